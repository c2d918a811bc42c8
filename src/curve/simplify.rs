//! The same picture with fewer pieces.

use super::fit::{Fitted, Proxy, Run, SHARE};
use super::frame::UnitFrame;
use super::strand::{Element, Strand, angle_between};
use super::{Cubic, CurveError, Line, Path, Piece, Subpath};
use crate::math::Vec2;

/// A path of fewer pieces within `tolerance` of a path, in model units: between corners nearly as few cubics as can be
/// shown to be within it ([`super::fit`] says how), smooth (G1) where they meet.
///
/// Corners stay exactly where they are, and so do the ends of subpaths and the points where pieces turn back: a joint
/// is a corner when the path turns by more than `corner` radians there. Straight parts become lines. The error is in
/// the sense of Fréchet, subpath by subpath: both can be walked from end to end, never back, so that the walkers are
/// never farther apart.
///
/// ```
/// use ogee::curve::{Arc, Path, Subpath, simplify};
/// use ogee::math::Vec2;
///
/// let circle = Arc::ellipse(Vec2::ZERO, Vec2::ONE)?;
/// let fine: Vec<_> = circle.cubics(1e-12)?.into_iter().map(Into::into).collect();
/// let path = Path { subpaths: vec![Subpath::closed(fine)?] };
/// let coarse = simplify(&path, 1e-3, 0.01)?;
/// assert!(coarse.curve.pieces().count() <= 4 && coarse.error <= 1e-3);
/// # Ok::<(), ogee::curve::CurveError>(())
/// ```
///
/// # Errors
/// [`CurveError::Tolerance`], [`CurveError::ToleranceTooFine`] below the rounding of the coordinates,
/// [`CurveError::Parameter`] when `corner` is negative or NaN.
pub fn simplify(path: &Path, tolerance: f64, corner: f64) -> Result<Fitted<Path>, CurveError> {
    if corner.is_nan() || corner < 0.0 {
        return Err(CurveError::Parameter { value: corner });
    }
    super::check_tolerance(tolerance)?;
    let Some(bounds) = path.bounding_box() else {
        return Ok(Fitted { curve: Path::default(), error: 0.0 });
    };
    let frame = UnitFrame::around(&bounds, 0.0)?;
    let limit = frame.tolerance(tolerance)?;
    let (mut simple, mut error) = (Path::default(), 0.0);
    for subpath in &path.subpaths {
        let strand = Strand::new(subpath, &frame, SHARE * tolerance, 0.0)?;
        let mut pieces = Vec::new();
        for smooth in smooth_parts(&strand, corner) {
            error = follow(smooth, &frame, limit, &mut pieces)?.max(error);
        }
        if pieces.is_empty() {
            pieces.push(Piece::line(subpath.start(), subpath.start())?);
        }
        simple.subpaths.push(if subpath.is_closed() {
            Subpath::closed(pieces)?
        } else {
            Subpath::open(pieces)?
        });
    }
    Ok(Fitted { curve: simple, error: frame.error_outward(error, tolerance) })
}

/// The elements between corners.
fn smooth_parts(strand: &Strand, corner: f64) -> impl Iterator<Item = &[Element]> {
    let turns =
        move |a: &Element, b: &Element| b.after_cusp || angle_between(a.tangents[1], b.tangents[0]) > corner;
    strand.elements.chunk_by(move |a, b| !turns(a, b))
}

/// Adds pieces for elements without a corner, and gives the largest error.
fn follow(
    elements: &[Element],
    frame: &UnitFrame,
    limit: f64,
    pieces: &mut Vec<Piece>,
) -> Result<f64, CurveError> {
    let mut run = Run::starting(elements[0].tangents[0]);
    for (index, element) in elements.iter().enumerate() {
        let after = elements.get(index + 1).map_or(element.tangents[1], |next| next.tangents[0]);
        let tangent = (element.tangents[1] + after).try_normalize().unwrap_or(after);
        run.push(Proxy { points: element.points, error: element.error }, tangent);
    }
    let fitted = run.fitted(limit);
    let last = fitted.len() - 1;
    let (first_end, last_end) = (elements[0].outer[0], elements[elements.len() - 1].outer[1]);
    let mut error = 0.0_f64;
    for (index, proxy) in fitted.iter().enumerate() {
        let mut points = proxy.points.map(|p| frame.outward(p));
        match (index, first_end, pieces.last()) {
            (0, Some(start), _) => points[0] = start,
            (_, _, Some(before)) => points[0] = before.end(),
            _ => {}
        }
        if let (true, Some(end)) = (index == last, last_end) {
            points[3] = end;
        }
        error = error.max(proxy.error);
        pieces.push(piece(points)?);
    }
    Ok(error)
}

/// A line where the control points lie on it, in order; else a cubic.
pub(super) fn piece(points: [Vec2; 4]) -> Result<Piece, CurveError> {
    let [a, b, c, d] = points;
    let chord = d - a;
    let square = chord.length_squared();
    // Half an ulp of rounding a coordinate; the frame's rounding has room for it.
    let size = points.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    let is_on = |p: Vec2| (p - a).perp_dot(chord).abs() <= f64::EPSILON * size * chord.length();
    let shares = [b, c].map(|p| (p - a).dot(chord) / square);
    let ascends = 0.0 <= shares[0] && shares[0] <= shares[1] && shares[1] <= 1.0;
    if square > 0.0 && is_on(b) && is_on(c) && ascends {
        return Ok(Piece::Line(Line::new([a, d])?));
    }
    Ok(Piece::Cubic(Cubic::new(points)?))
}
