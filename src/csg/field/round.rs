//! Meshes of round bodies within a tolerance that need no search: every vertex lies on the surface.
//!
//! A ball is eight octants of a sphere, each divided like a triangle into n^2 smaller ones. A point of an octant is the
//! mean of the three that great arcs parallel to its sides would give, which makes the triangles nearly equal: about 1.14
//! times as many as the least that vertices on the sphere allow, 8 pi R / (3 sqrt 3 e). Seen from the middle each triangle
//! covers what is above it, so mesh and sphere are as far apart as the lowest triangle is below the sphere.
//!
//! The sum of a ball and a box (or a segment) takes the octants apart and joins them by rectangles: sums with the same convex
//! body are no further apart than what was added to it. A ring or a cylinder with rounded rims is a polygon turned about the
//! axis, and half of the tolerance goes to each.

use crate::math::{Vec2, Vec3, acos, sin, sin_cos_degrees, unit_circle};
use crate::mesh::{Mesh, Solid};
use crate::polygon::triangulate;
use std::f64::consts::{FRAC_PI_2, PI};

/// Parts of the size of a body that are too small to be drawn beside it: numbers would not tell their corners apart.
const SMALLEST: f64 = 1.0 / (1_u64 << 20) as f64;

/// Most steps along a side of an octant: fifty million triangles.
const MOST_STEPS: u32 = 2500;

/// A body made of eight octants of a sphere or ellipsoid.
pub(in crate::csg) struct Rounded {
    /// Half of each side, rounding included.
    half: Vec3,
    /// Half of each side of the box or segment in the middle.
    core: Vec3,
    octant: Octant,
    /// Greatest distance between mesh and surface.
    pub(super) error: f64,
}

impl Rounded {
    /// All points within a distance of a box.
    pub(super) fn around(core: Vec3, half: Vec3, radius: f64, tolerance: f64) -> Option<Rounded> {
        if radius < SMALLEST * half.max_element() || core.to_array().iter().any(|&c| is_film(c, radius)) {
            return None;
        }
        let octant = Octant::within(tolerance / radius)?;
        let error = radius * octant.error;
        Some(Rounded { half, core, octant, error })
    }

    /// An ellipsoid: a map stretches no distance more than the longest half-axis.
    pub(super) fn ellipsoid(radii: Vec3, tolerance: f64) -> Option<Rounded> {
        let longest = radii.max_element();
        if radii.min_element() < SMALLEST * longest {
            return None;
        }
        let octant = Octant::within(tolerance / longest)?;
        let error = longest * octant.error;
        Some(Rounded { half: radii, core: Vec3::ZERO, octant, error })
    }

    pub(super) fn triangles(&self) -> u64 {
        let steps = u64::from(self.octant.steps);
        let wide = self.core.to_array().map(|c| u64::from(c > 0.0));
        let faces = (0..3).map(|a| wide[(a + 1) % 3] * wide[(a + 2) % 3]).sum::<u64>();
        8 * steps * steps + 8 * steps * wide.iter().sum::<u64>() + 4 * faces
    }

    pub(super) fn solid(&self) -> Solid {
        let names = self.names();
        let mut mesh = Mesh::new(self.positions(&names), Vec::new());
        for (names, signs) in names.iter().zip(0_u32..) {
            let mirrored = signs.count_ones() % 2 == 1;
            for [a, b, c] in self.octant.triangles() {
                let triangle = if mirrored { [a, c, b] } else { [a, b, c] };
                mesh.triangles.push(triangle.map(|place| names[place]));
            }
        }
        (0..3).for_each(|axis| self.join_sides(axis, &names, &mut mesh));
        (0..3).for_each(|axis| self.close_ends(axis, &names, &mut mesh));
        // Octants lie apart, on the outer side of three planes each, and seen from its middle no two triangles of one
        // overlap.
        Solid::assume(mesh, true)
    }

