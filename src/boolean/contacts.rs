//! Pairs of triangles that touch, and where.

use super::scene::Scene;
use crate::math::Aabb;
use crate::mesh::Topology;
use crate::polygon::exact::{Plane, PointId};
use crate::spatial::Bvh;
use std::cmp::Ordering;

/// What two triangles of different planes have in common: a segment, or a point where both ends are the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trace {
    pub(super) triangles: [u32; 2],
    pub(super) ends: [PointId; 2],
}

/// All contacts of a scene.
#[derive(Debug, Default)]
pub(super) struct Contacts {
    /// For each triangle, whether it touches another one, or lies in the plane of a neighbour that does.
    pub(super) touched: Vec<bool>,
    pub(super) traces: Vec<Trace>,
}

/// Finds all contacts between different operands and, in operands not known to be embedded, with themselves. Two
/// triangles that meet only in a corner of both, or in the edge across which they are neighbours, have no contact.
pub(super) fn find(scene: &mut Scene) -> Contacts {
    let mut contacts = Contacts { touched: vec![false; scene.triangles.len()], traces: Vec::new() };
    for [t, s] in candidates(scene) {
        contacts.examine(scene, t, s);
    }
    for half_edge in (0..scene.twins.len()).filter(|&h| scene.twins[h] == Topology::NONE) {
        contacts.touched[half_edge / 3] = true;
    }
    contacts.spread_over_planes(scene);
    contacts
}

/// Pairs of triangles whose boxes touch and that may have a contact.
fn candidates(scene: &Scene) -> Vec<[u32; 2]> {
    let members = &scene.members;
    let boxes: Vec<Aabb> = members.iter().map(|member| member.bounds).collect();
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    Bvh::new(&boxes).self_pairs(&boxes, |i, j| pairs.push((i, j)));
    pairs.extend((0..members.len() as u32).filter(|&i| !members[i as usize].embedded).map(|i| (i, i)));
    pairs.sort_unstable();

    let mut found = Vec::new();
    for (i, j) in pairs {
        if i == j {
            let own = Part::of(scene, i, boxes[i as usize]);
            own.bvh.self_pairs(&own.boxes, |a, b| {
                found.push([own.triangles[a as usize], own.triangles[b as usize]]);
            });
        } else {
            let overlap = boxes[i as usize].intersection(boxes[j as usize]);
            let (a, b) = (Part::of(scene, i, overlap), Part::of(scene, j, overlap));
            a.bvh.pairs(&a.boxes, &b.bvh, &b.boxes, |x, y| {
                found.push([a.triangles[x as usize], b.triangles[y as usize]]);
            });
        }
    }
    found.sort_unstable();
    found
}

/// The triangles of an operand that touch a box.
struct Part {
    triangles: Vec<u32>,
    boxes: Vec<Aabb>,
    bvh: Bvh,
}

impl Part {
    fn of(scene: &Scene, member: u32, within: Aabb) -> Part {
        let (mut triangles, mut boxes) = (Vec::new(), Vec::new());
        for t in scene.members[member as usize].triangles.clone() {
            let bounds = scene.bounds_of(t);
            if bounds.touches(within) {
                triangles.push(t);
                boxes.push(bounds);
            }
        }
        let bvh = Bvh::new(&boxes);
        Part { triangles, boxes, bvh }
    }
}

impl Contacts {
    /// Records what triangles `t` and `s` have in common.
    fn examine(&mut self, scene: &mut Scene, t: u32, s: u32) {
        let plane_t = *scene.own_plane(t);
        let sides_s = sides(scene, &plane_t, t, s);
        if all_on_one_side(sides_s) {
            return;
        }
        if sides_s == [0; 3] {
            if !are_unfolded_neighbours(scene, t, s) {
                self.touched[t as usize] = true;
                self.touched[s as usize] = true;
            }
            return;
        }
        let plane_s = *scene.own_plane(s);
        let sides_t = sides(scene, &plane_s, s, t);
        if all_on_one_side(sides_t) || meet_only_at_shared_corners(scene, [t, s], [sides_t, sides_s]) {
            return;
        }
        let across_t = section(scene, t, sides_t, &plane_s);
        let across_s = section(scene, s, sides_s, &plane_t);
        let later = |a: PointId, b: PointId| if along(scene, a, b) == Ordering::Less { b } else { a };
        let sooner = |a: PointId, b: PointId| if along(scene, a, b) == Ordering::Less { a } else { b };
        let ends = [later(across_t[0], across_s[0]), sooner(across_t[1], across_s[1])];
        if along(scene, ends[0], ends[1]) == Ordering::Greater || is_shared(scene, [t, s], ends) {
            return;
        }
        self.touched[t as usize] = true;
        self.touched[s as usize] = true;
        self.traces.push(Trace { triangles: [t, s], ends });
    }

