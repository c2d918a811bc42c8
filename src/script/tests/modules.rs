//! What modules make.

use super::*;
use crate::boolean::Op;
use crate::csg::{Body, Dimension, Flat};
use crate::math::{Affine3, Vec2, Vec3};

#[track_caller]
fn made(text: &str) -> Evaluated {
    let mut host = Memory::default();
    let result = host.run(text);
    result.unwrap_or_else(|_| panic!("{text}\n{:#?}", host.texts(Severity::Error)))
}

/// Checks the recipe of a script.
#[track_caller]
fn check(text: &str, expected: &Csg) {
    assert_eq!(*made(text).recipe, *expected, "{text}");
}

/// Checks that two scripts make the same.
#[track_caller]
fn check_same(a: &str, b: &str) {
    assert_eq!(*made(a).recipe, *made(b).recipe, "{a}\n{b}");
}

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Csg {
    Csg::Body(Body::Cuboid { min: Vec3::from_array(min), max: Vec3::from_array(max) })
}

fn cube(size: f64) -> Csg {
    cuboid([0.0; 3], [size; 3])
}

fn combine(op: Op, children: &[Csg]) -> Csg {
    Csg::Combine { op, children: children.iter().cloned().map(Arc::new).collect() }
}

#[test]
fn primitives_take_their_sizes() {
    check("cube();", &cube(1.0));
    check("cube(2);", &cube(2.0));
    check("cube([1, 2, 3], true);", &cuboid([-0.5, -1.0, -1.5], [0.5, 1.0, 1.5]));
    check("cube(center = true, size = 2);", &cuboid([-1.0; 3], [1.0; 3]));
    check("square([1, 2]);", &Csg::Flat(Flat::Rectangle { min: Vec2::ZERO, max: Vec2::new(1.0, 2.0) }));
    check("circle(d = 10);", &Csg::Flat(Flat::Circle { radius: 5.0, fragments: 16 }));
    check("sphere(5);", &Csg::Body(Body::Sphere { radius: 5.0, fragments: 16 }));
    check("sphere(r = 1, d = 4, $fn = 8);", &Csg::Body(Body::Sphere { radius: 2.0, fragments: 8 }));
    let frustum = |heights, radii, fragments| Csg::Body(Body::Frustum { heights, radii, fragments });
    check("cylinder();", &frustum([0.0, 1.0], [1.0, 1.0], 5));
    check("cylinder(2, 3, 4, true);", &frustum([-1.0, 1.0], [3.0, 4.0], 13));
    check("cylinder(h = 5, d1 = 4, d2 = 0);", &frustum([0.0, 5.0], [2.0, 0.0], 7));
    check("cylinder(r = 4, d2 = 10);", &frustum([0.0, 1.0], [4.0, 5.0], 16));
    check("cylinder(d = 3, r1 = 5);", &frustum([0.0, 1.0], [5.0, 1.5], 16));
}

#[test]
fn what_has_no_size_is_nothing() {
    for text in
        ["cube(0);", "cube([1, 0, 1]);", "cube(-1);", "sphere(0/0);", "sphere(1/0);", "cylinder(h = -1);"]
    {
        check(text, &Csg::Nothing);
    }
    for text in [
        "cylinder(r1 = 0, r2 = 0);",
        "circle(-1);",
        "square(1/0);",
        "polygon([]);",
        "polygon([[0, 0], [1, 0]]);",
    ] {
        check(text, &Csg::Nothing);
    }
    for text in ["", "union();", "hull() {}", "difference() { cube(-1); cube(1); }", "*cube();"] {
        check(text, &Csg::Nothing);
    }
}

