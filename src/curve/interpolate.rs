//! Splines through given points: each kind chooses derivatives at the knots, Hermite pieces do the rest.

use super::spline::{Spline, check_knots, uniform_knots};
use super::{CurveError, check_finite};
use crate::math::Blend;
use crate::numeric::tridiagonal::{Row, solve, solve_ring};

/// What an interpolating C2 spline does at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Boundary<P> {
    /// The first two (or last two) pieces are one polynomial.
    NotAKnot,
    /// The first derivative there ("clamped").
    First(P),
    /// The second derivative there; zero is the natural spline.
    Second(P),
}

/// How Catmull-Rom splines space their knots: by a power of the distance of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Equal steps.
    Uniform,
    /// Square roots of distances: no loops or cusps within a piece (Yuksel, Schaefer, Keyser 2011).
    Centripetal,
    /// Distances.
    Chordal,
}

impl<P: Blend> Spline<P> {
    /// The C2 spline through points at ascending knots, with a condition for each end; linear cost.
    ///
    /// Two points with not-a-knot ends give the straight line, three the parabola.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] below two points, [`CurveError::Count`] when knots and points differ in number,
    /// [`CurveError::Knot`], [`CurveError::NotFinite`] for wrong numbers or an overflow, [`CurveError::Singular`] when
    /// the equations have no unique solution in `f64`.
    pub fn interpolate(
        points: &[P],
        knots: &[f64],
        start: Boundary<P>,
        end: Boundary<P>,
    ) -> Result<Spline<P>, CurveError> {
        check(points, knots, points.len())?;
        let n = points.len();
        let (steps, slopes) = steps_and_slopes(points, knots);
        if n == 3 && start == Boundary::NotAKnot && end == Boundary::NotAKnot {
            return Spline::hermite(points, &parabola(&steps, &slopes), knots);
        }
        let (mut rows, mut right) = (vec![[0.0; 3]; n], vec![P::ZERO; n]);
        for i in 1..n - 1 {
            let (h, k) = (steps[i - 1], steps[i]);
            rows[i] = [k, 2.0 * (h + k), h];
            right[i] = (slopes[i - 1] * k + slopes[i] * h) * 3.0;
        }
        let last = slopes.len() - 1;
        let piece = |i: usize| (steps[i], slopes[i]);
        // Each end condition as seen looking inward; backward the derivatives keep their sign, curvature changes it.
        let (row, value) = end_row(start, piece(0), (last > 0).then(|| piece(1)), 1.0);
        (rows[0], right[0]) = ([0.0, row[0], row[1]], value);
        let (row, value) = end_row(end, piece(last), last.checked_sub(1).map(piece), -1.0);
        (rows[n - 1], right[n - 1]) = ([row[1], row[0], 0.0], value);
        solve(&rows, &mut right).map_err(|_| CurveError::Singular)?;
        Spline::hermite(points, &right, knots)
    }

    /// The closed C2 spline through points, the last of which joins the first; knots are one more than points.
    ///
    /// # Errors
    /// As [`Spline::interpolate`].
    pub fn periodic(points: &[P], knots: &[f64]) -> Result<Spline<P>, CurveError> {
        check(points, knots, points.len() + 1)?;
        let n = points.len();
        let ring: Vec<P> = points.iter().chain(&points[..1]).copied().collect();
        let (steps, slopes) = steps_and_slopes(&ring, knots);
        let before = |i: usize| (i + n - 1) % n;
        let mut rows: Vec<Row> = Vec::with_capacity(n);
        let mut right = Vec::with_capacity(n);
        for i in 0..n {
            let (h, k) = (steps[before(i)], steps[i]);
            rows.push([k, 2.0 * (h + k), h]);
            right.push((slopes[before(i)] * k + slopes[i] * h) * 3.0);
        }
        if n == 2 {
            // Both neighbours are the same point.
            let both = |row: Row| row[0] + row[2];
            rows = vec![[0.0, rows[0][1], both(rows[0])], [both(rows[1]), rows[1][1], 0.0]];
            solve(&rows, &mut right).map_err(|_| CurveError::Singular)?;
        } else {
            solve_ring(&rows, &mut right).map_err(|_| CurveError::Singular)?;
        }
        right.push(right[0]);
        Spline::hermite(&ring, &right, knots)?.into_closed()
    }

