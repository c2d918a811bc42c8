use super::{Lattice, PointId, Points};
use crate::math::Vec3;

/// Points on a lattice that remember where they were given.
#[derive(Debug)]
pub struct Snapped {
    /// The points; those that were added come first.
    pub points: Points,
    lattice: Lattice,
    /// For the points that were added, their positions as given.
    given: Vec<Vec3>,
    exact: bool,
}

impl Snapped {
    /// No points yet, for coordinates of at most `largest` in magnitude, on a lattice as coarse as `resolution` allows
    /// (0 for the finest).
    pub fn new(largest: f64, resolution: f64) -> Snapped {
        let lattice = Lattice::fitting(largest).as_coarse_as(resolution);
        Snapped { points: Points::default(), lattice, given: Vec::new(), exact: true }
    }

    /// The lattice point nearest to a position. All must be added before other points are made.
    pub fn add(&mut self, position: Vec3) -> PointId {
        let id = self.points.site(self.lattice.snap(position));
        self.exact &= self.lattice.to_model(self.points.rounded(id)) == position;
        match self.given.get_mut(id.0 as usize) {
            // Several positions may share a lattice point; which one stands for it must not depend on their order.
            Some(known) => *known = lesser(*known, position),
            None => self.given.push(position),
        }
        id
    }

    /// The position of a point in model units: as it was given, or its exact place rounded to doubles.
    pub fn position(&self, point: PointId) -> Vec3 {
        match self.given.get(point.0 as usize) {
            Some(&given) => given,
            None => self.lattice.to_model(self.points.rounded(point)),
        }
    }

    /// Whether the point was added.
    pub fn is_given(&self, point: PointId) -> bool {
        (point.0 as usize) < self.given.len()
    }

    /// Whether all added points lie on the lattice as they were given.
    pub fn is_exact(&self) -> bool {
        self.exact
    }
}

/// The first of two positions in lexicographic order.
fn lesser(a: Vec3, b: Vec3) -> Vec3 {
    let order = a.to_array().iter().zip(b.to_array()).map(|(x, y)| x.total_cmp(&y)).find(|o| o.is_ne());
    if order == Some(std::cmp::Ordering::Greater) { b } else { a }
}
