//! Where a curve meets a straight line.

use super::exact::{self, IntegerCurve};
use super::scene::grain;
use super::{Contact, Meeting, sorted};
use crate::curve::bernstein::{BernsteinRoot, Roots, roots};
use crate::curve::subdivide::{derivative, reciprocal_powers};
use crate::curve::{Bernstein, CurveError, check_finite, check_tolerance};
use crate::math::Vec2;
use crate::numeric::integer_polynomial::{Integer, IntegerPolynomial};

/// Where a curve meets the straight line through two points, whose parameter is 0 at `from` and 1 at `to` and runs on
/// beyond them, ascending along the curve.
///
/// The distance from the line is a polynomial in Bernstein form, whose simple roots are certified in `f64`; what rounding
/// leaves open is decided exactly up to degree 100, and beyond as far as rounding can tell. A curve all of whose control
/// points are on the line but for the rounding of the coordinates runs along it. With a tolerance, in model units, places
/// of the curve that come that near without meeting are reported as well.
///
/// # Errors
/// [`CurveError::NotFinite`] when a point is not finite, [`CurveError::TooFewPoints`] when both are the same,
/// [`CurveError::Tolerance`] for one that is not a positive number.
pub fn intersect_line<C: Bernstein<Vector = Vec2>>(
    curve: &C,
    from: Vec2,
    to: Vec2,
    tolerance: Option<f64>,
) -> Result<Vec<Meeting>, CurveError> {
    check_finite(&[from, to])?;
    tolerance.map_or(Ok(()), check_tolerance)?;
    if from == to {
        return Err(CurveError::TooFewPoints { actual: 1, least: 2 });
    }
    let view = View::new(curve.points(), from, to);
    let contacts = match roots(&view.heights, ROUNDING) {
        _ if view.is_on_line() => None,
        Roots::At(roots)
            if roots.iter().all(|root| root.multiplicity == 1 && root.t > 0.0 && root.t < 1.0) =>
        {
            Some(roots)
        }
        found if curve.degree() > exact::MAX_ELIMINATED => match found {
            Roots::Everywhere => None,
            Roots::At(roots) => Some(roots),
        },
        _ => exact_roots(curve.points(), from, to),
    };
    let meeting = |low: f64, high: f64, contact: Contact| {
        let second = [low, high].map(|t| view.along(curve.eval(t)));
        Meeting { first: [low, high], second, point: curve.eval(low), contact }
    };
    let Some(contacts) = contacts else { return Ok(vec![meeting(0.0, 1.0, Contact::Overlap)]) };
    let mut found: Vec<Meeting> = contacts
        .iter()
        .map(|root| meeting(root.t, root.t, Contact::of_multiplicity(root.multiplicity)))
        .collect();
    if let Some(tolerance) = tolerance {
        let misses = view.misses(tolerance);
        found.extend(misses.into_iter().map(|(t, distance)| meeting(t, t, Contact::NearMiss { distance })));
    }
    Ok(sorted(found))
}

/// Heights of points of size 1 over a line whose direction is off by 3 u are off by 12 u.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The curve as seen from the line: about unit size, the line through the origin.
struct View {
    /// Signed distances of the control points from the line.
    heights: Vec<f64>,
    from: Vec2,
    direction: Vec2,
    /// The length of the line, and the factors that made it so.
    span: f64,
    scale: [f64; 3],
    /// How far control points may be from the line because they, and the line's points, were rounded.
    grain: f64,
}

impl View {
    fn new(points: &[Vec2], from: Vec2, to: Vec2) -> View {
        // Differences may overflow, and quarters of subnormal numbers lose digits.
        let largest =
            points.iter().chain([&from, &to]).fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let quarter = if largest > 1e300 { 0.25 } else { 1.0 };
        let step = to * quarter - from * quarter;
        let [first, second] = reciprocal_powers(step.abs().max_element());
        let direction = (step * first * second).normalize();
        let offsets: Vec<Vec2> = points.iter().map(|&p| p * quarter - from * quarter).collect();
        let size = offsets.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let [first, second] = if size > 0.0 { reciprocal_powers(size) } else { [1.0, 1.0] };
        let heights = offsets.iter().map(|&p| direction.perp_dot(p * first * second)).collect();
        let span = (step * first * second).dot(direction);
        // What the line's own points are off grows with the distance from them.
        let scale = [quarter, first, second];
        let reach = 1.0 + 2.0 / span;
        let grain = grain(points.len() - 1, largest * quarter * first * second * reach);
        View { heights, from, direction, span, scale, grain }
    }

    /// Whether the curve is on the line as far as rounded points can tell.
    fn is_on_line(&self) -> bool {
        self.heights.iter().all(|h| h.abs() <= self.grain)
    }

    /// The line's parameter of a point.
    fn along(&self, p: Vec2) -> f64 {
        let [quarter, first, second] = self.scale;
        ((p * quarter - self.from * quarter) * first * second).dot(self.direction) / self.span
    }

