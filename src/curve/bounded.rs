use super::evaluate::{self, SAFE_SIZES};
use super::subdivide::reciprocal_powers;
use crate::math::Blend;
use crate::numeric::double_double::DoubleDouble;

/// A value and a bound of its error: the true value differs by at most `error`, in each component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded<T> {
    /// The value.
    pub value: T,
    /// What the true value may differ by; not negative.
    pub error: T,
}

/// Unit roundoff.
const U: f64 = 0.5 * f64::EPSILON;
/// The smallest positive number, twice what one operation may lose to underflow.
const TINY: f64 = f64::from_bits(1);

/// See [`super::Bernstein::eval_bounded`].
pub(super) fn eval_bounded<P: Blend>(points: &[P], t: f64) -> Bounded<P> {
    let size = points.iter().fold(0.0, |most: f64, point| most.max(point.max_abs()));
    if !SAFE_SIZES.contains(&size) && size != 0.0 {
        return scaled(points, size, |points| eval_bounded(points, t));
    }
    let inside = (0.0..=1.0).contains(&t);
    if inside && points.len() > 17 {
        return compensated(points, t);
    }
    let plain = running(points, t);
    let sharp = |axis| plain.error.component(axis) <= 4.0 * f64::EPSILON * plain.value.component(axis).abs();
    if !inside || (0..P::DIMENSION).all(sharp) { plain } else { compensated(points, t) }
}

/// The value alone, for curves near the limits of `f64`.
pub(super) fn eval_scaled<P: Blend>(points: &[P], t: f64, size: f64) -> P {
    scaled(points, size, |points| Bounded { value: evaluate::eval(points, t), error: P::ZERO }).value
}

/// Evaluates a copy of the points brought to a size between 1 and 2 by a power of two, and scales back.
///
/// Scaling is exact but for what is below 2^-1022 of the size, and for a result that is subnormal in the end; both
/// are in the bound.
fn scaled<P: Blend>(points: &[P], size: f64, evaluate: impl Fn(&[P]) -> Bounded<P>) -> Bounded<P> {
    let [first, second] = reciprocal_powers(size);
    let moved: Vec<P> = points.iter().map(|&point| point * first * second).collect();
    let Bounded { value, error } = evaluate(&moved);
    let back = |x: f64| x * (1.0 / first) * (1.0 / second);
    Bounded { value: value.map(back), error: error.map(|e| back(e + TINY).next_up() + TINY) }
}

/// A value replaced by the compensated one, in those components where it is off by more than that one's own bound (so
/// that a zero met exactly stays one).
pub(super) fn corrected<P: Blend>(points: &[P], t: f64, value: P) -> P {
    let exact = compensated(points, t);
    P::from_components(|axis| {
        let (plain, better) = (value.component(axis), exact.value.component(axis));
        if (plain - better).abs() <= exact.error.component(axis) { plain } else { better }
    })
}

/// De Casteljau with a bound that runs along.
///
/// A step computes `r = a + t(b - a)` (or the same from `b`) with three roundings: the difference is off by u of
/// itself, the product `m` by u more, the sum by u of `r`, and a factor 1 - t that is not exact adds another u, so `r`
/// is within u(|r| + 3|m|) plus underflow of the exact blend of the computed `a` and `b`; errors of those enter with
/// weights |1 - t| and |t|. The bound itself is rounded: at most four roundings a row, covered by the last factor.
fn running<P: Blend>(points: &[P], t: f64) -> Bounded<P> {
    let mut row = points.to_vec();
    let mut errors = vec![P::ZERO; points.len()];
    let (s, t_abs) = ((1.0 - t).abs(), t.abs());
    for count in (1..row.len()).rev() {
        for i in 0..count {
            let (a, b) = (row[i], row[i + 1]);
            let step = if t <= 0.5 { (b - a) * t } else { (b - a) * (1.0 - t) };
            row[i] = if t <= 0.5 { a + step } else { b - step };
            let fresh = row[i].zip(step, |r, m| U * (r.abs() + 3.0 * m.abs()) + TINY);
            errors[i] = errors[i] * s + errors[i + 1] * t_abs + fresh;
        }
    }
    let inflation = 1.0 + 16.0 * U * points.len() as f64;
    Bounded { value: row[0], error: errors[0] * inflation }
}

/// The linear geometric method of [`evaluate::wozny_chudy`] in double-double arithmetic, for `t` in [0, 1].
///
/// Cost about 25 times the plain method, linear in the degree. The bound, that of the last rounding to `f64` and a few
/// times n 2^-102 of the sum of `|b_i| B_i(t)`, runs along: in units of 2^-102, the error of one double-double
/// operation, the ratio is off by 1 and `grown` by 2 more than the share before it; `whole = grown + k` is off by the
/// share of that and 1; share and rest add 1 for their division and products and the sum 1 each. All terms of
/// `size` are positive, so that its own rounding is covered by a factor of 2.
pub fn compensated<P: Blend>(points: &[P], t: f64) -> Bounded<P> {
    let n = points.len() - 1;
    let near_start = t <= 0.5;
    let (s, rest) = if near_start {
        (DoubleDouble::from(t), DoubleDouble::difference(1.0, t))
    } else {
        (DoubleDouble::difference(1.0, t), DoubleDouble::from(t))
    };
    let ratio = s / rest;
    let at = |k: usize| if near_start { points[k] } else { points[n - k] };
    let mut share = DoubleDouble::from(1.0);
    let mut mean = [DoubleDouble::ZERO; 4];
    for (axis, mean) in mean.iter_mut().take(P::DIMENSION).enumerate() {
        *mean = DoubleDouble::from(at(0).component(axis));
    }
    let (mut share_error, mut size, mut error) = (0.0, at(0).map(f64::abs), P::ZERO);
    for k in 1..=n {
        let grown = share * ratio * (n - k + 1) as f64;
        let whole = grown + DoubleDouble::from(k as f64);
        share = grown / whole;
        let keep = DoubleDouble::from(k as f64) / whole;
        for (axis, mean) in mean.iter_mut().take(P::DIMENSION).enumerate() {
            *mean = *mean * keep + share * at(k).component(axis);
        }
        let grown_error = share_error + 3.0;
        share_error = keep.hi * grown_error + 2.0;
        let (old, new) = (size * keep.hi, at(k).map(f64::abs) * share.hi);
        size = old + new;
        error = error * keep.hi + old * (share.hi * grown_error + 3.0) + new * (share_error + 1.0) + size;
    }
    let value = P::from_components(|axis| mean[axis].to_f64());
    let rounding = value.map(|v| U * v.abs() * (1.0 + f64::EPSILON) + TINY);
    Bounded { value, error: rounding + error * (2.0 * DoubleDouble::EPSILON) }
}
