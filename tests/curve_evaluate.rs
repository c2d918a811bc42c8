//! Every method of evaluation against exact rational arithmetic.

use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive, Zero};
use ogee::curve::evaluate::{
    bernstein, compensated, de_casteljau, forward_differences, horner, horner_bernstein, schumaker_volk,
    wozny_chudy,
};
use ogee::curve::{AnyBezier, Bernstein, Bounded, Cubic, monomials};
use ogee::math::Vec2;
use proptest::prelude::*;

const U: f64 = 0.5 * f64::EPSILON;

/// An exact number: an integer over a power of two.
struct Exact {
    numerator: BigInt,
    exponent: usize,
}

/// Enough for the lowest bit of any `f64`.
const LOWEST: usize = 1074;

/// A number times 2^1074, an integer.
fn integer(x: f64) -> BigInt {
    let bits = x.abs().to_bits();
    let (exponent, fraction) = ((bits >> 52) as usize, bits & ((1 << 52) - 1));
    let magnitude = if exponent == 0 {
        BigInt::from(fraction)
    } else {
        BigInt::from(fraction | (1 << 52)) << (exponent - 1)
    };
    if x < 0.0 { -magnitude } else { magnitude }
}

/// The exact value and the exact sum of `|b_i| |B_i(t)|`.
fn exact(points: &[f64], t: f64) -> (Exact, f64) {
    let n = points.len() - 1;
    // t = whole / 2^places with places as few as possible.
    let (mut whole, mut places) = (integer(t), LOWEST);
    while places > 0 && !whole.bit(0) {
        whole >>= 1;
        places -= 1;
    }
    let rest = (BigInt::one() << places) - &whole;
    let mut rest_powers = vec![BigInt::one()];
    for k in 0..n {
        rest_powers.push(&rest_powers[k] * &rest);
    }
    let (mut value, mut size) = (BigInt::zero(), BigInt::zero());
    let (mut binomial, mut power) = (BigInt::one(), BigInt::one());
    for (i, &b) in points.iter().enumerate() {
        let weight = &binomial * &power * &rest_powers[n - i];
        let b = integer(b);
        size += (&weight * &b).abs();
        value += weight * b;
        binomial = binomial * (n - i) / (i + 1);
        power *= &whole;
    }
    let exponent = places * n + LOWEST;
    (Exact { numerator: value, exponent }, Exact { numerator: size, exponent }.to_f64())
}

impl Exact {
    /// The nearest number but for a few units in the last place.
    fn to_f64(&self) -> f64 {
        let bits = self.numerator.bits() as usize;
        let shift = bits.saturating_sub(64);
        let top = (&self.numerator >> shift).to_f64().expect("64 bits");
        let exponent = shift as i64 - self.exponent as i64;
        let (half, rest) = (exponent / 2, exponent - exponent / 2);
        top * 2.0_f64.powi(half as i32) * 2.0_f64.powi(rest as i32)
    }
}

fn off(got: f64, want: &Exact) -> f64 {
    let got = integer(got) << (want.exponent - LOWEST);
    Exact { numerator: (got - &want.numerator).abs(), exponent: want.exponent }.to_f64()
}

fn wild_points(degree: usize) -> Vec<f64> {
    // Numbers with full mantissas and changing signs.
    (0..=degree).map(|i| ((i * i * 7919 + 13 * i) % 1009) as f64 / 1009.0 - 0.4).collect()
}

