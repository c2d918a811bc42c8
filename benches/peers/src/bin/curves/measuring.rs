//! Flattening and arc length.

use crate::{Random, Runner, Side, cubic, flo_cubic, kurbo_cubic, lyon_cubic};
use kurbo::{ParamCurveArclen, PathEl};
use ogee::curve::{Bernstein, Cubic, length};
use ogee::math::Vec2;
use ogee::tessellate::flatten;
use std::hint::black_box;

const TOLERANCES: [f64; 3] = [1.0, 0.1, 0.01];

/// Segments by Wang's formula.
fn wang(curve: &Cubic<Vec2>, tolerance: f64) -> f64 {
    let [a, b, c, d] = curve.to_array();
    let second = (a - b * 2.0 + c).length().max((b - c * 2.0 + d).length());
    (0.75 * second / tolerance).sqrt().ceil().max(1.0)
}

/// The distance of curve and polyline in the sense of Fréchet over the tolerance, by dense samples: walked together from
/// end to end, never back, in the way that keeps them nearest to one another. (The nearest chord alone would overlook
/// turns that are cut off; the next chord as soon as it is nearer goes astray at loops.)
fn violation(curve: &Cubic<Vec2>, points: &[Vec2], tolerance: f64) -> f64 {
    const SAMPLES: u32 = 1000;
    let mut worst = vec![f64::INFINITY; points.len() - 1];
    worst[0] = 0.0;
    for k in 0..=SAMPLES {
        let p = curve.eval(f64::from(k) / f64::from(SAMPLES));
        let mut reachable = f64::INFINITY;
        for (i, worst) in worst.iter_mut().enumerate() {
            // Samples up to here end on this chord or on one before it.
            reachable = reachable.min(*worst);
            let (a, b) = (points[i], points[i + 1]);
            let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let distance = (p - a - (b - a) * if along.is_nan() { 0.0 } else { along }).length();
            *worst = reachable.max(distance);
        }
    }
    worst[worst.len() - 1] / tolerance
}

fn kurbo_points(curve: &Cubic<Vec2>, tolerance: f64) -> Vec<Vec2> {
    let bezier = kurbo_cubic(curve);
    let path = [PathEl::MoveTo(bezier.p0), PathEl::CurveTo(bezier.p1, bezier.p2, bezier.p3)];
    let mut points = Vec::new();
    kurbo::flatten(path, tolerance, |element| {
        if let PathEl::MoveTo(p) | PathEl::LineTo(p) = element {
            points.push(Vec2::new(p.x, p.y));
        }
    });
    points
}

fn lyon_points(curve: &Cubic<Vec2>, tolerance: f64) -> Vec<Vec2> {
    let mut points = vec![curve.start()];
    lyon_cubic(curve).for_each_flattened(tolerance, &mut |line| points.push(Vec2::new(line.to.x, line.to.y)));
    points
}

pub(crate) fn flattening(runner: &Runner) {
    let case = "flatten";
    if !runner.wants(case) {
        return;
    }
    let mut random = Random(2);
    let curves: Vec<(Cubic<Vec2>, f64)> = (0..10_000).map(|k| (random.cubic(), TOLERANCES[k % 3])).collect();
    let all: f64 = curves.iter().map(|(curve, tolerance)| wang(curve, *tolerance)).sum();
    type Flatten = fn(&Cubic<Vec2>, f64) -> Vec<Vec2>;
    let ours: Flatten = |curve, tolerance| flatten(curve, tolerance).expect("a tolerance").points;
    let sides: [(&'static str, Flatten); 3] =
        [("ogee", ours), ("kurbo", kurbo_points), ("lyon_geom", lyon_points)];
    let share = |f: Flatten| curves.iter().map(|(c, tol)| (f(c, *tol).len() - 1) as f64).sum::<f64>() / all;
    let worst = |f: Flatten| {
        curves.iter().step_by(10).map(|(c, tol)| violation(c, &f(c, *tol), *tol)).fold(0.0, f64::max)
    };
    for (name, f) in sides {
        eprintln!("flatten, {name}: at worst {:.3} of the tolerance", worst(f));
    }
    let work = |(name, f): &(&'static str, Flatten)| {
        let (f, curves) = (*f, &curves);
        Side::new(*name, share(f), move || {
            black_box(
                curves.iter().map(|(curve, tolerance)| f(black_box(curve), *tolerance).len()).sum::<usize>(),
            );
        })
    };
    runner.compare(case, "segments over Wang's", curves.len(), sides.iter().map(work).collect());
}

pub(crate) fn lengths(runner: &Runner) {
    let points = |row: [(f64, f64); 4]| cubic(row.map(Vec2::from));
    let cusp = points([(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)]);
    let near_cusp = points([(0.0, 0.0), (100.0, 100.0), (1e-6, 100.0), (100.0, 0.0)]);
    let arch = points([(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)]);
    let mut random = Random(3);
    let many: Vec<Cubic<Vec2>> = (0..1000).map(|_| random.cubic()).collect();
    for (case, curves) in [
        ("length to 1e-9 of an arch", vec![arch; 1000]),
        ("length to 1e-9 of a cusp", vec![cusp; 1000]),
        ("length to 1e-9 of a near cusp", vec![near_cusp; 1000]),
        ("length to 1e-9 of random cubics", many),
    ] {
        if runner.wants(case) {
            one_length(runner, case, &curves);
        }
    }
}

fn one_length(runner: &Runner, case: &str, curves: &[Cubic<Vec2>]) {
    let sure: Vec<f64> =
        curves.iter().map(|curve| length(curve, 1e-13).expect("an accuracy").value).collect();
    let error = |f: &dyn Fn(&Cubic<Vec2>) -> f64| {
        curves.iter().zip(&sure).map(|(curve, sure)| (f(curve) - sure).abs()).fold(0.0, f64::max)
    };
    let ours = |curve: &Cubic<Vec2>| length(curve, 1e-9).expect("an accuracy").value;
    let kurbo = |curve: &Cubic<Vec2>| kurbo_cubic(curve).arclen(1e-9);
    let flo = |curve: &Cubic<Vec2>| flo_curves::bezier::curve_length(&flo_cubic(curve), 1e-6);
    let few = &curves[..20];
    let sum = |f: &dyn Fn(&Cubic<Vec2>) -> f64, curves: &[Cubic<Vec2>]| {
        black_box(black_box(curves).iter().map(f).sum::<f64>());
    };
    let sides = vec![
        Side::new("ogee", error(&ours), || sum(&ours, curves)),
        Side::new("kurbo", error(&kurbo), || sum(&kurbo, curves)),
        Side::new("flo_curves at 1e-6", error(&flo), || {
            (0..curves.len() / few.len()).for_each(|_| sum(&flo, few))
        }),
    ];
    runner.compare(case, "length", curves.len(), sides);
}
