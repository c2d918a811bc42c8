//! Solids that are the inside of fields, and operators that work by distance.

use super::primitive::{numbers, radius, unusable};
use super::{Builtin, module_row};
use crate::boolean::Op;
use crate::csg::{self, Body, Csg, FieldBody, FieldShape, Formula, Offset};
use crate::math::{Aabb, Vec3};
use crate::script::Failure;
use crate::script::eval::{Fragmentation, Invocation, Machine, Made};
use crate::script::formula;
use crate::script::value::{List, Value};
use crate::sdf::{Blend, Periodic, Primitive};
use std::sync::Arc;

pub(super) const TABLE: &[Builtin] = &[
    module_row(
        "smooth_union",
        &["r", "kind", "tolerance"],
        1,
        "All children as one, inward edges between them filled by r; kind is round, soft or chamfer.",
        |machine, call| blended(machine, call, Op::Union),
    ),
    module_row(
        "smooth_difference",
        &["r", "kind", "tolerance"],
        1,
        "The first child without the others, edges between them rounded by r.",
        |machine, call| blended(machine, call, Op::Difference),
    ),
    module_row(
        "smooth_intersection",
        &["r", "kind", "tolerance"],
        1,
        "What all children have in common, edges between them rounded by r.",
        |machine, call| blended(machine, call, Op::Intersection),
    ),
    module_row(
        "offset3d",
        &["r", "tolerance"],
        1,
        "The children with their surface moved outward by r, inward when r is negative.",
        |machine, call| shifted(machine, call, "r", Offset::By),
    ),
    module_row(
        "shell",
        &["t", "tolerance"],
        1,
        "The wall of thickness t around the surface of the children, half of it on each side.",
        |machine, call| shifted(machine, call, "t", Offset::Shell),
    ),
    module_row(
        "round",
        &["r", "tolerance"],
        1,
        "The children with outward edges rounded to r and faces where they were.",
        |machine, call| shifted(machine, call, "r", Offset::Round),
    ),
    module_row("sdf_sphere", &["r", "d", "tolerance"], 1, "A ball about the origin.", |machine, call| {
        let Some(radius) = radius_of(machine, call, "r", "d", 1.0)? else { return Ok(machine.nothing()) };
        primitive(machine, call, Primitive::Sphere { radius })
    }),
    module_row(
        "sdf_ellipsoid",
        &["r", "tolerance"],
        1,
        "An ellipsoid about the origin with half-axes [x, y, z].",
        |machine, call| {
            let Some(radii) = sides(machine, call, "r", 1.0)? else { return Ok(machine.nothing()) };
            primitive(machine, call, Primitive::Ellipsoid { radii })
        },
    ),
    module_row(
        "sdf_box",
        &["size", "tolerance"],
        1,
        "A box about the origin; size is a number or [x, y, z].",
        |machine, call| {
            let Some(size) = sides(machine, call, "size", 1.0)? else { return Ok(machine.nothing()) };
            primitive(machine, call, Primitive::Cuboid { half: 0.5 * size })
        },
    ),
    module_row(
        "sdf_rounded_box",
        &["size", "r", "tolerance"],
        2,
        "A box about the origin with edges rounded to r.",
        |machine, call| {
            let Some(size) = sides(machine, call, "size", 1.0)? else { return Ok(machine.nothing()) };
            let Some([radius]) = lengths(machine, call, [("r", 0.0)])? else { return Ok(machine.nothing()) };
            primitive(machine, call, Primitive::RoundedCuboid { half: 0.5 * size, radius })
        },
    ),
    module_row(
        "sdf_cylinder",
        &["h", "r", "d", "rounding", "tolerance"],
        2,
        "A cylinder around the z axis, centred, its rims rounded by rounding.",
        |machine, call| {
            let Some([height, rounding]) = lengths(machine, call, [("h", 1.0), ("rounding", 0.0)])? else {
                return Ok(machine.nothing());
            };
            let Some(radius) = radius_of(machine, call, "r", "d", 1.0)? else { return Ok(machine.nothing()) };
            primitive(machine, call, Primitive::Cylinder { radius, half_height: 0.5 * height, rounding })
        },
    ),
    module_row(
        "sdf_capsule",
        &["h", "r", "d", "tolerance"],
        2,
        "All within r of a segment of length h of the z axis, centred.",
        |machine, call| {
            let Some([length]) = lengths(machine, call, [("h", 1.0)])? else { return Ok(machine.nothing()) };
            let Some(radius) = radius_of(machine, call, "r", "d", 1.0)? else { return Ok(machine.nothing()) };
            primitive(machine, call, Primitive::Capsule { half_length: 0.5 * length, radius })
        },
    ),
    module_row(
        "sdf_cone",
        &["h", "r1", "r2", "d1", "d2", "tolerance"],
        3,
        "A cone or frustum around the z axis, centred; its tip is on top by default.",
        |machine, call| {
            let Some([height]) = lengths(machine, call, [("h", 1.0)])? else { return Ok(machine.nothing()) };
            let Some(low) = radius_of(machine, call, "r1", "d1", 1.0)? else { return Ok(machine.nothing()) };
            let Some(high) = radius_of(machine, call, "r2", "d2", 0.0)? else { return Ok(machine.nothing()) };
            leaf(machine, call, FieldShape::Frustum { radii: [low, high], half_height: 0.5 * height })
        },
    ),
    module_row(
        "sdf_torus",
        &["r1", "r2", "tolerance"],
        2,
        "A ring around the z axis: its radius r1, and that of its tube r2.",
        |machine, call| {
            let Some([major, minor]) = lengths(machine, call, [("r1", 1.0), ("r2", 0.25)])? else {
                return Ok(machine.nothing());
            };
            primitive(machine, call, Primitive::Torus { major, minor })
        },
    ),
    module_row(
        "sdf_octahedron",
        &["r", "tolerance"],
        1,
        "A regular octahedron with corners on the axes at a distance of r.",
        |machine, call| {
            let Some([radius]) = lengths(machine, call, [("r", 1.0)])? else { return Ok(machine.nothing()) };
            primitive(machine, call, Primitive::Octahedron { radius })
        },
    ),
    module_row(
        "sdf_prism",
        &["n", "r", "h", "tolerance"],
        3,
        "A prism over a regular polygon of n corners at a distance of r from the z axis, centred.",
        prism,
    ),
    periodic_row(
        "sdf_gyroid",
        "The part of a gyroid in a box: a wall of a thickness, or all on one side.",
        |m, c| periodic(m, c, Periodic::Gyroid),
    ),
    periodic_row(
        "sdf_schwarz_p",
        "The part of Schwarz's P surface in a box: a wall, or all on one side.",
        |m, c| periodic(m, c, Periodic::SchwarzP),
    ),
    periodic_row(
        "sdf_diamond",
        "The part of Schwarz's D surface in a box: a wall, or all on one side.",
        |m, c| periodic(m, c, Periodic::Diamond),
    ),
    periodic_row(
        "sdf_neovius",
        "The part of Neovius' surface in a box: a wall, or all on one side.",
        |m, c| periodic(m, c, Periodic::Neovius),
    ),
    periodic_row(
        "sdf_iwp",
        "The part of Schoen's I-WP surface in a box: a wall, or all on one side.",
        |m, c| periodic(m, c, Periodic::Iwp),
    ),
    module_row(
        "sdf_metaballs",
        &["balls", "threshold", "tolerance"],
        2,
        "Soft balls [[x, y, z], radius, weight] that flow into each other where their sum exceeds threshold.",
        metaballs,
    ),
    module_row(
        "implicit",
        &["f", "bounds", "tolerance"],
        2,
        "Where a function of a point is negative, cut off at the box bounds; the function must be traceable.",
        implicit,
    ),
];

