//! What a mesh is worth, by the true surface.

use crate::models::Model;
use crate::truth::{Samples, Truth};
use ogee::math::{Aabb, Vec3};
use ogee::mesh::{self, Defects, Mesh};
use ogee::spatial::Bvh;

/// What is measured of a mesh.
pub(crate) struct Judgement {
    pub(crate) triangles: usize,
    /// The largest distance of a point of the mesh from the surface.
    pub(crate) from_mesh: f64,
    /// The largest distance of a point of the surface from the mesh.
    pub(crate) from_surface: f64,
    /// The largest distance of a point of a crease from the mesh; `None` where there is no crease.
    pub(crate) creases: Option<f64>,
    /// The error of the volume as a part of it.
    pub(crate) volume: f64,
    pub(crate) closed: bool,
    pub(crate) non_manifold_edges: usize,
    pub(crate) crossings: usize,
}

impl Judgement {
    /// Both ways.
    pub(crate) fn error(&self) -> f64 {
        self.from_mesh.max(self.from_surface)
    }
}

/// Cells of the grid of samples along the longest side of a shape.
const CELLS: usize = 120;

/// A shape's surface, sampled once.
pub(crate) struct Judge<'a> {
    truth: &'a Truth,
    samples: Samples,
    volume: f64,
}

impl<'a> Judge<'a> {
    pub(crate) fn of(model: &'a Model) -> Judge<'a> {
        let bounds = model.field.bounds();
        let margin = Vec3::splat(0.01);
        let around = Aabb { min: bounds.min - margin, max: bounds.max + margin };
        Judge {
            truth: &model.truth,
            samples: model.truth.samples(around, CELLS),
            volume: model.truth.volume(),
        }
    }

    pub(crate) fn judge(&self, mesh: &Mesh) -> Judgement {
        let defects = Defects::of(mesh);
        let all: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        let [from_surface, creases] = self.distances_to(mesh);
        Judgement {
            triangles: mesh.triangles.len(),
            from_mesh: self.distance_of(mesh),
            from_surface,
            creases: (!self.samples.creases.is_empty()).then_some(creases),
            volume: (mesh::volume(mesh) - self.volume) / self.volume,
            closed: defects.open_edges == 0 && defects.is_closed(),
            non_manifold_edges: defects.non_manifold_edges + defects.misoriented_edges,
            crossings: mesh::crossing_pairs(mesh, &all).len(),
        }
    }

    /// Over corners, the middles of sides, and the middle of each triangle.
    fn distance_of(&self, mesh: &Mesh) -> f64 {
        let mut most: f64 = 0.0;
        let mut look = |p: Vec3| {
            let distance = self.truth.nearest(p).map_or(f64::INFINITY, |q| q.distance(p));
            most = most.max(distance);
        };
        mesh.positions.iter().for_each(|&p| look(p));
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let corners = mesh.corners(index);
            look((corners[0] + corners[1] + corners[2]) / 3.0);
            for k in 0..3 {
                // Each side is met from both of its triangles.
                if triangle[k] < triangle[(k + 1) % 3] {
                    look(0.5 * (corners[k] + corners[(k + 1) % 3]));
                }
            }
        }
        most
    }

    /// The largest distances of samples, of the surface and of its creases.
    fn distances_to(&self, mesh: &Mesh) -> [f64; 2] {
        let boxes: Vec<Aabb> = (0..mesh.triangles.len()).map(|t| Aabb::of(mesh.corners(t))).collect();
        let bvh = Bvh::new(&boxes);
        let distance = |p: &Vec3| {
            let squared = |t: u32| (closest(*p, mesh.corners(t as usize)) - *p).length_squared();
            bvh.nearest(&boxes, *p, squared).map_or(f64::INFINITY, |t| squared(t).sqrt())
        };
        [&self.samples.surface, &self.samples.creases]
            .map(|points| points.iter().map(distance).fold(0.0, f64::max))
    }
}

/// The point of a triangle closest to `p` (Ericson, Real-time collision detection, 2005, 5.1.5).
fn closest(p: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    let scale = 1.0 / (va + vb + vc);
    a + ab * (vb * scale) + ac * (vc * scale)
}
