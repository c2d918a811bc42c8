//! Pairs of triangles that meet elsewhere than in common corners and sides.

use super::pairs::for_each_pair;
use ogee::math::{Aabb, Vec2, Vec3};
use ogee::mesh::Mesh;
use robust::{Coord, Coord3D};

/// How many pairs of triangles meet where they should not. Corners are common when their positions are equal, so
/// that parts which touch in whole sides and corners are no offence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Crossings {
    /// A side of one passes strictly through the inside of the other, or both lie on each other.
    pub(crate) crossing: usize,
    /// A corner of one is within the other, or sides meet. They may only touch, as a roof that stands on its ridge
    /// does; the signs of two triangles alone do not tell.
    pub(crate) touching: usize,
    /// Triangles without area; they are left out of the rest.
    pub(crate) flat: usize,
}

/// Finds all of them, by exact signs.
pub(crate) fn crossings(mesh: &Mesh) -> Crossings {
    let corners: Vec<[Vec3; 3]> = (0..mesh.triangles.len()).map(|i| mesh.corners(i)).collect();
    let (solid, flat): (Vec<_>, Vec<_>) = corners.into_iter().partition(|t| widest_axis(t).is_some());
    let boxes: Vec<Aabb> = solid.iter().map(|t| Aabb::of(*t)).collect();
    let mut found = Crossings { flat: flat.len(), ..Crossings::default() };
    for_each_pair(&boxes, &mut |a, b| match meeting(&solid[a], &solid[b]) {
        Meeting::Fair => {}
        Meeting::Touching => found.touching += 1,
        Meeting::Crossing => found.crossing += 1,
    });
    found
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Meeting {
    Fair,
    Touching,
    Crossing,
}

type Corners = [Vec3; 3];

fn meeting(a: &Corners, b: &Corners) -> Meeting {
    let shared: Vec<Vec3> = a.iter().copied().filter(|p| b.contains(p)).collect();
    match shared.len() {
        3 => Meeting::Crossing,
        2 => {
            if lie_on_each_other(a, b, &shared) {
                Meeting::Crossing
            } else {
                Meeting::Fair
            }
        }
        _ if pierces(a, b) || pierces(b, a) => Meeting::Crossing,
        _ if meets(a, b, &shared) || meets(b, a, &shared) => Meeting::Touching,
        _ => Meeting::Fair,
    }
}

/// Whether two triangles with a common side are in one plane and on one side of it.
fn lie_on_each_other(a: &Corners, b: &Corners, shared: &[Vec3]) -> bool {
    let apex = |t: &Corners| t.iter().copied().find(|p| !shared.contains(p));
    let (Some(p), Some(q)) = (apex(a), apex(b)) else { return true };
    if side(a, q) != 0 {
        return false;
    }
    let axis = widest_axis(a).expect("triangles without area were left out");
    let [u, v, p, q] = [shared[0], shared[1], p, q].map(|p| flattened(p, axis));
    turn(u, v, p) == turn(u, v, q)
}

/// Whether a side of `a` passes strictly through the inside of `b`.
fn pierces(a: &Corners, b: &Corners) -> bool {
    let sides = a.map(|p| side(b, p));
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        sides[i] * sides[j] < 0 && passes(a[i], a[j], b).is_some_and(|sum| sum.abs() == 3)
    })
}

/// Whether a side of `a` without shared corners meets `b`, border included.
fn meets(a: &Corners, b: &Corners, shared: &[Vec3]) -> bool {
    let sides = a.map(|p| side(b, p));
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        if shared.contains(&a[i]) || shared.contains(&a[j]) || sides[i] * sides[j] > 0 {
            false
        } else if sides[i] == 0 && sides[j] == 0 {
            meets_in_plane(a[i], a[j], b)
        } else {
            passes(a[i], a[j], b).is_some()
        }
    })
}

/// How the line from `p` to `q`, which is not in the plane of `b`, passes it: the sum of the three signs; `None` when
/// it passes outside.
fn passes(p: Vec3, q: Vec3, b: &Corners) -> Option<i32> {
    let signs = [0, 1, 2].map(|i| side(&[p, q, b[i]], b[(i + 1) % 3]));
    (!signs.contains(&1) || !signs.contains(&-1)).then(|| signs.iter().sum())
}

fn meets_in_plane(p: Vec3, q: Vec3, b: &Corners) -> bool {
    let axis = widest_axis(b).expect("triangles without area were left out");
    let (p, q) = (flattened(p, axis), flattened(q, axis));
    let b = b.map(|corner| flattened(corner, axis));
    let holds = |p: Vec2| {
        let signs = [0, 1, 2].map(|i| turn(b[i], b[(i + 1) % 3], p));
        !signs.contains(&1) || !signs.contains(&-1)
    };
    holds(p) || holds(q) || (0..3).any(|i| segments_meet(p, q, b[i], b[(i + 1) % 3]))
}

/// Whether closed segments meet; where they are on one line, their ends are left to [`meets_in_plane`]'s other test
/// and to the same test with the roles changed.
fn segments_meet(p: Vec2, q: Vec2, r: Vec2, s: Vec2) -> bool {
    let (a, b) = (turn(p, q, r) * turn(p, q, s), turn(r, s, p) * turn(r, s, q));
    a <= 0 && b <= 0 && (a < 0 || b < 0)
}

/// Positive where `p` is on the side that sees the corners clockwise.
fn side(t: &Corners, p: Vec3) -> i32 {
    let [a, b, c, p] = [t[0], t[1], t[2], p].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    sign(robust::orient3d(a, b, c, p))
}

fn turn(a: Vec2, b: Vec2, c: Vec2) -> i32 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    sign(robust::orient2d(a, b, c))
}

fn sign(x: f64) -> i32 {
    i32::from(x > 0.0) - i32::from(x < 0.0)
}

/// An axis along which the triangle still has area when seen, or none for a triangle without area.
fn widest_axis(t: &Corners) -> Option<usize> {
    (0..3).find(|&axis| {
        let [a, b, c] = t.map(|p| flattened(p, axis));
        turn(a, b, c) != 0
    })
}

fn flattened(p: Vec3, axis: usize) -> Vec2 {
    Vec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3])
}
