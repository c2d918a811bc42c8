//! The hard cases, each with what is known of its result.

use crate::oracle::random::SplitMix;
use crate::solids::{
    IDENTITY, Rows, all_of, ball, circle, cube, cuboid, difference, mapped, menger, prism, tetrahedron,
    together, translated, union,
};
use ogee::boolean::{Op, Tree};
use ogee::math::{Vec2, Vec3, sin_cos};
use ogee::mesh::Mesh;

/// An expression over meshes, and what is true of it.
pub(crate) struct Specimen {
    pub(crate) name: String,
    pub(crate) tree: Tree,
    pub(crate) operands: Vec<Mesh>,
    pub(crate) expected: Expected,
}

/// What is known of a result.
pub(crate) enum Expected {
    /// By hand: volume to a relative error, components, genus.
    Known { volume: f64, within: f64, components: usize, genus: i64 },
    /// Small enough for the oracle.
    Oracle,
}

impl Specimen {
    fn known(
        name: &str,
        tree: Tree,
        operands: Vec<Mesh>,
        volume: f64,
        components: usize,
        genus: i64,
    ) -> Specimen {
        let expected = Expected::Known { volume, within: 1e-12, components, genus };
        Specimen { name: name.to_owned(), tree, operands, expected }
    }

    fn asked(name: String, tree: Tree, operands: Vec<Mesh>) -> Specimen {
        Specimen { name, tree, operands, expected: Expected::Oracle }
    }

    fn within(mut self, error: f64) -> Specimen {
        if let Expected::Known { within, .. } = &mut self.expected {
            *within = error;
        }
        self
    }
}

const OPS: [Op; 4] = [Op::Union, Op::Intersection, Op::Difference, Op::SymmetricDifference];

/// Parts that touch: whole faces, parts of faces, edges and vertices.
pub(crate) fn contacts() -> Vec<Specimen> {
    let unit = || cube(0.0, 0.0, 0.0, 1.0);
    let pair = |name, x, y, z, components| {
        Specimen::known(name, union(2), vec![unit(), cube(x, y, z, 1.0)], 2.0, components, 0)
    };
    let roof = prism(&[Vec2::new(0.0, 0.5), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0)], 0.0, 1.0);
    // Its edge x = 0, y = 1/2 comes to lie along the middle of the cube's top.
    let roof = mapped(&roof, &[[0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 1.0]]);
    let plates = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, -1.0)]
        .map(|corner| cuboid(corner, corner + Vec3::new(2.0, 2.0, 1.0)));
    let mut pillars = vec![unit(), cube(1.0, 1.0, 0.0, 1.0)];
    pillars.extend(plates);
    let checkers = || -> Vec<Mesh> {
        let cells =
            (0..64).map(|i| [i % 4, i / 4 % 4, i / 16]).filter(|cell| cell.iter().sum::<i32>() % 2 == 0);
        cells.map(|[x, y, z]| cube(f64::from(x), f64::from(y), f64::from(z), 1.0)).collect()
    };
    let mut holes = vec![cube(0.0, 0.0, 0.0, 4.0)];
    holes.extend(checkers());
    vec![
        pair("cubes sharing a face", 1.0, 0.0, 0.0, 1),
        pair("cubes sharing part of a face", 1.0, 0.25, 0.5, 1),
        pair("cubes sharing an edge", 1.0, 1.0, 0.0, 2),
        pair("cubes sharing part of an edge", 1.0, 1.0, 0.5, 2),
        pair("cubes sharing a vertex", 1.0, 1.0, 1.0, 2),
        Specimen::known("an edge lying on a face", union(2), vec![unit(), roof], 1.5, 2, 0),
        Specimen::asked("pillars that touch along an edge between plates".into(), union(4), pillars),
        Specimen::known("a checkerboard of 32 cubes", union(32), checkers(), 32.0, 32, 0),
        Specimen::known("the other half of a checkerboard", difference(33), holes, 32.0, 32, 0),
    ]
}

