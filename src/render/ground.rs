//! The soft shadow of a model on the ground it stands on.

use super::camera::View;
use super::film::Film;
use super::scene::{Scene, bin_triangles};
use crate::math::{Aabb, Vec3, exp};

/// Cells a side of the map of the ground.
const CELLS: usize = 256;

/// Width of the map, relative to the larger side of the model's footprint.
const MAP_WIDTH: f64 = 2.0;

/// Radii of the blurs that make up the shadow, relative to the map, and the share of each.
const BLURS: [(f64, f64); 3] = [(0.008, 0.34), (0.030, 0.24), (0.080, 0.20)];

/// The ground under a scene: the plane through its lowest point.
pub(super) struct Ground {
    height: f64,
    middle: Vec3,
    width: f64,
    /// Darkness from 0 to 1, row by row from the largest y down.
    shadow: Vec<f64>,
}

impl Ground {
    /// None for a scene without triangles, or one with no footprint.
    pub(super) fn under(scene: &Scene<'_>) -> Option<Ground> {
        let used = scene.indices.iter().flatten().map(|&v| scene.view.upright(scene.placed[v as usize]));
        let bounds = Aabb::of(used);
        let side = bounds.size().truncate().max_element();
        if side <= 0.0 || !side.is_finite() {
            return None;
        }
        let width = MAP_WIDTH * side;
        let center = bounds.center();
        let middle = Vec3::new(center.x, center.y, bounds.min.z);
        let gaps = gaps(scene, middle, width);
        let mut shadow = vec![0.0; CELLS * CELLS];
        for (radius, share) in BLURS {
            // What hovers at the height of the blur's radius casts half of it.
            let cast: Vec<f64> = gaps.iter().map(|gap| exp(-0.7 * gap / (radius * width))).collect();
            let blurred = blur(cast, (radius * CELLS as f64).ceil() as usize);
            shadow.iter_mut().zip(blurred).for_each(|(sum, x)| *sum += share * x);
        }
        Some(Ground { height: bounds.min.z, middle, width, shadow })
    }

    /// How dark the ground is where a ray in view coordinates meets it from above.
    pub(super) fn darkness(&self, view: &View, (origin, direction): (Vec3, Vec3)) -> f64 {
        let (origin, direction) = (view.upright(origin), view.upright(direction));
        let depth = (self.height - origin.z) / direction.z;
        if direction.z >= 0.0 || (view.is_perspective() && depth <= 0.0) || !depth.is_finite() {
            return 0.0;
        }
        let hit = (origin + direction * depth - self.middle) / self.width;
        let place = |k: f64| (k + 0.5) * CELLS as f64 - 0.5;
        self.interpolate(place(hit.x), place(-hit.y))
    }

    /// Bilinear; nothing outside.
    fn interpolate(&self, x: f64, y: f64) -> f64 {
        let inside = |k: f64| (0.0..(CELLS - 1) as f64).contains(&k);
        if !inside(x) || !inside(y) {
            return 0.0;
        }
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f64, y - row as f64);
        let at = |dx: usize, dy: usize| self.shadow[(row + dy) * CELLS + column + dx];
        (at(0, 0) * (1.0 - u) + at(1, 0) * u) * (1.0 - v) + (at(0, 1) * (1.0 - u) + at(1, 1) * u) * v
    }
}

/// For each cell, the free height between the ground and what is above it; infinite under the sky.
fn gaps(scene: &Scene<'_>, middle: Vec3, width: f64) -> Vec<f64> {
    let size = CELLS as u32;
    let view = scene.view.beneath(middle, width, size);
    let below = scene.reprojected(&view);
    let film = Film::expose(&below, &bin_triangles(&below, size, size), None, size, size);
    film.pixels.iter().map(|pixel| f64::from(pixel.depth).max(0.0)).collect()
}

/// Three box blurs each way, close to a Gaussian of standard deviation `radius` cells.
fn blur(mut cells: Vec<f64>, radius: usize) -> Vec<f64> {
    for _ in 0..3 {
        cells = transposed(&box_blurred(&transposed(&box_blurred(&cells, radius)), radius));
    }
    cells
}

/// Every cell becomes the mean of its row from `radius` before to `radius` after it; outside there is nothing.
fn box_blurred(cells: &[f64], radius: usize) -> Vec<f64> {
    let blurred_row = |row: &[f64]| -> Vec<f64> {
        let mut sums = vec![0.0];
        sums.extend(row.iter().scan(0.0, |sum, x| {
            *sum += x;
            Some(*sum)
        }));
        let mean = |i: usize| sums[(i + radius + 1).min(CELLS)] - sums[i.saturating_sub(radius)];
        (0..CELLS).map(|i| mean(i) / (2 * radius + 1) as f64).collect()
    };
    cells.chunks(CELLS).flat_map(blurred_row).collect()
}

fn transposed(cells: &[f64]) -> Vec<f64> {
    (0..CELLS * CELLS).map(|i| cells[i % CELLS * CELLS + i / CELLS]).collect()
}
