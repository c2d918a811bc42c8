use super::bernstein::binomials;
use super::subdivide::elevate;
use super::{AnyBezier, Bernstein, CurveError};
use crate::math::Blend;

/// A curve of lower degree in place of another.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced<P> {
    /// The curve of lower degree.
    pub curve: AnyBezier<P>,
    /// Points at the same parameter are at most this far apart: the largest distance of control points once both are
    /// written with the higher degree, a little rounding included.
    pub error: f64,
}

/// The curve of a lower degree that is nearest in the mean square over [0, 1] among those that keep `ends` derivatives
/// at each end: 0 lets the ends go free, 1 keeps the end points, 2 tangents as well, and so on.
///
/// What the ends leave free is `(t(1-t))^ends q(t)`; the nearest polynomial of lower degree drops the highest Jacobi
/// polynomials of weight `(t(1-t))^(2 ends)` from q, one degree after the other. Rounding grows like 4^(degree); good for
/// degrees up to about 25.
///
/// # Errors
/// [`CurveError::Count`] when the degree is not lower or is too low to keep the ends, [`CurveError::NotFinite`] when
/// numbers overflow.
pub fn reduce<C: Bernstein>(curve: &C, degree: usize, ends: usize) -> Result<Reduced<C::Vector>, CurveError> {
    let n = curve.degree();
    let least = (2 * ends).saturating_sub(1);
    if degree > n {
        return Err(CurveError::Count { actual: degree + 1, expected: n + 1 });
    }
    if degree < least {
        return Err(CurveError::Count { actual: degree + 1, expected: least + 1 });
    }
    let carrier = end_interpolant(curve.points(), ends, degree);
    let mut rest = curve.points().to_vec();
    for (rest, carried) in rest.iter_mut().zip(elevated_to(&carrier, n)) {
        *rest = *rest - carried;
    }
    let mut quotient = divided(&rest, ends);
    while quotient.len() > degree + 1 - 2 * ends && !quotient.is_empty() {
        drop_highest(&mut quotient, 2 * ends);
    }
    let mut points = carrier;
    for (point, back) in points.iter_mut().zip(multiplied(&quotient, ends, degree)) {
        *point = *point + back;
    }
    for i in 0..ends.min(1) {
        (points[i], points[degree - i]) = (curve.start(), curve.end());
    }
    let curve_again = elevated_to(&points, n);
    let off = curve.points().iter().zip(&curve_again).map(|(&p, &q)| (p - q).norm()).fold(0.0, f64::max);
    let size = curve.points().iter().fold(0.0, |most: f64, point| most.max(point.max_abs()));
    let error = off + 4.0 * (n + 1 - degree) as f64 * f64::EPSILON * size;
    Ok(Reduced { curve: AnyBezier::new(points)?, error })
}

/// The curve of degree `2 ends - 1` with the same first `ends` derivatives at both ends, written with `degree`.
fn end_interpolant<P: Blend>(points: &[P], ends: usize, degree: usize) -> Vec<P> {
    if ends == 0 {
        return vec![P::ZERO; degree + 1];
    }
    let low = 2 * ends - 1;
    let one_end = |points: &[P]| {
        // Derivatives are falling factorials times differences: n!/(n-k)! D^k b = low!/(low-k)! D^k a.
        let mut differences = points[..ends.min(points.len())].to_vec();
        differences.resize(ends, P::ZERO);
        let mut ratio = 1.0;
        for order in 1..ends {
            for i in (order..ends).rev() {
                differences[i] = differences[i] - differences[i - 1];
            }
        }
        for (order, difference) in differences.iter_mut().enumerate() {
            *difference = *difference * ratio;
            ratio *= (points.len() - 1).saturating_sub(order) as f64 / (low - order) as f64;
        }
        for order in (1..ends).rev() {
            for i in order..ends {
                differences[i] = differences[i] + differences[i - 1];
            }
        }
        differences
    };
    let backward: Vec<P> = points.iter().rev().copied().collect();
    let mut interpolant = one_end(points);
    interpolant.extend(one_end(&backward).into_iter().rev());
    elevated_to(&interpolant, degree)
}

fn elevated_to<P: Blend>(points: &[P], degree: usize) -> Vec<P> {
    let mut points = points.to_vec();
    while points.len() < degree + 1 {
        points.push(P::ZERO);
        elevate(&mut points);
    }
    points
}

/// Bernstein coefficients of `p / (t(1-t))^ends`, whose first and last `ends` coefficients are zero.
fn divided<P: Blend>(points: &[P], ends: usize) -> Vec<P> {
    let n = points.len() - 1;
    if n < 2 * ends {
        return Vec::new();
    }
    let (whole, inner) = (binomials(n), binomials(n - 2 * ends));
    (0..=n - 2 * ends).map(|j| points[j + ends] * (whole[j + ends] / inner[j])).collect()
}

