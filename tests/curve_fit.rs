//! Fits, simplified paths, offsets and strokes against dense measurements of what they stand for.

use ogee::curve::{
    Arc, Bernstein, Continuity, Cubic, CurveError, Path, Piece, Ray, Side, Source, Spline, Subpath, fit, nearest,
    simplify,
};
use ogee::math::{Vec2, cos, sin};

/// y = sin x.
struct Wave;

impl Source for Wave {
    fn domain(&self) -> [f64; 2] {
        [0.0, 20.0]
    }

    fn ray(&self, t: f64, _: Side) -> Ray {
        let velocity = Vec2::new(1.0, cos(t));
        let speed = velocity.length();
        Ray { point: Vec2::new(t, sin(t)), tangent: velocity / speed, speed }
    }

    fn deviation(&self, from: f64, to: f64, cubic: &Cubic<Vec2>) -> f64 {
        // The fourth derivative is at most 1; the cubic's x may be off by rounding.
        let [a, b, c, d] = cubic.to_array().map(|p| p.x);
        let third = (to - from) / 3.0;
        let off = [a - from, b - from - third, c - to + third, d - to].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        (to - from).powi(4) / 384.0 + 2.0 * off + 1e-14
    }
}

fn distance(curve: &Spline<Vec2>, point: Vec2) -> f64 {
    curve.pieces().map(|piece| nearest(&piece, point).unwrap().distance.value).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_wave_is_followed_from_both_sides() {
    let mut counts = Vec::new();
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-9] {
        let fitted = fit(&Wave, tolerance).unwrap();
        let curve = &fitted.curve;
        counts.push(curve.knots().len() - 1);
        let mut worst = 0.0_f64;
        for k in 0..=2000 {
            let t = f64::from(k) / 100.0;
            worst = worst.max(distance(curve, Vec2::new(t, sin(t))));
        }
        for piece in curve.pieces() {
            for k in 0..=50 {
                // The vertical distance is at most sqrt 2 times the distance.
                let p = piece.eval(f64::from(k) / 50.0);
                worst = worst.max((p.y - sin(p.x)).abs() / 2.0_f64.sqrt());
            }
        }
        assert!(worst <= fitted.error && fitted.error <= tolerance, "{tolerance}: {worst} {fitted:?}");
        assert!(worst > 0.4 * fitted.error, "{tolerance}: {worst} {}", fitted.error);
        for index in 1..curve.knots().len() - 1 {
            assert!(curve.joint(index).unwrap().misfit(Continuity::G1) < 1e-9);
        }
        assert_eq!(curve.eval(0.0), Vec2::ZERO);
    }
    println!("{counts:?}");
}
