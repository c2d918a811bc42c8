//! Patches and surfaces through ogee, truck and curvo, in one run. See README.md.

#![allow(clippy::print_stdout, reason = "a program")]

use cpu_time::ProcessTime;
use curvo::prelude::{AdaptiveTessellationOptions, NurbsSurface3D, SurfaceTessellation3D, Tessellation as _};
use nalgebra::{Point3, Point4, Vector3};
use ogee::math::Vec3;
use ogee::surface::{Classic, Patch, Surface};
use ogee::tessellate::{Guarantee, SurfaceOptions, Tessellation, patches, surface};
use std::f64::consts::{PI, TAU};
use std::hint::black_box;
use truck_geometry::prelude::{
    BSplineSurface, KnotVec, ParameterDivision2D, ParametricSurface, ParametricSurface3D,
    Point3 as TruckPoint, Sphere, Torus,
};
use truck_polymesh::StructuredMesh;

const MAJOR: f64 = 2.0;
const MINOR: f64 = 0.5;

fn main() {
    let wanted = std::env::args().nth(1);
    let wants = |name: &str| wanted.as_deref().is_none_or(|wanted| wanted == name);
    if wants("evaluation") {
        evaluation();
    }
    println!("surface,side,tolerance,triangles,measured_error,milliseconds,least_triangles_ratio");
    if wants("sphere") {
        sphere_rows();
    }
    if wants("torus") {
        torus_rows();
    }
    if wants("teapot") {
        teapot_rows(&teapot());
    }
}

fn teapot() -> Vec<Patch> {
    ogee::io::bpt::read(include_bytes!("../../../../fixtures/patches/teapot.bpt")).expect("a teapot")
}

/// A result and the least CPU time of some calls, in milliseconds.
fn timed<T>(call: impl Fn() -> T) -> (T, f64) {
    let once = ProcessTime::now();
    let result = call();
    let first = once.elapsed().as_secs_f64();
    let rounds = (0.5 / first.max(1e-6)).clamp(1.0, 9.0) as usize;
    let round = || {
        let start = ProcessTime::now();
        drop(black_box(call()));
        start.elapsed().as_secs_f64()
    };
    (result, 1e3 * (0..rounds).map(|_| round()).fold(first, f64::min))
}

/// Triangles by their corners, with what each corner's parameters are and the surface it is of.
#[derive(Default)]
struct Triangles(Vec<(usize, [[f64; 2]; 3], [Vec3; 3])>);

impl Triangles {
    fn of(made: &Tessellation) -> Triangles {
        let triangle = |t: usize| (made.surfaces[t] as usize, made.parameters[t], made.mesh.corners(t));
        Triangles((0..made.mesh.triangles.len()).map(triangle).collect())
    }

    /// The cells of a grid that are not collapsed, each as two triangles; `at` gives the parameters as ogee has them.
    fn add_grid(&mut self, index: usize, mesh: &StructuredMesh, at: impl Fn(f64, f64) -> [f64; 2]) {
        let (us, vs) = mesh.uv_division().expect("made of a surface");
        let corner = |i: usize, j: usize| {
            let p = mesh.positions()[i][j];
            (at(us[i], vs[j]), Vec3::new(p.x, p.y, p.z))
        };
        for i in 1..us.len() {
            for j in 1..vs.len() {
                let [a, b, c, d] =
                    [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)].map(|(i, j)| corner(i, j));
                self.add(index, [a, b, c]);
                self.add(index, [a, c, d]);
            }
        }
    }

    fn add_curvo(
        &mut self,
        index: usize,
        mesh: &SurfaceTessellation3D<f64>,
        at: impl Fn(f64, f64) -> [f64; 2],
    ) {
        for face in mesh.faces() {
            let corner = |k: usize| {
                let (p, uv) = (&mesh.points()[k], &mesh.uvs()[k]);
                (at(uv.x, uv.y), Vec3::new(p.x, p.y, p.z))
            };
            self.add(index, face.map(corner));
        }
    }

    /// Triangles without area, at poles, are none.
    fn add(&mut self, index: usize, corners: [([f64; 2], Vec3); 3]) {
        let [a, b, c] = corners.map(|(_, p)| p);
        if (b - a).cross(c - a).length_squared() > 0.0 {
            self.0.push((index, corners.map(|(at, _)| at), corners.map(|(_, p)| p)));
        }
    }

    /// The largest distance from the surface by 28 points of every triangle, each with its own nearest point.
    fn error(&self, distance: impl Fn(usize, Vec3, [f64; 2]) -> f64) -> f64 {
        const STEPS: usize = 6;
        let mut most: f64 = 0.0;
        for &(index, at, corners) in &self.0 {
            for i in 0..=STEPS {
                for j in 0..=STEPS - i {
                    let weights = [i, j, STEPS - i - j].map(|k| k as f64 / STEPS as f64);
                    let place: Vec3 = (0..3).map(|k| weights[k] * corners[k]).sum();
                    let near =
                        [0, 1].map(|axis: usize| (0..3).map(|k| weights[k] * at[k][axis]).sum::<f64>());
                    most = most.max(distance(index, place, near));
                }
            }
        }
        most
    }
}

