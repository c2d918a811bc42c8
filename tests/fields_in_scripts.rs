//! Fields and smooth operators in scripts: volumes, boxes, what is refused, what is told.

use ogee::csg::{self, BuildError, BuildOptions, Built, Shape, explain, print};
use ogee::isosurface::IsoError;
use ogee::math::{cos, hypot};
use ogee::mesh::{Defects, Mesh, Solid, crossing_pairs};
use ogee::script::{self, Host, Loaded, Message, Options, Severity};
use std::f64::consts::PI;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::Arc;

/// A host that writes down complaints, with their places.
#[derive(Default)]
struct Desk {
    complaints: Vec<String>,
}

impl Host for Desk {
    fn script(&mut self, name: &str, _: &str) -> Result<Loaded, String> {
        Err(format!("{name} is not needed"))
    }

    fn mesh(&mut self, name: &str, _: &str) -> Result<Arc<Mesh>, String> {
        Err(format!("{name} is not needed"))
    }

    fn say(&mut self, message: Message) {
        if message.severity != Severity::Echo {
            let place = message.at.map_or(0, |label| label.span.start);
            self.complaints.push(format!("{:?} at {place}: {}", message.severity, message.text));
        }
    }
}

/// The recipe of a script, if there is one, and what it complains of.
fn evaluate(text: &str) -> (Option<Arc<csg::Csg>>, Vec<String>) {
    let mut host = Desk::default();
    let main = Loaded { name: "a.scad".into(), text: text.into() };
    let evaluated = script::evaluate(main, &mut host, &Options::default());
    (evaluated.ok().map(|evaluated| evaluated.recipe), host.complaints)
}

fn recipe(text: &str) -> Arc<csg::Csg> {
    let (recipe, complaints) = evaluate(text);
    assert!(complaints.is_empty(), "{text}: {complaints:?}");
    recipe.expect("a recipe")
}

