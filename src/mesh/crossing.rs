//! Triangles that pass through each other.

use super::Mesh;
use crate::math::{Aabb, Vec2, Vec3};
use crate::numeric::{orient2d, orient3d};
use crate::spatial::{Bvh, Grid};

/// Pairs of triangles that pass through each other, at least one of each pair among `suspects` (in increasing order):
/// a side of one passes strictly through the inside of the other, or both lie in one plane and overlap. Corners at one
/// place are common corners, whatever their indices; triangles that only touch are no offence, and neither are those
/// without area.
///
/// Exact for coordinates between 1e-100 and 1e100 and zero, and as far as numbers reach beyond that.
///
/// Costs about what it costs to find the triangles near the suspects.
pub fn crossing_pairs(mesh: &Mesh, suspects: &[u32]) -> Vec<[u32; 2]> {
    if suspects.is_empty() {
        return Vec::new();
    }
    let bounds = |t: u32| Aabb::around(mesh.corners(t as usize));
    let own: Vec<Aabb> = suspects.iter().map(|&t| bounds(t)).collect();
    let own_bvh = Bvh::new(&own);
    let window = own.iter().fold(Aabb::EMPTY, |all, &one| all.union(one));
    let mut found = Vec::new();
    let mut examine = |t: u32, s: u32| {
        if cross(&mesh.corners(t as usize), &mesh.corners(s as usize)) {
            found.push([t.min(s), t.max(s)]);
        }
    };
    own_bvh.self_pairs(&own, |i, j| examine(suspects[i as usize], suspects[j as usize]));
    let places = Places::of(&own, window);
    let mut next_suspects = suspects.iter().peekable();
    for t in 0..mesh.triangles.len() as u32 {
        let is_suspect = next_suspects.next_if_eq(&&t).is_some();
        let bounds = bounds(t);
        if !is_suspect && bounds.touches(window) && places.as_ref().is_none_or(|places| places.reach(bounds))
        {
            own_bvh.touching(&own, bounds, |i| examine(suspects[i as usize], t));
        }
    }
    found.sort_unstable();
    found
}

/// Cells of a coarse grid that some boxes reach: most triangles of a large mesh are told apart from them so.
struct Places {
    grid: Grid,
    reached: Vec<bool>,
}

impl Places {
    /// `None` where there are few boxes, or large ones among them.
    fn of(boxes: &[Aabb], window: Aabb) -> Option<Places> {
        const FEW: usize = 64;
        const CELLS_A_BOX: usize = 4;
        const LARGE: usize = 64;
        if boxes.len() < FEW {
            return None;
        }
        let grid = Grid::new(window, CELLS_A_BOX * boxes.len());
        let mut reached = vec![false; grid.len()];
        for &one in boxes {
            let span = grid.span(one);
            if span.len() > LARGE {
                return None;
            }
            grid.any_cell(span, |cell| {
                reached[cell] = true;
                false
            });
        }
        Some(Places { grid, reached })
    }

    /// Whether any of the boxes may touch this one.
    fn reach(&self, bounds: Aabb) -> bool {
        let span = self.grid.span(bounds);
        self.grid.any_cell(span, |cell| self.reached[cell])
    }
}

type Corners = [Vec3; 3];

/// Whether two triangles pass through each other.
fn cross(a: &Corners, b: &Corners) -> bool {
    let (mut shared_a, mut shared_b) = ([false; 3], [false; 3]);
    for i in 0..3 {
        for j in 0..3 {
            if a[i] == b[j] {
                (shared_a[i], shared_b[j]) = (true, true);
            }
        }
    }
    let (normal_a, normal_b) = (normal(a), normal(b));
    match shared_a.iter().filter(|&&shared| shared).count() {
        3 => has_area(a),
        2 => lie_on_each_other(a, b, [normal_a, normal_b], shared_a, shared_b),
        _ => {
            !is_beside_plane(a, normal_a, b, shared_b)
                && !is_beside_plane(b, normal_b, a, shared_a)
                && !are_apart_seen_along(widest(normal_a), a, b, shared_a, shared_b)
                && cross_in_space(a, b, shared_a, shared_b)
        }
    }
}

/// Whether two triangles with a common side lie in one plane and on one side of it.
fn lie_on_each_other(
    a: &Corners,
    b: &Corners,
    [normal_a, normal_b]: [Vec3; 2],
    shared_a: [bool; 3],
    shared_b: [bool; 3],
) -> bool {
    let apex = |shared: [bool; 3]| shared.iter().position(|&shared| !shared);
    // A triangle with two corners at one place has no area.
    let (Some(i), Some(j)) = (apex(shared_a), apex(shared_b)) else { return false };
    // Run through opposite ways the side belongs to neighbours, which would have to be folded over to lie on each other.
    let opposite = a[(i + 1) % 3] == b[(j + 2) % 3];
    let cosine = normal_a.dot(normal_b) * if opposite { 1.0 } else { -1.0 };
    if cosine > 1e-6 * normal_a.length() * normal_b.length() || orient3d(a[0], a[1], a[2], b[j]) != 0.0 {
        return false;
    }
    let axis = widest(normal_a);
    let [u, v, p, q] = [a[(i + 1) % 3], a[(i + 2) % 3], a[i], b[j]].map(|p| seen_along(axis, p));
    let (p, q) = (orient2d(u, v, p), orient2d(u, v, q));
    p * q > 0.0
}