fn row(
    name: &str,
    side: &str,
    tolerance: f64,
    triangles: &Triangles,
    error: f64,
    milliseconds: f64,
    least: f64,
) {
    let count = triangles.0.len();
    let ratio = if least > 0.0 { format!("{:.3}", count as f64 / least) } else { String::new() };
    println!("{name},{side},{tolerance:.3e},{count},{error:.3e},{milliseconds:.2},{ratio}");
}

/// Ours at a tolerance, proven and measured, and with the tolerance at which our measured error is that of a peer.
fn ours(
    name: &str,
    tolerance: f64,
    least: f64,
    made: &dyn Fn(&SurfaceOptions) -> Tessellation,
    error: &dyn Fn(&Triangles) -> f64,
) {
    for (side, guarantee) in [("ogee proven", Guarantee::Proven), ("ogee measured", Guarantee::Measured)] {
        let options = SurfaceOptions { guarantee, ..SurfaceOptions::within(tolerance) };
        let (result, milliseconds) = timed(|| made(&options));
        let triangles = Triangles::of(&result);
        let found = error(&triangles);
        // What is proven holds; what is measured holds at the places where it was.
        let room = if guarantee == Guarantee::Proven { 1.0 } else { 1.02 };
        assert!(found <= room * tolerance, "{name}: {found} of {tolerance}");
        row(name, side, tolerance, &triangles, found, milliseconds, least / tolerance);
    }
}

/// Ours, measured, with the coarsest tolerance at which the measured error is not above a peer's.
fn ours_as_good_as(
    name: &str,
    wanted: f64,
    made: &dyn Fn(&SurfaceOptions) -> Tessellation,
    error: &dyn Fn(&Triangles) -> f64,
) {
    let mut best: Option<f64> = None;
    let at = |tolerance: f64| SurfaceOptions {
        guarantee: Guarantee::Measured,
        ..SurfaceOptions::within(tolerance)
    };
    for factor in [1.0, 1.05, 1.1, 1.2, 1.3, 1.5, 1.7, 2.0] {
        if error(&Triangles::of(&made(&at(factor * wanted)))) <= wanted {
            best = Some(factor * wanted);
        }
    }
    let tolerance = best.unwrap_or(wanted);
    let (result, milliseconds) = timed(|| made(&at(tolerance)));
    let triangles = Triangles::of(&result);
    let found = error(&triangles);
    row(name, "ogee as good", tolerance, &triangles, found, milliseconds, 0.0);
}

fn sphere_rows() {
    let ball = Classic::Sphere { radius: 1.0 };
    let made = |options: &SurfaceOptions| surface(&ball, options).expect("a sphere");
    let error = |triangles: &Triangles| triangles.error(|_, place, _| (place.length() - 1.0).abs());
    let least = 8.0 * PI / (3.0 * 3.0_f64.sqrt());
    let truck = Sphere::new(TruckPoint::new(0.0, 0.0, 0.0), 1.0);
    let curvo = NurbsSurface3D::<f64>::try_sphere(&Point3::origin(), &Vector3::z(), &Vector3::x(), 1.0)
        .expect("a sphere");
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5] {
        ours("sphere", tolerance, least, &made, &error);
        truck_rows("sphere", &truck, ((0.0, PI), (0.0, TAU)), tolerance, &made, &error);
    }
    curvo_rows("sphere", &[curvo], &|_, u, v| [u, v], &made, &error);
}

