//! From a recipe to booleans over leaves, with frames, and without what cannot matter.
//!
//! Maps that keep axes are pushed down to the leaves. What is turned some other way is solved in a frame of its own and
//! mapped on leaving it; operands of one boolean whose maps have the same linear part, bit for bit, share a frame, so
//! that parts flush with each other stay so however the assembly is turned.

use super::arena::{Arena, NodeId};
use super::build::{BuildError, Color, Note, Report};
use super::frame::{EVERYWHERE, is_finite, keeps_axes, mapped_box, overlap, plane_part, widened};
use super::{Csg, Dimension};
use crate::boolean::Op;
use crate::math::{Aabb, Affine3, Vec3};
use std::collections::HashMap;

/// A shape to be solved, and a box around it.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) bounds: Aabb,
    pub(super) kind: Kind,
}

#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// Something built by itself and moved by a map that keeps axes.
    Leaf(Spot),
    /// A boolean of at least two parts. The spot of the recipe it came from, where it is all of that.
    Node { op: Op, parts: Vec<Plan>, origin: Option<Spot> },
    /// Something solved in coordinates of its own and then mapped.
    Frame { map: Affine3, inner: Box<Plan> },
}

/// A recipe under a map that keeps axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) node: NodeId,
    pub(super) map: Affine3,
    /// From the outermost recipe that gives one.
    pub(super) color: Option<Color>,
}

/// A plan with the map that leaves its frame, if it has one of its own.
struct Placed {
    outer: Option<Affine3>,
    plan: Plan,
}

/// Unions nested in more frames than this are opened up: solving them one inside the other would take time that grows
/// with the square of the depth.
const MOST_NESTED_FRAMES: u32 = 4;

/// Deepest nesting of booleans that cannot be opened up.
const MOST_NESTED_BOOLEANS: u32 = 200;

/// The plan of a node, or `None` where there is nothing.
pub(super) fn plan(
    arena: &Arena<'_>,
    uses: &Uses,
    spot: Spot,
    report: &mut Report,
) -> Result<Option<Plan>, BuildError> {
    let mut planner = Planner { arena, uses, report };
    let Some(placed) = planner.place(spot, Nesting::default())? else { return Ok(None) };
    let plan = match placed.outer {
        None => placed.plan,
        Some(map) => framed(map, placed.plan),
    };
    Ok(prune(plan, EVERYWHERE, planner.report))
}

/// How often each content occurs in a recipe.
pub(super) struct Uses(HashMap<u128, u64>);

impl Uses {
    pub(super) fn of(arena: &Arena<'_>) -> Uses {
        let nodes = arena.nodes();
        let mut visits = vec![0_u64; nodes.len()];
        visits[arena.root_id() as usize] = 1;
        let mut uses = HashMap::new();
        for (id, node) in nodes.iter().enumerate().rev() {
            for &child in &node.children {
                visits[child as usize] = visits[child as usize].saturating_add(visits[id]);
            }
            let count: &mut u64 = uses.entry(node.key).or_default();
            *count = count.saturating_add(visits[id]);
        }
        Uses(uses)
    }

    pub(super) fn is_repeated(&self, key: u128) -> bool {
        self.0.get(&key).is_some_and(|&count| count > 1)
    }
}

#[derive(Clone, Copy, Default)]
struct Nesting {
    booleans: u32,
    frames: u32,
}

struct Planner<'a, 'b> {
    arena: &'a Arena<'b>,
    uses: &'a Uses,
    report: &'a mut Report,
}

impl Planner<'_, '_> {
    fn place(&mut self, spot: Spot, nesting: Nesting) -> Result<Option<Placed>, BuildError> {
        let Some((outer, spot)) = self.descend(spot)? else { return Ok(None) };
        let node = self.arena.get(spot.node);
        let placed = match node.recipe {
            Csg::Combine { op, .. } => {
                let frames = nesting.frames + u32::from(outer.is_some());
                let nesting = Nesting { booleans: nesting.booleans + 1, frames };
                if nesting.booleans > MOST_NESTED_BOOLEANS {
                    return Err(BuildError::TooDeep { most: MOST_NESTED_BOOLEANS });
                }
                self.combine(*op, spot, nesting)?
            }
            _ => {
                let bounds = mapped_box(&spot.map, node.bounds);
                let spot = Spot { color: spot.color.or_else(|| self.first_color(spot.node)), ..spot };
                (!bounds.is_empty())
                    .then_some(Placed { outer: None, plan: Plan { bounds, kind: Kind::Leaf(spot) } })
            }
        };
        Ok(placed.map(|inner| Placed { outer: composed(outer, inner.outer), plan: inner.plan }))
    }

