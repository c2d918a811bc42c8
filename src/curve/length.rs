//! Arc length and its inverse, to a given accuracy, with a proved bound.
//!
//! The speed is the square root of q = D . D, D the derivative. On a piece, let c be D in its middle and r the most
//! that D can differ from c in the complex disk of radius R times the half piece, from Taylor coefficients. Where
//! r < (sqrt 2 - 1) |c|, q has no root in the disk, the speed is analytic in it and at most |c| + r, and Gauss'
//! quadrature has the bound of [`error_bound`]. Around cusps no such disk exists: there pieces are halved until the
//! control polygon is not longer than the chord by more than the accuracy, which is soon, since both shrink with the
//! square of the piece.

use super::bernstein::{binomials, inner_product, roots};
use super::evaluate::{de_casteljau, triangle};
use super::subdivide::{derivative, reciprocal_powers, restrict, with_unit_size};
use super::{Bernstein, Bounded, CurveError, Spline, check_tolerance, length_cubic};
use crate::math::Blend;
use crate::numeric::quadrature::{GAUSS_16, error_bound, integrate};
use crate::numeric::roots::bracketed;

/// The length of a curve. The error is at most `accuracy`, or what rounding allows where that is coarser.
///
/// # Errors
/// [`CurveError::Tolerance`] when `accuracy` is not a positive number, [`CurveError::NotFinite`] when the length
/// exceeds the range of `f64`.
pub fn length<C: Bernstein>(curve: &C, accuracy: f64) -> Result<Bounded<f64>, CurveError> {
    if let (2, &[a, b, c, d]) = (C::Vector::DIMENSION, curve.points()) {
        check_tolerance(accuracy)?;
        if let Some(length) =
            length_cubic::length([a, b, c, d].map(|p| [p.component(0), p.component(1)]), accuracy)
        {
            return Ok(length);
        }
    }
    Ok(ArcLength::new(curve, accuracy)?.total())
}

/// The length of a curve as a function of its parameter, both ways.
#[derive(Clone, Debug)]
pub struct ArcLength<P> {
    pieces: Vec<Piece<P>>,
    /// Two factors that bring lengths back to the curve's size.
    scale: [f64; 2],
    total: Bounded<f64>,
}

/// A piece whose length is known well enough.
#[derive(Clone, Debug)]
struct Piece<P> {
    low: f64,
    high: f64,
    /// Length of all pieces before it.
    before: f64,
    length: f64,
    error: f64,
    /// Bernstein coefficients of the derivative by the piece's own parameter.
    velocity: Vec<P>,
    /// Whether quadrature is certified; otherwise the length is that of the chord and polygon.
    smooth: bool,
}

impl<P: Blend> ArcLength<P> {
    /// Measures a curve.
    ///
    /// # Errors
    /// As [`length`].
    pub fn new<C: Bernstein<Vector = P>>(curve: &C, accuracy: f64) -> Result<ArcLength<P>, CurveError> {
        ArcLength::measure(&[curve.points().to_vec()], &[0.0, 1.0], accuracy)
    }

    /// Measures a spline, over its own parameter.
    ///
    /// # Errors
    /// As [`length`].
    pub fn of_spline(spline: &Spline<P>, accuracy: f64) -> Result<ArcLength<P>, CurveError> {
        let pieces: Vec<Vec<P>> = spline.pieces().map(|piece| piece.to_array().to_vec()).collect();
        ArcLength::measure(&pieces, spline.knots(), accuracy)
    }

    fn measure(curves: &[Vec<P>], knots: &[f64], accuracy: f64) -> Result<ArcLength<P>, CurveError> {
        check_tolerance(accuracy)?;
        let size = curves.iter().flatten().fold(0.0, |most: f64, point| most.max(point.max_abs()));
        let [first, second] = if size > 0.0 { reciprocal_powers(size) } else { [1.0, 1.0] };
        // Finer than rounding is not to be had.
        let wish = (accuracy * first * second).clamp(f64::EPSILON, f64::MAX) / curves.len() as f64;
        let (mut pieces, mut rounding) = (Vec::new(), 0.0);
        for (points, knots) in curves.iter().zip(knots.windows(2)) {
            let unit: Vec<P> = points.iter().map(|&point| point * first * second).collect();
            let velocity = derivative(&unit, 1);
            let polygon = unit.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>();
            rounding += (points.len() as f64 + 8.0) * f64::EPSILON * polygon;
            pieces.extend(measured(&velocity, knots[0], knots[1], wish));
        }
        let mut before = 0.0;
        let mut error = rounding;
        for piece in &mut pieces {
            piece.before = before;
            before += piece.length;
            error += piece.error;
        }
        let scale = [1.0 / first, 1.0 / second];
        let back = |x: f64| x * scale[0] * scale[1];
        let total = Bounded { value: back(before), error: back(error).next_up() };
        if !total.value.is_finite() {
            return Err(CurveError::NotFinite { index: 0 });
        }
        Ok(ArcLength { pieces, scale, total })
    }

