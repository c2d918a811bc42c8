//! Tangents, curvature, torsion and frames.

use super::subdivide::{restrict, with_unit_size};
use super::{Bernstein, CurveError};
use crate::math::{Blend, Vec2, Vec3};

/// A curve that can be asked for its point and first three derivatives anywhere in its domain.
pub trait Curve {
    /// A point or vector of the curve's space.
    type Point: Blend;

    /// First and last parameter.
    fn domain(&self) -> [f64; 2];

    /// Point and derivatives at a parameter of the domain.
    fn jet(&self, t: f64) -> Jet<Self::Point>;
}

/// A point of a curve with its derivatives by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<P> {
    /// The point.
    pub point: P,
    /// First derivative.
    pub first: P,
    /// Second derivative.
    pub second: P,
    /// Third derivative.
    pub third: P,
}

impl<C: Bernstein> Curve for C {
    type Point = C::Vector;

    fn domain(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn jet(&self, t: f64) -> Jet<C::Vector> {
        jet(self.points(), t)
    }
}

/// De Casteljau, stopped where four points are left: their differences are the derivatives.
pub(super) fn jet<P: Blend>(points: &[P], t: f64) -> Jet<P> {
    let n = points.len() - 1;
    let rows = super::evaluate::triangle(points, t);
    // The difference of an order stands in the row that many above the point.
    let mut derivatives = [P::ZERO; 4];
    derivatives[0] = super::evaluate::eval(points, t);
    let mut factor = 1.0;
    for order in 1..=n.min(3) {
        factor *= (n + 1 - order) as f64;
        let row = &rows[n - order];
        let difference = match order {
            1 => row[1] - row[0],
            2 => (row[2] - row[1]) - (row[1] - row[0]),
            _ => ((row[3] - row[2]) - (row[2] - row[1])) - ((row[2] - row[1]) - (row[1] - row[0])),
        };
        derivatives[order] = difference * factor;
    }
    let [point, first, second, third] = derivatives;
    Jet { point, first, second, third }
}

impl Jet<Vec2> {
    /// Signed curvature, positive where the curve turns left; its reciprocal is the radius of the osculating circle.
    /// Not finite where the curve stands still.
    pub fn curvature(&self) -> f64 {
        let speed = self.first.length();
        (self.first / speed).perp_dot(self.second / speed) / speed
    }
}

impl Jet<Vec3> {
    /// Curvature, not negative; not finite where the curve stands still.
    pub fn curvature(&self) -> f64 {
        let speed = self.first.length();
        (self.first / speed).cross(self.second / speed).length() / speed
    }

    /// Torsion, positive where the curve leaves its osculating plane like a right-handed screw; not finite where the
    /// curvature vanishes.
    pub fn torsion(&self) -> f64 {
        let binormal = self.first.cross(self.second);
        binormal.dot(self.third) / binormal.length_squared()
    }

    /// The Frenet frame; `None` where the curve stands still or has no curvature.
    pub fn frenet(&self) -> Option<Frame> {
        let tangent = self.first.try_normalize()?;
        let binormal = self.first.cross(self.second).try_normalize()?;
        Some(Frame { origin: self.point, tangent, normal: binormal.cross(tangent), binormal })
    }
}

/// A point with three unit vectors at right angles, right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The point.
    pub origin: Vec3,
    /// Along the curve.
    pub tangent: Vec3,
    /// At a right angle to the curve.
    pub normal: Vec3,
    /// `tangent` cross `normal`.
    pub binormal: Vec3,
}

impl Frame {
    /// The frame with a unit tangent and the part of `normal` at a right angle to it, or where there is none the axis that
    /// is farthest from the tangent.
    pub(crate) fn starting(origin: Vec3, tangent: Vec3, normal: Vec3) -> Frame {
        Frame::upright(origin, tangent, first_normal(tangent, normal))
    }

    /// The frame carried to a point and a unit tangent by double reflection.
    pub(crate) fn carried(&self, point: Vec3, tangent: Vec3) -> Frame {
        Frame::upright(point, tangent, doubly_reflected(self, point, tangent))
    }

