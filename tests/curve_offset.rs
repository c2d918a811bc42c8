//! Offsets of random and hard curves against the parallel itself, measured densely from both sides.
#![allow(clippy::print_stdout, reason = "figures for who asks with --nocapture")]

mod measure;

use measure::{aspect, rounding, two_sided};
use ogee::curve::{Arc, Cap, Cubic, CurveError, Join, Path, Piece, Stroke, Subpath, offset, stroke};
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
            let drawn = |tolerance: f64| offset(&one(piece), distance, Join::Round, tolerance);
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

/// Answers or typed errors, never a panic, in bounded time: for every kind of wrong, degenerate and extreme input.
#[test]
fn hostile_paths_get_answers_or_typed_errors() {
    let start = std::time::Instant::now();
    let cubic = |points: [(f64, f64); 4]| Piece::Cubic(Cubic::new(points.map(Vec2::from)).unwrap());
    let closed = |piece: Piece| Path { subpaths: vec![Subpath::closed(vec![piece]).unwrap()] };
    let circle = |radius: f64| closed(Arc::ellipse(Vec2::ZERO, Vec2::splat(radius)).unwrap().into());
    let mut random = Random(77);
    let scribble: Vec<Vec2> = (0..300).map(|_| random.point()).collect();
    let zero = Vec2::ZERO;
    let steps = [zero, zero, Vec2::X, Vec2::X, Vec2::ONE, Vec2::ONE, zero, zero];
    let paths = [
        ("circle", circle(1.0)),
        ("point", Path { subpaths: vec![Subpath::polyline(&[zero, zero], true).unwrap()] }),
        ("double-back", one(cubic([(0.0, 0.0), (2.0, 0.0), (-1.0, 0.0), (1.0, 0.0)]))),
        ("double-back, nearly", one(cubic([(0.0, 0.0), (2.0, 1e-13), (-1.0, 0.0), (1.0, 0.0)]))),
        ("cusp", one(cubic([(0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)]))),
        ("cusps at both ends", one(cubic([(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 0.0)]))),
        ("drop", closed(cubic([(0.0, 0.0), (1.2, 1.0), (-1.2, 1.0), (0.0, 0.0)]))),
        ("eight", closed(cubic([(0.0, 0.0), (4.0, 1.0), (-4.0, 1.0), (0.0, 0.0)]))),
        ("scribble", Path { subpaths: vec![Subpath::polyline(&scribble, true).unwrap()] }),
        ("repeated points", Path { subpaths: vec![Subpath::polyline(&steps, true).unwrap()] }),
        ("flat arc", one(Arc::new(zero, [Vec2::X, Vec2::X * 0.5], 0.3, 5.0).unwrap().into())),
        ("almost flat arc", one(Arc::new(zero, [Vec2::X, Vec2::new(0.5, 1e-12)], 0.3, 5.0).unwrap().into())),
        ("tiny beside huge", one(cubic([(0.0, 0.0), (1e-200, 0.0), (1e-200, 1e-200), (1.0, 1e-200)]))),
    ];
    let styles = |width: f64| {
        let joins =
            [Join::Round, Join::Bevel, Join::Miter { limit: 1.0 }, Join::Miter { limit: f64::INFINITY }];
        let caps = [Cap::Butt, Cap::Round, Cap::Square];
        let dashes = [(vec![], 0.0), (vec![0.0, 0.3], -0.1), (vec![0.25, 0.0, 0.0, 0.1, 0.2], -1e12)];
        let make = move |(join, k): (Join, usize)| Stroke {
            width,
            join,
            cap: caps[k % 3],
            dashes: dashes[k / 3].0.clone(),
            phase: dashes[k / 3].1,
        };
        joins.into_iter().flat_map(|join| (0..9).map(move |k| (join, k))).map(make)
    };
    for (name, path) in &paths {
        for distance in [0.0, 1e-300, 1e-9, 0.3, 1.0, 1e6, 1e300] {
            for tolerance in [1e-9, 1e-3, 1e3] {
                for distance in [distance, -distance] {
                    match offset(path, distance, Join::Miter { limit: 4.0 }, tolerance) {
                        Ok(parallel) => assert!(parallel.error <= tolerance, "{name}"),
                        Err(CurveError::ToleranceTooFine { finest, .. }) => {
                            assert!(finest > tolerance, "{name}");
                        }
                        Err(error) => panic!("{name} at {distance}, {tolerance}: {error}"),
                    }
                }
            }
        }
        for width in [1e-9, 0.2, 2.0, 100.0] {
            for style in styles(width) {
                match stroke(path, &style, 1e-4) {
                    Ok(outline) => assert!(outline.error <= 1e-4, "{name}"),
                    Err(CurveError::ToleranceTooFine { .. }) if name.contains("flat arc") => {}
                    Err(error) => panic!("{name}, {style:?}: {error}"),
                }
            }
        }
        println!("{name}: {:?}", start.elapsed());
    }
    // Where the radius of curvature is the distance the whole parallel is one point, but for rounding.
    for change in [0.0, 1e-15, -1e-15, 1e-12, 1e-9, -1e-9, 1e-6] {
        let collapsed = offset(&circle(1.0), 1.0 + change, Join::Round, 1e-5).unwrap();
        for piece in collapsed.curve.pieces() {
            assert!(piece.eval(0.3).length() <= collapsed.error + change.abs(), "{change}");
        }
    }
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

/// The direction of a loop smaller than anything that the tolerance can see still tells which way the parallel turns:
/// by more than half a turn, through where the loop goes.
#[test]
fn a_loop_too_small_to_see_turns_the_parallel_its_own_way() {
    for bit in [1e-6, -1e-6, 1e-5, -1e-5] {
        let points = [(0.0, 0.0), (100.0, 100.0), (bit, 100.0), (100.0, 0.0)].map(Vec2::from);
        let piece = Piece::Cubic(Cubic::new(points).unwrap());
        for distance in [7.0, -7.0] {
            let parallel = offset(&one(piece), distance, Join::Round, 1e-2).unwrap();
            let drawn: Vec<Piece> = parallel.curve.pieces().cloned().collect();
            let off = two_sided(&piece, distance, &drawn, 400);
            assert!(
                off <= parallel.error + 100.0 * rounding(&piece, distance),
                "{bit}: {off} {}",
                parallel.error
            );
        }
    }
}

/// A miter reaches as far as its limit says and no farther; zero-length segments make no corner.
#[test]
fn miters_and_closed_strokes() {
    for (angle, limit, is_pointed) in
        [(0.4, 5.0, false), (0.4, 5.1, true), (1.5, 1.46, false), (1.5, 1.47, true)]
    {
        // The tip is 1 / sin(angle / 2) half widths from the corner: 5.033 and 1.467.
        let corner = [Vec2::X * 10.0, Vec2::ZERO, Vec2::ZERO, Vec2::new(cos(angle), sin(angle)) * 10.0];
        let path = Path { subpaths: vec![Subpath::polyline(&corner, false).unwrap()] };
        let style = Stroke { join: Join::Miter { limit }, cap: Cap::Butt, ..Stroke::round(2.0) };
        let outline = stroke(&path, &style, 1e-6).unwrap().curve;
        let tip =
            outline.pieces().map(|piece| piece.start().dot(-Vec2::new(cos(0.5 * angle), sin(0.5 * angle))));
        let farthest = tip.fold(0.0, f64::max);
        let expected = if is_pointed { 1.0 / sin(0.5 * angle) } else { sin(0.5 * angle) };
        assert!((farthest - expected).abs() < 1e-6, "{angle} {limit}: {farthest} {expected}");
    }
    let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0)].map(Vec2::from);
    let path = Path { subpaths: vec![Subpath::polyline(&square, true).unwrap()] };
    let style = Stroke { join: Join::Miter { limit: 2.0 }, cap: Cap::Square, ..Stroke::round(1.0) };
    let outline = stroke(&path, &style, 1e-6).unwrap().curve;
    assert_eq!(outline.subpaths.len(), 2);
    // 5 x 5 less 3 x 3, and the four corners inside once more.
    assert!((outline.area() - 17.0).abs() < 1e-6, "{}", outline.area());
}

/// A pattern is the same for phases that differ by its length, and for those below 0.
#[test]
fn phases_wrap() {
    let line = Path { subpaths: vec![Subpath::polyline(&[Vec2::ZERO, Vec2::X * 10.0], false).unwrap()] };
    let dashed = |phase: f64| {
        let style = Stroke { dashes: vec![1.0, 0.5], phase, cap: Cap::Butt, ..Stroke::round(0.25) };
        let outline = stroke(&line, &style, 1e-6).unwrap().curve;
        outline.subpaths.iter().map(Subpath::bounding_box).collect::<Vec<_>>()
    };
    for phase in [0.0, 0.25, 1.25] {
        let plain = dashed(phase);
        for turns in [-1e9, -3.0, -1.0, 1.0, 1e9] {
            assert_eq!(dashed(phase + 1.5 * turns), plain, "{phase} {turns}");
        }
    }
    assert!((dashed(0.25)[0].max.x - 0.75).abs() < 1e-9);
    assert!((dashed(-0.25)[0].min.x - 0.25).abs() < 1e-9);
}