const fn periodic_row(
    name: &'static str,
    help: &'static str,
    action: for<'m, 'p> fn(&'m mut Machine<'p>, &'m Invocation<'m, 'p>) -> Result<Made, Failure>,
) -> Builtin {
    module_row(name, &["period", "size", "thickness", "bounds", "tolerance"], 3, help, action)
}

fn primitive<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    primitive: Primitive,
) -> Result<Made, Failure> {
    leaf(machine, call, FieldShape::Primitive(primitive))
}

fn prism<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let defaults = [("n", 6.0), ("r", 1.0), ("h", 1.0)];
    let Some([sides, radius, height]) = lengths(machine, call, defaults)? else {
        return Ok(machine.nothing());
    };
    // What is no number of sides at all becomes one that is refused.
    let sides = if sides.fract() == 0.0 { sides.clamp(0.0, f64::from(u32::MAX)) as u32 } else { 0 };
    leaf(machine, call, FieldShape::Prism { sides, radius, half_height: 0.5 * height })
}

fn periodic<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    kind: Periodic,
) -> Result<Made, Failure> {
    let Some([period]) = lengths(machine, call, [("period", 1.0)])? else { return Ok(machine.nothing()) };
    let thickness = match call.arguments.get("thickness") {
        None => None,
        Some(_) => match lengths(machine, call, [("thickness", 0.0)])? {
            Some([thickness]) => Some(thickness),
            None => return Ok(machine.nothing()),
        },
    };
    let bounds = if call.arguments.get("bounds").is_some() {
        bounds(machine, call)?
    } else {
        let size = sides(machine, call, "size", period)?;
        size.map(|size| Aabb { min: -0.5 * size, max: 0.5 * size })
    };
    let Some(bounds) = bounds else { return Ok(machine.nothing()) };
    leaf(machine, call, FieldShape::Periodic { kind, period, thickness, bounds })
}