    /// The C1 spline with these points and derivatives at ascending knots.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`], [`CurveError::Count`], [`CurveError::Knot`], [`CurveError::NotFinite`].
    pub fn hermite(points: &[P], derivatives: &[P], knots: &[f64]) -> Result<Spline<P>, CurveError> {
        check(points, knots, points.len())?;
        if derivatives.len() != points.len() {
            return Err(CurveError::Count { actual: derivatives.len(), expected: points.len() });
        }
        let mut control = vec![points[0]];
        for i in 1..points.len() {
            let third = (knots[i] - knots[i - 1]) / 3.0;
            control.push(points[i - 1] + derivatives[i - 1] * third);
            control.push(points[i] - derivatives[i] * third);
            control.push(points[i]);
        }
        Spline::open(control, knots.to_vec())
    }

    /// The spline of Akima 1970: local, without the swings of C2 splines. Derivatives are means of neighbouring slopes,
    /// weighted with the changes of slope on the other side; the plain mean where the slope does not change.
    ///
    /// # Errors
    /// As [`Spline::hermite`].
    pub fn akima(points: &[P], knots: &[f64]) -> Result<Spline<P>, CurveError> {
        check(points, knots, points.len())?;
        let (_, slopes) = steps_and_slopes(points, knots);
        if slopes.len() == 1 {
            return Spline::hermite(points, &[slopes[0]; 2], knots);
        }
        // Two slopes more at each end, in arithmetic progression.
        let count = slopes.len();
        let before = slopes[0] * 2.0 - slopes[1];
        let after = slopes[count - 1] * 2.0 - slopes[count - 2];
        let mut m = vec![before * 2.0 - slopes[0], before];
        m.extend_from_slice(&slopes);
        m.extend([after, after * 2.0 - slopes[count - 1]]);
        let derivative = |i: usize| {
            P::from_components(|axis| {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| m[i + k].component(axis));
                let (left, right) = ((d - c).abs(), (b - a).abs());
                if left + right > 0.0 { (left * b + right * c) / (left + right) } else { 0.5 * (b + c) }
            })
        };
        let derivatives: Vec<P> = (0..points.len()).map(derivative).collect();
        Spline::hermite(points, &derivatives, knots)
    }

    /// The monotone spline of Fritsch, Carlson 1980 with the derivatives of Fritsch, Butland 1984 (PCHIP): in each
    /// component it rises and falls only where the points do.
    ///
    /// # Errors
    /// As [`Spline::hermite`].
    pub fn monotone(points: &[P], knots: &[f64]) -> Result<Spline<P>, CurveError> {
        check(points, knots, points.len())?;
        let (steps, slopes) = steps_and_slopes(points, knots);
        let last = slopes.len() - 1;
        if last == 0 {
            return Spline::hermite(points, &[slopes[0]; 2], knots);
        }
        let mut derivatives = vec![slopes[0].zip(slopes[1], |m, n| one_sided(steps[0], steps[1], m, n))];
        for i in 1..=last {
            let (h, k) = (steps[i - 1], steps[i]);
            derivatives.push(slopes[i - 1].zip(slopes[i], |m, n| harmonic(h, k, m, n)));
        }
        let (h, k) = (steps[last], steps[last - 1]);
        derivatives.push(slopes[last].zip(slopes[last - 1], |m, n| one_sided(h, k, m, n)));
        Spline::hermite(points, &derivatives, knots)
    }

    /// The Catmull-Rom spline through points (Barry, Goldman 1988 for uneven knots): at each point the derivative of the
    /// parabola through it and its neighbours; at the ends of an open spline the slope of the end piece.
    ///
    /// Repeated neighbours, whose knots would coincide, are taken as one point unless the spacing is uniform.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] below two (different) points, [`CurveError::NotFinite`].
    pub fn catmull_rom(points: &[P], spacing: Spacing, closed: bool) -> Result<Spline<P>, CurveError> {
        check_finite(points)?;
        let mut points = points.to_vec();
        if spacing != Spacing::Uniform {
            points.dedup();
            if closed && points.len() > 1 && points[0] == points[points.len() - 1] {
                points.pop();
            }
        }
        if points.len() < 2 {
            return Err(CurveError::TooFewPoints { actual: points.len(), least: 2 });
        }
        if closed {
            points.push(points[0]);
        }
        let knots = spaced(&points, spacing);
        check_knots(&knots)?;
        let (steps, slopes) = steps_and_slopes(&points, &knots);
        let last = slopes.len() - 1;
        let parabolic = |i: usize, j: usize| {
            let share = steps[j] / (steps[i] + steps[j]);
            slopes[i] * share + slopes[j] * (1.0 - share)
        };
        let (first, end) =
            if closed { (parabolic(last, 0), parabolic(last, 0)) } else { (slopes[0], slopes[last]) };
        let mut derivatives = vec![first];
        derivatives.extend((1..=last).map(|i| parabolic(i - 1, i)));
        derivatives.push(end);
        let spline = Spline::hermite(&points, &derivatives, &knots)?;
        if closed { spline.into_closed() } else { Ok(spline) }
    }
}

