//! How parts of surfaces bend, in proven numbers.

use crate::math::Vec3;

/// Proven bounds of the second derivatives over a part of the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bends {
    /// Of their lengths: by uu, uv and vv.
    pub lengths: [f64; 3],
    /// What of them is across the surface; `None` where its normal may be any.
    pub across: Option<Across>,
}

/// What bends a surface instead of stretching its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// A unit vector near the normals of the part.
    pub normal: Vec3,
    /// No unit normal of the part is farther from it than this.
    pub spread: f64,
    /// Bounds of the components of the second derivatives along `normal`, without sign: by uu, uv and vv.
    pub along: [f64; 3],
    /// The least of `|S_u x S_v| / |S_v|` and of `|S_u x S_v| / |S_u|`: how far a step of 1 along u, and along v, leads
    /// away from the direction of the other at least.
    pub speeds: [f64; 2],
}

impl Across {
    /// From vectors that the derivatives by u and by v are near, how far they may be off, and the bounds along a normal.
    pub(super) fn new(
        [du, dv]: [Vec3; 2],
        [off_u, off_v]: [f64; 2],
        along: impl Fn(Vec3) -> [f64; 3],
    ) -> Option<Across> {
        let cross = du.cross(dv);
        let (length, [long_u, long_v]) = (cross.length(), [du.length(), dv.length()]);
        // (a + e) x (b + f) = a x b + a x f + e x b + e x f.
        let off = (long_u * off_v + long_v * off_u + off_u * off_v) * (1.0 + 16.0 * f64::EPSILON);
        let least = length * (1.0 - 16.0 * f64::EPSILON) - off;
        if !(least > 0.0 && least.is_finite()) {
            return None;
        }
        let normal = cross / length;
        // The chord of an angle below a right one is at most the root of two times its sine.
        let spread = std::f64::consts::SQRT_2 * off / (least + off) + 16.0 * f64::EPSILON;
        let speeds = [least / (long_v + off_v), least / (long_u + off_u)];
        Some(Across { normal, spread, along: along(normal), speeds })
    }
}
