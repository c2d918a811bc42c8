//! Pictures against an independent oracle: rays from the eye, cast one by one in model coordinates.

use super::*;
use crate::math::Affine3;
use crate::math::{Quat, sin_cos, tan};
use crate::mesh::cuboid;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];

/// No extras, transparent background: opacity is coverage.
fn bare(width: u32, height: u32) -> Style {
    Style {
        width,
        height,
        crease: 0.0,
        background: None,
        occlusion: false,
        shadow: false,
        ..Style::default()
    }
}

/// Looks down on the plane z = 0, in which the picture shows `height` model units.
fn above(height: f64) -> Camera {
    let projection = Projection::Orthographic { height };
    Camera { eye: Vec3::Z * 10.0, target: Vec3::ZERO, up: Vec3::Y, projection }
}

fn square(min: f64, max: f64, z: f64) -> Mesh {
    let corner = |x, y| Vec3::new(x, y, z);
    let positions = vec![corner(min, min), corner(max, min), corner(max, max), corner(min, max)];
    Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3]])
}

fn coverage(image: &Image) -> f64 {
    image.pixels.iter().map(|p| f64::from(p[3]) / 255.0).sum()
}

fn at(image: &Image, x: u32, y: u32) -> [u8; 4] {
    image.pixels[(y * image.width + x) as usize]
}

