//! Solids from points and faces.

use super::primitive::{paths, vectors};
use super::{Builtin, module_row};
use crate::csg::{Body, Csg};
use crate::math::{Vec2, Vec3};
use crate::mesh::Mesh;
use crate::script::Failure;
use crate::script::eval::{Invocation, Machine, Made};
use std::collections::BTreeMap;
use std::collections::HashMap;
use std::sync::Arc;

pub(super) const TABLE: &[Builtin] = &[module_row(
    "polyhedron",
    &["points", "faces", "convexity", "triangles"],
    3,
    "A solid from points and faces; each face lists its points clockwise seen from outside.",
    polyhedron,
)];

fn polyhedron<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let points = call.arguments.get("points").cloned();
    let faces = call.arguments.get("faces").or_else(|| call.arguments.get("triangles")).cloned();
    let (Some(points), Some(faces)) = (points, faces) else {
        machine.warn(call.span, "a polyhedron needs points and faces");
        return Ok(machine.nothing());
    };
    let Some(points): Option<Vec<[f64; 3]>> = vectors(machine, call, "points", &points)? else {
        return Ok(machine.nothing());
    };
    let Some(faces) = paths(machine, call, "faces", &faces, points.len())? else {
        return Ok(machine.nothing());
    };
    let points: Vec<Vec3> = points.into_iter().map(Vec3::from_array).collect();
    let merged = merged_indices(&points);
    let faces: Vec<Vec<u32>> = faces.iter().map(|face| outline(face, &merged)).collect();
    if let Some(defect) = open_edge(&faces) {
        return Err(machine.error(call.span, defect.text(&points)));
    }
    let triangles = faces.iter().flat_map(|face| triangulate(face, &points)).collect();
    let mut mesh = Mesh::new(points, triangles);
    if mesh.is_empty() {
        machine.warn(call.span, "the polyhedron has no faces");
        return Ok(machine.nothing());
    }
    if volume_sign(&mesh) < 0.0 {
        machine.warn(
            call.span,
            "the polyhedron is inside out and has been turned; faces run clockwise seen from outside",
        );
        mesh = mesh.flipped();
    }
    machine.leaf(Csg::Body(Body::Mesh(Arc::new(mesh))), call.span)
}

/// For each point the first one at the same place.
fn merged_indices(points: &[Vec3]) -> Vec<u32> {
    let mut first: HashMap<[u64; 3], u32> = HashMap::new();
    let place = |p: &Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
    points.iter().enumerate().map(|(index, p)| *first.entry(place(p)).or_insert(index as u32)).collect()
}

/// The face counter-clockwise seen from outside, each place once in a row; empty when fewer than three are left.
fn outline(face: &[u32], merged: &[u32]) -> Vec<u32> {
    let mut outline: Vec<u32> = face.iter().rev().map(|&index| merged[index as usize]).collect();
    outline.dedup();
    while outline.len() > 1 && outline.first() == outline.last() {
        outline.pop();
    }
    if outline.len() < 3 { Vec::new() } else { outline }
}

/// An edge along which faces do not run both ways equally often.
struct OpenEdge {
    ends: [u32; 2],
    faces: usize,
}

impl OpenEdge {
    fn text(&self, points: &[Vec3]) -> String {
        let [a, b] = self.ends;
        let at = |index: u32| points[index as usize].to_array().map(crate::script::format::number).join(", ");
        let edge = format!("points {a} [{}] and {b} [{}]", at(a), at(b));
        match self.faces {
            1 => format!("the polyhedron is open: only one face has the edge between {edge}"),
            2 => format!("one face is inside out: two faces run the same way along the edge between {edge}"),
            n => format!(
                "the polyhedron is not closed: {n} faces have the edge between {edge} and do not match"
            ),
        }
    }
}

/// The first edge, by its points, that is not closed.
fn open_edge(faces: &[Vec<u32>]) -> Option<OpenEdge> {
    let mut edges: BTreeMap<[u32; 2], (i64, usize)> = BTreeMap::new();
    for face in faces {
        for (i, &from) in face.iter().enumerate() {
            let to = face[(i + 1) % face.len()];
            let entry = edges.entry([from.min(to), from.max(to)]).or_default();
            entry.0 += if from < to { 1 } else { -1 };
            entry.1 += 1;
        }
    }
    let open = edges.into_iter().find(|(_, (balance, _))| *balance != 0);
    open.map(|(ends, (_, faces))| OpenEdge { ends, faces })
}

