use super::field::print::{body_call as field_call, operator_call};
use super::{Body, Csg, Explicit, Flat, LinearSweep, Parametric, RotateSweep, SurfaceBody};
use crate::boolean::Op;
use crate::curve::Spline;
use crate::math::{Affine3, Vec2, Vec3, degrees};
use crate::mesh::Mesh;
use crate::sdf::{Binary, Operation, Unary};
use crate::surface::Patch;
use std::fmt::Write;

/// The recipe as a script of plain calls, one a line, children indented: no variables, no loops, all numbers in full.
///
/// Read back by the script language it makes the same shape. A symmetric difference, which OpenSCAD does not have, is
/// written `symmetric_difference()`.
pub fn print(recipe: &Csg) -> String {
    let mut text = String::new();
    // What is still to be written: recipes, and the ends of groups.
    let mut stack = vec![(0, Some(recipe))];
    while let Some((depth, recipe)) = stack.pop() {
        text.push_str(&"  ".repeat(depth.min(DEEPEST_INDENT)));
        let Some(recipe) = recipe else {
            text.push_str("}\n");
            continue;
        };
        text.push_str(&call(recipe));
        if matches!(recipe, Csg::Nothing | Csg::Flat(_) | Csg::Body(_)) {
            text.push_str(";\n");
        } else {
            text.push_str(" {\n");
            stack.push((depth, None));
            stack.extend(recipe.children().iter().rev().map(|child| (depth + 1, Some(&**child))));
        }
    }
    text
}

/// Beyond this depth lines are indented no further, so that the text does not grow with the square of the depth.
const DEEPEST_INDENT: usize = 40;

/// The call that makes a node, without its children.
fn call(recipe: &Csg) -> String {
    match recipe {
        Csg::Nothing => "group()".to_owned(),
        Csg::Flat(flat) => flat_call(flat),
        Csg::Body(body) => body_call(body),
        Csg::Transform { map, .. } => format!("multmatrix({})", matrix(map)),
        Csg::Color { color, .. } => {
            format!("color({})", list(color.iter().map(|&c| shortest(c))))
        }
        Csg::Combine { op, .. } => match op {
            Op::Union => "union()",
            Op::Intersection => "intersection()",
            Op::Difference => "difference()",
            Op::SymmetricDifference => "symmetric_difference()",
        }
        .to_owned(),
        Csg::Hull { .. } => "hull()".to_owned(),
        Csg::LinearExtrude { sweep, .. } => linear_call(sweep),
        Csg::RotateExtrude { sweep, .. } => rotate_call(sweep),
        Csg::Blend { .. } | Csg::Offset { .. } => operator_call(recipe),
    }
}

fn flat_call(flat: &Flat) -> String {
    match flat {
        Flat::Rectangle { min, max } if *min == Vec2::ZERO => format!("square({})", vec2(*max)),
        Flat::Rectangle { min, max } => {
            polygon_call(&[vec![*min, Vec2::new(max.x, min.y), *max, Vec2::new(min.x, max.y)]])
        }
        Flat::Circle { radius, fragments } => format!("circle(r = {}, $fn = {fragments})", number(*radius)),
        Flat::Polygon { contours } => polygon_call(contours),
    }
}

fn polygon_call(contours: &[Vec<Vec2>]) -> String {
    let points = list(contours.iter().flatten().map(|&p| vec2(p)));
    let mut first = 0;
    let paths = contours.iter().map(|contour| {
        first += contour.len();
        list((first - contour.len()..first).map(|i| i.to_string()))
    });
    format!("polygon(points = {points}, paths = {})", list(paths))
}

fn body_call(body: &Body) -> String {
    match body {
        Body::Cuboid { min, max } if *min == Vec3::ZERO => format!("cube({})", vec3(*max)),
        // Sizes would be rounded: the corners themselves say the same without loss.
        Body::Cuboid { min, max } => mesh_call(&cuboid_corners(*min, *max)),
        Body::Sphere { radius, fragments } => format!("sphere(r = {}, $fn = {fragments})", number(*radius)),
        Body::Frustum { heights: [low, high], radii: [bottom, top], fragments } => {
            let sizes = format!("r1 = {}, r2 = {}, $fn = {fragments}", number(*bottom), number(*top));
            let height = number(high - low);
            if *low == 0.0 {
                format!("cylinder(h = {height}, {sizes})")
            } else if *low == -*high {
                format!("cylinder(h = {height}, {sizes}, center = true)")
            } else {
                format!("translate([0, 0, {}]) cylinder(h = {height}, {sizes})", number(*low))
            }
        }
        Body::Mesh(mesh) => mesh_call(mesh),
        Body::Surface(surface) => surface_call(surface),
        Body::Field(field) => field_call(field),
    }
}

