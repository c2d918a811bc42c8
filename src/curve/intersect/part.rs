//! Parts of curves: cut, boxed, and kept apart by proofs that allow for rounding.

use crate::math::Vec2;

/// Unit roundoff.
pub(super) const U: f64 = 0.5 * f64::EPSILON;

/// Control points on the stack for cubics, on the heap for the rest.
pub(super) trait Store: Clone + AsRef<[Vec2]> + AsMut<[Vec2]> {
    /// Point and derivative.
    fn at(&self, t: f64) -> (Vec2, Vec2);
}

impl Store for [Vec2; 4] {
    #[inline]
    fn at(&self, t: f64) -> (Vec2, Vec2) {
        let [a, b, c, d] = *self;
        let (p, q, r) = (a + (b - a) * t, b + (c - b) * t, c + (d - c) * t);
        let (v, w) = (p + (q - p) * t, q + (r - q) * t);
        (v + (w - v) * t, (w - v) * 3.0)
    }
}

impl Store for Vec<Vec2> {
    fn at(&self, t: f64) -> (Vec2, Vec2) {
        let mut row = self.clone();
        let n = row.len() - 1;
        for count in (2..=n).rev() {
            for i in 0..count {
                row[i] = row[i] + (row[i + 1] - row[i]) * t;
            }
        }
        if n == 0 {
            (row[0], Vec2::ZERO)
        } else {
            (row[0] + (row[1] - row[0]) * t, (row[1] - row[0]) * n as f64)
        }
    }
}

/// A part of a curve whose control points are at most 1 in size.
#[derive(Clone)]
pub(super) struct Part<S> {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) points: S,
    min: Vec2,
    max: Vec2,
    /// How far a control point may be from where it should be.
    pub(super) error: f64,
}

impl<S: Store> Part<S> {
    /// A whole curve, whose points are off by at most 4 u.
    #[inline]
    pub(super) fn whole(points: S) -> Part<S> {
        Part { low: 0.0, high: 1.0, min: Vec2::ZERO, max: Vec2::ZERO, points, error: 4.0 * U }.boxed()
    }

    #[inline]
    fn boxed(mut self) -> Part<S> {
        let points = self.points.as_ref();
        (self.min, self.max) =
            points.iter().fold((points[0], points[0]), |(low, high), &p| (low.min(p), high.max(p)));
        self
    }

    #[inline]
    pub(super) fn width(&self) -> f64 {
        self.high - self.low
    }

    /// The longer side of the box.
    #[inline]
    pub(super) fn size(&self) -> f64 {
        (self.max - self.min).max_element()
    }

    #[inline]
    pub(super) fn contains(&self, t: f64, slack: f64) -> bool {
        self.low - slack <= t && t <= self.high + slack
    }

    /// The part between two parameters of the part's own.
    ///
    /// A blend of points of size 1 is off by at most 3 u, and each of two passes has at most as many blends in a row as
    /// the degree n; the parameters are off by 2 u of a derivative of size 2 n. Together at most 16 n u.
    #[inline]
    pub(super) fn cut(&self, from: f64, to: f64) -> Part<S> {
        let mut part = self.clone();
        let width = self.width();
        (part.low, part.high) =
            (self.low + from * width, if to == 1.0 { self.high } else { self.low + to * width });
        let points = part.points.as_mut();
        let n = points.len() - 1;
        if to < 1.0 {
            for level in 1..=n {
                for i in (level..=n).rev() {
                    points[i] = points[i - 1] + (points[i] - points[i - 1]) * to;
                }
            }
        }
        if from > 0.0 {
            let share = from / to;
            for count in (1..=n).rev() {
                for i in 0..count {
                    points[i] = points[i] + (points[i + 1] - points[i]) * share;
                }
            }
        }
        part.error += 16.0 * n as f64 * U;
        part.boxed()
    }

    /// Two parts that meet in the middle.
    #[inline]
    pub(super) fn halves(&self) -> [Part<S>; 2] {
        let (mut left, mut right) = (self.clone(), self.clone());
        let middle = 0.5 * (self.low + self.high);
        (left.high, right.low) = (middle, middle);
        let (below, above) = (left.points.as_mut(), right.points.as_mut());
        let n = below.len() - 1;
        for count in (1..=n).rev() {
            for i in 0..count {
                above[i] = (above[i] + above[i + 1]) * 0.5;
            }
            below[n + 1 - count] = above[0];
        }
        let error = self.error + n as f64 * U;
        [left, right].map(|part| Part { error, ..part.boxed() })
    }

