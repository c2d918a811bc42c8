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
use crate::math::{Aabb, Vec3};
use crate::mesh::Mesh;
use crate::par;
use crate::sdf::{Local, Shell};

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
    pub(super) shell: Shell<'a>,
    pub(super) fields: &'a Fields<'a>,
    pub(super) tolerance: f64,
}

/// What is known around a star.
struct Star {
    /// In which the field grows, steadily enough.
    direction: Option<Vec3>,
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
    pub(super) fn anchored(&mut self) -> Vec<bool> {
        let vertices: Vec<u32> = (0..self.mesh.positions.len() as u32).collect();
        let stars = par::map_above(FEW, &vertices, |&v| self.star(v));
        self.shell.sign(stars.iter().flatten().flat_map(|star| star.signed.iter().copied()));
        par::map_above(FEW, &vertices, |&v| {
            stars[v as usize].as_ref().and_then(|star| star.direction).is_some_and(|up| {
                let own = &self.around[v as usize];
                let corners = own.iter().flat_map(|&t| self.mesh.corners(t as usize));
                let near = grown(Aabb::of(corners), NEAR * self.tolerance);
                self.shell.is_passed_upward(near, up, own.iter().copied())
            })
        })
    }

    fn star(&self, vertex: u32) -> Option<Star> {
        let triangles = &self.around[vertex as usize];
        let cell = Self::room(self.mesh, triangles, self.tolerance);
        let local = Local::of(self.fields.within(vertex, cell), cell)?;
        let own = triangles.iter().copied().filter(|&t| self.mesh.triangles[t as usize][0] == vertex);
        let signed = own.filter(|&t| self.shell.has_signs(t, &local)).collect();
        let steep = local.most <= STEEPEST * local.least;
        Some(Star { direction: steep.then_some(local.direction), signed })
    }
}

pub(super) fn grown(cell: Aabb, distance: f64) -> Aabb {
    Aabb { min: cell.min - distance, max: cell.max + distance }
}
