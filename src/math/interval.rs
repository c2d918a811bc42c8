//! Arithmetic with sets of numbers, rounded outward.

use super::{acos, asin, atan, atan2, cbrt, cos, exp, ln, pow, sin, tan};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A closed interval of real numbers that may reach to infinity, or the empty set.
///
/// Every operation hands out an interval that holds the exact result for all numbers of its arguments; where a
/// function is undefined, numbers are left out, and an argument without any number that fits gives
/// [`Interval::EMPTY`]. Sums are rounded outward only where they are not exact; products, quotients and roots by one
/// place; transcendental functions by [`LIBM_PLACES`].
///
/// Moore, Interval Analysis, 1966; IEEE 1788-2015 for the conventions at infinity (zero times infinity is zero).
///
/// ```
/// use ogee::math::Interval;
///
/// let x = Interval::new(-1.0, 2.0);
/// assert!((x * x).contains(-2.0)); // the factors are taken for independent
/// assert_eq!(x.square().lo, 0.0);
/// assert_eq!(Interval::new(-1.0, 4.0).sqrt().lo, 0.0);
/// assert!(Interval::new(-2.0, -1.0).sqrt().is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least number; NaN in the empty interval.
    pub lo: f64,
    /// The greatest number; NaN in the empty interval.
    pub hi: f64,
}

/// Places by which results of the transcendental functions are widened.
///
/// The sources that `libm` follows promise errors below one unit in the last place, two for `atan2`; the largest that
/// searches found in them are about 1 and 1.6 (Innocente and Zimmermann, Accuracy of mathematical functions in single,
/// double, double extended, and quadruple precision, 2024). The rest is margin.
pub const LIBM_PLACES: u32 = 4;

/// Beyond it nothing is said of the phase of an angle.
const LARGEST_ANGLE: f64 = 1e12;

