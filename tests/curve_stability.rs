//! Hard cases of curves, each with its answer; numbers were computed with 40 digits.

use ogee::curve::{
    AnyBezier, Bernstein, Boundary, Contact, Continuity, Cubic, CurveError, Line, Spacing, Spline, Winding,
    bounding_box, intersect, length, nearest, self_intersections, tangents, winding,
};
use ogee::math::{Vec2, sin_cos};
use ogee::tessellate::flatten;

fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
    Cubic::new(points.map(Vec2::from)).unwrap()
}

const CUSP: [(f64, f64); 4] = [(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)];
const ARCH: [(f64, f64); 4] = [(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)];

/// The length to 12 digits, within its own bound.
fn assert_length(curve: &Cubic<Vec2>, want: f64) {
    let got = length(curve, 1e-12).unwrap();
    assert!((got.value - want).abs() <= got.error, "{got:?} for {want}");
    assert!((got.value - want).abs() <= 1e-12 * want.max(1.0));
}

fn polyline_length(points: &[Vec2]) -> f64 {
    points.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum()
}

#[test]
fn cusp() {
    let curve = cubic(CUSP);
    assert_length(&curve, 182.84271247461902);
    assert_eq!(curve.derivative(1).unwrap().eval(0.5), Vec2::ZERO);
    assert_eq!(*curve.cusps(), [0.5]);
    let sides = tangents(&curve, 0.5).unwrap();
    // It rises to the cusp and falls from it.
    assert!((sides.arriving.unwrap() - Vec2::Y).length() < 1e-12);
    assert!((sides.leaving.unwrap() + Vec2::Y).length() < 1e-12);
}

#[test]
fn near_cusp() {
    let mut points = CUSP;
    points[2].0 = 1e-6;
    assert_length(&cubic(points), 182.84271234593936);
}

#[test]
fn loop_crosses_itself() {
    let curve = cubic([(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)]);
    assert_length(&curve, 211.85463666161536);
    let t = 0.17267316464601143;
    let [a, b] = curve.self_intersection().unwrap();
    assert!((a - t).abs() < 1e-16 && (b - (1.0 - t)).abs() < 2.3e-16);
    let found = self_intersections(&curve).unwrap();
    assert!(found.len() == 1 && (found[0].first[0] - t).abs() < 1e-14, "{found:?}");
}

#[test]
fn s_curve() {
    let curve = cubic([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (100.0, 100.0)]);
    assert_length(&curve, 167.65426274202858);
    assert_eq!(*curve.inflections(), [0.5]);
}

#[test]
fn on_a_line_and_turning_back() {
    let curve = cubic([(0.0, 0.0), (200.0, 0.0), (-100.0, 0.0), (100.0, 0.0)]);
    assert_length(&curve, 189.4427190999916);
    let turns = curve.cusps();
    assert!((turns[0] - 0.27639320225002106).abs() < 1e-15 && (turns[1] - 0.7236067977499789).abs() < 1e-15);
    let flat = flatten(&curve, 1e-6).unwrap();
    assert!((polyline_length(&flat.points) - 189.4427190999916).abs() < 1e-5);
}

#[test]
fn boxes_of_flat_curves() {
    let level = cubic([(0.0, 10.0), (-10.0, 10.0), (180.0, 10.0), (60.0, 10.0)]);
    let bounds = bounding_box(&level);
    assert!((bounds.min.x - -0.383376013856379).abs() < 1e-14);
    assert!((bounds.max.x - 99.8835682476126).abs() < 1e-13);
    let upright = cubic([(-1061.0, -3327.0), (-1061.0, -3177.0), (-1061.0, -3477.0), (-1061.0, -3327.0)]);
    let bounds = bounding_box(&upright);
    assert!((bounds.min.y - -3370.30).abs() < 5e-3 && (bounds.max.y - -3283.70).abs() < 5e-3);
    assert_eq!((bounds.min.x, bounds.max.x), (-1061.0, -1061.0));
}

#[test]
fn doubled_start() {
    let curve = cubic([(1.0, 1.0), (1.0, 1.0), (4.0, 5.0), (9.0, 9.0)]);
    let leaving = tangents(&curve, 0.0).unwrap().leaving.unwrap();
    assert!((leaving - Vec2::new(0.6, 0.8)).length() < 1e-15);
}

#[test]
fn all_points_equal() {
    let curve = cubic([(3.0, 4.0); 4]);
    assert_eq!(length(&curve, 1e-9).unwrap().value, 0.0);
    assert_eq!(tangents(&curve, 0.5).unwrap().leaving, None);
    assert_eq!(flatten(&curve, 1e-3).unwrap().points, [Vec2::new(3.0, 4.0)]);
    assert_eq!(nearest(&curve, Vec2::ZERO).unwrap().distance.value, 5.0);
}

