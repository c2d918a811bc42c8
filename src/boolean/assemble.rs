//! Kept cells merged into faces, triangulated and joined.

use super::Birth;
use super::body::Body;
use super::carriers::{Carrier, Carriers};
use super::regions::{Fin, Regions, Side};
use super::scene::Scene;
use super::world::{Facing, NONE, World};
use crate::math::Aabb;
use crate::numeric::DisjointSets;
use crate::polygon::exact::{Boundary, PointId, followers, triangulate};

/// Builds the surface between inside and outside.
pub(super) fn assemble<'a>(scene: Scene<'a>, carriers: Carriers, regions: &Regions) -> (World<'a>, Body) {
    let (mut scene, mut carriers) = (scene, carriers);
    let Joints { of_fin: joints, crowded } = pair_wedges(regions);
    let faces = merge_cells(&scene, &carriers, regions, &joints);
    let mut rims = Rims::new(&carriers, regions, &faces, &joints);
    let touched_inside = rims.any_touch_inside(&scene, &carriers, regions, &faces, &joints);
    let middles = rims.straighten(&scene, &carriers, &faces);
    let touches_itself = touched_inside
        || faces.any_merged_across(regions, &joints, &crowded)
        || any_flat_across(&scene, &carriers, regions, &joints, &crowded)
        || middles.any_met_by_others(&scene, &carriers, regions);
    let mut surface = Surface { of_rim: vec![NONE; rims.rims.len()], ..Surface::default() };
    surface.add_whole_triangles(&scene, &carriers, regions);
    for face in 0..rims.of_face.len() {
        surface.add_face(&mut scene, &mut carriers, &faces, &rims, face);
    }
    surface.join(regions, &rims, &joints);
    let body = surface.finish(&scene, !touches_itself, crowded.contains(&true));
    (scene.world, body)
}

/// How kept cells are joined along edges.
struct Joints {
    /// For each fin of a kept cell, the fin on the other flank of the solid wedge beside it; [`NONE`] for other fins.
    of_fin: Vec<u32>,
    /// For each fin, whether several wedges meet at its edge.
    crowded: Vec<bool>,
}

fn pair_wedges(regions: &Regions) -> Joints {
    let count = regions.fins.len();
    let mut joints = Joints { of_fin: vec![NONE; count], crowded: vec![false; count] };
    for range in &regions.edges {
        let kept: Vec<u32> =
            range.clone().filter(|&f| regions.is_kept(regions.fins[f as usize].cell)).collect();
        for (i, &fin) in kept.iter().enumerate() {
            joints.crowded[fin as usize] = kept.len() > 2;
            if regions.is_solid_after(&regions.fins[fin as usize]) {
                let other = kept[(i + 1) % kept.len()];
                joints.of_fin[fin as usize] = other;
                joints.of_fin[other as usize] = fin;
            }
        }
    }
    joints
}

/// Faces: cells of one carrier that continue each other.
struct Faces {
    /// For each cell of a carrier, its face, or [`NONE`] where it is not kept.
    of_cell: Vec<u32>,
    /// For each face, its carrier, whether its outward normal is the chart's, and where it came from.
    faces: Vec<Face>,
}

struct Face {
    carrier: u32,
    outward: bool,
    birth: Birth,
}

fn merge_cells(scene: &Scene<'_>, carriers: &Carriers, regions: &Regions, joints: &[u32]) -> Faces {
    let label = |cell: u32| birth_of(carriers, cell).map(|birth| scene.world.label(birth));
    let mut sets = DisjointSets::new(carriers.cell_count as usize);
    for (fin, other) in carrier_joints(regions, joints) {
        if are_flanks_of_one_edge(fin, other) && label(fin.cell) == label(other.cell) {
            sets.join(fin.cell, other.cell);
        }
    }
    let mut faces = Vec::new();
    let mut of_cell = vec![NONE; carriers.cell_count as usize];
    for (index, carrier) in (0..).zip(&carriers.carriers) {
        for cell in (carrier.first_cell..).take(carrier.overlay.coverage.len()) {
            let Some(birth) = birth_of(carriers, cell).filter(|_| regions.is_kept(cell)) else { continue };
            let root = sets.find(cell) as usize;
            if root == cell as usize {
                of_cell[root] = faces.len() as u32;
                faces.push(Face { carrier: index, outward: regions.inside[root][1], birth });
            }
            of_cell[cell as usize] = of_cell[root];
            let face = &mut faces[of_cell[root] as usize];
            face.birth = face.birth.min(birth);
        }
    }
    Faces { of_cell, faces }
}

