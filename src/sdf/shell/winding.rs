//! Whether a line passes a mesh upward.

use super::{Local, Post};
use crate::math::{Aabb, Vec3};
use crate::mesh::Mesh;
use crate::spatial::Bvh;

/// A mesh of a field's surface with the shell around it.
pub(crate) struct Shell<'m> {
    mesh: &'m Mesh,
    posts: Vec<Post>,
    /// For each triangle whether the field is proven to have the right signs on both its sides.
    signed: Vec<bool>,
    boxes: Vec<Aabb>,
    bvh: Bvh,
}

impl<'m> Shell<'m> {
    /// The shell of a mesh with a post for each vertex.
    pub(crate) fn new(mesh: &'m Mesh, posts: Vec<Post>) -> Shell<'m> {
        let count = mesh.triangles.len();
        let boxes: Vec<Aabb> = (0..count).map(|t| Aabb::around(mesh.corners(t))).collect();
        let bvh = Bvh::new(&boxes);
        Shell { mesh, posts, signed: vec![false; count], boxes, bvh }
    }

    pub(crate) fn posts(&self) -> &[Post] {
        &self.posts
    }

    /// Whether signs on both sides of a triangle follow from what is known of the field in a box around them.
    pub(crate) fn has_signs(&self, triangle: u32, local: &Local<'_>) -> bool {
        local.has_signs(&self.mesh.triangles[triangle as usize].map(|id| self.posts[id as usize]))
    }

    /// Marks triangles as proven to have the right signs.
    pub(crate) fn sign(&mut self, triangles: impl IntoIterator<Item = u32>) {
        triangles.into_iter().for_each(|t| self.signed[t as usize] = true);
    }

    /// Whether signs are proven for a triangle.
    pub(crate) fn is_signed(&self, triangle: u32) -> bool {
        self.signed[triangle as usize]
    }

    /// Whether signs are proven for all triangles that touch a box, and a line through the middle of one of `own` passes
    /// this upward and none of the others downward.
    pub(crate) fn is_passed_upward(&self, near: Aabb, up: Vec3, own: impl IntoIterator<Item = u32>) -> bool {
        let area = |t: u32| {
            let [a, b, c] = self.mesh.corners(t as usize);
            (b - a).cross(c - a).dot(up)
        };
        let widest = own.into_iter().map(|t| (area(t), t)).fold(None, |best: Option<(f64, u32)>, one| {
            if best.is_some_and(|best| best.0 >= one.0) { best } else { Some(one) }
        });
        let Some((_, widest)) = widest.filter(|(area, _)| *area > 0.0) else { return false };
        let on_line = center(self.mesh.corners(widest as usize));
        let mut passed = true;
        self.bvh.touching(&self.boxes, near, |t| {
            passed = passed && self.signed[t as usize] && (area(t) > 0.0 || self.is_beside(t, on_line, up));
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