fn metaballs<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let Some([threshold]) = lengths(machine, call, [("threshold", 0.5)])? else {
        return Ok(machine.nothing());
    };
    let value = call.arguments.get("balls").cloned().unwrap_or_default();
    let Some(list) = value.list() else {
        unusable(machine, call, "balls", &value, "a list of balls [[x, y, z], radius, weight]")?;
        return Ok(machine.nothing());
    };
    let mut balls = Vec::with_capacity(list.len());
    for (index, value) in list.iter().enumerate() {
        let Some(ball) = value.list().and_then(ball) else {
            let what = format!("balls[{index}]");
            unusable(machine, call, &what, &value, "[[x, y, z], radius] or [[x, y, z], radius, weight]")?;
            return Ok(machine.nothing());
        };
        balls.push(ball);
    }
    leaf(machine, call, FieldShape::Metaballs { balls, threshold })
}

fn ball(list: &List) -> Option<(Vec3, f64, f64)> {
    let center = Vec3::from_array(numbers::<3>(&list.get(0)?)?);
    let weight = list.get(2).map_or(Some(1.0), |weight| weight.number())?;
    (center.is_finite() && list.len() <= 3).then_some((center, list.get(1)?.number()?, weight))
}

/// The recipe of a field with its tolerance; a warning and nothing where its numbers make none.
pub(super) fn leaf<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    shape: FieldShape,
) -> Result<Made, Failure> {
    let Some(accuracy) = Accuracy::of(machine, call)? else { return Ok(machine.nothing()) };
    let body = FieldBody { shape, tolerance: 1.0 };
    if let Err(error) = body.check() {
        machine.warn(call.span, format!("{error}; this gives nothing"));
        return Ok(machine.nothing());
    }
    let tolerance = accuracy.within(0.5 * body.bounds().size().max_element());
    let body = FieldBody { tolerance, ..body };
    machine.leaf(Csg::Body(Body::Field(Arc::new(body))), call.span)
}

