use super::Site;
use crate::math::Vec3;
use crate::numeric::scale_by_power_of_two;

/// Bits of the largest coordinate.
const BITS: i32 = 60;

/// The integer multiples of a power of two, on which the coordinates of one scene are taken.
///
/// The unit is at most 2^-59 of the largest coordinate of the scene, so coordinates down to 2^-7 of the largest keep all
/// their bits, and smaller ones move by at most 2^-60 of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    exponent: i32,
}

impl Lattice {
    /// The finest lattice for coordinates of at most `largest` in magnitude, which must be finite.
    pub fn fitting(largest: f64) -> Lattice {
        debug_assert!(largest.is_finite());
        Lattice { exponent: (exponent_above(largest) - BITS).max(f64::MIN_EXP - 53) }
    }

    /// The same lattice, or where that is coarser the one of the largest power of two that is at most `resolution`.
    pub fn as_coarse_as(self, resolution: f64) -> Lattice {
        let coarser = resolution > 0.0 && resolution.is_finite();
        let exponent = if coarser { exponent_above(resolution) - 1 } else { self.exponent };
        Lattice { exponent: self.exponent.max(exponent) }
    }

    /// The exponent of two by which coordinates on this lattice are multiplied on `other`.
    pub(crate) fn exponent_in(self, other: Lattice) -> i32 {
        self.exponent - other.exponent
    }

    /// The nearest lattice point (ties away from zero).
    pub fn snap(self, p: Vec3) -> Site {
        p.to_array().map(|c| scale_by_power_of_two(c, -self.exponent).round() as i64)
    }

    /// Whether a position is a lattice point.
    pub(crate) fn holds(self, p: Vec3) -> bool {
        p.to_array().iter().all(|&c| scale_by_power_of_two(c, -self.exponent).fract() == 0.0)
    }

    /// From lattice units to model units.
    pub fn to_model(self, p: Vec3) -> Vec3 {
        Vec3::from_array(p.to_array().map(|c| scale_by_power_of_two(c, self.exponent)))
    }
}

/// The smallest `e` with `value < 2^e`, for finite values; the least exponent for zero.
fn exponent_above(value: f64) -> i32 {
    let biased = (value.abs().to_bits() >> 52) as i32;
    biased.max(1) - 1022
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resolution_only_makes_coarser() {
        let fine = Lattice::fitting(1.0);
        assert_eq!(fine.as_coarse_as(0.0), fine);
        assert_eq!(fine.as_coarse_as(f64::NAN), fine);
        assert_eq!(fine.as_coarse_as(1e-30), fine);
        assert_eq!(fine.as_coarse_as(0.3).to_model(Vec3::ONE), Vec3::splat(0.25));
        assert_eq!(fine.as_coarse_as(0.25).to_model(Vec3::ONE), Vec3::splat(0.25));
    }

    #[test]
    fn coordinates_near_the_largest_are_kept() {
        for scale in [1e-300, 1e-9, 1.0, 3.0, 1e9, 1e300] {
            let lattice = Lattice::fitting(1.7 * scale);
            for c in [1.7, 0.3, -0.1, 0.0, 1.0 + f64::EPSILON] {
                let p = Vec3::splat(c * scale);
                let site = lattice.snap(p);
                assert!(site[0].abs() <= 1 << BITS);
                assert_eq!(lattice.to_model(Vec3::splat(site[0] as f64)), p, "{c} at {scale}");
            }
        }
    }
}
