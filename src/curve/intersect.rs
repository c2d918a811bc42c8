//! Where curves meet: with a line, with another curve, with themselves, each meeting classified.

use super::bernstein::{Roots, roots};
use super::differential::jet;
use super::nearest::nearest;
use super::subdivide::{reciprocal_powers, restrict};
use super::{AnyBezier, Bernstein, Cubic, CubicShape, CurveError, check_degree, check_finite};
use crate::math::Vec2;

/// How two curves meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contact {
    /// They pass from one side to the other at an angle, or one of them ends on the other.
    Crossing,
    /// They touch with a common tangent, as far as rounding can tell; odd multiplicities pass to the other side.
    Tangency {
        /// The number of meetings that fall into one, 2 or more.
        multiplicity: usize,
    },
    /// They run together.
    Overlap,
    /// They do not meet but come nearer than the tolerance that was asked for.
    NearMiss {
        /// How near.
        distance: f64,
    },
}

/// A place where two curves meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// First and last parameter on the first curve; the same but for overlaps.
    pub first: [f64; 2],
    /// The parameters on the second curve that belong to those of `first`, descending where it runs the other way.
    pub second: [f64; 2],
    /// The point of the first curve at `first[0]`.
    pub point: Vec2,
    /// How they meet.
    pub contact: Contact,
}

/// Rounding of positions on curves of unit size and moderate degree.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Parameter width below which nearly parallel parts are examined as a touch: there a parabola deviates by rounding.
const TOUCH_WIDTH: f64 = 1.0 / (1_u64 << 26) as f64;
/// Pairs of parts that are examined before curves are called too close.
const MAX_PAIRS: usize = 50_000;
/// Pairs of parts that stay nearly parallel to the end before curves are called too close; a touch has a few dozen.
const MAX_TOUCHING: usize = 2_000;
/// Parts of a curve that are intersected with one another.
const MAX_PARTS: usize = 256;
/// Parameters nearer than this belong to one crossing: it was found from two neighbouring parts.
const SAME: f64 = 1.0 / (1_u64 << 34) as f64;

/// Where a curve meets the straight line through two points, whose parameter is 0 at `from` and 1 at `to` and runs on
/// beyond them. Roots of the distance in Bernstein form: none is missed.
///
/// # Errors
/// [`CurveError::NotFinite`] when a point is not finite, [`CurveError::TooFewPoints`] when both are the same,
/// [`CurveError::Degree`] above degree 500.
pub fn intersect_line<C: Bernstein<Vector = Vec2>>(
    curve: &C,
    from: Vec2,
    to: Vec2,
) -> Result<Vec<Meeting>, CurveError> {
    check_finite(&[from, to])?;
    check_degree(curve.degree())?;
    if from == to {
        return Err(CurveError::TooFewPoints { actual: 1, least: 2 });
    }
    let direction = unit(to * 0.25 - from * 0.25);
    let offsets: Vec<Vec2> = curve.points().iter().map(|&p| p * 0.25 - from * 0.25).collect();
    let size = offsets.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    let [a, b] = if size > 0.0 { reciprocal_powers(size) } else { [1.0, 1.0] };
    let heights: Vec<f64> = offsets.iter().map(|&p| direction.perp_dot(p * a * b)).collect();
    let span = (to * 0.25 - from * 0.25) * a * b;
    let along = |t: f64| {
        let p = (curve.eval(t) * 0.25 - from * 0.25) * a * b;
        p.dot(direction) / span.dot(direction)
    };
    let meeting = |low: f64, high: f64, contact: Contact| Meeting {
        first: [low, high],
        second: [along(low), along(high)],
        point: curve.eval(low),
        contact,
    };
    Ok(match roots(&heights, 4.0 * f64::EPSILON) {
        Roots::Everywhere => vec![meeting(0.0, 1.0, Contact::Overlap)],
        Roots::At(roots) => roots
            .iter()
            .map(|root| match root.multiplicity {
                1 => meeting(root.t, root.t, Contact::Crossing),
                multiplicity => meeting(root.t, root.t, Contact::Tangency { multiplicity }),
            })
            .collect(),
    })
}

