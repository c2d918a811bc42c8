//! How parts of surfaces bend, in proven numbers.

use super::Surface;
use crate::math::{Interval, Vec3};

/// Proven bounds of the second derivatives over a part of the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bends {
    /// Of their lengths: by uu, uv and vv.
    pub lengths: [f64; 3],
    /// What of them is across the surface; `None` where its tangent planes may be any.
    pub across: Option<Across>,
}

/// What bends a surface instead of stretching its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// The normals of the part; the bounds are of what of the second derivatives is along its direction.
    pub normal: Cone,
    /// The directions of the derivatives by u, and by v; the bounds are of what is at right angles to them.
    pub tangents: [Cone; 2],
    /// The least sine of the angle between the derivatives by u and by v.
    pub sine: f64,
    /// The least of `|S_u x S_v| / |S_v|` and of `|S_u x S_v| / |S_u|`: how far a step of 1 along u, and along v, leads
    /// away from the direction of the other at least.
    pub speeds: [f64; 2],
}

/// Unit vectors around a direction, with bounds of the second derivatives by uu, uv and vv.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// A unit vector.
    pub direction: Vec3,
    /// None of the unit vectors is farther from it than this.
    pub spread: f64,
    /// Of the parts of the second derivatives.
    pub bounds: [f64; 3],
}

impl Across {
    /// From vectors that the derivatives by u and by v are near, how far they may be off, and the bounds along a direction.
    pub(super) fn new(near: [Vec3; 2], off: [f64; 2], along: impl Fn(Vec3) -> [f64; 3]) -> Option<Across> {
        const ROUNDING: f64 = 16.0 * f64::EPSILON;
        let cross = near[0].cross(near[1]);
        let long = near.map(Vec3::length);
        // (a + e) x (b + f) = a x b + a x f + e x b + e x f.
        let wide = (long[0] * off[1] + long[1] * off[0] + off[0] * off[1]) * (1.0 + ROUNDING);
        let least = cross.length() * (1.0 - ROUNDING) - wide;
        if !(least > 0.0 && least.is_finite()) {
            return None;
        }
        // A vector within r of one of length l turns by at most the angle of sine r / l; the chord of an angle below a right
        // one is at most the root of two times its sine.
        let spread = |off: f64, length: f64| std::f64::consts::SQRT_2 * off / length + ROUNDING;
        let direction = cross.normalize();
        let normal = Cone { direction, spread: spread(wide, least + wide), bounds: along(direction) };
        let tangent = |axis: usize| {
            let along_it = near[axis] / long[axis];
            let beside = along(direction.cross(along_it));
            let bounds = [0, 1, 2].map(|k: usize| crate::math::hypot(normal.bounds[k], beside[k]));
            Cone { direction: along_it, spread: spread(off[axis], long[axis]), bounds }
        };
        let most = [long[0] + off[0], long[1] + off[1]];
        let tangents = [tangent(0), tangent(1)];
        Some(Across {
            normal,
            tangents,
            sine: least / (most[0] * most[1]),
            speeds: [least / most[1], least / most[0]],
        })
    }
}

/// Bounds over a part of the domain from the ranges of the second derivatives by uu, uv and vv, of each coordinate; `None`
/// where lengths have none.
pub(super) fn of_ranges(
    surface: &dyn Surface,
    part: [[f64; 2]; 2],
    ranges: &[[Interval; 3]; 3],
) -> Option<Bends> {
    let lengths = lengths(ranges)?;
    let [u, v] = part.map(|[low, high]| 0.5 * low + 0.5 * high);
    let jet = surface.jet(u, v);
    // From the middle of the part, half of its extents at most, with some room for the rounding of the slopes.
    let [s, t] = part.map(|[low, high]| (0.5 + 1e-9) * (high - low));
    let rounding = 1e-12 * (jet.du.length() + jet.dv.length());
    let off = [lengths[0] * s + lengths[1] * t + rounding, lengths[1] * s + lengths[2] * t + rounding];
    let along = |normal: Vec3| {
        [0, 1, 2].map(|k: usize| {
            let terms = [0, 1, 2].map(|axis: usize| ranges[axis][k] * Interval::point(normal[axis]));
            (terms[0] + terms[1] + terms[2]).magnitude()
        })
    };
    Some(Bends { lengths, across: Across::new([jet.du, jet.dv], off, along) })
}

/// Bounds of the lengths of vectors by the ranges of their components; `None` where they have none.
pub(super) fn lengths(ranges: &[[Interval; 3]; 3]) -> Option<[f64; 3]> {
    let bounds = [0, 1, 2].map(|k: usize| {
        let squares = ranges.map(|components| components[k].magnitude()).map(|most| most * most);
        squares.iter().sum::<f64>().sqrt() * (1.0 + 8.0 * f64::EPSILON)
    });
    bounds.iter().all(|bound| bound.is_finite()).then_some(bounds)
}