fn blended<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>, op: Op) -> Result<Made, Failure> {
    let size = size(machine, call, "r")?;
    let blend = blend(machine, call, size.unwrap_or(0.0))?;
    let accuracy = Accuracy::of(machine, call)?;
    let children = machine.children_of(call)?;
    let (Some(blend), Some(accuracy)) = (blend.filter(|blend| blend.size() > 0.0), accuracy) else {
        return machine.combined_solids(op, children, call.span, |children| Csg::Combine { op, children });
    };
    machine.combined_solids(op, children, call.span, |children| {
        let boxes = children.iter().map(|child| csg::bounds(child));
        let extent = 0.5 * boxes.fold(Aabb::EMPTY, Aabb::union).size().max_element();
        // The fillet itself is to be as round as everything else.
        let tolerance = accuracy.within(extent).min(accuracy.within(blend.size()));
        Csg::Blend { op, blend, tolerance, children }
    })
}

/// How edges are filled; a warning and the usual kind where it is none.
fn blend<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    size: f64,
) -> Result<Option<Blend>, Failure> {
    let round = Blend::Circular { radius: size };
    let Some(kind) = call.arguments.get("kind").cloned() else { return Ok(Some(round)) };
    Ok(Some(match kind.text() {
        Some("round") => round,
        Some("soft") => Blend::Quadratic { radius: size },
        Some("chamfer") => Blend::Chamfer { distance: size },
        _ => {
            unusable(machine, call, "kind", &kind, "\"round\", \"soft\" or \"chamfer\"")?;
            round
        }
    }))
}

fn shifted<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    parameter: &str,
    how: fn(f64) -> Offset,
) -> Result<Made, Failure> {
    let size = match how(0.0) {
        Offset::By(_) => {
            let given = call.arguments.get(parameter).cloned().unwrap_or_default();
            let size = given.finite();
            if size.is_none() {
                unusable(machine, call, parameter, &given, "a finite number")?;
            }
            size
        }
        Offset::Shell(_) | Offset::Round(_) => size(machine, call, parameter)?,
    };
    let accuracy = Accuracy::of(machine, call)?;
    let children = machine.children_of(call)?;
    let unchanged = |children| Csg::Combine { op: Op::Union, children };
    let joined = machine.combined_solids(Op::Union, children, call.span, unchanged)?;
    let (Some(size), Some(accuracy)) = (size.filter(|size| *size != 0.0), accuracy) else {
        return Ok(joined);
    };
    machine.wrapped(joined, call.span, |child| {
        let extent = 0.5 * csg::bounds(&child).size().max_element();
        let tolerance = accuracy.within(extent + size.max(0.0)).min(accuracy.within(size.abs()));
        Csg::Offset { how: how(size), tolerance, child }
    })
}

/// A length that is not negative; a warning and `None` where there is none.
fn size<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    parameter: &str,
) -> Result<Option<f64>, Failure> {
    let given = call.arguments.get(parameter).cloned().unwrap_or_default();
    let size = given.finite().filter(|size| *size >= 0.0);
    if size.is_none() {
        unusable(machine, call, parameter, &given, "a finite number, 0 or more")?;
    }
    Ok(size)
}

/// What decides how near a mesh is to its surface.
#[derive(Clone, Copy)]
struct Accuracy {
    given: Option<f64>,
    fragmentation: Fragmentation,
}

impl Accuracy {
    /// The tolerance as given, and what there is instead of it; a warning and `None` where it makes no sense.
    fn of<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Option<Accuracy>, Failure> {
        let given = call.arguments.get("tolerance").cloned();
        let fragmentation = machine.fragmentation();
        let Some(value) = given else { return Ok(Some(Accuracy { given: None, fragmentation })) };
        let tolerance = value.finite().filter(|tolerance| *tolerance > 0.0);
        if tolerance.is_none() {
            unusable(machine, call, "tolerance", &value, "a positive number")?;
        }
        Ok(tolerance.map(|tolerance| Accuracy { given: Some(tolerance), fragmentation }))
    }