    /// The whole length.
    pub fn total(&self) -> Bounded<f64> {
        self.total
    }

    /// The length up to a parameter, to the accuracy of the whole; 0 before the curve and all of it after.
    pub fn length_to(&self, t: f64) -> f64 {
        let index = self.pieces.partition_point(|piece| piece.low <= t).saturating_sub(1);
        let piece = &self.pieces[index];
        let local = ((t - piece.low) / (piece.high - piece.low)).clamp(0.0, 1.0);
        (piece.before + piece.length_to(local)) * self.scale[0] * self.scale[1]
    }

    /// The parameter at which the length is reached: the length there is right to the accuracy of the whole. The ends
    /// for lengths outside of the curve, and the start of a curve of no length.
    pub fn parameter(&self, length: f64) -> f64 {
        let length = length / self.scale[0] / self.scale[1];
        let reached = |piece: &Piece<P>| piece.before + piece.length <= length;
        let index = self.pieces.partition_point(reached).min(self.pieces.len() - 1);
        let piece = &self.pieces[index];
        let rest = (length - piece.before).clamp(0.0, piece.length);
        let local = bracketed(|s| piece.length_to(s) - rest, 0.0, 1.0);
        piece.low + local * (piece.high - piece.low)
    }

    /// `count` parameters that cut the curve into `count - 1` parts of equal length.
    pub fn evenly(&self, count: usize) -> Vec<f64> {
        let steps = count.saturating_sub(1).max(1) as f64;
        (0..count).map(|k| self.parameter(self.total.value * (k as f64 / steps))).collect()
    }
}

impl<P: Blend> Piece<P> {
    /// The length up to a parameter of the piece.
    fn length_to(&self, s: f64) -> f64 {
        if s == 1.0 {
            return self.length;
        }
        if self.smooth {
            let mut part = self.velocity.clone();
            restrict(&mut part, 0.0, s);
            return s * integrate(GAUSS_16, 0.0, 1.0, |t| de_casteljau(&part, t).norm());
        }
        s * self.length
    }
}

/// The pieces of one curve, given by its derivative, whose errors sum up to at most `accuracy`.
fn measured<P: Blend>(velocity: &[P], low: f64, high: f64, accuracy: f64) -> Vec<Piece<P>> {
    let mut share = accuracy;
    loop {
        let mut pieces = Vec::new();
        halve(velocity.to_vec(), low, high, (0, share), &mut pieces);
        if pieces.iter().map(|piece| piece.error).sum::<f64>() <= accuracy {
            return pieces;
        }
        // Allowances below are generous where the curve has many cusps.
        share *= 0.25;
    }
}

fn halve<P: Blend>(
    velocity: Vec<P>,
    low: f64,
    high: f64,
    (depth, accuracy): (i32, f64),
    pieces: &mut Vec<Piece<P>>,
) {
    let width = 0.5_f64.powi(depth);
    let singular_points = 16.0 * velocity.len() as f64;
    let (length, error, smooth) = estimate(&velocity);
    // Plain pieces are many and narrow, pieces around a cusp few whatever their width.
    let allowed = 0.5 * accuracy * (width + width.sqrt().sqrt() / singular_points);
    let middle = low + 0.5 * (high - low);
    if error <= allowed || middle <= low || middle >= high {
        return pieces.push(Piece { low, high, before: 0.0, length, error, velocity, smooth });
    }
    for (from, to, low, high) in [(0.0, 0.5, low, middle), (0.5, 1.0, middle, high)] {
        let mut half = velocity.clone();
        restrict(&mut half, from, to);
        for v in &mut half {
            *v = *v * 0.5;
        }
        halve(half, low, high, (depth + 1, accuracy), pieces);
    }
}

/// Length, bound of its error, and whether it comes from quadrature.
fn estimate<P: Blend>(velocity: &[P]) -> (f64, f64, bool) {
    let bound = quadrature_bound(velocity);
    let m = velocity.len() as f64;
    let polygon = velocity.iter().map(|v| v.norm() / m).sum::<f64>();
    let chord = velocity.iter().fold(P::ZERO, |sum, &v| sum + v * (1.0 / m)).norm();
    let spread = 0.5 * (polygon - chord).max(0.0);
    if spread < bound {
        (0.5 * (polygon + chord), spread, false)
    } else {
        (integrate(GAUSS_16, 0.0, 1.0, |t| de_casteljau(velocity, t).norm()), bound, true)
    }
}

