//! Paths against oracles: lengths by the arithmetic-geometric mean and by addition, areas in rationals, boxes and
//! conversions by dense samples.

use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use ogee::curve::{Arc, Cubic, CurveError, Path, Piece, Quadratic, Subpath};
use ogee::math::{Affine2, Mat2, Vec2, sin_cos};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn rational(x: f64) -> BigRational {
    BigRational::from_float(x).expect("a finite number")
}

fn binomial(n: usize, k: usize) -> BigRational {
    (0..k).fold(rational(1.0), |product, i| product * rational((n - i) as f64) / rational((i + 1) as f64))
}

/// The integral of (x dy - y dx) / 2 along a Bézier curve, from products of Bernstein polynomials.
fn exact_area(points: &[Vec2]) -> BigRational {
    let n = points.len() - 1;
    let mut sum = BigRational::zero();
    for (i, p) in points.iter().enumerate() {
        for j in 0..n {
            let [dx, dy] = [
                rational(points[j + 1].x) - rational(points[j].x),
                rational(points[j + 1].y) - rational(points[j].y),
            ];
            let weight = binomial(n, i) * binomial(n - 1, j) / binomial(2 * n - 1, i + j);
            sum += (rational(p.x) * dy - rational(p.y) * dx) * weight;
        }
    }
    // n from the derivative, 2 n from the integral of a Bernstein polynomial of degree 2 n - 1, 2 from Green.
    sum / rational(4.0)
}

fn point() -> impl Strategy<Value = Vec2> {
    let number = prop_oneof![(-40..40).prop_map(f64::from), -40.0..40.0_f64];
    (number.clone(), number).prop_map(Vec2::from)
}

/// A closed subpath of lines, quadratics and cubics, with the control points of its pieces.
fn closed() -> impl Strategy<Value = (Subpath, Vec<Vec<Vec2>>)> {
    (point(), prop::collection::vec((1..4_usize, point(), point(), point()), 1..6)).prop_map(
        |(start, rounds)| {
            let (mut at, mut lists) = (start, Vec::new());
            for (degree, a, b, c) in rounds {
                let list = [vec![at], [a, b][..degree - 1].to_vec(), vec![c]].concat();
                at = c;
                lists.push(list);
            }
            let piece = |list: &Vec<Vec2>| match list[..] {
                [a, b] => Piece::line(a, b),
                [a, b, c] => Quadratic::new([a, b, c]).map(Piece::from),
                [a, b, c, d] => Cubic::new([a, b, c, d]).map(Piece::from),
                _ => unreachable!("two to four points"),
            };
            let open = Subpath::open(lists.iter().map(piece).collect::<Result<_, _>>().expect("pieces"))
                .expect("a subpath");
            if at != start {
                lists.push(vec![at, start]);
            }
            (open.into_closed(), lists)
        },
    )
}

