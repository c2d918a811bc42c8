//! The vertices of edges, each from its curve alone.

use super::layout::{Curve, EdgeUse, Layout};
use super::{Guarantee, SurfaceOptions, TessellationError};
use crate::math::Vec3;
use std::collections::BTreeMap;

/// Share of the tolerance that edges may use; what bends across them needs the rest.
pub(super) const SHARE: f64 = 0.5;
/// Intervals of an edge on which its bending is bounded.
const INTERVALS: usize = 16;

/// The vertices of all edges.
pub(super) struct Edges {
    /// Corners first, then the inner vertices of edges.
    pub(super) positions: Vec<Vec3>,
    /// For each edge the parameters of its inner vertices, ascending.
    parameters: Vec<Vec<f64>>,
    /// For each edge the number of its first inner vertex.
    first: Vec<u32>,
}

impl Edges {
    /// Vertices of a side with their parameters on it, from its own start on, ends included; the end of a pole once.
    pub(super) fn side(&self, layout: &Layout<'_>, side: EdgeUse, range: [f64; 2]) -> Vec<(u32, f64)> {
        let edge = &layout.edges[side.edge];
        let [low, high] = edge.curve.range;
        let first = self.first[side.edge];
        let inner = self.parameters[side.edge].iter().zip(first..);
        let mut all = vec![(edge.ends[0], range[0])];
        if edge.pole {
            return all;
        }
        // The range of a side is that of its edge but for another side that is the same curve.
        let own = |t: f64| {
            let share = (t - low) / (high - low);
            if [low, high] == range { t } else { range[0] + share * (range[1] - range[0]) }
        };
        all.extend(inner.map(|(&t, id)| (id, own(t))));
        all.push((edge.ends[1], range[1]));
        if side.reversed {
            all.reverse();
            all.iter_mut().for_each(|(_, t)| *t = range[0] + (range[1] - *t));
        }
        all
    }
}

/// Chooses and computes the vertices of every edge, at least `least` segments on each.
pub(super) fn sample_all(
    layout: &Layout<'_>,
    options: &SurfaceOptions,
    least: usize,
) -> Result<Edges, TessellationError> {
    let least_of = least_segments(layout, least);
    let indices: Vec<usize> = (0..layout.edges.len()).collect();
    let sampled = crate::par::map_above(64, &indices, |&index| {
        let edge = &layout.edges[index];
        if edge.pole { Ok(Vec::new()) } else { sample(&edge.curve, options, least_of[index]) }
    });
    let mut edges = Edges { positions: layout.corners.clone(), parameters: Vec::new(), first: Vec::new() };
    for (edge, parameters) in layout.edges.iter().zip(sampled) {
        let parameters = parameters?;
        edges.first.push(edges.positions.len() as u32);
        edges.positions.extend(parameters.iter().map(|&t| edge.curve.point(t)));
        edges.parameters.push(parameters);
    }
    Ok(edges)
}

/// A loop needs three segments, and edges between the same corners two each, to be told apart.
fn least_segments(layout: &Layout<'_>, least: usize) -> Vec<usize> {
    let mut between: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    let key = |ends: [u32; 2]| [ends[0].min(ends[1]), ends[0].max(ends[1])];
    for edge in layout.edges.iter().filter(|edge| !edge.pole) {
        *between.entry(key(edge.ends)).or_default() += 1;
    }
    let of = |ends: [u32; 2]| match between.get(&key(ends)) {
        _ if ends[0] == ends[1] => 3,
        Some(&count) if count > 1 => 2,
        _ => 1,
    };
    layout.edges.iter().map(|edge| of(edge.ends).max(least)).collect()
}

/// How an interval of a curve bends.
struct Interval {
    range: [f64; 2],
    /// Second derivative over tolerance.
    bend: f64,
    /// Whether that is a bound.
    proven: bool,
    /// Segments that an interval of length 1 needs.
    density: f64,
    tolerance: f64,
}

impl Interval {
    fn width(&self) -> f64 {
        self.range[1] - self.range[0]
    }
}

fn sample(curve: &Curve<'_>, options: &SurfaceOptions, least: usize) -> Result<Vec<f64>, TessellationError> {
    /// What segments are multiplied by when some fail.
    const MORE: f64 = 1.0625;
    let [low, high] = curve.range;
    let at = |k: usize| {
        if k == INTERVALS { high } else { low + (high - low) * k as f64 / INTERVALS as f64 }
    };
    let mut intervals: Vec<Interval> =
        (0..INTERVALS).map(|k| interval(curve, options, [at(k), at(k + 1)])).collect();
    let (mut factor, mut count) = (1.0, least);
    loop {
        let total: f64 = intervals.iter().map(|interval| interval.density * interval.width()).sum();
        let wanted = (factor * total - 1e-9).ceil().max(count as f64);
        let most = options.max_triangles;
        if wanted > most as f64 || wanted.is_nan() {
            let triangles = if wanted.is_finite() { wanted as u64 } else { u64::MAX };
            return Err(TessellationError::TooLarge { triangles, most });
        }
        count = wanted as usize;
        let parameters = spread(curve, &intervals, total, count);
        let failing = failing(curve, options, &intervals, &parameters);
        if failing.is_empty() {
            return Ok(parameters);
        }
        intervals = split(curve, options, intervals, &failing);
        (factor, count) = (factor * MORE, count + 1);
    }
}

