use super::topology::sorted_half_edges;
use super::{Mesh, Topology};

/// How many of each kind of defect a mesh has.
///
/// A report of counts is more use than a refusal: a broken mesh is still worth describing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Defects {
    /// Positions with a coordinate that is NaN or infinite.
    pub non_finite_positions: usize,
    /// Triangles with an index past the end of the positions; they are left out of all other counts.
    pub indices_out_of_range: usize,
    /// Triangles that name one vertex twice; they are left out of the counts of edges.
    pub repeated_corners: usize,
    /// Triangles that name the same three vertices as an earlier one, whatever their order.
    pub duplicate_triangles: usize,
    /// Edges of one triangle only.
    pub open_edges: usize,
    /// Edges of two triangles that run along it the same way: one of them is inside out.
    pub misoriented_edges: usize,
    /// Edges of three or more triangles.
    pub non_manifold_edges: usize,
    /// Edges along which unequal numbers of triangles run each way; the mesh is closed when there is none.
    pub unbalanced_edges: usize,
    /// Vertices where separate fans of triangles meet.
    pub non_manifold_vertices: usize,
    /// Positions that no triangle uses.
    pub unused_positions: usize,
}

impl Defects {
    /// Counts the defects of `mesh`.
    pub fn of(mesh: &Mesh) -> Defects {
        let mut defects = Defects {
            non_finite_positions: mesh.positions.iter().filter(|p| !p.is_finite()).count(),
            ..Defects::default()
        };
        let triangles = defects.sort_out_triangles(mesh);
        defects.count_edges(&triangles);
        defects.count_vertices(mesh.positions.len(), &triangles);
        defects
    }

    /// Whether the mesh keeps the promises of [`Solid`](super::Solid) as it stands. Separate fans that share a
    /// vertex are no obstacle: they are given a copy each.
    pub fn is_solid(&self) -> bool {
        self.is_closed() && self.misoriented_edges == 0 && self.non_manifold_edges == 0
    }

    /// Whether the mesh bounds a volume as a chain: finite, and every edge has as many triangles running along it
    /// one way as the other. More than two triangles may meet at an edge.
    pub fn is_closed(&self) -> bool {
        self.non_finite_positions == 0
            && self.indices_out_of_range == 0
            && self.repeated_corners == 0
            && self.unbalanced_edges == 0
    }

    /// The counts with their names, in order, for printing.
    pub fn rows(&self) -> [(&'static str, usize); 10] {
        [
            ("non-finite positions", self.non_finite_positions),
            ("indices out of range", self.indices_out_of_range),
            ("triangles with a repeated corner", self.repeated_corners),
            ("duplicate triangles", self.duplicate_triangles),
            ("open edges", self.open_edges),
            ("misoriented edges", self.misoriented_edges),
            ("non-manifold edges", self.non_manifold_edges),
            ("unbalanced edges", self.unbalanced_edges),
            ("non-manifold vertices", self.non_manifold_vertices),
            ("unused positions", self.unused_positions),
        ]
    }

    /// The triangles whose edges can be counted.
    fn sort_out_triangles(&mut self, mesh: &Mesh) -> Vec<[u32; 3]> {
        let count = mesh.positions.len();
        let mut kept = Vec::with_capacity(mesh.triangles.len());
        for &triangle in &mesh.triangles {
            let [a, b, c] = triangle;
            if triangle.iter().any(|&v| v as usize >= count) {
                self.indices_out_of_range += 1;
            } else if a == b || b == c || c == a {
                self.repeated_corners += 1;
            } else {
                kept.push(triangle);
            }
        }
        let mut keys: Vec<[u32; 3]> = kept.clone();
        keys.iter_mut().for_each(|key| key.sort_unstable());
        keys.sort_unstable();
        self.duplicate_triangles = keys.windows(2).filter(|pair| pair[0] == pair[1]).count();
        kept
    }

    fn count_edges(&mut self, triangles: &[[u32; 3]]) {
        for group in sorted_half_edges(triangles).chunk_by(|a, b| a.edge() == b.edge()) {
            let backward = group.iter().filter(|h| h.reversed).count();
            match (group.len(), backward) {
                (1, _) => self.open_edges += 1,
                (2, 1) => {}
                (2, _) => self.misoriented_edges += 1,
                _ => self.non_manifold_edges += 1,
            }
            if 2 * backward != group.len() {
                self.unbalanced_edges += 1;
            }
        }
    }

    fn count_vertices(&mut self, count: usize, triangles: &[[u32; 3]]) {
        let topology = Topology::new(triangles);
        let (fans, fan_count) = fans(topology.twins());
        let mut seen = vec![false; fan_count as usize];
        let mut fans_at = vec![0_usize; count];
        for (&vertex, fan) in triangles.iter().flatten().zip(fans) {
            if !std::mem::replace(&mut seen[fan as usize], true) {
                fans_at[vertex as usize] += 1;
            }
        }
        self.non_manifold_vertices = fans_at.iter().filter(|&&n| n > 1).count();
        self.unused_positions = fans_at.iter().filter(|&&n| n == 0).count();
    }
}

/// For each corner, the number of its fan, and how many fans there are. Two corners at one vertex are in one fan when a
/// chain of twins leads from one to the other; `twins` names the twin of each half-edge or [`Topology::NONE`].
pub(crate) fn fans(twins: &[u32]) -> (Vec<u32>, u32) {
    const UNSEEN: u32 = u32::MAX;
    let mut fans = vec![UNSEEN; twins.len()];
    let mut count = 0;
    for first in 0..twins.len() as u32 {
        if fans[first as usize] != UNSEEN {
            continue;
        }
        // Around the vertex one way and, where a border ends that, the other way from the start.
        let mut corner = first;
        loop {
            fans[corner as usize] = count;
            let twin = twins[corner as usize];
            if twin == Topology::NONE {
                break;
            }
            corner = Topology::next(twin);
            if corner == first {
                break;
            }
        }
        let mut corner = twins[Topology::previous(first) as usize];
        while corner != Topology::NONE && fans[corner as usize] == UNSEEN {
            fans[corner as usize] = count;
            corner = twins[Topology::previous(corner) as usize];
        }
        count += 1;
    }
    (fans, count)
}
