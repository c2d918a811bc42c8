//! SVG: drawings read, path data read and written.
//!
//! Of a drawing the geometry is read: `path` and the basic shapes `rect`, `circle`, `ellipse`, `line`, `polyline` and
//! `polygon`, in the order in which they are drawn, under the transforms of everything around them. Arcs stay arcs of
//! ellipses. `g`, `a`, `switch` (all of it) and nested `svg` are entered, `use` is followed to what it names; what is
//! only kept for later use (`defs`, `symbol`, `clipPath`, `mask`, `marker`, `pattern`) and what has `display: none` is
//! not drawn and not read. Text and images are counted and passed over. Of styles only `display` in a `style` attribute is
//! obeyed; other declarations there and in style sheets that would change the geometry are counted, in
//! [`Drawing::disobeyed`]. Animations are not obeyed.
//!
//! Coordinates are user units of the outermost `svg`, with y down, as its view box has them. Lengths with units become
//! user units at 96 to the inch, percentages refer to the view box; [`Drawing::millimetres`] says how long a unit is.
//!
//! Browsers draw path data up to its first error. Here every error is an error, with its place: a shape that is cut off
//! somewhere is not what anybody meant.
//!
//! ```
//! let drawing = ogee::io::svg::read(br#"<svg xmlns="http://www.w3.org/2000/svg"><circle r="5"/></svg>"#)?;
//! let length = drawing.shapes[0].path.length(1e-9).map_err(|error| error.to_string()).unwrap();
//! assert!((length.value - 10.0 * std::f64::consts::PI).abs() <= length.error);
//! # Ok::<(), ogee::io::ReadError>(())
//! ```

mod data;
mod scan;
mod shapes;
mod styles;
mod tree;
mod values;
mod write;

pub use write::{Sheet, path_data};

use super::{Place, Problem, ReadError};
use crate::curve::Path;
use crate::math::Vec2;
use scan::Fault;

/// What an SVG file draws.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// The shapes in order.
    pub shapes: Vec<Shape>,
    /// Corner and size of the outermost view box, in user units; without one the corner is the origin, and the size
    /// that of the drawing, where it is given.
    pub view: Option<[Vec2; 2]>,
    /// Width and height of the drawing in user units at 96 to the inch, where the file gives them without percentages.
    pub size: [Option<f64>; 2],
    /// Names of elements that hold text or pictures, which are passed over, and how many there are of each.
    pub ignored: Vec<(String, usize)>,
    /// Properties that styles set and that would change the geometry, such as `transform` and `d`, but are not obeyed,
    /// and how many declarations of each there are. Those of style sheets count whatever they apply to.
    pub disobeyed: Vec<(String, usize)>,
}

/// A shape of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The name of its element, such as `circle`.
    pub element: String,
    /// The line of the file on which the element starts.
    pub line: usize,
    /// The element's `id`.
    pub id: Option<String>,
    /// What it draws; empty for a shape without size.
    pub path: Path,
}

impl Drawing {
    /// Millimetres of a user unit along x and y: from width, height and view box where the file has them, else a 96th
    /// of an inch.
    pub fn millimetres(&self) -> Vec2 {
        let unit = 25.4 / 96.0;
        let stretch = |axis: usize| match (self.size[axis], self.view) {
            (Some(size), Some([_, view])) if view[axis] > 0.0 => size / view[axis],
            _ => 1.0,
        };
        Vec2::new(stretch(0), stretch(1)) * unit
    }
}

/// The most pieces that a drawing is read with, copies by `use` included.
pub const MOST_PIECES: usize = 4_000_000;
/// The most elements that a drawing is read with, copies by `use` included.
pub const MOST_ELEMENTS: usize = 1_000_000;

/// Reads a drawing.
///
/// # Errors
/// Where the text stops being XML or SVG, and why; [`Problem::TooMany`] beyond [`MOST_PIECES`], [`MOST_ELEMENTS`] or 32
/// levels of `use`, so that time and memory are bounded whatever a small file asks for.
pub fn read(bytes: &[u8]) -> Result<Drawing, ReadError> {
    let start = Place::Character { line: 1, column: 1 };
    let unsupported = |what| ReadError { at: start, problem: Problem::Unsupported { what } };
    match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => return Err(unsupported("a text in UTF-16")),
        [0x1f, 0x8b, ..] => return Err(unsupported("a compressed drawing (.svgz)")),
        _ => {}
    }
    let text = std::str::from_utf8(bytes).map_err(|_| unsupported("a text that is not UTF-8"))?;
    tree::read(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// Reads path data, the attribute `d` of a `path`: every form of the grammar of SVG 2. Empty data and `none` are an
/// empty path; an arc with a radius of zero is a line, and one between equal points nothing.
///
/// # Errors
/// [`Problem::Expected`] with the line and character where the data breaks the grammar, or where coordinates leave the
/// range of numbers.
///
/// ```
/// let path = ogee::io::svg::read_path("M0 0a1 1 0 112 0zm9.5.5h1")?;
/// assert_eq!(path.subpaths.len(), 2);
/// # Ok::<(), ogee::io::ReadError>(())
/// ```
pub fn read_path(data: &str) -> Result<Path, ReadError> {
    data::path(data).map_err(|fault| {
        let before = &data[..floor(data, fault.at)];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        ReadError { at: Place::Character { line, column }, problem: problem(&fault, data) }
    })
}

/// What the fault in this value is.
fn problem(fault: &Fault, value: &str) -> Problem {
    let rest = &value[floor(value, fault.at)..];
    // The character at fault, with the rest of its word.
    let length = rest
        .char_indices()
        .find(|&(i, c)| i > 0 && (c.is_whitespace() || c == ','))
        .map_or(rest.len(), |(i, _)| i);
    match rest.is_empty() {
        true => {
            Problem::Malformed { reason: format!("the value ends where {} should follow", fault.expected) }
        }
        false => Problem::expected(fault.expected, &rest.as_bytes()[..length]),
    }
}

/// The start of the character that holds a byte.
fn floor(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or_default()
}
