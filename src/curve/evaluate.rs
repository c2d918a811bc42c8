//! The methods of evaluating a curve in Bernstein form, each with its cost and error.
//!
//! With n the degree, u = 2^-53 and *size* the sum of `|b_i| B_i(t)`, errors below are relative to that sum and meant
//! for `t` in [0, 1]. All panic when there are no points. Underflow is not counted: curves near the limits of `f64`
//! should be scaled by a power of two first, as [`super::Bernstein::eval`] does.

use super::bounded;
use crate::math::Blend;

pub use super::bounded::compensated;

/// Points that fit on the stack while they are combined.
const SMALL: usize = 16;
/// The largest degree for which scaled Horner forms cannot overflow: C(512, 256) times 2^300 is below 2^1024.
pub(super) const MAX_HORNER_DEGREE: usize = 512;
/// Sizes of control points within which no method over- or underflows.
pub(super) const SAFE_SIZES: std::ops::RangeInclusive<f64> =
    1.0 / ((1_u128 << 100) as f64 * (1_u128 << 100) as f64)..=(1_u128 << 100) as f64 * (1_u128 << 100) as f64;

/// Picks the method, see [`super::Bernstein::eval`].
#[inline]
pub(super) fn eval<P: Blend>(points: &[P], t: f64) -> P {
    let last = points.len() - 1;
    if t == 0.0 {
        return points[0];
    }
    if t == 1.0 {
        return points[last];
    }
    if !(0.0..=1.0).contains(&t) {
        return de_casteljau(points, t);
    }
    let sizes = points.iter().fold(P::ZERO, |most, &point| most.zip(point, |a, b| a.max(b.abs())));
    let size = sizes.max_abs();
    if !SAFE_SIZES.contains(&size) && size != 0.0 {
        return bounded::eval_scaled(points, t, size);
    }
    let value = match last {
        0..=8 => de_casteljau(points, t),
        9..=MAX_HORNER_DEGREE => horner_bernstein(points, t),
        _ => wozny_chudy(points, t),
    };
    // The condition of a coordinate is at most its largest control value over its own.
    let condition_is_low = |axis| value.component(axis).abs() * 67_108_864.0 >= sizes.component(axis);
    if (0..P::DIMENSION).all(condition_is_low) { value } else { bounded::corrected(points, t, value) }
}

/// De Casteljau's repeated interpolation.
///
/// Cost n(n+1)/2 blends. Error at most about 3n u; any `t`, extrapolation included. Exact at 0 and 1 and for equal
/// control points. The differences of points must not overflow.
#[inline]
pub fn de_casteljau<P: Blend>(points: &[P], t: f64) -> P {
    if points.len() <= SMALL {
        let mut row = [P::ZERO; SMALL];
        row[..points.len()].copy_from_slice(points);
        collapse(&mut row[..points.len()], t)
    } else {
        collapse(&mut points.to_vec(), t)
    }
}

/// De Casteljau in place; the point ends up in the first place.
#[inline]
fn collapse<P: Blend>(row: &mut [P], t: f64) -> P {
    for count in (1..row.len()).rev() {
        for i in 0..count {
            row[i] = lerp(row[i], row[i + 1], t);
        }
    }
    row[0]
}

/// The point at `t` between `a` and `b`, computed from the nearer end: exact at 0 and at 1 and where `a` equals `b`.
#[inline]
pub(crate) fn lerp<P: Blend>(a: P, b: P, t: f64) -> P {
    if t <= 0.5 { a + (b - a) * t } else { b - (b - a) * (1.0 - t) }
}

/// All rows of de Casteljau's construction, the control points first and the point of the curve last.
pub fn triangle<P: Blend>(points: &[P], t: f64) -> Vec<Vec<P>> {
    let mut rows = vec![points.to_vec()];
    for count in (1..points.len()).rev() {
        let above = &rows[rows.len() - 1];
        rows.push((0..count).map(|i| lerp(above[i], above[i + 1], t)).collect());
    }
    rows
}

/// The sum of `b_i C(n, i) t^i (1 - t)^(n - i)` with powers by repeated squaring.
///
/// Cost O(n log n). Error about 3n u. The binomials overflow from degree 1030 on: NaN.
pub fn bernstein<P: Blend>(points: &[P], t: f64) -> P {
    let n = points.len() - 1;
    let mut binomial = 1.0;
    let mut sum = P::ZERO;
    for (i, &point) in points.iter().enumerate() {
        sum = sum + point * (binomial * power(t, i) * power(1.0 - t, n - i));
        binomial = next_binomial(binomial, n, i);
    }
    sum
}

/// C(n, i + 1) from C(n, i). The division comes first where the product could overflow.
#[inline]
pub(super) fn next_binomial(binomial: f64, n: usize, i: usize) -> f64 {
    let (up, down) = ((n - i) as f64, (i + 1) as f64);
    if binomial < 1e300 { binomial * up / down } else { binomial / down * up }
}

fn power(base: f64, mut exponent: usize) -> f64 {
    let (mut square, mut product) = (base, 1.0);
    while exponent > 0 {
        if exponent % 2 == 1 {
            product *= square;
        }
        square *= square;
        exponent /= 2;
    }
    product
}

