//! The true surface, written down apart from all that is measured: smooth sheets, and which side of each is inside.
//!
//! A shape is what all its sheets have in common, or, as a union, what is inside of any. The nearest point of its surface
//! lies on a sheet, on a curve that two share, at a corner of three or at an apex: Newton steps find each candidate, and
//! those that are beyond another sheet are no surface.

use crate::models::{DOMAIN, Random};
use ogee::math::{Aabb, Mat3, Vec3};

/// A smooth function, negative inside, never steeper than 1.
#[derive(Clone, Copy)]
pub(crate) enum Sheet {
    Sphere {
        center: Vec3,
        radius: f64,
    },
    Torus {
        major: f64,
        minor: f64,
    },
    RoundedBox {
        half: Vec3,
        radius: f64,
    },
    /// The outside of a cylinder around an axis.
    Hole {
        axis: usize,
        radius: f64,
    },
    Plane {
        normal: Vec3,
        offset: f64,
    },
    /// Around the z axis, its apex upwards at this height.
    Cone {
        cosine: f64,
        sine: f64,
        apex: f64,
    },
    /// One side of the wall around a gyroid.
    Gyroid {
        turns: f64,
        sign: f64,
        half: f64,
    },
    /// Two balls and the quadratic smooth minimum.
    SmoothPair {
        balls: [(Vec3, f64); 2],
        reach: f64,
    },
}

impl Sheet {
    fn value(&self, p: Vec3) -> f64 {
        match *self {
            Sheet::Sphere { center, radius } => p.distance(center) - radius,
            Sheet::Torus { major, minor } => (p.x.hypot(p.y) - major).hypot(p.z) - minor,
            Sheet::RoundedBox { half, radius } => {
                let q = p.abs() - (half - Vec3::splat(radius));
                q.max(Vec3::ZERO).length() + q.max_element().min(0.0) - radius
            }
            Sheet::Hole { axis, radius } => radius - p[(axis + 1) % 3].hypot(p[(axis + 2) % 3]),
            Sheet::Plane { normal, offset } => normal.dot(p) - offset,
            Sheet::Cone { cosine, sine, apex } => p.x.hypot(p.y) * cosine + (p.z - apex) * sine,
            Sheet::Gyroid { turns, sign, half } => {
                let q = turns * p;
                let sum = q.x.sin() * q.y.cos() + q.y.sin() * q.z.cos() + q.z.sin() * q.x.cos();
                sign * sum / (3.0_f64.sqrt() * turns) - half
            }
            Sheet::SmoothPair { balls, reach } => {
                let [a, b] = balls.map(|(center, radius)| p.distance(center) - radius);
                let near = (reach - (a - b).abs()).max(0.0);
                a.min(b) - near * near / (4.0 * reach)
            }
        }
    }

    fn gradient(&self, p: Vec3) -> Vec3 {
        const STEP: f64 = 1e-6;
        let slope = |axis: Vec3| (self.value(p + STEP * axis) - self.value(p - STEP * axis)) / (2.0 * STEP);
        Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z))
    }
}

/// A surface made of sheets.
pub(crate) struct Truth {
    sheets: Vec<Sheet>,
    /// -1 for a union: the complement of what all complements have in common.
    sign: f64,
    /// Points of the surface at which no sheet is smooth.
    corners: Vec<Vec3>,
    volume: Option<f64>,
    /// For each cell of a grid over the domain the sheets that come near it.
    near: Vec<Vec<u32>>,
}

/// Cells along a side of the grid of sheets.
const SIDE: usize = 24;

/// Sheets further away than this from a cell are left out there; no error worth a row is as large.
const REACH: f64 = 0.2;

/// How far beyond a sheet still counts as on it.
const SLACK: f64 = 1e-9;

impl Truth {
    pub(crate) fn intersection(sheets: Vec<Sheet>) -> Truth {
        Truth { sheets, sign: 1.0, corners: Vec::new(), volume: None, near: Vec::new() }.with_grid()
    }

    pub(crate) fn union(sheets: Vec<Sheet>) -> Truth {
        Truth { sheets, sign: -1.0, corners: Vec::new(), volume: None, near: Vec::new() }.with_grid()
    }

    pub(crate) fn with_volume(self, volume: f64) -> Truth {
        Truth { volume: Some(volume), ..self }
    }

