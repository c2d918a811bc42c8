//! Parts of one algebraic curve: where they run together, found from their coefficients.
//!
//! Every polynomial curve is `C(p(t))` with a polynomial p and a curve C that is traced once (a straight line, however it
//! is walked, is C of degree 1). Two such C of one algebraic curve differ by a linear change of parameter, which is
//! rational; so everything is compared along the parameter of one C, in fractions. How to find p: Kozen, Landau, Polynomial
//! decomposition algorithms, 1989.

use super::exact::{self, Eliminated, IntegerCurve, Pair};
use super::{Contact, Meeting};
use crate::math::Vec2;
use crate::numeric::integer_polynomial::{Integer, IntegerPolynomial};
use crate::numeric::rational::{Fraction, nearest_f64, parts, rational_root};

/// Coefficients of 1, x, x^2 and so on.
type Polynomial = Vec<Fraction>;

/// A curve as `proper(inner(t))`, `inner` with leading coefficient 1 and no constant.
struct Traced {
    proper: [Polynomial; 2],
    inner: Polynomial,
    pieces: Vec<Piece>,
}

/// A stretch of [0, 1] on which the inner polynomial is monotone, with its values at the ends.
#[derive(Clone)]
struct Piece {
    ends: [Fraction; 2],
    values: [Fraction; 2],
}

/// Where two parts of one algebraic curve run together or meet.
pub(super) fn common(a: &IntegerCurve, b: &IntegerCurve) -> Vec<Meeting> {
    let (a, b) = (Traced::of(a), Traced::of(b));
    let Some((factor, shift)) = linear_change(&a.proper, &b.proper) else { return Vec::new() };
    let back = |v: &Fraction| (v - &shift) / &factor;
    let pieces_b: Vec<Piece> = b
        .pieces
        .iter()
        .map(|piece| Piece { ends: piece.ends.clone(), values: [0, 1].map(|k| back(&piece.values[k])) })
        .collect();
    let mut found = Vec::new();
    for p in &a.pieces {
        for q in &pieces_b {
            shared(
                p,
                q,
                &|u| a.parameter(p, u),
                &|u| b.parameter_of(q, u, &(u * &factor + &shift)),
                &mut found,
            );
        }
    }
    let [low, high] = range(a.pieces.iter().chain(&pieces_b));
    for pair in double_points(&a.proper, &low, &high) {
        for [u, v] in [pair.clone(), [pair[1].clone(), pair[0].clone()]] {
            for p in a.pieces.iter().filter(|p| p.holds(&u)) {
                for q in pieces_b.iter().filter(|q| q.holds(&v)) {
                    let (s, t) = (a.parameter(p, &u), b.parameter_of(q, &v, &(&v * &factor + &shift)));
                    found.push(at([s, s], [t, t], Contact::Crossing));
                }
            }
        }
    }
    without_repeats(found)
}

/// Where a curve that is traced more than once meets itself.
pub(super) fn own(a: &IntegerCurve) -> Vec<Meeting> {
    let a = Traced::of(a);
    let mut found = Vec::new();
    for (i, p) in a.pieces.iter().enumerate() {
        for q in &a.pieces[i + 1..] {
            shared(p, q, &|u| a.parameter(p, u), &|u| a.parameter(q, u), &mut found);
        }
    }
    let [low, high] = range(a.pieces.iter());
    for [u, v] in double_points(&a.proper, &low, &high) {
        for p in a.pieces.iter().filter(|p| p.holds(&u)) {
            for q in a.pieces.iter().filter(|q| q.holds(&v)) {
                let (s, t) = (a.parameter(p, &u), a.parameter(q, &v));
                found.push(at([s.min(t); 2], [s.max(t); 2], Contact::Crossing));
            }
        }
    }
    // Turns, where a piece meets its neighbour, are no meetings.
    found.retain(|m| m.first != m.second || m.first[0] != m.first[1]);
    without_repeats(found)
}

fn at(first: [f64; 2], second: [f64; 2], contact: Contact) -> Meeting {
    Meeting { first, second, point: Vec2::ZERO, contact }
}

/// Adds what two pieces have in common.
fn shared(
    p: &Piece,
    q: &Piece,
    first: &dyn Fn(&Fraction) -> f64,
    second: &dyn Fn(&Fraction) -> f64,
    found: &mut Vec<Meeting>,
) {
    let ([p_low, p_high], [q_low, q_high]) = (range([p].into_iter()), range([q].into_iter()));
    let (low, high) = (p_low.max(q_low), p_high.min(q_high));
    if low > high {
        return;
    }
    let (mut from, mut to) = ((first(&low), second(&low)), (first(&high), second(&high)));
    if from.0 > to.0 {
        std::mem::swap(&mut from, &mut to);
    }
    let contact = if low == high { Contact::Tangency { multiplicity: 2 } } else { Contact::Overlap };
    found.push(at([from.0, to.0], [from.1, to.1], contact));
}

