//! Meshes of implicit surfaces against an independent checker: closed, two-manifold, free of self-crossings by exact
//! signs, near the true surface both ways, of the right volume; and what is reported where methods fail.

#[path = "check/crossing.rs"]
mod crossing;
#[path = "check/pairs.rs"]
mod pairs;

use crossing::{Crossings, crossings};
use ogee::isosurface::{self, GridMethod, IsoError, Meshed, Options, mesh_on_grid};
use ogee::math::{Aabb, Vec3};
use ogee::mesh::{Defects, Solid};
use ogee::sdf::{Blend, Expr, Field, Implicit, MeshField, Periodic, Primitive, Tape};
use std::f64::consts::PI;

fn primitive(primitive: Primitive) -> Implicit {
    Implicit::primitive(primitive).expect("a shape")
}

fn sphere(radius: f64) -> Implicit {
    primitive(Primitive::Sphere { radius })
}

fn cuboid(x: f64, y: f64, z: f64) -> Implicit {
    primitive(Primitive::Cuboid { half: Vec3::new(x, y, z) })
}

fn moved(shape: &Implicit, x: f64, y: f64, z: f64) -> Implicit {
    shape.translate(Vec3::new(x, y, z)).expect("a shift")
}

fn block() -> Aabb {
    Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) }
}

/// What any mesh must be, whatever the field.
fn sound(solid: &Solid, name: &str) {
    let defects = Defects::of(solid.mesh());
    assert_eq!(defects, Defects::default(), "{name}");
    assert_eq!(crossings(solid.mesh()), Crossings::default(), "{name}");
}

