use super::SweepError;
use super::profile::{Profile, check_finite, most_triangles};
use crate::math::{Vec2, Vec3, degrees, sin_cos_degrees};
use crate::mesh::{Mesh, Solid, TooLarge};
use crate::polygon::Region;

/// The numbers of a straight sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSweep {
    /// From the base to the top. Only its z component is turned into height; x and y shear the sweep.
    pub vector: Vec3,
    /// Whether the sweep is centred: from minus half the vector to plus half the vector.
    pub center: bool,
    /// Turn of the top against the base, in radians, clockwise seen from above when positive.
    pub twist: f64,
    /// Number of layers, at least 1.
    pub slices: u32,
    /// Size of the top against the base, on each axis; zero gives a point or a ridge.
    pub scale: Vec2,
}

impl LinearSweep {
    /// Upper bound of the number of triangles that sweeping `region` makes.
    pub fn most_triangles(&self, region: &Region) -> u64 {
        most_triangles(region, self.layers())
    }

    /// Layers that matter: without twist and with equal scales all of them lie in the same planes.
    fn layers(&self) -> u32 {
        if self.twist == 0.0 && self.scale.x == self.scale.y { 1 } else { self.slices }
    }

    fn check(&self) -> Result<(), SweepError> {
        if !(self.vector.is_finite() && self.twist.is_finite() && self.scale.is_finite()) {
            return Err(SweepError::NonFinite);
        }
        if self.scale.min_element() < 0.0 {
            return Err(SweepError::NegativeScale { scale: self.scale.min_element() });
        }
        if self.slices == 0 {
            return Err(SweepError::TooFewSteps { steps: 0, needed: 1 });
        }
        Ok(())
    }

    /// Map of the plane at `layer` of `layers`.
    fn section(&self, layer: u32, layers: u32) -> impl Fn(Vec2) -> Vec3 {
        let scale = self.scale_at(layer, layers);
        let (sin, cos) = sin_cos_degrees(-degrees(self.twist) * f64::from(layer) / f64::from(layers));
        let start = if self.center { -0.5 * self.vector } else { Vec3::ZERO };
        let part = f64::from(layer) / f64::from(layers);
        let shift = if layer == layers { start + self.vector } else { start + part * self.vector };
        move |Vec2 { x, y }| {
            let turned = Vec2::new(x * cos - y * sin, x * sin + y * cos);
            (turned * scale).extend(0.0) + shift
        }
    }

    fn scale_at(&self, layer: u32, layers: u32) -> Vec2 {
        let part = f64::from(layer) / f64::from(layers);
        if layer == layers { self.scale } else { Vec2::ONE.lerp(self.scale, part) }
    }

    /// How much longer, squared, the diagonal from `a` below to `b` above is than that from `b` to `a`.
    ///
    /// Where the scales are equal this is worked out on the unturned points, so that it is exactly zero for edges that
    /// point away from the axis: rounding would else choose between their diagonals.
    fn diagonals(&self, a: Vec2, b: Vec2, layer: u32, layers: u32) -> f64 {
        let (below, above) = (self.scale_at(layer, layers).x, self.scale_at(layer + 1, layers).x);
        if self.scale.x == self.scale.y {
            let (sin, _) = sin_cos_degrees(-degrees(self.twist) / f64::from(layers));
            let growth = (below * below - above * above) * (a.length_squared() - b.length_squared());
            return growth + 4.0 * below * above * sin * a.perp_dot(b);
        }
        let (low, high) = (self.section(layer, layers), self.section(layer + 1, layers));
        low(a).distance_squared(high(b)) - low(b).distance_squared(high(a))
    }
}

/// Sweeps a region of the plane z = 0 along a straight line; empty where the vector has no height.
///
/// Each layer is turned, then scaled, then shifted. The quads between layers are split along their shorter diagonals; of
/// equal ones, along that which keeps more volume where the border runs counter-clockwise about the axis.
/// Without twist, scale and shear the sides are exactly vertical, whatever the number of layers. Where `scale` is zero on
/// both axes each border of the region runs into a tip of its own; where it is zero on one axis the top is a ridge of
/// triangles without area. Contours that the rounding of their vertices has made cross give ends that overlap
/// themselves; what is inside is right, and a boolean makes it clean.
///
/// # Errors
/// [`SweepError`] for numbers that are not finite, a negative scale, no layer, a region out of the range of exact signs,
/// and more triangles than a mesh holds.
pub fn linear_extrude(region: &Region, sweep: &LinearSweep) -> Result<Solid, SweepError> {
    sweep.check()?;
    TooLarge::check(sweep.most_triangles(region))?;
    if region.is_empty() || sweep.vector.z == 0.0 {
        return Ok(Solid::default());
    }
    let profile = Profile::new(region)?;
    let mesh = if sweep.scale == Vec2::ZERO { tipped(&profile, sweep) } else { capped(&profile, sweep) };
    check_finite(&mesh.positions)?;
    let upright = if sweep.vector.z > 0.0 { mesh } else { mesh.flipped() };
    let straight = sweep.twist == 0.0 && sweep.scale == Vec2::ONE && sweep.vector.truncate() == Vec2::ZERO;
    Ok(Solid::assume(upright, straight && profile.sound))
}

