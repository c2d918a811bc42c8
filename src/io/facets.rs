use super::{Place, Problem, ReadError};
use crate::math::{Vec2, Vec3};
use crate::mesh::Mesh;
use crate::polygon;

/// Polygons as a file holds them. They become triangles when all positions are known, since some formats let a
/// face come before its vertices.
#[derive(Default)]
pub(super) struct Facets {
    corners: Vec<u32>,
    faces: Vec<Face>,
}

struct Face {
    /// One past its last corner.
    end: usize,
    at: Place,
}

impl Facets {
    /// With room for that many triangles.
    pub(super) fn with_capacity(triangles: usize) -> Facets {
        Facets { corners: Vec::with_capacity(3 * triangles), faces: Vec::with_capacity(triangles) }
    }

    /// Adds a corner to the face at hand, by the index of its vertex from 0.
    pub(super) fn corner(&mut self, vertex: u32) {
        self.corners.push(vertex);
    }

    /// Ends the face at hand. A face of one or two corners bounds nothing and is left out.
    pub(super) fn end_face(&mut self, at: Place) -> Result<(), ReadError> {
        let start = self.faces.last().map_or(0, |face| face.end);
        if self.corners.len() - start < 3 {
            self.corners.truncate(start);
            return Ok(());
        }
        // A polygon makes fewer triangles than it has corners.
        super::check_count(self.corners.len() - 2 * self.faces.len(), at)?;
        self.faces.push(Face { end: self.corners.len(), at });
        Ok(())
    }

    /// The mesh of these faces. `first` is how the file numbers its first vertex.
    pub(super) fn mesh(self, positions: Vec<Vec3>, first: i64) -> Result<Mesh, ReadError> {
        let mut triangles = Vec::with_capacity(self.faces.len());
        let mut start = 0;
        for face in &self.faces {
            let polygon = &self.corners[start..face.end];
            if let Some(&beyond) = polygon.iter().find(|&&v| v as usize >= positions.len()) {
                let problem =
                    Problem::NoSuchVertex { index: i64::from(beyond) + first, count: positions.len() };
                return Err(ReadError { at: face.at, problem });
            }
            match *polygon {
                [a, b, c] => triangles.push([a, b, c]),
                _ => triangulate(polygon, &positions, &mut triangles),
            }
            start = face.end;
        }
        Ok(Mesh { positions, triangles })
    }
}

/// Cuts a polygon of four or more corners along diagonals, in the coordinate plane that shows most of it.
///
/// A polygon that crosses itself there has no such cut; it becomes the fan about its first corner, which has the
/// same border.
fn triangulate(polygon: &[u32], positions: &[Vec3], triangles: &mut Vec<[u32; 3]>) {
    let mut corners = polygon.to_vec();
    corners.dedup();
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let flat = shadow(&corners, positions);
    if is_surely_convex(&flat) {
        return fan(&corners, triangles);
    }
    match polygon::triangulate::simple(&flat) {
        Ok(cut) => triangles.extend(cut.iter().map(|t| t.map(|i| corners[i as usize]))),
        Err(_) => fan(&corners, triangles),
    }
}

fn fan(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    if let [apex, rim @ ..] = corners {
        triangles.extend(rim.windows(2).map(|side| [*apex, side[0], side[1]]));
    }
}

/// The polygon without one coordinate, so without rounding: the one along which its normal is longest. It runs
/// counter-clockwise.
fn shadow(corners: &[u32], positions: &[Vec3]) -> Vec<Vec2> {
    let normal = doubled_area_vector(corners, positions);
    let dropped = normal.abs().max_position();
    let (next, last) = ((dropped + 1) % 3, (dropped + 2) % 3);
    let (across, up) = if normal[dropped] < 0.0 { (last, next) } else { (next, last) };
    let flat = |&v: &u32| Vec2::new(positions[v as usize][across], positions[v as usize][up]);
    corners.iter().map(flat).collect()
}

/// Twice the vector area, about the first corner; its direction is the normal, rounded.
fn doubled_area_vector(corners: &[u32], positions: &[Vec3]) -> Vec3 {
    let [first, rim @ ..] = corners else { return Vec3::ZERO };
    let origin = positions[*first as usize];
    let arm = |v: u32| positions[v as usize] - origin;
    rim.windows(2).map(|side| arm(side[0]).cross(arm(side[1]))).sum()
}

/// Whether every corner turns left, beyond the doubt of rounding, and the polygon goes round once.
fn is_surely_convex(polygon: &[Vec2]) -> bool {
    let count = polygon.len();
    let corner = |i: usize| polygon[i % count];
    let turns_left = (0..count).all(|i| surely_left(corner(i), corner(i + 1), corner(i + 2)));
    let goes_right = |i: usize| corner(i).x < corner(i + 1).x;
    turns_left && (0..count).filter(|&i| goes_right(i) != goes_right(i + 1)).count() == 2
}

