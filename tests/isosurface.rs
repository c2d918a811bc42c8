//! Meshes of implicit surfaces against an independent checker.

#[path = "check/crossing.rs"]
mod crossing;
#[path = "check/pairs.rs"]
mod pairs;

use crossing::{Crossings, crossings};
use ogee::isosurface::{self, Options};
use ogee::math::Vec3;
use ogee::sdf::*;

#[test]
fn try_out() {
    let which = std::env::var("MODEL").unwrap_or("sphere".into());
    let tol: f64 = std::env::var("TOL").ok().and_then(|t| t.parse().ok()).unwrap_or(0.01);
    let certify = std::env::var("NOCERT").is_err();
    let p = |p| Implicit::primitive(p).unwrap();
    let shape = match which.as_str() {
        "sphere" => p(Primitive::Sphere { radius: 0.8 }),
        "torus" => p(Primitive::Torus { major: 0.6, minor: 0.2 }),
        "box" => p(Primitive::Cuboid { half: Vec3::new(0.7, 0.5, 0.3) }),
        "cyl" => p(Primitive::Cylinder { radius: 0.5, half_height: 0.5, rounding: 0.0 }),
        "gyroid" => p(Primitive::Periodic { kind: Periodic::Gyroid, period: 0.5 }).intersection(&p(Primitive::Sphere { radius: 0.8 })),
        "plate" => p(Primitive::Cuboid { half: Vec3::new(0.8, 0.8, 0.005) }),
        "octa" => p(Primitive::Octahedron { radius: 0.8 }),
        "blend" => p(Primitive::Cuboid { half: Vec3::new(0.5, 0.5, 0.5) }).blend_union(&p(Primitive::Cylinder { radius: 0.3, half_height: 0.8, rounding: 0.0 }), Blend::Quadratic { radius: 0.1 }).unwrap(),
        _ => panic!(),
    };
    let tape = shape.tape();
    let options = Options { certify, ..Options::new(tol) };
    let start = std::time::Instant::now();
    let mut last = start;
    let meshed = isosurface::mesh_with_progress(&tape, &options, &mut |s| { println!("  {:?} at {:.3}", s, last.elapsed().as_secs_f64()); last = std::time::Instant::now(); }).unwrap();
    println!("{which} {tol}: {:.3} s, {} triangles", start.elapsed().as_secs_f64(), meshed.mesh.triangles().len());
    let r=&meshed.report; println!("cert {:?} meas {:.5} cells {} vis {} unproven {} {:?} jumps {} uns {}", r.certified, r.measured, r.cells, r.visited, r.unproven.count, r.unproven.first.first(), r.jumps.count, r.unsigned.count);
    let m = meshed.mesh.measures(); println!("comp {} genus {:?} vol {}", m.components, m.genus, m.volume);
    let c = crossings(meshed.mesh.mesh());
    assert_eq!(c, Crossings::default());
}
