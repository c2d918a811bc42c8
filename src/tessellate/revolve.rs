use super::SweepError;
use super::profile::{Profile, check_finite, most_triangles};
use crate::math::{Vec2, Vec3, degrees, sin_cos_degrees};
use crate::mesh::{Mesh, Solid, TooLarge};
use crate::polygon::Region;

/// The numbers of a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotateSweep {
    /// Angle swept, in radians, clockwise seen from above when negative; a full turn or more closes on itself.
    pub angle: f64,
    /// Angle at which the sweep starts, in radians from the x axis.
    pub start: f64,
    /// Number of steps of the sweep, at least 1 (at least 3 for a full turn).
    pub fragments: u32,
}

impl RotateSweep {
    /// Upper bound of the number of triangles that turning `region` makes.
    pub fn most_triangles(&self, region: &Region) -> u64 {
        most_triangles(region, self.fragments)
    }

    /// Whether the sweep comes back to where it started.
    fn is_full(&self) -> bool {
        degrees(self.angle).abs() >= 360.0
    }

    fn check(&self) -> Result<(), SweepError> {
        if !(self.angle.is_finite() && self.start.is_finite()) {
            return Err(SweepError::NonFinite);
        }
        let needed = if self.is_full() { 3 } else { 1 };
        if self.fragments < needed {
            return Err(SweepError::TooFewSteps { steps: self.fragments, needed });
        }
        Ok(())
    }

    /// Sine and cosine of the angle after each step, the start first and, of a full turn, the end left out.
    fn directions(&self) -> Vec<(f64, f64)> {
        let angle = degrees(self.angle).clamp(-360.0, 360.0);
        let count = self.fragments + u32::from(!self.is_full());
        let after = |step: u32| {
            sin_cos_degrees(degrees(self.start) + angle * f64::from(step) / f64::from(self.fragments))
        };
        (0..count).map(after).collect()
    }
}

/// Turns a region about its y axis, which becomes the z axis; its x axis becomes the direction at the start angle. Empty
/// where the angle is zero.
///
/// The region lies on one side of the axis and may touch it: vertices on the axis become poles. A partial turn is closed
/// by the region itself at both ends.
///
/// # Errors
/// [`SweepError`] for numbers that are not finite, a region on both sides of the axis, too few steps, a region out of the
/// range of exact signs, and more triangles than a mesh holds.
pub fn rotate_extrude(region: &Region, sweep: &RotateSweep) -> Result<Solid, SweepError> {
    sweep.check()?;
    TooLarge::check(sweep.most_triangles(region))?;
    let x = || region.contours().iter().flatten().map(|p| p.x);
    let (min, max) = (x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max));
    if min < 0.0 && max > 0.0 {
        return Err(SweepError::CrossesAxis { min, max });
    }
    if region.is_empty() || sweep.angle == 0.0 {
        return Ok(Solid::default());
    }
    let profile = Profile::new(region)?;
    let mesh = turned(&profile, sweep);
    check_finite(&mesh.positions)?;
    let outward = if (max > 0.0) == (sweep.angle > 0.0) { mesh } else { mesh.flipped() };
    // Walls that run into a pole from two sides share its vertex so far.
    Ok(Solid::new(outward).expect("a swept border is closed"))
}

