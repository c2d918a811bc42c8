//! Marching cubes and surface nets over a uniform grid: what others do, to compare with.
//!
//! Neither keeps a tolerance: what happens within a cube is not seen, and creases are cut off. Faces of a cube on which
//! both diagonals differ are always cut so that the inside corners are apart, on both sides alike, so meshes close
//! (Lorensen, Cline 1987, without its cracks). Nets have a vertex for each sheet in a cube and not for each cube
//! (Nielson, Dual marching cubes, 2004); where the same two meet twice at a face they share an edge, which is refused.

use super::lattice::Map;
use super::{IsoError, bounds, check};
use crate::math::{Aabb, Vec3};
use crate::mesh::{Mesh, Solid};
use crate::par;
use crate::sdf::Field;

/// How the sheets in a cube become triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridMethod {
    /// Vertices on the edges of the grid, a fan for each sheet in a cube. Free of self-crossings within each cube but
    /// for fans of five corners and more, which are not flat.
    MarchingCubes,
    /// A vertex within the cube for each sheet, the mean of where it passes the edges. May cross itself.
    SurfaceNets,
}

/// The mesh of a field over a grid of nearly cubic cells, `cells` of them along the longest side of the box. What
/// leaves the box is closed half a cell outside of it.
///
/// ```
/// use ogee::isosurface::{GridMethod, mesh_on_grid};
/// use ogee::math::{Aabb, Vec3};
/// use ogee::sdf::{Implicit, Primitive};
///
/// let ball = Implicit::primitive(Primitive::Sphere { radius: 0.8 })?.tape();
/// let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
/// let solid = mesh_on_grid(&ball, bounds, 20, GridMethod::MarchingCubes)?;
/// assert_eq!(solid.measures().genus, Some(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A box that is empty, flat or not finite, more than 2^28 cells, and, with surface nets alone, sheets that share an
/// edge ([`IsoError::Pinched`]).
pub fn mesh_on_grid(
    field: &dyn Field,
    bounds: Aabb,
    cells: usize,
    method: GridMethod,
) -> Result<Solid, IsoError> {
    let bounds = bounds::checked(bounds)?;
    check("number of cells", cells as f64)?;
    let grid = Grid::over(field, bounds, cells)?;
    let mut sheets = Sheets { grid: &grid, mesh: Mesh::default(), on_edges: Map::default() };
    let loops = sheets.loops();
    match method {
        GridMethod::MarchingCubes => loops.iter().for_each(|ring| sheets.fan(ring)),
        GridMethod::SurfaceNets => sheets.net(&loops),
    }
    Solid::new(sheets.mesh).map_err(IsoError::Pinched)
}

/// Most cells: their values take two gigabytes.
const MOST: usize = 1 << 28;

/// Values at the corners of cells, with a layer of outside around them.
struct Grid {
    counts: [usize; 3],
    low: Vec3,
    step: Vec3,
    values: Vec<f64>,
}

impl Grid {
    fn over(field: &dyn Field, bounds: Aabb, cells: usize) -> Result<Grid, IsoError> {
        let size = bounds.size();
        let along = |axis: usize| (size[axis] / size.max_element() * cells as f64).ceil().max(1.0);
        let cells = Vec3::new(along(0), along(1), along(2));
        if cells.element_product() > MOST as f64 {
            return Err(IsoError::TooManyCells { limit: MOST });
        }
        let step = size / cells;
        // A corner more on each side.
        let counts = [cells.x as usize + 3, cells.y as usize + 3, cells.z as usize + 3];
        let mut grid = Grid { counts, low: bounds.min - step, step, values: Vec::new() };
        let layers: Vec<usize> = (0..counts[2]).collect();
        let layers = par::map_above(2, &layers, |&z| grid.layer(field, z));
        grid.values = layers.concat();
        Ok(grid)
    }

    fn layer(&self, field: &dyn Field, z: usize) -> Vec<f64> {
        let [nx, ny, nz] = self.counts;
        let rim = |i: usize, n: usize| i == 0 || i + 1 == n;
        let corner = |x: usize, y: usize| {
            if rim(x, nx) || rim(y, ny) || rim(z, nz) { 1.0 } else { field.value(self.position([x, y, z])) }
        };
        (0..ny).flat_map(|y| (0..nx).map(move |x| (x, y))).map(|(x, y)| corner(x, y)).collect()
    }

