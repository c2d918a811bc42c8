//! Every face plane cut into convex cells by every other face plane.

use super::exact::{Int, Int3, Lattice, Plane, Point, cross, dot, is_zero, sign, subtract};
use super::random::SplitMix;
use ogee::mesh::Mesh;
use std::collections::HashMap;

/// The operands on integers.
pub(crate) struct Scene {
    pub(crate) planes: Vec<Plane>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) operands: usize,
}

pub(crate) struct Triangle {
    pub(crate) operand: usize,
    pub(crate) corners: [Int3; 3],
    /// Index of its plane.
    pub(crate) plane: usize,
    /// 1 where its normal is that of the plane, -1 where it is the opposite one.
    pub(crate) side: i32,
}

/// A convex piece of a plane that no other plane crosses, counter-clockwise about the plane's normal.
pub(crate) struct Cell {
    pub(crate) plane: usize,
    pub(crate) polygon: Vec<Point>,
    /// For each operand, by how much its winding number just behind the plane exceeds the one just in front.
    pub(crate) step: Vec<i32>,
    /// A point strictly inside.
    pub(crate) inside: Point,
}

impl Scene {
    /// Triangles without area are left out: the rest is still closed as a chain of points.
    pub(crate) fn new(lattice: Lattice, operands: &[&Mesh]) -> Scene {
        let mut scene = Scene { planes: Vec::new(), triangles: Vec::new(), operands: operands.len() };
        let mut index_of = HashMap::new();
        for (operand, mesh) in operands.iter().enumerate() {
            for index in 0..mesh.triangles.len() {
                let corners = mesh.corners(index).map(|p| lattice.point(p));
                let normal = cross(&subtract(&corners[1], &corners[0]), &subtract(&corners[2], &corners[0]));
                if is_zero(&normal) {
                    continue;
                }
                let (plane, turned) = Plane::through(&corners[0], &normal).canonical();
                let plane = *index_of.entry(plane.clone()).or_insert_with(|| {
                    scene.planes.push(plane);
                    scene.planes.len() - 1
                });
                let side = if turned { -1 } else { 1 };
                scene.triangles.push(Triangle { operand, corners, plane, side });
            }
        }
        scene
    }

    /// The cells of all planes that some triangle covers with a step.
    pub(crate) fn cells(&self) -> Vec<Cell> {
        (0..self.planes.len()).flat_map(|plane| self.cells_of_plane(plane)).collect()
    }

    fn cells_of_plane(&self, index: usize) -> Vec<Cell> {
        let covers: Vec<Cover> = self
            .triangles
            .iter()
            .filter(|t| t.plane == index)
            .map(|t| Cover::new(t, &self.planes[index]))
            .collect();
        let mut pieces = vec![(self.frame_polygon(index), (0..covers.len()).collect::<Vec<_>>())];
        for (_, cutter) in self.planes.iter().enumerate().filter(|&(other, _)| other != index) {
            let mut next = Vec::with_capacity(pieces.len());
            for (polygon, near) in pieces {
                match split(&polygon, cutter) {
                    None => next.push((polygon, near)),
                    Some(halves) => next.extend(halves.into_iter().filter_map(|half| {
                        let near: Vec<usize> =
                            near.iter().copied().filter(|&c| covers[c].may_meet(&half)).collect();
                        (!near.is_empty()).then_some((half, near))
                    })),
                }
            }
            pieces = next;
        }
        pieces.into_iter().filter_map(|(polygon, near)| self.cell(index, polygon, &near, &covers)).collect()
    }

    /// The cell with its steps, or nothing where all of them are zero.
    fn cell(&self, plane: usize, polygon: Vec<Point>, near: &[usize], covers: &[Cover]) -> Option<Cell> {
        let mut random = SplitMix::new(1);
        loop {
            let inside = point_inside(&polygon, &mut random);
            let mut step = vec![0; self.operands];
            let on_an_edge = near.iter().any(|&c| match covers[c].holds(&inside) {
                Some(holds) => {
                    step[covers[c].operand] += if holds { covers[c].side } else { 0 };
                    false
                }
                None => true,
            });
            if !on_an_edge {
                return step.iter().any(|&s| s != 0).then_some(Cell { plane, polygon, step, inside });
            }
        }
    }

