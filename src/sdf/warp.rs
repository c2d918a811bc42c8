//! Operators that bend space: twist, bend, taper, displacement, repetition, rounding of edges.
//!
//! The steepness of a warped field is that of the field times the norm of the warp's Jacobian, which grows without
//! bound far away. So the field is made flat beyond a margin around the shape: within it the norm has a bound, and the
//! distance to a box around the result takes over outside.

use super::Expr;
use super::expr::Op;
use super::graph::Graph;
use super::implicit::{BadNumber, Implicit, grown};
use super::op::{Binary, Blend};
use super::primitive::Primitive;
use crate::math::{Aabb, Vec3, cos, sin};
use std::f64::consts::PI;

/// Most copies that a repetition makes.
const MOST_COPIES: u64 = 1 << 16;

impl Implicit {
    /// Turned around the z axis by `rate` radians a unit of height. A bound, no steeper than 1.
    ///
    /// # Errors
    /// A rate that is not finite, a shape that is not known to be bounded.
    pub fn twist(&self, rate: f64) -> Result<Implicit, BadNumber> {
        BadNumber::finite("rate", rate)?;
        let bounds = self.known_bounds()?;
        let [x, y, z] = Expr::axes();
        let angle = &z * -rate;
        let (c, s) = (angle.cos(), angle.sin());
        let map = [&x * &c - &y * &s, &x * &s + &y * &c, z];
        let far = bounds.min.abs().max(bounds.max.abs());
        let radius = far.truncate().length();
        let enclosure = Aabb {
            min: Vec3::new(-radius, -radius, bounds.min.z),
            max: Vec3::new(radius, radius, bounds.max.z),
        };
        // The singular values of a shear by k times the radius are those of [1 k; 0 1].
        let shear = |margin: f64| rate.abs() * (radius + 2.0 * margin);
        let slope = |margin: f64| 0.5 * (shear(margin) + (shear(margin) * shear(margin) + 4.0).sqrt());
        Ok(self.warped(map, bounds, enclosure, 0.25 * bounds.size().max_element(), slope))
    }

    /// Bent around an axis parallel to z, so that the x axis becomes an arc of this radius with its centre at y = radius.
    /// Lengths along the x axis are kept. A bound, no steeper than 1.
    ///
    /// # Errors
    /// A radius that is not positive or does not exceed the shape's largest y; a shape that is not known to be bounded,
    /// or so long that its ends would meet.
    pub fn bend(&self, radius: f64) -> Result<Implicit, BadNumber> {
        let bounds = self.known_bounds()?;
        let must = "above the largest y of the shape, and finite";
        BadNumber::check("radius", must, radius, radius > bounds.max.y.max(0.0) && radius.is_finite())?;
        let half_turn = PI * radius;
        let reach = bounds.min.x.abs().max(bounds.max.x.abs());
        BadNumber::check("radius", "so large that the ends do not meet", radius, reach < half_turn)?;
        let [x, y, z] = Expr::axes();
        let below = radius - &y;
        let map = [x.atan2(below.clone()) * radius, radius - Expr::norm2(&x, &below), z];
        let outer = radius - bounds.min.y;
        let mut enclosure = Aabb { min: Vec3::splat(-outer), max: Vec3::splat(outer) };
        (enclosure.min.y, enclosure.max.y) = (radius - outer, radius + outer);
        (enclosure.min.z, enclosure.max.z) = (bounds.min.z, bounds.max.z);
        let margin = (half_turn - reach).min(0.5 * (radius - bounds.max.y));
        let slope = |margin: f64| (radius / (radius - bounds.max.y - margin)).max(1.0);
        Ok(self.warped(map, bounds, enclosure, margin, slope))
    }

