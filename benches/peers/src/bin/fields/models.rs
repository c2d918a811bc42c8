//! What is meshed: as a recipe, as one expression, in plain operations for the peers, and as sheets to measure by.

use crate::truth::{Sheet, Truth};
use ogee::boolean::Op;
use ogee::csg::{Body, Csg, FieldBody, FieldShape};
use ogee::math::{Aabb, Affine3, Vec3};
use ogee::sdf::{Blend, Expr, Implicit, Operation, Periodic, Primitive};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A shape within [-1, 1]^3.
pub(crate) struct Model {
    pub(crate) name: &'static str,
    /// As a tree of fields, within a tolerance.
    pub(crate) recipe: Box<dyn Fn(f64) -> Csg>,
    /// As one field.
    pub(crate) field: Implicit,
    /// The same in the operations that everybody has.
    pub(crate) plain: Vec<Operation>,
    /// By what its meshes are judged.
    pub(crate) truth: Truth,
}

/// The box that all peers mesh.
pub(crate) const DOMAIN: Aabb = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };

pub(crate) fn all() -> Vec<Model> {
    vec![sphere(), torus(), drilled_box(), smooth_union(), gyroid_in_sphere(), spheres(500), cone(), plate()]
}

fn leaf(primitive: Primitive, tolerance: f64) -> Csg {
    body(FieldShape::Primitive(primitive), tolerance)
}

fn body(shape: FieldShape, tolerance: f64) -> Csg {
    Csg::Body(Body::Field(Arc::new(FieldBody { shape, tolerance })))
}

fn moved(map: Affine3, child: Csg) -> Csg {
    Csg::Transform { map, child: Arc::new(child) }
}

fn combined(op: Op, children: Vec<Csg>) -> Csg {
    Csg::Combine { op, children: children.into_iter().map(Arc::new).collect() }
}

fn implicit(primitive: Primitive) -> Implicit {
    Implicit::primitive(primitive).expect("good numbers")
}

/// What peers get is what we get, taken apart.
fn model(name: &'static str, recipe: impl Fn(f64) -> Csg + 'static, field: Implicit, truth: Truth) -> Model {
    let plain = field.expr().operations().expect("a formula");
    Model { name, recipe: Box::new(recipe), field, plain, truth }
}

fn sphere() -> Model {
    let ball = Primitive::Sphere { radius: 0.8 };
    let truth = Truth::intersection(vec![Sheet::Sphere { center: Vec3::ZERO, radius: 0.8 }])
        .with_volume(4.0 / 3.0 * PI * 0.512);
    model("sphere", move |tolerance| leaf(ball, tolerance), implicit(ball), truth)
}

fn torus() -> Model {
    let (major, minor) = (0.6, 0.25);
    let ring = Primitive::Torus { major, minor };
    let truth = Truth::intersection(vec![Sheet::Torus { major, minor }])
        .with_volume(2.0 * PI * PI * major * minor * minor);
    model("torus", move |tolerance| leaf(ring, tolerance), implicit(ring), truth)
}

/// A rounded box minus three cylinders along the axes.
fn drilled_box() -> Model {
    let (half, rounding, hole) = (Vec3::splat(0.7), 0.15, 0.35);
    let block = Primitive::RoundedCuboid { half, radius: rounding };
    let drill = Primitive::Cylinder { radius: hole, half_height: 0.9, rounding: 0.0 };
    let turns = [Affine3::IDENTITY, Affine3::from_rotation_x(0.5 * PI), Affine3::from_rotation_y(0.5 * PI)];
    let recipe = move |tolerance| {
        let drills = turns.map(|turn| moved(turn, leaf(drill, tolerance)));
        combined(Op::Difference, [vec![leaf(block, tolerance)], drills.to_vec()].concat())
    };
    let drilled = |whole: Implicit, turn: &Affine3| {
        whole.difference(&implicit(drill).transform(turn).expect("a rotation"))
    };
    let field = turns.iter().fold(implicit(block), drilled);
    let mut sheets = vec![Sheet::RoundedBox { half, radius: rounding }];
    sheets.extend([2, 1, 0].map(|axis| Sheet::Hole { axis, radius: hole }));
    model("rounded box minus three cylinders", recipe, field, Truth::intersection(sheets))
}

