//! Fitting: few cubics that follow points, curves and paths to within a tolerance.

mod arms;
mod deviation;
mod points;
mod run;
mod source;

pub use points::{Corners, PointFit, find_corners, fit_points, schneider};
pub use source::{Ray, Side, Source, fit};

pub(super) use run::{Proxy, Run};
pub(super) use source::{SHARE, Step, follow};

/// A curve in place of another one, or of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted<C> {
    /// The curve.
    pub curve: C,
    /// Bound of its distance from what it stands for, in model units; what distance is meant is said where the curve
    /// is made. Never above the tolerance.
    pub error: f64,
}
