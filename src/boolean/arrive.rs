//! From meshes and solids to exact surfaces on one lattice.

use super::body::Body;
use super::world::{Facing, Labels, NONE, World};
use super::{Birth, BooleanError, Operand};
use crate::math::{Aabb, Vec3};
use crate::mesh::{Defects, Exact, Mesh, Topology, Unmended};
use crate::polygon::exact::{Lattice, Origin, PointId, Points, Snapped};
use std::borrow::Cow;

/// Puts all operands on the finest lattice for them, or on one as coarse as `resolution` allows.
pub(super) fn enter<'a>(
    operands: &[Operand<'a>],
    resolution: f64,
) -> Result<(World<'a>, Vec<Body>), BooleanError> {
    let closed = operands.iter().enumerate().map(|(i, operand)| topology_of(i, operand));
    let topologies: Vec<Cow<'_, Topology>> = closed.collect::<Result<_, _>>()?;
    let meshes = || operands.iter().flat_map(Operand::meshes);
    let largest =
        meshes().flat_map(|mesh| &mesh.positions).fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
    let mut world = World::new(Snapped::new(largest, resolution));
    world.places.points.reserve(operands.iter().map(|operand| operand.mesh.positions.len()).sum());
    world.labels = operands.iter().map(|operand| operand.labels).collect();
    let rounds = world.places.lattice() != Lattice::fitting(largest);
    let mut taken_by = Vec::new();
    let enter = |(i, (operand, topology)): (u32, (&Operand<'a>, Cow<'_, Topology>))| {
        let surface = Surface::behind(operand, &world, rounds);
        let surface = surface.unwrap_or_else(|| Surface::at_positions(operand, &topology));
        Body::of_operand(&mut world, i, &surface, &mut taken_by)
    };
    let bodies = (0..).zip(operands.iter().zip(topologies)).map(enter).collect();
    Ok((world, bodies))
}

/// The topology of an operand, which must bound a volume.
fn topology_of<'a>(index: usize, operand: &Operand<'a>) -> Result<Cow<'a, Topology>, BooleanError> {
    if let Some(topology) = operand.topology {
        return Ok(Cow::Borrowed(topology));
    }
    let Mesh { positions, triangles } = operand.mesh;
    let is_sound = |&[a, b, c]: &[u32; 3]| {
        a != b && b != c && c != a && [a, b, c].iter().all(|&v| (v as usize) < positions.len())
    };
    if triangles.iter().all(is_sound) && positions.iter().all(|p| p.is_finite()) {
        let topology = Topology::new(triangles);
        if topology.is_closed() {
            return Ok(Cow::Owned(topology));
        }
    }
    // What is not that simple may be closed all the same.
    let defects = Defects::of(operand.mesh);
    if defects.is_closed() {
        Ok(Cow::Owned(Topology::new(triangles)))
    } else {
        Err(BooleanError::NotClosed { operand: index, defects: Box::new(defects) })
    }
}

/// What an operand enters with.
struct Surface<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    embedded: bool,
    /// What positions do not say, on the lattice of the world.
    origin: Option<Cow<'a, Origin>>,
    /// For each triangle, the one of the operand that it is born from, unless that is itself.
    stand_ins: Option<&'a [u32]>,
}

impl<'a> Surface<'a> {
    /// The operand as its positions have it.
    fn at_positions(operand: &Operand<'a>, topology: &'a Topology) -> Surface<'a> {
        let (mesh, embedded) = (operand.mesh, operand.embedded);
        Surface { mesh, topology, embedded, origin: None, stand_ins: None }
    }

    /// The exact surface behind an operand, on the lattice of the world; `None` where positions are all there is.
    ///
    /// A coarse resolution is asked for to have positions rounded, so it is not circumvented. Where numbers would become
    /// too wide, positions are taken as they are.
    fn behind(operand: &Operand<'a>, world: &World<'_>, rounds: bool) -> Option<Surface<'a>> {
        let Exact { origin, unmended } = operand.exact?;
        let (mesh, topology, stand_ins) = match unmended {
            Some(Unmended { mesh, topology, stand_ins }) => (mesh, topology, Some(&stand_ins[..])),
            None => (operand.mesh, operand.topology?, None),
        };
        let lattice = world.places.lattice();
        let origin = match origin.lattice.exponent_in(lattice) {
            0 => Cow::Borrowed(origin),
            ..0 if rounds => return None,
            _ => Cow::Owned(origin.at(lattice, &mesh.positions, &mesh.triangles)?),
        };
        let embedded = origin.embedded;
        let surface = Surface { mesh, topology, embedded, origin: Some(origin), stand_ins };
        surface.labels_follow_edges(operand.labels).then_some(surface)
    }

    /// The triangle of the operand that a triangle is born from.
    fn born_from(&self, triangle: u32) -> u32 {
        self.stand_ins.map_or(triangle, |stand_ins| stand_ins[triangle as usize])
    }

    /// Whether labels differ across edges of faces only: a diagonal between points that are not on the lattice has no
    /// line on which labels could part.
    fn labels_follow_edges(&self, labels: Labels<'_>) -> bool {
        let (Labels::Each(labels), Some(origin)) = (labels, &self.origin) else { return true };
        let mut is_fraction = vec![false; self.mesh.positions.len()];
        origin.fractions.iter().for_each(|&(vertex, _)| is_fraction[vertex as usize] = true);
        let label = |half_edge: u32| labels[self.born_from(half_edge / 3) as usize];
        origin.faces.iter().flat_map(|&(t, ..)| (0..3).map(move |i| 3 * t + i)).all(|half_edge| {
            let corners = self.mesh.triangles[half_edge as usize / 3];
            let twin = self.topology.twin(half_edge);
            twin == Topology::NONE
                || label(half_edge) == label(twin)
                || ![0, 1].iter().any(|i| is_fraction[corners[(half_edge as usize + i) % 3] as usize])
                || origin.sides.binary_search_by_key(&half_edge, |side| side.0).is_ok()
        })
    }
}

