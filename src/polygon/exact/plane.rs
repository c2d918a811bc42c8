use super::width::{Cross, Offset, PlaneAtPoint};
use super::{PointId, Points, Site};
use crate::math::Vec3;
use crate::numeric::Wide;

/// The points `p` with `normal . p = offset`.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    normal: [i128; 3],
    offset: Offset,
    /// Normal and offset rounded to doubles, for the filter.
    rounded: [f64; 4],
}

/// Relative error of a plane evaluated in doubles at a rounded point: each of the four terms carries at most three
/// roundings of its factors and product and three of the sum, 2^-53 each; twice that is safe.
const FILTER: f64 = 12.0 * (f64::EPSILON / 2.0);

/// Bits of normals. Those of planes through lattice points have at most 123; scaling may make them wider.
pub(super) const MOST_NORMAL_BITS: u32 = 126;

impl Plane {
    /// The plane through three lattice points with the normal `(b - a) x (c - a)`; `None` when they lie on a line.
    pub fn through(a: Site, b: Site, c: Site) -> Option<Plane> {
        let (u, v) = (difference(b, a), difference(c, a));
        let component = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
        let normal = [component(1, 2), component(2, 0), component(0, 1)];
        if normal == [0; 3] { None } else { Some(Plane::new(reduced(normal), a)) }
    }

    /// The plane through `a` and `b` that contains the direction of `axis`; `None` when the three are not independent.
    pub fn along_axis(a: Site, b: Site, axis: usize) -> Option<Plane> {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let d = difference(b, a);
        let mut normal = [0; 3];
        normal[u] = d[v];
        normal[v] = -d[u];
        if normal == [0; 3] { None } else { Some(Plane::new(reduced(normal), a)) }
    }

    /// The plane of all points with one coordinate, its normal along that axis.
    pub fn across(axis: usize, coordinate: i64) -> Plane {
        let (mut normal, mut through) = ([0; 3], [0; 3]);
        normal[axis] = 1;
        through[axis] = coordinate;
        Plane::new(normal, through)
    }

    fn new(normal: [i128; 3], through: Site) -> Plane {
        Plane::of(normal, dot(&normal, through))
    }

    fn of(normal: [i128; 3], offset: Offset) -> Plane {
        let rounded = [normal[0] as f64, normal[1] as f64, normal[2] as f64, offset.to_f64()];
        Plane { normal, offset, rounded }
    }

    /// The plane of all points with their coordinates times 2^`exponent`; `None` where its normal would be too wide.
    pub(crate) fn scaled(&self, exponent: i32) -> Option<Plane> {
        // The normal times 2^up and the offset times 2^(up + exponent), with as few bits as possible.
        let zeros = self.normal.iter().filter(|&&n| n != 0).map(|n| n.trailing_zeros()).min().unwrap_or(0);
        let up = match self.offset.is_zero() {
            true => -(zeros as i32),
            false => (-(zeros as i32)).max(-(self.offset.trailing_zeros() as i32) - exponent),
        };
        let bits = |n: &i128| 128 - n.unsigned_abs().leading_zeros();
        let widest = self.normal.iter().map(bits).max().unwrap_or(0);
        if widest as i32 + up > MOST_NORMAL_BITS as i32 {
            return None;
        }
        let normal = self.normal.map(|n| if up < 0 { n >> -up } else { n << up });
        Some(Plane::of(normal, self.offset.times_power_of_two(up + exponent)?))
    }

    /// The same points with the other side positive.
    pub fn flipped(&self) -> Plane {
        let rounded = self.rounded.map(|c| -c);
        Plane { normal: self.normal.map(|c| -c), offset: self.offset.negated(), rounded }
    }

