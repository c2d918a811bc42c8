//! What all steps of one evaluation share: a lattice with its points, and planes.

use super::Birth;
use crate::numeric::MixHasher;
use crate::polygon::exact::{Plane, Points, Snapped};
use std::collections::HashMap;
use std::hash::BuildHasherDefault;

/// A hash map of integers that is only looked up in.
pub(super) type Lookup<K, V> = HashMap<K, V, BuildHasherDefault<MixHasher>>;

/// Marks what is not there: a triangle without a known plane, a half-edge without a line.
pub(super) const NONE: u32 = u32::MAX;

/// Points, planes and lines of one evaluation. They stay valid from one arrangement to the next, so that nothing is ever
/// computed from a rounded value.
#[derive(Debug)]
pub(super) struct World<'a> {
    pub(super) places: Snapped,
    planes: PlaneTable,
    /// For a line on a face, a plane that crosses the face's own there.
    pub(super) lines: Vec<Plane>,
    /// For each operand, what its triangles are labelled with.
    pub(super) labels: Vec<Labels<'a>>,
}

/// Labels of the triangles of an operand.
#[derive(Clone, Copy, Debug)]
pub(super) enum Labels<'a> {
    /// One for all.
    One(u32),
    /// One each.
    Each(&'a [u32]),
}

impl<'a> World<'a> {
    /// An empty world with its lattice.
    pub(super) fn new(places: Snapped) -> World<'a> {
        World { places, planes: PlaneTable::default(), lines: Vec::new(), labels: Vec::new() }
    }

    /// All points.
    pub(super) fn points(&self) -> &Points {
        &self.places.points
    }

    /// The label of the triangle that something was born from.
    pub(super) fn label(&self, birth: Birth) -> u32 {
        match self.labels[birth.operand as usize] {
            Labels::One(label) => label,
            Labels::Each(labels) => labels[birth.triangle as usize],
        }
    }

    /// The facing of a plane with an outward normal; each plane is held once.
    pub(super) fn facing(&mut self, outward: &Plane) -> Facing {
        self.planes.find(outward)
    }

    /// A plane by its index, with its longest normal component positive.
    pub(super) fn plane(&self, index: u32) -> &Plane {
        &self.planes.planes[index as usize]
    }

    /// The plane of a facing, its normal outward.
    pub(super) fn outward_plane(&self, facing: Facing) -> Plane {
        let plane = self.plane(facing.plane());
        if facing.is_with_plane() { *plane } else { plane.flipped() }
    }

    /// Keeps the plane of a line.
    pub(super) fn add_line(&mut self, plane: &Plane) -> u32 {
        self.lines.push(*plane);
        self.lines.len() as u32 - 1
    }
}

/// A plane of the world and which way a face in it looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Facing(u32);

impl Facing {
    /// Not known.
    pub(super) const UNKNOWN: Facing = Facing(NONE);

    pub(super) fn new(plane: u32, with_plane: bool) -> Facing {
        Facing(2 * plane + u32::from(with_plane))
    }

    pub(super) fn known(self) -> Option<Facing> {
        (self != Facing::UNKNOWN).then_some(self)
    }

    /// The other way.
    pub(super) fn turned(self) -> Facing {
        if self == Facing::UNKNOWN { self } else { Facing(self.0 ^ 1) }
    }

    /// Index of the plane.
    pub(super) fn plane(self) -> u32 {
        self.0 / 2
    }

    /// Whether the outward normal is that of the plane.
    pub(super) fn is_with_plane(self) -> bool {
        self.0 % 2 == 1
    }
}

/// Planes, each once, with their longest normal component positive.
#[derive(Debug, Default)]
struct PlaneTable {
    planes: Vec<Plane>,
    by_key: Lookup<[u64; 4], Vec<u32>>,
}

impl PlaneTable {
    fn find(&mut self, plane: &Plane) -> Facing {
        let with_plane = plane.normal_sign(plane.main_axis()) > 0;
        let known = self.by_key.entry(plane.key()).or_default();
        if let Some(&index) = known.iter().find(|&&index| self.planes[index as usize].same_points(plane)) {
            return Facing::new(index, with_plane);
        }
        let index = self.planes.len() as u32;
        known.push(index);
        self.planes.push(if with_plane { *plane } else { plane.flipped() });
        Facing::new(index, with_plane)
    }
}