/// Whether `c` is left of the line from `a` to `b`; `false` where rounding leaves doubt. The bound is that of
/// Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates (1997).
fn surely_left(a: Vec2, b: Vec2, c: Vec2) -> bool {
    const BOUND: f64 = (3.0 + 16.0 * f64::EPSILON) * (f64::EPSILON / 2.0);
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let size = left.abs() + right.abs();
    // Below this, products may have lost their bits to underflow.
    size > f64::MIN_POSITIVE / f64::EPSILON && left - right > BOUND * size
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vector area and border of what becomes of a polygon.
    fn check(points: &[[f64; 3]]) -> Vec<[u32; 3]> {
        let positions: Vec<Vec3> = points.iter().map(|&p| Vec3::from_array(p)).collect();
        let polygon: Vec<u32> = (0..positions.len() as u32).collect();
        let mut triangles = Vec::new();
        triangulate(&polygon, &positions, &mut triangles);
        assert_eq!(triangles.len(), positions.len() - 2);
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            0.5 * (b - a).cross(c - a)
        };
        let whole = 0.5 * doubled_area_vector(&polygon, &positions);
        let sum: Vec3 = triangles.iter().map(area).sum();
        let sizes: f64 = triangles.iter().map(|t| area(t).length()).sum();
        assert!((sum - whole).length() <= 1e-12 * sizes, "{sum} {whole}");
        // No triangle sticks out: the sizes add up to the size of the whole when the polygon is flat.
        assert!((sizes - whole.length()).abs() <= 1e-12 * sizes, "{sizes} {}", whole.length());
        assert_eq!(border(&triangles), sides(&polygon));
        triangles
    }

    fn sides(polygon: &[u32]) -> Vec<[u32; 2]> {
        let mut sides: Vec<[u32; 2]> = polygon.windows(2).map(|s| [s[0], s[1]]).collect();
        sides.push([*polygon.last().unwrap(), polygon[0]]);
        sides.sort_unstable();
        sides
    }

    fn border(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let all: Vec<[u32; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let mut single: Vec<[u32; 2]> =
            all.iter().filter(|&&[a, b]| !all.contains(&[b, a])).copied().collect();
        single.sort_unstable();
        single
    }

    #[test]
    fn convex_polygons_become_fans() {
        let square = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
        assert_eq!(check(&square), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_polygons_lose_nothing_in_any_plane() {
        let arrow = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [3.0, 1.0]];
        let star: Vec<[f64; 2]> = (0..14)
            .map(|i| {
                let (sin, cos) = crate::math::sin_cos(f64::from(i) * std::f64::consts::PI / 7.0);
                let radius = if i % 2 == 0 { 5.0 } else { 1.0 };
                [radius * cos, radius * sin]
            })
            .collect();
        for outline in [arrow.as_slice(), &star] {
            for turn in 0..3 {
                for tilt in [0.0, 0.5, -2.0] {
                    let lift = |&[u, v]: &[f64; 2]| {
                        let mut p = [u, v, tilt * u + 0.25 * v];
                        p.rotate_left(turn);
                        p
                    };
                    let mut points: Vec<[f64; 3]> = outline.iter().map(lift).collect();
                    check(&points);
                    points.reverse();
                    check(&points);
                }
            }
        }
    }

    #[test]
    fn corners_on_a_straight_side_stay_on_the_border() {
        check(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]);
    }

    #[test]
    fn a_polygon_that_goes_round_twice_is_not_convex() {
        let pentagram: Vec<Vec2> = (0..5)
            .map(|i| crate::math::sin_cos(f64::from(i) * 0.8 * std::f64::consts::PI))
            .map(|(sin, cos)| Vec2::new(cos, sin))
            .collect();
        assert!((0..5).all(|i| surely_left(pentagram[i], pentagram[(i + 1) % 5], pentagram[(i + 2) % 5])));
        assert!(!is_surely_convex(&pentagram));
    }

    #[test]
    fn broken_polygons_keep_their_border() {
        let cases: [&[[f64; 3]]; 3] = [
            &[[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            &[[0.0; 3]; 5],
            &[[f64::NAN, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, f64::INFINITY, 0.0], [0.0, 1.0, 0.0]],
        ];
        for points in cases {
            let positions: Vec<Vec3> = points.iter().map(|&p| Vec3::from_array(p)).collect();
            let polygon: Vec<u32> = (0..positions.len() as u32).collect();
            let mut triangles = Vec::new();
            triangulate(&polygon, &positions, &mut triangles);
            assert_eq!(border(&triangles), sides(&polygon), "{points:?}");
        }
    }
}
