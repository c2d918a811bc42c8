//! The kernel against the oracle, on random cases drawn to be nasty.
//!
//! `OGEE_ORACLE_COUNT` cases, from `OGEE_ORACLE_SEED` on; case `n` is the same in every run. A case that fails is
//! shrunk and printed as the Rust that makes it.

#![allow(clippy::print_stdout, reason = "tests say how much they did")]

#[allow(dead_code, reason = "each test program uses its part")]
mod check;
#[allow(dead_code, reason = "each test program uses its part")]
mod nasty;
#[allow(dead_code, reason = "each test program uses its part")]
mod oracle;
#[allow(dead_code, reason = "each test program uses its part")]
mod solids;

use nasty::{Case, shrunk};
use ogee::boolean::{self, Op, Options, Steps, Tree};
use ogee::mesh::{Mesh, Solid};
use oracle::Truth;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Cases that failed once, and why: a result whose crossings were repaired forgot its exact surface, and the next call
/// left what it had been moved by.
const FAILED_ONCE: [u64; 1] = [405_873];

type Kernel<'a> = &'a dyn Fn(&Tree, &[&Mesh]) -> Result<Mesh, String>;

#[test]
fn kernel_equals_oracle() {
    let count = setting("OGEE_ORACLE_COUNT", 1500);
    let seed = setting("OGEE_ORACLE_SEED", 1);
    let mut failed = Vec::new();
    for seed in FAILED_ONCE.into_iter().chain(seed..seed + count) {
        let case = Case::random(seed);
        for kernel in [at_once, pair_by_pair, call_by_call] {
            if !disagreements(&case, &kernel).is_empty() {
                failed.push(seed);
                if failed.len() <= 3 {
                    report(seed, &case, &kernel);
                }
            }
        }
    }
    println!("{count} cases from seed {seed}, {} failed", failed.len());
    assert!(failed.is_empty(), "of {count} cases, {} failed, of seeds {failed:?}", failed.len());
}

/// The seeds print on their own, so that a long run can be cut short.
fn report(seed: u64, case: &Case, kernel: Kernel<'_>) {
    let smallest = shrunk(case, 2000, &|case| !disagreements(case, kernel).is_empty());
    println!("OGEE_ORACLE_SEED={seed} OGEE_ORACLE_COUNT=1 fails; at its smallest:\n{smallest:?}");
    disagreements(&smallest, kernel).iter().take(5).for_each(|line| println!("  {line}"));
}

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
}

/// One arrangement of everything.
fn at_once(tree: &Tree, operands: &[&Mesh]) -> Result<Mesh, String> {
    kernel(tree, operands, Steps::Once)
}

/// An arrangement for each operation, on the exact results of those before.
fn pair_by_pair(tree: &Tree, operands: &[&Mesh]) -> Result<Mesh, String> {
    kernel(tree, operands, Steps::Pairs)
}

/// A call of the library for each operation on two solids, with its result for the next.
fn call_by_call(tree: &Tree, operands: &[&Mesh]) -> Result<Mesh, String> {
    fn solid_of(tree: &Tree, operands: &[&Mesh]) -> Result<Solid, String> {
        let alone = |mesh: &Mesh| boolean::evaluate(&Tree::Leaf(0), &[mesh]).map(|combined| combined.solid);
        match tree {
            Tree::Leaf(index) => alone(operands[*index]).map_err(|error| error.to_string()),
            Tree::Node(_, parts) if parts.is_empty() => Ok(Solid::default()),
            Tree::Node(op, parts) => {
                let mut parts = parts.iter().map(|part| solid_of(part, operands));
                let first = parts.next().expect("there are some")?;
                parts.try_fold(first, |so_far, part| {
                    let pair = boolean::evaluate(&Tree::flat(*op, 2), &[&so_far, &part?]);
                    pair.map(|combined| combined.solid).map_err(|error| error.to_string())
                })
            }
            Tree::AtLeast(least, parts) => {
                let parts: Result<Vec<Solid>, String> =
                    parts.iter().map(|part| solid_of(part, operands)).collect();
                let (parts, tree) =
                    (parts?, |count| Tree::AtLeast(*least, (0..count).map(Tree::Leaf).collect()));
                let combined = boolean::evaluate(&tree(parts.len()), &parts.iter().collect::<Vec<_>>());
                combined.map(|combined| combined.solid).map_err(|error| error.to_string())
            }
        }
    }
    solid_of(tree, operands).map(Solid::into_mesh)
}

fn kernel(tree: &Tree, operands: &[&Mesh], steps: Steps) -> Result<Mesh, String> {
    boolean::evaluate_with(tree, operands, &Options { steps, ..Options::default() })
        .map(|combined| combined.solid.into_mesh())
        .map_err(|error| error.to_string())
}

