//! The oracle judged: cases with answers known by hand, and identities that any right answer satisfies.

#[allow(dead_code, reason = "each test program uses its part")]
mod oracle;
#[allow(dead_code, reason = "each test program uses its part")]
mod solids;

use dashu_ratio::RBig;
use ogee::boolean::{Op, Tree};
use ogee::math::{Vec2, Vec3};
use ogee::mesh::Mesh;
use oracle::{Truth, evaluate};
use solids::{all_of, cube, cuboid, difference, menger, tetrahedron, together, translated, union};

fn of(tree: &Tree, meshes: &[Mesh]) -> Truth {
    evaluate(tree, &meshes.iter().collect::<Vec<_>>())
}

fn pair(op: Op, a: &Mesh, b: &Mesh) -> Truth {
    evaluate(&all_of(op, 2), &[a, b])
}

/// Volume as a fraction, components, genus.
fn assert_is(truth: &Truth, volume: (i64, u64), components: usize, genus: i64) {
    let volume = RBig::from_parts(volume.0.into(), volume.1.into());
    assert_eq!((&truth.volume, truth.components.len(), truth.genus()), (&volume, components, genus));
}

#[test]
fn single_solids() {
    let unit = cube(0.0, 0.0, 0.0, 1.0);
    let truth = of(&Tree::Leaf(0), &[unit]);
    assert_is(&truth, (1, 1), 1, 0);
    assert_eq!(truth.area, 6.0);
    assert_eq!(truth.points.iter().filter(|(_, corner)| *corner).count(), 8);
    let corner = tetrahedron([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]);
    assert_is(&of(&Tree::Leaf(0), &[corner]), (1, 6), 1, 0);
    let tiny = cube(1e-9, 1e9, 0.0, 0.125);
    assert!((of(&Tree::Leaf(0), &[tiny]).volume_f64() * 512.0 - 1.0).abs() < 1e-5);
}

#[test]
fn contacts_of_cubes() {
    let unit = cube(0.0, 0.0, 0.0, 1.0);
    let at = |x: f64, y: f64, z: f64| translated(&unit, Vec3::new(x, y, z));
    assert_is(&pair(Op::Union, &unit, &at(1.0, 0.0, 0.0)), (2, 1), 1, 0);
    assert_is(&pair(Op::Union, &unit, &at(1.0, 0.5, 0.5)), (2, 1), 1, 0);
    assert_is(&pair(Op::Union, &unit, &at(1.0, 1.0, 0.0)), (2, 1), 2, 0);
    assert_is(&pair(Op::Union, &unit, &at(1.0, 1.0, 1.0)), (2, 1), 2, 0);
    assert_is(&pair(Op::Union, &unit, &at(0.5, 0.5, 0.5)), (15, 8), 1, 0);
    assert_is(&pair(Op::Difference, &unit, &unit), (0, 1), 0, 0);
    assert_is(&pair(Op::Union, &unit, &unit), (1, 1), 1, 0);
    assert_is(&pair(Op::Intersection, &unit, &at(1.0, 0.0, 0.0)), (0, 1), 0, 0);
    assert_is(&pair(Op::SymmetricDifference, &unit, &at(0.5, 0.0, 0.0)), (1, 1), 2, 0);
    let flush = pair(Op::Union, &unit, &at(1.0, 0.0, 0.0));
    assert_eq!(flush.points.iter().filter(|(_, corner)| *corner).count(), 8);
    assert_eq!(flush.area, 10.0);
}

#[test]
fn checkerboard() {
    let cells = (0..64).map(|i| (i % 4, i / 4 % 4, i / 16)).filter(|(x, y, z)| (x + y + z) % 2 == 0);
    let cubes: Vec<Mesh> =
        cells.map(|(x, y, z)| cube(f64::from(x), f64::from(y), f64::from(z), 1.0)).collect();
    assert_is(&of(&union(32), &cubes), (32, 1), 32, 0);
    let block = cube(0.0, 0.0, 0.0, 4.0);
    let rest = pair(Op::Difference, &block, &together(&cubes));
    assert_is(&rest, (32, 1), 32, 0);
}

