//! From exact surface to solid: vertices numbered, positions rounded, once.

use super::Birth;
use super::body::Body;
use super::world::{Lookup, NONE, World};
use crate::math::Vec3;
use crate::mesh::{Exact, Mesh, Topology, Unmended, fans};
use crate::polygon::exact::{Origin, Plane, PointId};

/// A result with rounded positions.
pub(super) struct Rounded {
    pub(super) mesh: Mesh,
    pub(super) birth: Vec<Birth>,
    pub(super) twins: Vec<u32>,
    /// Whether it is known not to cross itself.
    pub(super) embedded: bool,
    /// What positions do not say.
    pub(super) origin: Option<Origin>,
    /// The exact surface, where `mesh` has triangles without area: edges were too short to be parted.
    pub(super) unparted: Option<Exact>,
    /// Bound on the distance of a vertex from its exact place.
    pub(super) movement: f64,
}

impl World<'_> {
    /// The surface that a body stands for.
    pub(super) fn round(mut self, body: Body) -> Rounded {
        let mut surface = Numbered::new(body);
        let unparted = surface.part_double_edges(&mut self);
        let is_parted = unparted.is_some();
        let points = surface.points();
        let mesh = self.mesh_of(&surface, &points);
        let Numbered { body, .. } = surface;
        let embedded = body.embedded
            && !is_parted
            && self.places.is_exact()
            && points.iter().all(|&point| self.places.is_given(point));
        let exact = body.embedded && !is_parted;
        let origin = if embedded { None } else { self.origin_of(&body, &points, exact) };
        let movement = origin.as_ref().map_or(0.0, |origin| self.movement(origin, &mesh.positions));
        let is_thin = |&[a, b, c]: &[PointId; 3]| a == b || b == c || c == a;
        let unparted = unparted.filter(|_| body.corners.iter().any(is_thin));
        let unparted = unparted.map(|unparted| self.exact(unparted));
        Rounded { mesh, birth: body.births, twins: body.twins, embedded, origin, unparted, movement }
    }

    fn mesh_of(&self, surface: &Numbered, points: &[PointId]) -> Mesh {
        let positions = points.iter().map(|&point| self.places.position(point)).collect();
        Mesh { positions, triangles: surface.vertices.as_chunks().0.to_vec() }
    }

    /// A surface before edges were parted, each triangle of which is the one of that number afterwards or has become it
    /// and more.
    fn exact(&self, surface: Numbered) -> Exact {
        let points = surface.points();
        let mesh = self.mesh_of(&surface, &points);
        let body = surface.body;
        let origin = self.origin_of(&body, &points, body.embedded);
        let origin = origin.unwrap_or_else(|| Origin::on(self.places.lattice(), body.embedded));
        let stand_ins = (0..body.len() as u32).collect();
        let topology = Topology::of_twins(body.twins);
        Exact { origin, unmended: Some(Unmended { mesh, topology, stand_ins }) }
    }

    /// Bound on the distance of positions from where the vertices are: half an ulp in each coordinate of what was rounded,
    /// half a unit of the lattice of what was given.
    fn movement(&self, origin: &Origin, positions: &[Vec3]) -> f64 {
        let rounding = |vertex: u32| (0.5 * f64::EPSILON * positions[vertex as usize]).length();
        let rounded = origin.fractions.iter().map(|&(vertex, _)| rounding(vertex)).fold(0.0, f64::max);
        let unit = self.places.lattice().to_model(Vec3::splat(0.5)).length();
        if origin.sites.is_empty() { rounded } else { rounded.max(unit) }
    }

    /// What the positions of a body with its vertices at some points do not say; `None` when they say everything.
    fn origin_of(&self, body: &Body, points: &[PointId], embedded: bool) -> Option<Origin> {
        let mut origin = Origin::on(self.places.lattice(), embedded);
        for (vertex, &point) in (0..).zip(points) {
            if let Some(place) = self.places.hidden_place(point) {
                origin.add(vertex, place);
            }
        }
        let is_fraction = |point: &PointId| self.points().as_site(*point).is_none();
        let mut planes = Numbers::default();
        for (t, corners) in (0..).zip(&body.corners) {
            if corners.iter().any(is_fraction) {
                let facing = body.facings[t as usize];
                origin.faces.push((t, planes.number(facing.plane()), facing.is_with_plane()));
            }
        }
        origin.planes = planes.known.iter().map(|&index| *self.plane(index)).collect();
        let mut lines = Numbers::default();
        for (half_edge, &line) in (0..).zip(&body.lines).filter(|(_, line)| **line != NONE) {
            origin.sides.push((half_edge, lines.number(line)));
        }
        origin.lines = lines.known.iter().map(|&index| self.lines[index as usize]).collect();
        let says_something = !(origin.sites.is_empty() && origin.fractions.is_empty());
        says_something.then_some(origin)
    }
}

