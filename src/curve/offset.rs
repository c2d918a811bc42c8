//! Parallel curves.

use super::bernstein::{inner_product, product_with, sign_changes};
use super::fit::{Fitted, Ray, SHARE, Side, Source};
use super::frame::{ROUNDING, UnitFrame};
use super::pen::{Join, Pen, check_join};
use super::strand::Strand;
use super::subdivide::{derivative, restrict};
use super::{Bernstein, Cubic, CurveError, Path};
use crate::math::Vec2;
use crate::numeric::roots::bracketed;

/// The parallel of a path at a distance to its left (to its right where the distance is negative), within `tolerance`,
/// both in model units.
///
/// It has no gaps. Where the radius of curvature is smaller than the distance the parallel runs backward; it turns in
/// cusps, which are found and kept as joints. At corners, and where a piece itself turns back, the outer side is
/// bridged by `join` (in the middle of a piece always by an arc) and the inner side goes through the corner. So the
/// result crosses itself where the parallel does; what it goes around is a matter of winding: see
/// [`crate::curve::stroke`] for the region near to a path. Subpaths that are a point have no parallel.
///
/// The error is a bound in the sense of Fréchet: both curves can be walked from end to end, never back, so that the
/// walkers are never farther apart. (Where a piece turns so fast that its direction is lost in rounding, what is meant
/// is the parallel of a piece with a corner there.) Pieces are nearly as few as possible: [`super::fit`].
///
/// ```
/// use ogee::curve::{Arc, Join, Path, Subpath, offset};
/// use ogee::math::Vec2;
///
/// let circle = Subpath::closed(vec![Arc::ellipse(Vec2::ZERO, Vec2::ONE)?.into()])?;
/// let inner = offset(&Path { subpaths: vec![circle] }, 0.25, Join::Round, 1e-6)?;
/// for piece in inner.curve.pieces() {
///     assert!((piece.eval(0.3).length() - 0.75).abs() <= inner.error);
/// }
/// # Ok::<(), ogee::curve::CurveError>(())
/// ```
///
/// # Errors
/// [`CurveError::Tolerance`], [`CurveError::ToleranceTooFine`] below the rounding of the coordinates (and for arcs of
/// ellipses too flat to have a direction), [`CurveError::Distance`], [`CurveError::Parameter`] for a miter limit below
/// 1, [`CurveError::NotFinite`] when the result exceeds the range of `f64`.
pub fn offset(path: &Path, distance: f64, join: Join, tolerance: f64) -> Result<Fitted<Path>, CurveError> {
    super::check_tolerance(tolerance)?;
    check_join(join)?;
    if !distance.is_finite() {
        return Err(CurveError::Distance { value: distance });
    }
    let Some(bounds) = path.bounding_box() else {
        return Ok(Fitted { curve: Path::default(), error: 0.0 });
    };
    let frame = UnitFrame::around(&bounds, distance)?;
    let mut pen = Pen::new(frame.length_inward(distance), join, frame.tolerance(tolerance)?);
    let mut parallel = Path::default();
    for subpath in &path.subpaths {
        pen.beside(&Strand::new(subpath, &frame, SHARE * tolerance, distance)?);
        parallel.subpaths.extend(pen.lift(&frame, subpath.is_closed())?);
    }
    Ok(Fitted { curve: parallel, error: frame.error_outward(pen.error(), tolerance) })
}

/// The parallel of a cubic at a distance to its left, between two of its cusps.
///
/// The cubic stands still at most at its ends. With S' = w D, w = 1, t, 1 - t or t (1 - t) and D without a zero there,
/// the direction of D is the direction of the cubic everywhere.
pub(super) struct Parallel {
    points: [Vec2; 4],
    /// Unit tangents at the ends, shared with the neighbours.
    tangents: [Vec2; 2],
    /// The derivative.
    velocity: [Vec2; 3],
    distance: f64,
    /// 1 where the parallel runs with the cubic, -1 where it runs against it.
    sense: f64,
}

impl Parallel {
    pub(super) fn new(points: [Vec2; 4], tangents: [Vec2; 2], distance: f64) -> Parallel {
        let velocity = [0, 1, 2].map(|i| (points[i + 1] - points[i]) * 3.0);
        Parallel { points, tangents, velocity, distance, sense: 1.0 }
    }

    /// The same between two parameters without a cusp in between.
    pub(super) fn between(&self, from: f64, to: f64) -> Parallel {
        let sense = if self.pace(0.5 * from + 0.5 * to) < 0.0 { -1.0 } else { 1.0 };
        Parallel { sense, ..*self }
    }

    /// Control points of the cubic.
    pub(super) fn points(&self) -> &[Vec2; 4] {
        &self.points
    }

    /// Control values of its derivative.
    pub(super) fn velocity(&self) -> &[Vec2; 3] {
        &self.velocity
    }

    /// To the left.
    pub(super) fn distance(&self) -> f64 {
        self.distance
    }

    /// Control values of w and D.
    pub(super) fn direction(&self) -> ([f64; 3], [Vec2; 3]) {
        without_zeros(&self.velocity)
    }

