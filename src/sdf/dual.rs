//! Forward-mode derivatives: a number and its slopes along three axes (Wengert 1964).

use super::real::Real;
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its three partial derivatives. The value has the bits that `T` alone gives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dual<T> {
    pub(super) value: T,
    pub(super) slope: [T; 3],
}

impl<T: Real> Dual<T> {
    /// A constant.
    #[inline]
    pub(super) fn constant(value: T) -> Dual<T> {
        Dual { value, slope: [T::of(0.0); 3] }
    }

    /// The coordinate along an axis.
    #[inline]
    pub(super) fn variable(value: T, axis: usize) -> Dual<T> {
        Dual { value, slope: from_fn(|i| T::of(f64::from(u8::from(i == axis)))) }
    }

    /// A function of this number, by the chain rule.
    #[inline]
    fn chain(self, value: T, derivative: T) -> Dual<T> {
        let derivative = derivative.as_slope();
        Dual { value, slope: self.slope.map(|s| derivative * s) }
    }

    /// A function of two numbers, by the chain rule.
    #[inline]
    fn chain2(self, other: Dual<T>, value: T, by_self: T, by_other: T) -> Dual<T> {
        let (by_self, by_other) = (by_self.as_slope(), by_other.as_slope());
        Dual { value, slope: from_fn(|i| by_self * self.slope[i] + by_other * other.slope[i]) }
    }

    /// A function of a vector, by the chain rule.
    #[inline]
    pub(super) fn of_gradient<const N: usize>(value: T, gradient: [T; N], inner: [Dual<T>; N]) -> Dual<T> {
        let along = |axis: usize| {
            (1..N).fold(gradient[0] * inner[0].slope[axis], |sum, i| sum + gradient[i] * inner[i].slope[axis])
        };
        Dual { value, slope: from_fn(along) }
    }
}

impl<T: Real> Neg for Dual<T> {
    type Output = Dual<T>;

    #[inline]
    fn neg(self) -> Dual<T> {
        Dual { value: -self.value, slope: self.slope.map(|s| -s) }
    }
}

impl<T: Real> Add for Dual<T> {
    type Output = Dual<T>;

    #[inline]
    fn add(self, other: Dual<T>) -> Dual<T> {
        Dual { value: self.value + other.value, slope: from_fn(|i| self.slope[i] + other.slope[i]) }
    }
}

impl<T: Real> Sub for Dual<T> {
    type Output = Dual<T>;

    #[inline]
    fn sub(self, other: Dual<T>) -> Dual<T> {
        Dual { value: self.value - other.value, slope: from_fn(|i| self.slope[i] - other.slope[i]) }
    }
}

impl<T: Real> Mul for Dual<T> {
    type Output = Dual<T>;

    #[inline]
    fn mul(self, other: Dual<T>) -> Dual<T> {
        self.chain2(other, self.value * other.value, other.value, self.value)
    }
}

impl<T: Real> Div for Dual<T> {
    type Output = Dual<T>;

    #[inline]
    fn div(self, other: Dual<T>) -> Dual<T> {
        let quotient = self.value / other.value;
        self.chain2(other, quotient, other.value.recip(), -quotient / other.value)
    }
}

impl<T: Real> Real for Dual<T> {
    #[inline]
    fn of(x: f64) -> Dual<T> {
        Dual::constant(T::of(x))
    }

    #[inline]
    fn abs(self) -> Dual<T> {
        let slope = self.slope.map(|s| self.value.sided(-s, s));
        Dual { value: self.value.abs(), slope }
    }

    #[inline]
    fn square(self) -> Dual<T> {
        self.chain(self.value.square(), self.value + self.value)
    }

    #[inline]
    fn sqrt(self) -> Dual<T> {
        let root = self.value.sqrt();
        self.chain(root, T::slope_of_root(root))
    }

    fn cbrt(self) -> Dual<T> {
        let root = self.value.cbrt();
        self.chain(root, (T::of(3.0) * root.square()).recip())
    }

    #[inline]
    fn recip(self) -> Dual<T> {
        let value = self.value.recip();
        self.chain(value, -value.square())
    }

    fn floor(self) -> Dual<T> {
        Dual::constant(self.value.floor())
    }

    fn ceil(self) -> Dual<T> {
        Dual::constant(self.value.ceil())
    }

    fn round(self) -> Dual<T> {
        Dual::constant(self.value.round())
    }

    fn sin(self) -> Dual<T> {
        self.chain(self.value.sin(), self.value.cos())
    }

    fn cos(self) -> Dual<T> {
        self.chain(self.value.cos(), -self.value.sin())
    }

    fn tan(self) -> Dual<T> {
        let tangent = self.value.tan();
        self.chain(tangent, T::of(1.0) + tangent.square())
    }

    fn asin(self) -> Dual<T> {
        self.chain(self.value.asin(), (T::of(1.0) - self.value.square()).sqrt().recip())
    }

    fn acos(self) -> Dual<T> {
        self.chain(self.value.acos(), -(T::of(1.0) - self.value.square()).sqrt().recip())
    }

    fn atan(self) -> Dual<T> {
        self.chain(self.value.atan(), (T::of(1.0) + self.value.square()).recip())
    }

    fn exp(self) -> Dual<T> {
        let value = self.value.exp();
        self.chain(value, value)
    }

