//! Shapes without children.

use super::{Builtin, module_row};
use crate::csg::{Body, Csg, Flat};
use crate::math::{Vec2, Vec3};
use crate::script::Failure;
use crate::script::diagnostic::Span;
use crate::script::eval::{Fragmentation, Invocation, Machine, Made};
use crate::script::value::{List, Value};
use std::sync::Arc;

pub(super) const TABLE: &[Builtin] = &[
    module_row(
        "cube",
        &["size", "center"],
        2,
        "A box from the origin, or about it; size is a number or [x, y, z].",
        cube,
    ),
    module_row(
        "sphere",
        &["r", "d", "tolerance"],
        1,
        "A sphere about the origin, by radius or diameter.",
        sphere,
    ),
    module_row(
        "cylinder",
        &["h", "r1", "r2", "center", "r", "d", "d1", "d2", "tolerance"],
        4,
        "A cylinder or cone about the z axis, by radii or diameters.",
        cylinder,
    ),
    module_row("square", &["size", "center"], 2, "A rectangle from the origin, or about it.", square),
    module_row(
        "circle",
        &["r", "d", "tolerance"],
        1,
        "A circle about the origin, by radius or diameter.",
        circle,
    ),
    module_row(
        "polygon",
        &["points", "paths", "convexity"],
        3,
        "Points joined in order; paths of indices make several contours, holes among them.",
        polygon,
    ),
    module_row("import", &["file", "filename", "convexity"], 1, "The solid in a file.", import),
];

/// Most facets of one shape.
pub(super) const MOST_FACETS: f64 = 1e7;

fn cube<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let size = match call.arguments.get("size").cloned() {
        None => [1.0; 3],
        Some(Value::Number(size)) => [size; 3],
        Some(other) => match numbers::<3>(&other) {
            Some(size) => size,
            None => {
                unusable(machine, call, "size", &other, "a number or three")?;
                [1.0; 3]
            }
        },
    };
    let size = Vec3::from_array(size);
    if !positive(machine, call, "size", &size.to_array()) {
        return Ok(machine.nothing());
    }
    let min = if call.arguments.is_true("center") { -0.5 * size } else { Vec3::ZERO };
    let max = if call.arguments.is_true("center") { 0.5 * size } else { size };
    machine.leaf(Csg::Body(Body::Cuboid { min, max }), call.span)
}

fn square<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let size = match call.arguments.get("size").cloned() {
        None => [1.0; 2],
        Some(Value::Number(size)) => [size; 2],
        Some(other) => match numbers::<2>(&other) {
            Some(size) => size,
            None => {
                unusable(machine, call, "size", &other, "a number or two")?;
                [1.0; 2]
            }
        },
    };
    let size = Vec2::from_array(size);
    if !positive(machine, call, "size", &size.to_array()) {
        return Ok(machine.nothing());
    }
    let min = if call.arguments.is_true("center") { -0.5 * size } else { Vec2::ZERO };
    let max = if call.arguments.is_true("center") { 0.5 * size } else { size };
    machine.leaf(Csg::Flat(Flat::Rectangle { min, max }), call.span)
}

fn sphere<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let radius = radius(machine, call, "r", "d").unwrap_or(1.0);
    if !positive(machine, call, "radius", &[radius]) {
        return Ok(machine.nothing());
    }
    let Some(precision) = precision(machine, call)? else { return Ok(machine.nothing()) };
    let count = precision.of_sphere(radius);
    let fragments = fragments(machine, call.span, precision, count, count * (count + 1.0))?;
    machine.leaf(Csg::Body(Body::Sphere { radius, fragments }), call.span)
}

fn circle<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let radius = radius(machine, call, "r", "d").unwrap_or(1.0);
    if !positive(machine, call, "radius", &[radius]) {
        return Ok(machine.nothing());
    }
    let Some(precision) = precision(machine, call)? else { return Ok(machine.nothing()) };
    let count = precision.of_circle(radius);
    let fragments = fragments(machine, call.span, precision, count, count)?;
    machine.leaf(Csg::Flat(Flat::Circle { radius, fragments }), call.span)
}

