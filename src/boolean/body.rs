//! Operands and intermediate results as exact surfaces.

use super::Birth;
use super::world::Facing;
use crate::math::Aabb;
use crate::polygon::exact::PointId;

/// A closed surface of triangles between exact points. Half-edge `3 t + i` is side `i` of triangle `t`.
///
/// Operands have corners on the lattice, and their planes and lines follow from them. Faces that an arrangement cut have
/// corners anywhere: they remember the plane they lie in, and their boundaries the lines they run on, all of them planes
/// of operands, so that numbers are no wider in the last step of a long chain than in the first.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) corners: Vec<[PointId; 3]>,
    pub(super) births: Vec<Birth>,
    /// The other half-edge of each edge, or [`NONE`](super::world::NONE) where there is other than one.
    pub(super) twins: Vec<u32>,
    /// For each triangle, its plane, where that does not follow from its corners; may be shorter than `corners`.
    pub(super) facings: Vec<Facing>,
    /// For each half-edge, the line of the world it runs on, or `NONE` where that follows from its ends or it lies
    /// inside a face; may be shorter than `twins`.
    pub(super) lines: Vec<u32>,
    pub(super) bounds: Aabb,
    /// Whether it is known not to cross itself.
    pub(super) embedded: bool,
    /// Whether wedges of it may touch along an edge of both.
    pub(super) may_be_pinched: bool,
}

impl Body {
    /// Whether it encloses nothing.
    pub(super) fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Number of triangles.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }
}

impl Default for Body {
    fn default() -> Body {
        Body {
            corners: Vec::new(),
            births: Vec::new(),
            twins: Vec::new(),
            facings: Vec::new(),
            lines: Vec::new(),
            bounds: Aabb::EMPTY,
            embedded: true,
            may_be_pinched: false,
        }
    }
}
