//! Fits, simplified paths, offsets and strokes against dense measurements of what they stand for.

use ogee::curve::{
    Arc, Bernstein, Cap, Continuity, Cubic, Curve, CurveError, Join, Path, Ray, Side, Source, Spline, Stroke,
    Subpath, Winding, fit, nearest, offset, simplify, stroke, winding,
};
use ogee::math::{Affine2, Vec2, cos, sin};

/// y = sin x.
struct Wave;

impl Source for Wave {
    fn domain(&self) -> [f64; 2] {
        [0.0, 20.0]
    }

    fn ray(&self, t: f64, _: Side) -> Ray {
        let velocity = Vec2::new(1.0, cos(t));
        let speed = velocity.length();
        Ray { point: Vec2::new(t, sin(t)), tangent: velocity / speed, speed }
    }

    fn deviation(&self, from: f64, to: f64, cubic: &Cubic<Vec2>) -> f64 {
        // The fourth derivative is at most 1; the cubic's x may be off by rounding.
        let [a, b, c, d] = cubic.to_array().map(|p| p.x);
        let third = (to - from) / 3.0;
        let off =
            [a - from, b - from - third, c - to + third, d - to].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        (to - from).powi(4) / 384.0 + 2.0 * off + 1e-14
    }
}

fn distance(curve: &Spline<Vec2>, point: Vec2) -> f64 {
    curve.pieces().map(|piece| nearest(&piece, point).unwrap().distance.value).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_wave_is_followed_from_both_sides() {
    let mut counts = Vec::new();
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-9] {
        let fitted = fit(&Wave, tolerance).unwrap();
        let curve = &fitted.curve;
        counts.push(curve.knots().len() - 1);
        let mut worst = 0.0_f64;
        for k in 0..=2000 {
            let t = f64::from(k) / 100.0;
            worst = worst.max(distance(curve, Vec2::new(t, sin(t))));
        }
        for piece in curve.pieces() {
            for k in 0..=50 {
                // The vertical distance is at most sqrt 2 times the distance.
                let p = piece.eval(f64::from(k) / 50.0);
                worst = worst.max((p.y - sin(p.x)).abs() / 2.0_f64.sqrt());
            }
        }
        assert!(worst <= fitted.error && fitted.error <= tolerance, "{tolerance}: {worst} {fitted:?}");
        assert!(worst > 0.4 * fitted.error, "{tolerance}: {worst} {}", fitted.error);
        for index in 1..curve.knots().len() - 1 {
            assert!(curve.joint(index).unwrap().misfit(Continuity::G1) < 1e-9);
        }
        assert_eq!(curve.eval(0.0), Vec2::ZERO);
    }
    assert!(counts.is_sorted(), "{counts:?}");
}

fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
    Cubic::new(points.map(Vec2::from)).unwrap()
}