fn cylinder<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let arguments = &call.arguments;
    let height = arguments.number("h").unwrap_or(1.0);
    let both = radius(machine, call, "r", "d");
    let low = radius(machine, call, "r1", "d1").or(both).unwrap_or(1.0);
    let high = radius(machine, call, "r2", "d2").or(both).unwrap_or(1.0);
    if !positive(machine, call, "h", &[height]) {
        return Ok(machine.nothing());
    }
    let usable = low.is_finite() && high.is_finite() && low >= 0.0 && high >= 0.0 && low + high > 0.0;
    if !usable {
        machine.warn(call.span, format!("a cylinder with the radii {low} and {high} is nothing"));
        return Ok(machine.nothing());
    }
    let Some(precision) = precision(machine, call)? else { return Ok(machine.nothing()) };
    let count = precision.of_circle(low.max(high));
    let fragments = fragments(machine, call.span, precision, count, 4.0 * count)?;
    let heights = if arguments.is_true("center") { [-0.5 * height, 0.5 * height] } else { [0.0, height] };
    machine.leaf(Csg::Body(Body::Frustum { heights, radii: [low, high], fragments }), call.span)
}

fn polygon<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let Some(points) = call.arguments.get("points").cloned() else {
        machine.warn(call.span, "a polygon needs points");
        return Ok(machine.nothing());
    };
    let Some(points): Option<Vec<[f64; 2]>> = vectors(machine, call, "points", &points)? else {
        return Ok(machine.nothing());
    };
    let points: Vec<Vec2> = points.into_iter().map(Vec2::from_array).collect();
    let contours = match call.arguments.get("paths").cloned() {
        None => vec![points],
        Some(paths) => {
            let Some(paths) = self::paths(machine, call, "paths", &paths, points.len())? else {
                return Ok(machine.nothing());
            };
            paths.iter().map(|path| path.iter().map(|&index| points[index as usize]).collect()).collect()
        }
    };
    let contours: Vec<Vec<Vec2>> =
        contours.into_iter().filter(|contour: &Vec<Vec2>| contour.len() >= 3).collect();
    if contours.is_empty() {
        machine.warn(call.span, "a polygon needs at least three points");
        return Ok(machine.nothing());
    }
    machine.leaf(Csg::Flat(Flat::Polygon { contours: Arc::new(contours) }), call.span)
}

fn import<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let name = call.arguments.get("file").or_else(|| call.arguments.get("filename"));
    let Some(name) = name.and_then(Value::text).map(str::to_owned) else {
        return Err(machine.error(call.span, "import needs the name of a file"));
    };
    match machine.host_mesh(&name, call.span) {
        Ok(mesh) if mesh.is_empty() => {
            machine.warn(call.span, format!("{name} holds no triangle"));
            Ok(machine.nothing())
        }
        Ok(mesh) => machine.leaf(Csg::Body(Body::Mesh(mesh)), call.span),
        Err(reason) => Err(machine.error(call.span, format!("cannot import {name}: {reason}"))),
    }
}

/// A radius given as such or as a diameter, which wins.
pub(super) fn radius<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    radius: &str,
    diameter: &str,
) -> Option<f64> {
    let given = call.arguments.number(radius);
    let Some(twice) = call.arguments.number(diameter) else { return given };
    if given.is_some() {
        machine.warn(call.span, format!("{radius} is ignored since {diameter} is given too"));
    }
    Some(twice / 2.0)
}

/// Whether all sizes are positive and finite; a warning where one is not.
pub(super) fn positive<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    what: &str,
    sizes: &[f64],
) -> bool {
    let bad = sizes.iter().find(|size| !(**size > 0.0 && size.is_finite()));
    if let Some(bad) = bad {
        let bad = crate::script::format::number(*bad);
        machine.warn(call.span, format!("a {what} of {bad} gives nothing; it must be positive and finite"));
    }
    bad.is_none()
}

