//! How far a triangle with its corners on an ellipsoid is off it.
//!
//! With half axes a_i let G(p)^2 = sum p_i^2 / a_i^2, which is 1 on the ellipsoid, and N(p)^2 = sum p_i^2 / a_i^4, so that the
//! gradient of G has the length N / G. The paths p_i exp(t / a_i^2) are along that gradient everywhere and lead from every point
//! but the middle to the ellipsoid. On the way N / G only grows, since N^2 / G^2 is the mean of 1 / a_i^2 with the weights
//! p_i^2 / a_i^2, of which those of larger 1 / a_i^2 grow faster. So a path is no longer than
//!
//! h(p) = (1 - G) G / N,
//!
//! the distance to the first order; of a sphere it is the distance. The paths take the triangle continuously to a part of the
//! ellipsoid, so the largest h on it bounds the distance both ways.
//!
//! Where G is at least 1/2, (1 - G) G is concave, being so in G and falling there, and G is convex; and N is convex. So at any
//! point q of the triangle the tangents of both at q bound h from above by a ratio of two affine functions of p, whose largest
//! value is at a corner of the triangle. With q where h is largest that bound is the largest h itself.

use super::round_triangle::nearest_to_origin;
use crate::math::Vec3;

/// A bound of the distance, both ways; infinite where the triangle dips below half of the ellipsoid.
pub(super) fn bound(radii: Vec3, corners: [Vec3; 3]) -> f64 {
    /// Each brings q nearer to its place by about the share of h in the radius of curvature.
    const STEPS: usize = 3;
    // In the space in which the ellipsoid is the unit sphere.
    let unit = corners.map(|p| p / radii);
    let mut least = f64::INFINITY;
    let mut target = Vec3::ZERO;
    for _ in 0..STEPS {
        let q = target + nearest_to_origin(unit.map(|p| p - target));
        let g = q.length();
        if g <= 0.5 {
            return f64::INFINITY;
        }
        let slope = q / (radii * radii);
        let n = (q / radii).length();
        let slope = slope / n;
        // (1 - G) G and N along their tangents.
        let over = |p: Vec3| {
            let rise = (1.0 - 2.0 * g) * q.dot(p - q) / g;
            ((1.0 - g) * g + rise) / slope.dot(p)
        };
        if unit.iter().any(|&p| slope.dot(p) <= 0.0) {
            return f64::INFINITY;
        }
        least = least.min(unit.into_iter().map(over).fold(0.0, f64::max));
        // Where (1 - G) G - h N is largest, were the bends of all but G nothing.
        let h = (1.0 - g) * g / n;
        target = -h * g / (2.0 * g - 1.0) * slope;
    }
    least
}