/// Everything in which a kernel's result for the case is wrong; a panic is one thing.
fn disagreements(case: &Case, kernel: Kernel<'_>) -> Vec<String> {
    let operands = case.operands();
    match catch_unwind(AssertUnwindSafe(|| kernel(&case.tree, &operands))) {
        Ok(Ok(mesh)) => check::disagreements(&oracle::evaluate(&case.tree, &operands), &mesh, &operands),
        Ok(Err(error)) => vec![error],
        Err(_) => vec!["the kernel panicked".to_owned()],
    }
}

/// The oracle's own mesh passes, and it passes the checker that knows nothing of cells.
#[test]
fn a_right_kernel_passes() {
    for seed in 0..150 {
        let case = Case::random(seed);
        let found = disagreements(&case, &|tree, operands| Ok(oracle::mesh(tree, operands)));
        // Its hubs and middles are no corners of anything, and rounded.
        let allowed = |line: &String| line.contains("nothing meets") || line.contains("not exactly");
        let found: Vec<String> = found.into_iter().filter(|line| !allowed(line)).collect();
        assert_eq!(found, Vec::<String>::new(), "seed {seed}: {case:?}");
        let crossings = check::crossing::crossings(&oracle::mesh(&case.tree, &case.operands()));
        assert_eq!(crossings.crossing, 0, "seed {seed}: {crossings:?}");
    }
}

type Spoil = fn(Mesh) -> Mesh;

/// Kernels that are wrong in one way each are caught.
#[test]
fn wrong_kernels_are_caught() {
    let spoil: [(&str, Spoil); 5] = [
        ("loses a triangle", |mut mesh| {
            mesh.triangles.pop();
            mesh
        }),
        ("moves a vertex by a millionth", |mut mesh| {
            mesh.positions[0].x += 1e-6;
            mesh
        }),
        ("is inside out", Mesh::flipped),
        ("leaves everything twice", |mesh| solids::together([&mesh, &mesh])),
        ("welds all that touch", |mut mesh| {
            let first = |p| mesh.positions.iter().position(|q| *q == p).expect("itself") as u32;
            mesh.triangles =
                mesh.triangles.iter().map(|t| t.map(|v| first(mesh.positions[v as usize]))).collect();
            mesh
        }),
    ];
    for (name, change) in spoil {
        let caught = (0..100).map(Case::random).filter(|case| {
            !disagreements(case, &|tree, operands| {
                let mesh = oracle::mesh(tree, operands);
                Ok(if mesh.is_empty() { mesh } else { change(mesh) })
            })
            .is_empty()
        });
        let caught = caught.count();
        println!("a kernel that {name}: {caught} of 100");
        assert!(caught > if name.starts_with("welds") { 3 } else { 50 }, "{name}: {caught}");
    }
}

/// A failure of a known cause shrinks to that cause alone.
#[test]
fn shrinking_finds_the_cause() {
    let has_difference =
        |case: &Case| format!("{:?}", case.tree).contains("Difference") && case.operands.len() > 1;
    let case = (0..).map(Case::random).find(|case| has_difference(case) && case.operands.len() > 3);
    let smallest = shrunk(&case.expect("one of many"), 5000, &has_difference);
    assert_eq!(smallest.operands.len(), 2);
    assert!(smallest.operands.iter().all(|mesh| mesh.triangles.is_empty()), "{smallest:?}");
}

/// The oracle keeps the laws of volumes: inclusion and exclusion, De Morgan, and A - (A - B) = A and B.
#[test]
fn oracle_keeps_the_laws() {
    let leaf = |i| Tree::Leaf(i);
    let node = |op, children: &[Tree]| Tree::Node(op, children.to_vec());
    for seed in 0..100 {
        let operands: Vec<Mesh> =
            (0..2).flat_map(|k| Case::random(1000 + 2 * seed + k).operands.into_iter().take(1)).collect();
        let frame = solids::cuboid(ogee::math::Vec3::splat(-9.0), ogee::math::Vec3::splat(9.0));
        let all = [&operands[0], &operands[1], &frame];
        let of = |tree: &Tree| -> Truth { oracle::evaluate(tree, &all) };
        let (a, b) = (leaf(0), leaf(1));
        let both = of(&node(Op::Intersection, &[a.clone(), b.clone()]));
        let either = of(&node(Op::Union, &[a.clone(), b.clone()]));
        assert_eq!(of(&a).volume + of(&b).volume, either.volume.clone() + &both.volume);
        let rest = node(Op::Difference, &[a.clone(), b.clone()]);
        assert_eq!(of(&node(Op::Difference, &[a.clone(), rest])), both);
        let not = |tree| node(Op::Difference, &[leaf(2), tree]);
        let neither = node(Op::Intersection, &[not(a), not(b)]);
        assert_eq!(of(&not(neither)).volume, either.volume);
    }
}
