//! Where faces touch.
//!
//! Two faces in different planes meet along the line of both planes. It is looked at triangle by triangle, but diagonals,
//! the edges that only the triangulation has, are looked through: where the line crosses one, the contact goes on in the
//! next triangle, and no point is made. So every end of a contact is a corner or lies on a true edge of one of the two
//! faces, and has a name of bounded width.

use super::pairs::candidates;
use super::scene::Scene;
use super::slope::Slope;
use super::world::{Lookup, NONE};
use crate::numeric::DisjointSets;
use crate::polygon::exact::{Plane, PointId};
use std::cmp::Ordering;

/// What two faces of different planes have in common: a segment, or a point where both ends are the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trace {
    /// A triangle of each face.
    pub(super) triangles: [u32; 2],
    pub(super) ends: [PointId; 2],
}

/// All contacts of a scene.
#[derive(Debug)]
pub(super) struct Contacts {
    /// For each triangle, whether it touches another one, or lies in the plane of a neighbour that does.
    pub(super) touched: Vec<bool>,
    pub(super) traces: Vec<Trace>,
}

/// Finds all contacts between different members and, in members not known to be embedded, with themselves. Two triangles
/// that meet only in a corner of both, or in the edge across which they are neighbours, have no contact.
pub(super) fn find(scene: &mut Scene<'_>) -> Contacts {
    let count = scene.corners.len();
    let mut finder = Finder {
        contacts: Contacts { touched: vec![false; count], traces: Vec::new() },
        stops: Vec::new(),
        faces: None,
        crossings: Lookup::default(),
    };
    for [t, s] in candidates(scene) {
        finder.examine(scene, t, s);
    }
    finder.chain(scene);
    let mut contacts = finder.contacts;
    for half_edge in (0..scene.twins.len()).filter(|&h| scene.twins[h] == NONE) {
        contacts.touched[half_edge / 3] = true;
    }
    contacts.spread_over_planes(scene);
    contacts
}

/// Finds contacts.
struct Finder {
    contacts: Contacts,
    /// Ends of contacts that go on across diagonals.
    stops: Vec<Stop>,
    /// Triangles joined across diagonals that contacts cross.
    faces: Option<DisjointSets>,
    /// Where edges cross planes: both triangles along an edge ask for it, for all triangles in the plane.
    crossings: Lookup<(PointId, PointId, Across), PointId>,
}

/// What an edge crosses: a plane of the world, or that of a triangle for which none is known yet.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Across {
    Plane(u32),
    Triangle(u32),
}

/// Where a contact of two faces starts or ends.
#[derive(Clone, Copy)]
struct Stop {
    triangles: [u32; 2],
    at: PointId,
    kind: StopKind,
}

