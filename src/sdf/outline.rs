//! Shapes of the plane and what stands on them: polygons, extrusions, revolutions.

use super::implicit::{BadNumber, Implicit};
use super::number::within_reach;
use super::warp::regular;
use super::{Curvature, Expr, Field, Primitive, Range, Slopes};
use crate::math::{Aabb, Interval, Vec2, Vec3};
use crate::numeric::orient2d;
use std::sync::Arc;

/// The exact distance from plane contours, the same for every z: inside is where they wind around an odd number of
/// times, so that contours may be given in any order and direction.
#[derive(Clone, Debug)]
pub struct Polygon {
    edges: Vec<[Vec2; 2]>,
    /// Outward, one an edge.
    normals: Vec<Vec2>,
    bounds: [Vec2; 2],
}

/// Most edges of a polygon: every point looks at all of them.
const MOST_EDGES: usize = 4096;

/// Most edges of which slopes are told apart.
const MOST_NORMALS: usize = 64;

impl Polygon {
    /// The polygon within contours; the last corner of each is joined to its first.
    ///
    /// # Errors
    /// A corner that is not finite, or no edge at all.
    pub fn new(contours: &[Vec<Vec2>]) -> Result<Polygon, BadNumber> {
        let mut edges = Vec::new();
        for contour in contours {
            for (i, &a) in contour.iter().enumerate() {
                for x in [a.x, a.y] {
                    BadNumber::finite("coordinate of a corner", x)?;
                }
                let b = contour[(i + 1) % contour.len()];
                if a != b {
                    edges.push([a, b]);
                }
            }
        }
        let count = edges.len();
        BadNumber::check(
            "number of edges",
            "from 3 to 4096",
            count as f64,
            (3..=MOST_EDGES).contains(&count),
        )?;
        let corners = edges.as_flattened();
        let min = corners.iter().fold(Vec2::INFINITY, |least, &p| least.min(p));
        let max = corners.iter().fold(Vec2::NEG_INFINITY, |most, &p| most.max(p));
        let normals = (0..count).map(|edge| outward(&edges, edge)).collect();
        Ok(Polygon { edges, normals, bounds: [min, max] })
    }

    /// The square of the distance from an edge, and the vector from its nearest point.
    #[inline]
    fn from_edge([a, b]: [Vec2; 2], p: Vec2) -> (f64, Vec2) {
        let (along, to) = (b - a, p - a);
        let t = (to.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        // From the nearer end, so that the ends themselves are hit exactly.
        let offset = if t > 0.5 { (p - b) + along * (1.0 - t) } else { to - along * t };
        (offset.length_squared(), offset)
    }

    /// The distance, the vector from the nearest point, the nearest edge, and whether the point is inside.
    fn nearest(&self, p: Vec2) -> (f64, Vec2, usize, bool) {
        let (mut best, mut nearest, mut which, mut inside) = (f64::INFINITY, Vec2::NAN, 0, false);
        for (i, &[a, b]) in self.edges.iter().enumerate() {
            let (square, offset) = Polygon::from_edge([a, b], p);
            if square < best {
                (best, nearest, which) = (square, offset, i);
            }
            inside ^= crosses(a, b, p);
        }
        (best.sqrt(), nearest, which, inside)
    }

    fn signed(&self, p: Vec2) -> f64 {
        let (distance, _, _, inside) = self.nearest(p);
        if p.is_nan() {
            f64::NAN
        } else if inside {
            -distance
        } else {
            distance
        }
    }
}

/// The unit normal of an edge that points outward. A ray from its middle, across the edge's steeper axis, meets the others
/// an odd number of times when the side it sets out on is inside.
fn outward(edges: &[[Vec2; 2]], edge: usize) -> Vec2 {
    let [a, b] = edges[edge];
    let along = b - a;
    let upright = along.y.abs() >= along.x.abs();
    let seen = |p: Vec2| if upright { p } else { Vec2::new(p.y, p.x) };
    let from = seen(0.5 * a + 0.5 * b);
    let others = edges.iter().enumerate().filter(|&(i, _)| i != edge);
    let met = others.filter(|&(_, &[a, b])| crosses(seen(a), seen(b), from)).count();
    let ray = if upright { Vec2::X } else { Vec2::Y };
    let normal = along.perp().normalize_or_zero();
    let with_ray = if normal.dot(ray) > 0.0 { normal } else { -normal };
    if met % 2 == 1 { -with_ray } else { with_ray }
}

/// Whether the ray to the right of a point meets an edge, which owns its lower end.
fn crosses(a: Vec2, b: Vec2, from: Vec2) -> bool {
    if (a.y > from.y) == (b.y > from.y) {
        return false;
    }
    let turn = orient2d(a, b, from);
    if b.y > a.y { turn > 0.0 } else { turn < 0.0 }
}

impl Field for Polygon {
    fn value(&self, point: Vec3) -> f64 {
        self.signed(point.truncate())
    }

