//! The cubics that match end points, tangents, area and first moment: Levien's quartic.

use crate::curve::bernstein::roots;
use crate::math::Vec2;
use crate::numeric::quadrature::{GAUSS_8, integrate};

/// Arms longer than this many chords are not looked for: that of three quarters of a circle has 2.3.
const LONGEST: f64 = 4.0;

/// What is matched, in the frame in which the chord runs from (0, 0) to (1, 0).
#[derive(Clone, Copy, Debug)]
struct Target {
    /// Unit tangent at the start.
    start: Vec2,
    /// Unit tangent at the end.
    end: Vec2,
    /// Integral of y dx.
    area: f64,
    /// Integral of x y dx.
    moment: f64,
}

/// Integrals of y dx and x y dx along a cubic.
pub(super) fn integrals(points: &[Vec2; 4]) -> [f64; 2] {
    let [a, b, c, d] = *points;
    let at = |t: f64| {
        let s = 1.0 - t;
        let point = a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t);
        (point, ((b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t)) * 3.0)
    };
    // Of degree 5 and 8: eight nodes are exact.
    let area = integrate(GAUSS_8, 0.0, 1.0, |t| at(t).0.y * at(t).1.x);
    let moment = integrate(GAUSS_8, 0.0, 1.0, |t| at(t).0.x * at(t).0.y * at(t).1.x);
    [area, moment]
}

/// The cubics with these ends and unit tangents there that have integrals of y dx and x y dx, both in the frame in which
/// the chord runs from (0, 0) to (1, 0); and that with arms of a third of `polygon`, about the length: where things are
/// straight as far as rounding can tell the integrals mean nothing.
pub(super) fn candidates(
    [start, end]: [Vec2; 2],
    [leaving, arriving]: [Vec2; 2],
    [area, moment]: [f64; 2],
    polygon: f64,
) -> impl Iterator<Item = [Vec2; 4]> {
    let chord = end - start;
    let length = chord.length();
    let local = |v: Vec2| Vec2::new(v.dot(chord), chord.perp_dot(v)) / length;
    let target = Target { start: local(leaving), end: local(arriving), area, moment };
    let third = polygon / (3.0 * length);
    arms(&target)
        .into_iter()
        .chain([[third; 2]])
        .map(move |[p, q]| [start, start + leaving * (p * length), end - arriving * (q * length), end])
}

/// Lengths of both arms, in chords, of the cubics that match the target: at most four pairs (Levien, Fitting cubic
/// Bézier curves, 2021).
///
/// With arms p and q the area is 3/20 (2 p s0 + 2 q s1 - p q S), S the sine of the sum of both angles; that gives q as
/// a quotient of linear functions of p, and the moment, of second degree in q, becomes a quartic of p.
fn arms(target: &Target) -> Vec<[f64; 2]> {
    let (c0, s0, c1, s1) = (target.start.x, target.start.y, target.end.x, -target.end.y);
    let sum = s0 * c1 + c0 * s1;
    let (over, under) = ([20.0 / 3.0 * target.area, -2.0 * s0], [2.0 * s1, -sum]);
    let quartic = quartic(target, over, under, sum);
    let value = |[a, b]: [f64; 2], p: f64| a + b * p;
    let pair = |p: f64| [p, value(over, p) / value(under, p)];
    let fits = |[p, q]: &[f64; 2]| *p > 0.0 && *q > 0.0 && *q <= LONGEST;
    let found = positive_roots(&quartic);
    let pairs: Vec<[f64; 2]> = found.into_iter().map(pair).filter(fits).collect();
    if !pairs.is_empty() {
        return pairs;
    }
    // A target that no cubic matches, by rounding or because a double root just misses: the nearest misses.
    let slope: Vec<f64> = (1..5).map(|k| k as f64 * quartic[k]).collect();
    positive_roots(&slope).into_iter().map(pair).filter(fits).collect()
}

/// 280 times the moment's misfit times the square of the quotient's denominator, as coefficients of powers of p.
fn quartic(target: &Target, over: [f64; 2], under: [f64; 2], sum: f64) -> [f64; 5] {
    let (c0, s0, c1, s1) = (target.start.x, target.start.y, target.end.x, -target.end.y);
    let (nn, nd, dd) = (product(over, over), product(over, under), product(under, under));
    let terms = [
        (0, dd, -280.0 * target.moment),
        (1, dd, 34.0 * s0),
        (2, dd, 15.0 * s0 * c0),
        (0, nd, 50.0 * s1),
        (0, nn, -15.0 * s1 * c1),
        (1, nd, -(33.0 * s0 * c1 + 9.0 * c0 * s1)),
        (2, nd, -9.0 * sum * c0),
        (1, nn, 9.0 * sum * c1),
    ];
    let mut coefficients = [0.0; 5];
    for (power, factor, weight) in terms {
        for (k, value) in factor.into_iter().enumerate() {
            coefficients[power + k] += weight * value;
        }
    }
    coefficients
}

fn product([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 3] {
    [a * c, a * d + b * c, b * d]
}

/// Roots in (0, [`LONGEST`]] of a polynomial given by its coefficients of powers.
fn positive_roots(powers: &[f64]) -> Vec<f64> {
    let degree = powers.len() - 1;
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    let scaled: Vec<f64> = (0..=degree).map(|k| powers[k] * LONGEST.powi(k as i32)).collect();
    let bernstein: Vec<f64> =
        (0..=degree).map(|i| (0..=i).map(|k| choose(i, k) / choose(degree, k) * scaled[k]).sum()).collect();
    let size: f64 = scaled.iter().map(|c| c.abs()).sum();
    roots(&bernstein, 8.0 * f64::EPSILON * size).isolated().into_iter().map(|root| root.t * LONGEST).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The cubic with these arms, over the unit chord.
    fn cubic(angles: [f64; 2], [p, q]: [f64; 2]) -> ([Vec2; 4], Vec2, Vec2) {
        let [start, end] = angles.map(crate::math::sin_cos).map(|(s, c)| Vec2::new(c, s));
        ([Vec2::ZERO, start * p, Vec2::X - end * q, Vec2::X], start, end)
    }

    proptest! {
        #[test]
        fn a_cubic_is_found_from_its_integrals(
            first in -1.4..1.4_f64, last in -1.4..1.4_f64, p in 0.05..1.5_f64, q in 0.05..1.5_f64,
        ) {
            // Where both angles nearly vanish nothing can be told from area and moment.
            prop_assume!(first.abs() > 0.05 && last.abs() > 0.05);
            let (points, start, end) = cubic([first, last], [p, q]);
            let [area, moment] = integrals(&points);
            let found = arms(&Target { start, end, area, moment });
            let off = |pair: &[f64; 2]| (pair[0] - p).abs().max((pair[1] - q).abs());
            let best = found.iter().map(off).fold(f64::INFINITY, f64::min);
            // A double root is known to half of the digits.
            prop_assert!(best < 1e-4, "{:?} for {} {}", found, p, q);
        }
    }

    #[test]
    fn a_quarter_of_a_circle() {
        let r = 0.5_f64.sqrt();
        let (start, end) = (Vec2::new(r, r), Vec2::new(r, -r));
        // The segment's area over the chord; the moment is that about the middle.
        let area = (std::f64::consts::PI / 4.0 - 0.5) / 2.0;
        let found = arms(&Target { start, end, area, moment: 0.5 * area });
        let known = (4.0 / 3.0 * (2.0_f64.sqrt() - 1.0)) * r;
        assert!(found.iter().any(|[p, q]| (p - q).abs() < 1e-9 && (p - known).abs() < 5e-4), "{found:?}");
    }
}
