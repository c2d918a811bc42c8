//! Evolutes: where the normals of a curve meet their neighbours.

use super::bernstein::{inner_product, product_with};
use super::fit::{Ray, Side, Source};
use super::offset::Parallel;
use super::subdivide::{derivative, restrict};
use super::{Bernstein, Cubic};
use crate::math::Vec2;

/// The centres of curvature of a cubic, over a part of it without inflections and on which it stands still at most at
/// its ends.
///
/// With S' = w D as in [`Parallel`] the radius of curvature is w |D|^3 / (D x D').
pub(super) struct Evolute<'a>(pub(super) &'a Parallel);

impl Evolute<'_> {
    /// The chord between two parameters, if the part between is within a distance of it.
    pub(super) fn chord(&self, [from, to]: [f64; 2], distance: f64) -> Option<[Vec2; 4]> {
        let [a, b] = [from, to].map(|t| self.ray(t, Side::After).point);
        let points = [a, a + (b - a) / 3.0, b - (b - a) / 3.0, b];
        let chord = Cubic::new(points).ok()?;
        (self.deviation(from, to, &chord) <= distance).then_some(points)
    }
}

impl Source for Evolute<'_> {
    fn domain(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn ray(&self, t: f64, _: Side) -> Ray {
        let (factor, direction) = self.0.direction();
        let at = |points: &[Vec2], order: usize| super::evaluate::de_casteljau(&derivative(points, order), t);
        let [d, first, second] = [0, 1, 2].map(|order| at(&direction, order));
        let [w, slope] = [0, 1].map(|order| super::evaluate::de_casteljau(&derivative(&factor, order), t));
        let (turn, turn_slope) = (d.perp_dot(first), d.perp_dot(second));
        let length = d.length();
        let cube = length * length * length;
        let radius = w * cube / turn;
        let growth = (slope * cube + 3.0 * w * length * d.dot(first) - radius * turn_slope) / turn;
        let normal = self.0.tangent(t).perp();
        let distance = self.0.distance();
        let share = (radius / distance).clamp(0.0, 1.0);
        Ray { point: self.0.center(t) + normal * (share * distance), tangent: normal, speed: growth }
    }

    /// The cubic less the base curve, times D x D', should be w |D|^2 times D turned left: a polynomial of degree 8.
    fn deviation(&self, from: f64, to: f64, cubic: &Cubic<Vec2>) -> f64 {
        let (part, factor, direction) = self.0.part(from, to);
        let turn = product_with(&direction, &derivative(&direction, 1), Vec2::perp_dot);
        let least = turn.iter().map(|c| c * turn[0].signum()).fold(f64::INFINITY, f64::min);
        if least.is_nan() || least <= 0.0 {
            return f64::INFINITY;
        }
        let times = |a: &[f64], b: &[f64]| product_with(a, b, |x, y| x * y);
        let length = times(&times(&inner_product(&direction, &direction), &factor), &[to - from]);
        let raised = times(&turn, &[1.0; 3]);
        let misfit = |axis: usize| {
            let offset: Vec<f64> = (0..4).map(|i| cubic.points()[i][axis] - part[i][axis]).collect();
            let normal: Vec<f64> = direction.iter().map(|d| d.perp()[axis]).collect();
            let (have, want) = (times(&offset, &raised), times(&normal, &length));
            have.iter().zip(&want).map(|(a, b)| a - b).collect::<Vec<f64>>()
        };
        let (x, y) = (misfit(0), misfit(1));
        let largest = x.iter().zip(&y).fold(0.0, |most: f64, (&x, &y)| most.max(x * x + y * y));
        largest.sqrt() / least
    }
}

impl Parallel {
    /// The base curve between two parameters, and its derivative as a polynomial w with zeros at the ends only times
    /// one without, all over [0, 1].
    pub(super) fn part(&self, from: f64, to: f64) -> ([Vec2; 4], [f64; 3], [Vec2; 3]) {
        let (mut part, mut velocity) = (*self.points(), *self.velocity());
        restrict(&mut part, from, to);
        restrict(&mut velocity, from, to);
        let (factor, direction) = super::offset::without_zeros(&velocity);
        (part, factor, direction)
    }
}
