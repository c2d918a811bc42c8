use super::net::{self, Degrees};
use super::{Across, Bends, Jet, Side, Surface, SurfaceError, grid, limit};
use crate::curve::evaluate::de_casteljau;
use crate::curve::{AnyBezier, bounding_box};
use crate::math::{Aabb, Vec3, Vec4};

/// Highest degree in each parameter: the powers and binomials of normals and squared distances stay in range.
pub(super) const MOST_DEGREE: usize = 200;
/// Above this, differences of points may overflow.
const HUGE: f64 = 0.25 * f64::MAX;

/// A tensor-product Bézier patch over the unit square. All its points are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    points: Vec<Vec3>,
    degrees: Degrees,
}

impl Patch {
    /// The patch with these degrees in u and in v. Point (i, j), i counting along u, is `points[i * (n + 1) + j]` with n
    /// the degree in v.
    ///
    /// # Errors
    /// [`SurfaceError::Count`] when there are not `(m + 1) (n + 1)` points, [`SurfaceError::NotFinite`],
    /// [`SurfaceError::Degree`] above 200.
    pub fn new(degrees: [usize; 2], points: Vec<Vec3>) -> Result<Patch, SurfaceError> {
        check_degrees(degrees)?;
        let expected = (degrees[0] + 1) * (degrees[1] + 1);
        if points.len() != expected {
            return Err(SurfaceError::Count { actual: points.len(), expected });
        }
        match points.iter().position(|point| !point.is_finite()) {
            Some(index) => Err(SurfaceError::NotFinite { index }),
            None => Ok(Patch { points, degrees }),
        }
    }

    /// The bicubic patch with these points, u counting the rows.
    ///
    /// # Errors
    /// [`SurfaceError::NotFinite`].
    pub fn bicubic(points: [[Vec3; 4]; 4]) -> Result<Patch, SurfaceError> {
        Patch::new([3, 3], points.into_iter().flatten().collect())
    }

    /// The control points, see [`Patch::new`].
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Degrees in u and in v.
    pub fn degrees(&self) -> [usize; 2] {
        self.degrees
    }

    /// The point at parameters, by de Casteljau: errs by about 3 (m + n) u of the control points around it, and is exact
    /// in the corners. Parameters beyond the unit square prolong the patch.
    pub fn eval(&self, u: f64, v: f64) -> Vec3 {
        if net::size(&self.points) > HUGE {
            return 4.0 * self.quartered().eval(u, v);
        }
        net::eval(&self.points, self.degrees, u, v)
    }

    /// The point by the sum of Bernstein polynomials: another road to the same, within the same error.
    pub fn eval_bernstein(&self, u: f64, v: f64) -> Vec3 {
        net::bernstein(&self.points, self.degrees, u, v)
    }

    fn quartered(&self) -> Patch {
        Patch { points: self.points.iter().map(|&point| 0.25 * point).collect(), degrees: self.degrees }
    }

    /// The derivative of some order in u and in v as a patch of vectors; zero beyond the degrees.
    ///
    /// # Errors
    /// [`SurfaceError::NotFinite`] when a difference exceeds the range of `f64`.
    pub fn derivative(&self, by_u: usize, by_v: usize) -> Result<Patch, SurfaceError> {
        let (mut points, mut degrees) = (self.points.clone(), self.degrees);
        for axis in std::iter::repeat_n(0, by_u).chain(std::iter::repeat_n(1, by_v)) {
            (points, degrees) = net::derivative(&points, degrees, axis);
        }
        Patch::new(degrees, points)
    }

    /// Both parts at a parameter of u (axis 0) or v (axis 1), each over the unit square; they share their common border.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] when `t` is not within [0, 1].
    pub fn split(&self, axis: usize, t: f64) -> Result<[Patch; 2], SurfaceError> {
        if !(0.0..=1.0).contains(&t) {
            return Err(SurfaceError::Parameter { value: t });
        }
        let part = |range: [f64; 2]| {
            let mut points =
                if net::size(&self.points) > HUGE { self.quartered().points } else { self.points.clone() };
            if range[0] == range[1] {
                net::flatten_onto(&mut points, self.degrees, axis, t);
            } else {
                net::restrict(&mut points, self.degrees, axis, range);
            }
            let back = if net::size(&self.points) > HUGE { 4.0 } else { 1.0 };
            points.iter_mut().for_each(|point| *point *= back);
            Patch { points, degrees: self.degrees }
        };
        let (low, mut high) = (part([0.0, t]), part([t, 1.0]));
        net::share_border(&low.points, &mut high.points, self.degrees, axis);
        Ok([low, high])
    }

