//! Subpaths taken apart into cubics that do not stand still on the way.

use super::fit::SHARE;
use super::frame::UnitFrame;
use super::subdivide::restrict;
use super::{Arc, Cubic, Curve, CurveError, Piece, Subpath, tangents};
use crate::math::{Vec2, atan2, hypot, pow};

/// A subpath in a frame, as cubics with a direction everywhere.
pub(super) struct Strand {
    /// In order; none when the subpath is a point.
    pub(super) elements: Vec<Element>,
    pub(super) closed: bool,
    /// Where it starts.
    pub(super) start: Vec2,
    /// The direction there of one without elements.
    pub(super) heading: Vec2,
}

/// A cubic of some length that stands still at most at its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    pub(super) points: [Vec2; 4],
    /// Unit tangents at the ends.
    pub(super) tangents: [Vec2; 2],
    /// How far it may be from the piece of the path it stands for.
    pub(super) error: f64,
    /// Whether it starts where the piece itself turns back, and not at a joint of the path.
    pub(super) after_cusp: bool,
    /// The ends in model units where they are joints of the path.
    pub(super) outer: [Option<Vec2>; 2],
}

impl Strand {
    /// The subpath with its arcs as cubics whose parallels up to `distance` are within `tolerance` of those of the
    /// arcs, both in model units.
    pub(super) fn new(
        subpath: &Subpath,
        frame: &UnitFrame,
        tolerance: f64,
        distance: f64,
    ) -> Result<Strand, CurveError> {
        let (start, closed) = (frame.inward(subpath.start()), subpath.is_closed());
        let mut strand = Strand { elements: Vec::new(), closed, start, heading: Vec2::X };
        for piece in subpath.pieces() {
            let (cubics, error) = match piece {
                Piece::Arc(arc) => (arc_cubics(arc, tolerance, distance)?, frame.length_inward(tolerance)),
                _ => (piece.cubics(tolerance)?, 0.0),
            };
            for cubic in cubics {
                strand.add(&cubic, frame, error);
            }
        }
        Ok(strand)
    }

    /// Adds a cubic, cut where it stands still.
    fn add(&mut self, cubic: &Cubic<Vec2>, frame: &UnitFrame, error: f64) {
        let outer = cubic.to_array();
        let points = outer.map(|p| frame.inward(p));
        let inner = Cubic::assume(points);
        let mut from = 0.0;
        let cusps: Vec<f64> = inner.cusps().iter().copied().filter(|&t| t > 0.0 && t < 1.0).collect();
        for to in cusps.into_iter().chain([1.0]) {
            let mut part = points;
            restrict(&mut part, from, to);
            if from > 0.0 {
                part[1] = part[0];
            }
            if to < 1.0 {
                part[2] = part[3];
            }
            let outer = [(from == 0.0).then_some(outer[0]), (to == 1.0).then_some(outer[3])];
            self.elements.extend(Element::new(part, error, from > 0.0, outer));
            from = to;
        }
    }

    /// The same strand run backward.
    pub(super) fn reversed(&self) -> Strand {
        let mut elements: Vec<Element> = self.elements.iter().rev().map(Element::reversed).collect();
        // What was after an element comes before it now.
        let count = elements.len();
        for (index, element) in self.elements.iter().enumerate() {
            elements[(count - index) % count].after_cusp = element.after_cusp;
        }
        let start = self.elements.last().map_or(self.start, |last| last.points[3]);
        Strand { elements, closed: self.closed, start, heading: self.heading }
    }

    /// Pairs of neighbouring elements, the last and the first too when the strand is closed.
    pub(super) fn joints(&self) -> impl Iterator<Item = (&Element, &Element)> {
        let count = self.elements.len();
        let joints = if self.closed { count } else { count.saturating_sub(1) };
        (0..joints).map(move |index| (&self.elements[index], &self.elements[(index + 1) % count]))
    }
}

/// Cubics for an arc whose parallels are to be within a tolerance: half of it for the points, a quarter for the
/// directions, and another for the rounding of those.
///
/// On the unit circle a cubic over the angle w is off by at most e = 2/27 s^6 / c^2, s and c the sine and cosine of
/// w/4; the square of its radius is 1 + 216 e t^2 (1-t)^2 (1-2t)^2, so that its direction is off by at most
/// 8.4 e / w < 1.4 e^(5/6). The arc is the image under a map that stretches by a and b; points are off by at most
/// a times, directions by at most a/b times as much. An arc without width has its directions from rounding alone, and
/// so have its cubics: they are straight.
fn arc_cubics(arc: &Arc, tolerance: f64, distance: f64) -> Result<Vec<Cubic<Vec2>>, CurveError> {
    let ([long, short], _) = arc.half_axes();
    let [a, b] = [long, short].map(|axis| hypot(axis.x, axis.y));
    if b == 0.0 || distance == 0.0 {
        return arc.cubics(0.5 * tolerance);
    }
    let lever = distance.abs() * (a / b);
    let direction = pow(0.25 * tolerance / lever / 1.4, 1.2);
    let count = arc.count((0.5 * tolerance / a).min(direction));
    let arm = a * arc.sweep().abs() / (3.0 * count as f64);
    let rounding = (arc.finest() + 4.0 * lever * (arc.finest() / arm)).max(2.0 * arc.finest());
    if rounding > tolerance {
        return Err(CurveError::ToleranceTooFine { value: tolerance / SHARE, finest: rounding / SHARE });
    }
    arc.in_parts(count)
}

impl Element {
    /// The part between two parameters; `None` when it is a point.
    pub(super) fn part(&self, from: f64, to: f64) -> Option<Element> {
        let mut points = self.points;
        restrict(&mut points, from, to);
        Element::new(points, self.error, self.after_cusp && from == 0.0, [None; 2])
    }

    /// Point and unit tangent at a parameter.
    pub(super) fn ray(&self, t: f64) -> (Vec2, Vec2) {
        let jet = Cubic::assume(self.points).jet(t);
        let end = self.tangents[usize::from(t > 0.5)];
        (jet.point, if t > 0.0 && t < 1.0 { jet.first.try_normalize().unwrap_or(end) } else { end })
    }

    /// The element with these points; `None` when they are all equal.
    fn new(points: [Vec2; 4], error: f64, after_cusp: bool, outer: [Option<Vec2>; 2]) -> Option<Element> {
        let cubic = Cubic::assume(points);
        let start = tangents(&cubic, 0.0).ok()?.leaving?;
        let end = tangents(&cubic, 1.0).ok()?.arriving?;
        Some(Element { points, tangents: [start, end], error, after_cusp, outer })
    }

    fn reversed(&self) -> Element {
        let ([a, b, c, d], [start, end], [first, last]) = (self.points, self.tangents, self.outer);
        Element { points: [d, c, b, a], tangents: [-end, -start], outer: [last, first], ..*self }
    }
}

/// The angle between two unit vectors, in radians.
pub(super) fn angle_between(a: Vec2, b: Vec2) -> f64 {
    atan2(a.perp_dot(b).abs(), a.dot(b))
}
