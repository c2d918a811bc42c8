//! Paths past points: near to every one of them, of few pieces, smooth but at corners, in bounded time.
#![allow(clippy::print_stdout, reason = "figures for who asks with --nocapture")]

use ogee::curve::{
    Corners, CurveError, Fitted, Piece, PointFit, Subpath, find_corners, fit_points, schneider,
};
use ogee::math::{Vec2, cos, sin, unit_circle};
use std::f64::consts::TAU;

struct Random(u64);

impl Random {
    /// Evenly spread over (-1, 1).
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> Vec2 {
        Vec2::new(self.even(), self.even())
    }
}

fn smooth(tolerance: f64, closed: bool) -> PointFit {
    PointFit { tolerance, corners: Corners::At(vec![]), closed }
}

/// The distance from a point to a path: from each piece's samples, by thirds.
fn distance(path: &Subpath, point: Vec2) -> f64 {
    let near = |piece: &Piece| {
        let far = |t: f64| piece.eval(t).distance(point);
        let at = |k: i32| f64::from(k) / 128.0;
        let best = (0..=128).min_by(|&a, &b| far(at(a)).total_cmp(&far(at(b)))).unwrap();
        let (mut low, mut high) = (at((best - 1).max(0)), at((best + 1).min(128)));
        for _ in 0..90 {
            let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if far(thirds[0]) < far(thirds[1]) { high = thirds[1] } else { low = thirds[0] }
        }
        far(0.5 * (low + high)).min(far(at(best)))
    };
    path.pieces().iter().map(near).fold(f64::INFINITY, f64::min)
}

/// Directions of a piece at both ends.
fn ends(piece: &Piece) -> [Vec2; 2] {
    match piece {
        Piece::Line(_) => [(piece.end() - piece.start()).normalize(); 2],
        Piece::Cubic(cubic) => {
            let [a, b, c, d] = cubic.to_array();
            [(b - a).normalize(), (d - c).normalize()]
        }
        _ => unreachable!("fits are of lines and cubics"),
    }
}

fn check(name: &str, points: &[Vec2], style: &PointFit, fitted: &Fitted<Subpath>) {
    assert!(fitted.error <= style.tolerance, "{name}: {} of {}", fitted.error, style.tolerance);
    let step = (points.len() / 500).max(1);
    let worst = points.iter().step_by(step).map(|&p| distance(&fitted.curve, p)).fold(0.0, f64::max);
    assert!(worst <= fitted.error * (1.0 + 1e-9), "{name}: {worst} measured, {} reported", fitted.error);
    let pieces = fitted.curve.pieces();
    for pair in pieces.windows(2) {
        assert_eq!(pair[0].end(), pair[1].start(), "{name}");
    }
    assert_eq!(fitted.curve.is_closed(), style.closed);
    if matches!(&style.corners, Corners::At(none) if none.is_empty()) {
        for k in usize::from(!style.closed)..pieces.len() {
            let [before, after] = [&pieces[(k + pieces.len() - 1) % pieces.len()], &pieces[k]].map(ends);
            assert!(before[1].perp_dot(after[0]).abs() < 1e-6, "{name}: joint {k} turns");
            assert!(before[1].dot(after[0]) > 0.0, "{name}: joint {k} turns back");
        }
    }
}

type Method = fn(&[Vec2], &PointFit) -> Result<Fitted<Subpath>, CurveError>;
const METHODS: [(&str, Method); 2] = [("moments", fit_points), ("Schneider", schneider)];

/// A curve with bends of all kinds.
fn wave(t: f64) -> Vec2 {
    Vec2::new(10.0 * t, sin(12.0 * t) * (1.0 + t) + 0.3 * sin(31.0 * t))
}

fn waves(count: usize, noise: f64) -> Vec<Vec2> {
    let mut random = Random(5);
    (0..count).map(|k| wave(k as f64 / (count - 1) as f64) + random.point() * noise).collect()
}

