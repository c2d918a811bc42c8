use super::{Patch, SurfaceError};
use crate::curve::{Boundary, CurveError, Spline};
use crate::math::Vec3;

/// Bicubic patches through splines that follow one another: C2 from section to section, u across the sections, v along
/// them. Sections need as many pieces each; where `closed`, the last one is followed by the first.
///
/// Control points of like number are joined by natural (or periodic) cubic splines with uniform knots, so the surface runs
/// through every section exactly.
///
/// # Errors
/// [`SurfaceError::Count`] when sections differ in their number of control points, [`SurfaceError::Curve`] for fewer than
/// two sections, or three of a closed loft.
pub fn loft(sections: &[Spline<Vec3>], closed: bool) -> Result<Vec<Patch>, SurfaceError> {
    let least = if closed { 3 } else { 2 };
    if sections.len() < least {
        return Err(CurveError::TooFewPoints { actual: sections.len(), least }.into());
    }
    let first = &sections[0];
    for section in sections {
        let (actual, expected) = (section.points().len(), first.points().len());
        if actual != expected || section.is_closed() != first.is_closed() {
            return Err(SurfaceError::Count { actual, expected });
        }
    }
    let columns = (0..first.points().len()).map(|k| {
        let points: Vec<Vec3> = sections.iter().map(|section| section.points()[k]).collect();
        across(&points, closed)
    });
    let columns: Vec<Spline<Vec3>> = columns.collect::<Result<_, _>>()?;
    let strips = if closed { sections.len() } else { sections.len() - 1 };
    let pieces = first.knots().len() - 1;
    let mut patches = Vec::with_capacity(strips * pieces);
    for strip in 0..strips {
        for piece in 0..pieces {
            let column = |j: usize| columns[(3 * piece + j) % columns.len()].piece(strip).to_array();
            let columns: [[Vec3; 4]; 4] = [0, 1, 2, 3].map(column);
            patches.push(Patch::bicubic([0, 1, 2, 3].map(|i: usize| columns.map(|column| column[i])))?);
        }
    }
    Ok(patches)
}

/// The spline from section to section through one control point.
fn across(points: &[Vec3], closed: bool) -> Result<Spline<Vec3>, CurveError> {
    let knots: Vec<f64> = (0..points.len() + usize::from(closed)).map(|k| k as f64).collect();
    if closed {
        return Spline::periodic(points, &knots);
    }
    let natural = Boundary::Second(Vec3::ZERO);
    Spline::interpolate(points, &knots, natural, natural)
}