    /// The part over ranges of u and v, over the unit square.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] when a range is not ascending within [0, 1].
    pub fn part(&self, ranges: [[f64; 2]; 2]) -> Result<Patch, SurfaceError> {
        Ok(Patch { points: net::part(&self.points, self.degrees, ranges)?, degrees: self.degrees })
    }

    /// The same patch written with degrees higher by these numbers.
    ///
    /// # Errors
    /// [`SurfaceError::Degree`] above 200.
    pub fn elevated(&self, by: [usize; 2]) -> Result<Patch, SurfaceError> {
        let (points, degrees) = net::elevated_by(&self.points, self.degrees, by)?;
        Ok(Patch { points, degrees })
    }

    /// The same surface with u and v exchanged: the other side is outside.
    pub fn transposed(&self) -> Patch {
        let points = net::transposed(&self.points, self.degrees);
        Patch { points, degrees: [self.degrees[1], self.degrees[0]] }
    }

    /// The patch with `f` applied to its points; for affine `f` the image of the surface.
    ///
    /// # Errors
    /// [`SurfaceError::NotFinite`].
    pub fn map(&self, f: impl FnMut(Vec3) -> Vec3) -> Result<Patch, SurfaceError> {
        Patch::new(self.degrees, self.points.iter().copied().map(f).collect())
    }

    /// The curve of fixed u (axis 0) or v (axis 1).
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] when `t` is not finite, [`SurfaceError::Curve`] when the curve exceeds the range of
    /// `f64` beyond the domain.
    pub fn iso_curve(&self, axis: usize, t: f64) -> Result<AnyBezier<Vec3>, SurfaceError> {
        if !t.is_finite() {
            return Err(SurfaceError::Parameter { value: t });
        }
        // Lines along the fixed parameter, each of which gives a point of the curve.
        let (lines, length) = match axis {
            0 => (net::transposed(&self.points, self.degrees), self.degrees[0] + 1),
            _ => (self.points.clone(), self.degrees[1] + 1),
        };
        let points = lines.chunks_exact(length).map(|line| de_casteljau(line, t));
        Ok(AnyBezier::new(points.collect())?)
    }

    /// A border curve, exactly.
    pub fn border(&self, side: Side) -> AnyBezier<Vec3> {
        AnyBezier::new(net::border(&self.points, self.degrees, side as usize)).expect("points are finite")
    }

    /// The box of the control points, which holds the patch.
    pub fn hull_box(&self) -> Aabb {
        Aabb::of(self.points.iter().copied())
    }

    /// A box around the patch that no other box within it undercuts by more than `tolerance` on any side: parts are
    /// split until their control points tell.
    ///
    /// # Errors
    /// [`SurfaceError::Number`] for a tolerance that is not positive.
    pub fn bounding_box(&self, tolerance: f64) -> Result<Aabb, SurfaceError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(SurfaceError::Number { name: "tolerance", value: tolerance });
        }
        let borders = Side::ALL.into_iter().map(|side| {
            let bounds = bounding_box(&self.border(side));
            Aabb { min: bounds.min, max: bounds.max }
        });
        let mut sure = borders.fold(Aabb::EMPTY, Aabb::union);
        // Points no finer than rounding can be told apart.
        let tolerance = Vec3::splat(tolerance.max(64.0 * f64::EPSILON * net::size(&self.points)));
        let mut outer = sure;
        let mut pending = vec![self.clone()];
        while let Some(part) = pending.pop() {
            let hull = part.hull_box();
            let inside =
                (outer.min - tolerance).cmple(hull.min).all() && hull.max.cmple(outer.max + tolerance).all();
            if inside {
                sure = sure.union(hull);
                continue;
            }
            outer = outer.including(part.eval(0.5, 0.5));
            for axis in [0, 1] {
                outer = outer.including(part.eval([0.5, 0.0][axis], [0.0, 0.5][axis]));
            }
            for half in part.split(0, 0.5)? {
                pending.extend(half.split(1, 0.5)?);
            }
        }
        Ok(sure)
    }

    /// Points and unit normals on a grid of parameters, those of v running fastest: the fast way to many. Within a few
    /// units in the last place of [`Patch::eval`] up to degree 3; limit normals where there is no other, and zero where
    /// there is no limit.
    pub fn grid(&self, us: &[f64], vs: &[f64]) -> (Vec<Vec3>, Vec<Vec3>) {
        grid::evaluate(self, us, vs)
    }
}

