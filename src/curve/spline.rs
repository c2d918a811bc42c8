use super::bounds::Bounds;
use super::differential::{Curve, Jet};
use super::{Bernstein, Cubic, CurveError, bounding_box, check_finite};
use crate::math::Blend;

/// Cubic Bézier pieces end to end: neighbours share one point. All points are finite, knots ascend.
///
/// Piece i runs from knot i to knot i + 1 and has the points 3i to 3i + 3; a closed spline ends at its first point.
/// The joints need not be smooth: see [`Spline::joint`].
#[derive(Clone, Debug, PartialEq)]
pub struct Spline<P> {
    points: Vec<P>,
    knots: Vec<f64>,
    closed: bool,
}

/// How two pieces meet at a joint: what their derivatives are there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint<P> {
    /// First derivatives before and after.
    pub first: [P; 2],
    /// Second derivatives before and after.
    pub second: [P; 2],
}

/// Kinds of smoothness of a joint; C of the derivatives by the parameter, G of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuity {
    /// Equal first derivatives.
    C1,
    /// Equal first and second derivatives.
    C2,
    /// Equal tangents.
    G1,
    /// Equal tangents and curvatures.
    G2,
}

impl<P: Blend> Joint<P> {
    /// How far the joint is from a kind of smoothness, relative to the larger of the derivatives (or curvatures) that
    /// should agree: 0 where it holds exactly, 1 where one of two vanishes, 2 at a full turn.
    pub fn misfit(&self, kind: Continuity) -> f64 {
        let [a, b] = self.first;
        let [c, d] = self.second;
        match kind {
            Continuity::C1 => relative(a, b),
            Continuity::C2 => relative(a, b).max(relative(c, d)),
            Continuity::G1 => (unit(a) - unit(b)).norm(),
            Continuity::G2 => {
                (unit(a) - unit(b)).norm().max(relative(curvature_vector(a, c), curvature_vector(b, d)))
            }
        }
    }
}

fn relative<P: Blend>(a: P, b: P) -> f64 {
    let size = a.norm().max(b.norm());
    if size == 0.0 { 0.0 } else { (a - b).map(|x| x / size).norm() }
}

fn unit<P: Blend>(v: P) -> P {
    let size = v.norm();
    if size == 0.0 { P::ZERO } else { v.map(|x| x / size) }
}

/// The second derivative by arc length: curvature times normal; zero where the curve stands still.
fn curvature_vector<P: Blend>(first: P, second: P) -> P {
    let square = first.inner(first);
    if square == 0.0 { P::ZERO } else { across(second, unit(first)).map(|x| x / square) }
}

/// The part of `v` at a right angle to a unit vector.
fn across<P: Blend>(v: P, tangent: P) -> P {
    v - tangent * v.inner(tangent)
}

impl<P: Blend> Spline<P> {
    /// The open spline with three points a piece and one more, over these knots.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] below four points, [`CurveError::Count`] when points do not make whole pieces or
    /// knots are not one more than pieces, [`CurveError::Knot`] and [`CurveError::NotFinite`] for wrong numbers.
    pub fn open(points: Vec<P>, knots: Vec<f64>) -> Result<Spline<P>, CurveError> {
        if points.len() < 4 {
            return Err(CurveError::TooFewPoints { actual: points.len(), least: 4 });
        }
        let pieces = (points.len() - 1).div_ceil(3);
        Spline::checked(points, 3 * pieces + 1, knots, false)
    }

    /// The closed spline with three points a piece, over these knots.
    ///
    /// # Errors
    /// As [`Spline::open`], with at least three points.
    pub fn closed(points: Vec<P>, knots: Vec<f64>) -> Result<Spline<P>, CurveError> {
        if points.len() < 3 {
            return Err(CurveError::TooFewPoints { actual: points.len(), least: 3 });
        }
        let pieces = points.len().div_ceil(3);
        Spline::checked(points, 3 * pieces, knots, true)
    }

    fn checked(
        points: Vec<P>,
        expected: usize,
        knots: Vec<f64>,
        closed: bool,
    ) -> Result<Spline<P>, CurveError> {
        if points.len() != expected {
            return Err(CurveError::Count { actual: points.len(), expected });
        }
        if knots.len() != expected / 3 + 1 {
            return Err(CurveError::Count { actual: knots.len(), expected: expected / 3 + 1 });
        }
        check_knots(&knots)?;
        check_finite(&points)?;
        Ok(Spline { points, knots, closed })
    }

