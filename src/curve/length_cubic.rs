//! The length of a plane cubic. With points as complex numbers the derivative is a quadratic polynomial, and the speed is
//! analytic wherever neither that nor its conjugate vanishes: its two roots, in closed form, tell how fast Gauss'
//! quadrature converges on a piece, and where pieces must be cut. The bound of the error is that of
//! [`error_bound`](crate::numeric::quadrature::error_bound), with powers by squaring.

use super::Bounded;
use super::subdivide::reciprocal_powers;
use crate::numeric::quadrature::{GAUSS_8, GAUSS_16, GAUSS_24, GAUSS_32, Rule};

/// Unit roundoff.
const U: f64 = 0.5 * f64::EPSILON;
/// Ratio of a piece's ends' distances from a root, squared, at which 16 nodes give about 9 digits.
const GRADE: f64 = 1.0 / 7.0;
/// Pieces before the length is left to the method for all curves.
const MAX_PIECES: usize = 400;

type Complex = [f64; 2];

fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

fn plus(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

fn minus(a: Complex, b: Complex) -> Complex {
    [a[0] - b[0], a[1] - b[1]]
}

fn scaled(a: Complex, factor: f64) -> Complex {
    [a[0] * factor, a[1] * factor]
}

#[inline]
fn size([a, b]: Complex) -> f64 {
    (a * a + b * b).sqrt()
}

/// At least the size, and at most 1.5 times that: for bounds, without a root.
#[inline]
fn reach_of([a, b]: Complex) -> f64 {
    a.abs() + b.abs()
}

fn root([a, b]: Complex) -> Complex {
    let r = size([a, b]);
    let x = (0.5 * (r + a.abs())).sqrt();
    if x == 0.0 {
        return [0.0, 0.0];
    }
    let y = 0.5 * b.abs() / x;
    let (x, y) = if a >= 0.0 { (x, y) } else { (y, x) };
    [x, if b < 0.0 { -y } else { y }]
}

fn over(a: Complex, [c, d]: Complex) -> Complex {
    let square = c * c + d * d;
    scaled(times(a, [c, -d]), 1.0 / square)
}

/// The length to an accuracy, or what rounding allows; `None` where that takes too many pieces.
pub(super) fn length(points: [Complex; 4], accuracy: f64) -> Option<Bounded<f64>> {
    let largest = points.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    // Numbers near the limits of f64 are for the other method.
    if !(1e-280..1e280).contains(&largest) {
        return None;
    }
    let [first, second] = reciprocal_powers(largest);
    let scale = first * second;
    let [a, b, c, d] = points.map(|p| scaled(p, scale));
    let velocity = [minus(b, a), minus(c, b), minus(d, c)].map(|v| scaled(v, 3.0));
    let polygon: f64 = velocity.iter().map(|&v| reach_of(v)).sum::<f64>() / 3.0;
    // Finer than rounding is not to be had.
    let rounding = 24.0 * U * polygon;
    let wish = (accuracy * scale).max(4.0 * U * polygon);
    let walk = |share: f64| {
        let mut walk = Walk { velocity, roots: roots(&velocity), share, pieces: 0, length: 0.0, error: 0.0 };
        walk.piece(0.0, 1.0);
        (walk.pieces < MAX_PIECES).then_some(walk)
    };
    // Few pieces are expected; where their errors exceed the accuracy together, each gets less.
    let mut share = 0.125 * wish;
    let mut done = walk(share)?;
    while done.error > wish {
        share *= 0.0625;
        done = walk(share)?;
    }
    Some(Bounded { value: done.length / scale, error: ((done.error + rounding) / scale).next_up() })
}

/// Where the derivative vanishes, as a complex polynomial; infinite where there is no such place.
fn roots(&[u, v, w]: &[Complex; 3]) -> [Complex; 2] {
    let (a, half, c) = (plus(minus(u, scaled(v, 2.0)), w), minus(v, u), u);
    let discriminant = root(minus(times(half, half), times(a, c)));
    // The sum that does not cancel; the other root by their product.
    let aligned = half[0] * discriminant[0] + half[1] * discriminant[1] >= 0.0;
    let sum = scaled(if aligned { plus(half, discriminant) } else { minus(half, discriminant) }, -1.0);
    [over(sum, a), over(c, sum)]
        .map(|[x, y]| if x.is_nan() || y.is_nan() { [f64::INFINITY, 0.0] } else { [x, y] })
}

struct Walk {
    velocity: [Complex; 3],
    roots: [Complex; 2],
    /// What the error of a piece may be.
    share: f64,
    pieces: usize,
    length: f64,
    error: f64,
}

impl Walk {
    fn piece(&mut self, low: f64, high: f64) {
        self.pieces += 1;
        if self.pieces >= MAX_PIECES {
            return;
        }
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let [c0, c1, c2] = self.about(middle, half);
        let inverse = 1.0 / half;
        let sums = self.roots.map(|root| foci_distance(root, middle, inverse));
        let rho = ellipse(sums[0].min(sums[1]));
        if rho > 1.25 {
            let (limit, decay) = coefficient_limit(reach_of(c0), reach_of(c1), reach_of(c2), rho);
            if let Some((rule, bound)) = shortest_rule(half * limit, decay, self.share) {
                self.length += half * quadrature(rule, c0, c1, c2);
                self.error += bound;
                return;
            }
        }
        // Chord and polygon: by far enough around cusps.
        let ends = [minus(plus(c0, c2), c1), plus(plus(c0, c2), c1)];
        let inner = minus(c0, c2);
        let polygon = (size(ends[0]) + size(inner) + size(ends[1])) * 2.0 / 3.0;
        let chord = 2.0 * size(plus(c0, scaled(c2, 1.0 / 3.0)));
        let spread = 0.5 * half * (polygon - chord).max(0.0);
        if spread <= self.share {
            self.length += 0.5 * half * (polygon + chord);
            self.error += spread;
            return;
        }
        let worst = self.roots[usize::from(sums[1] < sums[0])][0];
        let cut = cut(low, high, worst);
        if !(cut > low && cut < high) {
            self.pieces = MAX_PIECES;
            return;
        }
        self.piece(low, cut);
        self.piece(cut, high);
    }

    /// Coefficients of the derivative by powers of the piece's own parameter, -1 to 1.
    #[inline]
    fn about(&self, t: f64, half: f64) -> [Complex; 3] {
        let [u, v, w] = self.velocity;
        let (p, q) = (plus(u, scaled(minus(v, u), t)), plus(v, scaled(minus(w, v), t)));
        let second = plus(minus(u, scaled(v, 2.0)), w);
        [plus(p, scaled(minus(q, p), t)), scaled(minus(q, p), 2.0 * half), scaled(second, half * half)]
    }
}

/// Where a piece is cut because of a root near it: there, if it is well inside, else graded towards it.
fn cut(low: f64, high: f64, root: f64) -> f64 {
    let width = high - low;
    let place = (root - low) / width;
    if place > GRADE && place < 1.0 - GRADE {
        root
    } else if place.abs() <= GRADE {
        low + width * (place.max(0.0) + GRADE)
    } else if (place - 1.0).abs() <= GRADE {
        high - width * ((1.0 - place).max(0.0) + GRADE)
    } else {
        low + 0.5 * width
    }
}

/// The mean of a root's distances from -1 and 1 in the piece's own parameter.
#[inline]
fn foci_distance([x, y]: Complex, middle: f64, inverse_half: f64) -> f64 {
    let w = [(x - middle) * inverse_half, y * inverse_half];
    if !(w[0].is_finite() && w[1].is_finite()) {
        return f64::INFINITY;
    }
    0.5 * (size([w[0] - 1.0, w[1]]) + size([w[0] + 1.0, w[1]]))
}

/// The sum of half-axes of the ellipse about -1 and 1 whose points have that mean distance, a little less for rounding;
/// at most 8, which is as good as infinite.
#[inline]
fn ellipse(distance: f64) -> f64 {
    // It is the mean of rho and 1 / rho.
    let sum = distance.min(4.0625) * (1.0 - 1e-9);
    sum + (sum * sum - 1.0).max(0.0).sqrt()
}

/// A bound of the speed in the ellipse times what n nodes leave of it but for the power of rho, and rho^-16.
#[inline]
fn coefficient_limit(c0: f64, c1: f64, c2: f64, rho: f64) -> (f64, f64) {
    // The derivative is at most the sum of its terms at the ellipse's far end.
    let inverse = 1.0 / rho;
    let reach = 0.5 * (rho + inverse);
    let square = inverse * inverse;
    let eighth = square * square * square * square;
    // 4 (1 + 1 / (4 n^2 - 1)) rho^-2n / (1 - rho^-2), the second factor that of 8 nodes, which is the largest.
    let limit = 4.0 * (256.0 / 255.0) * (c0 + reach * (c1 + reach * c2)) / (1.0 - square);
    (limit, eighth * eighth)
}

/// The rule with the fewest nodes whose error is at most `share`, and its bound.
#[inline]
fn shortest_rule(limit: f64, decay: f64, share: f64) -> Option<(&'static Rule, f64)> {
    let mut bound = limit;
    [GAUSS_8, GAUSS_16, GAUSS_24, GAUSS_32].into_iter().find_map(|rule| {
        bound *= decay;
        (bound <= share).then_some((rule, bound))
    })
}

/// The integral of the speed over [-1, 1], four nodes and their mirror images at a time.
#[inline]
fn quadrature(rule: &Rule, c0: Complex, c1: Complex, c2: Complex) -> f64 {
    let mut sums = [0.0; 4];
    for nodes in rule.as_chunks::<4>().0 {
        for (sum, &(x, weight)) in sums.iter_mut().zip(nodes) {
            let square = x * x;
            let even = [c0[0] + c2[0] * square, c0[1] + c2[1] * square];
            let odd = [c1[0] * x, c1[1] * x];
            *sum += weight * (size(plus(even, odd)) + size(minus(even, odd)));
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{ArcLength, Cubic};
    use crate::math::Vec2;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn both_methods_agree(points in prop::array::uniform4((-1.0..1.0_f64, -1.0..1.0_f64)), kind in 0..4) {
            // Cusps nearly: the ends' mirror images with the inner points exchanged, almost.
            let points = match kind {
                0 => [points[0], (-points[0].0, points[3].1), (points[0].0, points[3].1), (-points[0].0, points[0].1)],
                1 => [points[0], points[0], points[2], points[3]],
                _ => points,
            };
            let curve = Cubic::new(points.map(Vec2::from)).unwrap();
            for accuracy in [1e-3, 1e-9, 1e-13] {
                let fast = length(points.map(|(x, y)| [x, y]), accuracy).unwrap();
                let slow = ArcLength::new(&curve, 1e-13).unwrap().total();
                prop_assert!((fast.value - slow.value).abs() <= fast.error + slow.error, "{fast:?} {slow:?}");
                prop_assert!(fast.error <= accuracy + 1e-14, "{fast:?} at {accuracy}");
            }
        }
    }
}
