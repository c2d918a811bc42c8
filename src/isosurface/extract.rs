//! From leaves to triangles: their patches, and caps where the shape leaves the box.

use super::crossing::{Edge, Face};
use super::crossing::{FaceCut, lone};
use super::lattice::Map;
use super::patch::{Corner, Patch, Ring, place};
use super::refine::{Leaf, Refinement};
use super::tetrahedron::FACES;
use crate::math::Vec3;
use crate::mesh::Mesh;
use std::ops::Range;

/// A closed mesh, and where its triangles come from.
pub(super) struct Extracted {
    pub(super) mesh: Mesh,
    /// For each leaf with triangles its generation, its place among those, and its first triangle.
    pub(super) origins: Vec<[u32; 3]>,
    /// Triangles from this one on are caps.
    pub(super) caps_from: usize,
}

impl Extracted {
    /// Each leaf with triangles and which those are.
    pub(super) fn of_leaves(&self) -> impl Iterator<Item = ([u32; 3], Range<usize>)> + '_ {
        let ends = self.origins.iter().skip(1).map(|origin| origin[2] as usize).chain([self.caps_from]);
        self.origins.iter().zip(ends).map(|(&origin, end)| (origin, origin[2] as usize..end))
    }
}

#[derive(Default)]
struct Builder {
    mesh: Mesh,
    corners: Map<Corner, u32>,
    nodes: Map<u32, u32>,
}

/// The mesh of all leaves, in their order.
pub(super) fn extract(refinement: &Refinement<'_>) -> Extracted {
    let mut builder = Builder::default();
    let mut origins = Vec::new();
    for (generation, leaves) in (0_u32..).zip(&refinement.leaves) {
        for (index, leaf) in (0_u32..).zip(leaves) {
            if leaf.patch != Patch::Empty {
                origins.push([generation, index, builder.mesh.triangles.len() as u32]);
                builder.patch(leaf, refinement);
            }
        }
    }
    let caps_from = builder.mesh.triangles.len();
    for leaf in refinement.leaves.iter().flatten() {
        builder.caps(leaf, refinement);
    }
    Extracted { mesh: builder.mesh, origins, caps_from }
}

impl Builder {
    fn vertex(&mut self, position: Vec3) -> u32 {
        self.mesh.positions.push(position);
        self.mesh.positions.len() as u32 - 1
    }

    fn corner(&mut self, corner: Corner, refinement: &Refinement<'_>) -> u32 {
        if let Some(&known) = self.corners.get(&corner) {
            return known;
        }
        let vertex = self.vertex(place(corner, &refinement.cuts));
        self.corners.insert(corner, vertex);
        vertex
    }

    fn node(&mut self, id: u32, refinement: &Refinement<'_>) -> u32 {
        if let Some(&known) = self.nodes.get(&id) {
            return known;
        }
        let vertex = self.vertex(refinement.nodes.position(id));
        self.nodes.insert(id, vertex);
        vertex
    }

    fn patch(&mut self, leaf: &Leaf, refinement: &Refinement<'_>) {
        let ring = Ring::of(&leaf.tetrahedron, &refinement.nodes, &refinement.cuts);
        let corners: Vec<u32> = ring.corners().iter().map(|&c| self.corner(c, refinement)).collect();
        match leaf.patch {
            Patch::Empty => {}
            Patch::Flat(diagonal) => {
                self.mesh.triangles.extend(ring.flat(diagonal).map(|triangle| triangle.map(|i| corners[i])));
            }
            Patch::Fan(apex) => {
                let apex = self.vertex(apex);
                self.fan(apex, &corners);
            }
        }
    }

    fn fan(&mut self, apex: u32, ring: &[u32]) {
        for (i, &corner) in ring.iter().enumerate() {
            self.mesh.triangles.push([apex, corner, ring[(i + 1) % ring.len()]]);
        }
    }

    /// The inside parts of faces on the border of the box.
    fn caps(&mut self, leaf: &Leaf, refinement: &Refinement<'_>) {
        let nodes = &refinement.nodes;
        let righted = leaf.tetrahedron.righted(nodes);
        for face in FACES.map(|face| face.map(|i| righted[i])) {
            let inside = face.map(|id| nodes.is_inside(id));
            let places = face.map(|id| nodes.places[id as usize]);
            if inside.contains(&true) && refinement.lattice.on_one_side(places) {
                self.cap(face, inside, refinement);
            }
        }
    }

    fn cap(&mut self, ids: [u32; 3], inside: [bool; 3], refinement: &Refinement<'_>) {
        let Some(lone) = lone(inside) else {
            let triangle = ids.map(|id| self.node(id, refinement));
            self.mesh.triangles.push(triangle);
            return;
        };
        let [a, b, c] = [0, 1, 2].map(|k| ids[(lone + k) % 3]);
        let face = Face::of(ids);
        let [ab, ca] = [Edge::between(a, b), Edge::between(c, a)];
        let [ab, ca] = [ab, ca].map(|edge| self.corner(Corner::On(edge), refinement));
        let crease = matches!(refinement.cuts.faces[&face], FaceCut::Creased(_));
        let crease = crease.then(|| self.corner(Corner::In(face), refinement));
        let part = if inside[lone] {
            vec![ca, self.node(a, refinement), ab]
        } else {
            vec![ab, self.node(b, refinement), self.node(c, refinement), ca]
        };
        match crease {
            // All but the two segments over the crease, which are the patch's.
            Some(x) => self.mesh.triangles.extend(part.windows(2).map(|pair| [x, pair[0], pair[1]])),
            None => self.mesh.triangles.extend((1..part.len() - 1).map(|i| [part[0], part[i], part[i + 1]])),
        }
    }
}
