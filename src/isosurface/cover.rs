//! Whether triangles are near every point of a thin piece of space.
//!
//! Seen across, the piece is a convex polygon between two heights. It is cut along the edges of the triangles into parts
//! that have one triangle under or over them each, so that pieces need not be as small as the tolerance where
//! triangles meet.

use super::near::distance_to_triangle;
use crate::math::{Vec2, Vec3};
use std::borrow::Cow;

/// Whether every point of the convex hull of `points` is proven to be within `reach` of a triangle, by looking along a
/// direction that should be across both.
pub(super) fn is_covered<'t>(
    points: &[Vec3],
    along: Vec3,
    triangles: &(impl Iterator<Item = &'t [Vec3; 3]> + Clone),
    reach: f64,
) -> bool {
    // The whole is less than its prism.
    let is_beside = |triangle: &[Vec3; 3]| points.iter().all(|&p| is_near(p, triangle, reach));
    parts_are_covered(points, along, triangles, reach) || triangles.clone().any(is_beside)
}

fn is_near(p: Vec3, triangle: &[Vec3; 3], reach: f64) -> bool {
    distance_to_triangle(*triangle, p).length_squared() <= reach * reach
}

/// The same for the prism around the points, cut into parts.
fn parts_are_covered<'t>(
    points: &[Vec3],
    along: Vec3,
    triangles: &(impl Iterator<Item = &'t [Vec3; 3]> + Clone),
    reach: f64,
) -> bool {
    let (Some(&origin), Some(normal)) = (points.first(), along.try_normalize()) else { return false };
    let view = View::new(origin, normal);
    let seen: Vec<Vec3> = points.iter().map(|&p| view.see(p)).collect();
    let heights =
        seen.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p.z), high.max(p.z)]);
    let outline = hull(seen.iter().map(|p| p.truncate()).collect());
    let size = outline.iter().fold(0.0, |most: f64, p| most.max(p.length_squared())).sqrt();
    // How far beyond a line may still count as on it, and what that may come to at the thinnest corner of a tile.
    let blur = 1e-10 * size;
    let reach = reach - 1e4 * blur;
    let (mut open, mut left) = (vec![outline], Vec::new());
    for triangle in triangles.clone() {
        let Some(tile) = Tile::of(triangle.map(|p| view.see(p)), blur) else { continue };
        for part in open.drain(..) {
            tile.leave_of(part, heights, reach, &mut left);
        }
        std::mem::swap(&mut open, &mut left);
        if open.is_empty() {
            return true;
        }
        if open.len() > MOST_PARTS {
            return false;
        }
    }
    // What nothing is straight under or over may still be beside a triangle.
    let is_beside = |part: &Vec<Vec2>, triangle: &[Vec3; 3]| {
        let mut ends = part.iter().flat_map(|p| heights.map(|z| view.place(p.extend(z))));
        ends.all(|p| is_near(p, triangle, reach))
    };
    open.iter().all(|part| triangles.clone().any(|triangle| is_beside(part, triangle)))
}

/// More parts than this are rather looked at in smaller pieces.
const MOST_PARTS: usize = 24;

/// A frame that looks along its third axis.
struct View {
    origin: Vec3,
    axes: [Vec3; 3],
}

impl View {
    fn new(origin: Vec3, normal: Vec3) -> View {
        let (across, up) = normal.any_orthonormal_pair();
        View { origin, axes: [across, up, normal] }
    }

    fn see(&self, p: Vec3) -> Vec3 {
        Vec3::from_array(self.axes.map(|axis| axis.dot(p - self.origin)))
    }

    fn place(&self, seen: Vec3) -> Vec3 {
        let [across, up, normal] = self.axes;
        self.origin + seen.x * across + seen.y * up + seen.z * normal
    }
}

/// A triangle as it is seen, counter-clockwise, with its height as a linear function.
struct Tile {
    corners: [Vec2; 3],
    height: f64,
    slope: Vec2,
    /// What reaches no further than this beyond a side counts as on it.
    blur: f64,
}

impl Tile {
    /// `None` for triangles that are seen too slantwise, or too thin for cuts along their sides to meet near their corners.
    fn of([a, b, c]: [Vec3; 3], blur: f64) -> Option<Tile> {
        let normal = (b - a).cross(c - a);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        if normal.z.abs() <= (0.5 * normal.length()).max(THIN * longest) {
            return None;
        }
        let slope = -normal.truncate() / normal.z;
        let corners = if normal.z > 0.0 { [a, b, c] } else { [a, c, b] }.map(Vec3::truncate);
        Some(Tile { corners, height: a.z - slope.dot(a.truncate()), slope, blur })
    }

