use super::Range;
use crate::math::{Aabb, Interval, Vec3};
use std::sync::Arc;

/// A function of space whose surface is where it changes its sign: negative inside, and zero counts as outside.
///
/// Only [`Field::value`] must be written. A field that brings no ranges can be measured but not certified; one that
/// does promises them for every point of a cell, boundary included, and for the values *as computed*: a range holds
/// what `value` returns there, rounding errors of the evaluation included.
///
/// A value is NaN where the function is undefined (the root of a negative number); ranges say so
/// ([`Range::defined`]). Methods that take many points give the same bits as those that take one.
///
/// ```
/// use ogee::math::Vec3;
/// use ogee::sdf::Field;
///
/// struct Wave;
///
/// impl Field for Wave {
///     fn value(&self, p: Vec3) -> f64 {
///         p.z - 0.1 * ogee::math::sin(p.x)
///     }
/// }
///
/// let (value, gradient) = Wave.gradient(Vec3::new(0.0, 0.0, 1.0));
/// assert_eq!(value, 1.0);
/// assert!((gradient - Vec3::new(-0.1, 0.0, 1.0)).length() < 1e-9);
/// assert!(Wave.range(ogee::math::Aabb::of([Vec3::ZERO])).is_none());
/// ```
pub trait Field: Send + Sync {
    /// The value at a point; NaN where there is none.
    fn value(&self, point: Vec3) -> f64;

    /// The values at many points, one a point.
    ///
    /// # Panics
    /// When `out` has another length than the points.
    fn values(&self, points: Points<'_>, out: &mut [f64]) {
        points.check(out.len());
        for (value, point) in out.iter_mut().zip(points.iter()) {
            *value = self.value(point);
        }
    }

    /// The value at a point and the gradient there; at a kink that of one side or a mean of both, where the value
    /// is NaN anything.
    ///
    /// By default from central differences, good to about 1e-10 of the value's scale over the unit of length.
    fn gradient(&self, point: Vec3) -> (f64, Vec3) {
        // The cube root of the rounding unit balances truncation and rounding.
        let step = 6e-6 * point.abs().max_element().max(1e-3);
        let slope = |axis: Vec3| {
            let (after, before) = (point + step * axis, point - step * axis);
            (self.value(after) - self.value(before)) / (after - before).dot(axis)
        };
        (self.value(point), Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)))
    }

    /// Values and gradients at many points, one of each a point.
    ///
    /// # Panics
    /// When `values` or `gradients` has another length than the points.
    fn gradients(&self, points: Points<'_>, values: &mut [f64], gradients: &mut [Vec3]) {
        points.check(values.len());
        points.check(gradients.len());
        for ((value, gradient), point) in values.iter_mut().zip(gradients).zip(points.iter()) {
            (*value, *gradient) = self.gradient(point);
        }
    }

    /// What the values over a cell are; `None` when the field brings no ranges at all.
    fn range(&self, _cell: Aabb) -> Option<Range> {
        None
    }

    /// [`Field::range`] and bounds of the three slopes over a cell; `None` when the field brings none.
    fn slopes(&self, _cell: Aabb) -> Option<Slopes> {
        None
    }

    /// [`Field::slopes`] and bounds of the second derivatives over a cell; `None` when the field brings none.
    fn curvature(&self, _cell: Aabb) -> Option<Curvature> {
        None
    }

    /// A proven L with |f(p) - f(q)| <= L |p - q| everywhere, up to rounding; `None` where none is known. Stepping
    /// |f(p)| / L from p never jumps over the surface.
    fn lipschitz(&self) -> Option<f64> {
        None
    }

    /// A field that gives the same bits for every point of the cell and costs less; `None` where this one is as
    /// cheap as it gets.
    fn within(&self, _cell: Aabb) -> Option<Arc<dyn Field>> {
        None
    }

    /// A box that holds the surface, and outside of which no value is negative; `None` where none is known, or the
    /// inside is unbounded.
    fn bounds(&self) -> Option<Aabb> {
        None
    }

    /// What the evaluation costs, in basic operations a point, roughly.
    fn cost(&self) -> usize {
        1
    }
}

