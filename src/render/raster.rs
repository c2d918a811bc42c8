//! Triangles to samples: clipping, exact coverage, depth.
//!
//! Corners are rounded to fixed point once; from there on coverage is decided in integers, so triangles that share an
//! edge neither overlap nor leave a gap (Pineda, *A parallel algorithm for polygon rasterization*, 1988).

use super::camera::{SUBPIXELS, ScreenPoint, View};
use crate::math::Vec3;

/// Samples a pixel.
pub(super) const SAMPLES: usize = 16;

/// Sample places in 1/32 pixels from the middle of the pixel: one in every sixteenth row and column, spread evenly.
const PATTERN: [[i32; 2]; SAMPLES] = [
    [3, 3],
    [-1, -5],
    [-5, 5],
    [9, -1],
    [-9, -3],
    [5, 11],
    [11, 7],
    [7, -9],
    [-3, 13],
    [1, -13],
    [-7, -11],
    [-11, 9],
    [-15, 1],
    [15, -7],
    [13, 15],
    [-13, -15],
];

/// Pixels a side of a [`Tile`].
pub(super) const TILE: u32 = 32;

/// No triangle.
pub(super) const NOBODY: u32 = u32::MAX;

/// The place of a sample in its pixel, from the pixel's upper left corner.
pub(super) fn sample_offset(sample: usize) -> [f64; 2] {
    PATTERN[sample].map(|k| 0.5 + f64::from(k) / 32.0)
}

/// The samples of a square part of the picture: which triangle is nearest at each, and how near it is.
pub(super) struct Tile {
    /// Leftmost and uppermost pixel.
    pub(super) corner: [u32; 2],
    nearness: Vec<[f64; SAMPLES]>,
    triangle: Vec<[u32; SAMPLES]>,
}

impl Tile {
    pub(super) fn new(corner: [u32; 2]) -> Tile {
        let pixels = (TILE * TILE) as usize;
        Tile {
            corner,
            nearness: vec![[f64::NEG_INFINITY; SAMPLES]; pixels],
            triangle: vec![[NOBODY; SAMPLES]; pixels],
        }
    }

    /// Which triangle is seen at each sample of a pixel, by its place in the tile.
    pub(super) fn triangles_at(&self, x: u32, y: u32) -> &[u32; SAMPLES] {
        &self.triangle[(y * TILE + x) as usize]
    }

    /// How near the surface is at each sample of a pixel, by its place in the tile.
    pub(super) fn nearness_at(&self, x: u32, y: u32) -> &[f64; SAMPLES] {
        &self.nearness[(y * TILE + x) as usize]
    }

    /// Draws a triangle where it is nearer than what is there, into the samples of `mask`.
    pub(super) fn draw(&mut self, id: u32, corners: [ScreenPoint; 3], mask: u16) {
        let Some(setup) = Setup::new(corners) else { return };
        let [columns, rows] = [0, 1].map(|axis| {
            let first = (setup.min[axis] / SUBPIXELS - self.corner[axis] as i32).max(0);
            let last = (setup.max[axis] / SUBPIXELS - self.corner[axis] as i32).min(TILE as i32 - 1);
            first..=last
        });
        for row in rows {
            for column in columns.clone() {
                let pixel = [self.corner[0] as i32 + column, self.corner[1] as i32 + row];
                let covered = setup.coverage(pixel) & mask;
                if covered != 0 {
                    self.update((row * TILE as i32 + column) as usize, id, covered, setup.nearness(pixel));
                }
            }
        }
    }

    fn update(&mut self, pixel: usize, id: u32, covered: u16, nearness: [f64; SAMPLES]) {
        let (depths, owners) = (&mut self.nearness[pixel], &mut self.triangle[pixel]);
        for sample in 0..SAMPLES {
            if covered >> sample & 1 == 1 && nearness[sample] > depths[sample] {
                depths[sample] = nearness[sample];
                owners[sample] = id;
            }
        }
    }
}

/// A triangle ready to be sampled.
struct Setup {
    min: [i32; 2],
    max: [i32; 2],
    edges: [Edge; 3],
    plane: NearnessPlane,
    /// Change of nearness from the middle of a pixel to each sample.
    steps: [f64; SAMPLES],
}

/// `a x + b y + c >= 0` inside, in fixed point.
struct Edge {
    a: i64,
    b: i64,
    c: i64,
    /// Change from the middle of a pixel to each sample.
    steps: [i64; SAMPLES],
}

impl Setup {
    /// None for a triangle that covers nothing.
    fn new(corners: [ScreenPoint; 3]) -> Option<Setup> {
        let [p, q, r] = corners;
        let area = Edge::new(p, q).at(r);
        let [p, q, r] = if area < 0 { [p, r, q] } else { [p, q, r] };
        if area == 0 {
            return None;
        }
        let extreme = |of: fn(i32, i32) -> i32| [of(of(p.x, q.x), r.x), of(of(p.y, q.y), r.y)];
        let plane = NearnessPlane::new([p, q, r]);
        let steps =
            PATTERN.map(|[x, y]| (plane.slope[0] * f64::from(x) + plane.slope[1] * f64::from(y)) / 32.0);
        let edges = [Edge::new(p, q), Edge::new(q, r), Edge::new(r, p)].map(Edge::with_fill_rule);
        Some(Setup { min: extreme(i32::min), max: extreme(i32::max), edges, plane, steps })
    }

    /// The samples of a pixel that are inside, as bits.
    fn coverage(&self, pixel: [i32; 2]) -> u16 {
        let mut outside = [0_i64; SAMPLES];
        for edge in &self.edges {
            let middle = edge.at_middle(pixel);
            for (outside, step) in outside.iter_mut().zip(edge.steps) {
                *outside |= middle + step;
            }
        }
        outside.iter().enumerate().fold(0, |bits, (sample, &x)| bits | u16::from(x >= 0) << sample)
    }

