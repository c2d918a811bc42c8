//! The script language: parsing and evaluation, nothing built.
#![allow(missing_docs, reason = "criterion's macros make functions without")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ogee::mesh::Mesh;
use ogee::script::{Host, Loaded, Message, Options, evaluate};
use std::hint::black_box;
use std::sync::Arc;

/// Scripts that need nothing from outside.
struct Alone;

impl Host for Alone {
    fn script(&mut self, name: &str, _from: &str) -> Result<Loaded, String> {
        Err(format!("there is no {name}"))
    }

    fn mesh(&mut self, name: &str, _from: &str) -> Result<Arc<Mesh>, String> {
        Err(format!("there is no {name}"))
    }

    fn say(&mut self, message: Message) {
        black_box(message);
    }
}

fn run(text: &str) {
    let main = Loaded { name: "bench.scad".into(), text: text.into() };
    black_box(evaluate(main, &mut Alone, &Options::default()).expect("a sound script"));
}

fn scripts(c: &mut Criterion) {
    let long: String = (0..2000)
        .map(|i| format!("module m{i}(x, y = {i}) {{ translate([x, y, {i}]) cube(y + 1); }}\n"))
        .collect();
    let cases = [
        (
            "a sum in a list",
            "total = [for (s = 0, i = 0; i < 100000; s = s + i * 0.5, i = i + 1) s];".to_owned(),
        ),
        ("tail calls", "function down(n) = n == 0 ? 0 : down(n - 1); x = down(100000);".to_owned()),
        ("recursion", "function fib(n) = n < 2 ? n : fib(n - 1) + fib(n - 2); x = fib(18);".to_owned()),
        ("vectors", "x = [for (i = [0:20000]) [cos(i), sin(i), i] * 2 + [1, 2, 3]];".to_owned()),
        ("modules", "for (i = [0:2000]) translate([i, 0, 0]) rotate(i) cube(1);".to_owned()),
    ];
    let mut group = c.benchmark_group("script");
    for (name, text) in &cases {
        group.bench_function(*name, |b| b.iter(|| run(text)));
    }
    group.throughput(Throughput::Bytes(long.len() as u64));
    group.bench_function("parsing", |b| b.iter(|| run(&long)));
    group.finish();
}

criterion_group!(benches, scripts);
criterion_main!(benches);