    /// Whether the parallel runs against the cubic.
    pub(super) fn is_folded(&self) -> bool {
        self.sense < 0.0
    }

    /// A bound of the length of the cubic between two parameters.
    pub(super) fn length_bound(&self, from: f64, to: f64) -> f64 {
        let mut velocity = self.velocity;
        restrict(&mut velocity, from, to);
        (to - from) * velocity.iter().fold(0.0, |most: f64, v| most.max(v.length()))
    }

    /// The unit tangent of the cubic.
    pub(super) fn tangent(&self, t: f64) -> Vec2 {
        match t {
            0.0 => self.tangents[0],
            1.0 => self.tangents[1],
            t => velocity_at(&self.velocity, t).try_normalize().unwrap_or(self.tangents[0]),
        }
    }

    /// Unit tangents from one parameter to another, as many as it takes that between two neighbours the cubic turns
    /// one way and by less than a right angle, as far as rounding can tell.
    pub(super) fn directions(&self, from: f64, to: f64) -> Vec<Vec2> {
        let inflections = Cubic::assume(self.points).inflections();
        let inner = inflections.iter().copied().filter(|&t| from < t && t < to);
        let (mut directions, mut at) = (vec![self.tangent(from)], from);
        for stop in inner.chain([to]) {
            self.turn_towards(at, stop, &mut directions);
            at = stop;
        }
        directions
    }

    fn turn_towards(&self, from: f64, to: f64, directions: &mut Vec<Vec2>) {
        let (_, _, [a, b, c]) = self.part(from, to);
        let is_narrow = a.dot(b) > 0.0 && b.dot(c) > 0.0 && a.dot(c) > 0.0;
        let middle = 0.5 * from + 0.5 * to;
        if is_narrow || to - from <= NARROW {
            directions.push(self.tangent(to));
        } else {
            self.turn_towards(from, middle, directions);
            self.turn_towards(middle, to, directions);
        }
    }

    /// The point of the cubic.
    pub(super) fn center(&self, t: f64) -> Vec2 {
        match t {
            0.0 => self.points[0],
            1.0 => self.points[3],
            t => Cubic::assume(self.points).eval(t),
        }
    }

    /// The derivative of the parallel along the cubic's tangent: the speed times `1 - distance * curvature`.
    fn pace(&self, t: f64) -> f64 {
        let first = velocity_at(&self.velocity, t);
        let [u, v, w] = self.velocity;
        let second = ((v - u) * (1.0 - t) + (w - v) * t) * 2.0;
        let square = first.length_squared();
        if square > 0.0 {
            return square.sqrt() - self.distance * first.perp_dot(second) / square;
        }
        // At rest: the direction turns as that of S'' + S''' dt / 2 does.
        let third = (u - v * 2.0 + w) * 2.0;
        let square = second.length_squared();
        if square > 0.0 { -self.distance * second.perp_dot(third) / (2.0 * square) } else { 0.0 }
    }

    /// Where the parallel turns back, ascending and within (0, 1): where the radius of curvature is the distance.
    pub(super) fn cusps(&self) -> Vec<f64> {
        let mut found = Vec::new();
        self.cusps_between(0.0, 1.0, &mut found);
        // Neighbouring parts in which nothing can be told are one.
        found.dedup_by(|b, a| {
            b[0] == a[1] && {
                a[1] = b[1];
                true
            }
        });
        let cusps = found.into_iter().map(|[low, high]| bracketed(|t| self.pace(t), low, high));
        cusps.filter(|&t| t > 0.0 && t < 1.0).collect()
    }

    /// Isolates the zeros of w |D|^3 - d D x D' by its square with the other sign in the middle: Bernstein coefficients
    /// of degree 16, computed anew on each part from the derivative there, so that they are right also where that is
    /// small.
    fn cusps_between(&self, from: f64, to: f64, found: &mut Vec<[f64; 2]>) {
        let (_, factor, direction) = self.part(from, to);
        let scale = self.distance / (to - from);
        let turn = product_with(&direction, &derivative(&direction, 1), |a, b| a.perp_dot(b) * scale);
        if turn.iter().all(|&c| c <= 0.0) {
            return;
        }
        let times = |a: &[f64], b: &[f64]| product_with(a, b, |x, y| x * y);
        let square = inner_product(&direction, &direction);
        let speeds = times(&times(&times(&square, &square), &square), &times(&factor, &factor));
        let turns = times(&times(&turn, &turn), &[1.0; 11]);
        let misfit: Vec<f64> = speeds.iter().zip(&turns).map(|(a, b)| a - b).collect();
        let size = speeds.iter().chain(&turns).fold(0.0, |most: f64, c| most.max(c.abs()));
        let error = 64.0 * f64::EPSILON * size;
        if misfit.iter().all(|&c| c > error) || misfit.iter().all(|&c| c < -error) {
            return;
        }
        let is_sure = [misfit[0], misfit[16]].iter().all(|c| c.abs() > error);
        if is_sure && turn.iter().all(|&c| c > 0.0) && sign_changes(&misfit) == 1 {
            let cusp = bracketed(|t| self.pace(t), from, to);
            return found.push([cusp; 2]);
        }
        let is_point = to - from <= NARROW || self.length_bound(from, to) <= ROUNDING;
        if is_point || misfit.iter().all(|c| c.abs() <= 16.0 * error) {
            return found.push([from, to]);
        }
        let middle = 0.5 * from + 0.5 * to;
        self.cusps_between(from, middle, found);
        self.cusps_between(middle, to, found);
    }
}

