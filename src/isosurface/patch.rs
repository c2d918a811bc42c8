//! The piece of the mesh in one tetrahedron: a polygon over its faces, flat or pulled to a point within.
//!
//! A polygon drawn on the border of a convex body and joined to a point strictly within it does not cross itself, so
//! the pieces together do not either. Points within come from the tangent planes at the edges, as in Kobbelt, Botsch,
//! Schwanecke, Seidel, Feature sensitive surface extraction from volume data, 2001.

use super::crossing::{Cuts, Edge, EdgeCut, Face, FaceCut, MARGIN, SMOOTH, lone};
use super::lattice::Nodes;
use super::near::is_near;
use super::tetrahedron::{FACES, Tetrahedron};
use crate::math::{Mat3, Vec3};
use crate::sdf::Field;

/// How the polygon of a tetrahedron is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Patch {
    /// The surface does not pass.
    Empty,
    /// By a triangle, or by two on this diagonal: from the first corner or from the second.
    Flat(usize),
    /// By triangles to this point.
    Fan(Vec3),
}

/// A corner of the polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Corner {
    On(Edge),
    In(Face),
}

/// The polygon in which the surface passes the faces, its normal outward.
#[derive(Clone, Copy)]
pub(super) struct Ring {
    corners: [Corner; 8],
    count: usize,
}

impl Ring {
    /// The polygon of a tetrahedron that the surface passes.
    pub(super) fn of(tetrahedron: &Tetrahedron, nodes: &Nodes, cuts: &Cuts) -> Ring {
        let righted = tetrahedron.righted(nodes);
        let sides = FACES.map(|face| side(face.map(|i| righted[i]), nodes));
        let mut at = sides.iter().flatten().next().map_or(Edge::between(0, 0), |side| side.from);
        let mut ring = Ring { corners: [Corner::On(at); 8], count: 0 };
        for _ in sides.iter().flatten() {
            let Some(next) = sides.iter().flatten().find(|side| side.from == at) else { break };
            ring.push(Corner::On(at));
            if matches!(cuts.faces[&next.face], FaceCut::Creased(_)) {
                ring.push(Corner::In(next.face));
            }
            at = next.to;
        }
        ring
    }

    fn push(&mut self, corner: Corner) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners[..self.count]
    }

    fn is_creased(&self) -> bool {
        self.corners().iter().any(|corner| matches!(corner, Corner::In(_)))
    }

    fn edges<'c>(&'c self, cuts: &'c Cuts) -> impl Iterator<Item = &'c EdgeCut> {
        self.corners().iter().filter_map(|corner| match corner {
            Corner::On(edge) => Some(&cuts.edges[edge]),
            Corner::In(_) => None,
        })
    }

    /// The triangles of a flat filling, by places in the ring.
    pub(super) fn flat(&self, diagonal: usize) -> impl Iterator<Item = [usize; 3]> {
        let count = self.count;
        (1..count.saturating_sub(1)).map(move |i| [0, i, i + 1].map(|i| (i + diagonal) % count))
    }
}

/// The directed segment in which the surface passes a face seen from outside; the inside is on its right.
struct Side {
    from: Edge,
    to: Edge,
    face: Face,
}

fn side(ids: [u32; 3], nodes: &Nodes) -> Option<Side> {
    let inside = ids.map(|id| nodes.is_inside(id));
    let lone = lone(inside)?;
    let [a, b, c] = [0, 1, 2].map(|k| ids[(lone + k) % 3]);
    let (ab, ca, face) = (Edge::between(a, b), Edge::between(c, a), Face::of(ids));
    Some(if inside[lone] { Side { from: ca, to: ab, face } } else { Side { from: ab, to: ca, face } })
}

/// Where a corner is.
pub(super) fn place(corner: Corner, cuts: &Cuts) -> Vec3 {
    match corner {
        Corner::On(edge) => cuts.edges[&edge].point,
        Corner::In(face) => match cuts.faces[&face] {
            FaceCut::Creased(point) => point,
            FaceCut::Straight | FaceCut::Torn => Vec3::NAN,
        },
    }
}

/// The filling that is within `reach` of the surface as far as samples tell; `None` when there is none.
pub(super) fn fitting(
    field: &dyn Field,
    tetrahedron: &Tetrahedron,
    nodes: &Nodes,
    cuts: &Cuts,
    reach: f64,
) -> Option<Patch> {
    let is_torn = |face: &[usize; 3]| {
        let face = Face::of(face.map(|i| tetrahedron.nodes[i]));
        cuts.faces.get(&face) == Some(&FaceCut::Torn)
    };
    if FACES.iter().any(is_torn) {
        return None;
    }
    let ring = Ring::of(tetrahedron, nodes, cuts);
    if !ring.is_creased() {
        let fits = |&diagonal: &usize| is_flat(field, &ring, diagonal, cuts, reach);
        if let Some(diagonal) = (0..ring.count - 2).find(fits) {
            return Some(Patch::Flat(diagonal));
        }
    }
    let normals: Vec<Vec3> = ring.edges(cuts).map(|cut| cut.normal).collect();
    let smooth = normals.iter().all(|n| normals.iter().all(|m| n.dot(*m) > SMOOTH));
    if smooth && !ring.is_creased() {
        return None;
    }
    let apex = apex(&ring, tetrahedron, nodes, cuts)?;
    fan_fits(field, &ring, apex, cuts, reach).then_some(Patch::Fan(apex))
}

