//! Proofs that mesh and surface are within the tolerance of each other, by bounds of slopes and second derivatives.
//!
//! From the mesh to the surface: a triangle moved to both sides by the tolerance has opposite signs throughout.
//! From the surface to the mesh: where a linear function plus or minus the bound of its error can be zero, a triangle
//! is near. Both are divided where the bounds are too wide.

use super::extract::Extracted;
use super::lattice::Map;
use super::refine::{Leaf, Refinement};
use super::tetrahedron::{EDGES, LAST_GENERATION};
use super::{Places, cover::is_covered};
use crate::math::{Aabb, Interval, Vec3};
use crate::par;
use crate::sdf::{Curvature, Field};
use std::borrow::Cow;

/// Leaves that must be halved, and those that cannot be.
pub(super) struct Proof {
    /// By generation and place among its leaves.
    pub(super) failed: Vec<[usize; 2]>,
    pub(super) unproven: Places,
    /// Those that have been proven.
    pub(super) proven: Vec<[usize; 2]>,
}

impl Proof {
    /// Counts what failed as unproven.
    pub(super) fn give_up(&mut self, refinement: &Refinement<'_>) {
        for [generation, index] in std::mem::take(&mut self.failed) {
            let leaf = &refinement.leaves[generation][index];
            self.unproven.add(leaf.tetrahedron.bounds(&refinement.nodes));
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Outcome {
    Proven,
    Failed,
    Unproven,
}

/// Tries to prove every leaf that has not been proven before.
pub(super) fn prove(refinement: &Refinement<'_>, extracted: &Extracted) -> Proof {
    let pieces = Pieces::of(refinement, extracted);
    let mut names: Vec<[usize; 2]> = Vec::new();
    for (generation, leaves) in refinement.leaves.iter().enumerate() {
        names.extend((0..leaves.len()).filter(|&i| !leaves[i].proven).map(|i| [generation, i]));
    }
    let outcome = |&name: &[usize; 2]| judge(name, refinement, &pieces);
    let outcomes = par::map_above(64, &names, outcome);
    let mut proof = Proof { failed: Vec::new(), unproven: Places::default(), proven: Vec::new() };
    for (name, outcome) in names.into_iter().zip(outcomes) {
        match outcome {
            Outcome::Proven => proof.proven.push(name),
            Outcome::Failed => proof.failed.push(name),
            Outcome::Unproven => {
                let leaf = &refinement.leaves[name[0]][name[1]];
                proof.unproven.add(leaf.tetrahedron.bounds(&refinement.nodes));
            }
        }
    }
    proof
}

/// The triangles of each leaf, and the leaves at each node.
struct Pieces<'m> {
    extracted: &'m Extracted,
    of_leaf: Map<u64, [u32; 2]>,
    at_node: Vec<Vec<[u32; 2]>>,
}

fn name_key(generation: u32, index: u32) -> u64 {
    u64::from(generation) << 32 | u64::from(index)
}

impl<'m> Pieces<'m> {
    fn of(refinement: &Refinement<'_>, extracted: &'m Extracted) -> Pieces<'m> {
        let mut pieces = Pieces {
            extracted,
            of_leaf: Map::default(),
            at_node: vec![Vec::new(); refinement.nodes.places.len()],
        };
        let ends = extracted.origins.iter().skip(1).map(|o| o[2]).chain([extracted.caps_from as u32]);
        for (&[generation, index, first], end) in extracted.origins.iter().zip(ends) {
            pieces.of_leaf.insert(name_key(generation, index), [first, end]);
            let leaf = &refinement.leaves[generation as usize][index as usize];
            for id in leaf.tetrahedron.nodes {
                pieces.at_node[id as usize].push([first, end]);
            }
        }
        pieces
    }

    fn own(&self, [generation, index]: [usize; 2]) -> Vec<[Vec3; 3]> {
        let own = self.of_leaf.get(&name_key(generation as u32, index as u32));
        own.map_or(Vec::new(), |&range| self.triangles(range))
    }

    fn around(&self, leaf: &Leaf) -> Vec<[Vec3; 3]> {
        let mut ranges: Vec<[u32; 2]> =
            leaf.tetrahedron.nodes.iter().flat_map(|&id| self.at_node[id as usize].iter().copied()).collect();
        ranges.sort_unstable();
        ranges.dedup();
        ranges.into_iter().flat_map(|range| self.triangles(range)).collect()
    }

    fn triangles(&self, [first, end]: [u32; 2]) -> Vec<[Vec3; 3]> {
        (first..end).map(|i| self.extracted.mesh.corners(i as usize)).collect()
    }
}

fn judge(name: [usize; 2], refinement: &Refinement<'_>, pieces: &Pieces<'_>) -> Outcome {
    let leaf = &refinement.leaves[name[0]][name[1]];
    let t = &leaf.tetrahedron;
    let corners = t.corners(&refinement.nodes);
    let whole = refinement.field(t.field);
    let sizes = refinement.sizes;
    let cell = grown(Aabb::of(corners), sizes.tolerance);
    let pruned = whole.within(cell);
    let field = pruned.as_deref().unwrap_or(whole);
    let prover =
        Prover { field, tolerance: sizes.tolerance, own: pieces.own(name), around: pieces.around(leaf) };
    let bend = prover.bend(cell);
    let near = |&triangle: &[Vec3; 3]| prover.triangle_is_near(triangle, bend, 0);
    if prover.own.iter().all(near) && prover.zeros_are_near(corners, bend, &prover.around, 0) {
        return Outcome::Proven;
    }
    let size = t.size(&refinement.nodes);
    let last = t.generation == LAST_GENERATION || 0.5 * size < sizes.least;
    // Halving does not help where the field jumps, nor where ranges see a sheet that is not there.
    let hopeless = !t.one_sheet && size <= sizes.search && !t.is_crossed(&refinement.nodes)
        || !field.range(cell).is_some_and(|range| range.continuous && range.defined);
    if last || hopeless { Outcome::Unproven } else { Outcome::Failed }
}

struct Prover<'a> {
    field: &'a dyn Field,
    tolerance: f64,
    /// The leaf's own triangles.
    own: Vec<[Vec3; 3]>,
    /// Those of all leaves that share a node with it, and its own.
    around: Vec<[Vec3; 3]>,
}