/// The unit vector, whatever the size.
fn unit(v: Vec2) -> Vec2 {
    (v / v.abs().max_element()).normalize()
}

/// Where two curves meet, ascending along the first.
///
/// Parts whose boxes or strips are apart cannot meet; parts whose tangents span separate angles meet at most once, and
/// Newton's iteration finds that point to the last bits; parts that stay nearly parallel down to a width at which
/// rounding hides their bend are examined as a touch, and curves that share ends as an overlap. With a tolerance, in
/// model units, places where the curves come that near without meeting are reported as well.
///
/// # Errors
/// [`CurveError::Degree`] above degree 500, [`CurveError::Tolerance`] for one that is not a positive number,
/// [`CurveError::TooClose`] when the curves run together within rounding without being one.
pub fn intersect<A, B>(first: &A, second: &B, tolerance: Option<f64>) -> Result<Vec<Meeting>, CurveError>
where
    A: Bernstein<Vector = Vec2>,
    B: Bernstein<Vector = Vec2>,
{
    check_degree(first.degree().max(second.degree()))?;
    tolerance.map_or(Ok(()), super::check_tolerance)?;
    let scene = Scene::new(first.points(), second.points())?;
    if tolerance.is_none() && scene.boxes_are_apart() {
        return Ok(Vec::new());
    }
    let mut meetings = scene.overlaps()?;
    let overlaps = meetings.clone();
    let mut search = Search::new(&scene, ROUNDING, TOUCH_WIDTH);
    if overlaps.is_empty() {
        search.run()?;
    } else {
        search.run_beside(&overlaps)?;
    }
    meetings.extend(search.meetings());
    if let Some(tolerance) = tolerance {
        let near = scene.near_misses(tolerance * scene.scale[0] * scene.scale[1], &meetings)?;
        meetings.extend(near);
    }
    meetings.sort_by(|a, b| a.first[0].total_cmp(&b.first[0]).then(a.second[0].total_cmp(&b.second[0])));
    for meeting in &mut meetings {
        meeting.point = first.eval(meeting.first[0]);
    }
    Ok(meetings)
}

/// Where a curve meets itself: pairs of different parameters, the smaller one first.
///
/// Cubics and lower degrees, unless they run on a line, have at most one such point, found in closed form. For others
/// the curve is cut into parts whose tangents span less than a half turn, which cannot meet themselves, and the parts
/// are intersected with one another; the joints of neighbours do not count.
///
/// # Errors
/// As [`intersect`].
pub fn self_intersections<C: Bernstein<Vector = Vec2>>(curve: &C) -> Result<Vec<Meeting>, CurveError> {
    if let Some(meetings) = of_cubic(curve) {
        return Ok(meetings);
    }
    let mut cuts = vec![0.0];
    simple_parts(curve, 0.0, 1.0, &mut cuts)?;
    let parts: Vec<C> =
        cuts.windows(2).map(|cut| curve.subcurve(cut[0], cut[1])).collect::<Result<_, _>>()?;
    let mut found: Vec<Meeting> = Vec::new();
    for i in 0..parts.len() {
        for j in i + 1..parts.len() {
            for meeting in intersect(&parts[i], &parts[j], None)? {
                let outward = |k: usize, t: f64| cuts[k] + t * (cuts[k + 1] - cuts[k]);
                let (first, second) =
                    (meeting.first.map(|t| outward(i, t)), meeting.second.map(|t| outward(j, t)));
                let joint = (first[0] - second[0]).abs() < 1e-6 && meeting.contact != Contact::Overlap;
                let known = found.iter().any(|other| {
                    (other.first[0] - first[0]).abs() < SAME && (other.second[0] - second[0]).abs() < SAME
                });
                if !joint && !known {
                    found.push(Meeting { first, second, point: curve.eval(first[0]), ..meeting });
                }
            }
        }
    }
    found.sort_by(|a, b| a.first[0].total_cmp(&b.first[0]));
    Ok(found)
}

