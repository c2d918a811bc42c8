//! Triangles that fail are mended one by one: an edge flipped where that is better, else their longest edge split, with
//! those neighbours first whose longest edge it is not (Rivara, New longest-edge algorithms for the refinement and/or
//! improvement of unstructured triangulations, 1997).

use super::check::PLACES;
use super::frame::{FINEST, Local, Node, settled, turns_left};
use super::table::Table;
use super::{Care, TessellationError, check};
use crate::math::Vec3;
use crate::mesh::Topology;
use crate::surface::Surface;

const NONE: u32 = Topology::NONE;
/// Share of the tolerance that measured distances may use: between the places that are looked at they may be larger.
pub(super) const MEASURED_SHARE: f64 = 0.95;
/// Below this share of what is allowed, distances need no closer look.
pub(super) const SURE: f64 = 0.5;
/// Triangles that are flatter are so by rounding.
const FLAT: f64 = 1e-9;
/// No flip makes triangles as thin askew: split again, they would become flat.
const THINNEST: f64 = 1e-3;

#[derive(Clone)]
pub(super) struct Refinement<'a> {
    pub(super) surface: &'a dyn Surface,
    pub(super) table: &'a Table,
    pub(super) nodes: Vec<Node>,
    pub(super) positions: Vec<Vec3>,
    pub(super) triangles: Vec<[Local; 3]>,
    /// For each half-edge (side k of triangle t is 3 t + k) the one that runs the other way.
    pub(super) twins: Vec<u32>,
    /// Distance from the surface over tolerance, for each triangle; the bound where there is one.
    pub(super) ratios: Vec<f64>,
    /// The largest distance found between the usual places, with what may lie between those looked at.
    pub(super) told: f64,
}

/// What stops a refinement, where.
pub(super) enum Stopped {
    TooLarge(u64),
    NotReached([f64; 2]),
    NotFinite([f64; 2]),
}

impl Stopped {
    pub(super) fn of(self, surface: usize) -> TessellationError {
        match self {
            Stopped::TooLarge(most) => TessellationError::TooLarge { triangles: most + 1, most },
            Stopped::NotReached(parameters) => TessellationError::NotReached { surface, parameters },
            Stopped::NotFinite(parameters) => TessellationError::NotFinite { surface, parameters },
        }
    }
}

