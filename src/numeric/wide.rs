//! Integers of a fixed largest width, for exact signs: no allocation, no overflow where the width is proved.
//!
//! A [`Wide<N>`] holds a sign and up to `N` limbs of 64 bits, and knows how many it uses, so arithmetic costs what the
//! numbers are worth and not what they could be. Products and sums may be taken into a wider type; the caller names a
//! width that holds every possible result (a result that does not fit is a bug and panics).

use std::cmp::Ordering;

/// A signed integer below 2^(64 N) in magnitude.
#[derive(Clone, Copy, Debug)]
pub struct Wide<const N: usize> {
    negative: bool,
    /// Limbs in use; the topmost one in use is not zero.
    len: u8,
    /// Least significant first; zero from `len` on.
    limbs: [u64; N],
}

impl<const N: usize> Wide<N> {
    /// Zero.
    pub const ZERO: Self = Wide { negative: false, len: 0, limbs: [0; N] };

    /// `high * 2^64 + low`, in at least three limbs.
    #[inline]
    pub fn from_halves(high: i128, low: u64) -> Self {
        let (magnitude, lowest) = if high < 0 {
            // The negative of a number in two's complement: all bits turned, plus one.
            let (lowest, carry) = (!low).overflowing_add(1);
            ((!high as u128).wrapping_add(u128::from(carry)), lowest)
        } else {
            (high as u128, low)
        };
        let mut limbs = [0; N];
        (limbs[0], limbs[1], limbs[2]) = (lowest, magnitude as u64, (magnitude >> 64) as u64);
        Wide::from_limbs(high < 0, limbs, 3)
    }

    /// -1, 0 or 1.
    #[inline]
    pub fn signum(&self) -> i32 {
        match (self.len, self.negative) {
            (0, _) => 0,
            (_, true) => -1,
            (_, false) => 1,
        }
    }

    /// Whether it is zero.
    #[inline]
    pub fn is_zero(&self) -> bool {
        self.len == 0
    }

    /// The same number in another width.
    #[inline]
    pub fn widen<const M: usize>(&self) -> Wide<M> {
        let mut limbs = [0; M];
        limbs[..self.limbs().len()].copy_from_slice(self.limbs());
        Wide { negative: self.negative, len: self.len, limbs }
    }

    /// The product, in a width that holds it.
    #[inline]
    pub fn times<const M: usize, const R: usize>(&self, other: &Wide<M>) -> Wide<R> {
        let mut limbs = [0_u64; R];
        for (i, &a) in self.limbs().iter().enumerate() {
            let mut carry = 0_u128;
            for (j, &b) in other.limbs().iter().enumerate() {
                carry += u128::from(limbs[i + j]) + u128::from(a) * u128::from(b);
                limbs[i + j] = carry as u64;
                carry >>= 64;
            }
            if carry != 0 {
                limbs[i + other.limbs().len()] = carry as u64;
            }
        }
        let top = (self.len as usize + other.len as usize).min(R);
        Wide::from_limbs(self.negative != other.negative, limbs, top)
    }

    /// The sum.
    #[inline]
    pub fn plus(&self, other: &Self) -> Self {
        if self.negative == other.negative {
            return self.add_magnitude(other);
        }
        match self.cmp_magnitude(other) {
            Ordering::Equal => Self::ZERO,
            Ordering::Greater => self.sub_magnitude(other),
            Ordering::Less => other.sub_magnitude(self),
        }
    }

    /// The difference.
    #[inline]
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    /// The number with the other sign.
    #[inline]
    pub fn negated(&self) -> Self {
        Wide { negative: !self.negative && self.len > 0, ..*self }
    }

    /// Number of bits of the magnitude; 0 for zero.
    #[inline]
    pub fn bits(&self) -> u32 {
        match self.limbs().last() {
            Some(top) => 64 * u32::from(self.len) - top.leading_zeros(),
            None => 0,
        }
    }

