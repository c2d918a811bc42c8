//! Open meshes closed: parts turned one way, boundary loops capped.

use super::TessellationError;
use crate::math::{Aabb, Vec2, Vec3};
use crate::mesh::{Defects, Mesh, Topology};
use crate::polygon::triangulate;
use std::fmt;

/// Why a mesh cannot be closed.
#[derive(Clone, Debug, PartialEq)]
pub enum CloseError {
    /// An edge of more than two triangles, or a triangle that names a vertex twice.
    NotAManifold {
        /// What is wrong.
        defects: Box<Defects>,
    },
    /// A part has only one side, like a Moebius strip: it encloses nothing.
    OneSided,
    /// A part and its caps lie on each other: they enclose nothing.
    Flat {
        /// Their mean distance: twice the volume over the area.
        thickness: f64,
        /// What it must be more than.
        least: f64,
    },
    /// The surfaces could not be tessellated.
    Tessellation(TessellationError),
}

impl fmt::Display for CloseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CloseError::NotAManifold { defects } => {
                let wrong = defects.rows().into_iter().filter(|&(_, count)| count > 0);
                let list: Vec<String> = wrong.map(|(name, count)| format!("{count} {name}")).collect();
                write!(f, "the surface is not a manifold: {}", list.join(", "))
            }
            CloseError::OneSided => {
                f.write_str("a part of the surface has only one side and encloses nothing")
            }
            CloseError::Flat { thickness, least } => {
                write!(
                    f,
                    "the surface and the caps of its borders enclose nothing: they are {thickness:.3e} apart in the mean, \
                     within the tolerance of {least:.3e}; give it a thickness"
                )
            }
            CloseError::Tessellation(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for CloseError {}

impl From<TessellationError> for CloseError {
    fn from(error: TessellationError) -> CloseError {
        CloseError::Tessellation(error)
    }
}

/// The mesh with every boundary loop capped, and its connected parts turned so that each encloses a positive volume. The
/// triangles of caps follow those of the mesh.
///
/// A loop in a plane, or in several planes one after the other, gets flat caps: of half a pipe two half discs and a
/// rectangle. Any other is triangulated in the plane that fits it best; one that crosses itself there gets a fan about its
/// middle. Parts may cross one another: the solid is where at least one of them is, as booleans take it.
///
/// A part with caps must be thicker, in the mean, than `least`: the tolerance of the mesh, or 0.
///
/// ```
/// use ogee::mesh::Solid;
/// use ogee::surface::Classic;
/// use ogee::tessellate::{SurfaceOptions, capped, surface};
///
/// let mantle = surface(&Classic::Cylinder { radius: 1.0, height: 2.0 }, &SurfaceOptions::within(1e-3))?;
/// let cylinder = Solid::new(capped(&mantle.mesh, 1e-3).unwrap()).unwrap();
/// # Ok::<(), ogee::tessellate::TessellationError>(())
/// ```
///
/// # Errors
/// [`CloseError`].
pub fn capped(mesh: &Mesh, least: f64) -> Result<Mesh, CloseError> {
    let defects = Defects::of(mesh);
    if defects.non_manifold_edges > 0 || defects.repeated_corners > 0 || defects.indices_out_of_range > 0 {
        return Err(CloseError::NotAManifold { defects: Box::new(defects) });
    }
    let (mut closed, mut part_of) = oriented(mesh).ok_or(CloseError::OneSided)?;
    let mut has_caps = vec![false; part_of.len()];
    for (boundary, triangle) in loops(&closed.triangles) {
        for part in planar_parts(&closed, &boundary).unwrap_or_else(|| vec![boundary]) {
            cap(&mut closed, &part);
        }
        part_of.resize(closed.triangles.len(), part_of[triangle]);
        has_caps[part_of[triangle]] = true;
    }
    turn_outward(&mut closed, &part_of, &has_caps, least)?;
    Ok(closed)
}

/// The triangles turned so that neighbours agree, each part like its first one, and the number of the part of each; `None`
/// where that cannot be.
fn oriented(mesh: &Mesh) -> Option<(Mesh, Vec<usize>)> {
    let count = mesh.triangles.len();
    // Each edge with the triangles at it and whether they run from its lower vertex up.
    let mut sides: Vec<([u32; 2], u32, bool)> = Vec::with_capacity(3 * count);
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            sides.push(([a.min(b), a.max(b)], t as u32, a < b));
        }
    }
    sides.sort_unstable();
    let mut neighbours: Vec<Vec<(u32, bool)>> = vec![Vec::new(); count];
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let turned = pair[0].2 == pair[1].2;
        neighbours[pair[0].1 as usize].push((pair[1].1, turned));
        neighbours[pair[1].1 as usize].push((pair[0].1, turned));
    }
    let mut flipped: Vec<Option<bool>> = vec![None; count];
    let mut part_of = vec![0; count];
    for start in 0..count {
        if flipped[start].is_some() {
            continue;
        }
        flipped[start] = Some(false);
        part_of[start] = start;
        let mut pending = vec![start];
        while let Some(t) = pending.pop() {
            let own = flipped[t].unwrap_or_default();
            for &(neighbour, turned) in &neighbours[t] {
                match flipped[neighbour as usize] {
                    None => {
                        flipped[neighbour as usize] = Some(own != turned);
                        part_of[neighbour as usize] = start;
                        pending.push(neighbour as usize);
                    }
                    Some(other) if other != (own != turned) => return None,
                    Some(_) => {}
                }
            }
        }
    }
    let mut turned = mesh.clone();
    for (triangle, flipped) in turned.triangles.iter_mut().zip(flipped) {
        if flipped == Some(true) {
            triangle.swap(1, 2);
        }
    }
    Some((turned, part_of))
}

