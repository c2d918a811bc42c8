//! Curves brought near the origin and near size 1, so that products neither overflow nor lose what is there.

use super::subdivide::reciprocal_powers;
use super::{Bounds, CurveError, check_tolerance};
use crate::math::Vec2;

/// A map from model units to numbers of at most about 1 and back: a shift, halved so that nothing overflows, and a
/// power of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct UnitFrame {
    origin: Vec2,
    factors: [f64; 2],
    /// The largest coordinate of the model.
    largest: f64,
}

/// Rounding of a few dozen operations on numbers of size 1.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl UnitFrame {
    /// The frame in which a box widened by `margin` is within [-1, 1].
    pub(super) fn around(bounds: &Bounds<Vec2>, margin: f64) -> Result<UnitFrame, CurveError> {
        let origin = 0.5 * bounds.min + 0.5 * bounds.max;
        let half = 0.5 * bounds.max - 0.5 * bounds.min;
        let reach = half.max_element() + margin.abs();
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element() + margin.abs();
        if !largest.is_finite() {
            return Err(CurveError::NotFinite { index: 0 });
        }
        let factors = if reach > 0.0 { reciprocal_powers(reach) } else { [1.0, 1.0] };
        Ok(UnitFrame { origin, factors: [0.5 * factors[0], factors[1]], largest })
    }

    pub(super) fn inward(&self, point: Vec2) -> Vec2 {
        (0.5 * point - 0.5 * self.origin) * (2.0 * self.factors[0]) * self.factors[1]
    }

    pub(super) fn outward(&self, point: Vec2) -> Vec2 {
        (0.5 * self.origin + point * (0.5 / self.factors[0]) / self.factors[1]) * 2.0
    }

    pub(super) fn length_inward(&self, length: f64) -> f64 {
        length * self.factors[0] * self.factors[1]
    }

    pub(super) fn length_outward(&self, length: f64) -> f64 {
        length / self.factors[0] / self.factors[1]
    }

    /// Rounding of coordinates on the way in and out, in frame units.
    pub(super) fn rounding(&self) -> f64 {
        ROUNDING + 4.0 * f64::EPSILON * self.length_inward(self.largest)
    }

    /// The tolerance in frame units, less what rounding takes.
    ///
    /// # Errors
    /// [`CurveError::Tolerance`], [`CurveError::ToleranceTooFine`] when rounding takes more than a quarter of it.
    pub(super) fn tolerance(&self, tolerance: f64) -> Result<f64, CurveError> {
        check_tolerance(tolerance)?;
        let inward = self.length_inward(tolerance).min(f64::MAX);
        if inward < 4.0 * self.rounding() {
            let finest = self.length_outward(4.0 * self.rounding());
            return Err(CurveError::ToleranceTooFine { value: tolerance, finest });
        }
        Ok(inward - self.rounding())
    }

    /// A proved distance in frame units, within what [`UnitFrame::tolerance`] left of a tolerance, as one in model units
    /// with its rounding.
    pub(super) fn error_outward(&self, error: f64, tolerance: f64) -> f64 {
        let outward = self.length_outward(error + self.rounding());
        debug_assert!(outward <= tolerance * (1.0 + 4.0 * f64::EPSILON), "{outward} of {tolerance}");
        outward.min(tolerance)
    }
}
