//! Which edges are sharp, and the normals of what is smooth between them.

use crate::math::{Vec3, atan2, cos};
use crate::mesh::Topology;
use crate::par;

/// The smooth side of a mesh: corner normals, and the edges where they break.
pub(super) struct Creases {
    /// For each corner, an index into `normals`.
    group: Vec<u32>,
    normals: Vec<Vec3>,
    /// Half-edges that are sharp or have no twin, one of each pair.
    sharp: Vec<u32>,
}

impl Creases {
    /// Edges whose triangles meet at an angle of more than `angle` radians, and edges of other than two triangles, are
    /// sharp. The triangles of `indices` must name positions that exist.
    pub(super) fn new(positions: &[Vec3], indices: &[[u32; 3]], angle: f64) -> Creases {
        let topology = Topology::new(indices);
        let facets =
            par::map(indices, |t| facet_vector(&t.map(|v| positions[v as usize])).normalize_or_zero());
        let cosine = cos(angle.clamp(0.0, std::f64::consts::PI));
        let half_edges: Vec<u32> = (0..3 * indices.len() as u32).collect();
        let smooth = par::map(&half_edges, |&h| {
            let twin = topology.twin(h);
            twin != Topology::NONE && facets[h as usize / 3].dot(facets[twin as usize / 3]) >= cosine
        });
        let mut group = half_edges.clone();
        for &h in half_edges.iter().filter(|&&h| smooth[h as usize]) {
            join(&mut group, h, Topology::next(topology.twin(h)));
        }
        for corner in 0..group.len() {
            group[corner] = group[group[corner] as usize];
        }
        let sharp = half_edges.into_iter().filter(|&h| !smooth[h as usize] && h < topology.twin(h)).collect();
        Creases { normals: group_normals(positions, indices, &group), group, sharp }
    }

    /// The normals at the corners of a triangle; of a triangle without area they may be zero.
    pub(super) fn corner_normals(&self, triangle: u32) -> [Vec3; 3] {
        [0, 1, 2].map(|k| self.normals[self.group[3 * triangle as usize + k] as usize])
    }

    /// The vertices at the ends of each sharp edge.
    pub(super) fn sharp_edges(&self, indices: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let ends = |&h: &u32| {
            let triangle = indices[h as usize / 3];
            [triangle[h as usize % 3], triangle[Topology::next(h) as usize % 3]]
        };
        self.sharp.iter().map(ends).collect()
    }
}

/// Normal of a triangle, as long as twice its area.
pub(super) fn facet_vector([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}

/// Sums of facet normals weighted by area and by the angle at the corner: large flat faces stay flat beside fillets,
/// and how they are triangulated does not matter.
fn group_normals(positions: &[Vec3], indices: &[[u32; 3]], group: &[u32]) -> Vec<Vec3> {
    let weighted = par::map(indices, |t| {
        let corners = t.map(|v| positions[v as usize]);
        let normal = facet_vector(&corners);
        [0, 1, 2].map(|k| {
            let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
            normal * atan2(u.cross(v).length(), u.dot(v))
        })
    });
    let mut normals = vec![Vec3::ZERO; group.len()];
    for (corner, &root) in group.iter().enumerate() {
        normals[root as usize] += weighted[corner / 3][corner % 3];
    }
    par::map(&normals, |n| n.normalize_or_zero())
}

/// Joins two corners; the smaller root stands for both.
fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

fn root(parent: &mut [u32], mut corner: u32) -> u32 {
    while parent[corner as usize] != corner {
        let up = parent[parent[corner as usize] as usize];
        parent[corner as usize] = up;
        corner = up;
    }
    corner
}
