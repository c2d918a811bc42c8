//! How far a triangle is off its surface: a proof, and a measurement.

use super::slide::{self, Turned};
use super::table::Table;
use crate::math::Vec3;
use crate::surface::{Jet, Surface};

/// A proven bound of the distance between a triangle and its part of the surface, over the tolerance there.
pub(super) fn bound(table: &Table, surface: &dyn Surface, parameters: &[[f64; 2]; 3]) -> f64 {
    let whole = bound_by(table.bend(parameters), parameters);
    if whole > slide::MOST {
        return whole;
    }
    let range = |axis: usize| {
        let all = parameters.map(|p| p[axis]);
        [all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    };
    let part = [range(0), range(1)];
    let (free, left) = table.bend_left(parameters, part);
    let rough = left.map_or(whole, |bends| bound_by(bends, parameters)) + table.cost(parameters, whole);
    if rough <= 1.0 {
        return rough;
    }
    // Finer bounds cost much: only where they may help, or where a triangle is far smaller than its cell.
    const MAY_HELP: f64 = 1.5;
    if rough > MAY_HELP && !table.is_far_smaller(part) {
        return rough;
    }
    if part.iter().any(|[low, high]| low >= high) {
        return rough;
    }
    let Some(bends) = surface.bends(part) else { return rough };
    let tolerance = table.tolerance(parameters);
    let lengths = bends.lengths.map(|length| length / tolerance);
    let whole = whole.min(bound_by(lengths, parameters));
    let tight = match bends.across.filter(|_| left.is_some()) {
        Some(across) => bound_by(Turned::new(&across, tolerance).bends(free, lengths), parameters),
        None => whole,
    };
    rough.min(tight + table.cost(parameters, whole))
}

/// Half the squared radius of the smallest circle around the triangle in a norm that bounds the second derivatives:
/// `2 uv |du dv| <= uv (s du^2 + dv^2 / s)` for every s.
pub(super) fn bound_by([uu, uv, vv]: [f64; 3], parameters: &[[f64; 2]; 3]) -> f64 {
    let with = |s: f64| {
        let scale = [(uu + s * uv).sqrt(), (vv + uv / s).sqrt()];
        0.5 * enclosing_radius_squared(parameters.map(|p| [p[0] * scale[0], p[1] * scale[1]]))
    };
    if uv == 0.0 {
        return with(1.0);
    }
    let extent = |axis: usize| {
        let all = parameters.map(|p| p[axis]);
        all.into_iter().fold(f64::NEG_INFINITY, f64::max) - all.into_iter().fold(f64::INFINITY, f64::min)
    };
    let by_shape = extent(1) / extent(0);
    let by_bends = (uu / vv).sqrt();
    let fits = |s: &f64| *s > 0.0 && s.is_finite();
    [by_shape, by_bends, (by_shape * by_bends).sqrt()]
        .into_iter()
        .filter(fits)
        .map(with)
        .fold(f64::INFINITY, f64::min)
}

/// The squared radius of the smallest circle around three points.
fn enclosing_radius_squared([p, q, r]: [[f64; 2]; 3]) -> f64 {
    let square = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
    let (a, b, c) = (square(q, r), square(r, p), square(p, q));
    let longest = a.max(b).max(c);
    let others = (a + b + c) - longest;
    let cross = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    if others <= longest || cross == 0.0 {
        return 0.25 * longest;
    }
    // The circumcircle; no larger circle is ever needed.
    (a * b * c / (4.0 * cross * cross)).min(longest / 3.0)
}

/// Barycentric coordinates where distances are measured.
pub(super) const PLACES: [[f64; 3]; 7] = [
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
    [1.0 / 3.0; 3],
    [0.6, 0.2, 0.2],
    [0.2, 0.6, 0.2],
    [0.2, 0.2, 0.6],
];

/// Barycentric coordinates of the corners of so many small triangles along each side, without the three of the whole.
pub(super) fn places(steps: usize) -> Vec<[f64; 3]> {
    let rows = (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| [i, j, steps - i - j]));
    let inner = rows.filter(|all| all.iter().all(|&k| k < steps));
    inner.map(|all| all.map(|k| k as f64 / steps as f64)).collect()
}

