use super::{Bends, Gluing, Jet, Sides, Surface, SurfaceError, classic_bends, round_triangle};
use crate::math::{Vec3, pow, sin_cos_degrees};
use std::f64::consts::PI;

/// The surfaces of the textbooks, about the origin, z up. Angles are in turns: u and v run over [0, 1] unless said
/// otherwise. Closed ones have their normals outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Classic {
    /// A rectangle in z = 0, by its extents.
    Plane {
        /// Extents along x and y.
        size: [f64; 2],
    },
    /// A sphere; u is longitude, v runs from the south pole to the north pole.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// An ellipsoid; u and v as of the sphere.
    Ellipsoid {
        /// Half axes.
        radii: [f64; 3],
    },
    /// An ellipsoid with rounded or sharpened corners: `|x/a|^(2/e) + |y/b|^(2/e)` to the power e/n, and `|z/c|^(2/n)`
    /// (Barr, Superquadrics and angle-preserving transformations, 1981). u and v are the angles of Barr's powers for exponents
    /// of 1 and more, and the directions themselves for smaller ones.
    Superellipsoid {
        /// Half axes.
        radii: [f64; 3],
        /// Exponents n, of a meridian, and e, of the equator; 1 is an ellipse, less a box, 2 a diamond.
        exponents: [f64; 2],
    },
    /// The mantle of a cylinder about z, from z = 0.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Height.
        height: f64,
    },
    /// The mantle of a cone about z, from z = 0 up to its tip.
    Cone {
        /// Radius of the base.
        radius: f64,
        /// Height.
        height: f64,
    },
    /// A torus about z; u turns about the axis, v about the tube.
    Torus {
        /// Distance of the tube's middle from the axis.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// A Moebius strip of a half twist.
    Moebius {
        /// Radius of the circle in its middle.
        radius: f64,
        /// Width of the strip.
        width: f64,
    },
    /// A Klein bottle, as the figure of eight turned about an axis with half a twist: it crosses itself in a circle.
    Klein {
        /// Radius of the circle in its middle.
        radius: f64,
        /// Radius of the lobes.
        minor: f64,
    },
    /// A helicoid about z.
    Helicoid {
        /// Radius.
        radius: f64,
        /// Height of a turn.
        pitch: f64,
        /// Number of turns.
        turns: f64,
    },
    /// Enneper's minimal surface over a square of parameters from -reach to reach.
    Enneper {
        /// Largest parameter.
        reach: f64,
    },
}

impl Classic {
    /// Checks that the numbers are positive and finite.
    ///
    /// # Errors
    /// [`SurfaceError::Number`] for the first that is not.
    pub fn checked(self) -> Result<Classic, SurfaceError> {
        let numbers: Vec<(&'static str, f64)> = match self {
            Classic::Plane { size } => size.map(|x| ("size", x)).to_vec(),
            Classic::Sphere { radius } => vec![("radius", radius)],
            Classic::Ellipsoid { radii } => radii.map(|x| ("a radius", x)).to_vec(),
            Classic::Superellipsoid { radii, exponents } => {
                let mut all = radii.map(|x| ("a radius", x)).to_vec();
                all.extend(exponents.map(|x| ("an exponent", x)));
                all
            }
            Classic::Cylinder { radius, height } | Classic::Cone { radius, height } => {
                vec![("radius", radius), ("height", height)]
            }
            Classic::Torus { major, minor } => vec![("the major radius", major), ("the minor radius", minor)],
            Classic::Moebius { radius, width } => vec![("radius", radius), ("width", width)],
            Classic::Klein { radius, minor } => vec![("radius", radius), ("the minor radius", minor)],
            Classic::Helicoid { radius, pitch, turns } => {
                vec![("radius", radius), ("pitch", pitch), ("turns", turns)]
            }
            Classic::Enneper { reach } => vec![("reach", reach)],
        };
        match numbers.iter().find(|(_, x)| !(*x > 0.0 && x.is_finite())) {
            Some(&(name, value)) => Err(SurfaceError::Number { name, value }),
            None => Ok(self),
        }
    }
}

