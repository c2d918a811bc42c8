//! Outlines of strokes.

use super::dash::dashed;
use super::fit::{Fitted, SHARE};
use super::frame::UnitFrame;
use super::pen::{Cap, Join, Pen, check_join};
use super::strand::Strand;
use super::{CurveError, Path};

/// How a path is stroked. Lengths are in model units.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// The width of the line.
    pub width: f64,
    /// How corners are bridged.
    pub join: Join,
    /// How ends look, of dashes too.
    pub cap: Cap,
    /// Lengths of dashes and gaps in turn, repeated along each subpath; an odd number of them is taken twice. Empty
    /// for a line without gaps.
    pub dashes: Vec<f64>,
    /// Where in the pattern each subpath starts.
    pub phase: f64,
}

impl Stroke {
    /// A line of this width with round joins and caps: all points within half of the width from the path.
    pub fn round(width: f64) -> Stroke {
        Stroke { width, join: Join::Round, cap: Cap::Round, dashes: Vec::new(), phase: 0.0 }
    }
}

/// The outline of a stroked path: closed subpaths that have a winding number other than zero around the points that the
/// stroke covers, and zero around others. An open subpath gives one, a closed one two, each dash one.
///
/// A stroke covers, around each piece, all points of its normals up to half of the width, and at corners, where a
/// piece turns back, and at ends what join and cap say. With round ones that is the set of all points within half of
/// the width. There are no holes: the distance from a point to the path has, along each stretch on which it is at most
/// half of the width, one minimum more than maxima, and the winding number is the count of the former less that of the
/// latter. For butt and square caps that means: covered is what is near to a stretch that does not just begin or end
/// there, coming no nearer.
///
/// Each side is a parallel as [`super::offset`] draws it, off by at most `tolerance`, and the returned error is the
/// largest such bound. A subpath of no length gives a disc with round caps, a square along the axes with square ones,
/// and nothing with butt ones. A closed subpath whose first and last dash touch has them joined.
///
/// ```
/// use ogee::curve::{Stroke, Path, Subpath, stroke};
/// use ogee::math::Vec2;
///
/// let corner = Subpath::polyline(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)].map(Vec2::from), false)?;
/// let outline = stroke(&Path { subpaths: vec![corner] }, &Stroke::round(1.0), 1e-4)?;
/// let bounds = outline.curve.bounding_box().unwrap();
/// assert!((bounds.min - Vec2::splat(-0.5)).length() < 2.0 * outline.error);
/// assert!((bounds.max - Vec2::new(4.5, 3.5)).length() < 2.0 * outline.error);
/// # Ok::<(), ogee::curve::CurveError>(())
/// ```
///
/// # Errors
/// [`CurveError::Distance`] when the width is not positive, [`CurveError::Dash`] and [`CurveError::TooManyDashes`] for
/// more than a million; others as [`super::offset`].
pub fn stroke(path: &Path, style: &Stroke, tolerance: f64) -> Result<Fitted<Path>, CurveError> {
    super::check_tolerance(tolerance)?;
    check_join(style.join)?;
    if !(style.width > 0.0 && style.width.is_finite()) {
        return Err(CurveError::Distance { value: style.width });
    }
    let Some(bounds) = path.bounding_box() else {
        return Ok(Fitted { curve: Path::default(), error: 0.0 });
    };
    let radius = 0.5 * style.width;
    let frame = UnitFrame::around(&bounds, radius)?;
    // To the right: so the outline runs counter-clockwise around what it covers.
    let mut pen = Pen::new(-frame.length_inward(radius), style.join, frame.tolerance(tolerance)?).covering();
    let mut outline = Path::default();
    for subpath in &path.subpaths {
        let strand = Strand::new(subpath, &frame, SHARE * tolerance, radius)?;
        let dashes = style.dashes.iter().map(|&dash| frame.length_inward(dash)).collect::<Vec<f64>>();
        for strand in dashed(strand, &dashes, frame.length_inward(style.phase))? {
            draw(&strand, style.cap, &mut pen, &frame, &mut outline)?;
        }
    }
    Ok(Fitted { curve: outline, error: frame.error_outward(pen.error(), tolerance) })
}

/// Adds the outline of one strand.
fn draw(
    strand: &Strand,
    cap: Cap,
    pen: &mut Pen,
    frame: &UnitFrame,
    outline: &mut Path,
) -> Result<(), CurveError> {
    let [Some(first), Some(last)] = [strand.elements.first(), strand.elements.last()] else {
        if cap != Cap::Butt {
            pen.cap(strand.start, strand.heading, cap);
            pen.cap(strand.start, -strand.heading, cap);
        }
        outline.subpaths.extend(pen.lift(frame, true)?);
        return Ok(());
    };
    let back = strand.reversed();
    pen.beside(strand);
    if strand.closed {
        outline.subpaths.extend(pen.lift(frame, true)?);
        pen.beside(&back);
    } else {
        pen.cap(last.points[3], last.tangents[1], cap);
        pen.beside(&back);
        pen.cap(first.points[0], -first.tangents[0], cap);
    }
    outline.subpaths.extend(pen.lift(frame, true)?);
    Ok(())
}
