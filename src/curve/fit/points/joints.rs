//! Where a smooth path past points runs through, and in which direction.

use super::Section;
use crate::math::{Mat4, Vec2, Vec4, hypot};

/// Points on either side with which a window begins.
const LEAST: usize = 2;
/// The root mean square of residuals in a window, over the noise, above which the cubic does not fit: noise is known to
/// about a tenth, and three standard deviations of what n of them have are 3 / sqrt n at most.
const TOO_MUCH: f64 = 1.2;
/// The share of the tolerance that residuals may always have.
const FLOOR: f64 = 1.0 / 64.0;
/// Noise is told from about as many points.
const SAMPLES: usize = 1000;

/// A point of the path and the unit tangent there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub(super) point: Vec2,
    pub(super) tangent: Vec2,
}

/// Cubic polynomials fitted around points.
pub(super) struct Joints<'a> {
    section: &'a Section,
    /// The length of the polyline up to each point.
    lengths: Vec<f64>,
    limit: f64,
    noise: f64,
}

impl Joints<'_> {
    pub(super) fn new(section: &Section, limit: f64) -> Joints<'_> {
        let mut lengths = vec![0.0];
        for pair in section.points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
        }
        let noise = noise(&section.points, &lengths);
        Joints { section, lengths, limit, noise }
    }

    /// The length of the polyline up to each point.
    pub(super) fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// The joint at a point, from the widest window around it whose points lie on a cubic but for noise, not much wider
    /// than `most` points on either side. The ends of a section are kept; in between the joint is where the cubic is.
    pub(super) fn at(&self, index: usize, most: usize) -> Joint {
        let last = self.section.points.len() - 1;
        let here = self.section.points[index];
        let mut best = None;
        let mut reach = LEAST;
        loop {
            let window = self.window(index, reach);
            let fit = self.fit(index, window);
            let fits = fit.is_some_and(|(_, fits)| fits);
            if best.is_none() || fits {
                best = fit.or(best);
            }
            if !fits || reach >= most || window[1] - window[0] >= last as isize {
                break;
            }
            reach *= 2;
        }
        let is_end = (index == 0 || index == last) && !self.section.wraps;
        let Some((joint, _)) = best else {
            return Joint { point: here, tangent: self.chord(index) };
        };
        // Half of the tolerance is left for the cubics on both sides.
        let is_near = joint.point.distance(here) <= 0.5 * self.limit;
        Joint { point: if is_end || !is_near { here } else { joint.point }, ..joint }
    }

    /// First and last point of a window; of a loop they may be outside of the section and mean its other end.
    fn window(&self, index: usize, reach: usize) -> [isize; 2] {
        let (index, reach) = (index as isize, reach as isize);
        let last = self.section.points.len() as isize - 1;
        if self.section.wraps {
            let reach = reach.min(last / 2);
            return [index - reach, index + reach];
        }
        // As many points near an end as elsewhere.
        let low = (index - reach).max(0);
        let high = (low + 2 * reach).min(last);
        [(high - 2 * reach).max(0), high]
    }

    /// A point, and the length up to it.
    fn locate(&self, index: isize) -> (Vec2, f64) {
        let last = self.section.points.len() as isize - 1;
        let (turns, inner) = (index.div_euclid(last), index.rem_euclid(last));
        if !self.section.wraps || (0..=last).contains(&index) {
            return (self.section.points[index as usize], self.lengths[index as usize]);
        }
        let length = self.lengths[inner as usize] + turns as f64 * self.lengths[last as usize];
        (self.section.points[inner as usize], length)
    }

    /// The joint on the cubic polynomial of the length that fits a window best, of lower degree for fewer points, and
    /// whether residuals are no larger than the noise and the tolerance allow. `None` when nothing moves.
    fn fit(&self, index: usize, [low, high]: [isize; 2]) -> Option<(Joint, bool)> {
        let degree = (high - low).min(3);
        let (here, middle) = self.locate(index as isize);
        let half = (self.locate(high).1 - middle).max(middle - self.locate(low).1);
        let powers = |length: f64| {
            let s = (length - middle) / half;
            let masked = |k: isize, power: f64| if k <= degree { power } else { 0.0 };
            Vec4::new(1.0, masked(1, s), masked(2, s * s), masked(3, s * s * s))
        };
        // Unused powers have coefficients of zero.
        let unused = Vec4::new(0.0, f64::from(degree < 1), f64::from(degree < 2), f64::from(degree < 3));
        let mut normal = Mat4::from_diagonal(unused);
        let mut sides = [Vec4::ZERO; 2];
        for k in low..=high {
            let (point, length) = self.locate(k);
            let row = powers(length);
            normal += Mat4::from_cols(row * row.x, row * row.y, row * row.z, row * row.w);
            let offset = point - here;
            sides = [sides[0] + row * offset.x, sides[1] + row * offset.y];
        }
        let solve = normal.inverse();
        let [x, y] = sides.map(|side| solve * side);
        let tangent = Vec2::new(x.y, y.y).try_normalize()?;
        let misfit = |k: isize| {
            let (point, length) = self.locate(k);
            let (row, offset) = (powers(length), point - here);
            hypot(row.dot(x) - offset.x, row.dot(y) - offset.y)
        };
        let square: f64 = (low..=high).map(misfit).map(|off| off * off).sum();
        let spare = (high - low - degree).max(1) as f64;
        let allowed = (self.noise * (TOO_MUCH + 3.0 / spare.sqrt())).max(FLOOR * self.limit);
        let joint = Joint { point: here + Vec2::new(x.x, y.x), tangent };
        Some((joint, square <= spare * allowed * allowed))
    }

    /// The direction from the point before to the one after.
    fn chord(&self, index: usize) -> Vec2 {
        let [low, high] = self.window(index, 1);
        let (before, after) = (self.locate(low).0, self.locate(high).0);
        let here = self.section.points[index];
        let steps = [after - before, after - here, here - before];
        steps.into_iter().find_map(Vec2::try_normalize).unwrap_or(Vec2::X)
    }
}

/// The noise of points, as the root mean square of their distances from where they belong: the middle one of the
/// distances from the cubic through the two neighbours on both sides.
///
/// For evenly spaced points with normal noise s in each coordinate that distance has s sqrt(1 + 34/36) in each, and the
/// middle one of lengths of plane normal vectors is sqrt(2 ln 2) times that.
fn noise(points: &[Vec2], lengths: &[f64]) -> f64 {
    let last = points.len() - 1;
    let step = (last / SAMPLES).max(1);
    let places = (2..last.saturating_sub(1)).step_by(step);
    let mut misfits: Vec<f64> = places.filter_map(|k| misfit(points, lengths, k)).collect();
    misfits.sort_unstable_by(f64::total_cmp);
    let middle = misfits.get(misfits.len() / 2).copied().unwrap_or(0.0);
    // sqrt 2 / (sqrt(70/36) sqrt(2 ln 2))
    middle * 0.861
}

/// How far a point is from the cubic through its four neighbours.
fn misfit(points: &[Vec2], lengths: &[f64], index: usize) -> Option<f64> {
    let at = lengths[index];
    let nodes = [index - 2, index - 1, index + 1, index + 2];
    let weight = |k: usize| {
        let others = nodes.iter().filter(|&&n| n != nodes[k]);
        others.fold(1.0, |w, &n| w * (at - lengths[n]) / (lengths[nodes[k]] - lengths[n]))
    };
    let expected = (0..4).fold(Vec2::ZERO, |sum, k| sum + points[nodes[k]] * weight(k));
    let off = expected.distance(points[index]);
    off.is_finite().then_some(off)
}
