//! Arcs of ellipses.

use super::{Bounded, Bounds, Cubic, Curve, CurveError, Jet, check_finite, check_tolerance};
use crate::math::{Affine2, Mat2, Vec2, atan2, cos, hypot, pow, sin, sin_cos, sin_cos_degrees, tan};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::quadrature::{GAUSS_16, integrate};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// An arc of an ellipse: `center + u cos a + v sin a` for angles from `angle` to `angle + sweep`.
///
/// `u` and `v` are any two vectors, so that the image of an arc under an affine map is an arc. All numbers are finite
/// and the sweep is at most a full turn. The ends are kept as given and met exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    center: Vec2,
    axes: [Vec2; 2],
    angle: f64,
    sweep: f64,
    ends: [Vec2; 2],
}

impl Arc {
    /// The arc around `center` from `angle` over `sweep`, in radians; a sweep beyond a full turn is cut to one. A full
    /// turn ends exactly where it starts.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when a number or an end is not finite: index 0 for the centre, 1 and 2 for the axes,
    /// 3 for the angles.
    pub fn new(center: Vec2, axes: [Vec2; 2], angle: f64, sweep: f64) -> Result<Arc, CurveError> {
        check_finite(&[center, axes[0], axes[1], Vec2::new(angle, sweep)])?;
        let sweep = sweep.clamp(-TAU, TAU);
        let mut arc = Arc { center, axes, angle, sweep, ends: [Vec2::ZERO; 2] };
        let start = arc.at(angle);
        arc.ends = [start, if sweep.abs() == TAU { start } else { arc.at(angle + sweep) }];
        check_finite(&arc.ends)?;
        Ok(arc)
    }

    /// The whole ellipse around `center` with half-axes along x and y, from its largest x towards larger y.
    ///
    /// # Errors
    /// As [`Arc::new`].
    pub fn ellipse(center: Vec2, radii: Vec2) -> Result<Arc, CurveError> {
        Arc::new(center, [Vec2::new(radii.x, 0.0), Vec2::new(0.0, radii.y)], 0.0, TAU)
    }

    /// The arc that an SVG path draws (SVG 2, appendix on elliptical arcs): from one point to another along an ellipse
    /// with these radii, turned by `rotation` degrees, the long or the short way, with angles ascending or not. Radii
    /// that are too small are scaled up until the ellipse just reaches; `None` where SVG draws a line or nothing:
    /// for a radius of zero and for equal ends.
    ///
    /// Radii that are half of the distance to within the rounding of the coordinates make exact half turns.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] for the first of `from`, `to`, radii, rotation that is not.
    pub fn from_ends(
        from: Vec2,
        to: Vec2,
        radii: Vec2,
        rotation: f64,
        large: bool,
        ascending: bool,
    ) -> Result<Option<Arc>, CurveError> {
        check_finite(&[from, to, radii, Vec2::new(rotation, 0.0)])?;
        let radii = radii.abs();
        if radii.x == 0.0 || radii.y == 0.0 || from == to {
            return Ok(None);
        }
        let (sine, cosine) = sin_cos_degrees(rotation);
        let turn = Mat2::from_cols(Vec2::new(cosine, sine), Vec2::new(-sine, cosine));
        // Half of the chord where the ellipse is the unit circle.
        let chord = turn.transpose() * (0.5 * to - 0.5 * from);
        let half = Vec2::new(chord.x / radii.x, chord.y / radii.y);
        let reach = hypot(half.x, half.y);
        let size = from.abs().max(to.abs()) / radii;
        let rounding = 4.0 * f64::EPSILON * (1.0 + size.max_element());
        let scale = if reach >= 1.0 - rounding { reach } else { 1.0 };
        let axes = [turn.x_axis * (radii.x * scale), turn.y_axis * (radii.y * scale)];
        let half = half / scale;
        // The centre seen from the middle of the chord, to its left for short ascending arcs.
        let away = if scale == reach { 0.0 } else { ((1.0 - reach) * (1.0 + reach)).sqrt() };
        let left = if large == ascending { -away } else { away };
        let center = Vec2::new(-half.y, half.x) / hypot(half.x, half.y) * left;
        let (first, last) = (-half - center, half - center);
        let angle = atan2(first.y, first.x);
        let turned = atan2(first.perp_dot(last), first.dot(last));
        let sweep = match (away == 0.0, ascending) {
            (true, true) => PI,
            (true, false) => -PI,
            (false, true) if turned < 0.0 => turned + TAU,
            (false, false) if turned > 0.0 => turned - TAU,
            (false, _) => turned,
        };
        let middle = 0.5 * from + 0.5 * to + axes[0] * center.x + axes[1] * center.y;
        check_finite(&[middle, axes[0], axes[1]])?;
        Ok(Some(Arc { center: middle, axes, angle, sweep, ends: [from, to] }))
    }

