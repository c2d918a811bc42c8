//! What every kind of number can do that a formula is evaluated with: plain numbers, lanes of eight, ranges, duals of
//! these, and symbols. A primitive is written once, generically; `f64` is the definition the others agree with.

use crate::math;
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Arithmetic that formulas are made of. Every kind does the same operations in the same order, so that lanes and
/// the values of duals have the bits of `f64`.
pub(super) trait Real:
    Copy + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A constant.
    fn of(x: f64) -> Self;
    fn abs(self) -> Self;
    fn square(self) -> Self;
    fn sqrt(self) -> Self;
    fn cbrt(self) -> Self;
    fn recip(self) -> Self;
    fn floor(self) -> Self;
    fn ceil(self) -> Self;
    /// Halves go away from zero.
    fn round(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn tan(self) -> Self;
    fn asin(self) -> Self;
    fn acos(self) -> Self;
    fn atan(self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    /// 1 for zero, otherwise 0.
    fn not(self) -> Self;
    /// The angle of the point (x, self).
    fn atan2(self, x: Self) -> Self;
    /// NaN when either is.
    fn min(self, other: Self) -> Self;
    /// NaN when either is.
    fn max(self, other: Self) -> Self;
    /// -1, 0 or 1 as it is less than, equal to or greater than the other; NaN when either is.
    fn compare(self, other: Self) -> Self;
    /// The least remainder that is not negative.
    fn modulo(self, divisor: Self) -> Self;
    fn pow(self, exponent: Self) -> Self;
    /// To the power of a constant.
    fn power(self, exponent: f64) -> Self;
    /// This one where it is zero, otherwise the other.
    fn and(self, other: Self) -> Self;
    /// This one where it is not zero, otherwise the other.
    fn or(self, other: Self) -> Self;
    /// `negative` where this one is below zero, otherwise the other. Both must agree where this one is zero.
    fn select(self, negative: Self, otherwise: Self) -> Self;

    /// As [`Real::select`], where the first derivatives agree too.
    fn spliced(self, negative: Self, otherwise: Self) -> Self {
        self.select(negative, otherwise)
    }
    /// As [`Real::select`], for what may jump where this one is zero, as slopes do at a kink.
    fn sided(self, negative: Self, otherwise: Self) -> Self;
    /// The first where this one is zero, otherwise the second; what is chosen may jump.
    fn switched(self, zero: Self, otherwise: Self) -> Self;
    /// The same; a range without any number, which as a slope says nothing, becomes that of all numbers.
    fn as_slope(self) -> Self {
        self
    }
    /// Whether it is known to be one number.
    fn is_certain(self) -> bool;

    /// The derivative of the square root, given the root. At zero plain numbers take it for zero, so that a norm that
    /// is written out has a gradient there.
    fn slope_of_root(root: Self) -> Self {
        Self::of(0.5) / root
    }

    /// The Euclidean norm; its derivatives at zero are taken for zero.
    #[inline(always)]
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        sum_of_squares(v).sqrt()
    }

    /// The vector divided by its norm; zero where that is zero.
    fn direction<const N: usize>(v: [Self; N]) -> [Self; N] {
        let norm = Self::norm(v);
        v.map(|x| x / norm)
    }

    /// The exact distance from the orthant where all `q` are negative or zero: Euclidean outside of it, minus the least
    /// distance to a face inside.
    #[inline(always)]
    fn corner<const N: usize>(q: [Self; N]) -> Self {
        let zero = Self::of(0.0);
        let (mut most, mut outside) = (q[0], q);
        for &x in &q[1..] {
            most = most.max(x);
        }
        for x in &mut outside {
            *x = x.max(zero);
        }
        Self::norm(outside) + most.min(zero)
    }

    /// The partial derivatives of [`Real::corner`]; where two faces inside are equally near, those of the first.
    fn corner_slopes<const N: usize>(q: [Self; N]) -> [Self; N] {
        let (zero, one) = (Self::of(0.0), Self::of(1.0));
        let most = q.into_iter().reduce(Self::max).unwrap_or(zero);
        let outside = Self::direction(q.map(|x| x.max(zero)));
        from_fn(|i| {
            let earlier = (0..i).fold(one, |slope, j| (q[j] - q[i]).sided(slope, zero));
            let inside = (i + 1..N).fold(earlier, |slope, j| (q[i] - q[j]).sided(zero, slope));
            (-most).sided(outside[i], inside)
        })
    }
}

/// The sum of the squares, from the first to the last. Plain loops: arrays of lanes are too large for `map` to be inlined.
#[inline(always)]
pub(super) fn sum_of_squares<T: Real, const N: usize>(v: [T; N]) -> T {
    let mut sum = v[0].square();
    for x in &v[1..] {
        sum = sum + x.square();
    }
    sum
}

impl Real for f64 {
    #[inline]
    fn of(x: f64) -> f64 {
        x
    }

    #[inline]
    fn abs(self) -> f64 {
        f64::abs(self)
    }

    #[inline]
    fn square(self) -> f64 {
        self * self
    }

