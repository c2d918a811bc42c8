//! Closed meshes to cut each other with. Only additions, products, quotients and square roots make their
//! coordinates, so that any language builds them bit for bit.

use ogee::boolean::{Op, Tree};
use ogee::math::{Vec2, Vec3};
use ogee::mesh::Mesh;
use std::collections::HashMap;

/// A map of space, row by row: `x' = m[0] x + m[1] y + m[2] z + m[3]`, added from left to right.
pub(crate) type Rows = [[f64; 4]; 3];

pub(crate) const IDENTITY: Rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// The box between two corners.
pub(crate) fn cuboid(min: Vec3, max: Vec3) -> Mesh {
    let base =
        [Vec2::new(min.x, min.y), Vec2::new(max.x, min.y), Vec2::new(max.x, max.y), Vec2::new(min.x, max.y)];
    extrusion(&base, &[[0, 1, 2], [0, 2, 3]], min.z, max.z)
}

/// The cube with the smallest corner at `(x, y, z)`.
pub(crate) fn cube(x: f64, y: f64, z: f64, size: f64) -> Mesh {
    cuboid(Vec3::new(x, y, z), Vec3::new(x + size, y + size, z + size))
}

/// The tetrahedron of four points, turned outward; points in one plane give a closed chain that bounds nothing.
pub(crate) fn tetrahedron(points: [Vec3; 4]) -> Mesh {
    let [a, b, c, d] = points;
    let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let mesh = Mesh::new(points.to_vec(), triangles);
    if (b - a).cross(c - a).dot(d - a) < 0.0 { mesh.flipped() } else { mesh }
}

/// A counter-clockwise simple polygon swept from height `low` to height `high`.
pub(crate) fn prism(polygon: &[Vec2], low: f64, high: f64) -> Mesh {
    extrusion(polygon, &ears(polygon), low, high)
}

/// As [`prism`], with caps fanned from the first vertex: where the polygon is concave they fold over themselves.
pub(crate) fn fanned_prism(polygon: &[Vec2], low: f64, high: f64) -> Mesh {
    extrusion(polygon, &fan(polygon.len()), low, high)
}

/// The pyramid over a counter-clockwise simple polygon at height `low`.
pub(crate) fn pyramid(polygon: &[Vec2], low: f64, apex: Vec3) -> Mesh {
    let n = polygon.len() as u32;
    let mut positions: Vec<Vec3> = polygon.iter().map(|p| p.extend(low)).collect();
    positions.push(apex);
    let mut triangles: Vec<[u32; 3]> = ears(polygon).into_iter().map(|[a, b, c]| [a, c, b]).collect();
    triangles.extend((0..n).map(|i| [i, (i + 1) % n, n]));
    let mesh = Mesh::new(positions, triangles);
    if apex.z < low { mesh.flipped() } else { mesh }
}

/// A ball of `8 n^2` triangles: the faces of an octahedron, divided and pushed out to the radius.
pub(crate) fn ball(n: u32, radius: f64, center: Vec3) -> Mesh {
    let n = i64::from(n);
    let mut mesh = Mesh::default();
    let mut index_of = HashMap::new();
    for octant in 0..8 {
        let signs = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1 } else { -1 });
        let mut vertex = |i: i64, j: i64| {
            let key = [signs[0] * i, signs[1] * j, signs[2] * (n - i - j)];
            *index_of.entry(key).or_insert_with(|| {
                let [x, y, z] = key.map(|k| k as f64);
                let length = (x * x + y * y + z * z).sqrt();
                mesh.positions.push(Vec3::new(
                    center.x + radius * (x / length),
                    center.y + radius * (y / length),
                    center.z + radius * (z / length),
                ));
                mesh.positions.len() as u32 - 1
            })
        };
        let mut faces = Vec::new();
        for i in 0..n {
            for j in 0..n - i {
                faces.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 2 <= n {
                    faces.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
        }
        let turned = signs.iter().product::<i64>() < 0;
        mesh.triangles.extend(faces.into_iter().map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }));
    }
    mesh
}

/// A convex polygon of `4 n` points on the circle: the border of a square, divided and pushed out to the radius.
pub(crate) fn circle(n: u32, radius: f64, center: Vec2) -> Vec<Vec2> {
    let n = i64::from(n);
    let corners = [[n, -n], [n, n], [-n, n], [-n, -n]];
    let mut points = Vec::new();
    for (side, [x, y]) in corners.into_iter().enumerate() {
        let [x1, y1] = corners[(side + 1) % 4];
        for step in 0..n {
            let (u, v) = ((x * n + (x1 - x) * step) as f64, (y * n + (y1 - y) * step) as f64);
            let length = (u * u + v * v).sqrt();
            points.push(Vec2::new(center.x + radius * (u / length), center.y + radius * (v / length)));
        }
    }
    points
}

/// An upright cylinder of `4 n` sides.
pub(crate) fn tube(n: u32, radius: f64, center: Vec2, low: f64, high: f64) -> Mesh {
    fanned_prism(&circle(n, radius, center), low, high)
}