/// Two balls that flow into each other by a quadratic blend.
fn smooth_union() -> Model {
    let balls = [(Vec3::new(-0.3, 0.05, 0.0), 0.5), (Vec3::new(0.4, -0.1, 0.1), 0.35)];
    let radius = 0.15;
    let blend = Blend::Quadratic { radius };
    let recipe = move |tolerance| {
        let ball = |(center, radius): (Vec3, f64)| {
            Arc::new(moved(Affine3::from_translation(center), leaf(Primitive::Sphere { radius }, tolerance)))
        };
        Csg::Blend { op: Op::Union, blend, tolerance, children: balls.map(ball).to_vec() }
    };
    let part = |(center, radius): (Vec3, f64)| {
        implicit(Primitive::Sphere { radius }).translate(center).expect("finite")
    };
    let [a, b] = balls.map(part);
    let field = a.blend_union(&b, blend).expect("a radius");
    // As everybody writes it: min(a, b) - max(k - |a - b|, 0)^2 / 4k.
    let k = std::f64::consts::SQRT_2 * radius;
    let [x, y] = [a.expr(), b.expr()];
    let near = (k - (x - y).abs()).max(0.0);
    let plain = (x.min(y.clone()) - near.square() * (0.25 / k)).operations().expect("a formula");
    let truth = Truth::intersection(vec![Sheet::SmoothPair { balls, reach: k }]);
    Model { name: "smooth union", recipe: Box::new(recipe), field, plain, truth }
}

/// A wall around a gyroid, within a ball.
fn gyroid_in_sphere() -> Model {
    let (period, thickness, radius) = (0.6, 0.06, 0.9);
    let kind = Periodic::Gyroid;
    let ball = Primitive::Sphere { radius };
    let recipe = move |tolerance| {
        let wall = FieldShape::Periodic { kind, period, thickness: Some(thickness), bounds: DOMAIN };
        combined(Op::Intersection, vec![body(wall, tolerance), leaf(ball, tolerance)])
    };
    let wall = implicit(Primitive::Periodic { kind, period }).shell(thickness).expect("a thickness");
    let field = wall.intersection(&implicit(ball));
    let side = |sign| Sheet::Gyroid { turns: TAU / period, sign, half: 0.5 * thickness };
    let truth =
        Truth::intersection(vec![side(1.0), side(-1.0), Sheet::Sphere { center: Vec3::ZERO, radius }]);
    model("gyroid in a sphere", recipe, field, truth)
}

/// A union of random balls.
pub(crate) fn spheres(count: usize) -> Model {
    let mut random = Random(500);
    let balls: Vec<(Vec3, f64)> = (0..count)
        .map(|_| {
            let center = Vec3::from_array([(); 3].map(|()| 1.7 * random.unit() - 0.85));
            (center, 0.03 + 0.07 * random.unit())
        })
        .collect();
    let shapes: Vec<Implicit> = balls
        .iter()
        .map(|&(center, radius)| implicit(Primitive::Sphere { radius }).translate(center).expect("finite"))
        .collect();
    let sheets = balls.iter().map(|&(center, radius)| Sheet::Sphere { center, radius }).collect();
    let recipe = move |tolerance| {
        let ball = |&(center, radius): &(Vec3, f64)| {
            moved(Affine3::from_translation(center), leaf(Primitive::Sphere { radius }, tolerance))
        };
        combined(Op::Union, balls.iter().map(ball).collect())
    };
    model("500 spheres", recipe, Implicit::union_all(&shapes), Truth::union(sheets))
}

fn cone() -> Model {
    let (radius, half): (f64, f64) = (0.6, 0.7);
    let slant = radius.hypot(2.0 * half);
    let (cosine, sine) = (2.0 * half / slant, radius / slant);
    let recipe =
        move |tolerance| body(FieldShape::Frustum { radii: [radius, 0.0], half_height: half }, tolerance);
    let [x, y, z] = Expr::axes();
    let side = Expr::norm2(&x, &y) * cosine + (&z - half) * sine;
    let bounds = Aabb { min: Vec3::new(-radius, -radius, -half), max: Vec3::new(radius, radius, half) };
    let field = Implicit::formula(side.max(-z - half), Some(1.0 + 1e-12), bounds);
    let sheets =
        vec![Sheet::Cone { cosine, sine, apex: half }, Sheet::Plane { normal: Vec3::NEG_Z, offset: half }];
    let truth = Truth::intersection(sheets)
        .with_corners(vec![half * Vec3::Z])
        .with_volume(PI * radius * radius * 2.0 * half / 3.0);
    model("cone", recipe, field, truth)
}

/// A plate of 0.01, off the middle so that it lies on nobody's grid.
fn plate() -> Model {
    let (half, center) = (Vec3::new(0.7, 0.7, 0.005), Vec3::new(0.013, 0.021, 0.0037));
    let slab = Primitive::Cuboid { half };
    let recipe = move |tolerance| moved(Affine3::from_translation(center), leaf(slab, tolerance));
    let field = implicit(slab).translate(center).expect("finite");
    let mut sheets = Vec::new();
    for (axis, k) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().zip(0..) {
        sheets.push(Sheet::Plane { normal: axis, offset: center[k] + half[k] });
        sheets.push(Sheet::Plane { normal: -axis, offset: half[k] - center[k] });
    }
    let truth = Truth::intersection(sheets).with_volume(8.0 * half.element_product());
    model("plate of 0.01", recipe, field, truth)
}

/// A generator of numbers (Steele, Lea, Flood, SplitMix64, 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
