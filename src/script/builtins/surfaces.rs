//! Solids that explicit surfaces bound.

use super::curves::spline_of;
use super::primitive::{numbers, positive, precision, unusable};
use super::{Builtin, module_row};
use crate::csg::{Body, Csg, Explicit, Parametric, SurfaceBody};
use crate::curve::Spline;
use crate::math::{Aabb, Blend, Vec2, Vec3};
use crate::script::Failure;
use crate::script::budget::Fault;
use crate::script::degrees::radians;
use crate::script::eval::{Invocation, Machine, Made};
use crate::script::formula;
use crate::script::value::{List, Value};
use crate::sdf::Expr;
use crate::surface::{Patch, SurfaceError, Sweep, Tube, loft};
use std::f64::consts::PI;
use std::sync::Arc;

pub(super) const TABLE: &[Builtin] = &[
    module_row(
        "bezier_patch",
        &["points", "thickness", "tolerance"],
        3,
        "The plate around a Bezier patch, by rows of control points; without a thickness it is capped.",
        bezier_patch,
    ),
    module_row(
        "bezier_surface",
        &["patches", "thickness", "tolerance", "file", "close"],
        3,
        "Bezier patches joined where borders are equal, from lists or a .bpt file; open borders are capped.",
        bezier_surface,
    ),
    module_row(
        "parametric",
        &["f", "u", "v", "thickness", "tolerance"],
        3,
        "The points that function(u, v) gives over ranges of u and v, joined where they meet; open borders are capped.",
        parametric,
    ),
    module_row(
        "revolve",
        &["points", "angle", "start", "kind", "closed", "degree", "thickness", "tolerance"],
        2,
        "A curve through points [r, z] turned about the z axis; its ends are capped. Angles in degrees.",
        revolve,
    ),
    module_row(
        "sweep",
        &[
            "path",
            "profile",
            "twist",
            "scale",
            "closed",
            "kind",
            "profile_kind",
            "degree",
            "thickness",
            "tolerance",
        ],
        2,
        "A closed profile along a curve, turned by twist and scaled on its way; ends are capped.",
        sweep,
    ),
    module_row(
        "loft",
        &["sections", "closed", "kind", "degree", "thickness", "tolerance"],
        1,
        "A smooth skin over closed sections, lists of as many points each; ends are capped.",
        lofted,
    ),
    module_row(
        "tube",
        &["path", "r", "d", "closed", "kind", "degree", "thickness", "tolerance"],
        2,
        "A round tube along a curve through points; ends are capped.",
        tube,
    ),
];

fn bezier_patch<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let points = call.arguments.get("points").cloned().unwrap_or_default();
    match patch(&points) {
        Ok(patch) => made(machine, call, Explicit::Patches(vec![patch])),
        Err(reason) => refused(machine, call, &reason),
    }
}

fn bezier_surface<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    if call.arguments.get("close").is_some_and(|close| !close.is_true())
        && call.arguments.get("thickness").is_none()
    {
        return refused(machine, call, "a surface that is not closed needs a thickness to be a solid");
    }
    if let Some(name) = call.arguments.get("file").and_then(Value::text).map(str::to_owned) {
        return match machine.host_patches(&name, call.span) {
            Ok(patches) => made(machine, call, Explicit::Patches(patches)),
            Err(reason) => Err(machine.error(call.span, format!("cannot read {name}: {reason}"))),
        };
    }
    let Some(list) = call.arguments.get("patches").and_then(Value::list).cloned() else {
        return refused(machine, call, "bezier_surface needs a list of patches, or a file");
    };
    let mut patches = Vec::with_capacity(list.len());
    for (index, value) in list.iter().enumerate() {
        match patch(&value) {
            Ok(patch) => patches.push(patch),
            Err(reason) => return refused(machine, call, &format!("patches[{index}]: {reason}")),
        }
    }
    made(machine, call, Explicit::Patches(patches))
}

