//! The shell around a mesh: both its sides, moved out and in by the tolerance, and proofs of the field's sign there.

mod winding;

use crate::math::{Aabb, Interval, Mat3, Vec3};
use crate::sdf::{Curvature, Field, Slopes};

pub(crate) use winding::Shell;

/// Shifts fall short of the tolerance by more than rounding.
const SHORT: f64 = 1.0 - 1e-9;

/// Times that a triangle is quartered where slopes alone are known.
const DEEPEST: u32 = 3;

/// Times that it is where second derivatives are: bounds of these are then good enough.
const QUARTERINGS: u32 = 2;

/// A vertex moved to both sides along the field's gradient, and the field there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Post {
    /// Of length 1, or zero where the field has no gradient.
    pub(crate) direction: Vec3,
    /// Outward and inward.
    places: [Vec3; 2],
    /// There, the second with its sign changed: both should be positive.
    values: [f64; 2],
}

impl Post {
    pub(crate) fn at(point: Vec3, field: &dyn Field, tolerance: f64) -> Post {
        let gradient = field.gradient(point).1;
        let direction = if gradient.is_finite() { gradient.normalize_or_zero() } else { Vec3::ZERO };
        let shift = direction * (SHORT * tolerance);
        let places = [point + shift, point - shift];
        Post { direction, places, values: [field.value(places[0]), -field.value(places[1])] }
    }

    /// Whether the field has the signs at both ends that it should have.
    pub(crate) fn stands(&self) -> bool {
        self.values[0] > 0.0 && self.values[1] > 0.0
    }
}

/// What is known of a field in a box: it grows along a direction, at rates between two bounds.
pub(crate) struct Local<'f> {
    field: &'f dyn Field,
    pub(crate) direction: Vec3,
    /// The least slope along the direction, positive.
    pub(crate) least: f64,
    /// The greatest along any.
    pub(crate) most: f64,
    bend: Option<Bend>,
}

/// Second derivatives: those in the middle, and how far any eigenvalue can be from theirs.
struct Bend {
    middle: Mat3,
    spread: f64,
}

impl<'f> Local<'f> {
    /// `None` where ranges do not show a direction in which the field grows.
    pub(crate) fn of(field: &'f dyn Field, cell: Aabb) -> Option<Local<'f>> {
        let (slopes, hessian) = match field.curvature(cell) {
            Some(Curvature { slopes, hessian }) => (slopes, Some(hessian)),
            None => (field.slopes(cell)?, None),
        };
        let Slopes { mut gradient, .. } = slopes;
        if !gradient.iter().all(|g| g.is_bounded()) {
            return None;
        }
        if let Some(hessian) = hessian {
            narrow(&mut gradient, field, cell, hessian);
        }
        let direction = Vec3::from_array(gradient.map(Interval::middle)).try_normalize()?;
        let along = |k: usize| (gradient[k].lo * direction[k]).min(gradient[k].hi * direction[k]);
        let least = (along(0) + along(1) + along(2)) * SHORT;
        let most = Vec3::from_array(gradient.map(Interval::magnitude)).length();
        (least > 0.0).then(|| Local { field, direction, least, most, bend: hessian.and_then(Bend::of) })
    }

    /// A bound of second derivatives along straight lines, when there is one.
    pub(crate) fn bend(&self) -> Option<f64> {
        self.bend.as_ref().map(Bend::largest)
    }

    /// Whether the field is proven positive all over the outer side of a triangle, and negative over the inner one. Both
    /// must lie in the box.
    pub(crate) fn has_signs(&self, posts: &[Post; 3]) -> bool {
        if !posts.iter().all(Post::stands) {
            return false;
        }
        [1.0, -1.0].into_iter().zip(0..).all(|(sign, side): (f64, usize)| {
            let corners = posts.map(|post| post.places[side]);
            match &self.bend {
                Some(bend) => {
                    let bulge = bend.bulge(corners, sign) * (1.0 + 1e-9);
                    self.stays_above(corners, posts.map(|post| post.values[side]), sign, bulge, QUARTERINGS)
                }
                None => keeps_sign(self.field, corners, sign, DEEPEST),
            }
        })
    }

    /// Whether `sign` times the field is positive all over a triangle, given that at the corners and how far it may be below
    /// its linear interpolation.
    fn stays_above(&self, corners: [Vec3; 3], values: [f64; 3], sign: f64, bulge: f64, depth: u32) -> bool {
        if values.iter().all(|&value| value > bulge) {
            return true;
        }
        if depth == 0 {
            return false;
        }
        let [a, b, c] = corners;
        let middles = [0.5 * (b + c), 0.5 * (c + a), 0.5 * (a + b)];
        let between = middles.map(|p| sign * self.field.value(p));
        // Halved edges bend by a quarter.
        let bulge = 0.25 * bulge;
        let positive = |value: &f64| *value > 0.0;
        between.iter().all(positive)
            && self.stays_above(middles, between, sign, bulge, depth - 1)
            && (0..3).all(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let quarter = [corners[i], middles[k], middles[j]];
                self.stays_above(quarter, [values[i], between[k], between[j]], sign, bulge, depth - 1)
            })
    }
}

