//! How many fragments a circle gets.

use super::eval::Fragmentation;
use crate::math;
use std::f64::consts::PI;

/// Below this radius a circle is a triangle: 2^-20, the grid OpenSCAD rounds to.
const TINY: f64 = 1.0 / 1_048_576.0;

impl Fragmentation {
    /// Smallest value of `$fa` and `$fs`, as in OpenSCAD.
    pub(super) const FINEST: f64 = 0.01;

    /// Number of fragments of a full circle: `$fn` where it is positive, else from the chord error `$fe` where that
    /// is positive, else the smaller of what `$fa` and `$fs` ask for, at least 5. It may be too large for anything.
    pub(super) fn of_circle(&self, radius: f64) -> f64 {
        let radius = radius.abs();
        if radius < TINY || !radius.is_finite() || self.count.is_infinite() {
            return 3.0;
        }
        if self.count > 0.0 {
            return self.count.trunc().max(3.0);
        }
        if self.error > 0.0 {
            // A chord is at most r (1 - cos(pi / n)) away from its arc.
            let cosine = (1.0 - self.error / radius).max(-1.0);
            return (PI / math::acos(cosine)).ceil().max(3.0);
        }
        let by_angle = 360.0 / self.angle.max(Self::FINEST);
        let by_size = 2.0 * PI * radius / self.size.max(Self::FINEST);
        by_angle.min(by_size).max(5.0).ceil()
    }

    /// The same with a distance that decides alone, whatever `$fn` says.
    pub(super) fn within(self, error: f64) -> Fragmentation {
        Fragmentation { count: 0.0, error, ..self }
    }

    /// The distance allowed, where one decides.
    pub(super) fn tolerance(&self) -> Option<f64> {
        (self.count <= 0.0 && self.error > 0.0 && self.error.is_finite()).then_some(self.error)
    }

    /// Number of fragments of a sphere: as of a circle, but that a facet between two meridians and two rings is farther
    /// off than a chord, by `r - sqrt(r^2 - c^2)` where c is the radius of the circle around it, at most
    /// `sqrt(2) r sin(pi / n)`.
    pub(super) fn of_sphere(&self, radius: f64) -> f64 {
        match self.tolerance() {
            Some(error) if radius.abs() >= TINY && radius.is_finite() => {
                let share = (1.0 - error / radius.abs()).max(0.0);
                (2.0 * PI / math::acos(share * share)).ceil().max(3.0)
            }
            _ => self.of_circle(radius),
        }
    }

    /// Number of fragments of a part of a circle: its share, rounded down as in OpenSCAD unless a distance must be kept.
    pub(super) fn of_arc(&self, radius: f64, degrees: f64) -> f64 {
        let share = self.of_circle(radius) * degrees.abs() / 360.0;
        if self.tolerance().is_some() { share.ceil().max(1.0) } else { share.trunc().max(1.0) }
    }

    /// The largest distance of a circle of this radius from its fragments, not 0: `$fe` itself where it decides.
    pub(super) fn chord_error(&self, radius: f64) -> f64 {
        let of_chord = || (radius * (1.0 - math::cos(PI / self.of_circle(radius)))).max(f64::MIN_POSITIVE);
        self.tolerance().unwrap_or_else(of_chord)
    }

    /// Number of layers of a straight sweep of `height` that twists by `degrees`, of an outline that reaches `radius`
    /// far out and has no edge longer than `edge`: as many as its outermost edge has fragments, at least one for 120
    /// degrees.
    pub(super) fn of_helix(&self, radius: f64, edge: f64, height: f64, degrees: f64) -> f64 {
        let degrees = degrees.abs();
        let least = (degrees / 120.0).ceil().max(1.0);
        if self.count > 0.0 {
            return (degrees / 360.0 * self.count.trunc().max(3.0)).ceil().max(least);
        }
        if self.error > 0.0 {
            return self.of_wall(radius, edge, degrees).max(least);
        }
        let length = math::hypot(degrees / 360.0 * 2.0 * PI * radius, height);
        let by_angle = (degrees / self.angle.max(Self::FINEST)).ceil();
        let by_size = (length / self.size.max(Self::FINEST)).ceil();
        by_angle.min(by_size).max(least)
    }

    /// Layers after which a twisting wall keeps the distance. In a layer that turns by a the helix of a corner is off its
    /// chord by `r (1 - cos(a / 2))`, and an edge is off the diagonal between its two places by a quarter of how far it
    /// turns, `e sin(a / 2) / 2`: together at most `r a^2 / 8 + e a / 4`.
    fn of_wall(&self, radius: f64, edge: f64, degrees: f64) -> f64 {
        let (square, linear) = (radius / 8.0, edge / 4.0);
        let root = (linear * linear + 4.0 * square * self.error).sqrt();
        // The positive root of square a^2 + linear a = error, without cancellation.
        let angle = 2.0 * self.error / (linear + root);
        (degrees * PI / 180.0 / angle).ceil()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const USUAL: Fragmentation = Fragmentation { count: 0.0, angle: 12.0, size: 2.0, error: 0.0 };

    #[test]
    fn circles_have_as_many_fragments_as_in_openscad() {
        let check = |fragmentation: Fragmentation, radius: f64, n: f64| {
            assert_eq!(fragmentation.of_circle(radius), n, "{fragmentation:?} {radius}");
        };
        check(USUAL, 5.0, 16.0);
        check(USUAL, 1.0, 5.0);
        check(USUAL, 1000.0, 30.0);
        check(USUAL, 1e-7, 3.0);
        check(Fragmentation { count: 7.9, ..USUAL }, 5.0, 7.0);
        check(Fragmentation { count: 1.0, ..USUAL }, 5.0, 3.0);
        check(Fragmentation { count: -3.0, ..USUAL }, 5.0, 16.0);
        check(Fragmentation { angle: 1.0, size: 0.1, ..USUAL }, 5.0, 315.0);
    }

    #[test]
    fn chord_errors_are_kept() {
        for radius in [0.1, 1.0, 30.0, 1e4] {
            for error in [1e-3, 0.05, 2.0] {
                let n = Fragmentation { error, ..USUAL }.of_circle(radius);
                let chord_error = |n: f64| radius * (1.0 - math::cos(PI / n));
                assert!(chord_error(n) <= error * (1.0 + 1e-9) || n == 3.0, "{radius} {error} {n}");
                assert!(n == 3.0 || chord_error(n - 1.0) > error * (1.0 - 1e-9), "{radius} {error} {n}");
            }
        }
    }

    #[test]
    fn twists_have_as_many_layers_as_in_openscad() {
        let corner = 50.0_f64.sqrt();
        let check = |fragmentation: Fragmentation, degrees: f64, n: f64| {
            assert_eq!(fragmentation.of_helix(corner, 10.0, 10.0, degrees), n, "{fragmentation:?} {degrees}");
        };
        check(USUAL, 90.0, 8.0);
        check(USUAL, 720.0, 45.0);
        check(USUAL, 10.0, 1.0);
        check(Fragmentation { count: 50.0, ..USUAL }, 90.0, 13.0);
        check(Fragmentation { angle: 1.0, size: 0.1, ..USUAL }, -90.0, 90.0);
    }
}
