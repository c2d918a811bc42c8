//! How what is inside of a smooth operator becomes one field.
//!
//! Primitives and blends become formulas, sharp booleans minima and maxima; whatever has no formula becomes the distance
//! from its mesh. Moving a surface by a distance needs the distance itself: where a formula is only a bound of it on the
//! side that matters, it is meshed first, and the distance from that mesh taken.

use super::Offset;
use super::flush::{self, Place};
use crate::boolean::Op;
use crate::csg::arena::{Arena, NodeId};
use crate::csg::build::{BuildError, Note, Report};
use crate::csg::{Body, Csg, Dimension, LinearSweep};
use crate::math::{Aabb, Affine3, Mat3, Vec2, Vec3};
use crate::sdf::{BadNumber, Blend, Expr, Implicit, Primitive};

/// A field to be made.
pub(in crate::csg) struct FieldPlan {
    pub(in crate::csg) way: Way,
    pub(in crate::csg) parts: Vec<FieldPlan>,
    /// The recipe it stands for; several steps may stand for one.
    pub(in crate::csg) node: NodeId,
    /// A box around it, in its own coordinates.
    pub(in crate::csg) bounds: Aabb,
    /// The field itself, or, where meshes are still to be made, something with the same promises.
    promise: Implicit,
    /// The boxes of the shapes in it, and where they stand.
    places: Vec<Place>,
    /// Whether no mesh is needed.
    pub(in crate::csg) is_formula: bool,
}

/// How a field comes from its parts.
pub(in crate::csg) enum Way {
    /// By the formula of a primitive.
    Formula(Implicit),
    /// By the distance from the outline of an extrusion that goes straight up.
    Extruded,
    /// By the distance from the mesh of the recipe.
    Solved,
    /// By the distance from a mesh of the one part's surface.
    Remeshed,
    /// The one part under a map.
    Moved(Affine3),
    /// Minima and maxima.
    Sharp(Op),
    /// Blends.
    Smooth(Op, Blend),
    /// The one part with its values shifted or folded.
    Shifted(Offset),
}

/// Deepest nesting of operators in one field.
const MOST_NESTED: u32 = 200;

/// Most shapes in one field, each counted as often as it takes part.
const MOST_SHAPES: u64 = 1 << 16;

/// The plan of a node's field, or `None` where there is nothing.
pub(in crate::csg) fn plan(
    arena: &Arena<'_>,
    node: NodeId,
    report: &mut Report,
) -> Result<Option<FieldPlan>, BuildError> {
    let shapes = arena.get(node).leaves;
    if shapes > MOST_SHAPES {
        return Err(BuildError::TooManyShapes { shapes, most: MOST_SHAPES });
    }
    Planner { arena, report }.place(node, 0)
}

/// The field that a way makes of its parts, and of plans for them; meshes are made by whoever can.
pub(super) fn composed(way: &Way, parts: &[Implicit], plans: &[FieldPlan]) -> Result<Implicit, BadNumber> {
    match way {
        Way::Formula(field) => Ok(field.clone()),
        Way::Extruded | Way::Solved | Way::Remeshed => Ok(parts[0].clone()),
        Way::Moved(map) => parts[0].transform(map),
        Way::Sharp(op) => joined(*op, None, parts, plans),
        Way::Smooth(op, blend) => joined(*op, Some(*blend), parts, plans),
        Way::Shifted(Offset::By(distance)) => parts[0].offset(*distance),
        Way::Shifted(Offset::Shell(thickness)) => parts[0].shell(*thickness),
        Way::Shifted(Offset::Round(radius)) => parts[0].round(*radius),
    }
}

/// A boolean of fields: unions and intersections as balanced trees, differences one after the other.
fn joined(
    op: Op,
    blend: Option<Blend>,
    parts: &[Implicit],
    plans: &[FieldPlan],
) -> Result<Implicit, BadNumber> {
    let two = |a: &Implicit, b: &Implicit| match (op, blend) {
        (Op::Union, None) => Ok(a.union(b)),
        (Op::Intersection, None) => Ok(a.intersection(b)),
        (Op::Difference, None) => Ok(a.difference(b)),
        (Op::SymmetricDifference, None) => Ok(a.union(b).difference(&a.intersection(b))),
        (Op::Union, Some(blend)) => a.blend_union(b, blend),
        (Op::Intersection, Some(blend)) => a.blend_intersection(b, blend),
        (Op::Difference, Some(blend)) => a.blend_difference(b, blend),
        (Op::SymmetricDifference, Some(blend)) => {
            a.blend_difference(b, blend)?.blend_union(&b.blend_difference(a, blend)?, blend)
        }
    };
    match (op, parts) {
        (_, []) => Ok(Implicit::nothing()),
        (_, [one]) => Ok(one.clone()),
        (Op::Union | Op::Intersection, more) => {
            let middle = more.len() / 2;
            let (left, right) = more.split_at(middle);
            let (below, above) = plans.split_at(middle);
            let both = two(&joined(op, blend, left, below)?, &joined(op, blend, right, above)?)?;
            if op == Op::Union && blend.is_some() {
                return flush::cut(both, &places(below), &places(above));
            }
            Ok(both)
        }
        (_, [first, rest @ ..]) => rest.iter().try_fold(first.clone(), |all, part| two(&all, part)),
    }
}

