use super::Region;
use crate::math::Vec2;
use crate::numeric::{Unfit, fitted, orient2d};

/// The convex hull of points, by the monotone chain (Andrew 1979) on exact signs: one contour of those points that are
/// corners, or the empty region where all are on one line.
///
/// # Errors
/// [`Unfit`] for coordinates that are not finite or too far apart in size.
pub fn convex_hull(points: &[Vec2]) -> Result<Region, Unfit> {
    let coordinates: Vec<[f64; 2]> = points.iter().map(Vec2::to_array).collect();
    let at: Vec<Vec2> = fitted(&coordinates)?.into_iter().map(Vec2::from).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| (at[i].x, at[i].y).partial_cmp(&(at[j].x, at[j].y)).expect("finite"));
    order.dedup_by(|a, b| at[*a] == at[*b]);
    let mut corners = chain(&at, order.iter().copied());
    let upper = chain(&at, order.iter().rev().copied());
    if corners.len() + upper.len() < 5 {
        return Ok(Region::default());
    }
    // Each chain ends where the other starts.
    corners.pop();
    corners.extend(&upper[..upper.len() - 1]);
    Ok(Region::assume(vec![corners.into_iter().map(|i| points[i]).collect()]))
}

/// The points at which a walk through all of them, kept as far to the right as can be, turns left.
fn chain(at: &[Vec2], order: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut chain: Vec<usize> = Vec::new();
    for next in order {
        while let [.., a, b] = chain[..]
            && orient2d(at[a], at[b], at[next]) <= 0.0
        {
            chain.pop();
        }
        chain.push(next);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corners(points: &[Vec2]) -> Vec<Vec2> {
        convex_hull(points).unwrap().contours().first().cloned().unwrap_or_default()
    }

    #[test]
    fn a_grid_has_four_corners() {
        let grid: Vec<Vec2> = (0..100).map(|i| Vec2::new(f64::from(i % 10), f64::from(i / 10))).collect();
        let at = |x, y| Vec2::new(x, y);
        assert_eq!(corners(&grid), [at(0., 0.), at(9., 0.), at(9., 9.), at(0., 9.)]);
    }

    #[test]
    fn points_on_a_line_enclose_nothing() {
        for points in
            [vec![], vec![Vec2::ONE; 3], vec![Vec2::ZERO, Vec2::ONE], vec![Vec2::ZERO, Vec2::ONE, -Vec2::ONE]]
        {
            assert!(convex_hull(&points).unwrap().is_empty());
        }
        // Collinear to rounding, but not exactly.
        let tenth = |i: f64| Vec2::new(0.1 * i, 0.3 * i);
        assert_eq!(corners(&[tenth(1.0), tenth(2.0), tenth(3.0)]).len(), 3);
        assert_eq!(convex_hull(&[Vec2::NAN]), Err(Unfit::NonFinite { point: 0 }));
    }

    proptest! {
        #[test]
        fn convex_and_around_all(raw in prop::collection::vec((-4..5_i32, -4..5_i32), 0..30), scale in 0.1..1.0_f64) {
            let points: Vec<Vec2> = raw.iter().map(|&(x, y)| scale * Vec2::new(x.into(), y.into())).collect();
            let hull = corners(&points);
            prop_assert_eq!(&corners(&hull), &hull);
            let n = hull.len();
            for i in 0..n {
                let (a, b) = (hull[i], hull[(i + 1) % n]);
                prop_assert!(orient2d(a, b, hull[(i + 2) % n]) > 0.0);
                prop_assert!(points.iter().all(|&p| orient2d(a, b, p) >= 0.0));
                prop_assert!(points.contains(&a));
            }
        }
    }
}
