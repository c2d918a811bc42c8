//! Implicit surfaces: functions of space whose negative part is the inside.
//!
//! [`Field`] is what verbs ask of such a function: values, gradients, and, where it can, ranges over boxes that were
//! rounded outward and so prove something.

mod dual;
mod expr;
mod field;
mod from_mesh;
mod graph;
mod implicit;
mod number;
mod op;
mod outline;
mod primitive;
mod prune;
mod range;
mod real;
mod registers;
mod shell;
mod symbol;
mod tape;
mod trace;
mod tube;
mod warp;

pub use expr::Expr;
pub use field::{Curvature, Field, Points, Slopes};
pub use from_mesh::MeshField;
pub(crate) use implicit::greatest_stretch;
pub use implicit::{BadNumber, Implicit};
pub use op::{Binary, Blend, Unary};
pub use outline::Polygon;
pub use primitive::{Periodic, Primitive};
pub use range::Range;
pub(crate) use shell::{Local, Post, Shell, most_of_products};
pub use symbol::Operation;
pub use tape::Tape;
pub use trace::{Traced, trace};
pub use tube::Tube;