/// The closed form of a curve up to degree 3; `None` for higher degrees and for curves on a line.
fn of_cubic<C: Bernstein<Vector = Vec2>>(curve: &C) -> Option<Vec<Meeting>> {
    let raised = AnyBezier::assume(curve.points().to_vec()).elevated(3_usize.checked_sub(curve.degree())?);
    let &[a, b, c, d] = raised.points() else { return None };
    let cubic = Cubic::assume([a, b, c, d]);
    if curve.points().iter().all(|&point| point == a) {
        return Some(Vec::new());
    }
    if cubic.shape() == CubicShape::Straight {
        return None;
    }
    let meeting = |[s, t]: [f64; 2]| Meeting {
        first: [s, s],
        second: [t, t],
        point: curve.eval(s),
        contact: Contact::Crossing,
    };
    Some(cubic.self_intersection().map(meeting).into_iter().collect())
}

/// Adds the ends of parts of the curve whose derivatives stay within an open half-plane, or that are very short.
fn simple_parts<C>(curve: &C, low: f64, high: f64, cuts: &mut Vec<f64>) -> Result<(), CurveError>
where
    C: Bernstein<Vector = Vec2>,
{
    let part = curve.subcurve(low, high)?;
    let steps: Vec<Vec2> = part.points().windows(2).map(|pair| pair[1] - pair[0]).collect();
    let stands_still = steps.iter().all(|&step| step == Vec2::ZERO);
    if cuts.len() > MAX_PARTS {
        return Err(CurveError::TooClose);
    }
    if high - low < 1e-6 || stands_still || cone(&steps).is_some() {
        cuts.push(high);
        return Ok(());
    }
    let middle = 0.5 * (low + high);
    simple_parts(curve, low, middle, cuts)?;
    simple_parts(curve, middle, high, cuts)
}

/// The two outermost of vectors that span less than a half turn, clockwise one first; `None` where they span more or
/// one of them vanishes.
fn cone(steps: &[Vec2]) -> Option<[Vec2; 2]> {
    let &start = steps.first()?;
    let (mut right, mut left) = (start, start);
    for &step in steps {
        if step.dot(start) <= 0.0 {
            return None;
        }
        if right.perp_dot(step) < 0.0 {
            right = step;
        }
        if left.perp_dot(step) > 0.0 {
            left = step;
        }
    }
    (right.dot(left) > 0.0).then_some([right, left])
}

/// The smallest and largest coordinates.
fn extent(points: &[Vec2]) -> [Vec2; 2] {
    points.iter().fold([points[0]; 2], |[low, high], &p| [low.min(p), high.max(p)])
}

/// Whether no direction of one cone is parallel to one of the other.
fn apart(a: [Vec2; 2], b: [Vec2; 2]) -> bool {
    let sides = [a[0].perp_dot(b[0]), a[0].perp_dot(b[1]), a[1].perp_dot(b[0]), a[1].perp_dot(b[1])];
    sides.iter().all(|&x| x > 0.0) || sides.iter().all(|&x| x < 0.0)
}

/// Two curves about the origin and of about unit size.
struct Scene {
    a: Vec<Vec2>,
    b: Vec<Vec2>,
    /// Two factors that brought them to this size.
    scale: [f64; 2],
}

/// A part of a curve.
#[derive(Clone)]
struct Part {
    low: f64,
    high: f64,
    points: Vec<Vec2>,
}

impl Part {
    fn of(whole: &[Vec2], low: f64, high: f64) -> Part {
        let mut points = whole.to_vec();
        restrict(&mut points, low, high);
        Part { low, high, points }
    }

    fn halves(&self) -> [Part; 2] {
        let middle = 0.5 * (self.low + self.high);
        let (mut left, mut right) = (self.points.clone(), self.points.clone());
        super::subdivide::split(&mut left, &mut right, 0.5);
        [
            Part { low: self.low, high: middle, points: left },
            Part { low: middle, high: self.high, points: right },
        ]
    }

    fn width(&self) -> f64 {
        self.high - self.low
    }

    fn extent(&self) -> [Vec2; 2] {
        extent(&self.points)
    }

    fn cone(&self) -> Option<[Vec2; 2]> {
        let steps: Vec<Vec2> = self.points.windows(2).map(|pair| pair[1] - pair[0]).collect();
        cone(&steps)
    }

