//! The space between the cells: regions, their winding numbers, and which are inside.

use super::carriers::{Carrier, Carriers};
use super::ray::{Anchor, RayCaster};
use super::scene::Scene;
use super::tree::{Judge, Tree};
use super::world::NONE;
use crate::numeric::DisjointSets;
use crate::polygon::exact::{Boundary, Plane, PointId, Points, triangulate};
use std::cmp::Ordering;
use std::ops::Range;

/// What belongs to a cell along an edge: a half-edge of the result, if the cell is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// The cell above or below an edge of a carrier.
    Carrier { carrier: u32, edge: u32, above: bool },
    /// The side of an untouched triangle.
    Triangle { half_edge: u32 },
}

/// A half-plane that a cell lies in, seen from one of the cell's edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fin {
    /// The edge, from the smaller point to the larger one.
    pub(super) ends: [PointId; 2],
    /// Index of its plane in the list of planes of all fins.
    plane: u32,
    /// Whether the cell lies to the left of the edge about the normal of the plane.
    left: bool,
    pub(super) cell: u32,
    pub(super) side: Side,
}

/// Which cells separate inside from outside.
#[derive(Debug)]
pub(super) struct Regions {
    /// Fins by edge and, around one edge, counter-clockwise about its direction.
    pub(super) fins: Vec<Fin>,
    /// The fins of each edge.
    pub(super) edges: Vec<Range<u32>>,
    /// For each untouched triangle, the number of its cell.
    pub(super) cell_of_triangle: Vec<u32>,
    /// For each cell, whether the region in front of it (where its normal points) and the one behind are inside.
    pub(super) inside: Vec<[bool; 2]>,
}

impl Regions {
    /// Whether a cell is part of the result's surface.
    pub(super) fn is_kept(&self, cell: u32) -> bool {
        let [front, back] = self.inside[cell as usize];
        front != back
    }

    /// Whether the region counter-clockwise of a fin, about its edge, is inside.
    pub(super) fn is_solid_after(&self, fin: &Fin) -> bool {
        let [front, back] = self.inside[fin.cell as usize];
        if fin.left { front } else { back }
    }
}

/// Finds regions and their winding numbers, and evaluates the expression in each.
pub(super) fn classify(scene: &Scene<'_>, carriers: &Carriers, tree: &Tree) -> Regions {
    let patches = find_patches(scene, carriers);
    let (mut fins, planes) = gather_fins(scene, carriers, &patches);
    fins.sort_by_key(|fin| fin.ends);
    let edges = edge_ranges(&fins);
    for range in &edges {
        sort_radially(scene.points(), &planes, &mut fins[range.start as usize..range.end as usize]);
    }
    let (region_of_side, region_count) = join_regions(&fins, &edges, patches.cell_count);
    let links = links(scene, carriers, &patches, &region_of_side);
    let winding = propagate(scene, carriers, &patches, &links, region_count as usize);
    let mut judge = Judge::new(tree, scene.members.len());
    let inside: Vec<bool> = winding.iter().map(|winding| judge.holds(winding)).collect();
    let inside = (0..patches.cell_count as usize)
        .map(|cell| [2 * cell, 2 * cell + 1].map(|side| inside[region_of_side[side] as usize]))
        .collect();
    Regions { fins, edges, cell_of_triangle: patches.cell_of_triangle, inside }
}

/// Connected untouched triangles, each patch one cell; cells of carriers come first.
struct Patches {
    cell_of_triangle: Vec<u32>,
    /// The first triangle of each patch.
    first_triangle: Vec<u32>,
    cell_count: u32,
}

fn find_patches(scene: &Scene<'_>, carriers: &Carriers) -> Patches {
    let count = scene.corners.len();
    let (mut cell_of_triangle, mut first_triangle) = (vec![NONE; count], Vec::new());
    let mut cell_count = carriers.cell_count;
    let mut stack = Vec::new();
    for first in 0..count as u32 {
        if carriers.touched[first as usize] || cell_of_triangle[first as usize] != NONE {
            continue;
        }
        cell_of_triangle[first as usize] = cell_count;
        first_triangle.push(first);
        stack.push(first);
        while let Some(t) = stack.pop() {
            for &twin in &scene.twins[3 * t as usize..][..3] {
                let next = twin as usize / 3;
                if twin != NONE && !carriers.touched[next] && cell_of_triangle[next] == NONE {
                    cell_of_triangle[next] = cell_count;
                    stack.push(next as u32);
                }
            }
        }
        cell_count += 1;
    }
    Patches { cell_of_triangle, first_triangle, cell_count }
}