/// Calls the function once, with symbols for u and v: what it gives is a formula, whose bounds are known.
fn parametric<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let Some(Value::Function(function)) = call.arguments.get("f").cloned() else {
        return refused(machine, call, "parametric needs a function such as function(u, v) [u, v, u * v]");
    };
    let mut domain = [[0.0, 1.0]; 2];
    for (range, name) in domain.iter_mut().zip(["u", "v"]) {
        let Some(value) = call.arguments.get(name).cloned() else { continue };
        match numbers::<2>(&value).filter(|[low, high]| low.is_finite() && high.is_finite() && low < high) {
            Some(given) => *range = given,
            None => {
                unusable(machine, call, name, &value, "a range [from, to] of finite numbers")?;
                return Ok(machine.nothing());
            }
        }
    }
    let point = machine.traced_in_plane(&function, call.span)?;
    let coordinates: Option<Vec<Expr>> =
        point.list().and_then(|list| list.iter().map(|value| formula::expr(&value)).collect());
    let Some(coordinates) = coordinates.and_then(|list| <[Expr; 3]>::try_from(list).ok()) else {
        let shown = machine.shown_value(&point, call.span)?;
        return refused(machine, call, &format!("the function must give three numbers, not {shown}"));
    };
    match Parametric::new(coordinates, domain) {
        Ok(surface) => made(machine, call, Explicit::Parametric(Box::new(surface))),
        Err(error) => refused(machine, call, &error.to_string()),
    }
}

fn revolve<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let Some(profile) = curve::<Vec2>(machine, call, "points", "kind", "line", "closed")? else {
        return Ok(machine.nothing());
    };
    let angle = call.arguments.number("angle").filter(|angle| angle.is_finite()).unwrap_or(360.0);
    let start = call.arguments.number("start").filter(|start| start.is_finite()).unwrap_or(0.0);
    if angle == 0.0 {
        return refused(machine, call, "a turn by 0 degrees gives nothing");
    }
    if profile.points().iter().any(|p| p.x < 0.0) {
        return refused(machine, call, "a profile must not reach over the axis: r must not be negative");
    }
    let angle = angle.clamp(-360.0, 360.0);
    made(machine, call, Explicit::Revolution { profile, start: radians(start), angle: radians(angle) })
}

fn sweep<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let Some(path) = curve::<Vec3>(machine, call, "path", "kind", "natural", "closed")? else {
        return Ok(machine.nothing());
    };
    let Some(profile) = curve::<Vec2>(machine, call, "profile", "profile_kind", "line", "")? else {
        return Ok(machine.nothing());
    };
    let twist = call.arguments.number("twist").filter(|twist| twist.is_finite()).unwrap_or(0.0);
    let scale = call.arguments.number("scale").unwrap_or(1.0);
    match Sweep::new(path, profile, radians(twist), scale) {
        Ok(sweep) => made(machine, call, Explicit::Sweep(Box::new(sweep))),
        Err(error) => refused(machine, call, &error.to_string()),
    }
}

fn tube<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let radius = call.arguments.number("d").map(|d| 0.5 * d).or_else(|| call.arguments.number("r"));
    let radius = radius.unwrap_or(1.0);
    if !positive(machine, call, "radius", &[radius]) {
        return Ok(machine.nothing());
    }
    let Some(path) = curve::<Vec3>(machine, call, "path", "kind", "natural", "closed")? else {
        return Ok(machine.nothing());
    };
    match Tube::new(path, radius) {
        Ok(tube) => made(machine, call, Explicit::Tube(Box::new(tube))),
        Err(error) => refused(machine, call, &error.to_string()),
    }
}

fn lofted<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let Some(list) = call.arguments.get("sections").and_then(Value::list).cloned() else {
        return refused(machine, call, "loft needs a list of sections, each a list of points");
    };
    let (kind, degree) = kind_of(call, "kind", "natural");
    let mut sections = Vec::with_capacity(list.len());
    for (index, section) in list.iter().enumerate() {
        match spline_of::<Vec3>(&section, &kind, &degree, true, machine.budget()) {
            Ok(spline) => sections.push(spline),
            Err(fault) => return faulty(machine, call, &format!("sections[{index}]"), fault),
        }
    }
    match loft(&sections, call.arguments.is_true("closed")) {
        Ok(patches) => made(machine, call, Explicit::Patches(patches)),
        Err(error) => refused(machine, call, &error.to_string()),
    }
}

/// A warning, and nothing.
fn refused<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>, reason: &str) -> Result<Made, Failure> {
    machine.warn(call.span, reason);
    Ok(machine.nothing())
}

fn faulty<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    what: &str,
    fault: Fault,
) -> Result<Made, Failure> {
    match fault {
        Fault::Undefined(reason) => refused(machine, call, &format!("{what}: {reason}")),
        Fault::Limit(reason) => Err(machine.limit(call.span, reason)),
    }
}

