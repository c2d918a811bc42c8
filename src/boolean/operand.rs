use super::world::Labels;
use crate::mesh::{Mesh, Solid, Topology};
use crate::polygon::exact::Origin;

/// An operand of a boolean: a mesh and what is known of it.
#[derive(Clone, Copy, Debug)]
pub struct Operand<'a> {
    pub(super) mesh: &'a Mesh,
    /// Its topology, where it is known to be closed.
    pub(super) topology: Option<&'a Topology>,
    /// Whether it is known not to cross itself.
    pub(super) embedded: bool,
    pub(super) labels: Labels<'a>,
    /// What it was rounded from.
    pub(super) origin: Option<&'a Origin>,
}

impl<'a> Operand<'a> {
    /// The same operand with a label: coplanar faces with different labels are not merged, so that each triangle of the
    /// result has one label. All operands have label 0 unless told otherwise.
    #[must_use]
    pub fn with_material(self, material: u32) -> Operand<'a> {
        Operand { labels: Labels::One(material), ..self }
    }

    /// The same operand with a label for each triangle; see [`Operand::with_material`].
    ///
    /// # Panics
    /// When there are not as many labels as triangles.
    #[must_use]
    pub fn with_materials(self, materials: &'a [u32]) -> Operand<'a> {
        assert_eq!(materials.len(), self.mesh.triangles.len(), "a label for each triangle");
        Operand { labels: Labels::Each(materials), ..self }
    }
}

impl<'a> From<&'a Mesh> for Operand<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Operand { mesh, topology: None, embedded: false, labels: Labels::One(0), origin: None }
    }
}

impl<'a> From<&'a Solid> for Operand<'a> {
    fn from(solid: &'a Solid) -> Self {
        Operand {
            mesh: solid.mesh(),
            topology: Some(solid.topology()),
            embedded: solid.is_embedded(),
            labels: Labels::One(0),
            origin: solid.origin(),
        }
    }
}