fn places(plans: &[FieldPlan]) -> Vec<Place> {
    plans.iter().flat_map(|plan| plan.places.iter().copied()).collect()
}

struct Planner<'a, 'b> {
    arena: &'a Arena<'b>,
    report: &'a mut Report,
}

impl Planner<'_, '_> {
    fn place(&mut self, id: NodeId, depth: u32) -> Result<Option<FieldPlan>, BuildError> {
        let (inner, map) = self.descend(id);
        let node = self.arena.get(inner);
        if node.bounds.is_empty() || map.matrix3.determinant() == 0.0 {
            return Ok(None);
        }
        if depth > MOST_NESTED {
            return Err(BuildError::TooDeep { most: MOST_NESTED });
        }
        let placed = match node.recipe {
            Csg::Combine { op, .. } => self.combine(inner, *op, None, depth)?,
            Csg::Blend { op, blend, .. } => self.combine(inner, *op, Some(*blend), depth)?,
            Csg::Offset { how, .. } => {
                let child = self.place(node.children[0], depth + 1)?;
                child.map(|child| self.offset(inner, *how, child)).transpose()?
            }
            Csg::LinearExtrude { sweep, .. } if goes_straight_up(sweep) => {
                Some(self.step(Way::Extruded, Vec::new(), inner)?)
            }
            _ => Some(self.leaf(inner)?),
        };
        match placed {
            Some(placed) if map != Affine3::IDENTITY => {
                self.step(Way::Moved(map), vec![placed], id).map(Some)
            }
            placed => Ok(placed),
        }
    }

    /// Follows maps and colours down, and composes the maps.
    fn descend(&mut self, mut id: NodeId) -> (NodeId, Affine3) {
        let mut whole = Affine3::IDENTITY;
        loop {
            let node = self.arena.get(id);
            match node.recipe {
                Csg::Transform { map, .. } => {
                    whole *= *map;
                    if map.matrix3.determinant() == 0.0 {
                        self.report.note(Note::SingularMap);
                    }
                }
                Csg::Color { .. } => {}
                _ => return (id, whole),
            }
            id = node.children[0];
        }
    }

    fn combine(
        &mut self,
        id: NodeId,
        op: Op,
        blend: Option<Blend>,
        depth: u32,
    ) -> Result<Option<FieldPlan>, BuildError> {
        let mut parts = Vec::new();
        for (index, &child) in self.arena.get(id).children.iter().enumerate() {
            if self.arena.get(child).dimension == Some(Dimension::Two) {
                self.report.note(Note::MixedDimensions);
                continue;
            }
            match self.place(child, depth + 1)? {
                Some(part) => parts.push(part),
                None if op == Op::Intersection || op == Op::Difference && index == 0 => return Ok(None),
                None => {}
            }
        }
        match parts.len() {
            0 => Ok(None),
            1 => Ok(parts.pop()),
            _ => {
                let way = blend.map_or(Way::Sharp(op), |blend| Way::Smooth(op, blend));
                self.step(way, parts, id).map(Some)
            }
        }
    }

    fn leaf(&mut self, id: NodeId) -> Result<FieldPlan, BuildError> {
        match self.arena.get(id).recipe {
            Csg::Body(body) => match formula(body)? {
                Some(field) => self.step(Way::Formula(field), Vec::new(), id),
                None => self.step(Way::Solved, Vec::new(), id),
            },
            _ => self.step(Way::Solved, Vec::new(), id),
        }
    }

    fn offset(&mut self, id: NodeId, how: Offset, child: FieldPlan) -> Result<FieldPlan, BuildError> {
        let [inside, outside] = [child.promise.is_exact_inside(), child.promise.is_exact_outside()];
        let exact = match how {
            Offset::By(distance) if distance < 0.0 => inside,
            Offset::By(_) => outside,
            Offset::Shell(_) => inside && outside,
            Offset::Round(radius) => {
                if child.rounds_by_formula() {
                    return self.step(Way::Shifted(how), vec![child], id);
                }
                // Inward, and outward again: what a ball of this radius reaches from within.
                let inward = self.offset(id, Offset::By(-radius), child)?;
                return self.offset(id, Offset::By(radius), inward);
            }
        };
        let child = if exact {
            child
        } else {
            let node = child.node;
            self.step(Way::Remeshed, vec![child], node)?
        };
        self.step(Way::Shifted(how), vec![child], id)
    }