#[test]
fn polygons_have_paths() {
    let polygon = |contours: Vec<Vec<[f64; 2]>>| {
        let contours = contours.into_iter().map(|c| c.into_iter().map(Vec2::from_array).collect()).collect();
        Csg::Flat(Flat::Polygon { contours: Arc::new(contours) })
    };
    let triangle = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    check("polygon([[0, 0], [1, 0], [0, 1]]);", &polygon(vec![triangle.clone()]));
    check("polygon([[0, 0], [1, 0], [0, 1]], [0, 1, 2]);", &polygon(vec![triangle.clone()]));
    let points = "[[0, 0], [1, 0], [0, 1], [1, 1]]";
    let second = vec![[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    check(&format!("polygon({points}, [[0, 1, 2], [1, 2, 3]]);"), &polygon(vec![triangle, second]));
    check_complaint(
        Severity::Warning,
        "polygon([[0, 0], [1, 0], [0, 1]], [[0, 1, 7]]);",
        "paths[0]",
        "polygon([[0, 0], [1, 0], [0, 1]], [[0, 1, 7]])",
    );
}

#[test]
fn statements_are_joined() {
    check("cube(1); cube(2);", &combine(Op::Union, &[cube(1.0), cube(2.0)]));
    check("union() { cube(1); cube(2); }", &combine(Op::Union, &[cube(1.0), cube(2.0)]));
    check("module m() { cube(1); } m();", &cube(1.0));
    check("for (i = [1:2]) cube(i);", &combine(Op::Union, &[cube(1.0), cube(2.0)]));
    check("intersection_for (i = [1:2]) cube(i);", &combine(Op::Intersection, &[cube(1.0), cube(2.0)]));
    check("if (1 > 2) cube(1); else cube(2);", &cube(2.0));
    check("difference() { cube(2); cube(1); }", &combine(Op::Difference, &[cube(2.0), cube(1.0)]));
    // A condition that fails and an echo take no place among the children, a loop without rounds does.
    check("difference() { if (false) cube(5); echo(1); cube(3); }", &cube(3.0));
    check("difference() { for (i = []) cube(5); cube(3); }", &Csg::Nothing);
    check("difference() { { cube(2); cube(1); } }", &combine(Op::Difference, &[cube(2.0), cube(1.0)]));
    check("module none() {} difference() { none(); cube(4); }", &Csg::Nothing);
    check("intersection() { group(); cube(5); }", &combine(Op::Intersection, &[Csg::Nothing, cube(5.0)]));
    check(
        "module m() { difference() { children(0); children(1); } } m() { cube(2); cube(1); }",
        &combine(Op::Difference, &[cube(2.0), cube(1.0)]),
    );
    check(
        "hull() { cube(1); group(); cube(2); }",
        &Csg::Hull { children: vec![Arc::new(cube(1.0)), Arc::new(cube(2.0))] },
    );
}

#[test]
fn dimensions_do_not_mix() {
    check_same("union() { square(1); cube(1); square(2); }", "union() { square(1); square(2); }");
    check_same("difference() { cube(1); square(1); }", "cube(1);");
    check_same("linear_extrude(1) { square(1); cube(1); }", "linear_extrude(1) square(1);");
    check_complaint(Severity::Warning, "union() { square(1); cube(1); }", "do not mix", "union()");
}

#[test]
fn modifiers_choose() {
    let union = combine(Op::Union, &[cube(1.0), cube(3.0)]);
    check("cube(1); *cube(2); cube(3);", &union);
    check("cube(1); translate([1, 0, 0]) { !cube(2); } cube(3);", &cube(2.0));
    let evaluated = made("cube(1); %cube(2); #cube(3);");
    assert_eq!(*evaluated.recipe, union);
    let shown: Vec<&Csg> = evaluated.shown.iter().map(|shape| &**shape).collect();
    assert_eq!(shown, [&cube(2.0), &cube(3.0)]);
    let evaluated = made("translate([1, 2, 3]) { %cube(2); }");
    assert_eq!(*evaluated.recipe, Csg::Nothing);
    assert!(matches!(&*evaluated.shown[0], Csg::Transform { .. }));
}

#[test]
fn placements_are_exact_where_they_can_be() {
    let transform = |map: Affine3| Csg::Transform { map, child: Arc::new(cube(1.0)) };
    check("translate([1, 2]) cube();", &transform(Affine3::from_translation(Vec3::new(1.0, 2.0, 0.0))));
    check("scale([1, 2]) cube();", &transform(Affine3::from_scale(Vec3::new(1.0, 2.0, 1.0))));
    check_same("rotate(90) cube();", "multmatrix([[0, -1, 0], [1, 0, 0], [0, 0, 1]]) cube();");
    check_same("rotate([0, 90, 0]) cube();", "multmatrix([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]) cube();");
    check_same("rotate([90, 0, 90]) cube();", "multmatrix([[0, 0, 1], [1, 0, 0], [0, 1, 0]]) cube();");
    check_same("rotate(a = 45, v = [0, 0, 2]) cube();", "rotate(45) cube();");
    check_same("rotate([90]) cube();", "rotate([90, 0, 0]) cube();");
    check_same("mirror() cube();", "mirror([1, 0, 0]) cube();");
    check_same("mirror([1, 1, 0]) cube();", "multmatrix([[0, -1], [-1, 0]]) cube();");
    check_same("mirror([0, 0, 0]) cube();", "cube();");
    check_same(
        "multmatrix([[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 2]]) cube();",
        "multmatrix([[.5, 0, 0, 2.5], [0, .5, 0, 3], [0, 0, .5, 3.5]]) cube();",
    );
    for text in [
        "translate(5)",
        "translate(\"a\")",
        "translate([1/0, 0])",
        "rotate(\"a\")",
        "rotate(1/0)",
        "scale(undef)",
    ] {
        check_same(&format!("{text} cube();"), "cube();");
    }
}

/// Observed in OpenSCAD 2021.01, whose output has six digits.
#[test]
fn general_rotations_agree_with_openscad() {
    let check = |text: &str, rows: [[f64; 3]; 3]| {
        let evaluated = made(&format!("{text} cube();"));
        let Csg::Transform { map, .. } = &*evaluated.recipe else { panic!("{text}") };
        for (row, expected) in rows.iter().enumerate() {
            for (column, expected) in expected.iter().enumerate() {
                assert!((map.matrix3.col(column)[row] - expected).abs() < 1e-6, "{text}: {map}");
            }
        }
    };
    check(
        "rotate([30, 40, 50])",
        [[0.492404, -0.456826, 0.740843], [0.586824, 0.802872, 0.10504], [-0.642788, 0.383022, 0.663414]],
    );
    check(
        "rotate(30, [1, 1, 0])",
        [[0.933013, 0.0669873, 0.353553], [0.0669873, 0.933013, -0.353553], [-0.353553, 0.353553, 0.866025]],
    );
}

#[test]
fn extrusions_take_their_numbers() {
    let sweep = |text: &str| match &*made(text).recipe {
        Csg::LinearExtrude { sweep, .. } => *sweep,
        other => panic!("{text}: {other:?}"),
    };
    assert_eq!(sweep("linear_extrude(10) square(5);").vector, Vec3::new(0.0, 0.0, 10.0));
    assert_eq!(sweep("linear_extrude() square(5);").vector.z, 100.0);
    assert_eq!(sweep("linear_extrude(h = 7) square(5);").vector.z, 7.0);
    let slant = sweep("linear_extrude(height = 5, v = [3, 0, 4]) square(1);").vector;
    assert!((slant - Vec3::new(3.0, 0.0, 4.0)).length() < 1e-15);
    assert_eq!(
        sweep("linear_extrude(1, scale = [1, 2], center = true) square(1);").scale,
        Vec2::new(1.0, 2.0)
    );
    assert_eq!(sweep("linear_extrude(10, twist = 90) square(5);").slices, 8);
    assert_eq!(sweep("linear_extrude(10, twist = 720) square(5);").slices, 45);
    assert_eq!(sweep("linear_extrude(10, twist = 720) rotate(45) color(\"red\") square(5);").slices, 45);
    assert_eq!(sweep("linear_extrude(10, twist = 90, slices = 3) square(5);").slices, 3);
    assert_eq!(made("linear_extrude(0) square(1);").recipe.dimension(), None);
    let turn = |text: &str| match &*made(text).recipe {
        Csg::RotateExtrude { sweep, .. } => {
            (sweep.angle.to_degrees().round(), sweep.start.to_degrees().round(), sweep.fragments)
        }
        other => panic!("{text}: {other:?}"),
    };
    assert_eq!(turn("rotate_extrude() translate([3, 0]) square(1);"), (360.0, 180.0, 13));
    assert_eq!(turn("rotate_extrude(angle = 90) translate([3, 0]) square(1);"), (90.0, 0.0, 3));
    assert_eq!(turn("rotate_extrude(angle = -90, $fn = 10) translate([3, 0]) square(1);"), (90.0, -90.0, 2));
    assert_eq!(turn("rotate_extrude(400, start = 20) translate([3, 0]) square(1);"), (360.0, 20.0, 13));
    assert_eq!(made("rotate_extrude(angle = 20) square(1);").recipe.dimension(), Some(Dimension::Three));
}

#[test]
fn polyhedra_are_checked() {
    let points = "[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]";
    let polyhedron = |faces: &str| format!("polyhedron({points}, {faces});");
    // Clockwise seen from outside.
    let good = polyhedron("[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]");
    let Csg::Body(Body::Mesh(mesh)) = &*made(&good).recipe else { panic!("a mesh") };
    let solid = crate::mesh::Solid::new((**mesh).clone()).expect("a closed mesh");
    let volume: f64 = (0..4)
        .map(|t| {
            let [a, b, c] = solid.mesh().corners(t);
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!((volume - 1.0 / 6.0).abs() < 1e-15);
    let turned = polyhedron("[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]");
    assert!(matches!(&*made(&turned).recipe, Csg::Body(Body::Mesh(_))));
    check_complaint(Severity::Warning, &turned, "inside out", turned.trim_end_matches(';'));
    let open = polyhedron("[[0, 1, 2], [0, 3, 1], [0, 2, 3]]");
    check_complaint(Severity::Error, &open, "open", open.trim_end_matches(';'));
    let one_wrong = polyhedron("[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 2, 3]]");
    check_complaint(Severity::Error, &one_wrong, "one face is inside out", one_wrong.trim_end_matches(';'));
    let out_of_range = polyhedron("[[0, 1, 9]]");
    check_complaint(Severity::Warning, &out_of_range, "faces[0]", out_of_range.trim_end_matches(';'));
}

#[test]
fn files_come_from_the_host() {
    let mesh = Arc::new(crate::mesh::cuboid(Vec3::ZERO, Vec3::ONE).into_mesh());
    let mut host = Memory::default();
    host.meshes.insert("a.stl", mesh.clone());
    let recipe = host.run("import(\"a.stl\", convexity = 3);").expect("it runs").recipe;
    assert_eq!(*recipe, Csg::Body(Body::Mesh(mesh)));
    check_complaint(
        Severity::Error,
        "import(\"b.stl\");",
        "cannot import b.stl: there is no such file",
        "import(\"b.stl\")",
    );
}

#[test]
fn deep_recursion_makes_deep_recipes() {
    let chain =
        |n: u32| format!("module r(n) if (n > 0) {{ cube(); translate([2, 0, 0]) r(n - 1); }} r({n});");
    assert_eq!(made(&chain(900)).recipe.dimension(), Some(Dimension::Three));
    let mut host = Memory::default();
    assert_eq!(host.run(&chain(5000)).map(|_| ()), Err(Failure::Limit));
    assert!(host.messages[0].text.contains("operations within each other"), "{:?}", host.messages[0].text);
}

#[test]
fn options_that_do_nothing_are_named() {
    check_complaint(
        Severity::Warning,
        "color(alpha = 0.5) cube();",
        "alpha needs a colour",
        "color(alpha = 0.5)",
    );
    check_complaint(Severity::Warning, "sphere(1, $fa = 0.001);", "$fa", "sphere(1, $fa = 0.001)");
    check_complaint(
        Severity::Warning,
        "linear_extrude(1, segments = 3) square();",
        "segments",
        "linear_extrude(1, segments = 3)",
    );
}

#[test]
fn what_is_missing_is_named() {
    for builtin in builtins().filter(|builtin| builtin.is_missing()) {
        let name = builtin.name;
        let script =
            if builtin.kind == BuiltinKind::Module { format!("{name}();") } else { format!("x = {name}();") };
        check_complaint(
            Severity::Error,
            &script,
            &format!("ogee does not have {name}() yet"),
            &format!("{name}()"),
        );
    }
    check("module text(t) cube(1); text(\"own\");", &cube(1.0));
}
