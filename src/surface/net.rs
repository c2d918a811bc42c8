//! Tensor-product control nets as flat lists: point (i, j) stands at `i * (degree in v + 1) + j`.

use super::SurfaceError;
use super::patch::check_degrees;
use crate::curve::evaluate::{de_casteljau, lerp};
use crate::math::Blend;

/// Degrees in u and in v.
pub(super) type Degrees = [usize; 2];

/// Columns up to this length fit on the stack.
const SMALL: usize = 8;

/// The point at a parameter: de Casteljau in v of every row, then in u. At u or v of 0 and 1 it has the bits of the
/// border curve's own de Casteljau.
pub(super) fn eval<P: Blend>(points: &[P], degrees: Degrees, u: f64, v: f64) -> P {
    let width = degrees[1] + 1;
    let rows = points.chunks_exact(width).map(|row| de_casteljau(row, v));
    if degrees[0] < SMALL {
        let mut column = [P::ZERO; SMALL];
        column.iter_mut().zip(rows).for_each(|(place, point)| *place = point);
        de_casteljau(&column[..=degrees[0]], u)
    } else {
        de_casteljau(&rows.collect::<Vec<_>>(), u)
    }
}

/// The sum of `b_ij B_i(u) B_j(v)` with all Bernstein polynomials written out: the textbook form, about as accurate as
/// de Casteljau and cheaper at high degrees; the degrees must stay below 1030, where binomials overflow.
pub(super) fn bernstein<P: Blend>(points: &[P], degrees: Degrees, u: f64, v: f64) -> P {
    let width = degrees[1] + 1;
    let column: Vec<P> =
        points.chunks_exact(width).map(|row| crate::curve::evaluate::bernstein(row, v)).collect();
    crate::curve::evaluate::bernstein(&column, u)
}

/// The value and the first two derivatives of a curve: de Casteljau, stopped where three points are left.
fn curve_jet<P: Blend>(row: &mut [P], t: f64) -> [P; 3] {
    let n = row.len() - 1;
    let degree = n as f64;
    for count in (3..row.len()).rev() {
        for i in 0..count {
            row[i] = lerp(row[i], row[i + 1], t);
        }
    }
    let second = match n {
        0 | 1 => P::ZERO,
        _ => ((row[2] - row[1]) - (row[1] - row[0])) * (degree * (degree - 1.0)),
    };
    if n >= 2 {
        (row[0], row[1]) = (lerp(row[0], row[1], t), lerp(row[1], row[2], t));
    }
    let first = if n >= 1 { (row[1] - row[0]) * degree } else { P::ZERO };
    let value = if n >= 1 { lerp(row[0], row[1], t) } else { row[0] };
    [value, first, second]
}

/// Value, u, v, uu, uv, vv.
pub(super) fn jet<P: Blend>(points: &[P], degrees: Degrees, u: f64, v: f64) -> [P; 6] {
    let (height, width) = (degrees[0] + 1, degrees[1] + 1);
    if height <= SMALL && width <= SMALL {
        jet_in(points, degrees, u, v, &mut [P::ZERO; SMALL], &mut [[P::ZERO; SMALL]; 3])
    } else {
        let mut columns = [vec![P::ZERO; height], vec![P::ZERO; height], vec![P::ZERO; height]];
        jet_in(points, degrees, u, v, &mut vec![P::ZERO; width], &mut columns)
    }
}

/// [`jet`] with room for a row, and for a column of values, first and second derivatives.
fn jet_in<P: Blend, C: AsMut<[P]>>(
    points: &[P],
    degrees: Degrees,
    u: f64,
    v: f64,
    row: &mut [P],
    columns: &mut [C; 3],
) -> [P; 6] {
    let (height, width) = (degrees[0] + 1, degrees[1] + 1);
    for (i, points) in points.chunks_exact(width).enumerate() {
        row[..width].copy_from_slice(points);
        let derivatives = curve_jet(&mut row[..width], v);
        for (column, derivative) in columns.iter_mut().zip(derivatives) {
            column.as_mut()[i] = derivative;
        }
    }
    let [plain, first, second] = columns;
    let [value, du, duu] = curve_jet(&mut plain.as_mut()[..height], u);
    let [dv, duv, _] = curve_jet(&mut first.as_mut()[..height], u);
    let [dvv, ..] = curve_jet(&mut second.as_mut()[..height], u);
    [value, du, dv, duu, duv, dvv]
}

/// The net with u and v exchanged.
pub(super) fn transposed<P: Blend>(points: &[P], degrees: Degrees) -> Vec<P> {
    let (height, width) = (degrees[0] + 1, degrees[1] + 1);
    (0..width).flat_map(|j| (0..height).map(move |i| points[i * width + j])).collect()
}

/// The derivative by the parameter of an axis (0 for u): a net of one degree less; of degree 0, zeros.
pub(super) fn derivative<P: Blend>(points: &[P], degrees: Degrees, axis: usize) -> (Vec<P>, Degrees) {
    let width = degrees[1] + 1;
    if degrees[axis] == 0 {
        return (vec![P::ZERO; points.len()], degrees);
    }
    let factor = degrees[axis] as f64;
    if axis == 0 {
        let net = (0..degrees[0] * width).map(|at| (points[at + width] - points[at]) * factor).collect();
        return (net, [degrees[0] - 1, degrees[1]]);
    }
    let row = |row: &[P]| row.windows(2).map(|pair| (pair[1] - pair[0]) * factor).collect::<Vec<_>>();
    (points.chunks_exact(width).flat_map(row).collect(), [degrees[0], degrees[1] - 1])
}