/// Many points, a slice for each coordinate.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// First coordinates.
    pub x: &'a [f64],
    /// Second coordinates.
    pub y: &'a [f64],
    /// Third coordinates.
    pub z: &'a [f64],
}

impl<'a> Points<'a> {
    /// Points from slices of their coordinates.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn new(x: &'a [f64], y: &'a [f64], z: &'a [f64]) -> Points<'a> {
        assert!(x.len() == y.len() && y.len() == z.len(), "{} {} {}", x.len(), y.len(), z.len());
        Points { x, y, z }
    }

    /// Number of points.
    pub fn len(self) -> usize {
        self.x.len()
    }

    /// Whether there is none.
    pub fn is_empty(self) -> bool {
        self.x.is_empty()
    }

    /// The points one by one.
    pub fn iter(self) -> impl Iterator<Item = Vec3> + 'a {
        self.x.iter().zip(self.y).zip(self.z).map(|((&x, &y), &z)| Vec3::new(x, y, z))
    }

    pub(super) fn check(self, count: usize) {
        assert!(self.len() == count, "{} points, room for {count} results", self.len());
    }
}

/// The values of a field over a cell and how fast they change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes {
    /// The values.
    pub range: Range,
    /// For any two points p and q of the cell, f(p) - f(q) is a scalar product of p - q with a vector in these
    /// three intervals (but for rounding). They hold the gradients of both sides of every kink within the cell, though
    /// not of the far side of a kink on its boundary, and are [`Interval::ENTIRE`] where the field jumps, has no bounded
    /// slope, or may be undefined.
    pub gradient: [Interval; 3],
}

impl Slopes {
    /// The values once more, from those at one point of the cell and the slopes: the mean-value form, often narrower in
    /// small cells. `value` is the range over `middle` alone; its width tells how far rounding reaches, and the
    /// result is widened by four times that.
    pub fn narrowed(&self, cell: Aabb, middle: Vec3, value: Interval) -> Range {
        let reach = |axis: usize| {
            let side = Interval::new(cell.min[axis], cell.max[axis]) - Interval::point(middle[axis]);
            self.gradient[axis] * side
        };
        let slip = 4.0 * value.width();
        let mean = value + (reach(0) + reach(1) + reach(2)) + Interval::new(-slip, slip);
        let interval = self.range.interval.intersection(mean);
        // Nothing in common means that slopes and range are those of different cells; the range alone is then kept.
        Range { interval: if interval.is_empty() { self.range.interval } else { interval }, ..self.range }
    }

    /// Whether the surface within the cell is a graph over one axis, if it is there at all: no slope along that axis
    /// is zero. The axis with the steepest such slope.
    pub fn monotone_axis(&self) -> Option<usize> {
        let least = self.gradient.map(Interval::mignitude);
        let steepest = (0..3).fold(0, |best, axis| if least[axis] > least[best] { axis } else { best });
        (least[steepest] > 0.0).then_some(steepest)
    }
}

/// The values of a field over a cell, how fast they change, and how fast that changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// Values and slopes.
    pub slopes: Slopes,
    /// The second derivatives: by xx, yy, zz, yz, zx, xy. [`Interval::ENTIRE`] where there may be a kink.
    pub hessian: [Interval; 6],
}

impl Curvature {
    /// A bound of |v' H v| over unit vectors v: how fast the slope along any straight line can change.
    pub fn largest(&self) -> f64 {
        let [xx, yy, zz, yz, zx, xy] = self.hessian.map(Interval::magnitude);
        let row = |a: f64, b: f64, c: f64| ((a + b) + c) * (1.0 + 4.0 * f64::EPSILON);
        // No eigenvalue exceeds the greatest sum of magnitudes in a row (Gershgorin 1931).
        row(xx, xy, zx).max(row(xy, yy, yz)).max(row(zx, yz, zz))
    }
}
