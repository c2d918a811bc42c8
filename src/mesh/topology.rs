//! Connectivity of a triangle mesh by half-edges; it has never heard of positions.
//!
//! Half-edge `h` is side `h % 3` of triangle `h / 3` and runs from corner `h % 3` to the next corner.

/// Twin half-edges of a triangle list.
#[derive(Clone, Debug)]
pub struct Topology {
    twins: Vec<u32>,
}

impl Topology {
    /// Marks a half-edge that has no single twin: a border, or an edge of more than two triangles.
    pub const NONE: u32 = u32::MAX;

    /// Pairs every half-edge with the one that runs the other way. Where an edge has other than one half-edge in
    /// each direction, its half-edges have no twin.
    pub fn new(triangles: &[[u32; 3]]) -> Topology {
        let mut twins = vec![Self::NONE; triangles.len() * 3];
        for group in sorted_half_edges(triangles).chunk_by(|a, b| a.edge() == b.edge()) {
            if let [a, b] = group
                && a.reversed != b.reversed
            {
                twins[a.id as usize] = b.id;
                twins[b.id as usize] = a.id;
            }
        }
        Topology { twins }
    }

    /// The topology with these twins, of half-edges that have been paired already.
    pub(crate) fn of_twins(twins: Vec<u32>) -> Topology {
        Topology { twins }
    }

    /// The half-edge that runs the other way, or [`Topology::NONE`].
    pub fn twin(&self, half_edge: u32) -> u32 {
        self.twins[half_edge as usize]
    }

    /// The twins of all half-edges, [`Topology::NONE`] where there is none.
    pub fn twins(&self) -> &[u32] {
        &self.twins
    }

    /// The half-edge after this one around its triangle.
    pub fn next(half_edge: u32) -> u32 {
        if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
    }

    /// The half-edge before this one around its triangle.
    pub fn previous(half_edge: u32) -> u32 {
        if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
    }

    /// Number of half-edges, three a triangle.
    pub fn len(&self) -> usize {
        self.twins.len()
    }

    /// Whether there is no half-edge.
    pub fn is_empty(&self) -> bool {
        self.twins.is_empty()
    }

    /// Whether every half-edge has its twin.
    pub fn is_closed(&self) -> bool {
        !self.twins.contains(&Self::NONE)
    }
}

/// A half-edge with the edge it lies on, for sorting.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct HalfEdge {
    low: u32,
    high: u32,
    /// Whether it runs from the higher vertex to the lower one.
    pub(super) reversed: bool,
    id: u32,
}

impl HalfEdge {
    /// The undirected edge.
    pub(super) fn edge(&self) -> (u32, u32) {
        (self.low, self.high)
    }
}

/// All half-edges, those of one undirected edge side by side.
pub(super) fn sorted_half_edges(triangles: &[[u32; 3]]) -> Vec<HalfEdge> {
    let half_edge = |h: usize| {
        let triangle = triangles[h / 3];
        let (from, to) = (triangle[h % 3], triangle[(h + 1) % 3]);
        HalfEdge { low: from.min(to), high: from.max(to), reversed: from > to, id: h as u32 }
    };
    let count = 3 * triangles.len();
    let vertices = triangles.iter().flatten().max().map_or(0, |&last| last as usize + 1);
    if vertices > 2 * count {
        // Counting vertices would cost more than the edges do.
        let mut all: Vec<HalfEdge> = (0..count).map(half_edge).collect();
        all.sort_unstable();
        return all;
    }
    // By the lower vertex in one pass of counting, then the few at each vertex by comparing.
    let mut ends = vec![0_u32; vertices + 1];
    (0..count).for_each(|h| ends[half_edge(h).low as usize + 1] += 1);
    for vertex in 0..vertices {
        ends[vertex + 1] += ends[vertex];
    }
    let mut all = vec![HalfEdge { low: 0, high: 0, reversed: false, id: 0 }; count];
    for edge in (0..count).map(half_edge) {
        let next = &mut ends[edge.low as usize];
        all[*next as usize] = edge;
        *next += 1;
    }
    all.chunk_by_mut(|a, b| a.low == b.low).for_each(<[HalfEdge]>::sort_unstable);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_edges_are_sorted_however_large_the_indices() {
        let triangles = [[7, 3, 1], [1, 3, 2], [3, 7, 2], [7, 1, 2], [1, 3, 7]];
        let far = triangles.map(|t| t.map(|v: u32| v * 100_000_000));
        for all in [sorted_half_edges(&triangles), sorted_half_edges(&far)] {
            assert!(all.is_sorted());
            assert_eq!(all.len(), 15);
        }
        assert_eq!(Topology::new(&triangles).twins(), Topology::new(&far).twins());
    }
}
