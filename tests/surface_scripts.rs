//! Explicit surfaces in scripts and in the program: recipes, booleans, files.

use ogee::csg::{self, BuildOptions, Shape, print};
use ogee::mesh::{Defects, Mesh, Solid};
use ogee::script::{self, Host, Loaded, Message, Severity};
use ogee::surface::Patch;
use std::f64::consts::PI;
use std::fs;
use std::process::Command;
use std::sync::Arc;

/// A host that has the teapot and writes down complaints.
#[derive(Default)]
struct Kitchen {
    complaints: Vec<String>,
}

impl Host for Kitchen {
    fn script(&mut self, name: &str, _: &str) -> Result<Loaded, String> {
        Err(format!("{name} is not needed"))
    }

    fn mesh(&mut self, name: &str, _: &str) -> Result<Arc<Mesh>, String> {
        Err(format!("{name} is not needed"))
    }

    fn patches(&mut self, name: &str, _: &str) -> Result<Vec<Patch>, String> {
        let bytes = fs::read(format!("fixtures/patches/{name}")).map_err(|error| error.to_string())?;
        ogee::io::bpt::read(&bytes).map_err(|error| error.to_string())
    }

    fn say(&mut self, message: Message) {
        if message.severity != Severity::Echo {
            self.complaints.push(message.text);
        }
    }
}

/// The recipe of a script, and what it complains of.
fn evaluated(text: &str) -> (Arc<csg::Csg>, Vec<String>) {
    let mut host = Kitchen::default();
    let main = Loaded { name: "a.scad".into(), text: text.into() };
    let evaluated = script::evaluate(main, &mut host, &script::Options::default());
    (
        evaluated.unwrap_or_else(|failure| panic!("{text}: {failure:?} {:?}", host.complaints)).recipe,
        host.complaints,
    )
}

fn solid(text: &str) -> Solid {
    let (recipe, complaints) = evaluated(text);
    assert!(complaints.is_empty(), "{text}: {complaints:?}");
    let built =
        csg::build(&recipe, &BuildOptions::default()).unwrap_or_else(|error| panic!("{text}: {error}"));
    let Shape::Solid(solid) = built.shape else { panic!("{text}: flat") };
    assert!(Defects::of(solid.mesh()).is_solid());
    solid
}

