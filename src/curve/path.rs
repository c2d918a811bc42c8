//! Paths of the plane: what pens and SVG files draw.

use super::{Arc, Bernstein, Bounded, Bounds, Cubic, Curve, CurveError, Jet, Line, Quadratic};
use super::{bounding_box, check_tolerance, length};
use crate::math::{Affine2, Blend, Vec2};
use crate::numeric::double_double::DoubleDouble;

/// Any number of subpaths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// In the order in which they are drawn.
    pub subpaths: Vec<Subpath>,
}

/// Pieces drawn without lifting the pen: each starts exactly where the one before it ends.
///
/// A closed one ends exactly where it starts; the line that closes it is a piece like others.
#[derive(Clone, Debug, PartialEq)]
pub struct Subpath {
    start: Vec2,
    pieces: Vec<Piece>,
    closed: bool,
}

/// What a path is made of. All points are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// A straight line.
    Line(Line<Vec2>),
    /// A Bézier curve of degree 2.
    Quadratic(Quadratic<Vec2>),
    /// A Bézier curve of degree 3.
    Cubic(Cubic<Vec2>),
    /// An arc of an ellipse, kept as it is: a conversion to cubics would not be exact.
    Arc(Arc),
}

impl From<Line<Vec2>> for Piece {
    fn from(line: Line<Vec2>) -> Piece {
        Piece::Line(line)
    }
}

impl From<Quadratic<Vec2>> for Piece {
    fn from(curve: Quadratic<Vec2>) -> Piece {
        Piece::Quadratic(curve)
    }
}

impl From<Cubic<Vec2>> for Piece {
    fn from(curve: Cubic<Vec2>) -> Piece {
        Piece::Cubic(curve)
    }
}

impl From<Arc> for Piece {
    fn from(arc: Arc) -> Piece {
        Piece::Arc(arc)
    }
}

impl Piece {
    /// The straight piece between two points.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`].
    pub fn line(from: Vec2, to: Vec2) -> Result<Piece, CurveError> {
        Ok(Piece::Line(Line::new([from, to])?))
    }

    /// Its first point.
    pub fn start(&self) -> Vec2 {
        match self {
            Piece::Line(curve) => curve.start(),
            Piece::Quadratic(curve) => curve.start(),
            Piece::Cubic(curve) => curve.start(),
            Piece::Arc(arc) => arc.start(),
        }
    }

    /// Its last point.
    pub fn end(&self) -> Vec2 {
        match self {
            Piece::Line(curve) => curve.end(),
            Piece::Quadratic(curve) => curve.end(),
            Piece::Cubic(curve) => curve.end(),
            Piece::Arc(arc) => arc.end(),
        }
    }

    /// The point at a parameter of [0, 1], exact at both ends.
    pub fn eval(&self, t: f64) -> Vec2 {
        match self {
            Piece::Line(curve) => curve.eval(t),
            Piece::Quadratic(curve) => curve.eval(t),
            Piece::Cubic(curve) => curve.eval(t),
            Piece::Arc(arc) => arc.eval(t),
        }
    }

    /// The same piece run backward.
    pub fn reversed(&self) -> Piece {
        match self {
            Piece::Line(curve) => Piece::Line(curve.reversed()),
            Piece::Quadratic(curve) => Piece::Quadratic(curve.reversed()),
            Piece::Cubic(curve) => Piece::Cubic(curve.reversed()),
            Piece::Arc(arc) => Piece::Arc(arc.reversed()),
        }
    }

    /// The image under an affine map; its ends are the images of the ends.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when the image exceeds the range of `f64`.
    pub fn map(&self, map: &Affine2) -> Result<Piece, CurveError> {
        let image = |p: Vec2| map.transform_point2(p);
        Ok(match self {
            Piece::Line(curve) => Piece::Line(curve.map(image)?),
            Piece::Quadratic(curve) => Piece::Quadratic(curve.map(image)?),
            Piece::Cubic(curve) => Piece::Cubic(curve.map(image)?),
            Piece::Arc(arc) => Piece::Arc(arc.map(map)?),
        })
    }

    /// Its length, as [`length`]; arcs are measured to rounding whatever the accuracy.
    ///
    /// # Errors
    /// As [`length`].
    pub fn length(&self, accuracy: f64) -> Result<Bounded<f64>, CurveError> {
        check_tolerance(accuracy)?;
        // Seen from its start: differences are exact to their own last digit, whatever the origin.
        let near = Affine2::from_translation(-self.start());
        match self.map(&near).unwrap_or(*self) {
            Piece::Line(line) => straight(line.end()),
            Piece::Quadratic(curve) => length(&curve, accuracy),
            Piece::Cubic(curve) => length(&curve, accuracy),
            Piece::Arc(arc) => arc.length(),
        }
    }

