//! Double-double arithmetic: a number as the unevaluated sum of two `f64`, about 106 bits.
//!
//! Dekker, A floating-point technique for extending the available precision, 1971; Joldes, Muller, Popescu, Tight and
//! rigorous error bounds for basic building blocks of double-word arithmetic, 2017. No fused multiply-add is used, so
//! that every platform gives the same bits; the exact product splits its factors and needs them below 2^996.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The sum `hi + lo`, with `lo` at most half a last place of `hi`.
///
/// Sums and products have a relative error of at most [`DoubleDouble::EPSILON`] unless the result under- or overflows.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    /// The nearest `f64`.
    pub hi: f64,
    /// What is left.
    pub lo: f64,
}

/// The rounded sum and its error: `a + b == sum + error` exactly (Knuth 1969).
#[inline]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// As [`two_sum`], where `a` is zero or not smaller than `b` in magnitude.
#[inline]
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The rounded product and its error: `a * b == product + error` exactly (Dekker 1971), where nothing under- or
/// overflows and both factors are below 2^996.
#[inline]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

/// Two numbers of 26 bits whose sum is `a` (Veltkamp 1968).
#[inline]
fn halves(a: f64) -> (f64, f64) {
    let scaled = 134_217_729.0 * a; // 2^27 + 1
    let high = scaled - (scaled - a);
    (high, a - high)
}

impl DoubleDouble {
    /// Bound of the relative error of one sum, product or quotient: 2^-102.
    pub const EPSILON: f64 = 1.0 / ((1_u128 << 102) as f64);
    /// Zero.
    pub const ZERO: DoubleDouble = DoubleDouble { hi: 0.0, lo: 0.0 };

    /// The exact difference of two `f64`.
    #[inline]
    pub fn difference(a: f64, b: f64) -> DoubleDouble {
        let (hi, lo) = two_sum(a, -b);
        DoubleDouble { hi, lo }
    }

    /// The exact product of two `f64`.
    #[inline]
    pub fn product(a: f64, b: f64) -> DoubleDouble {
        let (hi, lo) = two_product(a, b);
        DoubleDouble { hi, lo }
    }

    /// The nearest `f64`.
    #[inline]
    pub fn to_f64(self) -> f64 {
        self.hi + self.lo
    }

    /// The magnitude.
    #[inline]
    pub fn abs(self) -> DoubleDouble {
        if self.hi < 0.0 || (self.hi == 0.0 && self.lo < 0.0) { -self } else { self }
    }

    /// The square root; of a negative number NaN.
    pub fn sqrt(self) -> DoubleDouble {
        if self.hi == 0.0 {
            return self;
        }
        // One Newton step from the rounded root doubles its digits.
        let root = self.hi.sqrt();
        let rest = self - DoubleDouble::product(root, root);
        DoubleDouble::from(root) + DoubleDouble::from(rest.hi / (2.0 * root))
    }
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(hi: f64) -> DoubleDouble {
        DoubleDouble { hi, lo: 0.0 }
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn neg(self) -> DoubleDouble {
        DoubleDouble { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (high, high_rest) = two_sum(self.hi, other.hi);
        let (low, low_rest) = two_sum(self.lo, other.lo);
        let (high, rest) = quick_two_sum(high, high_rest + low);
        let (hi, lo) = quick_two_sum(high, rest + low_rest);
        DoubleDouble { hi, lo }
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        let (high, rest) = two_product(self.hi, other.hi);
        let (hi, lo) = quick_two_sum(high, rest + (self.hi * other.lo + self.lo * other.hi));
        DoubleDouble { hi, lo }
    }
}

impl Mul<f64> for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn mul(self, other: f64) -> DoubleDouble {
        let (high, rest) = two_product(self.hi, other);
        let (hi, lo) = quick_two_sum(high, rest + self.lo * other);
        DoubleDouble { hi, lo }
    }
}

impl Div for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn div(self, other: DoubleDouble) -> DoubleDouble {
        let first = self.hi / other.hi;
        let rest = self - other * first;
        let second = rest.hi / other.hi;
        let rest = rest - other * second;
        let (hi, lo) = quick_two_sum(first, second);
        DoubleDouble { hi, lo } + DoubleDouble::from(rest.hi / other.hi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::{Signed, ToPrimitive};
    use proptest::prelude::*;

    fn exact(x: DoubleDouble) -> BigRational {
        rational(x.hi) + rational(x.lo)
    }

    fn rational(x: f64) -> BigRational {
        BigRational::from_float(x).expect("finite")
    }

    fn relative(got: DoubleDouble, want: &BigRational) -> f64 {
        let off = (exact(got) - want).abs();
        if *want == rational(0.0) { off.to_f64().unwrap() } else { (off / want.abs()).to_f64().unwrap() }
    }

    proptest! {
        #[test]
        fn errors_stay_below_epsilon(
            a in -1e6..1e6_f64, b in -1e6..1e6_f64, c in -1e-9..1e-9_f64, d in 1e-12..1e-9_f64,
        ) {
            let x = DoubleDouble::difference(a, c);
            let y = DoubleDouble::difference(b, d);
            prop_assert_eq!(exact(x), rational(a) - rational(c));
            prop_assert_eq!(exact(DoubleDouble::product(a, b)), rational(a) * rational(b));
            prop_assert!(relative(x + y, &(exact(x) + exact(y))) <= DoubleDouble::EPSILON);
            prop_assert!(relative(x * y, &(exact(x) * exact(y))) <= DoubleDouble::EPSILON);
            prop_assert!(relative(x * b, &(exact(x) * rational(b))) <= DoubleDouble::EPSILON);
            prop_assume!(y.hi.abs() > 1e-3);
            prop_assert!(relative(x / y, &(exact(x) / exact(y))) <= DoubleDouble::EPSILON);
            let root = y.abs().sqrt();
            prop_assert!(relative(root * root, &exact(y.abs())) <= 4.0 * DoubleDouble::EPSILON);
        }
    }
}
