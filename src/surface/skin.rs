//! Surfaces between curves and about an axis.

use super::formula::check_domain;
use super::{Gluing, Jet, RationalPatch, Sides, Surface, SurfaceError};
use crate::curve::{Curve, Spline};
use crate::math::{Blend, Vec2, Vec3, Vec4, sin_cos};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A profile in the half plane of x (distance from the axis) and y (height) turned about the z axis, from an angle by an
/// angle, in radians: exact, of a rational patch for each piece of the profile and at most a quarter of a turn. u runs
/// along the profile, v around; a full turn or more closes on itself, to the bit. Pieces on the axis have no patch.
///
/// # Errors
/// [`SurfaceError::Number`] for angles that are not finite or zero, and for a profile on both sides of the axis.
pub fn revolution(
    profile: &Spline<Vec2>,
    start: f64,
    angle: f64,
) -> Result<Vec<RationalPatch>, SurfaceError> {
    for (name, value) in [("the start angle", start), ("the angle", angle)] {
        if !value.is_finite() || (name == "the angle" && value == 0.0) {
            return Err(SurfaceError::Number { name, value });
        }
    }
    let bounds = profile.bounding_box();
    if bounds.min.x < 0.0 && bounds.max.x > 0.0 && profile.points().iter().any(|p| p.x < 0.0) {
        return Err(SurfaceError::Number { name: "the least distance from the axis", value: bounds.min.x });
    }
    let angle = angle.clamp(-TAU, TAU);
    let full = angle.abs() == TAU;
    let arcs = ((angle.abs() / FRAC_PI_2) - 1e-9).ceil().max(1.0) as usize;
    let step = angle / arcs as f64;
    // Directions are computed once, so that neighbours share them.
    let direction = |k: usize| {
        let k = if full && k == arcs { 0 } else { k };
        let (sine, cosine) = sin_cos(start + step * k as f64);
        Vec2::new(cosine, sine)
    };
    let mut patches = Vec::new();
    // A piece on the axis sweeps nothing.
    for piece in profile.pieces().filter(|piece| piece.to_array().iter().any(|p| p.x != 0.0)) {
        for k in 0..arcs {
            patches.push(quarter(&piece.to_array(), direction(k), direction(k + 1), step));
        }
    }
    Ok(patches)
}

/// The patch of a cubic turned from one direction to the next; the middle control point has the weight of half the cosine.
fn quarter(profile: &[Vec2; 4], from: Vec2, to: Vec2, step: f64) -> RationalPatch {
    let (_, weight) = sin_cos(0.5 * step);
    // The tangents meet at the sum of the directions over 1 + cos(step), which is twice the squared weight.
    let corner = (from + to) / (2.0 * weight * weight);
    let mut points = Vec::with_capacity(12);
    for p in profile {
        let at =
            |direction: Vec2, w: f64| Vec4::new(w * p.x * direction.x, w * p.x * direction.y, w * p.y, w);
        points.extend([at(from, 1.0), at(corner, weight), at(to, 1.0)]);
    }
    RationalPatch::assume([3, 2], points)
}

/// The straight lines between points of two curves at equal shares of their domains: u along the curves, v across.
#[derive(Clone, Debug, PartialEq)]
pub struct Ruled<A, B> {
    from: A,
    to: B,
}

impl<A: Curve<Point = Vec3>, B: Curve<Point = Vec3>> Ruled<A, B> {
    /// The surface between two curves.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] when the domain of one is not finite and ascending.
    pub fn new(from: A, to: B) -> Result<Ruled<A, B>, SurfaceError> {
        check_domain([from.domain(), to.domain()])?;
        Ok(Ruled { from, to })
    }
}

/// Point, first and second derivative at a share of a curve's domain.
fn share<C: Curve<Point = Vec3>>(curve: &C, share: f64) -> [Vec3; 3] {
    let [low, high] = curve.domain();
    let jet = curve.jet(if share >= 1.0 { high } else { low + share * (high - low) });
    let rate = high - low;
    [jet.point, jet.first * rate, jet.second * rate * rate]
}

impl<A: Curve<Point = Vec3> + Sync, B: Curve<Point = Vec3> + Sync> Surface for Ruled<A, B> {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0]; 2]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        let (a, b) = (share(&self.from, u)[0], share(&self.to, u)[0]);
        crate::curve::evaluate::lerp(a, b, v)
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let ([a, da, dda], [b, db, ddb]) = (share(&self.from, u), share(&self.to, u));
        Jet {
            point: crate::curve::evaluate::lerp(a, b, v),
            du: da + v * (db - da),
            dv: b - a,
            duu: dda + v * (ddb - dda),
            duv: db - da,
            dvv: Vec3::ZERO,
        }
    }

    fn sides(&self) -> Sides {
        let whole = |curve: &dyn Fn(f64) -> Vec3| curve(0.0) == curve(1.0);
        let closed = whole(&|t| share(&self.from, t)[0]) && whole(&|t| share(&self.to, t)[0]);
        Sides { u: if closed { Gluing::Closed } else { Gluing::Open }, ..Sides::OPEN }
    }
}

/// The surface that four curves bound (Coons, Surfaces for computer-aided design of space forms, 1967): the sum of the two
/// ruled surfaces less the bilinear one through the corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Coons<C> {
    /// Bottom and top, along u; left and right, along v.
    curves: [C; 4],
    corners: [Vec3; 4],
}

