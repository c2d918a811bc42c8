use super::defects::fans;
use super::{Defects, Exact, Mesh, Topology};
use crate::math::Vec3;
use std::sync::{Arc, OnceLock};

/// A mesh that bounds a volume, checked once.
///
/// Positions are finite; every half-edge has exactly one twin running the other way; no triangle repeats a vertex;
/// parts that touch at an edge or a vertex have their own copies of it. A solid may be empty, have several
/// components and cavities, and, when it came from outside, cross itself: what is inside is where the winding
/// number is at least one.
///
/// ```
/// use ogee::mesh::{cuboid, Solid};
/// use ogee::math::Vec3;
///
/// let cube = cuboid(Vec3::ZERO, Vec3::ONE);
/// assert_eq!(cube.triangles().len(), 12);
///
/// let mut open = cube.into_mesh();
/// open.triangles.pop();
/// assert_eq!(Solid::new(open).unwrap_err().open_edges, 3);
/// ```
///
/// The result of a boolean also remembers the exact surface that its positions were rounded from, so that the next
/// boolean goes on from there. Two solids are equal when their meshes are; what they remember is not compared.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    mesh: Mesh,
    embedded: bool,
    exact: Option<Arc<Exact>>,
    /// Once somebody has asked.
    topology: OnceLock<Topology>,
}

impl PartialEq for Solid {
    fn eq(&self, other: &Solid) -> bool {
        (&self.mesh, self.embedded) == (&other.mesh, other.embedded)
    }
}

impl Solid {
    /// Checks `mesh`, drops positions that no triangle uses and gives fans that share a vertex a copy each.
    ///
    /// # Errors
    /// The counts of what is wrong, when a position is not finite, an index is out of range, a triangle repeats a
    /// vertex, or an edge has other than one triangle running along it each way.
    pub fn new(mesh: Mesh) -> Result<Solid, Defects> {
        let defects = Defects::of(&mesh);
        if !defects.is_solid() {
            return Err(defects);
        }
        let whole = defects.non_manifold_vertices == 0 && defects.unused_positions == 0;
        let mesh = if whole { mesh } else { with_a_vertex_per_fan(&mesh) };
        Ok(Solid { mesh, ..Solid::default() })
    }

    /// A solid made by a verb that keeps the promises by construction. `embedded` says that the surface is known
    /// not to cross or touch itself except at its own edges and vertices.
    pub(crate) fn assume(mesh: Mesh, embedded: bool) -> Solid {
        debug_assert!(Defects::of(&mesh).is_solid(), "{:?}", Defects::of(&mesh));
        Solid { mesh, embedded, ..Solid::default() }
    }

    /// The same solid with the exact surface that it was rounded from.
    pub(crate) fn rounded_from(self, exact: Option<Exact>) -> Solid {
        Solid { exact: exact.map(Arc::new), ..self }
    }

    /// The same solid with its topology, which whoever made it knew.
    pub(crate) fn with_twins(self, twins: Vec<u32>) -> Solid {
        debug_assert_eq!(Topology::new(self.triangles()).twins(), twins);
        Solid { topology: OnceLock::from(Topology::of_twins(twins)), ..self }
    }

    /// Which half-edges are twins; found when first asked for.
    pub fn topology(&self) -> &Topology {
        self.topology.get_or_init(|| Topology::new(self.triangles()))
    }

    /// The exact surface that it was rounded from, where that is another.
    pub(crate) fn exact(&self) -> Option<&Exact> {
        self.exact.as_deref()
    }

    /// The same solid, its positions taken as they are: it forgets the exact surface that a boolean rounded them from.
    #[must_use]
    pub fn settled(self) -> Solid {
        Solid { exact: None, ..self }
    }

    /// Whether the surface is known not to cross itself; `false` where nobody has looked.
    pub fn is_embedded(&self) -> bool {
        self.embedded
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Vertex positions, in model units.
    pub fn positions(&self) -> &[Vec3] {
        &self.mesh.positions
    }

    /// Vertex indices of each triangle, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.mesh.triangles
    }

    /// Whether it encloses nothing at all.
    pub fn is_empty(&self) -> bool {
        self.mesh.is_empty()
    }

    /// Gives up the promise and keeps the triangles.
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }
}

/// The same triangles with one vertex for each fan, in the order of their first corners.
fn with_a_vertex_per_fan(mesh: &Mesh) -> Mesh {
    let (fans, count) = fans(Topology::new(&mesh.triangles).twins());
    let mut positions = vec![Vec3::ZERO; count as usize];
    for (&vertex, &fan) in mesh.triangles.iter().flatten().zip(&fans) {
        positions[fan as usize] = mesh.positions[vertex as usize];
    }
    Mesh { positions, triangles: fans.as_chunks().0.to_vec() }
}
