//! Near misses: where curves come nearer than a tolerance without meeting.

use super::part::{Part, Store};
use super::scene::Scene;
use super::touch::{groups, opposite};
use super::{Contact, Meeting};
use crate::curve::differential::jet;
use crate::curve::{AnyBezier, nearest_all};
use crate::math::Vec2;

/// Pairs of parts beyond which places are no longer told apart by cutting.
const MAX_PAIRS: usize = 1024;
/// The width at which the search for places ends: what is nearer together is one place.
const NARROW: f64 = 1.0 / 256.0;

/// Local minima of the distance of at most `gap`, in the scene's units, that are no meetings.
pub(super) fn misses<S: Store>(scene: &Scene<S>, gap: f64, meetings: &[Meeting]) -> Vec<Meeting> {
    let mut candidates = facing_ends(scene, gap);
    for group in groups(&parallel_places(scene, gap)) {
        candidates.push(opposite(scene, group));
    }
    let mut near: Vec<(f64, Meeting)> = Vec::new();
    for (s, t) in candidates {
        let distance = (scene.a.at(s).0 - scene.b.at(t).0).length();
        // What cannot be told from a meeting is one, and has been found.
        let is_meeting = distance <= 2.0 * scene.rounding || meetings.iter().any(|m| m.covers(s, t));
        if distance > gap || is_meeting || !is_minimum(scene, s, t) {
            continue;
        }
        let same = |other: &(f64, Meeting)| {
            (other.1.first[0] - s).abs() <= NARROW && (other.1.second[0] - t).abs() <= NARROW
        };
        let miss = Meeting {
            first: [s; 2],
            second: [t; 2],
            point: Vec2::ZERO,
            contact: Contact::NearMiss { distance: scene.outward(distance) },
        };
        match near.iter_mut().find(|other| same(other)) {
            Some(known) if known.0 <= distance => {}
            Some(known) => *known = (distance, miss),
            None => near.push((distance, miss)),
        }
    }
    near.into_iter().map(|(_, miss)| miss).collect()
}

/// Ends of one curve and the places of the other that are nearest to them, within `gap`, ascending.
pub(super) fn facing_ends<S: Store>(scene: &Scene<S>, gap: f64) -> Vec<(f64, f64)> {
    let curves = [&scene.a, &scene.b].map(|points| AnyBezier::assume(points.as_ref().to_vec()));
    let mut pairs = Vec::new();
    for (own, other) in [(0, 1), (1, 0)] {
        for end in [0.0, 1.0] {
            let point = crate::curve::Bernstein::eval(&curves[own], end);
            for place in nearest_all(&curves[other], point).unwrap_or_default() {
                if place.distance.value <= gap {
                    pairs.push(if own == 0 { (end, place.t) } else { (place.t, end) });
                }
            }
        }
    }
    pairs.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.total_cmp(&q.1)));
    pairs
}

/// Pairs of narrow parts that may be opposite one another with parallel tangents.
fn parallel_places<S: Store>(scene: &Scene<S>, gap: f64) -> Vec<[f64; 4]> {
    let [a, b] = scene.parts();
    let mut pairs = vec![(a, b)];
    loop {
        pairs.retain(|(a, b)| may_be_opposite(a, b, gap));
        let done = |(a, b): &(Part<S>, Part<S>)| a.width() <= NARROW && b.width() <= NARROW;
        if pairs.len() > MAX_PAIRS || pairs.iter().all(done) {
            return pairs.iter().map(|(a, b)| [a.low, a.high, b.low, b.high]).collect();
        }
        pairs = pairs.iter().flat_map(|(a, b)| cut(a, b)).collect();
    }
}

fn cut<S: Store>(a: &Part<S>, b: &Part<S>) -> Vec<(Part<S>, Part<S>)> {
    if a.width() >= b.width() {
        a.halves().into_iter().map(|half| (half, b.clone())).collect()
    } else {
        b.halves().into_iter().map(|half| (a.clone(), half)).collect()
    }
}

fn may_be_opposite<S: Store>(a: &Part<S>, b: &Part<S>, gap: f64) -> bool {
    if a.box_misses(b, gap) || a.clipped(b, gap).is_none() || b.clipped(a, gap).is_none() || a.turns_apart(b)
    {
        return false;
    }
    // The connection is at a right angle to the tangents somewhere only if its products with steps change sign.
    let (p, q) = (a.points.as_ref(), b.points.as_ref());
    let margin = 8.0 * (a.error + b.error);
    let changes = |steps: &[Vec2]| {
        let products = steps.windows(2).flat_map(|pair| {
            let step = pair[1] - pair[0];
            p.iter().flat_map(move |&p| q.iter().map(move |&q| (p - q).dot(step)))
        });
        let (low, high) = products.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        low <= margin && high >= -margin
    };
    changes(p) && changes(q)
}

/// Whether the distance does not shrink from here: towards the inside from ends, by its second derivative elsewhere.
fn is_minimum<S: Store>(scene: &Scene<S>, s: f64, t: f64) -> bool {
    let (a, b) = (jet(scene.a.as_ref(), s), jet(scene.b.as_ref(), t));
    let gap = a.point - b.point;
    let rises = |x: f64, slope: f64| (x > 0.0 || slope >= 0.0) && (x < 1.0 || slope <= 0.0);
    if !rises(s, gap.dot(a.first)) || !rises(t, -gap.dot(b.first)) {
        return false;
    }
    let (along_a, along_b) =
        (a.first.length_squared() + gap.dot(a.second), b.first.length_squared() - gap.dot(b.second));
    let inner = |x: f64| x > 0.0 && x < 1.0;
    if !(inner(s) && inner(t)) {
        return true;
    }
    // Parallel lines have a determinant of zero, but for rounding.
    let mixed = a.first.dot(b.first);
    along_a * along_b - mixed * mixed >= -16.0 * scene.rounding * mixed.abs()
}
