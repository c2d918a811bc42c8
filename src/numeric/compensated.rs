//! Sums and products whose rounding errors are carried along.
//!
//! A [`DoubleDouble`] is an unevaluated sum of two `f64` and has at least 106 significant bits: enough to add up
//! millions of terms that nearly cancel and to round once, at the end.
//!
//! Algorithms and bounds: M. Joldes, J.-M. Muller, V. Popescu, *Tight and rigorous error bounds for basic building
//! blocks of double-word arithmetic*, ACM TOMS 44 (2017). Below, `u` is 2⁻⁵³.

use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The sum of `terms`, as if taken in [`DoubleDouble`] and rounded once.
///
/// For `n` terms the error is at most `u |sum| + 3 n u² Σ|term|`. Sums that overflow are not finite.
pub fn sum(terms: impl IntoIterator<Item = f64>) -> f64 {
    terms.into_iter().map(DoubleDouble::from).sum::<DoubleDouble>().to_f64()
}

/// `high + low`, exactly, with `high` the `f64` nearest to it.
///
/// Products need factors below 2⁹⁹⁵ and results above 2⁻⁹⁶⁹ in size, or their last bits are lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// Zero.
    pub const ZERO: DoubleDouble = DoubleDouble { high: 0.0, low: 0.0 };

    /// `a - b` without error.
    pub fn difference(a: f64, b: f64) -> DoubleDouble {
        two_sum(a, -b)
    }

    /// `a * b` without error.
    pub fn product(a: f64, b: f64) -> DoubleDouble {
        let high = a * b;
        let ([a1, a2], [b1, b2]) = (split(a), split(b));
        DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
    }

    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.high
    }
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> DoubleDouble {
        DoubleDouble { high: value, low: 0.0 }
    }
}

/// Relative error at most 3u² / (1 - 4u).
impl Add for DoubleDouble {
    type Output = DoubleDouble;

    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let high = two_sum(self.high, other.high);
        let low = two_sum(self.low, other.low);
        let carried = quick_two_sum(high.high, high.low + low.high);
        quick_two_sum(carried.high, carried.low + low.low)
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;

    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + -other
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;

    fn neg(self) -> DoubleDouble {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

/// Relative error at most 7u².
impl Mul for DoubleDouble {
    type Output = DoubleDouble;

    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        let high = DoubleDouble::product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        quick_two_sum(high.high, high.low + cross)
    }
}

/// Relative error at most 15u².
impl Div for DoubleDouble {
    type Output = DoubleDouble;

    fn div(self, other: DoubleDouble) -> DoubleDouble {
        let quotient = self.high / other.high;
        let rest = self - other * quotient.into();
        quick_two_sum(quotient, rest.high / other.high)
    }
}

impl Sum for DoubleDouble {
    fn sum<I: Iterator<Item = DoubleDouble>>(terms: I) -> DoubleDouble {
        terms.fold(DoubleDouble::ZERO, Add::add)
    }
}

/// `a + b` and its rounding error (Knuth).
fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let b_part = high - a;
    let a_part = high - b_part;
    DoubleDouble { high, low: (a - a_part) + (b - b_part) }
}

/// `a + b` and its rounding error, for `|a| >= |b|` or `a` zero (Dekker).
fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// Two halves of at most 26 bits each whose sum is `a` (Veltkamp).
fn split(a: f64) -> [f64; 2] {
    const SHIFT: f64 = 134_217_729.0; // 2²⁷ + 1
    let shifted = SHIFT * a;
    let high = shifted - (shifted - a);
    [high, a - high]
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::{Signed, ToPrimitive, Zero};
    use proptest::prelude::*;

    fn exact(value: f64) -> BigRational {
        BigRational::from_float(value).expect("finite")
    }

    fn value(x: DoubleDouble) -> BigRational {
        exact(x.high) + exact(x.low)
    }

    /// Numbers of very different sizes, some of them nearly equal to others.
    fn number() -> impl Strategy<Value = f64> {
        let spread = (-1.0..1.0_f64, -60..60_i32).prop_map(|(m, e)| m * 2.0_f64.powi(e));
        let near_one = (-4..4_i32).prop_map(|ulps| 1.0 + f64::from(ulps) * f64::EPSILON);
        prop_oneof![spread, near_one]
    }

    fn double_double() -> impl Strategy<Value = DoubleDouble> {
        (number(), -1.0..1.0_f64).prop_map(|(high, m)| two_sum(high, high * m * 0.5 * f64::EPSILON))
    }

    fn assert_within(found: DoubleDouble, expected: &BigRational, u_squared: f64) {
        let bound = expected.abs() * exact(u_squared * f64::EPSILON * f64::EPSILON / 4.0);
        let error = (value(found) - expected).abs();
        assert!(error <= bound, "{found:?}: error {:?}", error.to_f64());
    }

    proptest! {
        #[test]
        fn differences_and_products_are_exact(a in number(), b in number()) {
            prop_assert_eq!(value(DoubleDouble::difference(a, b)), exact(a) - exact(b));
            prop_assert_eq!(value(DoubleDouble::product(a, b)), exact(a) * exact(b));
        }

        #[test]
        fn operations_keep_their_bounds(a in double_double(), b in double_double()) {
            assert_within(a + b, &(value(a) + value(b)), 3.1);
            assert_within(a - b, &(value(a) - value(b)), 3.1);
            assert_within(a * b, &(value(a) * value(b)), 7.0);
            if b.high != 0.0 {
                assert_within(a / b, &(value(a) / value(b)), 15.0);
            }
        }

        #[test]
        fn sums_survive_cancellation(mut terms in prop::collection::vec(number(), 1..40), rest in number()) {
            terms.extend(terms.clone().iter().rev().map(|x| -x));
            terms.push(rest * 2.0_f64.powi(-40));
            let expected = terms.iter().fold(BigRational::zero(), |sum, &x| sum + exact(x));
            let size: f64 = terms.iter().copied().map(f64::abs).sum();
            let error = (exact(sum(terms.iter().copied())) - &expected).abs().to_f64().expect("finite");
            let expected = expected.to_f64().expect("finite").abs();
            prop_assert!(error <= 1.2e-16 * expected + 3.0 * terms.len() as f64 * 1.3e-32 * size);
        }
    }

    #[test]
    fn a_plain_loop_would_lose_this() {
        assert_eq!(sum([1e100, 1.0, -1e100]), 1.0);
        assert_eq!(sum([]), 0.0);
    }
}