/// Single points that are ends of overlaps, and second reports, left out.
fn without_repeats(found: Vec<Meeting>) -> Vec<Meeting> {
    let mut kept: Vec<Meeting> = Vec::new();
    let (overlaps, points): (Vec<_>, Vec<_>) = found.into_iter().partition(|m| m.contact == Contact::Overlap);
    for meeting in overlaps.into_iter().chain(points) {
        let ends = |m: &Meeting| [0, 1].map(|k| (m.first[k], m.second[k]));
        let [from, to] = ends(&meeting);
        let known = |other: &Meeting| ends(other).contains(&from) && ends(other).contains(&to);
        if !kept.iter().any(known) {
            kept.push(meeting);
        }
    }
    kept
}

/// The smallest and largest value of pieces.
fn range<'a>(pieces: impl Iterator<Item = &'a Piece>) -> [Fraction; 2] {
    let mut values: Vec<&Fraction> = pieces.flat_map(|piece| &piece.values).collect();
    values.sort();
    [values[0].clone(), values[values.len() - 1].clone()]
}

impl Piece {
    fn holds(&self, value: &Fraction) -> bool {
        let [low, high] = range([self].into_iter());
        low <= *value && *value <= high
    }
}

impl Traced {
    fn of(curve: &IntegerCurve) -> Traced {
        let n = curve.degree();
        let axes = [0, 1].map(|axis| {
            curve.coefficients.iter().map(|c| Fraction::from(c[axis].clone())).collect::<Polynomial>()
        });
        let leading = usize::from(axes[0][n] == Fraction::ZERO);
        let divisors = (1..=n).rev().filter(|r| n.is_multiple_of(*r));
        let candidates = divisors.map(|r| inner_candidate(&axes[leading], r));
        let decomposed = candidates.filter_map(|inner| {
            let digits = [0, 1].map(|axis| digits(&axes[axis], &inner));
            let [Some(x), Some(y)] = digits else { return None };
            Some((inner, [x, y]))
        });
        // The last divisor, 1, leaves every curve as it is.
        let identity = || (vec![Fraction::ZERO, Fraction::ONE], axes.clone());
        let (inner, proper) = decomposed.into_iter().next().unwrap_or_else(identity);
        let pieces = monotone_pieces(&inner);
        Traced { proper, inner, pieces }
    }

    /// The parameter at which the inner polynomial has a value on a piece.
    fn parameter(&self, piece: &Piece, value: &Fraction) -> f64 {
        self.parameter_of(piece, value, value)
    }

    /// The same where the piece's values are told in another parameter than the polynomial's own.
    fn parameter_of(&self, piece: &Piece, value: &Fraction, own_value: &Fraction) -> f64 {
        if let Some(k) = (0..2).find(|&k| piece.values[k] == *value) {
            return nearest_f64(&piece.ends[k]);
        }
        if self.inner.len() == 2 {
            return nearest_f64(own_value);
        }
        let [mut low, mut high] = piece.ends.clone();
        let rises = evaluate(&self.inner, &high) > evaluate(&self.inner, &low);
        // 64 halvings leave less than rounding.
        for _ in 0..64 {
            let middle = (&low + &high) / Fraction::from(2);
            if (evaluate(&self.inner, &middle) > *own_value) == rises { high = middle } else { low = middle }
        }
        nearest_f64(&low)
    }
}

fn evaluate(p: &[Fraction], x: &Fraction) -> Fraction {
    p.iter().rev().fold(Fraction::ZERO, |sum, c| sum * x + c)
}

/// The only polynomial of degree r, with leading coefficient 1 and no constant, that `f` can be one in: the highest
/// coefficients of `f` are those of its power, so it is a root of a power series.
fn inner_candidate(f: &[Fraction], r: usize) -> Polynomial {
    let n = f.len() - 1;
    let exponent = Fraction::ONE / Fraction::from(n / r);
    let series = |i: usize| &f[n - i] / &f[n];
    let mut root = vec![Fraction::ONE];
    for j in 1..r {
        let term =
            |i: usize| (&exponent * Fraction::from(i) - Fraction::from(j - i)) * series(i) * &root[j - i];
        let sum = (1..=j).fold(Fraction::ZERO, |sum, i| sum + term(i));
        root.push(sum / Fraction::from(j));
    }
    let mut inner = vec![Fraction::ZERO];
    inner.extend(root.into_iter().rev());
    inner
}

/// Coefficients c of `f = c_0 + c_1 p + c_2 p^2 ...`; `None` where they would not be constants.
fn digits(f: &[Fraction], p: &[Fraction]) -> Option<Polynomial> {
    let r = p.len() - 1;
    let mut rest = f.to_vec();
    let mut digits = Vec::new();
    while rest.len() > r {
        let mut quotient = vec![Fraction::ZERO; rest.len() - r];
        for shift in (0..quotient.len()).rev() {
            let top = rest[shift + r].clone();
            for (k, c) in p.iter().enumerate() {
                rest[shift + k] = &rest[shift + k] - &top * c;
            }
            quotient[shift] = top;
        }
        digits.push(constant(&rest)?);
        rest = quotient;
    }
    digits.push(constant(&rest)?);
    Some(digits)
}

