//! Curves to polylines: few points, and every chord certified.

use crate::curve::{Bernstein, Cubic, CurveError, Spline, speed_minima};
use crate::math::Blend;
use crate::numeric::scale_by_power_of_two;

/// A polyline in place of a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Flattened<P> {
    /// Points of the curve, in order, its ends included. One point when the curve is a point.
    pub points: Vec<P>,
    /// The parameter of each point.
    pub parameters: Vec<f64>,
    /// Bound of the distance of curve and polyline in the sense of Fréchet: both can be walked from end to end, never
    /// back, so that the walkers are never farther apart. At most the tolerance.
    pub error: f64,
}

/// Flattens a curve to a polyline that is within `tolerance` of it, in model units, with few points.
///
/// From each point the longest chord that can be certified is taken, up to a few parts in a hundred. The certificate:
/// where the control polygon of the part advances along the chord throughout, so does the curve, and the distance is
/// that of the two inner control points from the chord, blended, whose largest value is found in closed form (at most
/// 3/4 of the larger one, and 4/9 where they lie on opposite sides); elsewhere, around turns, the same bound of the
/// distance of points at the same parameter is taken, so that turns are not cut off.
///
/// # Errors
/// [`CurveError::Tolerance`] when the tolerance is not a positive number, [`CurveError::ToleranceTooFine`] when it is
/// below the rounding of the curve's coordinates.
pub fn flatten<C: Bernstein>(curve: &C, tolerance: f64) -> Result<Flattened<C::Vector>, CurveError> {
    let mut out = begin(curve.points(), tolerance)?;
    append(curve, tolerance, [0.0, 1.0], &mut out);
    Ok(finished(out, curve.points()))
}

/// Flattens a spline as [`flatten`] does its pieces; joints are points of the polyline. A closed spline ends with its
/// first point again.
///
/// # Errors
/// As [`flatten`].
pub fn flatten_spline<P: Blend>(spline: &Spline<P>, tolerance: f64) -> Result<Flattened<P>, CurveError> {
    let mut out = begin(spline.points(), tolerance)?;
    for (piece, knots) in spline.pieces().zip(spline.knots().windows(2)) {
        append(&piece, tolerance, [knots[0], knots[1]], &mut out);
    }
    Ok(finished(out, spline.points()))
}

/// Rounding of a point computed from these control points.
fn rounding<P: Blend>(points: &[P]) -> f64 {
    let size = points.iter().fold(0.0, |most: f64, point| most.max(point.max_abs()));
    8.0 * points.len().min(8) as f64 * f64::EPSILON * size
}

fn begin<P: Blend>(points: &[P], tolerance: f64) -> Result<Flattened<P>, CurveError> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(CurveError::Tolerance { value: tolerance });
    }
    let finest = 4.0 * rounding(points);
    if tolerance < finest {
        return Err(CurveError::ToleranceTooFine { value: tolerance, finest });
    }
    Ok(Flattened { points: Vec::new(), parameters: Vec::new(), error: 0.0 })
}

/// One point for a curve that never leaves it.
fn finished<P: Blend>(mut out: Flattened<P>, control: &[P]) -> Flattened<P> {
    if control.iter().all(|&point| point == control[0]) {
        out.points.truncate(1);
        out.parameters.truncate(1);
    }
    out
}

/// Adds the points of a curve that runs over the parameters `low` to `high`; its start only when there is none yet.
fn append<C: Bernstein>(curve: &C, tolerance: f64, [low, high]: [f64; 2], out: &mut Flattened<C::Vector>) {
    let outward = |t: f64| if t == 1.0 { high } else { low + t * (high - low) };
    if out.points.is_empty() {
        out.points.push(curve.start());
        out.parameters.push(low);
    }
    let shift = shift_to_unit(curve.points());
    let scaled = |x: f64, shift: i32| if shift == 0 { x } else { scale_by_power_of_two(x, shift) };
    // Scaling towards size 1 keeps numbers finite.
    let moved = if shift == 0 { None } else { curve.map(|point| point.map(|x| scaled(x, shift))).ok() };
    let unit = moved.as_ref().unwrap_or(curve);
    let expected = expected_chords(unit.points(), scaled(tolerance, shift));
    out.points.reserve(expected);
    out.parameters.reserve(expected);
    let mut walk = Walk::new(unit, scaled(tolerance, shift));
    for stop in stops(unit) {
        while walk.t < stop {
            let chord = walk.advance(stop);
            out.error = out.error.max(scaled(chord.error, -shift));
            out.points.push(chord.end.map(|x| scaled(x, -shift)));
            out.parameters.push(outward(walk.t));
        }
    }
}