#[test]
fn sponges() {
    let (tree, meshes) = menger(1);
    assert_is(&of(&tree, &meshes), (20, 1), 1, 5);
    let (tree, meshes) = menger(2);
    assert_is(&of(&tree, &meshes), (400, 1), 1, 81);
}

#[test]
fn shells_and_windings() {
    let shells: Vec<Mesh> =
        (0..4).map(|i| cube(f64::from(i), f64::from(i), f64::from(i), f64::from(8 - 2 * i))).collect();
    let nested = of(&all_of(Op::SymmetricDifference, 4), &shells);
    assert_is(&nested, (512 - 216 + 64 - 8, 1), 4, 0);
    let (outer, inner) = (&shells[0], shells[1].clone());
    assert_is(&of(&Tree::Leaf(0), &[together([outer, &inner])]), (512, 1), 1, 0);
    assert_is(&of(&Tree::Leaf(0), &[together([outer, &inner.flipped()])]), (512 - 216, 1), 2, 0);
    assert_is(&of(&Tree::Leaf(0), &[cube(0.0, 0.0, 0.0, 1.0).flipped()]), (0, 1), 0, 0);
    let crossing = together([&cube(0.0, 0.0, 0.0, 2.0), &cube(1.0, 1.0, 1.0, 2.0)]);
    assert_is(&of(&Tree::Leaf(0), &[crossing]), (15, 1), 1, 0);
    assert_is(&of(&union(0), &[]), (0, 1), 0, 0);
}

#[test]
fn a_frame_and_a_folded_prism() {
    let frame = [
        cuboid(Vec3::ZERO, Vec3::new(3.0, 3.0, 1.0)),
        cuboid(Vec3::new(1.0, 1.0, -1.0), Vec3::new(2.0, 2.0, 2.0)),
    ];
    assert_is(&of(&difference(2), &frame), (8, 1), 1, 1);
    // A letter U whose caps are fanned from its first vertex and fold over themselves.
    let u = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)];
    let u: Vec<Vec2> = u.map(|(x, y)| Vec2::new(f64::from(x), f64::from(y))).into();
    assert_is(&of(&Tree::Leaf(0), &[solids::prism(&u, 0.0, 2.0)]), (14, 1), 1, 0);
    assert_is(&of(&Tree::Leaf(0), &[solids::fanned_prism(&u, 0.0, 2.0)]), (14, 1), 1, 0);
}

/// Two tetrahedra through each other: the star has 14 corners, 24 faces cut to eight points.
#[test]
fn stella_octangula() {
    let corners = |s: f64| {
        [[1.0, 1.0, s], [-1.0, -1.0, s], [1.0, -1.0, -s], [-1.0, 1.0, -s]].map(|[x, y, z]| Vec3::new(x, y, z))
    };
    let (a, b) = (tetrahedron(corners(1.0)), tetrahedron(corners(-1.0)));
    let star = pair(Op::Union, &a, &b);
    assert_is(&star, (4, 1), 1, 0);
    assert_eq!(star.points.iter().filter(|(_, corner)| *corner).count(), 14);
    assert_is(&pair(Op::Intersection, &a, &b), (4, 3), 1, 0);
    assert_is(&pair(Op::SymmetricDifference, &a, &b), (8, 3), 8, 0);
}

/// Solids turned by angles whose planes miss each other by very little.
#[test]
fn identities_of_near_copies() {
    let a = cube(-0.5, -0.5, -0.5, 1.0);
    for angle in [1e-6, 1e-12, 1e-15] {
        let (s, c) = ogee::math::sin_cos(angle);
        let turn = [[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let b = solids::mapped(&a, &turn);
        let volume = |op| pair(op, &a, &b).volume;
        let alone = |mesh: &Mesh| evaluate(&Tree::Leaf(0), &[mesh]).volume;
        assert_eq!(alone(&a) + alone(&b), volume(Op::Union) + volume(Op::Intersection), "{angle}");
        assert_eq!(alone(&a) - volume(Op::Difference), volume(Op::Intersection), "{angle}");
    }
}
