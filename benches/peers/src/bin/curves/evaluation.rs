//! Points at many parameters.

use crate::{Random, Runner, Side, flo_cubic, kurbo_cubic, lyon_cubic, python, row};
use flo_curves::BezierCurve;
use kurbo::ParamCurve;
use ogee::curve::{AnyBezier, Bernstein, evaluate::compensated};
use ogee::math::Vec2;
use std::hint::black_box;
use truck_geometry::prelude::{BSplineCurve, KnotVec, ParametricCurve, Point2};

const COUNT: usize = 1024;

fn parameters() -> Vec<f64> {
    (0..COUNT).map(|k| (k as f64 + 0.5) / COUNT as f64).collect()
}

/// The largest distance from the true points.
fn error(points: &[Vec2], parameters: &[f64], eval: impl Fn(f64) -> Vec2) -> f64 {
    let off = |&t: &f64| (eval(t) - compensated(points, t).value).length();
    parameters.iter().map(off).fold(0.0, f64::max)
}

pub(crate) fn cubics(runner: &Runner) {
    let case = "evaluate a cubic";
    if !runner.wants(case) {
        return;
    }
    let ours = Random(1).cubic();
    let (kurbo, lyon, flo) = (kurbo_cubic(&ours), lyon_cubic(&ours), flo_cubic(&ours));
    let parameters = parameters();
    let points = ours.points();
    let mut out = vec![Vec2::ZERO; COUNT];
    ours.eval_batch(&parameters, &mut out);
    let batch = |t: f64| out[((t * COUNT as f64) - 0.5) as usize];
    let errors = [
        error(points, &parameters, batch),
        error(points, &parameters, |t| Vec2::new(kurbo.eval(t).x, kurbo.eval(t).y)),
        error(points, &parameters, |t| Vec2::new(lyon.sample(t).x, lyon.sample(t).y)),
        error(points, &parameters, |t| Vec2::new(flo.point_at_pos(t).0, flo.point_at_pos(t).1)),
    ];
    // Sixteen times over, so that the clock's own steps do not show.
    let (p, mut ours_out) = (&parameters, vec![Vec2::ZERO; COUNT]);
    let mut kurbo_out = vec![kurbo::Point::ZERO; COUNT];
    let mut lyon_out = vec![lyon_geom::point(0.0, 0.0); COUNT];
    let mut flo_out = vec![flo_curves::Coord2(0.0, 0.0); COUNT];
    let sides = vec![
        Side::new("ogee", errors[0], || {
            for _ in 0..16 {
                black_box(&ours).eval_batch(black_box(p), &mut ours_out);
                black_box(&ours_out);
            }
        }),
        Side::new("kurbo", errors[1], || {
            for _ in 0..16 {
                let curve = black_box(kurbo);
                kurbo_out.iter_mut().zip(black_box(p)).for_each(|(out, &t)| *out = curve.eval(t));
                black_box(&kurbo_out);
            }
        }),
        Side::new("lyon_geom", errors[2], || {
            for _ in 0..16 {
                let curve = black_box(lyon);
                lyon_out.iter_mut().zip(black_box(p)).for_each(|(out, &t)| *out = curve.sample(t));
                black_box(&lyon_out);
            }
        }),
        Side::new("flo_curves", errors[3], || {
            for _ in 0..16 {
                let curve = black_box(flo);
                flo_out.iter_mut().zip(black_box(p)).for_each(|(out, &t)| *out = curve.point_at_pos(t));
                black_box(&flo_out);
            }
        }),
    ];
    runner.compare(case, "point", 16 * COUNT, sides);
}

pub(crate) fn high_degrees(runner: &Runner) {
    for degree in [10, 30, 100] {
        let case = format!("evaluate degree {degree}");
        if runner.wants(&case) {
            high_degree(runner, &case, degree);
        }
    }
}

fn high_degree(runner: &Runner, case: &str, degree: usize) {
    let mut random = Random(degree as u64);
    let points: Vec<Vec2> = (0..=degree).map(|_| random.point()).collect();
    let ours = AnyBezier::new(points.clone()).expect("finite");
    let parameters = parameters();
    let truck = BSplineCurve::new(
        KnotVec::bezier_knot(degree),
        points.iter().map(|p| Point2::new(p.x, p.y)).collect::<Vec<_>>(),
    );
    let knots = [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let curvo = curvo::prelude::NurbsCurve2D::<f64>::try_new(
        degree,
        points.iter().map(|p| nalgebra::Point3::new(p.x, p.y, 1.0)).collect(),
        knots,
    )
    .expect("a curve");
    let mut out = vec![Vec2::ZERO; COUNT];
    ours.eval_batch(&parameters, &mut out);
    let batch = |t: f64| out[((t * COUNT as f64) - 0.5) as usize];
    let ours_error = error(&points, &parameters, batch);
    let truck_error = error(&points, &parameters, |t| Vec2::new(truck.subs(t).x, truck.subs(t).y));
    let curvo_error = error(&points, &parameters, |t| Vec2::new(curvo.point_at(t).x, curvo.point_at(t).y));
    let few = &parameters[..COUNT / 16];
    // The peers are so slow that they get a sixteenth of the points, on average as hard as all.
    let strided: Vec<f64> = parameters.iter().copied().step_by(16).collect();
    assert_eq!(few.len(), strided.len());
    let p = &parameters;
    let mut ours_out = vec![Vec2::ZERO; COUNT];
    let sides = vec![
        Side::new("ogee", ours_error, || {
            black_box(&ours).eval_batch(black_box(p), &mut ours_out);
            black_box(&ours_out);
        }),
        Side::new("curvo", curvo_error, || {
            for _ in 0..16 {
                black_box(strided.iter().map(|&t| black_box(&curvo).point_at(t).x).sum::<f64>());
                if degree > 10 {
                    break;
                }
            }
        }),
        Side::new("truck", truck_error, || {
            for _ in 0..16 {
                black_box(strided.iter().map(|&t| black_box(&truck).subs(t).x).sum::<f64>());
                if degree > 10 {
                    break;
                }
            }
        }),
    ];
    let mut best = vec![f64::INFINITY; sides.len()];
    let mut sides = sides;
    for _ in 0..runner.options.rounds {
        for (k, side) in sides.iter_mut().enumerate() {
            let count = if k > 0 && degree > 10 { COUNT / 16 } else { COUNT };
            let start = cpu_time::ProcessTime::now();
            (side.work)();
            best[k] = best[k].min(start.elapsed().as_secs_f64() * 1e9 / count as f64);
        }
    }
    for k in 1..sides.len() {
        row(case, sides[k].name, "point", (best[0], ours_error), (best[k], sides[k].error));
    }
    if let Some((nanoseconds, values)) = python::evaluation(runner, &points, &parameters) {
        let off = |(v, &t): (&Vec2, &f64)| (*v - compensated(&points, t).value).length();
        let worst = values.iter().zip(&parameters).map(off).fold(0.0, f64::max);
        row(case, "Python bezier", "point", (best[0], ours_error), (nanoseconds, worst));
    }
}