fn check<P: Blend>(points: &[P], knots: &[f64], expected: usize) -> Result<(), CurveError> {
    if points.len() < 2 {
        return Err(CurveError::TooFewPoints { actual: points.len(), least: 2 });
    }
    if knots.len() != expected {
        return Err(CurveError::Count { actual: knots.len(), expected });
    }
    check_knots(knots)?;
    check_finite(points)
}

fn steps_and_slopes<P: Blend>(points: &[P], knots: &[f64]) -> (Vec<f64>, Vec<P>) {
    let steps: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let slopes = points.windows(2).zip(&steps).map(|(pair, h)| (pair[1] - pair[0]).map(|x| x / h)).collect();
    (steps, slopes)
}

/// Entries of the equation of an end, at it and next to it, and its right-hand side, from step and slope of the piece
/// there and of the next one. `forward` is -1 at the far end.
fn end_row<P: Blend>(
    end: Boundary<P>,
    (h, slope): (f64, P),
    next: Option<(f64, P)>,
    forward: f64,
) -> ([f64; 2], P) {
    match (end, next) {
        (Boundary::First(derivative), _) => ([1.0, 0.0], derivative),
        (Boundary::Second(second), _) => ([2.0, 1.0], slope * 3.0 - second * (0.5 * h * forward)),
        // With a single piece there is no knot to leave out: its own slope.
        (Boundary::NotAKnot, None) => ([1.0, 0.0], slope),
        (Boundary::NotAKnot, Some((k, next))) => {
            let both = h + k;
            let right = (slope * ((h + 2.0 * both) * k) + next * (h * h)).map(|x| x / both);
            ([k, both], right)
        }
    }
}

/// Derivatives at three knots of the parabola through the points.
fn parabola<P: Blend>(steps: &[f64], slopes: &[P]) -> [P; 3] {
    let bend = (slopes[1] - slopes[0]).map(|x| x / (steps[0] + steps[1]));
    [slopes[0] - bend * steps[0], slopes[0] + bend * steps[0], slopes[1] + bend * steps[1]]
}

/// The weighted harmonic mean of two slopes of one sign, else zero.
fn harmonic(h: f64, k: f64, m: f64, n: f64) -> f64 {
    if m == 0.0 || n == 0.0 || (m > 0.0) != (n > 0.0) {
        return 0.0;
    }
    let (w, v) = (2.0 * k + h, k + 2.0 * h);
    (w + v) / (w / m + v / n)
}

/// The derivative at an end, of the parabola through three points, kept from turning back.
fn one_sided(h: f64, k: f64, m: f64, n: f64) -> f64 {
    let d = ((2.0 * h + k) * m - h * n) / (h + k);
    let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
    if sign(d) != sign(m) {
        0.0
    } else if sign(m) != sign(n) && d.abs() > 3.0 * m.abs() {
        3.0 * m
    } else {
        d
    }
}

