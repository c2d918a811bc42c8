//! Small features taken out of a rounded surface where rounding has folded it.
//!
//! Rounding moves vertices by half an ulp; where features are smaller than that, triangles may come to pass through each
//! other. A triangle as thin as the rounding is taken out: across its short side, if it has one, by making that one vertex,
//! and else by turning its longest side. Neither moves the surface by more than the triangle is thin, and neither changes
//! what is connected to what.

use super::Birth;
use crate::mesh::{Mesh, Topology, crossing_pairs};

/// A closed surface under repair. Half-edge `3 t + i` is side `i` of triangle `t`.
pub(super) struct Patient {
    /// The surface; triangles that were taken out are points.
    mesh: Mesh,
    births: Vec<Birth>,
    twins: Vec<u32>,
    alive: Vec<bool>,
    /// Triangles that were changed and not looked at since.
    changed: Vec<u32>,
    /// Bound on how far the surface was moved.
    movement: f64,
}

impl Patient {
    pub(super) fn new(mesh: Mesh, births: Vec<Birth>, movement: f64) -> Patient {
        let twins = Topology::new(&mesh.triangles).twins().to_vec();
        let alive = vec![true; mesh.triangles.len()];
        Patient { mesh, births, twins, alive, changed: Vec::new(), movement }
    }

    /// The crossings that are left of those there were, and those that changes made.
    pub(super) fn crossings(&mut self, before: &[[u32; 2]]) -> Vec<[u32; 2]> {
        let mut suspects: Vec<u32> = before.iter().flatten().copied().collect();
        suspects.append(&mut self.changed);
        suspects.sort_unstable();
        suspects.dedup();
        crossing_pairs(&self.mesh, &suspects)
    }

    /// Takes out triangles thinner than `thickness` that cross others, or are beside such; tells how many.
    pub(super) fn thin_out(&mut self, crossings: &[[u32; 2]], thickness: f64) -> usize {
        let mut around: Vec<u32> = crossings.iter().flatten().flat_map(|&t| self.around(t)).collect();
        around.sort_unstable();
        around.dedup();
        let mut taken = 0;
        for t in around {
            if self.alive[t as usize] && self.take_out(t, thickness) {
                taken += 1;
            }
        }
        if taken > 0 {
            self.movement += 2.0 * thickness;
        }
        taken
    }

    /// The surface that is left, where each triangle came from, and a bound on how far it was moved.
    pub(super) fn discharged(self) -> (Mesh, Vec<Birth>, f64) {
        let Patient { mesh: Mesh { positions, triangles }, births, alive, movement, .. } = self;
        let births = births.into_iter().zip(&alive).filter(|(_, alive)| **alive).map(|(birth, _)| birth);
        let mut number = vec![u32::MAX; positions.len()];
        let mut kept = Vec::new();
        let mut renumbered = |v: u32| {
            let slot = &mut number[v as usize];
            if *slot == u32::MAX {
                *slot = kept.len() as u32;
                kept.push(positions[v as usize]);
            }
            *slot
        };
        let triangles = triangles.into_iter().zip(&alive).filter(|(_, alive)| **alive);
        let triangles = triangles.map(|(corners, _)| corners.map(&mut renumbered)).collect();
        (Mesh { positions: kept, triangles }, births.collect(), movement)
    }

    /// A triangle and all that share a corner with it.
    fn around(&self, t: u32) -> Vec<u32> {
        (3 * t..3 * t + 3).flat_map(|half_edge| self.fan(half_edge)).map(|half_edge| half_edge / 3).collect()
    }

    /// The half-edges that leave the vertex which a half-edge leaves.
    fn fan(&self, half_edge: u32) -> Vec<u32> {
        let mut fan = vec![half_edge];
        let mut next = self.twins[Topology::previous(half_edge) as usize];
        while next != half_edge && next != Topology::NONE {
            fan.push(next);
            next = self.twins[Topology::previous(next) as usize];
        }
        fan
    }

    fn origin(&self, half_edge: u32) -> u32 {
        self.mesh.triangles[half_edge as usize / 3][half_edge as usize % 3]
    }

