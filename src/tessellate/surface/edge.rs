//! The vertices of edges, each from its curve alone.

use super::frame::FINEST;
use super::layout::{Curve, EdgeUse, Layout};
use super::{Care, Guarantee, SurfaceOptions, TessellationError};
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
    care: Care,
) -> Result<Edges, TessellationError> {
    let least_of = least_segments(layout, care.least);
    let indices: Vec<usize> = (0..layout.edges.len()).collect();
    let sampled = crate::par::map_above(64, &indices, |&index| {
        let edge = &layout.edges[index];
        if edge.pole {
            return Ok(Vec::new());
        }
        let asked = Asked { options, by_place: care.by_place, surface: &|| layout.surface_of(index) };
        sample(&edge.curve, &asked, least_of[index])
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

/// What an edge must keep to.
struct Asked<'a> {
    options: &'a SurfaceOptions,
    by_place: bool,
    /// Whose side it is.
    surface: &'a dyn Fn() -> usize,
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

fn sample(curve: &Curve<'_>, asked: &Asked<'_>, least: usize) -> Result<Vec<f64>, TessellationError> {
    /// What segments are multiplied by when some fail.
    const MORE: f64 = 1.0625;
    /// Times that all segments are laid out together; where they are four times as many as bends ask for, something else
    /// is the matter.
    const ROUNDS: usize = 24;
    let [low, high] = curve.range;
    let at = |k: usize| {
        if k == INTERVALS { high } else { low + (high - low) * k as f64 / INTERVALS as f64 }
    };
    let mut intervals: Vec<Interval> =
        (0..INTERVALS).map(|k| interval(curve, asked, [at(k), at(k + 1)])).collect();
    let (mut factor, mut count) = (1.0, least);
    for _ in 0..ROUNDS {
        let total: f64 = intervals.iter().map(|interval| interval.density * interval.width()).sum();
        let wanted = (factor * total - 1e-9).ceil().max(count as f64);
        let most = asked.options.max_triangles;
        if wanted > most as f64 || wanted.is_nan() {
            let triangles = if wanted.is_finite() { wanted as u64 } else { u64::MAX };
            return Err(TessellationError::TooLarge { triangles, most });
        }
        count = wanted as usize;
        let parameters = spread(curve, &intervals, total, count);
        let failing = failing(curve, asked, &intervals, &parameters);
        if failing.is_empty() {
            return Ok(parameters);
        }
        intervals = split(curve, asked, intervals, &failing);
        (factor, count) = (factor * MORE, count + 1);
    }
    let parts = least.max(INTERVALS);
    let end = |k: usize| if k == parts { high } else { low + (high - low) * k as f64 / parts as f64 };
    let mut parameters = Vec::new();
    for k in 0..parts {
        halved(curve, asked, &intervals, [end(k), end(k + 1)], &mut parameters)?;
    }
    parameters.pop();
    Ok(parameters)
}

/// Halves a segment until every part keeps its share, and adds the end of each: for cusps, where bends tell nothing.
fn halved(
    curve: &Curve<'_>,
    asked: &Asked<'_>,
    intervals: &[Interval],
    [a, b]: [f64; 2],
    parameters: &mut Vec<f64>,
) -> Result<(), TessellationError> {
    if segment_holds(curve, asked, intervals, [a, b]) {
        parameters.push(b);
        return Ok(());
    }
    let middle = 0.5 * a + 0.5 * b;
    if b - a <= FINEST * (curve.range[1] - curve.range[0]).max(middle.abs()) {
        return Err(TessellationError::NotReached {
            surface: (asked.surface)(),
            parameters: curve.parameters(middle),
        });
    }
    halved(curve, asked, intervals, [a, middle], parameters)?;
    halved(curve, asked, intervals, [middle, b], parameters)
}

/// Halves the intervals with these indices, which ascend, as long as they are not tiny.
fn split(curve: &Curve<'_>, asked: &Asked<'_>, intervals: Vec<Interval>, failing: &[usize]) -> Vec<Interval> {
    /// Over the range of the curve.
    const TINY: f64 = 1e-7;
    /// Bends are known well enough where there are so many intervals.
    const MANY: usize = 4096;
    let least = TINY * (curve.range[1] - curve.range[0]);
    if intervals.len() > MANY {
        return intervals;
    }
    let mut halves = Vec::with_capacity(intervals.len() + failing.len());
    for (index, whole) in intervals.into_iter().enumerate() {
        if failing.binary_search(&index).is_ok() && whole.width() > least {
            let [low, high] = whole.range;
            let middle = 0.5 * low + 0.5 * high;
            halves.extend([[low, middle], [middle, high]].map(|range| interval(curve, asked, range)));
        } else {
            halves.push(whole);
        }
    }
    halves
}

fn interval(curve: &Curve<'_>, asked: &Asked<'_>, range: [f64; 2]) -> Interval {
    let Asked { options, by_place, .. } = *asked;
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
    // What bends along the curve only is no error but from place to place.
    let across = |[first, second]: [Vec3; 2]| {
        let along = if by_place { Vec3::ZERO } else { first.normalize_or_zero() };
        (second - second.dot(along) * along).length()
    };
    let measured = || derivatives.iter().map(|&both| across(both)).fold(0.0, f64::max);
    let bend = proven.unwrap_or_else(measured) / tolerance;
    let turn = |both: [Vec3; 2]| {
        let speed = both[0].length();
        if speed > 0.0 { across(both) / speed } else { 0.0 }
    };
    let turning = derivatives.iter().map(|&both| turn(both)).fold(0.0, f64::max);
    let by_bend = (bend / (8.0 * SHARE)).sqrt();
    // What is no longer than the tolerance needs no more, however it bends; twice as many, since speeds were only sampled.
    let speed = derivatives.iter().map(|both| both[0].length()).fold(0.0, f64::max);
    let enough = if proven.is_some() { f64::INFINITY } else { speed / (SHARE * tolerance) };
    let density = by_bend.min(enough).max(options.angle.map_or(0.0, |angle| turning / angle));
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
fn failing(curve: &Curve<'_>, asked: &Asked<'_>, intervals: &[Interval], parameters: &[f64]) -> Vec<usize> {
    let [low, high] = curve.range;
    let bounds: Vec<f64> = std::iter::once(low).chain(parameters.iter().copied()).chain([high]).collect();
    let mut all = Vec::new();
    for pair in bounds.windows(2) {
        let pair = [pair[0], pair[1]];
        if !segment_holds(curve, asked, intervals, pair) {
            let [first, last] = met(intervals, pair);
            all.extend(first..=last);
        }
    }
    all.dedup();
    all
}

/// The first and the last of the intervals that a segment meets.
fn met(intervals: &[Interval], segment: [f64; 2]) -> [usize; 2] {
    segment.map(|t| intervals.partition_point(|i| i.range[1] <= t).min(intervals.len() - 1))
}

fn segment_holds(curve: &Curve<'_>, asked: &Asked<'_>, intervals: &[Interval], segment: [f64; 2]) -> bool {
    let [first, last] = met(intervals, segment);
    holds(curve, asked, &intervals[first..=last], segment)
}

/// Whether a segment keeps its share of the tolerance.
fn holds(curve: &Curve<'_>, asked: &Asked<'_>, met: &[Interval], [a, b]: [f64; 2]) -> bool {
    let tolerance = met.iter().map(|interval| interval.tolerance).fold(f64::INFINITY, f64::min);
    let square = (b - a) * (b - a) / 8.0;
    if met.iter().all(|interval| interval.proven && interval.bend * square <= SHARE) {
        return true;
    }
    match asked.options.guarantee {
        Guarantee::Proven if let Some(bound) = curve.second_bound([a, b]) => {
            bound * square <= SHARE * tolerance
        }
        _ => deviation(curve, [a, b], asked.by_place) <= SHARE * tolerance,
    }
}

/// The largest distance of seven points of the curve from a chord, or from their places on it.
fn deviation(curve: &Curve<'_>, [a, b]: [f64; 2], by_place: bool) -> f64 {
    let (from, to) = (curve.point(a), curve.point(b));
    let chord = to - from;
    let distance = |share: f64| {
        let off = curve.point(a + share * (b - a)) - from;
        let along = (off.dot(chord) / chord.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (off - if by_place { share } else { along } * chord).length()
    };
    (1..8).map(|k| distance(f64::from(k) / 8.0)).fold(0.0, f64::max)
}
