//! Closed plane paths: area, moments, and which points they go around.

use super::subdivide::derivative;
use super::{Bernstein, Bounded, Cubic, CurveError, Spline, check_finite};
use crate::math::Vec2;
use crate::numeric::orient2d;
use crate::numeric::quadrature::{GAUSS_8, integrate};

/// Area and moments of what a closed path goes around, each part counted as often as it goes around it
/// counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Area, in square model units; negative for clockwise paths.
    pub area: Bounded<f64>,
    /// The centre of mass; not finite when the area is zero.
    pub centroid: Vec2,
    /// Integrals of x^2, x y and y^2 about the centroid.
    pub second: [f64; 3],
}

/// Area and moments of a closed spline, by Green's theorem; the integrals along cubics are exact but for rounding.
///
/// # Errors
/// [`CurveError::Open`] when the spline is not closed.
pub fn moments(path: &Spline<Vec2>) -> Result<Moments, CurveError> {
    if !path.is_closed() {
        return Err(CurveError::Open);
    }
    // From the middle of the box, so that a far origin does not cost digits.
    let bounds = path.bounding_box();
    let origin = 0.5 * bounds.min + 0.5 * bounds.max;
    let mut sums = [0.0; 6];
    let mut size = 0.0;
    for piece in path.pieces() {
        let points = piece.to_array().map(|p| p - origin);
        let velocity = derivative(&points, 1);
        let reach = points.iter().fold(0.0, |most: f64, p| most.max(p.length()));
        size += reach * velocity.iter().fold(0.0, |most: f64, v| most.max(v.length()));
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum += integrate(GAUSS_8, 0.0, 1.0, |t| {
                let (p, v) =
                    (super::evaluate::de_casteljau(&points, t), super::evaluate::de_casteljau(&velocity, t));
                let across = p.perp_dot(v);
                // Green's forms of degree d + 2 are the monomial times x dy - y dx over d + 2.
                match k {
                    0 => across / 2.0,
                    1 => p.x * across / 3.0,
                    2 => p.y * across / 3.0,
                    3 => p.x * p.x * across / 4.0,
                    4 => p.x * p.y * across / 4.0,
                    _ => p.y * p.y * across / 4.0,
                }
            });
        }
    }
    let [area, x, y, xx, xy, yy] = sums;
    let center = Vec2::new(x / area, y / area);
    let second = [xx - center.x * x, xy - center.x * y, yy - center.y * y];
    let error = 16.0 * f64::EPSILON * size;
    Ok(Moments { area: Bounded { value: area, error }, centroid: origin + center, second })
}

/// How a closed path goes around a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// So many times counter-clockwise; 0 is outside.
    Around(i32),
    /// The point is on the path, as far as rounding can tell.
    OnPath,
}

/// How often a closed spline goes around a point.
///
/// A piece whose box does not hold the point can be replaced by its chord without crossing the point; the others are
/// halved until that is so. What is left is a polygon, whose windings are decided by exact signs.
///
/// # Errors
/// [`CurveError::Open`] when the spline is not closed, [`CurveError::NotFinite`] when the point is not finite.
pub fn winding(path: &Spline<Vec2>, point: Vec2) -> Result<Winding, CurveError> {
    if !path.is_closed() {
        return Err(CurveError::Open);
    }
    check_finite(&[point])?;
    let size = path.points().iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    // Halving moves points by the rounding of at most 3 blends.
    let floor = 8.0 * f64::EPSILON * size;
    let mut turns = 0;
    for piece in path.pieces() {
        match around(&piece, point, floor) {
            Winding::Around(part) => turns += part,
            Winding::OnPath => return Ok(Winding::OnPath),
        }
    }
    Ok(Winding::Around(turns))
}

