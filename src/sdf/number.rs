//! How each kind of number is asked of a field that is a part of a formula, and of a primitive.

use super::dual::Dual;
use super::primitive::Primitive;
use super::real::{LANES, Lanes, Real};
use super::{Field, Points, Range};
use crate::math::{Aabb, Interval, Vec3};
use std::array::from_fn;

/// A kind of number that whole formulas are evaluated with.
pub(super) trait Number: Real {
    /// The field at these coordinates.
    fn of_field(field: &dyn Field, at: [Self; 3]) -> Self;

    /// The primitive at these coordinates.
    #[inline(always)]
    fn of_primitive(primitive: Primitive, at: [Self; 3]) -> Self {
        primitive.apply(at)
    }
}

impl Number for f64 {
    fn of_field(field: &dyn Field, [x, y, z]: [f64; 3]) -> f64 {
        field.value(Vec3::new(x, y, z))
    }
}

impl Number for Lanes {
    fn of_field(field: &dyn Field, at: [Lanes; 3]) -> Lanes {
        let mut out = [0.0; LANES];
        field.values(Points::new(&at[0].0, &at[1].0, &at[2].0), &mut out);
        Lanes(out)
    }
}

impl Number for Dual<f64> {
    fn of_field(field: &dyn Field, at: [Dual<f64>; 3]) -> Dual<f64> {
        let (value, gradient) = field.gradient(Vec3::from_array(at.map(|x| x.value)));
        Dual::of_gradient(value, gradient.to_array(), at)
    }
}

impl Number for Dual<Lanes> {
    fn of_field(field: &dyn Field, at: [Dual<Lanes>; 3]) -> Dual<Lanes> {
        let (mut values, mut gradients) = ([0.0; LANES], [Vec3::ZERO; LANES]);
        let [x, y, z] = at.map(|x| x.value.0);
        field.gradients(Points::new(&x, &y, &z), &mut values, &mut gradients);
        let gradient = from_fn(|axis| Lanes(from_fn(|i| gradients[i][axis])));
        Dual::of_gradient(Lanes(values), gradient, at)
    }
}

impl Number for Range {
    fn of_field(field: &dyn Field, at: [Range; 3]) -> Range {
        let Some(cell) = cell(at) else { return Range::UNKNOWN };
        passed_on(field.range(cell).unwrap_or(Range::UNKNOWN), at)
    }

    fn of_primitive(primitive: Primitive, at: [Range; 3]) -> Range {
        let natural = primitive.apply(at);
        let Some(cell) = cell(at).filter(|cell| cell.size().is_finite()) else { return natural };
        let ball = within_reach(cell, primitive.lipschitz(), |p| primitive.apply(p.to_array()));
        Range { interval: natural.interval.intersection(ball), ..natural }
    }
}

impl Number for Dual<Range> {
    fn of_field(field: &dyn Field, at: [Dual<Range>; 3]) -> Dual<Range> {
        let values = at.map(|x| x.value);
        let slopes = cell(values).and_then(|cell| field.slopes(cell));
        let Some(slopes) = slopes else {
            let unknown = [Range::UNKNOWN; 3];
            return Dual::of_gradient(Range::of_field(field, values), unknown, at);
        };
        Dual::of_gradient(passed_on(slopes.range, values), slopes.gradient.map(Range::of), at)
    }

    fn of_primitive(primitive: Primitive, at: [Dual<Range>; 3]) -> Dual<Range> {
        let dual = primitive.apply(at);
        Dual { value: Range::of_primitive(primitive, at.map(|x| x.value)), ..dual }
    }
}

/// Values with slopes, and slopes with slopes of their own: second derivatives.
pub(super) type Second = Dual<Dual<Range>>;

impl Number for Second {
    fn of_field(field: &dyn Field, at: [Second; 3]) -> Second {
        let inner = at.map(|x| x.value);
        let values = inner.map(|x| x.value);
        let value = Dual::<Range>::of_field(field, inner);
        let curvature = cell(values).and_then(|cell| field.curvature(cell));
        let (gradient, hessian) = match curvature {
            Some(curvature) => (curvature.slopes.gradient, curvature.hessian),
            None => ([Interval::ENTIRE; 3], [Interval::ENTIRE; 6]),
        };
        let [xx, yy, zz, yz, zx, xy] = hessian.map(Range::of);
        let rows = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
        let slopes = from_fn(|i| Dual::of_gradient(Range::of(gradient[i]), rows[i], inner));
        Dual::of_gradient(value, slopes, at)
    }

    fn of_primitive(primitive: Primitive, at: [Second; 3]) -> Second {
        let second = primitive.apply(at);
        let value = Range::of_primitive(primitive, at.map(|x| x.value.value));
        Dual { value: Dual { value, ..second.value }, ..second }
    }
}

/// The box that coordinates may be in; `None` when there is none.
fn cell(at: [Range; 3]) -> Option<Aabb> {
    let [x, y, z] = at.map(|x| x.interval);
    let empty = x.is_empty() || y.is_empty() || z.is_empty();
    (!empty).then(|| Aabb { min: Vec3::new(x.lo, y.lo, z.lo), max: Vec3::new(x.hi, y.hi, z.hi) })
}

/// The range of a field whose coordinates are themselves computed.
fn passed_on(range: Range, at: [Range; 3]) -> Range {
    let defined = range.defined && at.iter().all(|x| x.defined);
    let continuous = range.continuous && at.iter().all(|x| x.continuous);
    Range { defined, continuous, ..range }
}

/// The values over a cell of a function whose slope is at most `lipschitz`, from the one in the middle. Rounding of the
/// function itself is allowed for by 64 units in the last place of the largest coordinate: several times what the
/// dozen operations of a primitive can lose.
pub(super) fn within_reach(cell: Aabb, lipschitz: f64, value: impl Fn(Vec3) -> f64) -> Interval {
    let (middle, half) = (cell.center(), 0.5 * cell.size());
    let value = value(middle);
    let size = middle.abs().max_element() + half.max_element() + value.abs();
    let reach = lipschitz * half.length() * (1.0 + 8.0 * f64::EPSILON)
        + (1.0 + lipschitz) * 32.0 * f64::EPSILON * size
        + f64::MIN_POSITIVE;
    if value.is_nan() { Interval::ENTIRE } else { Interval::point(value) + Interval::new(-reach, reach) }
}
