//! Where the surface passes edges and faces of the tetrahedra. What is found depends on the edge or the face alone,
//! so that all tetrahedra around it agree.

use super::lattice::{Map, Nodes};
use super::near::is_near;
use crate::math::{Aabb, Vec3};
use crate::sdf::Field;

/// Vertices stay this part of an edge away from its ends. No triangle is then without area, and rounding, some
/// 2^-50, does not turn any over.
pub(super) const CLEARANCE: f64 = 1.0 / 16384.0;

/// Least barycentric coordinate of points within faces and tetrahedra.
pub(super) const MARGIN: f64 = 1.0 / 64.0;

/// Normals closer than this (30 degrees) are taken for those of one smooth sheet.
pub(super) const SMOOTH: f64 = 0.866;

/// An edge by its nodes, the lower first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Edge(u64);

impl Edge {
    pub(super) fn between(a: u32, b: u32) -> Edge {
        Edge(u64::from(a.min(b)) << 32 | u64::from(a.max(b)))
    }

    pub(super) fn nodes(self) -> [u32; 2] {
        [(self.0 >> 32) as u32, self.0 as u32]
    }
}

/// A face by its nodes in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Face(u64, u32);

impl Face {
    pub(super) fn of(mut nodes: [u32; 3]) -> Face {
        nodes.sort_unstable();
        Face(u64::from(nodes[0]) << 32 | u64::from(nodes[1]), nodes[2])
    }

    fn nodes(self) -> [u32; 3] {
        [(self.0 >> 32) as u32, self.0 as u32, self.1]
    }

    /// Its two edges that the surface passes.
    pub(super) fn crossed_edges(self, nodes: &Nodes) -> [Edge; 2] {
        let ids = self.nodes();
        let lone = lone(ids.map(|id| nodes.is_inside(id))).unwrap_or(0);
        [Edge::between(ids[lone], ids[(lone + 1) % 3]), Edge::between(ids[lone], ids[(lone + 2) % 3])]
    }
}

/// Which of three signs differs from the other two.
pub(super) fn lone(inside: [bool; 3]) -> Option<usize> {
    (0..3).find(|&i| inside[i] != inside[(i + 1) % 3] && inside[i] != inside[(i + 2) % 3])
}

/// Where the surface passes an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeCut {
    pub(super) point: Vec3,
    /// The direction of the gradient there; zero where there is none.
    pub(super) normal: Vec3,
    /// The sign changes without a zero.
    pub(super) jump: bool,
}

/// How the surface passes a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FaceCut {
    /// The segment between its edges' points is near enough to it.
    Straight,
    /// The surface is creased: two segments over this point are near enough.
    Creased(Vec3),
    /// Neither is.
    Torn,
}

/// All that has been found so far.
#[derive(Default)]
pub(super) struct Cuts {
    pub(super) edges: Map<Edge, EdgeCut>,
    pub(super) faces: Map<Face, FaceCut>,
}

/// The point where the surface passes an edge, found to within `accuracy`.
pub(super) fn cut_edge(field: &dyn Field, edge: Edge, nodes: &Nodes, accuracy: f64) -> EdgeCut {
    let [a, b] = edge.nodes();
    let (p, q) = (nodes.position(a), nodes.position(b));
    let ends = [nodes.values[a as usize], nodes.values[b as usize]];
    let slack = (accuracy / p.distance(q)).clamp(1e-12, 0.125);
    let along = |t: f64| p + (q - p) * t;
    let bracket = bracket(|t| field.value(along(t)), ends, slack);
    let [low, high] = bracket.ends;
    let nearer = if bracket.values[1].abs() < bracket.values[0].abs() { high } else { low };
    let t = nearer.clamp(CLEARANCE, 1.0 - CLEARANCE);
    let point = along(t);
    let steep = (bracket.values[0] - bracket.values[1]).abs() >= 0.5 * (ends[0] - ends[1]).abs();
    let jump = steep && bracket.values.iter().all(|v| v.is_finite()) && {
        let cell = Aabb::of([along(low), along(high)]);
        !field.range(cell).is_some_and(|range| range.continuous)
    };
    let gradient = field.gradient(point).1;
    let normal = if gradient.is_finite() { gradient.normalize_or_zero() } else { Vec3::ZERO };
    EdgeCut { point, normal, jump }
}

/// An interval in which the sign changes, and the values at its ends.
struct Bracket {
    ends: [f64; 2],
    values: [f64; 2],
}

/// Regula falsi with Illinois steps (Dowell, Jarratt 1971) until the sign change is within `slack`; where four steps
/// did not halve the interval, it is halved. A secant's point next to an end is moved past the zero, so that the
/// interval closes from both sides.
fn bracket(f: impl Fn(f64) -> f64, values: [f64; 2], slack: f64) -> Bracket {
    let mut found = Bracket { ends: [0.0, 1.0], values };
    let mut weights = values;
    let inside = values[0] < 0.0;
    let mut last_width = 1.0;
    for step in 1..200 {
        let [low, high] = found.ends;
        let width = high - low;
        if width <= slack || found.values.contains(&0.0) {
            break;
        }
        let secant = low + width * (weights[0] / (weights[0] - weights[1]));
        let halve = !secant.is_finite() || (step % 4 == 0 && width > 0.5 * last_width);
        if step % 4 == 0 {
            last_width = width;
        }
        let reach = 0.45 * slack;
        let t = if halve { 0.5 * (low + high) } else { secant.clamp(low + reach, high - reach) };
        let value = f(t);
        let end = usize::from((value < 0.0) != inside);
        found.ends[end] = t;
        found.values[end] = value;
        weights[end] = value;
        weights[1 - end] *= 0.5;
    }
    found
}

/// How the surface passes a face whose edges have been cut.
pub(super) fn cut_face(
    field: &dyn Field,
    face: Face,
    nodes: &Nodes,
    edges: &Map<Edge, EdgeCut>,
    reach: f64,
) -> FaceCut {
    let [a, b] = face.crossed_edges(nodes).map(|edge| edges[&edge]);
    let [p, q] = [a.point, b.point];
    let near = |x: Vec3, normal: Vec3| is_near(field, x, normal, reach);
    if near(0.5 * (p + q), a.normal) {
        return FaceCut::Straight;
    }
    if a.normal.dot(b.normal) > SMOOTH {
        return FaceCut::Torn;
    }
    let corners = face.nodes().map(|id| nodes.position(id));
    match crease(&a, &b, corners) {
        Some(x)
            if [(x, a), (0.5 * (x + p), a), (0.5 * (x + q), b)].iter().all(|&(x, of)| near(x, of.normal)) =>
        {
            FaceCut::Creased(x)
        }
        _ => FaceCut::Torn,
    }
}

/// Where the tangent planes at both points meet in the plane of the face, when that is well within it.
fn crease(a: &EdgeCut, b: &EdgeCut, corners: [Vec3; 3]) -> Option<Vec3> {
    let [u, v] = [corners[1] - corners[0], corners[2] - corners[0]];
    let across = u.cross(v);
    let along = across.cross(a.normal).normalize_or_zero();
    let steepness = b.normal.dot(along);
    // Planes that hardly meet say nothing.
    if steepness.abs() < 0.02 {
        return None;
    }
    let x = a.point + along * (b.normal.dot(b.point - a.point) / steepness);
    let share = |p: Vec3, q: Vec3| p.cross(q).dot(across) / across.length_squared();
    let (s, t) = (share(x - corners[0], v), share(u, x - corners[0]));
    let least = s.min(t).min(1.0 - s - t);
    (least >= MARGIN).then_some(x)
}
