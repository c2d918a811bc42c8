use super::op::Blend;
use super::primitive::Primitive;
use super::{Expr, Field, Tape};
use crate::math::{Aabb, Affine3, Interval, Mat3, Vec3};
use std::fmt;
use std::sync::Arc;

/// A shape given by a formula, negative inside, and what is known of the formula: how far it can be trusted as a
/// distance, how steep it is, and where the inside can be.
///
/// Operators carry the knowledge along and never claim more than holds (Hart, Sphere tracing, 1996; Quilez, Distance
/// functions). A minimum of exact distances is one outside only, a maximum inside only, a blend neither; all of them
/// stay as steep as the steepest.
///
/// ```
/// use ogee::math::Vec3;
/// use ogee::sdf::{Blend, Field, Implicit, Primitive};
///
/// let ball = Implicit::primitive(Primitive::Sphere { radius: 1.0 })?;
/// let block = Implicit::primitive(Primitive::Cuboid { half: Vec3::new(2.0, 2.0, 0.5) })?;
/// let both = ball.blend_union(&block, Blend::Circular { radius: 0.25 })?;
/// assert_eq!(both.lipschitz(), Some(2.0_f64.sqrt()));
/// assert!(!both.is_exact_outside());
/// assert!(both.tape().value(Vec3::new(0.0, 0.9, 0.52)) < 0.0); // in the fillet
/// # Ok::<(), ogee::sdf::BadNumber>(())
/// ```
#[derive(Clone, Debug)]
pub struct Implicit {
    expr: Expr,
    exact_inside: bool,
    exact_outside: bool,
    lipschitz: Option<f64>,
    bounds: Aabb,
}

/// A number that makes no shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadNumber {
    /// What it is, such as `radius`.
    pub name: &'static str,
    /// What it must be, such as `positive`.
    pub must_be: &'static str,
    /// What it was.
    pub value: f64,
}

impl fmt::Display for BadNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the {} must be {}, it is {}", self.name, self.must_be, self.value)
    }
}

impl std::error::Error for BadNumber {}

impl BadNumber {
    /// The value, when `holds` does.
    pub(crate) fn check(
        name: &'static str,
        must_be: &'static str,
        value: f64,
        holds: bool,
    ) -> Result<f64, BadNumber> {
        if holds { Ok(value) } else { Err(BadNumber { name, must_be, value }) }
    }

    pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, BadNumber> {
        BadNumber::check(name, "positive and finite", value, value > 0.0 && value.is_finite())
    }

    pub(super) fn finite(name: &'static str, value: f64) -> Result<f64, BadNumber> {
        BadNumber::check(name, "finite", value, value.is_finite())
    }

    /// From 0 to `most`.
    pub(super) fn within(
        name: &'static str,
        must_be: &'static str,
        value: f64,
        most: f64,
    ) -> Result<f64, BadNumber> {
        BadNumber::check(name, must_be, value, (0.0..=most).contains(&value))
    }
}

/// Everywhere: the bounds of what is not known to be bounded.
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

impl Implicit {
    /// A primitive around the origin.
    ///
    /// # Errors
    /// Which of its numbers is not finite, not positive, or too large for the others.
    pub fn primitive(primitive: Primitive) -> Result<Implicit, BadNumber> {
        primitive.check()?;
        let half = primitive.half_size();
        Ok(Implicit {
            expr: Expr::primitive(primitive),
            exact_inside: primitive.is_exact(),
            exact_outside: primitive.is_exact(),
            lipschitz: Some(primitive.lipschitz()),
            bounds: Aabb { min: -half, max: half },
        })
    }

    /// All points p with p . normal below `offset`; the normal may have any length but zero. Exact.
    ///
    /// # Errors
    /// A normal that is zero or not finite, an offset that is not.
    pub fn half_space(normal: Vec3, offset: f64) -> Result<Implicit, BadNumber> {
        let length = BadNumber::positive("length of the normal", normal.length())?;
        BadNumber::finite("offset", offset)?;
        let n = normal / length;
        let expr = Expr::linear([n.x, n.y, n.z, -offset / length], &Expr::axes());
        Ok(Implicit {
            expr,
            exact_inside: true,
            exact_outside: true,
            // The unit vector is rounded.
            lipschitz: Some(1.0 + 4.0 * f64::EPSILON),
            bounds: EVERYWHERE,
        })
    }

