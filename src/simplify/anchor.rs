//! Where the shell around a mesh is known to hold all of the surface.
//!
//! Let M+ and M- be the two sides of the shell, and w+ and w- how often they wind around a point. Suppose that in a
//! vertex's neighbourhood the field grows along n, at rates between `least` and `most`, and that it is positive on M+ and
//! negative on M- there. From a zero z within the tolerance of the star, go down along -n by [`DEEP`] tolerances, to x: on
//! the way the field is negative, so M+ is not met. At x it is more negative than it can be within the tolerance of M;
//! so M, on its way to M+, does not pass x, and w+(z) is how often M winds around x. Likewise w-(z) is how often it
//! winds around a point y above, and their difference is how often, in all, M is passed upward between x and y. That does not
//! change as the line is moved along the star, and where the line meets no triangle that faces down it is not zero.

use super::fields::Fields;
use super::shell::{Local, Post};
use crate::math::{Aabb, Vec3};
use crate::mesh::Mesh;
use crate::par;
use crate::spatial::Bvh;

/// Depth of the points below and above, in tolerances.
const DEEP: f64 = 3.5;

/// Greatest ratio of `most` to `least`: the field at that depth is then below -4/3 `most` times the tolerance.
const STEEPEST: f64 = 1.5;

/// The box around a star in which the field must be known, in tolerances: a zero is within one, `DEEP` farther are the
/// points, within one of these the mesh, and within one of it both sides of its shell.
const KNOWN: f64 = DEEP + 3.0;

/// How far triangles must be looked at.
const NEAR: f64 = DEEP + 2.0;

/// Below this many stars threads are not worth waking.
const FEW: usize = 64;

/// A mesh with the shell around it.
pub(super) struct Shelled<'a> {
    pub(super) mesh: &'a Mesh,
    /// The triangles at each vertex.
    pub(super) around: &'a [Vec<u32>],
    pub(super) posts: &'a [Post],
    pub(super) fields: &'a Fields<'a>,
    pub(super) tolerance: f64,
}

/// What is known around a star.
struct Star {
    direction: Vec3,
    /// Those of its triangles whose first corner is the star's vertex, and for which the field's signs are proven.
    signed: Vec<u32>,
}

impl Shelled<'_> {
    /// The box around a star with the room that is needed there.
    pub(super) fn room(mesh: &Mesh, triangles: &[u32], tolerance: f64) -> Aabb {
        let corners = triangles.iter().flat_map(|&t| mesh.corners(t as usize));
        grown(Aabb::of(corners), KNOWN * tolerance)
    }

    /// For each vertex whether the shell holds all of the surface that is within the tolerance of its star.
    pub(super) fn anchored(&self) -> Vec<bool> {
        let vertices: Vec<u32> = (0..self.mesh.positions.len() as u32).collect();
        let stars = par::map_above(FEW, &vertices, |&v| self.star(v));
        let mut signed = vec![false; self.mesh.triangles.len()];
        for &t in stars.iter().flatten().flat_map(|star| &star.signed) {
            signed[t as usize] = true;
        }
        let boxes: Vec<Aabb> =
            (0..self.mesh.triangles.len()).map(|t| Aabb::around(self.mesh.corners(t))).collect();
        let bvh = Bvh::new(&boxes);
        par::map_above(FEW, &vertices, |&v| {
            stars[v as usize].as_ref().is_some_and(|star| {
                self.is_passed_upward(v, star.direction, &signed, &|cell, found| {
                    bvh.touching(&boxes, cell, found);
                })
            })
        })
    }

    fn star(&self, vertex: u32) -> Option<Star> {
        let triangles = &self.around[vertex as usize];
        let cell = Self::room(self.mesh, triangles, self.tolerance);
        let local = Local::of(self.fields.within(vertex, cell), cell)?;
        let own = triangles.iter().copied().filter(|&t| self.mesh.triangles[t as usize][0] == vertex);
        let posts = |t: u32| self.mesh.triangles[t as usize].map(|id| self.posts[id as usize]);
        let signed = own.filter(|&t| local.has_signs(&posts(t))).collect();
        let steep = local.most <= STEEPEST * local.least;
        steep.then_some(Star { direction: local.direction, signed })
    }

    /// Whether signs are known all around the star, and a line through it meets no triangle that faces down.
    fn is_passed_upward(
        &self,
        vertex: u32,
        up: Vec3,
        signed: &[bool],
        near: &dyn Fn(Aabb, &mut dyn FnMut(u32)),
    ) -> bool {
        let star = &self.around[vertex as usize];
        let area = |t: u32| {
            let [a, b, c] = self.mesh.corners(t as usize);
            (b - a).cross(c - a).dot(up)
        };
        let widest = star.iter().fold(star[0], |best, &t| if area(t) > area(best) { t } else { best });
        if area(widest) <= 0.0 {
            return false;
        }
        let on_line = center(self.mesh.corners(widest as usize));
        let corners = star.iter().flat_map(|&t| self.mesh.corners(t as usize));
        let mut passed = true;
        near(grown(Aabb::of(corners), NEAR * self.tolerance), &mut |t| {
            passed &= signed[t as usize] && (area(t) > 0.0 || self.is_beside(t, on_line, up));
        });
        passed
    }

    /// Whether a line passes beside a triangle.
    fn is_beside(&self, triangle: u32, on_line: Vec3, along: Vec3) -> bool {
        let corners = self.mesh.corners(triangle as usize);
        let middle = center(corners);
        let radius = corners.iter().fold(0.0, |most: f64, p| most.max(p.distance(middle)));
        (middle - on_line).cross(along).length() > 1.001 * radius
    }
}

fn center([a, b, c]: [Vec3; 3]) -> Vec3 {
    (a + b + c) / 3.0
}

pub(super) fn grown(cell: Aabb, distance: f64) -> Aabb {
    Aabb { min: cell.min - distance, max: cell.max + distance }
}
