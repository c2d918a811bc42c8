//! Where the shell around a mesh is known to hold all of the surface.
//!
//! Let M be the mesh, M+ and M- the outer and the inner side of its shell. Suppose that around a triangle the field grows
//! along n, at rates between `least` and `most`, and that it is positive on M+ and negative on M- there, so that on M its
//! magnitude is at most `most` times the tolerance. From a zero z within the tolerance of the triangle go down along -n
//! to the depth s, to x: on the way the field is negative, so M+ is not met. Where s `least` is above 2 `most`
//! tolerances, the field at x is more negative than it can be within the tolerance of M; so M, on its way to M+, does not
//! pass x, and M+ winds around z as often as M does around x. Likewise M- winds around z as often as M does around a
//! point y above; the difference is how often, in all, M is passed upward between x and y. That does not change as the
//! line is moved to the triangle and along it, and where the line meets no triangle that faces down it is not zero.

use super::fields::Fields;
use crate::math::{Aabb, Vec3};
use crate::mesh::Mesh;
use crate::par;
use crate::sdf::{Local, Shell};

/// Depths of the points below and above that are tried, in tolerances.
const DEPTHS: [f64; 2] = [3.0, 4.5];

/// The box around a triangle in which the field must be known, in tolerances beyond the depth: a zero is within one, and
/// within one of the points the mesh, and within one of it both sides of its shell.
const KNOWN: f64 = 3.0;

/// How far triangles must be looked at, likewise.
const NEAR: f64 = 2.0;

/// Below this many triangles threads are not worth waking.
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

/// What is known around a triangle.
#[derive(Clone, Copy)]
struct Steep {
    /// In which the field grows.
    up: Vec3,
    /// The field's signs on both sides are proven.
    signed: bool,
    /// At which the field is strong enough.
    depth: Option<f64>,
}

impl Shelled<'_> {
    /// The box around a star with the room that is needed there.
    pub(super) fn room(mesh: &Mesh, triangles: &[u32], tolerance: f64) -> Aabb {
        let corners = triangles.iter().flat_map(|&t| mesh.corners(t as usize));
        grown(Aabb::of(corners), (DEPTHS[1] + KNOWN) * tolerance)
    }

    /// For each vertex whether the shell holds all of the surface that is within the tolerance of its star.
    pub(super) fn anchored(&mut self) -> Vec<bool> {
        let triangles: Vec<u32> = (0..self.mesh.triangles.len() as u32).collect();
        let steep = par::map_above(FEW, &triangles, |&t| self.steep(t));
        let signed = |&t: &u32| steep[t as usize].is_some_and(|steep| steep.signed);
        self.shell.sign(triangles.iter().copied().filter(signed));
        let anchored = par::map_above(FEW, &triangles, |&t| {
            steep[t as usize].and_then(|steep| steep.depth.map(|depth| (depth, steep.up))).is_some_and(
                |(depth, up)| {
                    let near = grown(self.bounds(t), (depth + NEAR) * self.tolerance);
                    self.shell.is_passed_upward(near, up, [t])
                },
            )
        });
        self.around.iter().map(|star| star.iter().all(|&t| anchored[t as usize])).collect()
    }

    fn bounds(&self, triangle: u32) -> Aabb {
        Aabb::around(self.mesh.corners(triangle as usize))
    }

    /// What is known around a triangle: at the least depth at which the field is steady enough, if there is one.
    fn steep(&self, triangle: u32) -> Option<Steep> {
        let vertex = self.mesh.triangles[triangle as usize][0];
        let mut known: Option<Steep> = None;
        for depth in DEPTHS {
            let cell = grown(self.bounds(triangle), (depth + KNOWN) * self.tolerance);
            let Some(local) = Local::of(self.fields.within(vertex, cell), cell) else { break };
            let steady = depth * local.least > 2.0 * local.most * (1.0 + 1e-9);
            let signed = known.map_or_else(|| self.shell.has_signs(triangle, &local), |known| known.signed);
            known = Some(Steep { up: local.direction, signed, depth: steady.then_some(depth) });
            if steady {
                break;
            }
        }
        known
    }
}

pub(super) fn grown(cell: Aabb, distance: f64) -> Aabb {
    Aabb { min: cell.min - distance, max: cell.max + distance }
}