    /// Any formula. `lipschitz` is a bound of its slope that the caller has proven, `bounds` a box that holds all that
    /// is inside; a box with infinite corners says nothing.
    pub fn formula(expr: Expr, lipschitz: Option<f64>, bounds: Aabb) -> Implicit {
        Implicit { expr, exact_inside: false, exact_outside: false, lipschitz, bounds }
    }

    /// A field of one's own, with what it says of itself. It is taken for a bound of the distance, not for exact.
    pub fn field(field: Arc<dyn Field>) -> Implicit {
        let (lipschitz, bounds) = (field.lipschitz(), field.bounds().unwrap_or(EVERYWHERE));
        Implicit::formula(Expr::field(field), lipschitz, bounds)
    }

    /// The same, where the caller knows whether it is the distance itself inside and outside.
    pub fn with_exactness(self, inside: bool, outside: bool) -> Implicit {
        Implicit { exact_inside: inside, exact_outside: outside, ..self }
    }

    /// The formula.
    pub fn expr(&self) -> &Expr {
        &self.expr
    }

    /// The form that can be evaluated, with what is known.
    pub fn tape(&self) -> Tape {
        let bounded = self.bounds.is_empty() || (self.bounds.min.is_finite() && self.bounds.max.is_finite());
        self.expr.compile().with_knowledge(self.lipschitz, bounded.then_some(self.bounds))
    }

    /// Whether the value is minus the distance to the surface wherever it is negative.
    pub fn is_exact_inside(&self) -> bool {
        self.exact_inside
    }

    /// Whether the value is the distance to the surface wherever it is positive.
    pub fn is_exact_outside(&self) -> bool {
        self.exact_outside
    }

    /// A proven bound of the slope; `None` where there is none.
    pub fn lipschitz(&self) -> Option<f64> {
        self.lipschitz
    }

    /// A box that holds all that is inside; infinite where that is not known to be bounded.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// What is inside of either.
    pub fn union(&self, other: &Implicit) -> Implicit {
        Implicit {
            expr: self.expr.min(&other.expr),
            exact_inside: false,
            exact_outside: self.exact_outside && other.exact_outside,
            lipschitz: self.steepest(other),
            bounds: self.bounds.union(other.bounds),
        }
    }

    /// The union of many, as a balanced tree; everything is outside when there are none.
    pub fn union_all(shapes: &[Implicit]) -> Implicit {
        match shapes {
            [] => Implicit::nothing(),
            [one] => one.clone(),
            more => {
                let (left, right) = more.split_at(more.len() / 2);
                Implicit::union_all(left).union(&Implicit::union_all(right))
            }
        }
    }

    /// Everything is outside.
    pub fn nothing() -> Implicit {
        Implicit::formula(Expr::constant(f64::INFINITY), Some(0.0), Aabb::EMPTY)
    }

    /// What is inside of both.
    pub fn intersection(&self, other: &Implicit) -> Implicit {
        Implicit {
            expr: self.expr.max(&other.expr),
            exact_inside: self.exact_inside && other.exact_inside,
            exact_outside: false,
            lipschitz: self.steepest(other),
            bounds: self.bounds.intersection(other.bounds),
        }
    }

    /// What is inside of this and outside of the other.
    pub fn difference(&self, other: &Implicit) -> Implicit {
        self.intersection(&other.complement())
    }

    /// Inside and outside swapped.
    pub fn complement(&self) -> Implicit {
        Implicit {
            expr: -&self.expr,
            exact_inside: self.exact_outside,
            exact_outside: self.exact_inside,
            lipschitz: self.lipschitz,
            bounds: EVERYWHERE,
        }
    }

