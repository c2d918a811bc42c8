//! Frames along a path, mitred where it has corners.

use super::SurfaceError;
use crate::curve::{Bernstein, Continuity, Curve, Frame, Spline};
use crate::math::{Blend, Vec2, Vec3, sin_cos};

/// Frames that do not turn about the path more than they must, and on closed paths meet again. Where the path has a
/// corner, they go over it by the least rotation, and what is carried along meets in the plane that halves the angle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Frames {
    path: Spline<Vec3>,
    stations: Vec<Station>,
    legs: Vec<Leg>,
    /// Turn about the tangent from start to end, in radians, on top of the least one.
    twist: f64,
}

/// A frame that others begin from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Station {
    t: f64,
    frame: Frame,
    leg: usize,
}

/// A part of the path without corners.
#[derive(Clone, Debug, PartialEq)]
struct Leg {
    range: [f64; 2],
    /// How far what is carried leans forward at the start and at the end, for each unit along normal and binormal.
    lean: [Vec2; 2],
}

/// Where a profile is carried to.
pub(super) struct Place {
    origin: Vec3,
    tangent: Vec3,
    normal: Vec3,
    binormal: Vec3,
    lean: Vec2,
}

impl Place {
    /// The place of a point of the profile.
    pub(super) fn carry(&self, p: Vec2) -> Vec3 {
        self.origin + (p.x * self.normal + p.y * self.binormal) + p.dot(self.lean) * self.tangent
    }
}

/// Stations a piece of the path: between them a double reflection is off by about the fourth power of its turn.
const STATIONS_A_PIECE: usize = 64;
/// A turn of the tangent by this much is rounding.
const SMOOTH: f64 = 1e-9;
/// The least cosine of half the angle of a corner; sharper ones lean without end.
const SHARPEST: f64 = 1e-3;

impl Frames {
    /// # Errors
    /// [`SurfaceError::Number`] for a twist that is not finite, [`SurfaceError::Curve`] where the path stands still,
    /// [`SurfaceError::Reversal`] where it turns back.
    pub(super) fn new(path: Spline<Vec3>, twist: f64) -> Result<Frames, SurfaceError> {
        if !twist.is_finite() {
            return Err(SurfaceError::Number { name: "twist", value: twist });
        }
        let mut frames = Frames { path, stations: Vec::new(), legs: Vec::new(), twist };
        let ends = frames.place_stations()?;
        frames.close(&ends);
        frames.lean(&ends)?;
        Ok(frames)
    }

    pub(super) fn path(&self) -> &Spline<Vec3> {
        &self.path
    }

    /// Parameters of corners.
    pub(super) fn corners(&self) -> Vec<f64> {
        self.legs[1..].iter().map(|leg| leg.range[0]).collect()
    }

    /// How much farther than itself something carried reaches from the path.
    pub(super) fn stretch(&self) -> f64 {
        let steepest =
            self.legs.iter().flat_map(|leg| leg.lean).map(Vec2::length_squared).fold(0.0, f64::max);
        (1.0 + steepest).sqrt()
    }

    /// Fills legs and stations; returns the frame at the end of each leg.
    fn place_stations(&mut self) -> Result<Vec<Frame>, SurfaceError> {
        let corners = corner_knots(&self.path);
        let knots = self.path.knots().to_vec();
        let mut ends: Vec<Frame> = Vec::new();
        let mut current: Option<Frame> = None;
        for piece in 0..knots.len() - 1 {
            let begins = piece == 0 || corners.contains(&piece);
            if begins {
                ends.extend(current);
                self.legs.push(Leg { range: [knots[piece]; 2], lean: [Vec2::ZERO; 2] });
            }
            let leg = self.legs.len() - 1;
            for k in 0..=STATIONS_A_PIECE {
                let share = k as f64 / STATIONS_A_PIECE as f64;
                let t = knots[piece] + (knots[piece + 1] - knots[piece]) * share;
                let (point, tangent) = self.direction(piece, share);
                let tangent =
                    tangent.ok_or(SurfaceError::Curve(crate::curve::CurveError::Parameter { value: t }))?;
                let frame = match &current {
                    Some(before) if begins && k == 0 => turned(before, point, tangent),
                    Some(before) => before.carried(point, tangent),
                    None => Frame::starting(point, tangent, Vec3::Z),
                };
                if k < STATIONS_A_PIECE {
                    self.stations.push(Station { t, frame, leg });
                }
                current = Some(frame);
            }
            self.legs[leg].range[1] = knots[piece + 1];
        }
        ends.extend(current);
        Ok(ends)
    }