/// The boundary loops as vertices, each in the direction of the triangles beside it and with one of these.
fn loops(triangles: &[[u32; 3]]) -> Vec<(Vec<u32>, usize)> {
    let topology = Topology::new(triangles);
    let start_of = |h: u32| triangles[h as usize / 3][h as usize % 3];
    let mut seen = vec![false; topology.len()];
    let mut found = Vec::new();
    for first in 0..topology.len() as u32 {
        if seen[first as usize] || topology.twin(first) != Topology::NONE {
            continue;
        }
        let (mut boundary, mut h) = (Vec::new(), first);
        while !seen[h as usize] {
            seen[h as usize] = true;
            boundary.push(start_of(h));
            // Around the end of this side to the next open one of the same fan.
            h = Topology::next(h);
            while topology.twin(h) != Topology::NONE {
                h = Topology::next(topology.twin(h));
            }
        }
        found.push((boundary, first as usize / 3));
    }
    found
}

/// Cuts a loop along chords into few loops in planes, where that can be: runs of vertices in one plane are cut off, the
/// longest first.
fn planar_parts(mesh: &Mesh, boundary: &[u32]) -> Option<Vec<Vec<u32>>> {
    /// More flat pieces than a loop of drawn shapes has.
    const MOST: usize = 16;
    /// Vertices that are this near a plane, over the size of the loop, are in it.
    const ROUNDING: f64 = 1e-9;
    let points = |list: &[u32]| list.iter().map(|&v| mesh.positions[v as usize]).collect::<Vec<Vec3>>();
    let slack = ROUNDING * Aabb::of(points(boundary)).size().max_element();
    let (mut rest, mut parts) = (boundary.to_vec(), Vec::new());
    while parts.len() < MOST {
        let (first, count) = longest_planar_run(&points(&rest), slack);
        if count == rest.len() {
            parts.push(rest);
            return Some(parts);
        }
        // Any three points are in a plane, so they tell nothing.
        if count < 4 {
            return None;
        }
        rest.rotate_left(first);
        let ends = [rest[0], rest[count - 1]];
        let is_side = |t: &[u32; 3]| ends.iter().all(|end| t.contains(end));
        if mesh.triangles.iter().any(is_side) {
            return None;
        }
        parts.push(rest[..count].to_vec());
        rest.drain(1..count - 1);
    }
    None
}

