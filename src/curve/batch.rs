use super::evaluate::{MAX_HORNER_DEGREE, eval};
use crate::math::Blend;
use crate::numeric::double_double::{DoubleDouble, two_sum};

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
    match P::DIMENSION {
        1 => in_dimension::<P, 1>(points, parameters, out),
        2 => in_dimension::<P, 2>(points, parameters, out),
        3 => in_dimension::<P, 3>(points, parameters, out),
        _ => in_dimension::<P, 4>(points, parameters, out),
    }
}

fn in_dimension<P: Blend, const D: usize>(points: &[P], parameters: &[f64], out: &mut [P]) {
    if let [a, b, c, d] = *points {
        let centred = centred::<P, D>([a, b, c, d]);
        blocks(points, parameters, out, |t, out| cubic_block(&centred, t, out));
    } else {
        let scaled = with_binomials(points);
        blocks(points, parameters, out, |t, out| horner_block::<P, D>(&scaled, t, out));
    }
}

/// Runs `block` over the parameters, eight at a time, and puts the ends where they belong: the last bits of a sum are not
/// those of an end point.
#[inline]
fn blocks<P: Blend>(
    points: &[P],
    parameters: &[f64],
    out: &mut [P],
    block: impl Fn(&[f64; LANES], &mut [P; LANES]),
) {
    let ends = [points[0], points[points.len() - 1]];
    let whole = |t: &[f64; LANES], out: &mut [P; LANES]| {
        block(t, out);
        if t.iter().fold(false, |any, &t| any | (t == 0.0) | (t == 1.0)) {
            for (place, &t) in out.iter_mut().zip(t) {
                *place = if t == 0.0 { ends[0] } else { *place };
                *place = if t == 1.0 { ends[1] } else { *place };
            }
        }
    };
    let (chunks, rest) = parameters.as_chunks::<LANES>();
    let (places, last) = out.as_chunks_mut::<LANES>();
    for (t, out) in chunks.iter().zip(places) {
        whole(t, out);
    }
    if !rest.is_empty() {
        let (mut t, mut points) = ([0.5; LANES], [P::ZERO; LANES]);
        t[..rest.len()].copy_from_slice(rest);
        whole(&t, &mut points);
        last.copy_from_slice(&points[..last.len()]);
    }
}

/// Coefficients of a cubic by powers of 2t - 1: there the powers are at most 1 and the coefficients no larger than twice
/// the points, so that Horner's scheme is off by a few u only. Sums are taken with their errors.
fn centred<P: Blend, const D: usize>([a, b, c, d]: [P; 4]) -> [[f64; 4]; D] {
    std::array::from_fn(|axis| {
        let [a, b, c, d] = [a, b, c, d].map(|p| p.component(axis));
        let ((outer, outer_rest), (inner, inner_rest)) = (two_sum(a, d), two_sum(b, c));
        let ((wide, wide_rest), (narrow, narrow_rest)) = (two_sum(d, -a), two_sum(c, -b));
        [
            0.125 * ((outer + 3.0 * inner) + (outer_rest + 3.0 * inner_rest)),
            0.375 * ((wide + narrow) + (wide_rest + narrow_rest)),
            0.375 * ((outer - inner) + (outer_rest - inner_rest)),
            0.125 * ((wide - 3.0 * narrow) + (wide_rest - 3.0 * narrow_rest)),
        ]
    })
}

#[inline]
fn cubic_block<P: Blend, const D: usize>(c: &[[f64; 4]; D], t: &[f64; LANES], out: &mut [P; LANES]) {
    let mut values = [[0.0; LANES]; D];
    for (values, [c0, c1, c2, c3]) in values.iter_mut().zip(c) {
        for lane in 0..LANES {
            let x = (t[lane] + t[lane]) - 1.0;
            values[lane] = c0 + x * (c1 + x * (c2 + x * c3));
        }
    }
    for (lane, place) in out.iter_mut().enumerate() {
        *place = P::from_components(|axis| values[axis][lane]);
    }
}

/// The control points times their binomials, each rounded once.
fn with_binomials<P: Blend>(points: &[P]) -> Vec<P> {
    let n = points.len() - 1;
    let mut binomial = DoubleDouble::from(1.0);
    let weigh = |(k, &point): (usize, &P)| {
        let weighted = point.map(|x| (binomial * x).to_f64());
        binomial = binomial * (n - k) as f64 / DoubleDouble::from((k + 1) as f64);
        weighted
    };
    points.iter().enumerate().map(weigh).collect()
}

/// Horner-Bernstein over eight parameters and `D` components at once.
///
/// Where `1 - t` is rounded to s, the form gives the value at t / (t + s) times (t + s)^n; the power is taken out again.
#[inline]
fn horner_block<P: Blend, const D: usize>(scaled: &[P], t: &[f64; LANES], out: &mut [P; LANES]) {
    let n = scaled.len() - 1;
    let mut sums = [[0.0; LANES]; D];
    let mut power = [1.0; LANES];
    let mut rest = [0.0; LANES];
    let mut correction = [0.0; LANES];
    for lane in 0..LANES {
        rest[lane] = 1.0 - t[lane];
        correction[lane] = n as f64 * ((1.0 - rest[lane]) - t[lane]);
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
            let value = sum[lane] + power[lane] * b;
            sum[lane] = value + value * correction[lane];
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
