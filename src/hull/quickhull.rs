//! Quickhull (Barber, Dobkin and Huhdanpaa 1996) with exact signs.
//!
//! A point counts as outside a facet only where it is strictly above its plane. So facets are never degenerate, points
//! in the plane of a facet end up in facets of the same plane, and the surface is convex, if not strictly so.

use crate::math::Vec3;
use crate::numeric::{orient2d, orient3d};

/// Triangles of the convex hull of different points, coplanar ones included; none where all are in one plane.
pub(super) fn surface(at: &[Vec3]) -> Vec<[u32; 3]> {
    let Some(simplex) = simplex(at) else { return Vec::new() };
    let mut hull = Hull::new(at, simplex);
    while let Some(facet) = hull.pending.pop() {
        if hull.facets[facet as usize].alive && !hull.facets[facet as usize].outside.is_empty() {
            hull.grow(facet);
        }
    }
    hull.facets.iter().filter(|facet| facet.alive).map(|facet| facet.corners).collect()
}

struct Facet {
    /// Counter-clockwise seen from outside.
    corners: [u32; 3],
    /// The facet beyond the side from each corner to the next.
    neighbors: [u32; 3],
    /// Points strictly above, each listed with one facet only.
    outside: Vec<u32>,
    alive: bool,
    /// The last point from which it was looked at, and whether it was seen.
    seen: (u32, bool),
}

impl Facet {
    fn new(corners: [u32; 3], neighbors: [u32; 3]) -> Facet {
        Facet { corners, neighbors, outside: Vec::new(), alive: true, seen: (u32::MAX, false) }
    }
}

struct Hull<'a> {
    at: &'a [Vec3],
    facets: Vec<Facet>,
    /// Facets that may have points outside.
    pending: Vec<u32>,
    /// For each point, the newest facet whose horizon edge starts there.
    starting_at: Vec<u32>,
}

/// A side of the visible part: the edge, and the facet beyond that stays.
struct Horizon {
    from: u32,
    to: u32,
    beyond: u32,
}