    /// A rectangle in the plane, a unit wider than all triangles on it. Lifted along the axis the plane is
    /// steepest against, so that its corners exist.
    fn frame_polygon(&self, index: usize) -> Vec<Point> {
        let Plane { normal, offset } = &self.planes[index];
        let up = (0..3).find(|&i| !normal[i].is_zero()).expect("planes have normals");
        let (u, v) = ((up + 1) % 3, (up + 2) % 3);
        let corners = || self.triangles.iter().filter(|t| t.plane == index).flat_map(|t| &t.corners);
        let range = |axis: usize| {
            let low = corners().map(|p| &p[axis]).min().expect("a triangle on each plane") - Int::ONE;
            let high = corners().map(|p| &p[axis]).max().expect("a triangle on each plane") + Int::ONE;
            (low, high)
        };
        let ((u0, u1), (v0, v1)) = (range(u), range(v));
        let lift = |a: &Int, b: &Int| {
            let mut x = [Int::ZERO, Int::ZERO, Int::ZERO];
            x[u] = a * &normal[up];
            x[v] = b * &normal[up];
            x[up] = -(offset + &normal[u] * a + &normal[v] * b);
            Point::new(x, normal[up].clone())
        };
        let mut polygon = vec![lift(&u0, &v0), lift(&u1, &v0), lift(&u1, &v1), lift(&u0, &v1)];
        if sign(&normal[up]) < 0 {
            polygon.reverse();
        }
        polygon
    }
}

/// A triangle as three half-planes of its plane, positive inside.
struct Cover {
    operand: usize,
    side: i32,
    edges: [Plane; 3],
}

impl Cover {
    fn new(triangle: &Triangle, plane: &Plane) -> Cover {
        let edges = [0, 1, 2].map(|i| {
            let (a, b) = (&triangle.corners[i], &triangle.corners[(i + 1) % 3]);
            let inward = cross(&plane.normal, &subtract(b, a));
            let inward = if triangle.side > 0 { inward } else { super::exact::negate(&inward) };
            Plane::through(a, &inward)
        });
        Cover { operand: triangle.operand, side: triangle.side, edges }
    }

    /// Whether the point is strictly inside; `None` on the border.
    fn holds(&self, point: &Point) -> Option<bool> {
        let lowest = self.edges.iter().map(|edge| sign(&edge.value(point))).min().expect("three edges");
        (lowest != 0).then_some(lowest > 0)
    }

    /// False only if no edge-plane lets any of the convex polygon in.
    fn may_meet(&self, polygon: &[Point]) -> bool {
        self.edges.iter().all(|edge| polygon.iter().any(|p| sign(&edge.value(p)) > 0))
    }
}

/// Both halves of a convex polygon, or nothing if the plane does not cross its inside.
fn split(polygon: &[Point], cutter: &Plane) -> Option<[Vec<Point>; 2]> {
    let values: Vec<Int> = polygon.iter().map(|p| cutter.value(p)).collect();
    let signs: Vec<i32> = values.iter().map(sign).collect();
    if !signs.contains(&1) || !signs.contains(&-1) {
        return None;
    }
    let mut halves = [Vec::new(), Vec::new()];
    for (i, p) in polygon.iter().enumerate() {
        let j = (i + 1) % polygon.len();
        if signs[i] >= 0 {
            halves[0].push(p.clone());
        }
        if signs[i] <= 0 {
            halves[1].push(p.clone());
        }
        if signs[i] * signs[j] < 0 {
            let crossing = Point::between(p, &values[i], &polygon[j], &values[j]);
            halves[0].push(crossing.clone());
            halves[1].push(crossing);
        }
    }
    Some(halves)
}

/// A random convex combination of all corners: sums of homogeneous coordinates are one, as every `w` is positive.
fn point_inside(polygon: &[Point], random: &mut SplitMix) -> Point {
    let mut x = [Int::ZERO, Int::ZERO, Int::ZERO];
    let mut w = Int::ZERO;
    for p in polygon {
        let weight = Int::from(1 + random.below(97));
        for (sum, c) in x.iter_mut().zip(&p.x) {
            *sum += c * &weight;
        }
        w += &p.w * weight;
    }
    Point::new(x, w)
}

impl Triangle {
    /// Positive where `direction` leaves the solid through this triangle.
    pub(crate) fn leaving(&self, direction: &Int3, planes: &[Plane]) -> i32 {
        self.side * sign(&dot(&planes[self.plane].normal, direction))
    }
}