#[test]
fn points_are_followed_with_few_pieces() {
    for (count, noise, tolerance) in [
        (60, 0.0, 1e-2),
        (500, 0.0, 1e-2),
        (500, 0.0, 1e-5),
        (500, 1e-3, 1e-2),
        (3000, 1e-2, 3e-2),
        (3000, 1e-2, 2e-2),
    ] {
        let points = waves(count, noise);
        let style = smooth(tolerance, false);
        let counts = METHODS.map(|(name, method)| {
            let fitted = method(&points, &style).unwrap();
            check(name, &points, &style, &fitted);
            assert_eq!(fitted.curve.start(), points[0]);
            assert_eq!(fitted.curve.end(), points[count - 1]);
            fitted.curve.pieces().len()
        });
        println!("{count} points, noise {noise}, tolerance {tolerance}: {counts:?}");
        assert!(counts[0] <= counts[1], "{counts:?}");
    }
}

#[test]
fn loops_and_corners() {
    let circle: Vec<Vec2> = (0..300).map(|k| unit_circle(k, 300)).collect();
    for (name, method) in METHODS {
        let style = smooth(1e-4, true);
        let fitted = method(&circle, &style).unwrap();
        check(name, &circle, &style, &fitted);
        println!("{name}: {} pieces for a circle", fitted.curve.pieces().len());
        assert!(fitted.curve.pieces().len() <= if name == "moments" { 5 } else { 16 }, "{name}");
        assert!((fitted.curve.area() - TAU / 2.0).abs() < 1e-3);
    }
    // A square with noise, whose corners are found or given.
    let mut random = Random(9);
    let side = |k: usize| {
        let (s, t) = (k / 100, (k % 100) as f64 / 100.0);
        let corner = |s: usize| [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y][s % 4];
        corner(s) + (corner(s + 1) - corner(s)) * t
    };
    let square: Vec<Vec2> = (0..400).map(|k| side(k) + random.point() * 1e-3).collect();
    assert_eq!(find_corners(&square, true, 0.8, 0.05).unwrap(), [0, 100, 200, 300]);
    assert_eq!(find_corners(&square, false, 0.8, 0.05).unwrap(), [100, 200, 300]);
    let styles = [Corners::Sharper { angle: 0.8, reach: 0.05 }, Corners::At(vec![300, 0, 100, 200, 100])];
    for corners in styles {
        for (name, method) in METHODS {
            let style = PointFit { tolerance: 5e-3, corners: corners.clone(), closed: true };
            let fitted = method(&square, &style).unwrap();
            check(name, &square, &style, &fitted);
            if name != "moments" {
                continue;
            }
            assert_eq!(fitted.curve.pieces().len(), 4);
            for (k, piece) in fitted.curve.pieces().iter().enumerate() {
                assert_eq!(piece.start(), square[100 * k]);
                // Not back and forth along the noise.
                assert!(piece.length(1e-6).unwrap().value < 1.01);
            }
        }
    }
}

#[test]
fn few_repeated_and_hostile_points() {
    let near = |x: f64, y: f64| Vec2::new(x, y);
    let cases: [(&str, Vec<Vec2>); 9] = [
        ("one", vec![Vec2::ONE]),
        ("equal", vec![Vec2::ONE; 5]),
        ("two", vec![Vec2::ZERO, Vec2::ONE]),
        ("three", vec![Vec2::ZERO, Vec2::ONE, near(2.0, 0.0)]),
        (
            "repeated",
            vec![Vec2::ZERO, Vec2::ZERO, Vec2::ONE, Vec2::ONE, near(2.0, 0.0), near(2.0, 0.0), Vec2::ZERO],
        ),
        ("there and back", vec![Vec2::ZERO, Vec2::X, Vec2::ZERO, Vec2::X, Vec2::ZERO]),
        ("straight", (0..50).map(|k| near(f64::from(k), 2.0 * f64::from(k))).collect()),
        ("uneven", (0..60).map(|k| near(1.5_f64.powi(k - 60), 1.1_f64.powi(-k))).collect()),
        ("anywhere", {
            let mut random = Random(3);
            (0..40).map(|_| random.point()).collect()
        }),
    ];
    for (name, points) in &cases {
        for (method_name, method) in METHODS {
            for closed in [false, true] {
                for tolerance in [1e-9, 1e-3, 10.0] {
                    for corners in [
                        Corners::At(vec![]),
                        Corners::At(vec![points.len() - 1]),
                        Corners::Sharper { angle: 0.5, reach: 0.1 },
                    ] {
                        let style = PointFit { tolerance, corners, closed };
                        let fitted = method(points, &style).unwrap();
                        assert!(fitted.error <= tolerance);
                        let worst = points.iter().map(|&p| distance(&fitted.curve, p)).fold(0.0, f64::max);
                        assert!(
                            worst <= fitted.error * (1.0 + 1e-9) + 1e-15,
                            "{name}, {method_name}: {worst} {}",
                            fitted.error
                        );
                    }
                }
            }
        }
    }
    let straight = fit_points(&cases[6].1, &smooth(1e-6, false)).unwrap().curve;
    assert!(matches!(straight.pieces(), [Piece::Line(_)]), "{straight:?}");
}