impl Interval {
    /// No number at all.
    pub const EMPTY: Interval = Interval { lo: f64::NAN, hi: f64::NAN };
    /// All real numbers.
    pub const ENTIRE: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// The number 0.
    pub const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };
    /// The number 1.
    pub const ONE: Interval = Interval { lo: 1.0, hi: 1.0 };
    /// The numbers from 0 to 1.
    pub const UNIT: Interval = Interval { lo: 0.0, hi: 1.0 };
    /// The numbers from -1 to 1.
    pub const SIGNED_UNIT: Interval = Interval { lo: -1.0, hi: 1.0 };

    /// The numbers from `lo` to `hi`; empty when `lo <= hi` does not hold.
    #[inline]
    pub fn new(lo: f64, hi: f64) -> Interval {
        if lo <= hi { Interval { lo, hi } } else { Interval::EMPTY }
    }

    /// One number; empty for NaN. An infinite one stands for what is too large to write.
    #[inline]
    pub fn point(x: f64) -> Interval {
        Interval { lo: x.min(f64::MAX), hi: x.max(f64::MIN) }.or_empty(x.is_nan())
    }

    #[inline]
    fn or_empty(self, empty: bool) -> Interval {
        if empty { Interval::EMPTY } else { self }
    }

    /// Whether there is no number in it.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.lo.is_nan()
    }

    /// Whether it is a single number.
    #[inline]
    pub fn is_point(self) -> bool {
        self.lo == self.hi
    }

    /// Whether both ends are finite.
    #[inline]
    pub fn is_bounded(self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// Whether `x` is in it.
    #[inline]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether every number of `other` is in it.
    #[inline]
    pub fn encloses(self, other: Interval) -> bool {
        other.is_empty() || (self.lo <= other.lo && other.hi <= self.hi)
    }

    /// The smallest interval around both.
    #[inline]
    pub fn hull(self, other: Interval) -> Interval {
        // Minimum and maximum pass over NaN, so over the empty one.
        Interval { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The numbers in both.
    #[inline]
    pub fn intersection(self, other: Interval) -> Interval {
        if self.is_empty() || other.is_empty() {
            return Interval::EMPTY;
        }
        Interval::new(self.lo.max(other.lo), self.hi.min(other.hi))
    }

    /// Distance between the ends, rounded up; NaN for the empty interval.
    #[inline]
    pub fn width(self) -> f64 {
        sum_up(self.hi, -self.lo)
    }

    /// A number near the middle; NaN for the empty interval.
    #[inline]
    pub fn middle(self) -> f64 {
        if self.is_bounded() { 0.5 * self.lo + 0.5 * self.hi } else { self.lo.max(f64::MIN).min(self.hi) }
    }

    /// The largest magnitude; NaN for the empty interval.
    #[inline]
    pub fn magnitude(self) -> f64 {
        if self.is_empty() { f64::NAN } else { self.hi.max(-self.lo) }
    }

    /// The smallest magnitude; NaN for the empty interval.
    #[inline]
    pub fn mignitude(self) -> f64 {
        if self.is_empty() { f64::NAN } else { self.lo.max(-self.hi).max(0.0) }
    }

    /// It and `places` more numbers of type `f64` at each end.
    #[inline]
    pub fn widened(self, places: u32) -> Interval {
        let mut wide = self;
        for _ in 0..places {
            wide = Interval { lo: wide.lo.next_down(), hi: wide.hi.next_up() };
        }
        wide
    }

    /// The magnitudes.
    #[inline]
    pub fn abs(self) -> Interval {
        Interval { lo: self.mignitude(), hi: self.magnitude() }
    }

    /// The lesser of two numbers.
    #[inline]
    pub fn min(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi) }
            .or_empty(self.is_empty() || other.is_empty())
    }

    /// The greater of two numbers.
    #[inline]
    pub fn max(self, other: Interval) -> Interval {
        Interval { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi) }
            .or_empty(self.is_empty() || other.is_empty())
    }

    /// The squares; never below zero.
    #[inline]
    pub fn square(self) -> Interval {
        let size = self.abs();
        Interval { lo: product_down(size.lo, size.lo), hi: product_up(size.hi, size.hi) }
    }

    /// The square roots of what is not negative.
    #[inline]
    pub fn sqrt(self) -> Interval {
        if self.is_empty() || self.hi < 0.0 {
            return Interval::EMPTY;
        }
        let lo = self.lo.max(0.0).sqrt();
        let hi = self.hi.sqrt();
        // A root whose rounded square is the number again may still be inexact; zero is not.
        let up = if hi == 0.0 { 0.0 } else { hi.next_up() };
        Interval { lo: lo.next_down().max(0.0), hi: up }
    }

    /// The cube roots.
    #[inline]
    pub fn cbrt(self) -> Interval {
        self.increasing(cbrt)
    }

    /// e to the power of each number.
    pub fn exp(self) -> Interval {
        let wide = self.increasing(exp);
        Interval { lo: wide.lo.max(0.0), hi: wide.hi }.or_empty(self.is_empty())
    }

    /// The natural logarithms of what is positive.
    pub fn ln(self) -> Interval {
        if self.hi <= 0.0 {
            return Interval::EMPTY;
        }
        Interval { lo: self.lo.max(0.0), hi: self.hi }.or_empty(self.is_empty()).increasing(ln)
    }

    /// The sines of angles in radians.
    pub fn sin(self) -> Interval {
        self.wave(sin, -FRAC_PI_2)
    }

    /// The cosines of angles in radians.
    pub fn cos(self) -> Interval {
        self.wave(cos, -PI)
    }

    /// A sine-like function whose least values are at `bottom` and every full turn from there.
    fn wave(self, f: impl Fn(f64) -> f64, bottom: f64) -> Interval {
        if self.is_empty() {
            return self;
        }
        if self.magnitude() > LARGEST_ANGLE || self.width() >= 2.0 * PI {
            return Interval::SIGNED_UNIT;
        }
        let ends = Interval::new(f(self.lo).min(f(self.hi)), f(self.lo).max(f(self.hi))).widened(LIBM_PLACES);
        let lo = if self.may_meet(bottom, 2.0 * PI) { -1.0 } else { ends.lo.max(-1.0) };
        let hi = if self.may_meet(bottom + PI, 2.0 * PI) { 1.0 } else { ends.hi.min(1.0) };
        Interval { lo, hi }
    }

    /// Whether a number of the form `start + k * step` may be in it; never wrongly `false`.
    fn may_meet(self, start: f64, step: f64) -> bool {
        // Three rounded operations and the rounded constants; a slip of 1e-14 is many times their error.
        let slip = 1e-14 * (1.0 + self.magnitude());
        let first = ((self.lo - slip - start) / step).ceil();
        first <= (self.hi + slip - start) / step
    }

    /// The tangents of angles in radians; all numbers when a pole may be among them.
    pub fn tan(self) -> Interval {
        if self.is_empty() {
            return self;
        }
        if self.meets_pole_of_tan() { Interval::ENTIRE } else { self.increasing(tan) }
    }

    /// Whether the tangent may have a pole in it.
    pub fn meets_pole_of_tan(self) -> bool {
        self.magnitude() > LARGEST_ANGLE || self.width() >= PI || self.may_meet(FRAC_PI_2, PI)
    }

    /// The arcs, in radians, of the sines from -1 to 1.
    pub fn asin(self) -> Interval {
        self.intersection(Interval::SIGNED_UNIT).increasing(asin)
    }

    /// The arcs, in radians, of the cosines from -1 to 1.
    pub fn acos(self) -> Interval {
        let cosines = self.intersection(Interval::SIGNED_UNIT);
        let arcs = Interval { lo: acos(cosines.hi), hi: acos(cosines.lo) }.widened(LIBM_PLACES);
        Interval { lo: arcs.lo.max(0.0), hi: arcs.hi }.or_empty(cosines.is_empty())
    }

    /// The arcs, in radians, of the tangents.
    pub fn atan(self) -> Interval {
        self.increasing(atan)
    }

    /// Angles from the x axis to points `(x, y)`, in radians from -pi to pi, `self` being `y`.
    pub fn atan2(self, x: Interval) -> Interval {
        let y = self;
        if y.is_empty() || x.is_empty() {
            return Interval::EMPTY;
        }
        let all = Interval { lo: -PI, hi: PI }.widened(LIBM_PLACES);
        let around_origin = x.contains(0.0) && y.contains(0.0);
        if around_origin || (x.lo < 0.0 && y.lo <= 0.0 && y.hi >= 0.0) {
            return all;
        }
        // The box does not meet the cut, so the extreme angles are at corners.
        let corners = [(y.lo, x.lo), (y.lo, x.hi), (y.hi, x.lo), (y.hi, x.hi)];
        let angles = corners.map(|(y, x)| Interval::point(atan2(y, x)));
        angles.into_iter().fold(Interval::EMPTY, Interval::hull).widened(LIBM_PLACES).intersection(all)
    }

    /// The powers with an exponent that is one number, as `pow` of C has them: of negative numbers only where the
    /// exponent is whole.
    pub fn power(self, exponent: f64) -> Interval {
        if self.is_empty() || exponent.is_nan() {
            return Interval::EMPTY;
        }
        if exponent == 0.0 {
            return Interval::ONE;
        }
        if exponent < 0.0 {
            return Interval::ONE / self.power(-exponent);
        }
        let whole = exponent.floor() == exponent;
        if !whole {
            return Interval::new(self.lo.max(0.0), self.hi).increasing(|x| pow(x, exponent)).at_least_zero();
        }
        // Whole numbers from 2^53 on are even, so the halves below are exact.
        if (0.5 * exponent).floor() == 0.5 * exponent {
            self.abs().increasing(|x| pow(x, exponent)).at_least_zero()
        } else {
            self.increasing(|x| pow(x, exponent))
        }
    }

    fn at_least_zero(self) -> Interval {
        Interval { lo: if self.is_empty() { self.lo } else { self.lo.max(0.0) }, hi: self.hi }
    }

    /// The powers of positive numbers with any exponents of an interval, and of zero with positive ones.
    pub fn pow(self, exponents: Interval) -> Interval {
        if exponents.is_point() {
            return self.power(exponents.lo);
        }
        let base = self.intersection(Interval { lo: 0.0, hi: f64::INFINITY });
        if base.is_empty() || exponents.is_empty() {
            return Interval::EMPTY;
        }
        // Monotone in each argument on either side of 1 and 0: the extremes are at corners.
        let corners = [base.lo, base.hi].map(|b| [exponents.lo, exponents.hi].map(|e| pow(b, e)));
        let ends = corners.as_flattened().iter().map(|&p| Interval::point(p));
        let mut hull = ends.fold(Interval::EMPTY, Interval::hull).widened(LIBM_PLACES).at_least_zero();
        if base.lo == 0.0 && exponents.lo <= 0.0 {
            hull.hi = f64::INFINITY;
        }
        if base.lo == 0.0 {
            hull.lo = 0.0;
        }
        hull
    }

    /// The greatest whole numbers not above.
    #[inline]
    pub fn floor(self) -> Interval {
        Interval { lo: self.lo.floor(), hi: self.hi.floor() }
    }

    /// The least whole numbers not below.
    #[inline]
    pub fn ceil(self) -> Interval {
        Interval { lo: self.lo.ceil(), hi: self.hi.ceil() }
    }

    /// The nearest whole numbers, halves away from zero.
    #[inline]
    pub fn round(self) -> Interval {
        Interval { lo: self.lo.round(), hi: self.hi.round() }
    }

    /// The least remainders that are not negative, as `f64::rem_euclid` has them.
    pub fn rem_euclid(self, divisor: Interval) -> Interval {
        if self.is_empty() || divisor.is_empty() || (divisor.lo == 0.0 && divisor.hi == 0.0) {
            return Interval::EMPTY;
        }
        let most = Interval { lo: 0.0, hi: divisor.magnitude() };
        if !divisor.is_point() || !self.is_bounded() {
            return most;
        }
        let step = divisor.lo.abs();
        let (first, last) = ((self.lo / step).floor(), (self.hi / step).floor());
        let (lo, hi) = (self.lo.rem_euclid(step), self.hi.rem_euclid(step));
        // The remainder is exact but for its last rounding of a small negative number to the step itself.
        if first == last && lo <= hi && self.width() < step {
            Interval { lo, hi }.widened(1).intersection(most)
        } else {
            most
        }
    }

    /// A function of the `libm` crate that does not fall.
    #[inline]
    fn increasing(self, f: impl Fn(f64) -> f64) -> Interval {
        let ends = Interval { lo: f(self.lo), hi: f(self.hi) };
        // Nearly all such functions are exact at zero.
        let wide = ends.widened(LIBM_PLACES);
        let exact = |x: f64, end: f64, wide: f64| if x == 0.0 && end == 0.0 { 0.0 } else { wide };
        Interval { lo: exact(self.lo, ends.lo, wide.lo), hi: exact(self.hi, ends.hi, wide.hi) }
            .or_empty(self.is_empty())
    }
}