/// Distances of the places of many triangles, those of a triangle together: from the surface at the same parameters, and
/// where these are above `enough` for the triangle, from the points that a step along the surface leads to when they are
/// nearer.
pub(super) fn distances(
    surface: &dyn Surface,
    places: &[[f64; 3]],
    parameters: &[[[f64; 2]; 3]],
    corners: &[[Vec3; 3]],
    enough: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let count = places.len();
    let at: Vec<[f64; 2]> =
        parameters.iter().flat_map(|own| places.iter().map(|&weights| mixed(weights, own))).collect();
    let place = |k: usize| self::place(places[k % count], &corners[k / count]);
    let mut points = vec![Vec3::ZERO; at.len()];
    surface.points(&at, &mut points);
    let mut all: Vec<f64> = (0..at.len()).map(|k| (place(k) - points[k]).length()).collect();
    let far: Vec<usize> = (0..at.len()).filter(|&k| all[k] > enough(k / count)).collect();
    let from: Vec<[f64; 2]> = far.iter().map(|&k| at[k]).collect();
    let mut tangents = vec![[Vec3::ZERO; 3]; far.len()];
    surface.tangents(&from, &mut tangents);
    let domain = surface.domain();
    let steps = far.iter().zip(&tangents).map(|(&k, tangents)| step(domain, place(k), at[k], tangents));
    let to: Vec<[f64; 2]> = steps.collect();
    let nearer = &mut points[..far.len()];
    surface.points(&to, nearer);
    for (&k, point) in far.iter().zip(nearer) {
        all[k] = all[k].min((place(k) - *point).length());
    }
    all
}

/// Parameters nearer to a place by one Gauss-Newton step, within the domain; the same where there is none.
fn step(domain: [[f64; 2]; 2], place: Vec3, at: [f64; 2], &[point, du, dv]: &[Vec3; 3]) -> [f64; 2] {
    let off = place - point;
    let (e, f, g) = (du.length_squared(), du.dot(dv), dv.length_squared());
    let (a, b) = (off.dot(du), off.dot(dv));
    let determinant = e * g - f * f;
    let next = [at[0] + (g * a - f * b) / determinant, at[1] + (e * b - f * a) / determinant];
    if next.iter().all(|t| t.is_finite()) {
        [0, 1].map(|axis: usize| next[axis].clamp(domain[axis][0], domain[axis][1]))
    } else {
        at
    }
}

pub(super) fn mixed(weights: [f64; 3], parameters: &[[f64; 2]; 3]) -> [f64; 2] {
    [0, 1].map(|axis: usize| (0..3).map(|k| weights[k] * parameters[k][axis]).sum::<f64>())
}

fn place(weights: [f64; 3], corners: &[Vec3; 3]) -> Vec3 {
    weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2]
}

/// The largest distance of places of a triangle from the surface, which Newton steps look for.
///
/// What is not above `known` is not looked at closely: the result is at least that, and right where it is larger.
pub(super) fn measure(
    surface: &dyn Surface,
    places: &[[f64; 3]],
    parameters: &[[f64; 2]; 3],
    corners: [Vec3; 3],
    found: &[f64],
    known: f64,
) -> f64 {
    let domain = surface.domain();
    let closely =
        |k: usize| distance_from(surface, domain, place(places[k], &corners), mixed(places[k], parameters));
    largest(found, known, closely)
}

