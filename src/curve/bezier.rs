use super::{Bounded, CurveError, batch, bounded, check_finite, evaluate, subdivide};
use crate::math::Blend;

/// A Bézier curve with `N` control points, degree `N - 1`. All its points are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bezier<P, const N: usize> {
    points: [P; N],
}

/// The straight line from one point to another.
pub type Line<P> = Bezier<P, 2>;
/// A curve of degree 2.
pub type Quadratic<P> = Bezier<P, 3>;
/// A curve of degree 3.
pub type Cubic<P> = Bezier<P, 4>;

/// A Bézier curve with any number of control points, at least one. All its points are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct AnyBezier<P> {
    points: Vec<P>,
}

impl<P: Blend, const N: usize> Bezier<P, N> {
    /// The curve with these control points.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] for the first point that is NaN or infinite, [`CurveError::TooFewPoints`] when `N` is 0.
    pub fn new(points: [P; N]) -> Result<Bezier<P, N>, CurveError> {
        check_points(&points)?;
        Ok(Bezier { points })
    }

    /// A curve whose points are known to be finite.
    pub(super) fn assume(points: [P; N]) -> Bezier<P, N> {
        debug_assert!(check_points(&points).is_ok());
        Bezier { points }
    }

    /// The control points.
    pub fn to_array(self) -> [P; N] {
        self.points
    }

    /// The same curve with `M >= N` control points, that is of degree `M - 1` ([`AnyBezier::elevated`]).
    pub fn elevated<const M: usize>(&self) -> Bezier<P, M> {
        const { assert!(M >= N, "elevation does not lower the degree") };
        let mut points = [P::ZERO; M];
        points[..N].copy_from_slice(&self.points);
        for n in N..M {
            subdivide::elevate(&mut points[..=n]);
        }
        Bezier { points }
    }
}

impl<P: Blend> AnyBezier<P> {
    /// The curve with these control points.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] for the first point that is NaN or infinite, [`CurveError::TooFewPoints`] for none.
    pub fn new(points: Vec<P>) -> Result<AnyBezier<P>, CurveError> {
        check_points(&points)?;
        Ok(AnyBezier { points })
    }

    /// A curve whose points are known to be finite.
    pub(super) fn assume(points: Vec<P>) -> AnyBezier<P> {
        debug_assert!(check_points(&points).is_ok());
        AnyBezier { points }
    }

    /// The control points.
    pub fn into_points(self) -> Vec<P> {
        self.points
    }

    /// The same curve written with a degree higher by `by`; each step costs a blend a point and errs by at most 2 u
    /// of the neighbouring control points.
    pub fn elevated(&self, by: usize) -> AnyBezier<P> {
        let mut points = self.points.clone();
        for _ in 0..by {
            points.push(P::ZERO);
            subdivide::elevate(&mut points);
        }
        AnyBezier { points }
    }
}

fn check_points<P: Blend>(points: &[P]) -> Result<(), CurveError> {
    if points.is_empty() {
        return Err(CurveError::TooFewPoints { actual: 0, least: 1 });
    }
    check_finite(points)
}

pub(super) mod sealed {
    use super::{AnyBezier, Bezier};

    /// Access to the points for those who keep them finite.
    pub trait Storage: Clone {
        type Point;
        fn storage(&self) -> &[Self::Point];
        fn storage_mut(&mut self) -> &mut [Self::Point];
    }

    impl<P: Copy, const N: usize> Storage for Bezier<P, N> {
        type Point = P;

        #[inline]
        fn storage(&self) -> &[P] {
            &self.points
        }

        #[inline]
        fn storage_mut(&mut self) -> &mut [P] {
            &mut self.points
        }
    }

    impl<P: Clone> Storage for AnyBezier<P> {
        type Point = P;

        #[inline]
        fn storage(&self) -> &[P] {
            &self.points
        }

        #[inline]
        fn storage_mut(&mut self) -> &mut [P] {
            &mut self.points
        }
    }
}

/// A polynomial curve in Bernstein form over [0, 1]: what [`Bezier`] and [`AnyBezier`] have in common.
pub trait Bernstein: sealed::Storage<Point = Self::Vector> {
    /// A point or vector of the curve's space.
    type Vector: Blend;

    /// The control points: at least one, all finite.
    #[inline]
    fn points(&self) -> &[Self::Vector] {
        self.storage()
    }

    /// The degree with which the curve is written, one less than the number of points.
    #[inline]
    fn degree(&self) -> usize {
        self.points().len() - 1
    }

    /// The point at parameter 0, a control point.
    fn start(&self) -> Self::Vector {
        self.points()[0]
    }

    /// The point at parameter 1, a control point.
    fn end(&self) -> Self::Vector {
        self.points()[self.degree()]
    }