/// What fragments depend on: `tolerance` where it is given, else the `$` variables; a warning and `None` where the
/// tolerance is no positive number.
pub(super) fn precision<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
) -> Result<Option<Fragmentation>, Failure> {
    let Some(value) = call.arguments.get("tolerance").cloned() else {
        return Ok(Some(machine.fragmentation()));
    };
    match value.finite().filter(|tolerance| *tolerance > 0.0) {
        Some(tolerance) => Ok(Some(machine.fragmentation().within(tolerance))),
        None => {
            unusable(machine, call, "tolerance", &value, "a positive number")?;
            Ok(None)
        }
    }
}

/// `count` as a number of fragments that come of `precision`, where the facets they make are not too many.
fn fragments(
    machine: &mut Machine<'_>,
    span: Span,
    precision: Fragmentation,
    count: f64,
    facets: f64,
) -> Result<u32, Failure> {
    for (name, value) in [("$fa", precision.angle), ("$fs", precision.size)] {
        if value < Fragmentation::FINEST && precision.count <= 0.0 && precision.error <= 0.0 {
            machine.warn(span, format!("{name} of {value} counts as {}", Fragmentation::FINEST));
        }
    }
    checked(machine, span, count, facets)
}

/// `count` as a number of fragments, where `facets` are not too many.
pub(super) fn checked(
    machine: &mut Machine<'_>,
    span: Span,
    count: f64,
    facets: f64,
) -> Result<u32, Failure> {
    if facets > MOST_FACETS || !facets.is_finite() {
        let text =
            format!("{count} fragments make {facets} facets, more than the {MOST_FACETS} of one shape");
        return Err(machine.limit(span, text));
    }
    Ok(count as u32)
}

/// Warns that an argument is not what is needed.
pub(super) fn unusable<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    parameter: &str,
    value: &Value,
    wanted: &str,
) -> Result<(), Failure> {
    let shown = machine.shown_value(value, call.span)?;
    machine.warn(call.span, format!("{parameter} must be {wanted}, not {shown}"));
    Ok(())
}

/// The value as exactly `N` numbers.
pub(super) fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    value.list()?.numbers()?.try_into().ok()
}

/// A list of points of `N` finite coordinates; a warning and `None` where one is something else.
pub(super) fn vectors<'p, const N: usize>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    parameter: &str,
    value: &Value,
) -> Result<Option<Vec<[f64; N]>>, Failure> {
    let Value::List(list) = value else {
        unusable(machine, call, parameter, value, "a list of points")?;
        return Ok(None);
    };
    let mut points = Vec::with_capacity(list.len());
    for (index, point) in list.iter().enumerate() {
        match numbers::<N>(&point).filter(|point| point.iter().all(|x| x.is_finite())) {
            Some(point) => points.push(point),
            None => {
                let what = format!("{parameter}[{index}]");
                unusable(machine, call, &what, &point, &format!("{N} finite numbers"))?;
                return Ok(None);
            }
        }
    }
    Ok(Some(points))
}

/// Lists of indices below `count`; one list of indices may stand alone. A warning and `None` where one is wrong.
pub(super) fn paths<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    parameter: &str,
    value: &Value,
    count: usize,
) -> Result<Option<Vec<Vec<u32>>>, Failure> {
    let Value::List(list) = value else {
        unusable(machine, call, parameter, value, "a list of lists of indices")?;
        return Ok(None);
    };
    let alone = list.get(0).is_some_and(|first| first.number().is_some());
    let lists: Vec<Value> = if alone { vec![Value::List(list.clone())] } else { list.iter().collect() };
    let mut paths = Vec::with_capacity(lists.len());
    for (index, path) in lists.iter().enumerate() {
        match path.list().and_then(|path| indices(path, count)) {
            Some(path) => paths.push(path),
            None => {
                let what = format!("{parameter}[{index}]");
                unusable(machine, call, &what, path, &format!("a list of indices below {count}"))?;
                return Ok(None);
            }
        }
    }
    Ok(Some(paths))
}

fn indices(path: &List, count: usize) -> Option<Vec<u32>> {
    let index = |&index: &f64| (index >= 0.0 && index.trunc() < count as f64).then_some(index as u32);
    path.numbers()?.iter().map(index).collect()
}