    /// Adds the parts of a convex polygon that are not over or under the triangle; all of it when the triangle is too far
    /// up or down.
    fn leave_of(&self, part: Vec<Vec2>, heights: [f64; 2], reach: f64, left: &mut Vec<Vec<Vec2>>) {
        let sides = [0, 1, 2].map(|i| Cut::along(self.corners[i], self.corners[(i + 1) % 3]));
        if sides.iter().any(|side| side.reaches(&part, 1.0) <= self.blur) {
            left.push(part);
            return;
        }
        let before = left.len();
        let mut inside = Cow::Borrowed(&part);
        for side in &sides {
            if side.reaches(&inside, -1.0) > self.blur {
                let (kept, rest) = side.halves(&inside);
                left.push(rest);
                inside = Cow::Owned(kept);
            }
        }
        let is_near = |p: &Vec2| {
            let height = self.height + self.slope.dot(*p);
            heights.iter().all(|z| (z - height).abs() <= reach)
        };
        if !inside.iter().all(is_near) {
            left.truncate(before);
            left.push(part);
        }
    }
}

/// Triangles whose height is a smaller part of their longest side are no help.
const THIN: f64 = 1e-3;

/// A line to cut convex polygons along.
struct Cut {
    from: Vec2,
    /// Of unit length, to the left.
    across: Vec2,
}

impl Cut {
    fn along(from: Vec2, to: Vec2) -> Cut {
        Cut { from, across: (to - from).perp().normalize() }
    }

    fn offset(&self, p: Vec2) -> f64 {
        self.across.dot(p - self.from)
    }

    /// How far a polygon reaches to the left, or with a sign of -1 to the right.
    fn reaches(&self, polygon: &[Vec2], sign: f64) -> f64 {
        polygon.iter().fold(f64::NEG_INFINITY, |most, &p| most.max(sign * self.offset(p)))
    }

    /// What is on the left and what is on the right.
    fn halves(&self, polygon: &[Vec2]) -> (Vec<Vec2>, Vec<Vec2>) {
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for (i, &p) in polygon.iter().enumerate() {
            let q = polygon[(i + 1) % polygon.len()];
            let [here, there] = [self.offset(p), self.offset(q)];
            if here >= 0.0 {
                left.push(p);
            }
            if here <= 0.0 {
                right.push(p);
            }
            if here * there < 0.0 {
                let crossing = p + (q - p) * (here / (here - there));
                left.push(crossing);
                right.push(crossing);
            }
        }
        (left, right)
    }
}

/// The convex hull, counter-clockwise (Andrew 1979).
fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
    points.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let chain = |points: &mut dyn Iterator<Item = Vec2>| {
        let mut chain: Vec<Vec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut whole = chain(&mut points.iter().copied());
    whole.extend(chain(&mut points.iter().rev().copied()));
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(reach: f64) -> impl Strategy<Value = Vec3> {
        [-reach..reach, -reach..reach, -0.2..0.2].prop_map(Vec3::from_array)
    }

    /// Two triangles with a side in common, and some more.
    fn roof() -> impl Strategy<Value = Vec<[Vec3; 3]>> {
        (proptest::array::uniform4(point(1.0)), proptest::collection::vec(point(1.5), 6)).prop_map(
            |([a, b, c, d], more)| {
                let mut triangles = vec![[a, b, c], [a, c, d]];
                triangles.extend(more.as_chunks().0);
                triangles
            },
        )
    }

    proptest! {
        /// Wherever it says yes, points between the corners are near.
        #[test]
        fn what_is_covered_is_near(
            triangles in roof(),
            points in proptest::collection::vec(point(0.5), 4..9),
            shares in proptest::collection::vec(proptest::collection::vec(0.0..1.0_f64, 8), 50),
            reach in 0.1..0.6,
        ) {
            if is_covered(&points, Vec3::Z, &triangles.iter(), reach) {
                for share in shares {
                    let sum: f64 = share.iter().zip(&points).map(|(s, _)| s).sum();
                    let p = share.iter().zip(&points).map(|(s, p)| *p * (s / sum)).sum::<Vec3>();
                    let distance = |t: &[Vec3; 3]| distance_to_triangle(*t, p).length();
                    let nearest = triangles.iter().map(distance).fold(f64::INFINITY, f64::min);
                    prop_assert!(nearest <= reach, "{nearest} of {reach}");
                }
            }
        }
    }

    /// A square of many triangles covers what is thinner than the reach, whatever edges run through it, and not what
    /// reaches beyond it.
    #[test]
    fn several_triangles_cover_together() {
        let corner = |i: i32, j: i32| Vec3::new(f64::from(i), f64::from(j), 0.0);
        let cells = (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
        let triangles: Vec<[Vec3; 3]> = cells
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let covers = |least: f64, most: f64, height: f64| {
            let ends = [[least, 0.5], [most, 0.7], [2.1, most], [1.3, 2.9]];
            let points: Vec<Vec3> =
                ends.iter().flat_map(|&[x, y]| [0.0, height].map(|z| Vec3::new(x, y, z))).collect();
            is_covered(&points, Vec3::new(0.0, 0.0, -2.0), &triangles.iter(), 0.01)
        };
        assert!(covers(0.2, 3.8, 0.009) && covers(0.0, 4.0, 0.009));
        assert!(!covers(0.2, 3.8, 0.011) && !covers(0.2, 4.02, 0.009));
        assert!(covers(-0.004, 4.0, 0.005));
    }
}
