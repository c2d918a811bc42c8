use super::{Lattice, Place, PointId, Points, Site};
use crate::math::Vec3;

/// Points on a lattice that remember where they were given.
#[derive(Debug)]
pub struct Snapped {
    /// The points; those that were added come first.
    pub points: Points,
    lattice: Lattice,
    /// For points that were added, their positions as given; NaN for others.
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

    /// The lattice point nearest to a position.
    pub fn add(&mut self, position: Vec3) -> PointId {
        self.add_at(self.lattice.snap(position), position)
    }

    /// The lattice points nearest to some positions.
    pub fn add_all(&mut self, positions: &[Vec3]) -> Vec<PointId> {
        self.add_each(positions, |snapped, _, position| snapped.add(position))
    }

    /// The points that `add` makes of some positions by their numbers, one after another. Most should be lattice points
    /// near their positions: these are fetched ahead, many at a time.
    pub(crate) fn add_each(
        &mut self,
        positions: &[Vec3],
        mut add: impl FnMut(&mut Snapped, u32, Vec3) -> PointId,
    ) -> Vec<PointId> {
        const TOGETHER: usize = 64;
        let mut all = Vec::with_capacity(positions.len());
        for group in positions.chunks(TOGETHER) {
            self.points.prefetch(group.iter().map(|&p| self.lattice.snap(p)));
            for &position in group {
                let id = add(self, all.len() as u32, position);
                all.push(id);
            }
        }
        all
    }

    /// A lattice point that was given as a position near it.
    pub fn add_at(&mut self, site: Site, position: Vec3) -> PointId {
        let id = self.points.site(site);
        self.exact &= self.lattice.to_model(self.points.rounded(id)) == position;
        if self.given.len() <= id.0 as usize {
            self.given.resize(id.0 as usize + 1, Vec3::NAN);
        }
        // Several positions may share a lattice point; which one stands for it must not depend on their order.
        let known = &mut self.given[id.0 as usize];
        *known = if known.is_nan() { position } else { lesser(*known, position) };
        id
    }

    /// The lattice.
    pub fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// Where a point is exactly, when that does not follow from its position.
    pub(crate) fn hidden_place(&self, point: PointId) -> Option<Place> {
        match self.points.fraction(point) {
            Err(fraction) => Some(Place::Fraction(*fraction)),
            Ok(site) => {
                let position = self.position(point);
                let is_there = self.lattice.holds(position) && self.lattice.snap(position) == site;
                (!is_there).then_some(Place::Site(site))
            }
        }
    }

    /// The position of a point in model units: as it was given, or its exact place rounded to doubles.
    pub fn position(&self, point: PointId) -> Vec3 {
        match self.given.get(point.0 as usize) {
            Some(&given) if !given.is_nan() => given,
            _ => self.lattice.to_model(self.points.rounded(point)),
        }
    }

    /// Whether the point was added.
    pub fn is_given(&self, point: PointId) -> bool {
        self.given.get(point.0 as usize).is_some_and(|given| !given.is_nan())
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
