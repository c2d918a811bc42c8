//! A checker of meshes that trusts nobody: connectivity counted afresh, volume on integers, crossings by exact
//! predicates.

pub(crate) mod crossing;
mod pairs;

use crate::oracle::exact::{Int, Lattice, cross, dot};
use crate::oracle::surface::Union;
use crate::oracle::{Truth, rounded};
use dashu_ratio::RBig;
use ogee::math::Vec3;
use ogee::mesh::{Defects, Mesh};
use std::collections::HashMap;

/// What a mesh is, by index and by position.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    /// What keeps it from being a closed manifold; all else is empty then.
    pub(crate) faults: Vec<String>,
    pub(crate) volume: RBig,
    pub(crate) area: f64,
    /// For each component its Euler number and volume.
    pub(crate) components: Vec<(i64, RBig)>,
}

impl Shape {
    pub(crate) fn of(mesh: &Mesh) -> Shape {
        let faults = faults(mesh);
        if !faults.is_empty() {
            return Shape { faults, ..Shape::default() };
        }
        let components = components(mesh);
        let volume = components.iter().fold(RBig::ZERO, |total, (_, volume)| total + volume);
        let area = |i: usize| {
            let [a, b, c] = mesh.corners(i);
            0.5 * (b - a).cross(c - a).length()
        };
        Shape { faults, volume, area: (0..mesh.triangles.len()).map(area).sum(), components }
    }

    /// Handles and tunnels, summed over the components.
    pub(crate) fn genus(&self) -> i64 {
        self.components.iter().map(|(euler, _)| 1 - euler / 2).sum()
    }

    pub(crate) fn volume_f64(&self) -> f64 {
        self.volume.to_f64().value()
    }
}

/// Everything in which a result differs from the truth about it. `inputs` are positions that results may keep,
/// though they are no corners.
pub(crate) fn disagreements(truth: &Truth, mesh: &Mesh, inputs: &[&Mesh]) -> Vec<String> {
    let shape = Shape::of(mesh);
    if !shape.faults.is_empty() {
        return shape.faults;
    }
    let mut found = Vec::new();
    if !Defects::of(mesh).is_solid() {
        found.push(format!("not a solid: {:?}", Defects::of(mesh)));
    }
    if truth.is_representable() && strays(truth, mesh, inputs).is_empty() && shape.volume != truth.volume {
        found.push(format!("volume {} is not exactly {}", shape.volume, truth.volume));
    }
    let slack = 1e-12 * truth.volume_f64().abs() + 4.0 * rounding(truth) * truth.area;
    if (shape.volume.clone() - &truth.volume).to_f64().value().abs() > slack {
        found.push(format!("volume {} instead of {}", shape.volume_f64(), truth.volume_f64()));
    }
    let ours = sorted(shape.components.iter().map(|(euler, volume)| (*euler, volume)));
    let theirs = sorted(truth.components.iter().map(|c| (c.euler, &c.volume)));
    let eulers = |list: &[(i64, f64)]| list.iter().map(|c| c.0).collect::<Vec<_>>();
    if eulers(&ours) != eulers(&theirs) {
        found.push(format!("Euler numbers {:?} instead of {:?}", eulers(&ours), eulers(&theirs)));
    } else if ours.iter().zip(&theirs).any(|(a, b)| (a.1 - b.1).abs() > slack) {
        found.push(format!("components {ours:?} instead of {theirs:?}"));
    }
    found.extend(misplaced(truth, mesh, inputs));
    found
}

/// Vertices where no planes meet and no operand has a vertex. On an edge they do no harm, but nothing asks for them
/// either, except where wedges touch along it and need to be told apart.
pub(crate) fn strays(truth: &Truth, mesh: &Mesh, inputs: &[&Mesh]) -> Vec<Vec3> {
    let reach = rounding(truth);
    let points: Vec<Vec3> = truth.points.iter().map(|(p, _)| rounded(p)).collect();
    let known =
        |p: Vec3| near(p, &points, reach) || inputs.iter().any(|input| near(p, &input.positions, reach));
    mesh.positions.iter().copied().filter(|&p| !known(p)).collect()
}

fn near(p: Vec3, list: &[Vec3], reach: f64) -> bool {
    list.iter().any(|&q| (p - q).abs().max_element() <= reach)
}

/// Half a unit in the last place of the largest coordinate, doubled: how far rounding may move a point.
fn rounding(truth: &Truth) -> f64 {
    let largest = truth.points.iter().map(|(p, _)| rounded(p).abs().max_element()).fold(0.0, f64::max);
    largest * f64::EPSILON
}

fn sorted<'a>(components: impl Iterator<Item = (i64, &'a RBig)>) -> Vec<(i64, f64)> {
    let mut list: Vec<(i64, f64)> = components.map(|(euler, v)| (euler, v.to_f64().value())).collect();
    list.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    list
}

