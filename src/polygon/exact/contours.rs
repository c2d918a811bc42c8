//! Boundary edges chained into contours.

use super::{Boundary, Chart, Line, PointId, Points};
use std::cmp::Ordering;

/// For each boundary edge, the one that follows it around the area on its left.
///
/// Where several contours meet at a vertex, each wedge of the area is walked on its own: contours touch there and do not
/// cross. Every vertex must have as many edges coming in as going out.
pub fn followers(chart: &Chart, points: &Points, lines: &[Line], boundary: &[Boundary]) -> Vec<u32> {
    let mut ends: Vec<End> = Vec::with_capacity(2 * boundary.len());
    for (edge, &Boundary { ends: [from, to], line }) in (0_u32..).zip(boundary) {
        let leaves_right = chart.compare(points, from, to) == Ordering::Less;
        ends.push(End { at: from, other: to, edge, line, outgoing: true, rightward: leaves_right });
        ends.push(End { at: to, other: from, edge, line, outgoing: false, rightward: !leaves_right });
    }
    ends.sort_unstable_by_key(|end| (end.at, end.outgoing, end.edge));
    let mut next = vec![0; boundary.len()];
    for fan in ends.chunk_by_mut(|a, b| a.at == b.at) {
        match fan {
            [incoming, outgoing] => next[incoming.edge as usize] = outgoing.edge,
            _ => pair_wedges(points, lines, fan, &mut next),
        }
    }
    next
}

/// One end of a boundary edge.
#[derive(Clone, Copy)]
struct End {
    at: PointId,
    other: PointId,
    edge: u32,
    line: u32,
    outgoing: bool,
    /// Whether the edge lies to the right of this end.
    rightward: bool,
}

/// Joins each incoming edge of a vertex to the first outgoing one clockwise from it: the area lies between them.
fn pair_wedges(points: &Points, lines: &[Line], fan: &mut [End], next: &mut [u32]) {
    fan.sort_by(|a, b| counter_clockwise(points, lines, a, b));
    let count = fan.len();
    for (place, end) in fan.iter().enumerate().filter(|(_, end)| !end.outgoing) {
        let clockwise = (1..=count).map(|step| &fan[(place + count - step) % count]);
        if let Some(follower) = clockwise.into_iter().find(|other| other.outgoing) {
            next[end.edge as usize] = follower.edge;
        }
    }
}

/// Orders ends at one vertex by angle, from straight down.
fn counter_clockwise(points: &Points, lines: &[Line], a: &End, b: &End) -> Ordering {
    b.rightward.cmp(&a.rightward).then_with(|| {
        // Both on one side of the vertex: below comes first on the right, above on the left.
        let order = lines[b.line as usize].side(points, a.other).cmp(&0);
        let order = if a.rightward { order } else { order.reverse() };
        // Two sides of a slit: the area lies clockwise of the one coming in and counter-clockwise of the one going out.
        order.then(a.outgoing.cmp(&b.outgoing))
    })
}