/// The stability cases, of size about 100.
fn hard_cases() -> Vec<(&'static str, Path)> {
    let one =
        |points: [(f64, f64); 4]| Path { subpaths: vec![Subpath::open(vec![cubic(points).into()]).unwrap()] };
    let closed = |points: [(f64, f64); 4]| Path {
        subpaths: vec![Subpath::closed(vec![cubic(points).into()]).unwrap()],
    };
    let polyline = |points: &[(f64, f64)], closed: bool| {
        let points: Vec<Vec2> = points.iter().copied().map(Vec2::from).collect();
        Path { subpaths: vec![Subpath::polyline(&points, closed).unwrap()] }
    };
    vec![
        ("arch", one([(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)])),
        ("cusp", one([(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)])),
        ("near cusp", one([(0.0, 0.0), (100.0, 100.0), (1e-6, 100.0), (100.0, 0.0)])),
        ("nearer cusp", one([(0.0, 0.0), (100.0, 100.0), (1e-13, 100.0), (100.0, 0.0)])),
        ("near cusp, looped", one([(0.0, 0.0), (100.0, 100.0), (-1e-9, 100.0), (100.0, 0.0)])),
        ("loop", one([(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)])),
        ("S", one([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (100.0, 100.0)])),
        ("line turning back", one([(0.0, 0.0), (200.0, 0.0), (-100.0, 0.0), (100.0, 0.0)])),
        ("slanted line turning back", one([(0.0, 0.0), (200.0, 66.6), (-100.0, -33.3), (100.0, 33.3)])),
        ("first point doubled", one([(0.0, 0.0), (0.0, 0.0), (50.0, 100.0), (100.0, 0.0)])),
        ("both ends doubled", one([(0.0, 0.0), (0.0, 0.0), (100.0, 50.0), (100.0, 50.0)])),
        ("first point tripled", one([(0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (100.0, 50.0)])),
        ("all points equal", one([(5.0, 5.0); 4])),
        ("tight bend", one([(0.0, 0.0), (100.0, 3.0), (100.0, 3.0), (0.0, 6.0)])),
        ("drop", closed([(0.0, 0.0), (120.0, 100.0), (-120.0, 100.0), (0.0, 0.0)])),
        (
            "zigzag",
            polyline(&[(0.0, 0.0), (50.0, 5.0), (2.0, 10.0), (60.0, 60.0), (60.0, 60.0), (61.0, 0.0)], false),
        ),
        ("triangle", polyline(&[(0.0, 0.0), (60.0, 0.0), (30.0, 50.0)], true)),
        ("there and back", polyline(&[(0.0, 0.0), (50.0, 0.0), (0.0, 0.0)], false)),
        (
            "small steps",
            polyline(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (1.5, 0.2), (40.0, 0.0)], false),
        ),
        (
            "circle",
            Path {
                subpaths: vec![
                    Subpath::closed(vec![Arc::ellipse(Vec2::ONE, Vec2::splat(20.0)).unwrap().into()])
                        .unwrap(),
                ],
            },
        ),
        (
            "ellipse",
            Path {
                subpaths: vec![
                    Subpath::closed(vec![Arc::ellipse(Vec2::ONE, Vec2::new(50.0, 4.0)).unwrap().into()])
                        .unwrap(),
                ],
            },
        ),
    ]
}

/// Numbers that look random, the same in each run.
fn noise(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    ((*state >> 33) as f64) / ((1_u64 << 31) as f64)
}

/// A path of which the arcs are finely cubic.
fn pieces_of(path: &Path) -> Vec<Cubic<Vec2>> {
    path.subpaths.iter().flat_map(|subpath| subpath.cubics(1e-9).unwrap()).collect()
}

fn distance_to(cubics: &[Cubic<Vec2>], point: Vec2) -> f64 {
    cubics.iter().map(|c| nearest(c, point).unwrap().distance.value).fold(f64::INFINITY, f64::min)
}

/// How often a path of closed subpaths goes around a point; `None` on the path.
fn windings(path: &Path, point: Vec2) -> Option<i32> {
    let mut sum = 0;
    for subpath in &path.subpaths {
        let spline = Spline::from_pieces(&subpath.cubics(1e-9).unwrap()).unwrap().into_closed().unwrap();
        match winding(&spline, point).unwrap() {
            Winding::Around(times) => sum += times,
            Winding::OnPath => return None,
        }
    }
    Some(sum)
}

#[test]
fn a_round_stroke_is_what_is_near() {
    let mut state = 1;
    for (name, path) in hard_cases() {
        let cubics = pieces_of(&path);
        for width in [0.5, 12.0, 90.0] {
            let tolerance = 1e-3;
            let outline = stroke(&path, &Stroke::round(width), tolerance).unwrap();
            assert!(outline.error <= tolerance);
            let count = outline.curve.pieces().count();
            let bounds = outline.curve.bounding_box().unwrap();
            let margin = Vec2::splat(1.0);
            let (low, size) = (bounds.min - margin, bounds.max - bounds.min + 2.0 * margin);
            for _ in 0..400 {
                let point = low + Vec2::new(noise(&mut state), noise(&mut state)) * size;
                let far = distance_to(&cubics, point) - 0.5 * width;
                if far.abs() <= tolerance {
                    continue;
                }
                let times = windings(&outline.curve, point);
                assert!(
                    times.is_none() || (times != Some(0)) == (far < 0.0),
                    "{name}, width {width}: {point} is {far} outside, {times:?} around, {count} pieces"
                );
                assert!(times.is_none_or(|times| times >= 0), "{name}: {times:?}");
            }
        }
    }
}

