//! The search for crossings in `f64`, each one proved: parts that are apart or cross at most once by their hulls, and
//! Newton's iteration with the theorem of Kantorovich.

use super::part::{Part, Store, U};
use super::scene::Scene;
use crate::math::Vec2;

/// A crossing: the true parameters differ by at most the radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    pub(super) s: f64,
    pub(super) t: f64,
    pub(super) radius: [f64; 2],
}

impl Crossing {
    /// Whether the other one may be the same, which it then is: each is the only one for far around.
    pub(super) fn is_same(&self, other: &Crossing) -> bool {
        (other.s - self.s).abs() <= other.radius[0] + self.radius[0]
            && (other.t - self.t).abs() <= other.radius[1] + self.radius[1]
    }
}

/// What rounding leaves open: parameters of both curves, low and high.
pub(super) type Open = [f64; 4];

/// A search through pairs of parts.
pub(super) struct Search<'a, S> {
    scene: &'a Scene<S>,
    /// Pairs that may still be looked at.
    budget: usize,
    /// Whether the first open pair ends the search.
    impatient: bool,
    pub(super) crossings: Vec<Crossing>,
    pub(super) open: Vec<Open>,
}

/// Parts narrower than this are not cut further: there a parabola deviates from its tangent by rounding.
const NARROW: f64 = 1.0 / (1_u64 << 26) as f64;
/// A part cut down to less than this share is worth another look before it is halved.
const GOOD_SHARE: f64 = 0.6;

/// Parameters less sure than this are sharpened: a thousand units in the last place.
const ILL_CONDITIONED: f64 = 1024.0 * U;

/// What Newton's iteration says about a pair of parts that cross at most once.
enum Verdict {
    Crossing(Crossing),
    Apart,
    Unsure,
}

