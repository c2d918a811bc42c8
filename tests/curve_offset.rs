//! Offsets of random and hard curves against the parallel itself, measured densely from both sides.

use ogee::curve::{Arc, Cubic, Curve, CurveError, Join, Path, Piece, Subpath, offset};
use ogee::math::{Vec2, cos, exp, ln, sin};

/// Curves in the random test unless `OGEE_OFFSETS` says otherwise: enough for each run.
const CURVES: usize = 60;

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Evenly spread over orders of magnitude.
    fn size(&mut self, low: f64, high: f64) -> f64 {
        exp(self.between(ln(low), ln(high)))
    }

    fn point(&mut self) -> Vec2 {
        Vec2::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A piece of about unit size, often a nasty one.
    fn piece(&mut self) -> Piece {
        let mut points = [(); 4].map(|()| self.point());
        match (self.unit() * 7.0) as u32 {
            0 => {
                // Near a cusp: the curve with middle points that make one, and a bit.
                let [a, _, _, d] = points;
                let (x, y) = (d - a, (d - a).perp());
                let bit = self.size(1e-8, 0.1) * (self.unit() - 0.5);
                points = [a, a + x + y, a + x * bit + y, d];
            }
            1 => {
                let flat = self.size(1e-8, 0.1);
                points = points.map(|p| Vec2::new(p.x, p.y * flat));
            }
            2 => points[1] = points[0] + self.point() * self.size(1e-10, 0.1),
            3 => return Piece::Arc(self.arc()),
            _ => {}
        }
        Piece::Cubic(Cubic::new(points).unwrap())
    }

    fn arc(&mut self) -> Arc {
        let (turn, aspect) = (self.between(0.0, 6.0), self.size(1e-3, 1.0));
        let axis = Vec2::new(cos(turn), sin(turn));
        let sweep = self.between(-6.2, 6.2);
        Arc::new(self.point(), [axis, axis.perp() * aspect], self.between(-7.0, 7.0), sweep).unwrap()
    }
}

/// Point of the parallel of a piece, from its derivative as it is, and whether it runs against the piece there.
fn parallel(piece: &Piece, distance: f64, t: f64) -> (Vec2, bool) {
    let jet = match piece {
        Piece::Arc(arc) => arc.jet(t),
        Piece::Cubic(cubic) => cubic.jet(t),
        _ => unreachable!("only these are made here"),
    };
    let (speed, turn) = (jet.first.length(), jet.first.perp_dot(jet.second));
    (jet.point + (jet.first / speed).perp() * distance, speed * speed * speed < distance * turn)
}

/// Where the parallel turns back.
fn cusps(piece: &Piece, distance: f64) -> Vec<f64> {
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

/// Parameters up to and with the stops, and points, none farther than `step` from the next, or `most` in parameter.
fn samples(curve: &impl Fn(f64) -> Vec2, stops: &[f64], step: f64, most: f64) -> Vec<(f64, Vec2)> {
    let mut open: Vec<(f64, Vec2)> = stops.iter().rev().map(|&t| (t, curve(t))).collect();
    let mut done = vec![(0.0, curve(0.0))];
    while let (Some(&next), Some(&last)) = (open.last(), done.last()) {
        let wide = next.0 - last.0;
        // A whole turn begins and ends in the same place.
        if wide > most || (last.1.distance(next.1) > step && wide > 1e-15) {
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
fn distance_to(curve: &impl Fn(f64) -> Vec2, samples: &[(f64, Vec2)], point: Vec2) -> f64 {
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
fn aspect(piece: &Piece) -> f64 {
    let Piece::Arc(arc) = piece else { return 1.0 };
    let ([long, short], _) = arc.half_axes();
    short.length() / long.length()
}

/// What the measurement itself may be off by: it divides by a derivative that may nearly vanish.
fn rounding(piece: &Piece, distance: f64) -> f64 {
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

/// The largest distance from a sample of one curve to the other, over both, of about this many samples each.
fn two_sided(piece: &Piece, distance: f64, drawn: &[Piece], count: usize) -> f64 {
    let meant = |t: f64| parallel(piece, distance, t).0;
    let seen = |t: f64| {
        let u = t * drawn.len() as f64;
        let index = (u as usize).min(drawn.len() - 1);
        drawn[index].eval(u - index as f64)
    };
    // Fine enough to see every bend of the base curve, of which the parallel has an arc.
    let step = (0.1 * distance.abs()).min(0.01 * (1.0 + distance.abs()));
    let stops: Vec<f64> = cusps(piece, distance).into_iter().chain([1.0]).collect();
    let truth = samples(&meant, &stops, step, 1.0 / 64.0);
    let joints: Vec<f64> = (1..=drawn.len()).map(|k| k as f64 / drawn.len() as f64).collect();
    let have = samples(&seen, &joints, step, 1.0 / (16.0 * drawn.len() as f64));
    let some = |all: &[(f64, Vec2)]| -> Vec<Vec2> {
        all.iter().step_by((all.len() / count).max(1)).map(|&(_, point)| point).collect()
    };
    let there = some(&truth).into_iter().map(|p| distance_to(&seen, &have, p));
    let back = some(&have).into_iter().map(|p| distance_to(&meant, &truth, p));
    there.chain(back).fold(0.0, f64::max)
}

fn one(piece: Piece) -> Path {
    Path { subpaths: vec![Subpath::open(vec![piece]).unwrap()] }
}

/// `OGEE_OFFSETS=2000 cargo test --release --test curve_offset random` takes some minutes.
#[test]
fn random_parallels_are_within_what_they_report() {
    let count = std::env::var("OGEE_OFFSETS").map_or(CURVES, |count| count.parse().unwrap());
    let (mut random, mut pieces, mut fill) = (Random(11), 0, 0.0_f64);
    let mut cases = 0;
    for index in 0..count {
        let piece = random.piece();
        for _ in 0..3 {
            let distance = random.size(1e-3, 20.0) * if random.unit() < 0.5 { -1.0 } else { 1.0 };
            let mut tolerance = random.size(1e-9, 0.1);
            let drawn = |tolerance: f64| offset(&one(piece.clone()), distance, Join::Round, tolerance);
            let mut parallel = drawn(tolerance);
            if let (Piece::Arc(_), Err(CurveError::ToleranceTooFine { finest, .. })) = (&piece, &parallel) {
                // Rounding turns a flat ellipse. What is said to be possible is.
                assert!(
                    *finest < 1e-11 * distance.abs() / aspect(&piece).powi(2),
                    "{index}: {piece:?} {distance}"
                );
                tolerance = 1.001 * finest;
                parallel = drawn(tolerance);
            }
            let parallel = parallel
                .unwrap_or_else(|error| panic!("{index}: {piece:?} at {distance}, {tolerance}: {error}"));
            let drawn: Vec<Piece> = parallel.curve.pieces().cloned().collect();
            let off = two_sided(&piece, distance, &drawn, 150);
            let rounding = rounding(&piece, distance);
            assert!(
                off <= parallel.error + rounding && parallel.error <= tolerance,
                "{index}: {piece:?} at {distance}: {off} off, {} reported of {tolerance}",
                parallel.error
            );
            (pieces, cases) = (pieces + drawn.len(), cases + 1);
            fill += (off / parallel.error).min(1.0);
        }
    }
    let cases = f64::from(cases);
    println!(
        "{:.1} pieces on average, off by {:.2} of what is reported",
        pieces as f64 / cases,
        fill / cases
    );
}
