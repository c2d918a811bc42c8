use super::evaluate::{eval, lerp};
use super::{Bernstein, CurveError};
use crate::math::{Blend, pow};
use crate::numeric::roots::power_of_two;

/// Above this the difference of two numbers may overflow.
const HUGE: f64 = 0.5 * f64::MAX;

/// Splits in place: both arguments hold the control points before and the two parts after.
pub(super) fn split<P: Blend>(left: &mut [P], right: &mut [P], t: f64) {
    keep_right(right, t);
    keep_left(left, t);
    left[left.len() - 1] = right[0];
}

/// The part from 0 to `t`, in place.
fn keep_left<P: Blend>(points: &mut [P], t: f64) {
    with_headroom(points, |points| {
        for level in 1..points.len() {
            for i in (level..points.len()).rev() {
                points[i] = lerp(points[i - 1], points[i], t);
            }
        }
    });
}

/// The part from `t` to 1, in place.
fn keep_right<P: Blend>(points: &mut [P], t: f64) {
    with_headroom(points, |points| {
        for count in (1..points.len()).rev() {
            for i in 0..count {
                points[i] = lerp(points[i], points[i + 1], t);
            }
        }
    });
}

/// Runs `work` on the points, quartered where their differences could overflow; `work` must be linear.
fn with_headroom<P: Blend>(points: &mut [P], work: impl FnOnce(&mut [P])) {
    if points.iter().all(|point| point.max_abs() <= HUGE) {
        return work(points);
    }
    for point in &mut *points {
        *point = *point * 0.25;
    }
    work(points);
    for point in points {
        *point = *point * 4.0;
    }
}

/// Runs `work` on the points brought near size 1 by a power of two, and leaves them so.
pub(super) fn with_unit_size<P: Blend, T>(points: &mut [P], work: impl FnOnce(&mut [P]) -> T) -> T {
    let size = points.iter().fold(0.0, |most: f64, point| most.max(point.max_abs()));
    if size > 0.0 {
        let [first, second] = reciprocal_powers(size);
        for point in &mut *points {
            *point = *point * first * second;
        }
    }
    work(points)
}

/// Two powers of two whose product brings a positive number between 1 and 2; two, since one may be out of range.
pub(super) fn reciprocal_powers(size: f64) -> [f64; 2] {
    let exponent = if size < f64::MIN_POSITIVE {
        // A subnormal number: its highest bit tells.
        -1011 - size.to_bits().leading_zeros() as i32
    } else {
        (size.to_bits() >> 52) as i32 - 1023
    };
    let half = -exponent / 2;
    [power_of_two(half), power_of_two(-exponent - half)]
}

/// The part between two finite parameters, in place; its ends are the points that evaluation gives.
#[inline]
pub(super) fn restrict<P: Blend>(points: &mut [P], from: f64, to: f64) {
    let (start, end) = (eval(points, from), eval(points, to));
    let last = points.len() - 1;
    let (low, high) = (from.min(to), from.max(to));
    if low == high {
        points.fill(start);
        return;
    }
    // The cut that leaves the longer part goes first: the second parameter is then well conditioned.
    if high >= 1.0 - low {
        keep_left(points, high);
        keep_right(points, low / high);
    } else {
        keep_right(points, low);
        keep_left(points, (high - low) / (1.0 - low));
    }
    if from > to {
        points.reverse();
    }
    (points[0], points[last]) = (start, end);
}

/// Writes the curve of the first points with one more: the last place is free before.
pub(super) fn elevate<P: Blend>(points: &mut [P]) {
    let n = points.len() - 1;
    if n == 0 {
        return;
    }
    points[n] = points[n - 1];
    with_headroom(points, |points| {
        for i in (1..n).rev() {
            points[i] = lerp(points[i], points[i - 1], i as f64 / n as f64);
        }
    });
}

/// Control points of the derivative of an order.
pub(super) fn derivative<P: Blend>(points: &[P], order: usize) -> Vec<P> {
    let mut points = points.to_vec();
    if order >= points.len() {
        return vec![P::ZERO];
    }
    for _ in 0..order {
        let n = points.len() - 1;
        for i in 0..n {
            points[i] = (points[i + 1] - points[i]) * n as f64;
        }
        points.pop();
    }
    points
}

/// Two curves made one.
#[derive(Clone, Debug, PartialEq)]
pub struct Joined<C> {
    /// The curve that the first one prolongs to.
    pub curve: C,
    /// The parameter of `curve` where the two meet.
    pub at: f64,
    /// The largest distance of a control point of the two from its like in `curve`, split at `at`: bounds the distance
    /// of corresponding points.
    pub error: f64,
}

/// Joins two curves of one degree that follow one another, as the two parts of a split do: the first one is prolonged
/// over the second, at the ratio of their speeds where they meet.
///
/// # Errors
/// [`CurveError::Count`] when the degrees differ, [`CurveError::NotFinite`] when the prolonged curve overflows,
/// [`CurveError::Parameter`] when one of them stands still where they meet and the other does not.
pub fn join<C: Bernstein>(first: &C, second: &C) -> Result<Joined<C>, CurveError> {
    let (expected, actual) = (first.points().len(), second.points().len());
    if actual != expected {
        return Err(CurveError::Count { actual, expected });
    }
    let at = meeting(first.points(), second.points());
    if !(at > 0.0 && at < 1.0) {
        return Err(CurveError::Parameter { value: at });
    }
    let mut curve = first.subcurve(0.0, 1.0 / at)?;
    // The end that is known is better than the one that was extrapolated.
    curve.storage_mut()[expected - 1] = second.end();
    let (a, b) = curve.split(at)?;
    Ok(Joined { error: distance(&a, first).max(distance(&b, second)), curve, at })
}

