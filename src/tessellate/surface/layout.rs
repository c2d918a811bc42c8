//! What belongs together: pieces, their edges and corners.

use super::{EdgeCounts, Precision, SurfaceOptions, TessellationError};
use crate::math::{Aabb, Vec3, Vec4};
use crate::numeric::DisjointSets;
use crate::surface::{Gluing, Patch, RationalPatch, Side, Surface};
use std::collections::BTreeMap;

/// All pieces with their edges.
pub(super) struct Layout<'a> {
    pub(super) surfaces: &'a [&'a dyn Surface],
    pub(super) pieces: Vec<Piece>,
    pub(super) edges: Vec<Edge<'a>>,
    /// Positions of the corners; edges name them by index.
    pub(super) corners: Vec<Vec3>,
    size: f64,
}

/// A part of a surface between creases.
pub(super) struct Piece {
    pub(super) surface: usize,
    pub(super) domain: [[f64; 2]; 2],
    /// In the order of [`Side::ALL`].
    pub(super) edges: [EdgeUse; 4],
}

/// An edge as a side of a piece.
#[derive(Clone, Copy)]
pub(super) struct EdgeUse {
    pub(super) edge: usize,
    /// Whether the side runs against the edge.
    pub(super) reversed: bool,
}

/// A curve that pieces share.
pub(super) struct Edge<'a> {
    pub(super) curve: Curve<'a>,
    pub(super) ends: [u32; 2],
    /// Whether it is a single point, which is then both ends.
    pub(super) pole: bool,
    pub(super) uses: usize,
}

/// The curve of an edge, as one of fixed v or u on a surface.
pub(super) struct Curve<'a> {
    surface: Carrier<'a>,
    pub(super) axis: usize,
    fixed: f64,
    pub(super) range: [f64; 2],
}

enum Carrier<'a> {
    Given(&'a dyn Surface),
    /// A Bézier curve, as a patch of degree 0 in v.
    Own(Box<dyn Surface>),
}

impl Curve<'_> {
    pub(super) fn surface(&self) -> &dyn Surface {
        match &self.surface {
            Carrier::Given(surface) => *surface,
            Carrier::Own(surface) => &**surface,
        }
    }

    pub(super) fn parameters(&self, t: f64) -> [f64; 2] {
        if self.axis == 0 { [t, self.fixed] } else { [self.fixed, t] }
    }

    pub(super) fn point(&self, t: f64) -> Vec3 {
        let [u, v] = self.parameters(t);
        self.surface().point(u, v)
    }

    /// First and second derivative.
    pub(super) fn derivatives(&self, t: f64) -> [Vec3; 2] {
        let [u, v] = self.parameters(t);
        let jet = self.surface().jet(u, v);
        if self.axis == 0 { [jet.du, jet.duu] } else { [jet.dv, jet.dvv] }
    }

    /// A proven bound of the second derivative over a range.
    pub(super) fn second_bound(&self, range: [f64; 2]) -> Option<f64> {
        let fixed = if matches!(self.surface, Carrier::Own(_)) { [0.0, 1.0] } else { [self.fixed; 2] };
        let part = if self.axis == 0 { [range, fixed] } else { [fixed, range] };
        Some(self.surface().second_bounds(part)?[2 * self.axis])
    }
}

/// A corner of a piece while it is not known which are the same.
type Slot = u32;

struct Builder<'a> {
    layout: Layout<'a>,
    slots: DisjointSets,
    positions: Vec<Vec3>,
    /// Edges with control points, by these, oriented.
    nets: BTreeMap<Vec<[u64; 4]>, usize>,
    /// Slots at exactly this position, of sides with control points.
    places: BTreeMap<[u64; 3], Slot>,
}

impl<'a> Layout<'a> {
    /// A surface that has an edge.
    pub(super) fn surface_of(&self, edge: usize) -> usize {
        let has_it = |piece: &&Piece| piece.edges.iter().any(|side| side.edge == edge);
        self.pieces.iter().find(has_it).map_or(0, |piece| piece.surface)
    }