    /// Whether the other part lies beyond the strip along this one's chord, by more than `gap`.
    fn strip_misses(&self, other: &Part, gap: f64) -> bool {
        let chord = self.points[self.points.len() - 1] - self.points[0];
        let length = chord.length();
        if length == 0.0 {
            return false;
        }
        let height = |p: &Vec2| chord.perp_dot(*p - self.points[0]) / length;
        let range = |points: &[Vec2]| {
            points.iter().map(height).fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)))
        };
        let ((low, high), (other_low, other_high)) = (range(&self.points), range(&other.points));
        other_low > high + gap || other_high < low - gap
    }
}

impl Scene {
    fn new(a: &[Vec2], b: &[Vec2]) -> Result<Scene, CurveError> {
        let origin = a[0] * 0.25;
        let moved = |points: &[Vec2]| points.iter().map(|&p| p * 0.25 - origin).collect::<Vec<Vec2>>();
        let (mut a, mut b) = (moved(a), moved(b));
        let size = a.iter().chain(&b).fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let [first, second] = if size > 0.0 { reciprocal_powers(size) } else { [1.0, 1.0] };
        for p in a.iter_mut().chain(&mut b) {
            *p = *p * first * second;
        }
        Ok(Scene { a, b, scale: [first, 0.25 * second] })
    }

    fn boxes_are_apart(&self) -> bool {
        let ([a_low, a_high], [b_low, b_high]) = (extent(&self.a), extent(&self.b));
        a_low.cmpgt(b_high + ROUNDING).any() || b_low.cmpgt(a_high + ROUNDING).any()
    }

    fn point_a(&self, t: f64) -> Vec2 {
        super::evaluate::eval(&self.a, t)
    }

    fn point_b(&self, t: f64) -> Vec2 {
        super::evaluate::eval(&self.b, t)
    }

    fn meeting(&self, s: f64, t: f64, contact: Contact) -> Meeting {
        Meeting { first: [s, s], second: [t, t], point: self.point_a(s), contact }
    }

    /// Ends of one curve that lie on the other, as pairs of parameters, ascending.
    fn shared_ends(&self, within: f64) -> Result<Vec<(f64, f64, f64)>, CurveError> {
        let (a, b) = (AnyBezier::assume(self.a.clone()), AnyBezier::assume(self.b.clone()));
        let mut pairs = Vec::new();
        for end in [0.0, 1.0] {
            let on_b = nearest(&b, a.eval(end))?;
            let on_a = nearest(&a, b.eval(end))?;
            pairs.push((end, on_b.t, on_b.distance.value));
            pairs.push((on_a.t, end, on_a.distance.value));
        }
        pairs.retain(|pair| pair.2 <= within);
        pairs.sort_by(|p, q| p.0.total_cmp(&q.0));
        pairs.dedup_by(|p, q| (p.0 - q.0).abs() < SAME && (p.1 - q.1).abs() < SAME);
        Ok(pairs)
    }

    /// Polynomial curves that run together do so between ends, and their parameters are linear in one another.
    fn overlaps(&self) -> Result<Vec<Meeting>, CurveError> {
        let ends = self.shared_ends(ROUNDING)?;
        let (Some(from), Some(to)) = (ends.first(), ends.last()) else { return Ok(Vec::new()) };
        if to.0 - from.0 < SAME || (to.1 - from.1).abs() < SAME {
            return Ok(Vec::new());
        }
        let (a, b) = (Part::of(&self.a, from.0, to.0).points, Part::of(&self.b, from.1, to.1).points);
        let degree = a.len().max(b.len());
        let raised = |points: Vec<Vec2>| {
            let missing = degree - points.len();
            AnyBezier::assume(points).elevated(missing).into_points()
        };
        let apart = raised(a).iter().zip(raised(b)).map(|(p, q)| (*p - q).length()).fold(0.0, f64::max);
        // Parameters found by projection err by rounding over the speed.
        if apart > 16.0 * ROUNDING {
            return Ok(Vec::new());
        }
        let (first, second) = ([from.0, to.0], [from.1, to.1]);
        Ok(vec![Meeting { first, second, point: self.point_a(from.0), contact: Contact::Overlap }])
    }

