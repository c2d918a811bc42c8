//! What the usual places of triangles do not see: distances between them, and those from the surface back to the mesh.
//!
//! A place of a triangle may be near the surface though the point at its parameters is far from the mesh: where parameters run
//! unevenly the nearest points of all places need not cover the surface. So both are looked at wherever the two are apart.

use super::Care;
use super::check;
use super::frame::Local;
use super::refine::{MEASURED_SHARE, Refinement, SURE};
use super::table::{MOST_STEPS, PARTS_UNKNOWN, Parts};
use crate::math::Vec3;
use crate::mesh::Topology;
use crate::surface::{Surface, least_distance};

impl Refinement<'_> {
    /// Mends what fails between the usual places, where that can be done.
    pub(super) fn mend_between(&mut self, care: Care, room: u64) {
        /// Few triangles fail; where mending takes more than this, distances are not found, as along the crease of a fold.
        const MORE: u64 = 256;
        let count = self.triangles.len() as u64;
        let room = room.min(count + count / 2 + MORE);
        let mut seen: Vec<[Local; 3]> = Vec::new();
        loop {
            seen.resize(self.triangles.len(), [0; 3]);
            let is_new = |&t: &u32| self.triangles[t as usize] != seen[t as usize];
            let new: Vec<u32> = (0..self.triangles.len() as u32).filter(is_new).collect();
            let failing = self.failing_between(&new);
            if failing.is_empty() {
                return;
            }
            let before = self.clone();
            seen.copy_from_slice(&self.triangles);
            for failing in &failing {
                self.ratios[failing.triangle as usize] = failing.ratio;
            }
            // No flips: they compare what is found at the usual places, and could undo each other where more is known.
            let pending = failing.iter().map(|failing| failing.triangle).collect();
            if self.mend(pending, false, care, room).is_err() {
                *self = before;
                // What was found is part of the distance that is told.
                self.told = failing.iter().fold(self.told, |told, failing| told.max(failing.distance));
                return;
            }
        }
    }

    /// Those of some triangles that fail at so many places that the bends of the surface leave no more than is kept back for
    /// what lies between them; what the others are off is told.
    fn failing_between(&mut self, triangles: &[u32]) -> Vec<Failing> {
        let parts: Vec<Option<Parts>> = triangles.iter().map(|&t| self.parts(t)).collect();
        let mut failing = Vec::new();
        for count in 2..=MOST_STEPS {
            let with = parts.iter().zip(triangles).filter_map(|(parts, &t)| Some((t, (*parts)?)));
            let with: Vec<(u32, Parts)> = with.filter(|(_, parts)| parts.count == count).collect();
            let own = |t: u32| self.triangles[t as usize];
            let parameters: Vec<_> = with.iter().map(|&(t, _)| self.parameters(own(t))).collect();
            let corners: Vec<_> = with.iter().map(|&(t, _)| self.corners(own(t))).collect();
            let allowed: Vec<f64> = parameters.iter().map(|own| self.allowed(own)).collect();
            let places = check::places(count);
            let found = check::distances(self.surface, &places, &parameters, &corners, |k| allowed[k]);
            for (k, found) in found.chunks(places.len()).enumerate() {
                let (t, Parts { rest, .. }) = with[k];
                let tolerance = allowed[k] / MEASURED_SHARE;
                // Nearest points may be farther apart than the places they are nearest to, so all that is kept back is told.
                let rest = rest.max(1.0 - MEASURED_SHARE) * tolerance;
                let known = (self.told - rest).clamp(0.0, allowed[k]);
                let most =
                    check::measure_folds(self.surface, &places, &parameters[k], corners[k], found, known);
                let most = (most + rest).max(self.distance_back(t, tolerance));
                let ratio = most / tolerance;
                if ratio > 1.0 {
                    failing.push(Failing { triangle: t, ratio, distance: most });
                } else {
                    self.told = self.told.max(most);
                }
            }
        }
        failing
    }

    /// How finely a triangle must be looked at; `None` where what bends it cannot make it fail.
    fn parts(&self, t: u32) -> Option<Parts> {
        self.table.parts(&self.parameters(self.triangles[t as usize]), 1.0 - MEASURED_SHARE)
    }

    /// The largest distance from the part of the surface that a triangle stands for back to the mesh: that part is cut until
    /// each part of it is within the tolerance of one flat triangle, at its corners and with what bends it between them.
    fn distance_back(&self, t: u32, tolerance: f64) -> f64 {
        let parameters = self.parameters(self.triangles[t as usize]);
        let Some(whole) = self.table.whole(&parameters) else { return self.distance_of_points_back(t) };
        let points = parameters.map(|[u, v]| self.surface.point(u, v));
        let flat = self.corners(self.triangles[t as usize]);
        let part = Part { parameters, points, flat, cuts: 0 };
        let mut pending = vec![part];
        let mut most: f64 = 0.0;
        while let Some(part) = pending.pop() {
            let bend = whole * tolerance / f64::from(1 << (2 * part.cuts));
            let mut near = part.apart();
            if near + bend > tolerance {
                near = self.distance_to_one(t, &part.points, tolerance - bend).min(near);
            }
            if near + bend <= tolerance {
                most = most.max(near + bend);
            } else if part.cuts < MOST_CUTS {
                pending.extend(part.quarters(self.surface));
            } else {
                return if near.is_nan() { f64::INFINITY } else { near + bend };
            }
        }
        most
    }

    /// [`Self::distance_back`] where bends are not known: that of some points, however near others are.
    fn distance_of_points_back(&self, t: u32) -> f64 {
        let parameters = self.parameters(self.triangles[t as usize]);
        let enough = self.allowed(&parameters);
        let back = |weights: [f64; 3]| {
            let [u, v] = check::mixed(weights, &parameters);
            self.distance_to_one(t, &[self.surface.point(u, v); 3], enough)
        };
        check::places(PARTS_UNKNOWN).into_iter().map(back).fold(0.0, f64::max)
    }

    /// The distance of some points from a single triangle, any that is enough or the nearest there is: from triangle to
    /// neighbouring triangle, the nearest first.
    fn distance_to_one(&self, start: u32, points: &[Vec3; 3], enough: f64) -> f64 {
        /// Points slide over few triangles: those around a corner, about.
        const MOST: usize = 12;
        let distance = |t: u32| {
            let corners = self.corners(self.triangles[t as usize]);
            let of = |point: &Vec3| least_distance(corners.map(|corner| corner - *point));
            points.iter().map(of).fold(0.0, f64::max)
        };
        let mut seen = vec![start];
        let mut front = vec![(distance(start), start)];
        let mut best = f64::INFINITY;
        while let Some(nearest) = (0..front.len()).min_by(|&a, &b| front[a].0.total_cmp(&front[b].0)) {
            let (here, t) = front.swap_remove(nearest);
            best = best.min(here);
            if enough < 0.0 || best <= enough || seen.len() > MOST {
                break;
            }
            for half_edge in 3 * t..3 * t + 3 {
                let twin = self.twins[half_edge as usize];
                if twin != Topology::NONE && !seen.contains(&(twin / 3)) {
                    seen.push(twin / 3);
                    front.push((distance(twin / 3), twin / 3));
                }
            }
        }
        best
    }

    /// The largest distance known of, both ways: found, and what bends leave between the places it was found at.
    pub(super) fn distance(&self) -> f64 {
        let parameters: Vec<_> = self.triangles.iter().map(|&triangle| self.parameters(triangle)).collect();
        let mut told = self.told;
        for (own, found) in parameters.iter().zip(self.found(&parameters)) {
            let tolerance = self.table.tolerance(own);
            let between = match self.table.whole(own) {
                // The usual places are the corners and the middle of halves.
                Some(whole) if whole <= 1.0 => (whole * tolerance).min(found + 0.25 * whole * tolerance),
                _ => found,
            };
            told = told.max(between).max(found);
        }
        told
    }

    /// The distances found at the usual places; small ones are not exact where there are large ones.
    fn found(&self, parameters: &[[[f64; 2]; 3]]) -> Vec<f64> {
        if self.ratios.iter().any(|&ratio| ratio > SURE) {
            let ratios = self.ratios.iter().zip(parameters);
            return ratios.map(|(ratio, own)| ratio.min(1.0) * self.allowed(own)).collect();
        }
        let places = &check::PLACES;
        let corners: Vec<_> = self.triangles.iter().map(|&triangle| self.corners(triangle)).collect();
        let found = check::distances(self.surface, places, parameters, &corners, |_| 0.0);
        let each = found.chunks(places.len()).enumerate();
        let distance = |(t, found): (usize, &[f64])| {
            check::measure(self.surface, places, &parameters[t], corners[t], found, 0.0)
        };
        each.map(distance).collect()
    }
}