    /// Spreads what is left to turn where a closed path comes back over all of it.
    fn close(&mut self, ends: &[Frame]) {
        if !self.path.is_closed() {
            return;
        }
        let (first, last) = (self.stations[0].frame, ends[ends.len() - 1]);
        let last = if self.has_corner_at_start() { turned(&last, first.origin, first.tangent) } else { last };
        self.twist += crate::math::atan2(first.normal.dot(last.binormal), first.normal.dot(last.normal));
    }

    fn has_corner_at_start(&self) -> bool {
        is_corner(&self.path, 0)
    }

    /// Leans both sides of every corner toward the plane between them.
    fn lean(&mut self, ends: &[Frame]) -> Result<(), SurfaceError> {
        for (leg, end) in ends.iter().enumerate() {
            let next = (leg + 1) % ends.len();
            if next == 0 && !self.has_corner_at_start() {
                break;
            }
            let start = self.stations.iter().find(|station| station.leg == next).map_or(*end, |s| s.frame);
            let plane = end.tangent + start.tangent;
            let least = 2.0 * SHARPEST * SHARPEST;
            if end.tangent.dot(plane) < least {
                return Err(SurfaceError::Reversal { parameter: self.legs[leg].range[1] });
            }
            let toward = |frame: &Frame, turn: f64| {
                let [normal, binormal] = twisted(frame, turn);
                -Vec2::new(normal.dot(plane), binormal.dot(plane)) / frame.tangent.dot(plane)
            };
            let [low, high] = self.path.domain();
            let turn = self.twist * (self.legs[leg].range[1] - low) / (high - low);
            self.legs[leg].lean[1] = toward(end, turn);
            // At the start of a closed path nothing has turned yet.
            self.legs[next].lean[0] = toward(&start, if next == 0 { 0.0 } else { turn });
        }
        Ok(())
    }

    /// The point at a share of a piece, and the unit tangent where the path moves.
    fn direction(&self, piece: usize, share: f64) -> (Vec3, Option<Vec3>) {
        let cubic = self.path.piece(piece);
        let [a, b, c, d] = cubic.to_array();
        let [p, q, r] = [b - a, c - b, d - c];
        let rest = 1.0 - share;
        let slope = rest * rest * p + 2.0 * share * rest * q + share * share * r;
        // A doubled end point has a limit.
        let first = slope.try_normalize().or_else(|| {
            let toward = if share <= 0.5 { [q, r] } else { [q, p] };
            toward.into_iter().find_map(Vec3::try_normalize).filter(|_| share == 0.0 || share == 1.0)
        });
        (cubic.eval(share), first)
    }

    /// Where something is carried to at a parameter.
    pub(super) fn at(&self, t: f64) -> Place {
        let [low, high] = self.path.domain();
        let end = t >= high && self.path.is_closed();
        let t = if end { low } else { t };
        let after = self.stations.partition_point(|station| station.t <= t);
        let station = &self.stations[after.saturating_sub(1)];
        let (piece, local) = self.path.locate(t);
        let (point, tangent) = self.direction(piece, local);
        let frame = station.frame.carried(point, tangent.unwrap_or(station.frame.tangent));
        // At the end of a closed path everything is as at its start, whole turns of twist included.
        let share = if end { 0.0 } else { (t - low) / (high - low) };
        let [normal, binormal] = twisted(&frame, self.twist * share);
        let leg = &self.legs[station.leg];
        let [start, stop] = leg.range;
        let along = ((t - start) / (stop - start)).clamp(0.0, 1.0);
        let lean = leg.lean[0] * (1.0 - along) + leg.lean[1] * along;
        Place { origin: frame.origin, tangent: frame.tangent, normal, binormal, lean }
    }
}

fn twisted(frame: &Frame, turn: f64) -> [Vec3; 2] {
    let (sine, cosine) = sin_cos(turn);
    [cosine * frame.normal + sine * frame.binormal, cosine * frame.binormal - sine * frame.normal]
}

/// The frame over a corner: turned about the axis at right angles to both tangents.
fn turned(frame: &Frame, point: Vec3, tangent: Vec3) -> Frame {
    let axis = frame.tangent.cross(tangent);
    let cosine = frame.tangent.dot(tangent);
    let turn = |v: Vec3| cosine * v + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine));
    Frame::starting(point, tangent, turn(frame.normal))
}

/// Indices of knots inside a spline where it has a corner.
fn corner_knots<P: Blend>(spline: &Spline<P>) -> Vec<usize> {
    (1..spline.knots().len() - 1).filter(|&k| is_corner(spline, k)).collect()
}

fn is_corner<P: Blend>(spline: &Spline<P>, knot: usize) -> bool {
    spline.joint(knot).is_some_and(|joint| joint.misfit(Continuity::G1) > SMOOTH)
}

/// Knots inside a spline where it has a corner.
pub(super) fn corners<P: Blend>(spline: &Spline<P>) -> Vec<f64> {
    corner_knots(spline).into_iter().map(|k| spline.knots()[k]).collect()
}