impl<'a> Refinement<'a> {
    pub(super) fn new(
        surface: &'a dyn Surface,
        table: &'a Table,
        nodes: Vec<Node>,
        positions: Vec<Vec3>,
        triangles: Vec<[Local; 3]>,
    ) -> Refinement<'a> {
        let twins = Topology::new(&triangles).twins().to_vec();
        let mut new =
            Refinement { surface, table, nodes, positions, triangles, twins, ratios: Vec::new(), told: 0.0 };
        new.ratios = new.ratios_of_all();
        new
    }

    fn ratios_of_all(&self) -> Vec<f64> {
        if self.table.proven {
            return self.triangles.iter().map(|&triangle| self.ratio(triangle)).collect();
        }
        let parameters: Vec<_> = self.triangles.iter().map(|&triangle| self.parameters(triangle)).collect();
        let corners: Vec<_> = self.triangles.iter().map(|&triangle| self.corners(triangle)).collect();
        let enough = |t: usize| SURE * self.allowed(&parameters[t]);
        let found = check::distances(self.surface, &PLACES, &parameters, &corners, enough);
        let each = found.chunks(PLACES.len()).enumerate();
        each.map(|(t, found)| self.measured(&parameters[t], corners[t], found)).collect()
    }

    /// Mends until every triangle passes, between its places too.
    pub(super) fn run(&mut self, care: Care, room: u64) -> Result<(), Stopped> {
        if let Some(place) = self.positions.iter().position(|point| !point.is_finite()) {
            return Err(Stopped::NotFinite(self.nodes[place].at));
        }
        let all = (0..self.triangles.len() as u32).rev().collect();
        self.mend(all, !care.by_place, care, room)?;
        if self.table.proven {
            return Ok(());
        }
        self.mend_between(care, room);
        Ok(())
    }

    /// Flips and splits until some triangles and what is made of them pass.
    pub(super) fn mend(
        &mut self,
        mut pending: Vec<u32>,
        flips: bool,
        care: Care,
        room: u64,
    ) -> Result<(), Stopped> {
        while let Some(t) = pending.pop() {
            if self.ratios[t as usize] <= 1.0 {
                continue;
            }
            let better = || if flips { self.better_flip(t) } else { None };
            let flip = self.flip_of_thin(t).or_else(better);
            let touched = match flip {
                Some(half_edge) => self.flip(half_edge).to_vec(),
                None => {
                    let half_edge = self.edge_to_split(t, care.by_place)?;
                    if self.triangles.len() as u64 >= room {
                        return Err(Stopped::TooLarge(room));
                    }
                    self.split(half_edge)?.to_vec()
                }
            };
            pending.push(t);
            pending.extend(touched);
        }
        Ok(())
    }

    pub(super) fn parameters(&self, triangle: [Local; 3]) -> [[f64; 2]; 3] {
        settled(triangle.map(|local| self.nodes[local as usize]))
    }

    fn ratio(&self, triangle: [Local; 3]) -> f64 {
        let parameters = self.parameters(triangle);
        if self.table.proven {
            let ratio = if self.table.closed_form {
                let bound = || self.surface.triangle_bound(self.corners(triangle));
                let bound = bound().filter(|_| !self.table.goes_around(&parameters));
                bound.unwrap_or(f64::INFINITY) / self.table.tolerance(&parameters)
            } else {
                check::bound(self.table, self.surface, &parameters)
            };
            return if ratio.is_nan() { f64::INFINITY } else { ratio };
        }
        let corners = self.corners(triangle);
        let enough = SURE * self.allowed(&parameters);
        let found = check::distances(self.surface, &PLACES, &[parameters], &[corners], |_| enough);
        self.measured(&parameters, corners, &found)
    }

    /// What measured distances of a triangle may be.
    pub(super) fn allowed(&self, parameters: &[[f64; 2]; 3]) -> f64 {
        MEASURED_SHARE * self.table.tolerance(parameters)
    }

    /// The largest distance found over what is allowed.
    fn measured(&self, parameters: &[[f64; 2]; 3], corners: [Vec3; 3], found: &[f64]) -> f64 {
        let allowed = self.allowed(parameters);
        let known = SURE * allowed;
        let ratio = check::measure(self.surface, &PLACES, parameters, corners, found, known) / allowed;
        if ratio.is_nan() { f64::INFINITY } else { ratio }
    }

    pub(super) fn corners(&self, triangle: [Local; 3]) -> [Vec3; 3] {
        triangle.map(|local| self.positions[local as usize])
    }

    fn corner(&self, half_edge: u32) -> Local {
        self.triangles[half_edge as usize / 3][half_edge as usize % 3]
    }

    /// The four corners around an inner half-edge from a to b: a, b, and the corners on its left and its right.
    fn around(&self, half_edge: u32) -> Option<[Local; 4]> {
        let twin = self.twins[half_edge as usize];
        (twin != NONE).then(|| {
            [
                self.corner(half_edge),
                self.corner(twin),
                self.corner(Topology::previous(half_edge)),
                self.corner(Topology::previous(twin)),
            ]
        })
    }

    /// The side of a thin triangle whose flip leaves none: halves of it would become flat.
    fn flip_of_thin(&self, t: u32) -> Option<u32> {
        let is_thin = |triangle: [Local; 3]| !self.turns_left(triangle, THINNEST);
        if !is_thin(self.triangles[t as usize]) {
            return None;
        }
        (3 * t..3 * t + 3).find(|&half_edge| {
            self.around(half_edge).is_some_and(|corners| {
                let has_pole = corners.iter().any(|&local| self.nodes[local as usize].free.is_some());
                let [a, b, c, d] = corners;
                !has_pole && ![[c, d, b], [d, c, a]].into_iter().any(is_thin)
            })
        })
    }

    /// The side of a triangle whose flip makes the worse of its two triangles better, the best of them.
    fn better_flip(&self, t: u32) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        for half_edge in 3 * t..3 * t + 3 {
            let Some([a, b, c, d]) = self.around(half_edge) else { continue };
            if [a, b, c, d].iter().any(|&local| self.nodes[local as usize].free.is_some()) {
                continue;
            }
            let new = [[c, d, b], [d, c, a]];
            if !new.iter().all(|&triangle| self.turns_left(triangle, THINNEST)) {
                continue;
            }
            let twin = self.twins[half_edge as usize];
            let old = self.ratios[t as usize].max(self.ratios[twin as usize / 3]);
            let worse = self.ratio(new[0]).max(self.ratio(new[1]));
            // Strictly better, so that no flip is ever undone.
            if worse < 0.999 * old && best.is_none_or(|(least, _)| worse < least) {
                best = Some((worse, half_edge));
            }
        }
        best.map(|(_, half_edge)| half_edge)
    }

    fn turns_left(&self, triangle: [Local; 3], share: f64) -> bool {
        turns_left(self.parameters(triangle), share, self.surface.domain())
    }

    /// Replaces the diagonal ab by cd. Returns the triangles that changed.
    fn flip(&mut self, half_edge: u32) -> [u32; 2] {
        let twin = self.twins[half_edge as usize];
        let [a, b, c, d] = self.around(half_edge).expect("flipped edges are inside");
        let (t, s) = (half_edge / 3, twin / 3);
        let outer = |next: fn(u32) -> u32, h: u32| self.twins[next(h) as usize];
        let (bc, ca) = (outer(Topology::next, half_edge), outer(Topology::previous, half_edge));
        let (ad, db) = (outer(Topology::next, twin), outer(Topology::previous, twin));
        self.triangles[t as usize] = [c, d, b];
        self.triangles[s as usize] = [d, c, a];
        self.join(3 * t, 3 * s);
        self.join(3 * t + 1, db);
        self.join(3 * t + 2, bc);
        self.join(3 * s + 1, ca);
        self.join(3 * s + 2, ad);
        for triangle in [t, s] {
            self.ratios[triangle as usize] = self.ratio(self.triangles[triangle as usize]);
        }
        [t, s]
    }

    fn join(&mut self, half_edge: u32, twin: u32) {
        self.twins[half_edge as usize] = twin;
        if twin != NONE {
            self.twins[twin as usize] = half_edge;
        }
    }

    /// The longest inner side of a triangle, in segments or in space.
    fn longest(&self, t: u32, in_space: bool) -> Option<(f64, u32)> {
        let triangle = self.triangles[t as usize];
        let at = self.parameters(triangle);
        let length = |h: u32| {
            let (k, next) = (h as usize % 3, (h as usize + 1) % 3);
            if !in_space {
                return self.table.length_squared(at[k], at[next]);
            }
            // Over the middle: a fold can bring the ends together.
            let middle = self.surface.point(0.5 * (at[k][0] + at[next][0]), 0.5 * (at[k][1] + at[next][1]));
            [k, next].map(|k| self.positions[triangle[k] as usize].distance(middle)).into_iter().sum()
        };
        let inner = (3 * t..3 * t + 3).filter(|&h| self.twins[h as usize] != NONE);
        inner.map(|h| (length(h), h)).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// From a triangle over longest sides to one that is the longest on both of its own.
    fn edge_to_split(&self, t: u32, in_space: bool) -> Result<u32, Stopped> {
        let nowhere = || Stopped::NotReached(self.parameters(self.triangles[t as usize])[0]);
        // What fails without any width, on an edge that cannot be split, fails for ever. At a pole parameters are any.
        let has_pole = self.triangles[t as usize].iter().any(|&v| self.nodes[v as usize].free.is_some());
        if !has_pole && !self.turns_left(self.triangles[t as usize], FLAT) {
            return Err(nowhere());
        }
        let (mut length, mut half_edge) = self.longest(t, in_space).ok_or_else(nowhere)?;
        loop {
            let twin = self.twins[half_edge as usize];
            match self.longest(twin / 3, in_space) {
                Some((longer, next)) if longer > length && next != twin => {
                    (length, half_edge) = (longer, next);
                }
                _ => return Ok(half_edge),
            }
        }
    }

    /// Puts a vertex into the middle of an inner side ab. Returns the triangles that changed or are new.
    fn split(&mut self, half_edge: u32) -> Result<[u32; 4], Stopped> {
        let [a, b, c, d] = self.around(half_edge).expect("split edges are inside");
        let m = self.middle(a, b)?;
        let twin = self.twins[half_edge as usize];
        let (t, s) = (half_edge / 3, twin / 3);
        let (bc, ca) = (
            self.twins[Topology::next(half_edge) as usize],
            self.twins[Topology::previous(half_edge) as usize],
        );
        let (ad, db) =
            (self.twins[Topology::next(twin) as usize], self.twins[Topology::previous(twin) as usize]);
        let (p, q) = (self.triangles.len() as u32, self.triangles.len() as u32 + 1);
        self.triangles[t as usize] = [a, m, c];
        self.triangles[s as usize] = [m, a, d];
        self.triangles.push([m, b, c]);
        self.triangles.push([b, m, d]);
        self.twins.extend([NONE; 6]);
        self.join(3 * t, 3 * s);
        self.join(3 * t + 1, 3 * p + 2);
        self.join(3 * t + 2, ca);
        self.join(3 * s + 1, ad);
        self.join(3 * s + 2, 3 * q + 1);
        self.join(3 * p, 3 * q);
        self.join(3 * p + 1, bc);
        self.join(3 * q + 2, db);
        self.ratios.extend([0.0; 2]);
        for triangle in [t, s, p, q] {
            self.ratios[triangle as usize] = self.ratio(self.triangles[triangle as usize]);
        }
        Ok([t, s, p, q])
    }

    /// A new vertex between two; from a pole straight along the other axis.
    fn middle(&mut self, a: Local, b: Local) -> Result<Local, Stopped> {
        let [p, q] = [a, b].map(|local| self.nodes[local as usize]);
        let mut at = [0, 1].map(|axis: usize| 0.5 * p.at[axis] + 0.5 * q.at[axis]);
        match (p.free, q.free) {
            (Some(axis), None) => at[axis] = q.at[axis],
            (None, Some(axis)) => at[axis] = p.at[axis],
            _ => {}
        }
        let domain = self.surface.domain();
        let near = |axis: usize| {
            (p.at[axis] - q.at[axis]).abs()
                <= FINEST * (domain[axis][1] - domain[axis][0]).abs().max(at[axis].abs())
        };
        if near(0) && near(1) {
            return Err(Stopped::NotReached(at));
        }
        let point = self.surface.point(at[0], at[1]);
        if !point.is_finite() {
            return Err(Stopped::NotFinite(at));
        }
        self.nodes.push(Node { shared: None, at, free: None });
        self.positions.push(point);
        Ok(self.nodes.len() as Local - 1)
    }
}
