//! The distance of a cubic from a curve made of cubics, proved.
//!
//! Both are walked at once, never back: on each piece of the curve the cubic runs over a monotone polynomial of the
//! piece's own parameter, so that the difference of the two is a polynomial of degree 9. Its control points bound the
//! distance of the walkers (Fréchet), and with it the distance from each curve to the other.

use super::run::Run;
use crate::curve::frame::ROUNDING;
use crate::math::{Blend, Vec2};

/// How often a piece of the curve is halved to bring the walkers side by side. Towards a cusp, where one of them
/// stands still and the other does not, each halving brings a quarter.
const HALVINGS: u32 = 24;
/// A bound of a distance this much above what was seen is sharp enough.
const SHARP: f64 = 1.05;

/// A bound of the distance of a cubic from the part of a run between two parameters, the errors of the run's own
/// pieces included; `None` when it cannot be shown to be within the limit.
pub(super) fn deviation(cubic: &[Vec2; 4], run: &Run, from: f64, to: f64, limit: f64) -> Option<f64> {
    let (mut worst, mut t) = (0.0_f64, 0.0);
    let total = run.polygon_length(from, to);
    let mut walked = 0.0;
    for part in run.parts(from, to) {
        walked += polygon_length(&part.points);
        let next = if part.is_last { 1.0 } else { opposite(cubic, &part.points, walked / total, t)? };
        let matching = Matching { cubic, limit: limit - part.error };
        worst = worst.max(matching.bound(&part.points, [t, next], HALVINGS)? + part.error);
        t = next;
    }
    Some(worst + ROUNDING)
}

pub(super) fn polygon_length(points: &[Vec2; 4]) -> f64 {
    points.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum()
}

struct Matching<'a> {
    cubic: &'a [Vec2; 4],
    limit: f64,
}

impl Matching<'_> {
    /// A bound for one piece of the curve against the cubic between two parameters.
    fn bound(&self, piece: &[Vec2; 4], t: [f64; 2], halvings: u32) -> Option<f64> {
        let pace = pace(self.cubic, piece, t);
        let difference = difference(self.cubic, &pace, piece);
        let ends = difference[0].length().max(difference[9].length());
        if ends > self.limit {
            return None;
        }
        let bound = largest(&difference, ends, self.limit, 6);
        if bound <= self.limit {
            return Some(bound);
        }
        if halvings == 0 {
            return None;
        }
        let (left, right) = halves(piece);
        let middle =
            opposite(self.cubic, &left, halves(&pace).1[0], t[0]).filter(|&middle| middle <= t[1])?;
        let first = self.bound(&left, [t[0], middle], halvings - 1)?;
        let second = self.bound(&right, [middle, t[1]], halvings - 1)?;
        Some(first.max(second))
    }
}

/// The parameter of the cubic, after `least`, that lies across from the end of a piece: in the direction of the
/// piece's normal there. Newton's steps from the guess.
fn opposite(cubic: &[Vec2; 4], piece: &[Vec2; 4], guess: f64, least: f64) -> Option<f64> {
    let along = piece.iter().rev().map(|&p| piece[3] - p).find(|step| *step != Vec2::ZERO)?;
    let mut t = guess;
    let mut reach = f64::INFINITY;
    for _ in 0..12 {
        let (point, velocity) = point_and_velocity(cubic, t);
        let step = (piece[3] - point).dot(along) / velocity.dot(along);
        if !step.is_finite() {
            return None;
        }
        t += step;
        if step.abs() <= 1e-12 || step.abs() >= reach {
            break;
        }
        reach = 2.0 * step.abs();
    }
    (t >= least && t <= 1.0).then_some(t)
}

pub(super) fn point_and_velocity(points: &[Vec2; 4], t: f64) -> (Vec2, Vec2) {
    let lerp = |a: Vec2, b: Vec2| a + (b - a) * t;
    let [a, b, c, d] = *points;
    let (ab, bc, cd) = (lerp(a, b), lerp(b, c), lerp(c, d));
    let (left, right) = (lerp(ab, bc), lerp(bc, cd));
    (lerp(left, right), (right - left) * 3.0)
}

