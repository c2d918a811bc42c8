use super::combine::{FillRule, combine};
use crate::math::Vec2;
use std::fmt;

/// A bounded part of the plane, with holes.
///
/// Contours are closed (the last vertex joins the first), have at least three vertices and do not cross each other or
/// themselves; they run counter-clockwise around the inside and clockwise around holes. Contours may touch, and where they
/// do, both have a vertex.
///
/// ```
/// use ogee::math::Vec2;
/// use ogee::polygon::{FillRule, Region};
///
/// let star = [(0.0, 3.0), (1.8, -2.4), (-2.9, 0.9), (2.9, 0.9), (-1.8, -2.4)];
/// let star: Vec<Vec2> = star.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
/// let filled = Region::new(&[star.clone()], FillRule::NonZero)?;
/// let hollow = Region::new(&[star], FillRule::EvenOdd)?;
/// assert_eq!(filled.contours().len(), 1);
/// assert_eq!(hollow.contours().len(), 5);
/// # Ok::<(), ogee::polygon::RegionError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    contours: Vec<Vec<Vec2>>,
}

/// Why contours bound no region.
#[derive(Clone, Debug, PartialEq)]
pub enum RegionError {
    /// A coordinate is NaN or infinite.
    NotFinite {
        /// Index of the contour.
        contour: usize,
        /// Index of the vertex in it.
        vertex: usize,
    },
}

impl fmt::Display for RegionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RegionError::NotFinite { contour, vertex } => {
                write!(f, "vertex {vertex} of contour {contour} is not finite")
            }
        }
    }
}

impl std::error::Error for RegionError {}

impl Region {
    /// What closed contours enclose by a rule. They may cross, overlap and run either way; contours without area
    /// enclose nothing.
    ///
    /// Exact but for the positions of new vertices, which are rounded to doubles.
    ///
    /// # Errors
    /// [`RegionError::NotFinite`].
    pub fn new(contours: &[Vec<Vec2>], rule: FillRule) -> Result<Region, RegionError> {
        for (contour, vertices) in contours.iter().enumerate() {
            if let Some(vertex) = vertices.iter().position(|p| !p.is_finite()) {
                return Err(RegionError::NotFinite { contour, vertex });
            }
        }
        Ok(combine(&[contours], 0.0, |winding| rule.holds(winding.first().map_or(0, |&(_, times)| times))))
    }

    /// A region made by an algorithm that keeps the promises by construction.
    pub(crate) fn assume(contours: Vec<Vec<Vec2>>) -> Region {
        Region { contours }
    }

    /// The contours.
    pub fn contours(&self) -> &[Vec<Vec2>] {
        &self.contours
    }

    /// Whether it holds no point.
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }

    /// Area, in square model units.
    pub fn area(&self) -> f64 {
        let twice = |contour: &Vec<Vec2>| -> f64 {
            let origin = contour[0];
            contour.windows(2).map(|edge| (edge[0] - origin).perp_dot(edge[1] - origin)).sum()
        };
        self.contours.iter().map(|contour| 0.5 * twice(contour)).sum()
    }
}
