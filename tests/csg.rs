//! Recipes built: lazily, exactly, once each.

use ogee::boolean::{self, Op, Tree};
use ogee::csg::{
    Body, BuildError, BuildOptions, Built, Csg, Flat, LinearSweep, Note, RotateSweep, Shape, bounds, build,
    build_with_progress, print,
};
use ogee::math::{Affine3, Vec2, Vec3};
use ogee::mesh::{Defects, Measures, Mesh, Solid};
use ogee::tessellate::SweepError;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

fn cube(min: impl Into<Vec3>, max: impl Into<Vec3>) -> Csg {
    Csg::Body(Body::Cuboid { min: min.into(), max: max.into() })
}

fn unit() -> Csg {
    cube(Vec3::ZERO, Vec3::ONE)
}

fn sphere(radius: f64, fragments: u32) -> Csg {
    Csg::Body(Body::Sphere { radius, fragments })
}

fn square(min: f64, max: f64) -> Csg {
    Csg::Flat(Flat::Rectangle { min: Vec2::splat(min), max: Vec2::splat(max) })
}

fn combine<const N: usize>(op: Op, children: [Csg; N]) -> Csg {
    Csg::Combine { op, children: children.into_iter().map(Arc::new).collect() }
}

fn union<const N: usize>(children: [Csg; N]) -> Csg {
    combine(Op::Union, children)
}

fn difference<const N: usize>(children: [Csg; N]) -> Csg {
    combine(Op::Difference, children)
}

fn transform(map: Affine3, child: Csg) -> Csg {
    Csg::Transform { map, child: Arc::new(child) }
}

fn at(x: f64, y: f64, z: f64, child: Csg) -> Csg {
    transform(Affine3::from_translation(Vec3::new(x, y, z)), child)
}

/// Some turn about no particular axis.
fn turned(child: Csg) -> Csg {
    transform(Affine3::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), 0.7), child)
}

fn color(color: [f32; 4], child: Csg) -> Csg {
    Csg::Color { color, child: Arc::new(child) }
}

fn extrude(height: f64, child: Csg) -> Csg {
    let vector = height * Vec3::Z;
    let sweep = LinearSweep { vector, center: false, twist: 0.0, slices: 1, scale: Vec2::ONE };
    Csg::LinearExtrude { sweep, child: Arc::new(child) }
}

fn hull<const N: usize>(children: [Csg; N]) -> Csg {
    Csg::Hull { children: children.into_iter().map(Arc::new).collect() }
}

fn volume(mesh: &Mesh) -> f64 {
    let origin = mesh.positions.first().copied().unwrap_or_default();
    let six = |t: usize| {
        let [a, b, c] = mesh.corners(t).map(|p| p - origin);
        a.dot(b.cross(c))
    };
    (0..mesh.triangles.len()).map(six).sum::<f64>() / 6.0
}

fn cook(recipe: &Csg) -> Built {
    build(recipe, &BuildOptions::default()).unwrap()
}

/// Builds a solid and checks that it is one.
fn solid(recipe: &Csg) -> (Solid, Built) {
    let built = cook(recipe);
    let Shape::Solid(solid) = built.shape.clone() else { panic!("not a solid") };
    let defects = Defects::of(solid.mesh());
    assert!(defects.is_solid() && defects.non_manifold_vertices == 0, "{defects:?}");
    assert!(built.colors.is_empty() || built.colors.len() == solid.triangles().len());
    (solid, built)
}

fn assert_volume(recipe: &Csg, expected: f64) -> Built {
    let (solid, built) = solid(recipe);
    let actual = volume(solid.mesh());
    assert!((actual - expected).abs() <= 1e-12 * expected.abs(), "{actual} is not {expected}: {recipe:?}");
    built
}