    /// Places nearer than `gap` that are not near a meeting: where tangents are parallel, and at ends.
    fn near_misses(&self, gap: f64, meetings: &[Meeting]) -> Result<Vec<Meeting>, CurveError> {
        let width = (0.125 * gap.sqrt()).clamp(TOUCH_WIDTH, 0.125);
        let mut search = Search::new(self, gap, width);
        search.run()?;
        let ends = self.shared_ends(gap)?.into_iter().map(|(s, t, _)| (s, t));
        let mut near: Vec<Meeting> = Vec::new();
        for (s, t) in search.parallel_points().into_iter().chain(ends) {
            let distance = (self.point_a(s) - self.point_b(t)).length();
            let at_meeting = |m: &Meeting| {
                m.first[0] - 2.0 * width <= s
                    && s <= m.first[1] + 2.0 * width
                    && m.second[0].min(m.second[1]) - 2.0 * width <= t
                    && t <= m.second[0].max(m.second[1]) + 2.0 * width
            };
            if distance <= gap && !meetings.iter().chain(&near).any(at_meeting) {
                let distance = distance / self.scale[0] / self.scale[1];
                near.push(self.meeting(s, t, Contact::NearMiss { distance }));
            }
        }
        Ok(near)
    }
}

/// A search for meetings of two curves.
struct Search<'a> {
    scene: &'a Scene,
    /// Parts farther apart than this are dropped.
    gap: f64,
    /// Nearly parallel parts are cut down to this width.
    floor: f64,
    pairs: usize,
    crossings: Vec<(f64, f64)>,
    /// Pairs of parts that stayed nearly parallel: low and high parameters of both.
    touching: Vec<[f64; 4]>,
}