    /// With the normal at a right angle to the tangent: rounding must not add up along a long curve.
    fn upright(origin: Vec3, tangent: Vec3, normal: Vec3) -> Frame {
        let normal = (normal - normal.dot(tangent) * tangent).normalize();
        Frame { origin, tangent, normal, binormal: tangent.cross(normal) }
    }
}

/// Frames along the curve that do not turn about its tangent, by double reflection (Wang, Jüttler, Zheng, Liu,
/// Computation of rotation minimizing frames, 2008): the angle to the true frames shrinks with the fourth power of
/// the step.
///
/// The first frame has the part of `normal` at a right angle to the curve as its normal, or where there is none the
/// axis that is farthest from the tangent. Parameters must ascend.
///
/// # Errors
/// [`CurveError::Parameter`] for a parameter outside the domain, out of order, or where the curve stands still.
pub fn rotation_minimizing_frames<C: Curve<Point = Vec3>>(
    curve: &C,
    parameters: &[f64],
    normal: Vec3,
) -> Result<Vec<Frame>, CurveError> {
    let [low, high] = curve.domain();
    let mut frames: Vec<Frame> = Vec::with_capacity(parameters.len());
    let mut before = low;
    for &t in parameters {
        if !(before <= t && t <= high) {
            return Err(CurveError::Parameter { value: t });
        }
        before = t;
        let jet = curve.jet(t);
        let tangent = jet.first.try_normalize().ok_or(CurveError::Parameter { value: t })?;
        frames.push(match frames.last() {
            Some(frame) => frame.carried(jet.point, tangent),
            None => Frame::starting(jet.point, tangent, normal),
        });
    }
    Ok(frames)
}

fn first_normal(tangent: Vec3, wish: Vec3) -> Vec3 {
    let across = wish - wish.dot(tangent) * tangent;
    if across.is_finite() && across.length() > f64::EPSILON.sqrt() * wish.length() {
        return across;
    }
    let size = tangent.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        Vec3::X
    } else if size.y <= size.z {
        Vec3::Y
    } else {
        Vec3::Z
    };
    axis - axis.dot(tangent) * tangent
}

/// The normal mirrored in the plane between the two points, then in the one that brings tangent onto tangent.
fn doubly_reflected(frame: &Frame, point: Vec3, tangent: Vec3) -> Vec3 {
    let mirror = |v: Vec3, across: Vec3| {
        let square = across.length_squared();
        if square > 0.0 { v - across * (2.0 * across.dot(v) / square) } else { v }
    };
    let step = point - frame.origin;
    if step == Vec3::ZERO {
        // Two tangents of one point may differ by rounding: no plane to mirror in.
        return frame.normal;
    }
    let (normal, carried) = (mirror(frame.normal, step), mirror(frame.tangent, step));
    mirror(normal, tangent - carried)
}

/// Unit directions in which a curve arrives at a point and leaves it: equal but for cusps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangents<P> {
    /// The limit from smaller parameters; at the start of the curve the same as `leaving`.
    pub arriving: Option<P>,
    /// The limit from larger parameters; at the end of the curve the same as `arriving`.
    pub leaving: Option<P>,
}

