//! Trigonometry in degrees, exact where the result is a simple number: at all multiples of 30 and 45 degrees.

use crate::math;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Radians of an angle in degrees.
pub(super) fn radians(degrees: f64) -> f64 {
    degrees * (PI / 180.0)
}

/// Sine; NaN for an angle that is not finite.
pub(super) fn sin(degrees: f64) -> f64 {
    // The remainder is exact, so no angle is too large.
    let turned = degrees % 360.0;
    let (turned, sign) = if turned < 0.0 { (-turned, -1.0) } else { (turned, 1.0) };
    let (half, sign) = if turned >= 180.0 { (turned - 180.0, -sign) } else { (turned, sign) };
    sign * sin_first_quadrant(if half > 90.0 { 180.0 - half } else { half })
}

/// Cosine; NaN for an angle that is not finite.
pub(super) fn cos(degrees: f64) -> f64 {
    let turned = (degrees % 360.0).abs();
    let half = if turned > 180.0 { 360.0 - turned } else { turned };
    if half > 90.0 { -sin_first_quadrant(half - 90.0) } else { sin_first_quadrant(90.0 - half) }
}

/// Sine over cosine; infinite at odd multiples of 90 degrees.
pub(super) fn tan(degrees: f64) -> f64 {
    sin(degrees) / cos(degrees)
}

/// Inverse sine, from -90 to 90.
pub(super) fn asin(value: f64) -> f64 {
    whole_if(degrees(math::asin(value)), |angle| sin(angle) == value)
}

/// Inverse cosine, from 0 to 180.
pub(super) fn acos(value: f64) -> f64 {
    whole_if(degrees(math::acos(value)), |angle| cos(angle) == value)
}

/// Inverse tangent, from -90 to 90.
pub(super) fn atan(value: f64) -> f64 {
    whole_if(degrees(math::atan(value)), |angle| tan(angle) == value)
}

/// Angle of the vector `(x, y)`, from -180 to 180.
pub(super) fn atan2(y: f64, x: f64) -> f64 {
    whole_if(degrees(math::atan2(y, x)), |angle| tan(angle) == y / x)
}

fn degrees(radians: f64) -> f64 {
    radians * (180.0 / PI)
}

/// The whole number of degrees next to `angle` where it is exactly the one wanted.
fn whole_if(angle: f64, is_exact: impl Fn(f64) -> bool) -> f64 {
    let whole = angle.round();
    if is_exact(whole) { whole } else { angle }
}

/// Sine from 0 to 90 degrees. Above 45 it is the cosine of the rest, so that `sin(a) == cos(90 - a)`.
fn sin_first_quadrant(degrees: f64) -> f64 {
    match degrees {
        0.0 => 0.0,
        30.0 => 0.5,
        45.0 => FRAC_1_SQRT_2,
        60.0 => 0.75_f64.sqrt(),
        90.0 => 1.0,
        _ if degrees > 45.0 => math::cos(radians(90.0 - degrees)),
        _ => math::sin(radians(degrees)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_thirds_and_halves_are_exact() {
        for turn in -3..=3 {
            let at = |degrees: f64| degrees + 360.0 * f64::from(turn);
            assert_eq!([sin(at(0.0)), sin(at(90.0)), sin(at(180.0)), sin(at(270.0))], [0.0, 1.0, 0.0, -1.0]);
            assert_eq!([cos(at(0.0)), cos(at(90.0)), cos(at(180.0)), cos(at(270.0))], [1.0, 0.0, -1.0, 0.0]);
            assert_eq!(
                [sin(at(30.0)), sin(at(210.0)), cos(at(60.0)), cos(at(240.0))],
                [0.5, -0.5, 0.5, -0.5]
            );
            assert_eq!([tan(at(45.0)), tan(at(135.0))], [1.0, -1.0]);
        }
    }

    #[test]
    fn sines_agree_with_radians() {
        for tenth in -7200..7200 {
            let angle = f64::from(tenth) / 10.0;
            assert!((sin(angle) - math::sin(radians(angle))).abs() < 4e-15, "{angle}");
            assert!((cos(angle) - math::cos(radians(angle))).abs() < 4e-15, "{angle}");
        }
    }

    #[test]
    fn inverses_of_whole_degrees_are_whole() {
        for whole in -90..=90 {
            let angle = f64::from(whole);
            assert_eq!(asin(sin(angle)), angle);
            assert_eq!(atan(tan(angle)), angle);
            assert_eq!(acos(cos(angle + 90.0)), angle + 90.0);
        }
    }
}
