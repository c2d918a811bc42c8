//! Numbers that can be trusted: exact signs, wide integers, stable hashes, seeded random numbers.

pub mod compensated;
