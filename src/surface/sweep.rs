//! Profiles along curves.

use super::frames::{Frames, corners};
use super::{Gluing, Sides, Surface, SurfaceError};
use crate::curve::{Curve, Spline};
use crate::math::{Vec2, Vec3};
use std::f64::consts::TAU;

/// A closed or open profile carried along a path by frames that minimise rotation (Wang, Jüttler, Zheng, Liu, Computation
/// of rotation minimizing frames, 2008), turned by a twist and scaled on its way. u runs along the path, v along the
/// profile, whose x lies along the normal of the frame and y along its binormal. Corners of the path are mitred: the
/// parts before and after one meet in the plane that halves its angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    frames: Frames,
    profile: Spline<Vec2>,
    scale: f64,
    twist: f64,
}

impl Sweep {
    /// The sweep of a profile along a path. `twist` is in radians from start to end; on a closed path it is taken to the
    /// nearest whole number of turns. `scale` is the size at the end over that at the start, 1 on a closed path.
    ///
    /// # Errors
    /// [`SurfaceError::Curve`] where the path stands still, [`SurfaceError::Reversal`] where it turns back on itself,
    /// [`SurfaceError::Number`] for a twist or scale out of range.
    pub fn new(
        path: Spline<Vec3>,
        profile: Spline<Vec2>,
        twist: f64,
        scale: f64,
    ) -> Result<Sweep, SurfaceError> {
        if !(scale > 0.0 && scale.is_finite()) || (path.is_closed() && scale != 1.0) {
            return Err(SurfaceError::Number { name: "scale", value: scale });
        }
        let twist = if path.is_closed() { (twist / TAU).round() * TAU } else { twist };
        Ok(Sweep { frames: Frames::new(path, twist)?, profile, scale, twist })
    }

    /// The path.
    pub fn path(&self) -> &Spline<Vec3> {
        self.frames.path()
    }

    /// The profile.
    pub fn profile(&self) -> &Spline<Vec2> {
        &self.profile
    }

    /// The twist from start to end, in radians.
    pub fn twist(&self) -> f64 {
        self.twist
    }

    /// The size at the end over that at the start.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// No point is farther from the path than this.
    pub fn reach(&self) -> f64 {
        let farthest = self.profile.points().iter().map(|p| p.length()).fold(0.0, f64::max);
        farthest * self.scale.max(1.0) * self.frames.stretch()
    }
}

impl Surface for Sweep {
    fn domain(&self) -> [[f64; 2]; 2] {
        [self.frames.path().domain(), self.profile.domain()]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        let [low, high] = self.frames.path().domain();
        let size = 1.0 + (self.scale - 1.0) * (u - low) / (high - low);
        self.frames.at(u).carry(size * self.profile.eval(v))
    }

    fn sides(&self) -> Sides {
        let gluing = |closed: bool| if closed { Gluing::Closed } else { Gluing::Open };
        let profile = self.profile.is_closed();
        Sides { u: gluing(self.frames.path().is_closed()), v: gluing(profile), poles: [false; 4] }
    }

    fn creases(&self) -> [Vec<f64>; 2] {
        [self.frames.corners(), corners(&self.profile)]
    }
}

/// A round tube about a path, mitred at its corners; u runs along the path, v around it, in turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    frames: Frames,
    radius: f64,
}

impl Tube {
    /// The tube with this radius.
    ///
    /// # Errors
    /// [`SurfaceError::Curve`] where the path stands still, [`SurfaceError::Reversal`] where it turns back on itself,
    /// [`SurfaceError::Number`] for a radius that is not positive.
    pub fn new(path: Spline<Vec3>, radius: f64) -> Result<Tube, SurfaceError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(SurfaceError::Number { name: "radius", value: radius });
        }
        Ok(Tube { frames: Frames::new(path, 0.0)?, radius })
    }

    /// The path.
    pub fn path(&self) -> &Spline<Vec3> {
        self.frames.path()
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// No point is farther from the path than this: corners reach beyond the radius.
    pub fn reach(&self) -> f64 {
        self.radius * self.frames.stretch()
    }
}

impl Surface for Tube {
    fn domain(&self) -> [[f64; 2]; 2] {
        [self.frames.path().domain(), [0.0, 1.0]]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        let (sine, cosine) = crate::math::sin_cos_degrees(360.0 * v);
        self.frames.at(u).carry(self.radius * Vec2::new(cosine, sine))
    }

    fn sides(&self) -> Sides {
        let u = if self.frames.path().is_closed() { Gluing::Closed } else { Gluing::Open };
        Sides { u, v: Gluing::Closed, poles: [false; 4] }
    }

    fn creases(&self) -> [Vec<f64>; 2] {
        [self.frames.corners(), Vec::new()]
    }
}
