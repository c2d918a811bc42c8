use super::implicit::BadNumber;
use super::real::{Real, sum_of_squares};
use crate::math::Vec3;

/// A shape around the origin whose field is a single operation: exact and cheap where ten of arithmetic would be neither.
///
/// *Exact* fields are the Euclidean distance, negative inside; *bounds* are never further from zero than that.
/// Lengths are in model units and not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// A ball. Exact.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// An ellipsoid along the axes. A bound: the distance scaled by the least half-axis.
    Ellipsoid {
        /// Half-axes, none zero.
        radii: Vec3,
    },
    /// A box along the axes. Exact.
    Cuboid {
        /// Half of each side.
        half: Vec3,
    },
    /// A box whose edges and corners are rounded; its faces are those of the box. Exact.
    RoundedCuboid {
        /// Half of each side, rounding included.
        half: Vec3,
        /// Radius of the edges, at most the least half side.
        radius: f64,
    },
    /// A cylinder around the z axis. Exact.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Half of the height.
        half_height: f64,
        /// Radius of the rounded rims, at most either of the others.
        rounding: f64,
    },
    /// All points within a distance of a segment of the z axis. Exact.
    Capsule {
        /// Half of the segment's length.
        half_length: f64,
        /// Radius.
        radius: f64,
    },
    /// A ring around the z axis. Exact.
    Torus {
        /// Distance of the tube's middle from the axis.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// A regular octahedron with its corners on the axes. Exact.
    Octahedron {
        /// Distance of the corners from the centre.
        radius: f64,
    },
    /// A triply periodic surface, divided by a bound of its slope. A bound.
    Periodic {
        /// Which one.
        kind: Periodic,
        /// Length after which it repeats along each axis.
        period: f64,
    },
    /// A soft ball for sums (Wyvill, McPheeters, Wyvill, Data structure for soft objects, 1986):
    /// `weight` (1 - d^2 / radius^2)^3 at a distance d below `radius`, 0 beyond. Positive, not a distance.
    Blob {
        /// Where it ends.
        radius: f64,
        /// Its value at the centre.
        weight: f64,
    },
}

/// A triply periodic surface, as the zeros of the usual trigonometric sum (von Schnering and Nesper, Nodal surfaces of
/// Fourier series, 1991), with angles of 2 pi a period.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Periodic {
    /// sin x cos y + sin y cos z + sin z cos x.
    Gyroid,
    /// cos x + cos y + cos z: Schwarz's P.
    SchwarzP,
    /// sin x sin y sin z + sin x cos y cos z + cos x sin y cos z + cos x cos y sin z: Schwarz's D.
    Diamond,
    /// 3 (cos x + cos y + cos z) + 4 cos x cos y cos z.
    Neovius,
    /// 2 (cos x cos y + cos y cos z + cos z cos x) - (cos 2x + cos 2y + cos 2z): Schoen's I-WP.
    Iwp,
}

impl Periodic {
    /// A bound of the slope over angles.
    ///
    /// Gyroid: |cos x cos y - sin x sin z|^2 <= cos^2 y + sin^2 z (Cauchy-Schwarz), and the three sum to 3. P: three
    /// sines. D: each partial is cos x cos(y - z) - sin x sin(y + z), its square at most cos^2(y - z) + sin^2(y + z).
    /// Neovius: |sin| (3 + 4) each. I-WP: 2 |sin x (cos y + cos z)| + 2 |sin 2x| <= 6 each.
    fn slope(self) -> f64 {
        const SQRT_3: f64 = 1.7320508075688774;
        const SQRT_6: f64 = 2.449489742783179;
        match self {
            Periodic::Gyroid | Periodic::SchwarzP => SQRT_3,
            Periodic::Diamond => SQRT_6,
            Periodic::Neovius => 7.0 * SQRT_3,
            Periodic::Iwp => 6.0 * SQRT_3,
        }
    }

