use super::{Vec2, sin_cos};
use std::f64::consts::FRAC_1_SQRT_2;

const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;

/// Point `index` of `count` points spaced evenly round the unit circle, counter-clockwise from the x axis.
///
/// Points that mirror each other in the axes or diagonals do so bit for bit, and those at multiples of 30 and 45
/// degrees have exact coordinates (correctly rounded where they are irrational).
pub fn unit_circle(index: u64, count: u64) -> Vec2 {
    let (index, count) = (u128::from(index % count), u128::from(count));
    let quarter = 4 * index / count;
    let part = 4 * index % count;
    let mirrored = 2 * part > count;
    let steps = if mirrored { count - part } else { part };
    let (sin, cos) = first_octant(90.0 * steps as f64 / count as f64);
    let (x, y) = if mirrored { (sin, cos) } else { (cos, sin) };
    turned(Vec2::new(x, y), quarter as u32)
}

/// Sine and cosine of an angle in degrees; exact at multiples of 30 and 45 degrees, NaN for infinite angles.
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // The remainder and the differences below are exact.
    let turn = degrees % 360.0;
    let positive = turn.abs();
    let quarter = (positive / 90.0).floor().min(3.0);
    let part = positive - 90.0 * quarter;
    let first = if part > 45.0 {
        let (sin, cos) = first_octant(90.0 - part);
        Vec2::new(sin, cos)
    } else {
        let (sin, cos) = first_octant(part);
        Vec2::new(cos, sin)
    };
    let Vec2 { x: cos, y: sin } = turned(first, quarter as u32);
    (if turn < 0.0 { -sin } else { sin }, cos)
}

/// An angle in degrees from radians: the whole number of degrees whose radians, rounded, are `radians`, or else the
/// rounded quotient.
pub fn degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    let whole = degrees.round();
    if whole.to_radians() == radians { whole } else { degrees }
}

/// Sine and cosine of an angle from 0 to 45 degrees.
fn first_octant(degrees: f64) -> (f64, f64) {
    if degrees == 30.0 {
        (0.5, HALF_SQRT_3)
    } else if degrees == 45.0 {
        (FRAC_1_SQRT_2, FRAC_1_SQRT_2)
    } else {
        sin_cos(degrees.to_radians())
    }
}

/// `v` turned counter-clockwise by quarter turns.
fn turned(v: Vec2, quarters: u32) -> Vec2 {
    // Subtracting from zero keeps zeros positive.
    match quarters % 4 {
        0 => v,
        1 => Vec2::new(0.0 - v.y, v.x),
        2 => Vec2::new(0.0 - v.x, 0.0 - v.y),
        _ => Vec2::new(v.y, 0.0 - v.x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_angles() {
        let half = 0.5;
        for (degrees, sin, cos) in [
            (0.0, 0.0, 1.0),
            (30.0, half, HALF_SQRT_3),
            (60.0, HALF_SQRT_3, half),
            (90.0, 1.0, 0.0),
            (135.0, FRAC_1_SQRT_2, -FRAC_1_SQRT_2),
            (150.0, half, -HALF_SQRT_3),
            (180.0, 0.0, -1.0),
            (-30.0, -half, HALF_SQRT_3),
            (-90.0, -1.0, 0.0),
            (-450.0, -1.0, 0.0),
            (270.0, -1.0, 0.0),
            (3660.0, HALF_SQRT_3, half),
        ] {
            assert_eq!(sin_cos_degrees(degrees), (sin, cos), "{degrees}");
        }
        assert!(sin_cos_degrees(f64::INFINITY).0.is_nan());
    }

    #[test]
    fn the_circle_is_symmetric_and_agrees_with_degrees() {
        for count in [3_u64, 4, 5, 8, 12, 24, 100, 360, 1001] {
            for i in 0..count {
                let (p, q) = (unit_circle(i, count), unit_circle(count - i, count));
                assert_eq!((p.x, p.y), (q.x, 0.0 - q.y), "{i} of {count}");
                let (sin, cos) = sin_cos_degrees(360.0 * i as f64 / count as f64);
                assert!((p - Vec2::new(cos, sin)).length() < 2e-15 && (p.length() - 1.0).abs() < 3e-16);
            }
        }
        assert_eq!(unit_circle(2, 24), Vec2::new(HALF_SQRT_3, 0.5));
    }

    #[test]
    fn whole_degrees_survive_radians() {
        for d in -720..=720_i32 {
            assert_eq!(degrees(f64::from(d).to_radians()), f64::from(d));
        }
        assert!((degrees(1.0) - 57.295_779_513_082_32).abs() < 1e-13);
    }
}
