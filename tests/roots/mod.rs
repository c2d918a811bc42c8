//! Real roots of integer polynomials by Sturm's theorem, and meetings of plane curves by Sylvester's resultant: slow,
//! exact, and with no code in common with the library.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Coefficients of 1, x, x^2 and so on, the last one not zero.
pub(crate) type Polynomial = Vec<BigInt>;

/// An isolated root: above `low` / 2^bits by less than 2^-bits, or equal to it.
#[derive(Clone, Debug)]
pub(crate) struct Root {
    pub(crate) low: BigInt,
    pub(crate) multiplicity: usize,
}

/// Bits behind the point to which roots are known.
pub(crate) const BITS: usize = 160;

impl Root {
    pub(crate) fn to_f64(&self) -> f64 {
        BigRational::new(self.low.clone(), BigInt::one() << BITS).to_f64().expect("finite")
    }
}

pub(crate) fn trimmed(mut p: Polynomial) -> Polynomial {
    while p.last().is_some_and(Zero::is_zero) {
        p.pop();
    }
    p
}

/// Integers that are the numbers times one power of two, the exponent of which is returned.
pub(crate) fn integers(numbers: &[f64]) -> (Vec<BigInt>, i32) {
    let exact: Vec<BigRational> =
        numbers.iter().map(|&x| BigRational::from_float(x).expect("finite")).collect();
    let bits = exact.iter().map(|x| x.denom().bits() - 1).max().unwrap_or(0);
    let whole = exact.iter().map(|x| (x * BigRational::from_integer(BigInt::one() << bits)).to_integer());
    (whole.collect(), -(bits as i32))
}

/// Coefficients of 1, t, t^2 of a curve from one coordinate of its control points.
pub(crate) fn monomials(control: &[BigInt]) -> Vec<BigInt> {
    let n = control.len() - 1;
    let choose = |n: usize, k: usize| (0..k).fold(BigInt::one(), |c, i| c * (n - i) / (i + 1));
    let coefficient = |j: usize| {
        let term = |i: usize| {
            let sign = if (j - i).is_multiple_of(2) { 1 } else { -1 };
            choose(j, i) * sign * &control[i]
        };
        choose(n, j) * (0..=j).map(term).sum::<BigInt>()
    };
    (0..=n).map(coefficient).collect()
}

fn primitive(p: &Polynomial) -> Polynomial {
    let divisor = p.iter().fold(BigInt::zero(), |a, b| common_divisor(&a, b));
    if divisor.is_zero() { p.clone() } else { p.iter().map(|c| c / &divisor).collect() }
}

/// By the reduction of fractions.
fn common_divisor(a: &BigInt, b: &BigInt) -> BigInt {
    if b.is_zero() { a.abs() } else { (b / BigRational::new(a.clone(), b.clone()).denom()).abs() }
}

fn derivative(p: &Polynomial) -> Polynomial {
    trimmed(p.iter().enumerate().skip(1).map(|(k, c)| c * k).collect())
}

/// The remainder times a positive constant.
fn remainder(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut rest = a.clone();
    let leading = &b[b.len() - 1];
    while rest.len() >= b.len() {
        let top = rest[rest.len() - 1].clone();
        let shift = rest.len() - b.len();
        for c in &mut rest {
            *c = &*c * leading.abs();
        }
        for (k, c) in b.iter().enumerate() {
            rest[shift + k] -= &top * c * leading.signum();
        }
        rest = trimmed(rest);
    }
    primitive(&rest)
}

fn gcd(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let (mut a, mut b) = (a.clone(), b.clone());
    while !b.is_empty() {
        let rest = remainder(&a, &b);
        (a, b) = (b, rest);
    }
    primitive(&a)
}

fn quotient(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let rational =
        |p: &Polynomial| p.iter().map(|c| BigRational::from_integer(c.clone())).collect::<Vec<_>>();
    let (mut rest, b) = (rational(a), rational(b));
    let mut result = vec![BigRational::zero(); a.len() + 1 - b.len()];
    for shift in (0..result.len()).rev() {
        let factor = &rest[shift + b.len() - 1] / &b[b.len() - 1];
        for (k, c) in b.iter().enumerate() {
            rest[shift + k] -= &factor * c;
        }
        result[shift] = factor;
    }
    let common = result.iter().fold(BigInt::one(), |d, c| d * c.denom());
    primitive(&result.iter().map(|c| (c * BigRational::from_integer(common.clone())).to_integer()).collect())
}

