//! Path data and sheets, written.

use super::super::WriteError;
use super::super::text::Shortest;
use crate::curve::{Arc, Bernstein, Path, Piece, Subpath};
use crate::math::{Vec2, atan2};
use std::io::Write;

/// Path data that draws the path, in few characters.
///
/// Reading it back gives the same numbers: they
/// have the fewest digits that do so, relative coordinates stand only
/// where adding them up gives exactly the point that was meant, and smooth commands only where the mirrored control
/// point is exactly the one. Ends of arcs are exact as well; radii, rotation and so what is between are as exact as
/// `f64` can say them, and a sweep beyond three quarters of a turn is written as two arcs.
pub fn path_data(path: &Path) -> String {
    let mut writer = Writer::default();
    path.subpaths.iter().for_each(|subpath| writer.subpath(subpath));
    writer.out
}

#[derive(Default)]
struct Writer {
    out: String,
    /// The command that the next coordinates would repeat.
    command: char,
    at: Vec2,
    /// The last control point, with the command family that it belongs to.
    control: Option<(char, Vec2)>,
}

impl Writer {
    fn subpath(&mut self, subpath: &Subpath) {
        self.shortest(&[Candidate::new('M', &[], subpath.start())]);
        // What follows a move without a command is a line.
        self.command = if self.command == 'm' { 'l' } else { 'L' };
        let pieces = subpath.pieces();
        let closing = matches!(pieces.last(), Some(Piece::Line(_))) && pieces.len() > 1;
        let drawn = if subpath.is_closed() && closing { &pieces[..pieces.len() - 1] } else { pieces };
        drawn.iter().for_each(|piece| self.piece(piece));
        if subpath.is_closed() {
            self.out.push('z');
            (self.command, self.at, self.control) = ('z', subpath.start(), None);
        }
    }

    fn piece(&mut self, piece: &Piece) {
        match piece {
            Piece::Line(line) => self.line(line.end()),
            Piece::Quadratic(curve) => {
                let [_, control, to] = curve.to_array();
                let mut candidates = vec![Candidate::new('Q', &[control], to)];
                if self.mirrored('Q') == control {
                    candidates.insert(0, Candidate::new('T', &[], to));
                }
                self.shortest(&candidates);
                self.control = Some(('Q', control));
            }
            Piece::Cubic(curve) => {
                let [_, first, second, to] = curve.to_array();
                let mut candidates = vec![Candidate::new('C', &[first, second], to)];
                if self.mirrored('C') == first {
                    candidates.insert(0, Candidate::new('S', &[second], to));
                }
                self.shortest(&candidates);
                self.control = Some(('C', second));
            }
            Piece::Arc(arc) if arc.sweep().abs() > 1.5 * std::f64::consts::PI => {
                let (first, second) = arc.halves();
                self.arc(&first);
                self.arc(&second);
            }
            Piece::Arc(arc) => self.arc(arc),
        }
    }

    fn line(&mut self, to: Vec2) {
        let mut candidates = Vec::new();
        if to.y == self.at.y {
            candidates.push(Candidate {
                letter: 'H',
                front: String::new(),
                points: vec![],
                last: Some((0, to)),
            });
        }
        if to.x == self.at.x {
            candidates.push(Candidate {
                letter: 'V',
                front: String::new(),
                points: vec![],
                last: Some((1, to)),
            });
        }
        candidates.push(Candidate::new('L', &[], to));
        self.shortest(&candidates);
    }

    fn arc(&mut self, arc: &Arc) {
        let ([long, short], _) = arc.half_axes();
        let mut front = String::new();
        let flags =
            [arc.sweep().abs() > std::f64::consts::PI, (arc.sweep() > 0.0) == (long.perp_dot(short) >= 0.0)];
        append(&mut front, long.length());
        append(&mut front, short.length());
        let round = long.length() == short.length();
        append(&mut front, if round { 0.0 } else { atan2(long.y, long.x).to_degrees() });
        front.push(' ');
        front.extend(flags.map(|flag| if flag { '1' } else { '0' }));
        let points = vec![arc.end()];
        self.shortest(&[Candidate { letter: 'A', front, points, last: None }]);
    }

    /// Where the mirrored control point of a smooth command would be.
    fn mirrored(&self, family: char) -> Vec2 {
        match self.control {
            Some((of, control)) if of == family => self.at + (self.at - control),
            _ => self.at,
        }
    }

