use super::bernstein::{Roots, inner_product, roots};
use super::bounded::eval_bounded;
use super::differential::jet;
use super::evaluate::de_casteljau;
use super::nearest_cubic;
use super::subdivide::{derivative, reciprocal_powers};
use super::{Bernstein, Bounded, CurveError};
use crate::math::Blend;

/// A point of a curve whose distance from a given point is a local minimum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<P> {
    /// Its parameter.
    pub t: f64,
    /// The point of the curve.
    pub point: P,
    /// Its distance; the true local minimum differs by at most the error.
    pub distance: Bounded<f64>,
}

/// The nearest point of a curve; of several at the same distance the one with the smallest parameter.
///
/// Never the wrong branch: all roots of the derivative of the squared distance are isolated in Bernstein form
/// (Descartes' rule, hull property), so that no minimum is missed; for cubics only those that may be the nearest.
/// The time grows with the square of the degree, to seconds at degree 2000.
///
/// # Errors
/// [`CurveError::NotFinite`] when the point is not finite.
pub fn nearest<C: Bernstein>(curve: &C, point: C::Vector) -> Result<Nearest<C::Vector>, CurveError> {
    if let &[a, b, c, d] = curve.points() {
        let view = View::new(curve, point)?;
        let (t, distance) = nearest_cubic::nearest(&[a, b, c, d].map(|p| view.inward(p)));
        return Ok(view.outward(curve, t, distance));
    }
    let all = nearest_all(curve, point)?;
    let best = all.into_iter().reduce(|a, b| if b.distance.value < a.distance.value { b } else { a });
    // A curve has at least one point that no other is nearer than.
    Ok(best.unwrap_or(Nearest {
        t: 0.0,
        point: curve.start(),
        distance: Bounded { value: (curve.start() - point).norm(), error: 0.0 },
    }))
}

/// All local minima of the distance, by ascending parameter, ends of the curve included where it comes nearer towards
/// them. The whole curve counts as one, at parameter 0, when its distance cannot be told from a constant.
///
/// # Errors
/// As [`nearest`].
pub fn nearest_all<C: Bernstein>(curve: &C, point: C::Vector) -> Result<Vec<Nearest<C::Vector>>, CurveError> {
    let view = View::new(curve, point)?;
    let offsets: Vec<C::Vector> = curve.points().iter().map(|&p| view.inward(p)).collect();
    Ok(minima(&offsets).into_iter().map(|(t, distance)| view.outward(curve, t, distance)).collect())
}

/// A curve as seen from a point: near size 1.
struct View<P> {
    point: P,
    /// Factors that bring differences to unit size, the first before they are taken.
    scale: [f64; 3],
}

impl<P: Blend> View<P> {
    fn new<C: Bernstein<Vector = P>>(curve: &C, point: P) -> Result<View<P>, CurveError> {
        if !point.finite() {
            return Err(CurveError::NotFinite { index: 0 });
        }
        // Differences of huge numbers may overflow, quarters of tiny ones lose digits.
        let size = |scale: f64| {
            let offsets = curve.points().iter().map(|&p| (p * scale - point * scale).max_abs());
            offsets.fold(0.0, f64::max)
        };
        let whole = size(1.0);
        let (quarter, size) = if whole < 1e300 { (1.0, whole) } else { (0.25, size(0.25)) };
        let [first, second] = if size > 0.0 { reciprocal_powers(size) } else { [1.0, 1.0] };
        Ok(View { point, scale: [quarter, first, second] })
    }

    #[inline]
    fn inward(&self, p: P) -> P {
        let [quarter, first, second] = self.scale;
        (p * quarter - self.point * quarter) * first * second
    }

    #[inline]
    fn outward<C: Bernstein<Vector = P>>(&self, curve: &C, t: f64, distance: Bounded<f64>) -> Nearest<P> {
        let [quarter, first, second] = self.scale;
        let back = |x: f64| x / first / second / quarter;
        let distance = Bounded { value: back(distance.value), error: back(distance.error) };
        Nearest { t, point: curve.eval(t), distance }
    }
}

