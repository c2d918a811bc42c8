//! Polynomials with integer coefficients of any size: common divisors, multiplicities, and roots in [0, 1], all exact.
//!
//! Multiplicities by Yun's square-free decomposition (1976), after a look modulo a prime that settles the common case;
//! roots isolated by Descartes' rule and bisection (Collins, Akritas 1976).

use dashu_int::ops::{Gcd, UnsignedAbs};
use dashu_int::{IBig, Sign};

/// Integers of any size.
pub type Integer = IBig;

/// A polynomial with integer coefficients; constants of zero have none.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegerPolynomial {
    /// Of 1, x, x^2 and so on, the last one not zero.
    coefficients: Vec<Integer>,
}

/// A real root between two neighbouring multiples of 2^-bits, or one of them.
#[derive(Clone, Debug)]
pub struct DyadicRoot {
    /// The root times 2^bits, rounded down.
    pub floor: Integer,
    /// Bits behind the point.
    pub bits: usize,
    /// Whether the root is `floor` / 2^bits.
    pub exact: bool,
    /// How often it is one.
    pub multiplicity: usize,
}

/// A prime for looks modulo it: 2^61 - 1.
const PRIME: u64 = (1 << 61) - 1;

impl IntegerPolynomial {
    /// The polynomial with these coefficients of 1, x, x^2 and so on.
    pub fn new(mut coefficients: Vec<Integer>) -> IntegerPolynomial {
        while coefficients.last().is_some_and(Integer::is_zero) {
            coefficients.pop();
        }
        IntegerPolynomial { coefficients }
    }

    /// The polynomial that has these values at 0, 1, 2 and so on, times a positive constant.
    pub fn through(mut values: Vec<Integer>) -> IntegerPolynomial {
        let count = values.len();
        for order in 1..count {
            for i in (order..count).rev() {
                values[i] = &values[i] - &values[i - 1];
            }
        }
        // Newton's form over (count - 1)!, so that its coefficients are integers.
        let mut factor = Integer::ONE;
        for (k, value) in values.iter_mut().enumerate().rev() {
            *value *= &factor;
            factor *= k.max(1);
        }
        let mut coefficients: Vec<Integer> = Vec::with_capacity(count);
        for (k, value) in values.into_iter().enumerate().rev() {
            coefficients.insert(0, Integer::ZERO);
            for i in 1..coefficients.len() {
                let above = &coefficients[i] * k;
                coefficients[i - 1] -= above;
            }
            match coefficients.first_mut() {
                Some(constant) => *constant += value,
                None => coefficients.push(value),
            }
        }
        IntegerPolynomial::new(coefficients).primitive()
    }

    /// The coefficients of 1, x, x^2 and so on, the last one not zero.
    pub fn coefficients(&self) -> &[Integer] {
        &self.coefficients
    }

    /// Whether it is zero everywhere.
    pub fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// The degree; 0 for constants, zero among them.
    pub fn degree(&self) -> usize {
        self.coefficients.len().saturating_sub(1)
    }

    /// The derivative.
    pub fn derivative(&self) -> IntegerPolynomial {
        let powers = self.coefficients.iter().enumerate().skip(1);
        IntegerPolynomial::new(powers.map(|(k, c)| c * k).collect())
    }

    /// The greatest common divisor without constant factors; zero when both are.
    pub fn common_divisor(&self, other: &IntegerPolynomial) -> IntegerPolynomial {
        let (mut a, mut b) = (self.primitive(), other.primitive());
        if a.degree() < b.degree() {
            std::mem::swap(&mut a, &mut b);
        }
        while !b.is_zero() {
            let rest = a.remainder(&b).primitive();
            (a, b) = (b, rest);
        }
        a
    }

