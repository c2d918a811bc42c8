//! Numbers that can be trusted: exact signs, wide integers, stable hashes, seeded random numbers.

pub mod double_double;
pub mod quadrature;
pub mod roots;
pub mod tridiagonal;