/// Most times that what a triangle stands for is cut into quarters.
const MOST_CUTS: u32 = 6;

/// A part of what a triangle stands for.
struct Part {
    parameters: [[f64; 2]; 3],
    points: [Vec3; 3],
    /// Points of the triangle at the same parameters.
    flat: [Vec3; 3],
    cuts: u32,
}

impl Part {
    /// How far corners are from those of the triangle.
    fn apart(&self) -> f64 {
        [0, 1, 2].map(|k: usize| self.points[k].distance(self.flat[k])).into_iter().fold(0.0, f64::max)
    }

    /// Three at its corners, and the one between them.
    fn quarters(&self, surface: &dyn Surface) -> [Part; 4] {
        let Part { parameters: [a, b, c], points: [p, q, r], flat: [x, y, z], .. } = *self;
        let middle = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|axis: usize| 0.5 * a[axis] + 0.5 * b[axis]);
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        let [pq, qr, rp] = [ab, bc, ca].map(|[u, v]| surface.point(u, v));
        let [xy, yz, zx] = [0.5 * x + 0.5 * y, 0.5 * y + 0.5 * z, 0.5 * z + 0.5 * x];
        let part = |parameters, points, flat| Part { parameters, points, flat, cuts: self.cuts + 1 };
        [
            part([a, ab, ca], [p, pq, rp], [x, xy, zx]),
            part([ab, b, bc], [pq, q, qr], [xy, y, yz]),
            part([ca, bc, c], [rp, qr, r], [zx, yz, z]),
            part([ab, bc, ca], [pq, qr, rp], [xy, yz, zx]),
        ]
    }
}

/// A triangle that fails.
struct Failing {
    triangle: u32,
    /// Over what is allowed.
    ratio: f64,
    distance: f64,
}
