use super::world::Labels;
use crate::mesh::{Exact, Mesh, Solid, Topology};

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
    pub(super) exact: Option<&'a Exact>,
}

impl<'a> Operand<'a> {
    /// The mesh that it is, and the one that it was before it was mended.
    pub(super) fn meshes(&self) -> impl Iterator<Item = &'a Mesh> {
        let unmended = self.exact.and_then(|exact| exact.unmended.as_ref());
        std::iter::once(self.mesh).chain(unmended.map(|unmended| &unmended.mesh))
    }

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
        Operand { mesh, topology: None, embedded: false, labels: Labels::One(0), exact: None }
    }
}

impl<'a> From<&'a Solid> for Operand<'a> {
    fn from(solid: &'a Solid) -> Self {
        Operand {
            mesh: solid.mesh(),
            topology: Some(solid.topology()),
            embedded: solid.is_embedded(),
            labels: Labels::One(0),
            exact: solid.exact(),
        }
    }
}
