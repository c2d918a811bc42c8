//! Winding numbers of a place by a ray.
//!
//! The ray runs along +z. It is the ray that is moved, by (e, e^2) with e as small as it takes, and never the geometry, so
//! it meets no edge and no vertex.

use super::scene::Scene;
use crate::math::{Aabb, Vec3};
use crate::numeric::Wide;
use crate::polygon::exact::{Plane, PointId, Points, Site};
use crate::spatial::Bvh;

/// A triangle of a surface; the ray starts beside a point inside of it, its centroid if that will do.
pub(super) struct Anchor {
    pub(super) corners: [PointId; 3],
    pub(super) plane: Plane,
}

/// Casts rays through a scene.
pub(super) struct RayCaster<'a> {
    scene: &'a Scene<'a>,
    boxes: Vec<Aabb>,
    members: Bvh,
    finders: Vec<Finder>,
}

/// Finds the triangles of a member near a ray.
#[derive(Default)]
struct Finder {
    /// How many rays came near the member.
    rays: usize,
    /// Its triangles by place.
    triangles: Option<(Vec<Aabb>, Bvh)>,
}

/// A tree over triangles costs about as much as looking at all of them this often.
const RAYS_WITHOUT_TREE: usize = 8;

impl<'a> RayCaster<'a> {
    pub(super) fn new(scene: &'a Scene<'a>) -> RayCaster<'a> {
        let boxes: Vec<Aabb> = scene.members.iter().map(|member| member.bounds).collect();
        let members = Bvh::new(&boxes);
        let finders = scene.members.iter().map(|_| Finder::default()).collect();
        RayCaster { scene, boxes, members, finders }
    }

    /// Winding numbers right beside a point of the anchor, and whether that is the side to which its normal points.
    ///
    /// Other surfaces may touch the anchor from one side along a line, or in a point, which bounds none of its cells. Beside
    /// that place winding numbers are not those of the rest, so the ray starts elsewhere.
    pub(super) fn cast(&mut self, anchor: &Anchor) -> (bool, Vec<(u32, i32)>) {
        // Above the plane, or, when that stands upright, to where the ray is moved.
        let side = [2, 0, 1].map(|axis| anchor.plane.normal_sign(axis)).into_iter().find(|&sign| sign != 0);
        let starts = weights().map(|weights| Start::new(self.scene.points(), anchor, weights));
        let winding = starts.into_iter().find_map(|start| self.winding(&start));
        (side == Some(1), winding.expect("no hundred planes pass all places of a triangle"))
    }

    /// Winding numbers around the start of a ray; `None` where the plane of some triangle near it passes it.
    fn winding(&mut self, start: &Start) -> Option<Vec<(u32, i32)>> {
        let column = start.column();
        let mut near = Vec::new();
        self.members.touching(&self.boxes, column, |member| near.push(member));
        near.sort_unstable();
        let mut winding = Vec::new();
        for member in near {
            let times = self.count(member, start, column)?;
            if times != 0 {
                winding.push((member, times));
            }
        }
        Some(winding)
    }

    /// How often a member winds around the start of the ray; `None` where the plane of one of its triangles near it passes
    /// it.
    fn count(&mut self, member: u32, start: &Start, column: Aabb) -> Option<i32> {
        let (scene, finder) = (self.scene, &mut self.finders[member as usize]);
        let triangles = scene.members[member as usize].triangles.clone();
        finder.rays += 1;
        if finder.rays <= RAYS_WITHOUT_TREE {
            let near = triangles.filter(|&t| scene.bounds_of(t).touches(column));
            return near.map(|t| start.crossing(scene, t)).sum();
        }
        let (boxes, bvh) = finder.triangles.get_or_insert_with(|| {
            let boxes: Vec<Aabb> = triangles.clone().map(|t| scene.bounds_of(t)).collect();
            let bvh = Bvh::new(&boxes);
            (boxes, bvh)
        });
        let mut times = Some(0);
        bvh.touching(boxes, column, |i| {
            times = times.zip(start.crossing(scene, triangles.start + i)).map(|(sum, one)| sum + one);
        });
        times
    }
}

/// Weights of corners for points inside of a triangle, the centroid first. No line passes more than 127 of them, and no
/// sum has more than 8 bits, for which the widths below have room.
fn weights() -> impl Iterator<Item = [i64; 3]> {
    (2..=127_i64).flat_map(|sum| (1..sum).map(move |first| [1, first, sum - first]))
}

type Numerator = Wide<19>;
type Denominator = Wide<18>;

/// A point between three others, exactly.
struct Start {
    rounded: Vec3,
    /// Bound on the error of each rounded coordinate.
    error: f64,
    numerators: [Numerator; 3],
    denominator: Denominator,
    /// The plane that it starts beside.
    home: Plane,
}

const UNIT: f64 = f64::EPSILON / 2.0;

impl Start {
    fn new(points: &Points, anchor: &Anchor, weights: [i64; 3]) -> Start {
        let corners = anchor.corners;
        let places = corners.map(|p| points.rounded(p));
        let [(a, u), (b, v), (c, w)] = corners.map(|p| points.homogeneous(p));
        let product = |x: &Wide<6>, y: &Wide<6>| -> Wide<12> { x.times(y) };
        let (vw, wu, uv) = (product(&v, &w), product(&w, &u), product(&u, &v));
        let sum = weights.iter().sum::<i64>();
        let weighted = |x: Numerator, k: usize| -> Numerator { x.times(&Wide::<1>::from(weights[k])) };
        let numerator = |i: usize| -> Numerator {
            let [a, b, c] = [a[i].times(&vw), b[i].times(&wu), c[i].times(&uv)];
            weighted(a, 0).plus(&weighted(b, 1)).plus(&weighted(c, 2))
        };
        let denominator: Denominator = uv.times::<6, 18>(&w).times(&Wide::<1>::from(sum));
        let largest = places.iter().fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
        Start {
            rounded: (0..3).map(|k| weights[k] as f64 * places[k]).sum::<Vec3>() / sum as f64,
            error: 8.0 * UNIT * largest,
            numerators: [numerator(0), numerator(1), numerator(2)],
            denominator,
            home: anchor.plane,
        }
    }