/// Horner's scheme for the Bernstein form (Farin): `a <- (a + t^k C(n, k) b_k)(1 - t)`.
///
/// Cost 4n operations, no branch and no division. Error about (3n + 1) u, in practice a few u. Overflows from degree
/// 1030 on, and earlier for large points.
#[inline]
pub fn horner_bernstein<P: Blend>(points: &[P], t: f64) -> P {
    let n = points.len() - 1;
    let s = 1.0 - t;
    let (mut weight, mut binomial) = (1.0, 1.0);
    let mut sum = P::ZERO;
    for (k, &point) in points[..n].iter().enumerate() {
        sum = (sum + point * (weight * binomial)) * s;
        binomial = next_binomial(binomial, n, k);
        weight *= t;
    }
    sum + points[n] * weight
}

/// Horner in t / (1 - t), from the other end above 1/2 (Schumaker, Volk, Efficient evaluation of multivariate
/// polynomials, 1986).
///
/// Cost 2n operations and one division. Error about 4n u. Overflows from degree 1030 on.
pub fn schumaker_volk<P: Blend>(points: &[P], t: f64) -> P {
    let n = points.len() - 1;
    let near_start = t <= 0.5;
    let (s, near) = if near_start { (t, 1.0 - t) } else { (1.0 - t, t) };
    let ratio = s / near;
    // From the far end on, so that powers of the ratio pile up on it.
    let at = |k: usize| if near_start { points[n - k] } else { points[k] };
    let mut binomial = 1.0;
    let mut sum = at(0);
    for k in 1..=n {
        binomial = next_binomial(binomial, n, k - 1);
        sum = sum * ratio + at(k) * binomial;
    }
    sum * power(near, n)
}

/// The geometric method of linear cost (Woźny, Chudy, Linear-time geometric algorithm for evaluating Bézier curves,
/// 2020): each step blends the next control point into the weighted mean of those before it.
///
/// With `W` the sum of the basis functions up to k, the share `h = B_k / W` obeys `h / (1 - h) = h' r (n-k+1) / k`, `h'`
/// the share before it and `r = t / (1 - t)`. Cost about 8n operations and n divisions. Error of a few u at degree
/// 100 (at most about 5 n^2 u). Only blends within the hull: no degree overflows. Not for `t` outside of [0, 1].
pub fn wozny_chudy<P: Blend>(points: &[P], t: f64) -> P {
    let n = points.len() - 1;
    let near_start = t <= 0.5;
    let s = if near_start { t } else { 1.0 - t };
    let ratio = s / (1.0 - s);
    let at = |k: usize| if near_start { points[k] } else { points[n - k] };
    let mut share = 1.0;
    let mut mean = at(0);
    for k in 1..=n {
        let (count, grown) = (k as f64, share * ratio * (n - k + 1) as f64);
        let whole = count + grown;
        share = grown / whole;
        mean = mean * (count / whole) + at(k) * share;
    }
    mean
}

/// Horner's scheme for coefficients of 1, t, t^2 and so on.
///
/// Cost 2n operations. Bernstein coefficients turned into these are ill-conditioned: errors grow like 4^n u. Only for
/// degrees up to 3, or for what came as monomials.
#[inline]
pub fn horner<P: Blend>(coefficients: &[P], t: f64) -> P {
    let n = coefficients.len() - 1;
    coefficients[..n].iter().rev().fold(coefficients[n], |sum, &coefficient| sum * t + coefficient)
}

/// The points at `0, 1/steps, ..., 1` by forward differences.
///
/// Cost n additions a point. Drifts: some hundred u after a thousand steps at degree 3, more at higher degrees. The
/// last point is set to the last control point.
///
/// # Panics
/// When `steps` is 0.
pub fn forward_differences<P: Blend>(points: &[P], steps: usize) -> Vec<P> {
    assert!(steps > 0, "at least one step");
    let n = points.len() - 1;
    let mut differences = step_differences(points, steps);
    let mut out = Vec::with_capacity(steps + 1);
    for _ in 0..steps {
        out.push(differences[0]);
        for i in 0..n {
            differences[i] = differences[i] + differences[i + 1];
        }
    }
    out.push(points[n]);
    out
}

/// Forward differences at 0 of all orders for the step `1 / steps`.
///
/// From monomial coefficients and not from values, whose differences would cancel: dividing by s, s - 1, s - 2 and so
/// on gives Newton's coefficients, which are the differences over factorials.
fn step_differences<P: Blend>(points: &[P], steps: usize) -> Vec<P> {
    let n = points.len() - 1;
    let mut row = points.to_vec();
    for order in 1..=n {
        for i in (order..=n).rev() {
            row[i] = row[i] - row[i - 1];
        }
    }
    let (mut binomial, mut scale) = (1.0, 1.0);
    for (k, value) in row.iter_mut().enumerate() {
        *value = *value * (binomial * scale);
        binomial = next_binomial(binomial, n, k);
        scale /= steps as f64;
    }
    for root in 1..n {
        for j in (root..n).rev() {
            row[j] = row[j] + row[j + 1] * root as f64;
        }
    }
    let mut factorial = 1.0;
    for (k, value) in row.iter_mut().enumerate() {
        factorial *= k.max(1) as f64;
        *value = *value * factorial;
    }
    row
}