impl<'a, S: Store> Search<'a, S> {
    /// A search that looks at no more than so many pairs; an impatient one ends where rounding leaves something open.
    pub(super) fn new(scene: &'a Scene<S>, budget: usize, impatient: bool) -> Search<'a, S> {
        Search { scene, budget, impatient, crossings: Vec::new(), open: Vec::new() }
    }

    /// Whether the search has come to its end early.
    fn is_over(&self) -> bool {
        self.budget == 0 || (self.impatient && !self.open.is_empty())
    }

    /// Finds the crossings of two parts.
    pub(super) fn run(&mut self, a: &Part<S>, b: &Part<S>) {
        if self.is_over() {
            return self.leave_open(a, b);
        }
        self.budget -= 1;
        if a.box_misses(b, 0.0) {
            return;
        }
        let Some((low, high)) = b.clipped(a, 0.0) else { return };
        let shrunk_b = high - low;
        let cut_b;
        let b = if shrunk_b < GOOD_SHARE {
            cut_b = b.cut(low, high);
            &cut_b
        } else {
            b
        };
        let Some((low, high)) = a.clipped(b, 0.0) else { return };
        let shrunk_a = high - low;
        let cut_a;
        let a = if shrunk_a < GOOD_SHARE {
            cut_a = a.cut(low, high);
            &cut_a
        } else {
            a
        };
        if a.turns_apart(b) {
            match self.newton(a, b) {
                Verdict::Crossing(crossing) => return self.add(crossing, a, b),
                Verdict::Apart => return,
                Verdict::Unsure => {}
            }
        }
        let shrunk = shrunk_a < GOOD_SHARE && shrunk_b < GOOD_SHARE;
        if a.width() <= NARROW && b.width() <= NARROW {
            return self.leave_open(a, b);
        }
        if shrunk {
            return self.run(a, b);
        }
        if b.width() <= NARROW || (a.width() > NARROW && a.size() >= b.size()) {
            a.halves().iter().for_each(|half| self.run(half, b));
        } else {
            b.halves().iter().for_each(|half| self.run(a, half));
        }
    }

    /// Whether so many pairs were looked at that the rest was left open.
    pub(super) fn budget_is_spent(&self) -> bool {
        self.budget == 0
    }

    /// Whether a part is not cut further.
    pub(super) fn is_narrow(&self, part: &Part<S>) -> bool {
        part.width() <= NARROW
    }

    pub(super) fn leave_open(&mut self, a: &Part<S>, b: &Part<S>) {
        self.open.push([a.low, a.high, b.low, b.high]);
    }

    /// Newton's iteration for the one crossing that parts with separate tangents may have.
    ///
    /// Proved by Kantorovich's theorem (1948): with the inverse of the derivative at most beta in size, the step eta and
    /// the second derivative K, there is one root within 2 eta where beta eta K is at most 1/2, none other within
    /// 1 / (beta K), and after the step the distance is at most 2 beta K eta^2, rounding aside.
    fn newton(&self, a: &Part<S>, b: &Part<S>) -> Verdict {
        let (mut s, mut t) = (0.5 * (a.low + a.high), 0.5 * (b.low + b.high));
        // From half a part away the digits double from step to step.
        for _ in 0..10 {
            let ((p, v), (q, w)) = (self.scene.a.at(s), self.scene.b.at(t));
            let (rest, cross) = (q - p, v.perp_dot(w));
            let step = Vec2::new(rest.perp_dot(w), rest.perp_dot(v)) / cross;
            let reach = [w, v].map(|d| (d.x.abs() + d.y.abs()) / cross.abs());
            let size = step.x.abs().max(step.y.abs());
            (s, t) = (s + step.x, t + step.y);
            // Overshoots by half a part lead elsewhere.
            if !(size.is_finite() && a.contains(s, 0.5 * a.width()) && b.contains(t, 0.5 * b.width())) {
                return Verdict::Unsure;
            }
            let stiffness = reach[0].max(reach[1]) * self.scene.bend;
            let rest = 2.0 * stiffness * size * size;
            if rest <= U && stiffness * size <= 0.25 {
                let radius = reach.map(|reach| reach * self.scene.rounding + rest + U);
                return self.placed(Crossing { s, t, radius }, reach, stiffness, a, b);
            }
        }
        Verdict::Unsure
    }

    /// Whether a proved crossing lies within two parts, or that there is none in them.
    fn placed(&self, rough: Crossing, reach: [f64; 2], stiffness: f64, a: &Part<S>, b: &Part<S>) -> Verdict {
        let ill = rough.radius[0].max(rough.radius[1]) > ILL_CONDITIONED;
        let Crossing { s, t, radius } = if ill { self.sharpened(rough, reach) } else { rough };
        if a.contains(s, radius[0]) && b.contains(t, radius[1]) {
            return Verdict::Crossing(Crossing { s, t, radius });
        }
        let farthest = |x: f64, part: &Part<S>| (x - part.low).abs().max((part.high - x).abs());
        let alone = farthest(s, a).max(farthest(t, b)) * stiffness <= 0.75;
        if alone { Verdict::Apart } else { Verdict::Unsure }
    }

    /// Two more steps with residuals in double-double.
    fn sharpened(&self, rough: Crossing, reach: [f64; 2]) -> Crossing {
        let Crossing { mut s, mut t, .. } = rough;
        let (v, w) = (self.scene.a.at(s).1, self.scene.b.at(t).1);
        let cross = v.perp_dot(w);
        for _ in 0..2 {
            let (rest, _) = self.scene.residual(s, t);
            (s, t) = (s + rest.perp_dot(w) / cross, t + rest.perp_dot(v) / cross);
        }
        let (rest, error) = self.scene.residual(s, t);
        let off = rest.x.abs() + rest.y.abs() + error;
        let radius = [0, 1].map(|k| (2.0 * reach[k] * off + U).min(rough.radius[k]));
        Crossing { s, t, radius }
    }

    /// Keeps a crossing, once: neighbouring parts find the same one at their common end.
    fn add(&mut self, crossing: Crossing, a: &Part<S>, b: &Part<S>) {
        let Some(crossing) = self.within_both(crossing) else { return self.leave_open(a, b) };
        if !self.crossings.iter().any(|known| known.is_same(&crossing)) {
            self.crossings.push(crossing);
        }
    }

    /// The crossing, put onto common ends of the curves exactly; `None` where it may be beyond an end.
    fn within_both(&self, mut crossing: Crossing) -> Option<Crossing> {
        let end = |x: f64, radius: f64| [0.0, 1.0].into_iter().find(|end| (x - end).abs() <= radius);
        let ends = (end(crossing.s, crossing.radius[0]), end(crossing.t, crossing.radius[1]));
        match ends {
            (None, None) => Some(crossing),
            (Some(s), Some(t)) if self.scene.ends_are_equal(s, t) => {
                (crossing.s, crossing.t) = (s, t);
                Some(crossing)
            }
            _ => None,
        }
    }
}
