//! Gauss-Legendre quadrature with a proved error bound.

use crate::math::pow;

/// Positive nodes on [-1, 1] and their weights of a symmetric rule with an even number of nodes.
pub type Rule = [(f64, f64)];

/// The rule with 8 nodes, exact for polynomials up to degree 15.
pub const GAUSS_8: &Rule = &[
    (0.1834346424956498, 0.362683783378362),
    (0.525532409916329, 0.31370664587788727),
    (0.7966664774136267, 0.22238103445337448),
    (0.9602898564975363, 0.10122853629037626),
];

/// The rule with 16 nodes, exact for polynomials up to degree 31.
pub const GAUSS_16: &Rule = &[
    (0.09501250983763744, 0.1894506104550685),
    (0.2816035507792589, 0.18260341504492358),
    (0.45801677765722737, 0.16915651939500254),
    (0.6178762444026438, 0.14959598881657674),
    (0.755404408355003, 0.12462897125553388),
    (0.8656312023878318, 0.09515851168249279),
    (0.9445750230732326, 0.062253523938647894),
    (0.9894009349916499, 0.027152459411754096),
];

/// The rule with 24 nodes, exact for polynomials up to degree 47.
pub const GAUSS_24: &Rule = &[
    (0.06405689286260563, 0.12793819534675216),
    (0.1911188674736163, 0.1258374563468283),
    (0.3150426796961634, 0.12167047292780339),
    (0.4337935076260451, 0.1155056680537256),
    (0.5454214713888396, 0.10744427011596563),
    (0.6480936519369755, 0.09761865210411388),
    (0.7401241915785544, 0.08619016153195327),
    (0.820001985973903, 0.0733464814110803),
    (0.8864155270044011, 0.05929858491543678),
    (0.9382745520027328, 0.04427743881741981),
    (0.9747285559713095, 0.028531388628933663),
    (0.9951872199970213, 0.0123412297999872),
];

/// The rule with 32 nodes, exact for polynomials up to degree 63.
pub const GAUSS_32: &Rule = &[
    (0.04830766568773832, 0.0965400885147278),
    (0.1444719615827965, 0.09563872007927486),
    (0.23928736225213706, 0.09384439908080457),
    (0.33186860228212767, 0.09117387869576389),
    (0.42135127613063533, 0.08765209300440381),
    (0.5068999089322294, 0.08331192422694675),
    (0.5877157572407623, 0.07819389578707031),
    (0.6630442669302152, 0.0723457941088485),
    (0.7321821187402897, 0.06582222277636185),
    (0.7944837959679424, 0.058684093478535544),
    (0.84936761373257, 0.050998059262376175),
    (0.8963211557660521, 0.04283589802222668),
    (0.9349060759377397, 0.03427386291302143),
    (0.9647622555875064, 0.02539206530926206),
    (0.9856115115452684, 0.01627439473090567),
    (0.9972638618494816, 0.007018610009470096),
];

/// The integral of `f` from `a` to `b` by one application of the rule; cost: an evaluation a node.
#[inline]
pub fn integrate(rule: &Rule, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * a + 0.5 * b, 0.5 * (b - a));
    let sum: f64 = rule.iter().map(|&(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum();
    half * sum
}

/// Bound of the error of [`integrate`] over [-1, 1] for a function that is analytic within the Bernstein ellipse of
/// parameter `rho > 1` (foci -1 and 1, sum of half-axes `rho`) and at most `size` in magnitude there.
///
/// Chebyshev coefficients of such a function are at most 2 `size` rho^-k; the rule with n nodes integrates every T_k
/// below 2n exactly, odd ones by symmetry, and errs on the others by at most 2 + 2 / (k^2 - 1); the geometric series
/// of the even ones from 2n on is the bound.
pub fn error_bound(rule: &Rule, size: f64, rho: f64) -> f64 {
    let n = 2.0 * rule.len() as f64;
    4.0 * size * (1.0 + 1.0 / (4.0 * n * n - 1.0)) * pow(rho, -2.0 * n) / (1.0 - 1.0 / (rho * rho))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_the_promised_degree_are_exact() {
        for rule in [GAUSS_8, GAUSS_16, GAUSS_24, GAUSS_32] {
            for degree in 0..4 * rule.len() as i32 {
                let got = integrate(rule, -1.0, 1.0, |x| x.powi(degree));
                let want = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
                assert!((got - want).abs() < 5e-16, "{} nodes, degree {degree}: {got}", 2 * rule.len());
            }
            let degree = 4 * rule.len() as i32;
            let got = integrate(rule, -1.0, 1.0, |x| x.powi(degree));
            assert!((got - 2.0 / f64::from(degree + 1)).abs() > 1e-11, "one degree more is not exact");
        }
    }

    #[test]
    fn the_bound_holds_near_a_pole_and_near_a_branch_point() {
        for distance in [1.1, 1.3, 2.0, 3.0_f64] {
            // 1 / (distance - x) has its pole on the ellipse whose half-axes sum to `edge`.
            let edge = distance + (distance * distance - 1.0).sqrt();
            for share in [0.5, 0.9, 0.99] {
                let rho = 1.0 + share * (edge - 1.0);
                let reach = 0.5 * (rho + 1.0 / rho);
                let exact = crate::math::ln((distance + 1.0) / (distance - 1.0));
                let root_exact =
                    ((distance + 1.0).powi(3).sqrt() - (distance - 1.0).powi(3).sqrt()) * 2.0 / 3.0;
                for rule in [GAUSS_8, GAUSS_16, GAUSS_24, GAUSS_32] {
                    let got = integrate(rule, -1.0, 1.0, |x| 1.0 / (distance - x));
                    let bound = error_bound(rule, 1.0 / (distance - reach), rho);
                    assert!((got - exact).abs() <= bound + 1e-15, "{distance} {rho}");
                    let got = integrate(rule, -1.0, 1.0, |x| (distance - x).sqrt());
                    let bound = error_bound(rule, (distance + reach).sqrt(), rho);
                    assert!((got - root_exact).abs() <= bound + 2e-15, "{distance} {rho}");
                }
            }
        }
    }
}