/// A ball of `n` rings, bumpy so that nothing is symmetric.
fn ball(n: u32) -> Mesh {
    let m = 2 * n;
    let point = |i: u32, j: u32| {
        let (s, c) = sin_cos(PI * f64::from(i) / f64::from(n));
        let (sin, cos) = sin_cos(TAU * f64::from(j) / f64::from(m));
        let radius = 1.0 + 0.15 * f64::from((3 * i + 5 * j) % 7) / 7.0;
        Vec3::new(s * cos, s * sin, c) * radius
    };
    let mut positions = vec![point(0, 0), point(n, 0)];
    positions.extend((1..n).flat_map(|i| (0..m).map(move |j| point(i, j))));
    let ring = |i: u32, j: u32| 2 + (i - 1) * m + j % m;
    let mut triangles = Vec::new();
    for j in 0..m {
        triangles.push([0, ring(1, j), ring(1, j + 1)]);
        triangles.push([1, ring(n - 1, j + 1), ring(n - 1, j)]);
        for i in 1..n - 1 {
            let [a, b, c, d] = [ring(i, j), ring(i + 1, j), ring(i + 1, j + 1), ring(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh::new(positions, triangles)
}

/// The ray through the point (x, y) of the picture, in model coordinates.
fn ray(camera: &Camera, width: u32, height: u32, x: f64, y: f64) -> (Vec3, Vec3) {
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let (u, v) = (x - 0.5 * f64::from(width), 0.5 * f64::from(height) - y);
    match camera.projection {
        Projection::Perspective { field_of_view } => {
            let step = 2.0 * tan(0.5 * field_of_view) / f64::from(height);
            (camera.eye, forward + right * (u * step) + up * (v * step))
        }
        Projection::Orthographic { height: shown } => {
            let step = shown / f64::from(height);
            (camera.eye + right * (u * step) + up * (v * step), forward)
        }
    }
}

/// Distance along a ray to a triangle and how far inside of it the hit is (least barycentric coordinate), after
/// Möller and Trumbore.
fn hit((origin, direction): (Vec3, Vec3), [a, b, c]: [Vec3; 3]) -> Option<(f64, f64)> {
    let (e, f) = (b - a, c - a);
    let p = direction.cross(f);
    let det = e.dot(p);
    let t = origin - a;
    let u = t.dot(p) / det;
    let q = t.cross(e);
    let v = direction.dot(q) / det;
    let inside = u.min(v).min(1.0 - u - v);
    (det != 0.0 && inside >= 0.0).then(|| (f.dot(q) / det, inside))
}

/// The nearest triangle along a ray, unless the ray passes close to an edge, where rounding may decide.
fn nearest(mesh: &Mesh, ray: (Vec3, Vec3)) -> Option<Option<usize>> {
    let mut hits: Vec<(f64, f64, usize)> = (0..mesh.triangles.len())
        .filter_map(|t| hit(ray, mesh.corners(t)).map(|(depth, inside)| (depth, inside, t)))
        .filter(|&(depth, ..)| depth > 0.0)
        .collect();
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    match hits.as_slice() {
        [] => Some(None),
        [(_, inside, t), ..] if *inside > 0.02 => Some(Some(*t)),
        _ => None,
    }
}

/// Checks samples of every tile against rays: which triangle each shows, and the depth and light there. Returns how
/// many there were, without those too close to an edge to tell.
fn check_against_rays(mesh: &Mesh, camera: &Camera) -> usize {
    let (width, height) = (96, 80);
    let style = Style { crease: 1.0, ..bare(width, height) };
    let view = View::new(camera, width, height).expect("a camera");
    let scene = Scene::new(mesh, &view, &style).expect("a scene");
    let bins = bin_triangles(&scene, width, height);
    let mut checked = 0;
    for index in bins.all() {
        let mut tile = raster::Tile::new(bins.corner(index));
        bins.at(index).iter().for_each(|&t| scene.draw(t, &mut tile));
        for (x, y, sample) in (0..300_u32).map(|i| (i * 7 % 32, i * 13 % 32, i as usize % raster::SAMPLES)) {
            let offset = raster::sample_offset(sample);
            let [px, py] = [0, 1].map(|k| f64::from(tile.corner[k] + [x, y][k]) + offset[k]);
            let ray = ray(camera, width, height, px, py);
            if let Some(found) = nearest(mesh, ray) {
                let expected = found.map_or(raster::NOBODY, |t| t as u32);
                assert_eq!(tile.triangles_at(x, y)[sample], expected, "at {px} {py}");
                found.iter().for_each(|&t| check_sight(mesh, &scene, t, ray, [px, py]));
                checked += 1;
            }
        }
    }
    checked
}

/// Depth and light at a place of the picture against those where the ray meets the triangle: normals are interpolated
/// over the triangle in space, not over the picture.
fn check_sight(mesh: &Mesh, scene: &Scene<'_>, triangle: usize, ray: (Vec3, Vec3), [x, y]: [f64; 2]) {
    let corners = mesh.corners(triangle);
    let sight = scene.look(triangle as u32, x, y);
    let (along, _) = hit(ray, corners).expect("a hit");
    let point = ray.0 + ray.1 * along;
    approx::assert_relative_eq!(sight.depth, scene.view.place(point).z, max_relative = 1e-9);

    let area = |a: Vec3, b: Vec3, c: Vec3| (b - a).cross(c - a).length();
    let [a, b, c] = corners;
    let weights = [area(b, c, point), area(c, a, point), area(a, b, point)];
    let creases = crease::Creases::new(&scene.placed, scene.indices, 1.0);
    let normals = creases.corner_normals(triangle as u32);
    let normal: Vec3 = normals.iter().zip(weights).map(|(n, w)| *n * w).sum();
    let eye = -scene.view.turn(ray.1).normalize();
    let front = crease::facet_vector(&scene.corners(triangle as u32)).dot(eye) > 0.0;
    let normal = normal.normalize() * if front { 1.0 } else { -1.0 };
    if normal.dot(eye) > 0.0 {
        let albedo = decode(Style::default().material[..3].try_into().expect("three"));
        let expected = light::Studio::new(scene.view.turn(Vec3::Z)).shade(albedo, normal, eye);
        for k in 0..3 {
            approx::assert_abs_diff_eq!(sight.shade.direct[k], expected.direct[k], epsilon = 1e-5);
            approx::assert_abs_diff_eq!(sight.shade.ambient[k], expected.ambient[k], epsilon = 1e-5);
        }
    }
}

#[test]
fn rays_meet_what_samples_show() {
    let mut mesh = ball(6);
    let turn = Affine3::from_rotation_translation(Quat::from_rotation_y(0.4), Vec3::new(0.4, -0.7, 0.3));
    let other = ball(5);
    let moved = other.positions.iter().map(|&p| turn.transform_point3(p)).collect();
    mesh.append(&Mesh::new(moved, other.triangles));
    for orthographic in [false, true] {
        let camera = Camera::fitted(&mesh, &Fit { orthographic, aspect: 1.2, ..Fit::default() });
        assert!(check_against_rays(&mesh, &camera) > 1500);
    }
    // From inside, and with half of the mesh behind the eye.
    let inside = Camera { eye: Vec3::new(0.1, -0.2, 0.1), target: Vec3::new(1.0, 0.5, 0.2), ..wide() };
    assert!(check_against_rays(&mesh, &inside) > 1500);
    let close = Camera { eye: Vec3::new(0.3, 0.2, 0.9), target: Vec3::new(0.2, -3.0, -0.4), ..wide() };
    assert!(check_against_rays(&mesh, &close) > 1500);
}

fn wide() -> Camera {
    let projection = Projection::Perspective { field_of_view: FRAC_PI_2 };
    Camera { eye: Vec3::ZERO, target: Vec3::Y, up: Vec3::Z, projection }
}

#[test]
fn coverage_is_exact_where_samples_can_tell() {
    // 8 x 8 pixels of one unit each: the square covers half of the picture, then half of a column of pixels.
    let image = |mesh: &Mesh| draw(mesh, &above(8.0), &bare(8, 8)).expect("a picture");
    let half = Mesh {
        positions: square(-4.0, 4.0, 0.0)
            .positions
            .iter()
            .map(|p| Vec3::new(p.x.min(0.0), p.y, 0.0))
            .collect(),
        ..square(0.0, 1.0, 0.0)
    };
    assert_eq!(coverage(&image(&half)), 32.0);
    assert_eq!((at(&image(&half), 3, 5)[3], at(&image(&half), 4, 5)[3]), (255, 0));
    let inner = image(&square(-2.5, 2.5, 0.0));
    assert_eq!([at(&inner, 1, 4)[3], at(&inner, 1, 1)[3], at(&inner, 2, 2)[3]], [128, 64, 255]);
    // A triangle's area to the accuracy of sixteen samples along its edges.
    let triangle =
        Mesh::new(vec![Vec3::ZERO, Vec3::new(3.1, 0.7, 0.0), Vec3::new(-1.3, 3.3, 0.0)], vec![[0, 1, 2]]);
    let fine = draw(&triangle, &above(8.0), &bare(64, 64)).expect("a picture");
    let (found, area) = (coverage(&fine), 32.0 * (3.1 * 3.3 + 0.7 * 1.3));
    assert!((found - area).abs() < 0.003 * area, "{found} for {area}");
}

/// Shared edges leave no gap and cover nothing twice, wherever they run.
#[test]
fn triangles_tile_the_plane() {
    let turn = Quat::from_rotation_z(0.3137);
    let positions =
        (0..441).map(|i| turn * Vec3::new(f64::from(i % 21) - 10.0, f64::from(i / 21) - 10.0, 0.0));
    let quad = |i: u32| [[i, i + 1, i + 22], [i, i + 22, i + 21]];
    let triangles = (0..420).filter(|i| i % 21 != 20).flat_map(quad).collect();
    let mesh = Mesh::new(positions.collect(), triangles);
    // A screen door of eight samples shows double coverage: two different doors would fill a pixel.
    let style = Style { material: [1.0, 1.0, 1.0, 0.5], ..bare(64, 64) };
    let image = draw(&mesh, &above(12.0), &style).expect("a picture");
    assert!(image.pixels.iter().all(|p| p[3] == 128));
}

#[test]
fn near_things_hide_far_things() {
    let mut mesh = square(-1.0, 1.0, 0.0);
    mesh.append(&square(-0.5, 0.5, 1.0));
    let style = Style { colors: [RED, RED, GREEN, GREEN].map(Some).to_vec(), ..bare(40, 40) };
    let image = draw(&mesh, &above(4.0), &style).expect("a picture");
    let [r, g, ..] = at(&image, 20, 20);
    assert!(g > 100 && r < 80, "green in front");
    let [r, g, ..] = at(&image, 12, 20);
    assert!(r > 100 && g < 80, "red around it");
    let below = Camera { eye: Vec3::Z * -10.0, ..above(4.0) };
    let [r, g, ..] = at(&draw(&mesh, &below, &style).expect("a picture"), 20, 20);
    assert!(r > 100 && g < 80, "red in front from below");
}

/// The floor under the eye reaches behind it: what is left after clipping is what the horizon leaves.
#[test]
fn the_near_plane_cuts_and_nothing_else() {
    let camera = Camera { eye: Vec3::new(0.0, 0.0, 1.0), target: Vec3::new(0.0, 1.0, 1.0), ..wide() };
    let image = draw(&square(-1e6, 1e6, 0.0), &camera, &bare(64, 64)).expect("a picture");
    for y in 0..64 {
        for x in 0..64 {
            assert_eq!(at(&image, x, y)[3], if y < 32 { 0 } else { 255 }, "{x} {y}");
        }
    }
}

#[test]
fn fitted_cameras_leave_the_margin() {
    for mesh in [ball(9), cuboid(Vec3::ZERO, Vec3::new(9.0, 1.0, 0.2)).into_mesh()] {
        for (orthographic, aspect, scale) in
            [(false, 1.5, 1.0), (true, 0.6, 1e-300), (false, 1.0, 1e290), (true, 2.0, 1.0)]
        {
            let positions = mesh.positions.iter().map(|&p| (p + Vec3::splat(50.0)) * scale).collect();
            let mesh = Mesh::new(positions, mesh.triangles.clone());
            let camera = Camera::fitted(&mesh, &Fit { orthographic, aspect, ..Fit::default() });
            let view = View::new(&camera, (aspect * 100.0) as u32, 100).expect("a camera");
            let points: Vec<_> =
                mesh.positions.iter().map(|&p| view.project(view.place(p)).expect("in sight")).collect();
            let pixels = |k: i32| f64::from(k) / f64::from(camera::SUBPIXELS);
            let extent = |of: fn(&camera::ScreenPoint) -> i32| {
                let all = || points.iter().map(|p| pixels(of(p)));
                (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max))
            };
            let ((left, right), (top, bottom)) = (extent(|p| p.x), extent(|p| p.y));
            let free = (left / (aspect * 100.0)).min(top / 100.0);
            assert!((free - 0.08).abs() < 1e-3, "{free}");
            let binding = if left < top { left + right - aspect * 100.0 } else { top + bottom - 100.0 };
            assert!(binding.abs() < 0.01, "{binding}");
        }
    }
}

/// The gimbal of OpenSCAD's default view looks from the front, the right and above.
#[test]
fn gimbal_angles() {
    let camera = Camera::gimbal(Vec3::X, Vec3::new(55.0, 0.0, 25.0).map(f64::to_radians), 2.0);
    let (s, c) = sin_cos(55_f64.to_radians());
    let (sz, cz) = sin_cos(25_f64.to_radians());
    let expected = Vec3::X + 2.0 * Vec3::new(s * sz, -s * cz, c);
    assert!((camera.eye - expected).length() < 1e-14, "{camera:?}");
    assert!(camera.up.dot(camera.eye - camera.target).abs() < 1e-14 && camera.up.z > 0.0);
}

#[test]
fn edges_are_lines_of_their_width_and_hide() {
    let mesh = cuboid(Vec3::splat(-1.0), Vec3::splat(1.0)).into_mesh();
    let edges = Some(Edges { color: [0.0; 3], width: 2.0 });
    let style = Style { edges, crease: 0.5, background: Some([1.0; 3]), ..bare(80, 80) };
    let image = draw(&mesh, &above(4.0), &style).expect("a picture");
    // The outline, two pixels wide about pixel 20; neither the diagonal nor the far side is drawn inside.
    let dark: Vec<u32> = (0..40).filter(|&x| at(&image, x, 33)[0] < 40).collect();
    assert_eq!(dark, [19, 20]);
    assert!((25..55).all(|k| at(&image, k, 40)[0] > 90 && at(&image, k, k)[0] > 90));
}

#[test]
fn creases_part_smooth_from_sharp() {
    // A box with 90 degree edges, flat at any lesser crease; a ball with soft edges, smooth.
    let flat = |mesh: &Mesh, crease: f64| {
        let creases = crease::Creases::new(&mesh.positions, &mesh.triangles, crease);
        (0..mesh.triangles.len()).all(|t| {
            let facet = crease::facet_vector(&mesh.corners(t)).normalize();
            creases.corner_normals(t as u32).iter().all(|n| (*n - facet).length() < 1e-12)
        })
    };
    let block = cuboid(Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)).into_mesh();
    assert!(flat(&block, 1.5) && !flat(&block, 1.6));
    assert!(flat(&ball(8), 0.0) && !flat(&ball(8), 1.0));
    let creases = crease::Creases::new(&block.positions, &block.triangles, 1.5);
    assert_eq!(creases.sharp_edges(&block.triangles).len(), 12);
}

#[test]
fn wrong_input_is_a_typed_error() {
    let mesh = square(-1.0, 1.0, 0.0);
    let draw_with = |mesh: &Mesh, camera: &Camera, style: Style| draw(mesh, camera, &style);
    let fine = || bare(8, 8);
    let camera = above(4.0);
    for (width, height) in [(0, 8), (8, 0), (16385, 1), (16384, 16384)] {
        let error = draw_with(&mesh, &camera, Style { width, height, ..fine() });
        assert_eq!(error, Err(RenderError::BadSize { width, height }));
    }
    let blind = |projection| Camera { projection, ..camera };
    for camera in [
        Camera { eye: camera.target, ..camera },
        Camera { eye: Vec3::NAN, ..camera },
        Camera { up: Vec3::ZERO, ..camera },
        blind(Projection::Perspective { field_of_view: PI }),
        blind(Projection::Perspective { field_of_view: f64::NAN }),
        blind(Projection::Orthographic { height: 0.0 }),
        blind(Projection::Orthographic { height: f64::INFINITY }),
    ] {
        let error = draw_with(&mesh, &camera, fine());
        assert!(matches!(error, Err(RenderError::BadCamera { .. })), "{camera:?}: {error:?}");
    }
    let colors = vec![None; 3];
    assert!(matches!(draw(&mesh, &camera, &Style { colors, ..fine() }), Err(RenderError::ColorCount { .. })));
    let mut broken = mesh.clone();
    broken.positions[2].x = f64::NAN;
    assert!(matches!(draw(&broken, &camera, &fine()), Err(RenderError::OutOfSight { vertex: 2, .. })));
    broken.triangles = vec![[0, 1, 9]];
    let out_of_range = RenderError::IndexOutOfRange { triangle: 0, positions: 4 };
    assert_eq!(draw(&broken, &camera, &fine()), Err(out_of_range));
}

#[test]
fn nothing_and_slivers_are_background() {
    let white = Style { background: Some([1.0; 3]), occlusion: true, shadow: true, ..bare(16, 16) };
    let sliver = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0], vec![[0, 1, 2], [1, 1, 2]]);
    for mesh in [Mesh::default(), sliver] {
        let camera = Camera::fitted(&mesh, &Fit::default());
        let image = draw(&mesh, &camera, &white).expect("a picture");
        assert!(image.pixels.iter().all(|p| *p == [255; 4]));
    }
}

