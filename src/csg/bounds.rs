use super::arena::{Arena, Node};
use super::field;
use super::frame::{mapped_box, overlap, plane_part, widened};
use super::{Body, Csg, Dimension, Flat, LinearSweep, RotateSweep};
use crate::boolean::Op;
use crate::math::{Aabb, Vec2, Vec3};

/// A box around the shape of a recipe, found without making any mesh; empty where there is certainly nothing.
///
/// It is tight for primitives, and may be larger than the shape for intersections, differences and turns. The box of a
/// plane region has no height. Numbers that are not finite give a meaningless box.
pub fn bounds(recipe: &Csg) -> Aabb {
    let arena = Arena::new(recipe);
    let Aabb { min, max } = arena.root().bounds;
    match arena.root().dimension {
        Some(Dimension::Two) if !arena.root().bounds.is_empty() => {
            Aabb { min: min.with_z(0.0), max: max.with_z(0.0) }
        }
        _ => Aabb { min, max },
    }
}

/// The box of a node from those of its children; see [`Node::bounds`].
pub(super) fn local_bounds(recipe: &Csg, dimension: Option<Dimension>, children: &[&Node<'_>]) -> Aabb {
    // Children of another dimension take no part; those of none are empty.
    let takes_part = |child: &&&Node<'_>| child.dimension.is_none() || child.dimension == dimension;
    let mut boxes = children.iter().filter(takes_part).map(|child| child.bounds);
    match recipe {
        Csg::Nothing => Aabb::EMPTY,
        Csg::Flat(flat) => flat_bounds(flat),
        Csg::Body(body) => body_bounds(body),
        Csg::Transform { map, .. } => {
            let map = if dimension == Some(Dimension::Two) { plane_part(map) } else { *map };
            boxes.next().map_or(Aabb::EMPTY, |child| mapped_box(&map, child))
        }
        Csg::Color { .. } => boxes.next().unwrap_or(Aabb::EMPTY),
        Csg::Combine { op: Op::Union | Op::SymmetricDifference, .. } | Csg::Hull { .. } => {
            boxes.fold(Aabb::EMPTY, Aabb::union)
        }
        Csg::Combine { op: Op::Difference, .. } => boxes.next().unwrap_or(Aabb::EMPTY),
        Csg::Combine { op: Op::Intersection, .. } => {
            let common = boxes.reduce(Aabb::intersection).unwrap_or(Aabb::EMPTY);
            if overlap(common, common) { common } else { Aabb::EMPTY }
        }
        Csg::LinearExtrude { sweep, .. } => linear_bounds(sweep, flat_child(children)),
        Csg::RotateExtrude { sweep, .. } => rotate_bounds(sweep, flat_child(children)),
        Csg::Blend { .. } | Csg::Offset { .. } => {
            let solid = |child: &&&Node<'_>| child.dimension != Some(Dimension::Two);
            let taking_part: Vec<&Node<'_>> = children.iter().filter(solid).copied().collect();
            proper(padded(field::reach::bounds(recipe, &taking_part).0, recipe_tolerance(recipe)))
        }
    }
}

fn flat_child(children: &[&Node<'_>]) -> Aabb {
    let flat = children.first().filter(|child| child.dimension == Some(Dimension::Two));
    flat.map_or(Aabb::EMPTY, |child| child.bounds)
}

fn flat_bounds(flat: &Flat) -> Aabb {
    let (min, max) = match flat {
        Flat::Rectangle { min, max } => (*min, *max),
        Flat::Circle { radius, .. } => (Vec2::splat(-radius), Vec2::splat(*radius)),
        Flat::Polygon { contours } => {
            let points = || contours.iter().flatten().copied();
            (points().fold(Vec2::INFINITY, Vec2::min), points().fold(Vec2::NEG_INFINITY, Vec2::max))
        }
    };
    proper(Aabb { min: min.extend(0.0), max: max.extend(1.0) })
}

fn body_bounds(body: &Body) -> Aabb {
    match body {
        Body::Cuboid { min, max } => proper(Aabb { min: *min, max: *max }),
        Body::Sphere { radius, .. } => proper(Aabb { min: Vec3::splat(-radius), max: Vec3::splat(*radius) }),
        Body::Frustum { heights: [low, high], radii: [bottom, top], .. } => {
            let radius = bottom.max(*top);
            proper(Aabb { min: Vec3::new(-radius, -radius, *low), max: Vec3::new(radius, radius, *high) })
        }
        Body::Mesh(mesh) => mesh.bounds(),
        Body::Surface(surface) => surface.bounds(),
        Body::Field(field) => proper(padded(field.bounds(), field.tolerance)),
    }
}

/// The box of a mesh that may be this far from its surface.
fn padded(bounds: Aabb, tolerance: f64) -> Aabb {
    if bounds.is_empty() {
        return bounds;
    }
    Aabb { min: bounds.min - Vec3::splat(tolerance), max: bounds.max + Vec3::splat(tolerance) }
}

fn recipe_tolerance(recipe: &Csg) -> f64 {
    match recipe {
        Csg::Blend { tolerance, .. } | Csg::Offset { tolerance, .. } => *tolerance,
        _ => 0.0,
    }
}

/// The box, or the empty one where it has no volume.
fn proper(bounds: Aabb) -> Aabb {
    if overlap(bounds, bounds) { bounds } else { Aabb::EMPTY }
}

fn linear_bounds(sweep: &LinearSweep, child: Aabb) -> Aabb {
    if child.is_empty() || sweep.vector.z == 0.0 {
        return Aabb::EMPTY;
    }
    let base = Aabb { min: child.min.with_z(0.0), max: child.max.with_z(0.0) };
    let top = mapped_box(&crate::math::Affine3::from_scale(sweep.scale.extend(1.0)), base);
    let sections = base.union(top);
    let sections = if sweep.twist == 0.0 {
        sections
    } else {
        let reach = sections.min.abs().max(sections.max.abs()).length();
        let disc = Vec3::new(reach, reach, 0.0);
        Aabb { min: -disc, max: disc }
    };
    let start = if sweep.center { -0.5 * sweep.vector } else { Vec3::ZERO };
    let shifted = |by: Vec3| Aabb { min: sections.min + by, max: sections.max + by };
    widened(shifted(start).union(shifted(start + sweep.vector)), 0.0)
}

fn rotate_bounds(sweep: &RotateSweep, child: Aabb) -> Aabb {
    if child.is_empty() || sweep.angle == 0.0 {
        return Aabb::EMPTY;
    }
    let reach = child.min.x.abs().max(child.max.x.abs());
    let turned =
        Aabb { min: Vec3::new(-reach, -reach, child.min.y), max: Vec3::new(reach, reach, child.max.y) };
    widened(turned, 0.0)
}