fn built(text: &str) -> Built {
    csg::build(&recipe(text), &BuildOptions::default()).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The solid of a script: closed, within the box that was foretold, and free of crossings.
fn solid(text: &str) -> Solid {
    solid_and_error(text).0
}

/// The same, and the greatest error of its fields.
fn solid_and_error(text: &str) -> (Solid, f64) {
    let Built { shape, report, .. } = built(text);
    let error = report.meshings.iter().map(|meshing| meshing.error).fold(0.0, f64::max);
    let Shape::Solid(solid) = shape else { panic!("{text}: flat") };
    assert!(Defects::of(solid.mesh()).is_solid(), "{text}");
    let all: Vec<u32> = (0..solid.triangles().len() as u32).collect();
    assert_eq!(crossing_pairs(solid.mesh(), &all), [[0_u32; 2]; 0], "{text}");
    if !solid.is_empty() {
        let (own, foretold) = (solid.bounds(), csg::bounds(&recipe(text)));
        let slack = 1e-6 * own.size().max_element();
        assert!((own.min - foretold.min).min_element() > -slack, "{text}: {own:?} {foretold:?}");
        assert!((foretold.max - own.max).min_element() > -slack, "{text}: {own:?} {foretold:?}");
    }
    (solid, error)
}

/// What a fillet of radius r adds around a shaft of this radius on a plate.
fn ring(shaft: f64, r: f64) -> f64 {
    2.0 * PI * (shaft * (1.0 - PI / 4.0) * r * r + (5.0 / 6.0 - PI / 4.0) * r * r * r)
}

fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

/// The volume within r of a cube.
fn around_cube(side: f64, r: f64) -> f64 {
    side.powi(3) + 6.0 * side * side * r + 3.0 * PI * side * r * r + ball(r)
}

/// Checks volumes to within the area times the tolerance of the mesh.
fn check_volumes(cases: &[(&str, f64)]) {
    for &(text, expected) in cases {
        let (solid, error) = solid_and_error(text);
        let allowed = solid.measures().area * error;
        let volume = solid.volume();
        assert!((volume - expected).abs() < allowed, "{text}: {volume} for {expected} within {allowed}");
        // Vertices lie on the surface: most of the mesh is far better than the bound.
        assert!((volume - expected).abs() < 0.15 * expected, "{text}: {volume} for {expected}");
    }
}

#[test]
fn primitives_have_their_volumes() {
    let periodic = |name: &str| solid(&format!("{name}(period = 4, size = 2, tolerance = 0.2);")).volume();
    check_volumes(&[
        ("sdf_sphere(2, tolerance = 0.04);", ball(2.0)),
        ("sdf_sphere(d = 4, tolerance = 0.04);", ball(2.0)),
        ("sdf_ellipsoid([1, 2, 3], tolerance = 0.1);", 6.0 * ball(1.0)),
        ("sdf_capsule(h = 3, r = 1, tolerance = 0.05);", 3.0 * PI + ball(1.0)),
        ("sdf_torus(2, 0.5, tolerance = 0.05);", PI * PI),
    ]);
    // By symmetry half of a box around a crossing of the gyroid is inside.
    assert!((periodic("sdf_gyroid") - 4.0).abs() < 0.1);
}

#[test]
fn what_has_plane_faces_is_not_searched_for() {
    let cases = [
        ("sdf_box([1, 2, 3]);", 6.0, 1e-14),
        ("sdf_octahedron(2);", 32.0 / 3.0, 1e-14),
        ("sdf_prism(n = 4, r = 2, h = 3);", 24.0, 1e-14),
        ("sdf_cylinder(h = 3, r = 2, tolerance = 1e-3);", 12.0 * PI, 1e-3),
        ("sdf_cone(h = 3, r1 = 2, tolerance = 1e-3);", 4.0 * PI, 1e-3),
        ("sdf_cone(h = 3, r1 = 2, r2 = 1, tolerance = 1e-3);", 7.0 * PI, 1e-3),
    ];
    for (text, expected, relative) in cases {
        assert!(built(text).report.meshings.is_empty(), "{text}");
        let volume = solid(text).volume();
        assert!((volume / expected - 1.0).abs() <= relative, "{text}: {volume} for {expected}");
    }
    let ring = solid("sdf_cylinder(h = 1, r = 2, tolerance = 0.01);");
    let sides = ring.positions().len() / 2;
    let chord = |n: usize| 2.0 * (1.0 - cos(PI / n as f64));
    assert!(chord(sides) <= 0.01 && chord(sides - 1) > 0.01, "{sides}");
}

#[test]
fn what_is_round_is_not_searched_for() {
    let cases = [
        ("sdf_sphere(2, tolerance = 1e-3);", ball(2.0)),
        ("sdf_ellipsoid([1, 2, 3], tolerance = 1e-3);", 6.0 * ball(1.0)),
        ("sdf_capsule(h = 3, r = 1, tolerance = 1e-3);", 3.0 * PI + ball(1.0)),
        ("sdf_torus(2, 0.5, tolerance = 1e-3);", PI * PI),
        ("sdf_rounded_box(4, r = 1, tolerance = 1e-3);", around_cube(2.0, 1.0)),
    ];
    for (text, expected) in cases {
        let built = built(text);
        let [meshing] = &built.report.meshings[..] else { panic!("{text}: one meshing") };
        let report = &meshing.report;
        assert!(
            report.cells == 0 && report.certified.is_some_and(|bound| bound <= 1e-3),
            "{text}: {report:?}"
        );
        let volume = solid(text).volume();
        assert!(volume < expected && volume > (1.0 - 2e-3) * expected, "{text}: {volume} for {expected}");
    }
}

#[test]
fn edges_of_primitives_are_rounded() {
    check_volumes(&[
        ("sdf_rounded_box(4, r = 1, tolerance = 0.05);", around_cube(2.0, 1.0)),
        ("round(1, tolerance = 0.05) cube(4);", around_cube(2.0, 1.0)),
        ("offset3d(1, tolerance = 0.05) cube(2, center = true);", around_cube(2.0, 1.0)),
        ("offset3d(-1, tolerance = 0.2) cube(4);", 8.0),
        ("shell(1, tolerance = 0.05) sphere(3, $fn = 6);", ball(3.5) - ball(2.5)),
    ]);
}

/// The volume around the z axis where a function of the distance from it and of the height is negative, by midpoints.
fn turned(inside: impl Fn(f64, f64) -> f64) -> f64 {
    const STEP: f64 = 0.005;
    let middle = |i: i32| (f64::from(i) + 0.5) * STEP;
    let row = |z: i32| (0..800).filter(|&x| inside(middle(x), middle(z)) < 0.0).map(middle).sum::<f64>();
    (-1000..1000).map(row).sum::<f64>() * 2.0 * PI * STEP * STEP
}

#[test]
fn fillets_are_as_they_are_defined() {
    let balls = |x: f64, z: f64| (hypot(x, z) - 2.0, hypot(x, z - 2.5) - 1.5);
    // Mercury, hg_sdf, 2015; Quilez, Smooth minimum, 2013, with the reach of the parabola sqrt 2 times its radius.
    let round = |a: f64, b: f64| if a.max(b) < 1.0 { 1.0 - hypot(1.0 - a, 1.0 - b) } else { a.min(b) };
    let reach = 2.0_f64.sqrt();
    let soft = |a: f64, b: f64| a.min(b) - (reach - (a - b).abs()).max(0.0).powi(2) / (4.0 * reach);
    let chamfer = |a: f64, b: f64| a.min(b).min((a + b - 1.0) / reach);
    let text = |call: &str| format!("{call} {{ sphere(2); translate([0, 0, 2.5]) sphere(1.5); }}");
    let texts = [
        "smooth_union(1, tolerance = 0.04)",
        "smooth_union(1, kind = \"soft\", tolerance = 0.04)",
        "smooth_union(1, kind = \"chamfer\", tolerance = 0.04)",
        "smooth_difference(1, tolerance = 0.04)",
        "smooth_intersection(0.5, tolerance = 0.02)",
    ]
    .map(text);
    let of = |field: &dyn Fn(f64, f64) -> f64| turned(|x, z| field(balls(x, z).0, balls(x, z).1));
    let tight = |a: f64, b: f64| 0.5 * round(2.0 * a, 2.0 * b);
    let volumes =
        [of(&round), of(&soft), of(&chamfer), of(&|a, b| -round(-a, b)), of(&|a, b| -tight(-a, -b))];
    for (text, expected) in texts.iter().zip(volumes) {
        let volume = solid(text).volume();
        assert!((volume / expected - 1.0).abs() < 0.02, "{text}: {volume} for {expected}");
    }
    // A fillet is a tenth of the whole, or so: the sharp union would be told apart.
    assert!((of(&|a: f64, b: f64| a.min(b)) / volumes[0] - 1.0).abs() > 0.03);
}

#[test]
fn a_shaft_on_a_plate_has_fillets() {
    let text = "$fe = 0.3; smooth_union(1.5) { cube([12, 12, 3], center = true); cylinder(h = 9, r = 3, center = true); }";
    check_volumes(&[(text, 144.0 * 3.0 + 54.0 * PI + 2.0 * ring(3.0, 1.5))]);
}

#[test]
fn flush_faces_stay_flat() {
    let tee =
        solid("$fe = 0.2; smooth_union(1) { cube([10, 4, 2]); translate([3, 0, 0]) cube([4, 10, 2]); }");
    let bounds = tee.bounds();
    assert!(bounds.min.min_element() > -1e-4 && bounds.max.z < 2.0 + 1e-4, "{bounds:?}");
    // Two edges are filled along the whole height, and only those.
    let expected = 80.0 + 48.0 + 2.0 * 2.0 * (1.0 - PI / 4.0);
    let near = |volume: f64| (expected - 5.0..expected + 0.3).contains(&volume);
    assert!(near(tee.volume()), "{} {expected}", tee.volume());
    let turned = solid(
        "$fe = 0.3; rotate([20, 30, 40]) smooth_union(1) { cube([10, 4, 2]); translate([3, 0, 0]) cube([4, 10, 2]); }",
    );
    assert!(near(turned.volume()), "{} {expected}", turned.volume());
}

#[test]
fn fields_and_meshes_mix_in_booleans() {
    let octant = "difference() { sdf_sphere(3, tolerance = 0.05); cube(10); }";
    let drilled = "difference() {
        smooth_union(1, tolerance = 0.2) { cube([12, 12, 3], center = true); cylinder(h = 9, r = 3, center = true); }
        cylinder(h = 20, r = 2, center = true, $fn = 4);
    }";
    check_volumes(&[
        (octant, 7.0 / 8.0 * ball(3.0)),
        (drilled, 144.0 * 3.0 + 54.0 * PI + 2.0 * ring(3.0, 1.0) - 8.0 * 9.0),
    ]);
    // Only what is blended becomes a field: the cut has the corners of its prism.
    let Shape::Solid(solid) = built(drilled).shape else { panic!("a solid") };
    let corners = solid.positions().iter().filter(|p| p.truncate().distance([2.0, 0.0].into()) < 1e-9);
    assert!(corners.clone().any(|p| p.z > 4.4) && corners.clone().any(|p| p.z < -4.4));
}