/// Halves the intervals with these indices, which ascend, as long as they are not tiny.
fn split(
    curve: &Curve<'_>,
    options: &SurfaceOptions,
    intervals: Vec<Interval>,
    failing: &[usize],
) -> Vec<Interval> {
    /// Over the range of the curve.
    const TINY: f64 = 1e-7;
    let least = TINY * (curve.range[1] - curve.range[0]);
    let mut halves = Vec::with_capacity(intervals.len() + failing.len());
    for (index, whole) in intervals.into_iter().enumerate() {
        if failing.binary_search(&index).is_ok() && whole.width() > least {
            let [low, high] = whole.range;
            let middle = 0.5 * low + 0.5 * high;
            halves.extend([[low, middle], [middle, high]].map(|range| interval(curve, options, range)));
        } else {
            halves.push(whole);
        }
    }
    halves
}

fn interval(curve: &Curve<'_>, options: &SurfaceOptions, range: [f64; 2]) -> Interval {
    let middle = 0.5 * range[0] + 0.5 * range[1];
    let places = [range[0], middle, range[1]];
    let tolerance =
        places.iter().map(|&t| options.precision.at(curve.point(t))).fold(f64::INFINITY, f64::min);
    // At a cusp or a root there may be none.
    let mut derivatives: Vec<[Vec3; 2]> = places.iter().map(|&t| curve.derivatives(t)).collect();
    derivatives.retain(|both| both.iter().all(|derivative| derivative.is_finite()));
    let proven = match options.guarantee {
        Guarantee::Proven => curve.second_bound(range),
        Guarantee::Measured => None,
    };
    // What bends along the curve only is no error.
    let across = |[first, second]: [Vec3; 2]| {
        let along = first.normalize_or_zero();
        (second - second.dot(along) * along).length()
    };
    let measured = || derivatives.iter().map(|&both| across(both)).fold(0.0, f64::max);
    let bend = proven.unwrap_or_else(measured) / tolerance;
    let turn = |both: [Vec3; 2]| {
        let speed = both[0].length();
        if speed > 0.0 { across(both) / speed } else { 0.0 }
    };
    let turning = derivatives.iter().map(|&both| turn(both)).fold(0.0, f64::max);
    let density = (bend / (8.0 * SHARE)).sqrt().max(options.angle.map_or(0.0, |angle| turning / angle));
    Interval { range, bend, proven: proven.is_some(), density, tolerance }
}

/// Parameters of the inner vertices of so many segments, each of which needs about as much as the others.
fn spread(curve: &Curve<'_>, intervals: &[Interval], total: f64, count: usize) -> Vec<f64> {
    let [low, high] = curve.range;
    // A little everywhere, so that straight parts between bends are divided by length.
    let floor = (total / (high - low)).max(1.0 / (high - low)) * 0.05;
    let weight = |interval: &Interval| interval.density.max(floor) * interval.width();
    let sum: f64 = intervals.iter().map(weight).sum();
    let mut parameters = Vec::with_capacity(count.saturating_sub(1));
    let (mut before, mut k) = (0.0, 0);
    for step in 1..count {
        let wanted = sum * step as f64 / count as f64;
        while k + 1 < intervals.len() && before + weight(&intervals[k]) < wanted {
            before += weight(&intervals[k]);
            k += 1;
        }
        let share = ((wanted - before) / weight(&intervals[k])).clamp(0.0, 1.0);
        parameters.push((intervals[k].range[0] + intervals[k].width() * share).clamp(low, high));
    }
    parameters.dedup();
    parameters
}

/// The intervals that segments meet which do not keep their share of the tolerance.
fn failing(
    curve: &Curve<'_>,
    options: &SurfaceOptions,
    intervals: &[Interval],
    parameters: &[f64],
) -> Vec<usize> {
    let [low, high] = curve.range;
    let bounds: Vec<f64> = std::iter::once(low).chain(parameters.iter().copied()).chain([high]).collect();
    let index = |t: f64| intervals.partition_point(|i| i.range[1] <= t).min(intervals.len() - 1);
    let mut all = Vec::new();
    for pair in bounds.windows(2) {
        let [first, last] = [pair[0], pair[1]].map(index);
        if !holds(curve, options, &intervals[first..=last], [pair[0], pair[1]]) {
            all.extend(first..=last);
        }
    }
    all.dedup();
    all
}

/// Whether a segment keeps its share of the tolerance.
fn holds(curve: &Curve<'_>, options: &SurfaceOptions, met: &[Interval], [a, b]: [f64; 2]) -> bool {
    let tolerance = met.iter().map(|interval| interval.tolerance).fold(f64::INFINITY, f64::min);
    let square = (b - a) * (b - a) / 8.0;
    if met.iter().all(|interval| interval.proven && interval.bend * square <= SHARE) {
        return true;
    }
    match options.guarantee {
        Guarantee::Proven if let Some(bound) = curve.second_bound([a, b]) => {
            bound * square <= SHARE * tolerance
        }
        _ => deviation(curve, a, b) <= SHARE * tolerance,
    }
}

/// The largest distance of three points of the curve from a chord.
fn deviation(curve: &Curve<'_>, a: f64, b: f64) -> f64 {
    let (from, to) = (curve.point(a), curve.point(b));
    let chord = to - from;
    let distance = |share: f64| {
        let off = curve.point(a + share * (b - a)) - from;
        let along = (off.dot(chord) / chord.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (off - along * chord).length()
    };
    [0.25, 0.5, 0.75].map(distance).into_iter().fold(0.0, f64::max)
}
