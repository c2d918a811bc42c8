//! What plane cubics have in closed form: inflections, cusps, the loop.

use super::Cubic;
use super::subdivide::with_unit_size;
use crate::math::Vec2;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::roots::{Few, quadratic};

/// What a plane cubic looks like over all parameters (Stone, DeRose, A geometric characterization of parametric cubic
/// curves, 1989).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CubicShape {
    /// It crosses itself.
    Loop {
        /// The two parameters of the double point, the smaller one first; they may lie outside of [0, 1].
        parameters: [f64; 2],
    },
    /// It stands still and turns back.
    Cusp {
        /// Where; it may lie outside of [0, 1].
        parameter: f64,
    },
    /// It has two inflections, or one with the other at infinity.
    Serpentine,
    /// It is a parabola.
    Quadratic,
    /// All control points are on one line.
    Straight,
}

impl Cubic<Vec2> {
    /// Parameters within [0, 1], ascending, where the curvature changes sign; at a cusp, where both inflections meet,
    /// its parameter once. None for straight curves.
    ///
    /// The roots of the cross product of first and second derivative, a quadratic for cubics.
    pub fn inflections(&self) -> Few<2> {
        let [a, b, c] = self.inflection_polynomial();
        quadratic(a.to_f64(), b.to_f64(), c.to_f64()).filtered(|t| (0.0..=1.0).contains(&t))
    }

    /// Parameters within (0, 1) where the curve crosses itself, as a pair; `None` where it does not.
    pub fn self_intersection(&self) -> Option<[f64; 2]> {
        match self.shape() {
            CubicShape::Loop { parameters: [s, t] } if 0.0 <= s && t <= 1.0 => Some([s, t]),
            _ => None,
        }
    }

    /// Parameters within [0, 1] where the curve stands still, ascending: cusps and, on straight curves, turns.
    pub fn cusps(&self) -> Few<2> {
        match self.shape() {
            CubicShape::Cusp { parameter } if (0.0..=1.0).contains(&parameter) => Few::NONE.with(parameter),
            CubicShape::Straight => self.straight_turns(),
            _ => self.resting_ends(),
        }
    }

    /// The kind of the curve, from the discriminant of its inflections: exactly zero, in double-double arithmetic, at
    /// a cusp.
    pub fn shape(&self) -> CubicShape {
        let [a, b, c] = self.inflection_polynomial();
        if a.hi == 0.0 && b.hi == 0.0 {
            return if c.hi == 0.0 { CubicShape::Straight } else { CubicShape::Quadratic };
        }
        let discriminant = b * b - a * c * 4.0;
        if a.hi == 0.0 || discriminant.hi > 0.0 {
            return CubicShape::Serpentine;
        }
        if discriminant.hi == 0.0 {
            return CubicShape::Cusp { parameter: (-b / (a * 2.0)).to_f64() };
        }
        // The double point has the same middle as the inflections (here complex), and sqrt(3) times their spread.
        let spread = (-discriminant * 3.0).sqrt();
        let middle = -b;
        let ends = [(middle - spread) / (a * 2.0), (middle + spread) / (a * 2.0)].map(DoubleDouble::to_f64);
        CubicShape::Loop { parameters: [ends[0].min(ends[1]), ends[0].max(ends[1])] }
    }

    /// Coefficients of t^2, t and 1 of the cross product of first and second derivative, up to a positive factor.
    fn inflection_polynomial(&self) -> [DoubleDouble; 3] {
        let mut points = self.to_array();
        with_unit_size(&mut points, |points| {
            let [p, q, r, s] = [points[0], points[1], points[2], points[3]];
            let exact = |a: f64, b: f64| DoubleDouble::difference(b, a);
            let step = |a: Vec2, b: Vec2| [exact(a.x, b.x), exact(a.y, b.y)];
            let cross = |a: [DoubleDouble; 2], b: [DoubleDouble; 2]| a[0] * b[1] - a[1] * b[0];
            let (u, v, w) = (step(p, q), step(q, r), step(r, s));
            // Bernstein coefficients of degree 2: u x v, (u x w) / 2, v x w.
            let (start, middle, end) = (cross(u, v), cross(u, w) * 0.5, cross(v, w));
            [start - middle * 2.0 + end, (middle - start) * 2.0, start]
        })
    }