/// The control values of the cubic's parameter as a function of the piece's: monotone, and at both ends with the rate
/// at which the speeds agree, as far as that is possible.
fn pace(cubic: &[Vec2; 4], piece: &[Vec2; 4], [from, to]: [f64; 2]) -> [f64; 4] {
    let rate = |t: f64, velocity: Vec2| {
        let (_, own) = point_and_velocity(cubic, t);
        velocity.dot(own) / own.length_squared()
    };
    // A third of the derivative; NaN, where the cubic stands still, becomes an even pace.
    let even = (to - from) / 3.0;
    let sane = |step: f64| if step.is_finite() { step.clamp(0.0, 3.0 * even) } else { even };
    let first = sane(rate(from, piece[1] - piece[0]));
    let last = sane(rate(to, piece[3] - piece[2]));
    let excess = ((first + last) / (3.0 * even)).max(1.0);
    let (first, last) = if even > 0.0 { (first / excess, last / excess) } else { (0.0, 0.0) };
    [from, (from + first).min(to), (to - last).max(from), to]
}

/// Control points of `cubic(pace(s)) - piece(s)`, of degree 9.
fn difference(cubic: &[Vec2; 4], pace: &[f64; 4], piece: &[Vec2; 4]) -> [Vec2; 10] {
    let rest = pace.map(|t| 1.0 - t);
    let (qq, rr) = (product33(pace, pace), product33(&rest, &rest));
    let (qqq, qqr) = (product36(pace, &qq), product36(&rest, &qq));
    let (qrr, rrr) = (product36(pace, &rr), product36(&rest, &rr));
    let [a, b, c, d] = *cubic;
    let raised = raised(piece);
    std::array::from_fn(|i| a * rrr[i] + b * (3.0 * qrr[i]) + c * (3.0 * qqr[i]) + d * qqq[i] - raised[i])
}

/// C(3, i) C(3, j) / C(6, i + j).
const BY_3_3: [[f64; 4]; 4] = weights([1.0, 3.0, 3.0, 1.0], [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0]);
/// C(3, i) C(6, j) / C(9, i + j).
const BY_3_6: [[f64; 7]; 4] = weights(
    [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0],
    [1.0, 9.0, 36.0, 84.0, 126.0, 126.0, 84.0, 36.0, 9.0, 1.0],
);

const fn weights<const N: usize, const M: usize>(inner: [f64; N], whole: [f64; M]) -> [[f64; N]; 4] {
    let thirds = [1.0, 3.0, 3.0, 1.0];
    let mut table = [[0.0; N]; 4];
    let mut i = 0;
    while i < 4 {
        let mut j = 0;
        while j < N {
            table[i][j] = thirds[i] * inner[j] / whole[i + j];
            j += 1;
        }
        i += 1;
    }
    table
}

fn product33(a: &[f64; 4], b: &[f64; 4]) -> [f64; 7] {
    let mut product = [0.0; 7];
    for i in 0..4 {
        for j in 0..4 {
            product[i + j] += BY_3_3[i][j] * a[i] * b[j];
        }
    }
    product
}

fn product36(a: &[f64; 4], b: &[f64; 7]) -> [f64; 10] {
    let mut product = [0.0; 10];
    for i in 0..4 {
        for j in 0..7 {
            product[i + j] += BY_3_6[i][j] * a[i] * b[j];
        }
    }
    product
}

/// A cubic written with degree 9: the product with 1.
fn raised(piece: &[Vec2; 4]) -> [Vec2; 10] {
    let mut high = [Vec2::ZERO; 10];
    for i in 0..4 {
        for j in 0..7 {
            high[i + j] += piece[i] * BY_3_6[i][j];
        }
    }
    high
}

/// A bound of the largest norm of a polynomial, sharp or at least within the limit where that is possible; `seen` is a
/// norm that it has.
fn largest(points: &[Vec2; 10], seen: f64, limit: f64, halvings: u32) -> f64 {
    let hull = points.iter().fold(0.0, |most: f64, p| most.max(p.length_squared())).sqrt();
    if hull <= SHARP * seen || halvings == 0 {
        return hull;
    }
    let (left, right) = halves(points);
    let seen = seen.max(right[0].length());
    if seen > limit {
        return hull;
    }
    let first = largest(&left, seen, limit, halvings - 1);
    first.max(largest(&right, seen.max(first / SHARP), limit, halvings - 1))
}

/// Both halves of a curve.
fn halves<P: Blend, const N: usize>(points: &[P; N]) -> ([P; N], [P; N]) {
    let (mut left, mut right) = (*points, *points);
    for (level, point) in left.iter_mut().enumerate().skip(1) {
        for i in 0..N - level {
            right[i] = (right[i] + right[i + 1]) * 0.5;
        }
        *point = right[0];
    }
    (left, right)
}