    /// The union with the edge between both filled.
    ///
    /// # Errors
    /// A radius that is negative or not finite.
    pub fn blend_union(&self, other: &Implicit, blend: Blend) -> Result<Implicit, BadNumber> {
        let size = BadNumber::within("radius of a blend", "0 or more and finite", blend.size(), f64::MAX)?;
        if size == 0.0 {
            return Ok(self.union(other));
        }
        let both = |f: fn(f64, f64) -> f64| Some(f(self.lipschitz?, other.lipschitz?));
        let lipschitz = match blend {
            // A mean of both slopes with weights that sum to 1.
            Blend::Quadratic { .. } => self.steepest(other),
            // Weights whose squares sum to 1.
            Blend::Circular { .. } => both(|a, b| (a * a + b * b).sqrt() * (1.0 + f64::EPSILON)).map(tidy),
            Blend::Chamfer { .. } => {
                both(|a, b| a.max(b).max((a + b) * std::f64::consts::FRAC_1_SQRT_2 * (1.0 + f64::EPSILON)))
                    .map(tidy)
            }
        };
        // What is filled in lies between both, and no further from either than the blend reaches.
        let bounds = self.bounds.union(other.bounds);
        let swollen = if self.bounds.is_empty() || other.bounds.is_empty() {
            bounds
        } else {
            self.filled_bounds(other, blend).unwrap_or(EVERYWHERE)
        };
        Ok(Implicit {
            expr: self.expr.blend_min(&other.expr, blend),
            exact_inside: false,
            exact_outside: false,
            lipschitz,
            bounds: swollen,
        })
    }

    /// A box around a blended union. A point that is filled in has both values below the blend's reach, so it is that
    /// near to both where they are exact distances.
    fn filled_bounds(&self, other: &Implicit, blend: Blend) -> Option<Aabb> {
        let reach = match blend {
            // d = a - b, s = a + b: s < (k^2 + d^2) / 2k < k, and |d| < k, so both are below k.
            Blend::Quadratic { radius } => Blend::quadratic_reach(radius),
            Blend::Circular { radius } => radius,
            // a + b < distance: one is, and the other is at least minus the depth of the shape.
            Blend::Chamfer { .. } => return self.chamfer_bounds(other, blend.size()),
        };
        let near = |shape: &Implicit| shape.exact_outside.then(|| grown(shape.bounds, reach));
        let filled = match (near(self), near(other)) {
            (Some(a), Some(b)) => a.intersection(b),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => return None,
        };
        Some(self.bounds.union(other.bounds).union(filled))
    }

    /// A point of the flat face lies outside of both, where a + b is below the distance, hence each is.
    fn chamfer_bounds(&self, other: &Implicit, distance: f64) -> Option<Aabb> {
        let near = |shape: &Implicit| shape.exact_outside.then(|| grown(shape.bounds, distance));
        let both = near(self).into_iter().chain(near(other)).reduce(Aabb::intersection)?;
        Some(self.bounds.union(other.bounds).union(both))
    }

    /// The intersection with the edge between both filled: rounded off or cut.
    ///
    /// # Errors
    /// A radius that is negative or not finite.
    pub fn blend_intersection(&self, other: &Implicit, blend: Blend) -> Result<Implicit, BadNumber> {
        let blended = self.complement().blend_union(&other.complement(), blend)?.complement();
        Ok(Implicit { bounds: self.bounds.intersection(other.bounds), ..blended })
    }

    /// The difference with the edge between both rounded off or cut.
    ///
    /// # Errors
    /// A radius that is negative or not finite.
    pub fn blend_difference(&self, other: &Implicit, blend: Blend) -> Result<Implicit, BadNumber> {
        self.blend_intersection(&other.complement(), blend)
    }

    /// Moves the surface outward by `distance`, inward when that is negative: by so much exactly where the field is an
    /// exact distance on that side, otherwise by at least as much.
    ///
    /// # Errors
    /// A distance that is not finite.
    pub fn offset(&self, distance: f64) -> Result<Implicit, BadNumber> {
        BadNumber::finite("distance", distance)?;
        let outward = distance >= 0.0;
        let bounds = match outward {
            true if self.exact_outside => grown(self.bounds, distance),
            true => EVERYWHERE,
            false => self.bounds,
        };
        Ok(Implicit {
            expr: &self.expr - distance,
            exact_inside: self.exact_inside && !outward,
            exact_outside: self.exact_outside && outward,
            lipschitz: self.lipschitz,
            bounds,
        })
    }