/// Six times the volume of the mesh, of which only the sign counts.
fn volume_sign(mesh: &Mesh) -> f64 {
    let origin = mesh.bounds().center();
    let six_volumes = |index| {
        let [a, b, c] = mesh.corners(index).map(|p| p - origin);
        a.dot(b.cross(c))
    };
    (0..mesh.triangles.len()).map(six_volumes).sum()
}

/// The face as triangles, by cutting off ears in its own plane. A face that crosses itself has no more ears at some
/// point; it is cut up all the same, so that the surface stays closed.
fn triangulate(face: &[u32], points: &[Vec3]) -> Vec<[u32; 3]> {
    let flat = projected(face, points);
    let mut left: Vec<usize> = (0..face.len()).collect();
    let mut triangles = Vec::with_capacity(face.len().saturating_sub(2));
    let mut at = 0;
    let mut missed = 0;
    while left.len() > 3 {
        let n = left.len();
        let [a, b, c] = [left[(at + n - 1) % n], left[at % n], left[(at + 1) % n]];
        if missed < n && !is_ear([a, b, c], &left, &flat) {
            at = (at + 1) % n;
            missed += 1;
            continue;
        }
        triangles.push([a, b, c]);
        left.remove(at % n);
        // Two steps on, so that ears are taken from all around and triangles do not get thin.
        at = (at + 1) % left.len();
        missed = 0;
    }
    if let [a, b, c] = left[..] {
        triangles.push([a, b, c]);
    }
    let corners = triangles.into_iter().map(|triangle| triangle.map(|i| face[i]));
    corners.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// The face seen along its normal (Newell), counter-clockwise.
fn projected(face: &[u32], points: &[Vec3]) -> Vec<Vec2> {
    let corners: Vec<Vec3> = face.iter().map(|&i| points[i as usize] - points[face[0] as usize]).collect();
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let normal: Vec3 = corners.iter().enumerate().map(|(i, p)| p.cross(next(i))).sum();
    let [x, y, z] = normal.abs().to_array();
    let flat = |p: &Vec3| {
        if z >= x && z >= y {
            Vec2::new(p.x, p.y * normal.z.signum())
        } else if y >= x {
            Vec2::new(p.z, p.x * normal.y.signum())
        } else {
            Vec2::new(p.y, p.z * normal.x.signum())
        }
    };
    corners.iter().map(flat).collect()
}

/// Whether the corner turns left and no other corner that turns right lies in its triangle.
fn is_ear([a, b, c]: [usize; 3], left: &[usize], flat: &[Vec2]) -> bool {
    let turn = |a: Vec2, b: Vec2, c: Vec2| (b - a).perp_dot(c - a);
    let (p, q, r) = (flat[a], flat[b], flat[c]);
    if turn(p, q, r) <= 0.0 {
        return false;
    }
    let inside = |&i: &usize| {
        let v = flat[i];
        v != p && v != q && v != r && turn(p, q, v) >= 0.0 && turn(q, r, v) >= 0.0 && turn(r, p, v) >= 0.0
    };
    !left.iter().any(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_concave_face_is_filled_and_no_more() {
        // An L in a slanted plane.
        let l = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
        let points: Vec<Vec3> = l.iter().map(|&(x, y)| Vec3::new(x, y, 0.5 * x - y)).collect();
        let face: Vec<u32> = (0..6).collect();
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            (b - a).cross(c - a)
        };
        let triangles = triangulate(&face, &points);
        assert_eq!(triangles.len(), 4);
        assert!(triangles.iter().all(|t| area(t).z > 0.0));
        let total: f64 = triangles.iter().map(|t| 0.5 * area(t).z).sum();
        assert_eq!(total, 5.0);
    }

    #[test]
    fn open_edges_are_named() {
        let check = |faces: &[&[u32]], ends: Option<[u32; 2]>| {
            let faces: Vec<Vec<u32>> = faces.iter().map(|face| face.to_vec()).collect();
            assert_eq!(open_edge(&faces).map(|edge| edge.ends), ends);
        };
        check(&[&[0, 1, 2], &[0, 2, 1]], None);
        check(&[&[0, 1, 2]], Some([0, 1]));
        check(&[&[0, 1, 2], &[0, 1, 2]], Some([0, 1]));
    }
}
