//! Numbers that can be trusted: exact signs, wide integers, compensated sums and double-doubles, roots, quadrature, small
//! solves, stable hashes.

pub mod compensated;
mod disjoint_sets;
pub mod double_double;
mod hash;
pub mod integer_polynomial;
mod predicates;
pub mod quadrature;
pub mod rational;
pub mod roots;
pub mod tridiagonal;
mod wide;

pub use disjoint_sets::DisjointSets;
pub use hash::{ContentHasher, MixHasher};
pub use predicates::{Unfit, fitted, orient2d, orient3d};
pub use wide::{Wide, rounded_quotient, scale_by_power_of_two};