impl Prover<'_> {
    /// A bound of second derivatives along straight lines, when there is one.
    fn bend(&self, cell: Aabb) -> Option<f64> {
        self.field.curvature(cell).map(|c| Curvature::largest(&c)).filter(|bend| bend.is_finite())
    }

    /// Whether every point of the triangle has surface within the tolerance.
    fn triangle_is_near(&self, [a, b, c]: [Vec3; 3], bend: Option<f64>, depth: u32) -> bool {
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let middle = (a + b + c) / 3.0;
        let along = self.direction([a, b, c], middle, bend.is_some());
        let mut proven = true;
        for side in [1.0, -1.0] {
            let shift = side * self.tolerance * along;
            let value = side * self.field.value(middle + shift);
            if value.is_nan() || value <= 0.0 {
                return false;
            }
            proven &= match bend {
                // On a triangle a function differs from its linear interpolation by half the bend times the square
                // of the radius of the circle around it, which is a third of the longest edge's at most.
                Some(bend) => {
                    let slack = bend * longest * longest / 6.0 * (1.0 + 1e-9);
                    [a, b, c].iter().all(|&p| side * self.field.value(p + shift) > slack)
                }
                None => self.keeps_sign([a, b, c].map(|p| p + shift), middle + shift, value),
            };
        }
        let smallest = if bend.is_some() { longest / 64.0 } else { 0.1 * self.tolerance };
        if proven {
            return true;
        }
        if longest <= smallest || depth > 10 || (bend.is_some() && depth > 3) {
            return false;
        }
        let (ab, bc, ca) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
        let quarters = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        quarters.into_iter().all(|quarter| {
            let bend = bend.or_else(|| self.bend(grown(Aabb::of(quarter), self.tolerance)));
            self.triangle_is_near(quarter, bend, depth + 1)
        })
    }

    /// The direction in which a triangle is moved: along the slope, near a crease between those of its sides.
    fn direction(&self, [a, b, c]: [Vec3; 3], middle: Vec3, smooth: bool) -> Vec3 {
        let slopes =
            if smooth { None } else { self.field.slopes(grown(Aabb::of([a, b, c]), self.tolerance)) };
        let gradient = match slopes {
            Some(slopes) if slopes.gradient.iter().all(|g| g.is_bounded()) => {
                Vec3::from_array(slopes.gradient.map(Interval::middle))
            }
            _ => self.field.gradient(middle).1,
        };
        gradient.try_normalize().unwrap_or_else(|| (b - a).cross(c - a).normalize_or_zero())
    }

    /// Whether a value in the middle of a triangle is larger than slopes can change it.
    fn keeps_sign(&self, corners: [Vec3; 3], middle: Vec3, value: f64) -> bool {
        let Some(slopes) = self.field.slopes(Aabb::of(corners)) else { return false };
        corners.iter().all(|&p| {
            let d = p - middle;
            let change =
                (0..3).fold(Interval::ZERO, |sum, k| sum + slopes.gradient[k] * Interval::point(d[k]));
            change.magnitude() < value
        })
    }

    /// Whether every zero in the tetrahedron has one of `triangles`, all that are not too far away, within the
    /// tolerance.
    fn zeros_are_near(
        &self,
        corners: [Vec3; 4],
        bend: Option<f64>,
        triangles: &[[Vec3; 3]],
        depth: u32,
    ) -> bool {
        let unknown = ([0.0; 4], f64::INFINITY, Vec3::ZERO);
        let (linear, slack, along) = self.linear(corners, bend).unwrap_or(unknown);
        if linear.iter().all(|&l| l > slack) || linear.iter().all(|&l| l < -slack) {
            return true;
        }
        let [i, j] = longest_edge(corners);
        let length = corners[i].distance(corners[j]);
        // A slab as thick as twice the tolerance is within it of nothing flat, unless the tetrahedron is small.
        let steepness = linear.iter().fold(0.0, |most: f64, l| most.max((l - linear[0]).abs())) / length;
        let thin = slack <= 2.0 * steepness * self.tolerance || length <= 2.0 * self.tolerance;
        let cell = grown(Aabb::of(corners), self.tolerance);
        let mut near = Cow::Borrowed(triangles);
        if thin || depth.is_multiple_of(3) {
            let touches = |triangle: &[Vec3; 3]| Aabb::around(*triangle).touches(cell);
            near = Cow::Owned(triangles.iter().copied().filter(touches).collect());
        }
        let all = self.own.iter().chain(near.iter());
        if thin && is_covered(&slab(corners, linear, slack), along, all, self.tolerance) {
            return true;
        }
        if depth > 40 || length < 0.25 * self.tolerance || (bend.is_some() && depth > 9) {
            return false;
        }
        let middle = 0.5 * (corners[i] + corners[j]);
        let bend = if depth % 3 == 2 { bend.or_else(|| self.bend(cell)) } else { bend };
        [i, j].into_iter().all(|end| {
            let mut half = corners;
            half[end] = middle;
            self.zeros_are_near(half, bend, &near, depth + 1)
        })
    }

    /// A linear function by its values at the corners, how far the field can be from it, and its gradient.
    fn linear(&self, corners: [Vec3; 4], bend: Option<f64>) -> Option<([f64; 4], f64, Vec3)> {
        let middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
        let (value, gradient) = self.field.gradient(middle);
        let from = corners.map(|p| p - middle);
        if let Some(bend) = bend {
            let radius = from.iter().fold(0.0, |most: f64, d| most.max(d.length_squared()));
            let slack = 0.5 * bend * radius * (1.0 + 1e-9);
            return Some((from.map(|d| value + gradient.dot(d)), slack, gradient));
        }
        let slopes = self.field.slopes(Aabb::of(corners))?;
        if slopes.range.interval.is_empty() || !slopes.gradient.iter().all(|g| g.is_bounded()) {
            return None;
        }
        let mean = Vec3::from_array(slopes.gradient.map(Interval::middle));
        let spread = Vec3::from_array(slopes.gradient.map(|g| 0.5 * g.width()));
        let slack = from.iter().fold(0.0, |most: f64, d| most.max(spread.dot(d.abs())));
        Some((from.map(|d| value + mean.dot(d)), slack * (1.0 + 1e-9), mean))
    }
}

/// The corners of the part of a tetrahedron in which a linear function is at most `slack` from zero.
fn slab(corners: [Vec3; 4], linear: [f64; 4], slack: f64) -> Vec<Vec3> {
    let mut points: Vec<Vec3> = (0..4).filter(|&i| linear[i].abs() <= slack).map(|i| corners[i]).collect();
    for [i, j] in EDGES {
        for level in [-slack, slack] {
            if (linear[i] < level) != (linear[j] < level) {
                let t = ((level - linear[i]) / (linear[j] - linear[i])).clamp(0.0, 1.0);
                points.push(corners[i] + (corners[j] - corners[i]) * t);
            }
        }
    }
    points
}

fn longest_edge(corners: [Vec3; 4]) -> [usize; 2] {
    let length = |[i, j]: [usize; 2]| corners[i].distance_squared(corners[j]);
    EDGES.into_iter().fold(EDGES[0], |best, edge| if length(edge) > length(best) { edge } else { best })
}

fn grown(cell: Aabb, distance: f64) -> Aabb {
    Aabb { min: cell.min - distance, max: cell.max + distance }
}