    fn target(&self, half_edge: u32) -> u32 {
        self.origin(Topology::next(half_edge))
    }

    fn length(&self, half_edge: u32) -> f64 {
        self.mesh.positions[self.origin(half_edge) as usize]
            .distance(self.mesh.positions[self.target(half_edge) as usize])
    }

    /// Takes out a triangle if it is thin and that can be done.
    fn take_out(&mut self, t: u32, thickness: f64) -> bool {
        let [a, b, c] = self.mesh.triangles[t as usize].map(|v| self.mesh.positions[v as usize]);
        let mut sides = [3 * t, 3 * t + 1, 3 * t + 2];
        sides.sort_by(|&g, &h| self.length(g).total_cmp(&self.length(h)));
        let longest = self.length(sides[2]);
        if (b - a).cross(c - a).length() > thickness * longest {
            return false;
        }
        if self.length(sides[0]) <= thickness { self.collapse(sides[0]) } else { self.turn(sides[2]) }
    }

    /// Makes the ends of a half-edge one vertex, unless that would glue other parts of the surface together.
    fn collapse(&mut self, half_edge: u32) -> bool {
        let twin = self.twins[half_edge as usize];
        let neighbours = |patient: &Patient, half_edge: u32| {
            let mut all: Vec<u32> = patient.fan(half_edge).iter().map(|&h| patient.target(h)).collect();
            all.sort_unstable();
            all
        };
        let (near, far) = (neighbours(self, half_edge), neighbours(self, twin));
        let common = near.iter().filter(|v| far.binary_search(v).is_ok()).count();
        // Triangles with three neighbours at a corner would be left as two back to back.
        let opposite = [half_edge, twin].map(|h| self.fan(Topology::previous(h)).len());
        if common != 2 || opposite.contains(&3) || near.len() < 3 || far.len() < 3 {
            return false;
        }
        let (gone, kept) = (self.origin(half_edge), self.target(half_edge));
        for h in self.fan(half_edge) {
            let corner = &mut self.mesh.triangles[h as usize / 3][h as usize % 3];
            debug_assert_eq!(*corner, gone);
            *corner = kept;
            self.changed.push(h / 3);
        }
        for h in [half_edge, twin] {
            let (x, y) = (self.twins[Topology::next(h) as usize], self.twins[Topology::previous(h) as usize]);
            self.twins[x as usize] = y;
            self.twins[y as usize] = x;
            self.alive[h as usize / 3] = false;
            self.mesh.triangles[h as usize / 3] = [kept; 3];
        }
        true
    }

    /// Turns a side into the other diagonal of its two triangles, unless there is such an edge already.
    fn turn(&mut self, half_edge: u32) -> bool {
        let twin = self.twins[half_edge as usize];
        let (left, right) = (Topology::previous(half_edge), Topology::previous(twin));
        let (c, d) = (self.origin(left), self.origin(right));
        let would_be_bare = [half_edge, twin].iter().any(|&h| self.fan(h).len() <= 3);
        if would_be_bare || c == d || self.fan(left).iter().any(|&h| self.target(h) == d) {
            return false;
        }
        let (a, b) = (self.origin(half_edge), self.origin(twin));
        // Triangles a b c and b a d become c d b and d c a.
        let outer = |h: u32| self.twins[h as usize];
        let (bc, ca) = (outer(Topology::next(half_edge)), outer(left));
        let (ad, db) = (outer(Topology::next(twin)), outer(right));
        let (t, s) = (half_edge / 3, twin / 3);
        self.changed.extend([t, s]);
        self.mesh.triangles[t as usize] = [c, d, b];
        self.mesh.triangles[s as usize] = [d, c, a];
        let pairs = [(3 * t, 3 * s), (3 * t + 1, db), (3 * t + 2, bc), (3 * s + 1, ca), (3 * s + 2, ad)];
        for (x, y) in pairs {
            self.twins[x as usize] = y;
            self.twins[y as usize] = x;
        }
        true
    }
}
