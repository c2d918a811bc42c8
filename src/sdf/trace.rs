use super::Field;
use crate::math::Vec3;

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Traced {
    /// The surface, at this distance along the ray: the value there is at most the tolerance.
    Hit(f64),
    /// Nothing as far as it was followed.
    Missed,
    /// A place where the field has no value, at this distance along the ray.
    Undefined(f64),
}

/// Follows a ray from `origin` along `direction`, of any length but zero, for a distance of `reach`.
///
/// Each step is as long as the value allows by `lipschitz`, a proven bound of the slope, so it never jumps over the
/// surface, however thin it is; it ends where the magnitude of the value is at most `tolerance`, or at the
/// first place of the other sign, and makes at most `reach * lipschitz / tolerance` steps. Hart, Sphere tracing, 1996.
///
/// ```
/// use ogee::math::Vec3;
/// use ogee::sdf::{Implicit, Primitive, Traced, trace};
///
/// let ball = Implicit::primitive(Primitive::Sphere { radius: 1.0 })?;
/// let met = trace(&ball.tape(), 1.0, Vec3::new(-3.0, 0.0, 0.0), Vec3::X, 10.0, 1e-9);
/// assert!(matches!(met, Traced::Hit(t) if (t - 2.0).abs() < 1e-8));
/// # Ok::<(), ogee::sdf::BadNumber>(())
/// ```
pub fn trace(
    field: &dyn Field,
    lipschitz: f64,
    origin: Vec3,
    direction: Vec3,
    reach: f64,
    tolerance: f64,
) -> Traced {
    let unit = direction.normalize_or_zero();
    // A step is never shorter than this, so the number of steps is bounded even where rounding swallows the value.
    let least = tolerance.max(4.0 * f64::EPSILON * (origin.abs().max_element() + reach)) / lipschitz;
    let first = field.value(origin);
    let mut travelled = 0.0;
    while travelled <= reach {
        let value = field.value(origin + travelled * unit);
        if value.is_nan() {
            return Traced::Undefined(travelled);
        }
        if value.abs() <= tolerance || (value < 0.0) != (first < 0.0) {
            return Traced::Hit(travelled);
        }
        travelled += (value.abs() / lipschitz).max(least);
    }
    Traced::Missed
}