fn constant(p: &[Fraction]) -> Option<Fraction> {
    p[1..].iter().all(|c| *c == Fraction::ZERO).then(|| p[0].clone())
}

fn monotone_pieces(inner: &[Fraction]) -> Vec<Piece> {
    let mut cuts = vec![Fraction::ZERO];
    if inner.len() > 2 {
        let slope = integer_polynomial(inner).derivative();
        for root in slope.roots_in_unit(128) {
            let cut = Fraction::from_parts_signed(root.floor, Integer::ONE << root.bits);
            if cut > Fraction::ZERO && cut < Fraction::ONE && root.multiplicity % 2 == 1 {
                cuts.push(cut);
            }
        }
    }
    cuts.push(Fraction::ONE);
    let piece = |pair: &[Fraction]| {
        let ends = [pair[0].clone(), pair[1].clone()];
        Piece { values: [evaluate(inner, &ends[0]), evaluate(inner, &ends[1])], ends }
    };
    cuts.windows(2).map(piece).collect()
}

/// The polynomial times a common denominator.
fn integer_polynomial(p: &[Fraction]) -> IntegerPolynomial {
    let common = p.iter().fold(Integer::ONE, |common, c| common * parts(c).1);
    let whole = p.iter().map(|c| {
        let (up, down) = parts(c);
        up * (&common / down)
    });
    IntegerPolynomial::new(whole.collect())
}

/// Factor and shift with `a(u) = b(factor u + shift)`.
fn linear_change(a: &[Polynomial; 2], b: &[Polynomial; 2]) -> Option<(Fraction, Fraction)> {
    let k = a[0].len().max(a[1].len()) - 1;
    let coefficient = |p: &Polynomial, i: usize| p.get(i).cloned().unwrap_or(Fraction::ZERO);
    let axis = (0..2).find(|&axis| coefficient(&b[axis], k) != Fraction::ZERO)?;
    let (a_top, b_top) = (coefficient(&a[axis], k), coefficient(&b[axis], k));
    let root = rational_root(&(a_top / &b_top), k)?;
    let factors = if k.is_multiple_of(2) { vec![root.clone(), -root] } else { vec![root] };
    factors.into_iter().filter(|factor| *factor != Fraction::ZERO).find_map(|factor| {
        let power = (1..k).fold(Fraction::ONE, |product, _| product * &factor);
        let next = coefficient(&a[axis], k - 1) / power - coefficient(&b[axis], k - 1);
        let shift = next / (&b_top * Fraction::from(k));
        let same = (0..2).all(|axis| {
            let moved = substituted(&b[axis], &factor, &shift);
            (0..=k).all(|i| coefficient(&moved, i) == coefficient(&a[axis], i))
        });
        same.then_some((factor, shift))
    })
}

/// `p(factor x + shift)`.
fn substituted(p: &[Fraction], factor: &Fraction, shift: &Fraction) -> Polynomial {
    let mut result: Polynomial = Vec::new();
    for c in p.iter().rev() {
        let mut next = vec![Fraction::ZERO; result.len() + 1];
        for (i, value) in result.iter().enumerate() {
            next[i] = &next[i] + value * shift;
            next[i + 1] = &next[i + 1] + value * factor;
        }
        next[0] = &next[0] + c;
        result = next;
    }
    result
}

/// Pairs of parameters between two values at which a properly traced curve crosses itself.
fn double_points(proper: &[Polynomial; 2], low: &Fraction, high: &Fraction) -> Vec<[Fraction; 2]> {
    let width = high - low;
    let k = proper[0].len().max(proper[1].len()) - 1;
    if k < 3 || (k - 1).pow(2) > exact::MAX_ELIMINATED || width == Fraction::ZERO {
        return Vec::new();
    }
    let both = [0, 1].map(|axis| substituted(&proper[axis], &width, low));
    let common = both.iter().flatten().fold(Integer::ONE, |common, c| common * parts(c).1);
    let whole = |axis: usize, i: usize| match both[axis].get(i) {
        Some(c) => {
            let (up, down) = parts(c);
            up * (&common / down)
        }
        None => Integer::ZERO,
    };
    let curve = IntegerCurve { coefficients: (0..=k).map(|i| [whole(0, i), whole(1, i)]).collect() };
    let Eliminated::Pairs(pairs) = exact::own_meetings(&curve) else { return Vec::new() };
    let outward = |x: f64| Fraction::try_from(x).map_or(Fraction::ZERO, |x| low + x * &width);
    pairs.iter().map(|Pair { s, t, .. }| [outward(*s), outward(*t)]).collect()
}
