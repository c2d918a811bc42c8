//! Bézier curves, splines and paths: evaluated, measured, found.
//!
//! A curve is made of finite control points and is checked once, where it is made; after that door nothing is NaN.
//! [`Bezier`] has a fixed number of control points, [`AnyBezier`] any number; both have the methods of [`Bernstein`]
//! and work for scalars, the plane and space ([`Blend`]). [`Rational`] adds weights, [`Spline`] joins cubics so that
//! neighbours share one point.
//!
//! Answers carry their error: [`Bounded`] is a value with a proved bound, measures take the accuracy they must reach,
//! and intersections are classified. There is no hidden epsilon: a tolerance is an argument, and where none is given
//! the bound is that of the rounding of `f64` at the size of the curve's hull.
//!
//! What curves stand for others say how far they are from them ([`Fitted`]): [`fit`] follows any curve that bounds its own
//! distance from a cubic, [`fit_points`] passes points, [`simplify`] keeps a path's corners and little else,
//! [`offset`](fn@offset) draws parallels with all of their cusps, and [`stroke`](fn@stroke) outlines that have no holes.
//!
//! ```
//! use ogee::curve::{Bernstein, Cubic};
//! use ogee::math::Vec2;
//!
//! let arch = Cubic::new([(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)].map(Vec2::from))?;
//! assert_eq!(arch.eval(0.5), Vec2::new(50.0, 45.0));
//! let length = ogee::curve::length(&arch, 1e-9)?;
//! assert!((length.value - 141.217_498_362_787_7).abs() <= length.error);
//! # Ok::<(), ogee::curve::CurveError>(())
//! ```

mod arc;
mod b_spline;
mod batch;
mod bernstein;
mod bezier;
mod bounded;
mod bounds;
mod closed;
mod convert;
mod cubic;
mod dash;
mod differential;
pub mod evaluate;
mod evolute;
mod fit;
mod frame;
mod interpolate;
mod intersect;
mod length;
mod length_cubic;
mod nearest;
mod nearest_cubic;
mod offset;
mod path;
mod pen;
mod rational;
mod reduce;
mod simplify;
mod spline;
mod strand;
mod stroke;
mod subdivide;

pub use arc::Arc;
pub use bernstein::BernsteinRoot;
pub use bezier::{AnyBezier, Bernstein, Bezier, Cubic, Line, Quadratic};
pub use bounded::Bounded;
pub use bounds::{Bounds, bounding_box, convex_hull, turns};
pub use closed::{Moments, Winding, moments, winding};
pub use convert::monomials;
pub use cubic::CubicShape;
pub use differential::{Curve, Frame, Jet, Tangents, rotation_minimizing_frames, tangents};
pub use fit::{Corners, Fitted, PointFit, Ray, Side, Source, find_corners, fit, fit_points, schneider};
pub use interpolate::{Boundary, Spacing};
pub use intersect::{Contact, Meeting, intersect, intersect_line, self_intersections};
pub use length::{ArcLength, length, speed_minima};
pub use nearest::{Nearest, nearest, nearest_all};
pub use offset::offset;
pub use path::{Path, Piece, Subpath};
pub use pen::{Cap, Join};
pub use rational::Rational;
pub use reduce::{Reduced, reduce};
pub use simplify::simplify;
pub use spline::{Continuity, Joint, Spline};
pub use stroke::{Stroke, stroke};
pub use subdivide::{Joined, join};

use crate::math::Blend;
use std::fmt;

/// What is wrong with the input of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurveError {
    /// There are fewer points than such a curve needs.
    TooFewPoints {
        /// How many there are.
        actual: usize,
        /// How many it takes at least.
        least: usize,
    },
    /// A point, or what was computed from it, is NaN or infinite.
    NotFinite {
        /// Index of the point.
        index: usize,
    },
    /// A tolerance or accuracy is zero, negative, infinite or NaN.
    Tolerance {
        /// What was asked for.
        value: f64,
    },
    /// A tolerance is finer than the rounding of `f64` at the size of the curve.
    ToleranceTooFine {
        /// What was asked for.
        value: f64,
        /// About the finest that can be promised.
        finest: f64,
    },
    /// A parameter is NaN or outside of the curve's domain.
    Parameter {
        /// The parameter.
        value: f64,
    },
    /// A knot is not finite or not larger than the one before it (for B-splines: smaller, or repeated too often).
    Knot {
        /// Index of the knot.
        index: usize,
    },
    /// There is not the number of knots, tangents or weights that the points ask for.
    Count {
        /// How many there are.
        actual: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A weight is not a positive number.
    Weight {
        /// Index of the weight.
        index: usize,
    },
    /// Two neighbours do not meet.
    Gap {
        /// Index of the piece whose start is not the end of the one before it.
        piece: usize,
    },
    /// A path that must be closed is open.
    Open,
    /// A distance or width is infinite or NaN, or not positive where it must be.
    Distance {
        /// What was asked for.
        value: f64,
    },
    /// The dashes of a stroke are not of any length together, or one is negative, infinite or NaN.
    Dash {
        /// Index of the dash; of the last when they sum up to 0.
        index: usize,
    },
    /// A path would be cut into too many dashes.
    TooManyDashes {
        /// About how many.
        count: f64,
        /// The most that are drawn.
        most: usize,
    },
    /// Two curves run so near to one another for so long, without being one, that their meetings cannot be told apart.
    TooClose,
    /// The equations of an interpolation have no unique solution at this size.
    Singular,
}

impl fmt::Display for CurveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CurveError::TooFewPoints { actual, least } => {
                write!(f, "{actual} points where {least} are needed")
            }
            CurveError::NotFinite { index } => write!(f, "point {index} is not finite"),
            CurveError::Tolerance { value } => write!(f, "a tolerance of {value} is not a positive number"),
            CurveError::ToleranceTooFine { value, finest } => {
                write!(f, "a tolerance of {value} is below the rounding of this curve, about {finest}")
            }
            CurveError::Parameter { value } => write!(f, "the parameter {value} is not in the domain"),
            CurveError::Knot { index } => write!(f, "knot {index} is not finite or out of order"),
            CurveError::Count { actual, expected } => write!(f, "{actual} values where {expected} belong"),
            CurveError::Weight { index } => write!(f, "weight {index} is not a positive number"),
            CurveError::Gap { piece } => {
                write!(f, "piece {piece} does not start where the one before it ends")
            }
            CurveError::Open => write!(f, "the path is not closed"),
            CurveError::Distance { value } => write!(f, "{value} is no distance"),
            CurveError::Dash { index } => write!(f, "dash {index} is not a length"),
            CurveError::TooManyDashes { count, most } => {
                write!(f, "about {count} dashes where {most} is the most")
            }
            CurveError::TooClose => {
                write!(f, "the curves are too close to one another to tell where they meet")
            }
            CurveError::Singular => write!(f, "the equations of the interpolation are singular"),
        }
    }
}

impl std::error::Error for CurveError {}

/// The first point that is not finite, as an error.
fn check_finite<P: Blend>(points: &[P]) -> Result<(), CurveError> {
    match points.iter().position(|point| !point.finite()) {
        Some(index) => Err(CurveError::NotFinite { index }),
        None => Ok(()),
    }
}

/// Checks that a tolerance or accuracy is a positive finite number.
fn check_tolerance(value: f64) -> Result<(), CurveError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(CurveError::Tolerance { value }) }
}

/// Checks that a parameter lies within [0, 1].
fn check_unit(value: f64) -> Result<(), CurveError> {
    if (0.0..=1.0).contains(&value) { Ok(()) } else { Err(CurveError::Parameter { value }) }
}
