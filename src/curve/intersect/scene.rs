//! Two curves brought near the origin and size 1, and the numbers that bound what rounding does to them.

use super::part::{Part, Store, U};
use crate::curve::subdivide::reciprocal_powers;
use crate::math::Vec2;
use crate::numeric::double_double::DoubleDouble;

/// Two curves about the origin whose control points are at most 1 in size.
pub(super) struct Scene<S> {
    pub(super) a: S,
    pub(super) b: S,
    /// The control points as they are.
    raw: [S; 2],
    /// A shift before and two factors after the origin is taken off, which make these of the raw points.
    scale: [f64; 3],
    /// How far the difference of two points may be off, in either norm.
    pub(super) rounding: f64,
    /// Bound of the second derivatives together.
    pub(super) bend: f64,
    /// How far control points that were rounded when curves were cut may be from where they should be.
    pub(super) grain: f64,
    /// Whether the ends are ends of whole curves.
    is_whole: bool,
}

/// Coordinates with fewer digits than these are taken for exact ones.
const COARSEST_GRAIN: f64 = 1.0 / (1_u64 << 26) as f64;

impl<S: Store> Scene<S> {
    #[inline]
    pub(super) fn new(a: S, b: S) -> Scene<S> {
        let raw = [a, b];
        let largest =
            raw.iter().flat_map(AsRef::as_ref).fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        // A difference of huge numbers overflows, a quarter of subnormal ones loses digits.
        let quarter = if largest > 1e300 { 0.25 } else { 1.0 };
        let origin = raw[0].as_ref()[0] * quarter;
        let [mut a, mut b] = raw.clone();
        let mut size: f64 = 0.0;
        for p in a.as_mut().iter_mut().chain(b.as_mut()) {
            *p = *p * quarter - origin;
            size = size.max(p.abs().max_element());
        }
        let [first, second] = if size > 0.0 { reciprocal_powers(size) } else { [1.0, 1.0] };
        let scale = [quarter, first, 0.5 * second];
        for p in a.as_mut().iter_mut().chain(b.as_mut()) {
            *p = *p * scale[1] * scale[2];
        }
        // De Casteljau has at most as many blends in a row as the degree, each off by 3 u; two curves, two axes.
        let degree = a.as_ref().len().max(b.as_ref().len()) - 1;
        let rounding = 4.0 * U * (4.0 + 3.0 * degree as f64);
        let bend = bend(a.as_ref()) + bend(b.as_ref());
        let grain = grain(degree, largest * quarter * scale[1] * scale[2]);
        Scene { a, b, raw, scale, rounding, bend, grain, is_whole: true }
    }

    pub(super) fn parts(&self) -> [Part<S>; 2] {
        [Part::whole(self.a.clone()), Part::whole(self.b.clone())]
    }

    /// A length of the scene in model units.
    pub(super) fn outward(&self, length: f64) -> f64 {
        length / self.scale[1] / self.scale[2] / self.scale[0]
    }

    /// A length in model units in those of the scene.
    pub(super) fn inward(&self, length: f64) -> f64 {
        length * self.scale[0] * self.scale[1] * self.scale[2]
    }

    /// The coordinate along which curves run that are on one straight line within the grain, and no points; `None` for
    /// others.
    pub(super) fn common_axis(&self, curves: &[&[Vec2]]) -> Option<usize> {
        let origin = curves[0][0];
        let offsets = || curves.iter().flat_map(|points| points.iter()).map(|&p| p - origin);
        let far = offsets().max_by(|p, q| p.length_squared().total_cmp(&q.length_squared()))?;
        let direction = far.try_normalize()?;
        let axis = usize::from(direction.y.abs() > direction.x.abs());
        offsets().all(|p| direction.perp_dot(p).abs() <= self.grain).then_some(axis)
    }

    /// Whether the ends at parameters 0 or 1 are the same point, exactly; that of windows is not known.
    pub(super) fn ends_are_equal(&self, s: f64, t: f64) -> bool {
        let end = |points: &[Vec2], t: f64| points[if t == 0.0 { 0 } else { points.len() - 1 }];
        self.is_whole && end(self.raw[0].as_ref(), s) == end(self.raw[1].as_ref(), t)
    }

