//! Planes of triangles in doubles.

use super::scene::Scene;
use crate::math::Vec3;
use crate::polygon::exact::{PointId, Points};

/// A triangle's plane in doubles, good enough for points away from it.
pub(super) struct Slope {
    corner: Vec3,
    normal: Vec3,
    /// Largest differences along the axes from the corner to the other two, with their errors.
    reach: Vec3,
}

impl Slope {
    pub(super) fn new(points: &Points, corners: [PointId; 3]) -> Slope {
        let [a, b, c] = corners;
        let (a, b, c) = (points.rounded(a), points.rounded(b), points.rounded(c));
        let (u, v) = (b - a, c - a);
        Slope { corner: a, normal: u.cross(v), reach: u.abs().max(v.abs()) }
    }

    /// On which side of the plane a point lies, where doubles can tell.
    pub(super) fn side(&self, p: Vec3) -> Option<i32> {
        // Coordinates are below 2^61 and rounded, so each carries an error of at most 2^7, and each difference of 2^9
        // beside that of its own rounding. The determinant is a sum of six products of three differences, one along each
        // axis; with all errors it lies between the products of what they are at most with and without them.
        const ERROR: f64 = 512.0;
        let w = p - self.corner;
        let value = self.normal.dot(w);
        let most = self.reach.max(w.abs());
        let with_error = most + Vec3::splat(ERROR);
        let spread = 6.0 * (with_error.x * with_error.y * with_error.z - most.x * most.y * most.z);
        let bound = 2.0 * spread + 64.0 * f64::EPSILON * with_error.x * with_error.y * with_error.z;
        if value.abs() > bound { Some(if value > 0.0 { 1 } else { -1 }) } else { None }
    }
}

/// A quick sign that two triangles have nothing in common but corners of both, or the edge across which they are
/// neighbours: all other corners of one lie on one side of the other's plane.
pub(super) fn are_parted(scene: &Scene<'_>, t: u32, s: u32) -> bool {
    let (of_t, of_s) = (scene.corners[t as usize], scene.corners[s as usize]);
    let shared = of_s.iter().filter(|p| of_t.contains(p)).count();
    let neighbours = || (3 * t..3 * t + 3).any(|half_edge| scene.twins[half_edge as usize] / 3 == s);
    match shared {
        3 => return false,
        // Surfaces may pass through each other at an edge that is not theirs by index.
        2 if !neighbours() => return false,
        _ => {}
    }
    let lie_apart = |of: [PointId; 3], corners: [PointId; 3]| {
        let slope = Slope::new(scene.points(), of);
        let others = corners.into_iter().filter(|p| !of.contains(p));
        let mut sides = others.map(|p| slope.side(scene.points().rounded(p)));
        let first = sides.next().flatten();
        first.is_some() && sides.all(|side| side == first)
    };
    lie_apart(of_t, of_s) || lie_apart(of_s, of_t)
}
