//! Path data: the attribute `d`.

use super::scan::{Fault, Scanner};
use crate::curve::{Arc, Cubic, CurveError, Path, Piece, Quadratic, Subpath};
use crate::math::Vec2;

/// What stands where a coordinate should.
const COORDINATE: &str = "a number";
const IN_RANGE: &str = "coordinates within the range of numbers";

/// The path that the data draws.
pub(super) fn path(data: &str) -> Result<Path, Fault> {
    let mut scanner = Scanner::new(data);
    let mut pen = Pen::default();
    scanner.skip_spaces();
    if scanner.rest().trim_end() == "none" {
        return Ok(Path::default());
    }
    if !matches!(scanner.peek(), None | Some(b'M' | b'm')) {
        return Err(scanner.fault("a move, M or m"));
    }
    while let Some(command) = scanner.peek() {
        if !b"MLHVCSQTAZmlhvcsqtaz".contains(&command) {
            return Err(scanner.fault("a command, one of MLHVCSQTAZ, large or small"));
        }
        scanner.at += 1;
        scanner.skip_spaces();
        draw(command, &mut scanner, &mut pen)?;
        scanner.skip_spaces();
    }
    pen.lift();
    Ok(Path { subpaths: pen.subpaths })
}

/// A command with all of its repetitions.
fn draw(mut command: u8, scanner: &mut Scanner<'_>, pen: &mut Pen) -> Result<(), Fault> {
    if matches!(command, b'Z' | b'z') {
        pen.close();
        return Ok(());
    }
    loop {
        let start = scanner.at;
        let kind = command.to_ascii_uppercase();
        pen.origin = if command.is_ascii_lowercase() { pen.at } else { Vec2::ZERO };
        let drawn = stroke(kind, scanner, pen)?;
        drawn.map_err(|_| Fault { at: start, expected: IN_RANGE })?;
        let comma = scanner.separator();
        if !scanner.is_number() {
            return if comma { Err(scanner.fault(COORDINATE)) } else { Ok(()) };
        }
        // More coordinates after a move are lines.
        command = match command {
            b'M' => b'L',
            b'm' => b'l',
            other => other,
        };
    }
}

/// One round of a command.
fn stroke(kind: u8, scanner: &mut Scanner<'_>, pen: &mut Pen) -> Result<Result<(), CurveError>, Fault> {
    let at = pen.at;
    Ok(match kind {
        b'M' => {
            let to = point(scanner, pen)?;
            pen.lift();
            (pen.start, pen.at, pen.control) = (to, to, Control::None);
            if to.is_finite() { Ok(()) } else { Err(CurveError::NotFinite { index: 0 }) }
        }
        b'L' => {
            let to = point(scanner, pen)?;
            pen.draw(Piece::line(at, to), Control::None)
        }
        b'H' => {
            let x = last(scanner)? + pen.origin.x;
            pen.draw(Piece::line(at, Vec2::new(x, at.y)), Control::None)
        }
        b'V' => {
            let y = last(scanner)? + pen.origin.y;
            pen.draw(Piece::line(at, Vec2::new(at.x, y)), Control::None)
        }
        b'C' | b'S' => {
            let first = if kind == b'C' { inner(scanner, pen)? } else { pen.mirrored(Control::cubic) };
            let (second, to) = (inner(scanner, pen)?, point(scanner, pen)?);
            pen.draw(Cubic::new([at, first, second, to]), Control::Cubic(second))
        }
        b'Q' | b'T' => {
            let control = if kind == b'Q' { inner(scanner, pen)? } else { pen.mirrored(Control::quadratic) };
            let to = point(scanner, pen)?;
            pen.draw(Quadratic::new([at, control, to]), Control::Quadratic(control))
        }
        _ => {
            let radii = Vec2::new(scanner.listed("a radius")?, scanner.listed("a radius")?);
            let rotation = scanner.listed("an angle")?;
            let (large, ascending) = (scanner.flag()?, scanner.flag()?);
            pen.arc(point(scanner, pen)?, radii, rotation, large, ascending)
        }
    })
}

/// The last coordinate of a round: what follows it is the caller's.
fn last(scanner: &mut Scanner<'_>) -> Result<f64, Fault> {
    scanner.number(COORDINATE)
}

/// A point in the middle of a round.
fn inner(scanner: &mut Scanner<'_>, pen: &Pen) -> Result<Vec2, Fault> {
    Ok(pen.origin + Vec2::new(scanner.listed(COORDINATE)?, scanner.listed(COORDINATE)?))
}

/// The point at the end of a round.
fn point(scanner: &mut Scanner<'_>, pen: &Pen) -> Result<Vec2, Fault> {
    Ok(pen.origin + Vec2::new(scanner.listed(COORDINATE)?, last(scanner)?))
}

/// The control point that a smooth command mirrors.
#[derive(Clone, Copy, Default)]
enum Control {
    #[default]
    None,
    Cubic(Vec2),
    Quadratic(Vec2),
}

impl Control {
    fn cubic(self) -> Option<Vec2> {
        if let Control::Cubic(point) = self { Some(point) } else { None }
    }

    fn quadratic(self) -> Option<Vec2> {
        if let Control::Quadratic(point) = self { Some(point) } else { None }
    }
}

/// What has been drawn.
#[derive(Default)]
struct Pen {
    subpaths: Vec<Subpath>,
    /// Pieces since the last move.
    pieces: Vec<Piece>,
    /// Where the last move went.
    start: Vec2,
    at: Vec2,
    control: Control,
    /// What relative coordinates are added to; zero for absolute ones.
    origin: Vec2,
}

impl Pen {
    fn draw<P: Into<Piece>>(
        &mut self,
        piece: Result<P, CurveError>,
        control: Control,
    ) -> Result<(), CurveError> {
        let piece: Piece = piece?.into();
        self.at = piece.end();
        self.pieces.push(piece);
        self.control = control;
        Ok(())
    }

    fn arc(
        &mut self,
        to: Vec2,
        radii: Vec2,
        rotation: f64,
        large: bool,
        ascending: bool,
    ) -> Result<(), CurveError> {
        let from = self.at;
        match Arc::from_ends(from, to, radii, rotation, large, ascending)? {
            Some(arc) => self.draw(Ok(arc), Control::None),
            None if from != to => self.draw(Piece::line(from, to), Control::None),
            None => {
                self.control = Control::None;
                Ok(())
            }
        }
    }

    /// The last control point, if it is of this kind, seen from the other side of the pen.
    fn mirrored(&self, kind: impl Fn(Control) -> Option<Vec2>) -> Vec2 {
        kind(self.control).map_or(self.at, |control| self.at + (self.at - control))
    }

    /// Ends the subpath.
    fn lift(&mut self) {
        // Pieces are there and follow each other.
        self.subpaths.extend(Subpath::open(std::mem::take(&mut self.pieces)));
    }

    fn close(&mut self) {
        self.subpaths.extend(Subpath::closed(std::mem::take(&mut self.pieces)));
        (self.at, self.control) = (self.start, Control::None);
    }
}