/// The largest distance of corresponding control points.
fn distance<C: Bernstein>(a: &C, b: &C) -> f64 {
    a.points().iter().zip(b.points()).map(|(&p, &q)| (p - q).norm()).fold(0.0, f64::max)
}

/// The share of the first curve in the common parameter, from the first order of derivative that does not vanish.
fn meeting<P: Blend>(first: &[P], second: &[P]) -> f64 {
    let (mut a, mut b) = (first.to_vec(), second.to_vec());
    for order in 1..first.len() {
        for row in [&mut a, &mut b] {
            *row = row.windows(2).map(|pair| pair[1] - pair[0]).collect();
        }
        let (speed_a, speed_b) = (a[a.len() - 1].norm(), b[0].norm());
        if speed_a > 0.0 || speed_b > 0.0 {
            let ratio = pow(speed_b / speed_a, 1.0 / order as f64);
            return 1.0 / (1.0 + ratio);
        }
    }
    0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{AnyBezier, Cubic, Line};
    use crate::math::Vec2;

    fn cubic() -> Cubic<Vec2> {
        Cubic::new([(0.0, 0.0), (1.0, 3.0), (4.0, -2.0), (5.0, 1.0)].map(Vec2::from)).unwrap()
    }

    #[test]
    fn split_parts_join_to_the_whole() {
        for t in [0.01, 0.25, 0.5, 0.8, 0.999] {
            let (left, right) = cubic().split(t).unwrap();
            assert_eq!(left.end(), right.start());
            let joined = join(&left, &right).unwrap();
            // Prolonging magnifies the rounding of the part by the cube of the ratio.
            let loss = 1e-14 / (t * t * t);
            assert!((joined.at - t).abs() < loss && joined.error < loss, "{t}: {joined:?}");
            assert!(distance(&joined.curve, &cubic()) < loss);
        }
    }

    #[test]
    fn what_does_not_belong_together_has_an_error_or_is_refused() {
        let other = cubic().map(|p| p + Vec2::new(5.0, 1.0)).unwrap();
        assert!(join(&cubic(), &other).unwrap().error > 1.0);
        let line = AnyBezier::new(vec![0.0, 1.0]).unwrap();
        let still = AnyBezier::new(vec![1.0, 1.0]).unwrap();
        assert!(matches!(join(&line, &still), Err(CurveError::Parameter { .. })));
        assert_eq!(join(&line, &line.elevated(1)), Err(CurveError::Count { actual: 3, expected: 2 }));
    }

    #[test]
    fn subcurves_run_where_they_should() {
        let curve = cubic();
        for (from, to) in
            [(0.0, 1.0), (0.2, 0.7), (0.7, 0.2), (0.9, 0.95), (0.01, 0.02), (-0.5, 1.5), (1.0, 0.0)]
        {
            let part = curve.subcurve(from, to).unwrap();
            for k in 0..=10 {
                let s = f64::from(k) / 10.0;
                let off = (part.eval(s) - curve.eval(from + s * (to - from))).length();
                assert!(off < 1e-14 * 20.0, "{from} {to} {s}: {off}");
            }
            assert_eq!((part.start(), part.end()), (curve.eval(from), curve.eval(to)));
        }
        assert_eq!(
            curve.subcurve(0.0, f64::NAN).unwrap_err().to_string(),
            "the parameter NaN is not in the domain"
        );
    }

    #[test]
    fn elevation_leaves_the_curve_and_keeps_the_ends() {
        let curve = cubic();
        let high = curve.elevated::<9>();
        let any = AnyBezier::from(curve).elevated(5);
        assert_eq!(high.points(), any.points());
        assert_eq!((high.start(), high.end()), (curve.start(), curve.end()));
        for k in 0..=32 {
            let t = f64::from(k) / 32.0;
            assert!((high.eval(t) - curve.eval(t)).length() < 5e-15);
        }
    }

    #[test]
    fn derivatives_of_each_order() {
        // t^3 in Bernstein form.
        let cube = Cubic::new([0.0, 0.0, 0.0, 1.0]).unwrap();
        assert_eq!(cube.derivative(1).unwrap().eval(0.5), 0.75);
        assert_eq!(cube.derivative(2).unwrap().eval(0.5), 3.0);
        assert_eq!(cube.derivative(3).unwrap().eval(0.5), 6.0);
        assert_eq!(cube.derivative(4).unwrap().points(), [0.0]);
        let swing = Line::new([-1e308, 1e308]).unwrap();
        assert_eq!(swing.derivative(1), Err(CurveError::NotFinite { index: 0 }));
        assert_eq!(swing.split(0.5).unwrap().0.points(), [-1e308, 0.0]);
    }
}
