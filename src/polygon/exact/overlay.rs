//! Segments of one plane cut where they meet, and the cells between them.

use super::sweep::{Planar, Visitor};
use super::{Chart, Line, PointId, Points};
use crate::math::Aabb;
use crate::numeric::DisjointSets;
use crate::spatial::Bvh;
use std::cmp::Ordering;

/// A segment of a chart, between different points of one of its lines.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// The ends, in either order.
    pub ends: [PointId; 2],
    /// Index of the line it lies on.
    pub line: u32,
    /// What changes across the segment, seen from its first end to its second; none for a mere cut.
    pub jump: Option<Jump>,
}

/// A change of coverage from the right of a directed segment to its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Jump {
    /// Whose coverage.
    pub operand: u32,
    /// By how much it is more on the left.
    pub amount: i32,
    /// The face that begins there.
    pub face: u32,
}

/// A planar subdivision: edges that meet only at common ends, and cells between them.
#[derive(Clone, Debug, Default)]
pub struct Overlay {
    /// Points from left to right.
    pub vertices: Vec<PointId>,
    /// Edges by their left ends, from one left end from bottom to top.
    pub edges: Vec<SubEdge>,
    /// All jumps of all edges; each edge names its range.
    pub jumps: Vec<Jump>,
    /// For each cell, the sorted operands that cover it and how often; cell 0 is the one outside.
    pub coverage: Vec<Vec<(u32, i32)>>,
}

/// A piece of one or several segments.
#[derive(Clone, Copy, Debug)]
pub struct SubEdge {
    /// Its ends, the left one first.
    pub ends: [PointId; 2],
    /// Index of a line it lies on.
    pub line: u32,
    /// The cell below it.
    pub below: u32,
    /// The cell above it.
    pub above: u32,
    /// Range in [`Overlay::jumps`], each from below to above.
    pub jumps: [u32; 2],
}

impl Overlay {
    /// The jumps of an edge, from below to above.
    pub fn jumps_of(&self, edge: &SubEdge) -> &[Jump] {
        &self.jumps[edge.jumps[0] as usize..edge.jumps[1] as usize]
    }
}

/// Cuts `segments` where they cross, touch or overlap, and at `marks` that lie on them, and finds the cells between them.
///
/// New points are entered into `points`. Coverage is zero outside and changes by the jumps.
pub fn overlay(
    chart: &Chart,
    points: &mut Points,
    lines: &[Line],
    segments: &[Segment],
    marks: &[PointId],
) -> Overlay {
    let oriented = segments.iter().map(|segment| from_left_to_right(chart, points, segment));
    // Before they are cut, so that what coincides is cut once.
    let strands = Strands::unite(oriented.map(|s| (s.ends, s.line, s.jump)).collect());
    let pieces = cut(chart, points, lines, &strands, marks);
    let (edges, jumps) = strands.united_pieces(&pieces);
    let ends: Vec<([PointId; 2], u32)> = edges.iter().map(|edge| (edge.ends, edge.line)).collect();
    let mut planar = Planar::new(chart, points, &ends);
    let order = sweep_order(&mut planar, points, lines);
    let edges: Vec<SubEdge> = order.iter().map(|&i| edges[i as usize]).collect();
    find_cells(&planar, points, lines, edges, jumps)
}

/// Segments from left to right, those with the same ends as one.
struct Strands {
    strands: Vec<Strand>,
    jumps: Vec<Jump>,
}

struct Strand {
    ends: [PointId; 2],
    line: u32,
    /// Range of its jumps.
    jumps: [u32; 2],
}

/// A piece of a strand from left to right.
struct Piece {
    ends: [PointId; 2],
    strand: u32,
}

impl Strands {
    fn unite(mut segments: Vec<([PointId; 2], u32, Option<Jump>)>) -> Strands {
        segments.sort_unstable_by_key(|&(ends, line, jump)| (ends, jump, line));
        let mut united = Strands { strands: Vec::with_capacity(segments.len()), jumps: Vec::new() };
        for group in segments.chunk_by(|a, b| a.0 == b.0) {
            let start = united.jumps.len() as u32;
            united.jumps.extend(group.iter().filter_map(|&(_, _, jump)| jump));
            let jumps = [start, united.jumps.len() as u32];
            united.strands.push(Strand { ends: group[0].0, line: group[0].1, jumps });
        }
        united
    }

    fn jumps_of(&self, strand: u32) -> &[Jump] {
        let [start, end] = self.strands[strand as usize].jumps;
        &self.jumps[start as usize..end as usize]
    }