/// Whether the corners of `b` that are not common lie on one side of the plane of `a`, as far as doubles can tell.
fn is_beside_plane(a: &Corners, normal: Vec3, b: &Corners, shared_b: [bool; 3]) -> bool {
    // The determinant is that of `orient3d`, whose error Shewchuk (1997) bounds by (7 + 56 u) u times the sum of the
    // magnitudes of its products, u = 2^-53.
    const FILTER: f64 = 8.0 * (f64::EPSILON / 2.0);
    let (u, v) = ((a[1] - a[0]).abs(), (a[2] - a[0]).abs());
    let magnitude = Vec3::new(u.y * v.z + u.z * v.y, u.z * v.x + u.x * v.z, u.x * v.y + u.y * v.x);
    let (mut above, mut below) = (true, true);
    for i in 0..3 {
        let w = b[i] - a[0];
        let (value, bound) = (normal.dot(w), FILTER * magnitude.dot(w.abs()));
        above &= shared_b[i] || value > bound;
        below &= shared_b[i] || value < -bound;
    }
    above != below
}

/// A quick sign that two triangles with at most one common corner have nothing else in common: seen along an axis, a
/// line along a side of one parts them.
fn are_apart_seen_along(
    axis: usize,
    a: &Corners,
    b: &Corners,
    shared_a: [bool; 3],
    shared_b: [bool; 3],
) -> bool {
    let (a, b) = (a.map(|p| seen_along(axis, p)), b.map(|p| seen_along(axis, p)));
    let parts = |a: &[Vec2; 3], shared_a: [bool; 3], b: &[Vec2; 3], shared_b: [bool; 3]| {
        (0..3).any(|i| {
            let [from, to, apex] = [0, 1, 2].map(|k| (i + k) % 3);
            let inside = orient2d(a[from], a[to], a[apex]);
            // A common corner is on the line when it is an end of the side, and else inside.
            inside != 0.0
                && !shared_a[apex]
                && (0..3).filter(|&j| !shared_b[j]).all(|j| inside * orient2d(a[from], a[to], b[j]) < 0.0)
        })
    };
    parts(&a, shared_a, &b, shared_b) || parts(&b, shared_b, &a, shared_a)
}

/// Whether triangles with at most one common corner pass through each other.
fn cross_in_space(a: &Corners, b: &Corners, shared_a: [bool; 3], shared_b: [bool; 3]) -> bool {
    let sides = |of: &Corners, p: &Corners, shared: [bool; 3]| {
        [0, 1, 2].map(|i| if shared[i] { 0 } else { sign(orient3d(of[0], of[1], of[2], p[i])) })
    };
    let sides_b = sides(a, b, shared_b);
    if sides_b.iter().zip(shared_b).all(|(&side, shared)| side == 0 || shared) {
        return overlap_in_plane(a, b);
    }
    pierces(b, sides_b, a) || pierces(a, sides(b, a, shared_a), b)
}

/// Whether a side of `a`, whose corners are on known sides of the plane of `b`, passes strictly through the inside of `b`.
fn pierces(a: &Corners, sides: [i32; 3], b: &Corners) -> bool {
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        sides[i] * sides[j] < 0 && {
            let turns = [0, 1, 2].map(|k| sign(orient3d(a[i], a[j], b[k], b[(k + 1) % 3])));
            turns == [1; 3] || turns == [-1; 3]
        }
    })
}

/// Whether triangles in one plane have an area in common.
fn overlap_in_plane(a: &Corners, b: &Corners) -> bool {
    let Some(axis) = (0..3).find(|&axis| area_seen_along(axis, a) != 0.0) else { return false };
    if area_seen_along(axis, b) == 0.0 {
        return false;
    }
    let (a, b) = (a.map(|p| seen_along(axis, p)), b.map(|p| seen_along(axis, p)));
    // Convex shapes have no area in common exactly when a side of one parts them.
    let parts = |a: &[Vec2; 3], b: &[Vec2; 3]| {
        (0..3).any(|i| {
            let inside = orient2d(a[i], a[(i + 1) % 3], a[(i + 2) % 3]);
            b.iter().all(|&p| inside * orient2d(a[i], a[(i + 1) % 3], p) <= 0.0)
        })
    };
    !parts(&a, &b) && !parts(&b, &a)
}

/// Whether a triangle has an area.
fn has_area(t: &Corners) -> bool {
    (0..3).any(|axis| area_seen_along(axis, t) != 0.0)
}

fn area_seen_along(axis: usize, t: &Corners) -> f64 {
    let [a, b, c] = t.map(|p| seen_along(axis, p));
    orient2d(a, b, c)
}

fn normal([a, b, c]: &Corners) -> Vec3 {
    (*b - *a).cross(*c - *a)
}

fn widest(normal: Vec3) -> usize {
    let [x, y, z] = normal.abs().to_array();
    if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    }
}

fn seen_along(axis: usize, p: Vec3) -> Vec2 {
    Vec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3])
}

fn sign(x: f64) -> i32 {
    i32::from(x > 0.0) - i32::from(x < 0.0)
}
