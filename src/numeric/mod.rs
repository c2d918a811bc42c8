//! Numbers that can be trusted: exact signs, wide integers, stable hashes, seeded random numbers.

pub mod compensated;
mod disjoint_sets;
mod hash;
mod predicates;
mod wide;

pub use disjoint_sets::DisjointSets;
pub use hash::{ContentHasher, MixHasher};
pub use predicates::{Unfit, fitted, orient2d, orient3d};
pub use wide::{Wide, rounded_quotient, scale_by_power_of_two};