    /// Number of zero bits below the lowest one that is set; 0 for zero.
    pub fn trailing_zeros(&self) -> u32 {
        let low = self.limbs().iter().position(|&limb| limb != 0);
        low.map_or(0, |at| 64 * at as u32 + self.limbs[at].trailing_zeros())
    }

    /// The product with 2^`exponent`; `None` where that is no integer, or one too wide.
    pub fn times_power_of_two(&self, exponent: i32) -> Option<Self> {
        if self.is_zero() {
            return Some(*self);
        }
        let by = exponent.unsigned_abs();
        let (limbs, bits) = ((by / 64) as usize, by % 64);
        let fits = if exponent < 0 { by <= self.trailing_zeros() } else { self.bits() + by <= 64 * N as u32 };
        fits.then(|| {
            // Limb `i` of the source, or of what lies beside it.
            let source =
                |i: Option<usize>| i.and_then(|i| self.limbs.get(i)).map_or(0, |&limb| u128::from(limb));
            let limb = |i: usize| match exponent {
                ..0 => ((source(Some(i + limbs)) | source(Some(i + limbs + 1)) << 64) >> bits) as u64,
                0.. => {
                    let (low, high) = (i.checked_sub(limbs + 1), i.checked_sub(limbs));
                    (((source(high) << 64 | source(low)) << bits) >> 64) as u64
                }
            };
            Wide::from_limbs(self.negative, std::array::from_fn(limb), N)
        })
    }

    /// The nearest double (ties to even). Numbers of more than 1023 bits are infinite.
    pub fn to_f64(&self) -> f64 {
        let bits = self.bits();
        let magnitude = if bits <= 64 {
            self.limbs.first().map_or(0.0, |&low| low as f64)
        } else {
            let shift = bits - 64;
            let (top, rest) = self.split_at_bit(shift);
            // The lowest bit of 64 lies far below the rounding position, so it can stand for everything beneath.
            scale_by_power_of_two((top | u64::from(rest)) as f64, shift as i32)
        };
        if self.negative { -magnitude } else { magnitude }
    }

    #[inline]
    fn limbs(&self) -> &[u64] {
        &self.limbs[..self.len as usize]
    }

    #[inline]
    fn from_limbs(negative: bool, limbs: [u64; N], mut len: usize) -> Self {
        while len > 0 && limbs[len - 1] == 0 {
            len -= 1;
        }
        Wide { negative: negative && len > 0, len: len as u8, limbs }
    }

    #[inline]
    fn cmp_magnitude(&self, other: &Self) -> Ordering {
        let by_len = self.len.cmp(&other.len);
        by_len.then_with(|| self.limbs().iter().rev().cmp(other.limbs().iter().rev()))
    }

    #[inline]
    fn add_magnitude(&self, other: &Self) -> Self {
        let (long, short) = if self.len >= other.len { (self, other) } else { (other, self) };
        let mut limbs = long.limbs;
        let mut carry = false;
        for (i, limb) in limbs.iter_mut().enumerate().take(long.len as usize) {
            if i >= short.len as usize && !carry {
                break;
            }
            let (sum, over) = limb.overflowing_add(short.limbs[i]);
            let (sum, over_again) = sum.overflowing_add(u64::from(carry));
            (*limb, carry) = (sum, over || over_again);
        }
        let mut len = long.len as usize;
        if carry {
            limbs[len] = 1;
            len += 1;
        }
        Wide { negative: self.negative, len: len as u8, limbs }
    }

    /// `self - other` for magnitudes with `self > other`; the sign is that of `self`.
    #[inline]
    fn sub_magnitude(&self, other: &Self) -> Self {
        let mut limbs = self.limbs;
        let mut borrow = false;
        for (i, limb) in limbs.iter_mut().enumerate().take(self.len as usize) {
            if i >= other.len as usize && !borrow {
                break;
            }
            let (difference, under) = limb.overflowing_sub(other.limbs[i]);
            let (difference, under_again) = difference.overflowing_sub(u64::from(borrow));
            (*limb, borrow) = (difference, under || under_again);
        }
        Wide::from_limbs(self.negative, limbs, self.len as usize)
    }

