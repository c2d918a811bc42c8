//! Coarsened meshes of fields against distances written down here: within the tolerance both ways, closed, two-manifold,
//! free of crossings, of the same topology; and what must stay as it is.

#[path = "check/crossing.rs"]
mod crossing;
#[path = "check/pairs.rs"]
mod pairs;

use crossing::{Crossings, crossings};
use ogee::isosurface::{self, Meshed, Options};
use ogee::math::{Aabb, Vec3, cos, exp, hypot, sin};
use ogee::mesh::{Defects, Solid};
use ogee::sdf::{Blend, Expr, Field, Implicit, Periodic, Primitive, Tape};
use ogee::simplify::{self, Simplified};
use std::f64::consts::{PI, TAU};
use std::fs;
use std::process::Command;

fn primitive(primitive: Primitive) -> Implicit {
    Implicit::primitive(primitive).expect("a shape")
}

/// The mesh before and after.
fn coarsened(field: &Tape, options: &Options, name: &str) -> (Meshed, Simplified) {
    let meshed = isosurface::mesh(field, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    let fewer = simplify::to_field(field, &meshed.mesh, options.tolerance);
    let (old, new) = (meshed.mesh.mesh(), fewer.mesh.mesh());
    assert_eq!(Defects::of(new), Defects::default(), "{name}");
    assert_eq!(crossings(new), Crossings::default(), "{name}");
    let [before, after] = [&meshed.mesh, &fewer.mesh].map(Solid::measures);
    assert_eq!((before.components, before.genus), (after.components, after.genus), "{name}");
    assert_eq!(old.positions.len() - new.positions.len(), fewer.collapsed, "{name}");
    (meshed, fewer)
}

/// Distance between a point and a triangle.
fn to_triangle([a, b, c]: [Vec3; 3], p: Vec3) -> f64 {
    let normal = (b - a).cross(c - a);
    let sides = [[a, b], [b, c], [c, a]];
    if sides.iter().all(|&[u, v]| normal.cross(v - u).dot(p - u) >= 0.0) && normal != Vec3::ZERO {
        return (normal.dot(p - a) / normal.length()).abs();
    }
    let to_side = |&[u, v]: &[Vec3; 2]| {
        let t = ((p - u).dot(v - u) / (v - u).length_squared()).clamp(0.0, 1.0);
        p.distance(u + (v - u) * t)
    };
    sides.iter().map(to_side).fold(f64::INFINITY, f64::min)
}

/// The greatest distance of the triangles from a surface, over 45 places of each, and of some of its points from these.
fn off(solid: &Solid, distance: impl Fn(Vec3) -> f64, points: impl Iterator<Item = Vec3>) -> [f64; 2] {
    let triangles: Vec<[Vec3; 3]> = (0..solid.triangles().len()).map(|i| solid.mesh().corners(i)).collect();
    let mut out = 0.0_f64;
    for [a, b, c] in &triangles {
        for i in 0..=8 {
            for j in 0..=8 - i {
                let (s, t) = (f64::from(i) / 8.0, f64::from(j) / 8.0);
                out = out.max(distance(*a + (*b - *a) * s + (*c - *a) * t).abs());
            }
        }
    }
    let nearest = |p: Vec3| triangles.iter().map(|&t| to_triangle(t, p)).fold(f64::INFINITY, f64::min);
    [out, points.map(nearest).fold(0.0, f64::max)]
}

/// Points on a sphere, evenly (Fibonacci's spiral).
fn around(center: Vec3, radius: f64, count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |i| {
        let (z, turn) = (1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count), f64::from(i) * 2.399_963_23);
        let ring = (1.0 - z * z).sqrt();
        center + radius * Vec3::new(ring * cos(turn), ring * sin(turn), z)
    })
}