/// The power of two that brings points near size 1 whose squares could leave the range of numbers; 0 for others.
fn shift_to_unit<P: Blend>(points: &[P]) -> i32 {
    let size = points.iter().fold(0.0, |most: f64, point| most.max(point.max_abs()));
    if size == 0.0 || (1e-100..1e100).contains(&size) {
        return 0;
    }
    let exponent = (size.to_bits() >> 52) as i32 - 1023;
    -exponent.clamp(-1000, 1000)
}

/// About as many as there will be: six tenths of what second differences ask for (Wang's formula); no more than a few
/// thousand, since it is a guess.
fn expected_chords<P: Blend>(points: &[P], tolerance: f64) -> usize {
    let n = (points.len() - 1) as f64;
    let bends = points.windows(3).map(|p| (p[2] - p[1] * 2.0 + p[0]).max_abs());
    let bend = bends.fold(0.0, f64::max);
    2 + (0.6 * (0.125 * n * (n - 1.0) * bend / tolerance).sqrt()).min(4096.0) as usize
}

/// Where chords must end: the end of the curve, and before it cusps and turns. Those are rare, and looked for only when
/// the control polygon turns back; to miss one costs points, not truth.
fn stops<C: Bernstein>(curve: &C) -> Vec<f64> {
    let points = curve.points();
    let steps = || points.windows(2).map(|pair| pair[1] - pair[0]);
    let turns_back = steps().zip(steps().skip(1)).any(|(a, b)| a.inner(b) < 0.0);
    if !turns_back {
        return vec![1.0];
    }
    let slow_speed = 0.01 * steps().fold(0.0, |most: f64, step| most.max(step.norm()));
    if let [a, b, c, d] = *points
        && keeps_speed([b - a, c - b, d - c], slow_speed, 6)
    {
        return vec![1.0];
    }
    let slow = |&t: &f64| velocity(curve, t).norm() < slow_speed;
    speed_minima(curve).into_iter().filter(slow).chain([1.0]).collect()
}

/// Whether a quadratic derivative is shown to stay longer than `slow` by hulls, after so many halvings at most.
fn keeps_speed<P: Blend>([u, v, w]: [P; 3], slow: f64, halvings: u32) -> bool {
    let (left, right) = ((u + v) * 0.5, (v + w) * 0.5);
    let middle = (left + right) * 0.5;
    let limit = slow * middle.norm();
    if [u, v, w].iter().all(|step| step.inner(middle) > limit) {
        return true;
    }
    halvings > 0
        && keeps_speed([u, left, middle], slow, halvings - 1)
        && keeps_speed([middle, right, w], slow, halvings - 1)
}

/// The derivative over the degree.
fn velocity<C: Bernstein>(curve: &C, t: f64) -> C::Vector {
    let rows = curve.construction(t);
    match &rows[..] {
        [.., row, _] => row[1] - row[0],
        _ => C::Vector::ZERO,
    }
}

/// A certified chord.
struct Chord<P> {
    end: P,
    /// A third of the derivative at its end; of cubics only.
    arriving: P,
    error: f64,
}

/// The state of a walk along a curve.
struct Walk<'a, C: Bernstein> {
    curve: &'a C,
    /// Control points when the degree is at most 3, for which parts are found from ends and derivatives.
    cubic: Option<[C::Vector; 4]>,
    tolerance: f64,
    rounding: f64,
    t: f64,
    /// The point at `t` and a third of the derivative; of cubics only.
    start: (C::Vector, C::Vector),
    /// The step that is expected to fill the tolerance.
    step: f64,
    /// The step that would have filled it for the last chord.
    filling: f64,
}

/// A chord that uses this share of the tolerance is long enough.
const ENOUGH: f64 = 0.75;
/// Chords of one start that fit before the longest of them is taken.
const MOST_FITS: u32 = 5;
/// The share of the tolerance that a guess aims at.
const AIM: f64 = 0.92;
/// The most by which the next chord is expected to be longer or shorter than this one, as this one was than the last:
/// with it four chords are tried for three that are taken, else six.
const TREND: f64 = 1.3;

