//! Meetings of polynomial curves by elimination, in integers of any size: what rounding leaves open is decided here.
//!
//! Control points are integers times a power of two. Bézout's determinant of `x(t) - X` and `y(t) - Y` vanishes where
//! (X, Y) is on the curve; along the other curve it is a polynomial in that one's parameter, found from its values at
//! 0, 1, 2 and so on, and its roots with their multiplicities are exact (Sederberg, Anderson, Goldman, Implicit
//! representation of parametric curves and surfaces, 1984).

use crate::math::Vec2;
use crate::numeric::integer_polynomial::{DyadicRoot, Integer, IntegerPolynomial, bit_length, sign};

/// The largest degree of an eliminated polynomial: the cost grows with its fourth power, to about a second here.
pub(super) const MAX_ELIMINATED: usize = 100;

/// Roots are known to so many bits; points that differ by less than their worth are the same point. Points of curves
/// with `f64` control points that are not the same have no reason to come so near, while both are roots exactly.
const BITS: usize = 128;

/// A pair of parameters of one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) s: f64,
    pub(super) t: f64,
    /// 1 for a crossing at an angle.
    pub(super) multiplicity: usize,
}

/// What elimination finds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Eliminated {
    /// These meetings and no others.
    Pairs(Vec<Pair>),
    /// Both are parts of one algebraic curve, or one curve is traced more than once.
    SameCurve,
}

/// A plane curve with integer coefficients of 1, t, t^2 and so on; the last one is not zero in both coordinates, unless
/// it is the only one.
#[derive(Clone, Debug)]
pub(super) struct IntegerCurve {
    pub(super) coefficients: Vec<[Integer; 2]>,
}

impl IntegerCurve {
    /// The curves, all times the same power of two.
    pub(super) fn of<const N: usize>(curves: [&[Vec2]; N]) -> [IntegerCurve; N] {
        let numbers = curves.iter().flat_map(|points| points.iter()).flat_map(|p| [p.x, p.y]);
        let least = numbers.filter(|&x| x != 0.0).map(|x| decoded(x).1).min().unwrap_or(0);
        let integer = |x: f64| {
            let (mantissa, exponent) = decoded(x);
            if mantissa == 0 { Integer::ZERO } else { Integer::from(mantissa) << (exponent - least) as usize }
        };
        curves.map(|points| {
            IntegerCurve::from_control(points.iter().map(|p| [integer(p.x), integer(p.y)]).collect())
        })
    }

    fn from_control(mut row: Vec<[Integer; 2]>) -> IntegerCurve {
        let n = row.len() - 1;
        for order in 1..=n {
            for i in (order..=n).rev() {
                row[i] = [0, 1].map(|axis| &row[i][axis] - &row[i - 1][axis]);
            }
        }
        let mut binomial = Integer::ONE;
        for (k, value) in row.iter_mut().enumerate() {
            for x in value {
                *x *= &binomial;
            }
            binomial = binomial * (n - k) / (k + 1);
        }
        while row.len() > 1 && row[row.len() - 1].iter().all(Integer::is_zero) {
            row.pop();
        }
        IntegerCurve { coefficients: row }
    }

    pub(super) fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    fn at_integer(&self, s: usize) -> [Integer; 2] {
        [0, 1].map(|axis| self.coefficients.iter().rev().fold(Integer::ZERO, |sum, c| sum * s + &c[axis]))
    }

    /// The point at a dyadic number below 2, and the derivative, times 2^BITS and rounded.
    fn near(&self, root: &DyadicRoot) -> [[Integer; 2]; 2] {
        let both = [0, 1].map(|axis| {
            let (mut value, mut slope) = (Integer::ZERO, Integer::ZERO);
            for c in self.coefficients.iter().rev() {
                slope = ((slope * &root.floor) >> root.bits) + &value;
                value = ((value * &root.floor) >> root.bits) + (&c[axis] << BITS);
            }
            [value, slope]
        });
        let [[x, u], [y, v]] = both;
        [[x, y], [u, v]]
    }

    /// How far a number of [`IntegerCurve::near`] may be off: the rest of the root times the next derivative, and
    /// roundings; both are less than the sum of coefficients times the square of the degree plus two.
    fn slack(&self) -> Integer {
        let sum = self.coefficients.iter().flatten().fold(Integer::ONE, |sum, c| {
            let magnitude = if sign(c) < 0 { -c.clone() } else { c.clone() };
            sum + magnitude
        });
        let n = self.coefficients.len() + 1;
        sum * (n * n * n)
    }
}

/// Mantissa and exponent.
fn decoded(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let magnitude = if exponent == 0 { fraction } else { fraction | (1 << 52) };
    let zeros = if magnitude == 0 { 0 } else { magnitude.trailing_zeros() };
    let signed = if x < 0.0 { -magnitude } else { magnitude };
    (signed >> zeros, exponent.max(1) - 1075 + zeros as i32)
}