    /// Marks all triangles that continue a marked one in its plane, so that flat faces are seen whole.
    fn spread_over_planes(&mut self, scene: &mut Scene) {
        let mut stack: Vec<u32> =
            (0..self.touched.len() as u32).filter(|&t| self.touched[t as usize]).collect();
        while let Some(t) = stack.pop() {
            let plane = *scene.own_plane(t);
            for half_edge in 3 * t..3 * t + 3 {
                let twin = scene.twins[half_edge as usize];
                if twin == Topology::NONE || self.touched[twin as usize / 3] {
                    continue;
                }
                let opposite = scene.triangles[twin as usize / 3].corners[(twin as usize + 2) % 3];
                if plane.side(scene.points(), opposite) == 0 {
                    self.touched[twin as usize / 3] = true;
                    stack.push(twin / 3);
                }
            }
        }
    }
}

/// On which sides of the plane of one triangle the corners of another lie.
fn sides(scene: &Scene, plane: &Plane, of: u32, triangle: u32) -> [i32; 3] {
    let own = scene.triangles[of as usize].corners;
    let side = |p: PointId| if own.contains(&p) { 0 } else { plane.side(scene.points(), p) };
    scene.triangles[triangle as usize].corners.map(side)
}

fn all_on_one_side(sides: [i32; 3]) -> bool {
    sides == [1; 3] || sides == [-1; 3]
}

/// Whether two coplanar triangles are neighbours across an edge that they lie on different sides of, facing one way.
fn are_unfolded_neighbours(scene: &Scene, t: u32, s: u32) -> bool {
    (3 * t..3 * t + 3).any(|half_edge| {
        let twin = scene.twins[half_edge as usize];
        twin / 3 == s && twin != Topology::NONE && {
            let corner =
                |h: u32, ahead: u32| scene.triangles[h as usize / 3].corners[((h % 3 + ahead) % 3) as usize];
            let (a, b) = (corner(half_edge, 0), corner(half_edge, 1));
            (0..3).any(|axis| {
                let side = |c: PointId| scene.points().orientation(a, b, c, axis);
                side(corner(half_edge, 2)) * side(corner(twin, 2)) < 0
            })
        }
    })
}

/// A quick sign that two triangles have nothing in common but a corner at one place, or the edge they are neighbours
/// across: apart from those, one lies strictly on one side of the other's plane.
fn meet_only_at_shared_corners(scene: &Scene, [t, s]: [u32; 2], sides: [[i32; 3]; 2]) -> bool {
    [(t, s, sides[0]), (s, t, sides[1])].into_iter().any(|(triangle, other, sides)| {
        let corners = scene.triangles[triangle as usize].corners;
        let mut on_plane = (0..3).filter(|&i| sides[i] == 0).map(|i| corners[i]);
        !(sides.contains(&1) && sides.contains(&-1))
            && on_plane
                .next()
                .is_some_and(|a| is_shared(scene, [triangle, other], [a, on_plane.next().unwrap_or(a)]))
    })
}

/// Whether a contact is just a corner at one place, or the edge across which the two are neighbours. Edges at one place
/// that are not joined by index are no such edge: surfaces may pass through each other there.
fn is_shared(scene: &Scene, [t, s]: [u32; 2], ends: [PointId; 2]) -> bool {
    let corners = scene.triangles[s as usize].corners;
    let side = |half_edge: u32| {
        let own = scene.triangles[t as usize].corners;
        [own[half_edge as usize % 3], own[(half_edge as usize + 1) % 3]]
    };
    if ends[0] == ends[1] {
        return corners.contains(&ends[0]) && scene.triangles[t as usize].corners.contains(&ends[0]);
    }
    (3 * t..3 * t + 3).any(|half_edge| {
        let twin = scene.twins[half_edge as usize];
        twin != Topology::NONE && twin / 3 == s && side(half_edge).iter().all(|end| ends.contains(end))
    })
}

/// Where a triangle that is not all on one side of a plane meets it: the two ends, in order; equal for a point.
fn section(scene: &mut Scene, triangle: u32, sides: [i32; 3], plane: &Plane) -> [PointId; 2] {
    let corners = scene.triangles[triangle as usize].corners;
    let mut ends: [Option<PointId>; 2] = [None; 2];
    let mut add = |end: PointId| match ends[0] {
        None => ends[0] = Some(end),
        Some(_) => ends[1] = Some(end),
    };
    for i in 0..3 {
        let j = (i + 1) % 3;
        if sides[i] == 0 {
            add(corners[i]);
        }
        if sides[i] * sides[j] < 0 {
            add(scene.places.points.crossing(corners[i], corners[j], plane));
        }
    }
    let first = ends[0].expect("the triangle meets the plane");
    let second = ends[1].unwrap_or(first);
    if along(scene, first, second) == Ordering::Greater { [second, first] } else { [first, second] }
}

/// Orders points of one line along it.
fn along(scene: &Scene, a: PointId, b: PointId) -> Ordering {
    let by = |axis: usize| scene.points().compare(a, b, axis);
    by(0).then_with(|| by(1)).then_with(|| by(2))
}