    pub(super) fn new(surfaces: &'a [&'a dyn Surface]) -> Result<Layout<'a>, TessellationError> {
        let layout =
            Layout { surfaces, pieces: Vec::new(), edges: Vec::new(), corners: Vec::new(), size: 0.0 };
        let (slots, nets, places) = (DisjointSets::new(0), BTreeMap::new(), BTreeMap::new());
        let mut builder = Builder { layout, slots, positions: Vec::new(), nets, places };
        for index in 0..surfaces.len() {
            builder.add(index)?;
        }
        Ok(builder.finish())
    }

    /// Refuses tolerances that rounding alone exceeds.
    pub(super) fn check_precision(&self, options: &SurfaceOptions) -> Result<(), TessellationError> {
        // Evaluation errs by a few units in the last place of the largest coordinate.
        let finest = 64.0 * f64::EPSILON * self.size;
        match options.precision {
            Precision::Distance(value) if value < finest => {
                Err(TessellationError::ToleranceTooFine { value, finest })
            }
            _ => Ok(()),
        }
    }

    /// Number of edges that more than two pieces share.
    pub(super) fn crowded_edges(&self) -> usize {
        // Each may have any number of segments, all of them then crowded.
        if self.edges.iter().any(|edge| edge.uses > 2) { usize::MAX } else { 0 }
    }

    pub(super) fn edge_counts(&self) -> EdgeCounts {
        let real = || self.edges.iter().filter(|edge| !edge.pole);
        EdgeCounts {
            all: real().count(),
            used_once: real().filter(|edge| edge.uses == 1).count(),
            collapsed: self.edges.iter().filter(|edge| edge.pole).map(|edge| edge.uses).sum(),
        }
    }
}

impl<'a> Builder<'a> {
    /// A grid of pieces between the creases of a surface.
    fn add(&mut self, index: usize) -> Result<(), TessellationError> {
        let surface = self.layout.surfaces[index];
        let (domain, creases) = (surface.domain(), surface.creases());
        let lines = [0, 1].map(|axis: usize| {
            let [low, high] = domain[axis];
            let inner = creases[axis].iter().copied().filter(|&t| low < t && t < high);
            std::iter::once(low).chain(inner).chain([high]).collect::<Vec<f64>>()
        });
        let slots = self.corner_slots(index, &lines)?;
        let [nu, nv] = [lines[0].len() - 1, lines[1].len() - 1];
        let mut grid = Grid { index, lines, slots, along_u: BTreeMap::new(), along_v: BTreeMap::new() };
        for i in 0..nu {
            for j in 0..nv {
                let bottom = self.edge_along(&mut grid, 0, i, j);
                let top = self.edge_along(&mut grid, 0, i, j + 1);
                let left = self.edge_along(&mut grid, 1, i, j);
                let right = self.edge_along(&mut grid, 1, i + 1, j);
                let domain =
                    [[grid.lines[0][i], grid.lines[0][i + 1]], [grid.lines[1][j], grid.lines[1][j + 1]]];
                self.layout.pieces.push(Piece { surface: index, domain, edges: [bottom, top, left, right] });
            }
        }
        Ok(())
    }

