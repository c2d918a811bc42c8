//! A mesh seen through a view: everything that tiles are drawn from.

use super::camera::{SUBPIXELS, ScreenPoint, View};
use super::color::{Light, decode};
use super::crease::{Creases, facet_vector};
use super::light::{Shade, Studio};
use super::raster::{NOBODY, NearnessPlane, TILE, Tile, clipped};
use super::{RenderError, Style};
use crate::math::Vec3;
use crate::mesh::Mesh;
use crate::par;

/// A mesh in view coordinates with what is needed to draw and shade it.
pub(super) struct Scene<'a> {
    pub(super) view: &'a View,
    pub(super) indices: &'a [[u32; 3]],
    /// Positions in view coordinates.
    pub(super) placed: Vec<Vec3>,
    /// Where positions are in the picture, when they need no clipping.
    projected: Vec<Option<ScreenPoint>>,
    creases: Option<Creases>,
    paint: Paint,
    studio: Studio,
}

/// Colour and opacity of triangles.
struct Paint {
    material: (Light, f32),
    of_triangle: Vec<Option<(Light, f32)>>,
}

impl Paint {
    fn of(&self, triangle: u32) -> (Light, f32) {
        self.of_triangle.get(triangle as usize).copied().flatten().unwrap_or(self.material)
    }
}

/// What is seen at a place of a triangle.
pub(super) struct Sight {
    pub(super) shade: Shade,
    /// Distance in front of the eye.
    pub(super) depth: f64,
    /// Unit normal of the triangle itself, on the side that is seen; zero where it has no area.
    pub(super) normal: Vec3,
}

impl<'a> Scene<'a> {
    /// Checks the mesh against the view.
    pub(super) fn new(mesh: &'a Mesh, view: &'a View, style: &Style) -> Result<Scene<'a>, RenderError> {
        let count = mesh.positions.len();
        let used = |&v: &u32| mesh.positions.get(v as usize);
        if let Some(triangle) = mesh.triangles.iter().position(|t| t.iter().any(|v| used(v).is_none())) {
            return Err(RenderError::IndexOutOfRange { triangle, positions: count });
        }
        let placed = par::map(&mesh.positions, |&p| view.place(p));
        if let Some(&vertex) = mesh.triangles.iter().flatten().find(|&&v| !placed[v as usize].is_finite()) {
            let position = mesh.positions[vertex as usize];
            return Err(RenderError::OutOfSight { vertex: vertex as usize, position });
        }
        let projected = par::map(&placed, |&p| if p.is_finite() { view.project(p) } else { None });
        let needs_creases = style.crease > 0.0 || style.edges.is_some();
        let creases = needs_creases.then(|| Creases::new(&placed, &mesh.triangles, style.crease));
        let coat = |c: &[f32; 4]| (decode([c[0], c[1], c[2]]), if c[3].is_nan() { 1.0 } else { c[3] });
        let paint = Paint {
            material: coat(&style.material),
            of_triangle: par::map(&style.colors, |c| c.as_ref().map(coat)),
        };
        let studio = Studio::new(view.turn(Vec3::Z));
        Ok(Scene { view, indices: &mesh.triangles, placed, projected, creases, paint, studio })
    }

    /// The same triangles through a view of this scene's view coordinates, for coverage and depth only.
    pub(super) fn reprojected<'b>(&'b self, view: &'b View) -> Scene<'b> {
        let placed = par::map(&self.placed, |&p| view.place(p));
        let projected = par::map(&placed, |&p| if p.is_finite() { view.project(p) } else { None });
        let paint = Paint { material: self.paint.material, of_triangle: Vec::new() };
        Scene {
            view,
            indices: self.indices,
            placed,
            projected,
            creases: None,
            paint,
            studio: Studio::new(Vec3::Z),
        }
    }

    pub(super) fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.indices[triangle as usize].map(|v| self.placed[v as usize])
    }

    /// The sharp edges, as pairs of vertices.
    pub(super) fn sharp_edges(&self) -> Vec<[u32; 2]> {
        self.creases.as_ref().map(|creases| creases.sharp_edges(self.indices)).unwrap_or_default()
    }

    /// Hands the screen triangles of a triangle to `take`: one, or what clipping leaves.
    pub(super) fn for_each_part(&self, triangle: u32, mut take: impl FnMut([ScreenPoint; 3])) {
        let [a, b, c] = self.indices[triangle as usize].map(|v| self.projected[v as usize]);
        if let (Some(a), Some(b), Some(c)) = (a, b, c) {
            take([a, b, c]);
        } else if let [first, rest @ ..] = clipped(self.view, self.corners(triangle)).as_slice() {
            rest.windows(2).for_each(|pair| take([*first, pair[0], pair[1]]));
        }
    }

    /// Draws a triangle into a tile.
    pub(super) fn draw(&self, triangle: u32, tile: &mut Tile) {
        let (_, opacity) = self.paint.of(triangle);
        let mask = if opacity >= 1.0 { u16::MAX } else { self.screen_door(triangle, opacity) };
        self.for_each_part(triangle, |part| tile.draw(triangle, part, mask));
    }

    /// Opacity as the share of samples that a triangle covers. The two sides of a surface cover different ones, so that
    /// its back shows through its front.
    fn screen_door(&self, triangle: u32, opacity: f32) -> u16 {
        let covered = (opacity.clamp(0.0, 1.0) * 16.0).round() as u32;
        let corners = self.corners(triangle);
        let eye = if self.view.is_perspective() { corners[0] } else { Vec3::Z };
        let turn = if facet_vector(&corners).dot(eye) > 0.0 { 0 } else { 8 };
        (((1_u32 << covered) - 1) as u16).rotate_left(turn)
    }

    /// What is seen of a triangle at a place of the picture on it or close by.
    pub(super) fn look(&self, triangle: u32, x: f64, y: f64) -> Sight {
        let (origin, direction) = self.view.ray(x, y);
        let corners = self.corners(triangle);
        let facet = facet_vector(&corners);
        let depth = self.depth_at(&corners, facet, origin, direction);
        let point = origin + direction * depth;
        let eye = -direction.normalize();
        let mut facet = facet.normalize_or_zero();
        let mut normal = self.creases.as_ref().map_or(facet, |creases| {
            let [a, b, c] = creases.corner_normals(triangle);
            let [u, v, w] = barycentric(&corners, point);
            (a * u + b * v + c * w).try_normalize().unwrap_or(facet)
        });
        if facet.dot(eye) < 0.0 {
            (facet, normal) = (-facet, -normal);
        }
        // A smoothed normal may look away from the eye where the facet does not.
        let away = normal.dot(eye);
        if away < 0.0 {
            normal = (normal - eye * away).try_normalize().unwrap_or(facet);
        }
        let normal = if normal == Vec3::ZERO { eye } else { normal };
        Sight { shade: self.studio.shade(self.paint.of(triangle).0, normal, eye), depth, normal: facet }
    }

    /// Where a ray meets the plane of a triangle, kept within the depths of its corners and in front of the eye.
    fn depth_at(&self, corners: &[Vec3; 3], facet: Vec3, origin: Vec3, direction: Vec3) -> f64 {
        let depth = facet.dot(corners[0] - origin) / facet.dot(direction);
        let [a, b, c] = corners.map(|p| p.z);
        let depth = if depth.is_nan() { a } else { depth };
        depth.max(a.min(b).min(c)).min(a.max(b).max(c))
    }

    /// How near the plane of the triangle seen at a sample is at another place of the picture.
    pub(super) fn plane_of(&self, triangle: u32) -> Option<NearnessPlane> {
        let [a, b, c] = self.indices[triangle as usize].map(|v| self.projected[v as usize]);
        Some(NearnessPlane::new([a?, b?, c?]))
    }
}