/// The sum rounded down.
#[inline]
fn sum_down(a: f64, b: f64) -> f64 {
    let (sum, error) = two_sum(a, b);
    if error >= 0.0 { sum } else { sum.next_down() }
}

/// The sum rounded up.
#[inline]
fn sum_up(a: f64, b: f64) -> f64 {
    let (sum, error) = two_sum(a, b);
    if error <= 0.0 { sum } else { sum.next_up() }
}

/// The rounded sum and its error (Knuth 1969); the error of an infinite sum is NaN.
#[inline]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The product rounded down, where zero times infinity is zero.
#[inline]
fn product_down(a: f64, b: f64) -> f64 {
    let product = a * b;
    let vanishes = product == 0.0 && product.is_sign_positive();
    if a == 0.0 || b == 0.0 || vanishes { 0.0 } else { product.next_down() }
}

/// The product rounded up, where zero times infinity is zero.
#[inline]
fn product_up(a: f64, b: f64) -> f64 {
    -product_down(a, -b)
}

impl From<f64> for Interval {
    fn from(x: f64) -> Interval {
        Interval::point(x)
    }
}

impl Neg for Interval {
    type Output = Interval;

    #[inline]
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}

impl Add for Interval {
    type Output = Interval;

    #[inline]
    fn add(self, other: Interval) -> Interval {
        Interval { lo: sum_down(self.lo, other.lo), hi: sum_up(self.hi, other.hi) }
    }
}