#[test]
fn round_models_stay_within_the_tolerance_with_far_fewer_triangles() {
    let check = |name: &str, shape: &Implicit, most: f64, off: &dyn Fn(&Solid) -> [f64; 2]| {
        let tolerance = 0.004;
        let tape = shape.tape();
        let (meshed, fewer) = coarsened(&tape, &Options::new(tolerance), name);
        assert_eq!(meshed.report.certified, Some(tolerance), "{name}");
        let [before, after] = [&meshed.mesh, &fewer.mesh].map(|solid| solid.triangles().len());
        assert!((after as f64) < most * before as f64, "{name}: {before} {after}");
        let [to_surface, to_mesh] = off(&fewer.mesh);
        assert!(to_surface <= tolerance && to_mesh <= tolerance, "{name}: {to_surface} {to_mesh}");
        // Not for want of trying.
        assert!(to_surface > 0.5 * tolerance, "{name}: {to_surface}");
    };
    let ball = primitive(Primitive::Sphere { radius: 0.8 });
    check("ball", &ball, 0.6, &|solid| off(solid, |p| p.length() - 0.8, around(Vec3::ZERO, 0.8, 2000)));
    let ring = primitive(Primitive::Torus { major: 0.6, minor: 0.3 });
    let to_ring = |p: Vec3| hypot(hypot(p.x, p.y) - 0.6, p.z) - 0.3;
    let on_ring = || {
        (0..2000).map(|i| {
            let (u, v) = (TAU * f64::from(i) / 2000.0, 2.399_963_23 * f64::from(i));
            let r = 0.6 + 0.3 * cos(v);
            Vec3::new(r * cos(u), r * sin(u), 0.3 * sin(v))
        })
    };
    check("ring", &ring, 0.6, &|solid| off(solid, to_ring, on_ring()));
    let block = primitive(Primitive::RoundedCuboid { half: Vec3::splat(0.5), radius: 0.2 });
    let to_block = |p: Vec3| {
        let q = p.abs() - 0.3;
        q.max(Vec3::ZERO).length() + q.max_element().min(0.0) - 0.2
    };
    // Out from the core in all directions.
    let on_block = || around(Vec3::ZERO, 1.0, 2000).map(|d| d.signum() * 0.3 + 0.2 * d);
    check("block", &block, 0.8, &|solid| off(solid, to_block, on_block()));
}

/// What is between the vertices is not missed: a bump much smaller than the triangles beside it.
#[test]
fn small_bumps_are_kept() {
    let tolerance = 0.005;
    let [x, y, z] = Expr::axes();
    let bump = ((&x.square() + &y.square() + (&z - 0.7).square()) * -400.0).exp() * 0.03;
    let tape = ((x.square() + y.square() + z.square()).sqrt() - 0.7 - bump).compile();
    let (_, fewer) = coarsened(&tape, &Options::new(tolerance), "bump");
    // Over the pole, where all is steep along z, the top of the bump.
    let height = |r: f64| {
        let f = |z: f64| hypot(r, z) - 0.7 - 0.03 * exp(-400.0 * (r * r + (z - 0.7) * (z - 0.7)));
        let (mut low, mut high) = (0.5, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if f(middle) < 0.0 { low = middle } else { high = middle }
        }
        high
    };
    let points = (0..400).map(|i| {
        let (r, turn) = (0.2 * (f64::from(i) / 400.0).sqrt(), 2.399_963_23 * f64::from(i));
        Vec3::new(r * cos(turn), r * sin(turn), height(r))
    });
    let [_, to_mesh] = off(&fewer.mesh, |_| 0.0, points);
    assert!(to_mesh <= tolerance, "{to_mesh}");
    assert!(fewer.collapsed > 0);
}

#[test]
fn blends_and_many_parts() {
    let at = |radius: f64, x: f64, y: f64, z: f64| {
        primitive(Primitive::Sphere { radius }).translate(Vec3::new(x, y, z)).expect("a shift")
    };
    for blend in [Blend::Quadratic { radius: 0.2 }, Blend::Circular { radius: 0.2 }] {
        let pair = at(0.5, -0.4, 0.0, 0.0).blend_union(&at(0.4, 0.4, 0.1, 0.0), blend).expect("a blend");
        let tape = pair.tape();
        let (meshed, fewer) = coarsened(&tape, &Options::new(0.005), "blend");
        let [before, after] = [&meshed.mesh, &fewer.mesh].map(|solid| solid.triangles().len());
        assert!(4 * after < 3 * before, "{before} {after}");
        // The field falls short of the distance by a root of two at most.
        let distance = |p: Vec3| {
            let (value, gradient) = tape.gradient(p);
            value / gradient.length()
        };
        let vertices = meshed.mesh.positions().iter().copied().step_by(7);
        let [to_surface, to_mesh] = off(&fewer.mesh, distance, vertices);
        assert!(to_surface <= 0.005 * 1.01 && to_mesh <= 0.005, "{to_surface} {to_mesh}");
    }
    let balls: Vec<Implicit> = (0..8)
        .map(|i| {
            let place = [i % 2, i / 2 % 2, i / 4].map(|k| 0.6 * f64::from(k) - 0.3);
            at(0.15 + 0.01 * f64::from(i), place[0], place[1], place[2])
        })
        .collect();
    let (meshed, fewer) = coarsened(&Implicit::union_all(&balls).tape(), &Options::new(0.002), "balls");
    let [before, after] = [&meshed.mesh, &fewer.mesh].map(|solid| solid.triangles().len());
    assert!(4 * after < 3 * before, "{before} {after}");
    let volume: f64 = (0..8).map(|i| 4.0 / 3.0 * PI * (0.15 + 0.01 * f64::from(i)).powi(3)).sum();
    let measures = fewer.mesh.measures();
    assert!((measures.volume - volume).abs() <= 0.002 * measures.area);
}