fn spaced<P: Blend>(points: &[P], spacing: Spacing) -> Vec<f64> {
    if spacing == Spacing::Uniform {
        return uniform_knots(points.len() - 1);
    }
    let mut knots = vec![0.0];
    for pair in points.windows(2) {
        let distance = (pair[1] - pair[0]).norm();
        let step = if spacing == Spacing::Chordal { distance } else { distance.sqrt() };
        knots.push(knots[knots.len() - 1] + step);
    }
    knots
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Continuity, Joint};
    use crate::math::Vec2;
    use proptest::prelude::*;

    fn data() -> impl Strategy<Value = (Vec<Vec2>, Vec<f64>)> {
        prop::collection::vec(((-9.0..9.0_f64, -9.0..9.0_f64), 0.1..2.0_f64), 2..12).prop_map(|rows| {
            let mut knot = 0.0;
            rows.into_iter()
                .map(|(point, step)| {
                    knot += step;
                    (Vec2::from(point), knot)
                })
                .unzip()
        })
    }

    /// Whether derivatives agree to rounding: points are up to 9 and steps down to 0.1, so that second differences of
    /// rounded points, over a squared step, err by about 1e-12.
    fn agrees(joint: &Joint<Vec2>, kind: Continuity) -> bool {
        let [a, b] = joint.first;
        let [c, d] = joint.second;
        (a - b).length() < 1e-11 * (1.0 + a.length())
            && (kind == Continuity::C1 || (c - d).length() < 1e-10 * (1.0 + c.length()))
    }

    proptest! {
        #[test]
        fn all_kinds_interpolate_and_join_smoothly((points, knots) in data()) {
            use Boundary::{First, NotAKnot, Second};
            let n = points.len();
            let mut kinds: Vec<(Spline<Vec2>, Continuity)> = Vec::new();
            for start in [NotAKnot, First(Vec2::ONE), Second(Vec2::ZERO), Second(Vec2::X)] {
                for end in [NotAKnot, First(Vec2::Y), Second(Vec2::ZERO)] {
                    kinds.push((Spline::interpolate(&points, &knots, start, end).unwrap(), Continuity::C2));
                }
            }
            kinds.push((Spline::akima(&points, &knots).unwrap(), Continuity::C1));
            kinds.push((Spline::monotone(&points, &knots).unwrap(), Continuity::C1));
            for (spline, kind) in kinds {
                for (&t, &p) in knots.iter().zip(&points) {
                    prop_assert_eq!(spline.eval(t), p);
                }
                for joint in (1..n - 1).map(|i| spline.joint(i).unwrap()) {
                    prop_assert!(agrees(&joint, kind), "{joint:?}");
                }
            }
            if n > 2 {
                let ring = Spline::periodic(&points[..n - 1], &knots).unwrap();
                for (index, &point) in points[..n - 1].iter().enumerate() {
                    prop_assert_eq!(ring.piece(index).to_array()[0], point);
                    prop_assert!(agrees(&ring.joint(index).unwrap(), Continuity::C2));
                }
            }
        }

        #[test]
        fn catmull_rom_interpolates((points, _) in data(), closed in any::<bool>()) {
            for spacing in [Spacing::Uniform, Spacing::Centripetal, Spacing::Chordal] {
                let spline = Spline::catmull_rom(&points, spacing, closed).unwrap();
                prop_assert_eq!(spline.pieces().len(), points.len() - 1 + usize::from(closed));
                for (index, piece) in spline.pieces().enumerate() {
                    prop_assert_eq!(piece.to_array()[0], points[index]);
                }
                let steps = spline.knots().windows(2).map(|pair| pair[1] - pair[0]);
                let shortest = steps.fold(f64::INFINITY, f64::min);
                for joint in (0..points.len()).filter_map(|i| spline.joint(i)) {
                    // Points up to 9 are rounded, over steps that may be short.
                    let [a, b] = joint.first;
                    prop_assert!((a - b).length() < 1e-13 * (1.0 / shortest + a.length()), "{joint:?}");
                }
            }
        }

        #[test]
        fn monotone_data_stay_monotone(steps in prop::collection::vec((0.01..3.0_f64, 0.0..5.0_f64), 2..12)) {
            let (mut t, mut y) = (0.0, 0.0);
            let (knots, values): (Vec<f64>, Vec<f64>) = steps.iter().map(|(h, rise)| { t += h; y += rise; (t, y) }).unzip();
            let spline = Spline::monotone(&values, &knots).unwrap();
            for piece in spline.pieces() {
                let samples: Vec<f64> =
                    (0..=64).map(|k| crate::curve::Bernstein::eval(&piece, f64::from(k) / 64.0)).collect();
                prop_assert!(samples.windows(2).all(|pair| pair[1] >= pair[0] - 1e-13));
            }
        }
    }

    #[test]
    fn uniform_catmull_rom_is_the_textbook_one() {
        let points = [(0.0, 0.0), (1.0, 2.0), (3.0, 1.0), (4.0, 4.0)].map(Vec2::from);
        let spline = Spline::catmull_rom(&points, Spacing::Uniform, false).unwrap();
        let piece = crate::curve::Cubic::from_catmull_rom(points).unwrap();
        for (a, b) in spline.piece(1).to_array().iter().zip(piece.to_array()) {
            assert!((*a - b).length() < 1e-15);
        }
    }
}