#[test]
fn both_ends_doubled() {
    let curve = cubic([(0.0, 0.0), (0.0, 0.0), (100.0, 50.0), (100.0, 50.0)]);
    assert_length(&curve, 111.80339887498948);
    assert_eq!(flatten(&curve, 1e-6).unwrap().points.len(), 2);
}

#[test]
fn far_from_the_origin() {
    let curve = cubic(ARCH).map(|p| p + 1e8).unwrap();
    let got = length(&curve, 1e-9).unwrap();
    assert!((got.value - 141.21749836278772).abs() <= got.error, "{got:?}");
    assert!((got.value - 141.21749836278772).abs() < 1e-6);
}

#[test]
fn intersections_do_not_depend_on_scale() {
    let other = [(0.0, 20.0), (60.0, -30.0), (40.0, 80.0), (100.0, 30.0)];
    let want = intersect(&cubic(ARCH), &cubic(other), None).unwrap();
    assert!(!want.is_empty());
    for scale in [1e-12, 1e-300, 1e300] {
        let scaled = |points| cubic(points).map(|p| p * scale).unwrap();
        let got = intersect(&scaled(ARCH), &scaled(other), None).unwrap();
        assert_eq!(got.len(), want.len());
        for (g, w) in got.iter().zip(&want) {
            assert!((g.first[0] - w.first[0]).abs() < 1e-13 && g.contact == w.contact);
        }
    }
}

#[test]
fn huge_and_swinging_numbers() {
    let huge = cubic(ARCH).map(|p| p * 1e306).unwrap();
    assert!((length(&huge, 1.0).unwrap().value / 1e306 - 141.21749836278772).abs() < 1e-12);
    assert!(nearest(&huge, Vec2::ZERO).unwrap().distance.value == 0.0);
    assert!(flatten(&huge, 1e304).unwrap().points.len() > 3);
    let max = bounding_box(&huge).max.y;
    assert!((max / 45e306 - 1.0).abs() < 1e-15);
    let swing = Cubic::new([-1.7e308, -1.7e308, 1.7e308, 1.7e308]).unwrap();
    assert_eq!(swing.eval(0.5), 0.0);
    assert_eq!(length(&swing, 1.0), Err(CurveError::NotFinite { index: 0 }));
}

#[test]
fn subnormal_sizes() {
    let tiny = Line::new([0.0, 1e-320]).unwrap();
    assert_eq!(length(&tiny, 1e-9).unwrap().value, 1e-320);
    let small = cubic(ARCH).map(|p| p * 1e-318).unwrap();
    assert!((length(&small, 1e-322).unwrap().value / 1e-318 - 141.2175).abs() < 0.01);
}

#[test]
fn wrong_numbers_are_refused_where_they_enter() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(Cubic::new([0.0, 1.0, bad, 2.0]), Err(CurveError::NotFinite { index: 2 }));
        assert_eq!(nearest(&cubic(ARCH), Vec2::new(bad, 0.0)), Err(CurveError::NotFinite { index: 0 }));
        assert!(cubic(ARCH).map(|p| p * bad).is_err());
        assert!(matches!(cubic(ARCH).split(bad), Err(CurveError::Parameter { .. })));
    }
    assert_eq!(AnyBezier::<f64>::new(vec![]), Err(CurveError::TooFewPoints { actual: 0, least: 1 }));
    for value in [0.0, -1.0, f64::NAN] {
        assert!(matches!(length(&cubic(ARCH), value), Err(CurveError::Tolerance { .. })));
        assert!(matches!(flatten(&cubic(ARCH), value), Err(CurveError::Tolerance { .. })));
        let met = intersect(&cubic(ARCH), &cubic(CUSP), Some(value));
        assert!(matches!(met, Err(CurveError::Tolerance { .. })));
    }
}

#[test]
fn outside_of_the_unit_interval() {
    let line = Line::new([1.0, 3.0]).unwrap();
    assert_eq!((line.eval(-1.0), line.eval(2.0)), (-1.0, 5.0));
    assert!(matches!(line.split(1.5), Err(CurveError::Parameter { value: 1.5 })));
    assert!(line.eval(f64::NAN).is_nan());
}

#[test]
fn near_tangent_arches() {
    let mirrored = |gap: f64| cubic(ARCH).map(|p| Vec2::new(p.x, 90.0 + gap - p.y)).unwrap();
    let touch = intersect(&cubic(ARCH), &mirrored(0.0), None).unwrap();
    assert_eq!((touch.len(), touch[0].contact), (1, Contact::Tangency { multiplicity: 2 }));
    assert_eq!((touch[0].first[0], touch[0].second[0]), (0.5, 0.5));
    assert_eq!(intersect(&cubic(ARCH), &mirrored(1e-9), None).unwrap(), []);
    let pair = intersect(&cubic(ARCH), &mirrored(-1e-9), None).unwrap();
    let parameters: Vec<f64> = pair.iter().map(|meeting| meeting.first[0] - 0.5).collect();
    assert_eq!(pair.len(), 2);
    assert!((parameters[0] + 1.66667e-6).abs() < 1e-10 && (parameters[1] - 1.66667e-6).abs() < 1e-10);
}