    /// A slot for each crossing of lines, joined where sides lie together.
    fn corner_slots(
        &mut self,
        index: usize,
        lines: &[Vec<f64>; 2],
    ) -> Result<Vec<Vec<Slot>>, TessellationError> {
        let surface = self.layout.surfaces[index];
        let mut slots = Vec::new();
        for &u in &lines[0] {
            let mut column = Vec::new();
            for &v in &lines[1] {
                let point = surface.point(u, v);
                if !point.is_finite() {
                    return Err(TessellationError::NotFinite { surface: index, parameters: [u, v] });
                }
                self.layout.size = self.layout.size.max(point.abs().max_element());
                self.positions.push(point);
                column.push(self.slots.add());
            }
            slots.push(column);
        }
        let sides = surface.sides();
        let (last_u, last_v) = (lines[0].len() - 1, lines[1].len() - 1);
        for j in 0..=last_v {
            match sides.u {
                Gluing::Open => {}
                Gluing::Closed => self.join(slots[0][j], slots[last_u][j]),
                Gluing::Twisted => self.join(slots[0][j], slots[last_u][last_v - j]),
            }
        }
        for i in 0..=last_u {
            match sides.v {
                Gluing::Open => {}
                Gluing::Closed => self.join(slots[i][0], slots[i][last_v]),
                Gluing::Twisted => self.join(slots[i][0], slots[last_u - i][last_v]),
            }
        }
        for (side, &is_pole) in Side::ALL.iter().zip(&sides.poles) {
            if is_pole {
                let length = if side.axis() == 0 { last_u } else { last_v };
                let slot = |k: usize| match side {
                    Side::Bottom => slots[k][0],
                    Side::Top => slots[k][last_v],
                    Side::Left => slots[0][k],
                    Side::Right => slots[last_u][k],
                };
                (1..=length).for_each(|k| {
                    self.slots.join(slot(0), slot(k));
                });
            }
        }
        Ok(slots)
    }

    fn join(&mut self, a: Slot, b: Slot) {
        self.slots.join(a, b);
    }

    /// The edge from crossing (i, j) along an axis.
    fn edge_along(&mut self, grid: &mut Grid, axis: usize, i: usize, j: usize) -> EdgeUse {
        let surface = self.layout.surfaces[grid.index];
        let counts = [grid.lines[0].len() - 1, grid.lines[1].len() - 1];
        let cross = 1 - axis;
        let (along, line) = if axis == 0 { (i, j) } else { (j, i) };
        let gluing = if cross == 0 { surface.sides().u } else { surface.sides().v };
        // The far side is the near one where they are glued.
        let glued = line == counts[cross] && gluing != Gluing::Open;
        let reversed = glued && gluing == Gluing::Twisted;
        let (along, line) = match (glued, reversed) {
            (false, _) => (along, line),
            (true, false) => (along, 0),
            (true, true) => (counts[axis] - 1 - along, 0),
        };
        let known = if axis == 0 { &grid.along_u } else { &grid.along_v };
        if let Some(&EdgeUse { edge, reversed: once }) = known.get(&(along, line)) {
            self.layout.edges[edge].uses += 1;
            return EdgeUse { edge, reversed: once != reversed };
        }
        let made = self.new_edge(grid, axis, along, line, counts);
        let known = if axis == 0 { &mut grid.along_u } else { &mut grid.along_v };
        known.insert((along, line), made);
        EdgeUse { edge: made.edge, reversed: made.reversed != reversed }
    }

    fn new_edge(
        &mut self,
        grid: &Grid,
        axis: usize,
        along: usize,
        line: usize,
        counts: [usize; 2],
    ) -> EdgeUse {
        let surface = self.layout.surfaces[grid.index];
        let slot = |k: usize| if axis == 0 { grid.slots[k][line] } else { grid.slots[line][k] };
        let ends = [slot(along), slot(along + 1)];
        let side = match (axis, line == 0, line == counts[1 - axis]) {
            (0, true, _) => Some(Side::Bottom),
            (0, _, true) => Some(Side::Top),
            (_, true, _) => Some(Side::Left),
            (_, _, true) => Some(Side::Right),
            _ => None,
        };
        let whole = side.filter(|_| counts[axis] == 1);
        if let Some(net) = whole.and_then(|side| surface.border_net(side)) {
            return self.net_edge(&net, ends);
        }
        let pole = side.is_some_and(|side| surface.sides().poles[side as usize]);
        let (range, fixed) =
            ([grid.lines[axis][along], grid.lines[axis][along + 1]], grid.lines[1 - axis][line]);
        let curve = Curve { surface: Carrier::Given(surface), axis, fixed, range };
        self.layout.edges.push(Edge { curve, ends, pole, uses: 1 });
        EdgeUse { edge: self.layout.edges.len() - 1, reversed: false }
    }