    /// Makes pieces with the same ends one edge with the jumps of all.
    fn united_pieces(&self, pieces: &[Piece]) -> (Vec<SubEdge>, Vec<Jump>) {
        let mut order: Vec<([PointId; 2], u32)> =
            pieces.iter().map(|piece| (piece.ends, piece.strand)).collect();
        order.sort_unstable();
        let (mut edges, mut jumps) = (Vec::with_capacity(order.len()), Vec::new());
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            let start = jumps.len();
            jumps.extend(group.iter().flat_map(|&(_, strand)| self.jumps_of(strand)));
            jumps[start..].sort_unstable();
            let jumps = [start as u32, jumps.len() as u32];
            let line = self.strands[group[0].1 as usize].line;
            edges.push(SubEdge { ends: group[0].0, line, below: 0, above: 0, jumps });
        }
        (edges, jumps)
    }
}

/// Strands of which all pairs are looked at sooner than a tree over them is made.
const FEW: usize = 24;

/// All strands in pieces that meet only at common ends, or coincide.
fn cut(
    chart: &Chart,
    points: &mut Points,
    lines: &[Line],
    strands: &Strands,
    marks: &[PointId],
) -> Vec<Piece> {
    let strands = &strands.strands;
    let boxes: Vec<Aabb> = strands.iter().map(|s| Aabb::of(s.ends.map(|p| points.rounded(p)))).collect();
    let mut cuts: Vec<(u32, PointId)> = Vec::new();
    let mut meet = |i: u32, j: u32| {
        let (a, b) = (&strands[i as usize], &strands[j as usize]);
        cut_pair(chart, points, lines, [a, b], |which, at| cuts.push(([i, j][which], at)));
    };
    let few = boxes.len() <= FEW;
    let bvh = if few && marks.is_empty() { Bvh::default() } else { Bvh::new(&boxes) };
    if few {
        for (j, b) in (0_u32..).zip(&boxes) {
            let touching = (0..j).filter(|&i| boxes[i as usize].touches(*b));
            touching.for_each(|i| meet(i, j));
        }
    } else {
        bvh.self_pairs(&boxes, meet);
    }
    for &mark in marks {
        let place = points.rounded(mark);
        bvh.touching(&boxes, Aabb { min: place, max: place }, |i| {
            let strand = &strands[i as usize];
            if lines[strand.line as usize].side(points, mark) == 0
                && strictly_between(chart, points, mark, strand)
            {
                cuts.push((i, mark));
            }
        });
    }
    cuts.sort_by(|a, b| a.0.cmp(&b.0).then_with(|| chart.compare(points, a.1, b.1)));
    cuts.dedup();

    let mut pieces = Vec::with_capacity(strands.len() + cuts.len());
    let mut cuts = cuts.into_iter().peekable();
    for (index, strand) in (0_u32..).zip(strands) {
        let mut from = strand.ends[0];
        while let Some((_, at)) = cuts.next_if(|&(of, _)| of == index) {
            pieces.push(Piece { ends: [from, at], strand: index });
            from = at;
        }
        pieces.push(Piece { ends: [from, strand.ends[1]], strand: index });
    }
    pieces
}

fn from_left_to_right(chart: &Chart, points: &Points, segment: &Segment) -> Segment {
    match chart.compare(points, segment.ends[0], segment.ends[1]) {
        Ordering::Greater => Segment {
            ends: [segment.ends[1], segment.ends[0]],
            jump: segment.jump.map(|jump| Jump { amount: -jump.amount, ..jump }),
            ..*segment
        },
        _ => *segment,
    }
}

/// Reports the points strictly inside one of two strands where the other one meets it.
fn cut_pair(
    chart: &Chart,
    points: &mut Points,
    lines: &[Line],
    pair: [&Strand; 2],
    mut report: impl FnMut(usize, PointId),
) {
    let [a, b] = pair;
    let (line_a, line_b) = (&lines[a.line as usize], &lines[b.line as usize]);
    // A common end lies on both lines, and needs no exact arithmetic to be found there.
    let side = |line: &Line, of: &Strand, p: PointId| {
        if of.ends.contains(&p) { 0 } else { line.side(points, p) }
    };
    let sides_of_a = if a.line == b.line { [0, 0] } else { a.ends.map(|p| side(line_b, b, p)) };
    if sides_of_a == [0, 0] {
        for (which, other) in [(0, b), (1, a)] {
            for end in other.ends {
                if strictly_between(chart, points, end, pair[which]) {
                    report(which, end);
                }
            }
        }
        return;
    }
    if sides_of_a[0] * sides_of_a[1] > 0 {
        return;
    }
    let sides_of_b = b.ends.map(|p| side(line_a, a, p));
    if sides_of_b[0] * sides_of_b[1] > 0 {
        return;
    }
    // The lines cross in one point, which is on both segments: an end wherever a side is zero.
    let end_of = |segment: &Strand, sides: [i32; 2]| {
        sides.iter().position(|&side| side == 0).map(|which| segment.ends[which])
    };
    match (end_of(a, sides_of_a), end_of(b, sides_of_b)) {
        (Some(_), Some(_)) => {}
        (Some(end), None) => report(1, end),
        (None, Some(end)) => report(0, end),
        (None, None) => {
            let meeting = points.meeting(chart.plane(), line_a.plane(), line_b.plane());
            let at = meeting.expect("lines that cross meet in one point");
            report(0, at);
            report(1, at);
        }
    }
}