/// The nearest `f64` of a root.
pub(super) fn nearest_f64(root: &DyadicRoot) -> f64 {
    // 64 leading bits are plenty; what they leave out is below the rounding.
    let cut = bit_length(&root.floor).saturating_sub(64);
    let leading = u64::try_from(&root.floor >> cut).unwrap_or(0);
    crate::numeric::scale_by_power_of_two(leading as f64, cut as i32 - root.bits as i32)
}

/// The meetings of two curves that are no points.
pub(super) fn meetings(a: &IntegerCurve, b: &IntegerCurve) -> Eliminated {
    let (on_a, on_b) = (eliminated(a, b), eliminated(b, a));
    if on_a.is_zero() || on_b.is_zero() {
        return Eliminated::SameCurve;
    }
    let (roots_a, roots_b) = (on_a.roots_in_unit(BITS), on_b.roots_in_unit(BITS));
    let mut pairs = Vec::new();
    let limit = a.slack() + b.slack();
    let near_b: Vec<_> = roots_b.iter().map(|root| b.near(root)).collect();
    for s in &roots_a {
        let near_a = a.near(s);
        for (t, near_b) in roots_b.iter().zip(&near_b) {
            if are_near(&near_a[0], &near_b[0], &limit) {
                let multiplicity = s.multiplicity.min(t.multiplicity);
                let multiplicity =
                    if are_parallel(&near_a[1], &near_b[1], &limit) { multiplicity } else { 1 };
                pairs.push(Pair { s: nearest_f64(s), t: nearest_f64(t), multiplicity });
            }
        }
    }
    Eliminated::Pairs(pairs)
}

/// The meetings of two curves of which at least one is a point, whose parameter is then 0.
pub(super) fn meetings_of_point(a: &IntegerCurve, b: &IntegerCurve) -> Vec<Pair> {
    let a_is_point = a.degree() == 0;
    let (point, curve) = if a_is_point { (a, b) } else { (b, a) };
    let [x, y] = [0, 1].map(|axis| {
        let mut row: Vec<Integer> = curve.coefficients.iter().map(|c| c[axis].clone()).collect();
        row[0] -= &point.coefficients[0][axis];
        IntegerPolynomial::new(row)
    });
    let both = x.common_divisor(&y);
    let parameters = if both.is_zero() {
        vec![(0.0, 1)]
    } else {
        both.roots_in_unit(BITS).iter().map(|root| (nearest_f64(root), root.multiplicity)).collect()
    };
    let pair = |(t, multiplicity): (f64, usize)| {
        let (s, t) = if a_is_point { (0.0, t) } else { (t, 0.0) };
        Pair { s, t, multiplicity }
    };
    parameters.into_iter().map(pair).collect()
}

/// The meetings of a curve with itself at different parameters, the smaller one first.
pub(super) fn own_meetings(a: &IntegerCurve) -> Eliminated {
    if a.degree() < 2 {
        return Eliminated::Pairs(Vec::new());
    }
    let values = (0..=(a.degree() - 1).pow(2)).map(|s| {
        let [p, q] = [0, 1].map(|axis| divided_difference(a, axis, s));
        bezout_determinant(&p, &q)
    });
    let eliminated = IntegerPolynomial::through(values.collect());
    if eliminated.is_zero() {
        return Eliminated::SameCurve;
    }
    let roots = eliminated.roots_in_unit(BITS);
    let near: Vec<_> = roots.iter().map(|root| a.near(root)).collect();
    let limit = a.slack() * 2;
    let mut pairs = Vec::new();
    for i in 0..roots.len() {
        for j in i + 1..roots.len() {
            if are_near(&near[i][0], &near[j][0], &limit) {
                let multiplicity = roots[i].multiplicity.min(roots[j].multiplicity);
                let multiplicity =
                    if are_parallel(&near[i][1], &near[j][1], &limit) { multiplicity } else { 1 };
                let [s, t] = [i, j].map(|k| nearest_f64(&roots[k]));
                pairs.push(Pair { s, t, multiplicity });
            }
        }
    }
    Eliminated::Pairs(pairs)
}

fn are_near(p: &[Integer; 2], q: &[Integer; 2], limit: &Integer) -> bool {
    (0..2).all(|axis| {
        let off = &p[axis] - &q[axis];
        off <= *limit && -off <= *limit
    })
}

/// Whether the cross product of two derivatives cannot be told from zero.
fn are_parallel(v: &[Integer; 2], w: &[Integer; 2], limit: &Integer) -> bool {
    let cross = &v[0] * &w[1] - &v[1] * &w[0];
    let size = [v, w].into_iter().flatten().map(bit_length).max().unwrap_or(0);
    // Each of two products is off by the limit times the other factor, twice.
    bit_length(&cross) <= bit_length(limit) + size + 3
}

