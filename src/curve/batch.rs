use super::evaluate::{MAX_HORNER_DEGREE, eval, next_binomial};
use crate::math::Blend;

/// Parameters handled side by side, so that the loops below become vector instructions.
const LANES: usize = 8;

/// See [`super::Bernstein::eval_batch`].
pub(super) fn eval_batch<P: Blend>(points: &[P], parameters: &[f64], out: &mut [P]) {
    assert_eq!(parameters.len(), out.len(), "a place for each point");
    let n = points.len() - 1;
    let size = points.iter().fold(0.0, |most: f64, point| most.max(point.max_abs()));
    if n > MAX_HORNER_DEGREE || !super::evaluate::SAFE_SIZES.contains(&size) {
        for (place, &t) in out.iter_mut().zip(parameters) {
            *place = eval(points, t);
        }
        return;
    }
    let scaled = with_binomials(points);
    for (places, parameters) in out.chunks_mut(LANES).zip(parameters.chunks(LANES)) {
        let mut lanes = [0.0; LANES];
        lanes[..parameters.len()].copy_from_slice(parameters);
        match P::DIMENSION {
            1 => block::<P, 1>(&scaled, &lanes, places),
            2 => block::<P, 2>(&scaled, &lanes, places),
            3 => block::<P, 3>(&scaled, &lanes, places),
            _ => block::<P, 4>(&scaled, &lanes, places),
        }
        for (place, &t) in places.iter_mut().zip(parameters) {
            // The last bits of the sum are not those of the end point where `1 - t` is 0 or 1 exactly.
            if t == 1.0 {
                *place = points[n];
            }
        }
    }
}

/// The control points times their binomials.
fn with_binomials<P: Blend>(points: &[P]) -> Vec<P> {
    let n = points.len() - 1;
    let mut binomial = 1.0;
    let weigh = |(k, &point): (usize, &P)| {
        let weighted = point * binomial;
        binomial = next_binomial(binomial, n, k);
        weighted
    };
    points.iter().enumerate().map(weigh).collect()
}

/// Horner-Bernstein over eight parameters and `D` components at once.
#[inline]
fn block<P: Blend, const D: usize>(scaled: &[P], t: &[f64; LANES], out: &mut [P]) {
    let n = scaled.len() - 1;
    let mut sums = [[0.0; LANES]; D];
    let mut power = [1.0; LANES];
    let mut rest = [0.0; LANES];
    for lane in 0..LANES {
        rest[lane] = 1.0 - t[lane];
    }
    for point in &scaled[..n] {
        for (axis, sum) in sums.iter_mut().enumerate() {
            let b = point.component(axis);
            for lane in 0..LANES {
                sum[lane] = (sum[lane] + power[lane] * b) * rest[lane];
            }
        }
        for lane in 0..LANES {
            power[lane] *= t[lane];
        }
    }
    for (axis, sum) in sums.iter_mut().enumerate() {
        let b = scaled[n].component(axis);
        for lane in 0..LANES {
            sum[lane] += power[lane] * b;
        }
    }
    for (lane, place) in out.iter_mut().enumerate() {
        *place = P::from_components(|axis| sums[axis][lane]);
    }
}

#[cfg(test)]
mod tests {
    use crate::curve::{AnyBezier, Bernstein};
    use crate::math::Vec3;

    #[test]
    fn batches_agree_with_single_points_and_are_exact_at_the_ends() {
        for degree in [0, 1, 2, 3, 7, 30, 100, 600] {
            let points = (0..=degree).map(|i| {
                let i = i as f64;
                Vec3::new(i % 7.0 + 0.1, 3.0 + i % 3.0, 0.3 * (i % 5.0) + 1.0)
            });
            let curve = AnyBezier::new(points.collect()).unwrap();
            let parameters: Vec<f64> = (0..=42).map(|k| f64::from(k) / 42.0).collect();
            let mut out = vec![Vec3::ZERO; parameters.len()];
            curve.eval_batch(&parameters, &mut out);
            assert_eq!((out[0], out[42]), (curve.start(), curve.end()));
            for (&t, got) in parameters.iter().zip(out) {
                let bound = 1e-15 * (degree as f64 + 4.0);
                assert!((got - curve.eval(t)).length() < bound * got.length(), "degree {degree} at {t}");
            }
        }
    }

    #[test]
    fn huge_and_tiny_curves_are_right_in_batches_too() {
        for scale in [1e308, 1e-310] {
            let curve = AnyBezier::new(vec![scale, -scale, scale, -scale]).unwrap();
            let mut out = [0.0; 3];
            curve.eval_batch(&[0.0, 0.5, 0.25], &mut out);
            assert_eq!(out[..2], [scale, 0.0]);
            assert_eq!(out[2], curve.eval(0.25));
        }
    }
}
