//! How the surfaces of the textbooks bend, in closed form over rectangles of parameters.

use super::bends::of_ranges;
use super::{Bends, Classic};
use crate::math::Interval;
use std::f64::consts::{PI, TAU};

/// Ranges of the second derivatives by uu, uv and vv, of each coordinate.
type Ranges = [[Interval; 3]; 3];

/// Proven bounds over a part of the domain; `None` for surfaces whose second derivatives have none.
pub(super) fn bends(surface: &Classic, part: [[f64; 2]; 2]) -> Option<Bends> {
    let [u, v] = part.map(|[low, high]| Interval::new(low, high));
    let mut bends = of_ranges(surface, part, &ranges(surface, u, v)?)?;
    for (length, most) in bends.lengths.iter_mut().zip(round_lengths(surface, u, v)) {
        *length = length.min(most * (1.0 + 64.0 * f64::EPSILON));
    }
    Some(bends)
}

/// A full turn is 1: cosine and sine of a range.
fn turn(share: Interval) -> [Interval; 2] {
    let angle = share * TAU.into();
    [angle.cos(), angle.sin()]
}

/// Cosine and sine of the latitude.
fn latitude(share: Interval) -> [Interval; 2] {
    // The quarter turn is exact that way; PI is off by less than half a unit in its last place.
    let angle = share * PI.into();
    [angle.sin(), -angle.cos()]
}

fn times(factor: f64, all: [Interval; 3]) -> [Interval; 3] {
    all.map(|range| range * factor.into())
}

fn ranges(surface: &Classic, u: Interval, v: Interval) -> Option<Ranges> {
    let none = Interval::point(0.0);
    let ([x, y], [c, s]) = (turn(u), turn(u * 0.5.into()));
    let square = TAU * TAU;
    // By uu, uv and vv, each a vector; by coordinates in the end.
    let [uu, uv, vv] = match *surface {
        Classic::Plane { .. } => [[none; 3]; 3],
        Classic::Sphere { radius } => ellipsoid([radius; 3], [x, y], latitude(v)),
        Classic::Ellipsoid { radii } => ellipsoid(radii, [x, y], latitude(v)),
        Classic::Superellipsoid { .. } => return None,
        Classic::Cylinder { radius, .. } => [times(-square * radius, [x, y, none]), [none; 3], [none; 3]],
        Classic::Cone { radius, .. } => {
            let r = (Interval::point(1.0) - v) * radius.into();
            [times(-square, [r * x, r * y, none]), times(TAU * radius, [y, -x, none]), [none; 3]]
        }
        Classic::Torus { major, minor } => {
            let [out, up] = turn(v);
            let r = out * minor.into() + major.into();
            [
                times(-square, [r * x, r * y, none]),
                times(square * minor, [up * y, -(up * x), none]),
                times(-square * minor, [out * x, out * y, up]),
            ]
        }
        Classic::Moebius { radius, width } => {
            let across = (v - 0.5.into()) * width.into();
            let r = across * c + radius.into();
            let (r_u, r_uu) = (-(across * s) * PI.into(), -(across * c) * (PI * PI).into());
            let rising = -(across * s) * (PI * PI).into();
            let [a, b] = [-(s * x) * PI.into() - c * y * TAU.into(), c * x * TAU.into() - s * y * PI.into()];
            [along_circle([r, r_u, r_uu], [x, y], rising), times(width, [a, b, c * PI.into()]), [none; 3]]
        }
        Classic::Klein { radius, minor } => klein([radius, minor], [x, y], [c, s], v),
        Classic::Helicoid { radius, turns, .. } => {
            let k = TAU * turns;
            let [x, y] = turn(u * turns.into());
            [times(-radius * k * k, [v * x, v * y, none]), times(radius * k, [-y, x, none]), [none; 3]]
        }
        Classic::Enneper { .. } => {
            let two = Interval::point(2.0);
            let (a, b) = (u * two, v * two);
            [[-a, b, two], [b, a, none], [a, -b, -two]]
        }
    };
    Some([0, 1, 2].map(|axis: usize| [uu[axis], uv[axis], vv[axis]]))
}