fn meshed(field: &dyn Field, options: &Options, name: &str) -> Meshed {
    let meshed = isosurface::mesh(field, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    sound(&meshed.mesh, name);
    meshed
}

fn in_block(tolerance: f64) -> Options {
    Options { bounds: Some(block()), ..Options::new(tolerance) }
}

/// Points of the surface: Newton steps from random points.
fn surface_points(field: &dyn Field, bounds: Aabb, count: usize) -> Vec<Vec3> {
    let mut state = 7_u64;
    let mut unit = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut points = Vec::new();
    for _ in 0..20 * count {
        let mut p = bounds.min + bounds.size() * Vec3::new(unit(), unit(), unit());
        for _ in 0..12 {
            let (value, gradient) = field.gradient(p);
            p -= gradient * (value / gradient.length_squared().max(1e-300));
        }
        if field.value(p).abs() < 1e-12 && p.cmpge(bounds.min).all() && p.cmple(bounds.max).all() {
            points.push(p);
        }
        if points.len() == count {
            break;
        }
    }
    assert!(points.len() > count / 4, "only {} points found", points.len());
    points
}

/// Both distances: from the mesh by value over slope, which may fall short of it by this factor, and to the mesh
/// from points of the surface.
fn near(field: &dyn Field, solid: &Solid, tolerance: f64, slope: f64, name: &str) {
    for index in 0..solid.triangles().len() {
        let [a, b, c] = solid.mesh().corners(index);
        for (s, t) in [(0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (1.0 / 3.0, 1.0 / 3.0), (0.2, 0.2)] {
            let p = a + (b - a) * s + (c - a) * t;
            let (value, gradient) = field.gradient(p);
            let distance = value.abs() / (slope * gradient.length());
            assert!(distance <= tolerance, "{name}: {distance} off at {p}");
        }
    }
    let mesh = MeshField::new(solid).expect("triangles");
    for p in surface_points(field, solid.mesh().bounds(), 400) {
        let distance = mesh.value(p).abs();
        assert!(distance <= tolerance, "{name}: the mesh is {distance} from {p}");
    }
}

/// A model with all that is known of it.
struct Model {
    name: &'static str,
    shape: Implicit,
    tolerance: f64,
    /// By how much value over slope may fall short of the distance near the surface.
    slope: f64,
    volume: Option<f64>,
    components: usize,
    genus: Option<u64>,
    /// Proofs of creased models take a while.
    certify: bool,
}

fn check(model: &Model) {
    let Model { name, shape, tolerance, slope, .. } = model;
    let tape = shape.tape();
    let options = Options { certify: model.certify, ..Options::new(*tolerance) };
    let Meshed { mesh, report } = meshed(&tape, &options, name);
    assert_eq!(report.certified, model.certify.then_some(*tolerance), "{name}");
    // Without a proof, what may have a second sheet is listed too.
    assert!(report.unproven.is_empty() || !model.certify, "{name}: {report:?}");
    assert_eq!((report.capped, report.undefined.count, report.jumps.count), (0, 0, 0), "{name}: {report:?}");
    near(&tape, &mesh, *tolerance, *slope, name);
    let measures = mesh.measures();
    if let Some(volume) = model.volume {
        let off = (measures.volume - volume).abs();
        assert!(off <= tolerance * measures.area, "{name}: volume {} is {off} off", measures.volume);
    }
    assert_eq!(measures.components, model.components, "{name}");
    if model.genus.is_some() {
        assert_eq!(measures.genus, model.genus, "{name}");
    }
}

#[test]
fn smooth_models() {
    let torus = primitive(Primitive::Torus { major: 0.6, minor: 0.2 });
    let ball = sphere(0.5);
    let blend = Blend::Quadratic { radius: 0.2 };
    let pair =
        moved(&ball, -0.4, 0.0, 0.0).blend_union(&moved(&ball, 0.4, 0.1, 0.05), blend).expect("a blend");
    let usual = |name, shape, volume, genus| Model {
        name,
        shape,
        tolerance: 0.01,
        slope: 1.0,
        volume,
        components: 1,
        genus: Some(genus),
        certify: true,
    };
    check(&usual("sphere", sphere(0.8), Some(4.0 / 3.0 * PI * 0.512), 0));
    check(&usual("torus", torus, Some(2.0 * PI * PI * 0.6 * 0.04), 1));
    check(&Model { slope: 0.9, ..usual("smooth union", pair, None, 0) });
}

#[test]
fn creased_models() {
    let rod = |axis: usize| {
        let turn = [Vec3::Y, Vec3::X, Vec3::Z][axis];
        let turn = ogee::math::Affine3::from_axis_angle(turn, if axis == 2 { 0.0 } else { PI / 2.0 });
        let rod = primitive(Primitive::Cylinder { radius: 0.25, half_height: 1.0, rounding: 0.0 });
        rod.transform(&turn).expect("a turn")
    };
    let rounded = primitive(Primitive::RoundedCuboid { half: Vec3::splat(0.6), radius: 0.1 });
    let part = (0..3).fold(rounded, |part, axis| part.difference(&rod(axis)));
    let [x, y, z] = Expr::axes();
    // Slopes at 45 degrees.
    let slope = (Expr::norm2(&x, &y) + &z - 0.6) * std::f64::consts::FRAC_1_SQRT_2;
    let cone = Implicit::formula(slope.max(-&z - 0.2), Some(1.0), block());
    let usual = |name, shape, volume, genus| Model {
        name,
        shape,
        tolerance: 0.03,
        slope: 1.0,
        volume: Some(volume),
        components: 1,
        genus: Some(genus),
        certify: false,
    };
    check(&Model {
        certify: true,
        tolerance: 0.08,
        ..usual("box", cuboid(0.7, 0.5, 0.3), 8.0 * 0.7 * 0.5 * 0.3, 0)
    });
    check(&Model { tolerance: 0.002, ..usual("plate", cuboid(0.8, 0.8, 0.005), 1.6 * 1.6 * 0.01, 0) });
    check(&usual("cone", cone, PI / 3.0 * 0.512, 0));
    let tape = part.tape();
    let Meshed { mesh, report } = meshed(&tape, &Options { certify: false, ..Options::new(0.03) }, "part");
    assert_eq!(report.capped, 0, "part: {report:?}");
    near(&tape, &mesh, 0.03, 1.0, "part");
    assert_eq!(mesh.measures().genus, Some(5));
}

/// Every point of the twelve edges of a box has mesh within the tolerance, and no vertex leaves the box.
#[test]
fn sharp_edges_are_kept() {
    let tape = cuboid(0.7, 0.5, 0.3).tape();
    let Meshed { mesh, .. } = meshed(&tape, &Options::new(0.06), "box");
    let field = MeshField::new(&mesh).expect("triangles");
    for i in 0..=40 {
        let t = f64::from(i) / 20.0 - 1.0;
        for (s, u) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            for p in [Vec3::new(t, s, u), Vec3::new(s, t, u), Vec3::new(s, u, t)] {
                let p = p * Vec3::new(0.7, 0.5, 0.3);
                assert!(field.value(p).abs() <= 0.06, "{} from the edge at {p}", field.value(p));
            }
        }
    }
}

#[test]
fn many_parts_and_tunnels() {
    let balls: Vec<Implicit> = (0..27)
        .map(|i| {
            let place = [i % 3, i / 3 % 3, i / 9].map(|k| 0.6 * (f64::from(k) - 1.0));
            moved(&sphere(0.1 + 0.005 * f64::from(i)), place[0], place[1], place[2])
        })
        .collect();
    let volume = (0..27).map(|i| 4.0 / 3.0 * PI * (0.1 + 0.005 * f64::from(i)).powi(3)).sum();
    check(&Model {
        name: "balls",
        shape: Implicit::union_all(&balls),
        tolerance: 0.02,
        slope: 1.0,
        volume: Some(volume),
        components: 27,
        genus: None,
        certify: false,
    });
    let gyroid = primitive(Primitive::Periodic { kind: Periodic::Gyroid, period: 1.0 });
    let tape = gyroid.intersection(&sphere(0.8)).tape();
    let options = Options { certify: false, ..Options::new(0.02) };
    let Meshed { mesh, report } = meshed(&tape, &options, "gyroid");
    assert_eq!(report.certified, None);
    assert!(mesh.measures().genus.is_some_and(|genus| genus > 3), "{:?}", mesh.measures());
}

/// Grids close whatever passes them: ambiguous faces, sheets in one cube, the border of the box.
#[test]
fn grids_make_closed_manifolds() {
    let gyroid = primitive(Primitive::Periodic { kind: Periodic::Gyroid, period: 0.6 }).tape();
    let ball = sphere(0.7).tape();
    let noise =
        formula(|x, y, z| (x * 37.0 + y * 91.0).sin() + (y * 53.0 - z * 77.0).sin() + (z * x * 211.0).sin());
    for method in [GridMethod::MarchingCubes, GridMethod::SurfaceNets] {
        for (name, tape) in [("gyroid", &gyroid), ("ball", &ball), ("noise", &noise)] {
            let solid = match mesh_on_grid(tape, block(), 14, method) {
                Ok(solid) => solid,
                Err(IsoError::Pinched(_)) if name == "noise" && method == GridMethod::SurfaceNets => continue,
                Err(error) => panic!("{name} {method:?}: {error}"),
            };
            assert_eq!(Defects::of(solid.mesh()), Defects::default(), "{name} {method:?}");
            assert!(solid.measures().volume > 0.0, "{name} {method:?}");
        }
        let solid = mesh_on_grid(&ball, block(), 40, method).expect("a mesh");
        let exact = 4.0 / 3.0 * PI * 0.343;
        assert!((solid.measures().volume / exact - 1.0).abs() < 0.01, "{method:?}");
        near(&ball, &solid, 0.01, 1.0, "ball on a grid");
    }
}

/// The tape of a formula of the coordinates.
fn formula(make: impl Fn(&Expr, &Expr, &Expr) -> Expr) -> Tape {
    let [x, y, z] = Expr::axes();
    make(&x, &y, &z).compile()
}

fn ball(x: &Expr, y: &Expr, z: &Expr) -> Expr {
    (x.square() + y.square() + z.square()).sqrt() - 0.7
}

#[test]
fn the_field_may_be_scaled() {
    let plain = meshed(&formula(ball), &in_block(0.02), "ball");
    for scale in [100, -100] {
        let factor = ogee::math::pow(2.0, f64::from(scale));
        let scaled = meshed(&formula(|x, y, z| ball(x, y, z) * factor), &in_block(0.02), "scaled");
        assert_eq!(scaled.mesh, plain.mesh, "2^{scale}");
    }
    // No slope on the surface.
    let cubed = meshed(
        &formula(|x, y, z| ball(x, y, z).pow(3.0)),
        &Options { certify: false, ..in_block(0.02) },
        "cubed",
    );
    let exact = formula(ball);
    near(&exact, &cubed.mesh, 0.02, 1.0, "cubed");
}

#[test]
fn fields_without_an_inside() {
    let nothing = [
        ("zero", formula(|x, _, _| x * 0.0)),
        ("magnitude", formula(|x, y, z| ball(x, y, z).abs())),
        ("outside only", formula(|x, y, z| ball(x, y, z).max(0.0))),
        ("square", formula(|x, y, z| ball(x, y, z).square())),
    ];
    for (name, tape) in nothing {
        let Meshed { mesh, report } = meshed(&tape, &in_block(0.05), name);
        assert!(mesh.is_empty(), "{name}");
        assert!(!report.unsigned.is_empty(), "{name}: {report:?}");
    }
    let far = meshed(&formula(|x, y, z| ball(x, y, z) + 5.0), &in_block(0.05), "far");
    assert!(far.mesh.is_empty() && far.report.unsigned.is_empty(), "{:?}", far.report);
}

#[test]
fn places_without_a_value() {
    let tape = formula(|x, y, z| x.sqrt() + y.square() + z.square() - 0.5);
    let Meshed { mesh, report } = meshed(&tape, &in_block(0.05), "root");
    assert!(!mesh.is_empty() && !report.undefined.is_empty(), "{report:?}");
}

#[test]
fn jumps_are_said() {
    let pole = meshed(&formula(|x, _, _| x.recip()), &Options { search: Some(0.2), ..in_block(0.1) }, "pole");
    assert!(!pole.report.jumps.is_empty(), "{:?}", pole.report);
    let sign = meshed(
        &formula(|x, y, z| ball(x, y, z).compare(0.0)),
        &Options { search: Some(0.2), certify: false, ..in_block(0.1) },
        "sign",
    );
    assert!(!sign.report.jumps.is_empty(), "{:?}", sign.report);
    near(&formula(ball), &sign.mesh, 0.1, 1.0, "sign");
}

#[test]
fn singular_places_are_listed() {
    let cone = formula(|x, y, z| x.square() + y.square() - z.square());
    let umbrella = formula(|x, y, z| x.square() - y.square() * z);
    for (name, tape) in [("double cone", cone), ("umbrella", umbrella)] {
        let Meshed { mesh, report } = meshed(&tape, &in_block(0.1), name);
        assert!(!mesh.is_empty() && report.capped > 0, "{name}");
        assert!(!report.unproven.is_empty(), "{name}: {report:?}");
    }
}

#[test]
fn touching_and_coincident_parts() {
    let half = cuboid(0.3, 0.3, 0.3);
    let at = |x: f64, y: f64, z: f64| moved(&half, x, y, z);
    let cases = [
        ("cubes at an edge", at(-0.3, -0.3, 0.0).union(&at(0.3, 0.3, 0.0))),
        ("cubes at a face", at(-0.3, 0.0, 0.0).union(&at(0.3, 0.0, 0.0))),
        (
            "nearly tangent",
            moved(&sphere(0.4), -0.4001, 0.0, 0.0).union(&moved(&sphere(0.4), 0.4001, 0.0, 0.0)),
        ),
    ];
    for (name, shape) in cases {
        let tape = shape.tape();
        let Meshed { mesh, report } =
            meshed(&tape, &Options { search: Some(0.2), ..Options::new(0.1) }, name);
        if name == "cubes at a face" {
            // The field is zero on their common face, which is no surface.
            assert!(!report.unproven.is_empty(), "{report:?}");
            assert!((mesh.measures().volume - 0.432).abs() < 0.1);
        } else {
            near(&tape, &mesh, 0.1, 0.7, name);
        }
    }
}

#[test]
fn small_shapes_are_found() {
    let pair = moved(&sphere(0.01), -0.9, 0.1, 0.2).union(&moved(&sphere(0.4), 0.5, 0.0, 0.0));
    let Meshed { mesh, report } = meshed(&pair.tape(), &in_block(0.008), "small");
    assert_eq!((mesh.measures().components, report.unproven.count), (2, 0));
    // Thinner than any cell that the tolerance alone would ask for.
    let wall = formula(|x, y, z| ball(x, y, z).abs() - 0.03);
    let options = Options { certify: false, search: Some(0.06), ..in_block(0.02) };
    let mesh = meshed(&wall, &options, "thin ball").mesh;
    assert_eq!(mesh.measures().components, 2, "an outer and an inner sheet");
}

#[test]
fn shapes_that_leave_the_box() {
    let bounds = Aabb { min: Vec3::new(-0.5, -1.0, -1.0), max: Vec3::new(0.4, 0.3, 1.0) };
    let Meshed { mesh, report } =
        meshed(&formula(ball), &Options { bounds: Some(bounds), ..Options::new(0.02) }, "cut");
    assert!(report.capped > 0);
    let found = mesh.mesh().bounds();
    assert_eq!((found.min.x, found.max.x, found.max.y), (-0.5, 0.4, 0.3));
    // The box is all inside.
    let inside = Aabb { min: Vec3::splat(-0.1), max: Vec3::splat(0.1) };
    let Meshed { mesh, .. } =
        meshed(&formula(ball), &Options { bounds: Some(inside), ..Options::new(0.02) }, "inside");
    assert!((mesh.measures().volume - 0.008).abs() < 1e-12);
}

/// A field of one's own that says nothing of itself.
struct Own;

impl Field for Own {
    fn value(&self, p: Vec3) -> f64 {
        p.length() - 0.7
    }
}

#[test]
fn fields_without_ranges_are_measured() {
    assert_eq!(
        isosurface::mesh(&Own, &Options::new(0.05)).unwrap_err(),
        IsoError::Unbounded { searched: 0.0 }
    );
    let Meshed { mesh, report } = meshed(&Own, &in_block(0.05), "own");
    assert_eq!(report.certified, None);
    assert!(report.measured > 0.0 && report.measured <= 0.05, "{report:?}");
    near(&Own, &mesh, 0.05, 1.0, "own");
}

#[test]
fn wrong_input_is_an_error() {
    let tape = formula(ball);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = isosurface::mesh(&tape, &Options::new(tolerance)).unwrap_err();
        assert!(matches!(error, IsoError::BadNumber { name: "tolerance", .. }), "{error}");
    }
    let flat = Aabb { min: Vec3::ZERO, max: Vec3::new(1.0, 1.0, 0.0) };
    for bounds in
        [flat, Aabb::EMPTY, Aabb { max: Vec3::INFINITY, ..block() }, Aabb { max: Vec3::NAN, ..block() }]
    {
        let error =
            isosurface::mesh(&tape, &Options { bounds: Some(bounds), ..Options::new(0.1) }).unwrap_err();
        assert!(matches!(error, IsoError::BadBounds(_)), "{error}");
    }
    let few = Options { most_cells: 1000, ..Options::new(0.001) };
    assert_eq!(isosurface::mesh(&tape, &few).unwrap_err(), IsoError::TooManyCells { limit: 1000 });
    assert!(matches!(isosurface::mesh(&tape, &Options::new(1e-12)), Err(IsoError::TooFine { .. })));
    assert!(matches!(
        isosurface::mesh(&Expr::z().compile(), &Options::new(0.1)),
        Err(IsoError::Unbounded { .. })
    ));
}