#[test]
fn overlapping_arcs() {
    let curve = cubic(ARCH);
    let (a, b) = (curve.subcurve(0.0, 0.7).unwrap(), curve.subcurve(0.3, 1.0).unwrap());
    for (a, b, first, second) in [
        (a, b, [3.0 / 7.0, 1.0], [0.0, 4.0 / 7.0]),
        (curve, curve, [0.0, 1.0], [0.0, 1.0]),
        (curve, curve.reversed(), [0.0, 1.0], [1.0, 0.0]),
    ] {
        let found = intersect(&a, &b, None).unwrap();
        assert!(found.len() == 1 && found[0].contact == Contact::Overlap, "{found:?}");
        for k in 0..2 {
            assert!((found[0].first[k] - first[k]).abs() < 1e-13);
            assert!((found[0].second[k] - second[k]).abs() < 1e-13);
        }
    }
}

#[test]
fn inside_near_the_edge_of_a_turned_circle() {
    let arm = 0.551_915_023_494;
    for step in 0..16 {
        let angle = 0.1 + 0.37 * f64::from(step);
        let (sine, cosine) = sin_cos(angle);
        let turn = |p: (f64, f64)| Vec2::new(cosine * p.0 - sine * p.1, sine * p.0 + cosine * p.1);
        let quarters = [
            [(1.0, 0.0), (1.0, arm), (arm, 1.0)],
            [(0.0, 1.0), (-arm, 1.0), (-1.0, arm)],
            [(-1.0, 0.0), (-1.0, -arm), (-arm, -1.0)],
            [(0.0, -1.0), (arm, -1.0), (1.0, -arm)],
        ];
        let points = quarters.iter().flatten().map(|&p| turn(p)).collect();
        let circle = Spline::closed(points, vec![0.0, 1.0, 2.0, 3.0, 4.0]).unwrap();
        for at in 0..32 {
            let (sine, cosine) = sin_cos(0.2 * f64::from(at));
            assert_eq!(winding(&circle, 0.9997 * Vec2::new(cosine, sine)), Ok(Winding::Around(1)));
        }
    }
}

#[test]
fn equal_neighbours_and_rings_of_two() {
    let points = [(0.0, 0.0), (1.0, 1.0), (1.0, 1.0), (3.0, 0.0)].map(Vec2::from);
    for (spacing, pieces) in [(Spacing::Uniform, 3), (Spacing::Centripetal, 2), (Spacing::Chordal, 2)] {
        assert_eq!(Spline::catmull_rom(&points, spacing, false).unwrap().pieces().len(), pieces);
    }
    let equal = [Vec2::ONE; 3];
    let error = Spline::catmull_rom(&equal, Spacing::Chordal, false);
    assert_eq!(error, Err(CurveError::TooFewPoints { actual: 1, least: 2 }));
    let natural = Boundary::Second(Vec2::ZERO);
    let through = Spline::interpolate(&points, &[0.0, 1.0, 2.0, 3.0], natural, natural).unwrap();
    assert_eq!((through.eval(1.0), through.eval(2.0)), (points[1], points[2]));
    let ring = Spline::periodic(&points[..2], &[0.0, 1.0, 2.0]).unwrap();
    assert!(ring.is_closed() && ring.points().len() == 6);
    assert_eq!((ring.eval(0.0), ring.eval(1.0), ring.eval(2.0)), (points[0], points[1], points[0]));
    assert!((0..2).all(|i| ring.joint(i).unwrap().misfit(Continuity::C2) < 1e-12));
    assert!(Spline::catmull_rom(&points[..2], Spacing::Centripetal, true).unwrap().is_closed());
}

#[test]
fn knots_out_of_order() {
    let values = [1.0, 2.0, 0.0];
    for knots in [[0.0, 0.0, 1.0], [0.0, -1.0, 1.0], [0.0, f64::NAN, 1.0]] {
        let natural = Boundary::Second(0.0);
        assert_eq!(
            Spline::interpolate(&values, &knots, natural, natural),
            Err(CurveError::Knot { index: 1 })
        );
        assert_eq!(Spline::akima(&values, &knots), Err(CurveError::Knot { index: 1 }));
        assert_eq!(Spline::monotone(&values, &knots), Err(CurveError::Knot { index: 1 }));
    }
    assert!(matches!(Spline::akima(&values, &[0.0]), Err(CurveError::Count { actual: 1, expected: 3 })));
}
