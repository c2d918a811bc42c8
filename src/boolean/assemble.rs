//! Kept cells merged into faces, triangulated and joined.

use super::carriers::{Carrier, Carriers};
use super::regions::{Fin, Regions, Side};
use super::scene::Scene;
use super::{Birth, Combined};
use crate::math::Vec3;
use crate::mesh::{Mesh, Solid, Topology, fans};
use crate::numeric::DisjointSets;
use crate::polygon::exact::{Boundary, PointId, followers, triangulate};

/// Builds the solid between inside and outside.
pub(super) fn assemble(scene: &Scene, carriers: &Carriers, regions: &Regions) -> Combined {
    let joints = pair_wedges(regions);
    let faces = merge_cells(scene, carriers, regions, &joints);
    let mut rims = Rims::new(carriers, regions, &faces, &joints);
    rims.straighten(scene, carriers, &faces);
    let mut surface = Surface { of_rim: vec![NONE; rims.rims.len()], ..Surface::default() };
    surface.add_whole_triangles(scene, carriers, regions);
    for face in 0..rims.of_face.len() {
        surface.add_face(scene, carriers, &faces, &rims, face);
    }
    surface.join(regions, &rims, &joints);
    surface.finish(scene)
}

const NONE: u32 = u32::MAX;

/// For each fin of a kept cell, the fin on the other flank of the solid wedge beside it; [`NONE`] for other fins.
fn pair_wedges(regions: &Regions) -> Vec<u32> {
    let mut joints = vec![NONE; regions.fins.len()];
    for range in &regions.edges {
        let kept: Vec<u32> =
            range.clone().filter(|&f| regions.is_kept(regions.fins[f as usize].cell)).collect();
        for (i, &fin) in kept.iter().enumerate() {
            if regions.is_solid_after(&regions.fins[fin as usize]) {
                let other = kept[(i + 1) % kept.len()];
                joints[fin as usize] = other;
                joints[other as usize] = fin;
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

fn merge_cells(scene: &Scene, carriers: &Carriers, regions: &Regions, joints: &[u32]) -> Faces {
    let material =
        |cell: u32| birth_of(carriers, cell).map(|birth| scene.members[birth.operand as usize].material);
    let mut sets = DisjointSets::new(carriers.cell_count as usize);
    for (fin, other) in carrier_joints(regions, joints) {
        if are_flanks_of_one_edge(fin, other) && material(fin.cell) == material(other.cell) {
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
            if are_flanks_of_one_edge(fin, other) && faces.of_cell[other.cell as usize] == face {
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

    /// Finds how rims follow each other, and makes one of those that run straight on between the same two faces.
    fn straighten(&mut self, scene: &Scene, carriers: &Carriers, faces: &Faces) {
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
    fn runs_on(&self, scene: &Scene, carriers: &Carriers, faces: &Faces, rim: usize, once: &[bool]) -> bool {
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

/// The result as triangles with twins, before vertices are numbered.
#[derive(Default)]
struct Surface {
    corners: Vec<[PointId; 3]>,
    birth: Vec<Birth>,
    /// For half-edge `3 t + i` of the result, its twin.
    twins: Vec<u32>,
    /// For each triangle of the scene, its triangle in the result.
    of_whole: Vec<u32>,
    /// For each rim, its half-edge in the result.
    of_rim: Vec<u32>,
}

impl Surface {
    fn push(&mut self, corners: [PointId; 3], birth: Birth) -> u32 {
        self.corners.push(corners);
        self.birth.push(birth);
        self.twins.extend([NONE; 3]);
        self.corners.len() as u32 - 1
    }

    fn link(&mut self, a: u32, b: u32) {
        self.twins[a as usize] = b;
        self.twins[b as usize] = a;
    }

    /// Adds the untouched triangles that are kept, joined among themselves.
    fn add_whole_triangles(&mut self, scene: &Scene, carriers: &Carriers, regions: &Regions) {
        self.of_whole = vec![NONE; scene.triangles.len()];
        for (t, triangle) in scene.triangles.iter().enumerate() {
            if carriers.touched[t] || !regions.is_kept(regions.cell_of_triangle[t]) {
                continue;
            }
            let [a, b, c] = triangle.corners;
            // Turned over where the outside of the operand is inside the result.
            let turned = regions.inside[regions.cell_of_triangle[t] as usize][0];
            let corners = if turned { [b, a, c] } else { [a, b, c] };
            self.of_whole[t] =
                self.push(corners, Birth { operand: triangle.operand, triangle: triangle.index });
        }
        for (half_edge, &twin) in (0_u32..).zip(&scene.twins) {
            if twin != Topology::NONE && half_edge < twin {
                let (a, b) =
                    (self.of_whole_half_edge(regions, half_edge), self.of_whole_half_edge(regions, twin));
                if let (Some(a), Some(b)) = (a, b) {
                    self.link(a, b);
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
        // Turned over, the corners are b a c: side 0 stays, sides 1 and 2 change places.
        let side = if turned { [0, 2, 1][half_edge as usize % 3] } else { half_edge % 3 };
        Some(3 * triangle + side)
    }

    /// Triangulates a face; its inner edges are joined, its rims remembered.
    fn add_face(&mut self, scene: &Scene, carriers: &Carriers, faces: &Faces, rims: &Rims, face: usize) {
        let Face { carrier, outward, birth } = faces.faces[face];
        let Carrier { chart, lines, .. } = &carriers.carriers[carrier as usize];
        let boundary = rims.boundary_in_chart(&faces.faces[face], face);
        let mut rim_of: Vec<([PointId; 2], u32)> =
            boundary.iter().zip(&rims.of_face[face]).map(|(edge, &rim)| (edge.ends, rim)).collect();
        rim_of.sort_unstable();
        let mut inner: Vec<([PointId; 2], u32)> = Vec::new();
        for [a, b, c] in triangulate(chart, scene.points(), lines, &boundary) {
            let triangle = self.push(if outward { [a, b, c] } else { [b, a, c] }, birth);
            let sides = if outward { [0, 1, 2] } else { [0, 2, 1] };
            for (ends, side) in [[a, b], [b, c], [c, a]].into_iter().zip(sides) {
                let half_edge = 3 * triangle + side;
                match rim_of.binary_search_by_key(&ends, |&(ends, _)| ends) {
                    Ok(at) => self.of_rim[rim_of[at].1 as usize] = half_edge,
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

    /// Numbers vertices, one for each fan of triangles.
    fn finish(self, scene: &Scene) -> Combined {
        debug_assert!(!self.twins.contains(&NONE), "a half-edge without a twin");
        let (vertices, count) = fans(&self.twins);
        let mut positions = vec![Vec3::ZERO; count as usize];
        for (&point, &vertex) in self.corners.iter().flatten().zip(&vertices) {
            positions[vertex as usize] = scene.places.position(point);
        }
        let embedded = scene.places.is_exact()
            && self.corners.iter().flatten().all(|&point| scene.places.is_given(point));
        let mut mesh = Mesh { positions, triangles: vertices.as_chunks().0.to_vec() };
        let mut birth = self.birth;
        part_double_edges(&mut mesh, self.twins, &mut birth);
        Combined { solid: Solid::assume(mesh, embedded), birth }
    }
}

/// Gives each pair of half-edges an edge of its own: where a solid pinches itself along an edge, both wedges may run
/// between the same two vertices; all but one of them get a vertex in the middle.
fn part_double_edges(mesh: &mut Mesh, mut twins: Vec<u32>, birth: &mut Vec<Birth>) {
    loop {
        let Some((half_edge, twin)) = double_edge(mesh, &twins) else { return };
        let ends = |h: u32| {
            let triangle = mesh.triangles[h as usize / 3];
            [triangle[h as usize % 3], triangle[(h as usize + 1) % 3]].map(|v| mesh.positions[v as usize])
        };
        let [a, b] = ends(half_edge);
        let middle = mesh.positions.len() as u32;
        mesh.positions.push(0.5 * a + 0.5 * b);
        let far = split_side(mesh, &mut twins, birth, half_edge, middle);
        let other_far = split_side(mesh, &mut twins, birth, twin, middle);
        for (x, y) in [(half_edge, other_far), (twin, far)] {
            twins[x as usize] = y;
            twins[y as usize] = x;
        }
    }
}

/// A half-edge, with its twin, between vertices that another pair joins too.
fn double_edge(mesh: &Mesh, twins: &[u32]) -> Option<(u32, u32)> {
    let mut edges: Vec<(u32, u32, u32)> = (0..3 * mesh.triangles.len())
        .map(|h| (mesh.triangles[h / 3][h % 3], mesh.triangles[h / 3][(h + 1) % 3], h as u32))
        .filter(|(from, to, _)| from < to)
        .collect();
    edges.sort_unstable();
    let double = edges.windows(2).find(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1))?;
    Some((double[1].2, twins[double[1].2 as usize]))
}

/// Cuts the triangle of a half-edge in two at a vertex on it. The half-edge keeps its first half; the other half, which
/// is returned, goes to a new triangle.
fn split_side(
    mesh: &mut Mesh,
    twins: &mut Vec<u32>,
    birth: &mut Vec<Birth>,
    half_edge: u32,
    middle: u32,
) -> u32 {
    let (t, side) = (half_edge as usize / 3, half_edge as usize % 3);
    let (to, opposite) = ((side + 1) % 3, (side + 2) % 3);
    let new = mesh.triangles.len() as u32;
    let [b, c] = [to, opposite].map(|i| mesh.triangles[t][i]);
    mesh.triangles[t][to] = middle;
    mesh.triangles.push([middle, b, c]);
    birth.push(birth[t]);
    let outer = twins[3 * t + to];
    twins.extend([NONE, outer, (3 * t + to) as u32]);
    twins[outer as usize] = 3 * new + 1;
    twins[3 * t + to] = 3 * new + 2;
    3 * new
}