    fn ln(self) -> Dual<T> {
        self.chain(self.value.ln(), self.value.recip())
    }

    fn not(self) -> Dual<T> {
        Dual::constant(self.value.not())
    }

    fn atan2(self, x: Dual<T>) -> Dual<T> {
        let square = self.value.square() + x.value.square();
        self.chain2(x, self.value.atan2(x.value), x.value / square, -self.value / square)
    }

    #[inline]
    fn min(self, other: Dual<T>) -> Dual<T> {
        let difference = self.value - other.value;
        let slope = from_fn(|i| difference.sided(self.slope[i], other.slope[i]));
        Dual { value: self.value.min(other.value), slope }
    }

    #[inline]
    fn max(self, other: Dual<T>) -> Dual<T> {
        let difference = other.value - self.value;
        let slope = from_fn(|i| difference.sided(self.slope[i], other.slope[i]));
        Dual { value: self.value.max(other.value), slope }
    }

    fn compare(self, other: Dual<T>) -> Dual<T> {
        Dual::constant(self.value.compare(other.value))
    }

    fn modulo(self, divisor: Dual<T>) -> Dual<T> {
        let value = self.value.modulo(divisor.value);
        let turns = ((self.value - value) / divisor.value).round();
        Dual { value, slope: from_fn(|i| self.slope[i] - turns * divisor.slope[i]) }
    }

    fn pow(self, exponent: Dual<T>) -> Dual<T> {
        let (x, e) = (self.value, exponent.value);
        let value = x.pow(e);
        self.chain2(exponent, value, e * x.pow(e - T::of(1.0)), value * x.ln())
    }

    fn power(self, exponent: f64) -> Dual<T> {
        let slope =
            if exponent == 0.0 { T::of(0.0) } else { T::of(exponent) * self.value.power(exponent - 1.0) };
        self.chain(self.value.power(exponent), slope)
    }

    fn and(self, other: Dual<T>) -> Dual<T> {
        let value = self.value.and(other.value);
        Dual { value, slope: from_fn(|i| self.value.switched(self.slope[i], other.slope[i])) }
    }

    fn or(self, other: Dual<T>) -> Dual<T> {
        let value = self.value.or(other.value);
        Dual { value, slope: from_fn(|i| self.value.switched(other.slope[i], self.slope[i])) }
    }

    fn select(self, negative: Dual<T>, otherwise: Dual<T>) -> Dual<T> {
        let value = self.value.select(negative.value, otherwise.value);
        Dual { value, slope: from_fn(|i| self.value.sided(negative.slope[i], otherwise.slope[i])) }
    }

    #[inline]
    fn norm<const N: usize>(v: [Dual<T>; N]) -> Dual<T> {
        let values = v.map(|x| x.value);
        Dual::of_gradient(T::norm(values), T::direction(values), v)
    }

    #[inline]
    fn corner<const N: usize>(q: [Dual<T>; N]) -> Dual<T> {
        let values = q.map(|x| x.value);
        Dual::of_gradient(T::corner(values), T::corner_slopes(values), q)
    }

    fn spliced(self, negative: Dual<T>, otherwise: Dual<T>) -> Dual<T> {
        let value = self.value.spliced(negative.value, otherwise.value);
        Dual { value, slope: from_fn(|i| self.value.select(negative.slope[i], otherwise.slope[i])) }
    }

    fn sided(self, negative: Dual<T>, otherwise: Dual<T>) -> Dual<T> {
        let value = self.value.sided(negative.value, otherwise.value);
        Dual { value, slope: from_fn(|i| self.value.sided(negative.slope[i], otherwise.slope[i])) }
    }

    fn switched(self, zero: Dual<T>, otherwise: Dual<T>) -> Dual<T> {
        let value = self.value.switched(zero.value, otherwise.value);
        Dual { value, slope: from_fn(|i| self.value.switched(zero.slope[i], otherwise.slope[i])) }
    }

    fn as_slope(self) -> Dual<T> {
        Dual { value: self.value.as_slope(), slope: self.slope.map(T::as_slope) }
    }

    fn is_certain(self) -> bool {
        self.value.is_certain()
    }

    fn direction<const N: usize>(v: [Dual<T>; N]) -> [Dual<T>; N] {
        Dual::turned(T::direction(v.map(|x| x.value)), v)
    }

    fn corner_slopes<const N: usize>(q: [Dual<T>; N]) -> [Dual<T>; N] {
        let unit = T::corner_slopes(q.map(|x| x.value));
        if unit.iter().all(|u| u.is_certain()) {
            return unit.map(Dual::constant);
        }
        Dual::turned(unit, q.map(|x| x.max(Dual::of(0.0))))
    }
}

impl<T: Real> Dual<T> {
    /// The unit vector along `v`, given its value, with the slopes of the quotient: what is across `v`, by its norm.
    fn turned<const N: usize>(unit: [T; N], v: [Dual<T>; N]) -> [Dual<T>; N] {
        let norm = T::norm(v.map(|x| x.value));
        let along: [T; 3] = from_fn(|axis| {
            (1..N).fold(unit[0] * v[0].slope[axis], |sum, i| sum + unit[i] * v[i].slope[axis])
        });
        from_fn(|i| {
            let slope = from_fn(|axis| (v[i].slope[axis] - unit[i] * along[axis]) / norm);
            Dual { value: unit[i], slope }
        })
    }
}
