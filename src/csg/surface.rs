//! Explicit surfaces as leaves.

use super::Parametric;
use super::build::BuildError;
use crate::curve::Spline;
use crate::math::{Aabb, Blend, Vec2, Vec3};
use crate::mesh::Mesh;
use crate::numeric::ContentHasher;
use crate::surface::{Patch, RationalPatch, Surface, SurfaceError, Sweep, Tube, revolution};
use crate::tessellate::{
    CloseError, SurfaceOptions, TessellationError, capped, patches, surface, surfaces, thickened,
};

/// A surface that bounds a solid: its boundary loops are capped, or it is given a thickness.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceBody {
    /// The surface.
    pub shape: Explicit,
    /// Largest distance of the triangles from the surface.
    pub tolerance: f64,
    /// Thickness of the plate that it becomes; `None` where it is closed by caps.
    pub thickness: Option<f64>,
}

/// A surface by what makes it.
#[derive(Clone, Debug, PartialEq)]
pub enum Explicit {
    /// Bézier patches; those with equal borders are joined.
    Patches(Vec<Patch>),
    /// A profile turned about the z axis, see [`revolution`].
    Revolution {
        /// In x (distance from the axis) and z.
        profile: Spline<Vec2>,
        /// Angle at which it starts, in radians.
        start: f64,
        /// Angle of the turn, in radians.
        angle: f64,
    },
    /// A profile along a path.
    Sweep(Box<Sweep>),
    /// A round tube along a path.
    Tube(Box<Tube>),
    /// Formulas of two parameters.
    Parametric(Box<Parametric>),
}

impl SurfaceBody {
    /// The closed mesh.
    pub(super) fn mesh(&self, max_triangles: u64) -> Result<Mesh, BuildError> {
        let options = SurfaceOptions { max_triangles, ..SurfaceOptions::within(self.tolerance) };
        let made = match &self.shape {
            Explicit::Patches(list) => patches(list, &options),
            Explicit::Revolution { profile, start, angle } => {
                let turned = revolution(profile, *start, *angle)?;
                surfaces(
                    &turned.iter().map(|patch: &RationalPatch| patch as &dyn Surface).collect::<Vec<_>>(),
                    &options,
                )
            }
            Explicit::Sweep(sweep) => surface(&**sweep, &options),
            Explicit::Tube(tube) => surface(&**tube, &options),
            Explicit::Parametric(parametric) => surface(&parametric.surface(), &options),
        };
        let mesh = made?.mesh;
        Ok(match self.thickness {
            Some(thickness) => thickened(&mesh, thickness)?,
            None => capped(&mesh, self.tolerance)?,
        })
    }

    /// A box around it.
    pub(super) fn bounds(&self) -> Aabb {
        let widened = |bounds: Aabb, by: f64| Aabb { min: bounds.min - by, max: bounds.max + by };
        let bounds = match &self.shape {
            Explicit::Patches(patches) => patches.iter().map(Patch::hull_box).fold(Aabb::EMPTY, Aabb::union),
            Explicit::Revolution { profile, .. } => {
                let reach = profile.points().iter().map(|p| p.x.abs()).fold(0.0, f64::max);
                let heights = || profile.points().iter().map(|p| p.y);
                Aabb {
                    min: Vec3::new(-reach, -reach, heights().fold(f64::INFINITY, f64::min)),
                    max: Vec3::new(reach, reach, heights().fold(f64::NEG_INFINITY, f64::max)),
                }
            }
            Explicit::Sweep(sweep) => widened(Aabb::of(sweep.path().points().iter().copied()), sweep.reach()),
            Explicit::Tube(tube) => widened(Aabb::of(tube.path().points().iter().copied()), tube.reach()),
            Explicit::Parametric(parametric) => parametric.bounds(),
        };
        // Rounding of the frames, and of the points.
        let slack = 1e-9 * bounds.size().max_element() + 0.5 * self.thickness.unwrap_or(0.0);
        widened(bounds, slack)
    }

    /// Whether all its numbers are finite, as those of curves and patches always are.
    pub(super) fn is_sound(&self) -> bool {
        let angles = match self.shape {
            Explicit::Revolution { start, angle, .. } => start.is_finite() && angle.is_finite(),
            _ => true,
        };
        self.tolerance.is_finite() && self.thickness.is_none_or(f64::is_finite) && angles
    }

    /// Hashes all that the shape depends on.
    pub(super) fn hash(&self, hash: &mut ContentHasher) {
        hash.integers([u64::from(self.thickness.is_some())]);
        hash.numbers([self.tolerance, self.thickness.unwrap_or(0.0)]);
        match &self.shape {
            Explicit::Patches(patches) => {
                hash.integers([0, patches.len() as u64]);
                for patch in patches {
                    hash.integers(patch.degrees().map(|degree| degree as u64));
                    hash.numbers(patch.points().iter().flat_map(Vec3::to_array));
                }
            }
            Explicit::Revolution { profile, start, angle } => {
                hash.integers([1]);
                hash_spline(hash, profile);
                hash.numbers([*start, *angle]);
            }
            Explicit::Sweep(sweep) => {
                hash.integers([2]);
                hash_spline(hash, sweep.path());
                hash_spline(hash, sweep.profile());
                hash.numbers([sweep.twist(), sweep.scale()]);
            }
            Explicit::Tube(tube) => {
                hash.integers([3]);
                hash_spline(hash, tube.path());
                hash.numbers([tube.radius()]);
            }
            Explicit::Parametric(parametric) => {
                hash.integers([4]);
                parametric.hash(hash);
            }
        }
    }
}

fn hash_spline<P: Blend>(hash: &mut ContentHasher, spline: &Spline<P>) {
    hash.integers([u64::from(spline.is_closed()), spline.points().len() as u64]);
    let points = spline.points().iter();
    hash.numbers(points.flat_map(|&p| (0..P::DIMENSION).map(move |axis| p.component(axis))));
    hash.numbers(spline.knots().iter().copied());
}

impl From<CloseError> for BuildError {
    fn from(error: CloseError) -> BuildError {
        match error {
            CloseError::Tessellation(error) => error.into(),
            error => BuildError::Surface(error),
        }
    }
}

impl From<TessellationError> for BuildError {
    fn from(error: TessellationError) -> BuildError {
        match error {
            TessellationError::TooLarge { triangles, most } => BuildError::Limit { triangles, most },
            error => BuildError::Surface(CloseError::Tessellation(error)),
        }
    }
}

impl From<SurfaceError> for BuildError {
    fn from(error: SurfaceError) -> BuildError {
        BuildError::Curves(error)
    }
}