    /// The tolerance of a round shape of this radius.
    fn within(self, radius: f64) -> f64 {
        self.given.unwrap_or_else(|| self.fragmentation.chord_error(radius))
    }
}

/// Numbers by name, with what stands for those that are not given; a warning and `None` where one is no number.
fn lengths<'p, const N: usize>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    parameters: [(&str, f64); N],
) -> Result<Option<[f64; N]>, Failure> {
    let mut values = [0.0; N];
    for (slot, (parameter, usual)) in values.iter_mut().zip(parameters) {
        let given = call.arguments.get(parameter).cloned().unwrap_or(Value::Number(usual));
        let Some(number) = given.number() else {
            unusable(machine, call, parameter, &given, "a number")?;
            return Ok(None);
        };
        *slot = number;
    }
    Ok(Some(values))
}

/// A radius as such or as a diameter; a warning and `None` where it is no number.
fn radius_of<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    name: &str,
    twice: &str,
    usual: f64,
) -> Result<Option<f64>, Failure> {
    if lengths(machine, call, [(name, 0.0), (twice, 0.0)])?.is_none() {
        return Ok(None);
    }
    Ok(Some(radius(machine, call, name, twice).unwrap_or(usual)))
}

/// Three lengths, or one for all; a warning and `None` where they are something else.
fn sides<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    parameter: &str,
    usual: f64,
) -> Result<Option<Vec3>, Failure> {
    let given = call.arguments.get(parameter).cloned().unwrap_or(Value::Number(usual));
    let sides = given.number().map(Vec3::splat).or_else(|| numbers::<3>(&given).map(Vec3::from_array));
    if sides.is_none() {
        unusable(machine, call, parameter, &given, "a number or three")?;
    }
    Ok(sides)
}

/// The box of the argument `bounds`; a warning and `None` where it is none.
pub(super) fn bounds<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
) -> Result<Option<Aabb>, Failure> {
    let given = call.arguments.get("bounds").cloned().unwrap_or_default();
    let corner = |list: &List, index: usize| numbers::<3>(&list.get(index)?).map(Vec3::from_array);
    let corners = given.list().filter(|list| list.len() == 2);
    let bounds = corners.and_then(|list| Some(Aabb { min: corner(list, 0)?, max: corner(list, 1)? }));
    let sound = |b: &Aabb| b.min.is_finite() && b.max.is_finite() && b.min.cmplt(b.max).all();
    let bounds = bounds.filter(sound);
    if bounds.is_none() {
        unusable(machine, call, "bounds", &given, "two corners [[x, y, z], [x, y, z]], the lower one first")?;
    }
    Ok(bounds)
}

fn implicit<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let value = call.arguments.get("f").cloned().unwrap_or_default();
    let Value::Function(closure) = value else {
        unusable(machine, call, "f", &value, "a function of a point, such as function(p) norm(p) - 1")?;
        return Ok(machine.nothing());
    };
    let given = match call.arguments.get("bounds") {
        None => None,
        Some(_) => match bounds(machine, call)? {
            None => return Ok(machine.nothing()),
            some => some,
        },
    };
    let traced = machine.traced(&closure, call.span)?;
    let expr = match &traced {
        Value::Number(_) | Value::Formula(_) => formula::expr(&traced),
        _ => None,
    };
    let Some(formula) = expr.and_then(Formula::new) else {
        let shown = machine.shown_value(&traced, call.span)?;
        return Err(machine.error(call.span, format!("the function must give a number, not {shown}")));
    };
    let bounds = match given {
        Some(bounds) => bounds,
        None => match FieldShape::bounds_of(&formula) {
            Ok(bounds) => bounds,
            Err(error) => {
                return Err(machine.error(call.span, format!("where this ends is not known: {error}")));
            }
        },
    };
    if bounds.is_empty() {
        machine.warn(call.span, "the function is nowhere negative; this gives nothing");
        return Ok(machine.nothing());
    }
    leaf(machine, call, FieldShape::Formula { formula, bounds })
}