impl Faces {
    /// Whether a face goes on from one fin to the other.
    fn go_on(&self, fin: &Fin, other: &Fin) -> bool {
        let face = |fin: &Fin| self.of_cell.get(fin.cell as usize);
        are_flanks_of_one_edge(fin, other) && face(fin) == face(other)
    }

    /// Whether a face goes on across an edge that another wedge touches.
    fn any_merged_across(&self, regions: &Regions, joints: &[u32], crowded: &[bool]) -> bool {
        (0..joints.len())
            .filter(|&fin| crowded[fin] && joints[fin] != NONE)
            .any(|fin| self.go_on(&regions.fins[fin], &regions.fins[joints[fin] as usize]))
    }
}

/// Whether an untouched triangle goes on in its plane across an edge that another wedge touches: it did not before, or it
/// would be touched.
fn any_flat_across(
    scene: &Scene<'_>,
    carriers: &Carriers,
    regions: &Regions,
    joints: &[u32],
    crowded: &[bool],
) -> bool {
    let plane = |fin: &Fin| match fin.side {
        Side::Carrier { carrier, .. } => *carriers.carriers[carrier as usize].chart.plane(),
        Side::Triangle { half_edge } => scene.plane_through(half_edge / 3),
    };
    let is_whole = |fin: &Fin| matches!(fin.side, Side::Triangle { .. });
    (0..joints.len()).filter(|&fin| crowded[fin] && joints[fin] != NONE).any(|fin| {
        let (fin, other) = (&regions.fins[fin], &regions.fins[joints[fin] as usize]);
        is_whole(fin) && plane(fin).same_points(&plane(other))
    })
}

/// Joined pairs of fins.
fn carrier_joints<'a>(regions: &'a Regions, joints: &'a [u32]) -> impl Iterator<Item = (&'a Fin, &'a Fin)> {
    let pairs = regions.fins.iter().zip(joints).filter(|&(_, &other)| other != NONE);
    pairs.map(|(fin, &other)| (fin, &regions.fins[other as usize]))
}

/// Whether two fins are the two sides of one edge of one carrier.
fn are_flanks_of_one_edge(a: &Fin, b: &Fin) -> bool {
    match (a.side, b.side) {
        (
            Side::Carrier { carrier, edge, above },
            Side::Carrier { carrier: other_carrier, edge: other_edge, above: other_above },
        ) => carrier == other_carrier && edge == other_edge && above != other_above,
        _ => false,
    }
}

fn birth_of(carriers: &Carriers, cell: u32) -> Option<Birth> {
    let home = carriers.carriers.partition_point(|carrier| carrier.first_cell <= cell).checked_sub(1)?;
    let carrier = &carriers.carriers[home];
    carrier.births[(cell - carrier.first_cell) as usize]
}

/// A boundary edge of a face, with the face on its left seen from outside.
#[derive(Clone, Copy)]
struct Rim {
    ends: [PointId; 2],
    line: u32,
    face: u32,
    /// The fin it came from.
    fin: u32,
    /// The rim that follows it around the face.
    next: u32,
    /// The rim on the other flank of the wedge; [`NONE`] where that is an untouched triangle.
    twin: u32,
    /// Whether it has become part of the rim before it.
    absorbed: bool,
}

/// The boundaries of all faces.
struct Rims {
    rims: Vec<Rim>,
    /// For each face, its rims.
    of_face: Vec<Vec<u32>>,
    /// For each fin, its rim.
    of_fin: Vec<u32>,
}

