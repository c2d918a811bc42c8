//! Normals where the derivatives by u and v do not give one.

use super::Surface;
use super::jet::unit_cross;
use super::net::{self, Degrees};
use crate::math::Vec3;

/// The normal of the jet, or its limit from inside the domain.
pub(super) fn normal<S: Surface + ?Sized>(surface: &S, u: f64, v: f64) -> Option<Vec3> {
    surface
        .jet(u, v)
        .normal()
        .filter(|_| !nearly_singular(surface, u, v))
        .or_else(|| from_inside(surface, u, v))
}

/// Whether a derivative is so small against its like inside that it is mostly error.
fn nearly_singular<S: Surface + ?Sized>(surface: &S, u: f64, v: f64) -> bool {
    // Differences are good to 1e-9 of the size; a sine of pi to 1e-16.
    const NOISE: f64 = 1e-8;
    let [[a, b], [c, d]] = surface.domain();
    if u != a && u != b && v != c && v != d {
        return false;
    }
    let (here, middle) = (surface.jet(u, v), surface.jet(0.5 * a + 0.5 * b, 0.5 * c + 0.5 * d));
    here.du.length() <= NOISE * middle.du.length() || here.dv.length() <= NOISE * middle.dv.length()
}

/// Normals at steps inward that shrink, extrapolated to a step of zero.
fn from_inside<S: Surface + ?Sized>(surface: &S, u: f64, v: f64) -> Option<Vec3> {
    // The normal changes by the order of the step; two steps cancel the first order.
    const STEP: f64 = 1e-4;
    inward(surface.domain(), u, v).into_iter().find_map(|[x, y]| {
        let [[a, b], [c, d]] = surface.domain();
        let at = |step: f64| surface.jet(u + step * x * (b - a), v + step * y * (d - c)).normal();
        let (near, far) = (at(STEP)?, at(2.0 * STEP)?);
        (2.0 * near - far).try_normalize()
    })
}

/// Directions from a point of the domain into it, in shares of its extents: straight from its border first.
fn inward([[a, b], [c, d]]: [[f64; 2]; 2], u: f64, v: f64) -> Vec<[f64; 2]> {
    let toward = |t: f64, low: f64, high: f64| if t <= 0.5 * low + 0.5 * high { 1.0 } else { -1.0 };
    let (x, y) = (toward(u, a, b), toward(v, c, d));
    let straight = if v == c || v == d { [[0.0, y], [x, 0.0]] } else { [[x, 0.0], [0.0, y]] };
    vec![straight[0], straight[1], [x, y], [x, 0.5 * y], [0.5 * x, y]]
}

/// The exact limit for a polynomial net over the unit square: along a line inward the cross product is a polynomial,
/// and its first coefficient that does not vanish gives the direction.
pub(super) fn of_net(points: &[Vec3], degrees: Degrees, u: f64, v: f64) -> Option<Vec3> {
    let [by_u, by_v] = [0, 1].map(|axis| net::derivative(points, degrees, axis));
    if let Some(normal) = unit_cross_beyond_rounding(
        net::eval(&by_u.0, by_u.1, u, v),
        net::eval(&by_v.0, by_v.1, u, v),
        [net::largest(&by_u.0), net::largest(&by_v.0)],
    ) {
        return Some(normal);
    }
    inward([[0.0, 1.0]; 2], u, v).into_iter().find_map(|direction| {
        let [a, b] = [&by_u, &by_v].map(|(points, degrees)| taylor(points, *degrees, [u, v], direction));
        first_cross(&a, &b)
    })
}

/// The unit cross product where it is above the rounding of vectors that were computed from such sizes.
fn unit_cross_beyond_rounding(a: Vec3, b: Vec3, sizes: [f64; 2]) -> Option<Vec3> {
    const ROUNDING: f64 = 64.0 * f64::EPSILON;
    (a.length() > ROUNDING * sizes[0] && b.length() > ROUNDING * sizes[1]).then(|| unit_cross(a, b)).flatten()
}

/// Coefficients of the polynomial in s of a net at `at + s * direction`.
fn taylor(points: &[Vec3], degrees: Degrees, at: [f64; 2], [x, y]: [f64; 2]) -> Vec<Vec3> {
    let mut coefficients = vec![Vec3::ZERO; degrees[0] + degrees[1] + 1];
    let (mut column, mut column_degrees) = (points.to_vec(), degrees);
    let mut weight_u = 1.0;
    for i in 0..=degrees[0] {
        let (mut net, mut net_degrees) = (column.clone(), column_degrees);
        let mut weight = weight_u;
        for j in 0..=degrees[1] {
            coefficients[i + j] += weight * net::eval(&net, net_degrees, at[0], at[1]);
            weight *= y / (j + 1) as f64;
            (net, net_degrees) = net::derivative(&net, net_degrees, 1);
        }
        weight_u *= x / (i + 1) as f64;
        (column, column_degrees) = net::derivative(&column, column_degrees, 0);
    }
    coefficients
}

/// The direction of the lowest coefficient of a product of vector polynomials that is not zero up to rounding.
fn first_cross(a: &[Vec3], b: &[Vec3]) -> Option<Vec3> {
    // A coefficient is a sum of fewer than degree products, each off by its evaluation.
    const ROUNDING: f64 = 256.0 * f64::EPSILON;
    let length = |v: Vec3| v.length();
    let size = |list: &[Vec3]| list.iter().copied().map(length).fold(0.0, f64::max);
    let (most_a, most_b) = (size(a), size(b));
    if most_a == 0.0 || most_b == 0.0 {
        return None;
    }
    let (a, b): (Vec<Vec3>, Vec<Vec3>) =
        (a.iter().map(|&v| v / most_a).collect(), b.iter().map(|&v| v / most_b).collect());
    (0..a.len() + b.len() - 1).find_map(|order| {
        let terms = (0..=order).filter(|&i| i < a.len() && order - i < b.len());
        let cross: Vec3 = terms.map(|i| a[i].cross(b[order - i])).sum();
        (cross.length() > ROUNDING * (order + 1) as f64).then(|| cross.normalize())
    })
}
