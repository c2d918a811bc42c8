//! Polynomials in Bernstein form over [0, 1]: products and certified roots.

use super::subdivide::restrict;
use crate::numeric::roots::bracketed;
use crate::numeric::scale_by_power_of_two;

/// A root of a polynomial, or as many as rounding cannot tell apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BernsteinRoot {
    /// The root; of a cluster the point where the polynomial is nearest to zero or changes sign.
    pub t: f64,
    /// Where the polynomial cannot be told from zero begins here; `t` itself for a simple root.
    pub low: f64,
    /// Where that ends.
    pub high: f64,
    /// How many roots there are at most, counted with multiplicity; odd where the sign changes, and 1 exactly for a
    /// simple root.
    pub multiplicity: usize,
}

/// The roots of a polynomial in [0, 1], ascending.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Roots {
    /// The polynomial cannot be told from zero anywhere.
    Everywhere,
    /// These and no others.
    At(Vec<BernsteinRoot>),
}

impl Roots {
    /// The roots; none of a polynomial that is zero everywhere.
    pub(super) fn isolated(self) -> Vec<BernsteinRoot> {
        match self {
            Roots::Everywhere => Vec::new(),
            Roots::At(roots) => roots,
        }
    }
}

/// Narrower pieces are not cut further.
const FLOOR: f64 = 4.0 * f64::EPSILON;

/// All roots in [0, 1] of a polynomial whose Bernstein coefficients are known up to `error`.
///
/// Certified by the hull property: a piece whose coefficients all exceed the error in one sign has no root, one with a
/// single change of sign and sure ends has exactly one (Descartes' rule), and everything else is cut in two. Where the
/// values stay below the error the piece belongs to a cluster.
pub(super) fn roots(coefficients: &[f64], error: f64) -> Roots {
    let n = coefficients.len();
    let size = coefficients.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    // Each piece is cut out of the whole by two de Casteljau passes.
    let error = error + 8.0 * n as f64 * f64::EPSILON * size;
    if size <= error {
        return Roots::Everywhere;
    }
    let mut search = Search { coefficients, error, simple: Vec::new(), doubtful: Vec::new() };
    search.piece(coefficients, 0.0, 1.0);
    let mut found = search.simple.clone();
    found.extend(search.clusters());
    found.sort_by(|a, b| a.t.total_cmp(&b.t));
    Roots::At(found)
}

struct Search<'a> {
    coefficients: &'a [f64],
    error: f64,
    simple: Vec<BernsteinRoot>,
    /// Pieces on which the value stays within twice the error or that are too narrow to cut.
    doubtful: Vec<(f64, f64)>,
}