    /// The middle of the ellipse.
    pub fn center(&self) -> Vec2 {
        self.center
    }

    /// The vectors that stand before the cosine and the sine of the angle.
    pub fn axes(&self) -> [Vec2; 2] {
        self.axes
    }

    /// The angle at the start, in radians.
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// What the angle grows by, in radians.
    pub fn sweep(&self) -> f64 {
        self.sweep
    }

    /// The first point.
    pub fn start(&self) -> Vec2 {
        self.ends[0]
    }

    /// The last point.
    pub fn end(&self) -> Vec2 {
        self.ends[1]
    }

    /// The point at a share of the sweep; exact at 0 and 1.
    pub fn eval(&self, t: f64) -> Vec2 {
        match t {
            0.0 => self.ends[0],
            1.0 => self.ends[1],
            t => self.at(self.angle + t * self.sweep),
        }
    }

    /// Both halves of the arc; they share the point between them.
    pub fn halves(&self) -> (Arc, Arc) {
        let (half, middle) = (0.5 * self.sweep, self.eval(0.5));
        let [start, end] = self.ends;
        let first = Arc { sweep: half, ends: [start, middle], ..*self };
        (first, Arc { angle: self.angle + half, sweep: half, ends: [middle, end], ..*self })
    }

    fn at(&self, angle: f64) -> Vec2 {
        let (sine, cosine) = quarter_exact(angle);
        self.center + (self.axes[0] * cosine + self.axes[1] * sine)
    }

    /// The same arc run backward.
    pub fn reversed(&self) -> Arc {
        let [start, end] = self.ends;
        Arc { angle: self.angle + self.sweep, sweep: -self.sweep, ends: [end, start], ..*self }
    }

    /// The image under an affine map.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when the image exceeds the range of `f64`.
    pub fn map(&self, map: &Affine2) -> Result<Arc, CurveError> {
        let center = map.transform_point2(self.center);
        let axes = self.axes.map(|axis| map.transform_vector2(axis));
        let ends = self.ends.map(|end| map.transform_point2(end));
        check_finite(&[center, axes[0], axes[1], ends[0], ends[1]])?;
        Ok(Arc { center, axes, ends, ..*self })
    }

    /// The half-axes, longer one first, and the angle at which the arc is at the end of the first.
    pub fn half_axes(&self) -> ([Vec2; 2], f64) {
        let [u, v] = self.axes;
        let size = u.abs().max(v.abs()).max_element();
        if size == 0.0 {
            return ([Vec2::ZERO; 2], 0.0);
        }
        let [p, q] = [u / size, v / size];
        let angle = 0.5 * atan2(2.0 * p.dot(q), (p.length() - q.length()) * (p.length() + q.length()));
        let (sine, cosine) = sin_cos(angle);
        ([u * cosine + v * sine, v * cosine - u * sine], angle)
    }

