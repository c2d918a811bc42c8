//! Where curved surfaces of fields cut each other: vertices there lie on all of them, edges near the curve.

use ogee::csg::{self, BuildOptions, Built, Seams, Shape};
use ogee::math::{Vec3, cos, hypot, sin};
use ogee::mesh::{Defects, Mesh, Solid, crossing_pairs};
use ogee::script::{self, Host, Loaded, Message, Options};
use std::f64::consts::PI;
use std::sync::Arc;

struct Nobody;

impl Host for Nobody {
    fn script(&mut self, name: &str, _: &str) -> Result<Loaded, String> {
        Err(format!("{name} is not needed"))
    }

    fn mesh(&mut self, name: &str, _: &str) -> Result<Arc<Mesh>, String> {
        Err(format!("{name} is not needed"))
    }

    fn say(&mut self, message: Message) {
        panic!("{}", message.text);
    }
}

fn built(text: &str) -> (Solid, Built) {
    let main = Loaded { name: "a.scad".into(), text: text.into() };
    let recipe = script::evaluate(main, &mut Nobody, &Options::default()).expect("a script").recipe;
    let built =
        csg::build(&recipe, &BuildOptions::default()).unwrap_or_else(|error| panic!("{text}: {error}"));
    let Shape::Solid(solid) = built.shape.clone() else { panic!("{text}: flat") };
    assert!(Defects::of(solid.mesh()).is_solid(), "{text}");
    let all: Vec<u32> = (0..solid.triangles().len() as u32).collect();
    assert_eq!(crossing_pairs(solid.mesh(), &all), [[0_u32; 2]; 0], "{text}");
    (solid, built)
}

/// Distance from a point to a segment.
fn distance_to_edge(p: Vec3, [a, b]: [Vec3; 2]) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + t * along)
}

/// The edges whose both ends are within `near` of all surfaces.
fn edges_near(solid: &Solid, near: f64, distances: impl Fn(Vec3) -> f64) -> Vec<[Vec3; 2]> {
    let is_near: Vec<bool> = solid.positions().iter().map(|&p| distances(p) <= near).collect();
    let sides = solid.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let on = sides.filter(|&[a, b]| a < b && is_near[a as usize] && is_near[b as usize]);
    on.map(|side| side.map(|v| solid.positions()[v as usize])).collect()
}

/// How far a curve is from edges with both ends on it, at most, in tolerances, and how many vertices were left beside it.
/// Where none was, it must be one tolerance at most.
fn off_curve(
    text: &str,
    tolerance: f64,
    surfaces: &[&dyn Fn(Vec3) -> f64],
    curve: impl Fn(f64) -> Vec3,
) -> usize {
    let (solid, Built { report, .. }) = built(text);
    let Seams { moved, left } = report.seams;
    assert!(moved > 8 && left < moved, "{text}: {:?}", report.seams);
    let off = |p: Vec3| surfaces.iter().map(|surface| surface(p).abs()).fold(0.0, f64::max);
    let edges = edges_near(&solid, 1e-6 * tolerance, off);
    let far = (0..1000)
        .map(|i| curve(f64::from(i) / 1000.0 * 2.0 * PI))
        .map(|p| edges.iter().map(|&edge| distance_to_edge(p, edge)).fold(f64::INFINITY, f64::min));
    let worst = far.fold(0.0, f64::max);
    assert!(worst <= tolerance || left > 0, "{text}: {worst} of {tolerance}");
    left
}

#[test]
fn spheres_meet_in_their_circle_at_any_angle() {
    let mut with_some_left = 0;
    // Centres 2 a apart: the spheres cut each other at 2 acos a.
    for (a, tolerance) in [(0.1_f64, 0.01), (0.5, 0.01), (0.9, 0.01), (0.98, 0.003), (0.05, 0.003)] {
        for verb in ["union", "difference", "intersection"] {
            let text = format!(
                "{verb}() {{ sdf_sphere(1, tolerance={tolerance}); \
                 translate([{}, 0, 0]) rotate([10, 20, 30]) sdf_sphere(1, tolerance={tolerance}); }}",
                2.0 * a
            );
            let radius = (1.0 - a * a).sqrt();
            let surfaces: [&dyn Fn(Vec3) -> f64; 2] =
                [&|p| p.length() - 1.0, &|p| (p - Vec3::X * 2.0 * a).length() - 1.0];
            let circle = |t: f64| Vec3::new(a, radius * cos(t), radius * sin(t));
            with_some_left += usize::from(off_curve(&text, tolerance, &surfaces, circle) > 0);
        }
    }
    assert!(with_some_left < 8, "{with_some_left} of 15");
}

