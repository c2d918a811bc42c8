use super::net::{self, Degrees};
use super::patch::check_degrees;
use super::{Across, Bends, Jet, Patch, Side, Surface, SurfaceError};
use crate::curve::Rational;
use crate::math::{Aabb, Vec3, Vec4};

/// A rational tensor-product Bézier patch over the unit square: quadrics are exact. Kept homogeneous, (w x, w y, w z, w).
#[derive(Clone, Debug, PartialEq)]
pub struct RationalPatch {
    points: Vec<Vec4>,
    degrees: Degrees,
}

impl RationalPatch {
    /// The patch with these degrees, points (in the order of [`Patch::new`]) and positive weights.
    ///
    /// # Errors
    /// As [`Patch::new`], and [`SurfaceError::Weight`].
    pub fn new(degrees: [usize; 2], points: &[Vec3], weights: &[f64]) -> Result<RationalPatch, SurfaceError> {
        check_degrees(degrees)?;
        let expected = (degrees[0] + 1) * (degrees[1] + 1);
        if let Some(&actual) = [points.len(), weights.len()].iter().find(|&&count| count != expected) {
            return Err(SurfaceError::Count { actual, expected });
        }
        if let Some(index) = weights.iter().position(|w| !(w.is_normal() && *w > 0.0)) {
            return Err(SurfaceError::Weight { index });
        }
        let homogeneous: Vec<Vec4> = points.iter().zip(weights).map(|(&p, &w)| (p * w).extend(w)).collect();
        match homogeneous.iter().position(|point| !point.is_finite()) {
            Some(index) => Err(SurfaceError::NotFinite { index }),
            None => Ok(RationalPatch { points: homogeneous, degrees }),
        }
    }

    /// From homogeneous points that are known to be sound.
    pub(super) fn assume(degrees: Degrees, points: Vec<Vec4>) -> RationalPatch {
        debug_assert!(points.iter().all(|p| p.is_finite() && p.w > 0.0));
        RationalPatch { points, degrees }
    }

    /// The homogeneous control points.
    pub fn homogeneous(&self) -> &[Vec4] {
        &self.points
    }

    /// Degrees in u and in v.
    pub fn degrees(&self) -> [usize; 2] {
        self.degrees
    }

    /// The point at parameters.
    pub fn eval(&self, u: f64, v: f64) -> Vec3 {
        projected(net::eval(&self.points, self.degrees, u, v))
    }

    /// The part over ranges of u and v, over the unit square.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] when a range is not ascending within [0, 1].
    pub fn part(&self, ranges: [[f64; 2]; 2]) -> Result<RationalPatch, SurfaceError> {
        Ok(RationalPatch { points: net::part(&self.points, self.degrees, ranges)?, degrees: self.degrees })
    }

    /// The same patch written with degrees higher by these numbers.
    ///
    /// # Errors
    /// [`SurfaceError::Degree`] above 200.
    pub fn elevated(&self, by: [usize; 2]) -> Result<RationalPatch, SurfaceError> {
        let (points, degrees) = net::elevated_by(&self.points, self.degrees, by)?;
        Ok(RationalPatch { points, degrees })
    }

    /// A border curve, exactly.
    ///
    /// # Errors
    /// [`SurfaceError::Curve`] when a coordinate over its weight exceeds the range of `f64`.
    pub fn border(&self, side: Side) -> Result<Rational, SurfaceError> {
        let line = net::border(&self.points, self.degrees, side as usize);
        let points: Vec<Vec3> = line.iter().copied().map(projected).collect();
        let weights: Vec<f64> = line.iter().map(|point| point.w).collect();
        Ok(Rational::new(&points, &weights)?)
    }

    /// The box of the control points, which holds the patch.
    pub fn hull_box(&self) -> Aabb {
        Aabb::of(self.points.iter().copied().map(projected))
    }
}

/// The point of space that a homogeneous one stands for.
pub(super) fn projected(point: Vec4) -> Vec3 {
    Vec3::new(point.x / point.w, point.y / point.w, point.z / point.w)
}

impl From<Patch> for RationalPatch {
    fn from(patch: Patch) -> RationalPatch {
        let points = patch.points().iter().map(|point| point.extend(1.0)).collect();
        RationalPatch { points, degrees: patch.degrees() }
    }
}