/// New numbers for some indices, in the order in which they come.
#[derive(Default)]
struct Numbers {
    of: Lookup<u32, u32>,
    known: Vec<u32>,
}

impl Numbers {
    fn number(&mut self, index: u32) -> u32 {
        *self.of.entry(index).or_insert_with(|| {
            self.known.push(index);
            self.known.len() as u32 - 1
        })
    }
}

/// A body with its corners numbered, one vertex for each fan of triangles.
#[derive(Clone)]
struct Numbered {
    body: Body,
    /// For each corner, its vertex.
    vertices: Vec<u32>,
    count: u32,
}

impl Numbered {
    fn new(body: Body) -> Numbered {
        let (vertices, count) = fans(&body.twins);
        Numbered { body, vertices, count }
    }

    /// The point of each vertex.
    fn points(&self) -> Vec<PointId> {
        let mut points = vec![PointId(NONE); self.count as usize];
        for (&point, &vertex) in self.body.corners.iter().flatten().zip(&self.vertices) {
            points[vertex as usize] = point;
        }
        points
    }

    /// Gives each pair of half-edges an edge of its own: where a solid pinches itself along an edge, both wedges may run
    /// between the same two vertices; all but one of them get a vertex on the way. What was before, if there were any.
    fn part_double_edges(&mut self, world: &mut World<'_>) -> Option<Numbered> {
        let mut double = self.double_edges();
        if double.is_empty() {
            return None;
        }
        let unparted = self.clone();
        self.body.lines.resize(self.body.twins.len(), NONE);
        while !double.is_empty() {
            self.part(world, &double);
            double = self.double_edges();
        }
        Some(unparted)
    }

    /// Parts edges, but none of a triangle that was cut already: its half-edges have moved.
    fn part(&mut self, world: &mut World<'_>, double: &[[u32; 2]]) {
        let mut is_cut = vec![false; self.body.len()];
        for &[beside, half_edge] in double {
            let twin = self.body.twins[half_edge as usize];
            let triangles = [half_edge as usize / 3, twin as usize / 3];
            // New triangles are parts of cut ones.
            if triangles.iter().any(|&t| is_cut.get(t) != Some(&false)) {
                continue;
            }
            triangles.into_iter().for_each(|t| is_cut[t] = true);
            for side in [half_edge, twin, beside, self.body.twins[beside as usize]] {
                self.name_plane(world, side / 3);
            }
            let on_the_way = self.point_on(world, half_edge, beside);
            for side in [half_edge, twin] {
                self.name_line(world, side);
            }
            let far = self.split_side(half_edge, on_the_way);
            let other_far = self.split_side(twin, on_the_way);
            self.count += 1;
            for (x, y) in [(half_edge, other_far), (twin, far)] {
                self.body.twins[x as usize] = y;
                self.body.twins[y as usize] = x;
            }
        }
    }

    /// One half-edge of each edge between vertices that an edge before it joins too, behind one of that. There are none
    /// where no more than two triangles meet at any place.
    fn double_edges(&self) -> Vec<[u32; 2]> {
        if !self.body.may_be_pinched {
            return Vec::new();
        }
        let next = |h: usize| if h % 3 == 2 { h - 2 } else { h + 1 };
        let mut edges: Vec<(u32, u32, u32)> = (0..self.vertices.len())
            .map(|h| (self.vertices[h], self.vertices[next(h)], h as u32))
            .filter(|(from, to, _)| from < to)
            .collect();
        edges.sort_unstable();
        edges.windows(2).filter(|e| (e[0].0, e[0].1) == (e[1].0, e[1].1)).map(|e| [e[0].2, e[1].2]).collect()
    }