    /// The wall of this thickness around the surface, half of it on each side.
    ///
    /// # Errors
    /// A thickness that is not positive.
    pub fn shell(&self, thickness: f64) -> Result<Implicit, BadNumber> {
        let half = 0.5 * BadNumber::positive("thickness", thickness)?;
        Ok(Implicit {
            expr: self.expr.abs() - half,
            exact_inside: false,
            exact_outside: self.exact_inside && self.exact_outside,
            lipschitz: self.lipschitz,
            bounds: if self.exact_outside { grown(self.bounds, half) } else { EVERYWHERE },
        })
    }

    /// A shape between this one (at 0) and the other (at 1): the mean of both fields with these weights.
    ///
    /// # Errors
    /// A parameter outside of 0 to 1.
    pub fn morph(&self, other: &Implicit, t: f64) -> Result<Implicit, BadNumber> {
        BadNumber::within("parameter", "from 0 to 1", t, 1.0)?;
        Ok(Implicit {
            expr: &self.expr * (1.0 - t) + &other.expr * t,
            exact_inside: false,
            exact_outside: false,
            lipschitz: self.steepest(other),
            bounds: self.bounds.union(other.bounds),
        })
    }

    /// The shape under an affine map. Rigid motions, reflections and uniform scalings keep exactness; others make a
    /// bound of it, the distance scaled by the least stretch.
    ///
    /// # Errors
    /// A map that is not finite or flattens space.
    pub fn transform(&self, map: &Affine3) -> Result<Implicit, BadNumber> {
        let inverse = map.inverse();
        let sound = inverse.is_finite() && map.is_finite();
        BadNumber::check("determinant of a map", "not 0 and finite", map.matrix3.determinant(), sound)?;
        // The reciprocal of the greatest is accurate where the least itself is not.
        let (least, most) = (1.0 / greatest_stretch(inverse.matrix3), greatest_stretch(map.matrix3));
        let uniform = most - least <= 1e-14 * most;
        let moved = self.expr.at_affine(&inverse);
        let scale = if uniform && (least - 1.0).abs() <= 1e-14 { 1.0 } else { least };
        // Rounding of the map and of the stretches.
        let slope = 1.0 + 16.0 * f64::EPSILON;
        Ok(Implicit {
            expr: if scale == 1.0 { moved } else { moved * scale },
            exact_inside: self.exact_inside && uniform,
            exact_outside: self.exact_outside && uniform,
            lipschitz: self.lipschitz.map(|l| if is_shift(map) { l } else { l * slope }),
            bounds: moved_box(self.bounds, map),
        })
    }

    /// The shape moved.
    ///
    /// # Errors
    /// A shift that is not finite.
    pub fn translate(&self, shift: Vec3) -> Result<Implicit, BadNumber> {
        self.transform(&Affine3::from_translation(shift))
    }

    /// The part with positive coordinates along an axis (0 to 2), and its mirror image.
    ///
    /// # Panics
    /// When there is no such axis.
    pub fn mirrored(&self, axis: usize) -> Implicit {
        let mut axes = Expr::axes();
        axes[axis] = axes[axis].abs();
        let mut bounds = self.bounds;
        bounds.min[axis] = -bounds.max[axis];
        let empty = self.bounds.is_empty() || bounds.max[axis] < 0.0;
        Implicit {
            expr: self.expr.at(axes),
            exact_inside: false,
            exact_outside: false,
            lipschitz: self.lipschitz,
            bounds: if empty { Aabb::EMPTY } else { bounds },
        }
    }

    pub(super) fn with_expr(&self, expr: Expr) -> Implicit {
        Implicit { expr, exact_inside: false, exact_outside: false, ..self.clone() }
    }

    pub(super) fn with_bounds(self, bounds: Aabb) -> Implicit {
        Implicit { bounds, ..self }
    }