    /// The 64 bits from bit `shift` up, and whether any bit below is set. Needs `shift + 64 >= bits`.
    fn split_at_bit(&self, shift: u32) -> (u64, bool) {
        let (limb, bit) = ((shift / 64) as usize, shift % 64);
        let low = self.limbs[limb] >> bit;
        let high = match self.limbs.get(limb + 1) {
            Some(next) if bit > 0 => next << (64 - bit),
            _ => 0,
        };
        let rest = self.limbs[..limb].iter().any(|&l| l != 0) || self.limbs[limb] & ((1 << bit) - 1) != 0;
        (low | high, rest)
    }
}

impl<const N: usize> From<i64> for Wide<N> {
    #[inline]
    fn from(value: i64) -> Self {
        let mut limbs = [0; N];
        limbs[0] = value.unsigned_abs();
        Wide { negative: value < 0, len: u8::from(value != 0), limbs }
    }
}

impl<const N: usize> From<i128> for Wide<N> {
    #[inline]
    fn from(value: i128) -> Self {
        let magnitude = value.unsigned_abs();
        let mut limbs = [0; N];
        limbs[0] = magnitude as u64;
        let high = (magnitude >> 64) as u64;
        if high != 0 {
            limbs[1] = high;
        }
        Wide::from_limbs(value < 0, limbs, N.min(2))
    }
}

impl<const N: usize> PartialEq for Wide<N> {
    fn eq(&self, other: &Self) -> bool {
        self.negative == other.negative && self.limbs() == other.limbs()
    }
}

impl<const N: usize> Eq for Wide<N> {}

impl<const N: usize> PartialOrd for Wide<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const N: usize> Ord for Wide<N> {
    fn cmp(&self, other: &Self) -> Ordering {
        match (self.negative, other.negative) {
            (false, true) => Ordering::Greater,
            (true, false) => Ordering::Less,
            (false, false) => self.cmp_magnitude(other),
            (true, true) => other.cmp_magnitude(self),
        }
    }
}

/// The double nearest to `numerator / denominator` (ties to even), for a positive denominator and a quotient
/// whose magnitude is zero or in the normal range.
///
/// Rounding is monotone: if the rounded quotients of two fractions differ, the fractions differ the same way.
pub fn rounded_quotient<const N: usize, const D: usize>(numerator: &Wide<N>, denominator: &Wide<D>) -> f64 {
    debug_assert!(denominator.signum() > 0);
    if numerator.is_zero() {
        return 0.0;
    }
    // Both leading 64 bits, truncated: the quotient of the leading parts is within a few units of its 62nd bit.
    let (top, top_shift) = leading_64(numerator);
    let (bottom, bottom_shift) = leading_64(denominator);
    let quotient = ((u128::from(top) << 64) / u128::from(bottom)) >> 1;
    // The quotient has 64 or 63 bits; its last 10 or 11 bits decide the rounding of a 53-bit mantissa.
    let extra = 128 - (quotient.leading_zeros() + 53);
    let mantissa = (quotient >> extra) as u64;
    let tail = quotient & ((1 << extra) - 1);
    let half = 1_u128 << (extra - 1);
    let exponent = top_shift - bottom_shift - 63 + extra as i32;
    const SLACK: u128 = 8;
    let rounded = if tail.abs_diff(half) > SLACK && tail > SLACK && tail < (1 << extra) - SLACK {
        mantissa + u64::from(tail > half)
    } else {
        settle_rounding(numerator, denominator, mantissa, exponent)
    };
    let magnitude = scale_by_power_of_two(rounded as f64, exponent);
    if numerator.negative { -magnitude } else { magnitude }
}

