use crate::math::Vec3;
use crate::mesh::Mesh;
use std::collections::HashMap;

/// Triangles given by their corners, welded on the way: corners with equal coordinates are one vertex. Vertices
/// are numbered in the order of their first corners, and -0 becomes 0.
#[derive(Default)]
pub(super) struct Welder {
    mesh: Mesh,
    vertices: HashMap<[u64; 3], u32>,
}

impl Welder {
    /// With room for `triangles` of them.
    pub(super) fn with_capacity(triangles: usize) -> Welder {
        let mut welder = Welder::default();
        welder.mesh.triangles.reserve(triangles);
        welder.vertices.reserve(triangles / 2);
        welder
    }

    pub(super) fn push(&mut self, corners: [Vec3; 3]) {
        let triangle = corners.map(|corner| self.vertex(corner));
        self.mesh.triangles.push(triangle);
    }

    /// The mesh.
    pub(super) fn finish(self) -> Mesh {
        self.mesh
    }

    fn vertex(&mut self, corner: Vec3) -> u32 {
        // Adding zero turns -0 into 0 and changes nothing else.
        let corner = corner + Vec3::ZERO;
        let next = self.mesh.positions.len() as u32;
        *self.vertices.entry(corner.to_array().map(f64::to_bits)).or_insert_with(|| {
            self.mesh.positions.push(corner);
            next
        })
    }
}
