use super::Surface;
use crate::numeric::quadrature::{GAUSS_8, GAUSS_16, Rule, integrate};

/// The area of a surface, to about a share of itself.
///
/// The length of the cross product is integrated by Gauss' rules with 8 and with 16 points an axis; parts on which they
/// differ are quartered. Where the surface folds or has a pole the cross product has a kink, and ever smaller parts with
/// ever less area hold it; they end when they make up less than the accuracy.
///
/// ```
/// use ogee::surface::{Classic, area};
/// use std::f64::consts::PI;
///
/// let ball = Classic::Sphere { radius: 2.0 };
/// assert!((area(&ball, 1e-9) - 16.0 * PI).abs() < 1e-7);
/// ```
pub fn area(surface: &dyn Surface, accuracy: f64) -> f64 {
    let domain = surface.domain();
    let mut total = 0.0;
    let mut pending = vec![(domain, 0)];
    let rough = over(surface, domain, GAUSS_16);
    while let Some((part, depth)) = pending.pop() {
        let (coarse, fine) = (over(surface, part, GAUSS_8), over(surface, part, GAUSS_16));
        // Beyond this depth a part is 4^-20 of the domain.
        if (coarse - fine).abs() <= 0.25 * accuracy * rough || depth == 20 {
            total += fine;
            continue;
        }
        let [[a, b], [c, d]] = part;
        let (u, v) = (0.5 * a + 0.5 * b, 0.5 * c + 0.5 * d);
        for quarter in [[[a, u], [c, v]], [[u, b], [c, v]], [[a, u], [v, d]], [[u, b], [v, d]]] {
            pending.push((quarter, depth + 1));
        }
    }
    total
}

fn over(surface: &dyn Surface, [[a, b], [c, d]]: [[f64; 2]; 2], rule: &Rule) -> f64 {
    integrate(rule, a, b, |u| {
        integrate(rule, c, d, |v| {
            let jet = surface.jet(u, v);
            jet.du.cross(jet.dv).length()
        })
    })
}
