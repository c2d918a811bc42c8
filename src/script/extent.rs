//! How far the outline of a plane recipe reaches, without building it.

use crate::boolean::Op;
use crate::csg::{Csg, Flat};
use crate::math::{Affine3, Vec2, Vec3};
use crate::script::degrees;
use crate::script::stack::with_room;

/// The largest value of `measure` over the vertices of a plane recipe, 0 where there are none.
///
/// Exact for leaves, transforms, unions and hulls. Of a difference the first child counts and of an intersection the
/// smallest, so the value may be too large where parts are cut off.
pub(super) fn farthest(recipe: &Csg, measure: &dyn Fn(Vec2) -> f64) -> f64 {
    reach(recipe, Affine3::IDENTITY, measure)
}

/// A length that no edge of a plane recipe exceeds whose outline reaches `radius` far out: that of its longest edge where
/// it is a leaf, moved or coloured, else twice the reach.
pub(super) fn longest_edge(recipe: &Csg, radius: f64) -> f64 {
    let longest = match recipe {
        Csg::Transform { map, child } => with_room(|| {
            let stretch = |axis: Vec3| map.transform_vector3(axis).truncate().length();
            // No direction of the plane is stretched by more than the root of the sum of squares.
            longest_edge(child, f64::INFINITY) * crate::math::hypot(stretch(Vec3::X), stretch(Vec3::Y))
        }),
        Csg::Color { child, .. } => with_room(|| longest_edge(child, radius)),
        Csg::Flat(Flat::Rectangle { min, max }) => (*max - *min).max_element(),
        Csg::Flat(Flat::Circle { radius, fragments }) => {
            2.0 * radius * degrees::sin(180.0 / f64::from(*fragments))
        }
        Csg::Flat(Flat::Polygon { contours }) => {
            let edges = contours.iter().flat_map(|c| c.iter().zip(c.iter().cycle().skip(1)));
            edges.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
        }
        _ => f64::INFINITY,
    };
    longest.min(2.0 * radius)
}

fn reach(recipe: &Csg, map: Affine3, measure: &dyn Fn(Vec2) -> f64) -> f64 {
    let inner = |child: &Csg| with_room(|| reach(child, map, measure));
    let largest =
        |children: &[std::sync::Arc<Csg>]| children.iter().map(|child| inner(child)).fold(0.0, f64::max);
    match recipe {
        Csg::Flat(flat) => reach_of_leaf(flat, map, measure),
        Csg::Transform { map: own, child } => with_room(|| reach(child, map * *own, measure)),
        Csg::Color { child, .. } => inner(child),
        Csg::Hull { children } => largest(children),
        Csg::Combine { op: Op::Difference, children } => children.first().map_or(0.0, |child| inner(child)),
        Csg::Combine { op: Op::Intersection, children } => {
            children.iter().map(|child| inner(child)).reduce(f64::min).unwrap_or(0.0)
        }
        Csg::Combine { children, .. } => largest(children),
        Csg::Nothing
        | Csg::Body(_)
        | Csg::LinearExtrude { .. }
        | Csg::RotateExtrude { .. }
        | Csg::Blend { .. }
        | Csg::Offset { .. } => 0.0,
    }
}

fn reach_of_leaf(flat: &Flat, map: Affine3, measure: &dyn Fn(Vec2) -> f64) -> f64 {
    let at = |p: Vec2| measure(map.transform_point3(Vec3::new(p.x, p.y, 0.0)).truncate());
    match flat {
        Flat::Rectangle { min, max } => [*min, *max, Vec2::new(min.x, max.y), Vec2::new(max.x, min.y)]
            .map(at)
            .into_iter()
            .fold(0.0, f64::max),
        Flat::Circle { radius, fragments } => {
            let vertex = |index: u32| {
                let angle = 360.0 * f64::from(index) / f64::from(*fragments);
                at(*radius * Vec2::new(degrees::cos(angle), degrees::sin(angle)))
            };
            (0..*fragments).map(vertex).fold(0.0, f64::max)
        }
        Flat::Polygon { contours } => contours.iter().flatten().map(|&p| at(p)).fold(0.0, f64::max),
    }
}