/// The mesh of a box; without triangles for one that holds nothing.
fn cuboid_corners(min: Vec3, max: Vec3) -> Mesh {
    crate::mesh::cuboid(min, max).into_mesh()
}

/// Curves are written as the control points of their cubics.
fn surface_call(body: &SurfaceBody) -> String {
    let space = |spline: &Spline<Vec3>| {
        let last = spline.is_closed().then(|| spline.points()[0]);
        list(spline.points().iter().copied().chain(last).map(vec3))
    };
    let plane = |spline: &Spline<Vec2>| {
        let last = spline.is_closed().then(|| spline.points()[0]);
        list(spline.points().iter().copied().chain(last).map(vec2))
    };
    let shape = match &body.shape {
        Explicit::Patches(patches) => {
            let rows = |patch: &Patch| {
                let rows = patch.points().chunks(patch.degrees()[1] + 1);
                list(rows.map(|row| list(row.iter().map(|&p| vec3(p)))))
            };
            format!("bezier_surface(patches = {}", list(patches.iter().map(rows)))
        }
        Explicit::Revolution { profile, start, angle } => format!(
            "revolve({}, angle = {}, start = {}, kind = \"bezier\", degree = 3",
            plane(profile),
            number(degrees(*angle)),
            number(degrees(*start))
        ),
        Explicit::Sweep(sweep) => format!(
            "sweep({}, {}, twist = {}, scale = {}, kind = \"bezier\", profile_kind = \"bezier\", degree = 3",
            space(sweep.path()),
            plane(sweep.profile()),
            number(degrees(sweep.twist())),
            number(sweep.scale())
        ),
        Explicit::Tube(tube) => format!(
            "tube({}, r = {}, kind = \"bezier\", degree = 3",
            space(tube.path()),
            number(tube.radius())
        ),
        Explicit::Parametric(parametric) => parametric_call(parametric),
    };
    let thickness = body.thickness.map_or_else(String::new, |t| format!(", thickness = {}", number(t)));
    format!("{shape}{thickness}, tolerance = {})", number(body.tolerance))
}

/// The call of `parametric`, without its end; every operation has a name.
fn parametric_call(surface: &Parametric) -> String {
    let mut bindings = Vec::new();
    let results = [0, 1, 2].map(|axis: usize| {
        let operations = &surface.coordinates()[axis];
        let name = |id: u32| format!("{}{id}", ["x", "y", "z"][axis]);
        for (id, operation) in operations.iter().enumerate() {
            bindings.push(format!("{} = {}", name(id as u32), operation_text(*operation, &name)));
        }
        name(operations.len() as u32 - 1)
    });
    let [[a, b], [c, d]] = surface.domain().map(|range| range.map(number));
    let (bindings, results) = (bindings.join(", "), results.join(", "));
    format!("parametric(function(u, v) let({bindings}) [{results}], u = [{a}, {b}], v = [{c}, {d}]")
}

/// An operation in the language, whose angles are degrees.
fn operation_text(operation: Operation, name: &dyn Fn(u32) -> String) -> String {
    let (unary, a) = match operation {
        Operation::Axis(axis) => return ["u", "v", "0"][usize::from(axis)].to_owned(),
        Operation::Constant(x) => return number(x),
        Operation::Binary(op, a, b) => return binary_text(op, &name(a), &name(b)),
        Operation::Unary(op, a) => (op, name(a)),
    };
    match unary {
        Unary::Neg => format!("-{a}"),
        Unary::Abs => format!("abs({a})"),
        Unary::Recip => format!("1 / {a}"),
        Unary::Sqrt => format!("sqrt({a})"),
        Unary::Cbrt => format!("sign({a}) * pow(abs({a}), 1 / 3)"),
        Unary::Square => format!("{a} * {a}"),
        Unary::Floor => format!("floor({a})"),
        Unary::Ceil => format!("ceil({a})"),
        Unary::Round => format!("round({a})"),
        Unary::Sin => format!("sin({a} * 180 / PI)"),
        Unary::Cos => format!("cos({a} * 180 / PI)"),
        Unary::Tan => format!("tan({a} * 180 / PI)"),
        Unary::Asin => format!("asin({a}) * PI / 180"),
        Unary::Acos => format!("acos({a}) * PI / 180"),
        Unary::Atan => format!("atan({a}) * PI / 180"),
        Unary::Exp => format!("exp({a})"),
        Unary::Ln => format!("ln({a})"),
        Unary::Not => format!("1 - abs(sign({a}))"),
    }
}