    fn step(&mut self, way: Way, parts: Vec<FieldPlan>, node: NodeId) -> Result<FieldPlan, BuildError> {
        let own = self.arena.get(node).bounds;
        let promises: Vec<Implicit> = match way {
            // The distance from a solid: exact on both sides.
            Way::Extruded | Way::Solved | Way::Remeshed => {
                let bounds = parts.first().map_or(own, |part| part.bounds);
                vec![Implicit::formula(Expr::constant(1.0), Some(1.0), bounds).with_exactness(true, true)]
            }
            _ => parts.iter().map(|part| part.promise.clone()).collect(),
        };
        let promise = composed(&way, &promises, &parts)?;
        let bounds = match way {
            Way::Remeshed => parts[0].bounds,
            _ => own,
        };
        let meshed = matches!(way, Way::Extruded | Way::Solved | Way::Remeshed);
        let is_formula = !meshed && parts.iter().all(|part| part.is_formula);
        let places = match self.arena.get(node).recipe {
            // Without the margin for its own mesh.
            Csg::Body(Body::Field(field)) => vec![(field.bounds(), Affine3::IDENTITY)],
            _ => places_of(&way, &parts, bounds),
        };
        Ok(FieldPlan { way, parts, node, bounds, promise, places, is_formula })
    }
}

impl FieldPlan {
    /// The field, where no mesh is needed.
    pub(in crate::csg) fn promise(&self) -> &Implicit {
        &self.promise
    }

    /// Whether rounding the edges of its primitives rounds the edges of the whole: primitives and what they have in
    /// common. Where something is taken away or added, edges come about that no primitive has.
    fn rounds_by_formula(&self) -> bool {
        match &self.way {
            Way::Formula(field) => field.expr().operations().is_some(),
            Way::Moved(map) => is_rigid(map) && self.parts[0].rounds_by_formula(),
            Way::Sharp(Op::Intersection) => self.parts.iter().all(FieldPlan::rounds_by_formula),
            _ => false,
        }
    }
}

/// The boxes of the shapes in a plan.
fn places_of(way: &Way, parts: &[FieldPlan], bounds: Aabb) -> Vec<Place> {
    match way {
        Way::Formula(_) | Way::Extruded | Way::Solved => vec![(bounds, Affine3::IDENTITY)],
        Way::Moved(map) => parts[0].places.iter().map(|(bounds, own)| (*bounds, *map * *own)).collect(),
        Way::Remeshed | Way::Shifted(Offset::Round(_)) => parts[0].places.clone(),
        Way::Shifted(_) => vec![(bounds, Affine3::IDENTITY)],
        // What is left of the first, or within it.
        Way::Sharp(Op::Difference | Op::Intersection) | Way::Smooth(Op::Difference | Op::Intersection, _) => {
            parts[0].places.clone()
        }
        Way::Sharp(_) | Way::Smooth(..) => places(parts),
    }
}

/// Whether an extrusion is its outline times an interval.
fn goes_straight_up(sweep: &LinearSweep) -> bool {
    let LinearSweep { vector, twist, scale, .. } = sweep;
    vector.x == 0.0 && vector.y == 0.0 && vector.z != 0.0 && *twist == 0.0 && *scale == Vec2::ONE
}

fn is_rigid(map: &Affine3) -> bool {
    let product = map.matrix3.transpose() * map.matrix3;
    product.abs_diff_eq(Mat3::IDENTITY, 1e-12)
}

/// The field of a body that has a formula: round bodies are as round as their radii say, whatever their fragments.
fn formula(body: &Body) -> Result<Option<Implicit>, BadNumber> {
    let between = |min: Vec3, max: Vec3| (0.5 * (max - min), min + 0.5 * (max - min));
    let (field, center) = match body {
        Body::Cuboid { min, max } => {
            let (half, center) = between(*min, *max);
            (Implicit::primitive(Primitive::Cuboid { half })?, center)
        }
        Body::Sphere { radius, .. } => {
            (Implicit::primitive(Primitive::Sphere { radius: *radius })?, Vec3::ZERO)
        }
        Body::Frustum { heights: [low, high], radii, .. } => {
            let half_height = 0.5 * (high - low);
            let field = if radii[0] == radii[1] {
                let radius = radii[0];
                Implicit::primitive(Primitive::Cylinder { radius, half_height, rounding: 0.0 })?
            } else {
                Implicit::frustum(*radii, half_height)?
            };
            (field, Vec3::new(0.0, 0.0, low + half_height))
        }
        Body::Field(body) => return body.confined().map(Some),
        Body::Mesh(_) | Body::Surface(_) => return Ok(None),
    };
    if center == Vec3::ZERO { Ok(Some(field)) } else { field.translate(center).map(Some) }
}