/// A field that must not be asked for anything outside of the cell that it was pruned for.
struct Fenced {
    ball: Tape,
    fence: Aabb,
    cost: usize,
}

impl Fenced {
    fn check(&self, cell: Aabb) {
        let slack = 1e-12;
        let held =
            (cell.min + slack).cmpge(self.fence.min).all() && (cell.max - slack).cmple(self.fence.max).all();
        assert!(held, "{cell:?} is not in {:?}", self.fence);
    }
}

impl Field for Fenced {
    fn value(&self, p: Vec3) -> f64 {
        self.check(Aabb::of([p]));
        self.ball.value(p)
    }

    fn gradient(&self, p: Vec3) -> (f64, Vec3) {
        self.check(Aabb::of([p]));
        self.ball.gradient(p)
    }

    fn range(&self, cell: Aabb) -> Option<ogee::sdf::Range> {
        self.check(cell);
        self.ball.range(cell)
    }

    fn slopes(&self, cell: Aabb) -> Option<ogee::sdf::Slopes> {
        self.check(cell);
        self.ball.slopes(cell)
    }

    fn curvature(&self, cell: Aabb) -> Option<ogee::sdf::Curvature> {
        self.check(cell);
        self.ball.curvature(cell)
    }

    fn within(&self, cell: Aabb) -> Option<std::sync::Arc<dyn Field>> {
        self.check(cell);
        Some(std::sync::Arc::new(Fenced { ball: self.ball.clone(), fence: cell, cost: self.cost / 2 }))
    }

    fn cost(&self) -> usize {
        self.cost
    }
}

#[test]
fn pruned_fields_are_not_used_beyond_their_cells() {
    let everywhere = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    let fenced = Fenced { ball: formula(ball), fence: everywhere, cost: 1 << 20 };
    let report = meshed(&fenced, &in_block(0.02), "fenced").report;
    assert_eq!(report.certified, Some(0.02));
}