/// The filling to fall back on when none fits.
pub(super) fn plainest(tetrahedron: &Tetrahedron, nodes: &Nodes, cuts: &Cuts) -> Patch {
    let ring = Ring::of(tetrahedron, nodes, cuts);
    if ring.is_creased() { Patch::Fan(middle(&ring, cuts)) } else { Patch::Flat(0) }
}

fn is_flat(field: &dyn Field, ring: &Ring, diagonal: usize, cuts: &Cuts, reach: f64) -> bool {
    let at = |i: usize| place(ring.corners()[i], cuts);
    let near = |[a, b, c]: [Vec3; 3]| {
        is_near(field, (a + b + c) / 3.0, (b - a).cross(c - a).normalize_or_zero(), reach)
    };
    if !ring.flat(diagonal).all(|triangle| near(triangle.map(at))) {
        return false;
    }
    let [p, q] = [at(diagonal), at((diagonal + 2) % ring.count)];
    ring.count < 4 || near([p, 0.5 * (p + q), q])
}

fn fan_fits(field: &dyn Field, ring: &Ring, apex: Vec3, cuts: &Cuts, reach: f64) -> bool {
    let corners = ring.corners();
    let at = |i: usize| place(corners[i % corners.len()], cuts);
    let normal = |i: usize| (at(i + 1) - at(i)).cross(apex - at(i)).normalize_or_zero();
    (0..corners.len()).all(|i| {
        is_near(field, (at(i) + at(i + 1) + apex) / 3.0, normal(i), reach)
            && is_near(field, 0.5 * (at(i) + apex), normal(i), reach)
    }) && is_near(field, apex, normal(0), reach)
}

/// A point strictly within the tetrahedron: the mean of the corners.
fn middle(ring: &Ring, cuts: &Cuts) -> Vec3 {
    let sum: Vec3 = ring.corners().iter().map(|&corner| place(corner, cuts)).sum();
    sum / ring.count as f64
}

/// The point nearest to all tangent planes, and among those to the creases; `None` when it is not well within the
/// tetrahedron.
fn apex(ring: &Ring, tetrahedron: &Tetrahedron, nodes: &Nodes, cuts: &Cuts) -> Option<Vec3> {
    let creases = ring.corners().iter().filter(|corner| matches!(corner, Corner::In(_)));
    let creases: Vec<Vec3> = creases.map(|&corner| place(corner, cuts)).collect();
    let base = match creases.len() {
        0 => middle(ring, cuts),
        count => creases.iter().sum::<Vec3>() / count as f64,
    };
    let x =
        base + nearest_to_planes(ring.edges(cuts).map(|cut| (cut.normal, cut.normal.dot(cut.point - base))));
    let [a, b, c, d] = tetrahedron.corners(nodes);
    let frame = Mat3::from_cols(b - a, c - a, d - a);
    let least = |x: Vec3| {
        let share = frame.inverse() * (x - a);
        share.min_element().min(1.0 - share.element_sum())
    };
    [x, base].into_iter().find(|&x| least(x) >= MARGIN)
}

/// The shortest vector x with the least sum of squares (n . x - offset)^2; directions in which the planes hardly
/// differ are left out.
fn nearest_to_planes(planes: impl Iterator<Item = (Vec3, f64)>) -> Vec3 {
    let (mut matrix, mut right) = ([[0.0; 3]; 3], Vec3::ZERO);
    for (n, offset) in planes {
        right += n * offset;
        for (i, row) in matrix.iter_mut().enumerate() {
            (0..3).for_each(|j| row[j] += n[i] * n[j]);
        }
    }
    let (values, vectors) = eigen(matrix);
    let most = values.into_iter().fold(0.0, f64::max);
    // Planes within some 15 degrees of each other do not fix a direction.
    let used = (0..3).filter(|&i| values[i] > 0.03 * most && values[i] > 0.0);
    used.map(|i| vectors[i] * (vectors[i].dot(right) / values[i])).sum()
}

/// Eigenvalues and vectors of a symmetric matrix, by Jacobi's rotations (1846).
fn eigen(mut s: [[f64; 3]; 3]) -> ([f64; 3], [Vec3; 3]) {
    let mut vectors = [Vec3::X, Vec3::Y, Vec3::Z];
    // Convergence is quadratic; five sweeps are enough for any matrix of three rows.
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(15) {
        if s[p][q] == 0.0 {
            continue;
        }
        let slope = (s[q][q] - s[p][p]) / (2.0 * s[p][q]);
        let t = slope.signum() / (slope.abs() + (slope * slope + 1.0).sqrt());
        let cosine = 1.0 / (t * t + 1.0).sqrt();
        let sine = t * cosine;
        for row in &mut s {
            (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
        }
        let (above, below) = (s[p], s[q]);
        s[p] = [0, 1, 2].map(|k| cosine * above[k] - sine * below[k]);
        s[q] = [0, 1, 2].map(|k| sine * above[k] + cosine * below[k]);
        let (u, v) = (vectors[p], vectors[q]);
        (vectors[p], vectors[q]) = (cosine * u - sine * v, sine * u + cosine * v);
    }
    ([s[0][0], s[1][1], s[2][2]], vectors)
}
