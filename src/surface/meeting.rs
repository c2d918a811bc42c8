use super::net;
use super::{Patch, Surface, SurfaceError};
use crate::math::{Vec2, Vec3};

/// Where a ray meets a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f64,
    /// Parameters.
    pub u: f64,
    /// Parameters.
    pub v: f64,
    /// The point of the patch.
    pub point: Vec3,
    /// Whether the ray touches the patch there instead of crossing it, as far as rounding can tell.
    pub touching: bool,
}

/// Parts narrower than this are told from points no more.
const NARROWEST: f64 = 1e-12;
/// Parameters nearer than this are one hit.
const SAME: f64 = 1e-7;
/// Parts in work at one time; only a ray that runs along the patch has more.
const MOST_PARTS: usize = 4096;

/// All hits of a ray with a patch, from the nearest on.
///
/// With two planes through the ray, a hit is a common zero of two polynomials. Parts of the patch are split until their
/// control values exclude one, or a Newton step finds the only one that the bounds of their derivatives allow; where both
/// fail down to a 10^12th the ray touches.
///
/// # Errors
/// [`SurfaceError::NotFinite`] for an origin (0) or direction (1) that is not finite, [`SurfaceError::Number`] for a
/// direction of no length, [`SurfaceError::AlongRay`] when the ray runs along the patch.
pub fn ray_hits(patch: &Patch, origin: Vec3, direction: Vec3) -> Result<Vec<Hit>, SurfaceError> {
    if let Some(index) = [origin, direction].iter().position(|v| !v.is_finite()) {
        return Err(SurfaceError::NotFinite { index });
    }
    let Some(unit) = direction.try_normalize() else {
        return Err(SurfaceError::Number { name: "the length of the direction", value: direction.length() });
    };
    let (a, b) = unit.any_orthonormal_pair();
    let off: Vec<Vec2> =
        patch.points().iter().map(|&p| Vec2::new((p - origin).dot(a), (p - origin).dot(b))).collect();
    // Rounding of the control values.
    let size = patch
        .points()
        .iter()
        .map(|p| (*p - origin).abs().max_element())
        .fold(origin.abs().max_element(), f64::max);
    let slack = 64.0 * f64::EPSILON * size;
    let mut found: Vec<([f64; 2], bool)> = Vec::new();
    let mut pending = vec![(off, [[0.0, 1.0]; 2])];
    while let Some((net, range)) = pending.pop() {
        if excludes_zero(&net, slack) {
            continue;
        }
        let middle = range.map(|[low, high]| 0.5 * low + 0.5 * high);
        if is_one_to_one(&net, patch.degrees())
            && let Some(hit) = newton(patch, origin, [a, b], middle, range)
        {
            found.push((hit, false));
            continue;
        }
        let widths = range.map(|[low, high]| high - low);
        if widths[0].max(widths[1]) <= NARROWEST {
            found.push((middle, true));
            continue;
        }
        if pending.len() > MOST_PARTS || found.len() > MOST_PARTS {
            return Err(SurfaceError::AlongRay);
        }
        let axis = usize::from(widths[1] > widths[0]);
        for (half, ends) in
            [([0.5, 1.0], [middle[axis], range[axis][1]]), ([0.0, 0.5], [range[axis][0], middle[axis]])]
        {
            let mut part = net.clone();
            net::restrict(&mut part, patch.degrees(), axis, half);
            let mut narrowed = range;
            narrowed[axis] = ends;
            pending.push((part, narrowed));
        }
    }
    Ok(sorted(patch, origin, unit, direction.length(), found))
}

/// Whether no combination of the control values is zero.
fn excludes_zero(net: &[Vec2], slack: f64) -> bool {
    let low = net.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let high = net.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
    low.x > slack || low.y > slack || high.x < -slack || high.y < -slack
}

/// Whether bounds of the derivatives, seen in the frame of those in the middle, leave a determinant that cannot vanish: no
/// two parameters then have the same value.
fn is_one_to_one(net: &[Vec2], degrees: [usize; 2]) -> bool {
    let [by_u, by_v] = [0, 1].map(|axis| net::derivative(net, degrees, axis).0);
    let mean = |list: &[Vec2]| list.iter().sum::<Vec2>() / list.len() as f64;
    let (p, q) = (mean(&by_u), mean(&by_v));
    let determinant = p.perp_dot(q);
    if determinant == 0.0 {
        return false;
    }
    // Rows of the inverse of the matrix with columns p and q.
    let framed = |v: &Vec2| Vec2::new(v.perp_dot(q), p.perp_dot(*v)) / determinant;
    let bounds = |list: &[Vec2]| {
        let framed: Vec<Vec2> = list.iter().map(framed).collect();
        let low = framed.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        (low, framed.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max))
    };
    let ((u_low, u_high), (v_low, v_high)) = (bounds(&by_u), bounds(&by_v));
    let largest = |a: f64, b: f64| a.abs().max(b.abs());
    u_low.x > 0.0
        && v_low.y > 0.0
        && u_low.x * v_low.y > largest(u_low.y, u_high.y) * largest(v_low.x, v_high.x) * (1.0 + 1e-9)
}

/// The zero that Newton's method finds in a range.
fn newton(
    patch: &Patch,
    origin: Vec3,
    [a, b]: [Vec3; 2],
    start: [f64; 2],
    range: [[f64; 2]; 2],
) -> Option<[f64; 2]> {
    let mut at = start;
    for _ in 0..20 {
        let jet = patch.jet(at[0], at[1]);
        let flat = |v: Vec3| Vec2::new(v.dot(a), v.dot(b));
        let (f, p, q) = (flat(jet.point - origin), flat(jet.du), flat(jet.dv));
        let determinant = p.perp_dot(q);
        let step = Vec2::new(f.perp_dot(q), p.perp_dot(f)) / determinant;
        if !step.is_finite() {
            return None;
        }
        at = [at[0] - step.x, at[1] - step.y];
        if step.abs().max_element() <= 4.0 * f64::EPSILON {
            break;
        }
        // A start that is good enough never leaves twice the range.
        let width = range.map(|[low, high]| high - low);
        if (0..2).any(|k| (at[k] - start[k]).abs() > 2.0 * width[k]) {
            return None;
        }
    }
    // A zero on the border belongs to both sides of it.
    let inside = |k: usize| range[k][0] - 1e-12 <= at[k] && at[k] <= range[k][1] + 1e-12;
    (inside(0) && inside(1)).then(|| at.map(|t| t.clamp(0.0, 1.0)))
}

fn sorted(patch: &Patch, origin: Vec3, unit: Vec3, length: f64, found: Vec<([f64; 2], bool)>) -> Vec<Hit> {
    let mut hits: Vec<Hit> = Vec::new();
    for ([u, v], touching) in found {
        let point = patch.eval(u, v);
        let t = (point - origin).dot(unit) / length;
        let same = |hit: &&mut Hit| (hit.u - u).abs() <= SAME && (hit.v - v).abs() <= SAME;
        match hits.iter_mut().find(same) {
            // A cluster of parts is one place where the ray touches.
            Some(hit) => hit.touching = hit.touching && touching,
            None if t >= 0.0 => hits.push(Hit { t, u, v, point, touching }),
            None => {}
        }
    }
    hits.sort_by(|a, b| a.t.total_cmp(&b.t));
    hits
}
