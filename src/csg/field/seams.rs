//! The curves in which curved surfaces cut each other.
//!
//! Booleans cut meshes, so the vertices along a cut lie where two facets meet, each within its tolerance of its surface:
//! where surfaces cut each other at an angle a, the curve is off by up to the tolerances over sin a. Such vertices are
//! moved onto all surfaces that meet there, edges along the curve are halved until they are near it too, and what would
//! not be a sound solid afterwards stays as it was.

use super::faces::{FLAT, Faces};
use super::meeting::{BESIDE, Piece, Sheet};
use crate::math::Vec3;
use crate::mesh::{Mesh, Solid, Topology, crossing_pairs};

/// What became of the vertices on seams.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seams {
    /// Vertices moved onto all surfaces that meet there.
    pub moved: usize,
    /// Vertices that were left where facets meet: surfaces touch there rather than cut, more than three meet, or the
    /// solid would not have stayed one.
    pub left: usize,
}

impl Seams {
    /// What became of those of two results together.
    #[must_use]
    pub fn and(self, other: Seams) -> Seams {
        Seams { moved: self.moved + other.moved, left: self.left + other.left }
    }
}

/// A solid with its seams on the surfaces.
pub(in crate::csg) struct Sewn {
    pub(in crate::csg) solid: Solid,
    /// For each triangle, the one that it was a part of.
    pub(in crate::csg) parents: Vec<u32>,
    pub(in crate::csg) seams: Seams,
}

/// Moves seams onto their surfaces; `None` where there are none. Where nothing could be moved the solid is as it was, with
/// all that is known of it.
pub(in crate::csg) fn sew(solid: &Solid, faces: &Faces) -> Option<Sewn> {
    let first = faces.of_triangle.first()?;
    if faces.of_triangle.iter().all(|face| face == first) {
        return None;
    }
    let mut cloth = Cloth::new(solid, faces);
    let mut new = cloth.seam_vertices();
    if new.is_empty() {
        return None;
    }
    let mut seams = Seams::default();
    for _ in 0..ROUNDS {
        let targets: Vec<(u32, Option<Vec3>)> = new.iter().map(|&h| (h, cloth.target(h))).collect();
        let moved = cloth.pull(&targets);
        seams = seams.and(Seams { moved, left: targets.len() - moved });
        if cloth.mesh.triangles.len() > MOST_GROWTH * solid.triangles().len() {
            break;
        }
        new = cloth.halve_seams();
        if new.is_empty() {
            break;
        }
    }
    if seams.moved == 0 {
        let parents = (0..solid.triangles().len() as u32).collect();
        return Some(Sewn { solid: solid.clone(), parents, seams });
    }
    let Cloth { mesh, parents, .. } = cloth;
    Some(Sewn { solid: Solid::assume(mesh, false), parents, seams })
}

/// Edges along seams are halved so many times at most: each halving brings them four times as near.
const ROUNDS: usize = 12;

/// Seams that would need more triangles than this many times those of the solid are no curves.
const MOST_GROWTH: usize = 4;

/// How near to the curve the middle of an edge must be, in tolerances.
const NEAR: f64 = 0.9;

/// Gradients with a larger cosine belong to one smooth piece of a surface.
const SMOOTH: f64 = 0.9;

/// Normals with a larger cosine belong to one plane, up to rounding.
const ONE_PLANE: f64 = 1.0 - 1e-9;

/// Rounds of leaving out what does no good.
const PATIENCE: usize = 16;

/// A mesh that is being changed.
struct Cloth<'a> {
    faces: &'a Faces,
    mesh: Mesh,
    twins: Vec<u32>,
    parents: Vec<u32>,
}