#[test]
fn what_cannot_matter_is_never_made() {
    let report = assert_volume(&difference([unit(), at(5.0, 0.0, 0.0, sphere(1.0, 60))]), 1.0).report;
    assert_eq!((report.made, report.skipped, report.booleans), (1, 1, 0));
    let nothing = combine(Op::Intersection, [unit(), at(5.0, 0.0, 0.0, sphere(1.0, 60)), sphere(1.0, 9)]);
    let report = assert_volume(&nothing, 0.0).report;
    assert_eq!((report.made, report.skipped, report.booleans), (0, 3, 0));
    let apart = union([unit(), at(1.5, 0.0, 0.0, unit()), at(0.0, 3.0, 0.0, sphere(1.0, 8))]);
    let report = cook(&apart).report;
    assert_eq!((report.made, report.reused, report.booleans), (2, 1, 0));
    // Deep inside: of the bar, only what is within the window of the intersection takes part.
    let bar: Vec<Arc<Csg>> = (0..50).map(|i| Arc::new(at(f64::from(i), 0.0, 0.0, unit()))).collect();
    let bar = Csg::Combine { op: Op::Union, children: bar };
    let report =
        assert_volume(&combine(Op::Intersection, [cube([9.5, 0.0, 0.0], [11.5, 1.0, 1.0]), bar]), 2.0).report;
    assert_eq!(report.skipped, 47);
    // Boxes that touch have no volume in common.
    let report = assert_volume(&difference([unit(), at(1.0, 0.0, 0.0, unit())]), 1.0).report;
    assert_eq!((report.skipped, report.booleans), (1, 0));
}

#[test]
fn a_hundred_million_facets_that_do_not_matter() {
    let elsewhere = at(1e6, 0.0, 0.0, sphere(1.0, 20_000));
    assert_volume(&difference([unit(), elsewhere.clone()]), 1.0);
    let error = build(&union([unit(), elsewhere]), &BuildOptions::default()).unwrap_err();
    assert!(matches!(error, BuildError::Limit { .. }), "{error}");
}

#[test]
fn equal_parts_are_solved_once() {
    let part = Arc::new(difference([unit(), cube([0.25, 0.25, -1.0], [0.75, 0.75, 2.0])]));
    let copy = |i: i32| {
        let map = Affine3::from_translation(Vec3::X * 2.0 * f64::from(i));
        Arc::new(Csg::Transform { map, child: part.clone() })
    };
    let row = Csg::Combine { op: Op::Union, children: (0..5).map(copy).collect() };
    let report = assert_volume(&row, 3.75).report;
    assert_eq!((report.made, report.booleans, report.reused), (2, 1, 4));
    // The same without shared pointers: contents decide. Turned copies share too.
    let again = || turned(difference([unit(), cube([0.25, 0.25, -1.0], [0.75, 0.75, 2.0])]));
    let report =
        assert_volume(&union([again(), at(3.0, 0.0, 0.0, again()), at(6.0, 0.0, 0.0, again())]), 2.25).report;
    assert_eq!(report.booleans, 1);
    // Copies that touch each other are one boolean over all leaves, so flush faces meet exactly.
    let wall = Csg::Combine {
        op: Op::Union,
        children: (0..5)
            .map(|i| {
                let map = Affine3::from_translation(Vec3::X * f64::from(i));
                Arc::new(Csg::Transform { map, child: part.clone() })
            })
            .collect(),
    };
    let (wall, built) = solid(&wall);
    assert_eq!((volume(wall.mesh()), built.report.booleans), (3.75, 1));
    assert_eq!(wall.positions().len(), 8 + 5 * 8);
}

#[test]
fn flush_parts_stay_flush_however_they_are_turned() {
    let bricks = || [unit(), at(1.0, 0.0, 0.0, unit()), at(0.1, 0.2, 1.0, cube(Vec3::ZERO, [1.5, 0.7, 0.3]))];
    let (straight, _) = solid(&union(bricks()));
    let (as_a_whole, _) = solid(&turned(union(bricks())));
    let (one_by_one, _) = solid(&union(bricks().map(turned)));
    let (moved_too, _) = solid(&union(bricks().map(|brick| at(10.0, 20.0, 30.0, turned(brick)))));
    let nested = turned(union([unit(), union([bricks()[1].clone(), bricks()[2].clone()])]));
    for other in [&as_a_whole, &one_by_one, &moved_too, &solid(&nested).0] {
        assert_eq!(other.triangles().len(), straight.triangles().len());
        assert!((volume(other.mesh()) - volume(straight.mesh())).abs() < 1e-12);
    }
    // Two turned blocks minus a turned block flush with both: nothing thin is left over.
    let pocket = difference([turned(unit()), turned(cube([0.5, 0.0, 0.0], [1.0, 1.0, 1.0]))]);
    assert_eq!(solid(&pocket).0.triangles().len(), 12);
    // Only some of the operands are turned alike.
    let mixed = difference([
        cube([-5.0, -5.0, -5.0], [5.0, 5.0, 5.0]),
        turned(unit()),
        turned(at(1.0, 0.0, 0.0, unit())),
        at(0.0, 0.0, 5.0, unit()),
    ]);
    let (mixed, _) = solid(&mixed);
    assert!((volume(mixed.mesh()) - 998.0).abs() < 1e-9);
    assert_eq!(mixed.triangles().len(), 24);
}