/// The picture does not depend on the model's units or place, up to rounding.
#[test]
fn huge_tiny_and_far_scenes_look_the_same() {
    let style = Style { width: 60, height: 45, ..Style::default() };
    let picture = |map: Affine3| {
        let mesh = ball(8);
        let mesh =
            Mesh::new(mesh.positions.iter().map(|&p| map.transform_point3(p)).collect(), mesh.triangles);
        draw(&mesh, &Camera::fitted(&mesh, &Fit::default()), &style).expect("a picture")
    };
    let plain = picture(Affine3::IDENTITY);
    for map in [
        Affine3::from_scale(Vec3::splat(1e-200)),
        Affine3::from_scale(Vec3::splat(3e250)),
        Affine3::from_translation(Vec3::new(1e6, -1e6, 1e6)),
    ] {
        let other = picture(map);
        let different = |(a, b): &(&[u8; 4], &[u8; 4])| (0..3).any(|k| a[k].abs_diff(b[k]) > 2);
        let count = plain.pixels.iter().zip(&other.pixels).filter(different).count();
        assert!(count < 8, "{count} pixels differ for {map:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any triangles and any camera give a picture or an error.
    #[test]
    fn anything_can_be_drawn(
        points in prop::collection::vec(prop::array::uniform3(coordinate()), 1..12),
        corners in prop::collection::vec(prop::array::uniform3(0..12_u32), 0..12),
        eye in prop::array::uniform3(coordinate()),
        target in prop::array::uniform3(coordinate()),
        orthographic in any::<bool>(),
    ) {
        let count = points.len() as u32;
        let mesh = Mesh::new(points.into_iter().map(Vec3::from).collect(), corners.into_iter().map(|t| t.map(|v| v % count)).collect());
        let edges = Some(Edges::default());
        let style = Style { width: 40, height: 30, edges, ..Style::default() };
        let camera = Camera { eye: eye.into(), target: target.into(), ..wide() };
        let camera = if orthographic { camera.to_orthographic() } else { camera };
        let _ = draw(&mesh, &camera, &style);
        let _ = draw(&mesh, &Camera::fitted(&mesh, &Fit { orthographic, ..Fit::default() }), &style);
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    let hard = [0.0, 1.0, -1.0, 1e-300, 5e-324, 1e300, f64::MAX, -f64::MAX, f64::NAN, f64::INFINITY];
    prop_oneof![4 => -10.0..10.0_f64, 1 => prop::sample::select(hard.to_vec())]
}

/// The bits of a small picture with everything on. When it changes, look at the picture that the message shows, and
/// only then at the hash.
#[test]
fn golden_picture() {
    let mut mesh = cuboid(Vec3::new(-2.0, -1.5, -1.0), Vec3::new(2.0, 1.5, -0.8)).into_mesh();
    mesh.append(&ball(10));
    let style = Style { width: 72, height: 54, edges: Some(Edges::default()), ..Style::default() };
    let image = draw(&mesh, &Camera::fitted(&mesh, &Fit::default()), &style).expect("a picture");
    // FNV-1a.
    let mix = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = image.pixels.iter().flatten().fold(0xcbf2_9ce4_8422_2325, mix);
    assert_eq!(format!("{hash:016x}"), "857544de89233688", "\n{}", in_letters(&image));
}

/// A picture as text, dark to light; two rows of pixels make one row of letters.
fn in_letters(image: &Image) -> String {
    const SHADES: &[u8] = b"@%#*+=-:. ";
    let shade = |p: &[u8; 4]| SHADES[usize::from(p[1]) * (SHADES.len() - 1) / 255] as char;
    image
        .pixels
        .chunks(2 * image.width as usize)
        .map(|rows| rows[..image.width as usize].iter().map(shade).collect::<String>() + "\n")
        .collect()
}
