//! Colours: coded as in files (sRGB) outside, proportional to light inside.

use crate::math::pow;

/// Light of the three channels, 1 for white.
pub(super) type Light = [f32; 3];

/// Light of a coded colour (IEC 61966-2-1). What is not a number counts as 0; what is outside 0 to 1 is brought inside.
pub(super) fn decode(color: [f32; 3]) -> Light {
    color.map(|c| {
        let c = if c.is_nan() { 0.0 } else { f64::from(c.clamp(0.0, 1.0)) };
        (if c <= 0.04045 { c / 12.92 } else { pow((c + 0.055) / 1.055, 2.4) }) as f32
    })
}

/// The coded colour of light, in bytes; more than white is white.
pub(super) fn encode(light: Light) -> [u8; 3] {
    light.map(|x| {
        let x = f64::from(x.clamp(0.0, 1.0));
        let coded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * pow(x, 1.0 / 2.4) - 0.055 };
        (coded * 255.0).round() as u8
    })
}

/// `a + (b - a) t`, channel by channel.
pub(super) fn mix(a: Light, b: Light, t: f32) -> Light {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t)
}

/// `a + b t`, channel by channel.
pub(super) fn add(a: Light, b: Light, t: f32) -> Light {
    [0, 1, 2].map(|i| a[i] + b[i] * t)
}

/// `a b`, channel by channel.
pub(super) fn times(a: Light, b: Light) -> Light {
    [0, 1, 2].map(|i| a[i] * b[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_comes_back() {
        for byte in 0..=255_u8 {
            let light = decode([f32::from(byte) / 255.0; 3]);
            assert_eq!(encode(light), [byte; 3]);
        }
        assert_eq!(encode(decode([f32::NAN, -1.0, f32::INFINITY])), [0, 0, 255]);
        assert_eq!(encode([0.214_041_14; 3]), [128; 3], "half of the code is a fifth of the light");
    }
}
