//! One piece: rows, then better triangles where some fail.

use super::check::PLACES;
use super::edge::Edges;
use super::frame::{Frame, Local, Node};
use super::layout::{Layout, Piece};
use super::refine::Refinement;
use super::table::Table;
use super::{Care, SurfaceOptions, TessellationError, check};
use crate::math::Vec3;
use crate::surface::{Side, Surface};

/// A tessellated piece.
pub(super) struct Made {
    /// Of inner vertices.
    pub(super) positions: Vec<Vec3>,
    /// Vertices; the inner ones of the piece follow those of edges.
    pub(super) triangles: Vec<[Vertex; 3]>,
    pub(super) parameters: Vec<[[f64; 2]; 3]>,
    /// Largest proven distance, where it is one.
    pub(super) bound: Option<f64>,
    /// Largest distance found.
    pub(super) measured: f64,
}

/// A vertex of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Vertex {
    /// Of an edge, numbered over all.
    Shared(u32),
    /// Of this piece.
    Inner(u32),
}

impl Vertex {
    /// The number in the mesh, where the inner vertices of the piece begin at `base`.
    pub(super) fn resolved(self, base: u32) -> u32 {
        match self {
            Vertex::Shared(id) => id,
            Vertex::Inner(id) => base + id,
        }
    }
}

/// Segments are laid out as long as right triangles allow. Staggered ones would allow more, but rows of different counts
/// do not stagger everywhere, and what fails is split.
const STRETCH: f64 = 1.0;

pub(super) fn tessellate(
    layout: &Layout<'_>,
    piece: &Piece,
    edges: &Edges,
    options: &SurfaceOptions,
    care: Care,
    room: u64,
) -> Result<Made, TessellationError> {
    let surface = layout.surfaces[piece.surface];
    let table = Table::new(piece.surface, surface, piece.domain, options)?;
    let (nodes, sides) = border(layout, piece, edges);
    let same = |a: usize, b: usize| {
        let edge = piece.edges[a].edge;
        edge == piece.edges[b].edge && !layout.edges[edge].pole
    };
    let glued = [same(2, 3), same(0, 1)];
    let frame = Frame { table: &table, domain: piece.domain, nodes, sides, glued, stretch: STRETCH };
    let expected = 2.0 * frame.estimate(0).min(frame.estimate(1));
    if expected > room as f64 || expected.is_nan() {
        let triangles = if expected.is_finite() { expected as u64 } else { u64::MAX };
        return Err(TessellationError::TooLarge { triangles, most: room });
    }
    let (triangles, nodes) = frame.fill();
    let positions = nodes.iter().map(|node| match node.shared {
        Some(id) => edges.positions[id as usize],
        None => surface.point(node.at[0], node.at[1]),
    });
    let positions = positions.collect();
    let mut refinement = Refinement::new(surface, &table, nodes, positions, triangles);
    refinement.run(care, room).map_err(|error| error.of(piece.surface))?;
    Ok(finish(surface, &table, &refinement))
}

/// The vertices of the sides, and each side from its smaller parameter on. Corners are one vertex for both of their
/// sides; the two sides of a seam have different vertices here, since their parameters differ.
fn border(layout: &Layout<'_>, piece: &Piece, edges: &Edges) -> (Vec<Node>, [Vec<Local>; 4]) {
    let mut nodes: Vec<Node> = Vec::new();
    let sides = Side::ALL.map(|side| {
        let used = piece.edges[side as usize];
        let free = layout.edges[used.edge].pole.then_some(side.axis());
        let vertices = edges.side(layout, used, piece.domain[side.axis()]);
        let node = |&(id, t): &(u32, f64)| Node { shared: Some(id), at: side.at(piece.domain, t), free };
        let first = nodes.len() as Local;
        nodes.extend(vertices.iter().map(node));
        (first..nodes.len() as Local).collect::<Vec<Local>>()
    });
    let [mut bottom, mut top, mut left, mut right] = sides;
    let is_pole = |side: Side| layout.edges[piece.edges[side as usize].edge].pole;
    // Left and right begin and end where bottom and top do; one that is a pole takes their corners along.
    for (side, line, place) in [(Side::Left, &mut left, 0), (Side::Right, &mut right, 1)] {
        let [low, high] = [&mut bottom, &mut top].map(|end| {
            let at = if place == 0 { 0 } else { end.len() - 1 };
            &mut end[at]
        });
        if is_pole(side) {
            (*low, *high) = (line[0], line[0]);
        } else {
            let last = line.len() - 1;
            (line[0], line[last]) = (*low, *high);
        }
    }
    (nodes, [bottom, top, left, right])
}

fn finish(surface: &dyn Surface, table: &Table, refinement: &Refinement<'_>) -> Made {
    let mut inner = vec![0; refinement.nodes.len()];
    let mut positions = Vec::new();
    for (local, node) in refinement.nodes.iter().enumerate() {
        if node.shared.is_none() {
            inner[local] = positions.len() as u32;
            positions.push(refinement.positions[local]);
        }
    }
    let vertex = |local: Local| match refinement.nodes[local as usize].shared {
        Some(id) => Vertex::Shared(id),
        None => Vertex::Inner(inner[local as usize]),
    };
    let mut made = Made {
        positions,
        triangles: Vec::new(),
        parameters: Vec::new(),
        bound: table.proven.then_some(0.0),
        measured: 0.0,
    };
    let mut corners = Vec::with_capacity(refinement.triangles.len());
    for (&triangle, ratio) in refinement.triangles.iter().zip(&refinement.ratios) {
        let vertices = triangle.map(vertex);
        if vertices[0] == vertices[1] || vertices[1] == vertices[2] || vertices[2] == vertices[0] {
            continue;
        }
        let parameters = refinement.parameters(triangle);
        let bound = ratio * table.tolerance(&parameters);
        made.bound = made.bound.map(|most| most.max(bound));
        made.triangles.push(vertices);
        made.parameters.push(parameters);
        corners.push(refinement.corners(triangle));
    }
    made.measured = if table.proven {
        let found = check::distances(surface, &PLACES, &made.parameters, &corners, |_| 0.0);
        found.chunks(PLACES.len()).enumerate().fold(0.0, |known: f64, (t, found)| {
            check::measure(surface, &PLACES, &made.parameters[t], corners[t], found, known)
        })
    } else {
        refinement.distance()
    };
    made
}
