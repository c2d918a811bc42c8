use super::layout::Layout;
use super::{Achieved, EdgeCounts, SurfaceOptions, Tessellation, TessellationError, surfaces};
use crate::math::power_of_two_below;
use crate::surface::{Patch, Surface};

/// [`surfaces`] of Bézier patches of any size: those near the limits of `f64` are scaled by a power of two on the way.
///
/// ```
/// use ogee::math::Vec3;
/// use ogee::surface::Patch;
/// use ogee::tessellate::{SurfaceOptions, patches};
///
/// let corner = |x: f64, y: f64| Vec3::new(x, y, x * y);
/// let saddle = Patch::new([1, 1], vec![corner(0., 0.), corner(0., 1.), corner(1., 0.), corner(1., 1.)]).unwrap();
/// let made = patches(&[saddle], &SurfaceOptions::within(1e-3))?;
/// assert!(made.error.bound.is_some_and(|bound| bound <= 1e-3));
/// # Ok::<(), ogee::tessellate::TessellationError>(())
/// ```
///
/// # Errors
/// [`TessellationError`].
pub fn patches(patches: &[Patch], options: &SurfaceOptions) -> Result<Tessellation, TessellationError> {
    /// Within this range neither products of three coordinates nor squares of their differences leave that of `f64`.
    const COMFORTABLE: std::ops::Range<f64> = 1e-90..1e90;
    let points = || patches.iter().flat_map(Patch::points);
    let size = points().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    if size == 0.0 || COMFORTABLE.contains(&size) {
        return surfaces(&borrowed(patches), options);
    }
    let power = power_of_two_below(size).max(f64::MIN_POSITIVE);
    let scaled: Vec<Patch> = patches
        .iter()
        .map(|patch| patch.map(|point| point / power).expect("smaller numbers are finite"))
        .collect();
    let options = SurfaceOptions { precision: options.precision.scaled(1.0 / power), ..*options };
    let mut made = surfaces(&borrowed(&scaled), &options).map_err(|error| in_size(error, power))?;
    made.mesh.positions.iter_mut().for_each(|position| *position *= power);
    let Achieved { bound, measured } = made.error;
    made.error = Achieved { bound: bound.map(|bound| bound * power), measured: measured * power };
    Ok(made)
}

/// How patches are joined by equal borders.
///
/// # Errors
/// [`TessellationError::NotFinite`].
pub fn patch_edges(patches: &[Patch]) -> Result<EdgeCounts, TessellationError> {
    Ok(Layout::new(&borrowed(patches))?.edge_counts())
}

fn borrowed(patches: &[Patch]) -> Vec<&dyn Surface> {
    patches.iter().map(|patch| patch as &dyn Surface).collect()
}

/// The error in the size that was asked for.
fn in_size(error: TessellationError, power: f64) -> TessellationError {
    match error {
        TessellationError::ToleranceTooFine { value, finest } => {
            TessellationError::ToleranceTooFine { value: value * power, finest: finest * power }
        }
        error => error,
    }
}