/// Powers of two make no difference, a shift none but for rounding.
#[test]
fn points_far_away_tiny_and_huge() {
    let points = waves(300, 0.0);
    let count = |points: &[Vec2], scale: f64| {
        let fitted = fit_points(points, &smooth(1e-3 * scale, false)).unwrap();
        assert!(fitted.error <= 1e-3 * scale);
        fitted.curve.pieces().len()
    };
    let expected = count(&points, 1.0);
    for scale in [2.0_f64.powi(-900), 2.0_f64.powi(-40), 2.0_f64.powi(1000)] {
        let scaled: Vec<Vec2> = points.iter().map(|&p| p * scale).collect();
        assert_eq!(count(&scaled, scale), expected, "{scale}");
    }
    let moved: Vec<Vec2> = points.iter().map(|&p| p + 1e6).collect();
    assert!(count(&moved, 1.0).abs_diff(expected) <= 1);
}

#[test]
fn many_points_take_little_time() {
    let cases = [
        ("dense", waves(100_000, 0.0), 1e-4),
        ("noisy", waves(100_000, 1e-3), 1e-2),
        ("noisier than the tolerance", waves(20_000, 1e-2), 1e-3),
        (
            "spiral",
            (0..100_000)
                .map(|k| {
                    let t = f64::from(k) * 1e-3;
                    Vec2::new(cos(t), sin(t)) * t
                })
                .collect(),
            1e-3,
        ),
        (
            "all one but the last",
            {
                let mut points = vec![Vec2::ZERO; 100_000];
                points.push(Vec2::X);
                points
            },
            1e-3,
        ),
    ];
    for (name, points, tolerance) in cases {
        let style = smooth(tolerance, false);
        for (method_name, method) in METHODS {
            let start = std::time::Instant::now();
            let fitted = method(&points, &style).unwrap();
            let taken = start.elapsed();
            println!("{name}, {method_name}: {} pieces, {taken:?}", fitted.curve.pieces().len());
            assert!(taken.as_secs() < 20 && fitted.error <= tolerance);
        }
        let start = std::time::Instant::now();
        let corners = find_corners(&points, false, 0.3, 0.1).unwrap();
        println!("{} corners in {:?}", corners.len(), start.elapsed());
    }
}

#[test]
fn wrong_points_are_named() {
    for (_, method) in METHODS {
        let with = |points: &[Vec2], style: PointFit| method(points, &style).unwrap_err();
        assert_eq!(with(&[], smooth(0.1, false)), CurveError::TooFewPoints { actual: 0, least: 1 });
        let bad = [Vec2::ZERO, Vec2::new(f64::NAN, 0.0), Vec2::ONE];
        assert_eq!(with(&bad, smooth(0.1, false)), CurveError::NotFinite { index: 1 });
        let points = [Vec2::ZERO, Vec2::X, Vec2::ONE];
        for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(with(&points, smooth(tolerance, true)), CurveError::Tolerance { .. }));
        }
        assert!(matches!(with(&points, smooth(1e-16, true)), CurveError::ToleranceTooFine { .. }));
        let corner = PointFit { corners: Corners::At(vec![1, 3]), ..smooth(0.1, false) };
        assert_eq!(with(&points, corner), CurveError::Parameter { value: 3.0 });
        for (angle, reach) in [(0.0, 1.0), (f64::NAN, 1.0), (1.0, -1.0)] {
            let found = PointFit { corners: Corners::Sharper { angle, reach }, ..smooth(0.1, false) };
            assert!(matches!(with(&points, found), CurveError::Parameter { .. }));
        }
    }
}