/// The integer nearest to `|numerator| / (denominator 2^exponent)`, given a guess that is at most one off.
#[cold]
fn settle_rounding<const N: usize, const D: usize>(
    numerator: &Wide<N>,
    denominator: &Wide<D>,
    guess: u64,
    exponent: i32,
) -> u64 {
    let mut mantissa = guess - 1;
    loop {
        // Compare with the midpoint (2 mantissa + 1) / 2.
        match compare_shifted(numerator, denominator, 2 * mantissa + 1, exponent - 1) {
            Ordering::Less => return mantissa,
            Ordering::Equal => return mantissa + (mantissa & 1),
            Ordering::Greater => mantissa += 1,
        }
    }
}

/// Orders `|numerator|` against `denominator * factor * 2^exponent`.
fn compare_shifted<const N: usize, const D: usize>(
    numerator: &Wide<N>,
    denominator: &Wide<D>,
    factor: u64,
    exponent: i32,
) -> Ordering {
    // Bit lengths decide unless they are close; then both sides fit a small common width after shifting.
    let product = multiply_limbs(denominator.limbs(), factor);
    let (left_shift, right_shift) =
        if exponent < 0 { (exponent.unsigned_abs(), 0) } else { (0, exponent as u32) };
    let left_bits = numerator.bits() + left_shift;
    let right_bits = limb_bits(&product) + right_shift;
    left_bits.cmp(&right_bits).then_with(|| {
        // Same length: walk both from the top.
        let chunks = left_bits.div_ceil(64);
        let chunk =
            |limbs: &[u64], shift: u32, index: u32| limb_at(limbs, i64::from(64 * index) - i64::from(shift));
        (0..chunks)
            .rev()
            .map(|i| chunk(numerator.limbs(), left_shift, i).cmp(&chunk(&product, right_shift, i)))
            .find(|order| order.is_ne())
            .unwrap_or(Ordering::Equal)
    })
}

/// Most limbs a denominator of [`rounded_quotient`] may have, with one more for a product.
const QUOTIENT_LIMBS: usize = 33;

fn multiply_limbs(limbs: &[u64], factor: u64) -> [u64; QUOTIENT_LIMBS] {
    let mut product = [0; QUOTIENT_LIMBS];
    let mut carry = 0_u128;
    for (out, &limb) in product.iter_mut().zip(limbs) {
        carry += u128::from(limb) * u128::from(factor);
        *out = carry as u64;
        carry >>= 64;
    }
    product[limbs.len()] = carry as u64;
    product
}

fn limb_bits(limbs: &[u64]) -> u32 {
    let used = limbs.iter().rposition(|&l| l != 0).map_or(0, |top| top + 1);
    if used == 0 { 0 } else { 64 * used as u32 - limbs[used - 1].leading_zeros() }
}

/// The 64 bits from bit `at`, which may be negative, up; zeros outside.
fn limb_at(limbs: &[u64], at: i64) -> u64 {
    let (index, bit) = (at.div_euclid(64), at.rem_euclid(64) as u32);
    let get = |i: i64| usize::try_from(i).ok().and_then(|i| limbs.get(i)).copied().unwrap_or(0);
    if bit == 0 { get(index) } else { (get(index) >> bit) | (get(index + 1) << (64 - bit)) }
}

/// The leading 64 bits of the magnitude, the highest one set, and the power of two they are worth.
fn leading_64<const N: usize>(value: &Wide<N>) -> (u64, i32) {
    let shift = i64::from(value.bits()) - 64;
    (limb_at(value.limbs(), shift), shift as i32)
}