    /// Follows maps and colours down to a leaf or a boolean. The maps down to the last one that does not keep axes are
    /// handed back apart.
    fn descend(&mut self, mut spot: Spot) -> Result<Option<(Option<Affine3>, Spot)>, BuildError> {
        let mut outer = None;
        loop {
            let node = self.arena.get(spot.node);
            match node.recipe {
                _ if node.bounds.is_empty() => {
                    self.report.skip(node.leaves);
                    return Ok(None);
                }
                Csg::Transform { map, .. } => {
                    let map = if node.dimension == Some(Dimension::Two) { plane_part(map) } else { *map };
                    if map.matrix3.determinant() == 0.0 {
                        self.report.note(Note::SingularMap);
                        return Ok(None);
                    }
                    spot = Spot { node: node.children[0], map: spot.map * map, ..spot };
                    if !is_finite(&spot.map) {
                        return Err(BuildError::NonFinite { what: "transform" });
                    }
                    if !keeps_axes(&map) {
                        outer = composed(outer, Some(spot.map));
                        spot.map = Affine3::IDENTITY;
                    }
                }
                Csg::Color { color, .. } => {
                    spot = Spot { node: node.children[0], color: spot.color.or(Some(*color)), ..spot };
                }
                _ => return Ok(Some((outer, spot))),
            }
        }
    }

    /// What flows together has one colour: that of the first child of a smooth operator.
    fn first_color(&self, mut node: NodeId) -> Option<Color> {
        if !matches!(self.arena.get(node).recipe, Csg::Blend { .. } | Csg::Offset { .. }) {
            return None;
        }
        loop {
            let of = self.arena.get(node);
            match of.recipe {
                Csg::Color { color, .. } => return Some(*color),
                _ => node = *of.children.first()?,
            }
        }
    }

    fn combine(&mut self, op: Op, spot: Spot, nesting: Nesting) -> Result<Option<Placed>, BuildError> {
        let members = match op {
            Op::Difference => self.difference_members(spot, nesting)?,
            Op::Union | Op::Intersection | Op::SymmetricDifference => self.members(op, spot, nesting)?,
        };
        let members = match op {
            Op::Union | Op::SymmetricDifference => members.into_iter().flatten().collect(),
            Op::Intersection => members.into_iter().collect::<Option<Vec<Placed>>>().unwrap_or_default(),
            Op::Difference if members.first().is_some_and(Option::is_some) => {
                members.into_iter().flatten().collect()
            }
            Op::Difference => Vec::new(),
        };
        let mut placed = gather(op, members);
        if let Some(Placed { outer: None, plan: Plan { kind: Kind::Node { origin, .. }, .. } }) = &mut placed
        {
            *origin = Some(spot);
        }
        Ok(placed)
    }

    /// Operands of an associative operation, those of the same operation below it among them. `None` for empty ones.
    fn members(&mut self, op: Op, spot: Spot, nesting: Nesting) -> Result<Vec<Option<Placed>>, BuildError> {
        let mut members = Vec::new();
        let mut stack = vec![(None, spot)];
        while let Some((outer, spot)) = stack.pop() {
            let Some((own, inner)) = self.descend(spot)? else {
                members.push(None);
                continue;
            };
            let node = self.arena.get(inner.node);
            let is_same = matches!(node.recipe, Csg::Combine { op: other, .. } if *other == op);
            let is_top = inner.node == spot.node && stack.is_empty() && members.is_empty();
            let stays_whole = (self.uses.is_repeated(node.key) || own.is_some())
                && nesting.frames < MOST_NESTED_FRAMES
                && nesting.booleans < MOST_NESTED_BOOLEANS / 2;
            if is_same && (is_top || !stays_whole) {
                let outer = composed(outer, own);
                let children = self.taking_part(inner);
                if children.is_empty() {
                    members.push(None);
                }
                stack.extend(children.into_iter().rev().map(|child| (outer, child)));
            } else {
                let placed = self.place(spot, nesting)?;
                members.push(placed.map(|p| Placed { outer: composed(outer, p.outer), plan: p.plan }));
            }
        }
        Ok(members)
    }