fn binary_text(op: Binary, a: &str, b: &str) -> String {
    match op {
        Binary::Add => format!("{a} + {b}"),
        Binary::Sub => format!("{a} - {b}"),
        Binary::Mul => format!("{a} * {b}"),
        Binary::Div => format!("{a} / {b}"),
        Binary::Atan2 => format!("atan2({a}, {b}) * PI / 180"),
        Binary::Min => format!("min({a}, {b})"),
        Binary::Max => format!("max({a}, {b})"),
        Binary::Compare => format!("sign({a} - {b})"),
        Binary::Mod => format!("{a} - abs({b}) * floor({a} / abs({b}))"),
        Binary::Pow => format!("pow({a}, {b})"),
        // Where a is zero the first is zero, and the second b.
        Binary::And => format!("abs(sign({a})) * {b}"),
        Binary::Or => format!("{a} + (1 - abs(sign({a}))) * {b}"),
    }
}

/// Faces run clockwise seen from outside, as the language has them.
fn mesh_call(mesh: &Mesh) -> String {
    let points = list(mesh.positions.iter().map(|&p| vec3(p)));
    let faces = list(mesh.triangles.iter().map(|&[a, b, c]| format!("[{a}, {c}, {b}]")));
    format!("polyhedron(points = {points}, faces = {faces})")
}

fn linear_call(sweep: &LinearSweep) -> String {
    let LinearSweep { vector, center, twist, slices, scale } = sweep;
    let mut text = String::from("linear_extrude(");
    let direction = if vector.truncate() == Vec2::ZERO {
        format!("height = {}", number(vector.z))
    } else {
        format!("v = {}", vec3(*vector))
    };
    write!(text, "{direction}, center = {center}, twist = {}, ", number(degrees(*twist))).expect("a string");
    write!(text, "slices = {slices}, scale = {})", vec2(*scale)).expect("a string");
    text
}

fn rotate_call(sweep: &RotateSweep) -> String {
    let (angle, start) = (degrees(sweep.angle), degrees(sweep.start));
    // The language takes the number of steps of a full turn, of which a part of it has its share, rounded down.
    let share = (angle.abs() / 360.0).min(1.0);
    let steps = f64::from(sweep.fragments);
    let fewest = if share > 0.0 { (steps / share).ceil() } else { steps };
    let around = if (fewest * share).trunc() < steps { fewest + 1.0 } else { fewest };
    format!("rotate_extrude(angle = {}, start = {}, $fn = {})", number(angle), number(start), number(around))
}

fn matrix(map: &Affine3) -> String {
    let m = map.matrix3.transpose();
    let rows = [m.x_axis, m.y_axis, m.z_axis].into_iter().zip(map.translation.to_array());
    let row = |(row, shift): (Vec3, f64)| list(row.to_array().into_iter().chain([shift]).map(number));
    list(rows.map(row).chain(["[0, 0, 0, 1]".to_owned()]))
}

fn vec2(v: Vec2) -> String {
    list(v.to_array().into_iter().map(number))
}

pub(super) fn vec3(v: Vec3) -> String {
    list(v.to_array().into_iter().map(number))
}

pub(super) fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

pub(super) fn number(value: f64) -> String {
    if value.is_finite() { shortest(value + 0.0) } else { not_finite(value) }
}

/// The fewest digits that read back to the same bits, without a fraction for whole numbers.
fn shortest(value: impl std::fmt::Debug) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// The language has no literals for these.
fn not_finite(value: f64) -> String {
    let text = if value.is_nan() {
        "(0/0)"
    } else if value > 0.0 {
        "(1/0)"
    } else {
        "(-1/0)"
    };
    text.to_owned()
}
