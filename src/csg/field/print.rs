//! Fields and smooth operators as calls of the script language.

use super::{FieldBody, FieldShape, Formula, Offset};
use crate::boolean::Op;
use crate::csg::Csg;
use crate::csg::print::{list, number, vec3};
use crate::math::Aabb;
use crate::sdf::{Binary, Blend, Operation, Periodic, Primitive, Unary};

/// The call that makes a smooth operator, without its children.
pub(in crate::csg) fn operator_call(recipe: &Csg) -> String {
    match recipe {
        Csg::Blend { op, blend, tolerance, .. } => {
            let name = match op {
                Op::Union => "smooth_union",
                Op::Intersection => "smooth_intersection",
                Op::Difference => "smooth_difference",
                Op::SymmetricDifference => "smooth_symmetric_difference",
            };
            let kind = match blend {
                Blend::Circular { .. } => "round",
                Blend::Quadratic { .. } => "soft",
                Blend::Chamfer { .. } => "chamfer",
            };
            let (size, tolerance) = (number(blend.size()), number(*tolerance));
            format!("{name}(r = {size}, kind = \"{kind}\", tolerance = {tolerance})")
        }
        Csg::Offset { how, tolerance, .. } => {
            let (name, parameter) = match how {
                Offset::By(_) => ("offset3d", "r"),
                Offset::Shell(_) => ("shell", "t"),
                Offset::Round(_) => ("round", "r"),
            };
            format!("{name}({parameter} = {}, tolerance = {})", number(how.size()), number(*tolerance))
        }
        _ => unreachable!("only smooth operators are written so"),
    }
}

/// The call that makes a field.
pub(in crate::csg) fn body_call(body: &FieldBody) -> String {
    let call = match &body.shape {
        FieldShape::Primitive(primitive) => primitive_call(*primitive),
        FieldShape::Frustum { radii: [low, high], half_height } => {
            let height = number(2.0 * half_height);
            format!("sdf_cone(h = {height}, r1 = {}, r2 = {}", number(*low), number(*high))
        }
        FieldShape::Prism { sides, radius, half_height } => {
            format!("sdf_prism(n = {sides}, r = {}, h = {}", number(*radius), number(2.0 * half_height))
        }
        FieldShape::Periodic { kind, period, thickness, bounds } => {
            let thickness = thickness.map_or_else(String::new, |t| format!(", thickness = {}", number(t)));
            let name = periodic_name(*kind);
            format!("{name}(period = {}, bounds = {}{thickness}", number(*period), corners(*bounds))
        }
        FieldShape::Metaballs { balls, threshold } => {
            let balls = balls.iter().map(|(center, radius, weight)| {
                list([vec3(*center), number(*radius), number(*weight)].into_iter())
            });
            format!("sdf_metaballs(balls = {}, threshold = {}", list(balls), number(*threshold))
        }
        FieldShape::Formula { formula, bounds } => {
            format!("implicit({}, bounds = {}", function(formula), corners(*bounds))
        }
    };
    format!("{call}, tolerance = {})", number(body.tolerance))
}

fn primitive_call(primitive: Primitive) -> String {
    let twice = |half: f64| number(2.0 * half);
    match primitive {
        Primitive::Sphere { radius } => format!("sdf_sphere(r = {}", number(radius)),
        Primitive::Ellipsoid { radii } => format!("sdf_ellipsoid(r = {}", vec3(radii)),
        Primitive::Cuboid { half } => format!("sdf_box(size = {}", vec3(2.0 * half)),
        Primitive::RoundedCuboid { half, radius } => {
            format!("sdf_rounded_box(size = {}, r = {}", vec3(2.0 * half), number(radius))
        }
        Primitive::Cylinder { radius, half_height, rounding } => {
            let (height, rounding) = (twice(half_height), number(rounding));
            format!("sdf_cylinder(h = {height}, r = {}, rounding = {rounding}", number(radius))
        }
        Primitive::Capsule { half_length, radius } => {
            format!("sdf_capsule(h = {}, r = {}", twice(half_length), number(radius))
        }
        Primitive::Torus { major, minor } => {
            format!("sdf_torus(r1 = {}, r2 = {}", number(major), number(minor))
        }
        Primitive::Octahedron { radius } => format!("sdf_octahedron(r = {}", number(radius)),
        // Neither has a size of its own; recipes that can be built do not hold them.
        Primitive::Periodic { kind, period } => {
            format!("{}(period = {}", periodic_name(kind), number(period))
        }
        Primitive::Blob { radius, weight } => {
            let ball = format!("[[[0, 0, 0], {}, {}]]", number(radius), number(weight));
            format!("sdf_metaballs(balls = {ball}")
        }
    }
}

/// The built-in that makes a periodic shape.
pub(in crate::csg) fn periodic_name(kind: Periodic) -> &'static str {
    match kind {
        Periodic::Gyroid => "sdf_gyroid",
        Periodic::SchwarzP => "sdf_schwarz_p",
        Periodic::Diamond => "sdf_diamond",
        Periodic::Neovius => "sdf_neovius",
        Periodic::Iwp => "sdf_iwp",
    }
}

fn corners(Aabb { min, max }: Aabb) -> String {
    list([vec3(min), vec3(max)].into_iter())
}

/// A function whose variables are the operations in order. Angles of the language are degrees.
fn function(formula: &Formula) -> String {
    let operations = formula.operations();
    let bindings =
        operations.iter().enumerate().map(|(id, operation)| format!("a{id} = {}", term(operation)));
    let bindings: Vec<String> = bindings.collect();
    format!("function(p) let({}) a{}", bindings.join(", "), operations.len().saturating_sub(1))
}

fn term(operation: &Operation) -> String {
    match *operation {
        Operation::Axis(axis) => format!("p[{axis}]"),
        Operation::Constant(x) => number(x),
        Operation::Unary(op, a) => unary(op, &format!("a{a}")),
        Operation::Binary(op, a, b) => binary(op, &format!("a{a}"), &format!("a{b}")),
    }
}

fn unary(op: Unary, a: &str) -> String {
    match op {
        Unary::Neg => format!("-{a}"),
        Unary::Recip => format!("1 / {a}"),
        Unary::Cbrt => format!("sign({a}) * pow(abs({a}), 1 / 3)"),
        Unary::Square => format!("{a} * {a}"),
        Unary::Sin | Unary::Cos | Unary::Tan => format!("{}({a} * (180 / PI))", op.name()),
        Unary::Asin | Unary::Acos | Unary::Atan => format!("{}({a}) * (PI / 180)", op.name()),
        Unary::Not => format!("({a} == 0 ? 1 : 0)"),
        Unary::Abs | Unary::Sqrt | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Exp | Unary::Ln => {
            format!("{}({a})", op.name())
        }
    }
}

fn binary(op: Binary, a: &str, b: &str) -> String {
    match op {
        Binary::Add => format!("{a} + {b}"),
        Binary::Sub => format!("{a} - {b}"),
        Binary::Mul => format!("{a} * {b}"),
        Binary::Div => format!("{a} / {b}"),
        Binary::Atan2 => format!("atan2({a}, {b}) * (PI / 180)"),
        Binary::Min | Binary::Max | Binary::Pow => format!("{}({a}, {b})", op.name()),
        Binary::Compare => format!("sign({a} - {b})"),
        Binary::Mod => format!("{a} - abs({b}) * floor({a} / abs({b}))"),
        Binary::And => format!("({a} == 0 ? 0 : {b})"),
        Binary::Or => format!("({a} == 0 ? {b} : {a})"),
    }
}
