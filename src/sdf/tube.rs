use super::implicit::{BadNumber, Implicit};
use super::number::within_reach;
use super::real::Real;
use super::{Expr, Field, Range, Slopes};
use crate::curve::{AnyBezier, Bernstein, nearest};
use crate::math::{Aabb, Interval, Vec3};
use std::sync::Arc;

/// The exact distance from all points within a radius of a Bézier curve; its ends are round.
#[derive(Clone, Debug)]
pub struct Tube {
    curve: AnyBezier<Vec3>,
    radius: f64,
    /// Boxes around parts of the curve.
    parts: Vec<Aabb>,
}

/// Parts that slopes tell apart.
const PARTS: u32 = 32;

/// Greatest degree of the curve: every point solves an equation of about twice this degree.
const MOST_DEGREE: usize = 20;

impl Tube {
    /// The tube around a curve.
    ///
    /// # Errors
    /// A radius that is not positive, a curve of a degree above 20.
    pub fn new(curve: AnyBezier<Vec3>, radius: f64) -> Result<Tube, BadNumber> {
        BadNumber::positive("radius", radius)?;
        let degree = curve.degree();
        BadNumber::check("degree of the curve", "at most 20", degree as f64, degree <= MOST_DEGREE)?;
        let part = |i: u32| {
            let ends = [i, i + 1].map(|k| f64::from(k) / f64::from(PARTS));
            // What cannot be cut out is held by the whole.
            let cut = curve.subcurve(ends[0], ends[1]).ok();
            Aabb::of(cut.as_ref().unwrap_or(&curve).points().iter().copied())
        };
        let parts: Vec<Aabb> = (0..PARTS).map(part).collect();
        Ok(Tube { curve, radius, parts })
    }

    /// The distance from the curve and its nearest point; NaN for a point that is not finite.
    fn nearest(&self, p: Vec3) -> (f64, Vec3) {
        nearest(&self.curve, p).map_or((f64::NAN, Vec3::NAN), |found| (found.distance.value, found.point))
    }
}

impl Field for Tube {
    fn value(&self, point: Vec3) -> f64 {
        self.nearest(point).0 - self.radius
    }

    fn gradient(&self, point: Vec3) -> (f64, Vec3) {
        let (distance, foot) = self.nearest(point);
        (distance - self.radius, (point - foot).normalize_or_zero())
    }

    fn range(&self, cell: Aabb) -> Option<Range> {
        Some(Range::of(within_reach(cell, 1.0, |p| self.value(p))))
    }

    fn slopes(&self, cell: Aabb) -> Option<Slopes> {
        let range = self.range(cell)?;
        let (middle, reach) = (cell.center(), 0.5 * cell.size().length());
        let limit = (self.nearest(middle).0 + 2.0 * reach) * (1.0 + 1e-12);
        let side = |a: Vec3, b: Vec3, axis: usize| Range::of(Interval::new(a[axis], b[axis]));
        let mut gradient = [Interval::EMPTY; 3];
        for part in &self.parts {
            let beside = middle - middle.clamp(part.min, part.max);
            if beside.length() <= limit {
                let from = [0, 1, 2].map(|i| side(cell.min, cell.max, i) - side(part.min, part.max, i));
                let unit = Range::direction(from);
                gradient = std::array::from_fn(|i| gradient[i].hull(unit[i].interval));
            }
        }
        // Parts are boxes of rounded points.
        let gradient = gradient.map(|g| if g.is_empty() { Interval::SIGNED_UNIT } else { g.widened(8) });
        Some(Slopes { range, gradient })
    }

    fn lipschitz(&self) -> Option<f64> {
        Some(1.0 + 1e-12)
    }

    fn bounds(&self) -> Option<Aabb> {
        let hull = self.parts.iter().fold(Aabb::EMPTY, |all, &part| all.union(part));
        Some(super::implicit::grown(hull, self.radius * (1.0 + 1e-12)))
    }

    fn cost(&self) -> usize {
        500
    }
}

impl Implicit {
    /// The tube around a Bézier curve. Exact.
    ///
    /// # Errors
    /// As [`Tube::new`].
    pub fn tube(curve: AnyBezier<Vec3>, radius: f64) -> Result<Implicit, BadNumber> {
        let tube = Arc::new(Tube::new(curve, radius)?);
        let (lipschitz, bounds) = (tube.lipschitz(), tube.bounds().unwrap_or(Aabb::EMPTY));
        Ok(Implicit::formula(Expr::field(tube), lipschitz, bounds).with_exactness(true, true))
    }
}