/// The mesh moved by a map; turned over again if the map mirrors.
pub(crate) fn mapped(mesh: &Mesh, rows: &Rows) -> Mesh {
    let move_one = |p: &Vec3| {
        let [x, y, z] = rows.map(|m| m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3]);
        Vec3::new(x, y, z)
    };
    let moved = Mesh::new(mesh.positions.iter().map(move_one).collect(), mesh.triangles.clone());
    let column = |i: usize| Vec3::new(rows[0][i], rows[1][i], rows[2][i]);
    if column(0).cross(column(1)).dot(column(2)) < 0.0 { moved.flipped() } else { moved }
}

/// The mesh moved along a vector.
pub(crate) fn translated(mesh: &Mesh, by: Vec3) -> Mesh {
    let positions = mesh.positions.iter().map(|&p| p + by).collect();
    Mesh::new(positions, mesh.triangles.clone())
}

/// All meshes side by side in one.
pub(crate) fn together<'a>(meshes: impl IntoIterator<Item = &'a Mesh>) -> Mesh {
    let mut all = Mesh::default();
    meshes.into_iter().for_each(|mesh| all.append(mesh));
    all
}

/// The unit cube and the bars whose removal leaves the Menger sponge of this depth.
pub(crate) fn menger(depth: u32) -> (Tree, Vec<Mesh>) {
    let mut meshes = vec![cube(0.0, 0.0, 0.0, 3_f64.powi(depth as i32))];
    for level in 1..=depth {
        let size = 3_f64.powi((depth - level) as i32);
        let count = 3_u32.pow(level);
        for axis in 0..3 {
            for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
                if i % 3 == 1 && j % 3 == 1 && !removed_before(i / 3, j / 3) {
                    meshes.push(bar(
                        axis,
                        f64::from(i) * size,
                        f64::from(j) * size,
                        size,
                        3_f64.powi(depth as i32),
                    ));
                }
            }
        }
    }
    (difference(meshes.len()), meshes)
}

/// Whether a coarser bar along the same axis took this square away.
fn removed_before(i: u32, j: u32) -> bool {
    (i > 0 || j > 0) && (i % 3 == 1 && j % 3 == 1 || removed_before(i / 3, j / 3))
}

/// A square bar along an axis through a cube of this length, its ends flush with the cube's faces.
fn bar(axis: usize, u: f64, v: f64, size: f64, length: f64) -> Mesh {
    let mut min = [0.0; 3];
    let mut max = [length; 3];
    min[(axis + 1) % 3] = u;
    max[(axis + 1) % 3] = u + size;
    min[(axis + 2) % 3] = v;
    max[(axis + 2) % 3] = v + size;
    cuboid(Vec3::from_array(min), Vec3::from_array(max))
}

/// The first operand minus all others.
pub(crate) fn difference(count: usize) -> Tree {
    all_of(Op::Difference, count)
}

/// The union of all operands.
pub(crate) fn union(count: usize) -> Tree {
    all_of(Op::Union, count)
}

/// One operation on operands `0..count`.
pub(crate) fn all_of(op: Op, count: usize) -> Tree {
    Tree::Node(op, (0..count).map(Tree::Leaf).collect())
}

fn extrusion(polygon: &[Vec2], cap: &[[u32; 3]], low: f64, high: f64) -> Mesh {
    let n = polygon.len() as u32;
    let ring = |height: f64| polygon.iter().map(move |p| p.extend(height));
    let mut triangles: Vec<[u32; 3]> = cap.iter().map(|&[a, b, c]| [a, c, b]).collect();
    triangles.extend(cap.iter().map(|t| t.map(|v| v + n)));
    for i in 0..n {
        let j = (i + 1) % n;
        triangles.extend([[i, j, j + n], [i, j + n, i + n]]);
    }
    Mesh::new(ring(low).chain(ring(high)).collect(), triangles)
}

fn fan(count: usize) -> Vec<[u32; 3]> {
    (1..count as u32 - 1).map(|i| [0, i, i + 1]).collect()
}

/// Cuts ears off a counter-clockwise simple polygon. For small polygons on a small grid, where signs are exact.
fn ears(polygon: &[Vec2]) -> Vec<[u32; 3]> {
    let turn = |a: u32, b: u32, c: u32| {
        let [a, b, c] = [a, b, c].map(|v| polygon[v as usize]);
        (b - a).perp_dot(c - a)
    };
    let mut ring: Vec<u32> = (0..polygon.len() as u32).collect();
    let mut triangles = Vec::new();
    while ring.len() > 3 {
        let n = ring.len();
        let ear = (0..n).find(|&i| {
            let (a, b, c) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
            let inside = |&v: &u32| turn(a, b, v) >= 0.0 && turn(b, c, v) >= 0.0 && turn(c, a, v) >= 0.0;
            let corners = [a, b, c].map(|v| polygon[v as usize]);
            turn(a, b, c) > 0.0 && !ring.iter().any(|v| !corners.contains(&polygon[*v as usize]) && inside(v))
        });
        let i = ear.expect("a simple polygon has an ear");
        triangles.push([ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]);
        ring.remove(i);
    }
    triangles.push([ring[0], ring[1], ring[2]]);
    triangles
}