#[test]
fn right_angles_and_mirrors_are_exact() {
    let quarter =
        |child| transform(Affine3::from_mat3(ogee::math::Mat3::from_cols(Vec3::Y, -Vec3::X, Vec3::Z)), child);
    let mirror = |child| transform(Affine3::from_scale(Vec3::new(-1.0, 1.0, 1.0)), child);
    let (solid_, _) = solid(&union([
        unit(),
        quarter(unit()),
        quarter(quarter(unit())),
        mirror(at(0.0, -1.0, 0.0, unit())),
    ]));
    assert_eq!((volume(solid_.mesh()), solid_.triangles().len()), (3.0, 20));
    let flipped = mirror(difference([sphere(1.0, 12), cube(Vec3::ZERO, Vec3::splat(2.0))]));
    assert!(volume(solid(&flipped).0.mesh()) > 0.0);
    let mirrored_turn = transform(Affine3::from_scale(Vec3::new(1.0, 1.0, -2.0)), turned(unit()));
    assert_volume(&mirrored_turn, 2.0);
}

#[test]
fn maps_that_flatten_give_nothing_and_a_note() {
    let flattened = transform(Affine3::from_scale(Vec3::new(1.0, 1.0, 0.0)), unit());
    let built = assert_volume(&union([flattened.clone(), at(3.0, 0.0, 0.0, unit())]), 1.0);
    assert_eq!(built.report.notes, [Note::SingularMap]);
    // The height of a map does not matter in the plane.
    let flat = extrude(2.0, transform(Affine3::from_scale(Vec3::new(3.0, 1.0, 0.0)), square(0.0, 1.0)));
    assert!(assert_volume(&flat, 6.0).report.notes.is_empty());
    let mixed = union([unit(), square(0.0, 5.0)]);
    assert_eq!(assert_volume(&mixed, 1.0).report.notes, [Note::MixedDimensions]);
}

#[test]
fn empty_operands() {
    let cases = [
        (Csg::Nothing, 0.0),
        (union([]), 0.0),
        (union([Csg::Nothing, unit()]), 1.0),
        (difference([Csg::Nothing, unit()]), 0.0),
        (difference([unit(), Csg::Nothing]), 1.0),
        (combine(Op::Intersection, [unit(), Csg::Nothing]), 0.0),
        (combine(Op::Intersection, [unit(), combine(Op::Intersection, [])]), 0.0),
        (combine(Op::SymmetricDifference, [unit(), Csg::Nothing, unit()]), 0.0),
        (combine(Op::SymmetricDifference, [unit(), unit(), unit()]), 1.0),
        (difference([unit(), unit()]), 0.0),
        (difference([difference([unit(), cube([0.5; 3], [1.0; 3])]), cube([0.0; 3], [0.5; 3])]), 0.75),
        (hull([Csg::Nothing]), 0.0),
        (extrude(1.0, Csg::Nothing), 0.0),
        (cube([1.0; 3], [0.0; 3]), 0.0),
    ];
    for (recipe, expected) in cases {
        assert_volume(&recipe, expected);
    }
}