#[test]
fn cylinders_bore_into_spheres_up_to_where_they_graze() {
    let mut with_some_left = 0;
    for (radius, tolerance) in [(0.3_f64, 0.01), (0.9, 0.01), (0.97, 0.004)] {
        let text = format!(
            "difference() {{ sdf_sphere(1, tolerance={tolerance}); \
             sdf_cylinder(r={radius}, h=4, tolerance={tolerance}); }}"
        );
        let surfaces: [&dyn Fn(Vec3) -> f64; 2] = [&|p| p.length() - 1.0, &|p| hypot(p.x, p.y) - radius];
        let height = (1.0 - radius * radius).sqrt();
        let circle = |t: f64| Vec3::new(radius * cos(t), radius * sin(t), height);
        with_some_left += usize::from(off_curve(&text, tolerance, &surfaces, circle) > 0);
    }
    assert!(with_some_left < 2, "{with_some_left} of 3");
}

#[test]
fn flat_faces_stay_flat_and_sharp_edges_sharp() {
    let text = "difference() { cube(2, center=true); translate([1, 1, 1]) sdf_sphere(0.7, tolerance=0.01); \
                translate([-1, 0.3, 0.2]) rotate([5, 0, 0]) sdf_cylinder(r=0.4, h=1, tolerance=0.01); }";
    let (solid, Built { report, .. }) = built(text);
    assert!(report.seams.moved > 20, "{:?}", report.seams);
    // On the faces of the cube to the bit, or on the ball or the cylinder.
    for &p in solid.positions() {
        let on_cube = p.abs().max_element() == 1.0;
        let ball = (p - Vec3::ONE).length() - 0.7;
        let q = ogee::math::Affine3::from_rotation_x(-5_f64.to_radians())
            .transform_point3(p - Vec3::new(-1.0, 0.3, 0.2));
        let cylinder = (hypot(q.x, q.y) - 0.4).abs().min(q.z.abs() - 0.5);
        assert!(on_cube || ball.abs() < 0.011 || cylinder.abs() < 0.011, "{p}");
        assert!(p.abs().max_element() <= 1.0, "{p}");
    }
    // The ball cuts three edges of the cube in points of their own.
    for axis in 0..3 {
        let mut corner = Vec3::ONE;
        corner[axis] = 1.0 - 0.7;
        let nearest = solid.positions().iter().map(|p| p.distance(corner)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-8, "{corner}: {nearest}");
    }
}

#[test]
fn edges_of_a_field_stay_where_they_are() {
    // The box is a field here, cut by a ball across two of its edges.
    let text = "union() { smooth_union(0.2) { translate([3, 0, 0]) sdf_sphere(0.5, tolerance=0.01); \
                translate([3.6, 0, 0]) sdf_sphere(0.4, tolerance=0.01); } difference() { \
                sdf_box([2, 2, 2], tolerance=0.01); translate([1, 0, 1]) sdf_sphere(0.6, tolerance=0.01); } }";
    let (solid, _) = built(text);
    for end in [-0.6, 0.6] {
        let corner = Vec3::new(1.0, end, 1.0);
        let nearest = solid.positions().iter().map(|p| p.distance(corner)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-8, "{corner}: {nearest}");
    }
}

#[test]
fn colours_and_maps_are_kept() {
    let text = "scale([1, 2, 1]) difference() { color(\"red\") sdf_sphere(1, tolerance=0.02); \
                translate([0.8, 0, 0]) color(\"blue\") sdf_sphere(1, tolerance=0.02); }";
    let (solid, Built { colors, report, .. }) = built(text);
    assert_eq!(colors.len(), solid.triangles().len());
    assert!(report.seams.moved > 8 && report.seams.left <= report.seams.moved / 4, "{:?}", report.seams);
    let red = colors.iter().filter(|color| color.is_some_and(|c| c[0] > 0.5)).count();
    assert!(red > 0 && red < colors.len());
    let on_both = solid.positions().iter().filter(|p| {
        let q = Vec3::new(p.x, 0.5 * p.y, p.z);
        (q.length() - 1.0).abs() < 1e-9 && (q - Vec3::X * 0.8).length() - 1.0 < 1e-9
    });
    assert!(on_both.count() >= report.seams.moved);
}

#[test]
fn surfaces_that_only_touch_are_left() {
    for gap in [0.0, 1e-9, 1e-3] {
        let text = format!(
            "union() {{ sdf_sphere(1, tolerance=0.01); translate([{}, 0, 0]) sdf_sphere(1, tolerance=0.01); }}",
            2.0 - gap
        );
        let (solid, _) = built(&text);
        assert!(solid.volume() > 2.0 * 4.0 / 3.0 * PI * 0.97, "{gap}");
    }
}

#[test]
fn what_has_no_seams_keeps_what_is_known_of_it() {
    // Mirrored without rounding.
    let text = "module ball() { implicit(function(p) norm(p - [3, 0, 0]) - 1, [[1.5, -2, -2], [4.5, 2, 2]], \
                tolerance = 0.05); } union() { ball(); mirror([1, 0, 0]) ball(); }";
    let (solid, Built { report, .. }) = built(text);
    assert_eq!(report.seams, Seams::default());
    assert!(solid.is_embedded());
}