/// Narrows slopes over a cell by those in its middle and second derivatives: the mean-value form.
fn narrow(gradient: &mut [Interval; 3], field: &dyn Field, cell: Aabb, hessian: [Interval; 6]) {
    let [xx, yy, zz, yz, zx, xy] = hessian.map(Interval::magnitude);
    let half = 0.5 * cell.size();
    let (_, middle) = field.gradient(cell.center());
    let rows = [Vec3::new(xx, xy, zx), Vec3::new(xy, yy, yz), Vec3::new(zx, yz, zz)];
    for (k, row) in rows.into_iter().enumerate() {
        let reach = row.dot(half) * (1.0 + 1e-9) + 1e-12 * middle[k].abs();
        let narrower = gradient[k].intersection(Interval::new(middle[k] - reach, middle[k] + reach));
        if reach.is_finite() && !narrower.is_empty() {
            gradient[k] = narrower;
        }
    }
}

impl Bend {
    fn of(hessian: [Interval; 6]) -> Option<Bend> {
        if !hessian.iter().all(|h| h.is_bounded()) {
            return None;
        }
        let [xx, yy, zz, yz, zx, xy] = hessian.map(Interval::middle);
        let middle = Mat3::from_cols(Vec3::new(xx, xy, zx), Vec3::new(xy, yy, yz), Vec3::new(zx, yz, zz));
        let [xx, yy, zz, yz, zx, xy] = hessian.map(|h| 0.5 * h.width() * (1.0 + 1e-9));
        // No eigenvalue exceeds the greatest sum of magnitudes in a row (Gershgorin 1931).
        let spread = (xx + xy + zx).max(xy + yy + yz).max(zx + yz + zz);
        Some(Bend { middle, spread })
    }

    fn largest(&self) -> f64 {
        let rows = self.middle.transpose();
        let sums = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.abs().element_sum());
        sums.into_iter().fold(0.0, f64::max) * (1.0 + 1e-9) + self.spread
    }

    /// How far, at most, the field is below (`sign` 1) or above (-1) its linear interpolation on a triangle.
    ///
    /// At the point of barycentric coordinates a_i the difference is half the sum over pairs of a_i a_j times the second
    /// derivative along the edge between them, where that is constant; how far it is not enters with its bound.
    fn bulge(&self, corners: [Vec3; 3], sign: f64) -> f64 {
        let along = |i: usize, j: usize| {
            let edge = corners[j] - corners[i];
            sign * edge.dot(self.middle * edge) + self.spread * edge.length_squared()
        };
        0.5 * most_of_products([along(0, 1), along(1, 2), along(2, 0)])
    }
}

/// The greatest sum of q_ij a_i a_j over barycentric coordinates, but for negative q, taken for zero: of squared edges the
/// square of the radius around an acute triangle, and a quarter of the longest for others.
pub(crate) fn most_of_products(q: [f64; 3]) -> f64 {
    let [a, b, c] = q.map(|q| q.max(0.0));
    let longest = a.max(b).max(c);
    if 2.0 * longest >= a + b + c {
        return 0.25 * longest;
    }
    let twice = 2.0 * (a * b + b * c + c * a) - (a * a + b * b + c * c);
    a * b * c / twice
}

/// Whether `sign` times the field is positive all over a triangle, by slopes.
fn keeps_sign(field: &dyn Field, corners: [Vec3; 3], sign: f64, depth: u32) -> bool {
    let [a, b, c] = corners;
    let middle = (a + b + c) / 3.0;
    let value = sign * field.value(middle);
    let Some(slopes) = field.slopes(Aabb::of(corners)) else { return false };
    if value.is_nan() || value <= 0.0 || !slopes.gradient.iter().all(|g| g.is_bounded()) {
        return false;
    }
    let change = |p: &Vec3| {
        let along = |k: usize| Interval::point(sign * (p[k] - middle[k])) * slopes.gradient[k];
        (along(0) + along(1) + along(2)).lo
    };
    let least = corners.iter().map(change).fold(0.0, f64::min);
    if value + least * (1.0 + 1e-9) > 0.0 {
        return true;
    }
    // What is far too wide will not become narrow.
    if depth == 0 || value + least < -6.0 * value {
        return false;
    }
    let (ab, bc, ca) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
    let quarters = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
    quarters.into_iter().all(|quarter| keeps_sign(field, quarter, sign, depth - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a fine sampling of the simplex.
    #[test]
    fn greatest_sum_of_products() {
        let cases = [[1.0, 1.0, 1.0], [1.0, 1.0, 2.0], [1.0, 0.2, 0.3], [0.0, 1.0, 1.0], [-1.0, 0.5, 0.25]];
        for q in cases {
            let mut most = 0.0_f64;
            for i in 0..=300 {
                for j in 0..=300 - i {
                    let (a, b) = (f64::from(i) / 300.0, f64::from(j) / 300.0);
                    let c = 1.0 - a - b;
                    let [x, y, z] = q.map(|q: f64| q.max(0.0));
                    most = most.max(x * a * b + y * b * c + z * c * a);
                }
            }
            let bound = most_of_products(q);
            assert!(bound >= most - 1e-12 && bound <= most + 1e-4, "{q:?}: {bound} {most}");
        }
    }
}