    pub(crate) fn with_corners(self, corners: Vec<Vec3>) -> Truth {
        Truth { corners, ..self }
    }

    fn with_grid(mut self) -> Truth {
        let size = 2.0 / SIDE as f64;
        let far = REACH + 0.5 * size * 3.0_f64.sqrt();
        self.near = (0..SIDE * SIDE * SIDE)
            .map(|i| {
                let cell = Vec3::new((i % SIDE) as f64, (i / SIDE % SIDE) as f64, (i / SIDE / SIDE) as f64);
                let middle = DOMAIN.min + size * (cell + Vec3::splat(0.5));
                let comes_near = |k: &u32| self.beyond(*k, middle) > -far;
                (0..self.sheets.len() as u32).filter(comes_near).collect()
            })
            .collect();
        self
    }

    /// The sheets that a point can be near to or beyond.
    fn around(&self, p: Vec3) -> &[u32] {
        let cell = ((p - DOMAIN.min) * (0.5 * SIDE as f64))
            .floor()
            .clamp(Vec3::ZERO, Vec3::splat(SIDE as f64 - 1.0));
        let [x, y, z] = cell.to_array().map(|c| c as usize);
        &self.near[x + SIDE * (y + SIDE * z)]
    }

    /// How far a point is beyond a sheet of the intersection.
    fn beyond(&self, sheet: u32, p: Vec3) -> f64 {
        self.sign * self.sheets[sheet as usize].value(p)
    }

    fn is_surface(&self, q: Vec3) -> bool {
        self.around(q).iter().all(|&k| self.beyond(k, q) <= SLACK)
    }

    /// Negative inside.
    fn value(&self, p: Vec3) -> f64 {
        let most = self.around(p).iter().map(|&k| self.beyond(k, p)).fold(-REACH, f64::max);
        self.sign * most
    }

    /// The point of the surface nearest to `p`, which should be near.
    pub(crate) fn nearest(&self, p: Vec3) -> Option<Vec3> {
        let mut best = Best { from: p, point: None, distance: f64::INFINITY };
        self.corners.iter().for_each(|&corner| best.offer(corner));
        let near = self.around(p);
        for &i in near {
            if self.beyond(i, p).abs() >= best.distance {
                continue;
            }
            let Some(q) = self.onto(&[i], p) else { continue };
            if q.distance(p) >= best.distance {
                continue;
            }
            if self.is_surface(q) {
                best.offer(q);
                continue;
            }
            for &j in near.iter().filter(|&&j| j != i && self.beyond(j, q) > SLACK) {
                self.try_curve([i, j], near, &mut best);
            }
        }
        best.point
    }

    fn try_curve(&self, [i, j]: [u32; 2], near: &[u32], best: &mut Best) {
        let Some(q) = self.onto(&[i, j], best.from) else { return };
        if q.distance(best.from) >= best.distance {
            return;
        }
        if self.is_surface(q) {
            best.offer(q);
            return;
        }
        for &k in near.iter().filter(|&&k| k != i && k != j && self.beyond(k, q) > SLACK) {
            if let Some(q) = self.onto(&[i, j, k], best.from).filter(|&q| self.is_surface(q)) {
                best.offer(q);
            }
        }
    }

    /// The point nearest to `p` at which up to three sheets are zero: Newton steps of least length, and between them steps
    /// towards `p` along what all of them share.
    fn onto(&self, sheets: &[u32], p: Vec3) -> Option<Vec3> {
        let mut q = p;
        for _ in 0..6 {
            for _ in 0..8 {
                let step = self.step(sheets, q)?;
                q += step;
                if step.length() < 1e-13 {
                    break;
                }
            }
            let back = self.along(sheets, q, p - q);
            if back.length() < 1e-9 * p.distance(q) + 1e-12 {
                break;
            }
            q += back;
        }
        q += self.step(sheets, q)?;
        let on = sheets.iter().all(|&k| self.beyond(k, q).abs() < 1e-10);
        (on && q.is_finite()).then_some(q)
    }