    /// The edge with these control points, which is there already where another side has them, forward or backward.
    fn net_edge(&mut self, net: &[Vec4], ends: [Slot; 2]) -> EdgeUse {
        for slot in ends {
            let place = key3(self.positions[slot as usize]);
            let first = *self.places.entry(place).or_insert(slot);
            self.slots.join(first, slot);
        }
        // Zero has two bit patterns that mean the same.
        let bits = |p: &Vec4| p.to_array().map(|x| (x + 0.0).to_bits());
        let forward: Vec<[u64; 4]> = net.iter().map(bits).collect();
        let backward: Vec<[u64; 4]> = forward.iter().rev().copied().collect();
        let reversed = backward < forward;
        let key = if reversed { backward } else { forward };
        if let Some(&edge) = self.nets.get(&key) {
            self.layout.edges[edge].uses += 1;
            return EdgeUse { edge, reversed };
        }
        let oriented: Vec<Vec4> = if reversed { net.iter().rev().copied().collect() } else { net.to_vec() };
        let ends = if reversed { [ends[1], ends[0]] } else { ends };
        let points: Vec<Vec3> = oriented.iter().map(|p| p.truncate() / p.w).collect();
        let pole = points.iter().all(|point| *point == points[0]);
        let curve = Curve {
            surface: Carrier::Own(ribbon(&oriented, points)),
            axis: 0,
            fixed: 0.0,
            range: [0.0, 1.0],
        };
        self.layout.edges.push(Edge { curve, ends, pole, uses: 1 });
        self.nets.insert(key, self.layout.edges.len() - 1);
        EdgeUse { edge: self.layout.edges.len() - 1, reversed }
    }

    /// Numbers the corners.
    fn finish(mut self) -> Layout<'a> {
        // Poles may join corners that their surfaces do not say are one.
        for edge in self.layout.edges.iter().filter(|edge| edge.pole) {
            self.slots.join(edge.ends[0], edge.ends[1]);
        }
        let (numbers, count) = self.slots.numbered();
        let mut corners = vec![Vec3::ZERO; count as usize];
        for (slot, &number) in numbers.iter().enumerate().rev() {
            corners[number as usize] = self.positions[slot];
        }
        for edge in &mut self.layout.edges {
            edge.ends = edge.ends.map(|slot| numbers[slot as usize]);
        }
        let bounds = Aabb::of(corners.iter().copied());
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        self.layout.size = self.layout.size.max(if reach.is_finite() { reach } else { 0.0 });
        self.layout.corners = corners;
        self.layout
    }
}

/// Lines of a surface with the slots at their crossings and the edges found so far.
struct Grid {
    index: usize,
    lines: [Vec<f64>; 2],
    slots: Vec<Vec<Slot>>,
    along_u: BTreeMap<(usize, usize), EdgeUse>,
    along_v: BTreeMap<(usize, usize), EdgeUse>,
}

fn key3(point: Vec3) -> [u64; 3] {
    point.to_array().map(|x| (x + 0.0).to_bits())
}

/// A Bézier curve as a patch.
fn ribbon(net: &[Vec4], points: Vec<Vec3>) -> Box<dyn Surface> {
    let degrees = [net.len() - 1, 0];
    if net.iter().all(|point| point.w == 1.0) {
        Box::new(Patch::new(degrees, points).expect("borders of patches are sound"))
    } else {
        let weights: Vec<f64> = net.iter().map(|point| point.w).collect();
        Box::new(RationalPatch::new(degrees, &points, &weights).expect("borders of patches are sound"))
    }
}