/// A point of the parallel, computed from the path itself.
fn parallel_point(curve: &Cubic<Vec2>, t: f64, distance: f64) -> Option<Vec2> {
    let jet = curve.jet(t);
    let tangent = jet.first.try_normalize()?;
    (jet.first.length() > 1e-7).then(|| jet.point + tangent.perp() * distance)
}

#[test]
fn a_parallel_is_at_its_distance_from_both_sides() {
    for (name, path) in hard_cases() {
        let cubics = pieces_of(&path);
        for distance in [-60.0, -3.0, 0.25, 7.0, 40.0] {
            for tolerance in [1e-2, 1e-5] {
                let parallel = offset(&path, distance, Join::Round, tolerance).unwrap();
                assert!(parallel.error <= tolerance);
                let drawn = pieces_of(&parallel.curve);
                for curve in &cubics {
                    for k in 0..=60 {
                        if let Some(p) = parallel_point(curve, f64::from(k) / 60.0, distance) {
                            let off = distance_to(&drawn, p);
                            assert!(
                                off <= parallel.error + 1e-8,
                                "{name} {distance}: {p} is {off} off, {} of {tolerance}",
                                parallel.error
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn offsets_far_away_tiny_and_huge() {
    let arch = [(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)];
    let plain = Path { subpaths: vec![Subpath::open(vec![cubic(arch).into()]).unwrap()] };
    let counts = |path: &Path, scale: f64| {
        let parallel = offset(path, 20.0 * scale, Join::Round, 1e-4 * scale).unwrap();
        assert!(parallel.error <= 1e-4 * scale);
        let outline = stroke(path, &Stroke::round(120.0 * scale), 1e-4 * scale).unwrap();
        (parallel.curve.pieces().count(), outline.curve.pieces().count())
    };
    let expected = counts(&plain, 1.0);
    // Powers of two make no difference at all.
    for scale in [2.0_f64.powi(-40), 2.0_f64.powi(-900), 2.0_f64.powi(1000)] {
        let scaled = plain.map(&Affine2::from_scale(Vec2::splat(scale))).unwrap();
        assert_eq!(counts(&scaled, scale), expected, "{scale}");
    }
    let moved = plain.map(&Affine2::from_translation(Vec2::splat(1e8))).unwrap();
    assert_eq!(counts(&moved, 1.0), expected);
    let tiny = plain.map(&Affine2::from_scale(Vec2::splat(1e-12))).unwrap();
    assert_eq!(counts(&tiny, 1e-12), expected);
    let huge = plain.map(&Affine2::from_scale(Vec2::splat(1e306))).unwrap();
    assert!(counts(&huge, 1e304).0 > 0);
    // Half of the width beyond the range of numbers.
    let error = stroke(&huge, &Stroke::round(1.7e308), 1e300).unwrap_err();
    assert_eq!(error, CurveError::NotFinite { index: 0 });
}

#[test]
fn wrong_input_is_named() {
    let line = Path { subpaths: vec![Subpath::polyline(&[Vec2::ZERO, Vec2::X], false).unwrap()] };
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let same = |error: CurveError| matches!(error, CurveError::Tolerance { .. });
        assert!(same(simplify(&line, tolerance, 0.1).unwrap_err()));
        assert!(same(offset(&line, 1.0, Join::Bevel, tolerance).unwrap_err()));
        assert!(same(stroke(&line, &Stroke::round(1.0), tolerance).unwrap_err()));
        assert!(same(fit(&Wave, tolerance).unwrap_err()));
    }
    let fine = offset(&line, 1.0, Join::Bevel, 1e-17).unwrap_err();
    assert!(
        matches!(fine, CurveError::ToleranceTooFine { value: 1e-17, finest } if finest < 1e-12),
        "{fine}"
    );
    assert!(matches!(fit(&Wave, 1e-13), Err(CurveError::ToleranceTooFine { .. })));
    assert!(matches!(simplify(&line, 0.1, f64::NAN), Err(CurveError::Parameter { .. })));
    assert_eq!(
        offset(&line, f64::INFINITY, Join::Bevel, 0.1),
        Err(CurveError::Distance { value: f64::INFINITY })
    );
    assert_eq!(
        offset(&line, 1.0, Join::Miter { limit: 0.5 }, 0.1),
        Err(CurveError::Parameter { value: 0.5 })
    );
    for width in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(stroke(&line, &Stroke::round(width), 0.1), Err(CurveError::Distance { value: width }));
    }
    let dashed = |dashes: &[f64]| Stroke { dashes: dashes.to_vec(), ..Stroke::round(0.1) };
    assert_eq!(stroke(&line, &dashed(&[1.0, -1.0]), 0.01), Err(CurveError::Dash { index: 1 }));
    assert_eq!(stroke(&line, &dashed(&[0.0, 0.0]), 0.01), Err(CurveError::Dash { index: 1 }));
    assert!(matches!(stroke(&line, &dashed(&[1e-9]), 0.01), Err(CurveError::TooManyDashes { .. })));
    assert_eq!(stroke(&Path::default(), &Stroke::round(1.0), 0.1).unwrap().curve, Path::default());
}

#[test]
fn joins_caps_and_dashes() {
    let corner = Path {
        subpaths: vec![
            Subpath::polyline(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)].map(Vec2::from), false).unwrap(),
        ],
    };
    let area = |join: Join, cap: Cap, dashes: &[f64]| {
        let style = Stroke { width: 2.0, join, cap, dashes: dashes.to_vec(), phase: 0.0 };
        let outline = stroke(&corner, &style, 1e-6).unwrap().curve;
        (outline.area(), outline.subpaths.len())
    };
    let pi = std::f64::consts::PI;
    // The inner side goes through the corner, so that the square there counts twice.
    let strips = 40.0;
    let near = |(area, count): (f64, usize), want: f64, parts: usize| {
        assert!((area - want).abs() < 1e-4 && count == parts, "{area} for {want}, {count} parts");
    };
    near(area(Join::Miter { limit: 4.0 }, Cap::Butt, &[]), strips + 1.0, 1);
    near(area(Join::Miter { limit: 1.2 }, Cap::Butt, &[]), strips + 0.5, 1);
    near(area(Join::Bevel, Cap::Butt, &[]), strips + 0.5, 1);
    near(area(Join::Round, Cap::Butt, &[]), strips + pi / 4.0, 1);
    near(area(Join::Bevel, Cap::Square, &[]), strips + 4.5, 1);
    near(area(Join::Bevel, Cap::Round, &[]), strips + 0.5 + pi, 1);
    // Three dashes of 4 with gaps of 4; the second one is cut by the corner.
    near(area(Join::Bevel, Cap::Butt, &[4.0]), 24.5, 3);
    near(area(Join::Bevel, Cap::Butt, &[4.0, 1.0]), 32.0, 4);
    // Dots.
    near(area(Join::Bevel, Cap::Round, &[0.0, 5.0]), 4.0 * pi, 4);
    near(area(Join::Bevel, Cap::Square, &[0.0, 5.0]), 16.0, 4);
    near(area(Join::Bevel, Cap::Butt, &[0.0, 5.0]), 0.0, 0);
    // A closed square whose first dash prolongs its last.
    let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(Vec2::from);
    let square = Path { subpaths: vec![Subpath::polyline(&square, true).unwrap()] };
    let style =
        Stroke { dashes: vec![10.0], phase: 5.0, join: Join::Bevel, cap: Cap::Butt, ..Stroke::round(2.0) };
    let outline = stroke(&square, &style, 1e-6).unwrap().curve;
    near((outline.area(), outline.subpaths.len()), 41.0, 2);
}
