//! Faces filled with triangles: a sweep that leaves no visible corner behind, then flips towards Delaunay.
//!
//! Sweep after Hertel and Mehlhorn (1983), flips after Lawson (1977). Orientations are exact; the choice between the two
//! diagonals of a convex quadrilateral is made in doubles and only where their error bound (Shewchuk 1997) allows, so
//! the flips end.

use super::sweep::{Planar, Visitor};
use super::{Chart, Line, PointId, Points};

/// A directed edge of a face's boundary, with the face on its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Boundary {
    /// From where to where.
    pub ends: [PointId; 2],
    /// Index of the line it lies on.
    pub line: u32,
}

/// Triangles that fill the area to the left of `boundary`, counter-clockwise about the chart's normal, with no vertices
/// but those of the boundary. Boundary edges must meet only at common ends and bound an area; an edge that comes in both
/// directions is a slit, with the area on both sides.
pub fn triangulate(
    chart: &Chart,
    points: &Points,
    lines: &[Line],
    boundary: &[Boundary],
) -> Vec<[PointId; 3]> {
    if let Some(triangle) = single_triangle(boundary) {
        return vec![triangle];
    }
    let mut directed: Vec<[PointId; 2]> = boundary.iter().map(|edge| edge.ends).collect();
    directed.sort_unstable();
    let mut planar = Planar::new(chart, points, &once_each(boundary));
    planar.sort(points, lines);
    let ends = planar.edges.iter().map(|e| [e.left, e.right].map(|v| planar.vertices[v as usize]));
    let inside_above = ends.map(|ends| directed.binary_search(&ends).is_ok());
    let mut filler = Filler {
        chart,
        points,
        vertices: &planar.vertices,
        inside_above: inside_above.collect(),
        chains: vec![None],
        triangles: Vec::with_capacity(boundary.len()),
    };
    planar.sweep(points, lines, 0, &mut filler);
    let mut triangles = filler.triangles;
    flip_towards_delaunay(chart, points, &planar, &directed, &mut triangles);
    let vertices = &planar.vertices;
    triangles.into_iter().map(|t| t.map(|v| vertices[v as usize])).collect()
}

/// A boundary of three edges that run around one triangle.
fn single_triangle(boundary: &[Boundary]) -> Option<[PointId; 3]> {
    let [first, second, third] = boundary else { return None };
    let [a, b] = first.ends;
    let other = if second.ends[0] == b { second } else { third };
    (other.ends[0] == b).then_some([a, b, other.ends[1]])
}

/// The edges of a boundary, one for both sides of a slit.
fn once_each(boundary: &[Boundary]) -> Vec<([PointId; 2], u32)> {
    let undirected = boundary
        .iter()
        .map(|edge| ([edge.ends[0].min(edge.ends[1]), edge.ends[0].max(edge.ends[1])], edge.line));
    let mut edges: Vec<([PointId; 2], u32)> = undirected.collect();
    edges.sort_unstable();
    edges.dedup_by_key(|&mut (ends, _)| ends);
    edges
}

/// Fills intervals inside the area. Each keeps the chain of vertices that bounds it on the left, from the left end of
/// the edge below to that of the edge above; no three in a row leave a triangle to be cut off to their right.
struct Filler<'a> {
    chart: &'a Chart,
    points: &'a Points,
    vertices: &'a [PointId],
    /// For each edge, whether the area is above it.
    inside_above: Vec<bool>,
    /// Chains of the intervals; none for those outside. The interval 0 is the one outside everything.
    chains: Vec<Option<Vec<u32>>>,
    triangles: Vec<[u32; 3]>,
}

