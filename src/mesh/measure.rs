//! Size, mass properties and topology of meshes.
//!
//! Sums over triangles are taken in [`DoubleDouble`] from the middle of the bounding box, with coordinates scaled by a
//! power of two, so the results depend neither on where the mesh is nor on its units. Moments follow B. Mirtich,
//! *Fast and accurate computation of polyhedral mass properties* (1996), in the form by signed tetrahedra.

use super::defects::fans;
use super::topology::sorted_half_edges;
use super::{Mesh, Solid, Topology};
use crate::math::{Aabb, Mat3, Vec3, power_of_two_below};
use crate::numeric::compensated::DoubleDouble;
use crate::par;

/// Triangles that are added up in one go; sums of such blocks are added in order.
const BLOCK: usize = 4096;

/// What can be measured on a mesh.
///
/// Triangles with an index out of range or a repeated corner are left out, as in [`Defects`](super::Defects). Numbers
/// that do not fit an `f64` are infinite or zero; with a corner that is not finite, lengths, areas and volumes are NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct Measures {
    /// Number of triangles.
    pub triangles: usize,
    /// Number of vertices that triangles use.
    pub vertices: usize,
    /// The smallest box around the triangles.
    pub bounds: Aabb,
    /// Area of all triangles. The relative error is at most 2⁻⁵⁰, but for triangles whose height is below 2⁻⁵⁰ of
    /// their second longest side.
    pub area: f64,
    /// Volume enclosed, in cubic model units; see [`volume`].
    pub volume: f64,
    /// Centre of the volume; none where the volume is zero or the surface is open.
    pub centroid: Option<Vec3>,
    /// Inertia tensor about the centroid for density one, in model units to the fifth; none where there is no
    /// centroid.
    pub inertia: Option<Mat3>,
    /// Whether the surface is a closed chain, so that volume, centroid and inertia mean something.
    pub closed: bool,
    /// Number of parts that do not share a vertex. A cavity is a part of its own.
    pub components: usize,
    /// Euler number: vertices - edges + triangles.
    pub euler: i64,
    /// Number of handles, over all components; none unless every edge has one triangle running along it each way
    /// and the triangles of every vertex are one fan.
    pub genus: Option<u64>,
}

impl Measures {
    /// Measures `mesh`.
    pub fn of(mesh: &Mesh) -> Measures {
        let triangles = sound_triangles(mesh);
        let topology = Counts::of(&triangles, mesh.positions.len());
        let frame = Frame::around(&mesh.positions, &triangles);
        let moments = frame.moments(&mesh.positions, &triangles);
        let (centroid, inertia) = match frame.centroid_and_inertia(&moments) {
            Some((centroid, inertia)) if topology.closed => (Some(centroid), Some(inertia)),
            _ => (None, None),
        };
        Measures {
            triangles: triangles.len(),
            vertices: topology.vertices,
            bounds: frame.bounds,
            area: frame.area(&mesh.positions, &triangles),
            volume: frame.volume(moments.one),
            centroid,
            inertia,
            closed: topology.closed,
            components: topology.components,
            euler: topology.euler(),
            genus: topology.genus(),
        }
    }

    /// Measures each connected component by itself, in the order of their first triangles.
    pub fn of_components(mesh: &Mesh) -> Vec<Measures> {
        components(mesh).iter().map(Measures::of).collect()
    }
}

impl Solid {
    /// Volume; see [`volume`].
    pub fn volume(&self) -> f64 {
        volume(self.mesh())
    }

    /// Area of the surface; see [`Measures::area`].
    pub fn area(&self) -> f64 {
        area(self.mesh())
    }

    /// The smallest box around the solid.
    pub fn bounds(&self) -> Aabb {
        self.mesh().bounds()
    }

    /// Everything that can be measured.
    pub fn measures(&self) -> Measures {
        Measures::of(self.mesh())
    }
}

/// The volume that a closed mesh encloses, each point counted as often as the surface winds around it; negative when
/// the mesh is inside out. For an open mesh it is the volume under a cone of no meaning.
///
/// Against what the given coordinates enclose exactly, the error is at most `2⁻⁵³ |volume| + n 2⁻⁹⁸ d s²` for `n`
/// triangles in a box of diagonal `d`, where `s²` is the largest product of the two shorter sides of a triangle.
pub fn volume(mesh: &Mesh) -> f64 {
    let triangles = sound_triangles(mesh);
    let frame = Frame::around(&mesh.positions, &triangles);
    let [six_volumes] = frame.sum(&mesh.positions, &triangles, |corners| [determinant(&corners)]);
    frame.volume(six_volumes / 6.0.into())
}

