//! Laws of Bézier curves, over random ones.

use ogee::curve::{
    AnyBezier, Bernstein, Contact, Cubic, CurveError, bounding_box, convex_hull, intersect, intersect_line,
    self_intersections,
};
use ogee::math::{Affine2, Mat2, Vec2};
use ogee::numeric::orient2d;
use proptest::prelude::*;

fn point() -> impl Strategy<Value = Vec2> {
    (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(Vec2::from)
}

fn curve() -> impl Strategy<Value = AnyBezier<Vec2>> {
    prop::collection::vec(point(), 2..10).prop_map(|points| AnyBezier::new(points).unwrap())
}

fn cubic() -> impl Strategy<Value = Cubic<Vec2>> {
    prop::array::uniform4(point()).prop_map(|points| Cubic::new(points).unwrap())
}

/// Crossings of two fine polylines whose vertices lie on the curves, as parameters.
fn crossings_of_polylines(a: &Cubic<Vec2>, b: &Cubic<Vec2>, steps: usize) -> Vec<(f64, f64)> {
    let sampled =
        |c: &Cubic<Vec2>| -> Vec<Vec2> { (0..=steps).map(|k| c.eval(k as f64 / steps as f64)).collect() };
    let (p, q) = (sampled(a), sampled(b));
    let mut found = Vec::new();
    for i in 0..steps {
        for j in 0..steps {
            let side = |a: Vec2, b: Vec2, c: Vec2| orient2d(a, b, c) > 0.0;
            let (a0, a1, b0, b1) = (p[i], p[i + 1], q[j], q[j + 1]);
            if side(a0, a1, b0) != side(a0, a1, b1) && side(b0, b1, a0) != side(b0, b1, a1) {
                found.push(((i as f64 + 0.5) / steps as f64, (j as f64 + 0.5) / steps as f64));
            }
        }
    }
    found
}

proptest! {
    #[test]
    fn ends_and_reversal(curve in curve(), t in 0.0..1.0_f64) {
        let points = curve.points();
        prop_assert_eq!((curve.eval(0.0), curve.eval(1.0)), (points[0], points[points.len() - 1]));
        prop_assert!((curve.reversed().eval(1.0 - t) - curve.eval(t)).length() < 1e-14);
    }

    #[test]
    fn within_hull_and_box(curve in curve(), t in 0.0..1.0_f64) {
        let (p, hull) = (curve.eval(t), convex_hull(curve.points()));
        for i in 0..hull.len() {
            let (a, b) = (hull[i], hull[(i + 1) % hull.len()]);
            prop_assert!((b - a).perp_dot(p - a) > -1e-14);
        }
        let bounds = bounding_box(&curve);
        prop_assert!(p.cmpge(bounds.min - 4e-16).all() && p.cmple(bounds.max + 4e-16).all());
    }

    #[test]
    fn affine_maps_commute(curve in curve(), t in 0.0..1.0_f64, a in point(), b in point(), shift in point()) {
        let map = Affine2 { matrix2: Mat2::from_cols(a, b), translation: shift };
        let image = curve.map(|p| map.transform_point2(p)).unwrap();
        prop_assert!((image.eval(t) - map.transform_point2(curve.eval(t))).length() < 1e-14);
    }

    #[test]
    fn lines_cross_no_more_often_than_the_polygon(curve in curve(), from in point(), to in point()) {
        prop_assume!((to - from).length() > 1e-3);
        let found = intersect_line(&curve, from, to, None).unwrap();
        let sides: Vec<bool> = curve.points().iter().map(|&p| orient2d(from, to, p) > 0.0).collect();
        let changes = sides.windows(2).filter(|pair| pair[0] != pair[1]).count();
        prop_assert!(found.len() <= changes);
        prop_assert!(found.len() % 2 == changes % 2, "{} of {}", found.len(), changes);
        for meeting in found {
            let on_line = from + meeting.second[0] * (to - from);
            prop_assert!((on_line - meeting.point).length() < 1e-12 * (1.0 + meeting.second[0].abs()));
        }
    }

    #[test]
    fn curves_on_a_coarse_grid_are_no_trap(
        a in prop::array::uniform4((0..4_i32, 0..4_i32)), b in prop::array::uniform4((0..4_i32, 0..4_i32)),
    ) {
        // Doubled points, cusps, shared ends, straight and overlapping pieces are common here.
        let on_grid = |points: [(i32, i32); 4]| {
            Cubic::new(points.map(|(x, y)| Vec2::new(f64::from(x), f64::from(y)))).unwrap()
        };
        let (a, b) = (on_grid(a), on_grid(b));
        match intersect(&a, &b, None) {
            Err(error) => prop_assert_eq!(error, CurveError::TooClose),
            Ok(found) => for meeting in found {
                for k in 0..2 {
                    let off = (a.eval(meeting.first[k]) - b.eval(meeting.second[k])).length();
                    prop_assert!(off < 1e-12, "{meeting:?}");
                }
            }
        }
        if let Ok(found) = self_intersections(&a) {
            for meeting in found {
                let off = (a.eval(meeting.first[0]) - a.eval(meeting.second[0])).length();
                prop_assert!(off < 1e-12, "{meeting:?}");
            }
        }
    }

    #[test]
    fn intersections_are_true_and_symmetric(a in cubic(), b in cubic()) {
        let (found, back) = (intersect(&a, &b, None).unwrap(), intersect(&b, &a, None).unwrap());
        prop_assert_eq!(found.len(), back.len());
        for meeting in &found {
            prop_assert!((a.eval(meeting.first[0]) - b.eval(meeting.second[0])).length() < 1e-14);
            let twin = back.iter().any(|other| {
                (other.first[0] - meeting.second[0]).abs() < 1e-11 && (other.second[0] - meeting.first[0]).abs() < 1e-11
            });
            prop_assert!(twin);
        }
    }

    #[test]
    fn intersections_are_those_of_fine_polylines(a in cubic(), b in cubic()) {
        let found = intersect(&a, &b, None).unwrap();
        let oracle = crossings_of_polylines(&a, &b, 100);
        let near = |m: &ogee::curve::Meeting, o: &(f64, f64)| {
            (m.first[0] - o.0).abs() < 0.03 && (m.second[0] - o.1).abs() < 0.03
        };
        // Each crossing of the polylines is near one that was found.
        for crossing in &oracle {
            prop_assert!(found.iter().any(|m| near(m, crossing)), "{:?} missed in {:?}", crossing, found);
        }
        // Others must be nearly tangent, near an end, or a pair within one step, which polylines miss.
        if found.iter().all(|m| m.contact == Contact::Crossing) && found.len() != oracle.len() {
            for meeting in found.iter().filter(|m| !oracle.iter().any(|o| near(m, o))) {
                let [u, v] = [a.derivative(1).unwrap().eval(meeting.first[0]), b.derivative(1).unwrap().eval(meeting.second[0])];
                let angle = u.normalize().perp_dot(v.normalize()).abs();
                let at_end = [meeting.first[0], meeting.second[0]].iter().any(|t| t.min(1.0 - t) < 0.02);
                prop_assert!(angle < 0.3 || at_end, "{meeting:?} is not there");
            }
        }
    }
}