fn torus_rows() {
    let ring = Classic::Torus { major: MAJOR, minor: MINOR };
    let made = |options: &SurfaceOptions| surface(&ring, options).expect("a torus");
    let error = |triangles: &Triangles| {
        triangles.error(|_, p, _| {
            let around = p.truncate().length() - MAJOR;
            ((around * around + p.z * p.z).sqrt() - MINOR).abs()
        })
    };
    let truck = Torus::new(TruckPoint::new(0.0, 0.0, 0.0), MAJOR, MINOR);
    let full = (0.0, TAU);
    let (x, y) = (Vector3::x(), Vector3::y());
    let curvo = NurbsSurface3D::<f64>::try_torus(&Point3::origin(), &x, &y, MAJOR, MINOR, full, full)
        .expect("a torus");
    for tolerance in [1e-2, 1e-3, 1e-4] {
        ours("torus", tolerance, 0.0, &made, &error);
        truck_rows("torus", &truck, (full, full), tolerance, &made, &error);
    }
    curvo_rows("torus", &[curvo], &|_, u, v| [u, v], &made, &error);
}

fn teapot_rows(teapot: &[Patch]) {
    let made = |options: &SurfaceOptions| patches(teapot, options).expect("a teapot");
    let error = |triangles: &Triangles| triangles.error(|index, place, at| near(&teapot[index], place, at));
    let trucks: Vec<BSplineSurface<TruckPoint>> = teapot.iter().map(truck_patch).collect();
    let curvos: Vec<NurbsSurface3D<f64>> = teapot.iter().map(curvo_patch).collect();
    for tolerance in [1e-2, 1e-3, 1e-4] {
        ours("teapot", tolerance, 0.0, &made, &error);
        let (meshes, milliseconds) = timed(|| {
            let mesh = |patch| StructuredMesh::from_surface(patch, ((0.0, 1.0), (0.0, 1.0)), tolerance);
            trucks.iter().map(mesh).collect::<Vec<StructuredMesh>>()
        });
        let mut triangles = Triangles::default();
        meshes.iter().enumerate().for_each(|(k, mesh)| triangles.add_grid(k, mesh, |u, v| [u, v]));
        let found = error(&triangles);
        row("teapot", "truck", tolerance, &triangles, found, milliseconds, 0.0);
        ours_as_good_as("teapot", found, &made, &error);
    }
    curvo_rows("teapot", &curvos, &|_, u, v| [u, v], &made, &error);
}

/// The distance of a place from a patch near some parameters, by Gauss-Newton steps within the unit square.
fn near(patch: &Patch, place: Vec3, start: [f64; 2]) -> f64 {
    let mut at = start;
    let mut best = f64::INFINITY;
    for _ in 0..6 {
        let jet = patch.jet(at[0], at[1]);
        let off = place - jet.point;
        best = best.min(off.length());
        let [e, f, g] = jet.first_form();
        let (a, b) = (off.dot(jet.du), off.dot(jet.dv));
        let determinant = e * g - f * f;
        if determinant <= 0.0 {
            break;
        }
        at = [at[0] + (g * a - f * b) / determinant, at[1] + (e * b - f * a) / determinant]
            .map(|t: f64| t.clamp(0.0, 1.0));
    }
    best
}

fn truck_rows<S: ParametricSurface3D + ParameterDivision2D>(
    name: &str,
    surface: &S,
    range: ((f64, f64), (f64, f64)),
    tolerance: f64,
    made: &dyn Fn(&SurfaceOptions) -> Tessellation,
    error: &dyn Fn(&Triangles) -> f64,
) {
    let (mesh, milliseconds) = timed(|| StructuredMesh::from_surface(surface, range, tolerance));
    let mut triangles = Triangles::default();
    triangles.add_grid(0, &mesh, |u, v| [u, v]);
    let found = error(&triangles);
    row(name, "truck", tolerance, &triangles, found, milliseconds, 0.0);
    ours_as_good_as(name, found, made, error);
}