    /// Whether the boxes are farther apart than `gap`.
    #[inline]
    pub(super) fn box_misses(&self, other: &Part<S>, gap: f64) -> bool {
        let reach = Vec2::splat(gap + self.error + other.error);
        self.min.cmpgt(other.max + reach).any() || other.min.cmpgt(self.max + reach).any()
    }

    /// The parameters of this part's own between which it may come nearer than `gap` to the other one, by the strip
    /// along that one's chord (Sederberg, Nishita, Curve intersection using Bézier clipping, 1990); `None` if nowhere.
    #[inline]
    pub(super) fn clipped(&self, other: &Part<S>, gap: f64) -> Option<(f64, f64)> {
        let strip = other.points.as_ref();
        let origin = strip[0];
        let chord = strip[strip.len() - 1] - origin;
        let length = chord.x.abs() + chord.y.abs();
        if length == 0.0 {
            return Some((0.0, 1.0));
        }
        // Heights are off by the errors of two points and 4 roundings, times the length.
        let margin = length * (gap + 2.0 * self.error.max(other.error) + 8.0 * U);
        let height = |p: Vec2| chord.perp_dot(p - origin);
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for &p in &strip[1..strip.len() - 1] {
            let h = height(p);
            (low, high) = (low.min(h), high.max(h));
        }
        (low, high) = (low - margin, high + margin);
        let points = self.points.as_ref();
        let mut heights = Buffer::of(points.len());
        let heights = heights.slice();
        for (place, &p) in heights.iter_mut().zip(points) {
            *place = height(p);
        }
        hull_within(heights, low, high)
    }

    /// Whether no direction of this part is one of the other, up to sign: then they meet at most once.
    #[inline]
    pub(super) fn turns_apart(&self, other: &Part<S>) -> bool {
        let (p, q) = (self.points.as_ref(), other.points.as_ref());
        let longest = |part: &Part<S>| {
            let side = part.max - part.min;
            side.x + side.y
        };
        // Steps are off by two errors each, their cross product by that times the steps.
        let margin = 4.0 * (self.error + other.error + U) * (longest(self) + longest(other));
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for a in p.windows(2) {
            let a = a[1] - a[0];
            for b in q.windows(2) {
                let cross = a.perp_dot(b[1] - b[0]);
                (least, most) = (least.min(cross), most.max(cross));
            }
        }
        least > margin || most < -margin
    }

    /// Whether all steps go less than a right angle from the first to the last point: such a part does not meet itself.
    pub(super) fn advances(&self) -> bool {
        let points = self.points.as_ref();
        let chord = points[points.len() - 1] - points[0];
        let margin = 4.0 * self.error * (chord.x.abs() + chord.y.abs());
        points.windows(2).all(|pair| (pair[1] - pair[0]).dot(chord) > margin)
    }
}

/// Numbers on the stack if they are few.
enum Buffer {
    Few([f64; 8], usize),
    Many(Vec<f64>),
}

impl Buffer {
    #[inline]
    fn of(count: usize) -> Buffer {
        if count <= 8 { Buffer::Few([0.0; 8], count) } else { Buffer::Many(vec![0.0; count]) }
    }

    #[inline]
    fn slice(&mut self) -> &mut [f64] {
        match self {
            Buffer::Few(values, count) => &mut values[..*count],
            Buffer::Many(values) => values,
        }
    }
}

/// The parameters between which the hull of a polynomial's control points reaches into [low, high].
#[inline]
fn hull_within(heights: &[f64], low: f64, high: f64) -> Option<(f64, f64)> {
    let n = heights.len() - 1;
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (i, &h) in heights.iter().enumerate() {
        if h >= low && h <= high {
            (least, most) = (least.min(i as f64), most.max(i as f64));
        }
    }
    if least == 0.0 && most == n as f64 {
        return Some((0.0, 1.0));
    }
    if heights.iter().all(|&h| h < low) || heights.iter().all(|&h| h > high) {
        return None;
    }
    for (i, &a) in heights.iter().enumerate() {
        for (j, &b) in heights.iter().enumerate().skip(i + 1) {
            for edge in [low, high] {
                if (a < edge) != (b < edge) {
                    let at = i as f64 + (j - i) as f64 * ((edge - a) / (b - a));
                    (least, most) = (least.min(at), most.max(at));
                }
            }
        }
    }
    if least > most {
        return None;
    }
    // Outward by the roundings of the quotient.
    let scale = 1.0 / n as f64;
    Some(((least * scale - 8.0 * U).max(0.0), (most * scale + 8.0 * U).min(1.0)))
}