/// Cosine and sine of a share of a full turn, exact at quarters.
fn turn(share: f64) -> [f64; 2] {
    let (sine, cosine) = sin_cos_degrees(360.0 * share);
    [cosine, sine]
}

/// Cosine and sine of the latitude that runs from -90 to 90 degrees.
fn latitude(share: f64) -> [f64; 2] {
    let (sine, cosine) = sin_cos_degrees(180.0 * share - 90.0);
    [cosine, sine]
}

/// The point of the curve `|x|^(2/e) + |y|^(2/e) = 1` for a direction: its powers, which bend evenly for exponents of 1
/// and more but rush away from the axes for smaller ones; there the point in that direction.
fn superellipse(direction: [f64; 2], exponent: f64) -> [f64; 2] {
    if exponent >= 1.0 {
        return direction.map(|t| signed_power(t, exponent));
    }
    let [x, y] = direction;
    // Over the larger one, so that nothing leaves the range of numbers.
    let most = x.abs().max(y.abs());
    let sum = pow(x.abs() / most, 2.0 / exponent) + pow(y.abs() / most, 2.0 / exponent);
    let radius = pow(sum, -0.5 * exponent) / most;
    [radius * x, radius * y]
}

/// A power that keeps the sign of the base.
fn signed_power(x: f64, exponent: f64) -> f64 {
    pow(x.abs(), exponent).copysign(x)
}

impl Surface for Classic {
    fn domain(&self) -> [[f64; 2]; 2] {
        match *self {
            Classic::Enneper { reach } => [[-reach, reach]; 2],
            _ => [[0.0, 1.0]; 2],
        }
    }

    fn point(&self, u: f64, v: f64) -> Vec3 {
        match *self {
            Classic::Plane { size: [x, y] } => Vec3::new((u - 0.5) * x, (v - 0.5) * y, 0.0),
            Classic::Sphere { radius } => ellipsoid([radius; 3], u, v),
            Classic::Ellipsoid { radii } => ellipsoid(radii, u, v),
            Classic::Superellipsoid { radii: [a, b, c], exponents: [n, e] } => {
                let ([out, up], [x, y]) = (superellipse(latitude(v), n), superellipse(turn(u), e));
                Vec3::new(a * out * x, b * out * y, c * up)
            }
            Classic::Cylinder { radius, height } => {
                let [x, y] = turn(u);
                Vec3::new(radius * x, radius * y, height * v)
            }
            Classic::Cone { radius, height } => {
                let ([x, y], r) = (turn(u), radius * (1.0 - v));
                Vec3::new(r * x, r * y, height * v)
            }
            Classic::Torus { major, minor } => {
                let ([x, y], [out, up]) = (turn(u), turn(v));
                let r = major + minor * out;
                Vec3::new(r * x, r * y, minor * up)
            }
            Classic::Moebius { radius, width } => {
                let ([x, y], [c, s]) = (turn(u), turn(0.5 * u));
                let across = width * (v - 0.5);
                let r = radius + across * c;
                Vec3::new(r * x, r * y, across * s)
            }
            Classic::Klein { radius, minor } => {
                let ([x, y], [c, s]) = (turn(u), turn(0.5 * u));
                let ([_, once], [_, twice]) = (turn(v), turn(2.0 * v));
                let r = radius + minor * (c * once - s * twice);
                Vec3::new(r * x, r * y, minor * (s * once + c * twice))
            }
            Classic::Helicoid { radius, pitch, turns } => {
                let [x, y] = turn(turns * u);
                Vec3::new(radius * v * x, radius * v * y, pitch * turns * u)
            }
            Classic::Enneper { .. } => {
                Vec3::new(u - u * u * u / 3.0 + u * v * v, v - v * v * v / 3.0 + v * u * u, u * u - v * v)
            }
        }
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        match *self {
            Classic::Sphere { radius } => ellipsoid_jet([radius; 3], u, v),
            Classic::Ellipsoid { radii } => ellipsoid_jet(radii, u, v),
            Classic::Torus { major, minor } => torus_jet(major, minor, u, v),
            _ => super::jet::by_differences(self, u, v),
        }
    }