impl Surface for RationalPatch {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0]; 2]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        self.eval(u, v)
    }

    /// By the quotient rule.
    fn jet(&self, u: f64, v: f64) -> Jet {
        let [s, su, sv, suu, suv, svv] = net::jet(&self.points, self.degrees, u, v);
        let point = projected(s);
        let du = (su.truncate() - su.w * point) / s.w;
        let dv = (sv.truncate() - sv.w * point) / s.w;
        let second = |d: Vec4, first: Vec3, weight: f64, other: Vec3, other_weight: f64| {
            (d.truncate() - weight * other - other_weight * first - d.w * point) / s.w
        };
        Jet {
            point,
            du,
            dv,
            duu: second(suu, du, su.w, du, su.w),
            duv: second(suv, du, su.w, dv, sv.w),
            dvv: second(svv, dv, sv.w, dv, sv.w),
        }
    }

    fn border_net(&self, side: Side) -> Option<Vec<Vec4>> {
        Some(net::border(&self.points, self.degrees, side as usize))
    }

    fn second_bounds(&self, part: [[f64; 2]; 2]) -> Option<[f64; 3]> {
        Some(Moved::new(self, part).second(Vec3::length))
    }

    fn bends(&self, part: [[f64; 2]; 2]) -> Option<Bends> {
        let moved = Moved::new(self, part);
        let lengths = moved.second(Vec3::length);
        let [u, v] = part.map(|[low, high]| 0.5 * low + 0.5 * high);
        let jet = self.jet(u, v);
        // From the middle of the part, half of its extents at most, with some room for rounding.
        let [s, t] = part.map(|[low, high]| (0.5 + 1e-9) * (high - low));
        let rounding = 1e-12 * (jet.du.length() + jet.dv.length());
        let off = [lengths[0] * s + lengths[1] * t + rounding, lengths[1] * s + lengths[2] * t + rounding];
        let along = |normal: Vec3| moved.second(|point| point.dot(normal).abs());
        Some(Bends { lengths, across: Across::new([jet.du, jet.dv], off, along) })
    }
}

/// The net over a part, moved so that the middle of the part is the origin.
struct Moved {
    /// The points, and their derivatives by u, v, uu, uv and vv.
    nets: [Vec<Vec4>; 6],
    least_weight: f64,
}

impl Moved {
    fn new(patch: &RationalPatch, part: [[f64; 2]; 2]) -> Moved {
        let mut cut = patch.points.clone();
        for axis in [0, 1] {
            net::restrict(&mut cut, patch.degrees, axis, part[axis]);
        }
        let middle = Aabb::of(cut.iter().copied().map(projected)).center();
        cut.iter_mut().for_each(|p| *p = (p.truncate() - p.w * middle).extend(p.w));
        let least_weight = cut.iter().fold(f64::INFINITY, |least, p| least.min(p.w));
        let rates = part.map(|[low, high]| 1.0 / (high - low));
        let by = |(points, degrees): &(Vec<Vec4>, Degrees), axis: usize| {
            let (mut points, degrees) = net::derivative(points, *degrees, axis);
            points.iter_mut().for_each(|point| *point *= rates[axis]);
            (points, degrees)
        };
        let plain = (cut, patch.degrees);
        let (u, v) = (by(&plain, 0), by(&plain, 1));
        let (uu, uv, vv) = (by(&u, 0), by(&u, 1), by(&v, 1));
        Moved { nets: [plain.0, u.0, v.0, uu.0, uv.0, vv.0], least_weight }
    }

    /// Bounds of the second derivatives of S in a seminorm. With B = S w the moved net, no point of S is farther from the
    /// origin than a control point; the derivatives of S follow from those of B and w by the quotient rule.
    fn second(&self, measure: impl Fn(Vec3) -> f64) -> [f64; 3] {
        let least = self.least_weight;
        let most = |net: &[Vec4]| net.iter().map(|p| measure(p.truncate())).fold(0.0, f64::max);
        let weight = |net: &[Vec4]| net.iter().map(|p| p.w.abs()).fold(0.0, f64::max);
        let [points, u, v, uu, uv, vv] = &self.nets;
        let radius = points.iter().map(|p| measure(p.truncate() / p.w)).fold(0.0, f64::max);
        let (wu, wv) = (weight(u), weight(v));
        let first = |net: &[Vec4]| (most(net) + weight(net) * radius) / least;
        let (du, dv) = (first(u), first(v));
        let second = |net: &[Vec4], cross: f64| {
            // A cut errs by a few units in the last place of the points it combines, not of what a seminorm leaves of them.
            let size = net.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
            (most(net) + cross + weight(net) * radius) / least * (1.0 + 1e-12) + 1e-13 * size / least
        };
        [second(uu, 2.0 * wu * du), second(uv, wu * dv + wv * du), second(vv, 2.0 * wv * dv)]
    }
}
