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
    let ends = [points[0], points[points.len() - 1]];
    if let [a, b, c, d] = *points {
        let centred = centred::<P, D>([a, b, c, d]);
        blocks(parameters, out, |t, out| cubic_blocks(&centred, ends, t, out));
    } else {
        let middle = middle_of_box(points);
        let weighted = with_binomials(points, middle);
        blocks(parameters, out, |t, out| horner_blocks::<P, D>(&weighted, middle, ends, t, out));
    }
}

/// Runs `work` over the parameters, eight at a time, the last ones filled up to eight.
#[inline(always)]
fn blocks<P: Blend>(parameters: &[f64], out: &mut [P], work: impl Fn(&[[f64; LANES]], &mut [[P; LANES]])) {
    let (chunks, rest) = parameters.as_chunks::<LANES>();
    let (places, last) = out.as_chunks_mut::<LANES>();
    work(chunks, places);
    if !rest.is_empty() {
        let (mut t, mut points) = ([[0.5; LANES]], [[P::ZERO; LANES]]);
        t[0][..rest.len()].copy_from_slice(rest);
        work(&t, &mut points);
        last.copy_from_slice(&points[0][..last.len()]);
    }
}

/// One loop, in which the coefficients stay where they are.
fn cubic_blocks<P: Blend, const D: usize>(
    c: &[[f64; 4]; D],
    ends: [P; 2],
    t: &[[f64; LANES]],
    out: &mut [[P; LANES]],
) {
    for (t, out) in t.iter().zip(out) {
        cubic_block(c, t, out);
        if reach_ends(t) {
            put_ends(ends, t, out);
        }
    }
}

fn horner_blocks<P: Blend, const D: usize>(
    weighted: &[P],
    middle: P,
    ends: [P; 2],
    t: &[[f64; LANES]],
    out: &mut [[P; LANES]],
) {
    for (t, out) in t.iter().zip(out) {
        horner_block::<P, D>(weighted, middle, t, out);
        if reach_ends(t) {
            put_ends(ends, t, out);
        }
    }
}

/// Whether a parameter may be 0 or 1: a fold of two lanes, which is a vector instruction a pair.
#[inline(always)]
fn reach_ends(t: &[f64; LANES]) -> bool {
    let mut most = [0.0_f64; 2];
    for pair in t.as_chunks::<2>().0 {
        for lane in 0..2 {
            let x = pair[lane] - 0.5;
            let square = x * x;
            most[lane] = if square > most[lane] { square } else { most[lane] };
        }
    }
    most[0] >= 0.25 || most[1] >= 0.25
}

/// The ends where they belong: the last bits of a sum are not those of an end point.
#[cold]
fn put_ends<P: Blend>(ends: [P; 2], t: &[f64; LANES], out: &mut [P; LANES]) {
    for (place, &t) in out.iter_mut().zip(t) {
        if t == 0.0 || t == 1.0 {
            *place = ends[usize::from(t == 1.0)];
        }
    }
}

/// Coefficients of a cubic by powers of t - 1/2: the terms are no larger than twice the points, so that Horner's scheme is
/// off by a few u only. Sums are taken with their errors.
fn centred<P: Blend, const D: usize>([a, b, c, d]: [P; 4]) -> [[f64; 4]; D] {
    std::array::from_fn(|axis| {
        let [a, b, c, d] = [a, b, c, d].map(|p| p.component(axis));
        let ((outer, outer_rest), (inner, inner_rest)) = (two_sum(a, d), two_sum(b, c));
        let ((wide, wide_rest), (narrow, narrow_rest)) = (two_sum(d, -a), two_sum(c, -b));
        [
            0.125 * ((outer + 3.0 * inner) + (outer_rest + 3.0 * inner_rest)),
            0.75 * ((wide + narrow) + (wide_rest + narrow_rest)),
            1.5 * ((outer - inner) + (outer_rest - inner_rest)),
            (wide - 3.0 * narrow) + (wide_rest - 3.0 * narrow_rest),
        ]
    })
}

#[inline(always)]
fn cubic_block<P: Blend, const D: usize>(c: &[[f64; 4]; D], t: &[f64; LANES], out: &mut [P; LANES]) {
    let mut values = [[0.0; LANES]; D];
    for (values, [c0, c1, c2, c3]) in values.iter_mut().zip(c) {
        for lane in 0..LANES {
            let x = t[lane] - 0.5;
            values[lane] = c0 + x * (c1 + x * (c2 + x * c3));
        }
    }
    for (lane, place) in out.iter_mut().enumerate() {
        *place = P::from_components(|axis| values[axis][lane]);
    }
}

/// The middle of the control points' box: seen from there the points are smallest, and so is what rounding makes of them.
fn middle_of_box<P: Blend>(points: &[P]) -> P {
    let (low, high) = points.iter().fold((points[0], points[0]), |(low, high), &p| {
        (low.zip(p, |a, b| if b < a { b } else { a }), high.zip(p, |a, b| if b > a { b } else { a }))
    });
    (low + high) * 0.5
}

/// The control points as seen from `middle`, times their binomials, each rounded once.
fn with_binomials<P: Blend>(points: &[P], middle: P) -> Vec<P> {
    let n = points.len() - 1;
    let mut binomial = DoubleDouble::from(1.0);
    let weigh = |(k, &point): (usize, &P)| {
        let weighted = point.zip(middle, |x, m| (binomial * DoubleDouble::difference(x, m)).to_f64());
        binomial = binomial * (n - k) as f64 / DoubleDouble::from((k + 1) as f64);
        weighted
    };
    points.iter().enumerate().map(weigh).collect()
}

/// Horner-Bernstein over eight parameters and `D` components at once.
///
/// Where `1 - t` is rounded to s, the form gives the value at t / (t + s) times (t + s)^n; the power is taken out again.
#[inline(always)]
fn horner_block<P: Blend, const D: usize>(weighted: &[P], middle: P, t: &[f64; LANES], out: &mut [P; LANES]) {
    let n = weighted.len() - 1;
    let mut sums = [[0.0; LANES]; D];
    let mut power = [1.0; LANES];
    let mut rest = [0.0; LANES];
    let mut correction = [0.0; LANES];
    for lane in 0..LANES {
        rest[lane] = 1.0 - t[lane];
        correction[lane] = n as f64 * ((1.0 - rest[lane]) - t[lane]);
    }
    for point in &weighted[..n] {
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
        let (b, middle) = (weighted[n].component(axis), middle.component(axis));
        for lane in 0..LANES {
            let value = sum[lane] + power[lane] * b;
            sum[lane] = middle + (value + value * correction[lane]);
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