    fn sides(&self) -> Sides {
        let (closed, open) = (Gluing::Closed, Gluing::Open);
        let round = |poles| Sides { u: closed, v: open, poles };
        match self {
            Classic::Plane { .. } | Classic::Helicoid { .. } | Classic::Enneper { .. } => Sides::OPEN,
            Classic::Sphere { .. } | Classic::Ellipsoid { .. } | Classic::Superellipsoid { .. } => {
                round([true, true, false, false])
            }
            Classic::Cylinder { .. } => round([false; 4]),
            Classic::Cone { .. } => round([false, true, false, false]),
            Classic::Torus { .. } => Sides { u: closed, v: closed, poles: [false; 4] },
            Classic::Moebius { .. } => Sides { u: Gluing::Twisted, ..Sides::OPEN },
            Classic::Klein { .. } => Sides { u: Gluing::Twisted, v: closed, poles: [false; 4] },
        }
    }

    /// In closed form; `None` for superellipsoids, whose second derivatives have no bounds.
    fn second_bounds(&self, part: [[f64; 2]; 2]) -> Option<[f64; 3]> {
        self.bends(part).map(|bends| bends.lengths)
    }

    /// For spheres and the mantles of cylinders and cones: projected from the middle, or straight from the axis, a triangle
    /// covers its part of the surface.
    fn triangle_bound(&self, corners: [Vec3; 3]) -> Option<f64> {
        round_triangle::bound(self, corners)
    }

    fn bends(&self, part: [[f64; 2]; 2]) -> Option<Bends> {
        classic_bends::bends(self, part)
    }

    fn creases(&self) -> [Vec<f64>; 2] {
        match self {
            // Powers other than 1 have a kink or stand still where their base vanishes.
            Classic::Superellipsoid { .. } => [vec![0.25, 0.5, 0.75], vec![0.5]],
            _ => [Vec::new(), Vec::new()],
        }
    }
}

fn ellipsoid([a, b, c]: [f64; 3], u: f64, v: f64) -> Vec3 {
    let ([out, up], [x, y]) = (latitude(v), turn(u));
    Vec3::new(a * out * x, b * out * y, c * up)
}

fn ellipsoid_jet([a, b, c]: [f64; 3], u: f64, v: f64) -> Jet {
    let ([out, up], [x, y]) = (latitude(v), turn(u));
    let (p, q) = (2.0 * PI, PI);
    Jet {
        point: Vec3::new(a * out * x, b * out * y, c * up),
        du: p * Vec3::new(-a * out * y, b * out * x, 0.0),
        dv: q * Vec3::new(-a * up * x, -b * up * y, c * out),
        duu: -p * p * Vec3::new(a * out * x, b * out * y, 0.0),
        duv: p * q * Vec3::new(a * up * y, -b * up * x, 0.0),
        dvv: -q * q * Vec3::new(a * out * x, b * out * y, c * up),
    }
}

fn torus_jet(major: f64, minor: f64, u: f64, v: f64) -> Jet {
    let ([x, y], [out, up]) = (turn(u), turn(v));
    let (r, p) = (major + minor * out, 2.0 * PI);
    let (radial, around) = (Vec3::new(x, y, 0.0), Vec3::new(-y, x, 0.0));
    Jet {
        point: r * radial + Vec3::new(0.0, 0.0, minor * up),
        du: p * r * around,
        dv: p * minor * (Vec3::new(0.0, 0.0, out) - up * radial),
        duu: -p * p * r * radial,
        duv: -p * p * minor * up * around,
        dvv: -p * p * minor * (out * radial + Vec3::new(0.0, 0.0, up)),
    }
}
