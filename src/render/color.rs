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

/// Light to coded bytes; more than white is white.
pub(super) struct Encoder {
    /// The least light of every byte but 0: the rounded code of light `x` is the number of bounds not above it.
    bounds: Vec<f32>,
}

impl Encoder {
    pub(super) fn new() -> Encoder {
        Encoder { bounds: (1..=255).map(|byte| decode([(byte as f32 - 0.5) / 255.0; 3])[0]).collect() }
    }

    pub(super) fn encode(&self, light: Light) -> [u8; 3] {
        light.map(|x| self.bounds.partition_point(|&bound| bound <= x) as u8)
    }
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
        let encoder = Encoder::new();
        for byte in 0..=255_u8 {
            let light = decode([f32::from(byte) / 255.0; 3]);
            assert_eq!(encoder.encode(light), [byte; 3]);
        }
        assert_eq!(encoder.encode(decode([f32::NAN, -1.0, f32::INFINITY])), [0, 0, 255]);
        assert_eq!(encoder.encode([0.215; 3]), [128; 3], "half of the code is a fifth of the light");
    }
}