impl<C: Curve<Point = Vec3>> Coons<C> {
    /// The surface between a bottom and a top curve along u and a left and a right one along v. Corners may miss each other
    /// by `tolerance`; the surface then runs through their middles.
    ///
    /// # Errors
    /// [`SurfaceError::Corner`], and [`SurfaceError::Parameter`] when a domain is not finite and ascending.
    pub fn new(curves: [C; 4], tolerance: f64) -> Result<Coons<C>, SurfaceError> {
        let [bottom, top, left, right] = &curves;
        check_domain([bottom.domain(), top.domain()])?;
        check_domain([left.domain(), right.domain()])?;
        let ends = [
            (share(bottom, 0.0)[0], share(left, 0.0)[0]),
            (share(bottom, 1.0)[0], share(right, 0.0)[0]),
            (share(top, 0.0)[0], share(left, 1.0)[0]),
            (share(top, 1.0)[0], share(right, 1.0)[0]),
        ];
        for (corner, (a, b)) in ends.iter().enumerate() {
            let gap = (*a - *b).norm();
            if gap > tolerance || gap.is_nan() {
                return Err(SurfaceError::Corner { corner, gap });
            }
        }
        let corners = ends.map(|(a, b)| if a == b { a } else { 0.5 * a + 0.5 * b });
        Ok(Coons { curves, corners })
    }
}

impl<C: Curve<Point = Vec3> + Sync> Surface for Coons<C> {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0]; 2]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        self.jet(u, v).point
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let [bottom, top, left, right] = &self.curves;
        let ([b, bu, buu], [t, tu, tuu]) = (share(bottom, u), share(top, u));
        let ([l, lv, lvv], [r, rv, rvv]) = (share(left, v), share(right, v));
        let [c00, c10, c01, c11] = self.corners;
        let twist = (c11 - c01) - (c10 - c00);
        let bilinear_u = (c10 - c00) + v * twist;
        let bilinear_v = (c01 - c00) + u * twist;
        let mix = |a: Vec3, b: Vec3, s: f64| (1.0 - s) * a + s * b;
        let bilinear = mix(mix(c00, c10, u), mix(c01, c11, u), v);
        Jet {
            point: mix(b, t, v) + mix(l, r, u) - bilinear,
            du: mix(bu, tu, v) + (r - l) - bilinear_u,
            dv: (t - b) + mix(lv, rv, u) - bilinear_v,
            duu: mix(buu, tuu, v),
            duv: (tu - bu) + (rv - lv) - twist,
            dvv: mix(lvv, rvv, u),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{AnyBezier, Bernstein, Cubic};

    #[test]
    fn a_turned_line_is_a_cylinder_and_closes_to_the_bit() {
        let line = [0.0, 1.0, 2.0, 3.0].map(|y| Vec2::new(2.0, y));
        let profile = Spline::from_pieces(&[Cubic::new(line).unwrap()]).unwrap();
        let patches = revolution(&profile, 0.3, TAU).unwrap();
        assert_eq!(patches.len(), 4);
        for (index, patch) in patches.iter().enumerate() {
            for k in 0..=10 {
                let p = patch.eval(0.5, f64::from(k) / 10.0);
                assert!((p.truncate().length() - 2.0).abs() < 1e-14 && (p.z - 1.5).abs() < 1e-14);
            }
            let next = &patches[(index + 1) % 4];
            let (right, left) = (super::super::Side::Top, super::super::Side::Bottom);
            assert_eq!(patch.border_net(right), next.border_net(left));
        }
        let backward = revolution(&profile, 0.0, -1.0).unwrap();
        assert_eq!(backward.len(), 1);
        assert!(backward[0].eval(0.0, 1.0).y < 0.0);
    }

    #[test]
    fn a_coons_patch_runs_through_its_curves() {
        let curve = |points: &[(f64, f64, f64)]| {
            AnyBezier::new(points.iter().copied().map(Vec3::from).collect()).unwrap()
        };
        let bottom = curve(&[(0., 0., 0.), (0.5, 0., 1.), (1., 0., 0.)]);
        let top = curve(&[(0., 1., 0.), (0.5, 1., -1.), (1., 1., 0.)]);
        let left = curve(&[(0., 0., 0.), (0., 0.3, 0.5), (0., 1., 0.)]);
        let right = curve(&[(1., 0., 0.), (1., 0.6, 2.), (1., 1., 0.)]);
        let all = [bottom, top, left, right];
        let coons = Coons::new(all.clone(), 0.0).unwrap();
        for k in 0..=8 {
            let t = f64::from(k) / 8.0;
            let off = [(t, 0.0, 0), (t, 1.0, 1), (0.0, t, 2), (1.0, t, 3)]
                .map(|(u, v, curve): (f64, f64, usize)| (coons.point(u, v) - all[curve].eval(t)).length());
            assert!(off.iter().all(|&off| off < 1e-15), "{t}: {off:?}");
        }
        let [bottom, top, left, _] = all;
        let gap = Coons::new([bottom, top, left.clone(), left], 1e-9);
        assert!(matches!(gap, Err(SurfaceError::Corner { corner: 1, gap }) if gap == 1.0));
    }
}