/// The surface for a region right of the axis and a positive angle.
fn turned(profile: &Profile, sweep: &RotateSweep) -> Mesh {
    let directions = sweep.directions();
    let mut mesh = Mesh::default();
    // Overlapping ends could not share their poles: they would meet along the axis more than twice.
    let is_pole = |point: Vec2| profile.sound && point.x == 0.0;
    // The vertices of a profile vertex at all steps: one for all on the axis, one for each elsewhere.
    let mut first = Vec::with_capacity(profile.points.len());
    for &point in &profile.points {
        first.push(mesh.positions.len() as u32);
        let around: &[(f64, f64)] = if is_pole(point) { &[(0.0, 1.0)] } else { &directions };
        let place = |&(sin, cos): &(f64, f64)| Vec3::new(point.x * cos, point.x * sin, point.y);
        mesh.positions.extend(around.iter().map(place));
    }
    let on_axis = |v: u32| is_pole(profile.points[v as usize]);
    let vertex = |v: u32, step: u32| first[v as usize] + if on_axis(v) { 0 } else { step };
    for step in 0..sweep.fragments {
        let next = (step + 1) % directions.len() as u32;
        for &[a, b] in &profile.border {
            match (on_axis(a), on_axis(b)) {
                (true, true) => {}
                (true, false) => mesh.triangles.push([first[a as usize], vertex(b, next), vertex(b, step)]),
                (false, true) => mesh.triangles.push([vertex(a, step), vertex(a, next), first[b as usize]]),
                (false, false) => {
                    let (a, b, c, d) = (vertex(a, step), vertex(a, next), vertex(b, next), vertex(b, step));
                    mesh.triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
    }
    if !sweep.is_full() {
        let end = |t: &[u32; 3], step: u32| t.map(|v| vertex(v, step));
        mesh.triangles.extend(profile.triangles.iter().map(|t| end(t, 0)));
        let last = profile.triangles.iter().map(|&[a, b, c]| end(&[a, c, b], sweep.fragments));
        mesh.triangles.extend(last);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin;
    use crate::mesh::Defects;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    const FULL: RotateSweep = RotateSweep { angle: TAU, start: 0.0, fragments: 12 };

    fn contour(list: &[(f64, f64)]) -> Vec<Vec2> {
        list.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    /// A shape with a hole, a side on the axis, and a corner of another contour that touches the axis.
    fn touching() -> Region {
        Region::assume(vec![
            contour(&[(0., 0.), (4., 0.), (4., 4.), (0., 4.)]),
            contour(&[(1., 1.), (1., 2.), (2., 2.), (2., 1.)]),
            contour(&[(0., 6.), (2., 4.5), (3., 6.), (2., 7.)]),
        ])
    }

    fn volume(mesh: &Mesh) -> f64 {
        let six = |t: usize| {
            let [a, b, c] = mesh.corners(t);
            a.dot(b.cross(c))
        };
        (0..mesh.triangles.len()).map(six).sum::<f64>() / 6.0
    }

    /// Volume by Pappus with facets: each step turns x dA into a prism of sin(step) / step of it.
    fn expected(region: &Region, sweep: &RotateSweep) -> f64 {
        let moment: f64 = region
            .contours()
            .iter()
            .map(|c| {
                (0..c.len())
                    .map(|i| {
                        let (p, q) = (c[i], c[(i + 1) % c.len()]);
                        p.perp_dot(q) * (p.x + q.x) / 6.0
                    })
                    .sum::<f64>()
            })
            .sum();
        f64::from(sweep.fragments) * sin((sweep.angle / f64::from(sweep.fragments)).abs()) * moment.abs()
    }

    fn check(region: &Region, sweep: RotateSweep) -> Solid {
        let solid = rotate_extrude(region, &sweep).unwrap();
        let defects = Defects::of(solid.mesh());
        assert!(defects.is_solid() && defects.non_manifold_vertices == 0, "{sweep:?}: {defects:?}");
        assert_eq!(defects.unused_positions, 0);
        for t in 0..solid.triangles().len() {
            let [a, b, c] = solid.mesh().corners(t);
            assert!((b - a).cross(c - a).length() > 1e-9, "{sweep:?}: triangle {t} has no area");
        }
        let (actual, expected) = (volume(solid.mesh()), expected(region, &sweep));
        assert!((actual - expected).abs() <= 1e-12 * expected, "{sweep:?}: {actual} is not {expected}");
        solid
    }

    #[test]
    fn volumes_have_closed_forms() {
        let mirrored = {
            let mirror = |c: &Vec<Vec2>| c.iter().rev().map(|p| Vec2::new(-p.x, p.y)).collect();
            Region::assume(touching().contours().iter().map(mirror).collect())
        };
        for region in [touching(), mirrored] {
            check(&region, FULL);
            check(&region, RotateSweep { angle: -TAU, start: 1.0, fragments: 3 });
            check(&region, RotateSweep { angle: 1.5 * PI, start: -0.3, fragments: 7 });
            check(&region, RotateSweep { angle: -FRAC_PI_2, start: 0.0, fragments: 1 });
        }
    }

    #[test]
    fn contours_that_cross_keep_their_winding_numbers() {
        let twice = contour(&[(0., 0.), (2., 0.), (0., 2.)]);
        let hole = contour(&[(0., 0.), (0., 2.), (0., 3.), (2., 0.)]);
        let crossing = Region::assume(vec![twice.clone(), twice.clone(), hole.clone(), hole]);
        for sweep in [FULL, RotateSweep { angle: 2.0, ..FULL }] {
            let solid = rotate_extrude(&crossing, &sweep).unwrap();
            assert!(Defects::of(solid.mesh()).is_solid());
            assert!(volume(solid.mesh()) < 0.0, "more hole than not");
        }
    }

    #[test]
    fn right_angles_are_exact() {
        let square = Region::assume(vec![contour(&[(1., 0.), (2., 0.), (2., 1.), (1., 1.)])]);
        let solid = check(&square, RotateSweep { angle: FRAC_PI_2, start: FRAC_PI_2, fragments: 3 });
        assert!(solid.positions().contains(&Vec3::new(0.0, 2.0, 1.0)));
        assert!(solid.positions().contains(&Vec3::new(-2.0, 0.0, 1.0)));
        assert!(solid.positions().contains(&Vec3::new(-1.0, 3.0_f64.sqrt(), 1.0)));
    }

    #[test]
    fn wrong_numbers_are_errors() {
        let error = |region: &Region, sweep| rotate_extrude(region, &sweep).unwrap_err();
        let across = Region::assume(vec![contour(&[(-1., 0.), (2., 0.), (2., 1.)])]);
        assert_eq!(error(&across, FULL), SweepError::CrossesAxis { min: -1.0, max: 2.0 });
        assert_eq!(
            error(&touching(), RotateSweep { fragments: 2, ..FULL }),
            SweepError::TooFewSteps { steps: 2, needed: 3 }
        );
        assert_eq!(error(&touching(), RotateSweep { angle: f64::INFINITY, ..FULL }), SweepError::NonFinite);
        assert!(matches!(
            error(&touching(), RotateSweep { fragments: u32::MAX, ..FULL }),
            SweepError::TooLarge(_)
        ));
        assert!(rotate_extrude(&touching(), &RotateSweep { angle: 0.0, ..FULL }).unwrap().is_empty());
    }

    proptest! {
        #[test]
        fn always_closed(angle in -8.0..8.0_f64, start in -10.0..10.0_f64, fragments in 3_u32..9) {
            let solid = rotate_extrude(&touching(), &RotateSweep { angle, start, fragments }).unwrap();
            let defects = Defects::of(solid.mesh());
            prop_assert!(defects.is_solid() && defects.non_manifold_vertices == 0, "{:?}", defects);
        }
    }
}