    /// For each octant, by the bits of its negative axes, the vertices of its places. Octants that are not taken apart along
    /// an axis share those on the plane across it.
    fn names(&self) -> [Vec<u32>; 8] {
        let mut names: [Vec<u32>; 8] = Default::default();
        let mut next = 0;
        for signs in 0..8_usize {
            for place in 0..self.octant.weights.len() {
                let weights = self.octant.weights[place];
                let shared = (0..3).filter(|&a| self.core[a] == 0.0 && weights[a] == 0);
                let first = shared.fold(signs, |bits, a| bits & !(1 << a));
                let name = if first == signs { next } else { names[first][place] };
                next += u32::from(first == signs);
                names[signs].push(name);
            }
        }
        names
    }

    fn positions(&self, names: &[Vec<u32>; 8]) -> Vec<Vec3> {
        let count = names.iter().flatten().max().map_or(0, |&last| last as usize + 1);
        let mut positions = vec![Vec3::ZERO; count];
        for (signs, names) in names.iter().enumerate() {
            for (&direction, &name) in self.octant.directions.iter().zip(names) {
                let along = |a: usize| {
                    // What reaches furthest does so to the bit.
                    let whole = direction[a] == 1.0;
                    let out = self.core[a] + (self.half[a] - self.core[a]) * direction[a];
                    let out = if whole { self.half[a] } else { out };
                    if signs >> a & 1 == 1 { -out } else { out }
                };
                // Adding zero turns -0 into 0.
                positions[name as usize] = Vec3::new(along(0), along(1), along(2)) + Vec3::ZERO;
            }
        }
        positions
    }

    /// Rectangles between octants that were taken apart along an axis.
    fn join_sides(&self, axis: usize, names: &[Vec<u32>; 8], mesh: &mut Mesh) {
        if self.core[axis] == 0.0 {
            return;
        }
        let (steps, [b, c]) = (self.octant.steps, [(axis + 1) % 3, (axis + 2) % 3]);
        // The arc in the plane of the other two, from one to the other.
        let arc = |k: u32| {
            let mut weights = [0; 3];
            (weights[b], weights[c]) = (steps - k, k);
            self.octant.place(weights)
        };
        for k in 0..steps {
            for signs in [0, 1 << b, 1 << c, 1 << b | 1 << c] {
                let [low, high] = [signs | 1 << axis, signs];
                let ring = [
                    names[low][arc(k)],
                    names[low][arc(k + 1)],
                    names[high][arc(k + 1)],
                    names[high][arc(k)],
                ];
                push_rectangle(mesh, ring, signs.count_ones() == 1);
            }
        }
    }

    /// The flat faces at both ends of an axis.
    fn close_ends(&self, axis: usize, names: &[Vec<u32>; 8], mesh: &mut Mesh) {
        let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
        if self.core[b] == 0.0 || self.core[c] == 0.0 {
            return;
        }
        let mut weights = [0; 3];
        weights[axis] = self.octant.steps;
        let place = self.octant.place(weights);
        for end in [0, 1 << axis] {
            let ring = [1 << b | 1 << c, 1 << c, 0, 1 << b].map(|signs: usize| names[signs | end][place]);
            push_rectangle(mesh, ring, end != 0);
        }
    }
}

fn push_rectangle(mesh: &mut Mesh, [p, q, r, s]: [u32; 4], inverted: bool) {
    let [p, q, r, s] = if inverted { [s, r, q, p] } else { [p, q, r, s] };
    mesh.triangles.extend([[p, q, r], [p, r, s]]);
}

/// Whether a side is too short beside a radius to be told from none.
fn is_film(side: f64, radius: f64) -> bool {
    side > 0.0 && side < SMALLEST * radius
}

/// The part of the unit sphere between three axes, divided.
struct Octant {
    steps: u32,
    /// Steps from each side, for each place; rows of falling length.
    weights: Vec<[u32; 3]>,
    directions: Vec<Vec3>,
    /// How far the lowest triangle is below the sphere.
    error: f64,
}

impl Octant {
    /// The coarsest that is as near as this; `None` where that would be too many triangles.
    fn within(error: f64) -> Option<Octant> {
        // From 1.09 times the least number of triangles up.
        let mut steps = (0.66 / error).sqrt().max(1.0);
        while steps <= f64::from(MOST_STEPS) {
            let octant = Octant::divided(steps as u32);
            if octant.error <= error {
                return Some(octant);
            }
            steps += 1.0;
        }
        None
    }

