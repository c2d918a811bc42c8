//! Corners among points.

use crate::curve::strand::angle_between;
use crate::curve::{CurveError, check_finite};
use crate::math::Vec2;

/// Indices of the points, ascending, at which the polyline through the points turns by more than `angle` radians,
/// seen over the length `reach` on both sides: the sharpest first, and no others within that length of one. Ends of an
/// open polyline are none.
///
/// Noise of the points turns directions by about its size over the reach: that should be well below the angle.
///
/// # Errors
/// [`CurveError::NotFinite`], [`CurveError::Parameter`] when angle or reach are not positive.
pub fn find_corners(points: &[Vec2], closed: bool, angle: f64, reach: f64) -> Result<Vec<usize>, CurveError> {
    check_finite(points)?;
    for value in [angle, reach] {
        if value.is_nan() || value <= 0.0 {
            return Err(CurveError::Parameter { value });
        }
    }
    if points.len() < 3 {
        return Ok(Vec::new());
    }
    let line = Polyline::new(points, closed);
    let turns: Vec<f64> = (0..points.len()).map(|index| line.turn(index, reach)).collect();
    let mut sharp: Vec<usize> = (0..points.len()).filter(|&index| turns[index] > angle).collect();
    sharp.sort_by(|&a, &b| turns[b].total_cmp(&turns[a]));
    let mut corners: Vec<usize> = Vec::new();
    for index in sharp {
        let place = corners.partition_point(|&other| other < index);
        // The next ones on both sides, around a closed polyline.
        let count = corners.len().max(1);
        let sides = [corners.get((place + count - 1) % count), corners.get(place % count)];
        if sides.into_iter().flatten().all(|&other| line.away(index, other) > reach) {
            corners.insert(place, index);
        }
    }
    Ok(corners)
}

struct Polyline<'a> {
    points: &'a [Vec2],
    closed: bool,
    /// The length up to each point; of a closed polyline, also that back to the first.
    lengths: Vec<f64>,
}

impl Polyline<'_> {
    fn new(points: &[Vec2], closed: bool) -> Polyline<'_> {
        let mut lengths = vec![0.0];
        let steps = points.windows(2).map(|pair| pair[0].distance(pair[1]));
        let back = closed.then(|| points[points.len() - 1].distance(points[0]));
        for step in steps.chain(back) {
            lengths.push(lengths[lengths.len() - 1] + step);
        }
        Polyline { points, closed, lengths }
    }

    fn total(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The point at a length, taken around a closed polyline and within an open one.
    fn at(&self, length: f64) -> Vec2 {
        let total = self.total();
        let length = if self.closed { length.rem_euclid(total) } else { length.clamp(0.0, total) };
        let after = self.lengths.partition_point(|&l| l <= length).clamp(1, self.lengths.len() - 1);
        let (low, high) = (self.lengths[after - 1], self.lengths[after]);
        let share = if high > low { (length - low) / (high - low) } else { 0.0 };
        let [from, to] = [after - 1, after].map(|index| self.points[index % self.points.len()]);
        from + (to - from) * share
    }

    /// The angle between what comes before a point and what comes after.
    fn turn(&self, index: usize, reach: f64) -> f64 {
        let (at, length) = (self.points[index], self.lengths[index]);
        if !self.closed && (length <= 0.0 || length >= self.total()) {
            return 0.0;
        }
        // Not more than half of a loop.
        let reach = reach.min(0.25 * self.total());
        let (before, after) = (at - self.at(length - reach), self.at(length + reach) - at);
        if before == Vec2::ZERO || after == Vec2::ZERO { 0.0 } else { angle_between(before, after) }
    }

    /// The length between two points.
    fn away(&self, index: usize, other: usize) -> f64 {
        let gap = (self.lengths[other] - self.lengths[index]).abs();
        if self.closed { gap.min(self.total() - gap) } else { gap }
    }
}