/// Vertices on no true edge, and true corners at which there is no vertex.
fn misplaced(truth: &Truth, mesh: &Mesh, inputs: &[&Mesh]) -> Vec<String> {
    let reach = rounding(truth);
    let off_edges = strays(truth, mesh, inputs)
        .into_iter()
        .filter(|&p| truth.edges.iter().all(|edge| distance(p, edge) > 4.0 * reach));
    let mut found: Vec<String> = off_edges.map(|p| format!("a vertex at {p} where nothing meets")).collect();
    let corners = truth.points.iter().filter(|(_, corner)| *corner).map(|(point, _)| rounded(point));
    let missing = corners.filter(|&point| !near(point, &mesh.positions, reach));
    found.extend(missing.map(|point| format!("no vertex at the corner {point}")));
    found
}

/// From a point to a segment.
fn distance(p: Vec3, [a, b]: &[Vec3; 2]) -> f64 {
    let along = *b - *a;
    let t = ((p - *a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (p - (*a + t * along)).length()
}

/// What keeps the mesh from being a closed manifold by index.
fn faults(mesh: &Mesh) -> Vec<String> {
    let mut found = Vec::new();
    let count = mesh.positions.len();
    if mesh.positions.iter().any(|p| !p.is_finite()) {
        found.push("a position that is not finite".to_owned());
    }
    if mesh.triangles.iter().any(|t| t.iter().any(|&v| v as usize >= count)) {
        found.push("an index out of range".to_owned());
        return found;
    }
    if mesh.triangles.iter().any(|[a, b, c]| a == b || b == c || c == a) {
        found.push("a triangle with a repeated corner".to_owned());
    }
    let sides = sides(mesh);
    let crowded = sides.values().filter(|list| list.len() > 1).count();
    let lonely = sides.keys().filter(|(a, b)| !sides.contains_key(&(*b, *a))).count();
    if crowded + lonely > 0 {
        found.push(format!("{crowded} sides run twice the same way, {lonely} sides have no twin"));
    } else {
        found.extend(vertex_faults(mesh, &sides));
    }
    found
}

type Sides = HashMap<(u32, u32), Vec<usize>>;

/// For each directed side the triangles it belongs to.
fn sides(mesh: &Mesh) -> Sides {
    let mut sides: Sides = HashMap::new();
    for (index, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        for side in [(a, b), (b, c), (c, a)] {
            sides.entry(side).or_default().push(index);
        }
    }
    sides
}

/// Walks once around each vertex: a manifold one has all its triangles in one round.
fn vertex_faults(mesh: &Mesh, sides: &Sides) -> Vec<String> {
    let mut degree = vec![0; mesh.positions.len()];
    let mut some_triangle = vec![usize::MAX; mesh.positions.len()];
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        for &v in triangle {
            degree[v as usize] += 1;
            some_triangle[v as usize] = index;
        }
    }
    let (mut unused, mut pinched) = (0, 0);
    for vertex in 0..mesh.positions.len() as u32 {
        let start = some_triangle[vertex as usize];
        if start == usize::MAX {
            unused += 1;
            continue;
        }
        let (mut triangle, mut steps) = (start, 0);
        loop {
            let corners = mesh.triangles[triangle];
            let place = corners.iter().position(|&v| v == vertex).expect("a triangle at the vertex");
            triangle = sides[&(vertex, corners[(place + 2) % 3])][0];
            steps += 1;
            if triangle == start || steps > degree[vertex as usize] {
                break;
            }
        }
        pinched += usize::from(steps != degree[vertex as usize]);
    }
    let mut found = Vec::new();
    if unused + pinched > 0 {
        found.push(format!("{unused} unused positions, {pinched} pinched vertices"));
    }
    found
}

/// For each component its Euler number and its exact volume.
fn components(mesh: &Mesh) -> Vec<(i64, RBig)> {
    let mut vertices = Union::new(mesh.positions.len());
    for &[a, b, c] in &mesh.triangles {
        vertices.join(a as usize, b as usize);
        vertices.join(b as usize, c as usize);
    }
    let (number, count) = vertices.numbers();
    let lattice = Lattice::holding(&mesh.positions);
    let mut corners = vec![0; count];
    let mut faces = vec![0; count];
    let mut volume = vec![Int::ZERO; count];
    number.iter().for_each(|&n| corners[n] += 1);
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let component = number[triangle[0] as usize];
        let [a, b, c] = mesh.corners(index).map(|p| lattice.point(p));
        volume[component] += dot(&a, &cross(&b, &c));
        faces[component] += 1;
    }
    // A closed surface has three edges for every two triangles.
    let eulers = corners.into_iter().zip(faces).map(|(v, f): (i64, i64)| v - f / 2);
    let volumes = volume.into_iter().map(|six| lattice.value(RBig::from(six) / Int::from(6), 3));
    eulers.zip(volumes).collect()
}