impl Filler<'_> {
    /// Whether `a b c` turns right at `b`.
    fn turns_right(&self, a: u32, b: u32, c: u32) -> bool {
        let [a, b, c] = [a, b, c].map(|v| self.vertices[v as usize]);
        self.chart.orientation(self.points, a, b, c) < 0
    }

    /// Adds a vertex at the upper end of a chain and cuts off what it sees.
    fn push_above(&mut self, chain: &mut Vec<u32>, vertex: u32) {
        while let [.., x, y] = chain[..] {
            if !self.turns_right(x, y, vertex) {
                break;
            }
            self.triangles.push([x, vertex, y]);
            chain.pop();
        }
        chain.push(vertex);
    }

    /// Adds a vertex at the lower end of a chain and cuts off what it sees.
    fn push_below(&mut self, chain: &mut Vec<u32>, vertex: u32) {
        let mut seen = 0;
        while let [y, x, ..] = chain[seen..] {
            if !self.turns_right(vertex, y, x) {
                break;
            }
            self.triangles.push([vertex, x, y]);
            seen += 1;
        }
        chain.splice(..seen, [vertex]);
    }

    fn add(&mut self, chain: Option<Vec<u32>>) -> u32 {
        self.chains.push(chain);
        self.chains.len() as u32 - 1
    }
}

impl Visitor for Filler<'_> {
    fn open(&mut self, vertex: u32, below: u32) -> u32 {
        let chain = self.inside_above[below as usize].then(|| vec![vertex]);
        self.add(chain)
    }

    fn close(&mut self, interval: u32, vertex: u32) {
        if let Some(chain) = self.chains[interval as usize].take() {
            self.triangles.extend(chain.windows(2).map(|pair| [pair[0], vertex, pair[1]]));
        }
    }

    fn turn_above(&mut self, interval: u32, vertex: u32) {
        if let Some(mut chain) = self.chains[interval as usize].take() {
            self.push_above(&mut chain, vertex);
            self.chains[interval as usize] = Some(chain);
        }
    }

    fn turn_below(&mut self, interval: u32, vertex: u32) {
        if let Some(mut chain) = self.chains[interval as usize].take() {
            self.push_below(&mut chain, vertex);
            self.chains[interval as usize] = Some(chain);
        }
    }

    fn split(&mut self, interval: u32, vertex: u32) -> (u32, u32) {
        let Some(mut lower) = self.chains[interval as usize].take() else {
            return (interval, self.add(None));
        };
        // The rightmost vertex of the chain sees the new one; vertices are numbered from left to right.
        let rightmost = (0..lower.len()).max_by_key(|&i| lower[i]).unwrap_or_default();
        let mut upper = lower[rightmost..].to_vec();
        lower.truncate(rightmost + 1);
        self.push_above(&mut lower, vertex);
        self.push_below(&mut upper, vertex);
        self.chains[interval as usize] = Some(lower);
        (interval, self.add(Some(upper)))
    }

    fn merge(&mut self, lower: u32, upper: u32, vertex: u32) -> u32 {
        let (Some(mut below), Some(mut above)) =
            (self.chains[lower as usize].take(), self.chains[upper as usize].take())
        else {
            return lower;
        };
        self.push_above(&mut below, vertex);
        self.push_below(&mut above, vertex);
        below.extend_from_slice(&above[1..]);
        self.chains[lower as usize] = Some(below);
        lower
    }

    fn start(&mut self, _edge: u32, _below: u32, _above: u32) {}
}

/// Flips inner edges until none fails the circle test by more than the error of doubles.
fn flip_towards_delaunay(
    chart: &Chart,
    points: &Points,
    planar: &Planar,
    fixed: &[[PointId; 2]],
    triangles: &mut [[u32; 3]],
) {
    if triangles.len() < 2 {
        return;
    }
    let flat: Vec<[f64; 2]> = flat_coordinates(chart, points, &planar.vertices);
    let mut twins = twins_of(triangles);
    let is_fixed = |h: usize| {
        let ends =
            [triangles[h / 3][h % 3], triangles[h / 3][(h + 1) % 3]].map(|v| planar.vertices[v as usize]);
        fixed.binary_search(&ends).is_ok()
    };
    for slit in (0..twins.len()).filter(|&h| twins[h] != u32::MAX && is_fixed(h)).collect::<Vec<_>>() {
        twins[slit] = u32::MAX;
    }
    let is_inner = |h: &u32, twins: &[u32]| twins[*h as usize] != u32::MAX;
    let mut queue: Vec<u32> = (0..twins.len() as u32).filter(|h| is_inner(h, &twins)).collect();
    while let Some(h) = queue.pop() {
        let g = twins[h as usize];
        if g == u32::MAX {
            continue;
        }
        let [a, b, c, d] = quadrilateral(triangles, h, g);
        let turns_left = |i: u32, j: u32, k: u32| {
            let [i, j, k] = [i, j, k].map(|v| planar.vertices[v as usize]);
            chart.orientation(points, i, j, k) > 0
        };
        let at = |v: u32| flat[v as usize];
        if in_circle(at(a), at(b), at(c), at(d)) && turns_left(d, b, c) && turns_left(c, a, d) {
            flip(triangles, &mut twins, h, g);
            let (t, s) = (h / 3 * 3, g / 3 * 3);
            queue.extend([t, t + 1, t + 2, s, s + 1, s + 2].iter().filter(|h| is_inner(h, &twins)));
        }
    }
}