pub(crate) fn check_degrees(degrees: [usize; 2]) -> Result<(), SurfaceError> {
    let actual = degrees[0].max(degrees[1]);
    if actual <= MOST_DEGREE { Ok(()) } else { Err(SurfaceError::Degree { actual, most: MOST_DEGREE }) }
}

impl Surface for Patch {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0]; 2]
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        self.eval(u, v)
    }

    fn points(&self, parameters: &[[f64; 2]], out: &mut [Vec3]) {
        assert_eq!(parameters.len(), out.len(), "a place for each point");
        grid::scattered(self, parameters, out);
    }

    fn tangents(&self, parameters: &[[f64; 2]], out: &mut [[Vec3; 3]]) {
        assert_eq!(parameters.len(), out.len(), "a place for each point");
        grid::scattered_tangents(self, parameters, out);
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let [point, du, dv, duu, duv, dvv] = net::jet(&self.points, self.degrees, u, v);
        Jet { point, du, dv, duu, duv, dvv }
    }

    fn normal(&self, u: f64, v: f64) -> Option<Vec3> {
        limit::of_net(&net::of_unit_size(&self.points), self.degrees, u, v)
    }

    fn border_net(&self, side: Side) -> Option<Vec<Vec4>> {
        let border = net::border(&self.points, self.degrees, side as usize);
        Some(border.into_iter().map(|point| point.extend(1.0)).collect())
    }

    /// The largest length in the control nets of the second derivatives, cut to the part.
    fn second_bounds(&self, part: [[f64; 2]; 2]) -> Option<[f64; 3]> {
        let nets = Nets::of(&self.points, self.degrees);
        Some(nets.cut(0, part[0]).cut(1, part[1]).largest(Vec3::length))
    }

    fn bends(&self, part: [[f64; 2]; 2]) -> Option<Bends> {
        let nets = Nets::of(&self.points, self.degrees);
        Some(nets.cut(0, part[0]).cut(1, part[1]).bends())
    }

    fn bends_table(&self, cells: [usize; 2]) -> Option<Vec<Bends>> {
        let nets = Nets::of(&self.points, self.degrees);
        let range = |k: usize, count: usize| [k as f64 / count as f64, (k + 1) as f64 / count as f64];
        let strips = (0..cells[0]).map(|i| nets.cut(0, range(i, cells[0])));
        let cell = |strip: Nets| (0..cells[1]).map(move |j| strip.cut(1, range(j, cells[1])).bends());
        Some(strips.flat_map(cell).collect())
    }
}

/// Control nets of the derivatives by u and v, and by uu, uv and vv.
struct Nets {
    first: [(Vec<Vec3>, Degrees); 2],
    second: [(Vec<Vec3>, Degrees); 3],
}

impl Nets {
    fn of(points: &[Vec3], degrees: Degrees) -> Nets {
        let first = [0, 1].map(|axis| net::derivative(points, degrees, axis));
        let again = |k: usize, axis: usize| net::derivative(&first[k].0, first[k].1, axis);
        let second = [again(0, 0), again(0, 1), again(1, 1)];
        Nets { first, second }
    }

    fn cut(&self, axis: usize, range: [f64; 2]) -> Nets {
        let cut = |(points, degrees): &(Vec<Vec3>, Degrees)| {
            let mut points = points.clone();
            net::restrict(&mut points, *degrees, axis, range);
            (points, *degrees)
        };
        Nets { first: self.first.each_ref().map(cut), second: self.second.each_ref().map(cut) }
    }

    /// The largest of a measure of the points of each second derivative, rounded up: each cut errs by a few units in the
    /// last place of the points it combines.
    fn largest(&self, measure: impl Fn(Vec3) -> f64) -> [f64; 3] {
        self.second.each_ref().map(|(points, degrees)| {
            let rounding = 32.0 * (degrees[0] + degrees[1] + 2) as f64 * f64::EPSILON;
            let most = points.iter().map(|&point| measure(point)).fold(0.0, f64::max);
            most + rounding * net::largest(points)
        })
    }

    fn bends(&self) -> Bends {
        let near = self.first.each_ref().map(|(points, _)| points.iter().sum::<Vec3>() / points.len() as f64);
        let off = [0, 1].map(|k: usize| {
            let most = self.first[k].0.iter().map(|&point| (point - near[k]).length()).fold(0.0, f64::max);
            most + 1e-13 * net::largest(&self.first[k].0)
        });
        let along = |normal: Vec3| self.largest(|point| point.dot(normal).abs());
        Bends { lengths: self.largest(Vec3::length), across: Across::new(near, off, along) }
    }
}