    /// The smallest box around it, rounded outward.
    pub fn bounding_box(&self) -> Bounds<Vec2> {
        match self {
            Piece::Line(curve) => bounding_box(curve),
            Piece::Quadratic(curve) => bounding_box(curve),
            Piece::Cubic(curve) => bounding_box(curve),
            Piece::Arc(arc) => arc.bounding_box(),
        }
    }

    /// The piece as cubics that follow it to within the tolerance. Lines and Bézier curves are one cubic that is the
    /// same curve but for rounding; arcs are [`Arc::cubics`].
    ///
    /// # Errors
    /// [`CurveError::Tolerance`] and [`CurveError::ToleranceTooFine`] for arcs.
    pub fn cubics(&self, tolerance: f64) -> Result<Vec<Cubic<Vec2>>, CurveError> {
        check_tolerance(tolerance)?;
        match self {
            Piece::Line(curve) => Ok(vec![curve.elevated()]),
            Piece::Quadratic(curve) => Ok(vec![curve.elevated()]),
            Piece::Cubic(curve) => Ok(vec![*curve]),
            Piece::Arc(arc) => arc.cubics(tolerance),
        }
    }

    /// Twice the integral of (x dy - y dx) / 2 along the piece, seen from `origin`: exact but for rounding at twice
    /// the precision of `f64`, for arcs at that of `f64`.
    fn twice_area(&self, origin: Vec2) -> DoubleDouble {
        match self {
            Piece::Line(curve) => across(curve.start(), curve.end(), origin),
            Piece::Quadratic(curve) => {
                let [a, b, c] = curve.to_array();
                let sum = (across(a, b, origin) + across(b, c, origin)) * 2.0 + across(a, c, origin);
                sum / DoubleDouble::from(3.0)
            }
            Piece::Cubic(curve) => {
                let [a, b, c, d] = curve.to_array();
                let outer = (across(a, b, origin) + across(c, d, origin)) * 2.0;
                let inner = across(a, c, origin) + across(b, c, origin) + across(b, d, origin);
                (outer * 3.0 + inner * 3.0 + across(a, d, origin)) / DoubleDouble::from(10.0)
            }
            Piece::Arc(arc) => across(arc.start(), arc.end(), origin) + arc.twice_segment_area(),
        }
    }
}

/// The length of a vector.
fn straight(line: Vec2) -> Result<Bounded<f64>, CurveError> {
    let value = line.norm();
    let finite = value.is_finite().then_some(Bounded { value, error: 4.0 * f64::EPSILON * value });
    finite.ok_or(CurveError::NotFinite { index: 0 })
}

/// The cross product of two points seen from `origin`.
fn across(a: Vec2, b: Vec2, origin: Vec2) -> DoubleDouble {
    let [ax, ay] = [DoubleDouble::difference(a.x, origin.x), DoubleDouble::difference(a.y, origin.y)];
    let [bx, by] = [DoubleDouble::difference(b.x, origin.x), DoubleDouble::difference(b.y, origin.y)];
    ax * by - ay * bx
}

impl Curve for Piece {
    type Point = Vec2;

    fn domain(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn jet(&self, t: f64) -> Jet<Vec2> {
        match self {
            Piece::Line(curve) => curve.jet(t),
            Piece::Quadratic(curve) => curve.jet(t),
            Piece::Cubic(curve) => curve.jet(t),
            Piece::Arc(arc) => arc.jet(t),
        }
    }
}

impl Subpath {
    /// An open subpath of at least one piece.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] for no piece, [`CurveError::Gap`] for the first piece that does not start where
    /// the one before it ends.
    pub fn open(pieces: Vec<Piece>) -> Result<Subpath, CurveError> {
        let Some(first) = pieces.first() else {
            return Err(CurveError::TooFewPoints { actual: 0, least: 1 });
        };
        let gap = pieces.windows(2).position(|pair| pair[0].end() != pair[1].start());
        if let Some(before) = gap {
            return Err(CurveError::Gap { piece: before + 1 });
        }
        Ok(Subpath { start: first.start(), pieces, closed: false })
    }

    /// A closed subpath: as [`Subpath::open`], with a line back to the start unless the pieces end there.
    ///
    /// # Errors
    /// As [`Subpath::open`].
    pub fn closed(pieces: Vec<Piece>) -> Result<Subpath, CurveError> {
        Ok(Subpath::open(pieces)?.into_closed())
    }

    /// The same, closed.
    pub fn into_closed(mut self) -> Subpath {
        if self.end() != self.start {
            self.pieces.push(Piece::Line(Line::assume([self.end(), self.start])));
        }
        self.closed = true;
        self
    }

    /// The straight lines from point to point, closed or not.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] below two points, [`CurveError::NotFinite`].
    pub fn polyline(points: &[Vec2], closed: bool) -> Result<Subpath, CurveError> {
        super::check_finite(points)?;
        if points.len() < 2 {
            return Err(CurveError::TooFewPoints { actual: points.len(), least: 2 });
        }
        let lines = points.windows(2).map(|pair| Piece::Line(Line::assume([pair[0], pair[1]])));
        let open = Subpath::open(lines.collect())?;
        Ok(if closed { open.into_closed() } else { open })
    }