#[test]
fn meshes_extrusions_and_booleans_take_part_in_blends() {
    let tetrahedron = "polyhedron([[0,0,0],[2,0,0],[0,2,0],[0,0,2]], [[0,1,2],[0,3,1],[1,3,2],[0,2,3]])";
    let texts = [
        format!(
            "smooth_union(0.2, tolerance = 0.25) {{ {tetrahedron}; translate([4, 0, 0]) sphere(1, $fn = 8); }}"
        ),
        "smooth_union(0.2, tolerance = 0.1) { linear_extrude(2) square(2); translate([4, 0, 0]) sphere(1); }"
            .to_owned(),
        "smooth_union(0.2, tolerance = 0.1) {
             intersection() { cube(2); translate([1, 1, 1]) cube(2); }
             translate([4, 0, 0]) difference() { sphere(1); translate([0, -2, -2]) cube(4); }
         }"
        .to_owned(),
        "smooth_union(0.2, tolerance = 0.08) { scale([1, 1, 2]) sphere(1); translate([4, 0, 0]) sphere(1); }"
            .to_owned(),
        "scale(2) rotate([10, 20, 30]) smooth_union(0.3, tolerance = 0.05) {
             smooth_intersection(0.1) { sphere(1); translate([-3, -3, -3]) cube(6); }
             translate([0, 0, 4]) sphere(1);
         }"
        .to_owned(),
    ];
    let expected =
        [4.0 / 3.0 + ball(1.0), 8.0 + ball(1.0), 1.0 + ball(1.0) / 2.0, 3.0 * ball(1.0), 16.0 * ball(1.0)];
    let cases: Vec<(&str, f64)> = texts.iter().map(String::as_str).zip(expected).collect();
    check_volumes(&cases);
}

