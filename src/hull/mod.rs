//! Convex hulls in space.

mod facets;
mod quickhull;

use crate::math::Vec3;
use crate::mesh::{Mesh, Solid};
use crate::numeric::{Unfit, fitted};

/// The convex hull of points; empty where all of them are in one plane.
///
/// All signs are exact: every point is inside or on the surface, and the surface is convex. Vertices are those points that
/// are corners of the hull, in the order of their coordinates; points inside faces and edges are left out, and each flat
/// face, however many points lie on it, is triangulated once.
///
/// # Errors
/// [`Unfit`] for coordinates that are not finite or too far apart in size.
pub fn convex_hull(points: &[Vec3]) -> Result<Solid, Unfit> {
    // Adding zero turns -0 into 0.
    let mut places: Vec<Vec3> = points.iter().map(|&p| p + Vec3::ZERO).collect();
    let coordinates: Vec<[f64; 3]> = places.iter().map(Vec3::to_array).collect();
    fitted(&coordinates)?;
    places.sort_by(|p, q| p.to_array().partial_cmp(&q.to_array()).expect("finite"));
    places.dedup();
    let coordinates: Vec<[f64; 3]> = places.iter().map(Vec3::to_array).collect();
    let at: Vec<Vec3> = fitted(&coordinates)?.into_iter().map(Vec3::from).collect();
    let surface = quickhull::surface(&at);
    let triangles = facets::retriangulated(&at, &surface);
    Ok(Solid::assume(compact(&places, triangles), true))
}

/// The triangles with only those places that they use.
fn compact(places: &[Vec3], mut triangles: Vec<[u32; 3]>) -> Mesh {
    let mut number = vec![u32::MAX; places.len()];
    triangles.iter().flatten().for_each(|&v| number[v as usize] = 0);
    let mut positions = Vec::new();
    for (slot, &place) in number.iter_mut().zip(places).filter(|(slot, _)| **slot == 0) {
        *slot = positions.len() as u32;
        positions.push(place);
    }
    triangles.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
    Mesh { positions, triangles }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Defects, cuboid, sphere};
    use crate::numeric::orient3d;
    use proptest::prelude::*;

    fn volume(mesh: &Mesh) -> f64 {
        let six = |t: usize| {
            let [a, b, c] = mesh.corners(t);
            a.dot(b.cross(c))
        };
        (0..mesh.triangles.len()).map(six).sum::<f64>() / 6.0
    }

    /// Checks everything the hull promises, by exact signs.
    fn check(points: &[Vec3]) -> Solid {
        let hull = convex_hull(points).unwrap();
        let mesh = hull.mesh();
        let defects = Defects::of(mesh);
        assert!(defects.is_solid() && defects.non_manifold_vertices == 0 && defects.unused_positions == 0);
        for t in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(t);
            assert!(points.iter().all(|&p| orient3d(a, b, c, p) <= 0.0), "all points inside");
        }
        assert!(mesh.positions.iter().all(|p| points.contains(p)));
        assert_eq!(convex_hull(&mesh.positions).unwrap(), hull, "idempotent");
        hull
    }

    #[test]
    fn a_grid_is_a_cube_of_twelve_triangles() {
        let grid = |i: i32| Vec3::new((i % 5).into(), (i / 5 % 5).into(), (i / 25).into());
        let points: Vec<Vec3> = (0..125).map(grid).collect();
        let hull = check(&points);
        assert_eq!((hull.positions().len(), hull.triangles().len()), (8, 12));
        assert_eq!(volume(hull.mesh()), 64.0);
    }

    #[test]
    fn flat_faces_stay_whole() {
        let ball = sphere(1.0, 30).unwrap();
        let hull = check(ball.positions());
        assert_eq!(hull.positions().len(), ball.positions().len());
        assert!((volume(hull.mesh()) - volume(ball.mesh())).abs() < 1e-12);
        let both: Vec<Vec3> = ball.positions().iter().flat_map(|&p| [p, p + 4.0 * Vec3::X, -p]).collect();
        check(&both);
        let cube = cuboid(Vec3::splat(-2.0), Vec3::splat(2.0));
        let around: Vec<Vec3> = [ball.positions(), cube.positions()].concat();
        assert_eq!(check(&around).triangles().len(), 12);
    }

    #[test]
    fn flat_points_enclose_nothing() {
        let plane = |i: i32| Vec3::new(f64::from(i % 7), f64::from(i * i % 5), f64::from(i % 7) * 2.0);
        let cases = [
            vec![],
            vec![Vec3::ONE; 5],
            (0..9).map(|i| 0.5 * f64::from(i) * Vec3::ONE).collect(),
            (0..40).map(plane).collect(),
        ];
        for points in cases {
            assert!(convex_hull(&points).unwrap().is_empty(), "{points:?}");
        }
        assert_eq!(convex_hull(&[Vec3::ZERO, Vec3::NAN]), Err(Unfit::NonFinite { point: 1 }));
    }

    #[test]
    fn a_needle_thinner_than_rounding_has_a_hull() {
        let above = f64::from_bits(1.0_f64.to_bits() + 1);
        let hull = check(&[
            Vec3::new(0.0, 0.0, 1.0),
            Vec3::new(1e9, 0.0, 1.0),
            Vec3::new(0.0, 1e9, 1.0),
            Vec3::new(1e8, 1e8, above),
        ]);
        assert_eq!(hull.triangles().len(), 4);
    }

    proptest! {
        #[test]
        fn small_integers(raw in prop::collection::vec(prop::array::uniform3(-2..3_i32), 0..40), scale in 0.1..1.0_f64) {
            let point = |p: &[i32; 3]| scale * Vec3::from(p.map(f64::from));
            check(&raw.iter().map(point).collect::<Vec<_>>());
        }

        #[test]
        fn anywhere(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 4..80)) {
            check(&points.into_iter().map(Vec3::from).collect::<Vec<_>>());
        }
    }
}
