//! Exact signs: where doubles decide, and where only integers can.
#![allow(missing_docs, reason = "criterion's macros make functions without")]

use criterion::{Criterion, criterion_group, criterion_main};
use ogee::polygon::exact::{Plane, PointId, Points};
use std::hint::black_box;

/// Three planes in general position, and points: a lattice point beside the first plane, one on it, and where all meet.
struct Scene {
    points: Points,
    planes: [Plane; 3],
    beside: PointId,
    on: PointId,
    meeting: PointId,
}

fn scene() -> Scene {
    const M: i64 = 1 << 52;
    let corners = [[0, 0, 0], [M, 3, 7], [5, M - 1, 11], [13, 17, M - 9], [M / 3, M / 5, M / 7]];
    let plane =
        |i: usize, j: usize, k: usize| Plane::through(corners[i], corners[j], corners[k]).expect("a plane");
    let planes = [plane(0, 1, 2), plane(1, 3, 4), plane(2, 3, 4)];
    let mut points = Points::default();
    let (beside, on) = (points.site(corners[3]), points.site([M, 3, 7]));
    let meeting = points.meeting(&planes[0], &planes[1], &planes[2]).expect("one point");
    Scene { points, planes, beside, on, meeting }
}

fn predicates(c: &mut Criterion) {
    let scene = scene();
    let mut group = c.benchmark_group("predicates");
    for (name, point) in
        [("decided by doubles", scene.beside), ("on it", scene.on), ("where three meet", scene.meeting)]
    {
        group.bench_function(format!("side of a plane, {name}"), |b| {
            b.iter(|| black_box(&scene.planes[0]).side(&scene.points, black_box(point)));
        });
    }
    group.bench_function("orientation, exact", |b| {
        b.iter(|| scene.points.orientation(black_box(scene.on), scene.meeting, black_box(scene.meeting), 2));
    });
    group.bench_function("meeting of three planes", |b| {
        b.iter_batched_ref(
            Points::default,
            |points| points.meeting(black_box(&scene.planes[0]), &scene.planes[1], &scene.planes[2]),
            criterion::BatchSize::SmallInput,
        );
    });
    group.finish();
}

criterion_group!(benches, predicates);
criterion_main!(benches);