#[test]
fn offsets_of_what_has_no_exact_formula_go_by_its_mesh() {
    // The corner that the cut leaves is inward, and stays sharp from within: 8 - 1 and a layer of 0.5 around it.
    let text = "offset3d(0.5, tolerance = 0.3) difference() { cube(2); translate([1, 1, 1]) cube(2); }";
    let plan = explain(&recipe(text)).expect("a plan");
    assert!(plan.contains("only a bound of the distance, so meshed first"), "{plan}");
    let exact = explain(&recipe("offset3d(-0.1) difference() { cube(2); translate([1, 1, 1]) cube(2); }"));
    assert!(!exact.expect("a plan").contains("meshed first"));
}

#[test]
fn functions_become_formulas() {
    check_volumes(&[
        ("implicit(function(p) norm(p) - 2, tolerance = 0.05);", ball(2.0)),
        ("implicit(function(x, y, z) sqrt(x^2 + y^2 + z^2) - 2, tolerance = 0.05);", ball(2.0)),
        (
            "f = function(p, r) norm(p) - r; implicit(function(p) f(p - [1, 0, 0], 2), tolerance = 0.05);",
            ball(2.0),
        ),
        ("implicit(function(p) p * p - 4, [[-3, -3, -3], [3, 3, 3]], tolerance = 0.05);", ball(2.0)),
        // Cut off at its box.
        ("implicit(function(p) p.z - p.x, [[-1, -1, -1], [1, 1, 1]], tolerance = 0.1);", 4.0),
        // A matrix, a loop, and a function that calls itself a known number of times.
        (
            "turn = [[0, -1, 0], [1, 0, 0], [0, 0, 1]];
             product = function(v, i = 0) i == 3 ? 0 : v[i] * v[i] + product(v, i + 1);
             implicit(function(p) sqrt(product(turn * p)) - 2, tolerance = 0.05);",
            ball(2.0),
        ),
        ("implicit(function(p) max([for (i = [0:2]) abs(p[i])]) - 1, tolerance = 0.15);", 8.0),
    ]);
}

#[test]
fn all_functions_of_numbers_can_be_traced() {
    // At a point of the surface the formula has the value that the language computes there.
    let terms = [
        "abs(x) + sign(y)",
        "sin(40 * x) + cos(30 * y) + tan(10 * z)",
        "asin(x / 9) + acos(y / 9) + atan(z)",
        "atan2(y, x)",
        "floor(x) + ceil(y) + round(z)",
        "ln(x) + log(y) + exp(z)",
        "pow(x, 1.5) + sqrt(y)",
        "max(x, y, z) - min([x, y, z])",
        "norm([x, y, z])",
        "cross([x, y, z], [1, 2, 3])[0]",
        "-x % 0.3 + y % z",
        "x > 1 && y < 2 ? x : y",
        "x > 1 || y < 1 ? x : y",
        "!(x >= 1) ? z : x",
        "x == y ? 1 : 2",
        "x != y ? 1 : 2",
        "x <= 1.25 ? [x, y][0] : 5",
        "[x, y] * [[1, 2], [3, 4]] * [1, 1]",
        "([[x, 1], [y, 2]] * [[1, 0], [0, z]])[1][1]",
        "(x + y) / z",
        "2 ^ x",
        "is_num(x) ? 3 : x",
    ];
    for term in terms {
        let point = "x = 1.25; y = 1.5; z = 0.75;";
        let text = format!("{point} echo({term});");
        let (_, complaints) = evaluate(&text);
        assert!(complaints.is_empty(), "{term}: {complaints:?}");
        let value = echoed(&text);
        let traced = format!("implicit(function(x, y, z) ({term}) - ({value}), [[0, 0, 0], [2, 2, 2]]);");
        let recipe = recipe(&traced);
        let csg::Csg::Body(csg::Body::Field(body)) = &*recipe else { panic!("{term}: {recipe:?}") };
        let csg::FieldShape::Formula { formula, .. } = &body.shape else { panic!("{term}") };
        let left = formula.expr().eval([1.25, 1.5, 0.75].into());
        // Six digits are echoed.
        let size = value.parse::<f64>().map_or(1.0, |value| value.abs().max(1.0));
        assert!(left.abs() < 1e-5 * size, "{term}: {left}");
    }
}

