//! Sharp edges as lines of even width, hidden where something is in front of them.

use super::camera::{SUBPIXELS, ScreenPoint};
use super::raster::{NOBODY, NearnessPlane, TILE, Tile, clipped, sample_offset};
use super::scene::{Bins, Scene};
use crate::par;

/// The lines of a picture, sorted by tile.
pub(super) struct Lines {
    segments: Vec<Option<Segment>>,
    bins: Bins,
    /// Half the width, in pixels.
    radius: f64,
}

/// A line in the picture, in pixels; nearness is linear along it.
#[derive(Clone, Copy)]
struct Segment {
    from: [f64; 2],
    way: [f64; 2],
    length_sq: f64,
    nearness: [f64; 2],
}

impl Lines {
    /// The sharp edges of a scene, `line_width` pixels wide.
    pub(super) fn new(scene: &Scene<'_>, line_width: f64, width: u32, height: u32) -> Lines {
        let radius = 0.5 * line_width;
        let segments = par::map(&scene.sharp_edges(), |&[a, b]| {
            let [a, b] = [a, b].map(|v| scene.placed[v as usize]);
            match clipped(scene.view, [a, a, b]).as_slice() {
                [] => None,
                // The clipped sliver is as long as the line between its first point and the farthest one.
                [first, rest @ ..] => {
                    rest.iter().max_by_key(|p| reach(first, p)).map(|last| Segment::new(*first, *last))
                }
            }
        });
        let boxes: Vec<_> = segments.iter().map(|s| s.as_ref().map(|s| s.pixels(radius))).collect();
        Lines { bins: Bins::new(width, height, &boxes), segments, radius }
    }

    /// For each pixel of a tile, the samples that a line covers, as bits.
    pub(super) fn cover(&self, scene: &Scene<'_>, tile: &Tile, index: u32) -> Vec<u16> {
        let mut covered = vec![0_u16; (TILE * TILE) as usize];
        for segment in self.bins.at(index).iter().filter_map(|&s| self.segments[s as usize].as_ref()) {
            let [min, max] = segment.pixels(self.radius);
            let range = |axis: usize| {
                let place = |pixel: i32| pixel - tile.corner[axis] as i32;
                place(min[axis]).max(0) as u32..(place(max[axis]) + 1).clamp(0, TILE as i32) as u32
            };
            for y in range(1) {
                for x in range(0) {
                    covered[(y * TILE + x) as usize] |= self.cover_pixel(segment, scene, tile, [x, y]);
                }
            }
        }
        covered
    }

    fn cover_pixel(&self, segment: &Segment, scene: &Scene<'_>, tile: &Tile, [x, y]: [u32; 2]) -> u16 {
        let corner = [f64::from(tile.corner[0] + x), f64::from(tile.corner[1] + y)];
        let owners = tile.triangles_at(x, y);
        let mut plane: Option<(u32, Option<NearnessPlane>)> = None;
        let mut bits = 0;
        for (sample, &owner) in owners.iter().enumerate() {
            let offset = sample_offset(sample);
            let Some((place, nearness)) =
                segment.closest([corner[0] + offset[0], corner[1] + offset[1]], self.radius)
            else {
                continue;
            };
            if plane.is_none_or(|(of, _)| of != owner) && owner != NOBODY {
                plane = Some((owner, scene.plane_of(owner)));
            }
            // The surface seen here, continued to the line: where it is one of the line's own faces, both agree.
            let surface = match plane {
                _ if owner == NOBODY => f64::NEG_INFINITY,
                Some((_, Some(plane))) => plane.at(place[0], place[1]),
                _ => tile.nearness_at(x, y)[sample],
            };
            // Faces beside the line's own may stick out by as much as a pixel is wide.
            let slack = if scene.view.is_perspective() { nearness } else { 1.0 } / scene.view.zoom;
            bits |= u16::from(surface <= nearness + slack) << sample;
        }
        bits
    }
}

fn reach(a: &ScreenPoint, b: &ScreenPoint) -> i64 {
    (i64::from(a.x) - i64::from(b.x)).abs() + (i64::from(a.y) - i64::from(b.y)).abs()
}

impl Segment {
    fn new(a: ScreenPoint, b: ScreenPoint) -> Segment {
        let pixels = |k: i32| f64::from(k) / f64::from(SUBPIXELS);
        let way = [pixels(b.x) - pixels(a.x), pixels(b.y) - pixels(a.y)];
        Segment {
            from: [pixels(a.x), pixels(a.y)],
            way,
            length_sq: way[0] * way[0] + way[1] * way[1],
            nearness: [a.nearness, b.nearness],
        }
    }

    /// Least and largest pixel that the line may touch.
    fn pixels(&self, radius: f64) -> [[i32; 2]; 2] {
        let end = [self.from[0] + self.way[0], self.from[1] + self.way[1]];
        let least = |axis: usize| (self.from[axis].min(end[axis]) - radius).floor() as i32;
        let most = |axis: usize| (self.from[axis].max(end[axis]) + radius).floor() as i32;
        [[least(0), least(1)], [most(0), most(1)]]
    }

    /// The place of the line closest to `p` and its nearness, when it is within `radius`.
    fn closest(&self, p: [f64; 2], radius: f64) -> Option<([f64; 2], f64)> {
        let along = (p[0] - self.from[0]) * self.way[0] + (p[1] - self.from[1]) * self.way[1];
        let t = if self.length_sq > 0.0 { (along / self.length_sq).clamp(0.0, 1.0) } else { 0.0 };
        let place = [self.from[0] + t * self.way[0], self.from[1] + t * self.way[1]];
        let (dx, dy) = (p[0] - place[0], p[1] - place[1]);
        let nearness = self.nearness[0] + t * (self.nearness[1] - self.nearness[0]);
        (dx * dx + dy * dy <= radius * radius).then_some((place, nearness))
    }
}