impl<'a, C: Bernstein> Walk<'a, C> {
    fn new(curve: &'a C, tolerance: f64) -> Walk<'a, C> {
        let points = curve.points();
        let raised = |low: Option<Cubic<C::Vector>>| low.map(Cubic::to_array);
        let cubic = match *points {
            [a, b, c, d] => Some([a, b, c, d]),
            [a, b, c] => raised(crate::curve::Quadratic::new([a, b, c]).ok().map(|low| low.elevated())),
            [a, b] => raised(crate::curve::Line::new([a, b]).ok().map(|low| low.elevated())),
            _ => None,
        };
        let start = cubic.map_or((points[0], C::Vector::ZERO), |[a, b, _, _]| (a, b - a));
        Walk { curve, cubic, tolerance, rounding: rounding(points), t: 0.0, start, step: 0.25, filling: 0.25 }
    }

    /// Moves to the end of a chord of which another width would have filled the tolerance.
    #[inline]
    fn take(&mut self, to: f64, chord: Chord<C::Vector>, filling: f64) -> Chord<C::Vector> {
        self.step = filling * (filling / self.filling).clamp(1.0 / TREND, TREND);
        self.filling = filling.max(f64::MIN_POSITIVE);
        self.t = to;
        self.start = (chord.end, chord.arriving);
        chord
    }

    /// Takes the longest chord towards `stop`, nearly, and moves to its end.
    fn advance(&mut self, stop: f64) -> Chord<C::Vector> {
        let from = self.t;
        let mut longest: Option<(f64, Chord<C::Vector>, f64)> = None;
        let (mut too_long, mut step, mut fits) = (f64::INFINITY, self.step, 0);
        loop {
            let to = if from + 1.001 * step >= stop { stop } else { (from + step).max(from.next_up()) };
            let (width, chord) = (to - from, self.certify(from, to));
            let fill = chord.error / self.tolerance;
            let guess = width * (AIM / fill.max(1e-4)).sqrt();
            // Neighbouring parameters: what is left is rounding.
            if fill <= 1.0 || to <= from.next_up() {
                fits += 1;
                if fill >= ENOUGH || to == stop || fits == MOST_FITS {
                    return self.take(to, chord, guess);
                }
                longest = Some((to, chord, guess));
                step = guess.max(1.05 * width).min(0.5 * width + 0.5 * too_long);
            } else if let Some((to, chord, guess)) = longest {
                return self.take(to, chord, guess);
            } else {
                too_long = width;
                step = guess.clamp(0.1 * width, 0.9 * width);
            }
        }
    }

    /// The chord between two parameters and a bound of its distance.
    fn certify(&self, from: f64, to: f64) -> Chord<C::Vector> {
        match &self.cubic {
            Some(cubic) => {
                // Hermite's form: the inner control points are a third of the derivatives away from the ends. Where
                // the width is small its rounding is small beside that of the ends.
                let ((start, leaving), (end, arriving)) = (self.start, ends_of(cubic, to));
                let width = to - from;
                let part = [start, start + leaving * width, end - arriving * width, end];
                Chord { end, arriving, error: cubic_bound(&part) + self.rounding }
            }
            None => match self.curve.subcurve(from, to) {
                Ok(part) => {
                    let error = general_bound(part.points()) + self.rounding;
                    Chord { end: part.end(), arriving: C::Vector::ZERO, error }
                }
                Err(_) => Chord { end: self.curve.eval(to), arriving: C::Vector::ZERO, error: f64::INFINITY },
            },
        }
    }
}

/// Point and a third of the derivative.
#[inline]
fn ends_of<P: Blend>(points: &[P; 4], t: f64) -> (P, P) {
    let [a, b, c, d] = *points;
    if t == 1.0 {
        return (d, d - c);
    }
    let (p, q, r) = (a + (b - a) * t, b + (c - b) * t, c + (d - c) * t);
    let (v, w) = (p + (q - p) * t, q + (r - q) * t);
    (v + (w - v) * t, w - v)
}

/// Whether the control polygon never steps back along its chord.
fn advances<P: Blend>(points: &[P], chord: P) -> bool {
    chord != P::ZERO && points.windows(2).all(|pair| (pair[1] - pair[0]).inner(chord) >= 0.0)
}

/// What the distance is made of: offsets of control points from the chord, across it where the polygon advances, else
/// from where they would be on a chord walked evenly.
fn offset<P: Blend>(point: P, start: P, chord: P, share: f64, across: bool) -> P {
    let from_start = point - start;
    let along = if across { from_start.inner(chord) / chord.inner(chord) } else { share };
    from_start - chord * along
}

#[inline]
fn cubic_bound<P: Blend>(points: &[P; 4]) -> f64 {
    let [a, b, c, d] = *points;
    let chord = d - a;
    let across = advances(points, chord);
    if across && P::DIMENSION == 2 {
        return plane_bound(b - a, c - a, chord);
    }
    let (v, w) = (offset(b, a, chord, 1.0 / 3.0, across), offset(c, a, chord, 2.0 / 3.0, across));
    // The second offset split into a multiple of the first and a rest across it; in the plane there is none.
    let square = v.inner(v);
    let multiple = if square > 0.0 { v.inner(w) / square } else { 0.0 };
    let rest = w - v * multiple;
    let (main, side) = (square.sqrt() * peak(multiple), 4.0 / 9.0 * rest.norm());
    (main * main + side * side).sqrt()
}

/// The bound across the chord in the plane, where offsets are cross products.
#[inline]
fn plane_bound<P: Blend>(b: P, c: P, chord: P) -> f64 {
    let height = |p: P| chord.component(0) * p.component(1) - chord.component(1) * p.component(0);
    let (v, w) = (height(b), height(c));
    // The peak is on the side of the larger one.
    let (main, other) = if v.abs() >= w.abs() { (v, w) } else { (w, v) };
    if main == 0.0 {
        return 0.0;
    }
    let r = other / main;
    // The derivative of t (1 - t) ((1 - t) + r t) is 1 + 2 (r - 2) t - 3 (r - 1) t^2.
    let half = 2.0 - r;
    let t = 1.0 / (half + (half * half - 3.0 * (1.0 - r)).max(0.0).sqrt());
    let peak = 3.0 * t * (1.0 - t) * ((1.0 - t) + r * t) * (1.0 + 8.0 * f64::EPSILON);
    main.abs() * peak / chord.inner(chord).sqrt()
}

/// The largest magnitude over [0, 1] of `3 t (1 - t) ((1 - t) + r t)`.
fn peak(r: f64) -> f64 {
    let f = |t: f64| (3.0 * t * (1.0 - t) * ((1.0 - t) + r * t)).abs();
    // Zeros of the derivative: 1 + 2 (r - 2) t - 3 (r - 1) t^2.
    let (half, square) = (r - 2.0, -3.0 * (r - 1.0));
    let root = (half * half - square).max(0.0).sqrt();
    // Both roots by the stable form, from their product 1 / square.
    let big = -half + if half < 0.0 { root } else { -root };
    let [first, second] = [big / square, 1.0 / big].map(|t| if t > 0.0 && t < 1.0 { f(t) } else { 0.0 });
    first.max(second) * (1.0 + 8.0 * f64::EPSILON)
}

/// The bound for any degree: inner basis functions sum up to at most `1 - 2^(1-n)`.
fn general_bound<P: Blend>(points: &[P]) -> f64 {
    let n = points.len() - 1;
    if n == 0 {
        return 0.0;
    }
    let (start, chord) = (points[0], points[n] - points[0]);
    let across = advances(points, chord);
    let offsets = points.iter().enumerate();
    let largest = offsets
        .map(|(i, &point)| offset(point, start, chord, i as f64 / n as f64, across).norm())
        .fold(0.0, f64::max);
    largest * (1.0 - 0.5_f64.powi(n as i32 - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{AnyBezier, Boundary};
    use crate::math::{Vec2, Vec3};
    use proptest::prelude::*;

    fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
        Cubic::new(points.map(Vec2::from)).unwrap()
    }

    /// The farthest that dense points of the curve are from the chord over their own parameters.
    fn worst<P: Blend, C: Bernstein<Vector = P>>(curve: &C, flat: &Flattened<P>) -> f64 {
        let mut worst: f64 = 0.0;
        for (ends, t) in flat.points.windows(2).zip(flat.parameters.windows(2)) {
            let chord = ends[1] - ends[0];
            for k in 0..=32 {
                let p = curve.eval(t[0] + (t[1] - t[0]) * f64::from(k) / 32.0) - ends[0];
                let square = chord.inner(chord);
                let along = if square > 0.0 { (p.inner(chord) / square).clamp(0.0, 1.0) } else { 0.0 };
                worst = worst.max((p - chord * along).norm());
            }
        }
        worst
    }

    fn wang(curve: &Cubic<Vec2>, tolerance: f64) -> f64 {
        let [a, b, c, d] = curve.to_array();
        let second = (a - b * 2.0 + c).length().max((b - c * 2.0 + d).length());
        (0.75 * second / tolerance).sqrt().ceil().max(1.0)
    }

    #[test]
    fn few_chords_and_none_too_far() {
        let (mut chords, mut wangs) = (0.0, 0.0);
        let mut state = 1_u64;
        let mut random = || {
            // Knuth's linear congruential generator.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for case in 0..10_000 {
            let curve = cubic([(); 4].map(|()| (100.0 * random(), 100.0 * random())));
            let tolerance = [1.0, 0.1, 0.01][case % 3];
            let flat = flatten(&curve, tolerance).unwrap();
            assert!(flat.error <= tolerance);
            if case % 10 < 3 {
                let worst = worst(&curve, &flat);
                assert!(worst <= flat.error, "{curve:?} at {tolerance}: {worst}");
            }
            chords += (flat.points.len() - 1) as f64;
            wangs += wang(&curve, tolerance);
        }
        assert!(chords <= 0.55 * wangs, "{}", chords / wangs);
    }

    #[test]
    fn turns_are_kept() {
        let line = cubic([(0.0, 0.0), (200.0, 0.0), (-100.0, 0.0), (100.0, 0.0)]);
        for tolerance in [1.0, 1e-3, 1e-6, 1e-9] {
            let flat = flatten(&line, tolerance).unwrap();
            let length: f64 = flat.points.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum();
            assert!((length - 189.4427190999916).abs() < 8.0 * tolerance && flat.points.len() <= 12);
        }
        let cusp = cubic([(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)]);
        let flat = flatten(&cusp, 0.01).unwrap();
        assert!(flat.points.iter().any(|point| (*point - Vec2::new(50.0, 75.0)).length() < 0.01));
    }

    #[test]
    fn degenerate_and_wrong_input() {
        let point = cubic([(3.0, 4.0); 4]);
        let flat = flatten(&point, 1e-3).unwrap();
        assert_eq!((flat.points.len(), flat.parameters), (1, vec![0.0]));
        let straight = cubic([(0.0, 0.0), (0.0, 0.0), (100.0, 50.0), (100.0, 50.0)]);
        assert_eq!(flatten(&straight, 1e-9).unwrap().points.len(), 2);
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(flatten(&point, value), Err(CurveError::Tolerance { .. })));
        }
        assert!(matches!(flatten(&straight, 1e-16), Err(CurveError::ToleranceTooFine { .. })));
        let huge = cubic([(0.0, 0.0), (1e308, 0.0), (1e308, 1e308), (0.0, 0.0)]);
        assert!(flatten(&huge, 1e300).unwrap().points.len() > 100);
    }

