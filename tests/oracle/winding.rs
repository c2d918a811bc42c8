//! Winding numbers by rays in directions that meet no edge, found by trying.

use super::arrange::{Cell, Scene};
use super::exact::{Int, Int3, Plane, Point, cross, dot, is_zero, negate, sign, subtract};
use super::random::SplitMix;
use std::collections::HashMap;

/// Casts rays from points on the scene's planes. What a direction needs is prepared once.
pub(crate) struct Caster<'a> {
    scene: &'a Scene,
    random: SplitMix,
    fans: Vec<Fan>,
}

/// A direction, and for each edge of the scene the plane through it along the direction.
struct Fan {
    direction: Int3,
    edge_planes: Vec<EdgePlane>,
    /// For each triangle its three edges, and whether it runs along each as the edge plane has it.
    edges: Vec<[(usize, bool); 3]>,
    /// For each triangle, 1 where the ray leaves its solid through it, -1 where it enters.
    leaving: Vec<i32>,
    /// For each plane, 1 where the ray goes to its positive side.
    toward: Vec<i32>,
}

/// Not reduced as a [`Plane`] is, as it may be no plane at all: an edge along the direction.
struct EdgePlane {
    normal: Int3,
    offset: Int,
}

impl<'a> Caster<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Caster<'a> {
        Caster { scene, random: SplitMix::new(7), fans: Vec::new() }
    }

    /// The winding number of each operand just in front of the cell, on the side its plane's normal points to.
    pub(crate) fn in_front(&mut self, cell: &Cell) -> Vec<i32> {
        for attempt in 0.. {
            if attempt == self.fans.len() {
                let direction = [0, 1, 2].map(|_| Int::from(self.random.between(-999, 999)));
                self.fans.push(Fan::new(self.scene, direction));
            }
            if let Some(winding) = self.fans[attempt].cast(self.scene, cell) {
                return winding;
            }
        }
        unreachable!("there is always another direction")
    }
}

impl Fan {
    fn new(scene: &Scene, direction: Int3) -> Fan {
        let mut edge_planes = Vec::new();
        let mut index_of: HashMap<(&Int3, &Int3), usize> = HashMap::new();
        let mut edges = Vec::with_capacity(scene.triangles.len());
        for triangle in &scene.triangles {
            edges.push([0, 1, 2].map(|i| {
                let (a, b) = (&triangle.corners[i], &triangle.corners[(i + 1) % 3]);
                let forward = a < b;
                let (a, b) = if forward { (a, b) } else { (b, a) };
                let index = *index_of.entry((a, b)).or_insert_with(|| {
                    edge_planes.push(EdgePlane::new(a, b, &direction));
                    edge_planes.len() - 1
                });
                (index, forward)
            }));
        }
        let leaving = scene.triangles.iter().map(|t| t.leaving(&direction, &scene.planes)).collect();
        let toward = scene.planes.iter().map(|p| sign(&dot(&p.normal, &direction))).collect();
        Fan { direction, edge_planes, edges, leaving, toward }
    }

    /// The winding numbers in front of the cell, unless the ray meets an edge or runs along the cell's plane.
    fn cast(&self, scene: &Scene, cell: &Cell) -> Option<Vec<i32>> {
        if is_zero(&self.direction) || self.toward[cell.plane] == 0 {
            return None;
        }
        let ahead: Vec<bool> = self.planes_ahead(scene, &cell.inside);
        let mut sides: Vec<Option<i32>> = vec![None; self.edge_planes.len()];
        let mut winding = vec![0; scene.operands];
        for (index, triangle) in scene.triangles.iter().enumerate() {
            if triangle.plane == cell.plane || !ahead[triangle.plane] {
                continue;
            }
            let corners = self.edges[index].map(|(edge, forward)| {
                let side = *sides[edge].get_or_insert_with(|| self.edge_planes[edge].side(&cell.inside));
                if forward { side } else { -side }
            });
            let (low, high) = (corners.into_iter().min()?, corners.into_iter().max()?);
            if low * high > 0 {
                winding[triangle.operand] += self.leaving[index];
            } else if low * high == 0 {
                return None;
            }
        }
        if self.toward[cell.plane] < 0 {
            // The ray left on the other side, behind the cell.
            winding.iter_mut().zip(&cell.step).for_each(|(w, step)| *w -= step);
        }
        Some(winding)
    }

    /// Which planes the ray from `start` meets.
    fn planes_ahead(&self, scene: &Scene, start: &Point) -> Vec<bool> {
        let meets = |(plane, &toward): (&Plane, &i32)| toward * sign(&plane.value(start)) < 0;
        scene.planes.iter().zip(&self.toward).map(meets).collect()
    }
}

impl EdgePlane {
    /// Its value at `p` is `direction . ((a - p) x (b - p))`: positive where the line through `p` along the
    /// direction passes `ab` counter-clockwise.
    fn new(a: &Int3, b: &Int3, direction: &Int3) -> EdgePlane {
        EdgePlane { normal: negate(&cross(direction, &subtract(a, b))), offset: dot(direction, &cross(a, b)) }
    }

    fn side(&self, p: &Point) -> i32 {
        sign(&(dot(&self.normal, &p.x) + &self.offset * &p.w))
    }
}
