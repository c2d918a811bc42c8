//! What a picture holds before it is developed: light, coverage, depth and normal of every pixel.

use super::color::{Light, add};
use super::lines::Lines;
use super::raster::{NOBODY, SAMPLES, TILE, Tile, sample_offset};
use super::scene::{Bins, Scene};
use crate::par;

/// One pixel of a [`Film`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
    /// Light from lamps, of the covered samples.
    pub(super) direct: Light,
    /// Light from all around, of the covered samples.
    pub(super) ambient: Light,
    /// Share of samples that show a surface.
    pub(super) coverage: f32,
    /// Share of samples on a line.
    pub(super) line: f32,
    /// Distance of the surface most samples show; infinite where there is none.
    pub(super) depth: f32,
    /// Unit normal of that surface.
    pub(super) normal: [f32; 3],
}

impl Pixel {
    const EMPTY: Pixel = Pixel {
        direct: [0.0; 3],
        ambient: [0.0; 3],
        coverage: 0.0,
        line: 0.0,
        depth: f32::INFINITY,
        normal: [0.0; 3],
    };
}

/// Pixels row by row, the upper left one first.
pub(super) struct Film {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<Pixel>,
}

impl Film {
    /// Draws the triangles of a scene, and its lines if there are any.
    pub(super) fn expose(
        scene: &Scene<'_>,
        bins: &Bins,
        lines: Option<&Lines>,
        width: u32,
        height: u32,
    ) -> Film {
        let tiles = par::map_above(2, &bins.all(), |&index| expose_tile(scene, bins, lines, index));
        let mut film = Film {
            width: width as usize,
            height: height as usize,
            pixels: vec![Pixel::EMPTY; width as usize * height as usize],
        };
        for (index, tile) in tiles.iter().enumerate() {
            let [left, top] = bins.corner(index as u32).map(|k| k as usize);
            let columns = (TILE as usize).min(film.width - left);
            for (row, pixels) in tile.chunks(TILE as usize).enumerate().take(film.height - top) {
                let start = (top + row) * film.width + left;
                film.pixels[start..start + columns].copy_from_slice(&pixels[..columns]);
            }
        }
        film
    }

    /// The pixel at a place that may be outside.
    pub(super) fn at(&self, x: i64, y: i64) -> Option<&Pixel> {
        let inside = (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y);
        inside.then(|| &self.pixels[y as usize * self.width + x as usize])
    }
}

fn expose_tile(scene: &Scene<'_>, bins: &Bins, lines: Option<&Lines>, index: u32) -> Vec<Pixel> {
    let mut tile = Tile::new(bins.corner(index));
    for &triangle in bins.at(index) {
        scene.draw(triangle, &mut tile);
    }
    let lined = lines.map(|lines| lines.cover(scene, &tile, index));
    let places = (0..TILE).flat_map(|y| (0..TILE).map(move |x| (x, y)));
    let pixel = |(x, y): (u32, u32)| {
        let mut pixel = resolve(scene, &tile, x, y);
        if let Some(lined) = &lined {
            pixel.line = lined[(y * TILE + x) as usize].count_ones() as f32 / SAMPLES as f32;
        }
        pixel
    };
    places.map(pixel).collect()
}

/// Shades every triangle seen in a pixel once, at the mean of the samples that show it.
fn resolve(scene: &Scene<'_>, tile: &Tile, x: u32, y: u32) -> Pixel {
    let owners = tile.triangles_at(x, y);
    let mut pixel = Pixel::EMPTY;
    let (mut done, mut largest) = (0_u16, 0);
    for first in 0..SAMPLES {
        let owner = owners[first];
        if done >> first & 1 == 1 || owner == NOBODY {
            continue;
        }
        let (mut count, mut place) = (0_u16, [0.0; 2]);
        for sample in (first..SAMPLES).filter(|&sample| owners[sample] == owner) {
            done |= 1 << sample;
            count += 1;
            let offset = sample_offset(sample);
            place = [place[0] + offset[0], place[1] + offset[1]];
        }
        let [left, top] = tile.corner;
        let mean = |k: u32, sum: f64| f64::from(k) + sum / f64::from(count);
        let sight = scene.look(owner, mean(left + x, place[0]), mean(top + y, place[1]));
        let share = f32::from(count) / SAMPLES as f32;
        pixel.direct = add(pixel.direct, sight.shade.direct, share);
        pixel.ambient = add(pixel.ambient, sight.shade.ambient, share);
        pixel.coverage += share;
        if count > largest {
            largest = count;
            pixel.depth = sight.depth as f32;
            pixel.normal = sight.normal.to_array().map(|k| k as f32);
        }
    }
    pixel
}
