//! How much ambient light reaches a surface, from the picture's own depths.
//!
//! After M. McGuire, B. Osman, M. Bukowski, P. Hennessy, *The Alchemy screen-space ambient obscurance algorithm* (2011):
//! points around a pixel that stand above its tangent plane take light away.

use super::camera::View;
use super::film::Film;
use crate::math::{Vec3, sin_cos};
use crate::par;
use std::f64::consts::TAU;

/// Points looked at for each pixel.
const TAPS: usize = 14;

/// Pixels a side of the block over which the pattern of points varies, and over which the result is averaged.
const BLOCK: usize = 4;

/// How dark a corner gets.
const STRENGTH: f64 = 3.6;

/// Sines of angles above the tangent plane that take no light: rounding must not darken flat faces.
const LEVEL: f64 = 0.03;

/// For each pixel, the share of ambient light that arrives, 0 to 1. Surfaces within `radius` (in view lengths) count.
pub(super) fn ambient_light(film: &Film, view: &View, radius: f64) -> Vec<f32> {
    let patterns = patterns();
    let rows: Vec<usize> = (0..film.height).collect();
    let raw: Vec<Vec<f32>> = par::map_above(2, &rows, |&y| {
        let pattern = |x: usize| &patterns[(y % BLOCK) * BLOCK + x % BLOCK];
        (0..film.width).map(|x| 1.0 - obscurance(film, view, radius, [x, y], pattern(x)) as f32).collect()
    });
    par::map_above(2, &rows, |&y| {
        (0..film.width).map(|x| average(film, &raw, radius, x, y)).collect::<Vec<f32>>()
    })
    .concat()
}

/// Directions and distances (0 to 1) of taps along a spiral, turned for each pixel of a block.
fn patterns() -> Vec<[[f64; 2]; TAPS]> {
    // The golden section turns the spirals of the block evenly.
    let turns = |i: usize| 0.618_033_988_749_894_9 * ((i * 7) % (BLOCK * BLOCK)) as f64;
    (0..BLOCK * BLOCK)
        .map(|i| {
            std::array::from_fn(|tap| {
                let share = (tap as f64 + (i % BLOCK) as f64 / BLOCK as f64 + 0.125) / TAPS as f64;
                let (s, c) = sin_cos(TAU * (share * 5.0 + turns(i)));
                [c * share, s * share]
            })
        })
        .collect()
}

fn obscurance(film: &Film, view: &View, radius: f64, [x, y]: [usize; 2], pattern: &[[f64; 2]; TAPS]) -> f64 {
    let Some((point, normal)) = surface(film, view, x as i64, y as i64) else { return 0.0 };
    let reach = view.pixels(radius, point.z).min(0.35 * film.height as f64);
    if reach < 1.0 {
        return 0.0;
    }
    let blocked = |offset: &[f64; 2]| {
        let [dx, dy] = offset.map(|k| (k * reach).round() as i64);
        if dx == 0 && dy == 0 {
            return 0.0;
        }
        let Some((other, _)) = surface(film, view, x as i64 + dx, y as i64 + dy) else { return 0.0 };
        let way = other - point;
        let distance = way.length();
        let fade = (1.0 - (distance / radius) * (distance / radius)).max(0.0);
        (way.dot(normal) / distance - LEVEL).max(0.0) * fade
    };
    let sum: f64 = pattern.iter().map(blocked).sum();
    (STRENGTH * sum / TAPS as f64).min(0.9)
}

/// Point and normal of the surface at a pixel, in view coordinates.
fn surface(film: &Film, view: &View, x: i64, y: i64) -> Option<(Vec3, Vec3)> {
    let pixel = film.at(x, y).filter(|pixel| pixel.depth.is_finite())?;
    let (origin, direction) = view.ray(x as f64 + 0.5, y as f64 + 0.5);
    let normal = Vec3::from(pixel.normal.map(f64::from));
    Some((origin + direction * f64::from(pixel.depth), normal))
}

/// The mean over a block of pixels of the same surface.
fn average(film: &Film, raw: &[Vec<f32>], radius: f64, x: usize, y: usize) -> f32 {
    let Some(here) = film.at(x as i64, y as i64).filter(|pixel| pixel.depth.is_finite()) else { return 1.0 };
    let block = |k: usize, end: usize| (k + 1).saturating_sub(BLOCK / 2)..(k + 1 + BLOCK / 2).min(end);
    let columns = block(x, film.width);
    let (mut sum, mut count) = (0.0, 0.0);
    for row in block(y, film.height) {
        let pixels = &film.pixels[row * film.width..][columns.clone()];
        for (other, light) in pixels.iter().zip(&raw[row][columns.clone()]) {
            let facing: f32 = (0..3).map(|i| here.normal[i] * other.normal[i]).sum();
            if f64::from((other.depth - here.depth).abs()) < 0.25 * radius && facing > 0.8 {
                sum += light;
                count += 1.0;
            }
        }
    }
    if count > 0.0 { sum / count } else { raw[y][x] }
}