    /// Operands of a difference; where the first one is itself a difference, its operands come instead of it.
    fn difference_members(
        &mut self,
        spot: Spot,
        nesting: Nesting,
    ) -> Result<Vec<Option<Placed>>, BuildError> {
        let mut taken_away: Vec<(Option<Affine3>, Spot)> = Vec::new();
        let (mut outer, mut first) = (None, spot);
        loop {
            let Some((own, inner)) = self.descend(first)? else { return Ok(vec![None]) };
            outer = composed(outer, own);
            if !matches!(self.arena.get(inner.node).recipe, Csg::Combine { op: Op::Difference, .. }) {
                first = inner;
                break;
            }
            let children = self.taking_part(inner);
            let Some((&next, rest)) = children.split_first() else { return Ok(vec![None]) };
            taken_away.extend(rest.iter().rev().map(|&child| (outer, child)));
            first = next;
        }
        taken_away.push((outer, first));
        let mut members = Vec::with_capacity(taken_away.len());
        for (outer, spot) in taken_away.into_iter().rev() {
            let placed = self.place(spot, nesting)?;
            members.push(placed.map(|p| Placed { outer: composed(outer, p.outer), plan: p.plan }));
        }
        Ok(members)
    }

    /// The children of a node, under its map, but for those of another dimension.
    fn taking_part(&mut self, spot: Spot) -> Vec<Spot> {
        let node = self.arena.get(spot.node);
        let mut children = Vec::with_capacity(node.children.len());
        for &child in &node.children {
            let dimension = self.arena.get(child).dimension;
            if dimension.is_none() || dimension == node.dimension {
                children.push(Spot { node: child, ..spot });
            } else {
                self.report.note(Note::MixedDimensions);
            }
        }
        children
    }
}

fn composed(outer: Option<Affine3>, inner: Option<Affine3>) -> Option<Affine3> {
    match (outer, inner) {
        (Some(outer), Some(inner)) => Some(outer * inner),
        (outer, inner) => outer.or(inner),
    }
}

/// Joins operands, those that share a linear part within their frame.
fn gather(op: Op, members: Vec<Placed>) -> Option<Placed> {
    let mut classes: Vec<(Option<Affine3>, Vec<Plan>)> = Vec::new();
    let mut class_of: HashMap<Option<[u64; 9]>, usize> = HashMap::new();
    for Placed { outer, plan } in members {
        let bits = outer.map(|map| map.matrix3.to_cols_array().map(|c| (c + 0.0).to_bits()));
        let class = *class_of.entry(bits).or_insert(classes.len());
        if class == classes.len() {
            classes.push((outer, vec![plan]));
            continue;
        }
        let offset = match (outer, classes[class].0) {
            (Some(own), Some(first)) => first.matrix3.inverse() * (own.translation - first.translation),
            _ => Vec3::ZERO,
        };
        classes[class].1.push(shifted(plan, offset));
    }
    if classes.len() <= 1 {
        let (outer, plans) = classes.pop()?;
        return Some(Placed { outer, plan: node(op, plans) });
    }
    let mut parts = Vec::new();
    for (index, (outer, plans)) in classes.into_iter().enumerate() {
        // What is taken away is joined within its frame first.
        let within = if op == Op::Difference && index > 0 { Op::Union } else { op };
        match outer {
            Some(map) => parts.push(framed(map, node(within, plans))),
            None if op == Op::Difference && index == 0 => parts.push(node(op, plans)),
            None => parts.extend(plans),
        }
    }
    Some(Placed { outer: None, plan: node(op, parts) })
}

fn node(op: Op, mut parts: Vec<Plan>) -> Plan {
    if parts.len() == 1 {
        return parts.swap_remove(0);
    }
    let boxes = parts.iter().map(|part| part.bounds);
    let bounds = match op {
        Op::Union | Op::SymmetricDifference => boxes.fold(Aabb::EMPTY, Aabb::union),
        Op::Intersection => boxes.fold(EVERYWHERE, Aabb::intersection),
        Op::Difference => parts[0].bounds,
    };
    Plan { bounds, kind: Kind::Node { op, parts, origin: None } }
}

fn framed(map: Affine3, inner: Plan) -> Plan {
    Plan { bounds: mapped_box(&map, inner.bounds), kind: Kind::Frame { map, inner: Box::new(inner) } }
}

