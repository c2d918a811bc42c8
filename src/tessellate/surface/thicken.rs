use super::caps::CloseError;
use crate::math::Vec3;
use crate::mesh::{Defects, Mesh};
use crate::numeric::DisjointSets;

/// A plate around an open or closed mesh: its vertices moved by half a thickness to both sides along their mean normals,
/// with walls along the boundary. One-sided meshes such as a Moebius strip become plates, too: the two sides are those
/// of the orientation double cover, on which one side of a triangle goes on to the like side of its neighbour.
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
    let sides = Sides::of(mesh);
    let normals = sides.normals(mesh);
    let mut positions = vec![Vec3::ZERO; sides.count];
    for (corner, &vertex) in mesh.triangles.iter().flatten().enumerate() {
        for side in [0, 1] {
            let number = sides.of_corner[2 * corner + side] as usize;
            positions[number] =
                mesh.positions[vertex as usize] + 0.5 * thickness * normals[number].normalize_or_zero();
        }
    }
    let mut plate = Mesh::new(positions, Vec::new());
    for t in 0..mesh.triangles.len() {
        plate.triangles.push([0, 1, 2].map(|k| sides.vertex(t, k, 0)));
        plate.triangles.push([0, 2, 1].map(|k| sides.vertex(t, k, 1)));
    }
    for &(t, k) in &sides.open {
        let [[a, below_a], [b, below_b]] =
            [k, (k + 1) % 3].map(|k| [0, 1].map(|side| sides.vertex(t, k, side)));
        plate.triangles.extend([[b, a, below_a], [b, below_a, below_b]]);
    }
    Ok(plate)
}

/// The vertices of both sides of every corner.
struct Sides {
    /// Above and below each corner.
    of_corner: Vec<u32>,
    count: usize,
    /// Sides of triangles without a neighbour.
    open: Vec<(usize, usize)>,
}

impl Sides {
    fn of(mesh: &Mesh) -> Sides {
        let half_edge = |h: usize| {
            let triangle = mesh.triangles[h / 3];
            let (a, b) = (triangle[h % 3], triangle[(h + 1) % 3]);
            ([a.min(b), a.max(b)], h, a < b)
        };
        let mut edges: Vec<([u32; 2], usize, bool)> = (0..3 * mesh.triangles.len()).map(half_edge).collect();
        edges.sort_unstable();
        let mut sets = DisjointSets::new(6 * mesh.triangles.len());
        let mut open = Vec::new();
        for group in edges.chunk_by(|a, b| a.0 == b.0) {
            let &[(_, h, forward), (_, other, other_forward)] = group else {
                open.extend(group.iter().map(|&(_, h, _)| (h / 3, h % 3)));
                continue;
            };
            let next = |h: usize| h / 3 * 3 + (h + 1) % 3;
            // Neighbours that run the same way along their edge face opposite sides.
            let turned = usize::from(forward == other_forward);
            let pairs = if turned == 1 {
                [(h, other), (next(h), next(other))]
            } else {
                [(h, next(other)), (next(h), other)]
            };
            for (corner, neighbour) in pairs {
                for side in [0, 1] {
                    sets.join((2 * corner + side) as u32, (2 * neighbour + (side ^ turned)) as u32);
                }
            }
        }
        open.sort_unstable();
        let (of_corner, count) = sets.numbered();
        Sides { of_corner, count: count as usize, open }
    }

    fn vertex(&self, triangle: usize, k: usize, side: usize) -> u32 {
        self.of_corner[2 * (3 * triangle + k) + side]
    }

    /// The sums of the normals of the triangles around each vertex, by their angles there, away from the mesh.
    fn normals(&self, mesh: &Mesh) -> Vec<Vec3> {
        let mut normals = vec![Vec3::ZERO; self.count];
        for t in 0..mesh.triangles.len() {
            let corners = mesh.corners(t);
            let [a, b, c] = corners;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            for k in 0..3 {
                let [p, q, r] = [corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]];
                let cosine = (q - p).normalize_or_zero().dot((r - p).normalize_or_zero());
                let weighted = crate::math::acos(cosine.clamp(-1.0, 1.0)) * normal;
                normals[self.vertex(t, k, 0) as usize] += weighted;
                normals[self.vertex(t, k, 1) as usize] -= weighted;
            }
        }
        normals
    }
}
