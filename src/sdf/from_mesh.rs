//! A mesh as a field: the distance to its nearest triangle, and the sign of its winding number.
//!
//! The winding number is the sum of the solid angles of all triangles over 4 pi, and those far away are summed as one
//! dipole each node of a tree: Barill, Dickson, Schmidt, Levin, Jacobson, Fast winding numbers for soups and clouds,
//! 2018. Solid angles: van Oosterom and Strackee, 1983. Nearest points of triangles: Ericson, Real-time collision
//! detection, 2005, section 5.1.5.

use super::implicit::{BadNumber, Implicit};
use super::number::within_reach;
use super::outline::cone;
use super::{Curvature, Expr, Field, Range, Slopes};
use crate::math::{Aabb, Interval, Vec3, atan2};
use crate::mesh::Solid;
use crate::spatial::Bvh;
use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::Arc;

/// The exact distance from the surface of a solid, negative where it winds around by more than a half.
///
/// For a solid that does not cross itself that is the inside, and the field is continuous, 1-Lipschitz and exact. Where
/// parts of it overlap, their faces within each other count as surface for the distance, though not for the sign.
#[derive(Clone, Debug)]
pub struct MeshField {
    corners: Vec<[Vec3; 3]>,
    normals: Vec<Vec3>,
    boxes: Vec<Aabb>,
    bvh: Bvh,
    /// For each node, level by level, what it is from afar.
    dipoles: Vec<Vec<Dipole>>,
    bounds: Aabb,
}

/// Triangles as seen from afar: the sum of their normals, scaled by their areas, at their mean place.
#[derive(Clone, Copy, Debug, Default)]
struct Dipole {
    place: Vec3,
    area: f64,
    normal: Vec3,
    /// No triangle reaches further from the place.
    radius: f64,
}

/// A node is one dipole from so many times its radius on. The paper's choice is 2; the error then stays far below the
/// half that decides.
const FAR: f64 = 2.3;

/// Most triangles of which slopes are told apart.
const MOST_NORMALS: usize = 64;

impl MeshField {
    /// The field of a solid.
    ///
    /// # Errors
    /// A solid without triangles.
    pub fn new(solid: &Solid) -> Result<MeshField, BadNumber> {
        let mesh = solid.mesh();
        let count = mesh.triangles.len();
        BadNumber::check("number of triangles", "positive", count as f64, count > 0)?;
        let corners: Vec<[Vec3; 3]> = (0..count).map(|i| mesh.corners(i)).collect();
        let normals = corners.iter().map(|&[a, b, c]| (b - a).cross(c - a).normalize_or_zero()).collect();
        let boxes: Vec<Aabb> = corners.iter().map(|&c| Aabb::of(c)).collect();
        let bvh = Bvh::new(&boxes);
        let dipoles = bvh.summed(
            |items| Dipole::of_triangles(items.iter().map(|&i| corners[i as usize])),
            Dipole::of_parts,
        );
        let bounds = mesh.bounds();
        Ok(MeshField { corners, normals, boxes, bvh, dipoles, bounds })
    }

    /// How often the surface winds around a point: near 1 inside, near 0 outside.
    pub fn winding_number(&self, p: Vec3) -> f64 {
        let total = RefCell::new(0.0);
        self.bvh.descend(
            |level, node| {
                let dipole = &self.dipoles[level][node];
                let to = dipole.place - p;
                let distance = to.length();
                if distance <= FAR * dipole.radius {
                    return true;
                }
                *total.borrow_mut() += dipole.normal.dot(to) / (distance * distance * distance);
                false
            },
            |item| *total.borrow_mut() += solid_angle(self.corners[item as usize], p),
        );
        total.into_inner() / (4.0 * PI)
    }

    /// The nearest triangle, and its nearest point.
    fn nearest(&self, p: Vec3) -> (usize, Vec3) {
        let square = |item: u32| (nearest_of(self.corners[item as usize], p) - p).length_squared();
        let item = self.bvh.nearest(&self.boxes, p, square).unwrap_or(0) as usize;
        (item, nearest_of(self.corners[item], p))
    }

    fn sign(&self, p: Vec3) -> f64 {
        let outside = !self.bounds.touches(Aabb::of([p])) || self.winding_number(p) < 0.5;
        if outside { 1.0 } else { -1.0 }
    }
}

impl Dipole {
    fn of_triangles(triangles: impl Iterator<Item = [Vec3; 3]> + Clone) -> Dipole {
        let parts = triangles.clone().map(|[a, b, c]| {
            let normal = 0.5 * (b - a).cross(c - a);
            Dipole { place: (a + b + c) / 3.0, area: normal.length(), normal, radius: 0.0 }
        });
        let parts: Vec<Dipole> = parts.collect();
        let mut whole = Dipole::of_parts(&parts);
        whole.radius =
            triangles.flatten().fold(0.0, |most: f64, corner| most.max(corner.distance(whole.place)));
        whole
    }

    fn of_parts(parts: &[Dipole]) -> Dipole {
        let area: f64 = parts.iter().map(|part| part.area).sum();
        let normal = parts.iter().map(|part| part.normal).sum();
        let weight = |part: &Dipole| if area > 0.0 { part.area / area } else { 1.0 / parts.len() as f64 };
        let place: Vec3 = parts.iter().map(|part| weight(part) * part.place).sum();
        let radius =
            parts.iter().fold(0.0, |most: f64, part| most.max(part.place.distance(place) + part.radius));
        Dipole { place, area, normal, radius }
    }
}

/// The solid angle of a triangle, positive seen from behind.
fn solid_angle(corners: [Vec3; 3], p: Vec3) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - p);
    let [la, lb, lc] = [a, b, c].map(Vec3::length);
    let turn = a.dot(b.cross(c));
    let across = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * atan2(turn, across)
}

