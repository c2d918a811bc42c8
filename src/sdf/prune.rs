//! Leaving out what cannot matter within a cell.
//!
//! Ranges of all steps are taken forwards; backwards it is noted which steps matter, and from which values on they do
//! not: the branch of a minimum that is always above the other does not, nor does one that is above what a minimum
//! further on is known to be. What is left is copied. Only what keeps every bit is left out. (Duff, Interval arithmetic
//! and recursive subdivision for implicit functions, 1992; Keeter, Massively parallel rendering of complex
//! closed-form implicit surfaces, 2020.)

use super::Range;
use super::expr::Op;
use super::graph::Step;
use super::op::{Binary, Blend, Unary};
use super::primitive::Primitive;
use super::real::Real;
use super::tape::{Tape, axes_of};
use crate::math::{Aabb, Interval};

/// The tape for points of the cell; `None` where nothing can be left out.
pub(super) fn within(tape: &Tape, cell: Aabb) -> Option<Tape> {
    if cell.is_empty() {
        return None;
    }
    let mut ranges = Vec::with_capacity(tape.steps.len());
    tape.trace(axes_of(cell, |x, _| x), &mut ranges);
    let choices = choose(&tape.steps, &ranges);
    let (steps, root) = rebuilt(&tape.steps, &choices);
    let pruned = Tape::of_steps(steps, root);
    (pruned.steps.len() < tape.steps.len()).then_some(pruned)
}

/// What becomes of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Choice {
    /// Nobody needs it.
    Drop,
    /// It stays.
    Keep,
    /// It is this argument.
    Take(usize),
    /// It is the negation of its argument.
    Negate,
    /// It is a blend that is a plain minimum.
    Plain,
    /// It is this number.
    Constant(f64),
}

/// The values that matter of a step: one above `cap` may be any other above it, one below `floor` any other below.
#[derive(Clone, Copy)]
struct Need {
    floor: f64,
    cap: f64,
}

impl Need {
    /// Nobody has asked yet.
    const NONE: Need = Need { floor: f64::INFINITY, cap: f64::NEG_INFINITY };
    /// Every value matters.
    const ALL: Need = Need { floor: f64::NEG_INFINITY, cap: f64::INFINITY };

    fn also(&mut self, other: Need) {
        *self = Need { floor: self.floor.min(other.floor), cap: self.cap.max(other.cap) };
    }

    fn is_none(self) -> bool {
        self.floor == f64::INFINITY && self.cap == f64::NEG_INFINITY
    }
}

fn choose(steps: &[Step], ranges: &[Range]) -> Vec<Choice> {
    let mut choices = vec![Choice::Drop; steps.len()];
    let mut needs = vec![Need::NONE; steps.len()];
    needs[steps.len() - 1] = Need::ALL;
    for id in (0..steps.len()).rev() {
        if needs[id].is_none() {
            continue;
        }
        let step = &steps[id];
        let args = step.args().iter().map(|&arg| ranges[arg as usize]).collect::<Vec<_>>();
        let (choice, asked) = decide(step, ranges[id], &args, needs[id]);
        choices[id] = choice;
        for (&arg, need) in step.args().iter().zip(asked) {
            needs[arg as usize].also(need);
        }
    }
    choices
}

/// What becomes of a step, and what it needs of each argument.
fn decide(step: &Step, range: Range, args: &[Range], need: Need) -> (Choice, [Need; 3]) {
    let keep = (Choice::Keep, [Need::ALL; 3]);
    let take = |arg: usize, need: Need| {
        let mut needs = [Need::NONE; 3];
        needs[arg] = need;
        (Choice::Take(arg), needs)
    };
    if let Some(x) = only_value(step, range) {
        return (Choice::Constant(x), [Need::NONE; 3]);
    }
    if args.iter().any(|arg| !arg.defined) && !matches!(step.op, Op::Binary(Binary::And | Binary::Or)) {
        return keep;
    }
    let side = |i: usize| args[i].interval;
    match &step.op {
        Op::Unary(Unary::Neg) => {
            (Choice::Keep, [Need { floor: -need.cap, cap: -need.floor }, Need::NONE, Need::NONE])
        }
        Op::Unary(Unary::Abs) if side(0).lo > 0.0 => take(0, Need::ALL),
        Op::Unary(Unary::Abs) if side(0).hi < 0.0 => (Choice::Negate, [Need::ALL; 3]),
        Op::Binary(Binary::Min) => match loser(side(0), side(1), need.cap) {
            Some(lost) => take(1 - lost, need),
            None => (Choice::Keep, capped(need, side(0).hi, side(1).hi)),
        },
        Op::Binary(Binary::Max) => match loser(-side(0), -side(1), -need.floor) {
            Some(lost) => take(1 - lost, need),
            None => (Choice::Keep, raised(need, side(0).lo, side(1).lo)),
        },
        Op::Binary(Binary::And) if is_zero(args[0]) => take(0, Need::ALL),
        Op::Binary(Binary::And) if !side(0).contains(0.0) => take(1, Need::ALL),
        Op::Binary(Binary::Or) if is_zero(args[0]) => take(1, Need::ALL),
        Op::Binary(Binary::Or) if !side(0).contains(0.0) => take(0, Need::ALL),
        Op::Binary(Binary::Add) => match zero_term(step, args) {
            Some(other) => take(other, need),
            None => keep,
        },
        Op::Blend(blend) => blended(*blend, args[0], args[1]),
        _ => keep,
    }
}

