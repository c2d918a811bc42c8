//! Curves: evaluation, arc length, nearest point, intersection, flattening.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ogee::curve::{AnyBezier, Bernstein, Cubic, intersect, length, nearest};
use ogee::math::Vec2;
use ogee::tessellate::flatten;
use std::hint::black_box;

fn arch() -> Cubic<Vec2> {
    Cubic::new([(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)].map(Vec2::from)).expect("finite")
}

fn cusp() -> Cubic<Vec2> {
    Cubic::new([(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)].map(Vec2::from)).expect("finite")
}

fn of_degree(degree: usize) -> AnyBezier<Vec2> {
    let points = (0..=degree).map(|k| Vec2::new(k as f64, ((k * k * 7919) % 101) as f64));
    AnyBezier::new(points.collect()).expect("finite")
}

fn evaluation(c: &mut Criterion) {
    let parameters: Vec<f64> = (0..1024).map(|k| f64::from(k) / 1023.0).collect();
    let mut out = vec![Vec2::ZERO; parameters.len()];
    let mut group = c.benchmark_group("evaluate 1024 points");
    group.throughput(Throughput::Elements(1024));
    group.bench_function("cubic, one by one", |b| {
        b.iter(|| parameters.iter().fold(Vec2::ZERO, |sum, &t| sum + black_box(&arch()).eval(t)));
    });
    for degree in [3, 10, 30, 100] {
        let curve = of_degree(degree);
        group.bench_function(format!("degree {degree}, batch"), |b| {
            b.iter(|| curve.eval_batch(black_box(&parameters), &mut out));
        });
    }
    group.finish();
}

fn measuring(c: &mut Criterion) {
    for (name, curve) in [("arch", arch()), ("cusp", cusp())] {
        c.bench_function(&format!("length to 1e-9, {name}"), |b| b.iter(|| length(black_box(&curve), 1e-9)));
        c.bench_function(&format!("nearest, {name}"), |b| {
            b.iter(|| nearest(black_box(&curve), Vec2::new(40.0, 10.0)));
        });
        c.bench_function(&format!("flatten to 0.01, {name}"), |b| {
            b.iter(|| flatten(black_box(&curve), 0.01));
        });
    }
}

fn meeting(c: &mut Criterion) {
    let mirrored = |gap: f64| arch().map(|p| Vec2::new(p.x, 90.0 + gap - p.y)).expect("finite");
    for (name, other) in
        [("crossing", mirrored(-30.0)), ("touching", mirrored(0.0)), ("apart", mirrored(1e-6))]
    {
        c.bench_function(&format!("intersect cubics, {name}"), |b| {
            b.iter(|| intersect(black_box(&arch()), &other, None));
        });
    }
}

criterion_group!(benches, evaluation, measuring, meeting);
criterion_main!(benches);
