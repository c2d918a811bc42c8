//! Places that rounding leaves open on curves of degrees too high for elimination.

use super::part::Store;
use super::scene::Scene;
use super::search::{Open, Search};
use super::{Contact, Meeting, together};
use crate::curve::CurveError;
use crate::math::Vec2;

/// Open pairs beyond which curves are called too close: a touch has a few dozen.
const MAX_OPEN: usize = 2_000;

/// The overlaps and the meetings of a search, its open places classified as far as rounding can tell.
pub(super) fn classified<S: Store>(
    scene: &Scene<S>,
    search: Search<'_, S>,
    overlaps: Vec<Meeting>,
) -> Result<Vec<Meeting>, CurveError> {
    if search.open.len() > MAX_OPEN || search.budget_is_spent() {
        return if overlaps.is_empty() { Err(CurveError::TooClose) } else { Ok(overlaps) };
    }
    let mut found: Vec<Meeting> = search.crossings.into_iter().map(Meeting::from).collect();
    for group in groups(&search.open) {
        let (s, t) = opposite(scene, group);
        let off = (scene.a.at(s).0 - scene.b.at(t).0).length();
        let near = |m: &Meeting| {
            (group[0]..=group[1]).contains(&m.first[0]) && (group[2]..=group[3]).contains(&m.second[0])
        };
        if off <= 4.0 * scene.rounding && !found.iter().any(near) {
            let contact = contact(scene, (s, t), group);
            found.push(Meeting::at(s, t, contact));
        }
    }
    Ok(together::merged(overlaps, found))
}

/// Open pairs that touch one another made one.
pub(super) fn groups(open: &[Open]) -> Vec<Open> {
    let mut groups: Vec<Open> = Vec::new();
    let mut pairs = open.to_vec();
    pairs.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[2].total_cmp(&q[2])));
    for mut pair in pairs {
        // A pair may join groups that were apart before.
        loop {
            let slack = (pair[1] - pair[0]).max(pair[3] - pair[2]);
            let touches = |g: &Open| {
                pair[0] <= g[1] + slack
                    && g[0] <= pair[1] + slack
                    && pair[2] <= g[3] + slack
                    && g[2] <= pair[3] + slack
            };
            let Some(place) = groups.iter().position(touches) else { break };
            let g = groups.swap_remove(place);
            pair = [g[0].min(pair[0]), g[1].max(pair[1]), g[2].min(pair[2]), g[3].max(pair[3])];
        }
        groups.push(pair);
    }
    groups.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[2].total_cmp(&q[2])));
    groups
}

/// Where tangents are parallel and the connection is at right angles to them, near a group, by Newton's iteration kept
/// within the group's surroundings and [0, 1].
pub(super) fn opposite<S: Store>(scene: &Scene<S>, [a_low, a_high, b_low, b_high]: Open) -> (f64, f64) {
    let (s0, t0) = (0.5 * (a_low + a_high), 0.5 * (b_low + b_high));
    let (mut s, mut t) = (s0, t0);
    let reach = 2.0 * (a_high - a_low).max(b_high - b_low);
    let clamped = |x: f64, middle: f64| x.clamp((middle - reach).max(0.0), (middle + reach).min(1.0));
    for _ in 0..30 {
        let ((p, v), (q, w)) = (scene.a.at(s), scene.b.at(t));
        let (second_a, second_b) = (second(&scene.a, s), second(&scene.b, t));
        let gap = p - q;
        // f = P' x Q', g = (P - Q) . P' and their derivatives.
        let (f, g) = (v.perp_dot(w), gap.dot(v));
        let (fs, ft) = (second_a.perp_dot(w), v.perp_dot(second_b));
        let (gs, gt) = (v.length_squared() + gap.dot(second_a), -w.dot(v));
        let determinant = fs * gt - ft * gs;
        let (ds, dt) = ((f * gt - g * ft) / determinant, (fs * g - gs * f) / determinant);
        if !(ds.is_finite() && dt.is_finite()) {
            break;
        }
        (s, t) = (clamped(s - ds, s0), clamped(t - dt, t0));
        if ds.abs().max(dt.abs()) < f64::EPSILON {
            break;
        }
    }
    (s, t)
}

/// The second derivative.
fn second<S: Store>(points: &S, t: f64) -> Vec2 {
    crate::curve::differential::jet(points.as_ref(), t).second
}

/// Whether the curves change sides, from their heights a little before and after.
fn contact<S: Store>(scene: &Scene<S>, (s, t): (f64, f64), group: Open) -> Contact {
    if s <= 0.0 || s >= 1.0 || t <= 0.0 || t >= 1.0 {
        return Contact::Tangency { multiplicity: 2 };
    }
    let ((_, v), (_, w)) = (scene.a.at(s), scene.b.at(t));
    let ratio = v.dot(w) / w.length_squared();
    let side = |step: f64| {
        let a = scene.a.at(s + step).0;
        // The point of the other curve at the same place along the tangent.
        let mut along = t + step * ratio;
        for _ in 0..8 {
            let (q, w) = scene.b.at(along);
            along += (a - q).dot(v) / w.dot(v);
        }
        v.perp_dot(a - scene.b.at(along).0)
    };
    // Outward until both heights are more than rounding; a touch of order k is that high at the k-th root of it.
    let sure = 8.0 * scene.rounding * v.length();
    let mut reach = 2.0 * (group[1] - group[0]);
    while reach < 0.25 && (side(-reach).abs() <= sure || side(reach).abs() <= sure) {
        reach *= 2.0;
    }
    let crosses = (side(-reach) > 0.0) != (side(reach) > 0.0);
    Contact::Tangency { multiplicity: if crosses { 3 } else { 2 } }
}