/// What a script echoes, as a number.
fn echoed(text: &str) -> String {
    struct Ear(String);
    impl Host for Ear {
        fn script(&mut self, _: &str, _: &str) -> Result<Loaded, String> {
            Err(String::new())
        }
        fn mesh(&mut self, _: &str, _: &str) -> Result<Arc<Mesh>, String> {
            Err(String::new())
        }
        fn say(&mut self, message: Message) {
            self.0 = message.text;
        }
    }
    let mut ear = Ear(String::new());
    let main = Loaded { name: "a.scad".into(), text: text.into() };
    script::evaluate(main, &mut ear, &Options::default()).expect("a script");
    ear.0
}

#[test]
fn what_cannot_be_traced_is_an_error_at_its_place() {
    let cases = [
        ("implicit(function(p) [1, 2, 3][p.x]);", "an index depends on a coordinate", "[1, 2, 3][p.x]"),
        ("implicit(function(p) len([for (i = [0:p.x]) i]));", "an end of a range", "[0:p.x]"),
        ("implicit(function(p) max([for (i = [0:2]) if (p[i] > 0) i]));", "this condition", "p[i] > 0"),
        ("implicit(function(p) assert(p.x > 0) p.x);", "this condition", "p.x > 0"),
        ("implicit(function(p) len(p.x));", "len(): ", "len(p.x)"),
        ("implicit(function(p) lookup(p.x, [[0, 0], [1, 1]]));", "lookup(): ", "lookup("),
        ("implicit(function(p) p == [0, 0, 0] ? 1 : 2);", "whether coordinates are equal", "p == [0"),
        ("implicit(function(p) p.x & 3);", "the bits of a coordinate", "p.x & 3"),
        ("implicit(function(p) p.x + \"a\");", "formula + string", "p.x + \"a\""),
        ("implicit(function(p) len(str(p)));", "the text of str() depends on a coordinate", "str(p)"),
        ("implicit(function(p) p.x > 0 ? [1] : 2);", "by a coordinate", "p.x > 0 ?"),
    ];
    for (text, message, place) in cases {
        let (recipe, complaints) = evaluate(text);
        let at = text.find(place).expect("a place");
        assert!(recipe.is_none(), "{text}");
        let last = complaints.last().expect("a complaint");
        assert!(last.contains(message) && last.contains("cannot be traced"), "{text}: {last}");
        assert!(last.starts_with(&format!("Error at {at}:")), "{text}: {last}");
    }
    let whole = [
        ("implicit(function(p) p);", "the function must give a number, not [formula, formula, formula]"),
        ("implicit(function(p) undef);", "the function must give a number, not undef"),
        ("implicit(function(a, b) a);", "not 2"),
        ("implicit(function(p) p.x);", "where this ends is not known"),
        ("g = function(x) g(x) + 1; implicit(function(p) g(p.x));", "calls are nested more than"),
        ("g = function(x) x > 0 ? g(x - 1) + 1 : 0; implicit(function(p) g(p.x));", "nested"),
    ];
    for (text, message) in whole {
        let (recipe, complaints) = evaluate(text);
        assert!(
            recipe.is_none() && complaints.iter().any(|said| said.contains(message)),
            "{text}: {complaints:?}"
        );
    }
}

