//! What the kernel will do with a recipe, in words.

use super::arena::{Arena, NodeId};
use super::build::{BuildError, Report};
use super::field::Direct;
use super::field::plan::{FieldPlan, Way};
use super::field::print::periodic_name;
use super::field::{self, FieldShape, Offset};
use super::plan::{self, Kind, Plan, Spot, Uses};
use super::{Body, Csg, Explicit};
use crate::boolean::Op;
use crate::math::Affine3;
use crate::sdf::{Blend, Primitive};

/// How a recipe will be built, one line a step or a group of equal ones, what a step is made of below it and indented:
/// which booleans are those of meshes, what becomes a field, what is meshed before its distance is taken, and how
/// finely. Nothing is made.
///
/// ```
/// use ogee::boolean::Op;
/// use ogee::csg::{Body, Csg, explain};
/// use ogee::math::Vec3;
/// use ogee::sdf::Blend;
/// use std::sync::Arc;
///
/// let cube = |size: f64| Arc::new(Csg::Body(Body::Cuboid { min: Vec3::ZERO, max: Vec3::splat(size) }));
/// let blend = Blend::Circular { radius: 0.5 };
/// let soft = Csg::Blend { op: Op::Union, blend, tolerance: 0.01, children: vec![cube(1.0), cube(2.0)] };
/// let cut = Csg::Combine { op: Op::Difference, children: vec![Arc::new(soft), cube(0.5)] };
/// assert_eq!(
///     explain(&cut)?,
///     "difference of 2 parts: exact boolean of their meshes\n\
///     \x20 smooth_union of 2 parts, r = 0.5: one field, meshed within 0.01\n\
///     \x20   2 times cube: exact distance, by formula\n\
///     \x20 cube: mesh\n"
/// );
/// # Ok::<(), ogee::csg::BuildError>(())
/// ```
///
/// # Errors
/// Those of [`build`](super::build()) that are known before anything is made.
pub fn explain(recipe: &Csg) -> Result<String, BuildError> {
    let arena = Arena::new(recipe);
    super::build::check_all(&arena)?;
    let uses = Uses::of(&arena);
    let spot = Spot { node: arena.root_id(), map: Affine3::IDENTITY, color: None };
    let mut report = Report::default();
    let Some(plan) = plan::plan(&arena, &uses, spot, &mut report)? else {
        return Ok("nothing\n".to_owned());
    };
    let mut text = String::new();
    write(&[Teller { arena: &arena, report: &mut report }.solids(&plan)?], 0, &mut text);
    Ok(text)
}

/// A line and those below it.
#[derive(PartialEq)]
struct Line {
    text: String,
    below: Vec<Line>,
}

/// Appends lines; equal ones in a row are one with their number.
fn write(lines: &[Line], depth: usize, text: &mut String) {
    for group in lines.chunk_by(|a, b| a == b) {
        let times = if group.len() == 1 { String::new() } else { format!("{} times ", group.len()) };
        text.push_str(&format!("{}{times}{}\n", "  ".repeat(depth), group[0].text));
        write(&group[0].below, depth + 1, text);
    }
}

struct Teller<'a, 'b> {
    arena: &'a Arena<'b>,
    report: &'a mut Report,
}

impl Teller<'_, '_> {
    /// What is done by meshes.
    fn solids(&mut self, plan: &Plan) -> Result<Line, BuildError> {
        match &plan.kind {
            Kind::Leaf(spot) => self.leaf(spot.node),
            // The turn itself is nothing that could be done otherwise.
            Kind::Frame { inner, .. } => self.solids(inner),
            Kind::Node { op, parts, .. } => {
                let below: Result<Vec<Line>, BuildError> =
                    parts.iter().map(|part| self.solids(part)).collect();
                let what = match self.arena.root().dimension {
                    Some(super::Dimension::Two) => "regions",
                    _ => "meshes",
                };
                let text = format!("{} of {} parts: exact boolean of their {what}", name(*op), parts.len());
                Ok(Line { text, below: below? })
            }
        }
    }

    fn leaf(&mut self, node: NodeId) -> Result<Line, BuildError> {
        let recipe = self.arena.get(node).recipe;
        let of = self.name_of(node);
        let text = match recipe {
            Csg::Body(Body::Mesh(_)) => format!("{of}: as it is"),
            Csg::Body(Body::Surface(surface)) => format!("{of}: mesh within {}", surface.tolerance),
            Csg::Body(Body::Field(field)) => match field.direct() {
                None => format!("{of}: field, meshed within {}", field.tolerance),
                Some(Direct::Rings { .. } | Direct::Rounded(_) | Direct::Turned(_)) => {
                    format!("{of}: mesh within {}", field.tolerance)
                }
                Some(_) => format!("{of}: mesh"),
            },
            Csg::Blend { tolerance, .. } | Csg::Offset { tolerance, .. } => {
                let Some(plan) = field::plan::plan(self.arena, node, self.report)? else {
                    return Ok(Line { text: format!("{of}: nothing"), below: Vec::new() });
                };
                let text = format!("{of}: one field, meshed within {tolerance}");
                return Ok(Line { text, below: self.parts(&plan) });
            }
            Csg::Flat(_) => format!("{of}: region"),
            _ => format!("{of}: mesh"),
        };
        Ok(Line { text, below: Vec::new() })
    }