/// The fins of all covered cells of carriers, and those of untouched triangles along touched ones and wherever more than
/// two meet: which of them belong together changes when inside and outside are exchanged.
fn gather_fins(scene: &Scene<'_>, carriers: &Carriers, patches: &Patches) -> (Vec<Fin>, Vec<Plane>) {
    let (mut fins, mut planes) = (Vec::new(), Vec::new());
    for (index, carrier) in (0_u32..).zip(&carriers.carriers) {
        planes.push(*carrier.chart.plane());
        for (number, edge) in (0_u32..).zip(&carrier.overlay.edges) {
            let [from, to] = edge.ends;
            for (above, (cell, covered)) in [false, true].into_iter().zip(carrier.beside(edge)) {
                if covered {
                    let side = Side::Carrier { carrier: index, edge: number, above };
                    // The cell above lies to the left of the edge seen from left to right.
                    let left = above == (from < to);
                    fins.push(Fin { ends: [from.min(to), from.max(to)], plane: index, left, cell, side });
                }
            }
        }
    }
    let pinched = scene.pinched();
    for (half_edge, &twin) in (0_u32..).zip(&scene.twins) {
        let triangle = half_edge / 3;
        if carriers.touched[triangle as usize]
            || !(carriers.touched[twin as usize / 3] || pinched[half_edge as usize])
        {
            continue;
        }
        let corners = scene.corners[triangle as usize];
        let (from, to) = (corners[half_edge as usize % 3], corners[(half_edge as usize + 1) % 3]);
        fins.push(Fin {
            ends: [from.min(to), from.max(to)],
            plane: planes.len() as u32,
            left: from < to,
            cell: patches.cell_of_triangle[triangle as usize],
            side: Side::Triangle { half_edge },
        });
        planes.push(scene.plane_through(triangle));
    }
    (fins, planes)
}

fn edge_ranges(fins: &[Fin]) -> Vec<Range<u32>> {
    let mut start = 0;
    let ranges = fins.chunk_by(|a, b| a.ends == b.ends).map(|group| {
        let range = start..start + group.len() as u32;
        start = range.end;
        range
    });
    ranges.collect()
}

/// Sorts the fins of one edge counter-clockwise about its direction, starting with the first.
fn sort_radially(points: &Points, planes: &[Plane], fins: &mut [Fin]) {
    if fins.len() < 3 {
        return;
    }
    let axis = direction_axis(points, fins[0].ends);
    let forward = points.compare(fins[0].ends[0], fins[0].ends[1], axis) == Ordering::Less;
    let turn = |a: &Fin, b: &Fin| {
        // n x n' runs along the edge; its sign there is that of the turn from one left half-plane to the other.
        let cross = planes[a.plane as usize].cross_sign(&planes[b.plane as usize], axis);
        if (a.left == b.left) == forward { cross } else { -cross }
    };
    let first = fins[0];
    let quadrant = |fin: &Fin| match turn(&first, fin) {
        0 if same_half_plane(planes, &first, fin) => 0,
        0 => 2,
        turn if turn > 0 => 1,
        _ => 3,
    };
    fins.sort_by(|a, b| quadrant(a).cmp(&quadrant(b)).then_with(|| turn(b, a).cmp(&0)));
}

/// Whether two fins with parallel planes lie on the same side of their edge.
fn same_half_plane(planes: &[Plane], a: &Fin, b: &Fin) -> bool {
    let (plane_a, plane_b) = (&planes[a.plane as usize], &planes[b.plane as usize]);
    let axis = plane_a.main_axis();
    let alike = plane_a.normal_sign(axis) == plane_b.normal_sign(axis);
    (a.left == b.left) == alike
}

/// An axis along which two points differ: the one along which they differ most, as far as doubles can tell.
fn direction_axis(points: &Points, ends: [PointId; 2]) -> usize {
    let [x, y, z] = (points.rounded(ends[0]) - points.rounded(ends[1])).abs().to_array();
    let longest = if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    };
    let differs = |&axis: &usize| points.compare(ends[0], ends[1], axis).is_ne();
    [longest, 0, 1, 2].into_iter().find(differs).unwrap_or(longest)
}

/// For the two sides of each cell (2 c in front, 2 c + 1 behind), the region it borders, and the number of regions.
fn join_regions(fins: &[Fin], edges: &[Range<u32>], cell_count: u32) -> (Vec<u32>, u32) {
    let mut sides = DisjointSets::new(2 * cell_count as usize);
    for range in edges {
        let group = &fins[range.start as usize..range.end as usize];
        for (i, fin) in group.iter().enumerate() {
            let next = &group[(i + 1) % group.len()];
            let after = 2 * fin.cell + u32::from(!fin.left);
            let before = 2 * next.cell + u32::from(next.left);
            sides.join(after, before);
        }
    }
    sides.numbered()
}