    /// Parameters and distances of the places that come nearest without meeting the line.
    fn misses(&self, tolerance: f64) -> Vec<(f64, f64)> {
        let slope = derivative(&self.heights, 1);
        let turns = roots(&slope, ROUNDING * self.heights.len() as f64).isolated();
        let at = |t: f64| crate::curve::evaluate::eval(&self.heights, t);
        let rises = |t: f64, slope: f64| slope * at(t) >= 0.0;
        let mut places: Vec<f64> = Vec::new();
        let bends_away =
            |t: f64| crate::curve::evaluate::de_casteljau(&derivative(&slope, 1), t) * at(t) >= 0.0;
        places.extend(turns.iter().map(|turn| turn.t).filter(|&t| t > 0.0 && t < 1.0 && bends_away(t)));
        places.extend(
            [(0.0, slope[0]), (1.0, -slope[slope.len() - 1])]
                .iter()
                .filter(|(t, s)| rises(*t, *s))
                .map(|end| end.0),
        );
        let [quarter, first, second] = self.scale;
        let outward = |h: f64| h.abs() / second / first / quarter;
        // What cannot be told from zero is a meeting.
        let missed = places.into_iter().map(|t| (t, at(t))).filter(|(_, h)| h.abs() > 2.0 * ROUNDING);
        missed.map(|(t, h)| (t, outward(h))).filter(|(_, distance)| *distance <= tolerance).collect()
    }
}

/// The roots of the distance, exactly; `None` when the curve is on the line.
fn exact_roots(points: &[Vec2], from: Vec2, to: Vec2) -> Option<Vec<BernsteinRoot>> {
    // Control points of a degree that says nothing keep their last coefficient: the line is the second curve.
    let [curve, line] = IntegerCurve::of([points, &[from, to]]);
    let [origin, step] = &line.coefficients[..] else { return None };
    let mut heights: Vec<Integer> =
        curve.coefficients.iter().map(|c| &step[0] * &c[1] - &step[1] * &c[0]).collect();
    heights[0] -= &step[0] * &origin[1] - &step[1] * &origin[0];
    let heights = IntegerPolynomial::new(heights);
    if heights.is_zero() {
        return None;
    }
    // More bits than a nearest f64 of any size needs in [2^-64, 1].
    let roots = heights.roots_in_unit(128);
    let root = |root| {
        let t = exact::nearest_f64(root);
        BernsteinRoot { t, low: t, high: t, multiplicity: root.multiplicity }
    };
    Some(roots.iter().map(root).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Cubic;

    fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
        Cubic::new(points.map(Vec2::from)).unwrap()
    }

    #[test]
    fn lines_cross_touch_and_overlap() {
        let arch = cubic([(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)]);
        let found = intersect_line(&arch, Vec2::new(-1.0, 1.0), Vec2::new(3.0, 1.0), None).unwrap();
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|m| m.contact == Contact::Crossing && (m.point.y - 1.0).abs() < 1e-15));
        let top = intersect_line(&arch, Vec2::new(0.0, 3.0), Vec2::new(1.0, 3.0), None).unwrap();
        assert_eq!(top.len(), 1);
        assert_eq!(top[0].contact, Contact::Tangency { multiplicity: 2 });
        assert_eq!((top[0].first[0], top[0].second[0]), (0.5, 2.0));
        let flat = cubic([(0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0)]);
        let on = intersect_line(&flat, Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), None).unwrap();
        assert_eq!((on[0].contact, on[0].second), (Contact::Overlap, [0.0, 3.0]));
        assert!(intersect_line(&flat, Vec2::ZERO, Vec2::X, None).unwrap().is_empty());
        let inflected = cubic([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 1.0)]);
        let triple = intersect_line(&inflected, Vec2::ZERO, Vec2::X, None).unwrap();
        assert_eq!((triple.len(), triple[0].contact), (1, Contact::Tangency { multiplicity: 3 }));
    }

    #[test]
    fn near_misses_of_lines() {
        let arch = cubic([(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)]);
        let above = |gap: f64, tolerance| {
            intersect_line(&arch, Vec2::new(0.0, 3.0 + gap), Vec2::new(1.0, 3.0 + gap), Some(tolerance))
                .unwrap()
        };
        let near = above(0.125, 0.25);
        assert_eq!((near.len(), near[0].first[0]), (1, 0.5));
        assert_eq!(near[0].contact, Contact::NearMiss { distance: 0.125 });
        assert!(above(0.125, 0.1).is_empty());
        // The ends come near a line below.
        let below = intersect_line(&arch, Vec2::new(0.0, -0.5), Vec2::new(1.0, -0.5), Some(1.0)).unwrap();
        assert_eq!(below.iter().map(|m| m.first[0]).collect::<Vec<_>>(), [0.0, 1.0]);
    }
}