#[test]
fn volumes_are_as_they_should_be() {
    let cases = [
        // A plate over a flat patch, and over a bow.
        ("bezier_patch([[[0,0,0],[0,4,0]],[[3,0,0],[3,4,0]]], thickness = 0.5);", 6.0, 1e-9),
        ("revolve([[1,0],[2,0],[2,1],[1,1]], closed = true, tolerance = 1e-4);", 3.0 * PI, 1e-3),
        ("revolve([[1,0],[2,0],[2,1],[1,1]], closed = true, angle = 90, tolerance = 1e-4);", 0.75 * PI, 1e-3),
        ("tube([[0,0,0],[0,0,5]], r = 1, kind = \"line\", tolerance = 1e-4);", 5.0 * PI, 1e-3),
        (
            "sweep([[0,0,0],[0,0,3]], [[0,0],[2,0],[2,1],[0,1]], kind = \"line\", tolerance = 1e-3);",
            6.0,
            1e-6,
        ),
        (
            "ring = [for (a = [0:30:359]) [cos(a), sin(a)]];
             loft([for (z = [0:3]) [for (p = ring) [p[0], p[1], z]]], tolerance = 1e-3);",
            3.0 * PI,
            0.02,
        ),
        // Half a pipe gets two half discs and a rectangle; a wedge of a lathe two sections that meet on the axis.
        ("revolve([[1,0],[1,5]], angle = 180, kind = \"line\", tolerance = 1e-3);", 2.5 * PI, 2e-3),
        ("revolve([[0,0],[1,0],[1,1],[0,1]], angle = 20, kind = \"line\", tolerance = 1e-3);", PI / 18.0, 2e-3),
        // A side on the axis is none of the surface.
        ("revolve([[0,0],[1,0],[1,1],[0,1]], closed = true, kind = \"line\", tolerance = 1e-3);", PI, 2e-3),
        // Mitred: the section goes all the way.
        (
            "sweep([[0,0,0],[5,0,0],[5,5,0],[5,5,5]], 0.5*[[-1,-1],[1,-1],[1,1],[-1,1]], kind = \"line\", tolerance = 0.01);",
            15.0,
            1e-9,
        ),
        (
            "sweep([[0,0,0],[5,0,0],[5,5,0],[0,5,0]], 0.5*[[-1,-1],[1,-1],[1,1],[-1,1]], closed = true, kind = \"line\", tolerance = 0.01);",
            20.0,
            1e-9,
        ),
        ("tube([[0,0,0],[5,0,0],[5,5,0]], r = 0.5, kind = \"line\", tolerance = 1e-3);", 2.5 * PI, 4e-3),
        // Formulas: sides that meet are joined, poles are points, matrices and conditions without branches work.
        (
            "parametric(function(u, v) [(3 + cos(v)) * cos(u), (3 + cos(v)) * sin(u), sin(v)],
                 u = [0, 360], v = [0, 360], tolerance = 1e-3);",
            6.0 * PI * PI,
            2e-3,
        ),
        (
            "parametric(function(u, v) 2 * [cos(v) * cos(u), cos(v) * sin(u), sin(v)],
                 u = [0, 360], v = [-90, 90], tolerance = 1e-3);",
            32.0 / 3.0 * PI,
            2e-3,
        ),
        (
            "function turn(a) = [[cos(a), -sin(a), 0], [sin(a), cos(a), 0], [0, 0, 1]];
             parametric(function(u, v) turn(30 * v) * [2 * cos(u), sin(u), v],
                 u = [0, 360], v = [0, 3], tolerance = 1e-3);",
            6.0 * PI,
            2e-3,
        ),
        (
            "f = function(u, v, lift = 0) [u, v, max(0, norm([u, v]) - 1, min(u, v) - 9) + lift + (-7 % 3) + 1];
             parametric(f, u = [2, 3], v = [0, 1], thickness = 0.01, tolerance = 1e-4);",
            0.01414,
            1e-3,
        ),
    ];
    for (text, expected, tolerance) in cases {
        let volume = solid(text).volume();
        assert!((volume / expected - 1.0).abs() < tolerance, "{text}: {volume} for {expected}");
    }
}

#[test]
fn tolerances_come_from_the_argument_or_from_special_variables() {
    let count = |text: &str| solid(text).triangles().len();
    let tube = |more: &str| format!("{more} tube([[0,0,0],[0,5,5],[5,5,5]], r = 1);");
    let (coarse, fine) = (count(&tube("$fe = 0.1;")), count(&tube("$fe = 0.01;")));
    assert!(fine > 5 * coarse, "{coarse} {fine}");
    assert_eq!(count("tube([[0,0,0],[0,5,5],[5,5,5]], r = 1, tolerance = 0.01, $fe = 1);"), fine);
    assert!(count(&tube("$fn = 60;")) > count(&tube("$fn = 12;")));
}

#[test]
fn a_teapot_less_a_cube_is_closed() {
    let whole = solid("bezier_surface(file = \"teapot.bpt\", tolerance = 0.05);");
    let cut = solid(
        "difference() { bezier_surface(file = \"teapot.bpt\", tolerance = 0.05); translate([0, 0, -1]) cube(5); }",
    );
    // A quarter is gone but for what handle and spout add to their sides.
    assert!(cut.volume() < 0.8 * whole.volume() && cut.volume() > 0.7 * whole.volume());
    assert_eq!(whole.measures().components, 1);
    // Lid, body, handle and spout are one: about 20 in volume without the spout.
    assert!((15.0..30.0).contains(&whole.volume()), "{}", whole.volume());
    let boxed = whole.bounds();
    assert!((boxed.max.z - 3.15).abs() < 0.06 && boxed.min.z.abs() < 0.06);
}

