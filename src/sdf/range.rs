use super::real::{Real, sum_of_squares};
use crate::math::Interval;
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What a field's values over a cell are proven to be.
///
/// After IEEE 1788-2015, whose decorations say the same in one word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Holds every value that is a number; empty when there is none.
    pub interval: Interval,
    /// Every point of the cell has a value: none is NaN.
    pub defined: bool,
    /// The values change continuously over the cell.
    pub continuous: bool,
}

impl Range {
    /// Anything at all.
    pub const UNKNOWN: Range = Range { interval: Interval::ENTIRE, defined: false, continuous: false };

    /// Values that are defined everywhere and change continuously.
    #[inline]
    pub fn of(interval: Interval) -> Range {
        Range { interval, defined: true, continuous: true }
    }

    /// Whether the whole cell is inside: every point has a value and it is negative.
    #[inline]
    pub fn is_inside(self) -> bool {
        self.defined && self.interval.hi < 0.0
    }

    /// Whether the whole cell is outside: every point has a value and none is negative.
    #[inline]
    pub fn is_outside(self) -> bool {
        self.defined && self.interval.lo >= 0.0
    }

    /// Whether no point of the cell has a value.
    #[inline]
    pub fn is_undefined(self) -> bool {
        self.interval.is_empty()
    }
}

impl Range {
    /// The same flags, and `so` for being defined.
    #[inline]
    fn with(self, interval: Interval, so: bool) -> Range {
        Range { interval, defined: self.defined && so, ..self }
    }

    /// The same flags, and `so` for being continuous.
    #[inline]
    fn steady(self, interval: Interval, so: bool) -> Range {
        Range { interval, continuous: self.continuous && so, ..self }
    }

    /// The flags of both.
    #[inline]
    fn joined(self, other: Range, interval: Interval) -> Range {
        let defined = self.defined && other.defined;
        Range { interval, defined, continuous: self.continuous && other.continuous }
    }

    /// The values of either.
    #[inline]
    fn either(self, other: Range) -> Range {
        self.joined(other, self.interval.hull(other.interval))
    }

    /// Whether a value may be infinite.
    #[inline]
    fn unbounded(self) -> bool {
        !self.interval.is_bounded()
    }

    fn broken(self) -> Range {
        Range { continuous: false, ..self }
    }
}

impl Neg for Range {
    type Output = Range;

    #[inline]
    fn neg(self) -> Range {
        Range { interval: -self.interval, ..self }
    }
}

impl Add for Range {
    type Output = Range;

    #[inline]
    fn add(self, other: Range) -> Range {
        let (a, b) = (self.interval, other.interval);
        // Infinite numbers of both signs add up to NaN.
        let clash = (a.hi == f64::INFINITY && b.lo == f64::NEG_INFINITY)
            || (a.lo == f64::NEG_INFINITY && b.hi == f64::INFINITY);
        let sum = self.joined(other, a + b);
        sum.with(sum.interval, !clash)
    }
}

impl Sub for Range {
    type Output = Range;

    #[inline]
    fn sub(self, other: Range) -> Range {
        self + -other
    }
}

impl Mul for Range {
    type Output = Range;

    #[inline]
    fn mul(self, other: Range) -> Range {
        let (a, b) = (self.interval, other.interval);
        // Zero times an infinite number is NaN.
        let clash = (self.unbounded() && b.contains(0.0)) || (other.unbounded() && a.contains(0.0));
        let product = self.joined(other, a * b);
        product.with(product.interval, !clash)
    }
}

impl Div for Range {
    type Output = Range;

    #[inline]
    fn div(self, other: Range) -> Range {
        let pole = other.interval.contains(0.0);
        // Numbers divided by a zero of either sign are infinite, and what comes after may make them finite again.
        let interval = if pole { Interval::ENTIRE } else { self.interval / other.interval };
        let quotient = self.joined(other, interval);
        let clash = self.unbounded() && other.unbounded();
        let continuous = quotient.continuous && !pole;
        Range { continuous, ..quotient.with(quotient.interval, !(pole || clash)) }
    }
}

impl Real for Range {
    #[inline]
    fn of(x: f64) -> Range {
        Range { interval: Interval::point(x), defined: !x.is_nan(), continuous: true }
    }