/// The first index and the length of a longest run of points of a loop that lie in one plane.
fn longest_planar_run(points: &[Vec3], slack: f64) -> (usize, usize) {
    let (mut best, mut first) = ((0, 0), 0);
    // Once around and to the end of the run that the first one may be a part of.
    while first < 2 * points.len() {
        let count = planar_run(points, first, slack);
        if count > best.1 {
            best = (first % points.len(), count);
        }
        if count == points.len() {
            break;
        }
        // The next plane may begin with the last side of this one.
        first += (count - 2).max(1);
    }
    best
}

/// How many points from one on lie in the plane of the first of them that are not on a line.
fn planar_run(points: &[Vec3], first: usize, slack: f64) -> usize {
    let origin = points[first % points.len()];
    let (mut direction, mut normal): (Option<Vec3>, Option<Vec3>) = (None, None);
    for count in 1..points.len() {
        let off = points[(first + count) % points.len()] - origin;
        match (direction, normal) {
            (_, Some(normal)) if off.dot(normal).abs() > slack => return count,
            (_, Some(_)) => {}
            (Some(along), None) => {
                let across = off - off.dot(along) * along;
                normal = (across.length() > slack).then(|| along.cross(across).normalize());
            }
            (None, None) => direction = (off.length() > slack).then(|| off.normalize()),
        }
    }
    points.len()
}

/// Fills a boundary loop.
fn cap(mesh: &mut Mesh, boundary: &[u32]) {
    let points: Vec<Vec3> = boundary.iter().map(|&v| mesh.positions[v as usize]).collect();
    let middle = points.iter().sum::<Vec3>() / points.len() as f64;
    // Newell's normal, against the loop: the cap runs the other way.
    let pair = |k: usize| (points[k] - middle, points[(k + 1) % points.len()] - middle);
    let normal: Vec3 = (0..points.len()).map(|k| pair(k).1.cross(pair(k).0)).sum();
    let Some(normal) = normal.try_normalize() else { return fan(mesh, boundary, middle) };
    let (x, y) = normal.any_orthonormal_pair();
    let flat: Vec<Vec2> =
        points.iter().rev().map(|&p| Vec2::new((p - middle).dot(x), (p - middle).dot(y))).collect();
    match triangulate::simple(&flat) {
        Ok(triangles) => {
            let vertex = |k: u32| boundary[boundary.len() - 1 - k as usize];
            mesh.triangles.extend(triangles.into_iter().map(|triangle| triangle.map(vertex)));
        }
        Err(_) => fan(mesh, boundary, middle),
    }
}

fn fan(mesh: &mut Mesh, boundary: &[u32], middle: Vec3) {
    let center = mesh.positions.len() as u32;
    mesh.positions.push(middle);
    for k in 0..boundary.len() {
        mesh.triangles.push([center, boundary[(k + 1) % boundary.len()], boundary[k]]);
    }
}

/// Flips the parts with negative volume; a part is named by one of its triangles. Those with caps must hold something.
fn turn_outward(mesh: &mut Mesh, part_of: &[usize], has_caps: &[bool], least: f64) -> Result<(), CloseError> {
    // Six times the volumes, twice the areas.
    let (mut volumes, mut areas) = (vec![0.0; part_of.len()], vec![0.0; part_of.len()]);
    for (t, &part) in part_of.iter().enumerate() {
        let [a, b, c] = mesh.corners(t);
        let origin = mesh.corners(part)[0];
        volumes[part] += (a - origin).dot((b - origin).cross(c - origin));
        areas[part] += (b - a).cross(c - a).length();
    }
    for part in (0..has_caps.len()).filter(|&part| has_caps[part]) {
        let thickness = 2.0 / 3.0 * volumes[part].abs() / areas[part];
        if thickness <= least || thickness.is_nan() {
            return Err(CloseError::Flat { thickness, least });
        }
    }
    for (triangle, &part) in mesh.triangles.iter_mut().zip(part_of) {
        if volumes[part] < 0.0 {
            triangle.swap(1, 2);
        }
    }
    Ok(())
}
