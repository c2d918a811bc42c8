//! Points, vectors and maps under short names, and the few shapes of ground they need.
//!
//! All of them are `f64` (`f32` lives only in file formats and pictures). The transcendental functions are those
//! of the `libm` crate, so that the same input gives the same bits on every platform.

mod aabb;
mod blend;
mod circle;
mod interval;

pub use aabb::Aabb;
pub use blend::Blend;
pub use circle::{degrees, sin_cos_degrees, unit_circle};
pub use glam::{
    DAffine2 as Affine2, DAffine3 as Affine3, DMat2 as Mat2, DMat3 as Mat3, DMat4 as Mat4, DQuat as Quat,
    DVec2 as Vec2, DVec3 as Vec3, DVec4 as Vec4,
};
pub use interval::{Interval, LIBM_PLACES};
pub use libm::{
    acos, asin, atan, atan2, cbrt, cos, cosh, exp, hypot, log as ln, log2, log10, pow, sin, sinh, tan, tanh,
};

/// Sine and cosine of an angle in radians.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// The largest power of two that is not above `|x|`; zero for zero and subnormal numbers. Dividing by it is exact but
/// for results that are subnormal.
pub fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & f64::INFINITY.to_bits())
}