    fn gradient(&self, point: Vec3) -> (f64, Vec3) {
        let p = point.truncate();
        let (distance, offset, edge, inside) = self.nearest(p);
        let unit = if distance > 0.0 {
            offset / distance * if inside { -1.0 } else { 1.0 }
        } else {
            self.normals[edge]
        };
        (self.signed(p), unit.extend(0.0))
    }

    fn range(&self, cell: Aabb) -> Option<Range> {
        Some(Range::of(within_reach(flat(cell), 1.0, |p| self.signed(p.truncate()))))
    }

    fn slopes(&self, cell: Aabb) -> Option<Slopes> {
        let range = self.range(cell)?;
        let cell = flat(cell);
        let (middle, reach) = (cell.center().truncate(), 0.5 * cell.size().length());
        let distance = self.nearest(middle).0;
        // Whatever is nearest to a point of the cell is this near to its middle.
        let limit = (distance + 2.0 * reach) * (1.0 + 16.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        let near = |&i: &usize| Polygon::from_edge(self.edges[i], middle).0.sqrt() <= limit;
        let near: Vec<usize> = (0..self.edges.len()).filter(near).take(MOST_NORMALS + 1).collect();
        let known = !near.is_empty()
            && near.len() <= MOST_NORMALS
            && near.iter().all(|&i| self.normals[i] != Vec2::ZERO);
        let normals = near.iter().map(|&i| self.normals[i].extend(0.0));
        let mut gradient = if known { cone(normals) } else { [Interval::SIGNED_UNIT; 3] };
        gradient[2] = Interval::ZERO;
        Some(Slopes { range, gradient })
    }

    fn curvature(&self, cell: Aabb) -> Option<Curvature> {
        let slopes = self.slopes(cell)?;
        let straight = slopes.gradient.iter().all(|g| g.width() < 1e-9);
        let hessian = if straight { [Interval::ZERO; 6] } else { [Interval::ENTIRE; 6] };
        Some(Curvature { slopes, hessian })
    }

    fn lipschitz(&self) -> Option<f64> {
        Some(1.0 + 8.0 * f64::EPSILON)
    }

    fn cost(&self) -> usize {
        10 * self.edges.len()
    }
}

/// A cell without its third side.
fn flat(cell: Aabb) -> Aabb {
    Aabb { min: cell.min.with_z(0.0), max: cell.max.with_z(0.0) }
}

/// Bounds of the unit vectors in the convex cone of unit normals: where all agree on a sign the least of them, since
/// the sum of unit vectors is no longer than their number.
pub(super) fn cone(normals: impl Iterator<Item = Vec3>) -> [Interval; 3] {
    let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for normal in normals {
        (min, max) = (min.min(normal), max.max(normal));
    }
    let single = max - min == Vec3::ZERO;
    std::array::from_fn(|axis| {
        let (lo, hi) = (min[axis], max[axis]);
        let around = Interval::new(if lo >= 0.0 { lo } else { -1.0 }, if hi <= 0.0 { hi } else { 1.0 });
        // Normals are rounded.
        if single { Interval::point(lo).widened(4) } else { around.widened(4) }
    })
}

impl Implicit {
    /// The inside of plane contours, the same for every z. Exact.
    ///
    /// # Errors
    /// As [`Polygon::new`].
    pub fn polygon(contours: &[Vec<Vec2>]) -> Result<Implicit, BadNumber> {
        let polygon = Polygon::new(contours)?;
        let [min, max] = polygon.bounds;
        let bounds = Aabb { min: min.extend(f64::NEG_INFINITY), max: max.extend(f64::INFINITY) };
        let lipschitz = polygon.lipschitz();
        let expr = Expr::field(Arc::new(polygon));
        Ok(Implicit::formula(expr, lipschitz, bounds).with_exactness(true, true))
    }

    /// A circle around the origin, the same for every z. Exact.
    ///
    /// # Errors
    /// A radius that is not positive.
    pub fn circle(radius: f64) -> Result<Implicit, BadNumber> {
        BadNumber::positive("radius", radius)?;
        let [x, y, _] = Expr::axes();
        let far = Vec3::new(radius, radius, f64::INFINITY);
        let expr = Expr::norm2(&x, &y) - radius;
        Ok(Implicit::formula(expr, Some(1.0), Aabb { min: -far, max: far }).with_exactness(true, true))
    }