impl Rims {
    fn new(carriers: &Carriers, regions: &Regions, faces: &Faces, joints: &[u32]) -> Rims {
        let mut rims = Rims {
            rims: Vec::new(),
            of_face: vec![Vec::new(); faces.faces.len()],
            of_fin: vec![NONE; regions.fins.len()],
        };
        for (index, fin) in regions.fins.iter().enumerate().filter(|&(i, _)| joints[i] != NONE) {
            let Side::Carrier { carrier, edge, above } = fin.side else { continue };
            let other = &regions.fins[joints[index] as usize];
            let face = faces.of_cell[fin.cell as usize];
            if faces.go_on(fin, other) {
                continue;
            }
            let edge = &carriers.carriers[carrier as usize].overlay.edges[edge as usize];
            let [left, right] = edge.ends;
            let ends =
                if above == faces.faces[face as usize].outward { [left, right] } else { [right, left] };
            rims.of_fin[index] = rims.rims.len() as u32;
            rims.of_face[face as usize].push(rims.rims.len() as u32);
            rims.rims.push(Rim {
                ends,
                line: edge.line,
                face,
                fin: index as u32,
                next: NONE,
                twin: NONE,
                absorbed: false,
            });
        }
        for rim in &mut rims.rims {
            rim.twin = rims.of_fin[joints[rim.fin as usize] as usize];
        }
        rims
    }

    /// Whether a rim or an untouched triangle has an end inside of a face, where the face will have no vertex.
    fn any_touch_inside(
        &self,
        scene: &Scene<'_>,
        carriers: &Carriers,
        regions: &Regions,
        faces: &Faces,
        joints: &[u32],
    ) -> bool {
        let mut ends: Vec<(PointId, u32)> =
            self.rims.iter().flat_map(|rim| rim.ends.map(|end| (end, rim.face))).collect();
        ends.sort_unstable();
        let mut inside: Vec<PointId> = Vec::new();
        for (fin, _) in carrier_joints(regions, joints).filter(|&(fin, other)| faces.go_on(fin, other)) {
            let face = faces.of_cell[fin.cell as usize];
            inside.extend(fin.ends.into_iter().filter(|&end| ends.binary_search(&(end, face)).is_err()));
        }
        for carrier in carriers.carriers.iter().filter(|carrier| !carrier.marks.is_empty()) {
            let mut cells = (carrier.first_cell..).take(carrier.overlay.coverage.len());
            if cells.any(|cell| regions.is_kept(cell)) {
                inside.extend(&carrier.marks);
            }
        }
        inside.sort_unstable();
        let is_end = |&point: &PointId| {
            ends.get(ends.partition_point(|end| end.0 < point)).is_some_and(|end| end.0 == point)
        };
        inside.iter().any(is_end) || any_whole_triangle_at(scene, carriers, regions, &inside)
    }

    /// Finds how rims follow each other, and makes one of those that run straight on between the same two faces.
    fn straighten(&mut self, scene: &Scene<'_>, carriers: &Carriers, faces: &Faces) -> Middles {
        for (index, face) in faces.faces.iter().enumerate() {
            let Carrier { chart, lines, .. } = &carriers.carriers[face.carrier as usize];
            let boundary = self.boundary_in_chart(face, index);
            let members = &self.of_face[index];
            for (&rim, next) in members.iter().zip(followers(chart, scene.points(), lines, &boundary)) {
                let (before, after) =
                    if face.outward { (rim, members[next as usize]) } else { (members[next as usize], rim) };
                self.rims[before as usize].next = after;
            }
        }
        let once = self.passed_once();
        let runs_on: Vec<bool> = self
            .rims
            .iter()
            .enumerate()
            .map(|(rim, _)| once[rim] && self.runs_on(scene, carriers, faces, rim, &once))
            .collect();
        let middles = self.middles(&runs_on);
        for (rim, runs_on) in runs_on.iter().enumerate() {
            if *runs_on {
                let next = self.rims[rim].next as usize;
                self.rims[next].absorbed = true;
            }
        }
        for head in (0..self.rims.len()).filter(|&rim| !self.rims[rim].absorbed).collect::<Vec<_>>() {
            let mut tail = head;
            while runs_on[tail] {
                tail = self.rims[tail].next as usize;
            }
            self.rims[head].ends[1] = self.rims[tail].ends[1];
            self.rims[head].twin = self.rims[tail].twin;
        }
        for members in &mut self.of_face {
            members.retain(|&rim| !self.rims[rim as usize].absorbed);
        }
        middles
    }