    /// The length of the arc, to about ten units in the last place at every excentricity.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when it exceeds the range of `f64`.
    pub fn length(&self) -> Result<Bounded<f64>, CurveError> {
        let ([long, short], offset) = self.half_axes();
        let (a, b) = (hypot(long.x, long.y), hypot(short.x, short.y));
        if a == 0.0 {
            return Ok(Bounded { value: 0.0, error: 0.0 });
        }
        // From the ends of the short half-axis: the speed is least at odd multiples of a quarter turn.
        let from = self.angle - offset + FRAC_PI_2;
        let turns = (from / PI).round() * PI;
        // The sweep as it is: a difference of angles would have lost the digits of a small one.
        let low = (from - turns).min(from - turns + self.sweep);
        let value = a * Speed { ratio: b / a }.integral(low, self.sweep.abs());
        if !value.is_finite() {
            return Err(CurveError::NotFinite { index: 0 });
        }
        Ok(Bounded { value, error: (16.0 * f64::EPSILON * value).next_up() })
    }

    /// The smallest box around the arc: sides that touch it at the ends of half-axes along x and y, or at its own
    /// ends, are right to the last digit, others are rounded outward.
    pub fn bounding_box(&self) -> Bounds<Vec2> {
        let [start, end] = self.ends;
        let (mut min, mut max) = (start.min(end), start.max(end));
        let [u, v] = self.axes;
        for axis in 0..2 {
            let reach = hypot(u[axis], v[axis]);
            let highest = atan2(v[axis], u[axis]);
            // Along the axes of the ellipse the sides are one sum away, like its points there.
            let exact = u[axis] == 0.0 || v[axis] == 0.0;
            let rounding = if exact { 0.0 } else { 2.0 * f64::EPSILON * (reach + self.center[axis].abs()) };
            if self.passes(highest) {
                max[axis] = max[axis].max(self.center[axis] + reach + rounding);
            }
            if self.passes(highest + PI) {
                min[axis] = min[axis].min(self.center[axis] - reach - rounding);
            }
        }
        Bounds { min, max }
    }

    /// Whether the arc runs over an angle, but for rounding at its ends.
    fn passes(&self, angle: f64) -> bool {
        let from = self.angle.min(self.angle + self.sweep);
        let after = (angle - from) - ((angle - from) / TAU).floor() * TAU;
        after < self.sweep.abs()
    }

    /// Cubics that follow the arc to within the tolerance and meet its ends exactly.
    ///
    /// Each spans the same angle w, at most a quarter turn. With arms of 4/3 tan(w/4) a cubic leaves the unit circle
    /// outward only, and its squared distance from the centre is at most 1 + 4/27 sin^6(w/4) / cos^2(w/4) (Goldapp,
    /// Approximation of circular arcs by cubic polynomials, 1991).
    ///
    /// # Errors
    /// [`CurveError::Tolerance`], [`CurveError::ToleranceTooFine`] below the rounding of the arc's coordinates.
    pub fn cubics(&self, tolerance: f64) -> Result<Vec<Cubic<Vec2>>, CurveError> {
        check_tolerance(tolerance)?;
        let ([long, _], _) = self.half_axes();
        let radius = hypot(long.x, long.y);
        let finest = self.finest();
        if tolerance < finest {
            return Err(CurveError::ToleranceTooFine { value: tolerance, finest });
        }
        // What rounding may add is kept back.
        self.in_parts(self.count((tolerance - 0.5 * finest) / radius))
    }

    /// That many cubics, as [`Arc::cubics`] makes them.
    pub(super) fn in_parts(&self, count: usize) -> Result<Vec<Cubic<Vec2>>, CurveError> {
        let step = self.sweep / count as f64;
        let arm = 4.0 / 3.0 * tan(0.25 * step);
        let corner = |k: usize| match k {
            0 => self.ends[0],
            k if k == count => self.ends[1],
            k => self.at(self.angle + k as f64 * step),
        };
        let velocity = |k: usize| self.velocity(self.angle + k as f64 * step) * arm;
        let cubic = |k: usize| {
            let (from, to) = (corner(k), corner(k + 1));
            Cubic::new([from, from + velocity(k), to - velocity(k + 1), to])
        };
        (0..count).map(cubic).collect()
    }

    /// The finest tolerance that [`Arc::cubics`] takes: rounding of the coordinates.
    pub(super) fn finest(&self) -> f64 {
        let ([long, _], _) = self.half_axes();
        16.0 * f64::EPSILON * (hypot(long.x, long.y) + self.center.abs().max_element())
    }