fn ellipsoid([a, b, c]: [f64; 3], [x, y]: [Interval; 2], [out, up]: [Interval; 2]) -> [[Interval; 3]; 3] {
    let (a, b, c) = (Interval::point(a), Interval::point(b), Interval::point(c));
    let (along_x, along_y) = (a * x, b * y);
    [
        times(-TAU * TAU, [out * along_x, out * along_y, Interval::point(0.0)]),
        times(TAU * PI, [up * a * y, -(up * b * x), Interval::point(0.0)]),
        times(-PI * PI, [out * along_x, out * along_y, up * c]),
    ]
}

/// The second derivative by u of a point at a changing distance from the axis, with that of its height.
fn along_circle([r, r_u, r_uu]: [Interval; 3], [x, y]: [Interval; 2], height: Interval) -> [Interval; 3] {
    let (whole, square) = (Interval::point(2.0 * TAU), Interval::point(TAU * TAU));
    [r_uu * x - whole * r_u * y - square * r * x, r_uu * y + whole * r_u * x - square * r * y, height]
}

fn klein(
    [radius, minor]: [f64; 2],
    [x, y]: [Interval; 2],
    [c, s]: [Interval; 2],
    v: Interval,
) -> [[Interval; 3]; 3] {
    let [minor, half, tau] = [minor, PI, TAU].map(Interval::point);
    let [quarter, square] = [PI * PI, TAU * TAU].map(Interval::point);
    let ([once_c, once], [twice_c, twice]) = (turn(v), turn(v * 2.0.into()));
    // The figure of eight, turned by half of u, and its derivatives by v.
    let turned = |p: Interval, q: Interval| [(c * p - s * q) * minor, (s * p + c * q) * minor];
    let [a, b] = turned(once, twice);
    let [a_v, b_v] = turned(once_c * tau, twice_c * tau * 2.0.into());
    let [a_vv, b_vv] = turned(-once * square, -twice * square * 4.0.into());
    // A turn by half of u: each derivative is pi times the other, at a right angle.
    let (r_u, r_uu) = (-(half * b), -(quarter * a));
    let a_uv = -(half * b_v);
    [
        along_circle([a + radius.into(), r_u, r_uu], [x, y], -(quarter * b)),
        [a_uv * x - tau * a_v * y, a_uv * y + tau * a_v * x, half * a_v],
        [a_vv * x, a_vv * y, b_vv],
    ]
}

/// Lengths that the turn about the axis has no part in; infinite where there is no such form.
fn round_lengths(surface: &Classic, u: Interval, v: Interval) -> [f64; 3] {
    let [out, up] = latitude(v).map(Interval::magnitude);
    let about = |r: Interval, slope: f64| [TAU * TAU * r.magnitude(), TAU * slope, f64::INFINITY];
    match *surface {
        Classic::Sphere { radius } => [TAU * TAU * radius * out, TAU * PI * radius * up, PI * PI * radius],
        Classic::Ellipsoid { radii: [a, b, c] } => {
            let wide = a.max(b);
            [TAU * TAU * wide * out, TAU * PI * wide * up, PI * PI * wide.max(c)]
        }
        Classic::Cylinder { radius, .. } => about(radius.into(), 0.0),
        Classic::Cone { radius, .. } => about((Interval::point(1.0) - v) * radius.into(), radius),
        Classic::Torus { major, minor } => {
            let [out, up] = turn(v);
            let [uu, uv, _] = about(out * minor.into() + major.into(), TAU * minor * up.magnitude());
            [uu, uv, TAU * TAU * minor]
        }
        Classic::Helicoid { radius, turns, .. } => {
            let k = TAU * turns;
            [k * k * radius * v.magnitude(), k * radius, f64::INFINITY]
        }
        Classic::Enneper { .. } => {
            let far = 2.0 * crate::math::hypot(crate::math::hypot(u.magnitude(), v.magnitude()), 1.0);
            [far, 2.0 * crate::math::hypot(u.magnitude(), v.magnitude()), far]
        }
        _ => [f64::INFINITY; 3],
    }
}