    /// The roots in [0, 1], ascending, known to 2^-bits.
    ///
    /// # Panics
    /// For the zero polynomial, which has all numbers as roots.
    pub fn roots_in_unit(&self, bits: usize) -> Vec<DyadicRoot> {
        assert!(!self.is_zero(), "everything is a root of zero");
        let mut roots: Vec<DyadicRoot> = Vec::new();
        for (index, factor) in self.square_free_factors().iter().enumerate() {
            let multiplicity = index + 1;
            for end in [0, 1] {
                if factor.sign_at(&Integer::from(end), 0) == 0 {
                    roots.push(DyadicRoot { floor: Integer::from(end), bits: 0, exact: true, multiplicity });
                }
            }
            let mut isolated = Vec::new();
            isolate(&factor.coefficients, &Integer::ZERO, 0, &mut isolated);
            roots.extend(isolated.into_iter().map(|root| factor.refined(root, bits, multiplicity)));
        }
        for root in &mut roots {
            root.floor <<= bits.saturating_sub(root.bits);
            root.bits = root.bits.max(bits);
        }
        roots.sort_by(|a, b| {
            (&a.floor << (b.bits.max(a.bits) - a.bits)).cmp(&(&b.floor << (a.bits.max(b.bits) - b.bits)))
        });
        roots
    }

    /// Halves the interval of an isolated root until it is narrow enough.
    fn refined(&self, mut root: DyadicRoot, bits: usize, multiplicity: usize) -> DyadicRoot {
        root.multiplicity = multiplicity;
        if root.exact {
            return root;
        }
        let above = self.sign_at(&(&root.floor + 1), root.bits);
        // At an upper end that is a root itself the sign before it is that of the interval's lower end, turned.
        let above = if above == 0 { -self.sign_beyond(&root.floor, root.bits) } else { above };
        while root.bits < bits {
            root.bits += 1;
            root.floor <<= 1;
            let middle = &root.floor + 1;
            match self.sign_at(&middle, root.bits) {
                0 => {
                    root.floor = middle;
                    root.exact = true;
                    return root;
                }
                sign if sign != above => root.floor = middle,
                _ => {}
            }
        }
        root
    }

    /// The sign a little above a number that may be a root, of a polynomial without multiple roots.
    fn sign_beyond(&self, numerator: &Integer, bits: usize) -> i32 {
        match self.sign_at(numerator, bits) {
            0 => self.derivative().sign_at(numerator, bits),
            sign => sign,
        }
    }

    /// The sign at `numerator` / 2^bits.
    fn sign_at(&self, numerator: &Integer, bits: usize) -> i32 {
        let mut sum = Integer::ZERO;
        for (k, c) in self.coefficients.iter().rev().enumerate() {
            sum = sum * numerator + (c << (k * bits));
        }
        sign(&sum)
    }

    /// Divided by the greatest common divisor of its coefficients.
    fn primitive(&self) -> IntegerPolynomial {
        let Some(leading) = self.coefficients.last() else { return self.clone() };
        let divide = |sum: Integer, c: &Integer| Integer::from(sum.gcd(c));
        let content = self.coefficients.iter().fold(leading.clone(), divide);
        IntegerPolynomial { coefficients: self.coefficients.iter().map(|c| c / &content).collect() }
    }

    /// The remainder of the division by another one, times a constant.
    fn remainder(&self, divisor: &IntegerPolynomial) -> IntegerPolynomial {
        let d = divisor.degree();
        let Some(leading) = divisor.coefficients.last() else { return self.clone() };
        let mut rest = self.coefficients.clone();
        while rest.len() > d {
            let Some(top) = rest.pop() else { break };
            if top.is_zero() {
                continue;
            }
            let shift = rest.len() - d;
            for c in &mut rest {
                *c *= leading;
            }
            for (c, other) in rest[shift..].iter_mut().zip(&divisor.coefficients[..d]) {
                *c -= &top * other;
            }
        }
        IntegerPolynomial::new(rest)
    }