#[test]
fn recipes_print_and_read_back() {
    let texts = [
        "bezier_patch([[[0,0,0],[0,4,1]],[[3,0,0],[3,4,0.1]]], thickness = 0.5);",
        "revolve([[1,0],[2,0],[2,1],[1,1]], angle = 90, start = 30, closed = true, tolerance = 0.01);",
        "tube([[0,0,0],[0,5,5],[5,5,5]], r = 1, closed = true, tolerance = 0.05);",
        "sweep([[0,0,0],[0,0.5,3]], [[0,0],[2,0],[2,1]], twist = 30, scale = 2, tolerance = 0.05);",
        "parametric(function(u, v) [(3 + cos(v) ^ 2) * cos(u), sqrt(9 + cos(v)) * sin(u), atan2(sin(v), 3) / 9 + exp(0.1 * sin(v))],
             u = [0, 360], v = [0, 360], tolerance = 0.05);",
    ];
    for text in texts {
        let (recipe, complaints) = evaluated(text);
        assert!(complaints.is_empty(), "{complaints:?}");
        let printed = print(&recipe);
        let (again, complaints) = evaluated(&printed);
        assert!(complaints.is_empty(), "{printed}: {complaints:?}");
        let volume = |recipe: &csg::Csg| match csg::build(recipe, &BuildOptions::default()).unwrap().shape {
            Shape::Solid(solid) => solid.volume(),
            Shape::Region(_) => panic!("flat"),
        };
        assert!((volume(&recipe) / volume(&again) - 1.0).abs() < 1e-3, "{printed}");
    }
}

#[test]
fn what_is_wrong_is_said() {
    let cases = [
        ("bezier_patch([[[0,0,0]],[[0,0,1],[1,1,1]]]);", "the rows of a patch differ in length"),
        ("bezier_patch(3);", "a patch is a list of rows of points"),
        ("bezier_surface();", "needs a list of patches, or a file"),
        ("bezier_surface([[[[0,0,0]]], [[[0,0,\"a\"]]]]);", "patches[1]: a control point is three numbers"),
        ("bezier_surface([], close = false);", "needs a thickness"),
        ("revolve([[-1,0],[1,0],[1,1]]);", "must not be negative"),
        ("tube([[0,0,0],[1,0,0]], r = -1);", "must be positive"),
        ("tube([[0,0],[1,0]], r = 1);", "the points must have 3 coordinates"),
        ("tube([[0,0,0],[1,0,0],[2,1,0]], kind = \"wavy\");", "there is no kind"),
        ("loft([[[0,0,0],[1,0,0],[0,1,0]]]);", "1 points where 2 are needed"),
        ("sweep([[0,0,0],[0,0,1]], [[0,0],[1,0],[0,1]], scale = 0);", "scale is 0"),
        ("tube([[0,0,0],[0,0,1]], tolerance = -1);", "tolerance must be a positive number"),
        ("sphere(2, tolerance = 0);", "tolerance must be a positive number"),
        (
            "linear_extrude(2, twist = 90, tolerance = \"a\") square(1);",
            "tolerance must be a positive number",
        ),
        ("tube([[0,0,0],[1,0,0],[0,0,0]], kind = \"line\");", "the path turns back on itself"),
        ("parametric(3);", "parametric needs a function"),
        ("parametric(function(u, v) [u, v]);", "must give three numbers, not [formula, formula]"),
        ("parametric(function(u, v) [u, v, \"u\"]);", "must give three numbers"),
        (
            "parametric(function(u, v) [u, v, 0], u = [1, 0]);",
            "u must be a range [from, to] of finite numbers",
        ),
    ];
    for (text, expected) in cases {
        let (_, complaints) = evaluated(text);
        assert!(complaints.iter().any(|complaint| complaint.contains(expected)), "{text}: {complaints:?}");
    }
}

#[test]
fn what_depends_on_parameters_decides_nothing() {
    let texts = [
        "parametric(function(u, v) u < 0.5 ? [u, v, 0] : [u, v, u]);",
        "parametric(function(u, v) [u, v, u ? 1 : 0]);",
        "parametric(function(u, v) [u, v, v == 1 ? 1 : 0]);",
        "parametric(function(u, v) [u, v, u && v ? 1 : 0]);",
        "parametric(function(u, v) [u, v, !u ? 1 : 0]);",
        "parametric(function(u, v) [u, v, len([for (x = [u]) if (x) x])]);",
    ];
    for text in texts {
        let mut host = Kitchen::default();
        let main = Loaded { name: "a.scad".into(), text: text.into() };
        let failure = script::evaluate(main, &mut host, &script::Options::default()).unwrap_err();
        assert_eq!(failure, script::Failure::Error, "{text}");
        assert!(host.complaints.iter().any(|said| said.contains("depends on the parameters")), "{text}");
    }
}