/// Whether a point of the segment's line lies inside the segment and is none of its ends.
fn strictly_between(chart: &Chart, points: &Points, point: PointId, segment: &Strand) -> bool {
    chart.compare(points, segment.ends[0], point) == Ordering::Less
        && chart.compare(points, point, segment.ends[1]) == Ordering::Less
}

/// Sorts the graph for the sweep and tells which edge came from where.
fn sweep_order(planar: &mut Planar, points: &Points, lines: &[Line]) -> Vec<u32> {
    let before = planar.edges.clone();
    planar.sort(points, lines);
    let mut place: Vec<(u32, u32, u32)> = (0..).zip(&before).map(|(i, e)| (e.left, e.right, i)).collect();
    place.sort_unstable();
    let find = |left: u32, right: u32| place[place.partition_point(|&(l, r, _)| (l, r) < (left, right))].2;
    planar.edges.iter().map(|edge| find(edge.left, edge.right)).collect()
}

/// Cells as a union of intervals: those that merge become one.
struct CellFinder<'a> {
    cells: DisjointSets,
    edges: &'a mut [SubEdge],
}

impl Visitor for CellFinder<'_> {
    fn open(&mut self, _vertex: u32, _below: u32) -> u32 {
        self.cells.add()
    }

    fn close(&mut self, _interval: u32, _vertex: u32) {}

    fn turn_above(&mut self, _interval: u32, _vertex: u32) {}

    fn turn_below(&mut self, _interval: u32, _vertex: u32) {}

    fn split(&mut self, interval: u32, _vertex: u32) -> (u32, u32) {
        (interval, interval)
    }

    fn merge(&mut self, lower: u32, upper: u32, _vertex: u32) -> u32 {
        self.cells.join(lower, upper)
    }

    fn start(&mut self, edge: u32, below: u32, above: u32) {
        let edge = &mut self.edges[edge as usize];
        (edge.below, edge.above) = (below, above);
    }
}

fn find_cells(
    planar: &Planar,
    points: &Points,
    lines: &[Line],
    mut edges: Vec<SubEdge>,
    jumps: Vec<Jump>,
) -> Overlay {
    let mut finder = CellFinder { cells: DisjointSets::new(1), edges: &mut edges };
    planar.sweep(points, lines, 0, &mut finder);
    let (names, count) = finder.cells.numbered();
    for edge in &mut edges {
        (edge.below, edge.above) = (names[edge.below as usize], names[edge.above as usize]);
    }
    let coverage = cover(&edges, &jumps, count as usize);
    Overlay { vertices: planar.vertices.clone(), edges, jumps, coverage }
}

/// Coverage of each cell, from the outside in. Edges in sweep order reach every cell from one that is known: the
/// leftmost edge below a cell starts between known ones.
fn cover(edges: &[SubEdge], jumps: &[Jump], count: usize) -> Vec<Vec<(u32, i32)>> {
    let mut coverage: Vec<Option<Vec<(u32, i32)>>> = vec![None; count];
    coverage[0] = Some(Vec::new());
    for edge in edges {
        if coverage[edge.above as usize].is_none() {
            let below = coverage[edge.below as usize].as_ref().expect("the cell below started before");
            coverage[edge.above as usize] =
                Some(after_jumps(below, &jumps[edge.jumps[0] as usize..edge.jumps[1] as usize]));
        }
    }
    coverage.into_iter().map(|cell| cell.expect("every cell lies above an edge")).collect()
}

fn after_jumps(below: &[(u32, i32)], jumps: &[Jump]) -> Vec<(u32, i32)> {
    let mut cover = below.to_vec();
    for jump in jumps {
        match cover.binary_search_by_key(&jump.operand, |&(operand, _)| operand) {
            Ok(at) => cover[at].1 += jump.amount,
            Err(at) => cover.insert(at, (jump.operand, jump.amount)),
        }
    }
    cover.retain(|&(_, amount)| amount != 0);
    cover
}
