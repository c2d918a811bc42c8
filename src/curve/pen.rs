//! Outlines drawn beside a strand: parallels, joins and caps.

use super::evolute::Evolute;
use super::fit::{Proxy, Run, SHARE, Side, Source, Step, follow};
use super::frame::UnitFrame;
use super::offset::Parallel;
use super::simplify::piece;
use super::strand::{Element, Strand, angle_between};
use super::{Arc, CurveError, Piece, Subpath};
use crate::math::Vec2;

/// How a corner is bridged on its outer side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Join {
    /// By an arc around the corner.
    Round,
    /// By both sides prolonged until they meet; where they meet farther from the corner than `limit` times the
    /// distance, as [`Join::Bevel`].
    Miter {
        /// At least 1. SVG's default is 4.
        limit: f64,
    },
    /// By a straight line.
    Bevel,
}

/// How a stroke ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cap {
    /// Straight across the end.
    Butt,
    /// By a half circle around the end.
    Round,
    /// Straight across, half a width beyond the end.
    Square,
}

/// What draws an outline in frame units.
pub(super) struct Pen {
    distance: f64,
    join: Join,
    /// What parallels and arcs may be off by.
    limit: f64,
    /// Whether parts that run backward are drawn so that outlines turn around nothing the wrong way.
    covers: bool,
    chain: Chain,
    /// The largest distance so far from what is meant.
    error: f64,
    /// What goes on without a corner and is not yet in the chain.
    run: Run,
    /// For a run backward that must be covered, the evolute beside it.
    evolute: Option<Vec<[Vec2; 4]>>,
    failure: Option<CurveError>,
}

/// Cubics, each of which starts exactly where the one before it ends.
#[derive(Default)]
struct Chain {
    at: Option<Vec2>,
    cubics: Vec<[Vec2; 4]>,
}

impl Chain {
    fn push(&mut self, points: [Vec2; 4]) {
        debug_assert!(self.at.is_none_or(|at| at == points[0]));
        self.at = Some(points[3]);
        self.cubics.push(points);
    }

    /// A straight line, or the start of the chain.
    fn line_to(&mut self, to: Vec2) {
        match self.at {
            Some(from) if from != to => {
                let third = (to - from) / 3.0;
                self.push([from, from + third, to - third, to]);
            }
            _ => self.at = Some(to),
        }
    }

    /// A straight line, or where its ends are as near as `near` the last cubic moved to the end.
    fn reach(&mut self, to: Vec2, near: f64) {
        match (self.at, self.cubics.last_mut()) {
            (Some(at), Some(last)) if (at - to).length() <= near => {
                last[3] = to;
                self.at = Some(to);
            }
            _ => self.line_to(to),
        }
    }

    /// Cubics that start where the chain ends, as nearly as `near`; else there is a line between. Those that do not
    /// leave that place are left out.
    fn extend(&mut self, cubics: &[[Vec2; 4]], near: f64) {
        for &points in cubics {
            let mut points = points;
            match self.at {
                Some(at) if points.iter().all(|&p| (at - p).length() <= near) => continue,
                Some(at) if (at - points[0]).length() <= near => points[0] = at,
                _ => self.line_to(points[0]),
            }
            self.push(points);
        }
    }
}

/// A part of a curve: smooth, or a corner since it is shorter than [`POINT`].
enum Leg {
    Run(Run, [f64; 2]),
    Turn([f64; 2]),
}

/// A part of a curve that is shorter than this share of the tolerance may be taken for a corner.
const POINT: f64 = 1.0 / 1024.0;

impl Pen {
    /// A pen that draws at a distance to the left of strands.
    pub(super) fn new(distance: f64, join: Join, limit: f64) -> Pen {
        let (chain, run) = (Chain::default(), Run::default());
        Pen { distance, join, limit, covers: false, chain, error: 0.0, run, evolute: None, failure: None }
    }

    /// The same pen for outlines of regions.
    pub(super) fn covering(self) -> Pen {
        Pen { covers: true, ..self }
    }

    /// The largest distance of what was drawn from what is meant.
    pub(super) fn error(&self) -> f64 {
        self.error
    }

    /// Takes the outline drawn so far as a subpath in model units; `None` when there is nothing.
    pub(super) fn lift(&mut self, frame: &UnitFrame, closed: bool) -> Result<Option<Subpath>, CurveError> {
        let cubics = std::mem::take(&mut self.chain).cubics;
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let outward = |points: [Vec2; 4]| piece(points.map(|p| frame.outward(p)));
        let pieces: Vec<Piece> = cubics.into_iter().map(outward).collect::<Result<_, _>>()?;
        if pieces.is_empty() {
            return Ok(None);
        }
        Ok(Some(if closed { Subpath::closed(pieces)? } else { Subpath::open(pieces)? }))
    }