#[test]
fn wrong_numbers_are_errors() {
    let error = |recipe: &Csg| build(recipe, &BuildOptions::default()).unwrap_err();
    let nan = transform(Affine3::from_scale(Vec3::splat(f64::NAN)), unit());
    assert_eq!(error(&union([unit(), nan])), BuildError::NonFinite { what: "transform" });
    assert_eq!(error(&sphere(f64::INFINITY, 9)), BuildError::NonFinite { what: "sphere" });
    let huge = Affine3::from_scale(Vec3::splat(1e200));
    assert_eq!(error(&transform(huge, transform(huge, unit()))), BuildError::NonFinite { what: "transform" });
    assert_eq!(
        error(&transform(huge, cube([0.0; 3], [1e200; 3]))),
        BuildError::NonFinite { what: "transform" }
    );
    assert!(matches!(error(&sphere(1.0, 10_000_000)), BuildError::Limit { .. }));
    let disc = Csg::Flat(Flat::Circle { radius: 1.0, fragments: u32::MAX });
    assert!(matches!(error(&disc), BuildError::Limit { .. }));
    let sweep = RotateSweep { angle: TAU, start: 0.0, fragments: 30 };
    let across = Csg::RotateExtrude { sweep, child: Arc::new(square(-1.0, 1.0)) };
    assert_eq!(error(&across), BuildError::Sweep(SweepError::CrossesAxis { min: -1.0, max: 1.0 }));
    let open = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]] };
    assert!(matches!(error(&Csg::Body(Body::Mesh(Arc::new(open)))), BuildError::NotClosed { .. }));
    let mut deep = unit();
    for i in 0..300 {
        let op = if i % 2 == 0 { Op::Intersection } else { Op::SymmetricDifference };
        deep = combine(op, [at(0.001, 0.0, 0.0, unit()), deep]);
    }
    assert!(matches!(error(&deep), BuildError::TooDeep { .. }));
}

#[test]
fn deep_recipes_need_no_stack() {
    let mut recipe = unit();
    for i in 0..60_000 {
        recipe = match i % 3 {
            0 => union([recipe]),
            1 => at(0.0, 0.0, 0.0, recipe),
            _ => color([1.0; 4], recipe),
        };
    }
    assert_volume(&recipe, 1.0);
    assert!(print(&recipe).len() > 60_000);
    let mut chain = unit();
    for i in 0..2000 {
        chain = difference([chain, at(f64::from(i), 5.0, 0.0, unit())]);
    }
    assert_volume(&chain, 1.0);
    // A spiral by recursion, each turn in the frame of the last.
    let mut spiral = unit();
    for _ in 0..30 {
        spiral = union([
            unit(),
            transform(Affine3::from_rotation_z(0.3) * Affine3::from_translation(Vec3::X * 3.0), spiral),
        ]);
    }
    assert!(volume(solid(&spiral).0.mesh()) > 10.0);
}

#[test]
fn colours_follow_the_faces() {
    let (red, blue) = ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]);
    let two = union([color(red, unit()), color(blue, at(1.0, 0.0, 0.0, unit()))]);
    let (solid_, built) = solid(&two);
    for (t, seen) in built.colors.iter().enumerate() {
        let middle = solid_.mesh().corners(t).iter().sum::<Vec3>() / 3.0;
        assert_eq!(*seen, Some(if middle.x < 1.0 { red } else { blue }), "{middle}");
    }
    assert_eq!(volume(solid_.mesh()), 2.0);
    // The outermost colour wins; what has none keeps none; a cut has the colour of what cut it.
    let cut = difference([color(red, color(blue, unit())), at(0.5, 0.0, 0.0, unit())]);
    let (solid_, built) = solid(&cut);
    for (t, seen) in built.colors.iter().enumerate() {
        let on_cut = solid_.mesh().corners(t).iter().all(|p| p.x == 0.5);
        assert_eq!(*seen, if on_cut { None } else { Some(red) });
    }
    let apart = turned(union([color(red, unit()), at(3.0, 0.0, 0.0, unit())]));
    assert_eq!(solid(&apart).1.colors, [vec![Some(red); 12], vec![None; 12]].concat());
    assert!(cook(&union([unit(), sphere(1.0, 9)])).colors.is_empty());
}

