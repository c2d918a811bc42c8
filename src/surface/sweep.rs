//! Profiles along curves.

use super::{Gluing, Sides, Surface, SurfaceError};
use crate::curve::{Continuity, Curve, Frame, Spline, rotation_minimizing_frames};
use crate::math::{Blend, Vec2, Vec3, sin_cos};
use std::f64::consts::TAU;

/// Frames along a curve that do not turn about it more than they must, and on closed curves meet again.
#[derive(Clone, Debug, PartialEq)]
struct Frames {
    path: Spline<Vec3>,
    parameters: Vec<f64>,
    frames: Vec<Frame>,
    /// Turn about the tangent from start to end, in radians, on top of the least one.
    twist: f64,
}

/// Frames a piece of the path: between them a double reflection is off by about the fourth power of its turn.
const FRAMES_A_PIECE: usize = 64;

impl Frames {
    fn new(path: Spline<Vec3>, twist: f64) -> Result<Frames, SurfaceError> {
        if !twist.is_finite() {
            return Err(SurfaceError::Number { name: "twist", value: twist });
        }
        let knots = path.knots();
        let mut parameters = Vec::with_capacity(FRAMES_A_PIECE * (knots.len() - 1) + 1);
        for pair in knots.windows(2) {
            let at = |k: usize| pair[0] + (pair[1] - pair[0]) * k as f64 / FRAMES_A_PIECE as f64;
            parameters.extend((0..FRAMES_A_PIECE).map(at));
        }
        parameters.push(knots[knots.len() - 1]);
        let frames = rotation_minimizing_frames(&path, &parameters, Vec3::Z)?;
        // What is left to turn where a closed path comes back, spread over all of it.
        let (first, last) = (frames[0], frames[frames.len() - 1]);
        let back = if path.is_closed() {
            crate::math::atan2(first.normal.dot(last.binormal), first.normal.dot(last.normal))
        } else {
            0.0
        };
        Ok(Frames { path, parameters, frames, twist: twist + back })
    }

    /// Point, normal and binormal at a parameter: reflected from the frame before it.
    fn at(&self, t: f64) -> [Vec3; 3] {
        let [low, high] = self.path.domain();
        let (t, end) = if t >= high && self.path.is_closed() { (low, true) } else { (t, false) };
        let before = self.parameters.partition_point(|&p| p <= t).saturating_sub(1);
        let start = self.frames[before];
        let steps = [self.parameters[before], t.max(self.parameters[before])];
        let frame = match rotation_minimizing_frames(&self.path, &steps, start.normal) {
            Ok(frames) => frames[1],
            Err(_) => start,
        };
        // At the end of a closed path everything is as at its start, whole turns of twist included.
        let share = if end { 0.0 } else { (t - low) / (high - low) };
        let (sine, cosine) = sin_cos(self.twist * share);
        let normal = cosine * frame.normal + sine * frame.binormal;
        [frame.origin, normal, cosine * frame.binormal - sine * frame.normal]
    }
}

/// A closed or open profile carried along a path by frames that minimise rotation (Wang, Jüttler, Zheng, Liu, Computation
/// of rotation minimizing frames, 2008), turned by a twist and scaled on its way. u runs along the path, v along the
/// profile, whose x lies along the normal of the frame and y along its binormal.
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
    /// [`SurfaceError::Curve`] where the path stands still, [`SurfaceError::Number`] for a twist or scale out of range.
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
        &self.frames.path
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
        farthest * self.scale.max(1.0)
    }
}

impl Surface for Sweep {
    fn domain(&self) -> [[f64; 2]; 2] {
        [self.frames.path.domain(), self.profile.domain()]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        let [origin, normal, binormal] = self.frames.at(u);
        let [low, high] = self.frames.path.domain();
        let size = 1.0 + (self.scale - 1.0) * (u - low) / (high - low);
        let p = self.profile.eval(v);
        origin + size * (p.x * normal + p.y * binormal)
    }

    fn sides(&self) -> Sides {
        let gluing = |closed: bool| if closed { Gluing::Closed } else { Gluing::Open };
        let profile = self.profile.is_closed();
        Sides { u: gluing(self.frames.path.is_closed()), v: gluing(profile), poles: [false; 4] }
    }

    fn creases(&self) -> [Vec<f64>; 2] {
        [corners(&self.frames.path), corners(&self.profile)]
    }
}

/// A round tube about a path; u runs along the path, v around it, in turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    frames: Frames,
    radius: f64,
}

impl Tube {
    /// The tube with this radius.
    ///
    /// # Errors
    /// [`SurfaceError::Curve`] where the path stands still, [`SurfaceError::Number`] for a radius that is not positive.
    pub fn new(path: Spline<Vec3>, radius: f64) -> Result<Tube, SurfaceError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(SurfaceError::Number { name: "radius", value: radius });
        }
        Ok(Tube { frames: Frames::new(path, 0.0)?, radius })
    }

    /// The path.
    pub fn path(&self) -> &Spline<Vec3> {
        &self.frames.path
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl Surface for Tube {
    fn domain(&self) -> [[f64; 2]; 2] {
        [self.frames.path.domain(), [0.0, 1.0]]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        let [origin, normal, binormal] = self.frames.at(u);
        let (sine, cosine) = crate::math::sin_cos_degrees(360.0 * v);
        origin + self.radius * (cosine * normal + sine * binormal)
    }

    fn sides(&self) -> Sides {
        let u = if self.frames.path.is_closed() { Gluing::Closed } else { Gluing::Open };
        Sides { u, v: Gluing::Closed, poles: [false; 4] }
    }

    fn creases(&self) -> [Vec<f64>; 2] {
        [corners(&self.frames.path), Vec::new()]
    }
}

/// Knots where a spline has a corner.
fn corners<P: Blend>(spline: &Spline<P>) -> Vec<f64> {
    // A turn of the tangent by this much is rounding.
    const SMOOTH: f64 = 1e-9;
    let knots = spline.knots();
    let is_corner = |k: &usize| spline.joint(*k).is_some_and(|joint| joint.misfit(Continuity::G1) > SMOOTH);
    (1..knots.len() - 1).filter(is_corner).map(|k| knots[k]).collect()
}
