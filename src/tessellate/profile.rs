use super::SweepError;
use crate::math::{Vec2, Vec3};
use crate::mesh::Topology;
use crate::polygon::Region;
use crate::polygon::triangulate::{self, TriangulationError};

/// A region made ready to be swept: triangles, and the edges they leave open, the inside on their left. Every vertex
/// has one open edge that starts at it and one that ends there.
pub(super) struct Profile {
    pub(super) points: Vec<Vec2>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) border: Vec<[u32; 2]>,
    /// Whether the triangles lie side by side. They do not where rounding made contours cross, see [`fans`].
    pub(super) sound: bool,
}

impl Profile {
    pub(super) fn new(region: &Region) -> Result<Profile, SweepError> {
        let (points, triangles, sound) = match triangulate::region(region) {
            Ok((points, triangles)) => (points, triangles, true),
            Err(
                TriangulationError::Crossing { .. }
                | TriangulationError::RepeatedVertex { .. }
                | TriangulationError::Winding,
            ) => {
                let (points, triangles) = fans(region);
                (points, triangles, false)
            }
            Err(error) => return Err(error.into()),
        };
        let topology = Topology::new(&triangles);
        let side = |h: u32| {
            let triangle = triangles[h as usize / 3];
            [triangle[h as usize % 3], triangle[Topology::next(h) as usize % 3]]
        };
        let open = (0..topology.len() as u32).filter(|&h| topology.twin(h) == Topology::NONE);
        let border = open.map(side).collect();
        Ok(Profile { points, triangles, border, sound })
    }

    /// For each vertex, the number of the border loop it is on, and how many loops there are.
    pub(super) fn loops(&self) -> (Vec<u32>, u32) {
        const NONE: u32 = u32::MAX;
        let mut next = vec![NONE; self.points.len()];
        for &[from, to] in &self.border {
            next[from as usize] = to;
        }
        let mut loop_of = vec![NONE; self.points.len()];
        let mut count = 0;
        for start in 0..loop_of.len() {
            let mut vertex = start;
            while loop_of[vertex] == NONE {
                loop_of[vertex] = count;
                vertex = next[vertex] as usize;
            }
            count += u32::from(vertex == start && loop_of[start] == count);
        }
        (loop_of, count)
    }
}

/// A fan of triangles over each contour. They overlap, but count to one inside and to zero outside, so that what is swept
/// has the right winding numbers everywhere and the exact booleans can clean it.
fn fans(region: &Region) -> (Vec<Vec2>, Vec<[u32; 3]>) {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for contour in region.contours() {
        let first = points.len() as u32;
        points.extend_from_slice(contour);
        triangles.extend((first + 2..points.len() as u32).map(|v| [first, v - 1, v]));
    }
    (points, triangles)
}

/// Upper bound of the triangles that sweeping `region` over `layers` makes, ends included.
pub(super) fn most_triangles(region: &Region, layers: u32) -> u64 {
    let vertices: usize = region.contours().iter().map(Vec::len).sum();
    let end = vertices + 2 * region.contours().len();
    2 * end as u64 + 2 * vertices as u64 * u64::from(layers)
}

/// Refuses positions that grew out of the range of numbers.
pub(super) fn check_finite(positions: &[Vec3]) -> Result<(), SweepError> {
    if positions.iter().all(|p| p.is_finite()) { Ok(()) } else { Err(SweepError::NonFinite) }
}
