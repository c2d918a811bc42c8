//! The hard cases of solid booleans, each with its expected volume, components and genus, known by hand or from the
//! oracle; every result is checked to be closed, manifold by index, and free of crossings by exact predicates.
//!
//! What is too large for a debug build runs in release, or where `OGEE_ZOO_LARGE` is set.

#![allow(clippy::print_stdout, reason = "tests say how much they did")]

#[allow(dead_code, reason = "each test program uses its part")]
mod check;
#[allow(dead_code, reason = "each test program uses its part")]
mod oracle;
#[allow(dead_code, reason = "each test program uses its part")]
mod solids;
#[path = "zoo/specimens.rs"]
mod specimens;

use check::Shape;
use check::crossing::{Crossings, crossings};
use ogee::boolean::{self, Combined, Op, Tree};
use ogee::math::Vec3;
use ogee::mesh::{Mesh, crossing_pairs};
use specimens::{Expected, Specimen};

#[test]
fn contacts() {
    judge(&specimens::contacts());
}

#[test]
fn copies() {
    judge(&specimens::copies());
}

#[test]
fn extremes() {
    judge(&specimens::extremes());
}

#[test]
fn windings() {
    judge(&specimens::windings());
}

#[test]
fn crowds() {
    judge(&specimens::crowds(10));
}

#[test]
fn plates() {
    let tilt = specimens::about(Vec3::new(1.0, 2.0, 3.0), 0.7);
    for (flush, turn) in [(true, None), (false, None), (false, Some(tilt))] {
        let (tree, operands) = specimens::perforated_plate(8, flush, turn);
        let shape = sound("a perforated plate", &tree, &operands);
        assert_eq!(
            (shape.components.len(), shape.genus()),
            (1, 64),
            "flush: {flush}, turned: {}",
            turn.is_some()
        );
    }
}

#[test]
fn large_sponge() {
    if !is_large() {
        println!("SKIPPED: the Menger sponge 4 runs in release builds or with OGEE_ZOO_LARGE set");
        return;
    }
    judge(&[specimens::sponge(4, 26433)]);
}

/// Whether there is time for what takes long.
fn is_large() -> bool {
    !cfg!(debug_assertions) || std::env::var_os("OGEE_ZOO_LARGE").is_some()
}

/// Nearly equal solids: nobody knows the pieces, but volumes must add up. Where they are ulps apart, whole sheets may run
/// through each other once they are rounded; the certificate must say so.
#[test]
fn near_copies_keep_the_laws() {
    for (name, a, b) in specimens::pairs() {
        let operands = [a, b];
        let volume = |tree: &Tree| {
            let (combined, shape) = closed(&name, tree, &operands);
            let (left, counted) = (combined.certificate.crossings_left, crossings(combined.solid.mesh()));
            assert_eq!(counted.crossing > 0, left > 0, "{name}: {:?} and {counted:?}", combined.certificate);
            if left > 0 {
                println!("{name}: {:?}", combined.certificate);
            }
            shape.volume_f64()
        };
        let of = |op| volume(&solids::all_of(op, 2));
        let [a, b] = [0, 1].map(|i| volume(&Tree::Leaf(i)));
        let (either, both) = (of(Op::Union), of(Op::Intersection));
        let (rest, odd) = (of(Op::Difference), of(Op::SymmetricDifference));
        for (left, right) in [(a + b, either + both), (a - both, rest), (either - both, odd)] {
            assert!((left - right).abs() <= 4e-15 * (a + b), "{name}: {left:e} and {right:e}");
        }
    }
}

/// Ninety cubes with a common centre, or a common corner: stars, so one piece without
/// handles, whatever the order.
#[test]
fn cubes_through_a_point() {
    let count = 90_usize;
    for corner in [-0.5, 0.0] {
        let mut operands = specimens::turned_cubes(corner, count);
        let one = sound("turned cubes", &solids::union(count), &operands);
        operands.reverse();
        let other = sound("turned cubes", &solids::union(count), &operands);
        assert_eq!((one.components.len(), one.genus()), (1, 0), "{corner}");
        assert!((one.volume_f64() - other.volume_f64()).abs() <= 1e-14 * one.volume_f64(), "{corner}");
        // Within the ball that every cube is in.
        assert!((1.0..21.8).contains(&one.volume_f64()));
    }
}

