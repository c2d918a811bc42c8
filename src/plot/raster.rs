//! A scene as pixels.

use super::scene::{Anchor, Item, Scene, Text};
use super::{Color, text};
use crate::curve::{Bernstein, Path, Piece};
use crate::math::Vec2;
use crate::par;
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};
use ttf_parser::OutlineBuilder;

impl Scene {
    /// The pixels row by row from the upper left one: red, green, blue and opacity, sRGB.
    pub fn pixels(&self) -> Vec<Color> {
        // The sizes of scenes are checked, so there is a pixmap.
        let Some(mut pixmap) = Pixmap::new(self.width, self.height) else { return Vec::new() };
        let [r, g, b, a] = self.background;
        pixmap.fill(tiny_skia::Color::from_rgba8(r, g, b, a));
        self.items.iter().for_each(|item| draw(item, &mut pixmap));
        let plain = |pixel: &tiny_skia::PremultipliedColorU8| {
            let color = pixel.demultiply();
            [color.red(), color.green(), color.blue(), color.alpha()]
        };
        par::map_above(1 << 16, pixmap.pixels(), plain)
    }
}

fn draw(item: &Item, pixmap: &mut Pixmap) {
    match item {
        Item::Line { path, width, color, dash } => {
            let dash = dash.and_then(|length| StrokeDash::new(vec![length as f32; 2], 0.0));
            let stroke = Stroke {
                width: *width as f32,
                line_cap: LineCap::Round,
                line_join: LineJoin::Round,
                dash,
                ..Stroke::default()
            };
            if let Some(path) = built(path) {
                pixmap.stroke_path(&path, &paint(*color), &stroke, Transform::identity(), None);
            }
        }
        Item::Fill { path, color } => fill(built(path), FillRule::EvenOdd, *color, pixmap),
        Item::Dots { centers, radius, color } => {
            // Overlapping discs are one area: several of them at once would be holes or darker.
            for center in centers {
                let mut pen = PathBuilder::new();
                pen.push_circle(center.x as f32, center.y as f32, *radius as f32);
                fill(pen.finish(), FillRule::Winding, *color, pixmap);
            }
        }
        Item::Text(text) => fill(letters(text), FillRule::Winding, text.color, pixmap),
    }
}

fn fill(path: Option<tiny_skia::Path>, rule: FillRule, color: Color, pixmap: &mut Pixmap) {
    if let Some(path) = path {
        pixmap.fill_path(&path, &paint(color), rule, Transform::identity(), None);
    }
}

fn paint([r, g, b, a]: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, a);
    paint
}

fn built(path: &Path) -> Option<tiny_skia::Path> {
    let at = |p: Vec2| (p.x as f32, p.y as f32);
    let mut pen = PathBuilder::new();
    for subpath in &path.subpaths {
        let (x, y) = at(subpath.start());
        pen.move_to(x, y);
        for piece in subpath.pieces() {
            let (x, y) = at(piece.end());
            match piece {
                Piece::Line(_) | Piece::Arc(_) => pen.line_to(x, y),
                Piece::Quadratic(curve) => {
                    let (x1, y1) = at(curve.points()[1]);
                    pen.quad_to(x1, y1, x, y);
                }
                Piece::Cubic(curve) => {
                    let ((x1, y1), (x2, y2)) = (at(curve.points()[1]), at(curve.points()[2]));
                    pen.cubic_to(x1, y1, x2, y2, x, y);
                }
            }
        }
        if subpath.is_closed() {
            pen.close();
        }
    }
    pen.finish()
}

fn letters(text: &Text) -> Option<tiny_skia::Path> {
    let width = text::width(&text.content, text.size);
    let start = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * width,
        Anchor::End => -width,
    };
    let mut pen = Pen(PathBuilder::new());
    text::outline(&text.content, text.size, &mut pen);
    let [x, y, start] = [text.at.x, text.at.y, start].map(|k| k as f32);
    let place = match text.upward {
        true => Transform::from_row(0.0, -1.0, -1.0, 0.0, x, y - start),
        // On whole pixels, so that equal letters look equal.
        false => Transform::from_row(1.0, 0.0, 0.0, -1.0, x + start, y.round()),
    };
    pen.0.finish()?.transform(place)
}

struct Pen(PathBuilder);

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}