impl<'a> Hull<'a> {
    /// The tetrahedron on four points of positive volume, with every point above it at one of its facets.
    fn new(at: &'a [Vec3], [a, b, c, d]: [u32; 4]) -> Hull<'a> {
        let facets = vec![
            Facet::new([a, c, b], [2, 3, 1]),
            Facet::new([a, b, d], [0, 3, 2]),
            Facet::new([c, a, d], [0, 1, 3]),
            Facet::new([b, c, d], [0, 2, 1]),
        ];
        let mut hull = Hull { at, facets, pending: Vec::new(), starting_at: vec![u32::MAX; at.len()] };
        hull.hand_out(0..at.len() as u32, &[0, 1, 2, 3]);
        hull
    }

    /// Adds the point farthest above `facet`, which has some.
    fn grow(&mut self, facet: u32) {
        let eye = self.farthest(facet);
        let (visible, horizon) = self.seen_from(eye, facet);
        let first = self.facets.len() as u32;
        for (edge, number) in horizon.iter().zip(first..) {
            self.starting_at[edge.from as usize] = number;
        }
        for edge in &horizon {
            let number = self.facets.len() as u32;
            let after = self.starting_at[edge.to as usize];
            let corners = [edge.from, edge.to, eye];
            // The side to the left neighbour is set by that neighbour, below.
            self.facets.push(Facet::new(corners, [edge.beyond, after, u32::MAX]));
            let beyond = &mut self.facets[edge.beyond as usize];
            let side =
                (0..3).find(|&i| beyond.corners[i] == edge.to && beyond.corners[(i + 1) % 3] == edge.from);
            beyond.neighbors[side.expect("the neighbour shares the edge")] = number;
        }
        let made: Vec<u32> = (first..self.facets.len() as u32).collect();
        for &number in &made {
            let after = self.facets[number as usize].neighbors[1];
            self.facets[after as usize].neighbors[2] = number;
        }
        let mut orphans = Vec::new();
        for old in visible {
            let old = &mut self.facets[old as usize];
            old.alive = false;
            orphans.append(&mut old.outside);
        }
        self.hand_out(orphans.into_iter().filter(|&p| p != eye), &made);
    }

    /// Lists each point with the first of the facets it is strictly above, if any.
    fn hand_out(&mut self, points: impl Iterator<Item = u32>, facets: &[u32]) {
        for point in points {
            if let Some(&facet) = facets.iter().find(|&&facet| self.is_above(point, facet)) {
                self.facets[facet as usize].outside.push(point);
            }
        }
        self.pending.extend(facets);
    }

    fn is_above(&self, point: u32, facet: u32) -> bool {
        let [a, b, c] = self.facets[facet as usize].corners;
        let at = |v: u32| self.at[v as usize];
        orient3d(at(a), at(b), at(c), at(point)) > 0.0
    }

    /// The point outside `facet` farthest from its plane as far as rounding can tell, which affects only the speed.
    fn farthest(&self, facet: u32) -> u32 {
        let Facet { corners, outside, .. } = &self.facets[facet as usize];
        let [a, b, c] = corners.map(|v| self.at[v as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let height = |p: u32| (self.at[p as usize] - a).dot(normal);
        let higher = |best: u32, &p: &u32| if height(p) > height(best) { p } else { best };
        outside[1..].iter().fold(outside[0], higher)
    }

    /// The facets that `eye` is strictly above, found from one of them, and the edges around them.
    fn seen_from(&mut self, eye: u32, facet: u32) -> (Vec<u32>, Vec<Horizon>) {
        let mut visible = vec![facet];
        self.facets[facet as usize].seen = (eye, true);
        let mut horizon = Vec::new();
        let mut next = 0;
        while let Some(&number) = visible.get(next) {
            next += 1;
            let Facet { corners, neighbors, .. } = self.facets[number as usize];
            for side in 0..3 {
                let beyond = neighbors[side];
                if self.facets[beyond as usize].seen.0 != eye {
                    let is_visible = self.is_above(eye, beyond);
                    self.facets[beyond as usize].seen = (eye, is_visible);
                    visible.extend(is_visible.then_some(beyond));
                }
                if !self.facets[beyond as usize].seen.1 {
                    horizon.push(Horizon { from: corners[side], to: corners[(side + 1) % 3], beyond });
                }
            }
        }
        (visible, horizon)
    }
}

/// Four points of positive volume, far apart; `None` where all points are in one plane.
fn simplex(at: &[Vec3]) -> Option<[u32; 4]> {
    let a = *at.first()?;
    let b = most(at, |p| p.distance_squared(a), |p| p != a)?;
    let along = at[b] - a;
    let c = most(at, |p| along.cross(p - a).length_squared(), |p| !on_one_line(a, at[b], p))?;
    let normal = along.cross(at[c] - a);
    let volume = |p: Vec3| orient3d(a, at[b], at[c], p);
    let d = most(at, |p| normal.dot(p - a).abs(), |p| volume(p) != 0.0)?;
    let [b, c, d] = [b, c, d].map(|i| i as u32);
    Some(if volume(at[d as usize]) > 0.0 { [0, b, c, d] } else { [0, c, b, d] })
}

/// The point of the largest rounded measure if it passes an exact test, else any that does.
fn most(at: &[Vec3], measure: impl Fn(Vec3) -> f64, passes: impl Fn(Vec3) -> bool) -> Option<usize> {
    let best = (0..at.len()).max_by(|&i, &j| measure(at[i]).total_cmp(&measure(at[j])))?;
    if passes(at[best]) { Some(best) } else { at.iter().position(|&p| passes(p)) }
}

fn on_one_line(a: Vec3, b: Vec3, c: Vec3) -> bool {
    let flat = |f: fn(Vec3) -> crate::math::Vec2| orient2d(f(a), f(b), f(c)) == 0.0;
    flat(Vec3::truncate) && flat(|p| p.truncate().with_x(p.z)) && flat(|p| p.truncate().with_y(p.z))
}
