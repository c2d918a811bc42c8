//! Where a curve turns, and the box and hull around it.

use super::Bernstein;
use super::bernstein::{BernsteinRoot, roots};
use super::bounded::eval_bounded;
use super::subdivide::{restrict, with_unit_size};
use crate::math::{Blend, Vec2};
use crate::numeric::orient2d;

/// A box with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<P> {
    /// The smallest components.
    pub min: P,
    /// The largest components.
    pub max: P,
}

/// Parameters in [0, 1], ascending, where a component of the curve turns: where its derivative vanishes, with
/// multiplicity (odd at an extremum). None for a component that is constant.
///
/// # Panics
/// When there is no such axis.
pub fn turns<C: Bernstein>(curve: &C, axis: usize) -> Vec<BernsteinRoot> {
    assert!(axis < C::Vector::DIMENSION, "axis {axis} of {}", C::Vector::DIMENSION);
    let mut values: Vec<f64> = curve.points().iter().map(|point| point.component(axis)).collect();
    with_unit_size(&mut values, |values| turns_of(values))
}

/// The turns of a polynomial of about unit size.
fn turns_of(values: &[f64]) -> Vec<BernsteinRoot> {
    let differences: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if differences.is_empty()
        || differences.iter().all(|&d| d >= 0.0)
        || differences.iter().all(|&d| d <= 0.0)
    {
        // Monotone: at most the ends, where a zero derivative is no turn.
        return Vec::new();
    }
    let size = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    roots(&differences, 0.5 * f64::EPSILON * size).isolated()
}

/// The smallest box around the curve, rounded outward: no point of the curve is outside, and no side is off by more
/// than the rounding of an evaluation. A side that an end point touches is exact.
pub fn bounding_box<C: Bernstein>(curve: &C) -> Bounds<C::Vector> {
    let sides: Vec<[f64; 2]> = (0..C::Vector::DIMENSION)
        .map(|axis| {
            let values: Vec<f64> = curve.points().iter().map(|point| point.component(axis)).collect();
            let turns = turns(curve, axis);
            range(&values, &turns)
        })
        .collect();
    Bounds {
        min: C::Vector::from_components(|axis| sides[axis][0]),
        max: C::Vector::from_components(|axis| sides[axis][1]),
    }
}

/// Least and greatest value of a polynomial with these turns.
fn range(values: &[f64], turns: &[BernsteinRoot]) -> [f64; 2] {
    let (first, last) = (values[0], values[values.len() - 1]);
    let (mut low, mut high) = (first.min(last), first.max(last));
    for turn in turns {
        // Around the turn: where rounding hides the derivative, the hull of that piece holds the extremum.
        let (from, to) = (turn.low.next_down().max(0.0), turn.high.next_up().min(1.0));
        let mut piece = values.to_vec();
        restrict(&mut piece, from, to);
        let at = eval_bounded(values, turn.t);
        let (least, most) = piece.iter().fold((at.value, at.value), |(l, m), &x| (l.min(x), m.max(x)));
        low = low.min((least - at.error).next_down());
        high = high.max((most + at.error).next_up());
    }
    // Never more than the hull of the control points.
    let (hull_low, hull_high) = values.iter().fold((first, first), |(l, h), &x| (l.min(x), h.max(x)));
    [low.max(hull_low), high.min(hull_high)]
}

/// The convex hull of points of the plane, counter-clockwise from the lowest of the leftmost, without points that lie
/// on a side; exact signs decide (Andrew 1979). One point for equal points, two for points on a line.
///
/// A curve lies within the hull of its control points.
pub fn convex_hull(points: &[Vec2]) -> Vec<Vec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let chain = |points: &mut dyn Iterator<Item = Vec2>| {
        let mut chain: Vec<Vec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                if orient2d(a, b, point) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut sorted.iter().copied());
    hull.extend(chain(&mut sorted.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{AnyBezier, Cubic};
    use proptest::prelude::*;

    #[test]
    fn known_boxes() {
        let curve =
            Cubic::new([(0.0, 10.0), (-10.0, 10.0), (180.0, 10.0), (60.0, 10.0)].map(Vec2::from)).unwrap();
        let Bounds { min, max } = bounding_box(&curve);
        assert!((min.x - -0.383376013856379).abs() < 1e-14 && (max.x - 99.8835682476126).abs() < 1e-12);
        assert_eq!((min.y, max.y), (10.0, 10.0));
        let arch = Cubic::new([0.0, 1.0, 1.0, 0.0]).unwrap();
        let Bounds { min, max } = bounding_box(&arch);
        assert!(min == 0.0 && (0.75..0.75 + 1e-15).contains(&max));
        let huge = arch.map(|x| x * 1.7e308).unwrap();
        let Bounds { min, max } = bounding_box(&huge);
        assert!(min == 0.0 && (max / 1.7e308 - 0.75).abs() < 1e-15);
    }

    #[test]
    fn hulls_have_no_needless_points() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.5), (0.5, 0.0)].map(Vec2::from);
        assert_eq!(convex_hull(&square), [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(Vec2::from));
        assert_eq!(convex_hull(&[Vec2::X; 4]), [Vec2::X]);
        assert_eq!(
            convex_hull(&[Vec2::ZERO, Vec2::X, Vec2::splat(0.0), Vec2::X * 0.5]),
            [Vec2::ZERO, Vec2::X]
        );
    }

    proptest! {
        #[test]
        fn boxes_hold_and_touch(points in prop::collection::vec(-1.0..1.0_f64, 1..9)) {
            let curve = AnyBezier::new(points).unwrap();
            let Bounds { min, max } = bounding_box(&curve);
            let values = (0..=2000).map(|k| curve.eval(f64::from(k) / 2000.0));
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
            prop_assert!(min <= low + 1e-16 && high - 1e-16 <= max);
            prop_assert!(low - min < 1e-4 && max - high < 1e-4);
        }
    }
}
