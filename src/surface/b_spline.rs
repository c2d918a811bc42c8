use super::{Patch, SurfaceError};
use crate::curve::Spline;
use crate::math::Vec3;

/// The bicubic patches of a tensor-product B-spline surface, those of v running fastest. `points` are rows of fixed u;
/// there are four knots more than rows, and than points a row.
///
/// # Errors
/// [`SurfaceError::Count`] for rows of unequal length, [`SurfaceError::Curve`] as of [`Spline::from_b_spline`].
pub fn from_b_spline(
    points: &[Vec<Vec3>],
    knots_u: &[f64],
    knots_v: &[f64],
) -> Result<Vec<Patch>, SurfaceError> {
    let expected = points.first().map_or(0, Vec::len);
    if let Some(row) = points.iter().find(|row| row.len() != expected) {
        return Err(SurfaceError::Count { actual: row.len(), expected });
    }
    let rows: Vec<Spline<Vec3>> =
        points.iter().map(|row| Spline::from_b_spline(row, knots_v)).collect::<Result<_, _>>()?;
    let width = rows.first().map_or(0, |row| row.points().len());
    let column = |k: usize| {
        let points: Vec<Vec3> = rows.iter().map(|row| row.points()[k]).collect();
        Spline::from_b_spline(&points, knots_u)
    };
    let columns: Vec<Spline<Vec3>> = (0..width).map(column).collect::<Result<_, _>>()?;
    let strips = columns.first().map_or(0, |column| column.pieces().len());
    let mut patches = Vec::new();
    for strip in 0..strips {
        for piece in 0..width / 3 {
            let column = |j: usize| columns[3 * piece + j].piece(strip).to_array();
            let columns: [[Vec3; 4]; 4] = [0, 1, 2, 3].map(column);
            patches.push(Patch::bicubic([0, 1, 2, 3].map(|i: usize| columns.map(|column| column[i])))?);
        }
    }
    Ok(patches)
}