impl<'a> Search<'a> {
    fn new(scene: &'a Scene, gap: f64, floor: f64) -> Search<'a> {
        Search { scene, gap, floor, pairs: 0, crossings: Vec::new(), touching: Vec::new() }
    }

    fn run(&mut self) -> Result<(), CurveError> {
        self.examine(&Part::of(&self.scene.a, 0.0, 1.0), &Part::of(&self.scene.b, 0.0, 1.0))
    }

    /// Searches the parts of the first curve that are not within overlaps; meetings at the ends of those are no news.
    fn run_beside(&mut self, overlaps: &[Meeting]) -> Result<(), CurveError> {
        for overlap in overlaps {
            let whole = Part::of(&self.scene.b, 0.0, 1.0);
            for (low, high) in [(0.0, overlap.first[0]), (overlap.first[1], 1.0)] {
                // The joint itself would be found again and again: keep away by more than rounding.
                let (low, high) =
                    (if low > 0.0 { low + 1e-6 } else { low }, if high < 1.0 { high - 1e-6 } else { high });
                if low < high {
                    self.examine(&Part::of(&self.scene.a, low, high), &whole)?;
                }
            }
        }
        Ok(())
    }

    fn examine(&mut self, a: &Part, b: &Part) -> Result<(), CurveError> {
        self.pairs += 1;
        if self.pairs > MAX_PAIRS || self.touching.len() > MAX_TOUCHING {
            return Err(CurveError::TooClose);
        }
        let ([a_low, a_high], [b_low, b_high]) = (a.extent(), b.extent());
        let gap = Vec2::splat(self.gap);
        if a_low.cmpgt(b_high + gap).any() || b_low.cmpgt(a_high + gap).any() {
            return Ok(());
        }
        if a.strip_misses(b, self.gap) || b.strip_misses(a, self.gap) {
            return Ok(());
        }
        if let (Some(p), Some(q)) = (a.cone(), b.cone())
            && apart(p, q)
            && let Some(pair) = self.crossing(a, b)
        {
            self.crossings.push(pair);
            return Ok(());
        }
        // A part as small as rounding is not cut either: its points cannot be told apart.
        let (size_a, size_b) = ((a_high - a_low).max_element(), (b_high - b_low).max_element());
        let done_a = a.width() <= self.floor || size_a <= f64::EPSILON;
        let done_b = b.width() <= self.floor || size_b <= f64::EPSILON;
        if done_a && done_b {
            self.touching.push([a.low, a.high, b.low, b.high]);
            return Ok(());
        }
        // The larger one is cut; both when they are alike.
        let cut_a = !done_a && (size_a >= 0.5 * size_b || done_b);
        let cut_b = !done_b && (size_b >= 0.5 * size_a || done_a);
        let halves_a = if cut_a { a.halves().to_vec() } else { vec![a.clone()] };
        let halves_b = if cut_b { b.halves().to_vec() } else { vec![b.clone()] };
        for a in &halves_a {
            for b in &halves_b {
                self.examine(a, b)?;
            }
        }
        Ok(())
    }

    /// Newton's iteration for the one crossing that parts with separate tangents may have; `None` unless it converges
    /// into both, but for rounding at their ends.
    fn crossing(&self, a: &Part, b: &Part) -> Option<(f64, f64)> {
        let (mut s, mut t) = (0.5 * (a.low + a.high), 0.5 * (b.low + b.high));
        let mut last = f64::INFINITY;
        for _ in 0..40 {
            let (p, q) = (jet(&self.scene.a, s), jet(&self.scene.b, t));
            let (rest, cross) = (q.point - p.point, p.first.perp_dot(q.first));
            let step = Vec2::new(rest.perp_dot(q.first) / cross, rest.perp_dot(p.first) / cross);
            if !step.is_finite() {
                return None;
            }
            let size = step.abs().max_element();
            if size == 0.0 || (size < 1e-9 && size >= last) {
                break;
            }
            last = size;
            (s, t) = (s + step.x, t + step.y);
            if s < a.low - a.width()
                || s > a.high + a.width()
                || t < b.low - b.width()
                || t > b.high + b.width()
            {
                return None;
            }
        }
        // An end that lies on the other curve counts, though rounding may put the crossing beyond it.
        let (s, t) = (snapped(s, a)?, snapped(t, b)?);
        let off = (self.scene.point_a(s) - self.scene.point_b(t)).length();
        (off <= ROUNDING).then_some((s, t))
    }

    /// Centres of groups of touching pairs, each a list of neighbours.
    fn groups(&self) -> Vec<[f64; 4]> {
        let mut groups: Vec<[f64; 4]> = Vec::new();
        let mut pairs = self.touching.clone();
        pairs.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[2].total_cmp(&q[2])));
        for pair in pairs {
            let near = |g: &&mut [f64; 4]| {
                let slack = 2.0 * self.floor;
                pair[0] <= g[1] + slack
                    && g[0] <= pair[1] + slack
                    && pair[2] <= g[3] + slack
                    && g[2] <= pair[3] + slack
            };
            match groups.iter_mut().find(near) {
                Some(g) => *g = [g[0].min(pair[0]), g[1].max(pair[1]), g[2].min(pair[2]), g[3].max(pair[3])],
                None => groups.push(pair),
            }
        }
        groups
    }

    /// Where tangents are parallel and the curves opposite one another, near each group.
    fn parallel_points(&self) -> Vec<(f64, f64)> {
        self.groups().into_iter().map(|group| self.parallel_point(group)).collect()
    }

    /// Newton's iteration for parallel tangents and a connection at right angles to them; kept within the group's
    /// surroundings and [0, 1].
    fn parallel_point(&self, [a_low, a_high, b_low, b_high]: [f64; 4]) -> (f64, f64) {
        let (mut s, mut t) = (0.5 * (a_low + a_high), 0.5 * (b_low + b_high));
        let reach = 4.0 * (a_high - a_low).max(b_high - b_low).max(self.floor);
        let (s0, t0) = (s, t);
        for _ in 0..20 {
            let (p, q) = (jet(&self.scene.a, s), jet(&self.scene.b, t));
            let gap = p.point - q.point;
            // f = P' x Q', g = (P - Q) . P' and their derivatives.
            let (f, g) = (p.first.perp_dot(q.first), gap.dot(p.first));
            let (fs, ft) = (p.second.perp_dot(q.first), p.first.perp_dot(q.second));
            let (gs, gt) = (p.first.length_squared() + gap.dot(p.second), -q.first.dot(p.first));
            let determinant = fs * gt - ft * gs;
            let (ds, dt) = ((f * gt - g * ft) / determinant, (fs * g - gs * f) / determinant);
            if !(ds.is_finite() && dt.is_finite()) {
                break;
            }
            s = (s - ds).clamp((s0 - reach).max(0.0), (s0 + reach).min(1.0));
            t = (t - dt).clamp((t0 - reach).max(0.0), (t0 + reach).min(1.0));
            if ds.abs().max(dt.abs()) < 1e-16 {
                break;
            }
        }
        (s, t)
    }

    fn meetings(&self) -> Vec<Meeting> {
        let mut found: Vec<Meeting> = Vec::new();
        for &(s, t) in &self.crossings {
            let same = |m: &Meeting| (m.first[0] - s).abs() < SAME && (m.second[0] - t).abs() < SAME;
            if !found.iter().any(same) {
                found.push(self.scene.meeting(s, t, Contact::Crossing));
            }
        }
        for group in self.groups() {
            let (s, t) = self.parallel_point(group);
            let off = (self.scene.point_a(s) - self.scene.point_b(t)).length();
            let slack = group[1] - group[0] + 4.0 * self.floor;
            let known =
                found.iter().any(|m| (m.first[0] - s).abs() < slack && (m.second[0] - t).abs() < slack);
            if off <= ROUNDING && !known {
                found.push(self.scene.meeting(s, t, self.touch(s, t, slack)));
            }
        }
        found
    }

    /// Whether the curves change sides at a touch, from their heights on both sides of it.
    fn touch(&self, s: f64, t: f64, slack: f64) -> Contact {
        let p = jet(&self.scene.a, s);
        let q = jet(&self.scene.b, t);
        if s == 0.0 || s == 1.0 || t == 0.0 || t == 1.0 {
            return Contact::Tangency { multiplicity: 2 };
        }
        // Far enough that the height is more than rounding, for a touch of third order too.
        let reach = (16.0 * slack).max(1e-3);
        let ratio = p.first.dot(q.first) / q.first.length_squared();
        let side = |step: f64| {
            let a = self.scene.point_a(s + step);
            // The point of the other curve at the same place along the tangent.
            let mut along = t + step * ratio;
            for _ in 0..8 {
                let at = jet(&self.scene.b, along);
                along += (a - at.point).dot(p.first) / at.first.dot(p.first);
            }
            p.first.perp_dot(a - self.scene.point_b(along))
        };
        let crosses = (side(-reach) > 0.0) != (side(reach) > 0.0);
        Contact::Tangency { multiplicity: if crosses { 3 } else { 2 } }
    }
}