#[test]
fn caps_that_enclose_nothing_are_an_error() {
    let texts = [
        "bezier_patch([[[0,0,0],[0,4,0]],[[3,0,0],[3,4,0]]]);",
        "parametric(function(u, v) [u, v, 1e-4 * u * v], tolerance = 0.01);",
    ];
    for text in texts {
        let (recipe, complaints) = evaluated(text);
        assert!(complaints.is_empty(), "{complaints:?}");
        let error = csg::build(&recipe, &BuildOptions::default()).unwrap_err();
        assert!(error.to_string().contains("enclose nothing"), "{text}: {error}");
    }
}

/// The largest of a measure over 28 points of every triangle.
/// Profiles that reach the middle of their path and beyond fold the surface; they once were halved without end, or cut
/// into triangles without any width.
#[test]
fn sweeps_that_fold_are_followed() {
    let ring =
        |step: u32, radius: f64| format!("[for (a = [0:{step}:359]) [{radius} * cos(a), {radius} * sin(a)]]");
    let sweep = |path: &str, profile: &str, rest: &str| {
        solid(&format!(
            "sweep([for (p = {path}) [p.x, p.y, 0]], closed = true, profile = {profile}, {rest});"
        ))
    };
    for (step, profile_step, radius, rest) in [
        (90, 120, 2.5, "tolerance = 0.05, twist = 90, kind = \"catmull-rom\""),
        (90, 45, 5.15, "tolerance = 0.05"),
        (60, 45, 5.0, "tolerance = 0.1, twist = 90, kind = \"catmull-rom\""),
    ] {
        let solid = sweep(&ring(step, 5.0), &ring(profile_step, radius), rest);
        let reach = largest(&solid, ogee::math::Vec3::length);
        // Some point of the profile leans outward by half its distance from the path.
        assert!(
            solid.volume() > 100.0 && reach > 4.9 + 0.5 * radius && reach < 12.0,
            "{radius} {rest}: {reach}"
        );
    }
}

fn largest(solid: &Solid, measure: impl Fn(ogee::math::Vec3) -> f64) -> f64 {
    let mesh = solid.mesh();
    let mut most: f64 = 0.0;
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t);
        for k in 0..49 {
            let (i, j) = (f64::from(k / 7) / 6.0, f64::from(k % 7) / 6.0);
            if i + j <= 1.0 {
                most = most.max(measure(a + i * (b - a) + j * (c - a)));
            }
        }
    }
    most
}

#[test]
fn curved_primitives_keep_their_tolerance() {
    for tolerance in [0.3, 0.02, 0.003] {
        for how in [format!("tolerance = {tolerance}, $fn = 5"), format!("$fe = {tolerance}")] {
            let ball = solid(&format!("sphere(2, {how});"));
            let off = largest(&ball, |p| 2.0 - p.length());
            assert!(off <= tolerance && off > 0.4 * tolerance, "{how}: {off}");
            let rod = solid(&format!("cylinder(h = 3, r = 2, {how}, center = true);"));
            let off = largest(&rod, |p| if p.z.abs() < 1.4 { 2.0 - p.truncate().length() } else { 0.0 });
            assert!(off <= tolerance * (1.0 + 1e-9) && off > 0.4 * tolerance, "{how}: {off}");
            let disc = solid(&format!("linear_extrude(1) circle(d = 4, {how});"));
            assert!(4.0 * PI - disc.volume() <= 4.0 * PI * tolerance, "{how}: {}", disc.volume());
            let ring = solid(&format!("rotate_extrude(angle = 100, {how}) translate([1, 0]) square(1);"));
            let (end_sine, end_cosine) = ogee::math::sin_cos_degrees(100.0);
            let off = largest(&ring, |p| {
                let (across, inside) = (p.truncate().length(), 0.01 < p.z && p.z < 0.99);
                let at_ends = p.y.abs() < 1e-9 || (p.x * end_sine - p.y * end_cosine).abs() < 1e-9;
                if inside && !at_ends { (2.0 - across).min((1.0 - across).abs()) } else { 0.0 }
            });
            assert!(off <= tolerance * (1.0 + 1e-9), "{how}: {off}");
            // At its height, turned back, the wall of a twisted bar is a square.
            let bar = solid(&format!("linear_extrude(4, twist = 120, {how}) square(2, center = true);"));
            let off = largest(&bar, |p| {
                if !(0.01..3.99).contains(&p.z) {
                    return 0.0;
                }
                let (sine, cosine) = ogee::math::sin_cos(120_f64.to_radians() * p.z / 4.0);
                let (x, y) = (p.x * cosine - p.y * sine, p.x * sine + p.y * cosine);
                (1.0 - x.abs().max(y.abs())).abs()
            });
            assert!(off <= tolerance && off > 0.1 * tolerance, "{how}: {off}");
        }
    }
}