#[test]
fn regions() {
    let Shape::Region(region) = cook(&difference([square(-2.0, 2.0), square(-1.0, 1.0)])).shape else {
        panic!()
    };
    assert_eq!((region.area(), region.contours().len()), (12.0, 2));
    assert_volume(&extrude(3.0, difference([square(-2.0, 2.0), square(-1.0, 1.0)])), 36.0);
    let points = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
    let bow = vec![points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()];
    assert_volume(&extrude(1.0, Csg::Flat(Flat::Polygon { contours: Arc::new(bow) })), 2.0);
    let turn = |child| transform(Affine3::from_rotation_z(0.3), child);
    let flush = union([turn(square(0.0, 1.0)), turn(at(1.0, 0.0, 7.0, square(0.0, 1.0)))]);
    let Shape::Region(region) = cook(&flush).shape else { panic!() };
    assert_eq!((region.contours().len(), region.contours()[0].len()), (1, 4));
    let mirrored = transform(Affine3::from_scale(Vec3::new(-1.0, 1.0, 1.0)), square(0.0, 2.0));
    assert_volume(&extrude(1.0, mirrored), 4.0);
    let corner = || Csg::Flat(Flat::Circle { radius: 1.0, fragments: 4 });
    assert_volume(&extrude(1.0, hull([corner(), at(4.0, 0.0, 3.0, corner())])), 10.0);
}

#[test]
fn hulls() {
    assert_volume(&hull([unit(), at(2.0, 0.0, 0.0, unit())]), 3.0);
    assert_volume(
        &hull([union([unit(), at(1.0, 1.0, 1.0, unit())]), hull([at(2.0, 2.0, 2.0, unit())])]),
        7.0,
    );
    assert_volume(&hull([difference([cube([0.0; 3], [2.0, 1.0, 1.0]), at(1.0, 0.0, 0.0, unit())])]), 1.0);
    assert_volume(&turned(hull([unit(), at(2.0, 0.0, 0.0, unit())])), 3.0);
    assert_volume(&difference([hull([unit(), at(2.0, 0.0, 0.0, unit())]), at(1.0, 0.0, 0.0, unit())]), 2.0);
}

#[test]
fn meshes_that_overlap_themselves_are_cleaned() {
    let mut twice = ogee::mesh::cuboid(Vec3::ZERO, Vec3::ONE).into_mesh();
    twice.append(ogee::mesh::cuboid(Vec3::splat(0.5), Vec3::splat(1.5)).mesh());
    let (solid_, built) = solid(&Csg::Body(Body::Mesh(Arc::new(twice))));
    assert_eq!((volume(solid_.mesh()), built.report.booleans), (1.875, 1));
    // A ridge and a twist leave no overlap behind.
    let ridge = LinearSweep {
        vector: Vec3::Z,
        center: true,
        twist: FRAC_PI_2,
        slices: 5,
        scale: Vec2::new(0.0, 1.0),
    };
    let ridge = Csg::LinearExtrude { sweep: ridge, child: Arc::new(square(-1.0, 1.0)) };
    let exact = BuildOptions { resolution: 0.0, ..BuildOptions::default() };
    let Shape::Solid(solid_) = build(&ridge, &exact).unwrap().shape else { panic!("a solid") };
    assert!(solid_.is_embedded() && volume(solid_.mesh()) > 0.0);
}

#[test]
fn progress_counts_up_to_its_total() {
    let mut seen = Vec::new();
    let recipe = union([difference([unit(), sphere(0.5, 12)]), at(0.5, 0.0, 0.0, turned(unit()))]);
    build_with_progress(&recipe, &BuildOptions::default(), &mut |progress| seen.push(progress)).unwrap();
    assert!(seen.iter().enumerate().all(|(i, p)| p.done == i as u64 + 1 && p.done <= p.total));
    assert!(!seen.is_empty());
}

#[test]
fn printed_recipes() {
    let recipe = difference([
        color([0.5, 0.25, 1.0, 1.0], at(0.1, -2.0, 1e30, cube(Vec3::ZERO, [1.0, 2.5, 3.0]))),
        hull([sphere(1.0, 8), Csg::Nothing]),
        extrude(2.0, square(0.0, 1.0)),
    ]);
    let expected = "difference() {
  color([0.5, 0.25, 1, 1]) {
    multmatrix([[1, 0, 0, 0.1], [0, 1, 0, -2], [0, 0, 1, 1e30], [0, 0, 0, 1]]) {
      cube([1, 2.5, 3]);
    }
  }
  hull() {
    sphere(r = 1, $fn = 8);
    group();
  }
  linear_extrude(height = 2, center = false, twist = 0, slices = 1, scale = [1, 1]) {
    square([1, 1]);
  }
}
";
    assert_eq!(print(&recipe), expected);
}