/// Local minima of the distance from the origin of a curve of about unit size.
fn minima<P: Blend>(offsets: &[P]) -> Vec<(f64, Bounded<f64>)> {
    let square = inner_product(offsets, offsets);
    let slope = derivative(&square, 1);
    let largest = square.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let error = 2.0 * square.len() as f64 * f64::EPSILON * largest;
    let turns = match roots(&slope, error * square.len() as f64) {
        Roots::Everywhere => return vec![(0.0, distance(offsets, 0.0, error))],
        Roots::At(turns) => turns,
    };
    let inner = turns.iter().filter(|turn| turn.t > 0.0 && turn.t < 1.0);
    let stops: Vec<f64> = [0.0].into_iter().chain(inner.map(|turn| turn.t)).chain([1.0]).collect();
    // Between turns the distance rises or falls throughout.
    let rises: Vec<bool> =
        stops.windows(2).map(|pair| de_casteljau(&slope, 0.5 * (pair[0] + pair[1])) > 0.0).collect();
    let is_minimum = |i: usize| {
        let falls_before = i == 0 || !rises[i - 1];
        let rises_after = i == rises.len() || rises[i];
        falls_before && rises_after
    };
    (0..stops.len())
        .filter(|&i| is_minimum(i))
        .map(|i| refined(offsets, stops[i]))
        .map(|t| (t, distance(offsets, t, error)))
        .collect()
}

/// Newton's steps on the product of offset and derivative, as long as they come nearer.
fn refined<P: Blend>(offsets: &[P], mut t: f64) -> f64 {
    if t == 0.0 || t == 1.0 {
        return t;
    }
    let mut now = jet(offsets, t);
    for _ in 0..3 {
        let bend = now.first.inner(now.first) + now.point.inner(now.second);
        let next = t - now.point.inner(now.first) / bend;
        if !(next > 0.0 && next < 1.0) || next == t {
            break;
        }
        let then = jet(offsets, next);
        if then.point.norm() > now.point.norm() || bend <= 0.0 {
            break;
        }
        (t, now) = (next, then);
    }
    t
}

/// The distance at `t`. At a minimum the squared distance is right up to `error`, whatever the parameter errs.
fn distance<P: Blend>(offsets: &[P], t: f64, error: f64) -> Bounded<f64> {
    let at = eval_bounded(offsets, t);
    let value = at.value.norm();
    Bounded { value, error: at.error.norm() + 2.0 * f64::EPSILON * value + error / (value + error.sqrt()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{AnyBezier, Cubic};
    use crate::math::{Vec2, Vec3};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_sample_is_nearer(
            points in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64), 1..8),
            point in (-2.0..2.0_f64, -2.0..2.0_f64, -2.0..2.0_f64),
        ) {
            let curve = AnyBezier::new(points.into_iter().map(Vec3::from).collect()).unwrap();
            let point = Vec3::from(point);
            let best = nearest(&curve, point).unwrap();
            let sampled = (0..=3000).map(|k| (curve.eval(f64::from(k) / 3000.0) - point).length());
            let sampled = sampled.fold(f64::MAX, f64::min);
            prop_assert!(best.distance.value <= sampled + best.distance.error);
            prop_assert!(sampled - best.distance.value < 1e-2);
            prop_assert!(best.distance.error < 1e-7);
            prop_assert!(((best.point - point).length() - best.distance.value).abs() < 1e-15);
        }

        #[test]
        fn points_on_the_curve_are_found(points in prop::array::uniform4((-1.0..1.0_f64, -1.0..1.0_f64)), t in 0.0..1.0_f64) {
            let curve = Cubic::new(points.map(Vec2::from)).unwrap();
            let best = nearest(&curve, curve.eval(t)).unwrap();
            prop_assert!(best.distance.value < 1e-14, "{best:?}");
        }
    }

    #[test]
    fn all_minima_and_degenerate_curves() {
        let arch = Cubic::new([(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)].map(Vec2::from)).unwrap();
        let all = nearest_all(&arch, Vec2::new(2.0, 0.0)).unwrap();
        assert_eq!(all.iter().map(|near| near.t).collect::<Vec<_>>(), [0.0, 1.0]);
        assert_eq!(nearest(&arch, Vec2::new(2.0, 5.0)).unwrap().t, 0.5);
        let point = Cubic::new([Vec2::ONE; 4]).unwrap();
        assert_eq!(nearest(&point, Vec2::X).unwrap().distance.value, 1.0);
        assert_eq!(nearest(&point, Vec2::NAN), Err(CurveError::NotFinite { index: 0 }));
        let huge = arch.map(|p| p * 4e307).unwrap();
        let far = nearest(&huge, Vec2::new(-1.6e308, 0.0)).unwrap();
        assert_eq!((far.t, far.distance.value), (0.0, 1.6e308));
    }
}
