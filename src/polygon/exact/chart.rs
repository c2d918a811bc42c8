use super::{Plane, PointId, Points};
use crate::math::Vec3;
use std::cmp::Ordering;

/// A plane seen along the axis of its longest normal component: two coordinates order its points from left to right
/// (those at one abscissa from bottom to top), and orientations are counter-clockwise about its normal.
#[derive(Clone, Debug)]
pub struct Chart {
    plane: Plane,
    axis: usize,
}

/// A line of a chart: where another plane crosses the chart's own.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    plane: Plane,
    /// The side of `plane` that lies above the line (to the left of it, seen from left to right).
    above: i32,
}

impl Line {
    /// 1 for a point of the chart above the line, 0 on it, -1 below.
    #[inline]
    pub fn side(&self, points: &Points, point: PointId) -> i32 {
        self.above * self.plane.side(points, point)
    }

    /// The plane that crosses the chart's own.
    pub fn plane(&self) -> &Plane {
        &self.plane
    }
}

impl Chart {
    /// The chart of a plane. Its normal is turned so that the longest component is positive.
    pub fn new(plane: &Plane) -> Chart {
        let axis = plane.main_axis();
        let plane = if plane.normal_sign(axis) < 0 { plane.flipped() } else { *plane };
        Chart { plane, axis }
    }

    /// The plane, with a positive longest normal component.
    pub fn plane(&self) -> &Plane {
        &self.plane
    }

    /// The axis that is dropped.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// The line where `other` crosses the chart; `None` for parallel planes.
    pub fn line(&self, other: &Plane) -> Option<Line> {
        // The line runs along the product of the normals; the side is turned so that it runs from left to right.
        let along = |axis: usize| self.plane.cross_sign(other, axis % 3);
        let direction = [along(self.axis + 1), along(self.axis + 2)].into_iter().find(|&sign| sign != 0)?;
        Some(Line { plane: *other, above: -direction })
    }

    /// The line through two lattice points of the chart; `None` when they are the same.
    pub fn line_through(&self, points: &Points, a: PointId, b: PointId) -> Option<Line> {
        let plane = Plane::along_axis(points.as_site(a)?, points.as_site(b)?, self.axis)?;
        self.line(&plane)
    }

    /// Orders points of the chart from left to right and, at one abscissa, from bottom to top.
    pub fn compare(&self, points: &Points, a: PointId, b: PointId) -> Ordering {
        let by = |axis: usize| points.compare(a, b, axis % 3);
        by(self.axis + 1).then_with(|| by(self.axis + 2))
    }

    /// 1 when the triangle runs counter-clockwise about the normal, 0 when its corners lie on a line.
    #[inline]
    pub fn orientation(&self, points: &Points, a: PointId, b: PointId, c: PointId) -> i32 {
        points.orientation(a, b, c, self.axis)
    }

    /// Coordinates within the plane, of unit scale along both, in doubles: for choices that need not be exact.
    pub fn flatten(&self, p: Vec3) -> [f64; 2] {
        let n = Vec3::from_array(self.plane.rounded_normal()).normalize();
        let (u, v) = n.any_orthonormal_pair();
        [p.dot(u), p.dot(v)]
    }
}