    /// How many cubics stay within this distance on the unit circle.
    pub(super) fn count(&self, tolerance: f64) -> usize {
        let turn = self.sweep.abs();
        let error = |count: f64| {
            let quarter = 0.25 * turn / count;
            let ratio = pow(sin(quarter), 3.0) / cos(quarter);
            // sqrt(1 + e) - 1 <= e / 2.
            2.0 / 27.0 * ratio * ratio
        };
        let least = (turn / FRAC_PI_2).ceil().max(1.0);
        // The error shrinks with the sixth power of the count.
        let guess = least * pow(error(least) / tolerance, 1.0 / 6.0);
        let mut count = guess.ceil().max(least);
        while error(count) > tolerance {
            count += 1.0;
        }
        count as usize
    }

    fn velocity(&self, angle: f64) -> Vec2 {
        let (sine, cosine) = sin_cos(angle);
        self.axes[1] * cosine - self.axes[0] * sine
    }

    /// Twice the signed area between the chord and the arc.
    pub(super) fn twice_segment_area(&self) -> DoubleDouble {
        let [u, v] = self.axes;
        let cross = DoubleDouble::product(u.x, v.y) - DoubleDouble::product(u.y, v.x);
        cross * beyond_sine(self.sweep)
    }
}

/// Sine and cosine, exact at the multiples of a quarter turn that `f64` comes nearest to.
fn quarter_exact(angle: f64) -> (f64, f64) {
    let quarters = angle / FRAC_PI_2;
    if quarters != quarters.round() || quarters.abs() > 8.0 {
        return sin_cos(angle);
    }
    [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarters.rem_euclid(4.0) as usize]
}

/// `x - sin x`; exactly `x` at half and full turns.
fn beyond_sine(x: f64) -> f64 {
    if x.abs() == PI || x.abs() == TAU {
        return x;
    }
    if x.abs() > 0.5 {
        return x - sin(x);
    }
    // Terms of the series of the sine from the third power on, in nested form; the next one is below rounding.
    let square = x * x;
    let factors = [6.0, 20.0, 42.0, 72.0, 110.0, 156.0, 210.0];
    let nested = factors[1..].iter().rev().fold(1.0, |inner, factor| 1.0 - square / factor * inner);
    x * square / factors[0] * nested
}

impl Curve for Arc {
    type Point = Vec2;

    fn domain(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn jet(&self, t: f64) -> Jet<Vec2> {
        let angle = self.angle + t * self.sweep;
        let first = self.velocity(angle);
        let (sine, cosine) = sin_cos(angle);
        let second = self.axes[0] * -cosine + self.axes[1] * -sine;
        let w = self.sweep;
        Jet { point: self.eval(t), first: first * w, second: second * (w * w), third: first * -(w * w * w) }
    }
}

/// The speed on an ellipse with half-axes 1 and `ratio`.
struct Speed {
    ratio: f64,
}

impl Speed {
    fn at(&self, angle: f64) -> f64 {
        let (sine, cosine) = sin_cos(angle);
        hypot(cosine, self.ratio * sine)
    }

    /// The length over angles from `low` on.
    ///
    /// The square of the speed vanishes at odd quarter turns plus i artanh(ratio). On an interval whose half-width is
    /// at most half of the distance to the next such place, the function is analytic in an ellipse of parameter
    /// rho >= 2 + sqrt 3, where 16 nodes err by less than rounding; other intervals are halved.
    fn integral(&self, low: f64, width: f64) -> f64 {
        let half = 0.5 * width;
        let middle = low + half;
        let nearest = ((middle - FRAC_PI_2) / PI).round() * PI + FRAC_PI_2;
        let distance = hypot(middle - nearest, self.ratio);
        // Between neighbouring angles nothing is left to resolve.
        if half <= 0.5 * distance || middle <= low || middle >= low + width {
            return width * integrate(GAUSS_16, 0.0, 1.0, |share| self.at(low + share * width));
        }
        self.integral(low, half) + self.integral(middle, half)
    }
}