/// Sharp edges, thin plates, what is cut off at a box, fields without ranges.
#[test]
fn what_is_not_round_stays() {
    let half = Vec3::new(0.7, 0.5, 0.3);
    let (_, fewer) = coarsened(&primitive(Primitive::Cuboid { half }).tape(), &Options::new(0.06), "box");
    let to_box = |p: Vec3| {
        let q = p.abs() - half;
        q.max(Vec3::ZERO).length() + q.max_element().min(0.0)
    };
    let edges = (0..=40).flat_map(|i| {
        let t = f64::from(i) / 20.0 - 1.0;
        [Vec3::new(t, 1.0, -1.0), Vec3::new(1.0, t, 1.0), Vec3::new(-1.0, 1.0, t)].map(|p| p * half)
    });
    let [to_surface, to_mesh] = off(&fewer.mesh, to_box, edges);
    assert!(to_surface <= 0.06 && to_mesh <= 0.06, "{to_surface} {to_mesh}");

    let block = Aabb { min: Vec3::splat(-0.9), max: Vec3::splat(0.9) };
    let gyroid = primitive(Primitive::Periodic { kind: Periodic::Gyroid, period: 1.5 }).tape();
    let options = Options { bounds: Some(block), ..Options::new(0.005) };
    let (meshed, fewer) = coarsened(&gyroid, &options, "gyroid");
    let on_border = |p: &&Vec3| p.abs().max_element() == 0.9;
    let [before, after] =
        [&meshed.mesh, &fewer.mesh].map(|solid| solid.positions().iter().filter(on_border).count());
    assert!(before == after && before > 0 && fewer.collapsed > 0, "{before} {after}");

    struct Plain;
    impl Field for Plain {
        fn value(&self, p: Vec3) -> f64 {
            p.length() - 0.5
        }
    }
    let options = Options { bounds: Some(block), search: Some(0.2), ..Options::new(0.02) };
    let meshed = isosurface::mesh(&Plain, &options).expect("a mesh");
    let same = simplify::to_field(&Plain, &meshed.mesh, 0.02);
    assert_eq!((same.collapsed, same.mesh), (0, meshed.mesh));
    let nothing = simplify::to_field(&gyroid, &Solid::default(), 0.1);
    assert!(nothing.mesh.is_empty());
}

/// The program: the same bits on any number of threads, counts in the summary, and the option that turns it off.
#[test]
fn formulas_are_coarsened_unless_that_is_turned_off() {
    let folder = tempfile::tempdir().expect("a folder");
    let lines = ["x var-x", "y var-y", "z var-z", "xx square x", "yy square y", "zz square z"];
    let rest = ["s add xx yy", "t add s zz", "r sqrt t", "c const 0.8", "d sub r c"];
    fs::write(folder.path().join("ball.vm"), [&lines[..], &rest[..]].concat().join("\n")).expect("a file");
    let run = |words: &str| {
        let line = format!("build ball.vm --tolerance 0.002 --summary json -o ball.obj {words}");
        let mut command = Command::new(env!("CARGO_BIN_EXE_ogee"));
        let done = command.args(line.split_whitespace()).current_dir(folder.path()).output().expect("ogee");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let summary: serde_json::Value = serde_json::from_slice(&done.stdout).expect("JSON");
        (fs::read(folder.path().join("ball.obj")).expect("a mesh"), summary)
    };
    let (one, summary) = run("--jobs 1");
    let (two, _) = run("--jobs 2");
    assert!(one == two);
    let (_, whole) = run("--no-coarsen");
    let before = &summary["surface"]["triangles before coarsening"];
    assert_eq!((before, before), (&whole["triangles"], &whole["surface"]["triangles before coarsening"]));
    let counts = [&summary["triangles"], before].map(|count| count.as_u64().expect("a count"));
    assert!(2 * counts[0] < counts[1], "{counts:?}");
    assert!(summary["seconds"]["coarsen"].is_number() && whole["seconds"]["coarsen"].is_null());
}
