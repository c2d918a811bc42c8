use super::{Vec2, Vec3, Vec4};
use std::fmt::Debug;
use std::ops::{Add, Mul, Sub};

/// What can be blended with weights: scalars, points of the plane and of space, homogeneous points.
///
/// One de Casteljau serves them all. Components are `f64` and numbered from 0.
pub trait Blend:
    Copy + Debug + PartialEq + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
    /// The neutral element of addition.
    const ZERO: Self;
    /// Number of components, at most 4.
    const DIMENSION: usize;

    /// The component of an axis below [`Blend::DIMENSION`].
    fn component(self, axis: usize) -> f64;

    /// The value with these components, asked for in order.
    fn from_components(component: impl FnMut(usize) -> f64) -> Self;

    /// The value with `f` applied to each component.
    #[inline]
    fn map(self, mut f: impl FnMut(f64) -> f64) -> Self {
        Self::from_components(|axis| f(self.component(axis)))
    }

    /// The value with `f` applied to each pair of components.
    #[inline]
    fn zip(self, other: Self, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        Self::from_components(|axis| f(self.component(axis), other.component(axis)))
    }

    /// Whether no component is NaN or infinite.
    #[inline]
    fn finite(self) -> bool {
        (0..Self::DIMENSION).all(|axis| self.component(axis).is_finite())
    }

    /// The largest absolute component.
    #[inline]
    fn max_abs(self) -> f64 {
        (0..Self::DIMENSION).fold(0.0, |most: f64, axis| most.max(self.component(axis).abs()))
    }

    /// The sum of products of components.
    #[inline]
    fn inner(self, other: Self) -> f64 {
        (0..Self::DIMENSION).fold(0.0, |sum, axis| sum + self.component(axis) * other.component(axis))
    }

    /// The Euclidean norm; neither overflows nor underflows before the result does.
    #[inline]
    fn norm(self) -> f64 {
        let square = self.inner(self);
        if square > 1e-280 && square < 1e280 {
            return square.sqrt();
        }
        let size = self.max_abs();
        if size == 0.0 || !size.is_finite() {
            return size;
        }
        // Division and not a reciprocal: that of a subnormal size is infinite.
        let unit = self.map(|x| x / size);
        size * unit.inner(unit).sqrt()
    }
}

impl Blend for f64 {
    const ZERO: f64 = 0.0;
    const DIMENSION: usize = 1;

    #[inline]
    fn component(self, _: usize) -> f64 {
        self
    }

    #[inline]
    fn from_components(mut component: impl FnMut(usize) -> f64) -> f64 {
        component(0)
    }
}

impl Blend for Vec2 {
    const ZERO: Vec2 = Vec2::ZERO;
    const DIMENSION: usize = 2;

    #[inline]
    fn component(self, axis: usize) -> f64 {
        self[axis]
    }

    #[inline]
    fn from_components(mut component: impl FnMut(usize) -> f64) -> Vec2 {
        Vec2::new(component(0), component(1))
    }
}

impl Blend for Vec3 {
    const ZERO: Vec3 = Vec3::ZERO;
    const DIMENSION: usize = 3;

    #[inline]
    fn component(self, axis: usize) -> f64 {
        self[axis]
    }

    #[inline]
    fn from_components(mut component: impl FnMut(usize) -> f64) -> Vec3 {
        Vec3::new(component(0), component(1), component(2))
    }
}

impl Blend for Vec4 {
    const ZERO: Vec4 = Vec4::ZERO;
    const DIMENSION: usize = 4;

    #[inline]
    fn component(self, axis: usize) -> f64 {
        self[axis]
    }

    #[inline]
    fn from_components(mut component: impl FnMut(usize) -> f64) -> Vec4 {
        Vec4::new(component(0), component(1), component(2), component(3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_do_not_overflow_or_vanish() {
        assert_eq!(Vec2::new(3.0, 4.0).norm(), 5.0);
        assert_eq!(Vec2::new(3e307, 4e307).norm(), 5e307);
        let tiny = f64::from_bits(1);
        assert_eq!(Vec3::new(0.0, tiny, 0.0).norm(), tiny);
        assert_eq!(Vec4::ZERO.norm(), 0.0);
        assert_eq!((-2.0_f64).norm(), 2.0);
    }

    #[test]
    fn components_come_back() {
        let v = Vec4::new(1.0, 2.0, 3.0, 4.0);
        assert_eq!(Vec4::from_components(|axis| v.component(axis)), v);
        assert_eq!(v.zip(v, |a, b| a * b), Vec4::new(1.0, 4.0, 9.0, 16.0));
        assert!(!Vec2::new(1.0, f64::NAN).finite());
    }
}
