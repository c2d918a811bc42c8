//! Implicit surfaces: functions of space whose negative part is the inside.
//!
//! [`Field`] is what verbs ask of such a function: values, gradients, and, where it can, ranges over boxes that were
//! rounded outward and so prove something.

mod field;
mod range;

pub use field::{Curvature, Field, Points, Slopes};
pub use range::Range;
