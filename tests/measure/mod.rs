//! Distances between curves, measured densely from both sides and by nothing but their points and derivatives.

use ogee::curve::{Curve, Piece};
use ogee::math::Vec2;

/// Point of the parallel of a piece, from its derivative as it is, and whether it runs against the piece there.
pub(crate) fn parallel(piece: &Piece, distance: f64, t: f64) -> (Vec2, bool) {
    let jet = match piece {
        Piece::Arc(arc) => arc.jet(t),
        Piece::Cubic(cubic) => cubic.jet(t),
        _ => unreachable!("only these are made here"),
    };
    let (speed, turn) = (jet.first.length(), jet.first.perp_dot(jet.second));
    (jet.point + (jet.first / speed).perp() * distance, speed * speed * speed < distance * turn)
}

/// Where the parallel turns back.
pub(crate) fn cusps(piece: &Piece, distance: f64) -> Vec<f64> {
    let runs_back = |t: f64| parallel(piece, distance, t).1;
    let mut cusps = Vec::new();
    for k in 0..2000 {
        let [mut low, mut high] = [k, k + 1].map(|k| f64::from(k) / 2000.0);
        let before = runs_back(low);
        if runs_back(high) != before {
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if runs_back(middle) == before { low = middle } else { high = middle }
            }
            cusps.push(high);
        }
    }
    cusps
}

/// Parameters up to and with the stops, and points, no two neighbours so far from one another that they are to be
/// split.
pub(crate) fn samples(
    curve: &impl Fn(f64) -> Vec2,
    stops: &[f64],
    is_far: impl Fn([f64; 2], [Vec2; 2]) -> bool,
) -> Vec<(f64, Vec2)> {
    let mut open: Vec<(f64, Vec2)> = stops.iter().rev().map(|&t| (t, curve(t))).collect();
    let mut done = vec![(0.0, curve(0.0))];
    while let (Some(&next), Some(&last)) = (open.last(), done.last()) {
        let wide = next.0 - last.0;
        if wide > 1e-15 && is_far([last.0, next.0], [last.1, next.1]) {
            let middle = 0.5 * (last.0 + next.0);
            open.push((middle, curve(middle)));
        } else {
            done.push(next);
            open.pop();
        }
    }
    done
}

/// How far a point is from a curve, given samples of it: by thirds between neighbours wherever that could be nearer
/// than the best so far. A curve may run back beside itself.
pub(crate) fn distance_to(curve: &impl Fn(f64) -> Vec2, samples: &[(f64, Vec2)], point: Vec2) -> f64 {
    let far: Vec<f64> = samples.iter().map(|sample| sample.1.distance(point)).collect();
    let mut best = far.iter().copied().fold(f64::INFINITY, f64::min);
    for k in 1..samples.len() {
        let [(mut low, a), (mut high, b)] = [samples[k - 1], samples[k]];
        if 0.5 * (far[k - 1] + far[k] - 1.5 * a.distance(b)) > best {
            continue;
        }
        for _ in 0..45 {
            let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            let [a, b] = thirds.map(|t| curve(t).distance_squared(point));
            if a < b { high = thirds[1] } else { low = thirds[0] }
        }
        best = best.min(curve(0.5 * (low + high)).distance(point));
    }
    best
}

/// The ratio of the half-axes; 1 for what is no arc.
pub(crate) fn aspect(piece: &Piece) -> f64 {
    let Piece::Arc(arc) = piece else { return 1.0 };
    let ([long, short], _) = arc.half_axes();
    short.length() / long.length()
}

/// What the measurement itself may be off by: it divides by a derivative that may nearly vanish.
pub(crate) fn rounding(piece: &Piece, distance: f64) -> f64 {
    let speed = |t: f64| match piece {
        Piece::Cubic(cubic) => cubic.jet(t).first.length(),
        _ => aspect(piece),
    };
    let (mut low, mut high) = (0.0, 1.0);
    let at = |k: i32| f64::from(k) / 2000.0;
    if let Some(slowest) = (0..=2000).min_by(|&a, &b| speed(at(a)).total_cmp(&speed(at(b)))) {
        (low, high) = (at((slowest - 1).max(0)), at((slowest + 1).min(2000)));
    }
    for _ in 0..60 {
        let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if speed(thirds[0]) < speed(thirds[1]) { high = thirds[1] } else { low = thirds[0] }
    }
    1e-13 + 1e-14 * distance.abs() / speed(0.5 * (low + high))
}

/// The largest distance from a sample of the parallel of a piece to what was drawn for it and back, over both, of about
/// this many samples each.
pub(crate) fn two_sided(piece: &Piece, distance: f64, drawn: &[Piece], count: usize) -> f64 {
    let meant = |t: f64| parallel(piece, distance, t).0;
    let step = 0.01 * (1.0 + distance.abs());
    // Fine enough to see every bend of the base curve, of which the parallel has an arc.
    let normal = |t: f64, point: Vec2| (point - piece.eval(t)) / distance;
    let is_far = |[s, t]: [f64; 2], [a, b]: [Vec2; 2]| {
        t - s > 1.0 / 64.0 || a.distance(b) > step || normal(s, a).distance(normal(t, b)) > 0.01
    };
    let stops: Vec<f64> = cusps(piece, distance).into_iter().chain([1.0]).collect();
    between(&meant, &samples(&meant, &stops, is_far), drawn, step, count)
}

/// The same for any curve over [0, 1], given samples of it.
pub(crate) fn between(
    meant: &impl Fn(f64) -> Vec2,
    truth: &[(f64, Vec2)],
    drawn: &[Piece],
    step: f64,
    count: usize,
) -> f64 {
    let pieces = drawn.len() as f64;
    let seen = |t: f64| {
        let index = ((t * pieces) as usize).min(drawn.len() - 1);
        drawn[index].eval(t * pieces - index as f64)
    };
    let joints: Vec<f64> = (1..=drawn.len()).map(|k| k as f64 / pieces).collect();
    let is_far = |[s, t]: [f64; 2], [a, b]: [Vec2; 2]| (t - s) * pieces > 1.0 / 16.0 || a.distance(b) > step;
    let have = samples(&seen, &joints, is_far);
    let some = |all: &[(f64, Vec2)]| -> Vec<Vec2> {
        all.iter().step_by((all.len() / count).max(1)).map(|&(_, point)| point).collect()
    };
    let there = some(truth).into_iter().map(|p| distance_to(&seen, &have, p));
    let back = some(&have).into_iter().map(|p| distance_to(meant, truth, p));
    there.chain(back).fold(0.0, f64::max)
}
