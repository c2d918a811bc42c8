//! Real roots of single equations: quadratics in closed form, anything continuous between two signs.

use super::double_double::DoubleDouble;

/// At most `N` numbers in ascending order; reads as a slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Few<const N: usize> {
    values: [f64; N],
    count: usize,
}

impl<const N: usize> Few<N> {
    /// No number.
    pub const NONE: Few<N> = Few { values: [0.0; N], count: 0 };

    /// These numbers and one more, not smaller than they are.
    ///
    /// # Panics
    /// When there are `N` already.
    pub fn with(mut self, value: f64) -> Few<N> {
        self.values[self.count] = value;
        self.count += 1;
        self
    }

    /// Those numbers that `keep` holds for.
    pub fn filtered(self, keep: impl Fn(f64) -> bool) -> Few<N> {
        self.iter().filter(|&&value| keep(value)).fold(Few::NONE, |few, &value| few.with(value))
    }
}

impl<const N: usize> std::ops::Deref for Few<N> {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// The real roots of `a t^2 + b t + c`, ascending, a double root once; none where all coefficients vanish.
///
/// The discriminant is taken in double-double arithmetic and its sign is therefore right for coefficients that are
/// themselves exact; roots are good to a few units in the last place. Roots beyond the range of `f64` are left out.
pub fn quadratic(a: f64, b: f64, c: f64) -> Few<2> {
    let size = a.abs().max(b.abs()).max(c.abs());
    if size == 0.0 || !size.is_finite() {
        return Few::NONE;
    }
    let (scale, rest) = power_of_two_near(1.0 / size);
    let [a, b, c] = [a, b, c].map(|x| x * scale * rest);
    if a == 0.0 {
        let root = -c / b;
        return if root.is_finite() { Few::NONE.with(root) } else { Few::NONE };
    }
    let discriminant = DoubleDouble::product(b, b) - DoubleDouble::product(a, c) * 4.0;
    if discriminant.hi < 0.0 {
        return Few::NONE;
    }
    let root = discriminant.sqrt();
    if root.hi == 0.0 {
        return finite_sorted(&[-0.5 * b / a]);
    }
    // The sum of like signs loses nothing; the other root comes from the product of both.
    let sum = if b < 0.0 { DoubleDouble::from(-b) + root } else { DoubleDouble::from(-b) - root };
    let half = 0.5 * sum.to_f64();
    finite_sorted(&[half / a, c / half])
}

fn finite_sorted(roots: &[f64]) -> Few<2> {
    let mut few = roots.iter().filter(|root| root.is_finite()).fold(Few::NONE, |few, &root| few.with(root));
    let count = few.count;
    few.values[..count].sort_by(f64::total_cmp);
    few
}

/// Two powers of two whose product is `size` up to a factor of 2, each within the normal range.
fn power_of_two_near(size: f64) -> (f64, f64) {
    let size = size.clamp(f64::MIN_POSITIVE, f64::MAX);
    let exponent = ((size.to_bits() >> 52) as i32) - 1023;
    (power_of_two(exponent / 2), power_of_two(exponent - exponent / 2))
}

/// 2 to an exponent from -1022 to 1023.
pub fn power_of_two(exponent: i32) -> f64 {
    debug_assert!((-1022..=1023).contains(&exponent));
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

/// A zero of `f` between `low` and `high`, where its signs differ: the end with the smaller magnitude of `f` of an
/// interval of adjacent numbers that holds a change of sign, or a point where `f` vanishes.
///
/// Regula falsi with Illinois steps (Dowell, Jarratt 1971); wherever three steps did not halve the count of numbers
/// in the interval, that count is halved, so there are at most about 200 evaluations whatever `f` is. Where the signs
/// do not differ the better end is returned.
pub fn bracketed(mut f: impl FnMut(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut a, mut b) = (low, high);
    let (mut fa, mut fb) = (f(a), f(b));
    // The values that the secant is drawn through: an end that stays has its own halved.
    let (mut ga, mut gb) = (fa, fb);
    let mut count = place(b) - place(a);
    for step in 1_u32.. {
        if fa == 0.0 || fb == 0.0 || (fa < 0.0) == (fb < 0.0) || place(b) - place(a) <= 1 {
            break;
        }
        let secant = a + (b - a) * (ga / (ga - gb));
        let slow = step.is_multiple_of(3) && place(b) - place(a) > count / 2;
        let x = if !slow && secant > a && secant < b { secant } else { at_place((place(a) + place(b)) / 2) };
        if step.is_multiple_of(3) {
            count = place(b) - place(a);
        }
        let fx = f(x);
        if (fx < 0.0) == (fa < 0.0) {
            (a, fa, ga) = (x, fx, fx);
            gb *= 0.5;
        } else {
            (b, fb, gb) = (x, fx, fx);
            ga *= 0.5;
        }
    }
    if fa.abs() <= fb.abs() { a } else { b }
}

/// The place of a number when all finite numbers stand in ascending order, 0 at place 0.
fn place(x: f64) -> i128 {
    let magnitude = i128::from(x.abs().to_bits());
    if x < 0.0 { -magnitude } else { magnitude }
}

/// The number at a place, the inverse of [`place`].
fn at_place(place: i128) -> f64 {
    let magnitude = f64::from_bits(place.unsigned_abs() as u64);
    if place < 0 { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quadratics_of_every_shape() {
        assert_eq!(*quadratic(1.0, -3.0, 2.0), [1.0, 2.0]);
        assert_eq!(*quadratic(-1.0, 3.0, -2.0), [1.0, 2.0]);
        assert_eq!(*quadratic(1.0, -2.0, 1.0), [1.0]);
        assert_eq!(*quadratic(1.0, 0.0, 0.0), [0.0]);
        assert!(quadratic(1.0, 0.0, 1.0).is_empty());
        assert_eq!(*quadratic(0.0, 2.0, -1.0), [0.5]);
        assert!(quadratic(0.0, 0.0, 1.0).is_empty());
        assert!(quadratic(0.0, 0.0, 0.0).is_empty());
        assert!(quadratic(f64::NAN, 0.0, 0.0).is_empty());
        // Kahan's example: the naive discriminant vanishes.
        let roots = quadratic(94_906_265.625, -2.0 * 94_906_267.0, 94_906_268.375);
        assert_eq!(*roots, [1.0, 1.000_000_028_975_958_3]);
    }

    #[test]
    fn quadratics_of_every_size() {
        for scale in [1e-320, 1e-300, 1e-12, 1e12, 1e307] {
            let roots = quadratic(scale, -3.0 * scale, 2.0 * scale);
            assert_eq!(roots.len(), 2, "{scale}");
            assert!((roots[0] - 1.0).abs() < 1e-2 && (roots[1] - 2.0).abs() < 1e-2, "{scale}: {roots:?}");
        }
        let far = quadratic(1.0, -1e200, 1.0);
        assert_eq!(*far, [1e-200, 1e200]);
    }

    #[test]
    fn a_bracket_closes_on_hard_functions() {
        assert!((bracketed(|x| x * x - 2.0, 0.0, 2.0) - 2_f64.sqrt()).abs() <= f64::EPSILON);
        assert_eq!(bracketed(|x| if x < 0.3 { -1.0 } else { 1e9 }, 0.0, 1.0), 0.3_f64.next_down());
        // The fifth power underflows to zero near its root.
        assert!(bracketed(|x| x * x * x * x * x, -1.0, 0.7).abs() < 1e-60);
        let mut count = 0;
        bracketed(
            |x| {
                count += 1;
                (x - 1e-9).powi(21)
            },
            -1.0,
            1.0,
        );
        assert!(count < 250, "{count}");
        assert_eq!(bracketed(|x| x + 1.0, 0.0, 1.0), 0.0);
    }

    proptest! {
        #[test]
        fn roots_of_products_are_found(r in -1e3..1e3_f64, s in -1e3..1e3_f64) {
            prop_assume!((r - s).abs() > 1e-3);
            let roots = quadratic(1.0, -(r + s), r * s);
            prop_assert_eq!(roots.len(), 2);
            let size = r.abs().max(s.abs());
            prop_assert!((roots[0] - r.min(s)).abs() <= 1e-9 * size && (roots[1] - r.max(s)).abs() <= 1e-9 * size);
        }
    }
}