    /// The open spline of these pieces with knots 0, 1, 2 and so on.
    ///
    /// # Errors
    /// [`CurveError::Gap`] when a piece does not start exactly where the one before it ends,
    /// [`CurveError::TooFewPoints`] for no piece.
    pub fn from_pieces(pieces: &[Cubic<P>]) -> Result<Spline<P>, CurveError> {
        let Some(first) = pieces.first() else {
            return Err(CurveError::TooFewPoints { actual: 0, least: 4 });
        };
        if let Some(gap) = pieces.windows(2).position(|pair| pair[0].end() != pair[1].start()) {
            return Err(CurveError::Gap { piece: gap + 1 });
        }
        let mut points = vec![first.start()];
        points.extend(pieces.iter().flat_map(|piece| piece.points()[1..].to_vec()));
        Spline::open(points, uniform_knots(pieces.len()))
    }

    /// The same curve as a closed one.
    ///
    /// # Errors
    /// [`CurveError::Open`] when the last point is not exactly the first.
    pub fn into_closed(mut self) -> Result<Spline<P>, CurveError> {
        if !self.closed {
            if self.points[0] != self.points[self.points.len() - 1] {
                return Err(CurveError::Open);
            }
            self.points.pop();
            self.closed = true;
        }
        Ok(self)
    }

    /// All control points, each once.
    pub fn points(&self) -> &[P] {
        &self.points
    }

    /// Parameters of the joints and ends, ascending, one more than pieces.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Whether the last piece ends at the first point.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The pieces, each over [0, 1].
    pub fn pieces(&self) -> impl ExactSizeIterator<Item = Cubic<P>> + '_ {
        (0..self.knots.len() - 1).map(|index| self.piece(index))
    }

    /// One piece, over [0, 1].
    ///
    /// # Panics
    /// When there is no such piece.
    pub fn piece(&self, index: usize) -> Cubic<P> {
        let count = self.points.len();
        Cubic::assume([0, 1, 2, 3].map(|k| self.points[(3 * index + k) % count]))
    }

    /// The piece that a parameter falls into, and its own parameter there; beyond the ends that of the end.
    pub fn locate(&self, t: f64) -> (usize, f64) {
        let last = self.knots.len() - 2;
        let index = self.knots.partition_point(|&knot| knot <= t).saturating_sub(1).min(last);
        let (low, high) = (self.knots[index], self.knots[index + 1]);
        // Halves, since knots may be as far apart as f64 allows.
        let local = (0.5 * t - 0.5 * low) / (0.5 * high - 0.5 * low);
        (index, local.clamp(0.0, 1.0))
    }

    /// The point at a parameter; beyond the ends that of the end. At knots exactly the joint.
    pub fn eval(&self, t: f64) -> P {
        let (index, local) = self.locate(t);
        self.piece(index).eval(local)
    }

    /// Derivatives on both sides of a joint: between piece `index - 1` and piece `index`, and for closed splines at
    /// index 0 between the last piece and the first. `None` where there is no such joint.
    pub fn joint(&self, index: usize) -> Option<Joint<P>> {
        let pieces = self.knots.len() - 1;
        if index >= pieces || (index == 0 && !self.closed) {
            return None;
        }
        let before = (index + pieces - 1) % pieces;
        let [_, b, c, d] = self.piece(before).to_array();
        let [p, q, r, _] = self.piece(index).to_array();
        let (h, k) = (self.step(before), self.step(index));
        Some(Joint {
            first: [(d - c) * (3.0 / h), (q - p) * (3.0 / k)],
            second: [(d - c * 2.0 + b) * (6.0 / h / h), (p - q * 2.0 + r) * (6.0 / k / k)],
        })
    }

    fn step(&self, piece: usize) -> f64 {
        self.knots[piece + 1] - self.knots[piece]
    }

    /// Moves the control points beside a joint as little as possible so that it becomes smooth in this way; returns
    /// how far the farthest one moved.
    ///
    /// First order moves the two neighbours of the joint, second order also the two after them, which are neighbours
    /// of the joints beside it: those may lose their smoothness. For C2 at all joints interpolate instead.
    ///
    /// # Errors
    /// [`CurveError::Parameter`] when there is no such joint, [`CurveError::TooFewPoints`] for a closed spline of one
    /// piece, [`CurveError::NotFinite`] when a point would overflow; the spline is then unchanged.
    pub fn enforce(&mut self, index: usize, kind: Continuity) -> Result<f64, CurveError> {
        let joint = self.joint(index).ok_or(CurveError::Parameter { value: index as f64 })?;
        let (pieces, count) = (self.knots.len() - 1, self.points.len());
        if pieces < 2 {
            return Err(CurveError::TooFewPoints { actual: count, least: 6 });
        }
        let place = |k: isize| (3 * index as isize + k).rem_euclid(count as isize) as usize;
        let places = [-2, -1, 0, 1, 2].map(place);
        let steps = [self.step((index + pieces - 1) % pieces), self.step(index)];
        let mut five = places.map(|place| self.points[place]);
        match kind {
            Continuity::C1 | Continuity::C2 => equal_derivatives(&mut five, &joint, steps),
            Continuity::G1 | Continuity::G2 => equal_tangents(&mut five),
        }
        match kind {
            Continuity::C2 => equal_second_derivatives(&mut five, steps),
            Continuity::G2 => equal_curvatures(&mut five),
            Continuity::C1 | Continuity::G1 => {}
        }
        if let Some(bad) = five.iter().position(|point| !point.finite()) {
            return Err(CurveError::NotFinite { index: places[bad] });
        }
        let mut moved: f64 = 0.0;
        for (place, point) in places.into_iter().zip(five) {
            moved = moved.max((self.points[place] - point).norm());
            self.points[place] = point;
        }
        Ok(moved)
    }

    /// The smallest box around the curve, rounded outward as [`bounding_box`].
    pub fn bounding_box(&self) -> Bounds<P> {
        let first = Bounds { min: self.points[0], max: self.points[0] };
        self.pieces()
            .map(|piece| bounding_box(&piece))
            .fold(first, |a, b| Bounds { min: a.min.zip(b.min, f64::min), max: a.max.zip(b.max, f64::max) })
    }
}