/// The point of a triangle nearest to `p`.
fn nearest_of([a, b, c]: [Vec3; 3], p: Vec3) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    // Twice the areas between the point's foot and each edge.
    let (on_ab, on_ac, on_bc) = (d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4);
    if on_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if on_ac <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if on_bc <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = on_ab + on_ac + on_bc;
    a + ab * (on_ac / sum) + ac * (on_ab / sum)
}

impl MeshField {
    /// The triangles that may be nearest to a point of the cell, `MOST_NORMALS` + 1 at most.
    fn candidates(&self, cell: Aabb) -> Vec<u32> {
        let (middle, reach) = (cell.center(), 0.5 * cell.size().length());
        // Whatever is nearest to a point of the cell is this near to its middle.
        let limit = (self.nearest(middle).1.distance(middle) + 2.0 * reach) * (1.0 + 16.0 * f64::EPSILON)
            + f64::MIN_POSITIVE;
        let mut near = Vec::new();
        let around = Aabb { min: middle - limit, max: middle + limit };
        self.bvh.touching(&self.boxes, around, |item| {
            let distance = || nearest_of(self.corners[item as usize], middle).distance(middle);
            if near.len() <= MOST_NORMALS && distance() <= limit {
                near.push(item);
            }
        });
        near
    }

    /// Bounds of the second derivatives where the nearest triangles bulge towards the cell, `None` where they may not.
    ///
    /// All triangles around a nearest point are among the candidates. Where each of them lies behind the planes of all
    /// others, the nearest point is that of the convex set behind those planes, the distance from which is convex and no
    /// more curved than a sphere around the nearest point: its second derivatives have eigenvalues from 0 to 1 over
    /// the distance, elements beside the diagonal at most half of that.
    fn convex_curvature(&self, cell: Aabb, values: Interval) -> Option<[Interval; 6]> {
        let nearest = values.mignitude();
        let near = self.candidates(cell);
        if !(nearest > 0.0 && nearest.is_finite()) || near.len() > MOST_NORMALS {
            return None;
        }
        // Seen from inside, what is behind a plane is in front of it.
        let sign = if values.hi < 0.0 { -1.0 } else { 1.0 };
        let size = self.bounds.size().max_element();
        let behind = |i: u32, j: u32| {
            let (normal, [origin, ..]) = (self.normals[i as usize], self.corners[i as usize]);
            let above = |corner: Vec3| sign * normal.dot(corner - origin);
            // Corners are rounded: planes that bend by less than this are flat.
            normal != Vec3::ZERO
                && self.corners[j as usize].iter().all(|&corner| above(corner) <= 1e-12 * size)
        };
        if !near.iter().all(|&i| near.iter().all(|&j| i == j || behind(i, j))) {
            return None;
        }
        let most = (1.0 / nearest) * (1.0 + 1e-9);
        let along = if sign > 0.0 { Interval::new(0.0, most) } else { Interval::new(-most, 0.0) };
        let across = Interval::new(-0.5 * most, 0.5 * most);
        Some([along, along, along, across, across, across])
    }
}

impl Field for MeshField {
    fn value(&self, point: Vec3) -> f64 {
        if point.is_nan() {
            return f64::NAN;
        }
        let distance = self.nearest(point).1.distance(point);
        if distance == 0.0 { 0.0 } else { self.sign(point) * distance }
    }

    fn gradient(&self, point: Vec3) -> (f64, Vec3) {
        if point.is_nan() {
            return (f64::NAN, Vec3::NAN);
        }
        let (triangle, foot) = self.nearest(point);
        let (offset, distance) = (point - foot, foot.distance(point));
        if distance == 0.0 {
            return (0.0, self.normals[triangle]);
        }
        let sign = self.sign(point);
        (sign * distance, sign * offset / distance)
    }

    fn range(&self, cell: Aabb) -> Option<Range> {
        Some(Range::of(within_reach(cell, 1.0, |p| self.value(p))))
    }

    fn slopes(&self, cell: Aabb) -> Option<Slopes> {
        let range = self.range(cell)?;
        let near: Vec<Vec3> =
            self.candidates(cell).into_iter().map(|item| self.normals[item as usize]).collect();
        let known = !near.is_empty() && near.len() <= MOST_NORMALS && !near.contains(&Vec3::ZERO);
        let gradient = if known { cone(near.into_iter()) } else { [Interval::SIGNED_UNIT; 3] };
        Some(Slopes { range, gradient })
    }

    fn curvature(&self, cell: Aabb) -> Option<Curvature> {
        let slopes = self.slopes(cell)?;
        let flat = slopes.gradient.iter().all(|g| g.width() < 1e-9);
        let hessian = if flat {
            [Interval::ZERO; 6]
        } else {
            self.convex_curvature(cell, slopes.range.interval).unwrap_or([Interval::ENTIRE; 6])
        };
        Some(Curvature { slopes, hessian })
    }

    fn lipschitz(&self) -> Option<f64> {
        Some(1.0 + 8.0 * f64::EPSILON)
    }

    fn bounds(&self) -> Option<Aabb> {
        Some(self.bounds)
    }

    fn cost(&self) -> usize {
        2000
    }
}

impl Implicit {
    /// A solid mesh as a field. Exact where it does not cross itself.
    ///
    /// # Errors
    /// A solid without triangles.
    pub fn mesh(solid: &Solid) -> Result<Implicit, BadNumber> {
        let field = Arc::new(MeshField::new(solid)?);
        let (lipschitz, bounds) = (field.lipschitz(), field.bounds);
        Ok(Implicit::formula(Expr::field(field), lipschitz, bounds)
            .with_exactness(solid.is_embedded(), solid.is_embedded()))
    }
}
