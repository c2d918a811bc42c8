//! A curve without corners, made of cubics, and the fewest cubics that follow it.

use super::arms::{candidates, integrals};
use super::deviation::{deviation, point_and_velocity, polygon_length};
use crate::curve::frame::UnitFrame;
use crate::curve::subdivide::restrict;
use crate::math::{Vec2, cbrt};

/// Cubics end to end without a corner, of about unit size, each with the distance it may be from what is meant.
///
/// Parameters run from 0 to the number of pieces.
#[derive(Clone, Debug, Default)]
pub(in crate::curve) struct Run {
    pieces: Vec<Proxy>,
    /// Unit tangents at the ends of the pieces, one more than pieces.
    tangents: Vec<Vec2>,
}

/// A cubic that stands for a part of a curve.
#[derive(Clone, Copy, Debug)]
pub(in crate::curve) struct Proxy {
    pub(in crate::curve) points: [Vec2; 4],
    /// Bound of its distance (Fréchet) from the part.
    pub(in crate::curve) error: f64,
}

/// A part of a piece of a run.
pub(super) struct Part {
    pub(super) points: [Vec2; 4],
    pub(super) error: f64,
    pub(super) is_last: bool,
}

/// A part is long enough when it fills this share of what is allowed: the error grows with the sixth power of the
/// length, so that nothing longer than by three parts in a hundred would do.
const ENOUGH: f64 = 0.85;
/// What a guess aims at.
const AIM: f64 = 0.93;
/// Candidates for one end of a part before the longest that did is taken.
const MOST_TRIES: u32 = 16;

impl Run {
    /// An empty run that starts in a direction.
    pub(in crate::curve) fn starting(tangent: Vec2) -> Run {
        Run { pieces: Vec::new(), tangents: vec![tangent] }
    }

    /// Adds a piece and the unit tangent at its end.
    pub(in crate::curve) fn push(&mut self, piece: Proxy, tangent: Vec2) {
        self.pieces.push(piece);
        self.tangents.push(tangent);
    }