    /// The points at which rims run straight on.
    fn middles(&self, runs_on: &[bool]) -> Middles {
        let passed = (0..self.rims.len()).filter(|&rim| runs_on[rim]);
        let mut points: Vec<PointId> = passed.map(|rim| self.rims[rim].ends[1]).collect();
        points.sort_unstable();
        points.dedup();
        let mut rims_at = vec![0; points.len()];
        for end in self.rims.iter().flat_map(|rim| rim.ends) {
            if let Ok(at) = points.binary_search(&end) {
                rims_at[at] += 1;
            }
        }
        Middles { points, rims_at }
    }

    /// The rims of a face as the chart sees them, with the face on the left.
    fn boundary_in_chart(&self, face: &Face, index: usize) -> Vec<Boundary> {
        let rims = self.of_face[index].iter().map(|&rim| &self.rims[rim as usize]);
        rims.map(|rim| {
            let [from, to] = rim.ends;
            Boundary { ends: if face.outward { [from, to] } else { [to, from] }, line: rim.line }
        })
        .collect()
    }

    /// For each rim, whether its face passes the end of the rim only once.
    fn passed_once(&self) -> Vec<bool> {
        let mut ends: Vec<(u32, PointId, u32)> =
            (0..).zip(&self.rims).map(|(i, rim)| (rim.face, rim.ends[1], i)).collect();
        ends.sort_unstable();
        let mut once = vec![false; self.rims.len()];
        for group in ends.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            if let [(_, _, rim)] = group {
                once[*rim as usize] = true;
            }
        }
        once
    }

    /// Whether a rim and the next one are one straight edge between two faces that both pass its middle once.
    fn runs_on(
        &self,
        scene: &Scene<'_>,
        carriers: &Carriers,
        faces: &Faces,
        rim: usize,
        once: &[bool],
    ) -> bool {
        let here = &self.rims[rim];
        let next = &self.rims[here.next as usize];
        if here.twin == NONE || next.twin == NONE {
            return false;
        }
        let back = &self.rims[next.twin as usize];
        if back.next != here.twin || !once[next.twin as usize] {
            return false;
        }
        let chart = &carriers.carriers[faces.faces[here.face as usize].carrier as usize].chart;
        let ([from, middle], to) = (here.ends, next.ends[1]);
        chart.orientation(scene.points(), from, middle, to) == 0
            && chart.compare(scene.points(), from, middle) == chart.compare(scene.points(), middle, to)
    }
}

/// Points at which edges of the result run straight on, without a vertex.
struct Middles {
    /// The points, in order.
    points: Vec<PointId>,
    /// For each point, how many rims begin or end there.
    rims_at: Vec<u32>,
}

impl Middles {
    /// Whether another edge or vertex touches one of the edges there: two edges have four rims.
    fn any_met_by_others(&self, scene: &Scene<'_>, carriers: &Carriers, regions: &Regions) -> bool {
        self.rims_at.iter().any(|&count| count > 4)
            || any_whole_triangle_at(scene, carriers, regions, &self.points)
    }
}