fn small_cube() -> impl Strategy<Value = Csg> {
    (prop::array::uniform3(-3..3_i32), prop::array::uniform3(1..4_i32)).prop_map(|(min, size)| {
        let min = Vec3::from(min.map(f64::from));
        cube(min, min + Vec3::from(size.map(f64::from)))
    })
}

fn any_op() -> impl Strategy<Value = Op> {
    prop_oneof![Just(Op::Union), Just(Op::Intersection), Just(Op::Difference), Just(Op::SymmetricDifference)]
}

fn any_map() -> impl Strategy<Value = Affine3> {
    let shift = prop::array::uniform3(-3..4_i32)
        .prop_map(|t| Affine3::from_translation(Vec3::from(t.map(f64::from))));
    let quarter = ogee::math::Mat3::from_cols(Vec3::Y, -Vec3::X, Vec3::Z);
    prop_oneof![
        4 => shift,
        1 => Just(Affine3::from_mat3(quarter)),
        1 => Just(Affine3::from_scale(Vec3::new(1.0, -1.0, 2.0))),
        1 => Just(Affine3::from_axis_angle(Vec3::new(1.0, 2.0, 2.0) / 3.0, 0.7)),
    ]
}

fn any_recipe() -> impl Strategy<Value = Csg> {
    small_cube().prop_recursive(4, 14, 4, |inner| {
        prop_oneof![
            2 => (any_op(), prop::collection::vec(inner.clone().prop_map(Arc::new), 0..4))
                .prop_map(|(op, children)| Csg::Combine { op, children }),
            1 => (any_map(), inner).prop_map(|(map, child)| transform(map, child)),
        ]
    })
}

/// All leaves as they stand, each vertex mapped at once, and the whole recipe as one expression.
fn all_at_once(recipe: &Csg, map: Affine3, leaves: &mut Vec<Mesh>) -> Tree {
    match recipe {
        Csg::Transform { map: own, child } => all_at_once(child, map * *own, leaves),
        Csg::Combine { op, children } => {
            Tree::Node(*op, children.iter().map(|child| all_at_once(child, map, leaves)).collect())
        }
        Csg::Body(Body::Cuboid { min, max }) => {
            let mut mesh = ogee::mesh::cuboid(*min, *max).into_mesh();
            mesh.positions.iter_mut().for_each(|p| *p = map.transform_point3(*p));
            leaves.push(if map.matrix3.determinant() < 0.0 { mesh.flipped() } else { mesh });
            Tree::Leaf(leaves.len() - 1)
        }
        _ => unreachable!("not among these recipes"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Being lazy, framed and flat changes nothing about the shape.
    #[test]
    fn lazy_equals_all_at_once(recipe in any_recipe()) {
        let (lazy, _) = solid(&recipe);
        let mut leaves = Vec::new();
        let tree = all_at_once(&recipe, Affine3::IDENTITY, &mut leaves);
        let whole = boolean::evaluate(&tree, &leaves.iter().collect::<Vec<_>>()).unwrap().solid;
        prop_assert!((volume(lazy.mesh()) - volume(whole.mesh())).abs() < 1e-9);
        let (outer, inner) = (bounds(&recipe), lazy.mesh().bounds());
        if !lazy.is_empty() {
            prop_assert!(outer.min.cmple(inner.min + 1e-12).all() && inner.max.cmple(outer.max + 1e-12).all());
        }
        prop_assert_eq!(solid(&recipe).0, lazy);
    }
}

#[test]
fn parts_that_miss_each_other_by_rounding_errors_are_joined() {
    // Ten bricks at multiples of 0.1: 3 * 0.1 is not 0.2 + 0.1.
    let brick = |i: i32| at(f64::from(i) * 0.1, 0.0, 0.0, cube(Vec3::ZERO, Vec3::splat(0.1)));
    let wall = union([0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(brick));
    let components = |options: &BuildOptions| match build(&wall, options).unwrap().shape {
        Shape::Solid(solid) => (Measures::of(solid.mesh()).components, solid.triangles().len()),
        Shape::Region(_) => panic!("a solid"),
    };
    assert_eq!(components(&BuildOptions::default()), (1, 12));
    assert!(
        components(&BuildOptions { resolution: 0.0, ..BuildOptions::default() }).0 > 1,
        "every bit counts"
    );
}
