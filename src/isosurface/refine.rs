//! Halving tetrahedra until each is free of the surface or has a piece of it that is near enough.

use super::crossing::{Cuts, Edge, Face, cut_edge, cut_face, lone};
use super::extract::Extracted;
use super::lattice::{Lattice, Nodes};
use super::patch::{Patch, fitting, plainest};
use super::shells::KNOWN;
use super::tetrahedron::{EDGES, FACES, LAST_GENERATION, Tetrahedron};
use super::{IsoError, Places};
use crate::math::{Aabb, Interval, Vec3};
use crate::par;
use crate::sdf::{Field, Range, Slopes};
use std::sync::Arc;

/// Below this many tetrahedra threads are not worth waking.
const FEW: usize = 256;

/// Fields cheaper than this are not worth pruning.
const CHEAP: usize = 16;

/// Samples must be within this part of the tolerance; the greatest error lies between them.
const SAMPLED: f64 = 0.75;

/// Proofs and samples look so many tolerances beyond a tetrahedron: what stands for the field in it must do so there.
pub(super) const AROUND: f64 = KNOWN + 0.001;

/// Root cells along the longest side of the box.
const ROOTS: usize = 6;

/// A tetrahedron that stays, with its piece of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub(super) tetrahedron: Tetrahedron,
    pub(super) patch: Patch,
    /// It was too small to be halved again, or nothing is known of its sheets.
    pub(super) given_up: bool,
    /// Its tolerance has been proven, and nothing around it has changed since.
    pub(super) proven: bool,
}

/// Sizes that steer the refinement, in model units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) tolerance: f64,
    /// Tetrahedra without a change of sign are halved down to this size where nothing is proven.
    pub(super) search: f64,
    /// Nothing is halved below this.
    pub(super) least: f64,
    pub(super) most_cells: usize,
}

/// The state of a meshing.
pub(super) struct Refinement<'f> {
    root: &'f dyn Field,
    /// Fields that stand for the whole one in parts of space; number 0 is the whole one.
    pruned: Vec<Arc<dyn Field>>,
    ranged: bool,
    pub(super) sizes: Sizes,
    pub(super) lattice: Lattice,
    pub(super) nodes: Nodes,
    pub(super) cuts: Cuts,
    /// By generation.
    pub(super) leaves: Vec<Vec<Leaf>>,
    /// Generations of tetrahedra that were halved since hanging nodes were looked for, a bit each.
    halved: u64,
    /// Corners of tetrahedra that were halved.
    changed: Vec<u32>,
    /// How many tetrahedra there have been.
    pub(super) visited: usize,
    pub(super) undefined: Places,
    pub(super) unsigned: Places,
}

/// What is known of a tetrahedron before its patch.
struct First {
    state: State,
    one_sheet: bool,
    pruned: Option<Arc<dyn Field>>,
    /// The field may have no value somewhere in it.
    undefined: bool,
    /// The field reaches zero and does not become negative.
    touched: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    /// Free of the surface.
    Gone,
    /// Inside, with a face on the border of the box, which will be a part of the mesh.
    Border,
    Open,
}