/// The same solid again, exactly or nearly.
pub(crate) fn copies() -> Vec<Specimen> {
    let mut all = Vec::new();
    let round = ball(8, 1.0, Vec3::ZERO);
    let volume = crate::check::Shape::of(&round).volume_f64();
    for (op, volume, components) in [
        (Op::Union, volume, 1),
        (Op::Intersection, volume, 1),
        (Op::Difference, 0.0, 0),
        (Op::SymmetricDifference, 0.0, 0),
    ] {
        let name = format!("{op:?} of identical balls");
        all.push(Specimen::known(&name, all_of(op, 2), vec![round.clone(); 2], volume, components, 0));
    }
    let block = || cube(-0.5, -0.5, -0.5, 1.0);
    for (exponent, op) in (0..10).zip(OPS.into_iter().cycle()) {
        let angle = ogee::math::pow(10.0, f64::from(-6 - exponent));
        let b = mapped(&block(), &about_z(angle));
        all.push(Specimen::asked(
            format!("{op:?} of cubes {angle:e} rad apart"),
            all_of(op, 2),
            vec![block(), b],
        ));
        let b = mapped(&block(), &about(Vec3::new(1.0, 2.0, 3.0), angle));
        let name = format!("{op:?} of cubes {angle:e} rad apart on a skew axis");
        all.push(Specimen::asked(name, all_of(op, 2), vec![block(), b]));
    }
    let step = 1e-9;
    let flat: Vec<Mesh> = (0..30).map(|k| mapped(&block(), &about_z(f64::from(k) * step))).collect();
    // Half of each side sticks out as a triangle with the legs 1/2 and tan(29 steps) / 2.
    let volume = 1.0 + 29.0 * step / 2.0;
    all.push(Specimen::known("30 cubes 1e-9 rad apart", union(30), flat, volume, 1, 0));
    let skew = (0..30).map(|k| mapped(&block(), &about(Vec3::new(1.0, 2.0, 3.0), f64::from(k) * step)));
    let skew: Vec<Mesh> = skew.collect();
    // All of them hold their common centre, so the union is a star: one piece without handles.
    all.push(
        Specimen::known("30 cubes 1e-9 rad apart on a skew axis", union(30), skew, 1.0, 1, 0).within(1e-7),
    );
    all
}

/// What is thin, long, tiny, far away or empty.
pub(crate) fn extremes() -> Vec<Specimen> {
    let unit = || cube(0.0, 0.0, 0.0, 1.0);
    let mut all = Vec::new();
    for thickness in [1e-12, 1e-15] {
        let top = 1.0 - thickness;
        let cutter = cuboid(Vec3::splat(-1.0), Vec3::new(2.0, 2.0, top));
        let name = format!("a slab {thickness:e} thick left over");
        all.push(Specimen::known(&name, difference(2), vec![unit(), cutter], 1.0 - top, 1, 0));
        let cutter = cuboid(Vec3::ZERO, Vec3::new(1.0, 1.0, top));
        let name = format!("a slab {thickness:e} thick left over by a flush cut");
        all.push(Specimen::known(&name, difference(2), vec![unit(), cutter], 1.0 - top, 1, 0));
    }
    for op in OPS {
        let needle = tetrahedron(
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1e-12, 0.0], [0.5, 5e-13, 1.0]].map(Vec3::from_array),
        );
        let block = cuboid(Vec3::new(0.3, -1.0, 0.2), Vec3::new(0.6, 1.0, 0.7));
        all.push(Specimen::asked(
            format!("{op:?} with a needle of aspect 1e12"),
            all_of(op, 2),
            vec![needle, block],
        ));
        for scale in [1e-9, 1e9] {
            let about = about(Vec3::new(3.0, 1.0, 2.0), 0.7).map(|row| row.map(|x| x * scale));
            let pair =
                vec![mapped(&unit(), &about), cube(0.1 * scale, 0.3 * scale, -0.2 * scale, 0.9 * scale)];
            all.push(Specimen::asked(format!("{op:?} of cubes of size {scale:e}"), all_of(op, 2), pair));
        }
        let far = Vec3::new(1e9, -1e9, 1e9);
        let tilted = mapped(&unit(), &about(Vec3::new(3.0, 1.0, 2.0), 0.7));
        let pair = vec![translated(&tilted, far), translated(&cube(0.125, 0.25, -0.25, 1.0), far)];
        all.push(Specimen::asked(format!("{op:?} of cubes at 1e9"), all_of(op, 2), pair));
    }
    let apart = || vec![unit(), cube(5.0, 0.0, 0.0, 1.0)];
    let nothing = |name: &str, tree, operands| Specimen::known(name, tree, operands, 0.0, 0, 0);
    all.extend([
        nothing("an intersection of what is apart", all_of(Op::Intersection, 2), apart()),
        nothing("a cube minus itself", difference(2), vec![unit(), unit()]),
        nothing("a union of nothing", union(0), vec![]),
        nothing("an intersection of nothing", all_of(Op::Intersection, 0), vec![]),
        nothing("a union of empty operands", union(2), vec![Mesh::default(), Mesh::default()]),
        nothing("nothing minus a cube", difference(2), vec![Mesh::default(), unit()]),
        nothing("a cube and nothing", all_of(Op::Intersection, 2), vec![unit(), Mesh::default()]),
        Specimen::known("a cube minus nothing", difference(2), vec![unit(), Mesh::default()], 1.0, 1, 0),
        Specimen::known("an expression of one leaf", Tree::Leaf(0), vec![unit()], 1.0, 1, 0),
    ]);
    all
}

