//! Explicit surfaces: points of space as functions of two parameters u and v.
//!
//! [`Patch`] is a tensor-product Bézier patch of any degrees, [`RationalPatch`] one with weights; they can be split,
//! measured and hit exactly as far as rounding allows. [`Surface`] is what everybody else needs of a surface, and what
//! a formula of one's own must bring: a domain and points. [`Classic`] holds the surfaces of the textbooks, [`Formula`]
//! three expressions, and [`Ruled`], [`Coons`], [`Tube`], [`Sweep`] are made of curves;
//! [`revolution`], [`loft`] and [`from_b_spline`] give patches.
//!
//! Normals point along the cross product of the derivatives by u and by v. Where that vanishes, on collapsed edges and at
//! poles, the limit from inside the domain is taken.
//!
//! ```
//! use ogee::math::Vec3;
//! use ogee::surface::{Patch, Surface};
//!
//! let corners = [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 1.0)].map(Vec3::from);
//! let saddle = Patch::new([1, 1], corners.to_vec())?;
//! assert_eq!(saddle.point(0.5, 0.5), Vec3::new(0.5, 0.5, 0.25));
//! assert!(saddle.jet(0.5, 0.5).curvature().unwrap().gauss < 0.0);
//! # Ok::<(), ogee::surface::SurfaceError>(())
//! ```

mod area;
mod b_spline;
mod bends;
mod classic;
mod classic_bends;
mod flat_in_ellipsoid;
mod flat_in_torus;
mod formula;
mod frames;
mod grid;
mod jet;
mod limit;
mod loft;
mod meeting;
mod nearest;
mod net;
mod patch;
mod rational;
mod round_triangle;
mod sides;
mod skin;
mod sweep;

pub use area::area;
pub use b_spline::from_b_spline;
pub use bends::{Across, Bends, Cone};
pub use classic::Classic;
pub use formula::Formula;
pub use jet::{Curvature, Jet};
pub use loft::loft;
pub use meeting::{Hit, ray_hits};
pub use nearest::{Nearest, nearest};
pub use patch::Patch;
pub(crate) use patch::check_degrees;
pub use rational::RationalPatch;
pub(crate) use round_triangle::least_distance;
pub use sides::{Gluing, Side, Sides};
pub use skin::{Coons, Ruled, revolution};
pub use sweep::{Sweep, Tube};

use crate::curve::CurveError;
use crate::math::{Vec3, Vec4};
use std::fmt;

/// A surface over a rectangle of parameters.
///
/// Only [`Surface::domain`] and [`Surface::point`] must be written; derivatives are then taken from differences. A
/// surface that brings [`Surface::second_bounds`] can be tessellated with a proven error, others are measured.
///
/// ```
/// use ogee::math::Vec3;
/// use ogee::surface::Surface;
///
/// struct Dish;
///
/// impl Surface for Dish {
///     fn domain(&self) -> [[f64; 2]; 2] {
///         [[-1.0, 1.0], [-1.0, 1.0]]
///     }
///     fn point(&self, u: f64, v: f64) -> Vec3 {
///         Vec3::new(u, v, u * u + v * v)
///     }
/// }
///
/// let normal = Dish.normal(0.0, 0.0).unwrap();
/// assert!((normal - Vec3::Z).length() < 1e-9);
/// ```
pub trait Surface: Sync {
    /// First and last parameter, of u and of v.
    fn domain(&self) -> [[f64; 2]; 2];

    /// The point at parameters of the domain.
    fn point(&self, u: f64, v: f64) -> Vec3;

    /// The points at many parameters, within rounding of [`Surface::point`].
    ///
    /// # Panics
    /// When there is not a place for each.
    fn points(&self, parameters: &[[f64; 2]], out: &mut [Vec3]) {
        assert_eq!(parameters.len(), out.len(), "a place for each point");
        for (place, &[u, v]) in out.iter_mut().zip(parameters) {
            *place = self.point(u, v);
        }
    }

    /// The points at many parameters with the derivatives by u and by v, within rounding of [`Surface::jet`].
    ///
    /// # Panics
    /// When there is not a place for each.
    fn tangents(&self, parameters: &[[f64; 2]], out: &mut [[Vec3; 3]]) {
        assert_eq!(parameters.len(), out.len(), "a place for each point");
        for (place, &[u, v]) in out.iter_mut().zip(parameters) {
            let jet = self.jet(u, v);
            *place = [jet.point, jet.du, jet.dv];
        }
    }

    /// The point and its first and second derivatives; by default from differences, good to about 1e-9 and 1e-5 of the
    /// size of the surface over that of its domain.
    fn jet(&self, u: f64, v: f64) -> Jet {
        jet::by_differences(self, u, v)
    }

    /// The unit normal, along the derivative by u times that by v; where that vanishes the limit from inside, `None`
    /// where there is none.
    fn normal(&self, u: f64, v: f64) -> Option<Vec3> {
        limit::normal(self, u, v)
    }

    /// How the sides of the domain lie together in space.
    fn sides(&self) -> Sides {
        Sides::OPEN
    }

    /// Parameters of each axis between which the surface is smooth, the ends of the domain left out: edges run there.
    fn creases(&self) -> [Vec<f64>; 2] {
        [Vec::new(), Vec::new()]
    }