#[test]
fn terrain_minus_domes() {
    let (ground, domes) = specimens::terrain(60, 6);
    let whole = Shape::of(&ground).volume_f64();
    let count = domes.len();
    let mut operands = vec![ground];
    operands.extend(domes);
    let chain =
        (1..=count).fold(Tree::Leaf(0), |sum, i| Tree::Node(Op::Difference, vec![sum, Tree::Leaf(i)]));
    let dug = sound("terrain minus domes", &chain, &operands);
    assert_eq!((dug.components.len(), dug.genus()), (1, 0));
    let union_of_domes = Tree::Node(Op::Union, (1..=count).map(Tree::Leaf).collect());
    let soil = Tree::Node(Op::Intersection, vec![Tree::Leaf(0), union_of_domes]);
    let soil = sound("terrain in domes", &soil, &operands);
    assert_eq!((soil.components.len(), soil.genus()), (count, 0));
    assert!((dug.volume_f64() + soil.volume_f64() - whole).abs() < 1e-13 * whole);
}

/// Judges all, so that one that fails does not hide the others.
fn judge(specimens: &[Specimen]) {
    let failed: Vec<String> = specimens
        .iter()
        .filter_map(|specimen| {
            let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| faults(specimen)));
            let faults = result.unwrap_or_else(|_| vec!["panicked".to_owned()]);
            (!faults.is_empty()).then(|| format!("{}: {}", specimen.name, faults.join("; ")))
        })
        .collect();
    assert!(failed.is_empty(), "{} of {} failed:\n{}", failed.len(), specimens.len(), failed.join("\n"));
}

fn faults(specimen: &Specimen) -> Vec<String> {
    let operands: Vec<&Mesh> = specimen.operands.iter().collect();
    let mesh = match boolean::evaluate(&specimen.tree, &operands) {
        Ok(combined) => combined.solid.into_mesh(),
        Err(error) => return vec![error.to_string()],
    };
    let mut found = match specimen.expected {
        Expected::Oracle => {
            check::disagreements(&oracle::evaluate(&specimen.tree, &operands), &mesh, &operands)
        }
        Expected::Known { volume, within, components, genus } => {
            let shape = Shape::of(&mesh);
            let mut found = shape.faults.clone();
            if (shape.volume_f64() - volume).abs() > within * volume {
                found.push(format!("volume {:e} instead of {volume:e}", shape.volume_f64()));
            }
            if (shape.components.len(), shape.genus()) != (components, genus) {
                let (ours, our_genus) = (shape.components.len(), shape.genus());
                found.push(format!(
                    "{ours} components of genus {our_genus} instead of {components} of {genus}"
                ));
            }
            found
        }
    };
    found.extend(crossing_fault(&mesh));
    found
}

/// The shape of a result that must be closed, manifold and free of crossings.
fn sound(name: &str, tree: &Tree, operands: &[Mesh]) -> Shape {
    let (combined, shape) = closed(name, tree, operands);
    assert_eq!(crossing_fault(combined.solid.mesh()), None, "{name}");
    shape
}

/// A result that must be closed and manifold, with its shape.
fn closed(name: &str, tree: &Tree, operands: &[Mesh]) -> (Combined, Shape) {
    let operands: Vec<&Mesh> = operands.iter().collect();
    let combined = boolean::evaluate(tree, &operands).expect("closed operands");
    let shape = Shape::of(combined.solid.mesh());
    assert!(shape.faults.is_empty(), "{name}: {:?}", shape.faults);
    (combined, shape)
}

fn crossing_fault(mesh: &Mesh) -> Option<String> {
    let found = crossings(mesh);
    (found.crossing > 0).then(|| format!("crossings: {found:?}"))
}

/// The checker counts what was planted.
#[test]
fn planted_crossings_are_counted() {
    let (a, b) = (solids::cube(0.0, 0.0, 0.0, 2.0), solids::cube(1.0, 1.25, 1.5, 2.0));
    assert_eq!(crossings(&a), Crossings::default());
    let together = solids::together([&a, &b]);
    assert!(crossings(&together).crossing >= 6);
    let all: Vec<u32> = (0..together.triangles.len() as u32).collect();
    let pairs = crossing_pairs(&together, &all);
    assert_eq!(pairs.len(), crossings(&together).crossing);
    let of_some: Vec<[u32; 2]> = pairs.into_iter().filter(|pair| pair.iter().any(|&t| t < 5)).collect();
    assert_eq!(crossing_pairs(&together, &all[..5]), of_some);
    assert_eq!(crossings(&solids::together([&a, &a])).crossing, 12);
    let beside = solids::cube(2.0, 0.0, 0.0, 2.0);
    assert!(crossings(&solids::together([&a, &beside])).crossing >= 2, "a ghost wall");
    let on_edge = solids::cube(2.0, 2.0, 0.0, 2.0);
    assert_eq!(crossings(&solids::together([&a, &on_edge])), Crossings::default());
    let on_corner = solids::cube(2.0, 2.0, 1.0, 2.0);
    let touching = crossings(&solids::together([&a, &on_corner]));
    assert!(touching.crossing == 0 && touching.touching > 0, "{touching:?}");
}
