//! Regions of the plane made from any contours, against winding numbers counted directly and against the laws of sets.

use ogee::math::Vec2;
use ogee::polygon::exact::{Boundary, Chart, Lattice, Plane, PointId, Points, triangulate};
use ogee::polygon::{FillRule, Region, combine};
use proptest::prelude::*;

type Contour = Vec<Vec2>;

/// A closed contour on a small grid: shared vertices, overlapping edges, spikes and repeated points are common.
fn contour(side: i32) -> impl Strategy<Value = Contour> {
    let vertex = (0..=side, 0..=side).prop_map(|(x, y)| Vec2::new(f64::from(x), f64::from(y)));
    proptest::collection::vec(vertex, 1..9)
}

fn contours(side: i32) -> impl Strategy<Value = Vec<Contour>> {
    proptest::collection::vec(contour(side), 0..4)
}

/// How often contours wind around a point that lies on none of their edges' lines.
fn winding(contours: &[Contour], p: Vec2) -> i32 {
    let mut times = 0;
    for contour in contours {
        for (i, &a) in contour.iter().enumerate() {
            let b = contour[(i + 1) % contour.len()];
            let left = (b - a).perp_dot(p - a);
            if a.y <= p.y && b.y > p.y && left > 0.0 {
                times += 1;
            } else if b.y <= p.y && a.y > p.y && left < 0.0 {
                times -= 1;
            }
        }
    }
    times
}

/// Points spread over the grid, none of them on a line through grid points.
fn probes(side: i32) -> impl Iterator<Item = Vec2> {
    let golden = 0.618_033_988_749_894_9;
    (0..40).map(move |i| {
        let t = f64::from(i) + 0.5;
        Vec2::new((t * golden).fract(), (t * golden * golden * 7.3).fract()) * f64::from(side)
    })
}

/// Triangles that fill a region, by the exact triangulation.
fn fill(region: &Region) -> Vec<[Vec2; 3]> {
    let largest = region.contours().iter().flatten().fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
    let lattice = Lattice::fitting(largest);
    let chart = Chart::new(&Plane::through([0, 0, 0], [1, 0, 0], [0, 1, 0]).expect("a plane"));
    let mut points = Points::default();
    let (mut boundary, mut lines) = (Vec::new(), Vec::new());
    for contour in region.contours() {
        let ids: Vec<PointId> = contour.iter().map(|p| points.site(lattice.snap(p.extend(0.0)))).collect();
        for (i, &from) in ids.iter().enumerate() {
            let to = ids[(i + 1) % ids.len()];
            boundary.push(Boundary { ends: [from, to], line: lines.len() as u32 });
            lines.push(chart.line_through(&points, from, to).expect("an edge"));
        }
    }
    let place = |p: PointId| lattice.to_model(points.rounded(p)).truncate();
    triangulate(&chart, &points, &lines, &boundary).into_iter().map(|t| t.map(place)).collect()
}

fn area_of(triangle: &[Vec2; 3]) -> f64 {
    0.5 * (triangle[1] - triangle[0]).perp_dot(triangle[2] - triangle[0])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn a_region_is_where_the_rule_holds(contours in contours(5)) {
        for rule in [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive] {
            let region = Region::new(&contours, rule).expect("finite");
            for p in probes(5) {
                let inside = winding(region.contours(), p);
                prop_assert_eq!(inside, i32::from(rule.holds(winding(&contours, p))), "{:?} at {}", rule, p);
            }
        }
    }

    #[test]
    fn areas_add_up(a in contours(4), b in contours(4)) {
        let both = combine(&[&a, &b], 0.0, |w| w.len() == 2);
        let either = combine(&[&a, &b], 0.0, |w| !w.is_empty());
        let area = |c: &[Contour]| Region::new(c, FillRule::NonZero).expect("finite").area();
        prop_assert!((area(&a) + area(&b) - both.area() - either.area()).abs() < 1e-12);
    }

    #[test]
    fn triangles_fill_a_region(contours in contours(6)) {
        let region = Region::new(&contours, FillRule::EvenOdd).expect("finite");
        let triangles = fill(&region);
        let area: f64 = triangles.iter().map(area_of).sum();
        prop_assert!((area - region.area()).abs() < 1e-12 * (1.0 + area), "{} {}", area, region.area());
        prop_assert!(triangles.iter().all(|t| area_of(t) > 0.0));
        let vertices: usize = region.contours().iter().map(Vec::len).sum();
        prop_assert!(triangles.len() <= vertices + 2 * region.contours().len());
    }

    #[test]
    fn contours_have_corners_only(contours in contours(4)) {
        let region = Region::new(&contours, FillRule::NonZero).expect("finite");
        let passed = |p: Vec2| region.contours().iter().flatten().filter(|&&q| q == p).count();
        for contour in region.contours() {
            prop_assert!(contour.len() >= 3);
            for i in 0..contour.len() {
                let [a, b, c] = [0, 1, 2].map(|k| contour[(i + k) % contour.len()]);
                prop_assert!((b - a).perp_dot(c - b).abs() > 1e-9 || passed(b) > 1, "{} {} {}", a, b, c);
            }
        }
    }
}

#[test]
fn touching_contours_stay_apart() {
    // Two squares that share a corner: two contours, not one that passes the corner twice.
    let square = |x: f64, y: f64| {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| Vec2::new(x + a, y + b)).to_vec()
    };
    let region = Region::new(&[square(0.0, 0.0), square(1.0, 1.0)], FillRule::NonZero).expect("finite");
    assert_eq!(region.contours().iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
    assert_eq!(fill(&region).len(), 4);
}

#[test]
fn equal_distances_give_square_triangles() {
    // A long strip of unit squares: the flips prefer diagonals of squares over slivers.
    let top = (0..=20).rev().map(|i| Vec2::new(f64::from(i), 1.0 + 0.01 * f64::from(i % 2)));
    let strip: Contour =
        (0..=20).map(|i| Vec2::new(f64::from(i), -0.01 * f64::from(i % 2))).chain(top).collect();
    let region = Region::new(&[strip], FillRule::NonZero).expect("finite");
    for [a, b, c] in fill(&region) {
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        assert!(longest < 2.1, "{a} {b} {c}");
    }
}

#[test]
fn coordinates_that_are_not_finite_are_named() {
    let bad = vec![vec![Vec2::ZERO], vec![Vec2::X, Vec2::new(f64::NAN, 0.0)]];
    let error = Region::new(&bad, FillRule::NonZero).expect_err("not finite");
    assert_eq!(error.to_string(), "vertex 1 of contour 1 is not finite");
}