    /// The point at a parameter; exact at 0 and 1.
    ///
    /// Within [0, 1] the method is picked by degree ([`evaluate::de_casteljau`] up to 8,
    /// [`evaluate::horner_bernstein`] up to 512, [`evaluate::wozny_chudy`] beyond); curves near the limits of `f64`
    /// are scaled by a power of two on the way; and a coordinate that lost more than half of its digits to
    /// cancellation (condition above 2^26) is computed again by [`evaluate::compensated`]. So each coordinate has a
    /// relative error of at most about 2^-26, and of a few units in the last place unless the curve passes near 0.
    /// Outside of [0, 1] de Casteljau extrapolates; far outside the result may be infinite. NaN gives NaN.
    #[inline]
    fn eval(&self, t: f64) -> Self::Vector {
        evaluate::eval(self.points(), t)
    }

    /// The point at a parameter and a proved bound of the error of each of its coordinates.
    ///
    /// De Casteljau with a running error analysis; where that bound is more than 4 units in the last place, or the
    /// degree more than 16, [`evaluate::compensated`] takes over within [0, 1].
    fn eval_bounded(&self, t: f64) -> Bounded<Self::Vector> {
        bounded::eval_bounded(self.points(), t)
    }

    /// The points at many parameters, eight side by side, several times faster than one by one.
    ///
    /// Cubics by Horner's scheme about the middle, with an error of about 4 u of the largest control point;
    /// Horner-Bernstein for the others with the error of [`evaluate::horner_bernstein`], both within [0, 1] and without
    /// the compensation of [`Bernstein::eval`]. Exact at 0 and 1.
    ///
    /// # Panics
    /// When `out` is not as long as `parameters`.
    fn eval_batch(&self, parameters: &[f64], out: &mut [Self::Vector]) {
        batch::eval_batch(self.points(), parameters, out);
    }

    /// All points of de Casteljau's construction at `t`: row 0 holds the control points, each further row one point
    /// less, the last row the point of the curve.
    fn construction(&self, t: f64) -> Vec<Vec<Self::Vector>> {
        evaluate::triangle(self.points(), t)
    }

    /// The derivative of an order as a curve (order 1: the hodograph); beyond the degree the zero curve.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when a difference exceeds the range of `f64`.
    fn derivative(&self, order: usize) -> Result<AnyBezier<Self::Vector>, CurveError> {
        AnyBezier::new(subdivide::derivative(self.points(), order))
    }

    /// Both parts of the curve at `t`, each over [0, 1]; they share the point at `t`.
    ///
    /// # Errors
    /// [`CurveError::Parameter`] when `t` is not within [0, 1].
    fn split(&self, t: f64) -> Result<(Self, Self), CurveError> {
        super::check_unit(t)?;
        let (mut left, mut right) = (self.clone(), self.clone());
        subdivide::split(left.storage_mut(), right.storage_mut(), t);
        Ok((left, right))
    }

    /// The part from `from` to `to`, over [0, 1]; it runs backward when `from > to`. Parameters outside of [0, 1]
    /// prolong the curve.
    ///
    /// # Errors
    /// [`CurveError::Parameter`] when a parameter is not finite, [`CurveError::NotFinite`] when the prolonged curve
    /// exceeds the range of `f64`.
    fn subcurve(&self, from: f64, to: f64) -> Result<Self, CurveError> {
        if let Some(&value) = [from, to].iter().find(|t| !t.is_finite()) {
            return Err(CurveError::Parameter { value });
        }
        let mut part = self.clone();
        subdivide::restrict(part.storage_mut(), from, to);
        check_finite(part.storage())?;
        Ok(part)
    }

    /// The same curve run backward: exactly the same points.
    fn reversed(&self) -> Self {
        let mut back = self.clone();
        back.storage_mut().reverse();
        back
    }

    /// The curve with `f` applied to its control points. For affine `f` this is the image of the curve.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when `f` gives a point that is not finite.
    fn map(&self, mut f: impl FnMut(Self::Vector) -> Self::Vector) -> Result<Self, CurveError> {
        let mut image = self.clone();
        for point in image.storage_mut() {
            *point = f(*point);
        }
        check_finite(image.storage())?;
        Ok(image)
    }
}

impl<P: Blend, const N: usize> Bernstein for Bezier<P, N> {
    type Vector = P;
}

impl<P: Blend> Bernstein for AnyBezier<P> {
    type Vector = P;
}

impl<P: Blend, const N: usize> From<Bezier<P, N>> for AnyBezier<P> {
    fn from(curve: Bezier<P, N>) -> AnyBezier<P> {
        AnyBezier { points: curve.points.to_vec() }
    }
}