    /// The parts of both curves between parameters (low and high of the first, then of the second) as a scene of their
    /// own; `None` where they are so small that rounding shows even in double-double.
    pub(super) fn window(&self, [a_low, a_high, b_low, b_high]: [f64; 4]) -> Option<Scene<S>> {
        let [mut a, mut b] = self.raw.clone();
        for axis in 0..2 {
            let curves = [&self.raw[0], &self.raw[1]].map(|points| self.exact(points.as_ref(), axis));
            let blossom = |k: usize, i: usize, low: f64, high: f64| blossom(curves[k].clone(), i, low, high);
            let origin = blossom(0, 0, a_low, a_high);
            for (i, p) in a.as_mut().iter_mut().enumerate() {
                p[axis] = (blossom(0, i, a_low, a_high) - origin).to_f64();
            }
            for (i, p) in b.as_mut().iter_mut().enumerate() {
                p[axis] = (blossom(1, i, b_low, b_high) - origin).to_f64();
            }
        }
        let size =
            a.as_ref().iter().chain(b.as_ref()).fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        // Double-double rounds 2^-104 of the curves, a few dozen times; the parts' f64 rounds 2^-53 of their size.
        let is_clear = size > 1.0 / (1_u64 << 44) as f64;
        is_clear.then(|| Scene { is_whole: false, ..Scene::new(a, b) })
    }

    /// A coordinate of control points in the scene, without rounding.
    fn exact(&self, points: &[Vec2], axis: usize) -> Vec<DoubleDouble> {
        let [quarter, first, second] = self.scale;
        let origin = self.raw[0].as_ref()[0][axis] * quarter;
        let difference = |p: &Vec2| DoubleDouble::difference(p[axis] * quarter, origin);
        let scaled = |x: DoubleDouble| DoubleDouble { hi: x.hi * first * second, lo: x.lo * first * second };
        points.iter().map(difference).map(scaled).collect()
    }

    /// The second curve's point less the first one's, in double-double, and the bound of its error.
    pub(super) fn residual(&self, s: f64, t: f64) -> (Vec2, f64) {
        let axis = |axis: usize| {
            let [on_a, on_b] = [&self.raw[0], &self.raw[1]].map(|points| self.exact(points.as_ref(), axis));
            (blossom(on_b, 0, t, t) - blossom(on_a, 0, s, s)).to_f64()
        };
        let degree = self.a.as_ref().len().max(self.b.as_ref().len()) as f64;
        let rest = Vec2::new(axis(0), axis(1));
        (rest, 16.0 * degree * DoubleDouble::EPSILON + 2.0 * U * (rest.x.abs() + rest.y.abs()))
    }
}

/// The polar form at `high` as often as `highs` says and else at `low`: that control point of the part between them.
fn blossom(mut row: Vec<DoubleDouble>, highs: usize, low: f64, high: f64) -> DoubleDouble {
    for count in (1..row.len()).rev() {
        let t = if count <= highs { high } else { low };
        let rest = DoubleDouble::difference(1.0, t);
        for i in 0..count {
            row[i] = row[i] * rest + row[i + 1] * t;
        }
    }
    row[0]
}

/// How far control points of a degree and coordinates up to a size, in the units of a scene, may be off because they were
/// rounded when a curve was cut or turned: 16 n u of the largest, 5e-15 of it for cubics.
///
/// A cut has two passes of as many blends in a row as the degree n; each is off by up to 3 u. That are 6 n u for one
/// curve, 12 n u for two, and as much as is usual when they are cut again to be compared.
pub(super) fn grain(degree: usize, largest: f64) -> f64 {
    (16.0 * degree as f64 * U * largest.max(1.0)).min(COARSEST_GRAIN)
}

/// Bound of the second derivative in the sum norm.
fn bend(points: &[Vec2]) -> f64 {
    let n = (points.len() - 1) as f64;
    let bends = points.windows(3).map(|p| p[2] - p[1] * 2.0 + p[0]).map(|d| d.x.abs() + d.y.abs());
    n * (n - 1.0) * (bends.fold(0.0, f64::max) + 8.0 * U)
}
