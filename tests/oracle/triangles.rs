//! A surface of cells as a mesh that is manifold by index.
//!
//! Two wedges that touch along an edge may be one solid at both of its ends; then they have their ends in common and
//! their sides would name the same two vertices. So a side of an edge that wedges share has a vertex of its own in the
//! middle.

use super::exact::Plane;
use super::surface::{Seam, Surface};
use ogee::math::Vec3;
use ogee::mesh::Mesh;
use std::collections::HashMap;

/// The faces as triangles; `positions` are those of the surface's points.
pub(crate) fn triangulated(surface: &Surface, planes: &[Plane], positions: &[Vec3]) -> Mesh {
    let sewn = surface.sew(planes);
    let first = surface.first_corners();
    let mut mesh =
        Mesh::new(vec![Vec3::ZERO; sewn.vertex.iter().max().map_or(0, |last| last + 1)], Vec::new());
    for (index, face) in surface.faces.iter().enumerate() {
        for (k, &point) in face.corners.iter().enumerate() {
            mesh.positions[sewn.vertex[first[index] + k]] = positions[point];
        }
    }
    let middles = middles(surface, &sewn.seams, positions, &mut mesh);
    for (index, face) in surface.faces.iter().enumerate() {
        let mut ring = Vec::new();
        for k in 0..face.corners.len() {
            ring.push(sewn.vertex[first[index] + k] as u32);
            ring.extend(middles.get(&(index, k)));
        }
        if ring.len() == face.corners.len() {
            mesh.triangles.extend(ring[1..].windows(2).map(|edge| [ring[0], edge[0], edge[1]]));
        } else {
            let total: Vec3 = face.corners.iter().map(|&p| positions[p]).sum();
            let hub = mesh.positions.len() as u32;
            mesh.positions.push(total / face.corners.len() as f64);
            mesh.triangles.extend((0..ring.len()).map(|i| [hub, ring[i], ring[(i + 1) % ring.len()]]));
        }
    }
    mesh
}

/// A vertex in the middle of each seam of a shared edge, by face and side.
fn middles(
    surface: &Surface,
    seams: &[Seam],
    positions: &[Vec3],
    mesh: &mut Mesh,
) -> HashMap<(usize, usize), u32> {
    let mut middles = HashMap::new();
    for seam in seams.iter().filter(|seam| seam.shared) {
        let [a, b] = surface.joined(seam.forward).map(|point| positions[point]);
        for side in [seam.forward, seam.backward] {
            middles.insert((side.face, side.index), mesh.positions.len() as u32);
        }
        mesh.positions.push(0.5 * (a + b));
    }
    middles
}