#[test]
fn nonsense_is_said_and_leaves_what_can_be_left() {
    let nothing = [
        ("sdf_sphere(-1);", "the radius must be positive and finite, it is -1"),
        ("sdf_sphere(0/0);", "it is NaN"),
        ("sdf_sphere(\"a\");", "r must be a number, not \"a\""),
        ("sdf_sphere(1/0);", "it is inf"),
        ("sdf_box([1, 2]);", "size must be a number or three, not [1, 2]"),
        ("sdf_box([1, 0, 1]);", "the half side must be positive"),
        ("sdf_rounded_box(2, r = 3);", "from 0 to the least half side"),
        ("sdf_cylinder(h = -1);", "the half height must be positive"),
        ("sdf_cylinder(h = 1, r = 1, rounding = 2);", "the rounding must be"),
        ("sdf_capsule(h = -1);", "the half length must be"),
        ("sdf_cone(h = 1, r1 = 0, r2 = 0);", "the larger radius must be positive"),
        ("sdf_torus(1, -1);", "the radius of the tube must be positive"),
        ("sdf_ellipsoid([1, 1, 0]);", "the half-axis must be positive"),
        ("sdf_octahedron(undef, tolerance = -1);", "tolerance must be a positive number, not -1"),
        ("sdf_prism(n = 2.5);", "the number of sides must be from 3"),
        ("sdf_prism(n = 1e9);", "the number of sides must be from 3"),
        ("sdf_gyroid(period = 0);", "the period must be positive"),
        ("sdf_gyroid(period = 1, thickness = -1);", "the thickness must be positive"),
        ("sdf_gyroid(period = 1, bounds = [[0, 0, 0], [1, 1, 0]]);", "bounds must be two corners"),
        ("sdf_metaballs();", "balls must be a list of balls"),
        ("sdf_metaballs([[[0, 0], 1]]);", "balls[0] must be"),
        ("sdf_metaballs([]);", "the number of balls must be 1 or more"),
        ("implicit();", "f must be a function of a point"),
        ("implicit(3);", "f must be a function of a point"),
        ("implicit(function(p) norm(p) - 1, bounds = 3);", "bounds must be two corners"),
        ("implicit(function(p) norm(p) + 1);", "nowhere negative"),
    ];
    for (text, message) in nothing {
        let (recipe, complaints) = evaluate(text);
        assert!(complaints.iter().any(|said| said.contains(message)), "{text}: {complaints:?}");
        assert_eq!(recipe.expect("a recipe").dimension(), None, "{text}");
    }
    // Operators leave their children as they are.
    let plain = [
        ("smooth_union() { cube(1); cube(2); }", "r must be a finite number, 0 or more, not undef"),
        ("smooth_union(-1) { cube(1); cube(2); }", "not -1"),
        ("smooth_union(0/0) { cube(1); cube(2); }", "not nan"),
        ("smooth_difference(\"a\") { cube(2); cube(1); }", "not \"a\""),
        (
            "smooth_intersection(1, tolerance = 0) { cube(2); cube(1); }",
            "tolerance must be a positive number",
        ),
        ("shell(-1) cube(1);", "t must be a finite number, 0 or more"),
        ("round(1/0) cube(1);", "not inf"),
        ("offset3d([1]) cube(1);", "r must be a finite number, not [1]"),
    ];
    for (text, message) in plain {
        let (recipe, complaints) = evaluate(text);
        assert!(complaints.iter().any(|said| said.contains(message)), "{text}: {complaints:?}");
        let built = csg::build(&recipe.expect("a recipe"), &BuildOptions::default()).expect("a shape");
        assert!(built.report.meshings.is_empty(), "{text}");
        assert!(matches!(built.shape, Shape::Solid(solid) if solid.volume() > 0.9), "{text}");
    }
    let (_, complaints) = evaluate("smooth_union(1, kind = \"wavy\") { cube(1); cube(2); }");
    assert!(complaints[0].contains("kind must be \"round\", \"soft\" or \"chamfer\""), "{complaints:?}");
    let (_, complaints) = evaluate("smooth_unoin(1) cube(1);");
    assert!(complaints[0].contains("unknown module"), "{complaints:?}");
}

#[test]
fn empty_and_plane_children() {
    let volume = |text: &str| {
        let (recipe, complaints) = evaluate(text);
        let built = csg::build(&recipe.expect("a recipe"), &BuildOptions::default()).expect("a shape");
        let Shape::Solid(solid) = built.shape else { panic!("{text}: flat") };
        (solid.volume(), complaints.len())
    };
    for text in [
        "smooth_union(1);",
        "smooth_difference(1) { union() {} cube(1); }",
        "smooth_intersection(1) { cube(1); union() {} }",
        "smooth_intersection(0.1) { cube(1); translate([9, 0, 0]) cube(1); }",
        "shell(1);",
        "offset3d(-3) cube(2);",
        "round(1) scale(0) cube(1);",
    ] {
        assert_eq!(volume(text).0, 0.0, "{text}");
    }
    // One child is itself, as it is.
    assert_eq!(volume("smooth_union(1) cube(2);"), (8.0, 0));
    assert_eq!(volume("smooth_union(1) { union() {} cube(2); }"), (8.0, 0));
    assert_eq!(volume("smooth_union(0) { cube(2); cube(1); }"), (8.0, 0));
    // Plane shapes have no distance in space.
    assert_eq!(volume("smooth_union(1) { cube(2); square(3); }"), (8.0, 1));
    assert_eq!(volume("smooth_union(1) { square(3); circle(3); }"), (0.0, 1));
    assert_eq!(volume("shell(1) square(3);"), (0.0, 1));
}

#[test]
fn tolerances_decide_how_many_triangles_there_are() {
    let count = |text: &str| solid(text).triangles().len();
    let (coarse, fine) = (count("$fe = 0.2; sdf_torus(2, 1);"), count("$fe = 0.05; sdf_torus(2, 1);"));
    assert!(2 * fine > 3 * coarse, "{coarse} {fine}");
    assert_eq!(count("sdf_torus(2, 1, tolerance = 0.2, $fe = 0.01);"), coarse);
    assert!(count("sdf_torus(2, 1, $fn = 20);") > count("sdf_torus(2, 1, $fn = 8);"));
}

