use super::differential::{Curve, Jet, jet};
use super::subdivide::{elevate, restrict};
use super::{CurveError, check_finite, check_unit, evaluate};
use crate::math::{Vec3, Vec4};

/// A rational Bézier curve in space: control points with positive weights, any degree. Conics are exact.
///
/// The points are kept homogeneous, (w x, w y, w z, w).
#[derive(Clone, Debug, PartialEq)]
pub struct Rational {
    points: Vec<Vec4>,
}

impl Rational {
    /// The curve with these control points and weights.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] for none, [`CurveError::Count`] when there is not a weight for each point,
    /// [`CurveError::Weight`] for one that is not a positive number, [`CurveError::NotFinite`] for a point that is not
    /// finite or not once it is multiplied by its weight.
    pub fn new(points: &[Vec3], weights: &[f64]) -> Result<Rational, CurveError> {
        if points.is_empty() {
            return Err(CurveError::TooFewPoints { actual: 0, least: 1 });
        }
        if points.len() != weights.len() {
            return Err(CurveError::Count { actual: weights.len(), expected: points.len() });
        }
        if let Some(index) = weights.iter().position(|w| !(w.is_normal() && *w > 0.0)) {
            return Err(CurveError::Weight { index });
        }
        let homogeneous: Vec<Vec4> = points.iter().zip(weights).map(|(&p, &w)| (p * w).extend(w)).collect();
        check_finite(&homogeneous)?;
        Ok(Rational { points: homogeneous })
    }

    /// The homogeneous control points.
    pub fn points(&self) -> &[Vec4] {
        &self.points
    }

    /// The degree.
    pub fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// The point at a parameter in [0, 1]; the error is that of an evaluation in each homogeneous component. Outside
    /// of [0, 1] the weight may vanish, and the point is then not finite.
    pub fn eval(&self, t: f64) -> Vec3 {
        let h = evaluate::eval(&self.points, t);
        Vec3::new(h.x / h.w, h.y / h.w, h.z / h.w)
    }

    /// Both parts of the curve at `t`.
    ///
    /// # Errors
    /// [`CurveError::Parameter`] when `t` is not within [0, 1].
    pub fn split(&self, t: f64) -> Result<(Rational, Rational), CurveError> {
        check_unit(t)?;
        let (mut left, mut right) = (self.clone(), self.clone());
        restrict(&mut left.points, 0.0, t);
        restrict(&mut right.points, t, 1.0);
        Ok((left, right))
    }

    /// The same curve written with a degree higher by one.
    pub fn elevated(&self) -> Rational {
        let mut points = self.points.clone();
        points.push(Vec4::ZERO);
        elevate(&mut points);
        Rational { points }
    }

    /// The same curve run backward.
    pub fn reversed(&self) -> Rational {
        Rational { points: self.points.iter().rev().copied().collect() }
    }
}

impl Curve for Rational {
    type Point = Vec3;

    fn domain(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    /// Quotient rule: from `h = w p` follows `w p' = h' - w' p`, and so on with binomials.
    fn jet(&self, t: f64) -> Jet<Vec3> {
        let h = jet(&self.points, t);
        let space = |v: Vec4| Vec3::new(v.x, v.y, v.z);
        let w = [h.point.w, h.first.w, h.second.w, h.third.w];
        let over = |v: Vec3| v / w[0];
        let point = self.eval(t);
        let first = over(space(h.first) - point * w[1]);
        let second = over(space(h.second) - first * (2.0 * w[1]) - point * w[2]);
        let third = over(space(h.third) - second * (3.0 * w[1]) - first * (3.0 * w[2]) - point * w[3]);
        Jet { point, first, second, third }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarter_circle() -> Rational {
        let weight = 0.5_f64.sqrt();
        Rational::new(&[Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y], &[1.0, weight, 1.0]).unwrap()
    }

    #[test]
    fn a_circle_is_a_circle() {
        let high = quarter_circle().elevated().elevated();
        for k in 0..=64 {
            let t = f64::from(k) / 64.0;
            assert!((quarter_circle().eval(t).length() - 1.0).abs() < 4e-16);
            assert!((high.eval(t) - quarter_circle().eval(t)).length() < 1e-15);
            let jet = quarter_circle().jet(t);
            assert!((jet.curvature() - 1.0).abs() < 1e-14 && jet.first.dot(jet.point).abs() < 1e-15);
            // Third derivative against a difference of second ones.
            let step = 1e-5;
            let slope = (quarter_circle().jet(t + step).second - quarter_circle().jet(t - step).second)
                / (2.0 * step);
            assert!((slope - jet.third).length() < 1e-7);
        }
        let (left, right) = quarter_circle().split(0.3).unwrap();
        assert!(
            (left.eval(0.5).length() - 1.0).abs() < 1e-15 && (right.eval(1.0) - Vec3::Y).length() < 1e-15
        );
    }

    #[test]
    fn wrong_weights_are_named() {
        assert_eq!(Rational::new(&[Vec3::X], &[0.0]), Err(CurveError::Weight { index: 0 }));
        assert_eq!(Rational::new(&[Vec3::X], &[]), Err(CurveError::Count { actual: 0, expected: 1 }));
        assert_eq!(Rational::new(&[], &[]), Err(CurveError::TooFewPoints { actual: 0, least: 1 }));
        assert_eq!(Rational::new(&[Vec3::X * 1e308], &[10.0]), Err(CurveError::NotFinite { index: 0 }));
    }
}
