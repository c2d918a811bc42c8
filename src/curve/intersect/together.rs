//! Curves that run together as far as their control points can tell.
//!
//! The parts that a curve is cut into have rounded control points, so that they are, strictly, parts of different curves
//! which cross here and there in the last digits. Wherever two curves run between ends of either no farther apart than
//! what cutting rounds ([`Scene::grain`]), that is one overlap and no crossings. Parts of one polynomial curve are linear
//! in one another's parameters, so control points of the same degree over the same interval tell; on a straight line
//! parameters may differ in any way, and one coordinate tells.

use super::exact::IntegerCurve;
use super::part::{Part, Store};
use super::scene::Scene;
use super::{Contact, Meeting, near, overlap};
use crate::curve::{AnyBezier, Bernstein, nearest_all};
use crate::math::Vec2;

/// What is shorter than so many grains is a point.
const POINT: f64 = 8.0;
/// Steps of Gauss and Newton; the second one corrects the first by what curvature left.
const STEPS: usize = 4;
/// Parameters of one place differ by less, even at a cusp, where rounding moves them by its cube root.
const SAME_PLACE: f64 = 1.0 / 8192.0;

/// The parameters at which parts begin and end, on both curves.
type Ends = [(f64, f64); 2];

/// Overlaps, and those other meetings that are not in them.
pub(super) fn merged(mut overlaps: Vec<Meeting>, mut others: Vec<Meeting>) -> Vec<Meeting> {
    others.retain(|m| !overlaps.iter().any(|overlap| is_within(m, overlap)));
    overlaps.append(&mut others);
    overlaps
}

/// Whether a meeting is one of the places that an overlap pairs.
fn is_within(m: &Meeting, overlap: &Meeting) -> bool {
    let share = (m.first[0] - overlap.first[0]) / (overlap.first[1] - overlap.first[0]);
    let t = overlap.second[0] + share * (overlap.second[1] - overlap.second[0]);
    let slack = SAME_PLACE / (overlap.first[1] - overlap.first[0]);
    -slack <= share && share <= 1.0 + slack && (m.second[0] - t).abs() <= SAME_PLACE
}

/// The overlaps of two curves that are not straight, longest first.
pub(super) fn overlaps<S: Store>(scene: &Scene<S>) -> Vec<Meeting> {
    let places = near::facing_ends(scene, scene.grain + scene.rounding);
    let mut candidates: Vec<Ends> = Vec::new();
    for (i, &from) in places.iter().enumerate() {
        candidates.extend(
            places[i + 1..].iter().filter(|to| to.0 > from.0 && to.1 != from.1).map(|&to| [from, to]),
        );
    }
    candidates.sort_by(|p, q| (q[1].0 - q[0].0).total_cmp(&(p[1].0 - p[0].0)));
    let mut found: Vec<Meeting> = Vec::new();
    for ends in candidates {
        if found.iter().any(|m| ends.iter().all(|&(s, t)| m.covers(s, t))) {
            continue;
        }
        if let Some([from, to]) = matched(scene, ends) {
            found.push(overlap_between([from.0, to.0], [from.1, to.1]));
        }
    }
    found
}

fn overlap_between(first: [f64; 2], second: [f64; 2]) -> Meeting {
    Meeting { first, second, point: Vec2::ZERO, contact: Contact::Overlap }
}