/// The one number that a step is everywhere, where its bits are beyond doubt: the sign of a zero is not.
fn only_value(step: &Step, range: Range) -> Option<f64> {
    let certain = range.defined && range.interval.is_point();
    let faded = matches!(step.op, Op::Primitive(Primitive::Blob { weight, .. }) if weight > 0.0);
    match step.op {
        Op::Constant(_) => None,
        _ if certain && range.interval.lo != 0.0 => Some(range.interval.lo),
        _ if certain && faded => Some(0.0),
        _ => None,
    }
}

fn is_zero(range: Range) -> bool {
    range.defined && range.interval == Interval::ZERO
}

/// Which of two arms a minimum does not need: one that is above the other, or above all that matters.
fn loser(a: Interval, b: Interval, cap: f64) -> Option<usize> {
    if a.hi < b.lo || b.lo > cap {
        Some(1)
    } else if b.hi < a.lo || a.lo > cap {
        Some(0)
    } else {
        None
    }
}

/// What a minimum needs of its arms: nothing above the other.
fn capped(need: Need, a: f64, b: f64) -> [Need; 3] {
    let arm = |other: f64| Need { cap: need.cap.min(other), ..need };
    [arm(b), arm(a), Need::NONE]
}

/// What a maximum needs of its arms: nothing below the other.
fn raised(need: Need, a: f64, b: f64) -> [Need; 3] {
    let arm = |other: f64| Need { floor: need.floor.max(other), ..need };
    [arm(b), arm(a), Need::NONE]
}

/// The other term, when one is zero and adding it changes no bit.
fn zero_term(step: &Step, args: &[Range]) -> Option<usize> {
    let nonzero = |range: Range| !range.interval.contains(0.0);
    (0..2).find(|&i| is_zero(args[1 - i]) && nonzero(args[i])).filter(|_| step.arity == 2)
}

/// A blend whose arms never come close enough is a minimum, and mostly one of its arms.
fn blended(blend: Blend, a: Range, b: Range) -> (Choice, [Need; 3]) {
    let plain = match blend {
        Blend::Quadratic { radius } => {
            let reach = Range::of(Interval::point(Blend::quadratic_reach(radius)));
            Real::abs(a - b) - reach
        }
        Blend::Circular { radius } => Real::max(a, b) - Range::of(Interval::point(radius)),
        // The cut is above the lesser arm where the other one is far enough above it.
        Blend::Chamfer { distance } => {
            let cut = (a + b - Range::of(Interval::point(distance)))
                * Range::of(Interval::point(std::f64::consts::FRAC_1_SQRT_2));
            cut - Real::min(a, b)
        }
    };
    let arms = [Need::ALL, Need::ALL, Need::NONE];
    // Rounding may put equal numbers in the wrong order, so not even at zero.
    if plain.interval.lo <= 0.0 || !plain.defined {
        return (Choice::Keep, arms);
    }
    match loser(a.interval, b.interval, f64::INFINITY) {
        Some(lost) => {
            let mut needs = [Need::NONE; 3];
            needs[1 - lost] = Need::ALL;
            (Choice::Take(1 - lost), needs)
        }
        None => (Choice::Plain, arms),
    }
}

/// The steps that stay, and the number of the result.
fn rebuilt(steps: &[Step], choices: &[Choice]) -> (Vec<Step>, u32) {
    let mut names = vec![0_u32; steps.len()];
    let mut kept: Vec<Step> = Vec::new();
    for (id, (step, choice)) in steps.iter().zip(choices).enumerate() {
        let args: Vec<u32> = step.args().iter().map(|&arg| names[arg as usize]).collect();
        let new = match *choice {
            Choice::Drop => continue,
            Choice::Take(arg) => {
                names[id] = args[arg];
                continue;
            }
            Choice::Keep => Step::new(step.op.clone(), &args),
            Choice::Negate => Step::new(Op::Unary(Unary::Neg), &args),
            Choice::Plain => Step::new(Op::Binary(Binary::Min), &args),
            Choice::Constant(x) => Step::new(Op::Constant(x), &[]),
        };
        names[id] = kept.len() as u32;
        kept.push(new);
    }
    (kept, names[steps.len() - 1])
}
