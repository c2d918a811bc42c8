//! The nearest point of a cubic: branch and bound on the squared distance, a sextic in Bernstein form, on the stack.

use super::Bounded;
use crate::math::Blend;

/// Unit roundoff.
const U: f64 = 0.5 * f64::EPSILON;

/// Parameter and distance from the origin of the nearest point of a cubic of about unit size; of several the first.
pub(super) fn nearest<P: Blend>(q: &[P; 4]) -> (f64, Bounded<f64>) {
    let square = square(q);
    let largest = square.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    // Three products of two components or more each are off by about 8 u of the largest, halvings add 6 u a level; the
    // bound is generous for some hundred levels.
    let error = 1024.0 * U * largest;
    let mut search = Search { q, error, best: (f64::INFINITY, 0.0) };
    search.consider(0.0);
    search.consider(1.0);
    search.piece(&square, 0.0, 1.0);
    let (best, t) = search.best;
    let value = best.sqrt();
    // A point is off by 10 u of the size in each axis, its norm by a few u, and the squared distance is within `tight` of
    // its minimum whatever the parameter errs.
    let size = largest.sqrt();
    let tight = 32.0 * U * largest;
    let error = 32.0 * U * size + tight / (value + tight.sqrt());
    (t, Bounded { value: point(q, t).0.norm(), error })
}

/// Bernstein coefficients of the squared distance.
#[inline]
fn square<P: Blend>(q: &[P; 4]) -> [f64; 7] {
    let of = |i: usize, j: usize| q[i].inner(q[j]);
    [
        of(0, 0),
        of(0, 1),
        0.4 * of(0, 2) + 0.6 * of(1, 1),
        0.1 * of(0, 3) + 0.9 * of(1, 2),
        0.4 * of(1, 3) + 0.6 * of(2, 2),
        of(2, 3),
        of(3, 3),
    ]
}

/// Point, derivative and second derivative.
#[inline]
fn point<P: Blend>(&[a, b, c, d]: &[P; 4], t: f64) -> (P, P, P) {
    let (p, q, r) = (a + (b - a) * t, b + (c - b) * t, c + (d - c) * t);
    let (v, w) = (p + (q - p) * t, q + (r - q) * t);
    let near_start = v + (w - v) * t;
    let value = if t == 1.0 { d } else { near_start };
    (value, (w - v) * 3.0, ((r - q) - (q - p)) * 6.0)
}

struct Search<'a, P> {
    q: &'a [P; 4],
    error: f64,
    /// The smallest squared distance found, and where.
    best: (f64, f64),
}

impl<P: Blend> Search<'_, P> {
    /// Looks at a piece of the squared distance.
    fn piece(&mut self, c: &[f64; 7], low: f64, high: f64) {
        let least = c.iter().fold(f64::INFINITY, |least: f64, &x| least.min(x));
        if least > self.best.0 + self.error {
            return;
        }
        let slope: [f64; 6] = std::array::from_fn(|i| c[i + 1] - c[i]);
        if slope.iter().all(|&x| x >= 0.0) || slope.iter().all(|&x| x <= 0.0) {
            // Monotone: the minimum is at an end, which is a neighbour's or the curve's.
            self.consider(if c[0] <= c[6] { low } else { high });
            return;
        }
        let changes = (0..5).filter(|&i| (slope[i] < 0.0) != (slope[i + 1] < 0.0)).count();
        if changes == 1 {
            if slope[0] < 0.0 {
                let t = self.minimum(low, high);
                self.consider(t);
            } else {
                self.consider(if c[0] <= c[6] { low } else { high });
            }
            return;
        }
        let middle = 0.5 * (low + high);
        // A piece all of whose values are the same but for rounding is no better elsewhere.
        if high - low < 64.0 * f64::EPSILON {
            return self.consider(middle);
        }
        let (mut left, mut right) = (*c, *c);
        for count in (1..7).rev() {
            for i in 0..count {
                right[i] = 0.5 * (right[i] + right[i + 1]);
            }
            left[7 - count] = right[0];
        }
        // The better half first: it shortens the other one.
        if left.iter().copied().fold(f64::INFINITY, f64::min)
            <= right.iter().copied().fold(f64::INFINITY, f64::min)
        {
            self.piece(&left, low, middle);
            self.piece(&right, middle, high);
        } else {
            self.piece(&right, middle, high);
            self.piece(&left, low, middle);
        }
    }

    /// The zero of the slope between a falling and a rising end: Newton's iteration kept within a bracket.
    fn minimum(&self, low: f64, high: f64) -> f64 {
        let (mut a, mut b) = (low, high);
        let mut t = 0.5 * (a + b);
        // Halving alone would take 60 steps.
        for _ in 0..64 {
            let (p, v, w) = point(self.q, t);
            let slope = p.inner(v);
            if slope < 0.0 {
                a = t;
            } else {
                b = t;
            }
            let step = slope / (v.inner(v) + p.inner(w));
            let next = t - step;
            let inside = next > a && next < b;
            // The step after this one would be below rounding, at an ordinary minimum.
            if step.abs() < 1e-9 && (low..=high).contains(&next) {
                return next;
            }
            t = if inside { next } else { 0.5 * (a + b) };
            if b - a < U {
                break;
            }
        }
        t
    }

    #[inline]
    fn consider(&mut self, t: f64) {
        let p = point(self.q, t).0;
        let square = p.inner(p);
        if square < self.best.0 || (square == self.best.0 && t < self.best.1) {
            self.best = (square, t);
        }
    }
}
