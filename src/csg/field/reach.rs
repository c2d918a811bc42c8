//! Boxes of what fields make, found before there is any field.

use super::Offset;
use crate::boolean::Op;
use crate::csg::arena::Node;
use crate::csg::{Body, Csg};
use crate::math::{Aabb, Vec3};
use crate::sdf::{Blend, greatest_stretch};

/// The box of a blend or an offset, and its swell, from those of the children that take part.
pub(in crate::csg) fn bounds(recipe: &Csg, children: &[&Node<'_>]) -> (Aabb, f64) {
    let parts = || children.iter().filter(|child| !child.bounds.is_empty());
    let steepest = parts().map(|child| child.swell).fold(1.0, f64::max);
    let grown = |child: &Node<'_>, by: f64| Aabb {
        min: child.bounds.min - Vec3::splat(child.swell * by),
        max: child.bounds.max + Vec3::splat(child.swell * by),
    };
    match recipe {
        Csg::Blend { op: Op::Union | Op::SymmetricDifference, blend, .. } => {
            // A tree of blends lowers the least value once a level, and a difference once a part.
            let count = parts().count() as u64;
            let levels = match recipe {
                Csg::Blend { op: Op::Union, .. } => count.next_power_of_two().trailing_zeros(),
                _ => count as u32,
            };
            let lowered = f64::from(levels) * most_lowered(*blend);
            (parts().map(|child| grown(child, lowered)).fold(Aabb::EMPTY, Aabb::union), steepest)
        }
        Csg::Blend { op: Op::Intersection, .. } => {
            let common = parts().map(|child| child.bounds).reduce(Aabb::intersection);
            (common.filter(|_| parts().count() == children.len()).unwrap_or(Aabb::EMPTY), ROOT_3 * steepest)
        }
        Csg::Blend { op: Op::Difference, .. } => {
            children.first().map_or((Aabb::EMPTY, 1.0), |first| (first.bounds, first.swell))
        }
        Csg::Offset { how, .. } => {
            let Some(child) = parts().next() else { return (Aabb::EMPTY, 1.0) };
            let around = |by: f64| Aabb {
                min: child.bounds.min - Vec3::splat(by),
                max: child.bounds.max + Vec3::splat(by),
            };
            match how {
                Offset::By(distance) if *distance <= 0.0 => (child.bounds, child.swell),
                Offset::By(distance) => (around(*distance), 1.0),
                Offset::Shell(thickness) => (around(0.5 * thickness), 1.0),
                Offset::Round(_) => (child.bounds, child.swell),
            }
        }
        _ => unreachable!("only smooth operators are asked for"),
    }
}

const ROOT_3: f64 = 1.7320508075688774;

/// By how much the value of a blended union may lie below both of its parts, where it is zero. At equal values a of
/// both parts: a - reach / 4 for the parabola; radius - sqrt 2 (radius - a), zero for a = (1 - 1 / sqrt 2) radius,
/// for the circle; sqrt 2 (a - distance / 2) for the chamfer.
fn most_lowered(blend: Blend) -> f64 {
    let root = std::f64::consts::SQRT_2;
    match blend {
        Blend::Quadratic { radius } => 0.25 * root * radius,
        Blend::Circular { radius } => (1.0 - 1.0 / root) * radius,
        Blend::Chamfer { distance } => 0.5 * distance,
    }
}

/// The swell of a node, from its children's; see [`Node::swell`].
pub(in crate::csg) fn swell(recipe: &Csg, children: &[&Node<'_>]) -> f64 {
    let steepest = children.iter().map(|child| child.swell).fold(1.0, f64::max);
    match recipe {
        Csg::Body(Body::Field(field)) => field.swell(),
        Csg::Transform { map, .. } => {
            let uneven =
                greatest_stretch(map.matrix3) * greatest_stretch(map.matrix3.inverse()) * (1.0 + 1e-12);
            // Turns and even scalings change nothing; what is flattened takes no part.
            let even = uneven < 1.0 + 1e-9 || !uneven.is_finite();
            if even { steepest } else { steepest * uneven }
        }
        Csg::Combine { op: Op::Intersection, .. } => ROOT_3 * steepest,
        Csg::Combine { op: Op::Difference, .. } => children.first().map_or(1.0, |first| first.swell),
        Csg::Combine { .. } | Csg::Color { .. } => steepest,
        Csg::Blend { .. } | Csg::Offset { .. } => bounds(recipe, children).1,
        _ => 1.0,
    }
}