/// The values of a kind and a degree, the kind by default another than a line.
fn kind_of(call: &Invocation<'_, '_>, name: &str, usual: &str) -> (Value, Value) {
    let kind = call.arguments.get(name).cloned().unwrap_or_else(|| Value::from_text(usual));
    let is_chain = kind.text() == Some("bezier");
    (kind, call.arguments.get("degree").cloned().filter(|_| is_chain).unwrap_or_default())
}

/// The curve through or near the points of an argument; a warning and `None` where there is none. A profile, for which
/// nothing says whether it is closed, is.
fn curve<'p, P: Blend>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    points: &str,
    kind: &str,
    usual: &str,
    closed: &str,
) -> Result<Option<Spline<P>>, Failure> {
    let Some(value) = call.arguments.get(points).cloned() else {
        machine.warn(call.span, format!("{points} must be a list of points"));
        return Ok(None);
    };
    let (kind, degree) = kind_of(call, kind, usual);
    let closed = closed.is_empty() || call.arguments.is_true(closed);
    match spline_of::<P>(&value, &kind, &degree, closed, machine.budget()) {
        Ok(spline) => Ok(Some(spline)),
        Err(fault) => faulty(machine, call, points, fault).map(|_| None),
    }
}

/// A patch from rows of points.
fn patch(value: &Value) -> Result<Patch, String> {
    let rows: &List = value.list().ok_or("a patch is a list of rows of points")?;
    let mut points = Vec::new();
    let mut width = None;
    for row in rows.iter() {
        let row = row.list().cloned().ok_or("a patch is a list of rows of points")?;
        if *width.get_or_insert(row.len()) != row.len() {
            return Err("the rows of a patch differ in length".to_owned());
        }
        for point in row.iter() {
            let point = numbers::<3>(&point).map(Vec3::from_array);
            points.push(point.ok_or("a control point is three numbers")?);
        }
    }
    let (Some(height), Some(width)) = (rows.len().checked_sub(1), width.and_then(|w| w.checked_sub(1)))
    else {
        return Err("a patch has at least one point".to_owned());
    };
    Patch::new([height, width], points).map_err(|error: SurfaceError| error.to_string())
}

/// The recipe of a surface, with its thickness and tolerance.
fn made<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>, shape: Explicit) -> Result<Made, Failure> {
    let thickness = match call.arguments.get("thickness").cloned() {
        None => None,
        Some(value) => match value.finite().filter(|thickness| *thickness > 0.0) {
            Some(thickness) => Some(thickness),
            None => {
                unusable(machine, call, "thickness", &value, "a positive number")?;
                return Ok(machine.nothing());
            }
        },
    };
    let Some(tolerance) = tolerance(machine, call, &shape)? else { return Ok(machine.nothing()) };
    let body = SurfaceBody { shape, tolerance, thickness };
    machine.leaf(Csg::Body(Body::Surface(Arc::new(body))), call.span)
}

/// The tolerance as given, else `$fe`, else the chord error of a circle as large as the surface with the fragments that
/// `$fn`, `$fa` and `$fs` give it.
fn tolerance<'p>(
    machine: &mut Machine<'p>,
    call: &Invocation<'_, 'p>,
    shape: &Explicit,
) -> Result<Option<f64>, Failure> {
    let Some(precision) = precision(machine, call)? else { return Ok(None) };
    if let Some(tolerance) = precision.tolerance() {
        return Ok(Some(tolerance));
    }
    let radius = 0.5 * extent(shape);
    let fragments = precision.of_circle(radius);
    Ok(Some((radius * (1.0 - crate::math::cos(PI / fragments))).max(f64::MIN_POSITIVE)))
}

/// The largest side of a box around the control points.
fn extent(shape: &Explicit) -> f64 {
    let space = |points: &[Vec3]| Aabb::of(points.iter().copied()).size().max_element();
    match shape {
        Explicit::Patches(patches) => {
            let all = patches.iter().map(Patch::hull_box).fold(Aabb::EMPTY, Aabb::union);
            all.size().max_element()
        }
        Explicit::Revolution { profile, .. } => {
            2.0 * profile.points().iter().map(|p| p.x.abs()).fold(0.0, f64::max)
        }
        Explicit::Sweep(sweep) => space(sweep.path().points()).max(2.0 * sweep.reach()),
        Explicit::Tube(tube) => 2.0 * tube.radius(),
        Explicit::Parametric(surface) => surface.extent(),
    }
}
