//! Fields that need no search: what has plane faces, or rings of them, is made as it is; round bodies by their form.

use super::make::COARSEST;
use super::round::{Rounded, Turned};
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
    Cuboid {
        half: Vec3,
    },
    Octahedron {
        radius: f64,
    },
    /// Rings of so many sides, which stand for circles or are meant so.
    Rings {
        radii: [f64; 2],
        half_height: f64,
        sides: u32,
        round: bool,
    },
    Rounded(Rounded),
    Turned(Turned),
}

/// Finer tolerances than this part of the size are for nobody to keep.
const FINEST: f64 = 1.0 / (1_u64 << 28) as f64;

impl FieldBody {
    /// What a field is that needs no meshing when it stands alone; round ones have as many sides as the tolerance
    /// asks for.
    pub(in crate::csg) fn direct(&self) -> Option<Direct> {
        let rings = |radii: [f64; 2], half_height| {
            let sides = self.sides(radii[0].max(radii[1]))?;
            Some(Direct::Rings { radii, half_height, sides, round: true })
        };
        match self.shape {
            FieldShape::Primitive(Primitive::Cuboid { half }) => Some(Direct::Cuboid { half }),
            FieldShape::Primitive(Primitive::Octahedron { radius }) => Some(Direct::Octahedron { radius }),
            FieldShape::Primitive(Primitive::Cylinder { radius, half_height, rounding: 0.0 }) => {
                rings([radius; 2], half_height)
            }
            FieldShape::Primitive(primitive) => self.round(primitive),
            FieldShape::Frustum { radii, half_height } => rings(radii, half_height),
            FieldShape::Prism { sides, radius, half_height } => {
                Some(Direct::Rings { radii: [radius; 2], half_height, sides, round: false })
            }
            _ => None,
        }
    }

    /// A round body, where the tolerance is neither too fine nor makes too many triangles.
    fn round(&self, primitive: Primitive) -> Option<Direct> {
        let size = 2.0 * primitive.half_size().max_element();
        let tolerance = self.tolerance.min(COARSEST * size);
        if !(size.is_finite() && tolerance >= FINEST * size) {
            return None;
        }
        let half = primitive.half_size();
        let around = |core: Vec3, radius: f64| Rounded::around(core, half, radius, tolerance);
        match primitive {
            Primitive::Sphere { radius } => around(Vec3::ZERO, radius).map(Direct::Rounded),
            Primitive::Ellipsoid { radii } => Rounded::ellipsoid(radii, tolerance).map(Direct::Rounded),
            Primitive::Capsule { half_length, radius } => {
                around(half_length * Vec3::Z, radius).map(Direct::Rounded)
            }
            Primitive::RoundedCuboid { half, radius: 0.0 } => Some(Direct::Cuboid { half }),
            Primitive::RoundedCuboid { half, radius } => around(half - radius, radius).map(Direct::Rounded),
            Primitive::Cylinder { radius, half_height, rounding } if rounding == radius => {
                around((half_height - radius) * Vec3::Z, radius).map(Direct::Rounded)
            }
            Primitive::Cylinder { radius, half_height, rounding } => {
                Turned::cylinder(radius, half_height, rounding, tolerance).map(Direct::Turned)
            }
            Primitive::Torus { major, minor } => Turned::ring(major, minor, tolerance).map(Direct::Turned),
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
            Direct::Rounded(body) => body.triangles(),
            Direct::Turned(body) => body.triangles(),
        }
    }

    /// How far the mesh of a round body is from it, at most; `None` where nothing was round.
    pub(super) fn error(&self) -> Option<f64> {
        match self {
            Direct::Rounded(body) => Some(body.error),
            Direct::Turned(body) => Some(body.error),
            _ => None,
        }
    }

    /// Whether its triangles stand for a curved surface.
    pub(super) fn is_round(&self) -> bool {
        match self {
            Direct::Cuboid { .. } | Direct::Octahedron { .. } => false,
            Direct::Rings { round, .. } => *round,
            Direct::Rounded(_) | Direct::Turned(_) => true,
        }
    }

    pub(super) fn solid(&self) -> Result<Solid, BuildError> {
        Ok(match self {
            &Direct::Cuboid { half } => mesh::cuboid(-half, half),
            &Direct::Octahedron { radius } => {
                let corners = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| [radius * axis, -radius * axis]);
                convex_hull(corners.as_flattened())?
            }
            &Direct::Rings { radii, half_height, sides, .. } => {
                mesh::frustum([-half_height, half_height], radii, sides)?
            }
            Direct::Rounded(body) => body.solid(),
            Direct::Turned(body) => body.solid(),
        })
    }
}