    /// The control points of a side that is a Bézier curve, homogeneous (w x, w y, w z, w), from its smaller parameter
    /// on. Sides of surfaces with equal control points, forward or backward, are one edge; `None` for other curves.
    fn border_net(&self, _side: Side) -> Option<Vec<Vec4>> {
        None
    }

    /// Proven bounds of the lengths of the second derivatives by uu, uv and vv over a part of the domain, given as the
    /// ranges of u and of v; `None` where the surface brings none.
    fn second_bounds(&self, _part: [[f64; 2]; 2]) -> Option<[f64; 3]> {
        None
    }

    /// [`Surface::second_bounds`], and what of the second derivatives is across the surface: with that it takes fewer
    /// triangles where parameters are stretched unevenly.
    fn bends(&self, part: [[f64; 2]; 2]) -> Option<Bends> {
        self.second_bounds(part).map(|lengths| Bends { lengths, across: None })
    }

    /// A proven bound of the distance, both ways, between a flat triangle with its corners on the surface and the part of the
    /// surface that it stands for, from the corners alone: for surfaces where there is a close one in closed form. `None` for
    /// all triangles of other surfaces, infinite for triangles that stand for no part.
    ///
    /// That part is where a continuous map takes the triangle: from the middle of a sphere, the axis of a cylinder or the ring
    /// of a torus outward, along the paths of steepest ascent of an ellipsoid. The bound is of how far that moves its points.
    /// The parts of the triangles of a mesh without gaps cover the surface when none of its sides goes around farther than
    /// half a turn, in its parameters: then the mesh can be moved into the surface without crossing middle, axis or ring.
    fn triangle_bound(&self, _corners: [Vec3; 3]) -> Option<f64> {
        None
    }

    /// [`Surface::bends`] of all cells of a regular grid over the domain, v running fastest.
    fn bends_table(&self, cells: [usize; 2]) -> Option<Vec<Bends>> {
        let domain = self.domain();
        let at = |axis: usize, k: usize| {
            let [low, high] = domain[axis];
            if k == cells[axis] { high } else { low + (high - low) * k as f64 / cells[axis] as f64 }
        };
        let cell = |index: usize| {
            let (i, j) = (index / cells[1], index % cells[1]);
            self.bends([[at(0, i), at(0, i + 1)], [at(1, j), at(1, j + 1)]])
        };
        (0..cells[0] * cells[1]).map(cell).collect()
    }
}

/// What is wrong with the input of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceError {
    /// There is not the number of points or weights that the degrees ask for.
    Count {
        /// How many there are.
        actual: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A point, or what was computed from it, is NaN or infinite.
    NotFinite {
        /// Index of the point.
        index: usize,
    },
    /// A weight is not a positive number.
    Weight {
        /// Index of the weight.
        index: usize,
    },
    /// A parameter is outside the domain, or a part of it is empty.
    Parameter {
        /// The parameter.
        value: f64,
    },
    /// A number such as a radius must be positive.
    Number {
        /// Its name.
        name: &'static str,
        /// What it is.
        value: f64,
    },
    /// Curves that should meet do not.
    Corner {
        /// Number of the corner: (0,0), (1,0), (0,1), (1,1).
        corner: usize,
        /// How far apart they are.
        gap: f64,
    },
    /// A degree too high to compute with.
    Degree {
        /// The degree.
        actual: usize,
        /// The highest that is taken.
        most: usize,
    },
    /// A coordinate is not made of plain operations alone.
    NotPlain {
        /// Which one: 0, 1 or 2.
        axis: usize,
    },
    /// A path turns back on itself: nothing can be carried around that corner.
    Reversal {
        /// The parameter of the corner.
        parameter: f64,
    },
    /// A ray runs along a surface instead of meeting it in points.
    AlongRay,
    /// A curve that the surface is made of is wrong.
    Curve(CurveError),
}

impl fmt::Display for SurfaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SurfaceError::Count { actual, expected } => write!(f, "{actual} values where {expected} belong"),
            SurfaceError::NotFinite { index } => write!(f, "point {index} is not finite"),
            SurfaceError::Weight { index } => write!(f, "weight {index} is not a positive number"),
            SurfaceError::Parameter { value } => write!(f, "the parameter {value} is not in the domain"),
            SurfaceError::Number { name, value } => write!(f, "{name} is {value}, not a positive number"),
            SurfaceError::Corner { corner, gap } => {
                write!(f, "the curves miss each other by {gap} at corner {corner}")
            }
            SurfaceError::Degree { actual, most } => {
                write!(f, "degree {actual} where {most} is the highest")
            }
            SurfaceError::NotPlain { axis } => {
                write!(
                    f,
                    "coordinate {axis} is not one formula in plain operations: it must not choose between several"
                )
            }
            SurfaceError::Reversal { parameter } => write!(f, "the path turns back on itself at {parameter}"),
            SurfaceError::AlongRay => f.write_str("the ray runs along the surface"),
            SurfaceError::Curve(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for SurfaceError {}

impl From<CurveError> for SurfaceError {
    fn from(error: CurveError) -> SurfaceError {
        SurfaceError::Curve(error)
    }
}