/// The polynomial in the parameter of `along` that vanishes where its point is on `curve`.
fn eliminated(along: &IntegerCurve, curve: &IntegerCurve) -> IntegerPolynomial {
    let values = (0..=along.degree() * curve.degree()).map(|s| {
        let point = along.at_integer(s);
        let [p, q] = [0, 1].map(|axis| {
            let mut row: Vec<Integer> = curve.coefficients.iter().map(|c| c[axis].clone()).collect();
            row[0] -= &point[axis];
            row
        });
        bezout_determinant(&p, &q)
    });
    IntegerPolynomial::through(values.collect())
}

/// Coefficients by powers of t of `(x(t) - x(s)) / (t - s)`.
fn divided_difference(a: &IntegerCurve, axis: usize, s: usize) -> Vec<Integer> {
    let mut row = vec![Integer::ZERO; a.degree()];
    let mut sum = Integer::ZERO;
    for k in (0..a.degree()).rev() {
        sum = sum * s + &a.coefficients[k + 1][axis];
        row[k] = sum.clone();
    }
    row
}

/// The determinant of Bézout's matrix of two polynomials written with the same degree: zero where they have a common
/// root (or both a leading zero).
fn bezout_determinant(p: &[Integer], q: &[Integer]) -> Integer {
    let n = p.len() - 1;
    let minor = |i: usize, j: usize| &p[i] * &q[j] - &p[j] * &q[i];
    let mut matrix = vec![vec![Integer::ZERO; n]; n];
    for i in 0..n {
        for j in i..n {
            let above = if i > 0 && j + 1 < n { matrix[i - 1][j + 1].clone() } else { Integer::ZERO };
            let entry = above + minor(j + 1, i);
            matrix[i][j] = entry.clone();
            matrix[j][i] = entry;
        }
    }
    determinant(matrix)
}

/// Fraction-free elimination (Bareiss 1968).
fn determinant(mut m: Vec<Vec<Integer>>) -> Integer {
    let n = m.len();
    let (mut before, mut negative) = (Integer::ONE, false);
    for k in 0..n.saturating_sub(1) {
        let Some(pivot) = (k..n).find(|&i| !m[i][k].is_zero()) else { return Integer::ZERO };
        if pivot != k {
            m.swap(pivot, k);
            negative = !negative;
        }
        for i in k + 1..n {
            for j in k + 1..n {
                m[i][j] = (&m[i][j] * &m[k][k] - &m[i][k] * &m[k][j]) / &before;
            }
        }
        before = m[k][k].clone();
    }
    let last = if n == 0 { Integer::ONE } else { m[n - 1][n - 1].clone() };
    if negative { -last } else { last }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curves<const N: usize>(points: [&[(f64, f64)]; N]) -> [IntegerCurve; N] {
        let points = points.map(|row| row.iter().map(|&p| Vec2::from(p)).collect::<Vec<_>>());
        IntegerCurve::of(std::array::from_fn(|k| &points[k][..]))
    }

    #[test]
    fn parabolas_touch_with_their_multiplicity() {
        // y = x^2 against y = 0, y = -x^2, y = 1/4 and itself.
        let [up, flat, down, across, same] = curves([
            &[(-1.0, 1.0), (0.0, -1.0), (1.0, 1.0)],
            &[(-1.0, 0.0), (1.0, 0.0)],
            &[(-1.0, -1.0), (0.0, 1.0), (1.0, -1.0)],
            &[(-1.0, 0.25), (1.0, 0.25)],
            &[(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)],
        ]);
        let double = Eliminated::Pairs(vec![Pair { s: 0.5, t: 0.5, multiplicity: 2 }]);
        assert_eq!(meetings(&up, &flat), double);
        assert_eq!(meetings(&up, &down), double);
        let two = [0.25, 0.75].map(|s| Pair { s, t: s, multiplicity: 1 });
        assert_eq!(meetings(&up, &across), Eliminated::Pairs(two.to_vec()));
        assert_eq!(meetings(&up, &same), Eliminated::SameCurve);
    }

    #[test]
    fn a_loop_and_a_line_through_its_double_point() {
        let [looped, line] = curves([
            &[(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)],
            &[(0.0, 0.0), (100.0, 0.0)],
        ]);
        let Eliminated::Pairs(own) = own_meetings(&looped) else { panic!() };
        assert!(own.len() == 1 && (own[0].s - 0.17267316464601143).abs() < 1e-16 && own[0].multiplicity == 1);
        let Eliminated::Pairs(found) = meetings(&looped, &line) else { panic!() };
        assert_eq!(found.iter().map(|pair| (pair.s, pair.t)).collect::<Vec<_>>(), [(0.0, 0.0), (1.0, 1.0)]);
    }

    #[test]
    fn numbers_of_every_size() {
        for scale in [1e-320, 1e-30, 1e300] {
            let [up, flat] =
                curves([&[(-scale, scale), (0.0, -scale), (scale, scale)], &[(-scale, 0.0), (scale, 0.0)]]);
            assert_eq!(
                meetings(&up, &flat),
                Eliminated::Pairs(vec![Pair { s: 0.5, t: 0.5, multiplicity: 2 }])
            );
        }
    }
}
