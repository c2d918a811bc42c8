use super::bernstein::binomials;
use super::{AnyBezier, Bernstein, Cubic, CurveError};
use crate::math::Blend;

impl<P: Blend> AnyBezier<P> {
    /// The curve with these coefficients of 1, t, t^2 and so on: `b_i = sum_k C(i, k) / C(n, k) a_k`.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] for none, [`CurveError::NotFinite`] when a control point is not finite.
    pub fn from_monomials(coefficients: &[P]) -> Result<AnyBezier<P>, CurveError> {
        let Some(n) = coefficients.len().checked_sub(1) else {
            return Err(CurveError::TooFewPoints { actual: 0, least: 1 });
        };
        // Summing the scaled coefficients n times is the binomial sum without binomials of i.
        let mut row: Vec<P> = coefficients.iter().zip(binomials(n)).map(|(&a, c)| a.map(|x| x / c)).collect();
        for first in (0..n).rev() {
            for i in first..n {
                row[i + 1] = row[i + 1] + row[i];
            }
        }
        AnyBezier::new(row)
    }
}

/// Coefficients of 1, t, t^2 and so on: `a_k = C(n, k)` times the k-th difference of the first control points.
///
/// Ill-conditioned: rounding grows like 3^n; degree 30 has no digit left. Coefficients may overflow to infinity.
pub fn monomials<C: Bernstein>(curve: &C) -> Vec<C::Vector> {
    let n = curve.degree();
    let mut row = curve.points().to_vec();
    for order in 1..=n {
        for i in (order..=n).rev() {
            row[i] = row[i] - row[i - 1];
        }
    }
    row.iter().zip(binomials(n)).map(|(&a, c)| a * c).collect()
}

impl<P: Blend> Cubic<P> {
    /// The cubic from `start` to `end` with these derivatives at the ends.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when a control point is not finite.
    pub fn from_hermite(
        start: P,
        end: P,
        start_derivative: P,
        end_derivative: P,
    ) -> Result<Cubic<P>, CurveError> {
        let third = |v: P| v.map(|x| x / 3.0);
        Cubic::new([start, start + third(start_derivative), end - third(end_derivative), end])
    }

    /// End points and derivatives at the ends, as [`Cubic::from_hermite`] takes them.
    pub fn to_hermite(&self) -> [P; 4] {
        let [a, b, c, d] = self.to_array();
        [a, d, (b - a) * 3.0, (d - c) * 3.0]
    }

    /// The piece of the uniform Catmull-Rom spline between the middle two of four points (Catmull, Rom 1974).
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when a control point is not finite.
    pub fn from_catmull_rom(points: [P; 4]) -> Result<Cubic<P>, CurveError> {
        let [before, start, end, after] = points;
        let sixth = |v: P| v.map(|x| x / 6.0);
        Cubic::new([start, start + sixth(end - before), end - sixth(after - start), end])
    }

    /// The four points whose uniform Catmull-Rom piece this is.
    pub fn to_catmull_rom(&self) -> [P; 4] {
        let [a, b, c, d] = self.to_array();
        [d - (b - a) * 6.0, a, d, a + (d - c) * 6.0]
    }

    /// The piece of the uniform cubic B-spline with these four control points.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when a control point is not finite.
    pub fn from_b_spline(points: [P; 4]) -> Result<Cubic<P>, CurveError> {
        let [a, b, c, d] = points;
        let third = |near: P, far: P| (near * 2.0 + far).map(|x| x / 3.0);
        let (before, first, second, after) = (third(b, a), third(b, c), third(c, b), third(c, d));
        Cubic::new([(before + first) * 0.5, first, second, (second + after) * 0.5])
    }

    /// The four control points of the uniform cubic B-spline whose piece this is.
    pub fn to_b_spline(&self) -> [P; 4] {
        let [a, b, c, d] = self.to_array();
        let (second, third) = (b * 2.0 - c, c * 2.0 - b);
        [(a * 2.0 - b) * 3.0 - second * 2.0, second, third, (d * 2.0 - c) * 3.0 - third * 2.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec2;
    use proptest::prelude::*;

    fn cubic() -> impl Strategy<Value = Cubic<Vec2>> {
        let point = (-10.0..10.0_f64, -10.0..10.0_f64).prop_map(Vec2::from);
        prop::array::uniform4(point).prop_map(|points| Cubic::new(points).unwrap())
    }

    fn near(a: &[Vec2], b: &[Vec2]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(p, q)| (*p - *q).length() < 1e-12)
    }

    proptest! {
        #[test]
        fn every_form_and_back(curve in cubic()) {
            let points = curve.to_array();
            prop_assert!(near(AnyBezier::from_monomials(&monomials(&curve)).unwrap().points(), &points));
            let [a, b, c, d] = curve.to_hermite();
            prop_assert!(near(Cubic::from_hermite(a, b, c, d).unwrap().points(), &points));
            let again = Cubic::from_catmull_rom(curve.to_catmull_rom()).unwrap();
            prop_assert!(near(again.points(), &points));
            prop_assert!(near(Cubic::from_b_spline(curve.to_b_spline()).unwrap().points(), &points));
        }

        #[test]
        fn monomials_have_the_same_values(curve in cubic(), t in 0.0..1.0_f64) {
            let value = crate::curve::evaluate::horner(&monomials(&curve), t);
            prop_assert!((value - curve.eval(t)).length() < 1e-13 * 10.0);
        }
    }

    #[test]
    fn the_cube_has_known_forms() {
        let cube = AnyBezier::from_monomials(&[0.0, 0.0, 0.0, 1.0]).unwrap();
        assert_eq!(cube.points(), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(monomials(&cube), [0.0, 0.0, 0.0, 1.0]);
        // The middle basis function of the uniform cubic B-spline at the middle of its support is 2/3.
        assert_eq!(Cubic::from_b_spline([0.0, 1.0, 0.0, 0.0]).unwrap().start(), 2.0 / 3.0);
        let error = AnyBezier::<f64>::from_monomials(&[]).unwrap_err();
        assert_eq!(error, CurveError::TooFewPoints { actual: 0, least: 1 });
    }
}