    #[inline]
    fn abs(self) -> Range {
        Range { interval: self.interval.abs(), ..self }
    }

    #[inline]
    fn square(self) -> Range {
        Range { interval: self.interval.square(), ..self }
    }

    #[inline]
    fn sqrt(self) -> Range {
        self.with(self.interval.sqrt(), self.interval.lo >= 0.0)
    }

    fn cbrt(self) -> Range {
        Range { interval: self.interval.cbrt(), ..self }
    }

    #[inline]
    fn recip(self) -> Range {
        Range::of(Interval::ONE) / self
    }

    #[inline]
    fn floor(self) -> Range {
        let steps = self.interval.floor();
        self.steady(steps, steps.is_point())
    }

    #[inline]
    fn ceil(self) -> Range {
        let steps = self.interval.ceil();
        self.steady(steps, steps.is_point())
    }

    #[inline]
    fn round(self) -> Range {
        let steps = self.interval.round();
        self.steady(steps, steps.is_point())
    }

    fn sin(self) -> Range {
        self.with(self.interval.sin(), !self.unbounded())
    }

    fn cos(self) -> Range {
        self.with(self.interval.cos(), !self.unbounded())
    }

    fn tan(self) -> Range {
        let tangent = self.with(self.interval.tan(), !self.unbounded());
        tangent.steady(tangent.interval, !self.interval.meets_pole_of_tan())
    }

    fn asin(self) -> Range {
        self.with(self.interval.asin(), Interval::SIGNED_UNIT.encloses(self.interval))
    }

    fn acos(self) -> Range {
        self.with(self.interval.acos(), Interval::SIGNED_UNIT.encloses(self.interval))
    }

    fn atan(self) -> Range {
        Range { interval: self.interval.atan(), ..self }
    }

    fn exp(self) -> Range {
        Range { interval: self.interval.exp(), ..self }
    }

    fn ln(self) -> Range {
        let mut interval = self.interval.ln();
        if self.interval.contains(0.0) {
            // The logarithm of zero as computed.
            interval = Interval { lo: f64::NEG_INFINITY, hi: interval.hi.max(f64::MIN) };
        }
        self.with(interval, self.interval.lo > 0.0)
    }

    fn not(self) -> Range {
        let interval = match self.interval {
            zero if zero == Interval::ZERO => Interval::ONE,
            mixed if mixed.contains(0.0) => Interval::UNIT,
            _ => Interval::ZERO,
        };
        // NaN is not zero either.
        let steady = interval.is_point() && self.defined;
        Range { interval: if self.defined { interval } else { Interval::UNIT }, defined: true, ..self }
            .steady_if(steady)
    }

    fn atan2(self, x: Range) -> Range {
        let angle = self.joined(x, self.interval.atan2(x.interval));
        let cut = self.interval.contains(0.0) && x.interval.lo <= 0.0;
        angle.steady(angle.interval, !cut)
    }

    #[inline]
    fn min(self, other: Range) -> Range {
        self.joined(other, self.interval.min(other.interval))
    }

    #[inline]
    fn max(self, other: Range) -> Range {
        self.joined(other, self.interval.max(other.interval))
    }

    fn compare(self, other: Range) -> Range {
        let (a, b) = (self.interval, other.interval);
        let lo = if a.lo > b.hi {
            1.0
        } else if a.lo >= b.hi {
            0.0
        } else {
            -1.0
        };
        let hi = if a.hi < b.lo {
            -1.0
        } else if a.hi <= b.lo {
            0.0
        } else {
            1.0
        };
        if a.is_empty() || b.is_empty() {
            return self.joined(other, Interval::EMPTY);
        }
        let sign = self.joined(other, Interval::new(lo, hi));
        sign.steady(sign.interval, sign.interval.is_point())
    }

    fn modulo(self, divisor: Range) -> Range {
        let rest = self.joined(divisor, self.interval.rem_euclid(divisor.interval));
        let whole = Interval { lo: 0.0, hi: divisor.interval.magnitude() };
        let sound = !divisor.interval.contains(0.0) && !self.unbounded();
        Range { continuous: rest.continuous && rest.interval != whole, ..rest.with(rest.interval, sound) }
    }

