//! The light of the studio: a warm key, a cool fill, and ambient light from sky and floor.

use super::color::{Light, add, times};
use crate::math::Vec3;

/// Lights in view coordinates (right, up, forward).
pub(super) struct Studio {
    lamps: [Lamp; 2],
    /// Up in the model.
    zenith: Vec3,
}

/// A lamp far away.
struct Lamp {
    /// Unit vector toward the lamp.
    toward: Vec3,
    light: Light,
    /// How strongly it glints.
    glint: f32,
}

/// Light that a point of a surface sends to the eye.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shade {
    /// From the lamps.
    pub(super) direct: Light,
    /// From all around; corners get less of it.
    pub(super) ambient: Light,
}

const SKY: Light = [0.44, 0.475, 0.54];
const FLOOR: Light = [0.225, 0.215, 0.205];

/// Sharpness of the highlight, that of a satin surface: Blinn's exponent is two to this.
const GLOSS: u32 = 5;

impl Studio {
    /// Lamps that stand with the camera, and a sky in the model's direction `zenith`.
    pub(super) fn new(zenith: Vec3) -> Studio {
        let lamp = |x: f64, y: f64, z: f64, light: Light, glint: f32| Lamp {
            toward: Vec3::new(x, y, z).normalize(),
            light,
            glint,
        };
        let key = lamp(-0.56, 0.64, -0.76, [0.98, 0.92, 0.855], 0.10);
        let fill = lamp(0.85, 0.10, -0.60, [0.12, 0.145, 0.19], 0.03);
        Studio { lamps: [key, fill], zenith }
    }

    /// Light from a surface of colour `albedo` and unit `normal` toward the eye, which is in direction `eye`.
    pub(super) fn shade(&self, albedo: Light, normal: Vec3, eye: Vec3) -> Shade {
        let up = (0.5 + 0.5 * normal.dot(self.zenith)) as f32;
        let mut shade =
            Shade { ambient: times(albedo, add(times(FLOOR, [1.0 - up; 3]), SKY, up)), ..Shade::default() };
        for lamp in &self.lamps {
            let facing = normal.dot(lamp.toward).max(0.0);
            shade.direct = add(shade.direct, times(albedo, lamp.light), facing as f32);
            let half = (lamp.toward + eye).normalize_or_zero();
            let glint = (0..GLOSS).fold(normal.dot(half).max(0.0), |x, _| x * x) * facing.min(0.25) * 4.0;
            shade.direct = add(shade.direct, lamp.light, lamp.glint * glint as f32);
        }
        shade
    }
}