/// Parts of a cubic narrower than this are not cut further in search of cusps.
const NARROW: f64 = 1.0 / (1_u64 << 40) as f64;

impl Source for Parallel {
    fn domain(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn ray(&self, t: f64, _: Side) -> Ray {
        let tangent = self.tangent(t);
        let point = self.center(t) + tangent.perp() * self.distance;
        Ray { point, tangent: tangent * self.sense, speed: self.pace(t) * self.sense }
    }

    /// Let V be the cubic less the base curve at the same parameter and T the direction of the base. V should be the
    /// distance times the normal. Along T it has V . T / |T|; the rest of it has the square |V|^2 less that one's, and
    /// the right sign where T x V has. All of these are polynomials whose control values bound them.
    fn deviation(&self, from: f64, to: f64, cubic: &Cubic<Vec2>) -> f64 {
        let (mut part, mut velocity) = (self.points, self.velocity);
        restrict(&mut part, from, to);
        restrict(&mut velocity, from, to);
        let (_, direction) = without_zeros(&velocity);
        let offset: [Vec2; 4] = std::array::from_fn(|i| cubic.points()[i] - part[i]);
        let far = self.distance.abs();
        // However the normals turn.
        let plain = far + offset.iter().fold(0.0, |most: f64, v| most.max(v.length()));
        let middle = direction[0] + direction[1] * 2.0 + direction[2];
        let slowest = direction.iter().map(|t| t.dot(middle)).fold(f64::INFINITY, f64::min) / middle.length();
        let sided = product(&direction, &offset, Vec2::perp_dot);
        if slowest.is_nan() || slowest <= 0.0 || far == 0.0 || sided.iter().any(|c| c * self.distance <= 0.0)
        {
            return plain;
        }
        let along = product(&direction, &offset, Vec2::dot);
        let along = along.iter().fold(0.0, |most: f64, c| most.max(c.abs())) / slowest;
        let squares = square(&offset);
        let excess = squares.iter().fold(0.0, |most: f64, c| most.max((c - far * far).abs()));
        let across = (excess + along * along) / far;
        plain.min((along * along + across * across).sqrt())
    }
}

/// C(2, i) C(3, j) / C(5, i + j).
const BY_2_3: [[f64; 4]; 3] = [[1.0, 0.6, 0.3, 0.1], [0.4, 0.6, 0.6, 0.4], [0.1, 0.3, 0.6, 1.0]];

fn product(a: &[Vec2; 3], b: &[Vec2; 4], times: impl Fn(Vec2, Vec2) -> f64) -> [f64; 6] {
    let mut product = [0.0; 6];
    for i in 0..3 {
        for j in 0..4 {
            product[i + j] += BY_2_3[i][j] * times(a[i], b[j]);
        }
    }
    product
}

/// The square of the norm, of degree 6.
fn square([a, b, c, d]: &[Vec2; 4]) -> [f64; 7] {
    [
        a.dot(*a),
        a.dot(*b),
        0.4 * a.dot(*c) + 0.6 * b.dot(*b),
        0.1 * a.dot(*d) + 0.9 * b.dot(*c),
        0.4 * b.dot(*d) + 0.6 * c.dot(*c),
        c.dot(*d),
        d.dot(*d),
    ]
}

fn velocity_at([u, v, w]: &[Vec2; 3], t: f64) -> Vec2 {
    let s = 1.0 - t;
    *u * (s * s) + *v * (2.0 * s * t) + *w * (t * t)
}

/// A derivative of degree 2 as a polynomial with zeros at the ends only, where it has any, times one without: control
/// values of both, of degree 2.
pub(super) fn without_zeros(velocity: &[Vec2; 3]) -> ([f64; 3], [Vec2; 3]) {
    let [u, v, w] = *velocity;
    let linear = |p: Vec2, q: Vec2| [p, (p + q) * 0.5, q];
    let is_zero = |p: Vec2| p == Vec2::ZERO;
    match (is_zero(u), is_zero(v), is_zero(w)) {
        (true, true, _) => ([0.0, 0.0, 1.0], [w; 3]),
        (_, true, true) => ([1.0, 0.0, 0.0], [u; 3]),
        (true, false, true) => ([0.0, 0.5, 0.0], [v * 2.0; 3]),
        (true, false, false) => ([0.0, 0.5, 1.0], linear(v * 2.0, w)),
        (false, false, true) => ([1.0, 0.5, 0.0], linear(u, v * 2.0)),
        _ => ([1.0; 3], *velocity),
    }
}