/// Sign at `x` / 2^bits.
fn sign(p: &Polynomial, x: &BigInt, bits: usize) -> i32 {
    let value = p.iter().rev().enumerate().fold(BigInt::zero(), |sum, (k, c)| sum * x + (c << (k * bits)));
    value.signum().to_i32().expect("small")
}

struct Sturm(Vec<Polynomial>);

impl Sturm {
    fn of(p: &Polynomial) -> Sturm {
        let mut chain = vec![p.clone(), derivative(p)];
        while chain[chain.len() - 1].len() > 1 {
            let next = remainder(&chain[chain.len() - 2], &chain[chain.len() - 1]);
            chain.push(next.into_iter().map(|c| -c).collect());
        }
        chain.retain(|p| !p.is_empty());
        Sturm(chain)
    }

    fn changes(&self, x: &BigInt, bits: usize) -> usize {
        let signs: Vec<i32> = self.0.iter().map(|p| sign(p, x, bits)).filter(|&s| s != 0).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }

    /// Roots above `low` up to `low + 1`, both over 2^bits.
    fn isolate(&self, low: &BigInt, bits: usize, found: &mut Vec<BigInt>) {
        let count = self.changes(low, bits) - self.changes(&(low + 1), bits);
        if count == 0 {
            return;
        }
        if count == 1 {
            return found.push(self.bisected(low.clone(), bits));
        }
        assert!(bits < BITS, "roots nearer to one another than 2^-{BITS}");
        let low = low << 1;
        self.isolate(&low, bits + 1, found);
        self.isolate(&(low + 1), bits + 1, found);
    }

    /// The one root above `low` up to `low + 1`, to all bits.
    fn bisected(&self, mut low: BigInt, bits: usize) -> BigInt {
        let p = &self.0[0];
        if sign(p, &(&low + 1), bits) == 0 {
            return (low + 1) << (BITS - bits);
        }
        let above = sign(p, &(&low + 1), bits);
        for bits in bits + 1..=BITS {
            low <<= 1;
            let middle: BigInt = &low + 1;
            match sign(p, &middle, bits) {
                0 => return middle << (BITS - bits),
                side if side != above => low = middle,
                _ => {}
            }
        }
        low
    }
}

/// The roots in [0, 1] of a polynomial that is not zero, with multiplicities, ascending.
pub(crate) fn roots(p: &Polynomial) -> Vec<Root> {
    let mut found = Vec::new();
    let mut rest = primitive(p);
    let mut factors = Vec::new();
    // Each step takes one of every root away.
    while rest.len() > 1 {
        let common = gcd(&rest, &derivative(&rest));
        factors.push(quotient(&rest, &common));
        rest = common;
    }
    for (index, factor) in factors.iter().enumerate() {
        // What has multiplicity `index + 1` exactly is no root of the next one.
        let own = match factors.get(index + 1) {
            Some(next) => quotient(factor, next),
            None => factor.clone(),
        };
        if own.len() <= 1 {
            continue;
        }
        let multiplicity = index + 1;
        if own[0].is_zero() {
            found.push(Root { low: BigInt::zero(), multiplicity });
        }
        let mut isolated = Vec::new();
        Sturm::of(&own).isolate(&BigInt::zero(), 0, &mut isolated);
        found.extend(isolated.into_iter().map(|low| Root { low, multiplicity }));
    }
    found.sort_by(|a, b| a.low.cmp(&b.low));
    found
}

/// The value at a root's lower end, times 2^BITS, rounded.
pub(crate) fn value(p: &Polynomial, x: &BigInt) -> BigInt {
    p.iter().rev().fold(BigInt::zero(), |sum, c| ((sum * x) >> BITS) + (c << BITS))
}

/// The determinant by fraction-free elimination.
fn determinant(mut m: Vec<Vec<BigInt>>) -> BigInt {
    let (n, mut before, mut sign) = (m.len(), BigInt::one(), 1);
    for k in 0..n - 1 {
        let Some(pivot) = (k..n).find(|&i| !m[i][k].is_zero()) else { return BigInt::zero() };
        if pivot != k {
            m.swap(pivot, k);
            sign = -sign;
        }
        for i in k + 1..n {
            for j in k + 1..n {
                m[i][j] = (&m[i][j] * &m[k][k] - &m[i][k] * &m[k][j]) / &before;
            }
        }
        before = m[k][k].clone();
    }
    sign * &m[n - 1][n - 1]
}