/// The area of all triangles; see [`Measures::area`].
pub fn area(mesh: &Mesh) -> f64 {
    let triangles = sound_triangles(mesh);
    Frame::around(&mesh.positions, &triangles).area(&mesh.positions, &triangles)
}

/// The parts of a mesh that do not share a vertex, in the order of their first triangles. Positions keep their order;
/// those that no part uses are dropped.
pub fn components(mesh: &Mesh) -> Vec<Mesh> {
    let triangles = sound_triangles(mesh);
    let labels = Labels::of(&triangles, mesh.positions.len());
    let mut parts = vec![Mesh::default(); labels.count];
    let mut place = vec![u32::MAX; mesh.positions.len()];
    for (vertex, &label) in labels.of_vertex.iter().enumerate() {
        if label != Labels::UNUSED {
            let part = &mut parts[label as usize];
            place[vertex] = part.positions.len() as u32;
            part.positions.push(mesh.positions[vertex]);
        }
    }
    for triangle in triangles {
        let part = labels.of_vertex[triangle[0] as usize] as usize;
        parts[part].triangles.push(triangle.map(|v| place[v as usize]));
    }
    parts
}

/// The triangles that can be measured.
fn sound_triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
    let count = mesh.positions.len();
    let in_range = |t: &[u32; 3]| t.iter().all(|&v| (v as usize) < count);
    let three = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    mesh.triangles.iter().copied().filter(|t| in_range(t) && three(t)).collect()
}

/// A point in [`DoubleDouble`].
type Point = [DoubleDouble; 3];

/// The integrals of 1, the coordinates and their products over a volume, in the coordinates of a frame.
struct Moments {
    one: DoubleDouble,
    /// x, y, z.
    first: [DoubleDouble; 3],
    /// xx, yy, zz, xy, yz, zx.
    second: [DoubleDouble; 6],
}

/// Coordinates in which sums are taken: model = `unit` * (frame + `origin`).
struct Frame {
    bounds: Aabb,
    finite: bool,
    /// A power of two near the largest coordinate.
    unit: f64,
    /// The middle of the box, in units of `unit`.
    origin: Vec3,
}

impl Frame {
    fn around(positions: &[Vec3], triangles: &[[u32; 3]]) -> Frame {
        let corners = || triangles.iter().flatten().map(|&v| positions[v as usize]);
        let bounds = Aabb::of(corners());
        let finite = corners().all(Vec3::is_finite);
        let largest =
            if bounds.is_empty() { 0.0 } else { bounds.min.abs().max(bounds.max.abs()).max_element() };
        // Not below 2⁻¹⁰⁰⁰, so that its inverse is a number too.
        let unit = power_of_two_below(largest).max(f64::from_bits(23 << 52));
        let origin =
            if bounds.is_empty() { Vec3::ZERO } else { (bounds.min / unit + bounds.max / unit) * 0.5 };
        Frame { bounds, finite, unit, origin }
    }

    /// The point in the frame's coordinates, without error.
    fn place(&self, p: Vec3) -> Point {
        let (p, o) = (p / self.unit, self.origin);
        [
            DoubleDouble::difference(p.x, o.x),
            DoubleDouble::difference(p.y, o.y),
            DoubleDouble::difference(p.z, o.z),
        ]
    }

    /// The sums over all triangles of what `terms` gives for their corners.
    fn sum<const N: usize>(
        &self,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        terms: impl Fn([Point; 3]) -> [DoubleDouble; N] + Sync + Send,
    ) -> [DoubleDouble; N] {
        let add =
            |sums: [DoubleDouble; N], more: [DoubleDouble; N]| std::array::from_fn(|i| sums[i] + more[i]);
        let corners =
            |&t: &[u32; 3]| from_widest_corner(t, positions).map(|v| self.place(positions[v as usize]));
        let block =
            |block: &&[[u32; 3]]| block.iter().map(|t| terms(corners(t))).fold([DoubleDouble::ZERO; N], add);
        let blocks: Vec<&[[u32; 3]]> = triangles.chunks(BLOCK).collect();
        par::map_above(2, &blocks, block).into_iter().fold([DoubleDouble::ZERO; N], add)
    }