impl Sub for Interval {
    type Output = Interval;

    #[inline]
    fn sub(self, other: Interval) -> Interval {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Interval;

    #[inline]
    fn mul(self, other: Interval) -> Interval {
        let (a, b) = (self, other);
        if a.lo >= 0.0 && b.lo >= 0.0 {
            return Interval { lo: product_down(a.lo, b.lo), hi: product_up(a.hi, b.hi) };
        }
        if a.is_empty() || b.is_empty() {
            return Interval::EMPTY;
        }
        let pairs = [(a.lo, b.lo), (a.lo, b.hi), (a.hi, b.lo), (a.hi, b.hi)];
        let lo = pairs.iter().fold(f64::INFINITY, |least, &(a, b)| least.min(product_down(a, b)));
        let hi = pairs.iter().fold(f64::NEG_INFINITY, |most, &(a, b)| most.max(product_up(a, b)));
        Interval { lo, hi }
    }
}

impl Div for Interval {
    type Output = Interval;

    /// Quotients by what is not zero.
    #[inline]
    fn div(self, other: Interval) -> Interval {
        let (a, b) = (self, other);
        if a.is_empty() || b.is_empty() || (b.lo == 0.0 && b.hi == 0.0) {
            return Interval::EMPTY;
        }
        if b.hi < 0.0 || (b.hi == 0.0 && b.lo < 0.0) {
            return -(a / -b);
        }
        if b.lo < 0.0 {
            return if a == Interval::ZERO { a } else { Interval::ENTIRE };
        }
        // The divisor is positive but for a zero at its lower end.
        let lo = if a.lo >= 0.0 { quotient_down(a.lo, b.hi) } else { quotient_down(a.lo, b.lo) };
        let hi = if a.hi <= 0.0 { -quotient_down(-a.hi, b.hi) } else { -quotient_down(-a.hi, b.lo) };
        Interval { lo, hi }
    }
}

/// The quotient by a number that is not negative, rounded down; by zero it is infinite.
#[inline]
fn quotient_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || (a > 0.0 && b == f64::INFINITY) {
        0.0
    } else if b == 0.0 {
        if a > 0.0 { f64::INFINITY } else { f64::NEG_INFINITY }
    } else if b == f64::INFINITY {
        // An infinite dividend over an infinite divisor is anything.
        if a == f64::NEG_INFINITY { a } else { -f64::MIN_POSITIVE }
    } else {
        let quotient = a / b;
        if quotient == 0.0 && a > 0.0 { 0.0 } else { quotient.next_down() }
    }
}
