//! What can be followed by cubics: curves that bound their own distance from one.

use super::Fitted;
use super::run::{Proxy, Run};
use crate::curve::frame::UnitFrame;
use crate::curve::{Bernstein, Bounds, Cubic, CurveError, Spline, check_tolerance};
use crate::math::Vec2;

/// From which side a parameter is approached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From smaller parameters.
    Before,
    /// From larger parameters.
    After,
}

/// A point of a curve and how the curve runs through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point.
    pub point: Vec2,
    /// Unit tangent in the sense of growing parameters; at a cusp its limit from the side.
    pub tangent: Vec2,
    /// The derivative by the parameter is `speed` times the tangent.
    pub speed: f64,
}

/// A plane curve that cubics can be fitted to.
///
/// It need not be polynomial, but it must bound its distance from a cubic: there is no fit within a tolerance of what
/// is only known at some points. Where the fourth derivative is at most M in norm on an interval of width h, the cubic
/// with the same ends and end derivatives is within M h^4 / 384, and a cubic with control points displaced by at
/// most e from that one within M h^4 / 384 + e.
///
/// Area and moments are not asked for: the fit takes them, exactly, from cubics that already follow the curve to a
/// small part of the tolerance.
pub trait Source {
    /// First and last parameter.
    fn domain(&self) -> [f64; 2];

    /// Parameters inside of the domain, ascending, at which the curve has a corner or a cusp, or may have one. A joint
    /// of the fit is put there, and its tangents may differ.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The curve at a parameter, seen from a side.
    fn ray(&self, t: f64, side: Side) -> Ray;

    /// A bound of the distance of points at the same share of the parameter, between the part of the curve `from` one
    /// parameter `to` another and a cubic; infinite where there is none. There is no break in between, and the cubic
    /// is near to the one that has the same ends and end derivatives.
    fn deviation(&self, from: f64, to: f64, cubic: &Cubic<Vec2>) -> f64;
}

/// The share of the tolerance that goes into the cubics that stand for the source.
pub(in crate::curve) const SHARE: f64 = 1.0 / 16.0;
/// Parts narrower than this share of the domain are not cut further.
const NARROWEST: f64 = 1.0 / (1_u64 << 46) as f64;

/// Cubics that follow a curve to within `tolerance`, in model units, nearly as few as possible: smooth (G1) but at the
/// breaks of the source, where there are joints.
///
/// Each cubic has the same ends, end tangents, area and first moment as the part it stands for (Levien, Fitting cubic
/// Bézier curves, 2021), of the up to four such cubics the one with the smallest proved distance; and of all parts
/// from a point on, the longest for which that distance is within the tolerance. The error is in the sense of Fréchet:
/// both curves can be walked from end to end, never back, so that the walkers are never farther apart.
///
/// # Errors
/// [`CurveError::Tolerance`]; [`CurveError::ToleranceTooFine`] when it is below the rounding of the coordinates or the
/// source does not bound its distance from cubics that well; [`CurveError::Knot`] for breaks out of order or outside
/// of the domain; [`CurveError::NotFinite`] when the curve is not finite; [`CurveError::Gap`] when both sides
/// of a break are not one point.
pub fn fit<S: Source>(source: &S, tolerance: f64) -> Result<Fitted<Spline<Vec2>>, CurveError> {
    check_tolerance(tolerance)?;
    let stops = stops(source)?;
    let mut runs = Vec::new();
    for stop in stops.windows(2) {
        runs.push(proxies(source, stop[0], stop[1], SHARE * tolerance)?);
    }
    let control = || runs.iter().flat_map(Run::control_points);
    let first = control().next().unwrap_or_default();
    let around = Bounds {
        min: control().fold(first, |a: Vec2, b| a.min(b)),
        max: control().fold(first, |a: Vec2, b| a.max(b)),
    };
    let frame = UnitFrame::around(&around, 0.0)?;
    let limit = frame.tolerance(tolerance)?;
    let (mut cubics, mut error) = (Vec::<Cubic<Vec2>>::new(), 0.0_f64);
    for run in &runs {
        let ends = [run.start(), run.end()];
        if let Some(gap) = cubics.last().map(|last| (ends[0] - last.end()).abs().max_element())
            && frame.length_inward(gap) > 0.25 * frame.rounding()
        {
            return Err(CurveError::Gap { piece: cubics.len() });
        }
        for proxy in run.inward(&frame).fitted(limit) {
            error = error.max(proxy.error);
            let mut points = proxy.points.map(|p| frame.outward(p));
            points[0] = cubics.last().map_or(ends[0], Bernstein::end);
            cubics.push(Cubic::new(points)?);
        }
        if let Some(last) = cubics.last_mut() {
            let [a, b, c, _] = last.to_array();
            *last = Cubic::new([a, b, c, ends[1]])?;
        }
    }
    Ok(Fitted { curve: Spline::from_pieces(&cubics)?, error: frame.error_outward(error, tolerance) })
}