    /// The lines below that of the recipe a plan stands for.
    fn parts(&self, plan: &FieldPlan) -> Vec<Line> {
        plan.parts.iter().map(|part| self.field(part)).collect()
    }

    /// What is done by fields.
    fn field(&self, plan: &FieldPlan) -> Line {
        let of = self.name_of(plan.node);
        let text = match &plan.way {
            Way::Moved(_) => return self.field(&plan.parts[0]),
            Way::Formula(field) => {
                let recipe = self.arena.get(plan.node).recipe;
                let round = matches!(recipe, Csg::Body(Body::Sphere { .. } | Body::Frustum { .. }));
                let sort = if field.is_exact_inside() { "exact distance" } else { "bound of the distance" };
                format!("{of}: {sort}, by formula{}", if round { ", truly round" } else { "" })
            }
            Way::Extruded => format!("{of}: exact distance from its outline"),
            Way::Solved => format!("{of}: distance from its mesh"),
            Way::Remeshed => "its formula is only a bound of the distance, so meshed first".to_owned(),
            Way::Sharp(Op::Union) => format!("{of}: minimum of fields"),
            Way::Sharp(Op::Intersection) => format!("{of}: maximum of fields"),
            Way::Sharp(_) => format!("{of}: maximum of fields, those taken away negated"),
            Way::Smooth(..) => format!("{of}: blended in the same field"),
            Way::Shifted(how) => format!("{}: by its values", offset_name(*how)),
        };
        Line { text, below: self.parts(plan) }
    }

    fn name_of(&self, node: NodeId) -> String {
        match self.arena.get(node).recipe {
            Csg::Blend { op, blend, children, .. } => {
                let (size, kind) = match blend {
                    Blend::Circular { radius } => (radius, ""),
                    Blend::Quadratic { radius } => (radius, ", soft"),
                    Blend::Chamfer { distance } => (distance, ", chamfer"),
                };
                format!("smooth_{} of {} parts, r = {size}{kind}", name(*op), children.len())
            }
            Csg::Offset { how, .. } => offset_name(*how),
            Csg::Combine { op, children } => format!("{} of {} parts", name(*op), children.len()),
            recipe => body_name(recipe),
        }
    }
}

fn name(op: Op) -> &'static str {
    match op {
        Op::Union => "union",
        Op::Intersection => "intersection",
        Op::Difference => "difference",
        Op::SymmetricDifference => "symmetric_difference",
    }
}

fn offset_name(how: Offset) -> String {
    match how {
        Offset::By(distance) => format!("offset3d, r = {distance}"),
        Offset::Shell(thickness) => format!("shell, t = {thickness}"),
        Offset::Round(radius) => format!("round, r = {radius}"),
    }
}

fn body_name(recipe: &Csg) -> String {
    match recipe {
        Csg::Body(Body::Cuboid { .. }) => "cube",
        Csg::Body(Body::Sphere { .. }) => "sphere",
        Csg::Body(Body::Frustum { .. }) => "cylinder",
        Csg::Body(Body::Mesh(mesh)) => return format!("polyhedron of {} triangles", mesh.triangles.len()),
        Csg::Body(Body::Surface(surface)) => match surface.shape {
            Explicit::Patches(_) => "bezier_surface",
            Explicit::Revolution { .. } => "revolve",
            Explicit::Sweep(_) => "sweep",
            Explicit::Tube(_) => "tube",
            Explicit::Parametric(_) => "parametric",
        },
        Csg::Body(Body::Field(field)) => field_name(&field.shape),
        Csg::Hull { .. } => "hull",
        Csg::LinearExtrude { .. } => "linear_extrude",
        Csg::RotateExtrude { .. } => "rotate_extrude",
        Csg::Flat(_) => "plane shape",
        _ => "group",
    }
    .to_owned()
}

fn field_name(shape: &FieldShape) -> &'static str {
    match shape {
        FieldShape::Primitive(primitive) => match primitive {
            Primitive::Sphere { .. } => "sdf_sphere",
            Primitive::Ellipsoid { .. } => "sdf_ellipsoid",
            Primitive::Cuboid { .. } => "sdf_box",
            Primitive::RoundedCuboid { .. } => "sdf_rounded_box",
            Primitive::Cylinder { .. } => "sdf_cylinder",
            Primitive::Capsule { .. } => "sdf_capsule",
            Primitive::Torus { .. } => "sdf_torus",
            Primitive::Octahedron { .. } => "sdf_octahedron",
            Primitive::Periodic { kind, .. } => periodic_name(*kind),
            Primitive::Blob { .. } => "sdf_metaballs",
        },
        FieldShape::Frustum { .. } => "sdf_cone",
        FieldShape::Prism { .. } => "sdf_prism",
        FieldShape::Periodic { kind, .. } => periodic_name(*kind),
        FieldShape::Metaballs { .. } => "sdf_metaballs",
        FieldShape::Formula { .. } => "implicit",
    }
}
