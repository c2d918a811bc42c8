use super::net::{self, Degrees};
use super::{Patch, Surface, SurfaceError};
use crate::math::Vec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The nearest point of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Parameters.
    pub u: f64,
    /// Parameters.
    pub v: f64,
    /// The point there.
    pub point: Vec3,
    /// Its distance.
    pub distance: f64,
    /// No point of the patch is nearer by more than this.
    pub error: f64,
}

/// Parts whose lower bound is still below the best distance; the most promising first.
struct Part {
    lower: f64,
    net: Vec<f64>,
    range: [[f64; 2]; 2],
}

impl PartialEq for Part {
    fn eq(&self, other: &Part) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Part) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Part) -> Ordering {
        // A heap gives the greatest first.
        other.lower.total_cmp(&self.lower).then_with(|| other.range[0][0].total_cmp(&self.range[0][0]))
    }
}

/// Parts narrower than this hold nothing that a Newton step does not see.
const NARROWEST: f64 = 1.0 / 67_108_864.0;

/// The point of a patch nearest to a point of space, to within `accuracy`: the globally nearest, whatever the shape.
///
/// Parts of the patch are split while the control values of the squared distance over them, which bound it from below,
/// leave room for something nearer; Newton steps polish the best one. Where many points are equally near (a sphere's middle)
/// parts are split down to a 2^26th, and `error` tells what is then left open.
///
/// # Errors
/// [`SurfaceError::Number`] for an accuracy that is not positive, [`SurfaceError::NotFinite`] for the point,
/// [`SurfaceError::Degree`] above 100.
pub fn nearest(patch: &Patch, point: Vec3, accuracy: f64) -> Result<Nearest, SurfaceError> {
    const MOST: usize = 100;
    if !(accuracy > 0.0 && accuracy.is_finite()) {
        return Err(SurfaceError::Number { name: "accuracy", value: accuracy });
    }
    if !point.is_finite() {
        return Err(SurfaceError::NotFinite { index: 0 });
    }
    let [m, n] = patch.degrees();
    if m.max(n) > MOST {
        return Err(SurfaceError::Degree { actual: m.max(n), most: MOST });
    }
    let (net, degrees) = squared_distance(patch, point);
    let mut best = [0.0, 1.0]
        .into_iter()
        .flat_map(|u| [0.0, 0.5, 1.0].map(|v| [u, v]))
        .chain([[0.5, 0.5]])
        .map(|start| polished(patch, point, start))
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
        .expect("there are starts");
    let mut heap = BinaryHeap::from([Part { lower: least(&net), net, range: [[0.0, 1.0]; 2] }]);
    // The budget ends what parts of equal distance would draw out; the error then says so.
    const BUDGET: usize = 20_000;
    let mut lowest = 0.0;
    for step in 0.. {
        let Some(part) = heap.pop() else {
            lowest = best.distance;
            break;
        };
        lowest = part.lower.max(0.0).sqrt();
        if best.distance - lowest <= accuracy || step == BUDGET {
            break;
        }
        let [u, v] = part.range;
        if (u[1] - u[0]).max(v[1] - v[0]) <= NARROWEST {
            break;
        }
        let middle = [0.5 * u[0] + 0.5 * u[1], 0.5 * v[0] + 0.5 * v[1]];
        if (patch.eval(middle[0], middle[1]) - point).length() < 1.5 * best.distance {
            let found = polished(patch, point, middle);
            if found.distance < best.distance {
                best = found;
            }
        }
        let axis = usize::from(v[1] - v[0] > u[1] - u[0]);
        for (half, low) in [([0.0, 0.5], true), ([0.5, 1.0], false)] {
            let mut net = part.net.clone();
            net::restrict(&mut net, degrees, axis, half);
            let mut range = part.range;
            range[axis] = if low { [range[axis][0], middle[axis]] } else { [middle[axis], range[axis][1]] };
            let lower = least(&net);
            if lower.max(0.0).sqrt() < best.distance {
                heap.push(Part { lower, net, range });
            }
        }
    }
    best.error = (best.distance - lowest).max(0.0);
    Ok(best)
}

/// The least control value, less what rounding may have added.
fn least(net: &[f64]) -> f64 {
    let size = net.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    net.iter().copied().fold(f64::INFINITY, f64::min) - 256.0 * f64::EPSILON * size
}

/// Control values of the squared distance from a point.
fn squared_distance(patch: &Patch, point: Vec3) -> (Vec<f64>, Degrees) {
    let [m, n] = patch.degrees();
    let off: Vec<Vec3> = patch.points().iter().map(|&p| p - point).collect();
    let (rows, columns) = (binomials(m), binomials(n));
    let (tall, wide) = (binomials(2 * m), binomials(2 * n));
    let mut net = vec![0.0; (2 * m + 1) * (2 * n + 1)];
    for (a, p) in off.iter().enumerate() {
        let (i, j) = (a / (n + 1), a % (n + 1));
        for (b, q) in off.iter().enumerate() {
            let (k, l) = (b / (n + 1), b % (n + 1));
            let weight = rows[i] * rows[k] / tall[i + k] * (columns[j] * columns[l] / wide[j + l]);
            net[(i + k) * (2 * n + 1) + j + l] += weight * p.dot(*q);
        }
    }
    (net, [2 * m, 2 * n])
}

fn binomials(n: usize) -> Vec<f64> {
    let mut row = vec![1.0];
    for k in 0..n {
        row.push(row[k] * (n - k) as f64 / (k + 1) as f64);
    }
    row
}

/// Gauss-Newton with steps that are halved until they help, inside the square.
fn polished(patch: &Patch, point: Vec3, start: [f64; 2]) -> Nearest {
    let mut at = start;
    let mut here = patch.eval(at[0], at[1]);
    for _ in 0..50 {
        let jet = patch.jet(at[0], at[1]);
        let off = point - here;
        // Second derivatives included: the distance may be large.
        let e = jet.du.length_squared() - off.dot(jet.duu);
        let f = jet.du.dot(jet.dv) - off.dot(jet.duv);
        let g = jet.dv.length_squared() - off.dot(jet.dvv);
        let (a, b) = (off.dot(jet.du), off.dot(jet.dv));
        let newton = [(g * a - f * b) / (e * g - f * f), (e * b - f * a) / (e * g - f * f)];
        let descends = newton[0] * a + newton[1] * b > 0.0;
        let step = if descends && newton[0].is_finite() && newton[1].is_finite() {
            newton
        } else {
            [
                a / jet.du.length_squared().max(f64::MIN_POSITIVE),
                b / jet.dv.length_squared().max(f64::MIN_POSITIVE),
            ]
        };
        let Some((next, place)) = shortened(patch, point, at, step, here) else { break };
        (at, here) = (next, place);
    }
    let distance = (here - point).length();
    Nearest { u: at[0], v: at[1], point: here, distance, error: distance }
}

/// The first of a step and its halves that comes nearer.
fn shortened(
    patch: &Patch,
    point: Vec3,
    at: [f64; 2],
    step: [f64; 2],
    here: Vec3,
) -> Option<([f64; 2], Vec3)> {
    let old = (here - point).length_squared();
    let mut size = 1.0;
    for _ in 0..30 {
        let next = [0, 1].map(|axis: usize| (at[axis] + size * step[axis]).clamp(0.0, 1.0));
        let place = patch.eval(next[0], next[1]);
        if next != at && (place - point).length_squared() < old {
            return Some((next, place));
        }
        size *= 0.5;
    }
    None
}