/// The ends of parts that are one within the grain, near those given; `None` where the parts differ or are points.
///
/// At each end one of the curves ends, and the place on the other is moved until the control points agree best: found
/// by projection alone it would be far off where the curve is slow.
fn matched<S: Store>(scene: &Scene<S>, mut ends: Ends) -> Option<Ends> {
    let degree = scene.a.as_ref().len().max(scene.b.as_ref().len()) - 1;
    for _ in 0..STEPS {
        let [from, to] = ends;
        let a = control_between(&scene.a, from.0, to.0, degree);
        let b = control_between(&scene.b, from.1, to.1, degree);
        if extent(&a) <= POINT * scene.grain {
            return None;
        }
        let off: Vec<Vec2> = a.iter().zip(&b).map(|(&p, &q)| p - q).collect();
        if off.iter().all(|d| d.abs().max_element() <= scene.grain) {
            return Some(ends);
        }
        let (slopes_a, slopes_b) = (by_ends(&a, to.0 - from.0), by_ends(&b, to.1 - from.1));
        let moves = [0, 1].map(|k| match ends[k] {
            (s, _) if !is_end(s) => Some((0, &slopes_a[k], 1.0)),
            (_, t) if !is_end(t) => Some((1, &slopes_b[k], -1.0)),
            _ => None,
        });
        let steps = least_squares(&off, moves.map(|m| m.map(|(_, slope, sign)| (slope, sign))));
        for k in 0..2 {
            let place = match moves[k] {
                Some((0, ..)) => &mut ends[k].0,
                Some(_) => &mut ends[k].1,
                None => continue,
            };
            *place = (*place + steps[k]).clamp(0.0, 1.0);
        }
        if !(ends[1].0 > ends[0].0 && ends[1].1 != ends[0].1) {
            return None;
        }
    }
    None
}

fn is_end(x: f64) -> bool {
    x == 0.0 || x == 1.0
}

fn extent(points: &[Vec2]) -> f64 {
    points.iter().map(|&p| (p - points[0]).abs().max_element()).fold(0.0, f64::max)
}

/// The control points of the part from one parameter to another, which may be the smaller one, at a degree.
fn control_between<S: Store>(points: &S, from: f64, to: f64, degree: usize) -> Vec<Vec2> {
    let mut part = Part::whole(points.clone()).cut(from.min(to), from.max(to)).points.as_ref().to_vec();
    if from > to {
        part.reverse();
    }
    let missing = degree + 1 - part.len();
    AnyBezier::assume(part).elevated(missing).points().to_vec()
}

/// The derivatives of a part's control points by its first and by its last parameter: the blossom is linear in each.
fn by_ends(points: &[Vec2], width: f64) -> [Vec<Vec2>; 2] {
    let n = points.len() - 1;
    let step = |i: usize, share: usize| {
        if share == 0 { Vec2::ZERO } else { (points[i + 1] - points[i]) * (share as f64 / width) }
    };
    let by_first = (0..=n).map(|i| step(i.min(n.saturating_sub(1)), n - i)).collect();
    let by_last = (0..=n).map(|i| step(i.saturating_sub(1), i)).collect();
    [by_first, by_last]
}

/// The moves of two ends that bring differences nearest to zero, in sum of squares; 0 for ends that do not move.
fn least_squares(off: &[Vec2], moves: [Option<(&Vec<Vec2>, f64)>; 2]) -> [f64; 2] {
    let product = |p: &[Vec2], q: &[Vec2]| p.iter().zip(q).map(|(p, q)| p.dot(*q)).sum::<f64>();
    match moves {
        [Some((u, p)), Some((v, q))] => {
            let (uu, uv, vv) = (product(u, u), product(u, v), product(v, v));
            let (ur, vr) = (product(u, off), product(v, off));
            let determinant = uu * vv - uv * uv;
            if determinant > 0.0 {
                [-p * (ur * vv - vr * uv) / determinant, -q * (vr * uu - ur * uv) / determinant]
            } else {
                [0.0; 2]
            }
        }
        _ => moves.map(|m| match m {
            Some((slope, sign)) if product(slope, slope) > 0.0 => {
                -sign * product(slope, off) / product(slope, slope)
            }
            _ => 0.0,
        }),
    }
}

