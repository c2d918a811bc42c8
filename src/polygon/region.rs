use crate::math::Vec2;

/// A bounded part of the plane, with holes.
///
/// Contours are closed (the last vertex joins the first), have at least three vertices and do not cross each other or
/// themselves; they run counter-clockwise around the inside and clockwise around holes. Contours may touch at vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    contours: Vec<Vec<Vec2>>,
}

impl Region {
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
