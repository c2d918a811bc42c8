//! A scene as SVG.

use super::Color;
use super::scene::{Anchor, Item, Scene, Text};
use crate::curve::{Bernstein, Path, Piece, Subpath};
use crate::io::{WriteError, svg::path_data};
use crate::math::Vec2;
use std::io::Write;
use svg::node::element::{Path as PathElement, Rectangle, Text as TextElement};

impl Scene {
    /// Writes the scene as an SVG document. Curves stay curves; coordinates are rounded to hundredths of a pixel.
    ///
    /// # Errors
    /// What `out` reports.
    pub fn svg(&self, out: &mut dyn Write) -> Result<(), WriteError> {
        let mut document = svg::Document::new()
            .set("width", self.width)
            .set("height", self.height)
            .set("viewBox", (0, 0, self.width, self.height))
            .set("font-family", "DejaVu Sans, Verdana, sans-serif");
        if self.background[3] > 0 {
            document = document
                .add(filled(Rectangle::new(), self.background).set("width", "100%").set("height", "100%"));
        }
        for item in &self.items {
            document = match item {
                Item::Line { path, width, color, dash } => document.add(line(path, *width, *color, *dash)),
                Item::Fill { path, color } => {
                    let element =
                        PathElement::new().set("d", path_data(&rounded(path))).set("fill-rule", "evenodd");
                    document.add(filled(element, *color))
                }
                Item::Dots { centers, radius, color } => document.add(dots(centers, *radius, *color)),
                Item::Text(text) => document.add(label(text)),
            };
        }
        svg::write(&mut *out, &document)?;
        Ok(writeln!(out)?)
    }
}

fn line(path: &Path, width: f64, color: Color, dash: Option<f64>) -> PathElement {
    let element = PathElement::new().set("d", path_data(&rounded(path))).set("fill", "none");
    let element = stroked(element, width, color);
    match dash {
        Some(length) => {
            element.set("stroke-dasharray", format!("{} {}", hundredths(length), hundredths(length)))
        }
        None => element,
    }
}

/// Lines without length: their round caps are discs, in a tenth of the characters.
fn dots(centers: &[Vec2], radius: f64, color: Color) -> PathElement {
    let mut data = String::new();
    for center in centers {
        data += &format!("M{} {}h0", hundredths(center.x), hundredths(center.y));
    }
    stroked(PathElement::new().set("d", data), 2.0 * radius, color)
}

fn label(text: &Text) -> TextElement {
    let [x, y] = [text.at.x, text.at.y].map(hundredths);
    let element = TextElement::new(text.content.as_str()).set("font-size", hundredths(text.size));
    let element = match text.anchor {
        Anchor::Start => element,
        Anchor::Middle => element.set("text-anchor", "middle"),
        Anchor::End => element.set("text-anchor", "end"),
    };
    let element = match text.upward {
        true => element.set("transform", format!("translate({x} {y}) rotate(-90)")),
        false => element.set("x", x).set("y", y),
    };
    filled(element, text.color)
}

fn stroked(element: PathElement, width: f64, color: Color) -> PathElement {
    let element = element.set("stroke", code(color)).set("stroke-width", hundredths(width));
    let element = element.set("stroke-linecap", "round").set("stroke-linejoin", "round");
    if color[3] == u8::MAX { element } else { element.set("stroke-opacity", opacity(color)) }
}

/// Any element with a fill.
fn filled<E: svg::Node>(mut element: E, color: Color) -> E {
    element.assign("fill", code(color));
    if color[3] < u8::MAX {
        element.assign("fill-opacity", opacity(color));
    }
    element
}

fn code([r, g, b, _]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn opacity(color: Color) -> f64 {
    hundredths(f64::from(color[3]) / 255.0)
}

fn hundredths(x: f64) -> f64 {
    (x * 100.0).round() / 100.0 + 0.0
}

/// The path with all points rounded; equal points stay equal, so that nothing opens.
fn rounded(path: &Path) -> Path {
    let round = |p: Vec2| Vec2::new(hundredths(p.x), hundredths(p.y));
    let piece = |piece: &Piece| match piece {
        Piece::Line(line) => line.map(round).map(Piece::Line),
        Piece::Quadratic(curve) => curve.map(round).map(Piece::Quadratic),
        Piece::Cubic(curve) => curve.map(round).map(Piece::Cubic),
        Piece::Arc(arc) => Ok(Piece::Arc(*arc)),
    };
    let subpath = |subpath: &Subpath| {
        let pieces = subpath.pieces().iter().map(piece).collect::<Result<Vec<_>, _>>().ok()?;
        let open = Subpath::open(pieces).ok()?;
        Some(if subpath.is_closed() { open.into_closed() } else { open })
    };
    Path { subpaths: path.subpaths.iter().filter_map(subpath).collect() }
}