    fn divided(steps: u32) -> Octant {
        let rows = (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| [i, j, steps - i - j]));
        let weights: Vec<[u32; 3]> = rows.collect();
        let directions = weights.iter().map(|&weights| direction(weights)).collect();
        let mut octant = Octant { steps, weights, directions, error: 0.0 };
        let depth = |triangle: [usize; 3]| {
            let [a, b, c] = triangle.map(|place| octant.directions[place]);
            let normal = (b - a).cross(c - a);
            1.0 - a.dot(normal) / normal.length()
        };
        // A few places are lost in the product.
        octant.error = octant.triangles().map(depth).fold(0.0, f64::max) + 16.0 * f64::EPSILON;
        octant
    }

    /// Where a point is among all.
    fn place(&self, [i, j, _]: [u32; 3]) -> usize {
        let (i, j, row) = (i as usize, j as usize, self.steps as usize + 1);
        i * row - i * (i.max(1) - 1) / 2 + j
    }

    /// By places, counter-clockwise seen from outside.
    fn triangles(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        let at = |i: u32, j: u32| self.place([i, j, 0]);
        let squares = (0..self.steps).flat_map(move |i| (0..self.steps - i).map(move |j| (i, j)));
        squares.flat_map(move |(i, j)| {
            let upright = [at(i, j), at(i + 1, j), at(i, j + 1)];
            let inverted = (i + j + 1 < self.steps).then(|| [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            std::iter::once(upright).chain(inverted)
        })
    }
}

/// The point of the octant with these steps from its sides.
fn direction(weights: [u32; 3]) -> Vec3 {
    let steps = weights[0] + weights[1] + weights[2];
    let mut sum = Vec3::ZERO;
    for a in 0..3 {
        let [b, c] = [(a + 1) % 3, (a + 2) % 3];
        if weights[a] == steps {
            return Vec3::AXES[a];
        }
        // On two sides as far up as the point, and then along the great arc between them.
        let (up, across) = sin_cos_degrees(90.0 * f64::from(weights[a]) / f64::from(steps));
        let [from, to] = [b, c].map(|side| across * Vec3::AXES[side] + up * Vec3::AXES[a]);
        let share = f64::from(weights[c]) / f64::from(weights[b] + weights[c]);
        let angle = acos(up * up);
        sum += sin((1.0 - share) * angle) / sin(angle) * from + sin(share * angle) / sin(angle) * to;
    }
    sum.normalize()
}

/// A convex polygon of radius and height, turned about the z axis.
pub(in crate::csg) struct Turned {
    /// Counter-clockwise, radius to the right; an open one runs from the bottom to the top and is closed by flat ends.
    profile: Vec<Vec2>,
    closed: bool,
    sides: u32,
    /// Greatest distance between mesh and surface.
    pub(super) error: f64,
}

impl Turned {
    /// A torus that does not reach its axis.
    pub(super) fn ring(major: f64, minor: f64, tolerance: f64) -> Option<Turned> {
        let size = major + minor;
        if minor < SMALLEST * size || major - minor < SMALLEST * size {
            return None;
        }
        let share = 0.5 * tolerance;
        // Quarters keep the extents.
        let (sides, around) = (sides_within(size, share)?, sides_within(minor, share)?);
        let profile =
            (0..u64::from(around)).map(|k| Vec2::new(major, 0.0) + minor * unit_circle(k, around.into()));
        let error = sagitta(size, sides) + sagitta(minor, around);
        Some(Turned { profile: profile.collect(), closed: true, sides, error })
    }

    /// A cylinder with rounded rims.
    pub(super) fn cylinder(radius: f64, half_height: f64, rounding: f64, tolerance: f64) -> Option<Turned> {
        let size = radius.max(half_height);
        let straight = 2.0 * (half_height - rounding);
        if rounding < SMALLEST * size || radius - rounding < SMALLEST * size || is_film(straight, size) {
            return None;
        }
        let share = 0.5 * tolerance;
        let (sides, around) = (sides_within(radius, share)?, sides_within(rounding, share)?);
        let quarter = u64::from(around / 4);
        let rim = |k: u64, level: f64| {
            let direction = unit_circle(k, around.into());
            let out = |middle: f64, whole: f64, along: f64| {
                if along.abs() == 1.0 { whole * along } else { middle + rounding * along }
            };
            let x = out(radius - rounding, radius, direction.x);
            let beside = level * (half_height - rounding);
            Vec2::new(
                x,
                if direction.y == level { level * half_height } else { beside + rounding * direction.y },
            )
        };
        let mut profile: Vec<Vec2> =
            (3 * quarter..=4 * quarter).map(|k| rim(k % (4 * quarter), -1.0)).collect();
        // Without a straight part both rims share a ring.
        let first = u64::from(straight == 0.0);
        profile.extend((first..=quarter).map(|k| rim(k, 1.0)));
        let error = sagitta(radius, sides) + sagitta(rounding, around);
        Some(Turned { profile, closed: false, sides, error })
    }

    pub(super) fn triangles(&self) -> u64 {
        let (rings, sides) = (self.profile.len() as u64, u64::from(self.sides));
        if self.closed { 2 * rings * sides } else { 2 * (rings - 1) * sides + 2 * (sides - 2) }
    }

    pub(super) fn solid(&self) -> Solid {
        let (rings, sides) = (self.profile.len() as u32, self.sides);
        let ring = |p: &Vec2| {
            let (x, z) = (p.x, p.y);
            (0..u64::from(sides)).map(move |k| (x * unit_circle(k, sides.into())).extend(z))
        };
        let mut mesh = Mesh::new(self.profile.iter().flat_map(ring).collect(), Vec::new());
        let joined = if self.closed { rings } else { rings - 1 };
        for lower in 0..joined {
            let upper = (lower + 1) % rings;
            for k in 0..sides {
                let next = (k + 1) % sides;
                let [p, q] = [lower * sides + k, lower * sides + next];
                let [r, s] = [upper * sides + next, upper * sides + k];
                push_rectangle(&mut mesh, [p, q, r, s], false);
            }
        }
        if !self.closed {
            mesh.triangles.extend(triangulate::convex((0..sides).rev().collect()));
            mesh.triangles.extend(triangulate::convex(((rings - 1) * sides..rings * sides).collect()));
        }
        // Between two half-planes it is a prism over the polygon, cut at a slant: its sides are flat.
        Solid::assume(mesh, true)
    }
}

/// Sides of a regular polygon in a circle, by fours, so that none is further away than this.
fn sides_within(radius: f64, error: f64) -> Option<u32> {
    let half_turns = PI / acos((1.0 - error / radius).max(0.0));
    let sides = 4.0 * (half_turns / 4.0).ceil();
    (sides <= f64::from(4 * MOST_STEPS)).then_some(sides as u32)
}

/// How far the middle of a side is from the circle.
fn sagitta(radius: f64, sides: u32) -> f64 {
    let sine = sin(FRAC_PI_2 / f64::from(sides));
    2.0 * radius * sine * sine * (1.0 + 8.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Defects, crossing_pairs};
    use crate::sdf::{Implicit, Primitive};

    /// Closed, free of crossings, as many triangles as said, every vertex on the surface, and places on triangles and
    /// on the surface no further apart than said.
    fn check(solid: &Solid, triangles: u64, error: f64, primitive: Primitive) {
        let mesh = solid.mesh();
        let defects = Defects::of(mesh);
        assert!(defects.is_solid() && defects.unused_positions == 0, "{primitive:?} {defects:?}");
        assert_eq!(defects.non_manifold_vertices, 0, "{primitive:?}");
        let all: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        assert!(crossing_pairs(mesh, &all).is_empty(), "{primitive:?}");
        assert_eq!(mesh.triangles.len() as u64, triangles, "{primitive:?}");
        let half = primitive.half_size();
        assert_eq!([mesh.bounds().min, mesh.bounds().max], [-half, half], "{primitive:?}");
        let tape = Implicit::primitive(primitive).unwrap().expr().compile();
        let distance = |p: Vec3| crate::sdf::Field::value(&tape, p);
        for &p in &mesh.positions {
            assert!(distance(p).abs() < 1e-12 * half.max_element(), "{primitive:?} {p}");
        }
        let mut most: f64 = 0.0;
        for t in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(t);
            for p in [(a + b + c) / 3.0, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)] {
                let off = distance(p).abs();
                assert!(off <= error, "{primitive:?} {p} {off} {error}");
                most = most.max(off);
            }
        }
        // The bound is no exaggeration: half of it is there, where a distance is one.
        assert!(!primitive.is_exact() || most > 0.5 * error, "{primitive:?} {most} {error}");
    }

    #[test]
    fn round_bodies_are_as_near_as_they_say() {
        for tolerance in [0.2, 0.05, 1e-2, 1e-3] {
            for (radius, core) in [
                (1.0, Vec3::ZERO),
                (0.5, Vec3::new(0.0, 0.0, 2.0)),
                (0.5, Vec3::new(1.0, 0.0, 2.0)),
                (0.3, Vec3::new(1.0, 2.0, 3.0)),
                (1e-3, Vec3::new(1.0, 2.0, 3.0)),
            ] {
                let half = core + radius;
                let body = Rounded::around(core, half, radius, tolerance).unwrap();
                assert!(body.error <= tolerance);
                let primitive = Primitive::RoundedCuboid { half, radius };
                check(&body.solid(), body.triangles(), body.error, primitive);
            }
            let radii = Vec3::new(0.5, 1.0, 2.0);
            let body = Rounded::ellipsoid(radii, tolerance).unwrap();
            check(&body.solid(), body.triangles(), body.error, Primitive::Ellipsoid { radii });
        }
    }

    #[test]
    fn turned_bodies_are_as_near_as_they_say() {
        for tolerance in [0.2, 0.05, 1e-2, 1e-3] {
            let (major, minor) = (2.0, 0.5);
            let ring = Turned::ring(major, minor, tolerance).unwrap();
            assert!(ring.error <= tolerance);
            check(&ring.solid(), ring.triangles(), ring.error, Primitive::Torus { major, minor });
            for (radius, half_height, rounding) in [(1.0, 2.0, 0.25), (1.0, 0.25, 0.25)] {
                let body = Turned::cylinder(radius, half_height, rounding, tolerance).unwrap();
                assert!(body.error <= tolerance);
                let primitive = Primitive::Cylinder { radius, half_height, rounding };
                check(&body.solid(), body.triangles(), body.error, primitive);
            }
        }
    }

    #[test]
    fn octants_take_few_triangles_and_none_is_turned_over() {
        for steps in [1, 2, 3, 7, 30] {
            let octant = Octant::divided(steps);
            for triangle in octant.triangles() {
                let [a, b, c] = triangle.map(|place| octant.directions[place]);
                assert!(a.dot(b.cross(c)) > 0.2 / f64::from(steps * steps), "{steps}");
            }
            let least = 8.0 * PI / (3.0 * 3.0_f64.sqrt()) / octant.error;
            assert!(f64::from(8 * steps * steps) < 1.3 * least, "{steps}");
        }
        assert!(Octant::within(1e-9).is_none());
    }

    #[test]
    fn what_is_too_thin_is_left_to_others() {
        assert!(Rounded::around(Vec3::ONE, Vec3::splat(1.0 + 1e-9), 1e-9, 0.1).is_none());
        assert!(Rounded::around(1e-9 * Vec3::Z, Vec3::new(1.0, 1.0, 1.0 + 1e-9), 1.0, 0.1).is_none());
        assert!(Turned::ring(1.0, 1.0, 0.1).is_none());
        assert!(Turned::ring(1.0, 2.0, 0.1).is_none());
        assert!(Turned::cylinder(1.0, 1.0, 1.0 - 1e-9, 0.1).is_none());
    }
}
