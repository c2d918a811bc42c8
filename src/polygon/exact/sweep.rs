//! A line swept over a planar straight-line graph from left to right.
//!
//! The sweep knows only order: which edges cross the sweep line, from bottom to top, and which interval lies between two
//! of them. What is done with the intervals (finding cells, filling them with triangles) is a [`Visitor`]'s.

use super::{Chart, Line, PointId, Points};

/// Edges that meet only at common ends.
#[derive(Clone, Debug, Default)]
pub struct Planar {
    /// Distinct points, in the order of the chart.
    pub vertices: Vec<PointId>,
    /// Edges, in any order; [`Planar::sort`] orders them for the sweep.
    pub edges: Vec<PlanarEdge>,
}

/// An edge between two vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanarEdge {
    /// Index of the vertex on the left.
    pub left: u32,
    /// Index of the vertex on the right.
    pub right: u32,
    /// Index of the line it lies on.
    pub line: u32,
}

/// What happens to the intervals between the edges that cross the sweep line. Intervals are named by the visitor.
pub(super) trait Visitor {
    /// A new interval between two edges that start at `vertex`, the lower of which is `below`.
    fn open(&mut self, vertex: u32, below: u32) -> u32;
    /// `interval` ends at `vertex`, where the edges on both sides of it end.
    fn close(&mut self, interval: u32, vertex: u32);
    /// The edge above `interval` ends at `vertex`, and another one goes on from there.
    fn turn_above(&mut self, interval: u32, vertex: u32);
    /// The edge below `interval` ends at `vertex`, and another one goes on from there.
    fn turn_below(&mut self, interval: u32, vertex: u32);
    /// Edges start at `vertex` inside `interval`: it becomes a lower and an upper one.
    fn split(&mut self, interval: u32, vertex: u32) -> (u32, u32);
    /// All edges between two intervals end at `vertex`: they become one.
    fn merge(&mut self, lower: u32, upper: u32, vertex: u32) -> u32;
    /// `edge` starts between two intervals.
    fn start(&mut self, edge: u32, below: u32, above: u32);
}

/// An edge that crosses the sweep line, and the interval above it.
struct Active {
    edge: u32,
    above: u32,
}

impl Planar {
    /// Orders edges by their left ends and, from one left end, from bottom to top.
    pub fn sort(&mut self, points: &Points, lines: &[Line]) {
        let vertices = &self.vertices;
        self.edges.sort_by(|a, b| {
            a.left
                .cmp(&b.left)
                .then_with(|| lines[b.line as usize].side(points, vertices[a.right as usize]).cmp(&0))
        });
    }

    /// Runs a visitor over the graph; `outside` is its name for the interval without an edge.
    ///
    /// Edges must be in the order of [`Planar::sort`].
    pub(super) fn sweep(&self, points: &Points, lines: &[Line], outside: u32, visitor: &mut impl Visitor) {
        let mut status: Vec<Active> = Vec::new();
        let mut bottom = outside;
        let mut starting = self.edges.chunk_by(|a, b| a.left == b.left).peekable();
        let mut next_edge = 0_u32;
        for (index, &vertex) in self.vertices.iter().enumerate() {
            let index = index as u32;
            // Edges meet at ends only, so the sweep line reaches a vertex on an edge at its right end.
            let side = |active: &Active| {
                let edge = &self.edges[active.edge as usize];
                if edge.right == index { 0 } else { lines[edge.line as usize].side(points, vertex) }
            };
            let low = status.partition_point(|active| side(active) > 0);
            let ending = status[low..].iter().take_while(|active| side(active) == 0).count();
            let rights = starting.next_if(|group| group[0].left == index).map_or(0, <[PlanarEdge]>::len);

            let below = if low == 0 { bottom } else { status[low - 1].above };
            let above = if ending == 0 { below } else { status[low + ending - 1].above };
            for pair in status[low..low + ending].windows(2) {
                visitor.close(pair[0].above, index);
            }
            let (below, above) = match (ending, rights) {
                (0, 0) => continue,
                (0, _) => visitor.split(below, index),
                (_, 0) => {
                    let merged = visitor.merge(below, above, index);
                    (merged, merged)
                }
                _ => {
                    visitor.turn_above(below, index);
                    visitor.turn_below(above, index);
                    (below, above)
                }
            };
            match low {
                0 => bottom = below,
                _ => status[low - 1].above = below,
            }
            let mut under = below;
            let news = (0..rights as u32).map(|i| {
                let edge = next_edge + i;
                let over = if i + 1 == rights as u32 { above } else { visitor.open(index, edge) };
                visitor.start(edge, std::mem::replace(&mut under, over), over);
                Active { edge, above: over }
            });
            status.splice(low..low + ending, news.collect::<Vec<_>>());
            next_edge += rights as u32;
        }
    }

    /// The graph of some edges between points, each point once.
    pub fn new(chart: &Chart, points: &Points, edges: &[([PointId; 2], u32)]) -> Planar {
        let mut vertices: Vec<PointId> = edges.iter().flat_map(|(ends, _)| *ends).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices.sort_by(|&a, &b| chart.compare(points, a, b));
        let mut index: Vec<(PointId, u32)> = vertices.iter().copied().zip(0..).collect();
        index.sort_unstable();
        let find = |p: PointId| index[index.partition_point(|&(q, _)| q < p)].1;
        let edges = edges.iter().map(|&([a, b], line)| {
            let (a, b) = (find(a), find(b));
            PlanarEdge { left: a.min(b), right: a.max(b), line }
        });
        Planar { edges: edges.collect(), vertices }
    }
}
