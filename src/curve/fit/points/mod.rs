//! Paths of few cubics that run past points.

mod corners;
mod joints;
mod moments;
mod schneider;

pub use corners::find_corners;

use super::{Fitted, Proxy};
use crate::curve::frame::UnitFrame;
use crate::curve::simplify::piece;
use crate::curve::{Bounds, CurveError, Piece, Subpath, check_finite};
use crate::math::Vec2;

/// What a path past points may do.
#[derive(Clone, Debug, PartialEq)]
pub struct PointFit {
    /// The farthest that a point may be from the path, in model units.
    pub tolerance: f64,
    /// Where the path may turn; it is smooth (G1) elsewhere, and passes exactly through these points.
    pub corners: Corners,
    /// Whether the path goes back to the first point.
    pub closed: bool,
}

/// Corners among points.
#[derive(Clone, Debug, PartialEq)]
pub enum Corners {
    /// At the points with these indices, in any order. None of them for a path that is smooth throughout.
    At(Vec<usize>),
    /// Where [`find_corners`] finds them.
    Sharper {
        /// Turns by more than this, in radians.
        angle: f64,
        /// The length over which directions are taken, in model units: larger than the noise of the points.
        reach: f64,
    },
}

/// A path past points: of few cubics, smooth but at corners, through the first and the last point and the corners
/// exactly, and nowhere farther from a point than the tolerance.
///
/// Joints and tangents come from cubic polynomials fitted around a point by least squares, as wide as the noise of the
/// points, told by their differences, allows. Between two joints the cubic has the area and first moment of the points
/// (Levien, Fitting cubic Bézier curves, 2021), which noise hardly changes; of the up to four such cubics it is the one
/// nearest to the points, and from each joint on the longest that is near enough.
///
/// The error is the largest distance of a point from the cubic it belongs to, computed for every point. Between points
/// nothing is known, and nothing said. Repeated points count once; points that are all one give a path of that point.
/// Time is about in proportion to the number of points.
///
/// ```
/// use ogee::curve::{Corners, PointFit, fit_points};
/// use ogee::math::{Vec2, unit_circle};
///
/// let points: Vec<Vec2> = (0..200).map(|k| unit_circle(k, 200)).collect();
/// let style = PointFit { tolerance: 1e-3, corners: Corners::At(vec![]), closed: true };
/// let circle = fit_points(&points, &style)?;
/// assert!(circle.curve.pieces().len() <= 5 && circle.error <= 1e-3);
/// # Ok::<(), ogee::curve::CurveError>(())
/// ```
///
/// # Errors
/// [`CurveError::TooFewPoints`] for none, [`CurveError::NotFinite`], [`CurveError::Tolerance`],
/// [`CurveError::ToleranceTooFine`] below the rounding of the coordinates, [`CurveError::Parameter`] for a corner that
/// is not the index of a point and for angles and reaches that are not positive.
pub fn fit_points(points: &[Vec2], style: &PointFit) -> Result<Fitted<Subpath>, CurveError> {
    fitted(points, style, moments::follow)
}

/// A path past points by the method of Schneider (An algorithm for automatically fitting digitized curves, Graphics
/// Gems, 1990), as a measure for [`fit_points`]: tangents from neighbouring points, arms by least squares, points
/// assigned to parameters by chord length and Newton's steps, and a joint at the farthest point where that does not do
/// (here never in the outer eighth of the points, so that time stays in proportion to n log n).
///
/// Corners, ends and the error are those of [`fit_points`]; joints are points.
///
/// # Errors
/// As [`fit_points`].
pub fn schneider(points: &[Vec2], style: &PointFit) -> Result<Fitted<Subpath>, CurveError> {
    fitted(points, style, schneider::follow)
}

/// Points between two corners, no two neighbours equal, at least two.
struct Section {
    points: Vec<Vec2>,
    /// Whether it is a loop without a corner: the last point is the first one again.
    wraps: bool,
}

impl Section {
    /// Where a path past the points starts and ends: at the first and the last, or anywhere for a loop.
    fn ends(&self, start: Vec2) -> [Vec2; 2] {
        if self.wraps { [start; 2] } else { [self.points[0], self.points[self.points.len() - 1]] }
    }
}

fn fitted(
    points: &[Vec2],
    style: &PointFit,
    follow: impl Fn(&Section, f64) -> Vec<Proxy>,
) -> Result<Fitted<Subpath>, CurveError> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Err(CurveError::TooFewPoints { actual: 0, least: 1 });
    };
    check_finite(points)?;
    let corners = match &style.corners {
        Corners::At(corners) => corners.clone(),
        Corners::Sharper { angle, reach } => find_corners(points, style.closed, *angle, *reach)?,
    };
    if let Some(&wrong) = corners.iter().find(|&&index| index >= points.len()) {
        return Err(CurveError::Parameter { value: wrong as f64 });
    }
    let around = Bounds {
        min: points.iter().fold(first, |a, &b| a.min(b)),
        max: points.iter().fold(first, |a, &b| a.max(b)),
    };
    let frame = UnitFrame::around(&around, 0.0)?;
    let limit = frame.tolerance(style.tolerance)?;
    let (mut pieces, mut error) = (Vec::<Piece>::new(), 0.0_f64);
    for section in sections(points, corners, style.closed) {
        let inward = Section { points: section.points.iter().map(|&p| frame.inward(p)).collect(), ..section };
        let proxies = follow(&inward, limit);
        let ends = section.ends(frame.outward(proxies[0].points[0]));
        for (index, proxy) in proxies.iter().enumerate() {
            let mut points = proxy.points.map(|p| frame.outward(p));
            points[0] = pieces.last().map_or(ends[0], Piece::end);
            if index + 1 == proxies.len() {
                points[3] = ends[1];
            }
            error = error.max(proxy.error);
            pieces.push(piece(points)?);
        }
    }
    if pieces.is_empty() {
        pieces.push(Piece::line(first, last)?);
    }
    let curve = if style.closed { Subpath::closed(pieces)? } else { Subpath::open(pieces)? };
    Ok(Fitted { curve, error: frame.error_outward(error, style.tolerance) })
}

/// The points from corner to corner. A closed path starts at its first corner.
fn sections(points: &[Vec2], mut corners: Vec<usize>, closed: bool) -> Vec<Section> {
    corners.sort_unstable();
    corners.dedup();
    let last = points.len() - 1;
    let section = |points: Vec<Vec2>, wraps: bool| Section { points, wraps };
    let mut ordered = points.to_vec();
    let is_smooth = closed && corners.is_empty();
    if closed {
        let start = corners.first().copied().unwrap_or(0);
        ordered.rotate_left(start);
        ordered.push(ordered[0]);
        corners.iter_mut().for_each(|corner| *corner -= start);
        corners.push(last + 1);
    } else {
        corners.push(last);
    }
    if corners[0] != 0 {
        corners.insert(0, 0);
    }
    let cut = corners.windows(2).map(|ends| {
        let mut part = ordered[ends[0]..=ends[1]].to_vec();
        part.dedup();
        section(part, is_smooth)
    });
    cut.filter(|section| section.points.len() > 1).collect()
}