/// Coordinates in the plane relative to the first vertex.
fn flat_coordinates(chart: &Chart, points: &Points, vertices: &[PointId]) -> Vec<[f64; 2]> {
    let origin = points.rounded(vertices[0]);
    vertices.iter().map(|&v| chart.flatten(points.rounded(v) - origin)).collect()
}

/// For half-edge `3 t + i`, from corner `i` of triangle `t` to the next, the one that runs back, or `u32::MAX`.
fn twins_of(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut sides: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * triangles.len());
    for (t, triangle) in (0_u32..).zip(triangles) {
        for i in 0..3 {
            let (from, to) = (triangle[i], triangle[(i + 1) % 3]);
            sides.push((from.min(to), from.max(to), 3 * t + i as u32));
        }
    }
    sides.sort_unstable();
    let mut twins = vec![u32::MAX; sides.len()];
    for pair in sides.windows(2) {
        if (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1) {
            twins[pair[0].2 as usize] = pair[1].2;
            twins[pair[1].2 as usize] = pair[0].2;
        }
    }
    twins
}

/// The ends `a`, `b` of half-edge `h`, the corner `c` opposite to it and the corner `d` opposite to its twin `g`.
fn quadrilateral(triangles: &[[u32; 3]], h: u32, g: u32) -> [u32; 4] {
    let corner = |h: u32, ahead: u32| triangles[h as usize / 3][((h % 3 + ahead) % 3) as usize];
    [corner(h, 0), corner(h, 1), corner(h, 2), corner(g, 2)]
}

/// Turns the diagonal `a b` of the triangles `a b c` and `b a d` into `c d`.
fn flip(triangles: &mut [[u32; 3]], twins: &mut [u32], h: u32, g: u32) {
    let [a, b, c, d] = quadrilateral(triangles, h, g);
    let (t, s) = (h / 3, g / 3);
    let beside = |h: u32, ahead: u32| h / 3 * 3 + (h % 3 + ahead) % 3;
    let outer = [beside(h, 1), beside(h, 2), beside(g, 1), beside(g, 2)].map(|e| twins[e as usize]);
    let [bc, ca, ad, db] = outer;
    triangles[t as usize] = [c, d, b];
    triangles[s as usize] = [d, c, a];
    let mut join = |e: u32, other: u32| {
        twins[e as usize] = other;
        if other != u32::MAX {
            twins[other as usize] = e;
        }
    };
    join(3 * t, 3 * s);
    join(3 * t + 1, db);
    join(3 * t + 2, bc);
    join(3 * s + 1, ca);
    join(3 * s + 2, ad);
}

/// Whether `d` lies inside the circle through the counter-clockwise `a b c`, beyond the error of doubles.
fn in_circle(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    const BOUND: f64 = (10.0 + 96.0 * (f64::EPSILON / 2.0)) * (f64::EPSILON / 2.0);
    let [a, b, c] = [a, b, c].map(|p| [p[0] - d[0], p[1] - d[1]]);
    let lift = |p: [f64; 2]| p[0] * p[0] + p[1] * p[1];
    let minor = |p: [f64; 2], q: [f64; 2]| (p[0] * q[1], q[0] * p[1]);
    let mut determinant = 0.0;
    let mut permanent = 0.0;
    for (p, (left, right)) in [(a, minor(b, c)), (b, minor(c, a)), (c, minor(a, b))] {
        determinant += lift(p) * (left - right);
        permanent += lift(p) * (left.abs() + right.abs());
    }
    determinant > BOUND * permanent
}
