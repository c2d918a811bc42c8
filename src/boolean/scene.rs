//! Operands on one lattice.

use crate::math::Aabb;
use crate::mesh::{Mesh, Solid, Topology};
use crate::polygon::exact::{Plane, PointId, Points, Site, Snapped};
use std::collections::HashMap;

/// An operand of a boolean: a mesh and what is known of it.
#[derive(Clone, Copy, Debug)]
pub struct Operand<'a> {
    pub(super) mesh: &'a Mesh,
    /// Whether it is known to be closed.
    pub(super) checked: bool,
    /// Whether it is known not to cross itself.
    embedded: bool,
    material: u32,
}

impl<'a> Operand<'a> {
    /// The same operand with a label: coplanar faces of operands with different labels are not merged, so that each
    /// triangle of the result has one label. All operands have label 0 unless told otherwise.
    #[must_use]
    pub fn with_material(self, material: u32) -> Operand<'a> {
        Operand { material, ..self }
    }
}

impl<'a> From<&'a Mesh> for Operand<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Operand { mesh, checked: false, embedded: false, material: 0 }
    }
}

impl<'a> From<&'a Solid> for Operand<'a> {
    fn from(solid: &'a Solid) -> Self {
        Operand { mesh: solid.mesh(), checked: true, embedded: solid.is_embedded(), material: 0 }
    }
}

/// A triangle of an operand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [PointId; 3],
    pub(super) operand: u32,
    /// Its index in the operand.
    pub(super) index: u32,
}

/// What is known of an operand in the scene.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// Its triangles in [`Scene::triangles`].
    pub(super) triangles: std::ops::Range<u32>,
    pub(super) bounds: Aabb,
    pub(super) embedded: bool,
    pub(super) material: u32,
}

/// All operands together. Half-edge `3 t + i` is side `i` of triangle `t`.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) places: Snapped,
    pub(super) triangles: Vec<Triangle>,
    /// The other half-edge of each edge, or [`Topology::NONE`] where there is other than one.
    pub(super) twins: Vec<u32>,
    pub(super) members: Vec<Member>,
    /// Planes of triangles that were asked for, each once for all triangles in it.
    planes: PlaneTable,
    /// For each triangle, its own plane (its normal outward) once it was asked for.
    own_planes: Vec<Option<Box<Plane>>>,
}

impl Scene {
    /// Snaps all operands to the finest lattice for them, or to one as coarse as `resolution` allows. Triangles without area on the lattice are dropped.
    pub(super) fn new(operands: &[Operand<'_>], resolution: f64) -> Scene {
        let coordinates = operands.iter().flat_map(|operand| &operand.mesh.positions);
        let largest = coordinates.fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
        let mut scene = Scene {
            places: Snapped::new(largest, resolution),
            triangles: Vec::new(),
            twins: Vec::new(),
            members: Vec::new(),
            planes: PlaneTable::default(),
            own_planes: Vec::new(),
        };
        for (index, operand) in (0..).zip(operands) {
            scene.add(index, operand);
        }
        scene.own_planes.resize_with(scene.triangles.len(), || None);
        scene
    }

    fn add(&mut self, index: u32, operand: &Operand<'_>) {
        let mesh = operand.mesh;
        let ids: Vec<PointId> = mesh.positions.iter().map(|&p| self.places.add(p)).collect();
        let first = self.triangles.len() as u32;
        let mut slots = vec![Topology::NONE; mesh.triangles.len()];
        for (t, triangle) in (0_u32..).zip(&mesh.triangles) {
            let corners = triangle.map(|v| ids[v as usize]);
            if self.has_area(corners) {
                slots[t as usize] = self.triangles.len() as u32;
                self.triangles.push(Triangle { corners, operand: index, index: t });
            }
        }
        let topology = Topology::new(&mesh.triangles);
        for t in (0..mesh.triangles.len() as u32).filter(|&t| slots[t as usize] != Topology::NONE) {
            self.twins.extend((3 * t..3 * t + 3).map(|half_edge| match topology.twin(half_edge) {
                Topology::NONE => Topology::NONE,
                twin => match slots[twin as usize / 3] {
                    Topology::NONE => Topology::NONE,
                    slot => 3 * slot + twin % 3,
                },
            }));
        }
        let triangles = first..self.triangles.len() as u32;
        let whole = triangles.len() == mesh.triangles.len();
        let corners = self.triangles[first as usize..].iter().flat_map(|t| t.corners);
        let bounds = Aabb::of(corners.map(|p| self.points().rounded(p)));
        let material = operand.material;
        self.members.push(Member { triangles, bounds, embedded: operand.embedded && whole, material });
    }

    /// The points of the scene.
    pub(super) fn points(&self) -> &Points {
        &self.places.points
    }

    /// The box of a triangle, in lattice units.
    pub(super) fn bounds_of(&self, triangle: u32) -> Aabb {
        Aabb::of(self.triangles[triangle as usize].corners.map(|p| self.points().rounded(p)))
    }

    /// The integer corners of a triangle.
    pub(super) fn sites_of(&self, triangle: u32) -> [Site; 3] {
        self.triangles[triangle as usize]
            .corners
            .map(|p| self.points().as_site(p).expect("vertices of operands are sites"))
    }

    fn has_area(&self, corners: [PointId; 3]) -> bool {
        (0..3).any(|axis| self.points().orientation(corners[0], corners[1], corners[2], axis) != 0)
    }

    /// The plane of a triangle, its normal outward.
    pub(super) fn own_plane(&mut self, triangle: u32) -> &Plane {
        if self.own_planes[triangle as usize].is_none() {
            self.own_planes[triangle as usize] = Some(Box::new(self.plane_through(triangle)));
        }
        self.own_planes[triangle as usize].as_ref().expect("it was just made")
    }

    /// [`Scene::own_plane`] without remembering it.
    pub(super) fn plane_through(&self, triangle: u32) -> Plane {
        let [a, b, c] = self.sites_of(triangle);
        Plane::through(a, b, c).expect("the triangle has area")
    }

    /// The plane that a triangle shares with all coplanar ones, and whether its normal is outward.
    pub(super) fn shared_plane(&mut self, triangle: u32) -> (u32, bool) {
        let own = *self.own_plane(triangle);
        self.planes.find(&own)
    }

    /// A plane by the index that [`Scene::shared_plane`] gave.
    pub(super) fn plane(&self, index: u32) -> &Plane {
        &self.planes.planes[index as usize]
    }
}

/// Planes, each once, with their longest normal component positive.
#[derive(Debug, Default)]
struct PlaneTable {
    planes: Vec<Plane>,
    by_key: HashMap<[u64; 4], Vec<u32>>,
}

impl PlaneTable {
    fn find(&mut self, plane: &Plane) -> (u32, bool) {
        let outward = plane.normal_sign(plane.main_axis()) > 0;
        let known = self.by_key.entry(plane.key()).or_default();
        if let Some(&index) = known.iter().find(|&&index| self.planes[index as usize].same_points(plane)) {
            return (index, outward);
        }
        let index = self.planes.len() as u32;
        known.push(index);
        self.planes.push(if outward { *plane } else { plane.flipped() });
        (index, outward)
    }
}