/// Ends of the domain and breaks, ascending.
fn stops<S: Source>(source: &S) -> Result<Vec<f64>, CurveError> {
    let [first, last] = source.domain();
    let mut stops = vec![first];
    stops.extend(source.breaks());
    stops.push(last);
    match stops.windows(2).position(|pair| !(pair[0] < pair[1] && pair[1].is_finite())) {
        Some(index) => Err(CurveError::Knot { index: index + 1 }),
        None if !first.is_finite() => Err(CurveError::Knot { index: 0 }),
        None => Ok(stops),
    }
}

/// A run of cubics that follow the source between two neighbouring stops to within `tolerance`.
fn proxies<S: Source>(source: &S, from: f64, to: f64, tolerance: f64) -> Result<Run, CurveError> {
    let start = source.ray(from, Side::After);
    if !(start.point.is_finite() && start.tangent.is_finite()) {
        return Err(CurveError::NotFinite { index: 0 });
    }
    let mut run = Run::starting(start.tangent);
    let mut stuck = None;
    let least = (to - from) * NARROWEST;
    follow(source, [from, to], tolerance, &|from, to| to - from <= least, &mut |step| {
        match step {
            Step::Proxy { proxy, tangent, .. } => run.push(proxy, tangent),
            Step::Stuck { deviation, .. } => stuck = Some(deviation),
        }
        stuck.is_none()
    });
    match stuck {
        Some(deviation) => {
            Err(CurveError::ToleranceTooFine { value: tolerance / SHARE, finest: deviation / SHARE })
        }
        None => Ok(run),
    }
}

/// A step along a source.
pub(in crate::curve) enum Step {
    /// A cubic up to a parameter, and the unit tangent there.
    Proxy { proxy: Proxy, to: f64, tangent: Vec2 },
    /// A part that is not cut further and still farther from its cubic than allowed.
    Stuck { from: f64, to: f64, deviation: f64 },
}

/// Walks a part of a source without breaks in cubics with its ends and end derivatives, halving until each is within
/// the tolerance; parts for which `is_least` holds are not cut further. Goes on, and returns true, as long as `take`
/// does.
pub(in crate::curve) fn follow<S: Source>(
    source: &S,
    [from, to]: [f64; 2],
    tolerance: f64,
    is_least: &impl Fn(f64, f64) -> bool,
    take: &mut impl FnMut(Step) -> bool,
) -> bool {
    let (start, end) = (source.ray(from, Side::After), source.ray(to, Side::Before));
    let third = (to - from) / 3.0;
    let points = [
        start.point,
        start.point + start.tangent * (start.speed * third),
        end.point - end.tangent * (end.speed * third),
        end.point,
    ];
    let deviation = Cubic::new(points).map_or(f64::INFINITY, |cubic| source.deviation(from, to, &cubic));
    if deviation <= tolerance {
        return take(Step::Proxy { proxy: Proxy { points, error: deviation }, to, tangent: end.tangent });
    }
    let middle = 0.5 * from + 0.5 * to;
    if is_least(from, to) || middle <= from || middle >= to {
        return take(Step::Stuck { from, to, deviation });
    }
    follow(source, [from, middle], tolerance, is_least, take)
        && follow(source, [middle, to], tolerance, is_least, take)
}
