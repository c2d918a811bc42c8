//! Faces that are flush with each other.
//!
//! A blend of two values cannot tell an edge to be filled from two faces in one plane: both values are zero in either
//! place, and it swells both (by 0.29 of the radius of a circular blend). No ball that rolls outside of two shapes
//! leaves a half-space that holds them both. So where both touch such a plane, the blend is cut off there.

use crate::math::{Aabb, Affine3, Vec3};
use crate::sdf::{BadNumber, Implicit};

/// A box and where it stands.
pub(super) type Place = (Aabb, Affine3);

/// Planes that differ by less than this part of the size of the shapes are one.
const NEAR: f64 = 1e-9;

/// Most directions of planes that are looked at: shapes stand upright or are turned together, as a rule.
const MOST_DIRECTIONS: usize = 48;

/// The shape without what is beyond planes that both `left` and `right` touch from within.
pub(super) fn cut(shape: Implicit, left: &[Place], right: &[Place]) -> Result<Implicit, BadNumber> {
    let size = left.iter().chain(right).map(extent).fold(0.0, f64::max);
    let mut whole = shape;
    for normal in directions(left.iter().chain(right)) {
        let [a, b] = [left, right].map(|side| support(side, normal));
        if (a - b).abs() <= NEAR * size {
            let bounds = whole.bounds();
            let half_space = Implicit::half_space(normal, a.max(b))?;
            let known = whole.intersection(&half_space);
            whole = Implicit::formula(known.expr().clone(), known.lipschitz(), bounds);
        }
    }
    Ok(whole)
}

/// How far places reach in a direction.
fn support(places: &[Place], normal: Vec3) -> f64 {
    let reach = |(bounds, map): &Place| {
        let along = map.matrix3.transpose() * normal;
        let pick =
            |axis: usize| along[axis] * if along[axis] > 0.0 { bounds.max[axis] } else { bounds.min[axis] };
        pick(0) + pick(1) + pick(2) + normal.dot(map.translation)
    };
    places.iter().map(reach).fold(f64::NEG_INFINITY, f64::max)
}

/// The outward normals of the faces of all boxes, each once.
fn directions<'a>(places: impl Iterator<Item = &'a Place>) -> Vec<Vec3> {
    let mut found: Vec<Vec3> = Vec::new();
    for (_, map) in places {
        let normals = map.matrix3.inverse().transpose();
        for column in [normals.x_axis, normals.y_axis, normals.z_axis] {
            let unit = column.normalize_or_zero();
            for normal in [unit, -unit] {
                let is_new = found.iter().all(|other| (*other - normal).length() > NEAR);
                if unit != Vec3::ZERO && is_new && found.len() < MOST_DIRECTIONS {
                    found.push(normal);
                }
            }
        }
    }
    found
}

fn extent((bounds, map): &Place) -> f64 {
    let corner = bounds.min.abs().max(bounds.max.abs());
    map.transform_vector3(corner).length() + map.translation.length()
}