    fn nearness(&self, pixel: [i32; 2]) -> [f64; SAMPLES] {
        let middle = self.plane.at(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
        self.steps.map(|step| self.plane.clamp(middle + step))
    }
}

impl Edge {
    /// Positive to the right of the way from `p` to `q` (y runs downward).
    fn new(p: ScreenPoint, q: ScreenPoint) -> Edge {
        let (a, b) = (i64::from(p.y) - i64::from(q.y), i64::from(q.x) - i64::from(p.x));
        Edge { a, b, c: -(a * i64::from(p.x) + b * i64::from(p.y)), steps: [0; SAMPLES] }
    }

    fn at(&self, p: ScreenPoint) -> i64 {
        self.a * i64::from(p.x) + self.b * i64::from(p.y) + self.c
    }

    fn at_middle(&self, pixel: [i32; 2]) -> i64 {
        let middle = |k: i32| i64::from(k) * i64::from(SUBPIXELS) + i64::from(SUBPIXELS / 2);
        self.a * middle(pixel[0]) + self.b * middle(pixel[1]) + self.c
    }

    /// Samples on an edge belong to the triangle right of or below it alone.
    fn with_fill_rule(mut self) -> Edge {
        let keeps_border = self.a > 0 || (self.a == 0 && self.b > 0);
        self.c -= i64::from(!keeps_border);
        let unit = i64::from(SUBPIXELS / 32);
        self.steps = PATTERN.map(|[x, y]| (self.a * i64::from(x) + self.b * i64::from(y)) * unit);
        self
    }
}

/// Nearness as a linear function of the place in the picture, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearnessPlane {
    origin: [f64; 2],
    at_origin: f64,
    slope: [f64; 2],
    least: f64,
    most: f64,
}

impl NearnessPlane {
    pub(super) fn new([p, q, r]: [ScreenPoint; 3]) -> NearnessPlane {
        let pixels = |k: i32| f64::from(k) / f64::from(SUBPIXELS);
        let (ux, uy) = (pixels(q.x) - pixels(p.x), pixels(q.y) - pixels(p.y));
        let (vx, vy) = (pixels(r.x) - pixels(p.x), pixels(r.y) - pixels(p.y));
        let (u, v) = (q.nearness - p.nearness, r.nearness - p.nearness);
        let area = ux * vy - uy * vx;
        NearnessPlane {
            origin: [pixels(p.x), pixels(p.y)],
            at_origin: p.nearness,
            slope: if area == 0.0 { [0.0; 2] } else { [(u * vy - v * uy) / area, (v * ux - u * vx) / area] },
            least: p.nearness.min(q.nearness).min(r.nearness),
            most: p.nearness.max(q.nearness).max(r.nearness),
        }
    }

    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        self.at_origin + self.slope[0] * (x - self.origin[0]) + self.slope[1] * (y - self.origin[1])
    }

    /// A triangle reaches no farther than its corners, however steep its plane.
    fn clamp(&self, nearness: f64) -> f64 {
        nearness.max(self.least).min(self.most)
    }
}

/// The part of a triangle, in view coordinates, that can be projected: a convex polygon.
pub(super) fn clipped(view: &View, triangle: [Vec3; 3]) -> Vec<ScreenPoint> {
    let mut polygon = triangle.to_vec();
    for plane in view.planes().into_iter().flatten() {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, &here) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()];
            let (d, e) = (plane.distance(here), plane.distance(next));
            if d >= 0.0 {
                kept.push(here);
            }
            // Always from the inside out, so that both triangles at an edge find the same point.
            if d >= 0.0 && e < 0.0 {
                kept.push(here + (next - here) * (d / (d - e)));
            } else if d < 0.0 && e >= 0.0 {
                kept.push(next + (here - next) * (e / (e - d)));
            }
        }
        polygon = kept;
    }
    polygon.into_iter().map(|p| view.project_clipped(p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Points on the grid that samples lie on, so that edges run through samples.
    fn on_samples([x, y]: [i32; 2]) -> ScreenPoint {
        let unit = SUBPIXELS / 32;
        ScreenPoint { x: x * unit, y: y * unit, nearness: 1.0 }
    }

    proptest! {
        /// Triangles about an inner point of a rectangle cover each of its samples once, in either direction.
        #[test]
        fn triangles_about_a_point_share_no_sample(
            x in 1..159_i32, y in 1..159_i32, along in prop::collection::btree_set(1..159_i32, 4..12), turned in any::<bool>(),
        ) {
            let mut border: Vec<[i32; 2]> = vec![[0, 0], [160, 0]];
            border.extend(along.iter().map(|&k| [160, k]));
            border.extend([[160, 160], [0, 160]]);
            border.extend(along.iter().rev().map(|&k| [0, k]));
            let fan: Vec<Setup> = (0..border.len())
                .filter_map(|i| {
                    let [p, q, r] = [border[i], border[(i + 1) % border.len()], [x, y]].map(on_samples);
                    Setup::new(if turned { [p, r, q] } else { [p, q, r] })
                })
                .collect();
            for pixel in (0..5).flat_map(|row| (0..5).map(move |column| [column, row])) {
                let covered: Vec<u16> = fan.iter().map(|setup| setup.coverage(pixel)).collect();
                prop_assert_eq!(covered.iter().fold(0, |all, bits| all | bits), u16::MAX);
                prop_assert_eq!(covered.iter().map(|bits| bits.count_ones()).sum::<u32>(), SAMPLES as u32);
            }
        }
    }
}