/// Its tolerance is one of normals, so several of them are tried.
fn curvo_rows(
    name: &str,
    surfaces: &[NurbsSurface3D<f64>],
    at: &dyn Fn(usize, f64, f64) -> [f64; 2],
    made: &dyn Fn(&SurfaceOptions) -> Tessellation,
    error: &dyn Fn(&Triangles) -> f64,
) {
    for tolerance in [1e-1, 3e-2, 1e-2] {
        let mut options = AdaptiveTessellationOptions::<_>::default().with_norm_tolerance(tolerance);
        options.max_depth = 12;
        let (meshes, milliseconds) = timed(|| {
            let mesh = |surface: &NurbsSurface3D<f64>| surface.tessellate(Some(options.clone()));
            surfaces.iter().map(mesh).collect::<Vec<_>>()
        });
        let mut triangles = Triangles::default();
        meshes.iter().enumerate().for_each(|(k, mesh)| triangles.add_curvo(k, mesh, |u, v| at(k, u, v)));
        let found = error(&triangles);
        row(name, "curvo", tolerance, &triangles, found, milliseconds, 0.0);
        ours_as_good_as(name, found, made, error);
    }
}

fn truck_patch(patch: &Patch) -> BSplineSurface<TruckPoint> {
    let [m, n] = patch.degrees();
    let rows = patch.points().chunks(n + 1);
    let net = rows.map(|row| row.iter().map(|p| TruckPoint::new(p.x, p.y, p.z)).collect()).collect();
    BSplineSurface::new((KnotVec::bezier_knot(m), KnotVec::bezier_knot(n)), net)
}

fn curvo_patch(patch: &Patch) -> NurbsSurface3D<f64> {
    let [m, n] = patch.degrees();
    let rows = patch.points().chunks(n + 1);
    let net = rows.map(|row| row.iter().map(|p| Point4::new(p.x, p.y, p.z, 1.0)).collect()).collect();
    let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    NurbsSurface3D::new(m, n, knots(m), knots(n), net)
}

/// Nanoseconds for a point and its unit normal, on a grid of 64 by 64.
fn evaluation() {
    const SIDE: usize = 64;
    println!("evaluation,side,nanoseconds,ratio,error");
    let patch = teapot()[4].clone();
    let (truck, curvo) = (truck_patch(&patch), curvo_patch(&patch));
    let at: Vec<f64> = (0..SIDE).map(|k| (k as f64 + 0.5) / SIDE as f64).collect();
    let best = |work: &dyn Fn()| {
        let round = || {
            let start = ProcessTime::now();
            work();
            start.elapsed().as_secs_f64()
        };
        (0..40).map(|_| round()).fold(f64::INFINITY, f64::min)
    };
    const TIMES: usize = 64;
    let each = 1e9 / (SIDE * SIDE) as f64;
    let ours = each / TIMES as f64
        * best(&|| {
            for _ in 0..TIMES {
                black_box(black_box(&patch).grid(black_box(&at), black_box(&at)));
            }
        });
    let theirs = each
        * best(&|| {
            for &u in black_box(&at) {
                for &v in &at {
                    black_box((truck.subs(u, v), truck.normal(u, v)));
                }
            }
        });
    let last = each
        * best(&|| {
            for &u in black_box(&at) {
                for &v in &at {
                    let (point, normal) = curvo.point_normal_at(u, v);
                    black_box((point, normal.normalize()));
                }
            }
        });
    let (points, normals) = patch.grid(&at, &at);
    let off = |point: &dyn Fn(f64, f64) -> (Vec3, Vec3)| {
        let pair = |k: usize| {
            let (p, n) = point(at[k / SIDE], at[k % SIDE]);
            (p - points[k]).length().max((n - normals[k]).length())
        };
        (0..SIDE * SIDE).map(pair).fold(0.0, f64::max)
    };
    let truck_off = off(&|u, v| {
        let (p, n) = (truck.subs(u, v), truck.normal(u, v));
        (Vec3::new(p.x, p.y, p.z), Vec3::new(n.x, n.y, n.z))
    });
    let curvo_off = off(&|u, v| {
        let (p, n) = curvo.point_normal_at(u, v);
        let n = n.normalize();
        (Vec3::new(p.x, p.y, p.z), Vec3::new(n.x, n.y, n.z))
    });
    let own = off(&|u, v| (patch.eval(u, v), patch.normal(u, v).expect("smooth")));
    println!("bicubic point and normal,ogee grid,{ours:.2},1,{own:.1e}");
    println!("bicubic point and normal,truck,{theirs:.2},{:.1},{truck_off:.1e}", theirs / ours);
    println!("bicubic point and normal,curvo,{last:.2},{:.1},{curvo_off:.1e}", last / ours);
}
