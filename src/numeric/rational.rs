//! Fractions of integers of any size.

use super::integer_polynomial::Integer;

/// A fraction in lowest terms.
pub type Fraction = dashu_ratio::RBig;

/// The nearest `f64`.
pub fn nearest_f64(x: &Fraction) -> f64 {
    x.to_f64().value()
}

/// Numerator and denominator, the latter positive.
pub fn parts(x: &Fraction) -> (Integer, Integer) {
    (x.numerator().clone(), x.denominator().clone().into())
}

/// The rational number whose power of an exponent is `x`, not negative for even exponents; `None` if there is none.
pub fn rational_root(x: &Fraction, exponent: usize) -> Option<Fraction> {
    let (up, down) = parts(x);
    if up < Integer::ZERO && exponent.is_multiple_of(2) {
        return None;
    }
    let (root_up, root_down) = (up.nth_root(exponent), down.nth_root(exponent));
    let found = root_up.pow(exponent) == up && root_down.pow(exponent) == down;
    found.then(|| Fraction::from_parts_signed(root_up, root_down))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_fractions() {
        let of = |up: i32, down: i32| Fraction::from_parts_signed(up.into(), down.into());
        assert_eq!(rational_root(&of(-8, 27), 3), Some(of(-2, 3)));
        assert_eq!(rational_root(&of(9, 4), 2), Some(of(3, 2)));
        assert_eq!(rational_root(&of(2, 1), 2), None);
        assert_eq!(rational_root(&of(-4, 1), 2), None);
        assert_eq!(nearest_f64(&of(1, 3)), 1.0 / 3.0);
    }
}
