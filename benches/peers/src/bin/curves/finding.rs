//! Nearest points and intersections.

use crate::roots::{BITS, Curve, eliminated, integers, monomials, roots, value};
use crate::{Random, Runner, Side, flo_cubic, kurbo_cubic, lyon_cubic, python, row};
use kurbo::ParamCurveNearest;
use num_bigint::BigInt;
use num_traits::Signed;
use ogee::curve::{Bernstein, Contact, Cubic, intersect, nearest, nearest_all};
use ogee::math::Vec2;
use std::hint::black_box;

type Query = (Cubic<Vec2>, Vec2);
type FindNearest = fn(&Query) -> f64;

pub(crate) fn nearest_points(runner: &Runner) {
    let case = "nearest point";
    if !runner.wants(case) {
        return;
    }
    let mut random = Random(4);
    let queries: Vec<Query> = (0..1000).map(|_| (random.cubic(), random.point())).collect();
    let sides: [(&'static str, FindNearest); 3] = [
        ("ogee", |(curve, p)| nearest(curve, *p).expect("finite").t),
        ("kurbo", |(curve, p)| kurbo_cubic(curve).nearest(kurbo::Point::new(p.x, p.y), 1e-9).t),
        ("flo_curves", |(curve, p)| {
            flo_curves::bezier::nearest_point_on_curve(&flo_cubic(curve), &flo_curves::Coord2(p.x, p.y))
        }),
    ];
    let distance = |(curve, p): &Query, t: f64| (curve.eval(t) - *p).length();
    let best: Vec<f64> = queries
        .iter()
        .map(|query| {
            let all = nearest_all(&query.0, query.1).expect("finite");
            all.iter().map(|near| near.distance.value).fold(f64::INFINITY, f64::min)
        })
        .collect();
    let sides = sides.map(|(name, find)| {
        let excess = queries.iter().zip(&best).map(|(query, best)| distance(query, find(query)) - best);
        let worst = excess.fold(0.0, f64::max);
        let queries = &queries;
        Side::new(name, worst, move || {
            black_box(black_box(queries).iter().map(find).sum::<f64>());
        })
    });
    runner.compare(case, "distance", queries.len(), sides.into());
}

type Pair = [Cubic<Vec2>; 2];
type FindMeetings = fn(&Pair) -> Vec<(f64, f64)>;

fn ours([a, b]: &Pair) -> Vec<(f64, f64)> {
    intersect(a, b, None).expect("cubics").iter().map(|m| (m.first[0], m.second[0])).collect()
}

fn lyon([a, b]: &Pair) -> Vec<(f64, f64)> {
    lyon_cubic(a).cubic_intersections_t(&lyon_cubic(b)).to_vec()
}

fn flo([a, b]: &Pair) -> Vec<(f64, f64)> {
    flo_curves::bezier::curve_intersects_curve_clip(&flo_cubic(a), &flo_cubic(b), 1e-6).to_vec()
}

pub(crate) fn intersections(runner: &Runner) {
    let mut random = Random(5);
    let anywhere: Vec<Pair> = (0..1000).map(|_| [random.cubic(), random.cubic()]).collect();
    let small = |random: &mut Random| {
        let (middle, arm) = (random.point(), 0.2);
        let near = random.cubic();
        near.map(|p| middle + (p - middle) * arm).expect("finite")
    };
    let apart: Vec<Pair> = (0..1000).map(|_| [small(&mut random), small(&mut random)]).collect();
    let touching: Vec<Pair> = (0..200).map(|_| tangent(&mut random)).collect();
    for (case, pairs) in [
        ("intersect random cubics", anywhere),
        ("intersect small cubics, mostly apart", apart),
        ("intersect cubics that nearly touch", touching),
    ] {
        if runner.wants(case) {
            meetings(runner, case, &pairs);
        }
    }
}

/// A curve and another one turned and moved to touch it within rounding.
fn tangent(random: &mut Random) -> Pair {
    let [a, b] = [random.cubic(), random.cubic()];
    let (s, t) = (random.unit(), random.unit());
    let of = |c: &Cubic<Vec2>, t: f64| (c.eval(t), c.derivative(1).expect("finite").eval(t).normalize());
    let ((p, v), (q, w)) = (of(&a, s), of(&b, t));
    let turn = Vec2::new(v.dot(w), w.perp_dot(v));
    [a, b.map(|x| p + turn.rotate(x - q)).expect("finite")]
}

fn meetings(runner: &Runner, case: &str, pairs: &[Pair]) {
    let want: Vec<Vec<(f64, f64)>> = pairs.iter().map(truth).collect();
    let wrong = |found: &[Vec<(f64, f64)>]| -> f64 {
        let bad = found.iter().zip(&want).filter(|(found, want)| !agree(found, want)).count();
        bad as f64 / pairs.len() as f64
    };
    let all = |find: FindMeetings| pairs.iter().map(find).collect::<Vec<_>>();
    let sides: [(&'static str, FindMeetings); 3] = [("ogee", ours), ("lyon_geom", lyon), ("flo_curves", flo)];
    let ours_wrong = wrong(&all(ours));
    // Results are counted and not kept, on every side.
    let count: [fn(&Pair) -> usize; 3] = [
        |[a, b]| {
            intersect(a, b, None).expect("cubics").iter().filter(|m| m.contact != Contact::Overlap).count()
        },
        |[a, b]| lyon_cubic(a).cubic_intersections_t(&lyon_cubic(b)).len(),
        |[a, b]| flo_curves::bezier::curve_intersects_curve_clip(&flo_cubic(a), &flo_cubic(b), 1e-6).len(),
    ];
    let sides = sides.into_iter().zip(count).map(|((name, find), count)| {
        Side::new(name, wrong(&all(find)), move || {
            black_box(black_box(pairs).iter().map(count).sum::<usize>());
        })
    });
    runner.compare(case, "share of pairs with a wrong answer", pairs.len(), sides.collect());
    if let Some((nanoseconds, found)) = python::intersections(runner, pairs) {
        let mut best = f64::INFINITY;
        for _ in 0..runner.options.rounds {
            let start = cpu_time::ProcessTime::now();
            black_box(black_box(pairs).iter().map(count[0]).sum::<usize>());
            best = best.min(start.elapsed().as_secs_f64() * 1e9 / pairs.len() as f64);
        }
        let errors = (ours_wrong, wrong(&found));
        row(
            case,
            "Python bezier",
            "share of pairs with a wrong answer",
            (best, errors.0),
            (nanoseconds, errors.1),
        );
    }
}

/// Whether there are as many, and each one has its own within 1e-5.
fn agree(found: &[(f64, f64)], want: &[(f64, f64)]) -> bool {
    let mut rest = want.to_vec();
    found.len() == want.len()
        && found.iter().all(|f| {
            let off = |w: &(f64, f64)| (f.0 - w.0).abs().max((f.1 - w.1).abs());
            let place = (0..rest.len()).min_by(|&i, &j| off(&rest[i]).total_cmp(&off(&rest[j])));
            place.is_some_and(|i| off(&rest.swap_remove(i)) < 1e-5)
        })
}

/// The meetings by elimination in integers.
fn truth([a, b]: &Pair) -> Vec<(f64, f64)> {
    let numbers: Vec<f64> = a.points().iter().chain(b.points()).flat_map(|p| [p.x, p.y]).collect();
    let whole = integers(&numbers).0;
    let curve = |from: usize| -> Curve {
        [0, 1].map(|axis| monomials(&(0..4).map(|k| whole[from + 2 * k + axis].clone()).collect::<Vec<_>>()))
    };
    let (a, b) = (curve(0), curve(8));
    let limit = (whole.iter().map(|x| x.abs()).max().expect("numbers") + 1) << (BITS - 120);
    let near =
        |s: &BigInt, t: &BigInt| (0..2).all(|axis| (value(&a[axis], s) - value(&b[axis], t)).abs() < limit);
    let (on_a, on_b) = (roots(&eliminated(&a, &b)), roots(&eliminated(&b, &a)));
    let pairs = on_a.iter().flat_map(|s| on_b.iter().map(move |t| (s, t)));
    pairs.filter(|(s, t)| near(&s.low, &t.low)).map(|(s, t)| (s.to_f64(), t.to_f64())).collect()
}
