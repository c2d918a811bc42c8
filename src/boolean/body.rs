//! Operands and intermediate results as exact surfaces.

use super::world::{Facing, NONE, World};
use super::{Birth, Operand};
use crate::math::Aabb;
use crate::mesh::Topology;
use crate::polygon::exact::{PointId, Points};

/// A closed surface of triangles between exact points. Half-edge `3 t + i` is side `i` of triangle `t`.
///
/// Operands have corners on the lattice, and their planes and lines follow from them. Faces that an arrangement cut have
/// corners anywhere: they remember the plane they lie in, and their boundaries the lines they run on, all of them planes
/// of operands, so that numbers are no wider in the last step of a long chain than in the first.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) corners: Vec<[PointId; 3]>,
    pub(super) births: Vec<Birth>,
    /// The other half-edge of each edge, or [`NONE`] where there is other than one.
    pub(super) twins: Vec<u32>,
    /// For each triangle, its plane, where that does not follow from its corners; may be shorter than `corners`.
    pub(super) facings: Vec<Facing>,
    /// For each half-edge, the line of the world it runs on, or [`NONE`] where that follows from its ends or it lies
    /// inside a face; may be shorter than `twins`.
    pub(super) lines: Vec<u32>,
    pub(super) bounds: Aabb,
    /// Whether it is known not to cross itself.
    pub(super) embedded: bool,
}

impl Body {
    /// Enters an operand into the world. Triangles without area on the lattice are dropped.
    pub(super) fn of_operand(
        world: &mut World<'_>,
        index: u32,
        operand: &Operand<'_>,
        topology: &Topology,
    ) -> Body {
        let mesh = operand.mesh;
        let ids: Vec<PointId> = mesh.positions.iter().map(|&p| world.places.add(p)).collect();
        let mut body = Body::default();
        let mut slots = vec![NONE; mesh.triangles.len()];
        for (t, triangle) in (0_u32..).zip(&mesh.triangles) {
            let corners = triangle.map(|v| ids[v as usize]);
            if has_area(world.points(), corners) {
                slots[t as usize] = body.corners.len() as u32;
                body.corners.push(corners);
                body.births.push(Birth { operand: index, triangle: t });
            }
        }
        body.twins = twins_of(topology, &slots);
        body.bounds = Aabb::of(body.corners.iter().flatten().map(|&p| world.points().rounded(p)));
        body.embedded = operand.embedded && body.corners.len() == mesh.triangles.len();
        body
    }

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
        }
    }
}

/// Twins of the triangles that have a slot, by slots.
fn twins_of(topology: &Topology, slots: &[u32]) -> Vec<u32> {
    let half_edges = (0..topology.len() as u32).filter(|&h| slots[h as usize / 3] != NONE);
    let twin_slot = |half_edge: u32| match topology.twin(half_edge) {
        Topology::NONE => NONE,
        twin => match slots[twin as usize / 3] {
            NONE => NONE,
            slot => 3 * slot + twin % 3,
        },
    };
    half_edges.map(twin_slot).collect()
}

fn has_area(points: &Points, corners: [PointId; 3]) -> bool {
    (0..3).any(|axis| points.orientation(corners[0], corners[1], corners[2], axis) != 0)
}