    /// Draws the parallel of a strand.
    pub(super) fn beside(&mut self, strand: &Strand) {
        let count = strand.elements.len();
        let smooth: Vec<bool> = strand.joints().map(|(a, b)| self.is_smooth(a, b)).collect();
        for (index, element) in strand.elements.iter().enumerate() {
            let neighbour = |joint: usize, other: usize| {
                smooth.get(joint).is_some_and(|&smooth| smooth).then(|| strand.elements[other % count])
            };
            let (before, after) = (index + count - 1, index + 1);
            let mut tangents = element.tangents;
            if let Some(before) = neighbour(before % count, before) {
                tangents[0] = middle(before.tangents[1], tangents[0]);
            }
            if let Some(after) = neighbour(index, after) {
                tangents[1] = middle(tangents[1], after.tangents[0]);
            }
            self.parallel(&Parallel::new(element.points, tangents, self.distance), element.error);
            let has_corner = smooth.get(index).is_some_and(|&smooth| !smooth);
            if has_corner {
                let next = &strand.elements[after % count];
                let join = if next.after_cusp { Join::Round } else { self.join };
                self.corner(element.points[3], element.tangents[1], next.tangents[0], join);
            }
        }
        self.flush();
    }

    /// Whether the parallels of two neighbours meet, as nearly as the tolerance asks.
    fn is_smooth(&self, a: &Element, b: &Element) -> bool {
        let angle = angle_between(a.tangents[1], b.tangents[0]);
        !b.after_cusp && angle < 0.1 && angle * self.distance.abs() <= 0.25 * SHARE * self.limit
    }

    /// Draws the parallel of one element, which is within `base` of the one that is meant.
    fn parallel(&mut self, whole: &Parallel, base: f64) {
        let mut from = 0.0;
        for to in whole.cusps().into_iter().chain([1.0]) {
            let stretch = whole.between(from, to);
            for leg in self.legs(&stretch, &stretch, [from, to], base) {
                match leg {
                    Leg::Run(run, range) => {
                        let folded = self.covers && stretch.is_folded();
                        let evolute = folded.then(|| self.evolute(&stretch, range));
                        self.append(run, evolute);
                    }
                    Leg::Turn(range) => self.turn(&stretch, range, base),
                }
            }
            from = to;
        }
    }

    /// A curve that goes with a stretch of a parallel, between two parameters.
    fn legs(&self, source: &impl Source, stretch: &Parallel, range: [f64; 2], base: f64) -> Vec<Leg> {
        let point = POINT * self.limit;
        let is_least = |from: f64, to: f64| stretch.length_bound(from, to) <= point;
        let (mut legs, mut at) = (Vec::new(), range[0]);
        follow(source, range, SHARE * self.limit, &is_least, &mut |step| {
            match step {
                Step::Proxy { proxy, to, tangent } => {
                    if !matches!(legs.last(), Some(Leg::Run(..))) {
                        legs.push(Leg::Run(Run::starting(source.ray(at, Side::After).tangent), [at, at]));
                    }
                    if let Some(Leg::Run(run, range)) = legs.last_mut() {
                        run.push(Proxy { error: proxy.error + base, ..proxy }, tangent);
                        range[1] = to;
                    }
                    at = to;
                }
                Step::Stuck { from, to, .. } => {
                    match legs.last_mut() {
                        Some(Leg::Turn(range)) if stretch.length_bound(range[0], to) <= point => {
                            range[1] = to;
                        }
                        _ => legs.push(Leg::Turn([from, to])),
                    }
                    at = to;
                }
            }
            true
        });
        legs
    }

    /// Goes on with the present run where it leads there in the same direction, else starts another.
    fn append(&mut self, run: Run, evolute: Option<Vec<[Vec2; 4]>>) {
        let goes_on = !self.run.is_empty()
            && self.run.end() == run.start()
            && self.run.last_tangent() == run.first_tangent();
        match (&mut self.evolute, evolute) {
            (None, None) if goes_on => self.run.append(run),
            (Some(before), Some(more)) if goes_on => {
                before.extend(more);
                self.run.append(run);
            }
            (_, evolute) => {
                self.flush();
                self.chain.line_to(run.start());
                (self.run, self.evolute) = (run, evolute);
            }
        }
    }

    /// Draws the present run with few cubics.
    ///
    /// Where it runs backward: up to the evolute normals run through points one way, beyond it the other way. So the
    /// outline goes along the evolute, back along the run, and along the evolute again: around both parts in the same
    /// sense.
    fn flush(&mut self) {
        let run = std::mem::take(&mut self.run);
        let cubics = self.fitted(&run);
        let Some(evolute) = self.evolute.take() else {
            return self.chain.extend(&cubics, 0.0);
        };
        let near = SHARE * self.limit;
        for pass in 0..2 {
            self.chain.extend(&evolute, near);
            self.chain.reach(run.end(), near);
            if pass == 0 {
                let back: Vec<[Vec2; 4]> = cubics.iter().rev().map(|&[a, b, c, d]| [d, c, b, a]).collect();
                self.chain.extend(&back, 0.0);
            }
        }
    }

    fn fitted(&mut self, run: &Run) -> Vec<[Vec2; 4]> {
        let fitted = run.fitted(self.limit);
        self.error = fitted.iter().fold(self.error, |most, proxy| most.max(proxy.error));
        fitted.into_iter().map(|proxy| proxy.points).collect()
    }