impl Cloth<'_> {
    fn new<'a>(solid: &Solid, faces: &'a Faces) -> Cloth<'a> {
        Cloth {
            faces,
            mesh: solid.mesh().clone(),
            twins: solid.topology().twins().to_vec(),
            parents: (0..solid.triangles().len() as u32).collect(),
        }
    }

    fn face(&self, triangle: u32) -> u32 {
        self.faces.of_triangle[self.parents[triangle as usize] as usize]
    }

    fn start(&self, half_edge: u32) -> u32 {
        self.mesh.triangles[half_edge as usize / 3][half_edge as usize % 3]
    }

    fn position(&self, vertex: u32) -> Vec3 {
        self.mesh.positions[vertex as usize]
    }

    /// Whether different surfaces meet along a half-edge.
    fn is_seam(&self, half_edge: u32) -> bool {
        self.face(half_edge / 3) != self.face(self.twins[half_edge as usize] / 3)
    }

    /// For each vertex on a seam, a half-edge that starts there.
    fn seam_vertices(&self) -> Vec<u32> {
        let mut seen = vec![false; self.mesh.positions.len()];
        let mut at = Vec::new();
        for half_edge in (0..self.twins.len() as u32).filter(|&h| self.is_seam(h)) {
            if !std::mem::replace(&mut seen[self.start(half_edge) as usize], true) {
                at.push(half_edge);
            }
        }
        at
    }

    /// The triangles around the start of a half-edge.
    fn around(&self, half_edge: u32) -> Vec<u32> {
        let mut around = Vec::new();
        let mut at = half_edge;
        loop {
            around.push(at / 3);
            at = self.twins[Topology::previous(at) as usize];
            if at == half_edge {
                return around;
            }
        }
    }

    fn area_vector(&self, triangle: u32) -> Vec3 {
        area_vector(&self.mesh.corners(triangle as usize))
    }

    /// Where the surfaces around the start of a half-edge meet, near it; `None` where that is nowhere.
    fn target(&self, half_edge: u32) -> Option<Vec3> {
        let place = self.position(self.start(half_edge));
        let pieces = self.pieces(&self.around(half_edge), place)?;
        self.faces.meeting(&pieces, place)
    }

    /// The pieces that some triangles at a point stand for; `None` where there are more than three.
    fn pieces(&self, triangles: &[u32], place: Vec3) -> Option<Vec<Piece>> {
        let mut pieces: Vec<(Piece, u32, Vec3)> = Vec::new();
        for &triangle in triangles {
            let face = self.face(triangle);
            let piece = if face == FLAT {
                let normal = self.area_vector(triangle).try_normalize()?;
                Piece::Flat(Sheet { normal, offset: normal.dot(place) })
            } else {
                let toward = centroid(&self.mesh.corners(triangle as usize));
                Piece::Curved { surface: face, toward }
            };
            let normal = self.faces.sheet(&piece, place, BESIDE)?.normal;
            let alike = if face == FLAT { ONE_PLANE } else { SMOOTH };
            let is_known = |known: &(Piece, u32, Vec3)| known.1 == face && known.2.dot(normal) > alike;
            if !pieces.iter().any(is_known) {
                pieces.push((piece, face, normal));
            }
        }
        (pieces.len() <= 3).then(|| pieces.into_iter().map(|(piece, ..)| piece).collect())
    }

    /// Moves the starts of half-edges to their targets. Where triangles would be folded, too far from their surfaces, or
    /// pass through others, it is done again without the vertices there. Tells how many were moved.
    fn pull(&mut self, targets: &[(u32, Option<Vec3>)]) -> usize {
        let movement = |&(half_edge, to): &(u32, Option<Vec3>)| {
            Some(Move { half_edge, vertex: self.start(half_edge), to: to? })
        };
        let mut moves: Vec<Move> = targets.iter().filter_map(movement).collect();
        for attempt in 0..PATIENCE {
            let before = (self.mesh.clone(), self.twins.clone());
            let bad = self.moved_badly(&moves);
            if bad.is_empty() {
                return moves.len();
            }
            let mut corners: Vec<u32> =
                bad.iter().flat_map(|&triangle| self.mesh.triangles[triangle as usize]).collect();
            corners.sort_unstable();
            (self.mesh, self.twins) = before;
            let count = moves.len();
            let is_corner = |vertex: &u32| corners.binary_search(vertex).is_ok();
            moves.retain(|m| !is_corner(&m.vertex));
            // What is bad may be so since something beside it was moved.
            if moves.len() == count || attempt > PATIENCE / 2 {
                let is_beside = |m: &Move| {
                    let around = self.around(m.half_edge);
                    around.iter().any(|&t| self.mesh.triangles[t as usize].iter().any(is_corner))
                };
                moves.retain(|m| !is_beside(m));
            }
            if moves.len() == count {
                break;
            }
        }
        0
    }

    /// Moves vertices and flips edges where that is needed; triangles that are not as they should be after it.
    fn moved_badly(&mut self, moves: &[Move]) -> Vec<u32> {
        let mut touched: Vec<u32> = moves.iter().flat_map(|m| self.around(m.half_edge)).collect();
        touched.sort_unstable();
        touched.dedup();
        let old = |&t: &u32| Old { triangle: t, area: self.area_vector(t), distance: self.distance(t) };
        let mut old: Vec<Old> = touched.iter().map(old).collect();
        moves.iter().for_each(|m| self.mesh.positions[m.vertex as usize] = m.to);
        self.flip_unsound(&mut old);
        let unsound = old.iter().filter(|old| !self.is_sound_still(old));
        let bad: Vec<u32> = unsound.map(|old| old.triangle).collect();
        if bad.is_empty() { crossing_pairs(&self.mesh, &touched).into_flattened() } else { bad }
    }

    fn is_sound_still(&self, old: &Old) -> bool {
        let corners = self.mesh.corners(old.triangle as usize);
        self.is_sound(self.face(old.triangle), &corners, old.area, old.distance)
    }

    /// Flips edges of unsound triangles where both new ones are sound. What lay between vertices on the curve alone is
    /// folded over once these are where they belong.
    fn flip_unsound(&mut self, old: &mut [Old]) {
        for _ in 0..PATIENCE {
            let mut any = false;
            for index in 0..old.len() {
                if !self.is_sound_still(&old[index]) {
                    any |= (0..3).any(|side| self.flip(3 * old[index].triangle + side, old));
                }
            }
            if !any {
                break;
            }
        }
    }

    /// Flips an edge inside of a curved face, if that makes two sound triangles.
    fn flip(&mut self, half_edge: u32, old: &mut [Old]) -> bool {
        let twin = self.twins[half_edge as usize];
        let (t, n) = (half_edge / 3, twin / 3);
        let known = |t: u32| old.binary_search_by_key(&t, |old| old.triangle).ok();
        let (face, Some(own), Some(other)) = (self.face(t), known(t), known(n)) else { return false };
        if face == FLAT || face != self.face(n) {
            return false;
        }
        let [a, b] = [half_edge, Topology::previous(half_edge)].map(|h| self.start(h));
        let [c, d] = [twin, Topology::previous(twin)].map(|h| self.start(h));
        let around_b = self.around(Topology::previous(half_edge));
        if around_b.iter().any(|&t| self.mesh.triangles[t as usize].contains(&d)) {
            return false;
        }
        let area = old[own].area + old[other].area;
        let distance = old[own].distance.max(old[other].distance);
        let new = [[a, d, b], [d, c, b]];
        let is_sound =
            |corners: &[u32; 3]| self.is_sound(face, &corners.map(|v| self.position(v)), area, distance);
        if !new.iter().all(is_sound) {
            return false;
        }
        let outer = |h: u32| self.twins[h as usize];
        let [cb, ba] = [outer(Topology::next(half_edge)), outer(Topology::previous(half_edge))];
        let [ad, dc] = [outer(Topology::next(twin)), outer(Topology::previous(twin))];
        [self.mesh.triangles[t as usize], self.mesh.triangles[n as usize]] = new;
        for (x, y) in [(3 * t, ad), (3 * t + 1, 3 * n + 2), (3 * t + 2, ba), (3 * n, dc), (3 * n + 1, cb)] {
            self.twins[x as usize] = y;
            self.twins[y as usize] = x;
        }
        for index in [own, other] {
            (old[index].area, old[index].distance) = (area, distance);
        }
        true
    }

    /// Whether a triangle of a face still faces the way of an area vector, and is as near to its surface as it may be or
    /// as something else was.
    fn is_sound(&self, face: u32, corners: &[Vec3; 3], area: Vec3, distance: f64) -> bool {
        const COSINE: f64 = 0.5;
        let now = area_vector(corners);
        // What is thin may turn about itself, but not about the surface.
        let outward = match face {
            FLAT => area,
            surface => {
                let (_, gradient) = self.faces.surfaces[surface as usize].gradient(centroid(corners));
                gradient * gradient.dot(area).signum()
            }
        };
        let allowed = match face {
            FLAT => f64::INFINITY,
            surface => self.faces.surfaces[surface as usize].tolerance.max(distance),
        };
        now.dot(outward) > COSINE * now.length() * outward.length()
            && self.distance_of(face, corners) <= allowed
    }

    fn distance(&self, triangle: u32) -> f64 {
        self.distance_of(self.face(triangle), &self.mesh.corners(triangle as usize))
    }

    /// About the largest distance of a triangle from the surface of its face.
    fn distance_of(&self, face: u32, corners: &[Vec3; 3]) -> f64 {
        if face == FLAT {
            return 0.0;
        }
        let &[a, b, c] = corners;
        let places = [centroid(corners), 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        let surface = &self.faces.surfaces[face as usize];
        places.into_iter().map(|p| surface.distance(p)).fold(0.0, f64::max)
    }

    /// Halves the edges along seams that are not near the curve, at most one of each triangle, where the middle can go
    /// there; for each new vertex a half-edge that starts there.
    fn halve_seams(&mut self) -> Vec<u32> {
        let mut is_cut = vec![false; self.mesh.triangles.len()];
        let mut new = Vec::new();
        for half_edge in 0..self.twins.len() as u32 {
            let twin = self.twins[half_edge as usize];
            let sides = [half_edge / 3, twin / 3].map(|t| t as usize);
            // New triangles are parts of cut ones.
            let any_cut = sides.iter().any(|&t| is_cut.get(t) != Some(&false));
            if half_edge > twin || any_cut || !self.is_seam(half_edge) {
                continue;
            }
            if let Some(target) = self.far_middle(half_edge)
                && [half_edge, twin].iter().all(|&h| self.may_be_cut(h, target))
            {
                sides.into_iter().for_each(|t| is_cut[t] = true);
                new.push(self.halve(half_edge));
            }
        }
        new
    }

    /// Where the middle of an edge along a seam belongs, unless it is near enough.
    fn far_middle(&self, half_edge: u32) -> Option<Vec3> {
        let twin = self.twins[half_edge as usize];
        let [from, to] = [half_edge, twin].map(|h| self.position(self.start(h)));
        let middle = 0.5 * (from + to);
        let tolerance = [half_edge, twin].map(|h| match self.face(h / 3) {
            FLAT => f64::INFINITY,
            surface => self.faces.surfaces[surface as usize].tolerance,
        });
        let target = self.faces.meeting(&self.pieces(&[half_edge / 3, twin / 3], middle)?, middle)?;
        (target.distance(middle) > NEAR * tolerance[0].min(tolerance[1])).then_some(target)
    }

    /// Whether both parts of a triangle are sound when one of its sides is cut at a vertex at some place.
    fn may_be_cut(&self, half_edge: u32, at: Vec3) -> bool {
        let triangle = half_edge / 3;
        let (corners, side) = (self.mesh.corners(triangle as usize), half_edge as usize % 3);
        let [from, to, opposite] = [0, 1, 2].map(|i| corners[(side + i) % 3]);
        let (area, distance) = (self.area_vector(triangle), self.distance(triangle));
        [[from, at, opposite], [at, to, opposite]]
            .iter()
            .all(|part| self.is_sound(self.face(triangle), part, area, distance))
    }

    /// Puts a vertex in the middle of an edge and hands back a half-edge that starts there.
    fn halve(&mut self, half_edge: u32) -> u32 {
        let twin = self.twins[half_edge as usize];
        let middle = 0.5 * (self.position(self.start(half_edge)) + self.position(self.start(twin)));
        let vertex = self.mesh.positions.len() as u32;
        self.mesh.positions.push(middle);
        let far = self.cut(half_edge, vertex);
        let other_far = self.cut(twin, vertex);
        for (a, b) in [(half_edge, other_far), (twin, far)] {
            self.twins[a as usize] = b;
            self.twins[b as usize] = a;
        }
        far
    }

    /// Cuts the triangle of a half-edge in two at a new vertex on it. The half-edge keeps its first half; the other half,
    /// which is returned, belongs to a new triangle.
    fn cut(&mut self, half_edge: u32, vertex: u32) -> u32 {
        let (t, side) = (half_edge as usize / 3, half_edge as usize % 3);
        let (to, opposite) = ((side + 1) % 3, (side + 2) % 3);
        let corners = self.mesh.triangles[t];
        let new = 3 * self.mesh.triangles.len() as u32;
        self.mesh.triangles.push([vertex, corners[to], corners[opposite]]);
        self.mesh.triangles[t][to] = vertex;
        self.parents.push(self.parents[t]);
        let (inner, outer) = ((3 * t + to) as u32, self.twins[3 * t + to]);
        self.twins.extend([half_edge, outer, inner]);
        self.twins[outer as usize] = new + 1;
        self.twins[inner as usize] = new + 2;
        new
    }
}

/// A vertex on its way.
struct Move {
    /// One that starts at the vertex, before anything is flipped.
    half_edge: u32,
    vertex: u32,
    to: Vec3,
}

/// What a triangle was like.
struct Old {
    triangle: u32,
    area: Vec3,
    distance: f64,
}

fn area_vector(&[a, b, c]: &[Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}

fn centroid(&[a, b, c]: &[Vec3; 3]) -> Vec3 {
    (a + b + c) / 3.0
}
