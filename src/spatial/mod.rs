//! Finding by place.

mod bvh;
mod grid;

pub use bvh::Bvh;
pub use grid::{Grid, Span};