    fn moments(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> Moments {
        let sums = self.sum(positions, triangles, |corners| {
            let det = determinant(&corners);
            let [a, b, c] = corners;
            let total: Point = std::array::from_fn(|i| a[i] + b[i] + c[i]);
            let square =
                |i: usize, j: usize| det * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + total[i] * total[j]);
            let [x, y, z] = total.map(|t| det * t);
            [det, x, y, z, square(0, 0), square(1, 1), square(2, 2), square(0, 1), square(1, 2), square(2, 0)]
        });
        Moments {
            one: sums[0] / 6.0.into(),
            first: [1, 2, 3].map(|i| sums[i] / 24.0.into()),
            second: [4, 5, 6, 7, 8, 9].map(|i| sums[i] / 120.0.into()),
        }
    }

    fn area(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
        if !self.finite {
            return f64::NAN;
        }
        let [twice] = self.sum(positions, triangles, |[a, b, c]| {
            let normal = twice_area_vector(&a, &b, &c);
            [length(Vec3::from(normal.map(DoubleDouble::to_f64))).into()]
        });
        0.5 * twice.to_f64() * self.unit * self.unit
    }

    fn volume(&self, volume: DoubleDouble) -> f64 {
        if self.finite { volume.to_f64() * self.unit * self.unit * self.unit } else { f64::NAN }
    }

    fn centroid_and_inertia(&self, moments: &Moments) -> Option<(Vec3, Mat3)> {
        if !self.finite || moments.one.to_f64() == 0.0 {
            return None;
        }
        let center = moments.first.map(|m| m / moments.one);
        let origin = self.origin.to_array().map(DoubleDouble::from);
        let placed: [f64; 3] = std::array::from_fn(|i| (center[i] + origin[i]).to_f64());
        let about = |k: usize, i: usize, j: usize| moments.second[k] - moments.first[i] * center[j];
        let [xx, yy, zz] = [about(0, 0, 0), about(1, 1, 1), about(2, 2, 2)];
        let [xy, yz, zx] = [about(3, 0, 1), about(4, 1, 2), about(5, 2, 0)];
        let u = self.unit;
        let scaled = |x: DoubleDouble| x.to_f64() * u * u * u * u * u;
        let [dx, dy, dz] = [scaled(yy + zz), scaled(zz + xx), scaled(xx + yy)];
        let [xy, yz, zx] = [-scaled(xy), -scaled(yz), -scaled(zx)];
        let inertia = Mat3::from_cols_array(&[dx, xy, zx, xy, dy, yz, zx, yz, dz]);
        Some((Vec3::from(placed) * u, inertia))
    }
}

/// Length of a vector whose squares may underflow.
fn length(v: Vec3) -> f64 {
    let largest = v.abs().max_element();
    if largest == 0.0 { 0.0 } else { (v / largest).length() * largest }
}

/// Six times the signed volume of the tetrahedron between the origin and a triangle.
fn determinant([a, b, c]: &[Point; 3]) -> DoubleDouble {
    let normal = twice_area_vector(a, b, c);
    a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2]
}

/// The normal of a triangle, as long as twice its area.
fn twice_area_vector(a: &Point, b: &Point, c: &Point) -> Point {
    let (e, f): (Point, Point) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
    [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]]
}