/// Closed input that overlaps itself, crosses itself, is inside out or nested.
pub(crate) fn windings() -> Vec<Specimen> {
    let alone = |name: &str, mesh: Mesh, volume, components, genus| {
        Specimen::known(name, Tree::Leaf(0), vec![mesh], volume, components, genus)
    };
    let block = |low: f64, high: f64| cuboid(Vec3::splat(low), Vec3::splat(high));
    let star = |s: f64| {
        tetrahedron([[1.0, 1.0, s], [-1.0, -1.0, s], [1.0, -1.0, -s], [-1.0, 1.0, -s]].map(Vec3::from_array))
    };
    let shells: Vec<Mesh> = (0..6).map(|k| block(f64::from(k), f64::from(20 - k))).collect();
    let alternating: Vec<Mesh> = shells
        .iter()
        .enumerate()
        .map(|(k, m)| if k % 2 == 0 { m.clone() } else { m.clone().flipped() })
        .collect();
    let volume: f64 =
        (0..6).map(|k| f64::from(20 - 2 * k).powi(3) * if k % 2 == 0 { 1.0 } else { -1.0 }).sum();
    let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]].map(|[x, y]| Vec2::new(x, y));
    vec![
        alone("a cube inside out", block(0.0, 1.0).flipped(), 0.0, 0, 0),
        alone("a cube twice in one mesh", together([&block(0.0, 1.0), &block(0.0, 1.0)]), 1.0, 1, 0),
        alone("cubes overlapping in one mesh", together([&block(0.0, 2.0), &block(1.0, 3.0)]), 15.0, 1, 0),
        alone("a cavity in one mesh", together([&block(0.0, 3.0), &block(1.0, 2.0).flipped()]), 26.0, 2, 0),
        alone("a cube in a cube in one mesh", together([&block(0.0, 3.0), &block(1.0, 2.0)]), 27.0, 1, 0),
        alone("a cube and its opposite", together([&block(0.0, 1.0), &block(0.0, 1.0).flipped()]), 0.0, 0, 0),
        alone("tetrahedra through each other in one mesh", together([&star(1.0), &star(-1.0)]), 4.0, 1, 0),
        // One half of the bow runs counter-clockwise and is inside, the other is inside out.
        alone("a prism over a bow tie", crate::solids::fanned_prism(&bow, 0.0, 1.0), 1.0, 1, 0),
        alone("six shells, one inside out in the other", together(&alternating), volume, 6, 0),
        Specimen::known(
            "six shells by symmetric difference",
            all_of(Op::SymmetricDifference, 6),
            shells,
            volume,
            6,
            0,
        ),
    ]
}

/// Many operands; the grid of cubes has so many on each axis, and there are five times as many rods each way.
pub(crate) fn crowds(side: u32) -> Vec<Specimen> {
    let mut all = vec![sponge(1, 5), sponge(2, 81), sponge(3, 1409)];
    all.extend(grids(side));
    all.extend([flush_cuts(), rods(5 * side, 0.0), rods(5 * side, 0.25)]);
    all
}

/// The Menger sponge of a depth, of unit cells.
pub(crate) fn sponge(depth: u32, genus: i64) -> Specimen {
    let (tree, operands) = menger(depth);
    Specimen::known(
        &format!("the Menger sponge {depth}"),
        tree,
        operands,
        20_f64.powi(depth as i32),
        1,
        genus,
    )
}