/// The inverse of [`divided`].
fn multiplied<P: Blend>(quotient: &[P], ends: usize, degree: usize) -> Vec<P> {
    let mut points = vec![P::ZERO; degree + 1];
    if quotient.is_empty() {
        return points;
    }
    let (whole, inner) = (binomials(degree), binomials(degree - 2 * ends));
    for (j, &value) in quotient.iter().enumerate() {
        points[j + ends] = value * (inner[j] / whole[j + ends]);
    }
    points
}

/// Takes the highest Jacobi polynomial of both weights `a` out of q and writes the rest with one coefficient less.
fn drop_highest<P: Blend>(q: &mut Vec<P>, a: usize) {
    let d = q.len() - 1;
    let (over, under) = (binomials(d + a), binomials(d));
    let alternating = |i: usize| if (d - i).is_multiple_of(2) { 1.0 } else { -1.0 };
    let jacobi: Vec<f64> = (0..=d).map(|i| alternating(i) * over[i] * over[d - i] / under[i]).collect();
    let leading = |values: &mut dyn Iterator<Item = P>| {
        values.enumerate().fold(P::ZERO, |sum, (i, value)| sum + value * (alternating(i) * under[i]))
    };
    let highest = leading(&mut q.iter().copied());
    let scale: f64 = jacobi.iter().enumerate().map(|(i, value)| alternating(i) * under[i] * value).sum();
    for (value, weight) in q.iter_mut().zip(&jacobi) {
        *value = *value - highest * (weight / scale);
    }
    // Now of degree d - 1: undo an elevation, each half from its own end, where that is stable.
    let mut low = vec![P::ZERO; d];
    for i in 0..d.div_ceil(2) {
        let before = if i > 0 { low[i - 1] * i as f64 } else { P::ZERO };
        low[i] = (q[i] * d as f64 - before).map(|x| x / (d - i) as f64);
    }
    for i in (d.div_ceil(2)..d).rev() {
        let after = if i + 1 < d { low[i + 1] * (d - 1 - i) as f64 } else { P::ZERO };
        low[i] = (q[i + 1] * d as f64 - after).map(|x| x / (i + 1) as f64);
    }
    *q = low;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec2;
    use crate::numeric::quadrature::{GAUSS_16, integrate};

    fn curve() -> AnyBezier<Vec2> {
        let points = [(0.0, 0.0), (1.0, 3.0), (4.0, -2.0), (5.0, 1.0), (7.0, 4.0), (3.0, 6.0), (8.0, 8.0)];
        AnyBezier::new(points.map(Vec2::from).to_vec()).unwrap()
    }

    fn mean_square(a: &AnyBezier<Vec2>, b: &AnyBezier<Vec2>) -> f64 {
        integrate(GAUSS_16, 0.0, 1.0, |t| (a.eval(t) - b.eval(t)).length_squared())
    }

    #[test]
    fn what_was_elevated_comes_back() {
        for ends in 0..=3 {
            let reduced = reduce(&curve().elevated(4), 6, ends).unwrap();
            assert!(reduced.error < 1e-12, "{ends}: {}", reduced.error);
            for (p, q) in reduced.curve.points().iter().zip(curve().points()) {
                assert!((*p - *q).length() < 1e-11, "{ends}");
            }
        }
    }

    #[test]
    fn nothing_near_is_nearer() {
        for (ends, degree) in [(0, 3), (1, 3), (2, 4), (0, 0), (1, 5), (2, 3)] {
            let reduced = reduce(&curve(), degree, ends).unwrap();
            let best = mean_square(&reduced.curve, &curve());
            for i in ends..=degree - ends.min(degree) {
                if 2 * ends > degree {
                    break;
                }
                for step in [-1e-3, 1e-3] {
                    let mut points = reduced.curve.points().to_vec();
                    points[i].x += step;
                    let other = AnyBezier::new(points).unwrap();
                    assert!(mean_square(&other, &curve()) > best, "ends {ends}, degree {degree}, point {i}");
                }
            }
        }
    }

    #[test]
    fn the_error_bounds_the_distance_and_the_ends_are_kept() {
        for (ends, degree) in [(0, 5), (0, 2), (1, 4), (1, 1), (2, 3), (3, 5)] {
            let Reduced { curve: low, error } = reduce(&curve(), degree, ends).unwrap();
            let samples = (0..=100).map(|k| f64::from(k) / 100.0);
            let worst = samples.map(|t| (low.eval(t) - curve().eval(t)).length()).fold(0.0, f64::max);
            assert!(worst <= error && error < 40.0 * worst.max(1e-15), "{ends} {degree}: {worst} {error}");
            for order in 0..ends {
                for t in [0.0, 1.0] {
                    let at = |c: &AnyBezier<Vec2>| c.derivative(order).unwrap().eval(t);
                    assert!((at(&low) - at(&curve())).length() < 1e-10, "{ends} {degree} order {order}");
                }
            }
        }
        assert_eq!(reduce(&curve(), 2, 2), Err(CurveError::Count { actual: 3, expected: 4 }));
        assert_eq!(reduce(&curve(), 7, 0), Err(CurveError::Count { actual: 8, expected: 7 }));
    }
}