#[test]
fn each_method_keeps_its_bound() {
    type Method = fn(&[f64], f64) -> f64;
    type Bound = fn(f64) -> f64;
    let methods: [(&str, Method, Bound); 5] = [
        ("de Casteljau", de_casteljau, |n| 3.0 * n),
        ("Bernstein", bernstein, |n| 3.0 * n),
        ("Horner-Bernstein", horner_bernstein, |n| 3.0 * n + 1.0),
        ("Schumaker-Volk", schumaker_volk, |n| 4.0 * n),
        ("Wozny-Chudy", wozny_chudy, |n| 5.0 * n * n),
    ];
    for degree in [1, 2, 3, 5, 10, 30, 100] {
        let points = wild_points(degree);
        for k in 0..=24 {
            let t = f64::from(k) / 24.0;
            let (value, size) = exact(&points, t);
            for (name, method, bound) in methods {
                let error = off(method(&points, t), &value);
                assert!(error <= bound(degree as f64) * U * size, "{name}, degree {degree} at {t}: {error}");
            }
            let Bounded { value: got, error } = compensated(&points, t);
            assert!(off(got, &value) <= error, "compensated, degree {degree} at {t}");
            assert!(error <= 1.01 * U * got.abs() + 1e-25 * size, "degree {degree} at {t}");
            assert_eq!(AnyBezier::new(points.clone()).unwrap().eval(0.0), points[0]);
        }
    }
}

#[test]
fn monomials_lose_digits_with_the_degree() {
    let worst = |degree: usize| {
        let curve = AnyBezier::new(wild_points(degree)).unwrap();
        let coefficients = monomials(&curve);
        let errors = (0..=16).map(|k| f64::from(k) / 16.0);
        errors.map(|t| off(horner(&coefficients, t), &exact(curve.points(), t).0)).fold(0.0, f64::max)
    };
    assert!(worst(3) < 20.0 * U);
    assert!(worst(30) > 1e6 * U);
}

#[test]
fn forward_differences_drift_as_documented() {
    let points = wild_points(3);
    let out = forward_differences(&points, 1024);
    assert_eq!(out.len(), 1025);
    assert_eq!((out[0], out[1024]), (points[0], points[3]));
    for (k, got) in out.iter().enumerate() {
        assert!(off(*got, &exact(&points, k as f64 / 1024.0).0) < 5000.0 * U, "{k}");
    }
}

#[test]
fn high_degrees_are_finite_and_right() {
    for degree in [100, 200, 512, 513, 1030, 2000] {
        let points = wild_points(degree);
        let curve = AnyBezier::new(points.clone()).unwrap();
        for t in [1e-3, 0.25, 0.5, 0.9, 0.999] {
            let (value, size) = exact(&points, t);
            assert!(off(curve.eval(t), &value) < 40.0 * U * size, "degree {degree} at {t}");
            assert!(off(wozny_chudy(&points, t), &value) < 40.0 * U * size);
            let bounded = curve.eval_bounded(t);
            assert!(off(bounded.value, &value) <= bounded.error && bounded.error < 1e-15, "{degree} {t}");
        }
        assert_eq!((curve.eval(0.0), curve.eval(1.0)), (points[0], points[degree]));
    }
}

#[test]
fn ill_conditioned_values_are_compensated() {
    // (s - 1)(s - 3/4)^7 by products in Bernstein form, exact in 64 bits: all roots are dyadic.
    let mut points = vec![1.0];
    for root in [1.0, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75] {
        let n = points.len();
        let mut product = vec![0.0; n + 1];
        for (i, b) in points.iter().enumerate() {
            product[i] += b * -root * (n - i) as f64 / n as f64;
            product[i + 1] += b * (1.0 - root) * (i + 1) as f64 / n as f64;
        }
        points = product;
    }
    let curve = AnyBezier::new(points.clone()).unwrap();
    let t = 0.75 + 1.01 / 256.0;
    let (value, size) = exact(&points, t);
    let true_value = value.to_f64();
    assert!(size / true_value.abs() > 1e12, "the case is hard");
    assert!(off(de_casteljau(&points, t), &value) > 1e-6 * true_value.abs(), "plain evaluation fails");
    assert!(off(curve.eval(t), &value) <= 2.0 * U * true_value.abs());
    let bounded = curve.eval_bounded(t);
    assert!(off(bounded.value, &value) <= bounded.error && bounded.error <= 32.0 * U * true_value.abs());
}

