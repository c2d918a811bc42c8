use super::spline::{Spline, uniform_knots};
use super::{Bernstein, Cubic, CurveError, check_finite};
use crate::math::Blend;

impl<P: Blend> Spline<P> {
    /// The cubic B-spline with these control points and knots, four more than points, as Bézier pieces over the knots
    /// from the fourth to the fourth from the end.
    ///
    /// Knots may repeat up to three times (at the ends of the list four times): each repetition costs an order of
    /// smoothness. The points of a piece from a to b are the blossom's values at aaa, aab, abb, bbb (Ramshaw 1989).
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] below four points, [`CurveError::Count`], [`CurveError::NotFinite`], and
    /// [`CurveError::Knot`] for one that is not finite, smaller than the one before, or repeated too often.
    pub fn from_b_spline(points: &[P], knots: &[f64]) -> Result<Spline<P>, CurveError> {
        if points.len() < 4 {
            return Err(CurveError::TooFewPoints { actual: points.len(), least: 4 });
        }
        if knots.len() != points.len() + 4 {
            return Err(CurveError::Count { actual: knots.len(), expected: points.len() + 4 });
        }
        check_finite(points)?;
        check_repeated(knots)?;
        let mut control = Vec::new();
        let mut bounds = Vec::new();
        for i in 3..points.len() {
            let (a, b) = (knots[i], knots[i + 1]);
            if a == b {
                continue;
            }
            if control.is_empty() {
                control.push(blossom(points, knots, i, [a, a, a]));
                bounds.push(a);
            }
            control.extend([[a, a, b], [a, b, b], [b, b, b]].map(|at| blossom(points, knots, i, at)));
            bounds.push(b);
        }
        if control.is_empty() {
            return Err(CurveError::Knot { index: points.len() });
        }
        Spline::open(control, bounds)
    }

    /// The uniform cubic B-spline with these control points: C2, near the points but not through them. Closed, it has
    /// a piece for each point; open, three less.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] below four points, closed below three; [`CurveError::NotFinite`].
    pub fn from_uniform_b_spline(points: &[P], closed: bool) -> Result<Spline<P>, CurveError> {
        let least = if closed { 3 } else { 4 };
        if points.len() < least {
            return Err(CurveError::TooFewPoints { actual: points.len(), least });
        }
        check_finite(points)?;
        let count = points.len();
        let pieces = if closed { count } else { count - 3 };
        let mut control = Vec::new();
        for i in 0..pieces {
            let piece = Cubic::from_b_spline([0, 1, 2, 3].map(|k| points[(i + k) % count]))?;
            control.extend_from_slice(&piece.points()[..3]);
            if i + 1 == pieces && !closed {
                control.push(piece.end());
            }
        }
        let knots = uniform_knots(pieces);
        if closed { Spline::closed(control, knots) } else { Spline::open(control, knots) }
    }
}

fn check_repeated(knots: &[f64]) -> Result<(), CurveError> {
    let inner = 1..knots.len() - 4;
    for (index, &knot) in knots.iter().enumerate() {
        let falls = index > 0 && knot < knots[index - 1];
        let repeated = inner.contains(&index) && knots[index + 3] == knot && knot != knots[0];
        let ends_repeated = index >= 4 && knots[index - 4] == knot;
        let at_far_end = repeated && knot == knots[knots.len() - 1];
        if !knot.is_finite() || falls || (repeated && !at_far_end) || ends_repeated {
            return Err(CurveError::Knot { index });
        }
    }
    Ok(())
}

/// The value of the blossom of the piece over knots `i` and `i + 1` (de Boor 1972, with an argument for each round).
fn blossom<P: Blend>(points: &[P], knots: &[f64], i: usize, arguments: [f64; 3]) -> P {
    let mut row = [0, 1, 2, 3].map(|k| points[i - 3 + k]);
    for (round, &u) in arguments.iter().enumerate() {
        for k in 0..3 - round {
            let (low, high) = (knots[i - 2 + k + round], knots[i + 1 + k]);
            let share = (u - low) / (high - low);
            row[k] = row[k] * (1.0 - share) + row[k + 1] * share;
        }
    }
    row[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Continuity;
    use crate::math::Vec2;

    fn points(count: u32) -> Vec<Vec2> {
        (0..count).map(|k| Vec2::new(f64::from(k * k % 7), f64::from(k * 3 % 5))).collect()
    }

    #[test]
    fn uneven_knots_and_even_ones_agree_where_they_should() {
        let uniform = Spline::from_uniform_b_spline(&points(9), false).unwrap();
        let knots: Vec<f64> = (-3..10).map(f64::from).collect();
        let general = Spline::from_b_spline(&points(9), &knots).unwrap();
        assert_eq!(uniform.knots(), general.knots());
        for (a, b) in uniform.points().iter().zip(general.points()) {
            assert!((*a - *b).length() < 1e-14);
        }
    }

    #[test]
    fn knots_decide_the_smoothness() {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 1.7, 1.7, 3.0, 3.0, 3.0, 4.0, 4.0, 4.0, 4.0];
        let spline = Spline::from_b_spline(&points(10), &knots).unwrap();
        assert_eq!(spline.knots(), [0.0, 1.0, 1.7, 3.0, 4.0]);
        assert_eq!((spline.points()[0], spline.points()[12]), (points(10)[0], points(10)[9]));
        assert!(spline.joint(1).unwrap().misfit(Continuity::C2) < 1e-13);
        assert!(spline.joint(2).unwrap().misfit(Continuity::C1) < 1e-13);
        assert!(spline.joint(2).unwrap().misfit(Continuity::C2) > 0.1);
        assert!(spline.joint(3).unwrap().misfit(Continuity::C1) > 0.1);
        let ring = Spline::from_uniform_b_spline(&points(5), true).unwrap();
        assert!((0..5).all(|i| ring.joint(i).unwrap().misfit(Continuity::C2) < 1e-13));
    }

    #[test]
    fn wrong_knots_are_named() {
        let wrong = |knots: [f64; 9]| Spline::from_b_spline(&points(5), &knots).unwrap_err();
        assert_eq!(wrong([0.0, 1.0, 2.0, 3.0, 2.5, 5.0, 6.0, 7.0, 8.0]), CurveError::Knot { index: 4 });
        assert_eq!(wrong([0.0, 1.0, 2.0, 2.0, 2.0, 2.0, 6.0, 7.0, 8.0]), CurveError::Knot { index: 2 });
        assert_eq!(wrong([0.0; 9]), CurveError::Knot { index: 4 });
        assert_eq!(wrong([0.0, 0.0, 0.0, 0.0, f64::NAN, 1.0, 1.0, 1.0, 1.0]), CurveError::Knot { index: 4 });
        let few = Spline::from_b_spline(&points(3), &[0.0; 7]).unwrap_err();
        assert_eq!(few, CurveError::TooFewPoints { actual: 3, least: 4 });
    }
}