fn shifted(plan: Plan, offset: Vec3) -> Plan {
    if offset == Vec3::ZERO {
        return plan;
    }
    let moved = |map: Affine3| Affine3::from_translation(offset) * map;
    let by_spot = |spot: Spot| Spot { map: moved(spot.map), ..spot };
    // A box over leaves is a union of their boxes or part of it, and rounding is monotone: it moves as they do.
    let bounds = mapped_box(&Affine3::from_translation(offset), plan.bounds);
    let kind = match plan.kind {
        Kind::Leaf(spot) => Kind::Leaf(by_spot(spot)),
        Kind::Frame { map, inner } => Kind::Frame { map: moved(map), inner },
        Kind::Node { op, parts, origin } => {
            let parts = parts.into_iter().map(|part| shifted(part, offset)).collect();
            Kind::Node { op, parts, origin: origin.map(by_spot) }
        }
    };
    Plan { bounds: widened(bounds, offset.abs().max_element()), kind }
}

/// The plan without what cannot matter inside `window`, or `None` where nothing can.
fn prune(plan: Plan, window: Aabb, report: &mut Report) -> Option<Plan> {
    let bounds = plan.bounds;
    // Where all is seen, what has no volume is built even so: it may be wrong, and that is to be said.
    if window != EVERYWHERE && !overlap(bounds, window) {
        report.skip(leaves(&plan));
        return None;
    }
    match plan.kind {
        Kind::Leaf(_) => Some(plan),
        Kind::Frame { map, inner } => {
            let seen = if window == EVERYWHERE { window } else { mapped_box(&map.inverse(), window) };
            // A window that does not map to a box hides nothing.
            let seen = if seen.min.is_nan() || seen.max.is_nan() { EVERYWHERE } else { seen };
            prune(*inner, seen, report).map(|inner| framed(map, inner))
        }
        Kind::Node { op: Op::Difference, mut parts, origin } => {
            let (count, before) = (leaves_of(&parts), report.skipped);
            let mut rest = parts.split_off(1);
            let Some(first) = parts.pop().and_then(|first| prune(first, window, report)) else {
                report.skipped = before + count;
                return None;
            };
            let seen = window.intersection(first.bounds);
            rest = rest.into_iter().filter_map(|part| prune(part, seen, report)).collect();
            let parts = std::iter::once(first).chain(rest).collect();
            Some(with_origin(node(Op::Difference, parts), origin, window, count))
        }
        Kind::Node { op: Op::Intersection, parts, origin } => {
            let (count, before) = (leaves_of(&parts), report.skipped);
            let seen = parts.iter().fold(window, |seen, part| seen.intersection(part.bounds));
            let kept = parts.into_iter().map(|part| prune(part, seen, report)).collect::<Option<Vec<Plan>>>();
            let Some(kept) = kept else {
                report.skipped = before + count;
                return None;
            };
            Some(with_origin(node(Op::Intersection, kept), origin, window, count))
        }
        Kind::Node { op, parts, origin } => {
            let count = leaves_of(&parts);
            let kept: Vec<Plan> = parts.into_iter().filter_map(|part| prune(part, window, report)).collect();
            (!kept.is_empty()).then(|| with_origin(node(op, kept), origin, window, count))
        }
    }
}

/// Remembers where a pruned boolean came from, unless it was pruned to fit a window and is no longer all of that.
fn with_origin(mut plan: Plan, from: Option<Spot>, window: Aabb, count: u64) -> Plan {
    let is_whole = window == EVERYWHERE || leaves(&plan) == count;
    if let Kind::Node { origin, .. } = &mut plan.kind
        && origin.is_none()
        && is_whole
    {
        *origin = from;
    }
    plan
}

fn leaves(plan: &Plan) -> u64 {
    match &plan.kind {
        Kind::Leaf(_) => 1,
        Kind::Frame { inner, .. } => leaves(inner),
        Kind::Node { parts, .. } => leaves_of(parts),
    }
}

fn leaves_of(parts: &[Plan]) -> u64 {
    parts.iter().map(leaves).sum()
}

impl Plan {
    /// Leaves and booleans in it.
    pub(super) fn steps(&self) -> u64 {
        match &self.kind {
            Kind::Leaf(_) => 1,
            Kind::Frame { inner, .. } => inner.steps(),
            Kind::Node { parts, .. } => 1 + parts.iter().map(Plan::steps).sum::<u64>(),
        }
    }
}