    /// Writes the shortest of the ways to say the same, the first of equally short ones.
    fn shortest(&mut self, candidates: &[Candidate]) {
        let mut best: Option<(char, String)> = None;
        for candidate in candidates {
            for relative in [false, true] {
                let Some(arguments) = candidate.arguments(relative.then_some(self.at)) else { continue };
                let letter = if relative { candidate.letter.to_ascii_lowercase() } else { candidate.letter };
                let text = self.joined(letter, &arguments);
                if best.as_ref().is_none_or(|(_, best)| text.len() < best.len()) {
                    best = Some((letter, text));
                }
            }
        }
        if let Some((letter, text)) = best {
            self.out += &text;
            (self.command, self.control) = (letter, None);
            self.at = candidates[0].end();
        }
    }

    /// The arguments with their letter, which is left out where it repeats.
    fn joined(&self, letter: char, arguments: &str) -> String {
        let arguments = arguments.trim_start();
        if letter != self.command {
            return format!("{letter}{arguments}");
        }
        let fraction = arguments.starts_with('.') && ends_with_fraction(&self.out);
        let blank = if arguments.starts_with('-') || fraction { "" } else { " " };
        format!("{blank}{arguments}")
    }
}

/// A command with its arguments, one way to draw a piece.
struct Candidate {
    letter: char,
    /// Arguments before the points.
    front: String,
    points: Vec<Vec2>,
    /// For a line along an axis: that axis, and its end.
    last: Option<(usize, Vec2)>,
}

impl Candidate {
    fn new(letter: char, controls: &[Vec2], to: Vec2) -> Candidate {
        let points = controls.iter().copied().chain([to]).collect();
        Candidate { letter, front: String::new(), points, last: None }
    }

    fn end(&self) -> Vec2 {
        self.last.map_or_else(|| self.points.last().copied().unwrap_or_default(), |(_, to)| to)
    }

    /// The arguments, relative to an origin if there is one; `None` where they would not give the same bits.
    fn arguments(&self, origin: Option<Vec2>) -> Option<String> {
        let mut text = self.front.clone();
        let mut number = |value: f64, from: Option<f64>| {
            let shown = value - from.unwrap_or(0.0);
            let same = from.is_none_or(|from| from + shown == value);
            append(&mut text, shown);
            same.then_some(())
        };
        if let Some((axis, to)) = self.last {
            number(to[axis], origin.map(|origin| origin[axis]))?;
        }
        for point in &self.points {
            number(point.x, origin.map(|origin| origin.x))?;
            number(point.y, origin.map(|origin| origin.y))?;
        }
        Some(text)
    }
}

/// Adds a number with as little as separates it from the one before.
fn append(text: &mut String, value: f64) {
    // Adding 0 makes a negative zero positive.
    let plain = Shortest(value + 0.0).to_string();
    // A zero before the point says nothing.
    let plain = match plain.strip_prefix("-0.") {
        Some(fraction) => format!("-.{fraction}"),
        None => plain.strip_prefix("0.").map_or(plain.clone(), |fraction| format!(".{fraction}")),
    };
    let blank = !(plain.starts_with('-') || plain.starts_with('.') && ends_with_fraction(text));
    if blank {
        text.push(' ');
    }
    text.push_str(&plain);
}

/// Whether the last number has a point or an exponent, so that a point starts the next one.
fn ends_with_fraction(text: &str) -> bool {
    let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | '-');
    let last = text.rsplit(|c: char| !number(c)).next().unwrap_or_default();
    let last = last.rfind('-').filter(|&at| !last[..at].ends_with('e')).map_or(last, |at| &last[at..]);
    last.contains('.') || last.contains('e')
}

/// Paths on a page, written as a document.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet<'a> {
    /// Paths, each with its colour as CSS says it, outlined.
    pub paths: Vec<(&'a Path, String)>,
    /// Corner and size of the view box.
    pub view: [Vec2; 2],
    /// Width of lines, in user units.
    pub stroke: f64,
}