#[test]
fn the_program_reads_patches() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ogee"));
        let output = command.args(arguments).current_dir(folder.path()).output().expect("the program");
        (
            output.status.code(),
            String::from_utf8(output.stdout).expect("text"),
            String::from_utf8(output.stderr).expect("text"),
        )
    };
    fs::copy("fixtures/patches/teapot.bpt", folder.path().join("teapot.bpt")).expect("a copy");
    let (code, out, err) = run(&["info", "teapot.bpt", "--json"]);
    assert_eq!(code, Some(0), "{err}");
    let info: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(
        (&info["patches"], &info["edges used once"], &info["collapsed edges"]),
        (&32.into(), &16.into(), &8.into())
    );
    let near = |value: &serde_json::Value, expected: f64| {
        (value.as_f64().expect("a number") - expected).abs() < 1e-3
    };
    assert!(near(&info["box"]["max"][2], 3.15) && near(&info["box"]["min"][0], -3.0), "{out}");
    let area = info["area"].as_f64().expect("an area");

    let (code, _, err) = run(&["build", "teapot.bpt", "--tolerance", "0.02", "-o", "teapot.obj"]);
    assert_eq!(code, Some(0), "{err}");
    let bytes = fs::read(folder.path().join("teapot.obj")).expect("a file");
    let text = String::from_utf8(bytes.clone()).expect("text");
    assert!(text.contains("\nvn ") && text.contains("//"));
    let open = ogee::io::obj::read(&bytes).expect("a mesh");
    assert!(Defects::of(&open).open_edges > 0);
    assert!((ogee::mesh::area(&open) / area - 1.0).abs() < 0.02, "{area}");

    let (code, _, err) =
        run(&["build", "teapot.bpt", "--tolerance", "0.05", "--close", "--strict", "-o", "closed.ply"]);
    assert_eq!(code, Some(0), "{err}");
    let (code, out, err) =
        run(&["build", "teapot.bpt", "--measured", "--tolerance", "0.05", "--summary", "json"]);
    assert_eq!(code, Some(0), "{err}");
    let summary: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert!(
        summary["error bound"].is_null() && summary["error measured"].as_f64().is_some_and(|e| e <= 0.05)
    );
    let wrong: [(&[&str], i32, &str); 5] = [
        (&["build", "teapot.bpt", "--tolerance", "-1", "-o", "a.obj"], 1, "-1"),
        (
            &["build", "teapot.bpt", "--tolerance", "0", "-o", "a.obj"],
            1,
            "tolerance of 0 is not a positive number",
        ),
        (&["build", "teapot.bpt", "--tolerance", "1e-20", "-o", "a.obj"], 1, "below the rounding"),
        (&["build", "teapot.bpt", "--strict", "-o", "a.obj"], 4, "not closed"),
        (&["boolean", "union", "teapot.bpt", "teapot.bpt", "-o", "a.obj"], 1, "ogee build --close"),
    ];
    for (arguments, expected, part) in wrong {
        let (code, _, err) = run(arguments);
        assert_eq!(code, Some(expected), "{arguments:?}: {err}");
        assert!(err.contains(part), "{arguments:?}: {err}");
        assert!(!folder.path().join("a.obj").exists());
    }
}