proptest! {
    /// The last digit is right even where parts cancel, and wherever the path is.
    #[test]
    fn areas_are_exact((subpath, lists) in closed(), shift in prop_oneof![Just(0.0), Just(1e8)]) {
        let moved = subpath.map(&Affine2::from_translation(Vec2::splat(shift))).unwrap();
        let lists: Vec<Vec<Vec2>> = lists.iter().map(|list| list.iter().map(|&p| p + Vec2::splat(shift)).collect()).collect();
        let exact: BigRational = lists.iter().map(|list| exact_area(list)).sum();
        let expected = exact.to_f64().unwrap();
        let found = moved.area();
        let size = 1e4;
        prop_assert!((found - expected).abs() <= 1.2e-16 * expected.abs() + 1e-27 * size, "{found:e} for {expected:e}");
        prop_assert!((moved.reversed().area() + found).abs() <= 2.3e-16 * found.abs() + 1e-27 * size);
    }

    #[test]
    fn arcs_are_as_svg_has_them(
        from in point(), to in point(), radii in (0.1..60.0_f64, 0.1..60.0_f64), turn in -400.0..400.0_f64,
        large: bool, ascending: bool,
    ) {
        prop_assume!(from != to);
        let arc = Arc::from_ends(from, to, radii.into(), turn, large, ascending).unwrap().unwrap();
        prop_assert_eq!((arc.start(), arc.end(), arc.eval(0.0), arc.eval(1.0)), (from, to, from, to));
        prop_assert_eq!(arc.sweep() > 0.0, ascending);
        let size = 100.0;
        let [u, v] = arc.axes();
        let computed = |angle: f64| {
            let (sine, cosine) = sin_cos(angle);
            arc.center() + u * cosine + v * sine
        };
        prop_assert!((computed(arc.angle()) - from).length() < 1e-12 * size);
        prop_assert!((computed(arc.angle() + arc.sweep()) - to).length() < 1e-12 * size);
        // Radii are those that were asked for unless the ellipse does not reach.
        let scale = u.length() / radii.0;
        prop_assert!((v.length() / radii.1 / scale - 1.0).abs() < 1e-13);
        prop_assert!(scale > 1.0 - 1e-13);
        if scale > 1.0 + 1e-13 {
            prop_assert_eq!(arc.sweep().abs(), PI);
        } else {
            prop_assert!((arc.sweep().abs() > PI) == large || (arc.sweep().abs() - PI).abs() < 1e-6);
        }
    }

    #[test]
    fn boxes_hold_arcs_and_touch_them(
        axes in (point(), point()), angle in -9.0..9.0_f64, sweep in -6.3..6.3_f64, center in point(),
    ) {
        let arc = Arc::new(center, axes.into(), angle, sweep).unwrap();
        let bounds = arc.bounding_box();
        let (mut min, mut max) = (arc.start(), arc.start());
        for k in 0..=2000 {
            let p = arc.eval(f64::from(k) / 2000.0);
            let rounding = 1e-13;
            prop_assert!(p.cmpge(bounds.min - rounding).all() && p.cmple(bounds.max + rounding).all());
            (min, max) = (min.min(p), max.max(p));
        }
        // A sample misses an extremum by the square of its step.
        let slack = 1e-5 * (axes.0.length() + axes.1.length()) + 1e-12;
        prop_assert!((min - bounds.min).abs().max_element() <= slack && (max - bounds.max).abs().max_element() <= slack);
    }

    #[test]
    fn cubics_follow_arcs_within_the_tolerance(
        radius in 0.1..50.0_f64, ratio in 0.01..1.0_f64, angle in -9.0..9.0_f64, sweep in 0.01..6.3_f64, digits in 1..12,
    ) {
        let tolerance = ogee::math::pow(10.0, -f64::from(digits)) * radius;
        let arc = Arc::new(Vec2::ZERO, [Vec2::new(radius, 0.0), Vec2::new(0.0, ratio * radius)], angle, sweep).unwrap();
        let cubics = arc.cubics(tolerance).unwrap();
        prop_assert_eq!((cubics[0].to_array()[0], cubics[cubics.len() - 1].to_array()[3]), (arc.start(), arc.end()));
        let mut worst: f64 = 0.0;
        for cubic in &cubics {
            for k in 0..=64 {
                use ogee::curve::Bernstein;
                let p = cubic.eval(f64::from(k) / 64.0) / Vec2::new(radius, ratio * radius);
                // Where the ellipse is the unit circle, distances are at most `radius` times smaller.
                worst = worst.max(radius * (p.length() - 1.0).abs());
            }
        }
        prop_assert!(worst <= tolerance * (1.0 + 1e-3) + 1e-14 * radius, "{worst:e} for {tolerance:e}");
        // The bound is that of a circle: with more than the least number, one cubic less would break it.
        if cubics.len() as f64 > (sweep / (0.5 * PI)).ceil() {
            let fewer = cubics.len() as f64 - 1.0;
            let growth = ogee::math::pow((fewer + 1.0) / fewer, 6.0);
            prop_assert!(growth * worst > 0.4 * tolerance, "{worst:e} for {tolerance:e}");
        }
    }

    #[test]
    fn lengths_of_arcs_add_up(
        power in 0..17, angle in -9.0..9.0_f64, sweep in 0.001..6.2_f64, at in 0.01..0.99_f64, turn in 0.0..7.0_f64,
    ) {
        let ratio = if power == 16 { 0.0 } else { ogee::math::pow(10.0, -f64::from(power)) };
        let turn = Mat2::from_angle(turn);
        let axes = [turn * Vec2::new(3.0, 0.0), turn * Vec2::new(0.0, 3.0 * ratio)];
        let part = |from: f64, over: f64| Arc::new(Vec2::ZERO, axes, from, over).unwrap().length().unwrap().value;
        let (whole, first, second) = (part(angle, sweep), part(angle, at * sweep), part(angle + at * sweep, sweep - at * sweep));
        prop_assert!((first + second - whole).abs() <= 1e-14 * whole, "{whole:e} {first:e} {second:e}");
        // Independently: a polyline of many chords, extrapolated.
        let chords = |count: i32| -> f64 {
            let at = |k: i32| {
                let (sine, cosine) = sin_cos(angle + sweep * f64::from(k) / f64::from(count));
                Vec2::new(3.0 * cosine, 3.0 * ratio * sine)
            };
            (0..count).map(|k| (at(k + 1) - at(k)).length()).sum()
        };
        let (coarse, fine) = (chords(500), chords(1000));
        let extrapolated = fine + (fine - coarse) / 3.0;
        prop_assert!((extrapolated - whole).abs() <= 1e-4 * whole, "{whole} for {extrapolated}");
    }
}