    fn pow(self, exponent: Range) -> Range {
        if exponent.interval.is_point() && exponent.defined {
            return Range { continuous: exponent.continuous && self.continuous, ..self }
                .power(exponent.interval.lo);
        }
        // Single negative numbers may have a power where the exponent happens to be whole.
        if self.interval.lo < 0.0 {
            return Range::UNKNOWN;
        }
        let mut power = self.joined(exponent, self.interval.pow(exponent.interval));
        if !power.defined {
            // 1 to any power is 1 and so is anything to the power of 0, even where the other is NaN.
            power.interval = power.interval.hull(Interval::ONE);
        }
        let sound = self.interval.lo > 0.0 && !self.unbounded() && !exponent.unbounded();
        Range { continuous: power.continuous && sound, ..power.with(power.interval, sound) }
    }

    fn power(self, exponent: f64) -> Range {
        if exponent == 0.0 {
            return Range { interval: Interval::ONE, ..self };
        }
        if !exponent.is_finite() {
            return Range::UNKNOWN;
        }
        let whole = exponent.floor() == exponent;
        if !whole && self.interval.lo == f64::NEG_INFINITY {
            return Range::UNKNOWN; // Minus infinity has all powers.
        }
        let sound = (whole || self.interval.lo >= 0.0) && (exponent >= 0.0 || !self.interval.contains(0.0));
        let pole = exponent < 0.0 && self.interval.contains(0.0);
        let interval = if pole { Interval::ENTIRE } else { self.interval.power(exponent) };
        let power = self.with(interval, sound);
        power.steady(power.interval, sound)
    }

    fn and(self, other: Range) -> Range {
        if self.interval == Interval::ZERO && self.defined {
            self
        } else if self.interval.contains(0.0) {
            // NaN is not zero, and passes on to the other.
            Range { defined: other.defined, ..Range::of(Interval::ZERO).either(other) }.broken()
        } else {
            Range { continuous: other.continuous && self.continuous, ..other }
        }
    }

    fn or(self, other: Range) -> Range {
        if self.interval == Interval::ZERO && self.defined {
            Range { continuous: other.continuous && self.continuous, ..other }
        } else if self.interval.contains(0.0) {
            self.either(other).broken()
        } else {
            self
        }
    }

    fn select(self, negative: Range, otherwise: Range) -> Range {
        if self.defined && self.interval.hi < 0.0 {
            negative
        } else if self.defined && self.interval.lo >= 0.0 {
            otherwise
        } else {
            negative.either(otherwise).steady_if(self.continuous)
        }
    }

    fn sided(self, negative: Range, otherwise: Range) -> Range {
        // A kink on the boundary of the cell is none within it.
        if self.defined && self.interval.hi <= 0.0 {
            negative
        } else if self.defined && self.interval.lo >= 0.0 {
            otherwise
        } else {
            negative.either(otherwise).broken()
        }
    }

    fn switched(self, zero: Range, otherwise: Range) -> Range {
        if self.defined && self.interval == Interval::ZERO {
            zero
        } else if self.defined && !self.interval.contains(0.0) {
            otherwise
        } else {
            zero.either(otherwise).broken()
        }
    }

    #[inline]
    fn as_slope(self) -> Range {
        if self.interval.is_empty() { Range::UNKNOWN } else { self }
    }

    #[inline]
    fn is_certain(self) -> bool {
        self.interval.is_point()
    }

    #[inline]
    fn norm<const N: usize>(v: [Range; N]) -> Range {
        sum_of_squares(v).sqrt()
    }

    fn direction<const N: usize>(v: [Range; N]) -> [Range; N] {
        let squares = v.map(|x| x.interval.square());
        let flags = v.into_iter().reduce(|a, b| a.joined(b, a.interval)).unwrap_or(Range::UNKNOWN);
        let around_zero = v.iter().all(|x| x.interval.contains(0.0));
        from_fn(|i| {
            let others = rest_of(&squares, i);
            let part = v[i].interval;
            let lo = part_of_unit(part.lo, if part.lo > 0.0 { others.hi } else { others.lo });
            let hi = part_of_unit(part.hi, if part.hi > 0.0 { others.lo } else { others.hi });
            let interval = Interval { lo: lo.lo, hi: hi.hi }.intersection(Interval::SIGNED_UNIT);
            Range { interval, ..flags }.steady_if(!around_zero)
        })
    }