    #[inline(always)]
    fn sum<T: Real>(self, p: [T; 3]) -> T {
        let [sx, sy, sz] = p.map(T::sin);
        let [cx, cy, cz] = p.map(T::cos);
        match self {
            Periodic::Gyroid => sx * cy + sy * cz + sz * cx,
            Periodic::SchwarzP => cx + cy + cz,
            Periodic::Diamond => sx * sy * sz + sx * cy * cz + cx * sy * cz + cx * cy * sz,
            Periodic::Neovius => T::of(3.0) * (cx + cy + cz) + T::of(4.0) * cx * cy * cz,
            // cos 2x = 2 cos^2 x - 1.
            Periodic::Iwp => {
                let squares = cx.square() + cy.square() + cz.square();
                T::of(2.0) * (cx * cy + cy * cz + cz * cx - squares) + T::of(3.0)
            }
        }
    }
}

impl Primitive {
    /// The value at a point of its own coordinates.
    #[inline(always)]
    pub(super) fn apply<T: Real>(self, p: [T; 3]) -> T {
        let [x, y, z] = p;
        match self {
            Primitive::Sphere { radius } => T::norm(p) - T::of(radius),
            Primitive::Ellipsoid { radii } => {
                let scaled = [x / T::of(radii.x), y / T::of(radii.y), z / T::of(radii.z)];
                (T::norm(scaled) - T::of(1.0)) * T::of(radii.min_element())
            }
            Primitive::Cuboid { half } => T::corner(beyond(p, half)),
            Primitive::RoundedCuboid { half, radius } => {
                T::corner(beyond(p, half - Vec3::splat(radius))) - T::of(radius)
            }
            Primitive::Cylinder { radius, half_height, rounding } => {
                let side = T::norm([x, y]) - T::of(radius - rounding);
                T::corner([side, z.abs() - T::of(half_height - rounding)]) - T::of(rounding)
            }
            Primitive::Capsule { half_length, radius } => {
                let past_end = (z.abs() - T::of(half_length)).max(T::of(0.0));
                T::norm([x, y, past_end]) - T::of(radius)
            }
            Primitive::Torus { major, minor } => T::norm([T::norm([x, y]) - T::of(major), z]) - T::of(minor),
            Primitive::Octahedron { radius } => octahedron(p, radius),
            Primitive::Periodic { kind, period } => {
                let turns = std::f64::consts::TAU / period;
                kind.sum(p.map(|x| x * T::of(turns))) * T::of(1.0 / (kind.slope() * turns))
            }
            Primitive::Blob { radius, weight } => {
                let fall = sum_of_squares(p) * T::of(1.0 / (radius * radius));
                let rest = (T::of(1.0) - fall).max(T::of(0.0));
                rest.square() * rest * T::of(weight)
            }
        }
    }

    /// Whether its numbers make a shape.
    ///
    /// # Errors
    /// Which of them does not.
    pub fn check(self) -> Result<(), BadNumber> {
        let sides =
            |name, v: Vec3| v.to_array().into_iter().try_for_each(|x| BadNumber::positive(name, x).map(drop));
        let positive = |name, x| BadNumber::positive(name, x).map(drop);
        match self {
            Primitive::Sphere { radius } | Primitive::Octahedron { radius } => positive("radius", radius),
            Primitive::Ellipsoid { radii } => sides("half-axis", radii),
            Primitive::Cuboid { half } => sides("half side", half),
            Primitive::RoundedCuboid { half, radius } => {
                sides("half side", half)?;
                BadNumber::within("radius", "from 0 to the least half side", radius, half.min_element())
                    .map(drop)
            }
            Primitive::Cylinder { radius, half_height, rounding } => {
                positive("radius", radius)?;
                positive("half height", half_height)?;
                let most = radius.min(half_height);
                BadNumber::within("rounding", "from 0 to the radius and half the height", rounding, most)
                    .map(drop)
            }
            Primitive::Capsule { half_length, radius } => {
                BadNumber::within("half length", "0 or more and finite", half_length, f64::MAX)?;
                positive("radius", radius)
            }
            Primitive::Torus { major, minor } => {
                positive("radius of the ring", major)?;
                positive("radius of the tube", minor)
            }
            Primitive::Periodic { period, .. } => positive("period", period),
            Primitive::Blob { radius, weight } => {
                positive("radius", radius)?;
                BadNumber::finite("weight", weight).map(drop)
            }
        }
    }

