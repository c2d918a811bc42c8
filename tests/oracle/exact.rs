//! Points and planes on integers of any size: no sign here is ever guessed.

use dashu_int::IBig;
use dashu_int::ops::{Gcd, UnsignedAbs};
use dashu_ratio::RBig;
use ogee::math::Vec3;
use std::cmp::Ordering;

pub(crate) type Int = IBig;

/// Three integers: a point of the lattice or a direction.
pub(crate) type Int3 = [Int; 3];

/// The lattice of all multiples of `2^exponent`, the coarsest one that holds every coordinate it was made for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    exponent: i32,
}

impl Lattice {
    /// For these finite positions.
    pub(crate) fn holding<'a>(positions: impl IntoIterator<Item = &'a Vec3>) -> Lattice {
        let coordinates = positions.into_iter().flat_map(Vec3::to_array);
        let exponents = coordinates.filter(|&x| x != 0.0).map(|x| mantissa_and_exponent(x).1);
        Lattice { exponent: exponents.min().unwrap_or(0) }
    }

    /// The integers that stand for a position which the lattice holds.
    pub(crate) fn point(self, position: Vec3) -> Int3 {
        position.to_array().map(|x| {
            let (mantissa, exponent) = mantissa_and_exponent(x);
            if mantissa == 0 { Int::ZERO } else { Int::from(mantissa) << (exponent - self.exponent) as usize }
        })
    }

    /// The number that `units` lattice units to the power of `dimension` are.
    pub(crate) fn value(self, units: RBig, dimension: i32) -> RBig {
        let shift = self.exponent * dimension;
        let power = Int::ONE << shift.unsigned_abs() as usize;
        if shift >= 0 { units * power } else { units / power }
    }
}

/// `x = mantissa * 2^exponent` with an odd mantissa, or zero.
fn mantissa_and_exponent(x: f64) -> (i64, i32) {
    assert!(x.is_finite(), "the oracle wants finite coordinates");
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) =
        if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let sign = if x < 0.0 { -1 } else { 1 };
    (sign * (mantissa >> zeros), exponent + zeros as i32)
}

pub(crate) fn sign(x: &Int) -> i32 {
    match x.cmp(&Int::ZERO) {
        Ordering::Less => -1,
        Ordering::Equal => 0,
        Ordering::Greater => 1,
    }
}

pub(crate) fn dot(a: &Int3, b: &Int3) -> Int {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &Int3, b: &Int3) -> Int3 {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

pub(crate) fn subtract(a: &Int3, b: &Int3) -> Int3 {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

pub(crate) fn negate(a: &Int3) -> Int3 {
    [-&a[0], -&a[1], -&a[2]]
}

pub(crate) fn is_zero(a: &Int3) -> bool {
    a.iter().all(Int::is_zero)
}

/// The greatest one, positive; of zero and anything, the other.
fn common_divisor(a: &Int, b: &Int) -> Int {
    Int::from(if b.is_zero() { a.unsigned_abs() } else { a.gcd(b) })
}

/// The point `x / w` with positive `w` and no common divisor, so that equal points are equal values.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Point {
    pub(crate) x: Int3,
    pub(crate) w: Int,
}

impl Point {
    pub(crate) fn new(x: Int3, w: Int) -> Point {
        let divisor = x.iter().fold(w.clone(), |g, c| common_divisor(&g, c));
        let divisor = if sign(&w) < 0 { -divisor } else { divisor };
        Point { x: x.map(|c| c / &divisor), w: w / &divisor }
    }

    /// Where the segment from `a` to `b` meets a plane that separates them; `at_a` and `at_b` are the plane's
    /// values there.
    pub(crate) fn between(a: &Point, at_a: &Int, b: &Point, at_b: &Int) -> Point {
        let blend = |p: &Int, q: &Int| p * at_b - q * at_a;
        let x = [blend(&a.x[0], &b.x[0]), blend(&a.x[1], &b.x[1]), blend(&a.x[2], &b.x[2])];
        Point::new(x, blend(&a.w, &b.w))
    }

    /// A positive multiple of the vector from this point to `other`.
    pub(crate) fn toward(&self, other: &Point) -> Int3 {
        [0, 1, 2].map(|i| &other.x[i] * &self.w - &self.x[i] * &other.w)
    }

    pub(crate) fn coordinates(&self) -> [RBig; 3] {
        [0, 1, 2].map(|i| RBig::from_parts(self.x[i].clone(), (&self.w).unsigned_abs()))
    }
}

/// The plane of all `p` with `normal . p + offset = 0`, without common divisor.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Plane {
    pub(crate) normal: Int3,
    pub(crate) offset: Int,
}

impl Plane {
    pub(crate) fn through(point: &Int3, normal: &Int3) -> Plane {
        let offset = -dot(normal, point);
        let divisor = normal.iter().fold(offset.clone(), |g, c| common_divisor(&g, c));
        Plane { normal: normal.clone().map(|c| c / &divisor), offset: offset / divisor }
    }

    /// The same plane with a normal whose first component that is not zero is positive, and whether that turned it.
    pub(crate) fn canonical(self) -> (Plane, bool) {
        let leading = self.normal.iter().map(sign).find(|&s| s != 0);
        if leading == Some(-1) {
            (Plane { normal: negate(&self.normal), offset: -self.offset }, true)
        } else {
            (self, false)
        }
    }

    /// Positive on the side the normal points to.
    pub(crate) fn value(&self, p: &Point) -> Int {
        dot(&self.normal, &p.x) + &self.offset * &p.w
    }
}

/// Adds in pairs: sums of halves have small denominators longer than a running sum would.
pub(crate) fn sum(mut terms: Vec<RBig>) -> RBig {
    while terms.len() > 1 {
        terms =
            terms.chunks(2).map(|pair| pair.iter().fold(RBig::ZERO, |total, term| total + term)).collect();
    }
    terms.pop().unwrap_or(RBig::ZERO)
}