/// One-sided tangents at `t`, right also where the curve stands still: the first control point of the part after `t`
/// that differs from the point at `t`, by more than rounding, gives the direction. `None` when all points are equal.
///
/// # Errors
/// [`CurveError::Parameter`] when `t` is not within [0, 1].
pub fn tangents<C: Bernstein>(curve: &C, t: f64) -> Result<Tangents<C::Vector>, CurveError> {
    super::check_unit(t)?;
    let mut points = curve.points().to_vec();
    with_unit_size(&mut points, |points| {
        let rounding = if t == 0.0 || t == 1.0 { 0.0 } else { 8.0 * points.len() as f64 * f64::EPSILON };
        let toward = |end: f64| {
            let mut part = points.to_vec();
            restrict(&mut part, t, end);
            let origin = part[0];
            let steps = part.iter().map(|&point| point - origin);
            let step = steps.into_iter().find(|step| step.norm() > rounding)?;
            Some(step.map(|x| x / step.norm()))
        };
        let leaving = if t < 1.0 { toward(1.0) } else { None };
        let arriving = if t > 0.0 { toward(0.0).map(|step| step * -1.0) } else { None };
        Ok(Tangents { arriving: arriving.or(leaving), leaving: leaving.or(arriving) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{AnyBezier, Cubic};
    use crate::math::sin_cos;

    /// A polynomial that follows a helix of radius 1 and pitch 2 pi c to about 1e-13.
    fn helix(turn: f64, c: f64) -> AnyBezier<Vec3> {
        // Taylor coefficients of cos(turn t), sin(turn t), c turn t.
        let mut factor = 1.0;
        let mut monomials = Vec::new();
        for k in 0..30 {
            let (sine, cosine) = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][k % 4];
            monomials.push(Vec3::new(cosine * factor, sine * factor, if k == 1 { c * turn } else { 0.0 }));
            factor *= turn / (k + 1) as f64;
        }
        AnyBezier::from_monomials(&monomials).unwrap()
    }

    #[test]
    fn a_helix_has_constant_curvature_and_torsion() {
        let (turn, c) = (2.0, 0.5);
        let curve = helix(turn, c);
        for k in 0..=8 {
            let jet = curve.jet(f64::from(k) / 8.0);
            assert!((jet.curvature() - 1.0 / (1.0 + c * c)).abs() < 1e-9, "{}", jet.curvature());
            assert!((jet.torsion() - c / (1.0 + c * c)).abs() < 1e-8, "{}", jet.torsion());
            let frame = jet.frenet().unwrap();
            let (sine, cosine) = sin_cos(turn * f64::from(k) / 8.0);
            assert!((frame.normal + Vec3::new(cosine, sine, 0.0)).length() < 1e-8);
        }
    }

    #[test]
    fn frames_turn_back_against_the_torsion() {
        // Along a helix the minimising frame lags behind the Frenet frame by torsion times length.
        let (turn, c) = (2.0, 0.5);
        let curve = helix(turn, c);
        let off = |steps: u32| {
            let parameters: Vec<f64> = (0..=steps).map(|k| f64::from(k) / f64::from(steps)).collect();
            let start = curve.jet(0.0).frenet().unwrap();
            let frames = rotation_minimizing_frames(&curve, &parameters, start.normal).unwrap();
            let (last, frenet) = (frames[frames.len() - 1], curve.jet(1.0).frenet().unwrap());
            let length = turn * (1.0_f64 + c * c).sqrt();
            let (sine, cosine) = sin_cos(-c / (1.0 + c * c) * length);
            (last.normal - (cosine * frenet.normal + sine * frenet.binormal)).length()
        };
        assert!(off(32) < 1e-5, "{}", off(32));
        // Fourth order: half the step, a sixteenth of the error.
        let ratio = off(16) / off(32);
        assert!((12.0..20.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn plane_curvature_has_a_sign() {
        let left = Cubic::new([(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (2.0, 2.0)].map(Vec2::from)).unwrap();
        assert!(left.jet(0.5).curvature() > 0.0 && left.reversed().jet(0.5).curvature() < 0.0);
        assert_eq!(left.jet(0.0).curvature(), 2.0 / 3.0);
        let line = AnyBezier::new(vec![Vec3::ZERO, Vec3::X]).unwrap();
        assert_eq!(line.jet(0.5).frenet(), None);
        let frames = rotation_minimizing_frames(&line, &[0.0, 0.5, 1.0], Vec3::X).unwrap();
        assert!(frames.iter().all(|frame| frame.normal == Vec3::Y && frame.binormal == Vec3::Z));
        let error = rotation_minimizing_frames(&line, &[0.5, 0.4], Vec3::Y);
        assert_eq!(error, Err(CurveError::Parameter { value: 0.4 }));
    }
}
