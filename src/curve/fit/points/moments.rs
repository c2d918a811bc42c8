//! Cubics past points by area and first moment.

use super::Section;
use super::joints::{Joint, Joints};
use crate::curve::fit::Proxy;
use crate::curve::fit::arms::{candidates, integrals};
use crate::curve::fit::deviation::point_and_velocity;
use crate::curve::frame::ROUNDING;
use crate::math::Vec2;
use crate::numeric::quadrature::{GAUSS_8, integrate};

/// A part is long enough when it is known not to be longer by this share.
const SHARP: f64 = 0.02;

/// Cubics longer than the polyline by more than this run back and forth past its points. An arc of a half circle over
/// two sides has 1.11 times their length.
const LONGER: f64 = 1.5;

/// Cubics past the points of a section, from joint to joint, each as long as can be.
pub(super) fn follow(section: &Section, limit: f64) -> Vec<Proxy> {
    let chain = Chain { section, joints: Joints::new(section, limit), limit };
    let last = section.points.len() - 1;
    let (mut fitted, mut at, mut start, mut hint) = (Vec::new(), 0, chain.joints.at(0, last), 8);
    let first = start;
    while at < last {
        let close = |to: usize| {
            if to == last && section.wraps { first } else { chain.joints.at(to, (to - at).max(8)) }
        };
        let (to, end, proxy) = chain.longest(at, start, hint, close);
        fitted.push(proxy);
        (hint, at, start) = (to - at, to, end);
    }
    fitted
}

struct Chain<'a> {
    section: &'a Section,
    joints: Joints<'a>,
    limit: f64,
}

impl Chain<'_> {
    /// The longest part from a joint that one cubic follows, nearly: its last point, joint and cubic.
    fn longest(
        &self,
        from: usize,
        start: Joint,
        hint: usize,
        close: impl Fn(usize) -> Joint,
    ) -> (usize, Joint, Proxy) {
        let last = self.section.points.len() - 1;
        let end = close(from + 1);
        let mut best = (from + 1, end, self.step([from, from + 1], [start, end]));
        let (mut too_long, mut to) = (usize::MAX, (from + hint).min(last));
        while to > best.0 {
            let end = close(to);
            match self.fit([from, to], [start, end]) {
                Some(proxy) => best = (to, end, proxy),
                None => too_long = to,
            }
            let (have, rest) = (best.0 - from, too_long.saturating_sub(best.0));
            if rest <= 1 || (too_long != usize::MAX && rest as f64 <= SHARP * have as f64) {
                break;
            }
            to = if too_long == usize::MAX { (from + 2 * have).min(last) } else { best.0 + rest / 2 };
        }
        best
    }

    /// The cubic between neighbouring points.
    fn step(&self, [from, to]: [usize; 2], [start, end]: [Joint; 2]) -> Proxy {
        let third = start.point.distance(end.point) / 3.0;
        let points =
            [start.point, start.point + start.tangent * third, end.point - end.tangent * third, end.point];
        let ends = [(start, from), (end, to)].map(|(joint, k)| joint.point.distance(self.section.points[k]));
        Proxy { points, error: ends[0].max(ends[1]) + ROUNDING }
    }

    /// A cubic that is near enough to the points of a part.
    fn fit(&self, [from, to]: [usize; 2], [start, end]: [Joint; 2]) -> Option<Proxy> {
        let chord = end.point - start.point;
        let length = chord.length();
        let polygon: f64 =
            self.section.points[from..=to].windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        if length <= 1e-3 * polygon {
            return None;
        }
        let turn = chord / (length * length);
        let local = |p: Vec2| Vec2::new((p - start.point).dot(turn), turn.perp_dot(p - start.point));
        let sums = self.integrals([from, to], [start.point, end.point], local);
        let mut best: Option<Proxy> = None;
        let ends = [start.point, end.point];
        for points in candidates(ends, [start.tangent, end.tangent], sums, polygon) {
            if length_of(&points) > LONGER * polygon {
                continue;
            }
            let allowed = best.as_ref().map_or(self.limit, |best| best.error);
            if let Some(error) = self.farthest(&points, [from, to], allowed - ROUNDING) {
                best = Some(Proxy { points, error: error + ROUNDING });
            }
        }
        best
    }

    /// Integrals of y dx and x y dx along cubics through the points, from one joint to another.
    fn integrals(&self, [from, to]: [usize; 2], ends: [Vec2; 2], local: impl Fn(Vec2) -> Vec2) -> [f64; 2] {
        let points = &self.section.points[from..=to];
        let mut sums = [0.0; 2];
        let mut add = |piece: [Vec2; 4]| {
            let [area, moment] = integrals(&piece);
            sums = [sums[0] + area, sums[1] + moment];
        };
        let line = |a: Vec2, b: Vec2| [a, a + (b - a) / 3.0, b - (b - a) / 3.0, b];
        add(line(local(ends[0]), local(points[0])));
        // By Catmull and Rom: a third of half of the way from the point before to the one after.
        let slope = |k: usize| {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(points.len() - 1));
            (local(points[after]) - local(points[before])) / (after - before) as f64
        };
        let mut arriving = slope(0);
        for k in 1..points.len() {
            let (a, b, leaving) = (local(points[k - 1]), local(points[k]), arriving);
            arriving = slope(k);
            add([a, a + leaving / 3.0, b - arriving / 3.0, b]);
        }
        add(line(local(points[points.len() - 1]), local(ends[1])));
        sums
    }

    /// The largest distance of the points of a part from a cubic, by a walk along it; `None` when it is beyond a limit.
    fn farthest(&self, cubic: &[Vec2; 4], [from, to]: [usize; 2], limit: f64) -> Option<f64> {
        let lengths = self.joints.lengths();
        let (mut worst, mut t) = (0.0_f64, 0.0_f64);
        for k in from..=to {
            let step =
                if k > from { (lengths[k] - lengths[k - 1]) / (lengths[to] - lengths[k - 1]) } else { 0.0 };
            let (near, distance) = nearest(cubic, self.section.points[k], (t + step * (1.0 - t)).min(1.0));
            (worst, t) = (worst.max(distance), near);
            if worst > limit {
                return None;
            }
        }
        Some(worst)
    }
}

fn length_of(cubic: &[Vec2; 4]) -> f64 {
    integrate(GAUSS_8, 0.0, 1.0, |t| point_and_velocity(cubic, t).1.length())
}

/// A parameter near a guess at which a cubic is near to a point, and the distance there: Newton's steps for the foot of
/// the normal. Any parameter gives an upper bound of the distance.
fn nearest(cubic: &[Vec2; 4], point: Vec2, guess: f64) -> (f64, f64) {
    let mut best = (guess, f64::INFINITY);
    let mut t = guess;
    for _ in 0..6 {
        let (at, velocity) = point_and_velocity(cubic, t);
        let distance = at.distance(point);
        if distance < best.1 {
            best = (t, distance);
        }
        // The curvature is left out: so the step never goes the wrong way.
        let next = (t - (at - point).dot(velocity) / velocity.length_squared()).clamp(0.0, 1.0);
        if next.is_nan() || (next - t).abs() <= 1e-9 {
            break;
        }
        t = next;
    }
    best
}
