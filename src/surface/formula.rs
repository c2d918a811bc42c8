use super::bends::{lengths, of_ranges};
use super::{Bends, Jet, Sides, Surface, SurfaceError};
use crate::math::{Aabb, Interval, Vec3};
use crate::sdf::{Expr, Field, Tape};

/// A surface given by three expressions, in which x stands for u and y for v. Their derivatives come from dual numbers,
/// and bounds of the second ones from intervals, so that its tessellation is proven.
///
/// ```
/// use ogee::sdf::Expr;
/// use ogee::surface::{Formula, Surface};
///
/// let [u, v, _] = Expr::axes();
/// let dish = Formula::new([u.clone(), v.clone(), u.square() + v.square()], [[-1.0, 1.0]; 2])?;
/// assert_eq!(dish.point(1.0, 0.5).z, 1.25);
/// let bounds = dish.second_bounds([[0.0, 1.0]; 2]).unwrap();
/// assert!((bounds[0] - 2.0).abs() < 1e-9 && bounds[1] < 1e-9);
/// # Ok::<(), ogee::surface::SurfaceError>(())
/// ```
#[derive(Clone)]
pub struct Formula {
    coordinates: [Tape; 3],
    domain: [[f64; 2]; 2],
    sides: Sides,
}

impl Formula {
    /// The surface of these coordinates over ranges of u and of v; none of its sides lie together.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] when a range is not finite and ascending.
    pub fn new(coordinates: [Expr; 3], domain: [[f64; 2]; 2]) -> Result<Formula, SurfaceError> {
        check_domain(domain)?;
        Ok(Formula { coordinates: coordinates.map(|expr| expr.compile()), domain, sides: Sides::OPEN })
    }

    /// The same surface with sides that lie together, see [`Sides::found`].
    pub fn with_sides(self, sides: Sides) -> Formula {
        Formula { sides, ..self }
    }
}

/// Checks that ranges of parameters are finite and ascend.
pub(super) fn check_domain(domain: [[f64; 2]; 2]) -> Result<(), SurfaceError> {
    for [low, high] in domain {
        if !(low.is_finite() && high.is_finite() && low < high && (high - low).is_finite()) {
            return Err(SurfaceError::Parameter { value: if low.is_finite() { high } else { low } });
        }
    }
    Ok(())
}

impl Surface for Formula {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.domain
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        Vec3::from_array([0, 1, 2].map(|axis: usize| self.coordinates[axis].value(Vec3::new(u, v, 0.0))))
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let first = |u: f64, v: f64| {
            let slopes = [0, 1, 2].map(|axis: usize| self.coordinates[axis].gradient(Vec3::new(u, v, 0.0)));
            [0, 1, 2].map(|k: usize| {
                Vec3::from_array(slopes.map(|(value, slope)| if k == 0 { value } else { slope[k - 1] }))
            })
        };
        let [point, du, dv] = first(u, v);
        // Differences of slopes, inward at the borders.
        let step = |axis: usize| 6e-6 * (self.domain[axis][1] - self.domain[axis][0]);
        let around = |axis: usize, t: f64| {
            let [low, high] = self.domain[axis];
            [(t - step(axis)).max(low), (t + step(axis)).min(high)]
        };
        let ([a, b], [c, d]) = (around(0, u), around(1, v));
        let (left, right, below, above) = (first(a, v), first(b, v), first(u, c), first(u, d));
        Jet {
            point,
            du,
            dv,
            duu: (right[1] - left[1]) / (b - a),
            duv: 0.5 * ((right[2] - left[2]) / (b - a) + (above[1] - below[1]) / (d - c)),
            dvv: (above[2] - below[2]) / (d - c),
        }
    }

    fn sides(&self) -> Sides {
        self.sides
    }

    fn second_bounds(&self, part: [[f64; 2]; 2]) -> Option<[f64; 3]> {
        lengths(&self.second_ranges(part)?)
    }

    fn bends(&self, part: [[f64; 2]; 2]) -> Option<Bends> {
        of_ranges(self, part, &self.second_ranges(part)?)
    }
}

impl Formula {
    /// Ranges of the second derivatives by uu, uv and vv, of each coordinate.
    fn second_ranges(&self, [[a, b], [c, d]]: [[f64; 2]; 2]) -> Option<[[Interval; 3]; 3]> {
        let cell = Aabb { min: Vec3::new(a, c, 0.0), max: Vec3::new(b, d, 0.0) };
        let of = |axis: usize| {
            let [xx, yy, _, _, _, xy] = self.coordinates[axis].curvature(cell)?.hessian;
            Some([xx, xy, yy])
        };
        Some([of(0)?, of(1)?, of(2)?])
    }
}
