//! What booleans promise beyond the right shape: errors, births, labels, the same bits in any order.

use ogee::boolean::{
    self, BooleanError, Combined, Op, Operand, Options, Steps, Tree, evaluate, evaluate_with,
};
use ogee::math::{Quat, Vec3};
use ogee::mesh::{Mesh, Solid, components, crossing_pairs, cuboid, sphere};

fn cube(corner: Vec3, size: f64) -> Solid {
    cuboid(corner, corner + Vec3::splat(size))
}

fn moved(solid: &Solid, turn: Quat, by: Vec3) -> Mesh {
    let mut mesh = solid.mesh().clone();
    mesh.positions.iter_mut().for_each(|p| *p = turn * *p + by);
    mesh
}

/// Triangles by their corner positions, each from its least corner, sorted.
fn canonical(mesh: &Mesh) -> Vec<[[u64; 3]; 3]> {
    let corner = |p: Vec3| (p + 0.0).to_array().map(f64::to_bits);
    let mut all: Vec<[[u64; 3]; 3]> = (0..mesh.triangles.len())
        .map(|t| {
            let mut corners = mesh.corners(t).map(corner);
            let least = (0..3).min_by_key(|&i| corners[i]).unwrap_or_default();
            corners.rotate_left(least);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

/// Distance of a point from the plane of a triangle.
fn off_plane(mesh: &Mesh, triangle: u32, p: Vec3) -> f64 {
    let [a, b, c] = mesh.corners(triangle as usize);
    (p - a).dot((b - a).cross(c - a).normalize()).abs()
}

fn some_pair() -> [Mesh; 2] {
    let ball = sphere(1.0, 24).expect("a sphere");
    let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -1.0).normalize(), 0.4);
    [ball.into_mesh(), moved(&cube(Vec3::splat(-0.7), 1.4), turn, Vec3::new(0.5, 0.1, 0.2))]
}

/// Cubes of many sizes, turned anyhow.
fn turned_cubes(seed: u64, count: usize, growth: f64) -> Vec<Solid> {
    let mut state = seed;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut vector = move || Vec3::new(random(), random(), random());
    let cube = |i: usize| {
        let turn = Quat::from_axis_angle(vector().normalize(), 2.0);
        let mesh = moved(&cube(Vec3::splat(-0.5), 1.0), turn, 0.8 * vector());
        let size = growth.powi(i as i32);
        let scaled = mesh.positions.iter().map(|&p| size * p).collect();
        Solid::new(Mesh::new(scaled, mesh.triangles)).expect("a cube")
    };
    (0..count).map(cube).collect()
}

/// The places of all vertices, each once.
fn places(solid: &Solid) -> Vec<[u64; 3]> {
    let mut places: Vec<_> =
        solid.positions().iter().map(|&p| (p + 0.0).to_array().map(f64::to_bits)).collect();
    places.sort_unstable();
    places.dedup();
    places
}

/// Sizes that grow and shrink make the lattice of each call another one.
#[test]
fn calls_one_after_another_are_as_exact_as_one_expression() {
    let ops = [Op::Union, Op::Difference, Op::Union, Op::SymmetricDifference, Op::Intersection];
    for growth in [1.0, 0.7, 1.3] {
        for seed in 0..6 {
            let cubes = turned_cubes(seed, 6, growth);
            let operands: Vec<&Solid> = cubes.iter().collect();
            let first = (Tree::Leaf(0), cubes[0].clone());
            let (tree, chained) = ops.iter().zip(1..).fold(first, |(tree, solid), (&op, i)| {
                let result = evaluate(&Tree::flat(op, 2), &[&solid, &cubes[i]]).expect("solids").solid;
                (Tree::Node(op, vec![tree, Tree::Leaf(i)]), result)
            });
            let at_once = evaluate(&tree, &operands).expect("solids").solid;
            // One expression takes the small parts on the lattice of the largest, a chain on their own.
            let (one, other) = (places(&chained), places(&at_once));
            assert_eq!(one.len(), other.len(), "seed {seed}, growth {growth}");
            let coordinates = one.iter().flatten().zip(other.iter().flatten());
            let off = coordinates.map(|(&x, &y)| (f64::from_bits(x) - f64::from_bits(y)).abs());
            assert!(off.fold(0.0, f64::max) <= if growth > 1.0 { 1e-15 } else { 0.0 });
            assert!((chained.measures().volume - at_once.measures().volume).abs() < 1e-14);
        }
    }
}

/// What is cut off and put back leaves no trace: every new vertex falls on the old plane again.
#[test]
fn what_is_cut_off_and_put_back_leaves_nothing_behind() {
    for seed in 0..10 {
        let cubes = turned_cubes(seed, 2, 0.9);
        let [a, b] = [&cubes[0], &cubes[1]];
        let rest = boolean::difference(a, b).solid;
        let back = boolean::difference(a, &rest).solid;
        let common = boolean::intersection(a, b).solid;
        assert_eq!(places(&back), places(&common), "seed {seed}");
        let whole = boolean::union(&rest, &common).solid;
        assert_eq!(places(&whole), places(a), "seed {seed}");
        let nothing = boolean::difference(&boolean::difference(a, &rest).solid, &common).solid;
        assert!(nothing.is_empty(), "seed {seed}");
        // Without the memory, slivers remain.
        let settled = boolean::union(&rest.settled(), &common.settled()).solid;
        assert_ne!(places(&settled), places(a), "seed {seed}");
    }
}

/// A hundred calls, with sizes that leave the first lattice far behind.
#[test]
fn long_chains_that_grow_stay_clean() {
    let mut tower = Solid::default();
    for i in 0..100 {
        let brick =
            cuboid(Vec3::new(0.1 * f64::from(i), 0.0, 0.0), Vec3::new(0.1 * f64::from(i + 1), 0.3, 0.7));
        tower = boolean::union(&tower, &brick).solid;
    }
    assert_eq!(tower.triangles().len(), 12);
}

/// A tip of one part touches a face of another from within, at no vertex of it.
#[test]
fn a_corner_on_the_inside_of_a_face_is_not_lost() {
    let tetrahedron = |corners: [[f64; 3]; 4], triangles: [[u32; 3]; 4]| {
        let mesh = Mesh::new(corners.map(Vec3::from_array).to_vec(), triangles.to_vec());
        Solid::new(mesh).expect("a tetrahedron")
    };
    let parts = [
        tetrahedron(
            [[3.0, 4.0, 4.0], [1.0, 0.0, 3.0], [0.0, 4.0, 4.0], [3.0, 3.0, 1.0]],
            [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        ),
        tetrahedron(
            [[2.0, 2.0, 1.0], [2.0, 4.0, 1.0], [2.0, 4.0, 4.0], [0.0, 4.0, 4.0]],
            [[0, 1, 2], [1, 0, 3], [1, 3, 2], [0, 2, 3]],
        ),
        tetrahedron(
            [[2.0, 3.0, 2.0], [-2.0, 3.0, 2.0], [0.0, 1.0, 2.0], [0.0, 3.0, 0.0]],
            [[0, 1, 2], [3, 1, 0], [3, 0, 2], [3, 2, 1]],
        ),
    ];
    let either = boolean::symmetric_difference(&parts[1], &parts[2]).solid;
    let all = boolean::union(&parts[0], &either).solid;
    assert!((all.measures().volume - 9.668_253_968_253_968).abs() < 1e-12);
}

#[test]
fn the_order_of_operands_changes_no_bit() {
    let [a, b] = some_pair();
    for op in [Op::Union, Op::Intersection, Op::SymmetricDifference] {
        let tree = Tree::flat(op, 2);
        let (ab, ba) = (evaluate(&tree, &[&a, &b]).unwrap(), evaluate(&tree, &[&b, &a]).unwrap());
        assert_eq!(canonical(ab.solid.mesh()), canonical(ba.solid.mesh()), "{op:?}");
    }
}

#[test]
fn every_triangle_lies_on_the_one_it_came_from() {
    let [a, b] = some_pair();
    for op in [Op::Union, Op::Intersection, Op::Difference, Op::SymmetricDifference] {
        let Combined { solid, birth, .. } = evaluate(&Tree::flat(op, 2), &[&a, &b]).unwrap();
        assert_eq!(solid.triangles().len(), birth.len());
        for (t, birth) in birth.iter().enumerate() {
            let source = [&a, &b][birth.operand as usize];
            for p in solid.mesh().corners(t) {
                assert!(off_plane(source, birth.triangle, p) < 1e-15 * 8.0, "{op:?} {t}");
            }
        }
    }
}

#[test]
fn vertices_away_from_the_cut_keep_their_bits() {
    let [a, b] = some_pair();
    let solid = evaluate(&Tree::flat(Op::Difference, 2), &[&a, &b]).unwrap().solid;
    let kept = a.positions.iter().filter(|p| solid.positions().contains(p)).count();
    assert!(kept > a.positions.len() / 2);
}

/// Two wedges that touch along an edge become two others where what was inside is outside.
#[test]
fn touching_wedges_change_partners_when_turned_inside_out() {
    let pair = [cube(Vec3::ZERO, 1.0), cube(Vec3::new(1.0, 1.0, 0.0), 1.0)];
    let block = cube(Vec3::splat(-1.0), 4.0);
    let taken_away = Tree::flat(Op::Difference, 3);
    let at_once = evaluate(&taken_away, &[&block, &pair[0], &pair[1]]).unwrap().solid;
    let wedges = boolean::union(&pair[0], &pair[1]).solid;
    assert_eq!(components(wedges.mesh()).len(), 2);
    let one_by_one = boolean::difference(&block, &wedges).solid;
    let steps = Options { steps: Steps::Pairs, ..Options::default() };
    let in_pairs = evaluate_with(&taken_away, &[&block, &pair[0], &pair[1]], &steps).unwrap().solid;
    for result in [at_once, one_by_one, in_pairs] {
        // The two cavities are one, joined along both flanks of the edge.
        assert_eq!(components(result.mesh()).len(), 2);
        let wedges = boolean::difference(&block, &result).solid;
        assert_eq!(components(wedges.mesh()).len(), 2);
        // Faces of the cavities run on flat across the edge, where the other two meet: what cuts them there is seen.
        let cutter = cuboid(Vec3::new(0.5, 0.5, 0.25), Vec3::new(1.5, 1.5, 0.75));
        assert_eq!(boolean::difference(&result, &cutter).solid.measures().volume, 61.75);
    }
}

#[test]
fn at_least_two_of_three_slabs() {
    let slab = |axis: usize| {
        let mut size = Vec3::splat(3.0);
        size[axis] = 1.0;
        cuboid(-0.5 * size, 0.5 * size)
    };
    let slabs = [0, 1, 2].map(slab);
    let all: Vec<&Solid> = slabs.iter().collect();
    let volume = |least: u32| {
        let tree = Tree::AtLeast(least, (0..3).map(Tree::Leaf).collect());
        evaluate(&tree, &all).unwrap().solid.measures().volume
    };
    // A cube of 27 cells of a unit: each cell is in as many slabs as it has middle coordinates.
    assert_eq!([0, 1, 2, 3, 4].map(volume), [0.0, 19.0, 7.0, 1.0, 0.0]);
}

#[test]
fn labels_keep_coplanar_faces_apart() {
    let (a, b) = (cube(Vec3::ZERO, 1.0), cube(Vec3::X, 1.0));
    let tree = Tree::flat(Op::Union, 2);
    let plain = evaluate(&tree, &[&a, &b]).unwrap();
    assert_eq!(plain.solid.triangles().len(), 12);
    let labelled = [Operand::from(&a), Operand::from(&b).with_material(1)];
    let Combined { solid, birth, .. } = evaluate(&tree, &labelled).unwrap();
    assert_eq!((solid.triangles().len(), solid.positions().len()), (20, 12));
    for (t, birth) in birth.iter().enumerate() {
        let middle = solid.mesh().corners(t).iter().sum::<Vec3>() / 3.0;
        assert_eq!(birth.operand, u32::from(middle.x > 1.0));
    }
}

#[test]
fn empty_and_missing_operands_are_ordinary() {
    let (a, nothing) = (cube(Vec3::ZERO, 1.0), Solid::default());
    assert_eq!(boolean::union(&a, &nothing).solid.triangles().len(), 12);
    assert!(boolean::intersection(&a, &nothing).solid.is_empty());
    assert!(boolean::difference(&nothing, &a).solid.is_empty());
    assert!(evaluate::<&Solid>(&Tree::flat(Op::Union, 0), &[]).unwrap().solid.is_empty());
    assert!(evaluate::<&Solid>(&Tree::flat(Op::Intersection, 0), &[]).unwrap().solid.is_empty());
}

#[test]
fn what_bounds_no_volume_is_refused() {
    let mut open = cube(Vec3::ZERO, 1.0).into_mesh();
    open.triangles.pop();
    let error = evaluate(&Tree::Leaf(0), &[&open]).unwrap_err();
    assert_eq!(error.to_string(), "operand 0 bounds no volume: 3 open edges, 3 unbalanced edges");
    let mut far = cube(Vec3::ZERO, 1.0).into_mesh();
    far.positions[2].y = f64::NAN;
    assert!(matches!(evaluate(&Tree::Leaf(0), &[&far]), Err(BooleanError::NotClosed { operand: 0, .. })));
    far.triangles[3][1] = 99;
    assert!(evaluate(&Tree::Leaf(0), &[&far]).is_err());
    let error = evaluate(&Tree::Leaf(1), &[&cube(Vec3::ZERO, 1.0)]).unwrap_err();
    assert_eq!(error.to_string(), "the expression names operand 1 of 1");
}

#[test]
fn extreme_sizes_are_taken() {
    for scale in [1e-300, 1e-9, 1e9, 1e300] {
        let (a, b) = (cube(Vec3::ZERO, scale), cube(Vec3::splat(0.5 * scale), scale));
        let solid = boolean::difference(&a, &b).solid;
        assert_eq!((solid.positions().len(), solid.triangles().len()), (14, 24), "{scale:e}");
        assert!(solid.positions().contains(&Vec3::splat(0.5 * scale)));
    }
}

#[test]
fn a_grid_joins_what_misses_by_less() {
    let (a, b) = (cube(Vec3::ZERO, 1.0), cube(Vec3::new(1.0 + 1e-13, 0.0, 1e-13), 1.0));
    let parts = [&a, &b];
    let tree = Tree::flat(Op::Union, 2);
    assert_eq!(evaluate(&tree, &parts).unwrap().solid.triangles().len(), 24);
    assert_eq!(
        evaluate_with(&tree, &parts, &Options { resolution: 1e-10, ..Options::default() })
            .unwrap()
            .solid
            .triangles()
            .len(),
        12
    );
}

/// A ring on a face, both part of one operand: what the ring leaves of the face in its middle has no side of its own.
#[test]
fn an_operand_may_lie_on_itself() {
    let block = cuboid(Vec3::ZERO, Vec3::new(4.0, 4.0, 2.0)).into_mesh();
    let outer = cuboid(Vec3::new(1.0, 1.0, 1.0), Vec3::new(3.0, 3.0, 2.0));
    let inner = cuboid(Vec3::new(1.5, 1.5, 0.5), Vec3::new(2.5, 2.5, 2.5));
    let ring = boolean::difference(&outer, &inner).solid.into_mesh();
    let offset = block.positions.len() as u32;
    let mut both = block;
    both.positions.extend(ring.positions);
    both.triangles.extend(ring.triangles.iter().map(|t| t.map(|v| v + offset)));
    let whole = evaluate(&Tree::Leaf(0), &[&both]).expect("closed").solid;
    assert_eq!((whole.triangles().len(), whole.measures().volume), (12, 32.0));
}

/// Cubes a billionth of a radian apart have features far below an ulp; none of them may end up folded.
#[test]
fn what_rounding_folds_is_repaired() {
    let axis = Vec3::new(1.0, 2.0, 3.0).normalize();
    let cubes: Vec<Mesh> = (0..30)
        .map(|k| {
            let turn = Quat::from_axis_angle(axis, 1e-9 * f64::from(k));
            moved(&cube(Vec3::splat(-0.5), 1.0), turn, Vec3::ZERO)
        })
        .collect();
    let Combined { solid, birth, certificate } =
        evaluate(&Tree::flat(Op::Union, 30), &cubes.iter().collect::<Vec<_>>()).expect("cubes");
    assert!(certificate.crossings_found > 0 && certificate.crossings_left == 0, "{certificate:?}");
    assert!(certificate.movement < 1e-14, "{certificate:?}");
    let all: Vec<u32> = (0..solid.triangles().len() as u32).collect();
    assert_eq!(crossing_pairs(solid.mesh(), &all), Vec::<[u32; 2]>::new());
    assert_eq!(solid.measures().genus, Some(0));
    // The repair moved vertices; the next boolean goes on from where they are exactly, colours and all.
    let materials: Vec<u32> = birth.iter().map(|birth| birth.operand).collect();
    for cube in &cubes {
        let whole = Operand::from(&solid);
        for whole in [whole, whole.with_materials(&materials)] {
            let nothing = evaluate(&Tree::flat(Op::Difference, 2), &[Operand::from(cube), whole]);
            assert!(nothing.expect("solids").solid.is_empty());
        }
    }
}
