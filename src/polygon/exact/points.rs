use super::width::{Comparison, Denominator, Numerator, Orientation};
use super::{Plane, Site};
use crate::math::Vec3;
use crate::numeric::{MixHasher, Wide, rounded_quotient};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::hash::BuildHasherDefault;

/// A point of a [`Points`] table. Equal points have equal ids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PointId(pub u32);

/// All points of one scene, each once.
#[derive(Debug, Default)]
pub struct Points {
    /// Positions in lattice units, correctly rounded.
    rounded: Vec<Vec3>,
    exact: Vec<Exact>,
    /// First point with these rounded coordinates; further ones are chained through `next`.
    first: HashMap<[u64; 3], u32, BuildHasherDefault<MixHasher>>,
    next: Vec<u32>,
}

#[derive(Debug)]
enum Exact {
    Site(Site),
    Fraction(Box<([Numerator; 3], Denominator)>),
}

const NO_POINT: u32 = u32::MAX;

/// Relative error of an orientation in doubles from rounded coordinates, in units of the products of the sums of
/// magnitudes: two roundings in each difference beside those of its terms, one in each product, one in the sum.
const ORIENTATION_FILTER: f64 = 10.0 * (f64::EPSILON / 2.0);

impl Points {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.rounded.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.rounded.is_empty()
    }

    /// The point at a lattice site.
    pub fn site(&mut self, site: Site) -> PointId {
        self.intern(Exact::Site(site), Vec3::new(site[0] as f64, site[1] as f64, site[2] as f64))
    }

    /// Where the segment between two lattice points on different sides of `plane` crosses it.
    ///
    /// # Panics
    /// When a point is no lattice point, or both lie on one side.
    pub fn crossing(&mut self, a: PointId, b: PointId, plane: &Plane) -> PointId {
        let (from, to) = (self.expect_site(a), self.expect_site(b));
        let (at_from, at_to) = (plane.at_site(from), plane.at_site(to));
        assert!(at_from.signum() * at_to.signum() < 0, "the segment does not cross the plane");
        // from + (to - from) at_from / (at_from - at_to), with a positive denominator.
        let (near, far) =
            if at_to.signum() > 0 { (at_from, at_to) } else { (at_from.negated(), at_to.negated()) };
        let numerator = |i: usize| -> Numerator {
            Wide::<1>::from(from[i]).times(&far).minus(&Wide::<1>::from(to[i]).times(&near))
        };
        let denominator = far.minus(&near).widen();
        self.fraction_point([numerator(0), numerator(1), numerator(2)], denominator)
    }

    /// Where three planes meet; `None` where they do not meet in one point.
    pub fn meeting(&mut self, p: &Plane, q: &Plane, r: &Plane) -> Option<PointId> {
        let (numerators, denominator) = Plane::meet(p, q, r)?;
        Some(self.fraction_point(numerators, denominator))
    }

    /// Position in lattice units, correctly rounded to doubles.
    #[inline]
    pub fn rounded(&self, point: PointId) -> Vec3 {
        self.rounded[point.0 as usize]
    }

    /// The integer coordinates of a lattice point; `None` for other points.
    pub fn as_site(&self, point: PointId) -> Option<Site> {
        match &self.exact[point.0 as usize] {
            Exact::Site(site) => Some(*site),
            Exact::Fraction(_) => None,
        }
    }

    /// Orders two points by one coordinate.
    #[inline]
    pub fn compare(&self, a: PointId, b: PointId, axis: usize) -> Ordering {
        let (x, y) = (self.rounded(a)[axis], self.rounded(b)[axis]);
        x.partial_cmp(&y).filter(|order| order.is_ne()).unwrap_or_else(|| self.compare_exactly(a, b, axis))
    }

    /// Twice the signed area of the triangle `a b c` seen along `axis`: 1 when it runs counter-clockwise in the plane of
    /// the next two axes, 0 when the points lie on a line there.
    pub fn orientation(&self, a: PointId, b: PointId, c: PointId, axis: usize) -> i32 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (pa, pb, pc) = (self.rounded(a), self.rounded(b), self.rounded(c));
        let left = (pa[u] - pc[u]) * (pb[v] - pc[v]);
        let right = (pa[v] - pc[v]) * (pb[u] - pc[u]);
        let sum = |i: usize, p: Vec3| p[i].abs() + pc[i].abs();
        let bound = ORIENTATION_FILTER * (sum(u, pa) * sum(v, pb) + sum(v, pa) * sum(u, pb));
        if (left - right).abs() > bound {
            return if left > right { 1 } else { -1 };
        }
        self.exact_orientation([a, b, c], u, v)
    }

    /// Integer coordinates, or numerators and a positive denominator.
    pub(crate) fn fraction(&self, point: PointId) -> Result<Site, (&[Numerator; 3], &Denominator)> {
        match &self.exact[point.0 as usize] {
            Exact::Site(site) => Ok(*site),
            Exact::Fraction(fraction) => Err((&fraction.0, &fraction.1)),
        }
    }

    /// Numerators and denominator, whatever the point is.
    pub(crate) fn homogeneous(&self, point: PointId) -> ([Numerator; 3], Denominator) {
        match &self.exact[point.0 as usize] {
            Exact::Site(site) => (site.map(Numerator::from), Denominator::from(1_i64)),
            Exact::Fraction(fraction) => **fraction,
        }
    }

    fn expect_site(&self, point: PointId) -> Site {
        self.as_site(point).expect("a lattice point")
    }

    fn fraction_point(&mut self, numerators: [Numerator; 3], denominator: Denominator) -> PointId {
        let rounded = Vec3::from_array(numerators.map(|n| rounded_quotient(&n, &denominator)));
        match integer_site(rounded, &numerators, &denominator) {
            Some(site) => self.site(site),
            None => self.intern(Exact::Fraction(Box::new((numerators, denominator))), rounded),
        }
    }

    fn intern(&mut self, exact: Exact, rounded: Vec3) -> PointId {
        let key = rounded.to_array().map(|c| (c + 0.0).to_bits());
        let new = self.rounded.len() as u32;
        let mut known = match self.first.entry(key) {
            std::collections::hash_map::Entry::Vacant(slot) => {
                slot.insert(new);
                NO_POINT
            }
            std::collections::hash_map::Entry::Occupied(slot) => *slot.get(),
        };
        let mut last = NO_POINT;
        while known != NO_POINT {
            if self.exact[known as usize].equals(&exact) {
                return PointId(known);
            }
            (last, known) = (known, self.next[known as usize]);
        }
        if last != NO_POINT {
            self.next[last as usize] = new;
        }
        self.rounded.push(rounded);
        self.exact.push(exact);
        self.next.push(NO_POINT);
        PointId(new)
    }

    #[cold]
    fn compare_exactly(&self, a: PointId, b: PointId, axis: usize) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        if let (Some(x), Some(y)) = (self.as_site(a), self.as_site(b)) {
            return x[axis].cmp(&y[axis]);
        }
        let ((x, w), (y, v)) = (self.homogeneous(a), self.homogeneous(b));
        let left: Comparison = x[axis].times(&v);
        left.cmp(&y[axis].times(&w))
    }

    #[cold]
    fn exact_orientation(&self, [a, b, c]: [PointId; 3], u: usize, v: usize) -> i32 {
        if let (Some(a), Some(b), Some(c)) = (self.as_site(a), self.as_site(b), self.as_site(c)) {
            let difference = |p: Site, i: usize| i128::from(p[i]) - i128::from(c[i]);
            let (left, right) = (difference(a, u) * difference(b, v), difference(a, v) * difference(b, u));
            return left.cmp(&right) as i32;
        }
        let ((a, aw), (b, bw), (c, cw)) = (self.homogeneous(a), self.homogeneous(b), self.homogeneous(c));
        let minor = |p: &[Numerator; 3], q: &[Numerator; 3], w: &Denominator| -> Orientation {
            let left: Wide<14> = p[u].times(&q[v]);
            left.minus(&p[v].times(&q[u])).times(w)
        };
        minor(&a, &b, &cw).plus(&minor(&b, &c, &aw)).plus(&minor(&c, &a, &bw)).signum()
    }
}

impl Exact {
    /// Whether both are the same point, given that their rounded coordinates are the same. A fraction is never a
    /// lattice point (those are stored as such).
    fn equals(&self, other: &Exact) -> bool {
        match (self, other) {
            (Exact::Site(a), Exact::Site(b)) => a == b,
            (Exact::Fraction(a), Exact::Fraction(b)) => (0..3).all(|i| {
                let left: Comparison = a.0[i].times(&b.1);
                left == b.0[i].times(&a.1)
            }),
            _ => false,
        }
    }
}

/// The integer coordinates of a fraction, when it has them.
fn integer_site(rounded: Vec3, numerators: &[Numerator; 3], denominator: &Denominator) -> Option<Site> {
    let site = rounded.to_array().map(|c| c as i64);
    let is_integer = |i: usize| {
        rounded[i].fract() == 0.0 && denominator.times::<1, 7>(&Wide::from(site[i])) == numerators[i]
    };
    (0..3).all(is_integer).then_some(site)
}