    pub(super) fn with_lipschitz(self, lipschitz: Option<f64>) -> Implicit {
        Implicit { lipschitz, ..self }
    }

    /// The greater slope; unknown when either is.
    fn steepest(&self, other: &Implicit) -> Option<f64> {
        Some(self.lipschitz?.max(other.lipschitz?))
    }
}

/// sqrt 2 as it is usually written, where rounding has moved it by less than two places.
fn tidy(slope: f64) -> f64 {
    let root = std::f64::consts::SQRT_2;
    if (slope - root).abs() <= 4.0 * f64::EPSILON { root } else { slope }
}

/// A box larger by `distance` on all sides, rounded outward.
pub(super) fn grown(bounds: Aabb, distance: f64) -> Aabb {
    if bounds.is_empty() {
        return bounds;
    }
    let side =
        |axis: usize| Interval::new(bounds.min[axis], bounds.max[axis]) + Interval::new(-distance, distance);
    let sides = [side(0), side(1), side(2)];
    Aabb { min: Vec3::from_array(sides.map(|s| s.lo)), max: Vec3::from_array(sides.map(|s| s.hi)) }
}

fn is_shift(map: &Affine3) -> bool {
    map.matrix3 == Mat3::IDENTITY
}

/// The box around a moved box.
fn moved_box(bounds: Aabb, map: &Affine3) -> Aabb {
    if bounds.is_empty() {
        return bounds;
    }
    let m = map.matrix3.to_cols_array_2d();
    let sides = [0, 1, 2].map(|axis| {
        (0..3).fold(Interval::point(map.translation[axis]), |sum, k| {
            sum + Interval::point(m[k][axis]) * Interval::new(bounds.min[k], bounds.max[k])
        })
    });
    Aabb { min: Vec3::from_array(sides.map(|s| s.lo)), max: Vec3::from_array(sides.map(|s| s.hi)) }
}

/// The greatest factor by which a map stretches lengths: its singular value, by Jacobi's rotations of the symmetric
/// product (1846).
pub(crate) fn greatest_stretch(map: Mat3) -> f64 {
    let mut s = (map.transpose() * map).to_cols_array_2d();
    // Convergence is quadratic; five sweeps are enough for any matrix of three rows.
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(15) {
        if s[p][q] == 0.0 {
            continue;
        }
        let slope = (s[q][q] - s[p][p]) / (2.0 * s[p][q]);
        let t = slope.signum() / (slope.abs() + (slope * slope + 1.0).sqrt());
        let cosine = 1.0 / (t * t + 1.0).sqrt();
        let sine = t * cosine;
        for row in &mut s {
            (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
        }
        let (above, below) = (s[p], s[q]);
        s[p] = [0, 1, 2].map(|k| cosine * above[k] - sine * below[k]);
        s[q] = [0, 1, 2].map(|k| sine * above[k] + cosine * below[k]);
    }
    s[0][0].max(s[1][1]).max(s[2][2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_singular_values() {
        let turn = Mat3::from_rotation_x(0.3) * Mat3::from_rotation_z(1.1);
        for scale in [Vec3::new(1.0, 2.0, 3.0), Vec3::splat(2.0), Vec3::new(1e-3, 1.0, 1e3)] {
            let most = greatest_stretch(turn * Mat3::from_diagonal(scale) * turn.transpose());
            assert!((most / scale.max_element() - 1.0).abs() < 1e-14, "{most}");
        }
    }

    #[test]
    fn numbers_that_make_no_shape() {
        let refused = |primitive| Implicit::primitive(primitive).unwrap_err().to_string();
        assert_eq!(
            refused(Primitive::Sphere { radius: f64::NAN }),
            "the radius must be positive and finite, it is NaN"
        );
        assert_eq!(
            refused(Primitive::RoundedCuboid { half: Vec3::ONE, radius: 1.5 }),
            "the radius must be from 0 to the least half side, it is 1.5"
        );
        let flat = Affine3::from_scale(Vec3::new(1.0, 0.0, 1.0));
        assert!(Implicit::nothing().transform(&flat).is_err());
        assert!(Implicit::nothing().offset(f64::INFINITY).is_err());
    }
}
