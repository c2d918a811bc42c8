//! Nearest points of cubics against the exact roots of the distance's derivative.
//!
//! `OGEE_CURVES_COUNT` queries, from `OGEE_CURVES_SEED` on; query `n` is the same in every run.

#![allow(clippy::print_stdout, reason = "tests say how much they did")]

#[allow(dead_code, reason = "each test program uses its part")]
mod roots;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use ogee::curve::{Bernstein, Cubic, nearest};
use ogee::math::Vec2;
use roots::{BITS, integers, monomials, trimmed};

/// A generator of numbers (Steele, Lea, Flood, SplitMix64, 2014).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Points anywhere, or of a coarse grid: cusps, lines, loops, points at equal distances.
    fn point(&mut self, coarse: bool) -> Vec2 {
        let p = Vec2::new(self.unit(), self.unit());
        if coarse { (p * 5.0).floor() } else { p }
    }
}

fn case(seed: u64) -> (Cubic<Vec2>, Vec2) {
    let mut random = Random(seed);
    let coarse = seed.is_multiple_of(4);
    let curve = Cubic::new([(); 4].map(|()| random.point(coarse))).unwrap();
    let point = match seed % 16 {
        // On the curve, on its evolute, far away.
        1 => curve.eval(random.unit()),
        2 => {
            let jet = ogee::curve::Curve::jet(&curve, random.unit());
            let center = jet.point + jet.first.normalize().perp() / jet.curvature();
            if center.is_finite() { center } else { jet.point }
        }
        3 => (random.point(false) - 0.5) * 1e6,
        _ => random.point(coarse) * 2.0 - random.point(coarse) * 0.5,
    };
    (curve, point)
}

/// The smallest distance, correctly rounded but for the last bit.
fn truth(curve: &Cubic<Vec2>, point: Vec2) -> f64 {
    let control = curve.to_array();
    let numbers: Vec<f64> = control.iter().chain([&point]).flat_map(|p| [p.x, p.y]).collect();
    let (whole, exponent) = integers(&numbers);
    let axes = [0, 1].map(|axis| {
        let row: Vec<BigInt> = (0..4).map(|k| &whole[2 * k + axis] - &whole[8 + axis]).collect();
        monomials(&row)
    });
    let mut square = vec![BigInt::ZERO; 7];
    for axis in &axes {
        for (i, x) in axis.iter().enumerate() {
            for (j, y) in axis.iter().enumerate() {
                square[i + j] += x * y;
            }
        }
    }
    let slope = trimmed(square.iter().enumerate().skip(1).map(|(k, c)| c * k).collect());
    let ends = [BigInt::ZERO, BigInt::from(1) << BITS];
    let turns = if slope.is_empty() { Vec::new() } else { roots::roots(&slope) };
    let places = turns.into_iter().map(|root| root.low).chain(ends);
    let best = places.map(|t| roots::value(&square, &t)).min().unwrap();
    let scale = BigRational::from_integer(BigInt::from(1) << BITS)
        * BigRational::from_integer(BigInt::from(1) << (-2 * exponent) as usize);
    (BigRational::from_integer(best) / scale).to_f64().unwrap().max(0.0).sqrt()
}

#[test]
fn nearest_points_are_nearest() {
    let setting = |name: &str, otherwise: u64| {
        std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
    };
    let (count, seed) = (setting("OGEE_CURVES_COUNT", 1500), setting("OGEE_CURVES_SEED", 1));
    let (mut wrong, mut worst) = (0, 0.0_f64);
    for seed in seed..seed + count {
        let (curve, point) = case(seed);
        let (found, want) = (nearest(&curve, point).unwrap(), truth(&curve, point));
        let size = curve.points().iter().fold(0.0, |most: f64, p| most.max((*p - point).length()));
        let reached = (curve.eval(found.t) - point).length();
        worst = worst.max((reached - want) / size);
        let is_right = (found.distance.value - want).abs() <= found.distance.error + 2e-16 * want
            && reached - want <= 4e-15 * size
            && found.distance.error <= 1e-7 * size;
        if !is_right {
            wrong += 1;
            println!("OGEE_CURVES_SEED={seed}: {found:?} for {want}, reached {reached}, {curve:?} {point:?}");
        }
    }
    println!("{count} queries from seed {seed}, {wrong} wrong, farther by at most {worst:.1e} of the size");
    assert_eq!(wrong, 0);
}