/// A parameter within a part; one beyond its end by rounding is moved to it.
fn snapped(t: f64, part: &Part) -> Option<f64> {
    let slack = 1e-9 * part.width() + 8.0 * f64::EPSILON;
    let inside = t.clamp(part.low, part.high);
    ((t - inside).abs() <= slack).then_some(if (part.low..=part.high).contains(&t) { t } else { inside })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Cubic;

    fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
        Cubic::new(points.map(Vec2::from)).unwrap()
    }

    /// An arch and its mirror image, moved so that they are `gap` apart.
    fn arches(gap: f64) -> [Cubic<Vec2>; 2] {
        let arch = cubic([(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)]);
        [arch, arch.map(|p| Vec2::new(p.x, 90.0 + gap - p.y)).unwrap()]
    }

    #[test]
    fn touching_near_and_crossing_arches() {
        let [a, b] = arches(0.0);
        let found = intersect(&a, &b, None).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].contact, Contact::Tangency { multiplicity: 2 });
        assert!((found[0].first[0] - 0.5).abs() < 1e-12 && (found[0].second[0] - 0.5).abs() < 1e-12);
        let [a, b] = arches(1e-9);
        assert_eq!(intersect(&a, &b, None).unwrap(), []);
        let near = intersect(&a, &b, Some(1e-6)).unwrap();
        let [Meeting { contact: Contact::NearMiss { distance }, .. }] = near[..] else { panic!("{near:?}") };
        assert!((distance - 1e-9).abs() < 1e-13);
        let [a, b] = arches(-1e-9);
        let found = intersect(&a, &b, None).unwrap();
        assert_eq!(found.len(), 2, "{found:?}");
        for (meeting, sign) in found.iter().zip([-1.0, 1.0]) {
            assert_eq!(meeting.contact, Contact::Crossing);
            assert!((meeting.first[0] - 0.5 - sign * 1.66667e-6).abs() < 1e-10, "{meeting:?}");
        }
    }

    #[test]
    fn overlaps_have_intervals() {
        let curve = cubic([(0.0, 0.0), (1.0, 3.0), (4.0, -2.0), (5.0, 1.0)]);
        let (a, b) = (curve.subcurve(0.0, 0.7).unwrap(), curve.subcurve(0.3, 1.0).unwrap());
        let check = |found: &[Meeting], first: [f64; 2], second: [f64; 2]| {
            assert!(found.len() == 1 && found[0].contact == Contact::Overlap, "{found:?}");
            for (got, want) in found[0].first.iter().chain(&found[0].second).zip(first.iter().chain(&second))
            {
                assert!((got - want).abs() < 1e-12, "{found:?}");
            }
        };
        check(&intersect(&a, &b, None).unwrap(), [3.0 / 7.0, 1.0], [0.0, 4.0 / 7.0]);
        check(&intersect(&curve, &curve, None).unwrap(), [0.0, 1.0], [0.0, 1.0]);
        check(&intersect(&curve, &curve.reversed(), None).unwrap(), [0.0, 1.0], [1.0, 0.0]);
    }

    #[test]
    fn lines_cross_touch_and_overlap() {
        let arch = cubic([(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)]);
        let found = intersect_line(&arch, Vec2::new(-1.0, 1.0), Vec2::new(3.0, 1.0)).unwrap();
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|m| m.contact == Contact::Crossing && (m.point.y - 1.0).abs() < 1e-15));
        let top = intersect_line(&arch, Vec2::new(0.0, 3.0), Vec2::new(1.0, 3.0)).unwrap();
        assert_eq!(top.len(), 1);
        assert_eq!(top[0].contact, Contact::Tangency { multiplicity: 2 });
        assert!((top[0].first[0] - 0.5).abs() < 1e-9 && (top[0].second[0] - 2.0).abs() < 1e-8);
        let flat = cubic([(0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0)]);
        let on = intersect_line(&flat, Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0)).unwrap();
        assert_eq!((on[0].contact, on[0].second), (Contact::Overlap, [0.0, 3.0]));
        assert!(intersect_line(&flat, Vec2::ZERO, Vec2::X).unwrap().is_empty());
    }

    #[test]
    fn a_loop_meets_itself_once() {
        let looped = cubic([(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)]);
        let found = self_intersections(&looped).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].first[0] - 0.17267316464601143).abs() < 1e-14);
        assert!((found[0].second[0] - (1.0 - 0.17267316464601143)).abs() < 1e-14);
        assert!(self_intersections(&arches(0.0)[0]).unwrap().is_empty());
    }

    #[test]
    fn scale_does_not_matter() {
        let a = cubic([(0.0, 0.0), (1.0, 3.0), (4.0, -2.0), (5.0, 1.0)]);
        let b = cubic([(0.0, 1.0), (2.0, -3.0), (3.0, 4.0), (5.0, 0.0)]);
        let want = intersect(&a, &b, None).unwrap();
        assert_eq!(want.len(), 3);
        for exponent in [-1000, -40, 900] {
            let scale = 2.0_f64.powi(exponent);
            let scaled = |c: &Cubic<Vec2>| c.map(|p| p * scale).unwrap();
            let got = intersect(&scaled(&a), &scaled(&b), None).unwrap();
            let parameters = |m: &[Meeting]| m.iter().map(|m| (m.first, m.second)).collect::<Vec<_>>();
            assert_eq!(parameters(&got), parameters(&want));
        }
    }
}