    /// The axis along which the normal is longest; the first one of equals.
    pub fn main_axis(&self) -> usize {
        let [x, y, z] = self.normal.map(i128::unsigned_abs);
        if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        }
    }

    /// Sign of the normal along an axis.
    pub fn normal_sign(&self, axis: usize) -> i32 {
        self.normal[axis].signum() as i32
    }

    /// The normal rounded to doubles, not of unit length.
    pub fn rounded_normal(&self) -> [f64; 3] {
        [self.rounded[0], self.rounded[1], self.rounded[2]]
    }

    /// The offset rounded to a double.
    pub(crate) fn rounded_offset(&self) -> f64 {
        self.rounded[3]
    }

    /// On which side of the plane the point lies: 1 where the normal points, 0 on the plane, -1 behind.
    #[inline]
    pub fn side(&self, points: &Points, point: PointId) -> i32 {
        let p = points.rounded(point);
        let [a, b, c, d] = self.rounded;
        let terms = [a * p.x, b * p.y, c * p.z, d];
        let value = terms[0] + terms[1] + terms[2] - terms[3];
        let bound = FILTER * (terms[0].abs() + terms[1].abs() + terms[2].abs() + terms[3].abs());
        if value > bound {
            1
        } else if value < -bound {
            -1
        } else {
            points.exact_side(self, point)
        }
    }

    /// `normal . site - offset`.
    pub(super) fn at_site(&self, site: Site) -> Offset {
        dot(&self.normal, site).minus(&self.offset)
    }

    /// `normal . numerators - offset denominator`.
    pub(crate) fn at_fraction<const X: usize, const D: usize, const R: usize>(
        &self,
        numerators: &[Wide<X>; 3],
        denominator: &Wide<D>,
    ) -> Wide<R> {
        let mut sum = self.offset.times::<D, R>(denominator).negated();
        for (n, x) in self.normal.iter().zip(numerators) {
            if *n != 0 {
                sum = sum.plus(&Wide::<2>::from(*n).times::<X, R>(x));
            }
        }
        sum
    }

    /// Sign of one component of `self.normal x other.normal`.
    pub fn cross_sign(&self, other: &Plane, axis: usize) -> i32 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let left = self.rounded[u] * other.rounded[v];
        let right = self.rounded[v] * other.rounded[u];
        let bound = FILTER * (left.abs() + right.abs());
        if (left - right).abs() > bound {
            return if left > right { 1 } else { -1 };
        }
        self.cross(other, u, v).signum()
    }

    /// An axis along which `self.normal x other.normal` does not vanish: the one along which it is longest, as far as
    /// doubles can tell; `None` for parallel planes.
    pub fn longest_cross_axis(&self, other: &Plane) -> Option<usize> {
        let normals = [self, other].map(|plane| Vec3::from_array(plane.rounded_normal()));
        let [x, y, z] = normals[0].cross(normals[1]).abs().to_array();
        let longest = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        [longest, 0, 1, 2].into_iter().find(|&axis| self.cross_sign(other, axis) != 0)
    }

    fn cross(&self, other: &Plane, u: usize, v: usize) -> Cross {
        let product = |i: i128, j: i128| Wide::<2>::from(i).times::<2, 4>(&Wide::<2>::from(j));
        product(self.normal[u], other.normal[v]).minus(&product(self.normal[v], other.normal[u]))
    }

    /// Where three planes meet, as three numerators and a positive denominator; `None` where they do not meet in one
    /// point (Cramer's rule).
    pub(super) fn meet(
        p: &Plane,
        q: &Plane,
        r: &Plane,
    ) -> Option<([super::width::Numerator; 3], super::width::Denominator)> {
        let cross = |a: &Plane, b: &Plane| [a.cross(b, 1, 2), a.cross(b, 2, 0), a.cross(b, 0, 1)];
        let (qr, rp, pq) = (cross(q, r), cross(r, p), cross(p, q));
        let mut denominator = Wide::ZERO;
        for (n, c) in p.normal.iter().zip(&qr) {
            denominator = Wide::plus(&denominator, &Wide::<2>::from(*n).times(c));
        }
        let sign = denominator.signum();
        if sign == 0 {
            return None;
        }
        let numerator = |i: usize| {
            let sum = p.offset.times(&qr[i]).plus(&q.offset.times(&rp[i])).plus(&r.offset.times(&pq[i]));
            if sign < 0 { Wide::negated(&sum) } else { sum }
        };
        let denominator = if sign < 0 { denominator.negated() } else { denominator };
        Some(([numerator(0), numerator(1), numerator(2)], denominator))
    }

    /// Whether both hold the same points, facing the same way or not.
    pub fn same_points(&self, other: &Plane) -> bool {
        let axis = self.main_axis();
        if other.normal[axis] == 0 {
            return false;
        }
        // Parallel, and offset in the same proportion as the normals along the main axis.
        let parallel = (0..3).all(|i| self.cross_sign(other, i) == 0);
        let scaled = |offset: &Offset, by: i128| -> Wide<5> { offset.times(&Wide::<2>::from(by)) };
        parallel && scaled(&self.offset, other.normal[axis]) == scaled(&other.offset, self.normal[axis])
    }

    /// Numbers that are equal for planes that hold the same points: ratios to the main component of the normal, each
    /// correctly rounded.
    pub fn key(&self) -> [u64; 4] {
        let axis = self.main_axis();
        let main = Wide::<2>::from(self.normal[axis]);
        let (main, sign) = if main.signum() < 0 { (main.negated(), -1.0) } else { (main, 1.0) };
        let ratio = |value: f64| (sign * value + 0.0).to_bits();
        let component = |i: usize| crate::numeric::rounded_quotient(&Wide::<2>::from(self.normal[i]), &main);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let offset = crate::numeric::rounded_quotient(&self.offset, &main);
        [axis as u64, ratio(component(u)), ratio(component(v)), ratio(offset)]
    }
}

impl Points {
    /// [`Plane::side`] where doubles cannot tell.
    #[cold]
    fn exact_side(&self, plane: &Plane, point: PointId) -> i32 {
        match self.fraction(point) {
            Ok(site) => plane.at_site(site).signum(),
            Err(fraction) => {
                let value: PlaneAtPoint = plane.at_fraction(&fraction.numerators, &fraction.denominator);
                value.signum()
            }
        }
    }
}

fn difference(a: Site, b: Site) -> [i128; 3] {
    [0, 1, 2].map(|i| i128::from(a[i]) - i128::from(b[i]))
}

/// The product in two halves, each of which fits: normals have at most 123 bits, coordinates 60.
fn dot(normal: &[i128; 3], site: Site) -> Offset {
    let (mut high, mut low) = (0_i128, 0_i128);
    for (n, c) in normal.iter().zip(site) {
        let c = i128::from(c);
        high += (n >> 64) * c;
        low += i128::from(*n as u64) * c;
    }
    // high 2^64 + low, with the carry of the lower half.
    let high = high + (low >> 64);
    Wide::from_halves(high, low as u64)
}

/// A normal along an axis cut down to length one: axis-parallel faces are common, and small numbers are fast.
fn reduced(normal: [i128; 3]) -> [i128; 3] {
    if normal.iter().filter(|&&c| c != 0).count() == 1 { normal.map(i128::signum) } else { normal }
}
