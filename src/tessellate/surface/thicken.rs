use super::caps::CloseError;
use crate::math::Vec3;
use crate::mesh::{Defects, Mesh, Topology};

/// A plate around an open or closed mesh: its vertices moved by half a thickness to both sides along their mean normals,
/// with walls along the boundary. One-sided meshes such as a Moebius strip become plates, too.
///
/// It is closed whatever the mesh; where the surface bends tighter than the thickness it crosses itself. Flat faces have
/// exactly the thickness, bends up to that of the angle between neighbouring triangles.
///
/// # Errors
/// [`CloseError::NotAManifold`].
pub fn thickened(mesh: &Mesh, thickness: f64) -> Result<Mesh, CloseError> {
    let defects = Defects::of(mesh);
    if defects.non_manifold_edges > 0 || defects.repeated_corners > 0 || defects.indices_out_of_range > 0 {
        return Err(CloseError::NotAManifold { defects: Box::new(defects) });
    }
    let normals = mean_normals(mesh);
    let side = |sign: f64| {
        mesh.positions.iter().zip(&normals).map(move |(&p, &normal)| p + sign * 0.5 * thickness * normal)
    };
    let positions: Vec<Vec3> = side(1.0).chain(side(-1.0)).collect();
    let count = mesh.positions.len() as u32;
    let mut plate = Mesh::new(positions, Vec::new());
    // The vertex above a corner on the side the triangle faces, and the one below.
    let above = |t: usize, v: u32| {
        let [a, b, c] = mesh.corners(t);
        if (b - a).cross(c - a).dot(normals[v as usize]) >= 0.0 { v } else { v + count }
    };
    let below = |t: usize, v: u32| (above(t, v) + count) % (2 * count);
    for (t, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        plate.triangles.push([a, b, c].map(|v| above(t, v)));
        plate.triangles.push([a, c, b].map(|v| below(t, v)));
    }
    for (t, k) in open_sides(mesh) {
        let (a, b) = (mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
        plate.triangles.push([above(t, b), above(t, a), below(t, a)]);
        plate.triangles.push([above(t, b), below(t, a), below(t, b)]);
    }
    Ok(plate)
}

/// A unit normal for each vertex, the mean of the triangles around it by their angles; of triangles that do not agree
/// which side is up, each is taken like the first one there.
fn mean_normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; mesh.positions.len()];
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for k in 0..3 {
            let [p, q, r] = [corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]];
            let cosine = (q - p).normalize_or_zero().dot((r - p).normalize_or_zero());
            let weighted = crate::math::acos(cosine.clamp(-1.0, 1.0)) * normal;
            let sum = &mut normals[mesh.triangles[t][k] as usize];
            *sum += if sum.dot(weighted) >= 0.0 { weighted } else { -weighted };
        }
    }
    normals.into_iter().map(Vec3::normalize_or_zero).collect()
}

/// Sides of one triangle only. Neighbours that run along an edge the same way are none: the mesh may be one-sided.
fn open_sides(mesh: &Mesh) -> Vec<(usize, usize)> {
    let side = |h: u32| {
        let triangle = mesh.triangles[h as usize / 3];
        let (a, b) = (triangle[h as usize % 3], triangle[Topology::next(h) as usize % 3]);
        [a.min(b), a.max(b)]
    };
    let mut sides: Vec<([u32; 2], u32)> = (0..3 * mesh.triangles.len() as u32).map(|h| (side(h), h)).collect();
    sides.sort_unstable();
    let alone = sides.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() == 1);
    alone.map(|group| (group[0].1 as usize / 3, group[0].1 as usize % 3)).collect()
}