/// Where a curve runs back over itself within the rounding of its control points, which it does about a turn: the parts
/// before and after it are one another's reverse. (A polynomial curve that does so otherwise has degree 6 at least.)
pub(super) fn own_overlap<S: Store>(scene: &Scene<S>) -> Option<Meeting> {
    let curve = AnyBezier::assume(scene.a.as_ref().to_vec());
    let gap = scene.grain + scene.rounding;
    let facing = |end: f64| {
        let places = nearest_all(&curve, curve.eval(end)).unwrap_or_default();
        places.into_iter().filter(move |place| place.distance.value <= gap).map(|place| place.t)
    };
    let from_start = facing(0.0).filter(|&t| t > SAME_PLACE).map(|t| (0.0, t));
    let from_end = facing(1.0).filter(|&t| t < 1.0 - SAME_PLACE).map(|t| (t, 1.0));
    let folded = from_start.chain(from_end).filter_map(|(from, to)| fold(scene, from, to));
    let widest = folded.max_by(|p, q| (p.1 - p.0).total_cmp(&(q.1 - q.0)))?;
    let turn = 0.5 * (widest.0 + widest.1);
    Some(overlap_between([widest.0, turn], [widest.1, turn]))
}

/// The part that is its own reverse, near one given; the end that is none of the curve's is moved.
fn fold<S: Store>(scene: &Scene<S>, mut from: f64, mut to: f64) -> Option<(f64, f64)> {
    let degree = scene.a.as_ref().len() - 1;
    for _ in 0..STEPS {
        let part = control_between(&scene.a, from, to, degree);
        if extent(&part) <= POINT * scene.grain {
            return None;
        }
        let against =
            |row: &[Vec2]| row.iter().zip(row.iter().rev()).map(|(&p, &q)| p - q).collect::<Vec<_>>();
        let off = against(&part);
        if off.iter().all(|d| d.abs().max_element() <= scene.grain) {
            return Some((from, to));
        }
        let [by_first, by_last] = by_ends(&part, to - from);
        let slope = against(if is_end(from) { &by_last } else { &by_first });
        let [step, _] = least_squares(&off, [Some((&slope, 1.0)), None]);
        match (is_end(from), is_end(to)) {
            (true, false) => to = (to + step).clamp(from, 1.0),
            (false, _) => from = (from + step).clamp(0.0, to),
            (true, true) => return None,
        }
        if from >= to {
            return None;
        }
    }
    None
}

/// The meetings of curves on one straight line within the rounding of their control points, if they run together.
pub(super) fn on_line(scene: &Scene<impl Store>, a: &[Vec2], b: &[Vec2]) -> Option<Vec<Meeting>> {
    let axis = scene.common_axis(&[scene.a.as_ref(), scene.b.as_ref()])?;
    let [a, b] = IntegerCurve::of([&along(a, axis)[..], &along(b, axis)]);
    if a.degree() == 0 || b.degree() == 0 {
        return None;
    }
    let found = overlap::common(&a, &b);
    let found: Vec<Meeting> = found.into_iter().map(|m| short_as_point(scene, m)).collect();
    found.iter().any(|m| m.contact == Contact::Overlap).then_some(found)
}

/// The meetings with itself of a curve on a straight line within the rounding of its control points; `None` where it is
/// not on one.
pub(super) fn own_on_line(scene: &Scene<impl Store>, points: &[Vec2]) -> Option<Vec<Meeting>> {
    let axis = scene.common_axis(&[scene.a.as_ref()])?;
    let [curve] = IntegerCurve::of([&along(points, axis)[..]]);
    Some(if curve.degree() == 0 { Vec::new() } else { overlap::own(&curve) })
}

/// One coordinate; the line is walked in it as it is in the plane.
fn along(points: &[Vec2], axis: usize) -> Vec<Vec2> {
    points.iter().map(|p| Vec2::new(p[axis], 0.0)).collect()
}

/// An overlap that rounding made of a common point is one.
fn short_as_point<S: Store>(scene: &Scene<S>, m: Meeting) -> Meeting {
    let [from, to] = m.first.map(|s| scene.a.at(s).0);
    if m.contact == Contact::Overlap && (to - from).abs().max_element() <= POINT * scene.grain {
        let (s, t) = (m.first[0], m.second[0]);
        return Meeting::at(s, t, Contact::Tangency { multiplicity: 2 });
    }
    m
}