    /// The part of a shape of the plane (one that is the same for every z) between -half and half of a height. Exact
    /// when the shape is.
    ///
    /// # Errors
    /// A height that is not positive.
    pub fn extrude(&self, half_height: f64) -> Result<Implicit, BadNumber> {
        BadNumber::positive("half height", half_height)?;
        let ends = Expr::z().abs() - half_height;
        let mut bounds = self.bounds();
        (bounds.min.z, bounds.max.z) = (-half_height, half_height);
        Ok(self
            .with_expr(Expr::corner2(self.expr(), &ends))
            .with_lipschitz(self.lipschitz().map(|l| l.max(1.0)))
            .with_bounds(bounds)
            .with_exactness(self.is_exact_inside(), self.is_exact_outside()))
    }

    /// A shape of the plane turned around the z axis: its x becomes the distance from the axis, its y the height. What
    /// is left of x = 0 plays no part. Exact outside when the shape is; inside where it keeps off the axis or is
    /// its own mirror image.
    pub fn revolve(&self) -> Implicit {
        let [x, y, z] = Expr::axes();
        let map = [Expr::norm2(&x, &y), z, Expr::constant(0.0)];
        let Aabb { min, max } = self.bounds();
        let radius = max.x.max(0.0);
        let bounds = Aabb { min: Vec3::new(-radius, -radius, min.y), max: Vec3::new(radius, radius, max.y) };
        let whole = min.x >= 0.0;
        self.with_expr(self.expr().at(map))
            .with_bounds(if max.x < 0.0 || self.bounds().is_empty() { Aabb::EMPTY } else { bounds })
            .with_exactness(self.is_exact_inside() && whole && min.x > 0.0, self.is_exact_outside() && whole)
    }

    /// A cone around the z axis, or a frustum of one: its radii at the lower and the upper end, half of its height.
    /// Exact.
    ///
    /// # Errors
    /// Radii that are negative or both zero, a height that is not positive.
    pub fn frustum(radii: [f64; 2], half_height: f64) -> Result<Implicit, BadNumber> {
        BadNumber::positive("half height", half_height)?;
        radii
            .iter()
            .try_for_each(|&r| BadNumber::within("radius", "0 or more and finite", r, f64::MAX).map(drop))?;
        let [low, high] = radii;
        BadNumber::positive("larger radius", low.max(high))?;
        let h = half_height;
        let section = [(-low, -h), (low, -h), (high, h), (-high, h)].map(Vec2::from).to_vec();
        Ok(Implicit::polygon(&[section])?.revolve().with_exactness(true, true))
    }

    /// A prism over a regular polygon whose corners have this distance from the z axis; one of them is on the x axis.
    /// Exact.
    ///
    /// # Errors
    /// Fewer than three sides, lengths that are not positive.
    pub fn prism(sides: u32, radius: f64, half_height: f64) -> Result<Implicit, BadNumber> {
        BadNumber::check(
            "number of sides",
            "from 3 to 65536",
            f64::from(sides),
            (3..=65536).contains(&sides),
        )?;
        BadNumber::positive("radius", radius)?;
        Implicit::polygon(&[regular(sides, radius)])?.extrude(half_height)
    }

    /// Soft balls that flow into each other: inside is where their sum (of [`Primitive::Blob`]) exceeds `threshold`.
    /// Each has a centre, a radius where it ends, and a weight, its value at the centre. The difference is divided by
    /// the sum of slopes: a bound, no steeper than 1.
    ///
    /// # Errors
    /// Numbers that make no blob, a threshold that is not positive, no ball.
    pub fn metaballs(balls: &[(Vec3, f64, f64)], threshold: f64) -> Result<Implicit, BadNumber> {
        BadNumber::positive("threshold", threshold)?;
        BadNumber::check("number of balls", "1 or more", balls.len() as f64, !balls.is_empty())?;
        let mut terms = Vec::with_capacity(balls.len());
        let (mut slope, mut bounds) = (0.0, Aabb::EMPTY);
        for &(center, radius, weight) in balls {
            let blob = Primitive::Blob { radius, weight };
            let ball = Implicit::primitive(blob)?.translate(center)?;
            slope += blob.lipschitz();
            if weight > 0.0 {
                bounds = bounds.union(ball.bounds());
            }
            terms.push(ball.expr().clone());
        }
        let sum = balanced_sum(&terms);
        let slope = BadNumber::positive("sum of slopes", slope * (1.0 + balls.len() as f64 * f64::EPSILON))?;
        Ok(Implicit::formula((threshold - sum) * (1.0 / slope), Some(1.0 + 4.0 * f64::EPSILON), bounds))
    }
}

fn balanced_sum(terms: &[Expr]) -> Expr {
    match terms {
        [one] => one.clone(),
        more => {
            let (left, right) = more.split_at(more.len() / 2);
            balanced_sum(left) + balanced_sum(right)
        }
    }
}