    /// Scaled across the z axis: by 1 at the lowest z of the shape, by `top` at the highest, linearly between. A bound,
    /// no steeper than 1.
    ///
    /// # Errors
    /// A scale that is not positive, a shape that is not known to be bounded or has no height.
    pub fn taper(&self, top: f64) -> Result<Implicit, BadNumber> {
        BadNumber::positive("scale at the top", top)?;
        let bounds = self.known_bounds()?;
        let height = BadNumber::positive("height of the shape", bounds.size().z)?;
        let [x, y, z] = Expr::axes();
        let (rate, least, most) = ((top - 1.0) / height, top.min(1.0), top.max(1.0));
        let scale = ((&z - bounds.min.z) * rate + 1.0).max(least).min(most);
        let map = [&x / &scale, &y / &scale, z];
        let radius = bounds.min.abs().max(bounds.max.abs()).truncate().length();
        let enclosure = Aabb {
            min: Vec3::new(-radius * most, -radius * most, bounds.min.z),
            max: Vec3::new(radius * most, radius * most, bounds.max.z),
        };
        let slope = |margin: f64| 1.0 / least + rate.abs() * (radius + 2.0 * margin) / least;
        Ok(self.warped(map, bounds, enclosure, 0.25 * bounds.size().max_element(), slope))
    }

    /// The surface moved outward by what a formula says, at most `amplitude` either way; `lipschitz` is a bound of the
    /// formula's slope that the caller has proven. The sum is divided by both slopes: a bound, no steeper than 1.
    ///
    /// # Errors
    /// Numbers that are negative or not finite; a shape of unknown slope.
    pub fn displace(&self, by: &Expr, amplitude: f64, lipschitz: f64) -> Result<Implicit, BadNumber> {
        BadNumber::within("amplitude", "0 or more and finite", amplitude, f64::MAX)?;
        BadNumber::within("slope", "0 or more and finite", lipschitz, f64::MAX)?;
        let own = self.lipschitz().unwrap_or(f64::NAN);
        let slope = BadNumber::positive("slope of the shape", own)? + lipschitz;
        let sum = (self.expr() - by) * (1.0 / slope);
        let known = self.is_exact_outside();
        let bounds = if known { grown(self.bounds(), amplitude) } else { everywhere() };
        Ok(self.with_expr(sum).with_lipschitz(Some(1.0 + 8.0 * f64::EPSILON)).with_bounds(bounds))
    }

    /// Copies side by side: `counts` along each axis, the first where the shape is.
    ///
    /// # Errors
    /// Distances that are not finite, no copies or more than 65536.
    pub fn repeat(&self, distance: Vec3, counts: [u32; 3]) -> Result<Implicit, BadNumber> {
        let copies = counts.iter().fold(1_u64, |all, &count| all.saturating_mul(u64::from(count)));
        let must = "from 1 to 65536";
        BadNumber::check("number of copies", must, copies as f64, (1..=MOST_COPIES).contains(&copies))?;
        let [nx, ny, nz] = counts;
        let mut shapes = Vec::with_capacity(copies as usize);
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    let steps = Vec3::new(f64::from(x), f64::from(y), f64::from(z));
                    shapes.push(self.translate(steps * distance)?);
                }
            }
        }
        Ok(Implicit::union_all(&shapes))
    }

    /// Rounds the outward edges to this radius and leaves the faces where they are: edges of boxes, cylinders,
    /// octahedra and the ends of extrusions, and those between the parts of intersections and differences. Edges
    /// of unions point inward; blend those. Outlines and meshes keep theirs.
    ///
    /// # Errors
    /// A radius that is negative or too large for a primitive in it.
    pub fn round(&self, radius: f64) -> Result<Implicit, BadNumber> {
        BadNumber::within("radius", "0 or more and finite", radius, f64::MAX)?;
        if radius == 0.0 {
            return Ok(self.clone());
        }
        let (expr, arcs) = rounded(self.expr(), radius)?;
        // Each arc in another one multiplies the slope by up to sqrt 2.
        let grow = std::f64::consts::SQRT_2.powi(arcs) * (1.0 + f64::from(arcs) * f64::EPSILON);
        Ok(self.with_expr(expr).with_lipschitz(self.lipschitz().map(|l| l * grow)))
    }

    fn known_bounds(&self) -> Result<Aabb, BadNumber> {
        let size = self.bounds().size();
        BadNumber::check("size of the shape", "known and finite", size.max_element(), size.is_finite())?;
        Ok(self.bounds())
    }

    /// The shape seen through a map of coordinates. `enclosure` holds the result; `slope` bounds the norm of the map's
    /// Jacobian where the map leads within a margin of the shape's bounds.
    ///
    /// In the mapped coordinates the field is raised to the distance from the bounds, which changes no sign, and capped
    /// by the margin, so that it is flat beyond it.
    fn warped(
        &self,
        map: [Expr; 3],
        bounds: Aabb,
        enclosure: Aabb,
        margin: f64,
        slope: impl Fn(f64) -> f64,
    ) -> Implicit {
        let own = self.lipschitz();
        let steep = slope(margin) * own.unwrap_or(1.0).max(1.0) * (1.0 + 64.0 * f64::EPSILON);
        let confined = self.expr().max(box_around(bounds)).min(margin);
        let inner = confined.at(map) * (1.0 / steep);
        let whole = inner.max(box_around(enclosure));
        self.with_expr(whole).with_lipschitz(own.map(|_| 1.0 + 64.0 * f64::EPSILON)).with_bounds(enclosure)
    }
}