impl Search<'_> {
    fn piece(&mut self, c: &[f64], low: f64, high: f64) {
        let (first, last) = (c[0], c[c.len() - 1]);
        let error = self.error;
        if c.iter().all(|&x| x > error) || c.iter().all(|&x| x < -error) {
            return;
        }
        let sure = first.abs() > error && last.abs() > error;
        if sure && (first < 0.0) != (last < 0.0) && sign_changes(c) == 1 {
            let t = bracketed(|t| self.value(t), low, high);
            self.simple.push(BernsteinRoot { t, low: t, high: t, multiplicity: 1 });
            return;
        }
        // Twice the error: a piece that varies less than the error then falls on one side or the other at once.
        if c.iter().all(|x| x.abs() <= 2.0 * error) || high - low <= FLOOR {
            self.doubtful.push((low, high));
            return;
        }
        // A cut at a root would leave both parts with a doubtful end; such a place is avoided when there is another.
        let middles = [0.5, 0.4375, 0.578125].map(|share| low + share * (high - low));
        let middle = *middles.iter().find(|&&t| self.value(t).abs() > error).unwrap_or(&middles[0]);
        for (from, to) in [(low, middle), (middle, high)] {
            let mut part = self.coefficients.to_vec();
            restrict(&mut part, from, to);
            self.piece(&part, from, to);
        }
    }

    fn value(&self, t: f64) -> f64 {
        super::evaluate::de_casteljau(self.coefficients, t)
    }

    /// Doubtful pieces made one where the polynomial stays within a few errors of zero between them.
    fn clusters(&self) -> Vec<BernsteinRoot> {
        let mut merged: Vec<(f64, f64)> = Vec::new();
        for &(low, high) in &self.doubtful {
            match merged.last_mut() {
                Some(before) if before.1 == low || self.stays_small(before.1, low) => before.1 = high,
                _ => merged.push((low, high)),
            }
        }
        merged.iter().map(|&(low, high)| self.cluster(low, high)).collect()
    }

    fn stays_small(&self, low: f64, high: f64) -> bool {
        let mut part = self.coefficients.to_vec();
        restrict(&mut part, low, high);
        part.iter().all(|c| c.abs() <= 4.0 * self.error)
    }

    /// What a doubtful interval holds.
    fn cluster(&self, low: f64, high: f64) -> BernsteinRoot {
        // A little wider, so that the signs at the ends are sure (unless they are the ends of the whole).
        let widen = |from: f64, step: f64| {
            let mut reach = step;
            let mut t = from;
            while self.value(t).abs() <= self.error && (0.0..=1.0).contains(&(from + reach)) {
                t = from + reach;
                reach *= 2.0;
            }
            t
        };
        let (outer_low, outer_high) = (widen(low, -FLOOR), widen(high, FLOOR));
        let mut part = self.coefficients.to_vec();
        restrict(&mut part, outer_low, outer_high);
        let (first, last) = (self.value(outer_low), self.value(outer_high));
        let changes = sign_changes(&part);
        let crosses = first.abs() > self.error && last.abs() > self.error && (first < 0.0) != (last < 0.0);
        let t = if crosses {
            bracketed(|t| self.value(t), outer_low, outer_high)
        } else {
            self.nearest_to_zero(low, high)
        };
        let at_end = low == 0.0 || high == 1.0;
        let multiplicity = match (crosses, at_end) {
            (true, _) => changes.max(1) | 1,
            (false, true) => changes.max(1),
            (false, false) => (changes + 1).max(2) & !1,
        };
        BernsteinRoot { t, low, high, multiplicity }
    }

    /// Where the derivative changes sign within the interval, or the end nearer to zero.
    fn nearest_to_zero(&self, low: f64, high: f64) -> f64 {
        if low == 0.0 || high == 1.0 {
            let (a, b) = (self.value(low).abs(), self.value(high).abs());
            return if low == 0.0 && (a <= b || high < 1.0) { low } else { high };
        }
        let slopes = super::subdivide::derivative(self.coefficients, 1);
        bracketed(|t| super::evaluate::de_casteljau(&slopes, t), low, high)
    }
}

/// Changes of sign in a list, zeros left out.
pub(super) fn sign_changes(values: &[f64]) -> usize {
    let mut last = 0.0;
    let mut count = 0;
    for &value in values.iter().filter(|&&value| value != 0.0) {
        if last != 0.0 && (value < 0.0) != (last < 0.0_f64) {
            count += 1;
        }
        last = value;
    }
    count
}

/// The sum of products of two polynomial curves: `sum_axis a_axis(t) b_axis(t)` in Bernstein form.
pub(super) fn inner_product<P: crate::math::Blend>(a: &[P], b: &[P]) -> Vec<f64> {
    product_with(a, b, P::inner)
}

/// The product of two polynomials under any bilinear map. Binomials of high degrees are kept with their exponents.
pub(super) fn product_with<P: Copy, Q: Copy>(a: &[P], b: &[Q], times: impl Fn(P, Q) -> f64) -> Vec<f64> {
    let (n, m) = (a.len() - 1, b.len() - 1);
    let (of_a, of_b, of_product) = (binomials_apart(n), binomials_apart(m), binomials_apart(n + m));
    let mut product = vec![0.0; n + m + 1];
    for i in 0..=n {
        for j in 0..=m {
            let ((x, p), (y, q), (z, r)) = (of_a[i], of_b[j], of_product[i + j]);
            let weight = scale_by_power_of_two(x * y / z, p + q - r);
            product[i + j] += weight * times(a[i], b[j]);
        }
    }
    product
}