#[test]
fn errors_are_told_in_model_units() {
    let text = "scale(3) rotate(20) sdf_torus(2, 1, tolerance = 0.3); translate([30, 0, 0]) sdf_torus(2, 1, tolerance = 0.3);";
    let built = built(text);
    // Made once, used at both sizes: the larger one counts.
    let errors: Vec<f64> = built.report.meshings.iter().map(|meshing| meshing.error).collect();
    assert!(errors.len() == 1 && (errors[0] - 0.9).abs() < 1e-12, "{errors:?}");
}

#[test]
fn tolerances_beyond_reason_end_soon() {
    let limited = BuildOptions { max_triangles: 2_000, ..BuildOptions::default() };
    let refused = |text: &str| csg::build(&recipe(text), &limited).expect_err(text);
    assert!(matches!(
        refused("sdf_sphere(1, tolerance = 1e-7);"),
        BuildError::Meshing(IsoError::TooManyCells { .. }) | BuildError::Limit { .. }
    ));
    assert!(matches!(
        refused("sdf_sphere(1, tolerance = 1e-30);"),
        BuildError::Meshing(IsoError::TooFine { .. })
    ));
    assert!(matches!(refused("round(5) cube(4);"), BuildError::Field(_)));
    // A tolerance larger than the shape makes a coarse shape, and no failure.
    let coarse = solid("sdf_sphere(1, tolerance = 50);");
    assert!(coarse.triangles().len() < 2_000);
}

#[test]
fn too_much_in_one_field_is_refused() {
    let many = "smooth_union(1, tolerance = 1) for (i = [0:70000]) translate([3 * i, 0, 0]) sphere(1);";
    // A loop is one child, the union of what it makes.
    let (recipe, _) = evaluate(many);
    let many = csg::Csg::Blend {
        op: ogee::boolean::Op::Union,
        blend: ogee::sdf::Blend::Circular { radius: 1.0 },
        tolerance: 1.0,
        children: vec![recipe.clone().expect("a recipe"), recipe.expect("a recipe")],
    };
    let error = csg::build(&many, &BuildOptions::default()).expect_err("too many");
    assert!(matches!(error, BuildError::TooManyShapes { .. }), "{error}");
    let mut deep = Arc::new(csg::Csg::Body(csg::Body::Sphere { radius: 1.0, fragments: 6 }));
    let other = deep.clone();
    for _ in 0..300 {
        deep = Arc::new(csg::Csg::Blend {
            op: ogee::boolean::Op::Union,
            blend: ogee::sdf::Blend::Circular { radius: 0.1 },
            tolerance: 0.5,
            children: vec![deep, other.clone()],
        });
    }
    let error = csg::build(&deep, &BuildOptions::default()).expect_err("too deep");
    assert!(matches!(error, BuildError::TooDeep { .. }), "{error}");
}

