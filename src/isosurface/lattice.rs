//! Nodes of the tetrahedra: whole numbers first, positions from them.

use crate::math::{Aabb, Vec3};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Halvings of a root cell: three generations of tetrahedra each.
pub(super) const HALVINGS: u32 = 16;

/// Greatest number of root cells along an axis: 20 bits hold its places, 63 those of a node.
const MOST_ROOTS: usize = 15;

/// How far the planes between root cells stand off the even division, in cells. Models are drawn in round numbers;
/// faces that lie on nodes would have their vertices pushed off by [`super::crossing::CLEARANCE`].
const SHIFT: f64 = 0.086_713;

/// A place in units of a root cell divided by 2^[`HALVINGS`].
pub(super) type Place = [u32; 3];

/// The planes between root cells.
pub(super) struct Lattice {
    lines: [Vec<f64>; 3],
}

impl Lattice {
    /// Nearly cubic root cells over `bounds`, `roots` of them along its longest side.
    pub(super) fn over(bounds: Aabb, roots: usize) -> Lattice {
        let size = bounds.size();
        let longest = size.max_element();
        let along = |axis: usize| {
            let count = (size[axis] / longest * roots as f64).round().clamp(1.0, MOST_ROOTS as f64);
            let (low, high) = (bounds.min[axis], bounds.max[axis]);
            let line = |i: u32| match f64::from(i) {
                0.0 => low,
                i if i == count => high,
                i => low + (high - low) * ((i + SHIFT) / count),
            };
            (0..=count as u32).map(line).collect()
        };
        Lattice { lines: [along(0), along(1), along(2)] }
    }

    /// How many root cells there are along each axis.
    pub(super) fn roots(&self) -> [u32; 3] {
        [0, 1, 2].map(|axis| self.lines[axis].len() as u32 - 1)
    }

    pub(super) fn position(&self, place: Place) -> Vec3 {
        let along = |axis: usize| {
            let (whole, part) = ((place[axis] >> HALVINGS) as usize, place[axis] & ((1 << HALVINGS) - 1));
            let low = self.lines[axis][whole];
            if part == 0 {
                return low;
            }
            low + (self.lines[axis][whole + 1] - low) * (f64::from(part) / f64::from(1 << HALVINGS))
        };
        Vec3::new(along(0), along(1), along(2))
    }

    /// For each axis whether the place is at the low or the high end of the box.
    pub(super) fn ends(&self, place: Place) -> [[bool; 2]; 3] {
        let roots = self.roots();
        [0, 1, 2].map(|axis| [place[axis] == 0, place[axis] == roots[axis] << HALVINGS])
    }

    /// Whether three places lie on one side of the box.
    pub(super) fn on_one_side(&self, places: [Place; 3]) -> bool {
        let ends = places.map(|place| self.ends(place));
        (0..3).any(|axis| (0..2).any(|end| ends.iter().all(|e| e[axis][end])))
    }
}

fn key([x, y, z]: Place) -> u64 {
    u64::from(x) | u64::from(y) << 21 | u64::from(z) << 42
}

/// The nodes that are there, by number: where they are and what the field is.
#[derive(Default)]
pub(super) struct Nodes {
    ids: Map<u64, u32>,
    pub(super) places: Vec<Place>,
    pub(super) positions: Vec<Vec3>,
    pub(super) values: Vec<f64>,
}

impl Nodes {
    /// The number of the node there; a new one has no value yet.
    pub(super) fn at(&mut self, place: Place, lattice: &Lattice) -> u32 {
        let next = self.places.len() as u32;
        let id = *self.ids.entry(key(place)).or_insert(next);
        if id == next {
            self.places.push(place);
            self.positions.push(lattice.position(place));
        }
        id
    }

    /// Whether there is a node in the middle between two.
    pub(super) fn have_middle(&self, a: u32, b: u32) -> bool {
        let (a, b) = (self.places[a as usize], self.places[b as usize]);
        // Ends of the shortest edges have no middle.
        let sums = [0, 1, 2].map(|axis| a[axis] + b[axis]);
        sums.iter().all(|sum| sum.is_multiple_of(2)) && self.ids.contains_key(&key(sums.map(|sum| sum / 2)))
    }

    pub(super) fn middle(&mut self, a: u32, b: u32, lattice: &Lattice) -> u32 {
        let (a, b) = (self.places[a as usize], self.places[b as usize]);
        self.at([0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2), lattice)
    }

    pub(super) fn position(&self, id: u32) -> Vec3 {
        self.positions[id as usize]
    }

    /// Negative is inside; zero and NaN are not.
    pub(super) fn is_inside(&self, id: u32) -> bool {
        self.values[id as usize] < 0.0
    }
}

/// A map from small whole numbers; nobody goes through it in its own order.
pub(super) type Map<K, V> = HashMap<K, V, BuildHasherDefault<Mixer>>;

/// Multiplies and turns, as in the Firefox hasher: keys here are places and numbers, not an adversary's.
#[derive(Default)]
pub(super) struct Mixer(u64);

impl Hasher for Mixer {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(u64::from(byte)));
    }

    fn write_u32(&mut self, x: u32) {
        self.write_u64(u64::from(x));
    }

    fn write_u64(&mut self, x: u64) {
        // An odd number near 2^64 divided by the golden ratio.
        self.0 = (self.0.rotate_left(26) ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn write_usize(&mut self, x: usize) {
        self.write_u64(x as u64);
    }

    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 29)
    }
}
