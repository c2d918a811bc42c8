//! Solids that are closed by construction.
//!
//! Curved ones have the facets OpenSCAD gives them: rings of vertices, the first on the x axis.

use super::{Mesh, Solid};
use crate::math::{Vec3, unit_circle};
use crate::polygon::triangulate;
use std::fmt;

/// A mesh that would have more triangles than 32-bit half-edges can number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// How many triangles it would have.
    pub triangles: u64,
}

impl TooLarge {
    /// The most triangles a mesh can have.
    pub const MOST: u64 = u32::MAX as u64 / 3;

    /// Refuses more than [`TooLarge::MOST`] triangles.
    ///
    /// # Errors
    /// The number, when there are more.
    pub fn check(triangles: u64) -> Result<(), TooLarge> {
        if triangles > TooLarge::MOST { Err(TooLarge { triangles }) } else { Ok(()) }
    }
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} triangles are more than a mesh can hold ({})", self.triangles, TooLarge::MOST)
    }
}

impl std::error::Error for TooLarge {}

/// The box between the corners `min` and `max`, twelve triangles; empty unless `min < max` on every axis.
pub fn cuboid(min: Vec3, max: Vec3) -> Solid {
    if !min.cmplt(max).all() || !min.is_finite() || !max.is_finite() {
        return Solid::default();
    }
    let corner = |i: u32| {
        Vec3::new(
            if i & 1 == 0 { min.x } else { max.x },
            if i & 2 == 0 { min.y } else { max.y },
            if i & 4 == 0 { min.z } else { max.z },
        )
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Solid::assume(Mesh { positions: (0..8).map(corner).collect(), triangles }, true)
}

/// A sphere about the origin: `(fragments + 1) / 2` rings of `fragments` vertices, at the latitudes in the middle of as
/// many equal steps, so that no vertex is at a pole; flat polygons close the ends. Empty unless `radius` is positive and
/// finite and `fragments` at least 3.
///
/// # Errors
/// [`TooLarge`] beyond about 37000 fragments; [`sphere_triangles`] tells before.
pub fn sphere(radius: f64, fragments: u32) -> Result<Solid, TooLarge> {
    TooLarge::check(sphere_triangles(fragments))?;
    if !(radius > 0.0 && radius.is_finite() && fragments >= 3) {
        return Ok(Solid::default());
    }
    let rings = fragments.div_ceil(2);
    let latitude = |ring: u32| radius * unit_circle(2 * u64::from(ring) + 1, 4 * u64::from(rings));
    let mut mesh = Mesh::default();
    // From the south pole up.
    for ring in (0..rings).rev() {
        let (height, around) = latitude(ring).into();
        push_ring(&mut mesh, around, height, fragments);
    }
    close_rings(&mut mesh, fragments, rings);
    Ok(Solid::assume(mesh, facets_are_sound(radius, fragments)))
}

/// A cylinder or cone about the z axis between two heights, the lower one first, with a radius at each; a radius of zero
/// makes a tip. Empty unless the heights are finite and ascending, the radii finite and not negative, at least one of
/// them positive, and `fragments` at least 3.
///
/// # Errors
/// [`TooLarge`] beyond about 300 million fragments.
pub fn frustum(heights: [f64; 2], radii: [f64; 2], fragments: u32) -> Result<Solid, TooLarge> {
    TooLarge::check(frustum_triangles(radii, fragments))?;
    let [low, high] = heights;
    let sizes_are_sound = radii.iter().all(|r| *r >= 0.0 && r.is_finite()) && radii != [0.0, 0.0];
    if !(low < high && low.is_finite() && high.is_finite() && sizes_are_sound && fragments >= 3) {
        return Ok(Solid::default());
    }
    let mut mesh = Mesh::default();
    match radii {
        [0.0, top] => {
            push_ring(&mut mesh, top, high, fragments);
            mesh.triangles.extend(triangulate::convex((0..fragments).collect()));
            push_tip(&mut mesh, low, (0..fragments).rev());
        }
        [bottom, 0.0] => {
            push_ring(&mut mesh, bottom, low, fragments);
            mesh.triangles.extend(triangulate::convex((0..fragments).rev().collect()));
            push_tip(&mut mesh, high, 0..fragments);
        }
        [bottom, top] => {
            push_ring(&mut mesh, bottom, low, fragments);
            push_ring(&mut mesh, top, high, fragments);
            close_rings(&mut mesh, fragments, 2);
        }
    }
    let smallest = radii.iter().copied().filter(|&r| r > 0.0).fold(f64::INFINITY, f64::min);
    Ok(Solid::assume(mesh, facets_are_sound(smallest, fragments)))
}

/// Number of triangles of a [`sphere`] that is not empty.
pub fn sphere_triangles(fragments: u32) -> u64 {
    let (around, rings) = (u64::from(fragments), u64::from(fragments.div_ceil(2)));
    (2 * around * rings).saturating_sub(4)
}

/// Number of triangles of a [`frustum`] that is not empty.
pub fn frustum_triangles(radii: [f64; 2], fragments: u32) -> u64 {
    let around = u64::from(fragments);
    if radii.contains(&0.0) { (2 * around).saturating_sub(2) } else { (4 * around).saturating_sub(4) }
}

/// Whether rounding cannot have made neighbouring facets cross: a chord's height over its arc, 5 / fragments^2 of the
/// radius, is far above the rounding of a coordinate, 2^-53.
fn facets_are_sound(smallest_radius: f64, fragments: u32) -> bool {
    fragments <= 1 << 20 && smallest_radius > 1e-290
}

fn push_ring(mesh: &mut Mesh, radius: f64, height: f64, fragments: u32) {
    let around = u64::from(fragments);
    let vertex = |i: u64| (radius * unit_circle(i, around)).extend(height);
    mesh.positions.extend((0..around).map(vertex));
}

/// Joins `rings` rings, stored from the bottom up, by quads, and closes both ends.
fn close_rings(mesh: &mut Mesh, fragments: u32, rings: u32) {
    mesh.triangles.extend(triangulate::convex((0..fragments).rev().collect()));
    for ring in 1..rings {
        let (below, above) = ((ring - 1) * fragments, ring * fragments);
        for i in 0..fragments {
            let next = (i + 1) % fragments;
            mesh.triangles.push([below + i, below + next, above + next]);
            mesh.triangles.push([below + i, above + next, above + i]);
        }
    }
    mesh.triangles.extend(triangulate::convex(((rings - 1) * fragments..rings * fragments).collect()));
}

/// Joins a ring, given in the direction in which the sides run along it, to a vertex on the axis.
fn push_tip(mesh: &mut Mesh, height: f64, ring: impl Iterator<Item = u32> + Clone) {
    let tip = mesh.positions.len() as u32;
    mesh.positions.push(Vec3::new(0.0, 0.0, height));
    let next = ring.clone().cycle().skip(1);
    mesh.triangles.extend(ring.zip(next).map(|(a, b)| [a, b, tip]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Defects;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn volume(mesh: &Mesh) -> f64 {
        let six = |t: usize| {
            let [a, b, c] = mesh.corners(t);
            a.dot(b.cross(c))
        };
        (0..mesh.triangles.len()).map(six).sum::<f64>() / 6.0
    }

    /// Area of a regular polygon of unit radius.
    fn polygon_area(n: u32) -> f64 {
        0.5 * f64::from(n) * crate::math::sin(TAU / f64::from(n))
    }

    fn assert_close(actual: f64, expected: f64) {
        assert!((actual - expected).abs() <= 1e-12 * expected.abs(), "{actual} is not {expected}");
    }

    #[test]
    fn volumes_have_closed_forms() {
        for n in [3, 4, 5, 6, 7, 30, 101] {
            let area = polygon_area(n);
            let mut cases = vec![([0.0, 2.0], [3.0, 3.0], 18.0), ([-1.0, 1.0], [1.0, 2.0], 14.0 / 3.0)];
            cases.extend([([0.0, 3.0], [2.0, 0.0], 4.0), ([0.0, 3.0], [0.0, 2.0], 4.0)]);
            for (heights, radii, factor) in cases {
                let solid = frustum(heights, radii, n).unwrap();
                assert_close(volume(solid.mesh()), area * factor);
                assert_eq!(solid.triangles().len() as u64, frustum_triangles(radii, n));
            }
            let rings = n.div_ceil(2);
            let slab = |k: u32| {
                let at = |k: u32| unit_circle(2 * u64::from(k) + 1, 4 * u64::from(rings));
                let (a, b) = (at(k), at(k + 1));
                area * (a.x - b.x) * (a.y * a.y + a.y * b.y + b.y * b.y) / 3.0
            };
            let ball = sphere(2.0, n).unwrap();
            assert_close(volume(ball.mesh()), 8.0 * (0..rings - 1).map(slab).sum::<f64>());
            assert_eq!(ball.triangles().len() as u64, sphere_triangles(n));
        }
    }

    #[test]
    fn ends_are_flat_and_start_on_the_x_axis() {
        let ball = sphere(1.0, 12).unwrap();
        assert_eq!(ball.positions().len(), 72);
        let (bottom, top) = (&ball.positions()[..12], &ball.positions()[60..]);
        assert!(top.iter().all(|p| p.z == top[0].z) && bottom.iter().all(|p| p.z == -top[0].z));
        assert_eq!(
            frustum([0.0, 1.0], [2.0, 2.0], 12).unwrap().positions()[1],
            Vec3::new(3.0_f64.sqrt(), 1.0, 0.0)
        );
        assert_eq!(frustum([0.0, 1.0], [2.0, 2.0], 12).unwrap().positions()[0], Vec3::new(2.0, 0.0, 0.0));
    }

    #[test]
    fn nothing_is_empty_and_too_much_is_an_error() {
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(sphere(radius, 10).unwrap().is_empty());
            assert!(frustum([0.0, 1.0], [1.0, radius.min(0.0) - 1.0], 10).unwrap().is_empty());
        }
        assert!(sphere(1.0, 2).unwrap().is_empty());
        assert!(frustum([1.0, 1.0], [1.0, 1.0], 10).unwrap().is_empty());
        assert!(frustum([0.0, 1.0], [0.0, 0.0], 10).unwrap().is_empty());
        assert_eq!(sphere(1.0, 10_000_000), Err(TooLarge { triangles: 99_999_999_999_996 }));
        assert!(frustum([0.0, 1.0], [1.0, 1.0], u32::MAX).is_err());
    }

    proptest! {
        #[test]
        fn always_closed(n in 0_u32..40, r in prop::array::uniform2(-0.5..1e9_f64), h in prop::array::uniform2(-1e9..1e9)) {
            for solid in [sphere(r[0], n).unwrap(), frustum(h, r, n).unwrap(), frustum(h, [0.0, r[1]], n).unwrap()] {
                let defects = Defects::of(solid.mesh());
                prop_assert!(defects.is_solid() && defects.non_manifold_vertices == 0, "{:?}", defects);
                prop_assert_eq!(defects.unused_positions, 0);
            }
        }
    }
}