#[test]
fn recipes_print_and_read_back() {
    let texts = [
        "smooth_union(0.5, tolerance = 0.1) { cube(1); sphere(1); }",
        "smooth_difference(0.5, kind = \"soft\", tolerance = 0.1) { cube(1); sphere(1); }",
        "smooth_intersection(0.5, kind = \"chamfer\", tolerance = 0.1) { cube(1); sphere(1); }",
        "offset3d(-0.1, tolerance = 0.1) cube(1);",
        "shell(0.1, tolerance = 0.1) cube(1);",
        "round(0.1, tolerance = 0.1) cube(1);",
        "sdf_sphere(2);",
        "sdf_ellipsoid([1, 2, 3]);",
        "sdf_box([1, 2, 3]);",
        "sdf_rounded_box([1, 2, 3], r = 0.25);",
        "sdf_cylinder(h = 3, r = 2, rounding = 0.5);",
        "sdf_capsule(h = 3, r = 2);",
        "sdf_cone(h = 3, r1 = 2, r2 = 1);",
        "sdf_torus(3, 1);",
        "sdf_octahedron(2);",
        "sdf_prism(n = 5, r = 2, h = 3);",
        "sdf_gyroid(period = 2, size = [1, 2, 3]);",
        "sdf_schwarz_p(period = 2, thickness = 0.25);",
        "sdf_diamond(period = 2);",
        "sdf_neovius(period = 2);",
        "sdf_iwp(period = 2, bounds = [[0, 0, 0], [1, 1, 1]]);",
        "sdf_metaballs([[[0, 0, 0], 1], [[1, 0, 0], 1, 0.75]], threshold = 0.25);",
    ];
    for text in texts {
        let first = recipe(text);
        let printed = print(&first);
        assert_eq!(recipe(&printed), first, "{printed}");
    }
    // Formulas keep their values, though not their every operation.
    let first = recipe(
        "implicit(function(p) p.x < 0 ? sin(p.y * 90) + norm(p) % 0.7 : atan2(p.y, p.z) - ln(p.x + 3),
                  [[-1, -1, -1], [1, 1, 1]]);",
    );
    let again = recipe(&print(&first));
    let formula = |recipe: &csg::Csg| match recipe {
        csg::Csg::Body(csg::Body::Field(body)) => match &body.shape {
            csg::FieldShape::Formula { formula, .. } => formula.expr().clone(),
            _ => panic!("no formula"),
        },
        _ => panic!("no field"),
    };
    for point in [[0.3, 0.4, 0.5], [-0.3, 0.4, -0.9], [-1.0, -1.0, 1.0]] {
        let [a, b] = [&first, &again].map(|recipe| formula(recipe).eval(point.into()));
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn plans_are_told_in_words() {
    let text = "difference() {
        smooth_union(2, tolerance = 0.1) {
            cube(20);
            for (i = [0:3]) translate([5 * i, 0, 0]) cylinder(h = 30, r = 2);
            difference() { sphere(3); linear_extrude(3) square(1); }
            hull() { cube(1); translate([9, 9, 9]) cube(1); }
            scale([1, 1, 2]) sphere(1);
        }
        translate([1, 1, 1]) cube(5);
        round(1, tolerance = 0.25) union() { cube(3); translate([1, 0, 0]) cube(4); }
    }";
    let told = explain(&recipe(text)).expect("a plan");
    let expected = "\
difference of 3 parts: exact boolean of their meshes
  smooth_union of 5 parts, r = 2: one field, meshed within 0.1
    cube: exact distance, by formula
    union of 4 parts: minimum of fields
      4 times cylinder: exact distance, by formula, truly round
    difference of 2 parts: maximum of fields, those taken away negated
      sphere: exact distance, by formula, truly round
      linear_extrude: exact distance from its outline
    hull: distance from its mesh
    sphere: exact distance, by formula, truly round
  cube: mesh
  round, r = 1: one field, meshed within 0.25
    its formula is only a bound of the distance, so meshed first
      offset3d, r = -1: by its values
        its formula is only a bound of the distance, so meshed first
          union of 2 parts: minimum of fields
            2 times cube: exact distance, by formula
";
    assert_eq!(told, expected);
    assert_eq!(explain(&recipe("")).expect("a plan"), "nothing\n");
}

/// Runs the program in a folder.
fn ogee(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ogee"))
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .expect("the program runs")
}

#[test]
fn the_program_tells_what_was_meshed() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("blob.scad", "smooth_union(1) { sphere(2); translate([3, 0, 0]) sphere(2); } cube(1);");
    write("cut.scad", "implicit(function(p) p.z, [[-1, -1, -1], [1, 1, 1]]);");
    write("bad.scad", "implicit(function(p) p.x + len(p.y));");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();

    let done = ogee(folder.path(), "build blob.scad --explain");
    assert!(done.status.success());
    assert!(
        text(&done.stdout).contains("smooth_union of 2 parts, r = 1: one field"),
        "{}",
        text(&done.stdout)
    );

    let done = ogee(folder.path(), "build blob.scad --tolerance 0.2 -o one.obj --jobs 1 --summary json");
    assert!(done.status.success(), "{}", text(&done.stderr));
    let summary: serde_json::Value = serde_json::from_slice(&done.stdout).expect("JSON");
    assert_eq!(summary["closed"], true);
    assert_eq!(summary["fields"]["meshed"], 1);
    assert_eq!(summary["fields"]["error bound"], 0.2);
    assert_eq!(summary["fields"]["capped"], 0);
    assert_eq!(summary["fields"]["uncertified"], 0);
    for stage in ["evaluate", "build", "bounds", "refine", "extract", "certify"] {
        assert!(summary["seconds"][stage].is_number(), "{stage}: {summary}");
    }
    assert!(ogee(folder.path(), "build blob.scad --tolerance 0.2 -o two.obj --jobs 2").status.success());
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect("a mesh");
    assert!(read("one.obj") == read("two.obj"), "threads change bits");

    let done = ogee(folder.path(), "build cut.scad --tolerance 0.2 -o cut.obj --summary text");
    assert!(
        text(&done.stderr).contains("the shape leaves the box and is cut off there"),
        "{}",
        text(&done.stderr)
    );
    assert!(text(&done.stdout).contains("fields       meshed 1"), "{}", text(&done.stdout));

    let done = ogee(folder.path(), "build bad.scad -o bad.obj");
    assert_eq!(done.status.code(), Some(1));
    let said = text(&done.stderr);
    assert!(said.contains("bad.scad:1:28") && said.contains("cannot be traced into a formula"), "{said}");
}