impl Stop {
    /// With the triangles changed over, the line runs the other way.
    fn seen_from_the_other(self) -> Stop {
        let [t, s] = self.triangles;
        let kind = match self.kind {
            StopKind::Start => StopKind::End,
            StopKind::End => StopKind::Start,
            StopKind::Touch => StopKind::Touch,
        };
        Stop { triangles: [s, t], kind, ..self }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum StopKind {
    Start,
    End,
    /// The faces touch there, for all that these two triangles tell.
    Touch,
}

/// The line of two planes, run through along the product of their normals.
#[derive(Clone, Copy)]
struct Direction {
    axis: usize,
    forward: bool,
}

/// Where the part of a triangle in a plane ends.
#[derive(Clone, Copy)]
enum End {
    Point(PointId),
    /// On a diagonal: the part goes on in the next triangle.
    Diagonal(u32),
}

/// The part of a triangle in the plane of another one.
struct Section {
    start: End,
    end: End,
    plane: Plane,
}

impl Finder {
    /// Records what triangles `t` and `s` have in common.
    fn examine(&mut self, scene: &mut Scene<'_>, t: u32, s: u32) {
        let sides_s = sides(scene, t, s);
        if all_on_one_side(sides_s) {
            return;
        }
        if sides_s == [0; 3] {
            if !are_unfolded_neighbours(scene, t, s) {
                self.touch([t, s]);
            }
            return;
        }
        let sides_t = sides(scene, s, t);
        if all_on_one_side(sides_t) || meet_only_at_shared_corners(scene, [t, s], [sides_t, sides_s]) {
            return;
        }
        let (plane_t, plane_s) = (scene.own_plane(t), scene.own_plane(s));
        let direction = Direction::of(&plane_t, &plane_s);
        let of_t = self.section(scene, t, sides_t, plane_t, (s, &plane_s));
        let across = self.section(scene, s, sides_s, plane_s, (t, &plane_t));
        // The line runs the other way for the second triangle.
        let of_s = Section { start: across.end, end: across.start, plane: across.plane };
        match [of_t.start, of_t.end, of_s.start, of_s.end] {
            [End::Point(a), End::Point(b), End::Point(c), End::Point(d)] => {
                self.meet_at_points(scene, [t, s], direction, [[a, b], [c, d]]);
            }
            _ => self.meet_across_diagonals(scene, [t, s], direction, [&of_t, &of_s]),
        }
    }

    fn touch(&mut self, triangles: [u32; 2]) {
        for t in triangles {
            self.contacts.touched[t as usize] = true;
        }
    }

    /// Two sections between points have in common what lies between the later start and the sooner end.
    fn meet_at_points(
        &mut self,
        scene: &Scene<'_>,
        triangles: [u32; 2],
        direction: Direction,
        [a, b]: [[PointId; 2]; 2],
    ) {
        let order = |x: PointId, y: PointId| direction.compare(scene, x, y);
        let start = if order(a[0], b[0]).is_lt() { b[0] } else { a[0] };
        let end = if order(a[1], b[1]).is_gt() { b[1] } else { a[1] };
        if order(start, end).is_gt() || is_shared(scene, triangles, [start, end]) {
            return;
        }
        self.touch(triangles);
        self.contacts.traces.push(Trace { triangles, ends: [start, end] });
    }

    /// What two sections have in common, where at least one ends on a diagonal: the points at which it starts and ends.
    fn meet_across_diagonals(
        &mut self,
        scene: &Scene<'_>,
        triangles: [u32; 2],
        direction: Direction,
        sections: [&Section; 2],
    ) {
        let stop = |at: PointId, kind: StopKind| Stop { triangles, at, kind };
        let past_start =
            |p: PointId, section: &Section| direction.distance(scene, p, section.start, section, 1);
        let before_end =
            |p: PointId, section: &Section| direction.distance(scene, p, section.end, section, -1);
        let mut found: [Option<Stop>; 2] = [None; 2];
        for (own, other) in [(sections[0], sections[1]), (sections[1], sections[0])] {
            if let End::Point(p) = own.start
                && past_start(p, other) >= 0
            {
                match before_end(p, own).min(before_end(p, other)) {
                    1 => found[0] = Some(stop(p, StopKind::Start)),
                    0 => found[0] = Some(stop(p, StopKind::Touch)),
                    _ => {}
                }
            }
            if let End::Point(p) = own.end
                && before_end(p, other) >= 0
            {
                match past_start(p, own).min(past_start(p, other)) {
                    1 => found[1] = Some(stop(p, StopKind::End)),
                    0 => found[1] = Some(stop(p, StopKind::Touch)),
                    _ => {}
                }
            }
        }
        for stop in found.into_iter().flatten() {
            if stop.kind != StopKind::Touch || !is_shared(scene, triangles, [stop.at; 2]) {
                self.touch(triangles);
                self.stops.push(stop);
            }
        }
    }

    /// The part of a triangle in a plane that it is not all on one side of, along the product of its normal with the
    /// plane's: the triangle runs counter-clockwise, so it starts where a side climbs through the plane.
    fn section(
        &mut self,
        scene: &mut Scene<'_>,
        triangle: u32,
        sides: [i32; 3],
        own: Plane,
        other: (u32, &Plane),
    ) -> Section {
        let corners = scene.corners[triangle as usize];
        let (mut start, mut end) = (None, None);
        for i in 0..3 {
            let (before, next) = (sides[(i + 2) % 3], sides[(i + 1) % 3]);
            if sides[i] == 0 {
                if next >= before {
                    start = Some(End::Point(corners[i]));
                }
                if next <= before {
                    end = Some(End::Point(corners[i]));
                }
            } else if sides[i] * next < 0 {
                let crossing = self.crossing(scene, 3 * triangle + i as u32, &own, other);
                *(if next > 0 { &mut start } else { &mut end }) = Some(crossing);
            }
        }
        let meets = "the triangle meets the plane";
        Section { start: start.expect(meets), end: end.expect(meets), plane: own }
    }

    /// Where a side of a triangle crosses the plane of another one.
    fn crossing(
        &mut self,
        scene: &mut Scene<'_>,
        half_edge: u32,
        own: &Plane,
        (other, plane): (u32, &Plane),
    ) -> End {
        if scene.goes_on(half_edge, own) {
            let count = scene.corners.len();
            let faces = self.faces.get_or_insert_with(|| DisjointSets::new(count));
            faces.join(half_edge / 3, scene.twins[half_edge as usize] / 3);
            return End::Diagonal(half_edge);
        }
        let line = scene.line_index(half_edge);
        let [from, to] = scene.ends(half_edge);
        let across =
            scene.facing(other).map_or(Across::Triangle(other), |facing| Across::Plane(facing.plane()));
        let points = &mut scene.world.places.points;
        End::Point(*self.crossings.entry((from.min(to), from.max(to), across)).or_insert_with(
            || match line {
                NONE => points.crossing(from, to, plane),
                index => {
                    let line = &scene.world.lines[index as usize];
                    points.meeting(own, line, plane).expect("a line that crosses a plane meets it")
                }
            },
        ))
    }

    /// Makes traces of the starts and ends that belong together.
    fn chain(&mut self, scene: &mut Scene<'_>) {
        let Some(mut faces) = self.faces.take() else { return };
        let by_faces = |stop: Stop| {
            let [t, s] = stop.triangles.map(|t| faces.find(t));
            if t <= s { ([t, s], stop) } else { ([s, t], stop.seen_from_the_other()) }
        };
        let mut stops: Vec<([u32; 2], Stop)> = self.stops.drain(..).map(by_faces).collect();
        stops.sort_by_key(|(faces, _)| *faces);
        for group in stops.chunk_by_mut(|a, b| a.0 == b.0) {
            let [t, s] = group[0].1.triangles;
            let direction = Direction::of(&scene.own_plane(t), &scene.own_plane(s));
            group.sort_by(|a, b| direction.compare(scene, a.1.at, b.1.at));
            self.chain_along(group);
        }
    }

    /// Joins the stops of two faces, in order along their line.
    fn chain_along(&mut self, stops: &[([u32; 2], Stop)]) {
        let triangles = stops[0].1.triangles;
        let mut depth = 0_i64;
        let mut last: Option<PointId> = None;
        for place in stops.chunk_by(|a, b| a.1.at == b.1.at) {
            let at = place[0].1.at;
            let count = |kind: StopKind| place.iter().filter(|(_, stop)| stop.kind == kind).count() as i64;
            let entered = depth > 0;
            if let Some(from) = last.filter(|_| entered) {
                self.contacts.traces.push(Trace { triangles, ends: [from, at] });
            }
            depth = depth + count(StopKind::Start) - count(StopKind::End);
            if !entered && depth == 0 {
                self.contacts.traces.push(Trace { triangles, ends: [at, at] });
            }
            last = Some(at);
        }
        debug_assert_eq!(depth, 0, "every contact ends");
    }
}

impl Direction {
    fn of(plane_t: &Plane, plane_s: &Plane) -> Direction {
        let axis = plane_t.longest_cross_axis(plane_s).expect("the planes cross");
        Direction { axis, forward: plane_t.cross_sign(plane_s, axis) > 0 }
    }

    /// Orders two points of the line.
    fn compare(self, scene: &Scene<'_>, a: PointId, b: PointId) -> Ordering {
        let order = scene.points().compare(a, b, self.axis);
        if self.forward { order } else { order.reverse() }
    }

    /// 1 when a point of the line lies inside of an end of a section, 0 at it, -1 outside; `inward` tells whether the
    /// inside is ahead of it (1) or behind (-1).
    fn distance(self, scene: &Scene<'_>, p: PointId, end: End, section: &Section, inward: i32) -> i32 {
        match end {
            End::Point(q) => inward * self.compare(scene, p, q) as i32,
            End::Diagonal(half_edge) => {
                let ([a, b], axis) = (scene.ends(half_edge), section.plane.main_axis());
                scene.points().orientation(a, b, p, axis) * section.plane.normal_sign(axis)
            }
        }
    }
}

impl Contacts {
    /// Marks all triangles that continue a marked one in its plane, so that flat faces are seen whole.
    fn spread_over_planes(&mut self, scene: &mut Scene<'_>) {
        let mut stack: Vec<u32> =
            (0..self.touched.len() as u32).filter(|&t| self.touched[t as usize]).collect();
        while let Some(t) = stack.pop() {
            for half_edge in 3 * t..3 * t + 3 {
                let twin = scene.twins[half_edge as usize];
                if twin == NONE || self.touched[twin as usize / 3] {
                    continue;
                }
                let plane = scene.own_plane(t);
                if plane.side(scene.points(), scene.opposite(twin)) == 0 {
                    self.touched[twin as usize / 3] = true;
                    stack.push(twin / 3);
                }
            }
        }
    }
}

/// On which sides of the plane of one triangle the corners of another lie.
fn sides(scene: &mut Scene<'_>, of: u32, triangle: u32) -> [i32; 3] {
    let own = scene.corners[of as usize];
    let corners = scene.corners[triangle as usize];
    let slope = Slope::new(scene.points(), own);
    let quick =
        corners.map(|p| if own.contains(&p) { Some(0) } else { slope.side(scene.points().rounded(p)) });
    if let [Some(a), Some(b), Some(c)] = quick {
        return [a, b, c];
    }
    let plane = scene.own_plane(of);
    [0, 1, 2].map(|i| quick[i].unwrap_or_else(|| plane.side(scene.points(), corners[i])))
}

fn all_on_one_side(sides: [i32; 3]) -> bool {
    sides == [1; 3] || sides == [-1; 3]
}

/// Whether two coplanar triangles are neighbours across an edge that they lie on different sides of, facing one way.
fn are_unfolded_neighbours(scene: &Scene<'_>, t: u32, s: u32) -> bool {
    (3 * t..3 * t + 3).any(|half_edge| {
        let twin = scene.twins[half_edge as usize];
        twin / 3 == s && twin != NONE && {
            let [a, b] = scene.ends(half_edge);
            (0..3).any(|axis| {
                let side = |c: PointId| scene.points().orientation(a, b, c, axis);
                side(scene.opposite(half_edge)) * side(scene.opposite(twin)) < 0
            })
        }
    })
}

/// A quick sign that two triangles have nothing in common but a corner at one place, or the edge they are neighbours
/// across: apart from those, one lies strictly on one side of the other's plane.
fn meet_only_at_shared_corners(scene: &Scene<'_>, [t, s]: [u32; 2], sides: [[i32; 3]; 2]) -> bool {
    [(t, s, sides[0]), (s, t, sides[1])].into_iter().any(|(triangle, other, sides)| {
        let corners = scene.corners[triangle as usize];
        let mut on_plane = (0..3).filter(|&i| sides[i] == 0).map(|i| corners[i]);
        !(sides.contains(&1) && sides.contains(&-1))
            && on_plane
                .next()
                .is_some_and(|a| is_shared(scene, [triangle, other], [a, on_plane.next().unwrap_or(a)]))
    })
}

/// Whether a contact is just a corner at one place, or the edge across which the two are neighbours. Edges at one place
/// that are not joined by index are no such edge: surfaces may pass through each other there.
fn is_shared(scene: &Scene<'_>, [t, s]: [u32; 2], ends: [PointId; 2]) -> bool {
    if ends[0] == ends[1] {
        return [t, s].iter().all(|&triangle| scene.corners[triangle as usize].contains(&ends[0]));
    }
    (3 * t..3 * t + 3).any(|half_edge| {
        let twin = scene.twins[half_edge as usize];
        twin != NONE && twin / 3 == s && scene.ends(half_edge).iter().all(|end| ends.contains(end))
    })
}