/// Whether an untouched triangle that is kept has a corner among some points, which are in order.
fn any_whole_triangle_at(
    scene: &Scene<'_>,
    carriers: &Carriers,
    regions: &Regions,
    points: &[PointId],
) -> bool {
    let is_kept = |t: usize| !carriers.touched[t] && regions.is_kept(regions.cell_of_triangle[t]);
    !points.is_empty()
        && (0..scene.corners.len())
            .filter(|&t| is_kept(t))
            .any(|t| scene.corners[t].iter().any(|corner| points.binary_search(corner).is_ok()))
}

/// The result as triangles with twins, before vertices are numbered.
#[derive(Default)]
struct Surface {
    corners: Vec<[PointId; 3]>,
    birth: Vec<Birth>,
    facings: Vec<Facing>,
    /// For half-edge `3 t + i` of the result, its twin.
    twins: Vec<u32>,
    /// For each half-edge, its line in the world, or [`NONE`]; may be shorter than `twins`.
    lines: Vec<u32>,
    /// For each triangle of the scene, its triangle in the result.
    of_whole: Vec<u32>,
    /// For each rim, its half-edge in the result.
    of_rim: Vec<u32>,
}

/// Where the sides of a triangle `a b c` are after it is turned over to `b a c`.
const TURNED: [u32; 3] = [0, 2, 1];

impl Surface {
    fn push(&mut self, corners: [PointId; 3], birth: Birth, facing: Facing) -> u32 {
        self.corners.push(corners);
        self.birth.push(birth);
        self.facings.push(facing);
        self.twins.extend([NONE; 3]);
        self.corners.len() as u32 - 1
    }

    fn set_line(&mut self, half_edge: u32, line: u32) {
        if line != NONE {
            let least = half_edge as usize + 1;
            if self.lines.len() < least {
                self.lines.resize(least, NONE);
            }
            self.lines[half_edge as usize] = line;
        }
    }

    fn link(&mut self, a: u32, b: u32) {
        self.twins[a as usize] = b;
        self.twins[b as usize] = a;
    }

    /// Adds the untouched triangles that are kept, joined among themselves.
    fn add_whole_triangles(&mut self, scene: &Scene<'_>, carriers: &Carriers, regions: &Regions) {
        self.of_whole = vec![NONE; scene.corners.len()];
        for (t, &[a, b, c]) in (0_u32..).zip(&scene.corners) {
            let cell = regions.cell_of_triangle[t as usize];
            if carriers.touched[t as usize] || !regions.is_kept(cell) {
                continue;
            }
            // Turned over where the outside of the operand is inside the result.
            let turned = regions.inside[cell as usize][0];
            let facing = scene.facing(t).unwrap_or(Facing::UNKNOWN);
            let (corners, facing) = if turned { ([b, a, c], facing.turned()) } else { ([a, b, c], facing) };
            let triangle = self.push(corners, scene.births[t as usize], facing);
            self.of_whole[t as usize] = triangle;
            let sides = if turned { TURNED } else { [0, 1, 2] };
            for (half_edge, side) in (3 * t..).zip(sides) {
                self.set_line(3 * triangle + side, scene.line_index(half_edge));
            }
        }
        for t in (0..scene.corners.len() as u32).filter(|&t| self.of_whole[t as usize] != NONE) {
            for half_edge in 3 * t..3 * t + 3 {
                let twin = scene.twins[half_edge as usize];
                if twin != NONE
                    && let Some(other) = self.of_whole_half_edge(regions, twin)
                    && let Some(own) = self.of_whole_half_edge(regions, half_edge)
                {
                    self.twins[own as usize] = other;
                }
            }
        }
    }

    /// The half-edge of the result at the place of an untouched one of the scene.
    fn of_whole_half_edge(&self, regions: &Regions, half_edge: u32) -> Option<u32> {
        let triangle = self.of_whole[half_edge as usize / 3];
        if triangle == NONE {
            return None;
        }
        let turned = regions.inside[regions.cell_of_triangle[half_edge as usize / 3] as usize][0];
        let side = if turned { TURNED[half_edge as usize % 3] } else { half_edge % 3 };
        Some(3 * triangle + side)
    }