    /// A box around the start.
    fn place(&self) -> Aabb {
        Aabb { min: self.rounded - Vec3::splat(self.error), max: self.rounded + Vec3::splat(self.error) }
    }

    /// A box around the ray.
    fn column(&self) -> Aabb {
        let Aabb { min, max } = self.place();
        Aabb { min, max: Vec3::new(max.x, max.y, f64::INFINITY) }
    }

    /// 1 where the ray leaves through a triangle, -1 where it enters, 0 where it passes by; `None` where another plane than
    /// its own passes the start, as that of a triangle near it.
    fn crossing(&self, scene: &Scene<'_>, triangle: u32) -> Option<i32> {
        let [a, b, c] = scene.corners[triangle as usize];
        let points = scene.points();
        let plane = scene.plane_through(triangle);
        let mut side = None;
        if scene.bounds_of(triangle).touches(self.place()) {
            side = Some(self.side(&plane));
            if side == Some(0) && plane.longest_cross_axis(&self.home).is_some() {
                return None;
            }
        }
        let turn = self.turn(points, a, b);
        if turn == 0 || self.turn(points, b, c) != turn || self.turn(points, c, a) != turn {
            return Some(0);
        }
        // The triangle faces up when it runs counter-clockwise around the ray; the start is below it when it is behind.
        let side = match side.unwrap_or_else(|| self.side(&plane)) {
            // In the plane it starts beside, it starts above.
            0 => plane.normal_sign(2),
            side => side,
        };
        Some(if side == -turn { turn } else { 0 })
    }

    /// 1 when the moved ray passes to the left of the segment seen from above; 0 only for an upright segment.
    fn turn(&self, points: &Points, a: PointId, b: PointId) -> i32 {
        let (from, to) = (points.rounded(a), points.rounded(b));
        let (along, place) = (to - from, self.rounded - from);
        let (left, right) = (along.x * place.y, along.y * place.x);
        // Bounds on the errors of `along` and `place`, and from them on that of the difference.
        let slack =
            |i: usize| self.error + 2.0 * UNIT * (self.rounded[i].abs() + from[i].abs() + to[i].abs());
        let (dx, dy) = (slack(0), slack(1));
        let (along_size, place_size) = (along.abs(), place.abs());
        let error = (along_size.x + place_size.x + dx) * dy + (along_size.y + place_size.y + dy) * dx;
        let bound = 2.0 * error + 4.0 * UNIT * (left.abs() + right.abs());
        if (left - right).abs() > bound {
            return if left > right { 1 } else { -1 };
        }
        let sign = match (points.as_site(a), points.as_site(b)) {
            (Some(from), Some(to)) => self.turn_about_sites(from, to),
            _ => self.turn_about_fractions(points, a, b),
        };
        // The move changes the value by -ey e + ex e^2.
        let [ex, ey] = [0, 1].map(|axis| points.compare(b, a, axis) as i32);
        [sign, -ey, ex].into_iter().find(|&s| s != 0).unwrap_or(0)
    }

    fn turn_about_sites(&self, from: Site, to: Site) -> i32 {
        let offset = |i: usize| self.numerators[i].minus(&Wide::<1>::from(from[i]).times(&self.denominator));
        let product = |i: usize, j: usize| -> Wide<20> { Wide::<1>::from(to[i] - from[i]).times(&offset(j)) };
        product(0, 1).minus(&product(1, 0)).signum()
    }

    /// The determinant of the three points' first two numerators and denominators.
    fn turn_about_fractions(&self, points: &Points, a: PointId, b: PointId) -> i32 {
        let ((a, aw), (b, bw)) = (points.homogeneous(a), points.homogeneous(b));
        let start = &self.numerators;
        let ab: Wide<14> = a[0].times::<7, 14>(&b[1]).minus(&a[1].times(&b[0]));
        let bs: Wide<26> = b[0].times::<19, 26>(&start[1]).minus(&b[1].times(&start[0]));
        let sa: Wide<26> = start[0].times::<7, 26>(&a[1]).minus(&start[1].times(&a[0]));
        let sum: Wide<32> = ab.times(&self.denominator);
        sum.plus(&bs.times(&aw)).plus(&sa.times(&bw)).signum()
    }

    /// On which side of a plane the start lies.
    fn side(&self, plane: &Plane) -> i32 {
        let n = Vec3::from_array(plane.rounded_normal());
        let offset = plane.rounded_offset();
        let value = n.dot(self.rounded) - offset;
        let slack = Vec3::splat(self.error) + 8.0 * UNIT * self.rounded.abs();
        let bound = 2.0 * (n.abs().dot(slack) + 8.0 * UNIT * offset.abs());
        if value.abs() > bound {
            return if value > 0.0 { 1 } else { -1 };
        }
        let value: Wide<21> = plane.at_fraction(&self.numerators, &self.denominator);
        value.signum()
    }
}
