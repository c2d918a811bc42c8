//! Schneider's fit: least squares between joints that are points.

use super::Section;
use crate::curve::fit::Proxy;
use crate::curve::fit::deviation::point_and_velocity;
use crate::curve::frame::ROUNDING;
use crate::math::Vec2;

/// Rounds of new parameters before a part is cut.
const ROUNDS: usize = 4;
/// Arms shorter than this share of the chord are no arms.
const SHORTEST: f64 = 1e-6;

/// A part of a section, with unit tangents that lead along the path at both ends.
struct Part {
    from: usize,
    to: usize,
    tangents: [Vec2; 2],
}

/// Cubics past the points of a section.
pub(super) fn follow(section: &Section, limit: f64) -> Vec<Proxy> {
    let points = &section.points;
    let last = points.len() - 1;
    let ends = if section.wraps {
        [direction(points[last - 1], points[1], points[0], points[1]); 2]
    } else {
        [(points[1] - points[0]).normalize(), (points[last] - points[last - 1]).normalize()]
    };
    let mut open = vec![Part { from: 0, to: last, tangents: ends }];
    let mut fitted = Vec::new();
    while let Some(part) = open.pop() {
        match fit(&points[part.from..=part.to], part.tangents, limit) {
            Ok(proxy) => fitted.push(proxy),
            Err(farthest) => {
                let eighth = (part.to - part.from) / 8;
                let (low, high) = (part.from + 1 + eighth, part.to - 1 - eighth);
                let cut = (part.from + farthest).clamp(low, high);
                let tangent = direction(points[cut - 1], points[cut + 1], points[cut], points[cut + 1]);
                open.push(Part { from: cut, to: part.to, tangents: [tangent, part.tangents[1]] });
                open.push(Part { from: part.from, to: cut, tangents: [part.tangents[0], tangent] });
            }
        }
    }
    fitted
}

/// The direction from `a` to `b`; from `c` to `d`, which differ, where those are one.
fn direction(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> Vec2 {
    (b - a).try_normalize().unwrap_or_else(|| (d - c).normalize())
}

/// One cubic that is near enough to the points, or the index of the farthest.
fn fit(points: &[Vec2], tangents: [Vec2; 2], limit: f64) -> Result<Proxy, usize> {
    let last = points.len() - 1;
    let (start, end) = (points[0], points[last]);
    if last == 1 {
        return Ok(Proxy { points: with_arms(start, end, tangents, even(start, end)), error: ROUNDING });
    }
    let mut parameters = by_length(points);
    let mut farthest = 1;
    for _ in 0..=ROUNDS {
        let cubic = least_squares(points, &parameters, tangents);
        let off = |k: usize| point_and_velocity(&cubic, parameters[k]).0.distance(points[k]);
        let error;
        (farthest, error) =
            (1..last).map(|k| (k, off(k))).fold((1, 0.0), |a, b| if b.1 > a.1 { b } else { a });
        if error + ROUNDING <= limit {
            return Ok(Proxy { points: cubic, error: error + ROUNDING });
        }
        // Hopeless cases are not tried again.
        if error > 4.0 * limit.max(limit.sqrt() * start.distance(end)) {
            break;
        }
        for (t, &point) in parameters.iter_mut().zip(points) {
            *t = nearer(&cubic, point, *t);
        }
    }
    Err(farthest)
}

/// Shares of the length of the polyline.
fn by_length(points: &[Vec2]) -> Vec<f64> {
    let mut lengths = vec![0.0];
    for pair in points.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = lengths[lengths.len() - 1];
    lengths.iter().map(|length| length / total).collect()
}

fn with_arms(start: Vec2, end: Vec2, [leaving, arriving]: [Vec2; 2], [p, q]: [f64; 2]) -> [Vec2; 4] {
    [start, start + leaving * p, end - arriving * q, end]
}

fn even(start: Vec2, end: Vec2) -> [f64; 2] {
    [start.distance(end) / 3.0; 2]
}

/// The cubic with these end tangents whose points at the parameters have the least sum of squared distances; with even
/// arms where an arm would be of no length.
fn least_squares(points: &[Vec2], parameters: &[f64], tangents: [Vec2; 2]) -> [Vec2; 4] {
    let (start, end) = (points[0], points[points.len() - 1]);
    let (mut pp, mut pq, mut qq, mut p, mut q) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (&point, &t) in points.iter().zip(parameters) {
        let s = 1.0 - t;
        let (first, second) = (tangents[0] * (3.0 * s * s * t), tangents[1] * (-3.0 * s * t * t));
        let rest = point - start * (s * s * (s + 3.0 * t)) - end * (t * t * (t + 3.0 * s));
        pp += first.dot(first);
        pq += first.dot(second);
        qq += second.dot(second);
        p += first.dot(rest);
        q += second.dot(rest);
    }
    let determinant = pp * qq - pq * pq;
    let arms = [(p * qq - q * pq) / determinant, (pp * q - pq * p) / determinant];
    let least = SHORTEST * start.distance(end);
    let is_sane = arms.iter().all(|&arm| arm > least && arm.is_finite());
    with_arms(start, end, tangents, if is_sane { arms } else { even(start, end) })
}

/// One of Newton's steps towards the foot of the normal from a point.
fn nearer(cubic: &[Vec2; 4], point: Vec2, t: f64) -> f64 {
    let (at, velocity) = point_and_velocity(cubic, t);
    let [a, b, c, d] = *cubic;
    let acceleration = ((a - b * 2.0 + c) * (1.0 - t) + (b - c * 2.0 + d) * t) * 6.0;
    let slope = velocity.length_squared() + (at - point).dot(acceleration);
    let next = t - (at - point).dot(velocity) / slope;
    if next.is_finite() { next.clamp(0.0, 1.0) } else { t }
}