/// Signed crossings of a piece with the ray from the point along x, as its replacement by chords has them.
fn around(piece: &Cubic<Vec2>, point: Vec2, floor: f64) -> Winding {
    let points = piece.to_array();
    let min = points.iter().fold(points[0], |a, &b| a.min(b));
    let max = points.iter().fold(points[0], |a, &b| a.max(b));
    if point.cmplt(min).any() || point.cmpgt(max).any() {
        return Winding::Around(crossing(points[0], points[3], point));
    }
    if (max - min).max_element() <= floor {
        return Winding::OnPath;
    }
    let Ok((left, right)) = piece.split(0.5) else { return Winding::OnPath };
    match (around(&left, point, floor), around(&right, point, floor)) {
        (Winding::Around(a), Winding::Around(b)) => Winding::Around(a + b),
        _ => Winding::OnPath,
    }
}

/// 1 where an edge crosses the ray upward, -1 downward; lower ends belong to an edge, upper ends do not.
fn crossing(from: Vec2, to: Vec2, point: Vec2) -> i32 {
    if from.y <= point.y && point.y < to.y {
        i32::from(orient2d(from, to, point) > 0.0)
    } else if to.y <= point.y && point.y < from.y {
        -i32::from(orient2d(from, to, point) < 0.0)
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;
    use proptest::prelude::*;

    /// The usual four cubics, radius 1 up to 2.7e-4, turned by an angle.
    fn circle(angle: f64) -> Spline<Vec2> {
        let arm = 0.551_915_023_494;
        let mut points = Vec::new();
        for quarter in 0..4 {
            let (sine, cosine) = sin_cos(angle + f64::from(quarter) * std::f64::consts::FRAC_PI_2);
            let turn = |x: f64, y: f64| Vec2::new(cosine * x - sine * y, sine * x + cosine * y);
            points.extend([turn(1.0, 0.0), turn(1.0, arm), turn(arm, 1.0)]);
        }
        Spline::closed(points, super::super::spline::uniform_knots(4)).unwrap()
    }

    proptest! {
        #[test]
        fn circles_know_inside_from_outside(angle in 0.0..7.0_f64, at in 0.0..7.0_f64, far in 1e-3..0.9_f64) {
            let path = circle(angle);
            let (sine, cosine) = sin_cos(at);
            let direction = Vec2::new(cosine, sine);
            prop_assert_eq!(winding(&path, direction * (1.0 - far)), Ok(Winding::Around(1)));
            prop_assert_eq!(winding(&path, direction * (1.0 + far)), Ok(Winding::Around(0)));
            let found = moments(&path).unwrap();
            prop_assert!((found.area.value - std::f64::consts::PI).abs() < 1e-3);
            prop_assert!(found.centroid.length() < 1e-15);
            prop_assert!((found.second[0] - std::f64::consts::FRAC_PI_4).abs() < 1e-3);
            prop_assert!(found.second[1].abs() < 1e-15);
        }
    }

    #[test]
    fn points_on_and_beside_the_path() {
        let path = circle(0.3);
        for k in 0..40 {
            let p = path.eval(0.1 * f64::from(k));
            let inward = p * (1.0 - 1e-13);
            assert_eq!(winding(&path, inward), Ok(Winding::Around(1)), "{k}");
            assert_eq!(winding(&path, p * (1.0 + 1e-13)), Ok(Winding::Around(0)), "{k}");
        }
        assert_eq!(winding(&path, path.points()[3]), Ok(Winding::OnPath));
        let back = Spline::from_pieces(&circle(0.0).pieces().collect::<Vec<_>>()).unwrap();
        assert_eq!(winding(&back, Vec2::ZERO), Err(CurveError::Open));
        assert_eq!(winding(&path, Vec2::NAN), Err(CurveError::NotFinite { index: 0 }));
    }

    #[test]
    fn a_far_square_has_its_area() {
        let corner = Vec2::splat(1e8);
        let corners = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)].map(|c| corner + Vec2::from(c));
        let sides = (0..4).map(|i| {
            let side = crate::curve::Line::new([corners[i], corners[(i + 1) % 4]]).unwrap();
            side.elevated::<4>()
        });
        let path = Spline::from_pieces(&sides.collect::<Vec<_>>()).unwrap().into_closed().unwrap();
        let found = moments(&path).unwrap();
        assert!((found.area.value - 9.0).abs() < 1e-6 && (found.centroid - corner - 1.5).length() < 1e-6);
        assert!((found.second[0] - 6.75).abs() < 1e-6);
    }
}
