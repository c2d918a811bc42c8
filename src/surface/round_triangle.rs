//! How far triangles are off surfaces that are round about a point or an axis, in closed form.

use super::{Classic, flat_in_ellipsoid, flat_in_torus};
use crate::math::{Vec3, hypot};

/// See [`Surface::triangle_bound`](super::Surface::triangle_bound).
pub(super) fn bound(surface: &Classic, corners: [Vec3; 3]) -> Option<f64> {
    let (off, size) = match *surface {
        Classic::Sphere { radius } => (below(radius, corners), radius),
        Classic::Ellipsoid { radii } => {
            (flat_in_ellipsoid::bound(radii.into(), corners), radii.into_iter().fold(0.0, f64::max))
        }
        Classic::Cylinder { radius, .. } => (below(radius, corners.map(|p| p.with_z(0.0))), radius),
        Classic::Cone { radius, height } => (cone([radius, height], corners), radius.max(height)),
        // Beyond that the tube crosses itself on the axis, and nothing tells on which side a point is.
        Classic::Torus { major, minor } if minor < major => {
            (flat_in_torus::bound([major, minor], corners), major + minor)
        }
        _ => return None,
    };
    // Corners are off the surface by their rounding, and so is what is computed from them.
    const ROUNDING: f64 = 64.0 * f64::EPSILON;
    Some(off + ROUNDING * size)
}

/// How far a triangle dips below a circle or sphere about the origin; infinite where it does not leave the origin out.
fn below(radius: f64, corners: [Vec3; 3]) -> f64 {
    let least = least_distance(corners);
    if least > 0.0 { (radius - least).max(0.0) } else { f64::INFINITY }
}

/// Seen from the tip all triangles end in the base; there they dip below its circle, and nearer to the tip in proportion
/// less. What is so far off the mantle along the radius is off it by the cosine of its slope.
fn cone([radius, height]: [f64; 2], corners: [Vec3; 3]) -> f64 {
    let share = corners.map(|p| 1.0 - p.z / height);
    let most = share.into_iter().fold(0.0, f64::max);
    // The tip itself is over every point of the base.
    const TIP: f64 = 1e-9;
    let Some(known) = (0..3).find(|&k| share[k] > TIP) else { return 0.0 };
    let flat = [0, 1, 2].map(|k: usize| {
        let k = if share[k] > TIP { k } else { known };
        corners[k].with_z(0.0) / share[k]
    });
    most * below(radius, flat) * height / hypot(radius, height)
}

/// The least distance of a triangle from the origin; a triangle without area counts as its sides.
pub(crate) fn least_distance(corners: [Vec3; 3]) -> f64 {
    nearest_to_origin(corners).length()
}

/// The point of a triangle that is nearest to the origin.
pub(super) fn nearest_to_origin([a, b, c]: [Vec3; 3]) -> Vec3 {
    let normal = (b - a).cross(c - a);
    let is_left = |p: Vec3, q: Vec3| normal.dot((q - p).cross(-p)) >= 0.0;
    if normal.length_squared() > 0.0 && is_left(a, b) && is_left(b, c) && is_left(c, a) {
        return a.dot(normal) / normal.length_squared() * normal;
    }
    let on_side = |p: Vec3, q: Vec3| {
        let along = q - p;
        let t = (-p.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        p + t * along
    };
    let nearer = |p: Vec3, q: Vec3| if q.length_squared() < p.length_squared() { q } else { p };
    nearer(nearer(on_side(a, b), on_side(b, c)), on_side(c, a))
}