/// C(n, 0) to C(n, n), each as a factor of moderate size and the exponent of a power of two.
fn binomials_apart(n: usize) -> Vec<(f64, i32)> {
    let mut row = vec![(1.0, 0); n + 1];
    for k in 0..n {
        let (factor, exponent) = row[k];
        let next = factor * (n - k) as f64 / (k + 1) as f64;
        // One power of two at a time is enough: powers of 2^300 move in before anything over- or underflows.
        row[k + 1] = if next > LARGE {
            (next / LARGE, exponent + LARGE_EXPONENT)
        } else if next < 1.0 && exponent > 0 {
            (next * LARGE, exponent - LARGE_EXPONENT)
        } else {
            (next, exponent)
        };
    }
    row
}

/// Below the root of the largest number.
const LARGE_EXPONENT: i32 = 300;
/// 2 to that power.
const LARGE: f64 = f64::from_bits(((LARGE_EXPONENT + 1023) as u64) << 52);

/// C(n, 0) to C(n, n).
pub(super) fn binomials(n: usize) -> Vec<f64> {
    let mut row = vec![1.0; n + 1];
    for k in 0..n {
        row[k + 1] = super::evaluate::next_binomial(row[k], n, k);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bernstein coefficients of the product of `t - root`.
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        roots.iter().fold(vec![1.0], |p, root| product_with(&p, &[-root, 1.0 - root], |a, b| a * b))
    }

    fn found(roots: &[f64]) -> Vec<(f64, usize)> {
        let roots = super::roots(&with_roots(roots), 0.0).isolated();
        roots.iter().map(|root| (root.t, root.multiplicity)).collect()
    }

    #[test]
    fn multiplicities_are_told() {
        assert_eq!(found(&[0.25]), [(0.25, 1)]);
        let double = found(&[0.5, 0.5]);
        assert!(double.len() == 1 && double[0].1 == 2 && (double[0].0 - 0.5).abs() < 1e-15, "{double:?}");
        let triple = found(&[0.3, 0.3, 0.3]);
        assert!(triple.len() == 1 && triple[0].1 == 3 && (triple[0].0 - 0.3).abs() < 1e-5, "{triple:?}");
        let quadruple = found(&[0.7; 4]);
        assert!(quadruple.len() == 1 && quadruple[0].1 == 4, "{quadruple:?}");
        let mixed = found(&[0.1, 0.6, 0.6, 0.9]);
        assert_eq!(mixed.iter().map(|root| root.1).collect::<Vec<_>>(), [1, 2, 1]);
        assert_eq!(found(&[0.0, 0.5]).len(), 2);
        assert_eq!(found(&[0.0, 1.0]).iter().map(|root| root.0).collect::<Vec<_>>(), [0.0, 1.0]);
        assert_eq!(found(&[2.0, -1.0]), []);
        assert_eq!(roots(&[0.0, 0.0, 0.0], 0.0), Roots::Everywhere);
        assert_eq!(roots(&[1e-9, -1e-9], 1e-8), Roots::Everywhere);
    }

    #[test]
    fn near_roots_are_told_apart() {
        let pair = found(&[0.5, 0.5 + 1e-6]);
        assert_eq!(pair.len(), 2);
        assert!((pair[0].0 - 0.5).abs() < 1e-9 && (pair[1].0 - 0.500001).abs() < 1e-9);
        // Above zero by 1e-10: none.
        let lifted: Vec<f64> = with_roots(&[0.5, 0.5]).iter().map(|c| c + 1e-10).collect();
        assert_eq!(roots(&lifted, 0.0), Roots::At(vec![]));
    }

    proptest! {
        #[test]
        fn planted_roots_are_found(mut planted in prop::collection::vec(0.01..0.99_f64, 1..6)) {
            planted.sort_by(f64::total_cmp);
            prop_assume!(planted.windows(2).all(|pair| pair[1] - pair[0] > 0.03));
            let got = found(&planted);
            prop_assert_eq!(got.len(), planted.len());
            for (root, want) in got.iter().zip(planted) {
                prop_assert!((root.0 - want).abs() < 1e-9 && root.1 == 1);
            }
        }
    }
}