/// [`measure`] where the surface may be folded: a place may be near to what is at other parameters than its own.
pub(super) fn measure_folds(
    surface: &dyn Surface,
    places: &[[f64; 3]],
    parameters: &[[f64; 2]; 3],
    corners: [Vec3; 3],
    found: &[f64],
    known: f64,
) -> f64 {
    if found.iter().all(|&distance| distance <= known) {
        return known;
    }
    let domain = surface.domain();
    let at: Vec<[f64; 2]> = places.iter().map(|&weights| mixed(weights, parameters)).collect();
    let mut points = vec![Vec3::ZERO; at.len()];
    surface.points(&at, &mut points);
    let closely = |k: usize| {
        let place = place(places[k], &corners);
        let own = found[k].min(distance_from(surface, domain, place, at[k]));
        if own <= known {
            return own;
        }
        let nearest =
            |a: &usize, b: &usize| points[*a].distance(place).total_cmp(&points[*b].distance(place));
        let start = (0..at.len()).min_by(nearest).unwrap_or(k);
        own.min(distance_from(surface, domain, place, at[start]))
    };
    largest(found, known, closely)
}

/// The largest of some distances that are above what is known, looked at closely.
fn largest(found: &[f64], known: f64, closely: impl Fn(usize) -> f64) -> f64 {
    let mut most = known;
    for (k, &distance) in found.iter().enumerate() {
        if distance <= most {
            continue;
        }
        let near = closely(k);
        // NaN must not pass for small.
        if near.is_nan() {
            return f64::INFINITY;
        }
        most = most.max(near);
    }
    most
}

/// The distance of a place from the surface near some parameters: Gauss-Newton steps inside the domain as long as they
/// bring it much nearer, damped where the surface folds or stands still and a whole step leads away.
fn distance_from(surface: &dyn Surface, domain: [[f64; 2]; 2], place: Vec3, start: [f64; 2]) -> f64 {
    const STEPS: usize = 12;
    const MUCH: f64 = 0.9;
    const DAMPING: [f64; 4] = [0.0, 0.01, 0.3, 10.0];
    let mut at = start;
    let mut jet = surface.jet(at[0], at[1]);
    let mut distance = (place - jet.point).length();
    for _ in 0..STEPS {
        let steps = DAMPING.into_iter().filter_map(|damping| damped_step(&jet, domain, place, at, damping));
        let found = steps.map(|next| (next, surface.jet(next[0], next[1])));
        let mut found = found.map(|(next, jet)| (next, jet, (place - jet.point).length()));
        let Some(nearer) = found.find(|&(.., new)| new < distance) else { break };
        let enough = nearer.2 > MUCH * distance;
        (at, jet, distance) = nearer;
        if enough {
            break;
        }
    }
    distance
}

/// Where a Gauss-Newton step leads within the domain (Levenberg, A method for the solution of certain non-linear problems
/// in least squares, 1944, for damping).
fn damped_step(
    jet: &Jet,
    domain: [[f64; 2]; 2],
    place: Vec3,
    at: [f64; 2],
    damping: f64,
) -> Option<[f64; 2]> {
    let off = place - jet.point;
    let [e, f, g] = jet.first_form();
    let (e, g) = (e + damping * (e + g), g + damping * (e + g));
    let (a, b) = (off.dot(jet.du), off.dot(jet.dv));
    let determinant = e * g - f * f;
    let clamped = |axis: usize, t: f64| t.clamp(domain[axis][0], domain[axis][1]);
    let free = [at[0] + (g * a - f * b) / determinant, at[1] + (e * b - f * a) / determinant];
    if !(free[0].is_finite() && free[1].is_finite()) {
        return None;
    }
    let mut next = [clamped(0, free[0]), clamped(1, free[1])];
    // On a side of the domain the best is along it.
    if next[0] != free[0] && next[1] == free[1] && g > 0.0 {
        next[1] = clamped(1, at[1] + (b - f * (next[0] - at[0])) / g);
    } else if next[1] != free[1] && next[0] == free[0] && e > 0.0 {
        next[0] = clamped(0, at[0] + (a - f * (next[1] - at[1])) / e);
    }
    Some(next)
}
