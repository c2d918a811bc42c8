//! Finding by place.

mod bvh;

pub use bvh::Bvh;