fn everywhere() -> Aabb {
    Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY }
}

/// The distance from a box.
fn box_around(bounds: Aabb) -> Expr {
    let center = bounds.center();
    let half = 0.5 * bounds.size();
    let axes = Expr::axes();
    let moved = std::array::from_fn(|i| &axes[i] - center[i]);
    // Rounding must not cut the shape.
    Expr::primitive(Primitive::Cuboid {
        half: half * (1.0 + 8.0 * f64::EPSILON) + center.abs() * f64::EPSILON * 4.0,
    })
    .at(moved)
}

/// A formula with its outward edges rounded, and how many arcs lie within each other at most.
fn rounded(expr: &Expr, radius: f64) -> Result<(Expr, i32), BadNumber> {
    let (graph, root) = Graph::of(expr);
    let mut done: Vec<(Expr, i32)> = Vec::with_capacity(graph.steps.len());
    for step in &graph.steps {
        let args: Vec<Expr> = step.args().iter().map(|&arg| done[arg as usize].0.clone()).collect();
        let arcs = step.args().iter().map(|&arg| done[arg as usize].1).max().unwrap_or(0);
        let new = match &step.op {
            Op::Binary(Binary::Max) => (args[0].blend_max(&args[1], Blend::Circular { radius }), arcs + 1),
            Op::Corner => {
                let inset = args.iter().map(|arg| arg + radius).collect();
                (Expr::new(Op::Corner, inset) - radius, arcs)
            }
            Op::Primitive(primitive) => {
                let (primitive, inset) = rounded_primitive(*primitive, radius);
                primitive.check()?;
                let shape = Expr::new(Op::Primitive(primitive), args);
                (if inset == 0.0 { shape } else { shape - inset }, arcs)
            }
            op => (Expr::new(op.clone(), args), arcs),
        };
        done.push(new);
    }
    Ok(done.swap_remove(root as usize))
}

/// A primitive with rounded edges, and by how much its surface is to be moved outward yet.
fn rounded_primitive(primitive: Primitive, radius: f64) -> (Primitive, f64) {
    match primitive {
        Primitive::Cuboid { half } => (Primitive::RoundedCuboid { half, radius }, 0.0),
        Primitive::RoundedCuboid { half, radius: own } => {
            (Primitive::RoundedCuboid { half, radius: own.max(radius) }, 0.0)
        }
        Primitive::Cylinder { radius: side, half_height, rounding } => {
            (Primitive::Cylinder { radius: side, half_height, rounding: rounding.max(radius) }, 0.0)
        }
        Primitive::Octahedron { radius: corner } => {
            (Primitive::Octahedron { radius: corner - 3.0_f64.sqrt() * radius }, radius)
        }
        other => (other, 0.0),
    }
}

/// The outline of a regular polygon around the origin, its first corner on the x axis.
pub(super) fn regular(sides: u32, radius: f64) -> Vec<crate::math::Vec2> {
    let corner = |i: u32| {
        let angle = 2.0 * PI * f64::from(i) / f64::from(sides);
        crate::math::Vec2::new(radius * cos(angle), radius * sin(angle))
    };
    (0..sides).map(corner).collect()
}