impl Body {
    /// Enters an operand into the world. Triangles without area on the lattice are dropped. `taken_by` tells for points
    /// the last operand with a vertex there.
    fn of_operand(world: &mut World<'_>, index: u32, surface: &Surface<'_>, taken_by: &mut Vec<u32>) -> Body {
        let Surface { mesh, topology, ref origin, .. } = *surface;
        let ids = match origin {
            Some(origin) => exact_points(world, &mesh.positions, origin),
            None => world.places.add_all(&mesh.positions),
        };
        taken_by.resize(world.points().len().max(taken_by.len()), NONE);
        let shares = |p: &PointId| std::mem::replace(&mut taken_by[p.0 as usize], index) == index;
        let may_be_pinched = ids.iter().any(shares) || surface.stand_ins.is_some();
        let mut body = Body { may_be_pinched, ..Body::default() };
        body.corners.reserve(mesh.triangles.len());
        body.births.reserve(mesh.triangles.len());
        let mut slots = vec![NONE; mesh.triangles.len()];
        for (t, triangle) in (0_u32..).zip(&mesh.triangles) {
            let corners = triangle.map(|v| ids[v as usize]);
            if has_area(world.points(), corners) {
                slots[t as usize] = body.corners.len() as u32;
                body.corners.push(corners);
                body.births.push(Birth { operand: index, triangle: surface.born_from(t) });
            }
        }
        let is_whole = body.corners.len() == mesh.triangles.len();
        body.twins = if is_whole { topology.twins().to_vec() } else { twins_of(topology, &slots) };
        body.bounds = Aabb::of(body.corners.iter().flatten().map(|&p| world.points().rounded(p)));
        body.embedded = surface.embedded && is_whole;
        if let Some(origin) = origin {
            body.remember(world, origin, &slots);
        }
        body
    }

    /// Takes over planes of faces and lines of edges.
    fn remember(&mut self, world: &mut World<'_>, origin: &Origin, slots: &[u32]) {
        let facings: Vec<Facing> = origin.planes.iter().map(|plane| world.facing(plane)).collect();
        if !origin.faces.is_empty() {
            self.facings = vec![Facing::UNKNOWN; self.corners.len()];
        }
        for &(t, plane, outward) in origin.faces.iter().filter(|face| slots[face.0 as usize] != NONE) {
            let facing = facings[plane as usize];
            self.facings[slots[t as usize] as usize] = if outward { facing } else { facing.turned() };
        }
        let lines: Vec<u32> = origin.lines.iter().map(|line| world.add_line(line)).collect();
        if !origin.sides.is_empty() {
            self.lines = vec![NONE; self.twins.len()];
        }
        for &(half_edge, line) in origin.sides.iter().filter(|side| slots[side.0 as usize / 3] != NONE) {
            let slot = slots[half_edge as usize / 3];
            self.lines[(3 * slot + half_edge % 3) as usize] = lines[line as usize];
        }
    }
}

/// The points of the vertices of a mesh that was rounded.
fn exact_points(world: &mut World<'_>, positions: &[Vec3], origin: &Origin) -> Vec<PointId> {
    let (mut sites, mut fractions) = (origin.sites.iter().peekable(), origin.fractions.iter().peekable());
    world.places.add_each(positions, |places, vertex, position| {
        if let Some((_, site)) = sites.next_if(|site| site.0 == vertex) {
            places.add_at(*site, position)
        } else if let Some((_, fraction)) = fractions.next_if(|fraction| fraction.0 == vertex) {
            places.points.fraction_point(fraction.numerators, fraction.denominator)
        } else {
            places.add(position)
        }
    })
}

/// Twins of the triangles that have a slot, by slots.
fn twins_of(topology: &Topology, slots: &[u32]) -> Vec<u32> {
    let half_edges = (0..topology.len() as u32).filter(|&h| slots[h as usize / 3] != NONE);
    let twin_slot = |half_edge: u32| match topology.twin(half_edge) {
        Topology::NONE => NONE,
        twin => match slots[twin as usize / 3] {
            NONE => NONE,
            slot => 3 * slot + twin % 3,
        },
    };
    half_edges.map(twin_slot).collect()
}

fn has_area(points: &Points, corners: [PointId; 3]) -> bool {
    (0..3).any(|axis| points.orientation(corners[0], corners[1], corners[2], axis) != 0)
}