    #[test]
    fn closed_splines_close() {
        let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(Vec2::from);
        let ring = Spline::periodic(&points, &[0.0, 1.0, 2.0, 3.0, 4.0]).unwrap();
        let flat = flatten_spline(&ring, 1e-3).unwrap();
        assert_eq!((flat.points[0], flat.parameters[0]), (points[0], 0.0));
        assert_eq!(flat.points[flat.points.len() - 1], points[0]);
        assert!(flat.parameters.windows(2).all(|pair| pair[0] < pair[1]));
        for (t, p) in [(1.0, points[1]), (2.0, points[2])] {
            let place = flat.parameters.iter().position(|&s| s == t).unwrap();
            assert_eq!(flat.points[place], p);
        }
        let natural = Boundary::Second(Vec2::ZERO);
        let open = Spline::interpolate(&points, &[0.0, 1.0, 2.0, 3.0], natural, natural).unwrap();
        assert!(flatten_spline(&open, 1e-3).unwrap().error <= 1e-3);
    }

    proptest! {
        #[test]
        fn every_degree_in_space(
            points in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64, -9.0..9.0_f64), 1..9),
            tolerance in 1e-4..1.0_f64,
        ) {
            let curve = AnyBezier::new(points.into_iter().map(Vec3::from).collect()).unwrap();
            let flat = flatten(&curve, tolerance).unwrap();
            prop_assert!(flat.error <= tolerance);
            let worst = worst(&curve, &flat);
            prop_assert!(worst <= flat.error + 1e-14);
            prop_assert_eq!(flat.points[flat.points.len() - 1], curve.end());
        }
    }
}
