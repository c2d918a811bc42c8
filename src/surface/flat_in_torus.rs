//! How far a triangle with its corners on a torus is off it.
//!
//! A point at the distance d from the ring, the circle in the middle of the tube, is |d - r| off the torus, and the projection
//! from the ring takes the triangle continuously to a part of the torus. So the largest |d - r| on the triangle bounds the
//! distance both ways.
//!
//! With the distance rho from the axis, d^2 = |p|^2 + R^2 - 2 R rho. At p = sum l_i p_i
//!
//! sum l_i |p_i|^2 - |p|^2 = sum l_i l_j |p_i - p_j|^2 over the pairs, and
//! sum l_i rho_i - rho = sum l_i l_j w_ij / (sum l_i rho_i + rho) with w_ij = |q_i - q_j|^2 - (rho_i - rho_j)^2,
//!
//! q being p without its height: the difference of the squares of the two terms on the left. So
//!
//! d^2 = sum l_i d_i^2 + sum l_i l_j (k w_ij - |p_i - p_j|^2) with k = 2 R / (sum l_i rho_i + rho),
//!
//! a quadratic function but for k, which changes by the share of the triangle's extent in rho. The least and the largest k give
//! bounds, and on the quarters of a triangle close ones.

use super::round_triangle::least_distance;
use crate::math::{Vec3, hypot};

/// A bound of the distance, both ways; infinite where the triangle comes to the ring or the axis, or has a side that may lead
/// around the tube either way.
pub(super) fn bound([major, minor]: [f64; 2], corners: [Vec3; 3]) -> f64 {
    let least = least_distance(corners.map(|p| p.with_z(0.0)));
    let [a, b, c] = corners.map(|p| Corner::new(major, p));
    let sides = [(&a, &b), (&b, &c), (&c, &a)];
    // Where every point of a side is nearer than the ring to one of its ends, heights and distances from the axis taken for
    // coordinates, it leads around by less than two quarters; there it is a chord that bends toward the axis.
    let reach = |p: &Corner, q: &Corner| {
        0.5 * hypot(p.rho - q.rho, p.point.z - q.point.z) + p.turned(q) / (8.0 * least)
    };
    if least <= 0.0 || sides.iter().any(|(p, q)| reach(p, q) >= minor) {
        return f64::INFINITY;
    }
    let [ab, bc, ca] = sides.map(|(p, q)| Corner::new(major, 0.5 * p.point + 0.5 * q.point));
    let quarters = [[&a, &ab, &ca], [&ab, &b, &bc], [&ca, &bc, &c], [&ab, &bc, &ca]];
    quarters.into_iter().map(|corners| off(major, minor, corners)).fold(0.0, f64::max)
}

struct Corner {
    point: Vec3,
    /// Distance from the axis.
    rho: f64,
    /// Square of the distance from the ring.
    square: f64,
}

impl Corner {
    fn new(major: f64, point: Vec3) -> Corner {
        let rho = hypot(point.x, point.y);
        let across = rho - major;
        Corner { point, rho, square: across * across + point.z * point.z }
    }

    /// The w of two corners.
    fn turned(&self, other: &Corner) -> f64 {
        let (along, between) = (self.point - other.point, self.rho - other.rho);
        (along.truncate().length_squared() - between * between).max(0.0)
    }
}

/// A bound of |d - r| on a triangle.
fn off(major: f64, minor: f64, corners: [&Corner; 3]) -> f64 {
    let rho = corners.map(|corner| corner.rho);
    let least = least_distance(corners.map(|corner| corner.point.with_z(0.0)));
    let most = rho.into_iter().fold(0.0, f64::max);
    let bends = [major / most, 2.0 * major / (least + rho.into_iter().fold(f64::INFINITY, f64::min))];
    let squares = corners.map(|corner| corner.square);
    let [inner, outer] = bends.map(|k| {
        let pair = |i: usize, j: usize| {
            k * corners[i].turned(corners[j]) - corners[i].point.distance_squared(corners[j].point)
        };
        range(squares, [pair(1, 2), pair(2, 0), pair(0, 1)])
    });
    if inner[0] <= 0.0 {
        return f64::INFINITY;
    }
    (minor - inner[0].sqrt()).max(outer[1].sqrt() - minor)
}

/// The least and the largest value of `sum l_i f_i + sum l_j l_k c_i` on a triangle, for c by the corner that it leaves out.
fn range(f: [f64; 3], c: [f64; 3]) -> [f64; 2] {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let mut add = |value: f64| range = [range[0].min(value), range[1].max(value)];
    for k in 0..3 {
        add(f[k]);
        let (from, to, bend) = (f[(k + 1) % 3], f[(k + 2) % 3], c[k]);
        let t = 0.5 + 0.5 * (to - from) / bend;
        if 0.0 < t && t < 1.0 {
            add(from + t * (to - from) + t * (1.0 - t) * bend);
        }
    }
    // With l_0 = 1 - s - t for s = l_1 and t = l_2.
    let value = |s: f64, t: f64| {
        let rest = 1.0 - s - t;
        rest * f[0] + s * f[1] + t * f[2] + s * t * c[0] + t * rest * c[1] + rest * s * c[2]
    };
    let (slope_s, slope_t) = (f[1] - f[0] + c[2], f[2] - f[0] + c[1]);
    let (ss, st, tt) = (2.0 * c[2], c[1] + c[2] - c[0], 2.0 * c[1]);
    let determinant = ss * tt - st * st;
    let (s, t) = ((tt * slope_s - st * slope_t) / determinant, (ss * slope_t - st * slope_s) / determinant);
    if s > 0.0 && t > 0.0 && s + t < 1.0 {
        add(value(s, t));
    }
    range
}