    #[inline]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    fn cbrt(self) -> f64 {
        math::cbrt(self)
    }

    #[inline]
    fn recip(self) -> f64 {
        1.0 / self
    }

    #[inline]
    fn floor(self) -> f64 {
        f64::floor(self)
    }

    #[inline]
    fn ceil(self) -> f64 {
        f64::ceil(self)
    }

    #[inline]
    fn round(self) -> f64 {
        f64::round(self)
    }

    fn sin(self) -> f64 {
        math::sin(self)
    }

    fn cos(self) -> f64 {
        math::cos(self)
    }

    fn tan(self) -> f64 {
        math::tan(self)
    }

    fn asin(self) -> f64 {
        math::asin(self)
    }

    fn acos(self) -> f64 {
        math::acos(self)
    }

    fn atan(self) -> f64 {
        math::atan(self)
    }

    fn exp(self) -> f64 {
        math::exp(self)
    }

    fn ln(self) -> f64 {
        math::ln(self)
    }

    #[inline]
    fn not(self) -> f64 {
        f64::from(self == 0.0)
    }

    fn atan2(self, x: f64) -> f64 {
        math::atan2(self, x)
    }

    #[inline]
    fn min(self, other: f64) -> f64 {
        // One choice without a branch becomes vector instructions.
        if (self < other) | self.is_nan() { self } else { other }
    }

    #[inline]
    fn max(self, other: f64) -> f64 {
        if (self > other) | self.is_nan() { self } else { other }
    }

    #[inline]
    fn compare(self, other: f64) -> f64 {
        let sign = f64::from(self > other) - f64::from(self < other);
        if self.is_nan() || other.is_nan() { f64::NAN } else { sign }
    }

    #[inline]
    fn modulo(self, divisor: f64) -> f64 {
        self.rem_euclid(divisor)
    }

    fn pow(self, exponent: f64) -> f64 {
        math::pow(self, exponent)
    }

    fn power(self, exponent: f64) -> f64 {
        math::pow(self, exponent)
    }

    #[inline]
    fn and(self, other: f64) -> f64 {
        if self == 0.0 { self } else { other }
    }

    #[inline]
    fn or(self, other: f64) -> f64 {
        if self != 0.0 { self } else { other }
    }

    #[inline]
    fn select(self, negative: f64, otherwise: f64) -> f64 {
        if self < 0.0 { negative } else { otherwise }
    }

    #[inline]
    fn sided(self, negative: f64, otherwise: f64) -> f64 {
        self.select(negative, otherwise)
    }

    #[inline]
    fn switched(self, zero: f64, otherwise: f64) -> f64 {
        if self == 0.0 { zero } else { otherwise }
    }

    #[inline]
    fn is_certain(self) -> bool {
        true
    }

    #[inline]
    fn slope_of_root(root: f64) -> f64 {
        if root == 0.0 { 0.0 } else { 0.5 / root }
    }

    #[inline]
    fn direction<const N: usize>(v: [f64; N]) -> [f64; N] {
        let norm = Self::norm(v);
        if norm == 0.0 { [0.0; N] } else { v.map(|x| x / norm) }
    }
}

/// Numbers in a batch that are computed side by side.
pub(super) const LANES: usize = 8;

/// Eight numbers; every operation is a loop that compilers turn into vector instructions.
#[derive(Clone, Copy)]
pub(super) struct Lanes(pub(super) [f64; LANES]);

impl Lanes {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Lanes {
        Lanes(from_fn(|i| f(self.0[i])))
    }

    #[inline(always)]
    fn zip(self, other: Lanes, f: impl Fn(f64, f64) -> f64) -> Lanes {
        Lanes(from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Neg for Lanes {
    type Output = Lanes;

    #[inline(always)]
    fn neg(self) -> Lanes {
        self.map(|x| -x)
    }
}

macro_rules! lanewise_operators {
    ($($name:ident $method:ident $operator:tt),*) => {$(
        impl $name for Lanes {
            type Output = Lanes;

            #[inline(always)]
            fn $method(self, other: Lanes) -> Lanes {
                self.zip(other, |a, b| a $operator b)
            }
        }
    )*};
}

lanewise_operators!(Add add +, Sub sub -, Mul mul *, Div div /);

macro_rules! lanewise {
    (unary: $($unary:ident)*; binary: $($binary:ident)*) => {
        $(
            #[inline(always)]
            fn $unary(self) -> Lanes {
                self.map(<f64 as Real>::$unary)
            }
        )*
        $(
            #[inline(always)]
            fn $binary(self, other: Lanes) -> Lanes {
                self.zip(other, <f64 as Real>::$binary)
            }
        )*
    };
}

impl Real for Lanes {
    lanewise! {
        unary: abs square sqrt cbrt recip floor ceil round sin cos tan asin acos atan exp ln not;
        binary: atan2 min max compare modulo pow and or
    }

    #[inline(always)]
    fn of(x: f64) -> Lanes {
        Lanes([x; LANES])
    }

    #[inline(always)]
    fn power(self, exponent: f64) -> Lanes {
        self.map(|x| Real::power(x, exponent))
    }

    #[inline(always)]
    fn select(self, negative: Lanes, otherwise: Lanes) -> Lanes {
        Lanes(from_fn(|i| self.0[i].select(negative.0[i], otherwise.0[i])))
    }

    #[inline(always)]
    fn sided(self, negative: Lanes, otherwise: Lanes) -> Lanes {
        self.select(negative, otherwise)
    }

    #[inline(always)]
    fn switched(self, zero: Lanes, otherwise: Lanes) -> Lanes {
        Lanes(from_fn(|i| self.0[i].switched(zero.0[i], otherwise.0[i])))
    }

    #[inline(always)]
    fn is_certain(self) -> bool {
        true
    }

    #[inline(always)]
    fn slope_of_root(root: Lanes) -> Lanes {
        root.map(f64::slope_of_root)
    }

    #[inline(always)]
    fn direction<const N: usize>(v: [Lanes; N]) -> [Lanes; N] {
        let norm = Self::norm(v);
        v.map(|x| x.zip(norm, |x, n| if n == 0.0 { 0.0 } else { x / n }))
    }
}
