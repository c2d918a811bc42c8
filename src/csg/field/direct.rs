//! Fields that need no meshing: what has plane faces, or rings of them, is made as it is.

use super::{FieldBody, FieldShape};
use crate::csg::build::BuildError;
use crate::hull::convex_hull;
use crate::math::{Vec3, acos};
use crate::mesh::{self, Solid};
use crate::sdf::Primitive;
use std::f64::consts::PI;

/// Most sides of a ring.
const MOST_SIDES: f64 = 1e7;

/// A shape of known faces around the origin.
pub(in crate::csg) enum Direct {
    Cuboid { half: Vec3 },
    Octahedron { radius: f64 },
    Rings { radii: [f64; 2], half_height: f64, sides: u32 },
}

impl FieldBody {
    /// What a field is that needs no meshing when it stands alone; round ones have as many sides as the tolerance
    /// asks for.
    pub(in crate::csg) fn direct(&self) -> Option<Direct> {
        let rings = |radii: [f64; 2], half_height| {
            Some(Direct::Rings { radii, half_height, sides: self.sides(radii[0].max(radii[1]))? })
        };
        match self.shape {
            FieldShape::Primitive(Primitive::Cuboid { half }) => Some(Direct::Cuboid { half }),
            FieldShape::Primitive(Primitive::Octahedron { radius }) => Some(Direct::Octahedron { radius }),
            FieldShape::Primitive(Primitive::Cylinder { radius, half_height, rounding: 0.0 }) => {
                rings([radius; 2], half_height)
            }
            FieldShape::Frustum { radii, half_height } => rings(radii, half_height),
            FieldShape::Prism { sides, radius, half_height } => {
                Some(Direct::Rings { radii: [radius; 2], half_height, sides })
            }
            _ => None,
        }
    }

    fn sides(&self, radius: f64) -> Option<u32> {
        // A chord is at most r (1 - cos(pi / n)) away from its arc; a triangle is the least there is.
        let cosine = (1.0 - self.tolerance / radius).max(0.5);
        let sides = (PI / acos(cosine)).ceil();
        (sides <= MOST_SIDES).then_some((sides as u32).max(3))
    }
}

impl Direct {
    /// Number of triangles.
    pub(super) fn triangles(&self) -> u64 {
        match self {
            Direct::Cuboid { .. } => 12,
            Direct::Octahedron { .. } => 8,
            Direct::Rings { radii, sides, .. } => mesh::frustum_triangles(*radii, *sides),
        }
    }

    pub(super) fn solid(&self) -> Result<Solid, BuildError> {
        Ok(match *self {
            Direct::Cuboid { half } => mesh::cuboid(-half, half),
            Direct::Octahedron { radius } => {
                let corners = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| [radius * axis, -radius * axis]);
                convex_hull(corners.as_flattened())?
            }
            Direct::Rings { radii, half_height, sides } => {
                mesh::frustum([-half_height, half_height], radii, sides)?
            }
        })
    }
}