    /// The shortest step to where the sheets' linear parts are zero.
    fn step(&self, sheets: &[u32], q: Vec3) -> Option<Vec3> {
        let of = |k: u32| (self.sheets[k as usize].value(q), self.sheets[k as usize].gradient(q));
        let rows: Vec<(f64, Vec3)> = sheets.iter().map(|&k| of(k)).collect();
        let step = match rows[..] {
            [(a, u)] => -a / u.length_squared() * u,
            [(a, u), (b, v)] => {
                let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
                let determinant = uu * vv - uv * uv;
                ((uv * b - vv * a) * u + (uv * a - uu * b) * v) / determinant
            }
            [(a, u), (b, v), (c, w)] => Mat3::from_cols(u, v, w).transpose().inverse() * -Vec3::new(a, b, c),
            _ => return None,
        };
        (step.is_finite() && step.length() < REACH).then_some(step)
    }

    /// The part of a vector along all sheets.
    fn along(&self, sheets: &[u32], q: Vec3, v: Vec3) -> Vec3 {
        let normals: Vec<Vec3> = sheets.iter().map(|&k| self.sheets[k as usize].gradient(q)).collect();
        match normals[..] {
            [u] => v - v.dot(u) / u.length_squared() * u,
            [u, w] => {
                let line = u.cross(w).normalize_or_zero();
                v.dot(line) * line
            }
            _ => Vec3::ZERO,
        }
    }

    /// Points all over the surface, and points of its creases: random ones, one in each cell of a grid near it, moved
    /// onto it.
    pub(crate) fn samples(&self, bounds: Aabb, cells: usize) -> Samples {
        let step = bounds.size().max_element() / cells as f64;
        let counts = (bounds.size() / step).ceil();
        let mut random = Random(1);
        let mut samples = Samples { surface: Vec::new(), creases: self.corners.clone() };
        for z in 0..counts.z as usize {
            for y in 0..counts.y as usize {
                for x in 0..counts.x as usize {
                    let inside = Vec3::from_array([(); 3].map(|()| random.unit()));
                    let p = bounds.min + step * (Vec3::new(x as f64, y as f64, z as f64) + inside);
                    if self.value(p).abs() < step {
                        samples.surface.extend(self.nearest(p).filter(|q| q.distance(p) < 4.0 * step));
                        self.sample_creases(p, step, &mut samples.creases);
                    }
                }
            }
        }
        samples
    }

    fn sample_creases(&self, p: Vec3, step: f64, creases: &mut Vec<Vec3>) {
        let close: Vec<u32> =
            self.around(p).iter().copied().filter(|&k| self.beyond(k, p).abs() < step).collect();
        for (i, &a) in close.iter().enumerate() {
            for &b in &close[..i] {
                let crease =
                    self.onto(&[a, b], p).filter(|&q| q.distance(p) < 2.0 * step && self.is_surface(q));
                creases.extend(crease);
            }
        }
    }

    /// The volume: known, or the sum over a fine grid of how much of each cell is inside by value and slope, good to a few
    /// parts in 1e5.
    pub(crate) fn volume(&self) -> f64 {
        const CELLS: usize = 320;
        if let Some(volume) = self.volume {
            return volume;
        }
        let step = 2.0 / CELLS as f64;
        let part = |i: usize| {
            let cell = Vec3::new((i % CELLS) as f64, (i / CELLS % CELLS) as f64, (i / CELLS / CELLS) as f64);
            let p = DOMAIN.min + step * (cell + Vec3::splat(0.5));
            let value = self.value(p);
            if value.abs() > 2.0 * step {
                return if value < 0.0 { 1.0 } else { 0.0 };
            }
            let h = 0.25 * step;
            let slope = |axis: Vec3| (self.value(p + h * axis) - self.value(p - h * axis)) / (2.0 * h);
            let steep = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).length().max(1e-3);
            (0.5 - value / (steep * step)).clamp(0.0, 1.0)
        };
        (0..CELLS * CELLS * CELLS).map(part).sum::<f64>() * step * step * step
    }
}

/// Points of a surface.
pub(crate) struct Samples {
    pub(crate) surface: Vec<Vec3>,
    pub(crate) creases: Vec<Vec3>,
}

/// The nearest so far.
struct Best {
    from: Vec3,
    point: Option<Vec3>,
    distance: f64,
}

impl Best {
    fn offer(&mut self, point: Vec3) {
        let distance = self.from.distance(point);
        if distance < self.distance {
            (self.point, self.distance) = (Some(point), distance);
        }
    }
}