/// The common derivative d with the least sum of squared moves of both neighbours, which stand at h d / 3.
fn equal_derivatives<P: Blend>(five: &mut [P; 5], joint: &Joint<P>, [h, k]: [f64; 2]) {
    let share = 1.0 / (1.0 + (k / h) * (k / h));
    let common = joint.first[0] * share + joint.first[1] * (1.0 - share);
    five[1] = five[2] - common * (h / 3.0);
    five[3] = five[2] + common * (k / 3.0);
}

/// Both neighbours on one line through the joint, each as far from it as before.
fn equal_tangents<P: Blend>(five: &mut [P; 5]) {
    let (before, after) = ((five[2] - five[1]).norm(), (five[3] - five[2]).norm());
    let direction = unit(five[3] - five[1]);
    if direction != P::ZERO {
        five[1] = five[2] - direction * before;
        five[3] = five[2] + direction * after;
    }
}

fn equal_second_derivatives<P: Blend>(five: &mut [P; 5], [h, k]: [f64; 2]) {
    let [b, c, d, q, r] = *five;
    // Second differences are h^2 / 6 and k^2 / 6 times the second derivatives.
    let ratio = (k / h) * (k / h);
    let (before, after) = (d - c * 2.0 + b, d - q * 2.0 + r);
    let common = (before + after * ratio).map(|x| x / (1.0 + ratio * ratio));
    five[0] = common + c * 2.0 - d;
    five[4] = common * ratio + q * 2.0 - d;
}

fn equal_curvatures<P: Blend>(five: &mut [P; 5]) {
    let [b, c, d, q, r] = *five;
    let (arm, leg) = (d - c, q - d);
    let (square, other) = (arm.inner(arm), leg.inner(leg));
    let tangent = unit(arm);
    if square == 0.0 || other == 0.0 {
        return;
    }
    // Curvature vectors are 2/3 of the distance across over the squared arm; they should agree.
    let (before, after) = (across(b - d, tangent), across(r - d, tangent));
    let common = (before * square + after * other).map(|x| x / (square * square + other * other));
    five[0] = b - before + common * square;
    five[4] = r - after + common * other;
}