    /// The first point.
    pub fn start(&self) -> Vec2 {
        self.start
    }

    /// The last point.
    pub fn end(&self) -> Vec2 {
        self.pieces.last().map_or(self.start, Piece::end)
    }

    /// The pieces in order, at least one.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Whether it ends where it starts on purpose.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The same subpath run backward.
    pub fn reversed(&self) -> Subpath {
        let pieces = self.pieces.iter().rev().map(Piece::reversed).collect();
        Subpath { start: self.end(), pieces, closed: self.closed }
    }

    /// See [`Path::area`].
    pub fn area(&self) -> f64 {
        self.twice_area().to_f64() * 0.5
    }

    /// From its own start, so that a far origin costs nothing and the chord that closes an open one adds nothing.
    fn twice_area(&self) -> DoubleDouble {
        self.pieces.iter().fold(DoubleDouble::ZERO, |sum, piece| sum + piece.twice_area(self.start))
    }

    /// The smallest box around it, rounded outward.
    pub fn bounding_box(&self) -> Bounds<Vec2> {
        let start = Bounds { min: self.start, max: self.start };
        self.pieces.iter().fold(start, |all, piece| around(all, piece.bounding_box()))
    }

    /// The image under an affine map.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when the image exceeds the range of `f64`.
    pub fn map(&self, map: &Affine2) -> Result<Subpath, CurveError> {
        let pieces: Vec<Piece> = self.pieces.iter().map(|piece| piece.map(map)).collect::<Result<_, _>>()?;
        Ok(Subpath { start: pieces.first().map_or(self.start, Piece::start), pieces, closed: self.closed })
    }

    /// The subpath as cubics: see [`Piece::cubics`].
    ///
    /// # Errors
    /// As [`Piece::cubics`].
    pub fn cubics(&self, tolerance: f64) -> Result<Vec<Cubic<Vec2>>, CurveError> {
        let each: Vec<_> =
            self.pieces.iter().map(|piece| piece.cubics(tolerance)).collect::<Result<_, _>>()?;
        Ok(each.into_iter().flatten().collect())
    }
}

impl Path {
    /// All pieces in order.
    pub fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.subpaths.iter().flat_map(|subpath| &subpath.pieces)
    }

    /// Whether there is a subpath and all of them are closed.
    pub fn is_closed(&self) -> bool {
        !self.subpaths.is_empty() && self.subpaths.iter().all(Subpath::is_closed)
    }

    /// The length of all that is drawn. The error is at most `accuracy`, or what rounding allows where that is
    /// coarser.
    ///
    /// # Errors
    /// [`CurveError::Tolerance`] when `accuracy` is not a positive number, [`CurveError::NotFinite`] when the length
    /// exceeds the range of `f64`.
    pub fn length(&self, accuracy: f64) -> Result<Bounded<f64>, CurveError> {
        check_tolerance(accuracy)?;
        let share = (accuracy / self.pieces().count().max(1) as f64).max(f64::MIN_POSITIVE);
        let (mut sum, mut error) = (DoubleDouble::ZERO, 0.0);
        for piece in self.pieces() {
            let part = piece.length(share)?;
            sum = sum + DoubleDouble::from(part.value);
            error += part.error;
        }
        let value = sum.to_f64();
        if !value.is_finite() {
            return Err(CurveError::NotFinite { index: 0 });
        }
        Ok(Bounded { value, error: (error + f64::EPSILON * value).next_up() })
    }

    /// The area that the subpaths go around, each part counted as often as they turn around it from x towards y
    /// (counter-clockwise where y points up, clockwise on a page where it points down), negative for the other way.
    /// An open subpath counts as if a line closed it.
    ///
    /// For lines and Bézier curves the last digit is right whatever cancels; an arc adds the rounding of its own
    /// sector. Beyond the range of `f64` the result is not finite.
    pub fn area(&self) -> f64 {
        let twice = self.subpaths.iter().fold(DoubleDouble::ZERO, |sum, part| sum + part.twice_area());
        twice.to_f64() * 0.5
    }

    /// The smallest box around what is drawn, rounded outward; `None` for an empty path.
    pub fn bounding_box(&self) -> Option<Bounds<Vec2>> {
        self.subpaths.iter().map(Subpath::bounding_box).reduce(around)
    }

    /// The image under an affine map.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] when the image exceeds the range of `f64`.
    pub fn map(&self, map: &Affine2) -> Result<Path, CurveError> {
        Ok(Path { subpaths: self.subpaths.iter().map(|subpath| subpath.map(map)).collect::<Result<_, _>>()? })
    }
}

/// The smallest box around two.
fn around(a: Bounds<Vec2>, b: Bounds<Vec2>) -> Bounds<Vec2> {
    Bounds { min: a.min.min(b.min), max: a.max.max(b.max) }
}
