use super::width::{Comparison, Denominator, Numerator, Orientation};
use super::{Plane, Site};
use crate::math::Vec3;
use crate::numeric::{MixHasher, Wide, rounded_quotient};
use std::cmp::Ordering;
use std::hash::Hasher;

/// A point of a [`Points`] table. Equal points have equal ids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PointId(pub u32);

/// All points of one scene, each once.
#[derive(Debug, Default)]
pub struct Points {
    /// Positions in lattice units, correctly rounded.
    rounded: Vec<Vec3>,
    /// Integer coordinates; for other points, [`IS_FRACTION`] and an index in `fractions`.
    sites: Vec<Site>,
    fractions: Vec<Fraction>,
    /// Points by their rounded coordinates, in open addressing: each stands in the first free slot from its hash on.
    slots: Vec<u32>,
}

/// Three numerators over one positive denominator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    pub(crate) numerators: [Numerator; 3],
    pub(crate) denominator: Denominator,
}

/// No coordinate of a lattice point.
const IS_FRACTION: i64 = i64::MIN;

const FREE: u32 = u32::MAX;

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
        let rounded = rounded(site);
        match self.find(rounded, |known| self.sites[known] == site) {
            Ok(known) => known,
            Err(slot) => self.push(rounded, site, slot),
        }
    }

    /// Brings the places in the table of sites that will be asked for next into the cache, all at a time: in a large table
    /// each of them would have to be waited for.
    pub(super) fn prefetch(&self, sites: impl Iterator<Item = Site>) {
        if !self.slots.is_empty() {
            let seen = |site: Site| self.slots[self.first_slot(rounded(site))];
            std::hint::black_box(sites.fold(0, |all, site| all ^ seen(site)));
        }
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
        let site = self.sites[point.0 as usize];
        (site[0] != IS_FRACTION).then_some(site)
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
    pub(crate) fn fraction(&self, point: PointId) -> Result<Site, &Fraction> {
        let site = self.sites[point.0 as usize];
        if site[0] == IS_FRACTION { Err(&self.fractions[site[1] as usize]) } else { Ok(site) }
    }

    /// Numerators and denominator, whatever the point is.
    pub(crate) fn homogeneous(&self, point: PointId) -> ([Numerator; 3], Denominator) {
        match self.fraction(point) {
            Ok(site) => (site.map(Numerator::from), Denominator::from(1_i64)),
            Err(fraction) => (fraction.numerators, fraction.denominator),
        }
    }

    fn expect_site(&self, point: PointId) -> Site {
        self.as_site(point).expect("a lattice point")
    }

    /// The point with these coordinates; the denominator is positive.
    pub(crate) fn fraction_point(&mut self, numerators: [Numerator; 3], denominator: Denominator) -> PointId {
        let rounded = Vec3::from_array(numerators.map(|n| rounded_quotient(&n, &denominator)));
        if let Some(site) = integer_site(rounded, &numerators, &denominator) {
            return self.site(site);
        }
        let fraction = Fraction { numerators, denominator };
        match self.find(rounded, |known| self.is_fraction(known, &fraction)) {
            Ok(known) => known,
            Err(slot) => {
                self.fractions.push(fraction);
                self.push(rounded, [IS_FRACTION, self.fractions.len() as i64 - 1, 0], slot)
            }
        }
    }

    /// Whether a point, of which the rounded coordinates are right, has these coordinates. A fraction is never a lattice
    /// point: those are held as such.
    fn is_fraction(&self, known: usize, fraction: &Fraction) -> bool {
        let site = self.sites[known];
        site[0] == IS_FRACTION && {
            let other = &self.fractions[site[1] as usize];
            (0..3).all(|i| {
                let left: Comparison = other.numerators[i].times(&fraction.denominator);
                left == fraction.numerators[i].times(&other.denominator)
            })
        }
    }

    /// The point with these rounded coordinates that passes the test, or the slot where it belongs.
    fn find(&self, rounded: Vec3, is_same: impl Fn(usize) -> bool) -> Result<PointId, usize> {
        if self.slots.is_empty() {
            return Err(0);
        }
        let mut slot = self.first_slot(rounded);
        loop {
            match self.slots[slot] {
                FREE => return Err(slot),
                known if self.rounded[known as usize] == rounded && is_same(known as usize) => {
                    return Ok(PointId(known));
                }
                _ => slot = (slot + 1) & (self.slots.len() - 1),
            }
        }
    }

    /// Where to begin to look for a point. There is a power of two of slots.
    fn first_slot(&self, rounded: Vec3) -> usize {
        let mut hasher = MixHasher::default();
        // -0 and 0 are one coordinate.
        rounded.to_array().into_iter().for_each(|c| hasher.write_u64((c + 0.0).to_bits()));
        hasher.finish() as usize & (self.slots.len() - 1)
    }

    fn push(&mut self, rounded: Vec3, site: Site, slot: usize) -> PointId {
        let new = self.rounded.len() as u32;
        self.rounded.push(rounded);
        self.sites.push(site);
        // At most half of the slots are taken.
        if 2 * self.rounded.len() > self.slots.len() {
            self.place_all(4 * self.rounded.len());
        } else {
            self.slots[slot] = new;
        }
        PointId(new)
    }

    /// Makes room for more points to come.
    pub fn reserve(&mut self, more: usize) {
        self.rounded.reserve(more);
        self.sites.reserve(more);
        self.place_all(2 * (self.rounded.len() + more));
    }

    fn place_all(&mut self, least: usize) {
        self.slots = vec![FREE; least.next_power_of_two()];
        for point in 0..self.rounded.len() {
            let mut slot = self.first_slot(self.rounded[point]);
            while self.slots[slot] != FREE {
                slot = (slot + 1) & (self.slots.len() - 1);
            }
            self.slots[slot] = point as u32;
        }
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

fn rounded(site: Site) -> Vec3 {
    Vec3::from_array(site.map(|c| c as f64))
}

/// The integer coordinates of a fraction, when it has them.
fn integer_site(rounded: Vec3, numerators: &[Numerator; 3], denominator: &Denominator) -> Option<Site> {
    let site = rounded.to_array().map(|c| c as i64);
    let is_integer = |i: usize| {
        rounded[i].fract() == 0.0 && denominator.times::<1, 7>(&Wide::from(site[i])) == numerators[i]
    };
    (0..3).all(is_integer).then_some(site)
}