    fn corner_slopes<const N: usize>(q: [Range; N]) -> [Range; N] {
        let q = q.map(|x| x.interval);
        let outside = q.iter().any(|x| x.hi > 0.0);
        let inside = q.iter().all(|x| x.lo <= 0.0);
        let squares = q.map(|x| x.max(Interval::ZERO).square());
        let mut kink = false;
        let slopes = from_fn(|i| {
            let mut slope = Interval::EMPTY;
            if inside {
                let others = (0..N).filter(|&j| j != i);
                let may_win = others.clone().all(|j| q[i].hi >= q[j].lo);
                let may_lose = others.clone().any(|j| q[j].hi >= q[i].lo);
                kink |= may_win && may_lose;
                slope =
                    Interval { lo: if may_lose { 0.0 } else { 1.0 }, hi: if may_win { 1.0 } else { 0.0 } };
            }
            if outside {
                let (part, others) = (q[i].max(Interval::ZERO), rest_of(&squares, i));
                let alone = part.lo == 0.0 && others.hi == 0.0;
                let lo = if alone { 1.0 } else { part_of_unit(part.lo, others.hi).lo };
                let hi = part_of_unit(part.hi, others.lo).hi;
                slope = slope.hull(Interval { lo: lo.max(0.0), hi: hi.min(1.0) });
            }
            Range::of(slope)
        });
        slopes.map(|slope| slope.steady_if(!kink))
    }
}

impl Range {
    #[inline]
    fn steady_if(self, so: bool) -> Range {
        self.steady(self.interval, so)
    }
}

/// The sum of all but one.
fn rest_of<const N: usize>(squares: &[Interval; N], but: usize) -> Interval {
    (0..N).filter(|&j| j != but).fold(Interval::ZERO, |sum, j| sum + squares[j])
}

/// x / sqrt(x^2 + rest), which grows with x, and the more slowly the larger the rest.
fn part_of_unit(x: f64, rest: f64) -> Interval {
    if x == 0.0 {
        return Interval::ZERO;
    }
    if x.is_infinite() || rest == 0.0 {
        // Along an axis, or what an infinite box may hold.
        return if rest == 0.0 { Interval::point(x.signum()) } else { Interval::SIGNED_UNIT };
    }
    let x = Interval::point(x);
    x / (x.square() + Interval::new(rest, rest)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(lo: f64, hi: f64) -> Range {
        Range::of(Interval::new(lo, hi))
    }

    #[test]
    fn slopes_of_a_corner_are_certain_at_a_face() {
        let slopes = Range::corner_slopes([range(-0.1, 0.1), range(-0.6, -0.4), range(-0.6, -0.4)]);
        assert_eq!(slopes.map(|s| (s.interval.lo, s.interval.hi)), [(1.0, 1.0), (0.0, 0.0), (0.0, 0.0)]);
        assert!(slopes.iter().all(|s| s.continuous));
    }

    #[test]
    fn slopes_of_a_corner_at_an_edge_are_both() {
        let slopes = Range::corner_slopes([range(-0.1, 0.1), range(-0.1, 0.1), range(-0.6, -0.4)]);
        assert_eq!(slopes[0].interval, Interval::UNIT);
        assert_eq!(slopes[2].interval, Interval::ZERO);
        assert!(!slopes[0].continuous);
    }

    #[test]
    fn directions_keep_to_their_side() {
        let unit = Range::direction([range(1.0, 1.1), range(-0.1, 0.1)]);
        assert!(unit[0].interval.lo > 0.99 && unit[0].interval.hi == 1.0, "{unit:?}");
        assert!(unit[1].interval.magnitude() < 0.1, "{unit:?}");
        let around = Range::direction([range(-1.0, 1.0), range(-1.0, 1.0)]);
        assert_eq!(around[0].interval, Interval::SIGNED_UNIT);
        assert!(!around[0].continuous);
    }

    #[test]
    fn infinite_numbers_may_clash() {
        let huge = range(1e300, 1e308) * range(1e300, 1e308);
        assert!(huge.defined && !(huge - huge).defined);
    }
}
