//! Whether a point is near the surface, by signs: what holds for a field holds for its multiples and its cube.

use crate::math::Vec3;
use crate::sdf::Field;

/// Whether the field changes its sign, or is zero, within `reach` of a point, along its gradient or, where that
/// is nothing, along `normal`. A place where it is undefined cannot be judged and passes.
pub(super) fn is_near(field: &dyn Field, point: Vec3, normal: Vec3, reach: f64) -> bool {
    let (value, gradient) = field.gradient(point);
    if value == 0.0 || value.is_nan() {
        return true;
    }
    let slope = gradient.length();
    // A quarter leaves room for slopes that grow.
    if value.abs() <= 0.25 * reach * slope {
        return true;
    }
    let along = if slope.is_normal() && slope.is_finite() { gradient / slope } else { normal };
    let step = if value < 0.0 { reach } else { -reach };
    let beyond = field.value(point + step * along);
    beyond.is_nan() || (beyond < 0.0) != (value < 0.0)
}

/// The vector from the nearest point of a triangle to `p`: within its plane's prism the height, otherwise from the
/// nearest edge.
pub(super) fn distance_to_triangle([a, b, c]: [Vec3; 3], p: Vec3) -> Vec3 {
    let normal = (b - a).cross(c - a);
    let beside = |u: Vec3, v: Vec3| normal.cross(v - u).dot(p - u) < 0.0;
    let edges = [[a, b], [b, c], [c, a]];
    if normal != Vec3::ZERO && !edges.iter().any(|&[u, v]| beside(u, v)) {
        return normal * (normal.dot(p - a) / normal.length_squared());
    }
    let from_edge = |[u, v]: [Vec3; 2]| {
        let along = v - u;
        let t = ((p - u).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        p - (u + along * t)
    };
    let from_edges = edges.map(from_edge);
    from_edges
        .into_iter()
        .fold(from_edges[0], |best, d| if d.length_squared() < best.length_squared() { d } else { best })
}