    /// Triangulates a face; its inner edges are joined, its rims remembered.
    fn add_face(
        &mut self,
        scene: &mut Scene<'_>,
        carriers: &mut Carriers,
        faces: &Faces,
        rims: &Rims,
        face: usize,
    ) {
        let Face { carrier, outward, birth } = faces.faces[face];
        let carrier = &mut carriers.carriers[carrier as usize];
        let facing = Facing::new(carrier.plane, outward);
        let boundary = rims.boundary_in_chart(&faces.faces[face], face);
        let mut rim_of: Vec<([PointId; 2], u32)> =
            boundary.iter().zip(&rims.of_face[face]).map(|(edge, &rim)| (edge.ends, rim)).collect();
        rim_of.sort_unstable();
        let mut inner: Vec<([PointId; 2], u32)> = Vec::new();
        for [a, b, c] in triangulate(&carrier.chart, scene.points(), &carrier.lines, &boundary) {
            let triangle = self.push(if outward { [a, b, c] } else { [b, a, c] }, birth, facing);
            let sides = if outward { [0, 1, 2] } else { TURNED };
            for (ends, side) in [[a, b], [b, c], [c, a]].into_iter().zip(sides) {
                let half_edge = 3 * triangle + side;
                match rim_of.binary_search_by_key(&ends, |&(ends, _)| ends) {
                    Ok(at) => {
                        let rim = rim_of[at].1;
                        self.of_rim[rim as usize] = half_edge;
                        let line = rims.rims[rim as usize].line;
                        self.set_line(half_edge, world_line(&mut scene.world, carrier, line, ends));
                    }
                    Err(_) => inner.push(([ends[0].min(ends[1]), ends[0].max(ends[1])], half_edge)),
                }
            }
        }
        inner.sort_unstable();
        for pair in inner.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a), (_, b)] = *pair {
                self.link(a, b);
            }
        }
    }

    /// Joins faces and untouched triangles along their rims.
    fn join(&mut self, regions: &Regions, rims: &Rims, joints: &[u32]) {
        for (fin, &other) in joints.iter().enumerate().filter(|&(_, &other)| other != NONE) {
            let half_edge = |fin: usize| match regions.fins[fin].side {
                Side::Triangle { half_edge } => self.of_whole_half_edge(regions, half_edge),
                Side::Carrier { .. } => {
                    let rim = rims.of_fin[fin];
                    (rim != NONE && !rims.rims[rim as usize].absorbed).then(|| self.of_rim[rim as usize])
                }
            };
            let along_whole =
                [fin, other as usize].map(|f| matches!(regions.fins[f].side, Side::Triangle { .. }));
            if along_whole.contains(&true)
                && let (Some(a), Some(b)) = (half_edge(fin), half_edge(other as usize))
            {
                self.link(a, b);
            }
        }
        for (index, rim) in rims.rims.iter().enumerate().filter(|(_, rim)| !rim.absorbed && rim.twin != NONE)
        {
            self.link(self.of_rim[index], self.of_rim[rim.twin as usize]);
        }
    }

    fn finish(self, scene: &Scene<'_>, embedded: bool, may_be_pinched: bool) -> Body {
        debug_assert!(!self.twins.contains(&NONE), "a half-edge without a twin");
        let bounds = Aabb::of(self.corners.iter().flatten().map(|&p| scene.points().rounded(p)));
        Body {
            corners: self.corners,
            births: self.birth,
            twins: self.twins,
            facings: self.facings,
            lines: self.lines,
            bounds,
            embedded,
            may_be_pinched,
        }
    }
}

/// The line of the world that a boundary edge runs on; [`NONE`] where that follows from its ends.
fn world_line(world: &mut World<'_>, carrier: &mut Carrier, line: u32, ends: [PointId; 2]) -> u32 {
    if ends.iter().all(|&end| world.points().as_site(end).is_some()) {
        return NONE;
    }
    let known = &mut carrier.world_lines[line as usize];
    if *known == NONE {
        *known = world.add_line(carrier.lines[line as usize].plane());
    }
    *known
}