#[test]
fn equal_points_and_ends_are_exact() {
    let flat = Cubic::new([0.1; 4]).unwrap();
    for k in 0..=1000 {
        assert_eq!(flat.eval(f64::from(k) / 1000.0), 0.1);
    }
    let high = AnyBezier::new(vec![0.1; 101]).unwrap();
    for k in 0..=1000 {
        let bounded = high.eval_bounded(f64::from(k) / 1000.0);
        assert!((bounded.value - 0.1).abs() <= bounded.error && bounded.value == 0.1);
    }
}

#[test]
fn the_limits_of_range() {
    let swing = Cubic::new([-1.7e308, -1.7e308, 1.7e308, 1.7e308]).unwrap();
    assert_eq!(swing.eval(0.5), 0.0);
    assert_eq!(swing.split(0.5).unwrap().0.end(), 0.0);
    let huge = Cubic::new([1e308, -1e308, 1.5e308, 1e308]).unwrap();
    let same = huge.map(|x| x * 2.0_f64.powi(-1000)).unwrap();
    assert_eq!(huge.eval(0.3), same.eval(0.3) * 2.0_f64.powi(1000));
    let tiny = f64::from_bits(1);
    let small = Cubic::new([0.0, 3.0 * tiny, 9.0 * tiny, 16.0 * tiny]).unwrap();
    // (3 * 3 + 3 * 9 + 16) / 8 = 6.5 rounds to even.
    assert_eq!(small.eval(0.5), 6.0 * tiny);
    let bounded = small.eval_bounded(0.5);
    assert!(off(bounded.value, &exact(small.points(), 0.5).0) <= bounded.error);
    assert!(bounded.error <= 4.0 * tiny);
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1.0..1.0_f64,
        (-300..300_i32, -1.0..1.0_f64).prop_map(|(e, m)| m * 2.0_f64.powi(e)),
        Just(0.0),
        Just(1.0),
        (0..4_u64).prop_map(|ulps| f64::from_bits(1.0_f64.to_bits() + ulps)),
    ]
}

proptest! {
    #[test]
    fn running_bounds_hold(
        points in prop::collection::vec(coordinate(), 1..24),
        t in prop_oneof![0.0..1.0_f64, -2.0..3.0_f64, Just(1e-300), Just(1.0 - U), -1e-9..1e-9_f64],
    ) {
        let bounded = AnyBezier::new(points.clone()).unwrap().eval_bounded(t);
        prop_assert!(off(bounded.value, &exact(&points, t).0) <= bounded.error);
    }

    #[test]
    fn bounds_hold_in_any_range(
        points in prop::collection::vec(-1.0..1.0_f64, 2..9),
        scale in prop_oneof![Just(f64::MAX), Just(1e-307), Just(1e-318)],
        t in 0.0..1.0_f64,
    ) {
        let points: Vec<f64> = points.iter().map(|x| x * scale).collect();
        let curve = AnyBezier::new(points.clone()).unwrap();
        let bounded = curve.eval_bounded(t);
        prop_assert!(bounded.value.is_finite());
        prop_assert!(off(bounded.value, &exact(&points, t).0) <= bounded.error);
        prop_assert!((curve.eval(t) - bounded.value).abs() <= 16.0 * f64::EPSILON * scale + 4.0 * bounded.error);
    }

    #[test]
    fn methods_agree_in_the_plane(
        points in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 1..20), t in 0.0..1.0_f64,
    ) {
        let points: Vec<Vec2> = points.into_iter().map(Vec2::from).collect();
        let want = compensated(&points, t).value;
        for method in [de_casteljau, bernstein, horner_bernstein, schumaker_volk, wozny_chudy] {
            prop_assert!((method(&points, t) - want).length() < 1e-13);
        }
        let rows = AnyBezier::new(points.clone()).unwrap().construction(t);
        prop_assert_eq!(rows.len(), points.len());
        prop_assert!((rows[points.len() - 1][0] - want).length() < 1e-13);
    }
}
