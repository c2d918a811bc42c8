//! Booleans of pairs: as meshes of which nothing is known, and as solids that a boolean made.
#![allow(missing_docs, reason = "criterion's macros make functions without")]

#[allow(dead_code, unreachable_pub, reason = "shared with the tests")]
#[path = "../tests/solids/mod.rs"]
mod solids;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ogee::boolean::{self, Op, Tree};
use ogee::math::Vec3;
use ogee::mesh::{Mesh, Solid};
use std::hint::black_box;

fn cubes(criterion: &mut Criterion) {
    pair(criterion, "cubes", &solids::cube(0.0, 0.0, 0.0, 1.0), &solids::cube(0.5, 0.4, 0.3, 1.0));
    pair(criterion, "flush cubes", &solids::cube(0.0, 0.0, 0.0, 1.0), &solids::cube(1.0, 0.25, 0.0, 1.0));
}

fn balls(criterion: &mut Criterion) {
    for (name, n) in [("balls 1k", 11), ("balls 10k", 35)] {
        let b = solids::ball(n, 1.0, Vec3::new(0.31, 0.47, 0.23));
        pair(criterion, name, &solids::ball(n, 1.0, Vec3::ZERO), &b);
    }
}

fn pair(criterion: &mut Criterion, name: &str, a: &Mesh, b: &Mesh) {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(20).throughput(Throughput::Elements((a.triangles.len() + b.triangles.len()) as u64));
    let (solid_a, solid_b) = (clean(a), clean(b));
    group.bench_function("difference of solids", |bench| {
        bench.iter(|| boolean::difference(black_box(&solid_a), black_box(&solid_b)));
    });
    let union = Tree::Node(Op::Union, vec![Tree::Leaf(0), Tree::Leaf(1)]);
    group.bench_function("union of meshes", |bench| {
        bench.iter(|| boolean::evaluate(black_box(&union), &[black_box(a), black_box(b)]));
    });
    group.finish();
}

/// The same solid, known not to cross itself.
fn clean(mesh: &Mesh) -> Solid {
    boolean::evaluate(&Tree::Leaf(0), &[mesh]).expect("a closed mesh").solid
}

criterion_group!(benches, cubes, balls);
criterion_main!(benches);