    /// A point on an edge, where a plane of lattice points crosses it near the middle. Where the edge is too short for
    /// one, its start.
    ///
    /// An edge inside a face has no line of its own; it lies where the face's plane crosses one of those beside the other
    /// edge between the same points.
    fn point_on(&self, world: &mut World<'_>, half_edge: u32, beside: u32) -> PointId {
        let corners = self.body.corners[half_edge as usize / 3];
        let [from, to] = [0, 1].map(|i| corners[(half_edge as usize + i) % 3]);
        let [a, b] = [from, to].map(|p| world.points().rounded(p));
        let along = (b - a).abs();
        let axis = (0..3).fold(0, |best, axis| if along[axis] > along[best] { axis } else { best });
        let across = Plane::across(axis, (0.5 * (a[axis] + b[axis])) as i64);
        if across.side(world.points(), from) * across.side(world.points(), to) >= 0 {
            return from;
        }
        if [from, to].iter().all(|&end| world.points().as_site(end).is_some()) {
            return world.places.points.crossing(from, to, &across);
        }
        let plane_of = |half_edge: u32| *world.plane(self.body.facings[half_edge as usize / 3].plane());
        let face = plane_of(half_edge);
        let lines: Vec<Plane> = match self.body.lines[half_edge as usize] {
            NONE => [beside, self.body.twins[beside as usize], self.body.twins[half_edge as usize]]
                .map(plane_of)
                .into(),
            line => vec![world.lines[line as usize]],
        };
        let mut points = lines.iter().filter_map(|line| world.places.points.meeting(&face, line, &across));
        points.next().expect("two faces in different planes meet along the edge")
    }

    /// Gives an untouched triangle, which is one between lattice points, its plane.
    fn name_plane(&mut self, world: &mut World<'_>, triangle: u32) {
        let t = triangle as usize;
        if self.body.facings[t].known().is_none() {
            let site = |p: PointId| world.points().as_site(p).expect("cut faces know their plane");
            let [a, b, c] = self.body.corners[t].map(site);
            let plane = Plane::through(a, b, c).expect("the triangle has area");
            self.body.facings[t] = world.facing(&plane);
        }
    }

    /// Gives a half-edge between lattice points a line, which its halves will need.
    fn name_line(&mut self, world: &mut World<'_>, half_edge: u32) {
        let corners = self.body.corners[half_edge as usize / 3];
        let [from, to] = [0, 1].map(|i| world.points().as_site(corners[(half_edge as usize + i) % 3]));
        if self.body.lines[half_edge as usize] == NONE
            && let (Some(from), Some(to)) = (from, to)
        {
            let face = world.plane(self.body.facings[half_edge as usize / 3].plane());
            let line = Plane::along_axis(from, to, face.main_axis()).expect("edges have length");
            self.body.lines[half_edge as usize] = world.add_line(&line);
        }
    }

    /// Cuts the triangle of a half-edge in two at a point on it. The half-edge keeps its first half; the other half, which
    /// is returned, goes to a new triangle.
    fn split_side(&mut self, half_edge: u32, at: PointId) -> u32 {
        let Numbered { body, vertices, count } = self;
        let (t, side) = (half_edge as usize / 3, half_edge as usize % 3);
        let (to, opposite) = ((side + 1) % 3, (side + 2) % 3);
        let new = body.corners.len() as u32;
        let corners = body.corners[t];
        body.corners.push([at, corners[to], corners[opposite]]);
        body.corners[t][to] = at;
        vertices.extend([*count, vertices[3 * t + to], vertices[3 * t + opposite]]);
        vertices[3 * t + to] = *count;
        body.births.push(body.births[t]);
        body.facings.push(body.facings[t]);
        let outer_line = body.lines[3 * t + to];
        body.lines.extend([body.lines[half_edge as usize], outer_line, NONE]);
        body.lines[3 * t + to] = NONE;
        let outer = body.twins[3 * t + to];
        body.twins.extend([NONE, outer, (3 * t + to) as u32]);
        body.twins[outer as usize] = 3 * new + 1;
        body.twins[3 * t + to] = 3 * new + 2;
        3 * new
    }
}