    /// A proven bound of the slope.
    pub fn lipschitz(self) -> f64 {
        match self {
            // The greatest slope of (1 - t^2)^3 is at t = 1 / sqrt 5: 96 / (25 sqrt 5).
            Primitive::Blob { radius, weight } => 1.717_300_206_8 * weight.abs() / radius,
            _ => 1.0,
        }
    }

    /// Whether it is the distance itself and not only a bound of it.
    pub fn is_exact(self) -> bool {
        !matches!(self, Primitive::Ellipsoid { .. } | Primitive::Periodic { .. } | Primitive::Blob { .. })
    }

    /// Half of each side of the box around it; infinite where it is.
    pub fn half_size(self) -> Vec3 {
        match self {
            Primitive::Sphere { radius } | Primitive::Octahedron { radius } => Vec3::splat(radius),
            Primitive::Ellipsoid { radii } => radii,
            Primitive::Cuboid { half } | Primitive::RoundedCuboid { half, .. } => half,
            Primitive::Cylinder { radius, half_height, .. } => Vec3::new(radius, radius, half_height),
            Primitive::Capsule { half_length, radius } => Vec3::new(radius, radius, half_length + radius),
            Primitive::Torus { major, minor } => Vec3::new(major + minor, major + minor, minor),
            Primitive::Periodic { .. } => Vec3::INFINITY,
            Primitive::Blob { radius, .. } => Vec3::splat(radius),
        }
    }

    /// Its name and its numbers: what makes it different from others.
    pub(crate) fn parameters(self) -> (u8, Vec<f64>) {
        match self {
            Primitive::Sphere { radius } => (0, vec![radius]),
            Primitive::Ellipsoid { radii } => (1, radii.to_array().to_vec()),
            Primitive::Cuboid { half } => (2, half.to_array().to_vec()),
            Primitive::RoundedCuboid { half, radius } => (3, vec![half.x, half.y, half.z, radius]),
            Primitive::Cylinder { radius, half_height, rounding } => (4, vec![radius, half_height, rounding]),
            Primitive::Capsule { half_length, radius } => (5, vec![half_length, radius]),
            Primitive::Torus { major, minor } => (6, vec![major, minor]),
            Primitive::Octahedron { radius } => (7, vec![radius]),
            Primitive::Periodic { kind, period } => (8, vec![f64::from(kind as u8), period]),
            Primitive::Blob { radius, weight } => (9, vec![radius, weight]),
        }
    }
}

/// How far a point is beyond each pair of faces of a box.
#[inline(always)]
fn beyond<T: Real>(p: [T; 3], half: Vec3) -> [T; 3] {
    let [x, y, z] = p;
    [x.abs() - T::of(half.x), y.abs() - T::of(half.y), z.abs() - T::of(half.z)]
}

/// The distance from |x| + |y| + |z| = radius.
///
/// In the positive octant the nearest point of the face's triangle is max(a - t, 0), where t is the greatest of the
/// means by which the one, two or three largest coordinates exceed their share: projection onto a simplex (Held, Wolfe,
/// Crowder 1974). What is left of a is min(a, t). Where t does not exceed the least coordinate the face itself is
/// nearest, and inside always.
#[inline(always)]
fn octahedron<T: Real>(p: [T; 3], radius: f64) -> T {
    const ROOT: f64 = 1.7320508075688772;
    let [x, y, z] = p.map(T::abs);
    let r = T::of(radius);
    let face = (x + y + z - r) * T::of(1.0 / 3.0);
    let least = x.min(y).min(z);
    let most = x.max(y).max(z);
    let two = ((x + y).max(y + z).max(z + x) - r) * T::of(0.5);
    let t = face.max(two).max(most - r);
    let beside = T::norm([x.min(t), y.min(t), z.min(t)]);
    // Over the face, or below it.
    (face.min(face - least)).select(face * T::of(ROOT), beside)
}