/// Barycentric coordinates of a point in the plane of a triangle, moved onto it where it is outside; those of its
/// middle for a triangle without area.
fn barycentric(corners: &[Vec3; 3], point: Vec3) -> [f64; 3] {
    let facet = facet_vector(corners);
    let [a, b, c] = corners;
    let part = |from: &Vec3, to: &Vec3| facet.dot((to - from).cross(point - from)).max(0.0);
    let parts = [part(b, c), part(c, a), part(a, b)];
    let sum: f64 = parts.iter().sum();
    if sum > 0.0 { parts.map(|x| x / sum) } else { [1.0 / 3.0; 3] }
}

/// For each tile of a picture, what touches it.
pub(super) struct Bins {
    /// Tiles in a row and in a column.
    pub(super) tiles: [u32; 2],
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Bins {
    /// Sorts `count` items by the tiles that their boxes (least and largest pixel) touch.
    pub(super) fn new(width: u32, height: u32, boxes: &[Option<[[i32; 2]; 2]>]) -> Bins {
        let tiles = [width.div_ceil(TILE), height.div_ceil(TILE)];
        let touched = |item: &Option<[[i32; 2]; 2]>| {
            let range = |axis: usize| {
                let [min, max] = item.map_or([0, -1], |[min, max]| [min[axis], max[axis]]);
                let tile = |pixel: i32| pixel.div_euclid(TILE as i32);
                tile(min).max(0)..(tile(max) + 1).clamp(0, tiles[axis] as i32)
            };
            let (columns, rows) = (range(0), range(1));
            rows.flat_map(move |row| {
                columns.clone().map(move |column| row as usize * tiles[0] as usize + column as usize)
            })
        };
        let mut starts = vec![0; (tiles[0] * tiles[1]) as usize + 1];
        for tile in boxes.iter().flat_map(touched) {
            starts[tile + 1] += 1;
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut next = starts.clone();
        let mut items = vec![NOBODY; starts[starts.len() - 1]];
        for (item, area) in boxes.iter().enumerate() {
            for tile in touched(area) {
                items[next[tile]] = item as u32;
                next[tile] += 1;
            }
        }
        Bins { tiles, starts, items }
    }

    /// The items that touch a tile, in order.
    pub(super) fn at(&self, tile: u32) -> &[u32] {
        &self.items[self.starts[tile as usize]..self.starts[tile as usize + 1]]
    }

    /// Leftmost and uppermost pixel of a tile.
    pub(super) fn corner(&self, tile: u32) -> [u32; 2] {
        [tile % self.tiles[0] * TILE, tile / self.tiles[0] * TILE]
    }

    /// All tiles, row by row.
    pub(super) fn all(&self) -> Vec<u32> {
        (0..self.tiles[0] * self.tiles[1]).collect()
    }
}

/// The triangles of a scene by the tiles they touch.
pub(super) fn bin_triangles(scene: &Scene<'_>, width: u32, height: u32) -> Bins {
    let triangles: Vec<u32> = (0..scene.indices.len() as u32).collect();
    let boxes = par::map(&triangles, |&t| {
        let mut area: Option<[[i32; 2]; 2]> = None;
        scene.for_each_part(t, |part| {
            for p in part {
                let pixel = [p.x.div_euclid(SUBPIXELS), p.y.div_euclid(SUBPIXELS)];
                let [min, max] = area.unwrap_or([pixel, pixel]);
                area = Some([
                    [min[0].min(pixel[0]), min[1].min(pixel[1])],
                    [max[0].max(pixel[0]), max[1].max(pixel[1])],
                ]);
            }
        });
        area
    });
    Bins::new(width, height, &boxes)
}