/// Knots 0, 1, ..., `pieces`.
pub(super) fn uniform_knots(pieces: usize) -> Vec<f64> {
    (0..=pieces).map(|k| k as f64).collect()
}

/// Checks that knots are finite and ascend.
pub(super) fn check_knots(knots: &[f64]) -> Result<(), CurveError> {
    for (index, &knot) in knots.iter().enumerate() {
        if !knot.is_finite() || (index > 0 && knot <= knots[index - 1]) {
            return Err(CurveError::Knot { index });
        }
    }
    Ok(())
}

impl<P: Blend> Curve for Spline<P> {
    type Point = P;

    fn domain(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.knots.len() - 1]]
    }

    /// Derivatives by the parameter of the spline; at a joint those after it.
    fn jet(&self, t: f64) -> Jet<P> {
        let (index, local) = self.locate(t);
        let jet = self.piece(index).jet(local);
        let rate = 1.0 / self.step(index);
        Jet {
            point: jet.point,
            first: jet.first * rate,
            second: jet.second * rate * rate,
            third: jet.third * rate * rate * rate,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec2;

    fn rough(closed: bool) -> Spline<Vec2> {
        let mut points: Vec<Vec2> =
            (0..10).map(|k| Vec2::new(f64::from(k * k % 7), f64::from(k * 3 % 5) + 0.3)).collect();
        let knots = vec![0.0, 1.0, 3.0, 3.5];
        if closed {
            points.pop();
            Spline::closed(points, knots).unwrap()
        } else {
            Spline::open(points, knots).unwrap()
        }
    }

    #[test]
    fn every_kind_can_be_enforced_at_every_joint() {
        for closed in [false, true] {
            for index in 0..3 {
                for kind in [Continuity::C1, Continuity::C2, Continuity::G1, Continuity::G2] {
                    let mut spline = rough(closed);
                    let Some(joint) = spline.joint(index) else {
                        assert!(index == 0 && !closed);
                        continue;
                    };
                    assert!(joint.misfit(kind) > 0.01);
                    assert!(spline.enforce(index, kind).unwrap() > 0.01);
                    assert!(spline.joint(index).unwrap().misfit(kind) < 1e-12, "{closed} {index} {kind:?}");
                    assert!(spline.enforce(index, kind).unwrap() < 1e-12, "twice is once");
                }
            }
        }
        assert_eq!(rough(false).enforce(0, Continuity::C1), Err(CurveError::Parameter { value: 0.0 }));
    }

    #[test]
    fn pieces_share_points_and_knots_are_exact() {
        let spline = rough(true);
        assert_eq!(spline.pieces().len(), 3);
        assert_eq!(spline.piece(2).end(), spline.piece(0).start());
        assert_eq!(spline.eval(3.0), spline.points()[6]);
        assert_eq!(spline.eval(9.0), spline.points()[0]);
        let open = Spline::from_pieces(&spline.pieces().collect::<Vec<_>>()).unwrap();
        assert_eq!(open.clone().into_closed().unwrap().points(), spline.points());
        assert_eq!(open.locate(1.5), (1, 0.5));
    }

    #[test]
    fn wrong_input_is_named() {
        let p = Vec2::ZERO;
        let open = |n: usize, k: &[f64]| Spline::open(vec![p; n], k.to_vec()).unwrap_err();
        assert_eq!(open(0, &[]), CurveError::TooFewPoints { actual: 0, least: 4 });
        assert_eq!(open(5, &[0.0, 1.0]), CurveError::Count { actual: 5, expected: 7 });
        assert_eq!(open(7, &[0.0, 1.0]), CurveError::Count { actual: 2, expected: 3 });
        assert_eq!(open(7, &[0.0, 1.0, 1.0]), CurveError::Knot { index: 2 });
        assert_eq!(open(7, &[0.0, f64::NAN, 1.0]), CurveError::Knot { index: 1 });
        let nan = Spline::open(vec![p, p, Vec2::NAN, p], vec![0.0, 1.0]).unwrap_err();
        assert_eq!(nan, CurveError::NotFinite { index: 2 });
        let pieces = [rough(false).piece(0), rough(false).piece(2)];
        assert_eq!(Spline::from_pieces(&pieces), Err(CurveError::Gap { piece: 1 }));
        assert_eq!(rough(false).into_closed(), Err(CurveError::Open));
    }
}
