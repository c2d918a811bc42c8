//! Signs of determinants of coordinates, exact by adaptive expansions (Shewchuk, *Adaptive Precision Floating-Point
//! Arithmetic and Fast Robust Geometric Predicates*, 1997), as the `robust` crate has them.

use super::scale_by_power_of_two;
use crate::math::{Vec2, Vec3};
use robust::{Coord, Coord3D};
use std::fmt;

/// A number with the sign of the area of the triangle `a b c`: positive where it runs counter-clockwise, zero exactly
/// where the points are on one line. Exact for coordinates that are [`fitted`].
pub fn orient2d(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let coord = |p: Vec2| Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// A number with the sign of the volume of the tetrahedron `a b c d`: positive where `d` is on the side from which
/// `a b c` runs counter-clockwise, zero exactly where the points are in one plane. Exact for coordinates that are
/// [`fitted`].
pub fn orient3d(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> f64 {
    let coord = |p: Vec3| Coord3D { x: p.x, y: p.y, z: p.z };
    -robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// Why points cannot be brought into the range of exact signs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// A coordinate is NaN or infinite.
    NonFinite {
        /// Index of its point.
        point: usize,
    },
    /// A coordinate is about 1e-103 times the largest one, or less, but not zero.
    Range {
        /// Index of its point.
        point: usize,
    },
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unfit::NonFinite { point } => write!(f, "point {point} is not finite"),
            Unfit::Range { point } => write!(f, "point {point} has a coordinate too small beside the others"),
        }
    }
}

impl std::error::Error for Unfit {}

/// Points times the power of two that brings the largest coordinate between 2^199 and 2^200. No bit is lost, signs of
/// determinants stay the same, and they can be computed without overflow or underflow, which Shewchuk proves for
/// exponents from -142 to 201.
///
/// # Errors
/// [`Unfit`], with the first point that does not fit.
pub fn fitted<const N: usize>(points: &[[f64; N]]) -> Result<Vec<[f64; N]>, Unfit> {
    let is_finite = |point: &[f64; N]| point.iter().all(|c| c.is_finite());
    if let Some(point) = points.iter().position(|p| !is_finite(p)) {
        return Err(Unfit::NonFinite { point });
    }
    let largest = points.iter().flatten().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    // Subnormal numbers have exponent -1023 here, and end up lower by as many powers as they have leading zeros.
    let shift = 199 - ((largest.to_bits() >> 52) as i32 - 1023);
    let smallest = scale_by_power_of_two(1.0, -142);
    let mut fitted = points.to_vec();
    for (index, point) in fitted.iter_mut().enumerate() {
        for c in point {
            *c = scale_by_power_of_two(*c, shift);
            if *c != 0.0 && c.abs() < smallest {
                return Err(Unfit::Range { point: index });
            }
        }
    }
    match points.iter().zip(&fitted).position(|(p, f)| (0..N).any(|i| p[i] != 0.0 && f[i] == 0.0)) {
        Some(point) => Err(Unfit::Range { point }),
        None => Ok(fitted),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::Signed;
    use proptest::prelude::*;

    fn exact(x: f64) -> BigRational {
        BigRational::from_float(x).expect("finite")
    }

    fn sign(x: &BigRational) -> f64 {
        if x.is_positive() {
            1.0
        } else if x.is_negative() {
            -1.0
        } else {
            0.0
        }
    }

    fn sign_of(x: f64) -> f64 {
        if x == 0.0 { 0.0 } else { x.signum() }
    }

    #[test]
    fn conventions() {
        assert!(orient2d(Vec2::ZERO, Vec2::X, Vec2::Y) > 0.0);
        assert!(orient3d(Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z) > 0.0);
    }

    #[test]
    fn what_fits() {
        assert_eq!(fitted(&[[1.0, f64::NAN]]), Err(Unfit::NonFinite { point: 0 }));
        assert_eq!(fitted(&[[1.0, 1.0], [1e-110, 0.0]]), Err(Unfit::Range { point: 1 }));
        assert_eq!(fitted(&[[1e300, 1.0], [1e-300, 0.0]]), Err(Unfit::Range { point: 0 }));
        assert_eq!(fitted(&[[1e300, 0.0], [1e-300, 0.0]]), Err(Unfit::Range { point: 1 }));
        for size in [f64::MAX, 1e300, 1.0, 1e-300, 5e-324] {
            let fit = fitted(&[[size, -size], [0.0, size / 2.0]]).unwrap()[0];
            assert_eq!(fit[0], -fit[1]);
            assert!((1e40..=1.7e60).contains(&fit[0]), "{size}: {}", fit[0]);
        }
        assert_eq!(fitted(&[[0.0, 0.0]]), Ok(vec![[0.0, 0.0]]));
    }

    /// Coordinates near a common line or plane, where rounding decides without exact arithmetic.
    fn near() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3((0_i32..4, -3_i64..4)).prop_map(|c| {
            c.map(|(whole, ulps)| {
                f64::from_bits((f64::from(whole) + 0.1).to_bits().wrapping_add_signed(ulps))
            })
        })
    }

    proptest! {
        #[test]
        fn signs_agree_with_rationals(p in prop::collection::vec(near(), 4)) {
            let q: Vec<Vec<BigRational>> = p.iter().map(|p| p.iter().map(|&c| exact(c)).collect()).collect();
            let d = |i: usize, k: usize| &q[i][k] - &q[0][k];
            let minor = |i: usize, j: usize| d(1, i) * d(2, j) - d(1, j) * d(2, i);
            let volume = d(3, 0) * minor(1, 2) + d(3, 1) * minor(2, 0) + d(3, 2) * minor(0, 1);
            let at: Vec<Vec3> = p.iter().map(|&p| p.into()).collect();
            prop_assert_eq!(sign_of(orient3d(at[0], at[1], at[2], at[3])), sign(&volume));
            let flat = |i: usize| at[i].truncate();
            prop_assert_eq!(sign_of(orient2d(flat(0), flat(1), flat(2))), sign(&minor(0, 1)));
        }
    }
}
