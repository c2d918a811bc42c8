//! All ways to evaluate a field agree: batches and gradients give the bits of single points, ranges hold them, slopes
//! hold the differences, and what is left out within a cell changes nothing.

mod fields;

use fields::{Cell, expression, points_in, same_bits, zoo};
use ogee::math::{Interval, Vec3};
use ogee::sdf::{Field, Points};
use proptest::prelude::*;

/// Whether two computed numbers may come from the same exact one: slopes are bounded for exact functions.
fn nearly_in(interval: Interval, x: f64, scale: f64) -> bool {
    let slip = 1e-9 * (1.0 + scale + x.abs());
    interval.lo - slip <= x && x <= interval.hi + slip
}

fn agree(field: &dyn Field, points: &[Vec3], name: &str) {
    let coordinate = |axis: usize| points.iter().map(|p| p[axis]).collect::<Vec<_>>();
    let [x, y, z] = [0, 1, 2].map(coordinate);
    let mut values = vec![0.0; points.len()];
    field.values(Points::new(&x, &y, &z), &mut values);
    let (mut dual_values, mut gradients) = (values.clone(), vec![Vec3::ZERO; points.len()]);
    field.gradients(Points::new(&x, &y, &z), &mut dual_values, &mut gradients);
    for (i, &p) in points.iter().enumerate() {
        let value = field.value(p);
        assert!(same_bits(value, values[i]), "{name} batch at {p}: {value} {}", values[i]);
        assert!(same_bits(value, dual_values[i]), "{name} gradients at {p}: {value} {}", dual_values[i]);
        let (single, gradient) = field.gradient(p);
        assert!(same_bits(value, single), "{name} gradient at {p}: {value} {single}");
        for axis in 0..3 {
            assert!(
                same_bits(gradient[axis], gradients[i][axis]),
                "{name} gradient at {p}: {gradient} {}",
                gradients[i]
            );
        }
    }
}

fn ranges_hold(field: &dyn Field, cell: Cell, name: &str) {
    let points = points_in(cell, 12);
    let range = field.range(cell.aabb()).expect("ranges");
    let slopes = field.slopes(cell.aabb()).expect("slopes");
    let curvature = field.curvature(cell.aabb()).expect("curvature");
    let values: Vec<f64> = points.iter().map(|&p| field.value(p)).collect();
    for (&p, &value) in points.iter().zip(&values) {
        if value.is_nan() {
            assert!(!range.defined, "{name} in {cell:?}: NaN at {p}");
            continue;
        }
        assert!(
            range.interval.contains(value) || value.is_infinite(),
            "{name} in {cell:?}: {value} at {p}, {range:?}"
        );
        assert!(
            slopes.range.interval.contains(value) || value.is_infinite(),
            "{name} in {cell:?}: {value}, {slopes:?}"
        );
    }
    let size = range.interval.magnitude();
    if !size.is_finite() || !slopes.range.continuous || !slopes.range.defined {
        return;
    }
    for pair in points.windows(2).map(|w| (w[0], w[1])).zip(values.windows(2)) {
        let ((p, q), v) = pair;
        let d = p - q;
        let spread = (0..3).fold(Interval::ZERO, |sum, i| sum + slopes.gradient[i] * Interval::point(d[i]));
        assert!(nearly_in(spread, v[0] - v[1], size), "{name} in {cell:?}: {p} {q} {v:?} {slopes:?}");
    }
    let h = curvature.hessian;
    // On the boundary the computed gradient may be that of the far side of a kink.
    if h.iter().any(|h| !h.is_bounded()) || cell.size.min_element() == 0.0 {
        return;
    }
    for (p, q) in points[8..].windows(2).map(|w| (w[0], w[1])) {
        let (d, (_, gp), (_, gq)) = (p - q, field.gradient(p), field.gradient(q));
        if gp.is_nan() || gq.is_nan() {
            continue; // Infinite numbers on the way.
        }
        let rows = [[h[0], h[5], h[4]], [h[5], h[1], h[3]], [h[4], h[3], h[2]]];
        let steep = gp.abs().max_element().max(gq.abs().max_element());
        for axis in 0..3 {
            let spread = (0..3).fold(Interval::ZERO, |sum, i| sum + rows[axis][i] * Interval::point(d[i]));
            assert!(
                nearly_in(spread, gp[axis] - gq[axis], steep + size),
                "{name} in {cell:?}: {gp} {gq} {curvature:?}"
            );
        }
    }
}

fn pruning_keeps_bits(field: &dyn Field, cell: Cell, name: &str) -> bool {
    let Some(within) = field.within(cell.aabb()) else { return false };
    for p in points_in(cell, 12) {
        let (all, few) = (field.value(p), within.value(p));
        assert!(same_bits(all, few), "{name} in {cell:?} at {p}: {all} {few}");
    }
    assert!(within.cost() < field.cost(), "{name}");
    true
}

fn cell() -> impl Strategy<Value = Cell> {
    let place = prop_oneof![-3.0..3.0_f64, Just(0.0), Just(1.0), Just(-0.5)];
    let size = prop_oneof![4 => -9.0..1.5_f64, 1 => Just(f64::NEG_INFINITY)].prop_map(f64::exp2);
    (prop::array::uniform3(place), prop::array::uniform3(size), any::<u64>())
        .prop_map(|(corner, size, seed)| Cell { corner: corner.into(), size: size.into(), seed })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(fields::cases(1500)))]

    #[test]
    fn formulas(expression in expression(), cell in cell()) {
        let tape = expression.compile();
        agree(&tape, &points_in(cell, 11), "formula");
        ranges_hold(&tape, cell, "formula");
        pruning_keeps_bits(&tape, cell, "formula");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(fields::cases(100)))]

    #[test]
    fn shapes(cell in cell()) {
        for (name, field) in zoo() {
            agree(field, &points_in(cell, 11), name);
            ranges_hold(field, cell, name);
            pruning_keeps_bits(field, cell, name);
        }
    }
}

#[test]
fn hostile_points_neither_panic_nor_disagree() {
    let numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e308, -1e308, 5e-324, 1.0, 1e154];
    let mut points = Vec::new();
    for (i, &x) in numbers.iter().enumerate() {
        for (j, &y) in numbers.iter().enumerate() {
            points.push(Vec3::new(x, y, numbers[(i + 3 * j) % numbers.len()]));
        }
    }
    for (name, field) in zoo() {
        agree(field, &points, name);
    }
}