/// A grid of cubes added one by one, then taken away again: themselves, or a smaller one out of each.
pub(crate) fn grids(side: u32) -> Vec<Specimen> {
    let count = side.pow(3);
    let cells = || (0..count).map(move |i| [i % side, i / side % side, i / side / side].map(f64::from));
    let added = || cells().map(|[x, y, z]| cube(x, y, z, 1.0));
    let smaller = cells().map(|[x, y, z]| cube(x + 0.25, y + 0.25, z + 0.25, 0.5));
    let tree = (1..2 * count as usize).fold(Tree::Leaf(0), |sum, next| {
        let op = if next < count as usize { Op::Union } else { Op::Difference };
        Tree::Node(op, vec![sum, Tree::Leaf(next)])
    });
    let (twice, hollow) = (added().chain(added()).collect(), added().chain(smaller).collect());
    let (volume, components) = (0.875 * f64::from(count), 1 + count as usize);
    vec![
        Specimen::known("a grid of cubes added and removed", tree.clone(), twice, 0.0, 0, 0),
        Specimen::known("a grid of cubes added and hollowed", tree, hollow, volume, components, 0),
    ]
}

/// A bar shortened ninety times by boxes flush with its sides and with each other, at coordinates that `f64` rounds.
fn flush_cuts() -> Specimen {
    let end = |k: i32| 10.0 - 0.1 * f64::from(k);
    let mut operands = vec![cuboid(Vec3::ZERO, Vec3::new(end(0), 0.3, 0.7))];
    operands.extend((0..90).map(|k| cuboid(Vec3::new(end(k + 1), 0.0, 0.0), Vec3::new(end(k), 0.3, 0.7))));
    let tree = (1..operands.len())
        .fold(Tree::Leaf(0), |bar, cut| Tree::Node(Op::Difference, vec![bar, Tree::Leaf(cut)]));
    Specimen::known("a bar cut flush again and again", tree, operands, end(90) * 0.3 * 0.7, 1, 0)
}

/// Rods across as many rods, in one layer or one a little higher: between them are holes.
fn rods(count: u32, rise: f64) -> Specimen {
    let end = f64::from(2 * count);
    let places = || (0..count).map(|i| f64::from(2 * i));
    let along_x = places().map(|y| cuboid(Vec3::new(-1.0, y, 0.0), Vec3::new(end, y + 1.0, 1.0)));
    let along_y = places().map(|x| cuboid(Vec3::new(x, -1.0, rise), Vec3::new(x + 1.0, end, 1.0 + rise)));
    let operands: Vec<Mesh> = along_x.chain(along_y).collect();
    let volume = end * (end + 1.0) - f64::from(count * count) * (1.0 - rise);
    let name = format!("rods {count} x {count}, {rise} apart");
    Specimen::known(&name, union(operands.len()), operands, volume, 1, i64::from(count - 1).pow(2))
}

/// Pairs for which only the laws are known: volumes must add up, and every result must be sound.
pub(crate) fn pairs() -> Vec<(String, Mesh, Mesh)> {
    let round = ball(6, 1.0, Vec3::ZERO);
    let ulp = Vec3::new(f64::EPSILON, 0.0, 0.0);
    let mut all = vec![
        ("a ball and itself moved by one ulp".to_owned(), round.clone(), translated(&round, ulp)),
        (
            "a gear and itself a tooth further".to_owned(),
            gear(),
            mapped(&gear(), &about_z(std::f64::consts::TAU / 24.0)),
        ),
        (
            "a gear and its mirror image".to_owned(),
            gear(),
            mapped(&gear(), &[[-1.0, 0.0, 0.0, 0.0], IDENTITY[1], IDENTITY[2]]),
        ),
    ];
    for exponent in [-6, -9, -12, -15] {
        let angle = ogee::math::pow(10.0, f64::from(exponent));
        let turned = mapped(&round, &about(Vec3::new(1.0, 2.0, 3.0), angle));
        all.push((format!("a ball and itself turned by {angle:e}"), round.clone(), turned));
    }
    all
}

/// A wheel of 24 teeth with sloping flanks.
fn gear() -> Mesh {
    let teeth = 24;
    let outline: Vec<Vec2> = (0..4 * teeth)
        .map(|k| {
            let turn = f64::from(k / 4) + [0.0, 0.1, 0.4, 0.5][k as usize % 4];
            let (s, c) = sin_cos(std::f64::consts::TAU * turn / f64::from(teeth));
            let radius = if matches!(k % 4, 1 | 2) { 1.0 } else { 0.85 };
            Vec2::new(radius * c, radius * s)
        })
        .collect();
    prism(&outline, 0.0, 0.2)
}