/// The sweep with a flat end at the top.
fn capped(profile: &Profile, sweep: &LinearSweep) -> Mesh {
    let layers = sweep.layers();
    let mut mesh = sides(profile, sweep, layers, layers);
    let top = layers * profile.points.len() as u32;
    mesh.triangles.extend(profile.triangles.iter().map(|t| t.map(|v| v + top)));
    mesh
}

/// The sweep with a tip for each border.
fn tipped(profile: &Profile, sweep: &LinearSweep) -> Mesh {
    let layers = sweep.layers();
    let mut mesh = sides(profile, sweep, layers - 1, layers);
    let (loop_of, loops) = profile.loops();
    let first_tip = mesh.positions.len() as u32;
    let tip = sweep.section(layers, layers)(Vec2::ZERO);
    mesh.positions.extend((0..loops).map(|_| tip));
    let below = (layers - 1) * profile.points.len() as u32;
    let side = |&[a, b]: &[u32; 2]| [a + below, b + below, first_tip + loop_of[a as usize]];
    mesh.triangles.extend(profile.border.iter().map(side));
    mesh
}

/// The base and the sides up to and with layer `last` of `layers`.
fn sides(profile: &Profile, sweep: &LinearSweep, last: u32, layers: u32) -> Mesh {
    let count = profile.points.len() as u32;
    let mut mesh = Mesh::default();
    for layer in 0..=last {
        mesh.positions.extend(profile.points.iter().copied().map(sweep.section(layer, layers)));
    }
    mesh.triangles.extend(profile.triangles.iter().map(|&[a, b, c]| [a, c, b]));
    for layer in 0..last {
        let (below, above) = (layer * count, (layer + 1) * count);
        for &[a, b] in &profile.border {
            let longer =
                sweep.diagonals(profile.points[a as usize], profile.points[b as usize], layer, layers);
            let (c, d) = (b + above, a + above);
            let (a, b) = (a + below, b + below);
            let splits_ac = longer < 0.0 || longer == 0.0 && sweep.twist >= 0.0;
            mesh.triangles.extend(if splits_ac { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Defects;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    const PLAIN: LinearSweep =
        LinearSweep { vector: Vec3::Z, center: false, twist: 0.0, slices: 1, scale: Vec2::ONE };

    fn contour(list: &[(f64, f64)]) -> Vec<Vec2> {
        list.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    fn square(min: f64, max: f64) -> Vec<Vec2> {
        contour(&[(min, min), (max, min), (max, max), (min, max)])
    }

    /// A frame with a hole, and a square that touches its corner.
    fn frame() -> Region {
        let mut hole = square(1.0, 3.0);
        hole.reverse();
        Region::assume(vec![square(0.0, 4.0), hole, square(4.0, 5.0)])
    }

    fn volume(mesh: &Mesh) -> f64 {
        let origin = mesh.positions.first().copied().unwrap_or_default();
        let six = |t: usize| {
            let [a, b, c] = mesh.corners(t).map(|p| p - origin);
            a.dot(b.cross(c))
        };
        (0..mesh.triangles.len()).map(six).sum::<f64>() / 6.0
    }

    fn assert_volume(region: &Region, sweep: LinearSweep, expected: f64) {
        let solid = linear_extrude(region, &sweep).unwrap();
        let defects = Defects::of(solid.mesh());
        assert!(defects.is_solid() && defects.non_manifold_vertices == 0, "{sweep:?}: {defects:?}");
        let actual = volume(solid.mesh());
        assert!((actual - expected).abs() <= 1e-13 * expected, "{sweep:?}: {actual} is not {expected}");
    }

    #[test]
    fn volumes_have_closed_forms() {
        let area = 13.0;
        assert_volume(&frame(), PLAIN, area);
        assert_volume(&frame(), LinearSweep { slices: 7, center: true, ..PLAIN }, area);
        assert_volume(&frame(), LinearSweep { vector: Vec3::new(3.0, -1.0, -2.0), ..PLAIN }, 2.0 * area);
        assert_volume(&frame(), LinearSweep { scale: Vec2::ZERO, slices: 4, ..PLAIN }, area / 3.0);
        assert_volume(&frame(), LinearSweep { scale: Vec2::splat(0.5), ..PLAIN }, area * 7.0 / 12.0);
        // A rectangle that loses one dimension on the way up: a wedge.
        let wedge = LinearSweep { scale: Vec2::new(0.0, 1.0), slices: 3, ..PLAIN };
        assert_volume(&Region::assume(vec![square(-1.0, 1.0)]), wedge, 2.0);
    }

    #[test]
    fn twisted_sections_keep_their_exact_angles() {
        let sweep = LinearSweep { twist: FRAC_PI_2, slices: 9, ..PLAIN };
        let solid = linear_extrude(&frame(), &sweep).unwrap();
        let top = &solid.positions()[9 * 12..];
        assert_eq!(top[1], Vec3::new(0.0, -4.0, 1.0), "(4, 0) turned clockwise by a right angle");
        assert_eq!(solid.positions()[3 * 12 + 1], {
            let (sin, cos) = sin_cos_degrees(-30.0);
            Vec3::new(4.0 * cos, 4.0 * sin, 3.0 / 9.0)
        });
    }

    /// Volumes that OpenSCAD 2021.01 finds, to the six digits it writes.
    #[test]
    fn quads_are_split_as_openscad_splits_them() {
        let l = Region::assume(vec![contour(&[(0., 0.), (4., 0.), (4., 1.), (1., 1.), (1., 3.), (0., 3.)])]);
        let at = |degrees: f64, slices, scale| {
            let twist = degrees.to_radians();
            let sweep = LinearSweep { vector: 10.0 * Vec3::Z, center: false, twist, slices, scale };
            volume(linear_extrude(&l, &sweep).unwrap().mesh())
        };
        for (degrees, slices, scale, expected) in [
            (90.0, 7, Vec2::ONE, 66.9159),
            (-90.0, 7, Vec2::ONE, 66.9159),
            (45.0, 7, Vec2::ONE, 63.6064),
            (-30.0, 7, Vec2::ONE, 62.4350),
            (200.0, 7, Vec2::ONE, 73.5062),
            (60.0, 5, Vec2::new(0.5, 2.0), 64.0917),
        ] {
            let actual = at(degrees, slices, scale);
            assert!((actual - expected).abs() < 1e-4, "{degrees}: {actual} is not {expected}");
        }
    }

    #[test]
    fn a_twisted_square_approaches_a_prism_from_below() {
        let square = Region::assume(vec![square(-1.0, 1.0)]);
        let at = |slices| {
            volume(linear_extrude(&square, &LinearSweep { twist: PI, slices, ..PLAIN }).unwrap().mesh())
        };
        let (coarse, fine) = (at(30), at(300));
        assert!((fine - 4.0).abs() < (coarse - 4.0).abs() && (fine - 4.0).abs() < 0.03, "{coarse} {fine}");
    }

    #[test]
    fn wrong_numbers_are_errors() {
        let error = |sweep| linear_extrude(&frame(), &sweep).unwrap_err();
        assert_eq!(error(LinearSweep { twist: f64::NAN, ..PLAIN }), SweepError::NonFinite);
        assert_eq!(
            error(LinearSweep { scale: Vec2::splat(1e308), vector: Vec3::Z, ..PLAIN }),
            SweepError::NonFinite
        );
        assert_eq!(
            error(LinearSweep { scale: Vec2::new(-1.0, 1.0), ..PLAIN }),
            SweepError::NegativeScale { scale: -1.0 }
        );
        assert_eq!(
            error(LinearSweep { slices: 0, ..PLAIN }),
            SweepError::TooFewSteps { steps: 0, needed: 1 }
        );
        assert!(matches!(
            error(LinearSweep { twist: 1.0, slices: u32::MAX, ..PLAIN }),
            SweepError::TooLarge(_)
        ));
        assert!(linear_extrude(&frame(), &LinearSweep { vector: Vec3::X, ..PLAIN }).unwrap().is_empty());
        assert!(linear_extrude(&Region::default(), &PLAIN).unwrap().is_empty());
    }

    #[test]
    fn contours_that_cross_keep_their_winding_numbers() {
        // A square and a larger hole: outside in, but for a border of -1.
        let mut hole = square(0.0, 4.0);
        hole.reverse();
        let crossing = Region::assume(vec![square(0.0, 4.0), hole, square(1.0, 6.0)]);
        let solid = linear_extrude(&crossing, &PLAIN).unwrap();
        assert!(!solid.is_embedded());
        assert_eq!(volume(solid.mesh()), 25.0);
    }

    proptest! {
        #[test]
        fn always_closed(
            v in prop::array::uniform3(-10.0..10.0_f64), center: bool, twist in prop_oneof![Just(0.0), -10.0..10.0_f64], slices in 1_u32..6,
            scale in prop::array::uniform2(prop_oneof![Just(0.0), Just(1.0), 0.0..3.0_f64]),
        ) {
            let sweep = LinearSweep { vector: v.into(), center, twist, slices, scale: scale.into() };
            let solid = linear_extrude(&frame(), &sweep).unwrap();
            let defects = Defects::of(solid.mesh());
            prop_assert!(defects.is_solid() && defects.non_manifold_vertices == 0, "{:?}", defects);
            prop_assert_eq!(defects.unused_positions, 0);
            prop_assert!(twist != 0.0 || v[2] == 0.0 || volume(solid.mesh()) > 0.0);
            prop_assert!(solid.triangles().len() as u64 <= sweep.most_triangles(&frame()));
        }
    }
}