    /// The quotient of a division that leaves no remainder, without constant factors.
    fn quotient(&self, divisor: &IntegerPolynomial) -> IntegerPolynomial {
        let d = divisor.degree();
        let Some(leading) = divisor.coefficients.last() else { return self.clone() };
        let mut rest = self.coefficients.clone();
        let mut quotient = vec![Integer::ZERO; rest.len().saturating_sub(d)];
        while rest.len() > d {
            let Some(top) = rest.pop() else { break };
            let shift = rest.len() - d;
            for c in rest.iter_mut().chain(&mut quotient) {
                *c *= leading;
            }
            for (c, other) in rest[shift..].iter_mut().zip(&divisor.coefficients[..d]) {
                *c -= &top * other;
            }
            quotient[shift] = top;
        }
        IntegerPolynomial::new(quotient).primitive()
    }

    /// Factors without multiple roots: the roots of the first are simple, those of the second double, and so on.
    fn square_free_factors(&self) -> Vec<IntegerPolynomial> {
        let slope = self.derivative();
        if self.is_square_free_modulo_prime() {
            return vec![self.primitive()];
        }
        let common = self.common_divisor(&slope);
        let (mut rest, mut slope) = (self.quotient(&common), common);
        let mut factors = Vec::new();
        // `rest` has each root of multiplicity k or more once, `slope` has those of more than k, less k times.
        while rest.degree() > 0 {
            let next = rest.common_divisor(&slope);
            factors.push(rest.quotient(&next));
            slope = slope.quotient(&next);
            rest = next;
        }
        factors
    }

    /// Whether it is square-free modulo a prime that does not divide its leading coefficient, and so in truth.
    fn is_square_free_modulo_prime(&self) -> bool {
        let reduce = |p: &IntegerPolynomial| -> Vec<u64> { p.coefficients.iter().map(residue).collect() };
        let (mut a, mut b) = (reduce(self), reduce(&self.derivative()));
        if a.last().is_none_or(|&c| c == 0) {
            return false;
        }
        trim(&mut b);
        while !b.is_empty() {
            let inverse = power(b[b.len() - 1], PRIME - 2);
            while a.len() >= b.len() {
                let factor = times(a[a.len() - 1], inverse);
                let shift = a.len() - b.len();
                for (x, &y) in a[shift..].iter_mut().zip(&b) {
                    *x = (*x + PRIME - times(factor, y)) % PRIME;
                }
                trim(&mut a);
                if a.is_empty() {
                    break;
                }
            }
            std::mem::swap(&mut a, &mut b);
        }
        a.len() == 1
    }
}

fn trim(p: &mut Vec<u64>) {
    while p.last() == Some(&0) {
        p.pop();
    }
}

fn residue(x: &Integer) -> u64 {
    let rest = x % Integer::from(PRIME);
    let rest = if sign(&rest) < 0 { rest + PRIME } else { rest };
    u64::try_from(rest).unwrap_or(0)
}

fn times(a: u64, b: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64
}

fn power(mut base: u64, mut exponent: u64) -> u64 {
    let mut product = 1;
    while exponent > 0 {
        if exponent % 2 == 1 {
            product = times(product, base);
        }
        base = times(base, base);
        exponent /= 2;
    }
    product
}

/// -1, 0 or 1.
pub fn sign(x: &Integer) -> i32 {
    match (x.is_zero(), x.sign()) {
        (true, _) => 0,
        (_, Sign::Positive) => 1,
        (_, Sign::Negative) => -1,
    }
}

/// Number of bits of the magnitude.
pub fn bit_length(x: &Integer) -> usize {
    use dashu_int::ops::BitTest;
    x.unsigned_abs().bit_len()
}

/// `p(x + 1)`.
fn shifted(p: &mut [Integer]) {
    let n = p.len();
    for k in 1..n {
        for i in (k - 1..n - 1).rev() {
            let above = p[i + 1].clone();
            p[i] += above;
        }
    }
}

