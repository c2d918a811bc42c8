//! Smooth to flat: curves flattened, surfaces tessellated, polygons extruded and revolved.

mod extrude;
mod flatten;
mod profile;
mod revolve;
mod surface;

pub use extrude::{LinearSweep, linear_extrude};
pub use flatten::{Flattened, flatten, flatten_spline};
pub use revolve::{RotateSweep, rotate_extrude};
pub use surface::{
    Achieved, CloseError, EdgeCounts, Guarantee, Precision, SurfaceOptions, Tessellation, TessellationError,
    View, capped, patch_edges, patches, surface, surfaces, thickened,
};

use crate::mesh::TooLarge;
use crate::polygon::triangulate::TriangulationError;
use std::fmt;

/// Why a region could not be swept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SweepError {
    /// A number of the sweep is NaN or infinite, or the result would be larger than numbers are.
    NonFinite,
    /// The top would be turned inside out.
    NegativeScale {
        /// The smaller component.
        scale: f64,
    },
    /// Too few steps to sweep.
    TooFewSteps {
        /// How many there are.
        steps: u32,
        /// The fewest that will do.
        needed: u32,
    },
    /// A region with points on both sides of the axis it is turned about.
    CrossesAxis {
        /// Smallest distance from the axis, to the right of it.
        min: f64,
        /// Largest.
        max: f64,
    },
    /// The region does not keep its promises.
    Region(TriangulationError),
    /// The mesh would be too large.
    TooLarge(TooLarge),
}

impl fmt::Display for SweepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SweepError::NonFinite => f.write_str("a size is not finite"),
            SweepError::NegativeScale { scale } => write!(f, "the top cannot be scaled by {scale}"),
            SweepError::TooFewSteps { steps, needed } => {
                write!(f, "{steps} steps are too few for a sweep that needs {needed}")
            }
            SweepError::CrossesAxis { min, max } => {
                write!(
                    f,
                    "the region reaches from x = {min} to x = {max}, across the axis it is turned about"
                )
            }
            SweepError::Region(error) => error.fmt(f),
            SweepError::TooLarge(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for SweepError {}

impl From<TriangulationError> for SweepError {
    fn from(error: TriangulationError) -> SweepError {
        SweepError::Region(error)
    }
}

impl From<TooLarge> for SweepError {
    fn from(error: TooLarge) -> SweepError {
        SweepError::TooLarge(error)
    }
}