/// The perimeter by the arithmetic-geometric mean (Gauss): 2 pi (a^2 - sum 2^(n-1) c_n^2) / M(a, b).
fn perimeter(a: f64, b: f64) -> f64 {
    let (mut x, mut y, mut sum, mut power) = (a, b, 0.5 * (a - b) * (a + b), 0.5);
    while (x - y).abs() > 1e-15 * x {
        let c = 0.5 * (x - y);
        (x, y) = (0.5 * (x + y), (x * y).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    TAU * (a * a - sum) / x
}

#[test]
fn perimeters_of_ellipses() {
    for (a, b) in [(1.0, 1.0), (3.0, 1.0), (1.0, 3.0), (5.0, 4.99), (1.0, 0.1), (1e9, 2e8), (1e-9, 5e-10)] {
        let found = Arc::ellipse(Vec2::new(7.0, -2.0), Vec2::new(a, b)).unwrap().length().unwrap();
        let expected = perimeter(a, b);
        assert!((found.value / expected - 1.0).abs() < 4e-15, "{a} {b}: {found:?} for {expected}");
        assert!((found.value - expected).abs() <= found.error + 4e-15 * expected);
    }
    // Flat ones: 4 a (1 + (b/a)^2 (ln(4 a/b) - 1/2) / 2 + ...).
    for ratio in [1e-5, 1e-7, 1e-10, 0.0] {
        let found = Arc::ellipse(Vec2::ZERO, Vec2::new(1.0, ratio)).unwrap().length().unwrap().value;
        let correction =
            if ratio > 0.0 { 0.5 * ratio * ratio * (ogee::math::ln(4.0 / ratio) - 0.5) } else { 0.0 };
        assert!((found - 4.0 * (1.0 + correction)).abs() < 1e-14, "{ratio}: {found}");
    }
}

#[test]
fn half_turns_are_half_turns_in_decimals_too() {
    for (from, to, radius) in [
        ((0.0, 0.0), (10.0, 0.0), 5.0),
        ((10.1, 20.0), (10.1 + 6.6, 20.0), 3.3),
        ((0.3, 0.7), (0.5, 0.7), 0.1),
    ] {
        let arc = Arc::from_ends(Vec2::from(from), Vec2::from(to), Vec2::splat(radius), 0.0, false, true)
            .unwrap()
            .unwrap();
        assert!((arc.length().unwrap().value / (PI * radius) - 1.0).abs() < 1e-12, "{arc:?}");
    }
    let arc = |to: Vec2, radii: Vec2| Arc::from_ends(Vec2::ZERO, to, radii, 0.0, false, true);
    assert_eq!(arc(Vec2::ZERO, Vec2::ONE), Ok(None));
    assert_eq!(arc(Vec2::ONE, Vec2::new(0.0, 1.0)), Ok(None));
    assert!(matches!(arc(Vec2::NAN, Vec2::ONE), Err(CurveError::NotFinite { index: 1 })));
    assert!(matches!(arc(Vec2::new(1e308, 0.0), Vec2::splat(1e-308)), Err(CurveError::NotFinite { .. })));
}

#[test]
fn tiny_arcs_keep_their_digits() {
    for sweep in [1e-3, 1e-6, 1e-9] {
        let arc = Arc::new(Vec2::ZERO, [Vec2::X, Vec2::Y], 0.5, sweep).unwrap();
        let path = Path { subpaths: vec![Subpath::open(vec![arc.into()]).unwrap()] };
        assert!((path.length(1e-15).unwrap().value / sweep - 1.0).abs() < 1e-14);
        // The segment between chord and arc: (x - sin x) / 2.
        let expected = sweep * sweep * sweep / 12.0 * (1.0 - sweep * sweep / 20.0);
        assert!((path.area() / expected - 1.0).abs() < 1e-12, "{} for {expected}", path.area());
    }
}

#[test]
fn figures_of_eight_have_no_area_and_far_squares_theirs() {
    let eight = ogee::io::svg::read_path("M0 0C10 10 20 10 20 0S10-10 0 0S-10 10-20 0S-10-10 0 0").unwrap();
    let once = ogee::io::svg::read_path("M0 0C10 10 20 10 20 0S10-10 0 0").unwrap();
    assert!(once.area() < -100.0);
    assert!(eight.area().abs() < 1e-20, "{}", eight.area());
    let square = ogee::io::svg::read_path("M1e8 1e8h3v3h-3z").unwrap();
    assert_eq!((square.area(), square.length(1e-9).unwrap().value), (9.0, 12.0));
    assert_eq!(square.bounding_box().unwrap().max, Vec2::splat(1e8 + 3.0));
}

#[test]
fn lengths_do_not_mind_a_far_origin() {
    let near = ogee::io::svg::read_path("M0 0C30 60 70 60 100 0").unwrap();
    let far = near.map(&Affine2::from_translation(Vec2::splat(67_108_864.0))).unwrap();
    for path in [near, far] {
        let found = path.length(1e-11).unwrap();
        assert!((found.value - 141.217_498_362_787_72).abs() <= 1e-11, "{found:?}");
    }
}

#[test]
fn subpaths_without_gaps_only() {
    let line = |from: (f64, f64), to: (f64, f64)| Piece::line(from.into(), to.into()).unwrap();
    let gap = Subpath::open(vec![line((0.0, 0.0), (1.0, 0.0)), line((1.0, 1e-300), (2.0, 0.0))]);
    assert_eq!(gap, Err(CurveError::Gap { piece: 1 }));
    assert_eq!(Subpath::open(Vec::new()), Err(CurveError::TooFewPoints { actual: 0, least: 1 }));
    assert!(Subpath::polyline(&[Vec2::ZERO, Vec2::NAN], false).is_err());
    let triangle = Subpath::polyline(&[Vec2::ZERO, Vec2::X, Vec2::Y], true).unwrap();
    assert_eq!((triangle.pieces().len(), triangle.end(), triangle.area()), (3, Vec2::ZERO, 0.5));
    assert_eq!(triangle.reversed().area(), -0.5);
    assert!(Path::default().length(f64::NAN).is_err());
}
