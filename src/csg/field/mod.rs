//! Fields in recipes: leaves given by formulas, smooth booleans, offsets, and how they become meshes.
//!
//! Sharp booleans at the top of a recipe are those of meshes, exact and cheap. What only fields can do is done by fields,
//! each meshed by itself to its own tolerance.

mod direct;
mod faces;
mod flush;
mod leaf;
mod make;
mod meeting;
pub(super) mod plan;
pub(super) mod print;
pub(super) mod reach;
mod round;
mod seams;

pub(super) use direct::Direct;
pub(super) use faces::{Faces, Surface};
pub use leaf::{FieldBody, FieldShape, Formula};
pub use make::Meshing;
pub use seams::Seams;
pub(super) use seams::{Sewn, sew};

/// What is done to the surface of a solid by its distance. Lengths are in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// Moved outward by so much, inward when negative: what a ball of this radius reaches from within.
    By(f64),
    /// Replaced by a wall of this thickness, half of it on each side.
    Shell(f64),
    /// Its outward edges rounded to this radius, the faces left where they are.
    Round(f64),
}

impl Offset {
    /// The length.
    pub fn size(self) -> f64 {
        match self {
            Offset::By(size) | Offset::Shell(size) | Offset::Round(size) => size,
        }
    }
}