impl Sheet<'_> {
    /// Writes the document.
    ///
    /// # Errors
    /// What `out` reports.
    pub fn write(&self, out: &mut dyn Write) -> Result<(), WriteError> {
        let [corner, size] = self.view;
        let mut document = svg::Document::new().set("viewBox", (corner.x, corner.y, size.x, size.y));
        for (path, color) in &self.paths {
            let element = svg::node::element::Path::new()
                .set("fill", "none")
                .set("stroke", color.as_str())
                .set("stroke-width", self.stroke)
                .set("d", path_data(path));
            document = document.add(element);
        }
        Ok(svg::write(out, &document)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Cubic, Quadratic};
    use crate::io::svg::read_path;
    use proptest::prelude::*;

    #[test]
    fn few_characters() {
        for data in [
            "M0 0H10V10H0z",
            "M1 2 3 4 5 6",
            "M0 0C1 2 3 4 5 6S9 8 7 7z",
            "M0 0Q1 2 3 0T6 0",
            "M.5-.5.25.125",
            "M0 0A5 5 0 10 7 7z",
            "M1e-7 1e20V3",
            "M0 0H1zM5 5H9",
        ] {
            assert_eq!(path_data(&read_path(data).unwrap()), data);
        }
        let far = read_path("M1000 1000H5L6 7C1001 1002 1004 1001 1005 1000").unwrap();
        assert_eq!(path_data(&far), "M1000 1000H5L6 7c995 995 998 994 999 993");
    }

    fn number() -> impl Strategy<Value = f64> {
        let edges = [0.0, -0.0, 0.1, 1e-5, 9.9e-6, 1e16, 5e-324, 1e300, -1e300, 1.0 / 3.0, 100.0];
        prop_oneof![prop::sample::select(edges.to_vec()), -1e3..1e3_f64, (-50..50).prop_map(f64::from)]
    }

    fn point() -> impl Strategy<Value = Vec2> {
        (number(), number()).prop_map(Vec2::from)
    }

    fn subpath() -> impl Strategy<Value = Subpath> {
        let round = (0..5, prop::array::uniform3(point()));
        (point(), prop::collection::vec(round, 1..8), any::<bool>()).prop_map(|(start, rounds, closed)| {
            let mut at = start;
            let piece = |(kind, [a, b, c]): (i32, [Vec2; 3])| {
                let from = std::mem::replace(&mut at, c);
                match kind {
                    0 => Piece::line(from, c),
                    1 => {
                        at.y = from.y;
                        Piece::line(from, Vec2::new(c.x, from.y))
                    }
                    2 => Quadratic::new([from, a, c]).map(Piece::from),
                    3 => Cubic::new([from, a, b, c]).map(Piece::from),
                    _ => Cubic::new([from, from, b, c]).map(Piece::from),
                }
                .unwrap()
            };
            let open = Subpath::open(rounds.into_iter().map(piece).collect()).unwrap();
            if closed { open.into_closed() } else { open }
        })
    }

    proptest! {
        #[test]
        fn reading_back_gives_the_same(subpaths in prop::collection::vec(subpath(), 0..4)) {
            let path = Path { subpaths };
            let data = path_data(&path);
            prop_assert_eq!(read_path(&data).unwrap(), path, "{}", data);
        }

        #[test]
        fn arcs_come_back(
            from in (-9.0..9.0_f64, -9.0..9.0_f64), to in (-9.0..9.0_f64, -9.0..9.0_f64),
            radii in (0.5..20.0_f64, 0.5..20.0_f64), turn in -180.0..180.0_f64, large: bool, ascending: bool,
        ) {
            let radii = Vec2::from(radii);
            let Some(arc) = Arc::from_ends(from.into(), to.into(), radii, turn, large, ascending).unwrap() else {
                return Ok(());
            };
            // Where the ellipse just reaches, its middle moves with the root of rounding.
            prop_assume!((arc.sweep().abs() - std::f64::consts::PI).abs() > 1e-3);
            let path = Path { subpaths: vec![Subpath::open(vec![arc.into()]).unwrap()] };
            let back = read_path(&path_data(&path)).unwrap();
            let (first, last) = (back.pieces().next().unwrap(), back.pieces().last().unwrap());
            prop_assert_eq!((first.start(), last.end()), (arc.start(), arc.end()));
            let middle = if back.pieces().count() == 1 { first.eval(0.5) } else { first.end() };
            prop_assert!((middle - arc.eval(0.5)).length() < 1e-9, "{}", path_data(&path));
        }
    }
}
