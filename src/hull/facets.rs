use crate::math::Vec3;
use crate::mesh::Topology;
use crate::numeric::orient3d;
use crate::polygon::triangulate;

/// The same convex surface with each flat face triangulated over its corners alone. The result depends only on the shape,
/// not on how `surface` is divided or ordered.
pub(super) fn retriangulated(at: &[Vec3], surface: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let topology = Topology::new(surface);
    let face = flat_faces(at, surface, &topology);
    let corner = |h: u32| surface[h as usize / 3][h as usize % 3];
    let face_of = |h: u32| face[h as usize / 3];
    // The edges between faces, those of one face side by side in the order of their first vertices.
    let mut edges: Vec<(u32, u32, u32)> = (0..topology.len() as u32)
        .filter(|&h| face_of(h) != face_of(topology.twin(h)))
        .map(|h| (face_of(h), corner(h), corner(Topology::next(h))))
        .collect();
    edges.sort_unstable();
    // In a corner at least three faces meet; elsewhere on an edge there are two.
    let mut faces_at = vec![0_u32; at.len()];
    edges.iter().for_each(|&(_, from, _)| faces_at[from as usize] += 1);
    let faces = edges.chunk_by(|a, b| a.0 == b.0);
    let mut polygons: Vec<Vec<u32>> =
        faces.map(|face| polygon(face, |v| faces_at[v as usize] >= 3)).collect();
    polygons.sort_unstable();
    polygons.into_iter().flat_map(triangulate::convex).collect()
}

/// For each triangle, the smallest one of the flat face it is in.
fn flat_faces(at: &[Vec3], surface: &[[u32; 3]], topology: &Topology) -> Vec<u32> {
    let mut face = vec![u32::MAX; surface.len()];
    let mut stack = Vec::new();
    for first in 0..surface.len() as u32 {
        if face[first as usize] != u32::MAX {
            continue;
        }
        face[first as usize] = first;
        stack.push(first);
        while let Some(triangle) = stack.pop() {
            let [a, b, c] = surface[triangle as usize].map(|v| at[v as usize]);
            for twin in (3 * triangle..3 * triangle + 3).map(|h| topology.twin(h)) {
                let beyond = twin as usize / 3;
                let apex = at[surface[beyond][Topology::previous(twin) as usize % 3] as usize];
                if face[beyond] == u32::MAX && orient3d(a, b, c, apex) == 0.0 {
                    face[beyond] = first;
                    stack.push(beyond as u32);
                }
            }
        }
    }
    face
}

/// The corners of one face from its edges, sorted by their first vertices, starting at the smallest corner.
fn polygon(edges: &[(u32, u32, u32)], is_corner: impl Fn(u32) -> bool) -> Vec<u32> {
    let next = |v: u32| edges[edges.binary_search_by_key(&v, |edge| edge.1).expect("edges are a cycle")].2;
    let start = edges[0].1;
    let around = std::iter::successors(Some(start), |&v| Some(next(v)).filter(|&v| v != start));
    let mut corners: Vec<u32> = around.filter(|&v| is_corner(v)).collect();
    let smallest = (0..corners.len()).min_by_key(|&i| corners[i]).expect("a face has corners");
    corners.rotate_left(smallest);
    corners
}