impl<'f> Refinement<'f> {
    pub(super) fn new(root: &'f dyn Field, bounds: Aabb, sizes: Sizes) -> Refinement<'f> {
        let ranged = root.range(bounds).is_some();
        Refinement {
            root,
            pruned: Vec::new(),
            ranged,
            sizes,
            lattice: Lattice::over(bounds, ROOTS),
            nodes: Nodes::default(),
            cuts: Cuts::default(),
            leaves: vec![Vec::new(); usize::from(LAST_GENERATION) + 1],
            halved: 0,
            changed: Vec::new(),
            visited: 0,
            undefined: Places::default(),
            unsigned: Places::default(),
        }
    }

    /// Refines from the root cells until every leaf is settled and no node hangs.
    pub(super) fn run(&mut self) -> Result<(), IsoError> {
        let [nx, ny, nz] = self.lattice.roots();
        let mut fresh = Vec::new();
        for cell in (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z]))) {
            fresh.extend(Tetrahedron::of_root(cell, &mut self.nodes, &self.lattice));
        }
        let places = self.nodes.positions.clone();
        self.nodes.values = par::map_above(FEW, &places, |&p| self.root.value(p));
        self.settle(fresh)
    }

    /// Halves leaves, by generation and place among its leaves in ascending order, and what follows from it.
    pub(super) fn halve_leaves(&mut self, chosen: &[[usize; 2]]) -> Result<(), IsoError> {
        let mut split = Vec::with_capacity(chosen.len());
        let mut next = chosen.iter().peekable();
        for (generation, leaves) in self.leaves.iter_mut().enumerate() {
            let mut index = 0;
            leaves.retain(|leaf| {
                let out = next.next_if_eq(&&[generation, index]).is_some();
                index += 1;
                if out {
                    split.push(leaf.tetrahedron);
                }
                !out
            });
        }
        let first_new = self.nodes.values.len();
        let mut changed = vec![false; first_new];
        self.changed.clear();
        let fresh = self.halve(&split);
        self.settle(fresh)?;
        for id in self.changed.iter().map(|&id| id as usize).filter(|&id| id < first_new) {
            changed[id] = true;
        }
        for leaf in self.leaves.iter_mut().flatten() {
            let near = |&id: &u32| changed.get(id as usize).is_none_or(|&changed| changed);
            leaf.proven &= !leaf.tetrahedron.nodes.iter().any(near);
        }
        Ok(())
    }

    /// Marks leaves as proven.
    pub(super) fn note_proven(&mut self, proven: &[[usize; 2]]) {
        proven.iter().for_each(|&[generation, index]| self.leaves[generation][index].proven = true);
    }

    fn settle(&mut self, mut fresh: Vec<Tetrahedron>) -> Result<(), IsoError> {
        loop {
            while !fresh.is_empty() {
                self.visited += fresh.len();
                let cells = self.leaf_count() + fresh.len();
                if cells > self.sizes.most_cells {
                    return Err(IsoError::TooManyCells { limit: self.sizes.most_cells });
                }
                let split = self.sort_out(fresh);
                fresh = self.halve(&split);
            }
            let hanging = self.take_hanging();
            if hanging.is_empty() {
                return Ok(());
            }
            fresh = self.halve(&hanging);
        }
    }

    /// The whole field.
    pub(super) fn root(&self) -> &dyn Field {
        self.root
    }

    /// The field that stands for the whole one in a tetrahedron.
    pub(super) fn field(&self, number: u32) -> &dyn Field {
        match number {
            0 => self.root,
            n => &*self.pruned[n as usize - 1],
        }
    }

    /// Keeps what is settled as leaves, drops what is free of the surface, hands back what must be halved.
    fn sort_out(&mut self, fresh: Vec<Tetrahedron>) -> Vec<Tetrahedron> {
        let firsts = par::map_above(FEW, &fresh, |t| self.first_look(t));
        let mut open = Vec::with_capacity(fresh.len());
        for (mut tetrahedron, first) in fresh.into_iter().zip(firsts) {
            let bounds = || tetrahedron.bounds(&self.nodes);
            if first.touched {
                self.unsigned.add(bounds());
            }
            match first.state {
                State::Gone if first.undefined => self.undefined.add(bounds()),
                State::Gone => {}
                State::Border => self.keep(tetrahedron, Patch::Empty, false),
                State::Open => {
                    tetrahedron.one_sheet = first.one_sheet;
                    if let Some(field) = first.pruned {
                        self.pruned.push(field);
                        tetrahedron.field = self.pruned.len() as u32;
                    }
                    open.push(tetrahedron);
                }
            }
        }
        self.cut(&open);
        let patches = par::map_above(FEW, &open, |t| self.verdict(t));
        let mut split = Vec::new();
        for (tetrahedron, patch) in open.into_iter().zip(patches) {
            match patch {
                Some((patch, given_up)) => self.keep(tetrahedron, patch, given_up),
                None => split.push(tetrahedron),
            }
        }
        split
    }

    fn keep(&mut self, tetrahedron: Tetrahedron, patch: Patch, given_up: bool) {
        self.leaves[usize::from(tetrahedron.generation)].push(Leaf {
            tetrahedron,
            patch,
            given_up,
            proven: false,
        });
    }

    /// What ranges and slopes tell.
    fn first_look(&self, tetrahedron: &Tetrahedron) -> First {
        let (cell, field) = (tetrahedron.bounds(&self.nodes), self.field(tetrahedron.field));
        let crossed = tetrahedron.is_crossed(&self.nodes);
        let mut first = First {
            state: State::Open,
            one_sheet: tetrahedron.one_sheet,
            pruned: None,
            undefined: false,
            touched: false,
        };
        if !crossed {
            let range = field.range(cell).unwrap_or(Range::UNKNOWN);
            first.undefined = range.is_undefined();
            first.touched = range.is_outside() && range.interval.lo == 0.0;
            first.state = match range {
                range if range.is_outside() || range.is_undefined() => State::Gone,
                range if range.is_inside() && !tetrahedron.is_at_border(&self.nodes, &self.lattice) => {
                    State::Gone
                }
                range if range.is_inside() => State::Border,
                _ => State::Open,
            };
        }
        if first.state == State::Open && self.ranged {
            if tetrahedron.generation.is_multiple_of(3) && field.cost() > CHEAP {
                let around = AROUND * self.sizes.tolerance;
                let cell = Aabb { min: cell.min - around, max: cell.max + around };
                // A little less is not worth the memory.
                first.pruned = field.within(cell).filter(|pruned| 4 * pruned.cost() < 3 * field.cost());
            }
            let field = first.pruned.as_deref().unwrap_or(field);
            first.one_sheet |= field.slopes(cell).is_some_and(|slopes| has_one_sheet(&slopes));
        }
        first
    }

    /// Cuts all edges and faces that the surface passes and that have not been cut yet.
    fn cut(&mut self, open: &[Tetrahedron]) {
        let (nodes, cuts) = (&self.nodes, &self.cuts);
        let mut edges: Vec<(Edge, u32)> = Vec::new();
        let mut faces: Vec<(Face, u32)> = Vec::new();
        for t in open.iter().filter(|t| t.is_crossed(nodes)) {
            for [i, j] in EDGES {
                let edge = Edge::between(t.nodes[i], t.nodes[j]);
                if nodes.is_inside(t.nodes[i]) != nodes.is_inside(t.nodes[j])
                    && !cuts.edges.contains_key(&edge)
                {
                    edges.push((edge, t.field));
                }
            }
            for face in FACES.map(|face| face.map(|i| t.nodes[i])) {
                let crossed = lone(face.map(|id| nodes.is_inside(id))).is_some();
                if crossed && !cuts.faces.contains_key(&Face::of(face)) {
                    faces.push((Face::of(face), t.field));
                }
            }
        }
        edges.sort_unstable();
        edges.dedup_by_key(|(edge, _)| *edge);
        faces.sort_unstable();
        faces.dedup_by_key(|(face, _)| *face);
        // Vertices count as points of the surface.
        let accuracy = 1e-4 * self.sizes.tolerance;
        let found =
            par::map_above(FEW, &edges, |&(edge, field)| cut_edge(self.field(field), edge, nodes, accuracy));
        self.cuts.edges.extend(edges.into_iter().map(|(edge, _)| edge).zip(found));
        let (nodes, known, reach) = (&self.nodes, &self.cuts.edges, SAMPLED * self.sizes.tolerance);
        let found = par::map_above(FEW, &faces, |&(face, field)| {
            cut_face(self.field(field), face, nodes, known, reach)
        });
        self.cuts.faces.extend(faces.into_iter().map(|(face, _)| face).zip(found));
    }

    /// The piece of the surface and whether it is only the best that could be done; `None` when it must be halved.
    fn verdict(&self, t: &Tetrahedron) -> Option<(Patch, bool)> {
        let size = t.size(&self.nodes);
        let last = t.generation == LAST_GENERATION || 0.5 * size < self.sizes.least;
        let crossed = t.is_crossed(&self.nodes);
        // Where a piece fits, a second sheet is for the proof to find.
        let search = if crossed { 8.0 * self.sizes.search } else { self.sizes.search };
        if !t.one_sheet && size > search && !last {
            return None;
        }
        if !crossed {
            return Some((Patch::Empty, !t.one_sheet));
        }
        let reach = SAMPLED * self.sizes.tolerance;
        match fitting(self.field(t.field), t, &self.nodes, &self.cuts, reach) {
            Some(patch) => Some((patch, !t.one_sheet)),
            None if last => Some((plainest(t, &self.nodes, &self.cuts), true)),
            None => None,
        }
    }

    /// Both halves of each, with the field at their new nodes.
    fn halve(&mut self, split: &[Tetrahedron]) -> Vec<Tetrahedron> {
        let mut halves = Vec::with_capacity(2 * split.len());
        let mut new: Vec<(Vec3, u32)> = Vec::new();
        for t in split {
            let [a, b] = t.halved_edge();
            let middle = self.nodes.middle(a, b, &self.lattice);
            if middle as usize == self.nodes.values.len() + new.len() {
                new.push((self.nodes.position(middle), t.field));
            }
            halves.extend(t.halves(middle));
            self.changed.extend(t.nodes);
            // Its neighbours may hang now, and so may its halves.
            self.halved |= 0b11 << t.generation;
        }
        let values = par::map_above(FEW, &new, |&(p, field)| self.field(field).value(p));
        self.nodes.values.extend(values);
        halves
    }

    /// How many leaves there are.
    pub(super) fn leaf_count(&self) -> usize {
        self.leaves.iter().map(Vec::len).sum()
    }

    /// Whether the field brings ranges.
    pub(super) fn is_ranged(&self) -> bool {
        self.ranged
    }

    /// Leaves whose piece is only the best that could be done.
    pub(super) fn given_up(&self) -> Places {
        let mut places = Places::default();
        let leaves = self.leaves.iter().flatten().filter(|leaf| leaf.given_up);
        leaves.for_each(|leaf| places.add(leaf.tetrahedron.bounds(&self.nodes)));
        places
    }

    /// Edges along which the sign changes by a jump.
    pub(super) fn jumps(&self) -> Places {
        let crossed = self.leaves.iter().flatten().filter(|leaf| leaf.patch != Patch::Empty);
        let all = crossed.flat_map(|leaf| {
            let nodes = leaf.tetrahedron.nodes;
            EDGES.map(|[i, j]| Edge::between(nodes[i], nodes[j]))
        });
        let mut edges: Vec<Edge> =
            all.filter(|edge| self.cuts.edges.get(edge).is_some_and(|cut| cut.jump)).collect();
        edges.sort_unstable();
        edges.dedup();
        let mut places = Places::default();
        edges.iter().for_each(|edge| places.add(Aabb::of(edge.nodes().map(|id| self.nodes.position(id)))));
        places
    }

    /// The greatest distance from the surface, by value over slope, at the middles of triangles.
    pub(super) fn measured(&self, extracted: &Extracted) -> f64 {
        let indices: Vec<usize> = (0..extracted.caps_from).collect();
        let distances = par::map(&indices, |&i| {
            let [a, b, c] = extracted.mesh.corners(i);
            let (value, gradient) = self.root.gradient((a + b + c) / 3.0);
            let distance = value.abs() / gradient.length();
            if distance.is_finite() { distance } else { 0.0 }
        });
        distances.into_iter().fold(0.0, f64::max)
    }

    /// Takes out the leaves with a node in the middle of an edge. Only those up to three generations above what was
    /// halved can have one.
    fn take_hanging(&mut self) -> Vec<Tetrahedron> {
        let halved = std::mem::take(&mut self.halved);
        let (leaves, nodes) = (&mut self.leaves, &self.nodes);
        let mut hanging = Vec::new();
        let may_hang =
            leaves.iter_mut().enumerate().filter(|(generation, _)| halved >> generation & 0b1111 != 0);
        for (_, leaves) in may_hang {
            let hangs = par::map(leaves, |leaf| leaf.tetrahedron.hangs(nodes));
            let mut hangs = hangs.into_iter();
            leaves.retain(|leaf| {
                let out = hangs.next() == Some(true);
                if out {
                    hanging.push(leaf.tetrahedron);
                }
                !out
            });
        }
        hanging
    }
}

/// Whether the field nowhere falls along one direction, the middle of its slopes: then it changes its sign once at
/// most. Rounding is forgiven here, since what is proven in the end does not rest on it.
fn has_one_sheet(slopes: &Slopes) -> bool {
    if !slopes.gradient.iter().all(|g| g.is_bounded()) {
        return false;
    }
    let middle = slopes.gradient.map(Interval::middle);
    let least = (0..3).map(|k| {
        let g = slopes.gradient[k];
        (g.lo * middle[k]).min(g.hi * middle[k])
    });
    let size: f64 = middle.iter().map(|m| m * m).sum();
    size > 0.0 && least.sum::<f64>() >= -1e-9 * size
}
