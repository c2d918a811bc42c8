//! Modules that make solids of plane shapes.

use super::primitive::{checked, numbers, positive, precision, unusable};
use super::{Builtin, module_row};
use crate::csg::{Csg, Dimension, LinearSweep, RotateSweep};
use crate::math::{Vec2, Vec3};
use crate::script::Failure;
use crate::script::degrees::radians;
use crate::script::eval::{Invocation, Machine, Made};
use crate::script::extent::{farthest, longest_edge};
use crate::script::value::Value;

pub(super) const TABLE: &[Builtin] = &[
    module_row(
        "linear_extrude",
        &["height", "v", "center", "convexity", "twist", "slices", "scale", "segments", "h", "tolerance"],
        7,
        "A plane shape swept up by height, twisted by degrees and scaled on its way.",
        linear_extrude,
    ),
    module_row(
        "rotate_extrude",
        &["angle", "start", "convexity", "tolerance"],
        2,
        "A plane shape swept about the z axis, its y axis up; angles in degrees.",
        rotate_extrude,
    ),
];

/// The height where none is given.
const USUAL_HEIGHT: f64 = 100.0;

fn linear_extrude<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let children = plane_children(machine, call)?;
    if call.arguments.get("segments").is_some() {
        machine
            .warn(call.span, "ogee does not divide outlines by segments yet; the outline is swept as it is");
    }
    let Some(vector) = direction(machine, call)? else { return Ok(machine.nothing()) };
    let twist = call.arguments.number("twist").filter(|twist| twist.is_finite()).unwrap_or(0.0);
    let scale = end_scale(machine, call)?;
    let Some(slices) = slices(machine, call, &children, vector.length(), twist, scale)? else {
        return Ok(machine.nothing());
    };
    let center = call.arguments.is_true("center");
    let sweep = LinearSweep { vector, center, twist: radians(twist), slices, scale };
    machine.wrapped(children, call.span, |child| Csg::LinearExtrude { sweep, child })
}

/// From the base to the top: along `v`, as long as `height` where that is given, else as `v` itself.
fn direction<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Option<Vec3>, Failure> {
    let height = call.arguments.get("height").or_else(|| call.arguments.get("h")).cloned();
    if let Some(value) = height.as_ref().filter(|value| value.number().is_none()) {
        unusable(machine, call, "height", value, "a number")?;
    }
    let height = height.and_then(|height| height.number());
    let vector = match call.arguments.get("v").cloned() {
        None => Vec3::new(0.0, 0.0, height.unwrap_or(USUAL_HEIGHT)),
        Some(value) => match numbers::<3>(&value).map(Vec3::from_array).filter(|v| v.is_finite()) {
            Some(v) if v.length() > 0.0 => height.map_or(v, |height| v * (height / v.length())),
            _ => {
                unusable(machine, call, "v", &value, "three finite numbers, not all 0")?;
                return Ok(None);
            }
        },
    };
    Ok(positive(machine, call, "height", &[vector.z]).then_some(vector))
}

/// Number of layers: as given, else as many as the twist of the outermost edge needs.
fn slices<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    children: &Made,
    height: f64,
    twist: f64,
    scale: Vec2,
) -> Result<Option<u32>, Failure> {
    let Some(precision) = precision(machine, call)? else { return Ok(None) };
    let slices = match call.arguments.number("slices") {
        Some(slices) => slices.trunc().max(1.0),
        None if twist == 0.0 => 1.0,
        None => {
            let recipes = || children.shapes.iter().map(|shape| &*shape.recipe);
            let radius = recipes().map(|recipe| farthest(recipe, &Vec2::length)).fold(0.0, f64::max);
            let edge = recipes().map(|recipe| longest_edge(recipe, radius)).fold(0.0, f64::max);
            // A distance must be kept where the outline is largest.
            let largest = if precision.tolerance().is_some() { scale.max_element().max(1.0) } else { 1.0 };
            precision.of_helix(largest * radius, largest * edge, height, twist)
        }
    };
    // The outline has at least three edges, and each layer has two triangles an edge.
    checked(machine, call.span, slices, 6.0 * slices).map(Some)
}

/// Size of the top against the base; negative ones count as 0.
fn end_scale<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Vec2, Failure> {
    let Some(value) = call.arguments.get("scale").cloned() else { return Ok(Vec2::ONE) };
    let scale = value.finite().map(Vec2::splat).or_else(|| numbers::<2>(&value).map(Vec2::from_array));
    match scale.filter(|scale| scale.is_finite()) {
        Some(scale) => Ok(scale.max(Vec2::ZERO)),
        None => {
            unusable(machine, call, "scale", &value, "a finite number or two")?;
            Ok(Vec2::ONE)
        }
    }
}

fn rotate_extrude<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let children = plane_children(machine, call)?;
    let given = call.arguments.number("angle").filter(|angle| angle.is_finite());
    let full = given.is_none_or(|angle| angle.abs() >= 360.0);
    // As in OpenSCAD, a turn of which nothing is said starts at -x, and one of a given angle at x.
    let usual_start = if given.is_none() { 180.0 } else { 0.0 };
    let start = call.arguments.number("start").filter(|start| start.is_finite()).unwrap_or(usual_start);
    let angle = given.filter(|_| !full).unwrap_or(360.0);
    if angle == 0.0 {
        machine.warn(call.span, "a turn by 0 degrees gives nothing");
        return Ok(machine.nothing());
    }
    let Some(fragments) = turn_fragments(machine, call, &children, angle, full)? else {
        return Ok(machine.nothing());
    };
    // A turn backwards is one forwards from its end.
    let (start, angle) = if angle < 0.0 { (start + angle, -angle) } else { (start, angle) };
    let sweep = RotateSweep { angle: radians(angle), start: radians(start), fragments };
    machine.wrapped(children, call.span, |child| Csg::RotateExtrude { sweep, child })
}

fn turn_fragments<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    children: &Made,
    angle: f64,
    full: bool,
) -> Result<Option<u32>, Failure> {
    let Some(precision) = precision(machine, call)? else { return Ok(None) };
    let outlines = children.shapes.iter().map(|shape| farthest(&shape.recipe, &|p| p.x.abs()));
    let radius = outlines.fold(0.0, f64::max);
    let fragments = if full { precision.of_circle(radius) } else { precision.of_arc(radius, angle) };
    checked(machine, call.span, fragments, 6.0 * fragments).map(Some)
}

/// The children as one plane shape; solids among them are left out with a warning.
fn plane_children<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let mut children = machine.children_of(call)?;
    let count = children.shapes.len();
    for shapes in [&mut children.shapes, &mut children.shown] {
        shapes.retain(|shape| shape.dimension != Some(Dimension::Three));
    }
    if children.shapes.len() < count {
        machine.warn(call.span, "only plane shapes can be extruded; solids are left out");
    }
    if let Some(value) =
        call.arguments.get("convexity").filter(|value| !matches!(value, Value::Number(_))).cloned()
    {
        unusable(machine, call, "convexity", &value, "a number")?;
    }
    machine.joined(children, call.span)
}