    fn position(&self, corner: [usize; 3]) -> Vec3 {
        self.low + self.step * Vec3::from_array(corner.map(|i| i as f64))
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    fn corner(&self, index: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [index % nx, index / nx % ny, index / (nx * ny)]
    }

    fn is_inside(&self, index: usize) -> bool {
        self.values[index] < 0.0
    }

    /// Where the line between the values at both ends of an edge is zero, well between them.
    fn crossing(&self, [a, b]: [usize; 2]) -> Vec3 {
        let (p, q) = (self.position(self.corner(a)), self.position(self.corner(b)));
        let t = self.values[a] / (self.values[a] - self.values[b]);
        let t = if t.is_finite() { t.clamp(1e-3, 1.0 - 1e-3) } else { 0.5 };
        p + (q - p) * t
    }
}

/// An edge of the grid, its lower corner first.
type GridEdge = [usize; 2];

/// Where one sheet passes the edges of a cube, in order, its normal outward.
type Loop = Vec<GridEdge>;

struct Sheets<'g> {
    grid: &'g Grid,
    mesh: Mesh,
    on_edges: Map<(u64, u64), u32>,
}

/// Corners of the six faces of a cube, counter-clockwise seen from outside; bit k of a corner is its place on axis k.
const CUBE_FACES: [[usize; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

impl Sheets<'_> {
    /// The sheets of all cubes, in order.
    fn loops(&self) -> Vec<Loop> {
        let [nx, ny, nz] = self.grid.counts;
        let cubes =
            (0..nz - 1).flat_map(|z| (0..ny - 1).flat_map(move |y| (0..nx - 1).map(move |x| [x, y, z])));
        cubes.flat_map(|cube| self.loops_of(cube)).collect()
    }

    fn loops_of(&self, [x, y, z]: [usize; 3]) -> Vec<Loop> {
        let corners: [usize; 8] =
            std::array::from_fn(|i| self.grid.index([x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)]));
        let inside = corners.map(|corner| self.grid.is_inside(corner));
        if inside.iter().all(|&i| i) || !inside.contains(&true) {
            return Vec::new();
        }
        let mut sides: Vec<[GridEdge; 2]> = CUBE_FACES
            .iter()
            .flat_map(|face| sides(face.map(|i| corners[i]), face.map(|i| inside[i])))
            .collect();
        let mut loops = Vec::new();
        while let Some([first, mut at]) = sides.pop() {
            let mut ring = vec![first];
            while let Some(next) = sides.iter().position(|side| side[0] == at) {
                ring.push(at);
                at = sides.swap_remove(next)[1];
            }
            loops.push(ring);
        }
        loops
    }

    fn on_edge(&mut self, edge: GridEdge) -> u32 {
        let key = (edge[0] as u64, edge[1] as u64);
        let mesh = &mut self.mesh;
        *self.on_edges.entry(key).or_insert_with(|| {
            mesh.positions.push(self.grid.crossing(edge));
            mesh.positions.len() as u32 - 1
        })
    }

    fn fan(&mut self, ring: &Loop) {
        let corners: Vec<u32> = ring.iter().map(|&edge| self.on_edge(edge)).collect();
        let triangles = (1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]);
        self.mesh.triangles.extend(triangles);
    }

    /// A vertex for each sheet; around each crossed edge the four sheets that pass it.
    fn net(&mut self, loops: &[Loop]) {
        let mut around: Map<(u64, u64), Vec<u32>> = Map::default();
        let mut order = Vec::new();
        for (vertex, ring) in (0_u32..).zip(loops) {
            let sum: Vec3 = ring.iter().map(|&edge| self.grid.crossing(edge)).sum();
            self.mesh.positions.push(sum / ring.len() as f64);
            for &edge in ring {
                let sheets = around.entry((edge[0] as u64, edge[1] as u64)).or_default();
                if sheets.is_empty() {
                    order.push(edge);
                }
                sheets.push(vertex);
            }
        }
        for edge in order {
            // Cubes come in the order of their places: below and left first, above and right last.
            let [p, q, r, s] = around[&(edge[0] as u64, edge[1] as u64)][..] else { continue };
            let (low, high) = (self.grid.corner(edge[0]), self.grid.corner(edge[1]));
            // Seen along the y axis the second place is on the other side.
            let turned = self.grid.is_inside(edge[0]) != (low[1] != high[1]);
            let quad = if turned { [p, q, s, r] } else { [p, r, s, q] };
            self.mesh.triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
    }
}

/// The directed segments in which sheets pass a face seen from outside, the inside on their right; four crossings
/// keep the inside corners apart.
fn sides(corners: [usize; 4], inside: [bool; 4]) -> Vec<[GridEdge; 2]> {
    let edge = |i: usize| {
        let (a, b) = (corners[i % 4], corners[(i + 1) % 4]);
        [a.min(b), a.max(b)]
    };
    // Along the border of the face, a sheet goes from where the inside ends back to where it began.
    let ends: Vec<usize> = (0..4).filter(|&i| inside[i] && !inside[(i + 1) % 4]).collect();
    let begins = |end: usize| (1..4).map(|k| (end + 4 - k) % 4).find(|&i| !inside[i]);
    ends.into_iter().filter_map(|end| Some([edge(begins(end)?), edge(end)])).collect()
}