/// A cell as a way from the region in front of it to the one behind.
struct Link {
    front: u32,
    back: u32,
    cell: u32,
    /// What winds around the region behind and not around the one in front.
    gain: Vec<(u32, i32)>,
}

fn links(scene: &Scene<'_>, carriers: &Carriers, patches: &Patches, region_of_side: &[u32]) -> Vec<Link> {
    let link = |cell: u32, gain: Vec<(u32, i32)>| {
        let [front, back] = [2 * cell, 2 * cell + 1].map(|side| region_of_side[side as usize]);
        Link { front, back, cell, gain }
    };
    let of_patches = (0_u32..)
        .zip(&patches.first_triangle)
        .map(|(i, &t)| link(carriers.cell_count + i, vec![(scene.member_of(t), 1)]));
    let of_carriers = carriers.carriers.iter().flat_map(|carrier| {
        let covered = (0_u32..).zip(&carrier.overlay.coverage).filter(|(_, cover)| !cover.is_empty());
        covered.map(|(cell, cover)| link(carrier.first_cell + cell, cover.clone()))
    });
    of_patches.chain(of_carriers).collect()
}

/// Winding numbers of all regions: one ray for each connected set of them, then along the links.
fn propagate(
    scene: &Scene<'_>,
    carriers: &Carriers,
    patches: &Patches,
    links: &[Link],
    region_count: usize,
) -> Vec<Vec<(u32, i32)>> {
    let mut ways: Vec<(u32, u32)> = Vec::with_capacity(2 * links.len());
    for (index, link) in (0_u32..).zip(links) {
        ways.extend([(link.front, index), (link.back, index)]);
    }
    ways.sort_unstable();
    let ways_from = |region: u32| {
        let start = ways.partition_point(|&(from, _)| from < region);
        ways[start..]
            .iter()
            .take_while(move |&&(from, _)| from == region)
            .map(|&(_, link)| &links[link as usize])
    };
    let mut winding: Vec<Option<Vec<(u32, i32)>>> = vec![None; region_count];
    let mut caster = RayCaster::new(scene);
    let mut stack = Vec::new();
    for link in links {
        if winding[link.front as usize].is_some() {
            continue;
        }
        let (in_front, around) = caster.cast(&anchor(scene, carriers, patches, link.cell));
        let region = if in_front { link.front } else { link.back };
        winding[region as usize] = Some(around);
        stack.push(region);
        while let Some(region) = stack.pop() {
            for way in ways_from(region) {
                let (other, sign) = if way.front == region { (way.back, 1) } else { (way.front, -1) };
                if winding[other as usize].is_none() {
                    let here = winding[region as usize].as_ref().expect("regions on the stack are known");
                    winding[other as usize] = Some(after(here, &way.gain, sign));
                    stack.push(other);
                }
            }
        }
    }
    // What is left borders no covered cell.
    winding.into_iter().map(Option::unwrap_or_default).collect()
}

fn after(winding: &[(u32, i32)], gain: &[(u32, i32)], sign: i32) -> Vec<(u32, i32)> {
    let mut result = winding.to_vec();
    for &(operand, amount) in gain {
        match result.binary_search_by_key(&operand, |&(k, _)| k) {
            Ok(at) => result[at].1 += sign * amount,
            Err(at) => result.insert(at, (operand, sign * amount)),
        }
    }
    result.retain(|&(_, times)| times != 0);
    result
}

/// A triangle inside a cell.
fn anchor(scene: &Scene<'_>, carriers: &Carriers, patches: &Patches, cell: u32) -> Anchor {
    if let Some(patch) = cell.checked_sub(carriers.cell_count) {
        let triangle = patches.first_triangle[patch as usize];
        let corners = scene.corners[triangle as usize];
        return Anchor { corners, plane: scene.plane_through(triangle) };
    }
    let home = carriers.carriers.partition_point(|carrier| carrier.first_cell <= cell) - 1;
    let carrier = &carriers.carriers[home];
    let boundary = boundary_of(carrier, cell - carrier.first_cell);
    let triangles = triangulate(&carrier.chart, scene.points(), &carrier.lines, &boundary);
    Anchor { corners: triangles[0], plane: *carrier.chart.plane() }
}

/// The edges of a cell of a carrier, with the cell on their left.
fn boundary_of(carrier: &Carrier, cell: u32) -> Vec<Boundary> {
    let edges = carrier.overlay.edges.iter().filter(|edge| edge.below != edge.above);
    edges
        .filter_map(|edge| {
            let [left, right] = edge.ends;
            let ends = if edge.above == cell {
                [left, right]
            } else if edge.below == cell {
                [right, left]
            } else {
                return None;
            };
            Some(Boundary { ends, line: edge.line })
        })
        .collect()
}
