use super::{Mesh, Topology};
use crate::polygon::exact::Origin;

/// The exact surface behind a solid whose positions were rounded.
#[derive(Clone, Debug)]
pub(crate) struct Exact {
    /// What positions do not say of it: those of the solid, or of the mesh before it was mended.
    pub(crate) origin: Origin,
    /// The mesh before, where the solid has other triangles.
    pub(crate) unmended: Option<Unmended>,
}

/// A mesh between the same vertices as an exact surface, from which a solid was made with other triangles: rounding had
/// folded it, or two of its edges had run between the same vertices.
#[derive(Clone, Debug)]
pub(crate) struct Unmended {
    pub(crate) mesh: Mesh,
    pub(crate) topology: Topology,
    /// For each of its triangles, one of the solid's that was born from the same.
    pub(crate) stand_ins: Vec<u32>,
}
