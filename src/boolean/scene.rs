//! The bodies of one arrangement, side by side.

use super::Birth;
use super::body::Body;
use super::world::{Facing, NONE, World};
use crate::math::Aabb;
use crate::polygon::exact::{Chart, Line, Plane, PointId, Points};
use std::ops::Range;

/// What is known of a body in the scene.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// Its triangles in the scene.
    pub(super) triangles: Range<u32>,
    pub(super) bounds: Aabb,
    pub(super) embedded: bool,
    may_be_pinched: bool,
}

/// All bodies together. Half-edge `3 t + i` is side `i` of triangle `t`.
#[derive(Debug)]
pub(super) struct Scene<'a> {
    pub(super) world: World<'a>,
    pub(super) corners: Vec<[PointId; 3]>,
    pub(super) births: Vec<Birth>,
    pub(super) twins: Vec<u32>,
    pub(super) members: Vec<Member>,
    facings: Vec<Facing>,
    lines: Vec<u32>,
    /// For each triangle, its own plane in `own_planes` once it was asked for, or [`NONE`].
    own: Vec<u32>,
    own_planes: Vec<Plane>,
}

impl<'a> Scene<'a> {
    /// Puts bodies side by side; the member of each has its index.
    pub(super) fn new(world: World<'a>, bodies: Vec<Body>) -> Scene<'a> {
        let mut scene = Scene {
            world,
            corners: Vec::new(),
            births: Vec::new(),
            twins: Vec::new(),
            members: Vec::with_capacity(bodies.len()),
            facings: Vec::new(),
            lines: Vec::new(),
            own: Vec::new(),
            own_planes: Vec::new(),
        };
        for body in bodies {
            scene.add(body);
        }
        scene.own = vec![NONE; scene.corners.len()];
        scene
    }

    fn add(&mut self, body: Body) {
        let first = self.corners.len() as u32;
        let shift = |twin: u32| if twin == NONE { NONE } else { twin + 3 * first };
        let end = first + body.len() as u32;
        self.members.push(Member {
            triangles: first..end,
            bounds: body.bounds,
            embedded: body.embedded,
            may_be_pinched: body.may_be_pinched,
        });
        if !body.facings.is_empty() {
            self.facings.resize(first as usize, Facing::UNKNOWN);
            self.facings.extend(body.facings);
        }
        if !body.lines.is_empty() {
            self.lines.resize(3 * first as usize, NONE);
            self.lines.extend(body.lines);
        }
        if first == 0 {
            (self.corners, self.births, self.twins) = (body.corners, body.births, body.twins);
        } else {
            self.corners.extend(body.corners);
            self.births.extend(body.births);
            self.twins.extend(body.twins.into_iter().map(shift));
        }
    }

    /// The points of the world.
    pub(super) fn points(&self) -> &Points {
        self.world.points()
    }

    /// The box of a triangle, in lattice units.
    pub(super) fn bounds_of(&self, triangle: u32) -> Aabb {
        let ([a, b, c], points) = (self.corners[triangle as usize], self.points());
        Aabb::around([points.rounded(a), points.rounded(b), points.rounded(c)])
    }

    /// The member that a triangle belongs to.
    pub(super) fn member_of(&self, triangle: u32) -> u32 {
        self.members.partition_point(|member| member.triangles.end <= triangle) as u32
    }

    /// For each half-edge, whether its member has others than its twin at the same place.
    pub(super) fn pinched(&self) -> Vec<bool> {
        let mut pinched = vec![false; self.twins.len()];
        for member in self.members.iter().filter(|member| member.may_be_pinched) {
            let Range { start, end } = member.triangles;
            let place = |half_edge: u32| {
                let [from, to] = self.ends(half_edge);
                (from.min(to), from.max(to), half_edge)
            };
            let mut places: Vec<(PointId, PointId, u32)> = (3 * start..3 * end).map(place).collect();
            places.sort_unstable();
            for group in places.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|group| group.len() > 2) {
                group.iter().for_each(|&(.., half_edge)| pinched[half_edge as usize] = true);
            }
        }
        pinched
    }

    /// The ends of a half-edge.
    pub(super) fn ends(&self, half_edge: u32) -> [PointId; 2] {
        let corners = self.corners[half_edge as usize / 3];
        [corners[half_edge as usize % 3], corners[(half_edge as usize + 1) % 3]]
    }

    /// The corner of a half-edge's triangle that the half-edge does not touch.
    pub(super) fn opposite(&self, half_edge: u32) -> PointId {
        self.corners[half_edge as usize / 3][(half_edge as usize + 2) % 3]
    }

    /// The plane of a triangle, its normal outward.
    pub(super) fn own_plane(&mut self, triangle: u32) -> Plane {
        let t = triangle as usize;
        if self.own[t] == NONE {
            self.own[t] = self.own_planes.len() as u32;
            self.own_planes.push(self.plane_through(triangle));
        }
        self.own_planes[self.own[t] as usize]
    }

    /// [`Scene::own_plane`] without remembering it.
    pub(super) fn plane_through(&self, triangle: u32) -> Plane {
        match self.facing(triangle) {
            Some(facing) => self.world.outward_plane(facing),
            None => {
                let site = |p: PointId| self.points().as_site(p).expect("cut faces know their plane");
                let [a, b, c] = self.corners[triangle as usize].map(site);
                Plane::through(a, b, c).expect("the triangle has area")
            }
        }
    }

    /// The facing of a triangle, if it was asked for before or came with its body.
    pub(super) fn facing(&self, triangle: u32) -> Option<Facing> {
        self.facings.get(triangle as usize).and_then(|facing| facing.known())
    }

    /// The facing of a triangle, by the plane that all coplanar triangles share.
    pub(super) fn shared_facing(&mut self, triangle: u32) -> Facing {
        if let Some(facing) = self.facing(triangle) {
            return facing;
        }
        let own = self.own_plane(triangle);
        let facing = self.world.facing(&own);
        if self.facings.len() < self.corners.len() {
            self.facings.resize(self.corners.len(), Facing::UNKNOWN);
        }
        self.facings[triangle as usize] = facing;
        facing
    }

    /// The line of the world that a half-edge came with, or [`NONE`].
    pub(super) fn line_index(&self, half_edge: u32) -> u32 {
        self.lines.get(half_edge as usize).copied().unwrap_or(NONE)
    }

    /// The line that a side of a face runs on, in the face's chart.
    pub(super) fn line_of_side(&self, chart: &Chart, half_edge: u32) -> Line {
        let line = match self.line_index(half_edge) {
            NONE => {
                let [from, to] = self.ends(half_edge);
                chart.line_through(self.points(), from, to)
            }
            index => chart.line(&self.world.lines[index as usize]),
        };
        line.expect("sides have length")
    }

    /// Whether a face goes on in its plane across a half-edge of a triangle in the given plane, so that the edge is none
    /// of the solid but only of its triangulation.
    pub(super) fn goes_on(&self, half_edge: u32, plane: &Plane) -> bool {
        let (twin, t) = (self.twins[half_edge as usize], half_edge / 3);
        if twin == NONE
            || self.world.label(self.births[t as usize]) != self.world.label(self.births[twin as usize / 3])
        {
            return false;
        }
        if let (Some(here), Some(there)) = (self.facing(t), self.facing(twin / 3)) {
            return here == there;
        }
        let across = self.opposite(twin);
        plane.side(self.points(), across) == 0 && {
            let ([a, b], axis) = (self.ends(half_edge), plane.main_axis());
            let side = |c: PointId| self.points().orientation(a, b, c, axis);
            side(across) == -side(self.opposite(half_edge))
        }
    }
}