/// Does `work` with every line of points along an axis: its first index, the stride and the length.
fn for_lines(degrees: Degrees, axis: usize, mut work: impl FnMut(usize, usize, usize)) {
    let (height, width) = (degrees[0] + 1, degrees[1] + 1);
    if axis == 0 {
        (0..width).for_each(|j| work(j, width, height));
    } else {
        (0..height).for_each(|i| work(i * width, 1, width));
    }
}

/// Cuts the net to the part from `low` to `high` along an axis, in place; `0 <= low < high <= 1`.
pub(super) fn restrict<P: Blend>(points: &mut [P], degrees: Degrees, axis: usize, [low, high]: [f64; 2]) {
    for_lines(degrees, axis, |first, stride, count| {
        let at = |k: usize| first + k * stride;
        if high < 1.0 {
            for level in 1..count {
                for k in (level..count).rev() {
                    points[at(k)] = lerp(points[at(k - 1)], points[at(k)], high);
                }
            }
        }
        if low > 0.0 {
            let t = low / high;
            for left in (1..count).rev() {
                for k in 0..left {
                    points[at(k)] = lerp(points[at(k)], points[at(k + 1)], t);
                }
            }
        }
    });
}

/// The net of the part over ranges of u and v.
pub(super) fn part<P: Blend>(
    points: &[P],
    degrees: Degrees,
    ranges: [[f64; 2]; 2],
) -> Result<Vec<P>, SurfaceError> {
    let mut part = points.to_vec();
    for (axis, range) in ranges.into_iter().enumerate() {
        let [low, high] = range;
        if !(0.0 <= low && low < high && high <= 1.0) {
            return Err(SurfaceError::Parameter { value: if low >= 0.0 { high } else { low } });
        }
        restrict(&mut part, degrees, axis, range);
    }
    Ok(part)
}

/// The same surface with degrees higher by these numbers.
pub(super) fn elevated_by<P: Blend>(
    points: &[P],
    degrees: Degrees,
    by: [usize; 2],
) -> Result<(Vec<P>, Degrees), SurfaceError> {
    check_degrees([degrees[0].saturating_add(by[0]), degrees[1].saturating_add(by[1])])?;
    let mut net = (points.to_vec(), degrees);
    for axis in std::iter::repeat_n(0, by[0]).chain(std::iter::repeat_n(1, by[1])) {
        net = elevated(&net.0, net.1, axis);
    }
    Ok(net)
}

/// The same surface with a degree one higher along an axis.
fn elevated<P: Blend>(points: &[P], degrees: Degrees, axis: usize) -> (Vec<P>, Degrees) {
    let mut raised = degrees;
    raised[axis] += 1;
    let mut net = vec![P::ZERO; (raised[0] + 1) * (raised[1] + 1)];
    let old_width = degrees[1] + 1;
    let n = raised[axis];
    let old = |line: usize, k: usize| {
        if axis == 0 { points[k * old_width + line] } else { points[line * old_width + k] }
    };
    for_lines(raised, axis, |first, stride, count| {
        let line = if axis == 0 { first } else { first / count };
        for k in 0..count {
            net[first + k * stride] = match k {
                0 => old(line, 0),
                k if k == n => old(line, n - 1),
                k => lerp(old(line, k), old(line, k - 1), k as f64 / n as f64),
            };
        }
    });
    (net, raised)
}

/// One of the four border curves: v = 0, v = 1 (along u), u = 0, u = 1 (along v).
pub(super) fn border<P: Blend>(points: &[P], degrees: Degrees, side: usize) -> Vec<P> {
    let (height, width) = (degrees[0] + 1, degrees[1] + 1);
    match side {
        0 => (0..height).map(|i| points[i * width]).collect(),
        1 => (0..height).map(|i| points[i * width + width - 1]).collect(),
        2 => points[..width].to_vec(),
        _ => points[(height - 1) * width..].to_vec(),
    }
}

/// The largest norm of the points.
pub(super) fn largest<P: Blend>(points: &[P]) -> f64 {
    points.iter().fold(0.0, |most: f64, point| most.max(point.norm()))
}

/// The largest absolute component of the points.
pub(super) fn size<P: Blend>(points: &[P]) -> f64 {
    points.iter().fold(0.0, |most: f64, point| most.max(point.max_abs()))
}

/// The points brought to a largest component between 1 and 2 by a power of two, which is exact but for the tiniest.
pub(super) fn of_unit_size<P: Blend>(points: &[P]) -> Vec<P> {
    let power = crate::math::power_of_two_below(size(points));
    if power == 0.0 {
        return points.to_vec();
    }
    points.iter().map(|point| point.map(|x| x / power)).collect()
}

/// All points of each line along an axis moved to the point of the line at `t`.
pub(super) fn flatten_onto<P: Blend>(points: &mut [P], degrees: Degrees, axis: usize, t: f64) {
    for_lines(degrees, axis, |first, stride, count| {
        let line: Vec<P> = (0..count).map(|k| points[first + k * stride]).collect();
        let point = de_casteljau(&line, t);
        (0..count).for_each(|k| points[first + k * stride] = point);
    });
}

/// Gives the second part of a split the border that the first one ends with.
pub(super) fn share_border<P: Blend>(low: &[P], high: &mut [P], degrees: Degrees, axis: usize) {
    for_lines(degrees, axis, |first, stride, count| high[first] = low[first + (count - 1) * stride]);
}