/// Sylvester's resultant.
fn resultant(p: &[BigInt], q: &[BigInt]) -> BigInt {
    let (n, m) = (p.len() - 1, q.len() - 1);
    let mut matrix = vec![vec![BigInt::zero(); n + m]; n + m];
    for row in 0..m {
        p.iter().rev().enumerate().for_each(|(k, c)| matrix[row][row + k] = c.clone());
    }
    for row in 0..n {
        q.iter().rev().enumerate().for_each(|(k, c)| matrix[m + row][row + k] = c.clone());
    }
    determinant(matrix)
}

/// A plane curve by coefficients of 1, t, t^2 and so on.
pub(crate) type Curve = [Vec<BigInt>; 2];

/// A polynomial in the parameter of `along` whose roots are where its points are on `curve`: the resultant of the two
/// equations, turned by (2, 1; 1, 1) so that both have the full degree, through its values at small integers.
pub(crate) fn eliminated(along: &Curve, curve: &Curve) -> Polynomial {
    let degree =
        |c: &Curve| c.iter().map(|axis| trimmed(axis.clone()).len()).max().unwrap_or(0).saturating_sub(1);
    let (n, m) = (degree(along), degree(curve));
    let turned = |c: &Curve| -> Curve {
        let of = |f: i32| c[0].iter().zip(&c[1]).map(|(x, y)| x * f + y).collect::<Vec<_>>();
        [of(2), of(1)]
    };
    let (along, curve) = (turned(along), turned(curve));
    let values: Vec<BigInt> = (0..=n * m)
        .map(|s| {
            let rows = [0, 1].map(|axis| {
                let at = along[axis].iter().rev().fold(BigInt::zero(), |sum, c| sum * s + c);
                let mut row = curve[axis][..=m].to_vec();
                row[0] -= at;
                row
            });
            resultant(&rows[0], &rows[1])
        })
        .collect();
    interpolated(&values)
}

/// A polynomial whose roots are the parameters at which a curve is where it is at another one too, and those of its cusps:
/// the resultant of both coordinates' divided differences, turned as above.
pub(crate) fn own_eliminated(curve: &Curve) -> Polynomial {
    let n = curve.iter().map(|axis| trimmed(axis.clone()).len()).max().unwrap_or(0).saturating_sub(1);
    if n < 2 {
        return vec![BigInt::one()];
    }
    let of = |f: i32| curve[0].iter().zip(&curve[1]).map(|(x, y)| x * f + y).collect::<Vec<_>>();
    let turned = [of(2), of(1)];
    let values: Vec<BigInt> = (0..=(n - 1) * (n - 1))
        .map(|s| {
            let rows = [0, 1].map(|axis: usize| {
                let coefficient = |k: usize| {
                    turned[axis][k + 1..=n].iter().rev().fold(BigInt::zero(), |sum, c| sum * s + c)
                };
                (0..n).map(coefficient).collect::<Vec<_>>()
            });
            resultant(&rows[0], &rows[1])
        })
        .collect();
    interpolated(&values)
}

/// Lagrange's polynomial through values at 0, 1, 2 and so on, times a constant.
fn interpolated(values: &[BigInt]) -> Polynomial {
    let count = values.len();
    let mut sum = vec![BigRational::zero(); count];
    for (i, value) in values.iter().enumerate() {
        let mut basis = vec![BigRational::one()];
        let mut scale = BigRational::from_integer(value.clone());
        for j in (0..count).filter(|&j| j != i) {
            basis.push(BigRational::zero());
            for k in (0..basis.len()).rev() {
                let below = if k > 0 { basis[k - 1].clone() } else { BigRational::zero() };
                basis[k] = below - &basis[k] * BigRational::from_integer(j.into());
            }
            scale /= BigRational::from_integer(BigInt::from(i) - BigInt::from(j));
        }
        for (total, c) in sum.iter_mut().zip(&basis) {
            *total += c * &scale;
        }
    }
    let common = sum.iter().fold(BigInt::one(), |d, c| d * c.denom());
    primitive(&trimmed(
        sum.iter().map(|c| (c * BigRational::from_integer(common.clone())).to_integer()).collect(),
    ))
}