    /// Where the derivative of a curve on a line vanishes.
    fn straight_turns(&self) -> Few<2> {
        let [p, q, r, s] = self.to_array();
        let axis = if (s - p).abs().max_element() == (s - p).abs().x { 0 } else { 1 };
        let turns_along = |axis: usize| {
            let (u, v, w) = (q[axis] - p[axis], r[axis] - q[axis], s[axis] - r[axis]);
            quadratic(u - 2.0 * v + w, 2.0 * (v - u), u).filtered(|t| (0.0..=1.0).contains(&t))
        };
        let is_constant = |axis: usize| [q, r, s].iter().all(|point| point[axis] == p[axis]);
        turns_along(if is_constant(axis) { 1 - axis } else { axis })
    }

    /// The ends, where the end point is doubled.
    fn resting_ends(&self) -> Few<2> {
        let [p, q, r, s] = self.to_array();
        let start = if p == q { Few::NONE.with(0.0) } else { Few::NONE };
        if r == s { start.with(1.0) } else { start }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Bernstein;
    use proptest::prelude::*;

    fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
        Cubic::new(points.map(Vec2::from)).unwrap()
    }

    #[test]
    fn the_kinds() {
        let cusp = cubic([(0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)]);
        assert_eq!(cusp.shape(), CubicShape::Cusp { parameter: 0.5 });
        assert_eq!((*cusp.cusps()).to_vec(), [0.5]);
        let looped = cubic([(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)]);
        let [s, t] = looped.self_intersection().unwrap();
        assert!((s - 0.17267316464601143).abs() < 1e-16 && (t - (1.0 - 0.17267316464601143)).abs() < 2e-16);
        let bend = cubic([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (100.0, 100.0)]);
        assert_eq!(*bend.inflections(), [0.5]);
        assert_eq!(bend.shape(), CubicShape::Serpentine);
        assert_eq!(bend.self_intersection(), None);
        let line = cubic([(0.0, 0.0), (200.0, 0.0), (-100.0, 0.0), (100.0, 0.0)]);
        assert_eq!(line.shape(), CubicShape::Straight);
        let turns = line.cusps();
        assert!((turns[0] - 0.27639320225002).abs() < 1e-13 && (turns[1] - 0.72360679774998).abs() < 1e-13);
        let parabola =
            crate::curve::Quadratic::new([Vec2::ZERO, Vec2::ONE, Vec2::X * 2.0]).unwrap().elevated::<4>();
        assert!(matches!(
            parabola.shape(),
            CubicShape::Quadratic | CubicShape::Serpentine | CubicShape::Loop { .. }
        ));
        assert!(parabola.inflections().is_empty());
        assert_eq!(*cubic([(0.0, 0.0), (0.0, 0.0), (1.0, 1.0), (1.0, 0.0)]).cusps(), [0.0]);
    }

    proptest! {
        #[test]
        fn double_points_are_double(points in prop::array::uniform4((-1.0..1.0_f64, -1.0..1.0_f64))) {
            let curve = cubic(points);
            if let CubicShape::Loop { parameters: [s, t] } = curve.shape() {
                let size = 1.0 + s.abs().max(t.abs());
                prop_assert!((curve.eval(s) - curve.eval(t)).length() < 1e-13 * size * size * size * size);
            }
            for &t in curve.inflections().iter() {
                let jet = crate::curve::Curve::jet(&curve, t);
                prop_assert!(jet.first.perp_dot(jet.second).abs() < 1e-10);
            }
        }
    }
}