/// `value * 2^exponent`, exact while the result is normal.
pub fn scale_by_power_of_two(value: f64, exponent: i32) -> f64 {
    let power = |e: i32| f64::from_bits(((e + 1023) as u64) << 52);
    match exponent {
        -1022..=1023 => value * power(exponent),
        1024.. => value * power(1023) * power((exponent - 1023).min(1023)),
        _ => value * power(-1022) * power((exponent + 1022).max(-1022)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use num_traits::{Signed, ToPrimitive, Zero};
    use proptest::prelude::*;

    type W = Wide<12>;

    /// Products of up to six random factors: short, long, sparse and equal ones.
    fn number() -> impl Strategy<Value = (W, BigInt)> {
        let factor = prop_oneof![
            any::<i64>(),
            -3_i64..4,
            (0_u32..63).prop_map(|k| 1_i64 << k),
            (0_u32..63).prop_map(|k| (1_i64 << k) - 1),
        ];
        proptest::collection::vec(factor, 1..6).prop_map(|factors| {
            let one = (W::from(1_i64), BigInt::from(1));
            factors.iter().fold(one, |(w, b), &f| (w.times(&Wide::<1>::from(f)), b * f))
        })
    }

    fn value(wide: &W) -> BigInt {
        let magnitude = wide.limbs.iter().rev().fold(BigInt::zero(), |sum, &l| (sum << 64) + l);
        if wide.negative { -magnitude } else { magnitude }
    }

    /// The nearest double by exact comparison with its neighbours.
    fn is_nearest(rounded: f64, exact: &BigRational) -> bool {
        let at = |x: f64| BigRational::from_float(x).expect("finite");
        let error = (at(rounded) - exact).abs();
        [rounded.next_down(), rounded.next_up()].iter().all(|&other| {
            let other_error = (at(other) - exact).abs();
            error < other_error || (error == other_error && rounded.to_bits() & 1 == 0)
        })
    }

    proptest! {
        #[test]
        fn arithmetic_is_that_of_integers((a, big_a) in number(), (b, big_b) in number()) {
            prop_assert_eq!(value(&a.plus(&b)), &big_a + &big_b);
            prop_assert_eq!(value(&a.minus(&b)), &big_a - &big_b);
            prop_assert_eq!(value(&a.times::<12, 12>(&b)), &big_a * &big_b);
            prop_assert_eq!(a.cmp(&b), big_a.cmp(&big_b));
            prop_assert_eq!(u64::from(a.bits()), big_a.bits());
            prop_assert_eq!(a.signum(), big_a.signum().to_i32().expect("small"));
            prop_assert_eq!(a.to_f64(), big_a.to_f64().expect("finite"));
        }

        #[test]
        fn powers_of_two_multiply_exactly_or_not_at_all((a, big_a) in number(), exponent in -400_i32..800) {
            let factor = BigInt::from(1) << exponent.unsigned_abs();
            let expected = if exponent < 0 {
                (&big_a % &factor).is_zero().then(|| &big_a / &factor)
            } else {
                Some(&big_a * &factor).filter(|product| product.bits() <= 12 * 64)
            };
            prop_assert_eq!(a.times_power_of_two(exponent).map(|product| value(&product)), expected);
            prop_assert_eq!(u64::from(a.trailing_zeros()), big_a.trailing_zeros().unwrap_or(0));
        }

        #[test]
        fn quotients_are_correctly_rounded((a, big_a) in number(), (b, big_b) in number()) {
            prop_assume!(b.signum() != 0);
            let (a, big_a) = if b.signum() < 0 { (a.negated(), -big_a) } else { (a, big_a) };
            let positive = if b.signum() < 0 { b.negated() } else { b };
            let quotient = rounded_quotient(&a, &positive);
            prop_assert!(is_nearest(quotient, &BigRational::new(big_a, big_b.abs())));
        }

        #[test]
        fn quotients_next_to_midpoints_are_settled(m in (1_i64 << 52)..(1_i64 << 53), w in 1_i64..i64::MAX, e in -1_i64..2, s in 1_i64..5) {
            // (2m + 1) w + e over 2 w: a hair above, below or at the middle of two doubles.
            let numerator = W::from(2 * m + 1).times::<1, 12>(&Wide::from(w)).plus(&W::from(e));
            let denominator = Wide::<2>::from(w).times::<1, 12>(&Wide::from(1_i64 << s));
            let exact = BigRational::new(value(&numerator), value(&denominator));
            prop_assert!(is_nearest(rounded_quotient(&numerator, &denominator), &exact));
        }
    }
}