fn quadrature_bound<P: Blend>(velocity: &[P]) -> f64 {
    let m = velocity.len() - 1;
    if m == 0 {
        return 0.0;
    }
    let rows = triangle(velocity, 0.5);
    let middle = rows[m][0].norm();
    // Norms of Taylor coefficients in w = 2 t - 1.
    let coefficients: Vec<f64> = (1..=m)
        .zip(&binomials(m)[1..])
        .map(|(k, binomial)| {
            let mut row = rows[m - k].clone();
            for _ in 0..k {
                row = row.windows(2).map(|pair| pair[1] - pair[0]).collect();
            }
            row[0].norm() * binomial * 0.5_f64.powi(k as i32)
        })
        .collect();
    let bounds = [3.0, 2.0, 1.5, 1.25_f64].map(|radius| {
        let reach = coefficients.iter().rev().fold(0.0, |sum, c| (sum + c) * radius);
        let rho = radius + (radius * radius - 1.0).sqrt();
        if reach < 0.41 * middle { 0.5 * error_bound(GAUSS_16, middle + reach, rho) } else { f64::INFINITY }
    });
    bounds.into_iter().fold(f64::INFINITY, f64::min)
}

/// Parameters inside (0, 1), ascending, where the speed has a local minimum or vanishes.
pub fn speed_minima<C: Bernstein>(curve: &C) -> Vec<f64> {
    let mut points = curve.points().to_vec();
    if points.len() < 3 {
        return Vec::new();
    }
    with_unit_size(&mut points, |points| {
        let velocity = derivative(points, 1);
        let square = inner_product(&velocity, &velocity);
        let slope = derivative(&square, 1);
        let size = square.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let error = 4.0 * square.len() as f64 * f64::EPSILON * size;
        let turns = roots(&slope, error).isolated();
        let rising = |t: f64| de_casteljau(&derivative(&slope, 1), t) > 0.0;
        turns.iter().map(|turn| turn.t).filter(|&t| t > 0.0 && t < 1.0 && rising(t)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Cubic;
    use crate::math::Vec2;
    use proptest::prelude::*;

    fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
        Cubic::new(points.map(Vec2::from)).unwrap()
    }

    #[test]
    fn known_lengths_at_every_accuracy() {
        let cases = [
            ([(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)], 182.84271247461902),
            ([(0.0, 0.0), (100.0, 100.0), (1e-6, 100.0), (100.0, 0.0)], 182.84271234593936),
            ([(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)], 211.85463666161536),
            ([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (100.0, 100.0)], 167.65426274202858),
            ([(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)], 141.21749836278772),
            ([(0.0, 0.0), (200.0, 0.0), (-100.0, 0.0), (100.0, 0.0)], 189.4427190999916),
        ];
        for (points, want) in cases {
            for accuracy in [1.0, 1e-3, 1e-6, 1e-9, 1e-12] {
                let got = length(&cubic(points), accuracy).unwrap();
                assert!((got.value - want).abs() <= got.error, "{points:?}: {got:?} for {want}");
                assert!(got.error <= accuracy + 1e-12, "{points:?} at {accuracy}: {}", got.error);
            }
        }
    }

    #[test]
    fn inverse_at_a_cusp() {
        let cusp = cubic([(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)]);
        let arc = ArcLength::new(&cusp, 1e-12).unwrap();
        assert!((arc.parameter(0.5 * arc.total().value) - 0.5).abs() < 1e-6);
        for k in 0..=20 {
            let s = arc.total().value * f64::from(k) / 20.0;
            assert!((arc.length_to(arc.parameter(s)) - s).abs() < 1e-11, "{k}");
        }
        assert_eq!((arc.parameter(-1.0), arc.parameter(1e9)), (0.0, 1.0));
        assert_eq!(speed_minima(&cusp), [0.5]);
    }

    proptest! {
        #[test]
        fn lengths_add_up(
            points in prop::array::uniform4((-1.0..1.0_f64, -1.0..1.0_f64)), t in 0.0..1.0_f64,
        ) {
            let curve = cubic(points);
            let (left, right) = curve.split(t).unwrap();
            let [whole, a, b] = [&curve, &left, &right].map(|part| length(part, 1e-13).unwrap());
            prop_assert!((whole.value - a.value - b.value).abs() <= whole.error + a.error + b.error + 1e-15);
            let arc = ArcLength::new(&curve, 1e-13).unwrap();
            prop_assert!((arc.length_to(t) - a.value).abs() < 1e-12);
            let evenly = arc.evenly(5);
            prop_assert!(evenly.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }
}