/// Isolates the roots inside (0, 1) of `p`, which is the square-free whole over (floor, floor + 1) / 2^bits.
fn isolate(p: &[Integer], floor: &Integer, bits: usize, found: &mut Vec<DyadicRoot>) {
    let mut turned: Vec<Integer> = p.iter().rev().cloned().collect();
    shifted(&mut turned);
    let signs = turned.iter().map(sign).filter(|&s| s != 0);
    let (mut last, mut changes) = (0, 0);
    for s in signs {
        changes += usize::from(last != 0 && s != last);
        last = s;
    }
    if changes == 0 {
        return;
    }
    if changes == 1 {
        found.push(DyadicRoot { floor: floor.clone(), bits, exact: false, multiplicity: 1 });
        return;
    }
    let n = p.len() - 1;
    let mut half: Vec<Integer> = p.iter().enumerate().map(|(k, c)| c << (n - k)).collect();
    let floor = Integer::from(floor << 1);
    isolate(&half, &floor, bits + 1, found);
    shifted(&mut half);
    let floor: Integer = floor + 1;
    if half[0].is_zero() {
        found.push(DyadicRoot { floor: floor.clone(), bits: bits + 1, exact: true, multiplicity: 1 });
    }
    isolate(&half, &floor, bits + 1, found);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The product of `q x - p` for p/q.
    fn with_roots(roots: &[(i64, i64)]) -> IntegerPolynomial {
        let mut c = vec![Integer::ONE];
        for &(p, q) in roots {
            c.push(Integer::ZERO);
            for i in (0..c.len()).rev() {
                let below = if i > 0 { &c[i - 1] * q } else { Integer::ZERO };
                c[i] = below - &c[i] * p;
            }
        }
        IntegerPolynomial::new(c)
    }

    fn found(roots: &[(i64, i64)]) -> Vec<(f64, usize)> {
        let value =
            |root: &DyadicRoot| i64::try_from(&root.floor).unwrap() as f64 / (root.bits as f64).exp2();
        let roots = with_roots(roots).roots_in_unit(60);
        roots.iter().map(|root| (value(root), root.multiplicity)).collect()
    }

    #[test]
    fn multiplicities_and_ends() {
        assert_eq!(found(&[(0, 1), (1, 2), (1, 2), (1, 1)]), [(0.0, 1), (0.5, 2), (1.0, 1)]);
        assert_eq!(found(&[(1, 3), (1, 3), (1, 3), (5, 1)]), [(1.0 / 3.0, 3)]);
        assert_eq!(found(&[(-1, 3), (4, 3)]), []);
        let near = found(&[(1, 3), (333_333_333, 1_000_000_000)]);
        assert!(near.len() == 2 && near[0].0 < near[1].0);
    }

    proptest! {
        #[test]
        fn planted_roots_come_back(mut planted in prop::collection::vec((0..40_i64, 1..40_i64), 1..9)) {
            let value = |r: &(i64, i64)| r.0 as f64 / r.1 as f64;
            let got = found(&planted);
            planted.retain(|root| root.0 <= root.1);
            planted.sort_by(|a, b| value(a).total_cmp(&value(b)));
            prop_assert_eq!(got.iter().map(|root| root.1).sum::<usize>(), planted.len());
            let repeated = got.iter().flat_map(|root| std::iter::repeat_n(root.0, root.1));
            for (root, want) in repeated.zip(&planted) {
                prop_assert!((root - value(want)).abs() < 1e-15);
            }
        }

        #[test]
        fn interpolation_gives_the_polynomial_back(c in prop::collection::vec(-100..100_i64, 1..8)) {
            let p = IntegerPolynomial::new(c.iter().map(|&x| Integer::from(x)).collect());
            let value = |x: usize| p.coefficients.iter().rev().fold(Integer::ZERO, |sum, c| sum * x + c);
            let again = IntegerPolynomial::through((0..c.len()).map(value).collect());
            prop_assert_eq!(again, p.primitive());
        }
    }
}