/// Unit cubes in random attitudes, all with their centre or all with a corner at the origin.
pub(crate) fn turned_cubes(corner: f64, count: usize) -> Vec<Mesh> {
    let mut random = SplitMix::new(90);
    let block = cube(corner, corner, corner, 1.0);
    (0..count)
        .map(|_| {
            let axis = Vec3::from_array([0; 3].map(|_| random.unit() - 0.5));
            mapped(&block, &about(axis, std::f64::consts::TAU * random.unit()))
        })
        .collect()
}

/// Hilly ground of `2 n^2` triangles above a flat bottom, and domes to dig out of it that do not touch each other.
pub(crate) fn terrain(n: u32, domes: u32) -> (Mesh, Vec<Mesh>) {
    let height =
        |x: f64, y: f64| 2.0 + 0.3 * sin_cos(1.3 * x).0 * sin_cos(0.9 * y).1 + 0.2 * sin_cos(0.7 * x + y).0;
    let size = f64::from(domes);
    let at = |k: u32| size * f64::from(k) / f64::from(n);
    let mut ground = Mesh::default();
    for (j, i) in (0..=n).flat_map(|j| (0..=n).map(move |i| (j, i))) {
        ground.positions.push(Vec3::new(at(i), at(j), height(at(i), at(j))));
    }
    let row = n + 1;
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let (a, b, c, d) = (j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i);
        ground.triangles.extend([[a, b, c], [a, c, d]]);
    }
    close_below(&mut ground, n);
    let mut balls = Vec::new();
    for (j, i) in (0..domes).flat_map(|j| (0..domes).map(move |i| (j, i))) {
        let (x, y) = (f64::from(i) + 0.5, f64::from(j) + 0.5);
        balls.push(ball(6, 0.4, Vec3::new(x, y, height(x, y))));
    }
    (ground, balls)
}

/// Walls down to z = 0 and a bottom fanned about its middle.
fn close_below(ground: &mut Mesh, n: u32) {
    let row = n + 1;
    let south = 0..n;
    let east = (0..n).map(|j| j * row + n);
    let north = (1..=n).rev().map(|i| n * row + i);
    let west = (1..=n).rev().map(|j| j * row);
    let rim: Vec<u32> = south.chain(east).chain(north).chain(west).collect();
    let base = ground.positions.len() as u32;
    let feet: Vec<Vec3> = rim.iter().map(|&v| ground.positions[v as usize].with_z(0.0)).collect();
    ground.positions.extend(&feet);
    ground.positions.push(feet.iter().sum::<Vec3>() / feet.len() as f64);
    let count = rim.len() as u32;
    for k in 0..count {
        let next = (k + 1) % count;
        let (top, top_next, foot, foot_next) = (rim[k as usize], rim[next as usize], base + k, base + next);
        ground.triangles.extend([
            [foot, foot_next, top_next],
            [foot, top_next, top],
            [base + count, foot_next, foot],
        ]);
    }
}

fn about_z(angle: f64) -> Rows {
    let (s, c) = sin_cos(angle);
    [[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], IDENTITY[2]]
}

/// The turn by an angle about an axis through the origin (Rodrigues).
pub(crate) fn about(axis: Vec3, angle: f64) -> Rows {
    let u = axis / axis.length();
    let (s, c) = sin_cos(angle);
    let t = 1.0 - c;
    [
        [c + t * u.x * u.x, t * u.x * u.y - s * u.z, t * u.x * u.z + s * u.y, 0.0],
        [t * u.x * u.y + s * u.z, c + t * u.y * u.y, t * u.y * u.z - s * u.x, 0.0],
        [t * u.x * u.z - s * u.y, t * u.y * u.z + s * u.x, c + t * u.z * u.z, 0.0],
    ]
}

/// A plate and cylinders through it, their ends flush with its faces or beyond.
pub(crate) fn perforated_plate(rows: u32, flush: bool, turn: Option<Rows>) -> (Tree, Vec<Mesh>) {
    let beyond = if flush { 0.0 } else { 0.5 };
    let size = f64::from(rows);
    let mut operands = vec![cuboid(Vec3::ZERO, Vec3::new(size, size, 1.0))];
    for (j, i) in (0..rows).flat_map(|j| (0..rows).map(move |i| (j, i))) {
        let center = Vec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5);
        operands.push(prism(&circle(4, 0.3, center), -beyond, 1.0 + beyond));
    }
    if let Some(rows) = turn {
        operands = operands.iter().map(|mesh| mapped(mesh, &rows)).collect();
    }
    (difference(operands.len()), operands)
}