    /// A part so short, and that turns so fast, that it is a corner. Its parallel is arcs on either side, as many as it
    /// takes to turn the way the part does.
    fn turn(&mut self, stretch: &Parallel, [from, to]: [f64; 2], base: f64) {
        let at = stretch.center(from);
        let directions = stretch.directions(from, to);
        for pair in directions.windows(2) {
            let [arriving, leaving] = [pair[0], pair[1]];
            let inner = arriving.perp_dot(leaving) * self.distance > 0.0;
            if self.covers || !inner {
                self.corner(at, arriving, leaving, Join::Round);
            } else {
                self.flush();
                self.chain.line_to(at + arriving.perp() * self.distance);
                self.arc(at, arriving, leaving, -1.0);
            }
        }
        // The end of the last arc is moved once more.
        self.error = self.error.max(0.5 * self.limit + base + 2.0 * stretch.length_bound(from, to));
        self.chain.reach(stretch.ray(to, Side::Before).point, POINT * self.limit);
    }

    /// The evolute between two parameters; a straight line where it is one as far as the tolerance can tell.
    fn evolute(&mut self, stretch: &Parallel, range: [f64; 2]) -> Vec<[Vec2; 4]> {
        let evolute = Evolute(stretch);
        if let Some(chord) = evolute.chord(range, self.limit) {
            return vec![chord];
        }
        let limit = (1.0 - SHARE) * self.limit;
        let runs = self.legs(&evolute, stretch, range, 0.0).into_iter().filter_map(|leg| match leg {
            Leg::Run(run, _) => Some(run),
            Leg::Turn(_) => None,
        });
        runs.flat_map(|run| run.fitted(limit)).map(|proxy| proxy.points).collect()
    }

    /// Draws around a corner of the strand from one tangent to the other.
    ///
    /// On the inner side the outline goes through the corner itself: so it is the sum of outlines around the parts on
    /// both sides and the join between them, and turns around no point the wrong way.
    fn corner(&mut self, at: Vec2, from: Vec2, to: Vec2, join: Join) {
        self.flush();
        let (start, end) = (at + from.perp() * self.distance, at + to.perp() * self.distance);
        let (turn, ahead) = (from.perp_dot(to), from.dot(to));
        self.chain.line_to(start);
        if start == end {
            return;
        }
        let inner = turn * self.distance > 0.0;
        if inner && (end - start).length() > 0.25 * self.limit {
            self.chain.line_to(at);
        } else if !inner {
            match join {
                Join::Round => self.arc(at, from, to, 1.0),
                Join::Miter { limit } if 2.0 <= limit * limit * (1.0 + ahead) => {
                    self.chain.line_to(at + (from.perp() + to.perp()) * (self.distance / (1.0 + ahead)));
                }
                Join::Miter { .. } | Join::Bevel => {}
            }
        }
        self.chain.line_to(end);
    }

    /// An arc around a corner: for `sense` 1 through the direction of `from`, as on the outer side, for -1 against it.
    fn arc(&mut self, at: Vec2, from: Vec2, to: Vec2, sense: f64) {
        let axes = [from.perp() * self.distance, from * (sense * self.distance.abs())];
        let tolerance = 0.5 * self.limit;
        let arc = Arc::new(at, axes, 0.0, angle_between(from, to)).and_then(|arc| arc.cubics(tolerance));
        let mut cubics = match arc {
            Ok(cubics) => cubics.iter().map(|cubic| cubic.to_array()).collect(),
            Err(error) => {
                self.failure = self.failure.or(Some(error));
                Vec::new()
            }
        };
        // The ends are known better than the arc computes them.
        if let (Some(first), Some(start)) = (cubics.first_mut(), self.chain.at) {
            first[0] = start;
        }
        if let Some(last) = cubics.last_mut() {
            last[3] = at + to.perp() * self.distance;
        }
        for points in cubics {
            self.chain.push(points);
        }
        self.error = self.error.max(tolerance);
    }

    /// Draws around the end of a strand that arrives along `tangent`.
    pub(super) fn cap(&mut self, at: Vec2, tangent: Vec2, cap: Cap) {
        let side = tangent.perp() * self.distance;
        self.chain.line_to(at + side);
        match cap {
            Cap::Butt => {}
            Cap::Round => self.arc(at, tangent, -tangent, 1.0),
            Cap::Square => {
                let beyond = at + tangent * self.distance.abs();
                self.chain.line_to(beyond + side);
                self.chain.line_to(beyond - side);
            }
        }
        self.chain.line_to(at - side);
    }
}

/// The direction between two that nearly agree.
fn middle(a: Vec2, b: Vec2) -> Vec2 {
    if a == b { a } else { (a + b).try_normalize().unwrap_or(b) }
}

/// Whether a join can be drawn.
///
/// # Errors
/// [`CurveError::Parameter`] for a miter limit below 1 or NaN.
pub(super) fn check_join(join: Join) -> Result<(), CurveError> {
    match join {
        Join::Miter { limit } if limit.is_nan() || limit < 1.0 => Err(CurveError::Parameter { value: limit }),
        _ => Ok(()),
    }
}