/// The same triangle, starting at the corner opposite its longest side: the product of the other two is what the
/// error of its normal grows with.
fn from_widest_corner(triangle: [u32; 3], positions: &[Vec3]) -> [u32; 3] {
    let [a, b, c] = triangle;
    let side = |from: u32, to: u32| (positions[to as usize] - positions[from as usize]).abs().max_element();
    let (bc, ca, ab) = (side(b, c), side(c, a), side(a, b));
    if bc >= ca && bc >= ab {
        [a, b, c]
    } else if ca >= ab {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// The connected component of each vertex, numbered in the order of their first triangles.
struct Labels {
    of_vertex: Vec<u32>,
    count: usize,
}

impl Labels {
    /// The label of a vertex that no triangle uses.
    const UNUSED: u32 = u32::MAX;

    fn of(triangles: &[[u32; 3]], vertices: usize) -> Labels {
        let mut parent: Vec<u32> = (0..vertices as u32).collect();
        for &[a, b, c] in triangles {
            let (root, other) = (find(&mut parent, a), find(&mut parent, b));
            parent[other as usize] = root;
            let other = find(&mut parent, c);
            parent[other as usize] = root;
        }
        let mut of_root = vec![Self::UNUSED; vertices];
        let mut of_vertex = vec![Self::UNUSED; vertices];
        let mut count = 0;
        for &vertex in triangles.iter().flatten() {
            let label = &mut of_root[find(&mut parent, vertex) as usize];
            if *label == Self::UNUSED {
                *label = count;
                count += 1;
            }
            of_vertex[vertex as usize] = *label;
        }
        Labels { of_vertex, count: count as usize }
    }
}

/// The root of a union-find tree, halving the path on the way.
fn find(parent: &mut [u32], mut vertex: u32) -> u32 {
    while parent[vertex as usize] != vertex {
        let up = parent[parent[vertex as usize] as usize];
        parent[vertex as usize] = up;
        vertex = up;
    }
    vertex
}

/// What the Euler number is made of.
struct Counts {
    vertices: usize,
    edges: usize,
    triangles: usize,
    components: usize,
    closed: bool,
    manifold: bool,
}

impl Counts {
    fn of(triangles: &[[u32; 3]], positions: usize) -> Counts {
        let labels = Labels::of(triangles, positions);
        let vertices = labels.of_vertex.iter().filter(|&&label| label != Labels::UNUSED).count();
        let (mut edges, mut closed, mut paired) = (0, true, true);
        for group in sorted_half_edges(triangles).chunk_by(|a, b| a.edge() == b.edge()) {
            edges += 1;
            closed &= 2 * group.iter().filter(|h| h.reversed).count() == group.len();
            paired &= group.len() == 2;
        }
        let manifold = closed && paired && fans(Topology::new(triangles).twins()).1 as usize == vertices;
        Counts { vertices, edges, triangles: triangles.len(), components: labels.count, closed, manifold }
    }

    fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.triangles as i64
    }

    /// Every component has Euler number 2 - 2 genus.
    fn genus(&self) -> Option<u64> {
        self.manifold.then(|| (self.components as i64 - self.euler() / 2) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Affine3, Quat, sin_cos};
    use crate::mesh::cuboid;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use num_traits::{Signed, ToPrimitive, Zero};
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};

    /// Volume, centroid and inertia (xx, yy, zz, xy, yz, zx) by rational arithmetic, from the origin.
    fn exact_mass(mesh: &Mesh) -> (BigRational, [BigRational; 3], [BigRational; 6]) {
        let number = |i: i64| BigRational::from_integer(i.into());
        let (mut one, mut first, mut second) = (
            BigRational::zero(),
            [(); 3].map(|()| BigRational::zero()),
            [(); 6].map(|()| BigRational::zero()),
        );
        for t in 0..mesh.triangles.len() {
            let [a, b, c] =
                mesh.corners(t).map(|p| p.to_array().map(|x| BigRational::from_float(x).expect("finite")));
            let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
            let det = &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1);
            let total: Vec<BigRational> = (0..3).map(|i| &a[i] + &b[i] + &c[i]).collect();
            one += &det / number(6);
            for i in 0..3 {
                first[i] += &det * &total[i] / number(24);
            }
            for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
                let square = &a[i] * &a[j] + &b[i] * &b[j] + &c[i] * &c[j] + &total[i] * &total[j];
                second[k] += &det * square / number(120);
            }
        }
        let centroid = first.clone().map(|m| m / &one);
        let about = |k: usize, i: usize, j: usize| &second[k] - &first[i] * &centroid[j];
        let [xx, yy, zz] = [about(0, 0, 0), about(1, 1, 1), about(2, 2, 2)];
        let products = [about(3, 0, 1), about(4, 1, 2), about(5, 2, 0)].map(|x| -x);
        let [xy, yz, zx] = products;
        let inertia = [&yy + &zz, &zz + &xx, &xx + &yy, xy, yz, zx];
        (one, centroid, inertia)
    }

    /// The area with 200 bits after the point of the scaled square root.
    fn exact_area(mesh: &Mesh) -> BigRational {
        let mut sum = BigRational::zero();
        for t in 0..mesh.triangles.len() {
            let [a, b, c] =
                mesh.corners(t).map(|p| p.to_array().map(|x| BigRational::from_float(x).expect("finite")));
            let (e, f): (Vec<_>, Vec<_>) = (0..3).map(|i| (&b[i] - &a[i], &c[i] - &a[i])).unzip();
            let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &e[i] * &f[j] - &e[j] * &f[i]);
            let square = normal.iter().fold(BigRational::zero(), |sum, x| sum + x * x);
            let shifted = (square * (BigInt::from(1) << 800_usize)).to_integer();
            sum += BigRational::new(shifted.sqrt(), BigInt::from(1) << 401_usize);
        }
        sum
    }

    fn close(found: f64, expected: &BigRational, relative: f64, absolute: f64) {
        let found_exactly = BigRational::from_float(found).expect("finite");
        let error = (found_exactly - expected).abs().to_f64().expect("a number");
        let size = expected.abs().to_f64().expect("a number");
        assert!(
            error <= relative * size + absolute,
            "{found} for {expected:.3?}, error {error}",
            expected = expected.to_f64()
        );
    }

    /// Compares everything with rational arithmetic on the same coordinates.
    fn check(mesh: &Mesh) {
        let found = Measures::of(mesh);
        let (volume, centroid, inertia) = exact_mass(mesh);
        let size = found.bounds.size().length();
        close(found.volume, &volume, 1.2e-16, 0.0);
        close(super::volume(mesh), &volume, 1.2e-16, 0.0);
        close(found.area, &exact_area(mesh), 1e-15, 0.0);
        let place = found.centroid.expect("a volume").to_array();
        let tensor = found.inertia.expect("a volume").to_cols_array();
        for i in 0..3 {
            close(place[i], &centroid[i], 1.2e-16, 1e-24 * size);
        }
        let largest = inertia[..3].iter().map(|x| x.abs().to_f64().expect("a number")).fold(0.0, f64::max);
        for (k, at) in [0, 4, 8, 1, 5, 2].into_iter().enumerate() {
            close(tensor[at], &inertia[k], 3e-16, 1e-28 * largest);
        }
    }

    /// A torus of `n` by `m` vertices with radii 3 and 1.
    fn torus(n: u32, m: u32) -> Mesh {
        let position = |i: u32, j: u32| {
            let (s, c) = sin_cos(TAU * f64::from(i) / f64::from(n));
            let (h, r) = sin_cos(TAU * f64::from(j) / f64::from(m));
            Vec3::new((3.0 + r) * c, (3.0 + r) * s, h)
        };
        let index = |i: u32, j: u32| (i % n) * m + j % m;
        let grid = || (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
        let quad = |(i, j)| {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        Mesh::new(grid().map(|(i, j)| position(i, j)).collect(), grid().flat_map(quad).collect())
    }

    fn moved(mesh: &Mesh, map: Affine3) -> Mesh {
        Mesh::new(mesh.positions.iter().map(|&p| map.transform_point3(p)).collect(), mesh.triangles.clone())
    }

    fn block(x: f64, y: f64, z: f64) -> Mesh {
        cuboid(Vec3::ZERO, Vec3::new(x, y, z)).into_mesh()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// Closed surfaces through random points of very different sizes, far from the origin and not.
        #[test]
        fn random_solids_agree_with_rationals(
            offsets in prop::collection::vec(prop::array::uniform3(-0.4..0.4_f64), 60),
            scale in prop::array::uniform3(-30..30_i32),
            shift in prop::array::uniform3(-1e9..1e9_f64),
            far in any::<bool>(),
        ) {
            let scale = Vec3::from(scale.map(|e| 2.0_f64.powi(if far { e / 4 } else { e })));
            let shift = if far { Vec3::from(shift) } else { Vec3::ZERO };
            let mut mesh = torus(10, 6);
            for (p, offset) in mesh.positions.iter_mut().zip(offsets) {
                *p = scale * (*p + Vec3::from(offset)) + shift;
            }
            check(&mesh);
        }
    }

    #[test]
    fn hard_cases_agree_with_rationals() {
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
        let rotated = |mesh: &Mesh, at: Vec3| moved(mesh, Affine3::from_rotation_translation(turn, at));
        let mut pair = rotated(&block(1.0, 2.0, 3.0), Vec3::splat(1e9));
        pair.append(&rotated(&block(2.0, 1.0, 1e-3), Vec3::splat(-1e9)));
        let cases = [
            rotated(&block(1.0, 1.0, 1.0), Vec3::new(1e9, -1e9, 1e9)),
            rotated(&block(1.0, 1.0, 1e-12), Vec3::ZERO),
            rotated(&block(1e6, 1e-6, 1e-6), Vec3::ZERO),
            rotated(&block(1e-9, 1e-9, 1e-9), Vec3::ZERO),
            rotated(&block(1e9, 1e9, 1e9), Vec3::ZERO),
            moved(&torus(12, 9), Affine3::from_translation(Vec3::splat(1e9))),
            pair,
        ];
        cases.iter().for_each(check);
    }

    #[test]
    fn a_unit_cube_far_away_is_exactly_one() {
        let at = Vec3::splat(1e9);
        let found = cuboid(at, at + Vec3::ONE).measures();
        assert_eq!((found.volume, found.area, found.centroid), (1.0, 6.0, Some(at + Vec3::splat(0.5))));
        assert_eq!(found.inertia, Some(Mat3::from_diagonal(Vec3::splat(1.0 / 6.0))));
        assert_eq!((found.components, found.euler, found.genus, found.closed), (1, 2, Some(0), true));
    }

    #[test]
    fn fine_shapes_approach_their_formulas() {
        let found = Measures::of(&torus(600, 300));
        approx::assert_relative_eq!(found.volume, 2.0 * PI * PI * 3.0, max_relative = 1e-3);
        approx::assert_relative_eq!(found.area, 4.0 * PI * PI * 3.0, max_relative = 1e-3);
        let about_z = found.inertia.expect("a volume").z_axis.z;
        approx::assert_relative_eq!(about_z, found.volume * (9.0 + 0.75), max_relative = 1e-3);
        assert_eq!((found.components, found.euler, found.genus), (1, 0, Some(1)));
    }

    #[test]
    fn extremes_of_f64() {
        let huge = cuboid(Vec3::splat(-1.7e308), Vec3::splat(1.7e308)).measures();
        assert_eq!((huge.volume, huge.area, huge.centroid), (f64::INFINITY, f64::INFINITY, Some(Vec3::ZERO)));
        let tiny = cuboid(Vec3::ZERO, Vec3::splat(2.0_f64.powi(-350))).measures();
        assert_eq!((tiny.volume, tiny.area), (2.0_f64.powi(-1050), 6.0 * 2.0_f64.powi(-700)));
        let mut broken = block(1.0, 1.0, 1.0);
        broken.positions[3].y = f64::NAN;
        let found = Measures::of(&broken);
        assert!(found.volume.is_nan() && found.area.is_nan() && found.centroid.is_none() && found.closed);
    }

    #[test]
    fn topology_of_parts() {
        let mut mesh = block(1.0, 1.0, 1.0);
        mesh.append(&moved(&torus(9, 5), Affine3::from_translation(Vec3::splat(9.0))));
        mesh.positions.push(Vec3::splat(1e30));
        let whole = Measures::of(&mesh);
        assert_eq!((whole.components, whole.euler, whole.genus, whole.vertices), (2, 2, Some(1), 53));
        let parts = Measures::of_components(&mesh);
        assert_eq!(
            parts.iter().map(|m| (m.euler, m.genus)).collect::<Vec<_>>(),
            [(2, Some(0)), (0, Some(1))]
        );
        assert_eq!(parts[0].volume, 1.0);

        mesh.triangles.pop();
        let open = Measures::of(&mesh);
        assert_eq!((open.closed, open.genus, open.centroid, open.euler), (false, None, None, 1));
        // Two blocks that share a vertex are one component and no manifold.
        let mut touching = block(1.0, 1.0, 1.0);
        touching.append(&moved(&block(1.0, 1.0, 1.0), Affine3::from_translation(Vec3::ONE)));
        touching.triangles.iter_mut().flatten().filter(|v| **v == 8).for_each(|v| *v = 7);
        let found = Measures::of(&touching);
        assert_eq!((found.components, found.closed, found.genus), (1, true, None));
        assert_eq!(Solid::new(touching).expect("closed").measures().genus, Some(0));
    }

    #[test]
    fn nothing_measures_zero() {
        let nothing = Solid::default().measures();
        assert_eq!((nothing.volume, nothing.area, nothing.centroid), (0.0, 0.0, None));
        assert_eq!((nothing.components, nothing.euler, nothing.genus, nothing.closed), (0, 0, Some(0), true));
        let bad = Mesh::new(vec![Vec3::ZERO], vec![[0, 0, 0], [0, 1, 2], [u32::MAX, 0, 0]]);
        assert_eq!(Measures::of(&bad), Measures { bounds: Aabb::EMPTY, ..nothing });
    }

    #[test]
    fn inside_out_is_negative() {
        let found = Measures::of(&block(1.0, 2.0, 3.0).flipped());
        assert_eq!((found.volume, found.centroid), (-6.0, Some(Vec3::new(0.5, 1.0, 1.5))));
    }
}