    /// All control points, those of joints twice.
    pub(super) fn control_points(&self) -> impl Iterator<Item = Vec2> + '_ {
        self.pieces.iter().flat_map(|piece| piece.points)
    }

    /// The run in a frame.
    pub(super) fn inward(&self, frame: &UnitFrame) -> Run {
        let inward = |piece: &Proxy| Proxy {
            points: piece.points.map(|p| frame.inward(p)),
            error: frame.length_inward(piece.error),
        };
        Run { pieces: self.pieces.iter().map(inward).collect(), tangents: self.tangents.clone() }
    }

    /// The first point; the origin for an empty run.
    pub(in crate::curve) fn start(&self) -> Vec2 {
        self.pieces.first().map_or(Vec2::ZERO, |piece| piece.points[0])
    }

    pub(in crate::curve) fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Unit tangent at the start.
    pub(in crate::curve) fn first_tangent(&self) -> Vec2 {
        self.tangents[0]
    }

    /// Adds a run that starts where this one ends, in its direction.
    pub(in crate::curve) fn append(&mut self, other: Run) {
        self.pieces.extend(other.pieces);
        self.tangents.extend(other.tangents.into_iter().skip(1));
    }

    /// Unit tangent at the end.
    pub(in crate::curve) fn last_tangent(&self) -> Vec2 {
        self.tangents[self.tangents.len() - 1]
    }

    /// The last point; the origin for an empty run.
    pub(in crate::curve) fn end(&self) -> Vec2 {
        self.pieces.last().map_or(Vec2::ZERO, |piece| piece.points[3])
    }

    /// Cubics that follow the run to within the limit, nearly as few as possible, each from the end of the one before
    /// and with the same unit tangent there; its ends are kept exactly.
    ///
    /// From each point the longest part that can be shown to be within the limit is taken. Parts within one piece are
    /// exact, so that there is always one.
    pub(in crate::curve) fn fitted(&self, limit: f64) -> Vec<Proxy> {
        let (mut fitted, mut at, mut hint) = (Vec::<Proxy>::new(), 0.0, 1.0);
        while at < self.pieces.len() as f64 {
            let (to, mut proxy) = self.longest(at, hint, limit);
            // Equal but for rounding, where one is a part of a piece and the other is not.
            proxy.points[0] = fitted.last().map_or(proxy.points[0], |last| last.points[3]);
            fitted.push(proxy);
            hint = to - at;
            at = to;
        }
        fitted
    }

    /// The longest part from `from` that one cubic follows, nearly, and that cubic.
    fn longest(&self, from: f64, hint: f64, limit: f64) -> (f64, Proxy) {
        let end = self.pieces.len() as f64;
        let floor = (from.floor() + 1.0).min(end);
        let mut best = (floor, self.inside(from, floor));
        let (mut too_long, mut step) = (f64::INFINITY, hint.max(1.05 * (floor - from)));
        for _ in 0..MOST_TRIES {
            if best.0 >= end || too_long - best.0 <= 0.01 * (best.0 - from) {
                break;
            }
            let to =
                if from + 1.02 * step >= end.min(too_long) && too_long > end { end } else { from + step };
            match self.fit(from, to, limit) {
                Some(proxy) => {
                    let fill = proxy.error / limit;
                    best = (to, proxy);
                    if fill >= ENOUGH {
                        break;
                    }
                    // The sixth root.
                    let growth = cbrt((AIM / fill.max(1e-6)).sqrt());
                    step = (growth.max(1.02) * (to - from)).min(0.5 * (to + too_long) - from);
                }
                None => {
                    too_long = to;
                    step = 0.5 * (best.0 + too_long) - from;
                }
            }
        }
        best
    }

    /// The part of one piece, as it is.
    fn inside(&self, from: f64, to: f64) -> Proxy {
        let piece = &self.pieces[from as usize];
        let base = from.floor();
        Proxy { points: cut(&piece.points, from - base, to - base), error: piece.error }
    }

    /// A cubic for a part that is within the limit.
    fn fit(&self, from: f64, to: f64, limit: f64) -> Option<Proxy> {
        if to <= from.floor() + 1.0 {
            return Some(self.inside(from, to));
        }
        let (start, end) = (self.at(from), self.at(to));
        let chord = end - start;
        let length = chord.length();
        if length <= 1e-3 * self.polygon_length(from, to) {
            // Nearly closed: no single cubic of use.
            return None;
        }
        let (leaving, arriving) = (self.tangent(from), self.tangent(to));
        let turn = chord / (length * length);
        let local = |p: Vec2| Vec2::new(p.dot(turn), turn.perp_dot(p));
        let mut sums = [0.0; 2];
        for part in self.parts(from, to) {
            let [area, moment] = integrals(&part.points.map(|p| local(p - start)));
            sums = [sums[0] + area, sums[1] + moment];
        }
        let mut best: Option<Proxy> = None;
        let polygon = self.polygon_length(from, to);
        for points in candidates([start, end], [leaving, arriving], sums, polygon) {
            let allowed = best.as_ref().map_or(limit, |best| best.error);
            if let Some(error) = deviation(&points, self, from, to, allowed) {
                best = Some(Proxy { points, error });
            }
        }
        best.filter(|best| best.error <= limit)
    }

    fn locate(&self, u: f64) -> (usize, f64) {
        let index = (u as usize).min(self.pieces.len() - 1);
        (index, u - index as f64)
    }

    fn at(&self, u: f64) -> Vec2 {
        let (index, t) = self.locate(u);
        match t {
            0.0 => self.pieces[index].points[0],
            1.0 => self.pieces[index].points[3],
            t => point_and_velocity(&self.pieces[index].points, t).0,
        }
    }

    fn tangent(&self, u: f64) -> Vec2 {
        let (index, t) = self.locate(u);
        match t {
            0.0 => self.tangents[index],
            1.0 => self.tangents[index + 1],
            t => {
                let (_, velocity) = point_and_velocity(&self.pieces[index].points, t);
                velocity.try_normalize().unwrap_or(self.tangents[index])
            }
        }
    }

    /// The pieces between two parameters, the first and the last cut.
    pub(super) fn parts(&self, from: f64, to: f64) -> impl Iterator<Item = Part> + '_ {
        let last = ((to.ceil() as usize).max(1) - 1).min(self.pieces.len() - 1);
        (from as usize..=last).map(move |index| {
            let piece = &self.pieces[index];
            let (low, high) = ((from - index as f64).max(0.0), (to - index as f64).min(1.0));
            Part { points: cut(&piece.points, low, high), error: piece.error, is_last: index == last }
        })
    }

    /// The length of the control polygons between two parameters.
    pub(super) fn polygon_length(&self, from: f64, to: f64) -> f64 {
        self.parts(from, to).map(|part| polygon_length(&part.points)).sum()
    }
}

fn cut(points: &[Vec2; 4], from: f64, to: f64) -> [Vec2; 4] {
    let mut part = *points;
    if from > 0.0 || to < 1.0 {
        restrict(&mut part, from, to);
    }
    part
}
