//! A campaign over random closed sweeps: what comes out as a solid, and how far it is off.
//!
//! `OGEE_SWEEPS=200 OGEE_SEED=1 cargo test --release --test sweeps -- --nocapture` runs as many and tells what became of them.

use ogee::curve::{Spacing, Spline};
use ogee::math::{Vec2, Vec3, sin_cos_degrees};
use ogee::mesh::Solid;
use ogee::surface::{Surface, SurfaceError, Sweep};
use ogee::tessellate::{SurfaceOptions, Tessellation, capped, surface};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Numbers that look random and are the same every time (Steele, Lea, Flood, Fast splittable generators, 2014).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.next() % all.len() as u64) as usize]
    }
}

fn number_of(variable: &str, usual: u64) -> u64 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Points around the origin at about this distance, more or less uneven.
fn ring(numbers: &mut Numbers, radius: f64) -> Vec<Vec2> {
    let count = 3 + (numbers.next() % 6) as usize;
    let uneven = numbers.one_of(&[0.0, 0.2, 0.6]);
    let corner = |k: usize| {
        let (sine, cosine) = sin_cos_degrees(360.0 * k as f64 / count as f64);
        radius * (1.0 - uneven * numbers.unit()) * Vec2::new(cosine, sine)
    };
    (0..count).map(corner).collect()
}

/// A planar or space path of size 5; a profile from far smaller than its bends to one that reaches beyond its middle; closed
/// paths with whole turns of twist, open ones with any twist and scale.
fn random_sweep(numbers: &mut Numbers) -> Result<Sweep, SurfaceError> {
    let is_closed = numbers.one_of(&[false, true, true]);
    let height = numbers.one_of(&[0.0, 1.0, 3.0]);
    let points = ring(numbers, 5.0);
    let path: Vec<Vec3> = points.iter().map(|p| p.extend(height * (numbers.unit() - 0.5))).collect();
    let size = numbers.one_of(&[0.2, 1.0, 2.5, 5.0, 6.5]);
    let profile = ring(numbers, size);
    let spacing = numbers.one_of(&[Spacing::Uniform, Spacing::Centripetal]);
    let path = Spline::catmull_rom(&path, spacing, is_closed)?;
    let profile = Spline::catmull_rom(&profile, Spacing::Centripetal, true)?;
    let twist = numbers.one_of(&[0.0, 90.0_f64, 360.0, -720.0]).to_radians();
    let scale = if is_closed { 1.0 } else { numbers.one_of(&[1.0, 0.3, 2.0]) };
    Sweep::new(path, profile, twist, scale)
}

/// The largest distance of points of the sweep, not those that the mesh was made with, from the mesh near their parameters:
/// from triangles whose parameters are about theirs.
fn distance_from_mesh(sweep: &Sweep, made: &Tessellation, tolerance: f64) -> f64 {
    const GRID: usize = 23;
    let [[a, b], [c, d]] = sweep.domain();
    let mut most: f64 = 0.0;
    for k in 0..GRID * GRID {
        let share = |k: usize| (k as f64 + 0.43) / GRID as f64;
        let point = sweep.point(a + share(k / GRID) * (b - a), c + share(k % GRID) * (d - c));
        let mut least = f64::INFINITY;
        for t in 0..made.mesh.triangles.len() {
            let corners = made.mesh.corners(t);
            // Boxes first.
            let (low, high) =
                (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
            let outside = (low - point).max(point - high).max(Vec3::ZERO).length();
            if outside < least {
                least = least.min(to_triangle(point, corners));
            }
            if least <= most.max(0.5 * tolerance) {
                break;
            }
        }
        most = most.max(least);
    }
    most
}

fn to_triangle(point: Vec3, [a, b, c]: [Vec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = |p: Vec3, q: Vec3| normal.cross(q - p).dot(point - p) >= 0.0;
    if normal.length_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return (point - a).dot(normal.normalize()).abs();
    }
    let segment = |p: Vec3, q: Vec3| {
        let t = (point - p).dot(q - p) / (q - p).length_squared().max(f64::MIN_POSITIVE);
        (point - p - t.clamp(0.0, 1.0) * (q - p)).length()
    };
    segment(a, b).min(segment(b, c)).min(segment(c, a))
}

/// What becomes of a sweep: a solid with its triangles and error over the tolerance, or why not.
fn outcome(sweep: &Sweep, tolerance: f64) -> Result<(usize, f64), String> {
    let options = SurfaceOptions { max_triangles: 2_000_000, ..SurfaceOptions::within(tolerance) };
    let made = surface(sweep, &options).map_err(|error| error.to_string())?;
    if made.error.measured > tolerance {
        return Err(format!("tells {:.2} tolerances", made.error.measured / tolerance));
    }
    let closed = capped(&made.mesh, tolerance).map_err(|error| error.to_string())?;
    Solid::new(closed).map_err(|defects| format!("{defects:?}"))?;
    Ok((made.mesh.triangles.len(), distance_from_mesh(sweep, &made, tolerance) / tolerance))
}

#[test]
#[allow(clippy::print_stdout, reason = "a campaign says what it found")]
fn random_sweeps_become_solids_within_their_tolerance() {
    let (seed, count) = (number_of("OGEE_SEED", 1), number_of("OGEE_SWEEPS", 6));
    let mut numbers = Numbers(seed);
    let mut refused: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let (mut solids, mut triangles, mut worst) = (0, 0, (0.0_f64, 0));
    let mut slowest = (Duration::ZERO, 0);
    for index in 0..count {
        let made = random_sweep(&mut numbers);
        let tolerance = numbers.one_of(&[0.1, 0.05]);
        let start = Instant::now();
        match made.map_err(|error| error.to_string()).and_then(|sweep| outcome(&sweep, tolerance)) {
            Ok((made, off)) => {
                (solids, triangles) = (solids + 1, triangles + made);
                worst = if off > worst.0 { (off, index) } else { worst };
            }
            Err(reason) => refused.entry(reason).or_default().push(index),
        }
        slowest = slowest.max((start.elapsed(), index));
    }
    println!("seed {seed}: {solids} of {count} are solids, of {triangles} triangles in all");
    println!(
        "farthest over the tolerance {:.3} (number {}), slowest {:?} (number {})",
        worst.0, worst.1, slowest.0, slowest.1
    );
    refused.iter().for_each(|(reason, which)| println!("refused {which:?}: {reason}"));
    assert!(refused.is_empty() && worst.0 <= 1.0, "{refused:?} {worst:?}");
}
