//! From a figure to a scene: ranges, ticks, margins, and then everything in its place.

use super::figure::{Axis, Content, Figure, Layer, Mark, Scale};
use super::legend::{self, Legend};
use super::scene::{Anchor, Item, Scene, Text};
use super::ticks::{Tick, ticks};
use super::{Color, text};
use crate::curve::{Arc, Cubic, Line, Path, Piece, Subpath};
use crate::math::{Affine2, Mat2, Vec2, log10};

/// The share of the data's range that is left free on each side.
const AIR: f64 = 0.04;
/// Distance in pixels that curves may be off where they cannot be drawn as they are.
const TOLERANCE: f64 = 0.05;
/// Opacity of areas.
const FAINT: u8 = 40;

/// Sizes of text and lines, in pixels.
#[derive(Clone, Copy)]
pub(super) struct Measures {
    /// Of an em of labels.
    pub(super) text: f64,
    /// Width of a line of weight 1.
    pub(super) line: f64,
}

impl Measures {
    fn of(width: u32, height: u32) -> Measures {
        let side = f64::from(width.min(height));
        // Below 9 pixels an em cannot be read; lines below one fade.
        Measures { text: (side / 46.0).max(9.0), line: (side / 340.0).max(1.2) }
    }
}

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) min: Vec2,
    pub(super) max: Vec2,
}

impl Area {
    pub(super) fn size(&self) -> Vec2 {
        (self.max - self.min).max(Vec2::ONE)
    }
}

/// Where numbers are in the picture.
pub(super) struct Frame<'a> {
    figure: &'a Figure,
    pub(super) area: Area,
    /// Ranges in the axes' own scales.
    low: Vec2,
    high: Vec2,
}

pub(super) fn scene(figure: &Figure, width: u32, height: u32) -> Scene {
    let measures = Measures::of(width, height);
    let whole = Area { min: Vec2::ZERO, max: Vec2::new(f64::from(width), f64::from(height)) };
    let data = range(figure);
    let mut frame = framed(figure, data, whole, measures, [0.0; 2]);
    let legend = placed(figure, &mut frame, data, whole, measures);
    let mut items = Vec::new();
    let [across, up] = frame.ticks(measures);
    grid(&frame, &across, &up, measures, &mut items);
    labels(&frame, &across, &up, whole, measures, &mut items);
    figure.layers.iter().for_each(|layer| draw(layer, &frame, measures, &mut items));
    if let Some((legend, corner)) = &legend {
        legend.draw(*corner, figure, measures, &mut items);
    }
    Scene { width, height, background: figure.theme.background, items }
}

/// The legend and its upper left corner: in a corner of the frame that no data reach, else beside or below a smaller
/// frame, wherever more of it is left.
fn placed<'a>(
    figure: &'a Figure,
    frame: &mut Frame<'a>,
    data: [Vec2; 2],
    whole: Area,
    measures: Measures,
) -> Option<(Legend, Vec2)> {
    let Vec2 { x: width, y: height } = whole.size();
    let beside = Legend::of(figure, measures, 0.4 * width, 0.8 * height)?;
    if let Some(corner) = legend::free_corner(&beside, &frame.area, &drawn_places(figure, frame, measures)) {
        return Some((beside, corner));
    }
    let below = Legend::of(figure, measures, width, 0.5 * height)?;
    if (width - beside.size().x) * height >= width * (height - below.size().y) {
        *frame = framed(figure, data, whole, measures, [beside.size().x, 0.0]);
        let corner = Vec2::new(width - beside.size().x, frame.area.min.y);
        return Some((beside, corner));
    }
    *frame = framed(figure, data, whole, measures, [0.0, below.size().y]);
    let corner = Vec2::new(0.5 * measures.text, height - below.size().y);
    Some((below, corner))
}

/// The numbers that must be in sight, in the axes' own scales.
fn range(figure: &Figure) -> [Vec2; 2] {
    let boxes = figure.layers.iter().filter_map(Layer::bounds);
    let all = boxes.reduce(|a, b| crate::curve::Bounds { min: a.min.min(b.min), max: a.max.max(b.max) });
    let Some(all) = all else { return [Vec2::ZERO, Vec2::ONE] };
    let place = |p: Vec2| Vec2::new(figure.x.place(p.x), figure.y.place(p.y));
    let (low, high) = (place(all.min), place(all.max));
    let mut size = high - low;
    // A range of nothing is shown as some; equal units take it from the other axis.
    let magnitude = low.abs().max(high.abs());
    for axis in 0..2 {
        if size[axis] <= 1e-12 * magnitude[axis] || size[axis] == 0.0 {
            let other = size[1 - axis];
            let plain = if magnitude[axis] > 0.0 { 0.2 * magnitude[axis] } else { 1.0 };
            size[axis] = if figure.equal && other > 1e-12 * magnitude.max_element() { other } else { plain };
        }
    }
    let middle = 0.5 * low + 0.5 * high;
    let half = 0.5 * size * (1.0 + 2.0 * AIR);
    [middle - half, middle + half]
}

impl Axis {
    /// The place of a number on the axis' own scale.
    fn place(&self, x: f64) -> f64 {
        match self.scale {
            Scale::Linear => x,
            Scale::Log => log10(x),
        }
    }
}

/// The frame with room for what stands around it, and `extra` pixels to the right and below.
fn framed<'a>(
    figure: &'a Figure,
    [low, high]: [Vec2; 2],
    whole: Area,
    measures: Measures,
    extra: [f64; 2],
) -> Frame<'a> {
    let em = measures.text;
    let labelled = |label: &str| if label.is_empty() { 0.0 } else { 1.7 * em };
    let top = if figure.title.is_empty() { 1.0 * em } else { 3.1 * em };
    let bottom = 2.3 * em + labelled(&figure.x.label) + extra[1];
    let (mut left, mut right) = (em, em + extra[0]);
    let mut frame = Frame { figure, area: whole, low, high };
    // Labels need room, and the room decides about labels; margins only grow, so that this ends.
    for _ in 0..8 {
        let min = Vec2::new(left, top);
        let max = (whole.max - Vec2::new(right, bottom)).max(min + 1.0);
        frame = Frame { figure, area: Area { min, max }, low, high };
        if figure.equal {
            frame.equalize();
        }
        let [across, up] = frame.ticks(measures);
        let widest = up.iter().map(|tick| text::width(&tick.label, em)).fold(0.0, f64::max);
        let needed = 1.1 * em + widest + labelled(&figure.y.label);
        let over = |tick: &Tick| {
            let end = frame.across(tick.place) + 0.5 * text::width(&tick.label, em);
            end - (whole.max.x - extra[0])
        };
        let beyond = across.iter().map(over).fold(0.0, f64::max);
        if needed <= left && beyond <= 0.0 {
            break;
        }
        // A smaller frame moves its labels by less than it shrinks: a pixel more ends that soon.
        (left, right) = (left.max(needed), right + if beyond > 0.0 { beyond + 1.0 } else { 0.0 });
    }
    frame
}

impl Frame<'_> {
    /// Widens one of the ranges until a unit is as long on both axes.
    fn equalize(&mut self) {
        let units = (self.high - self.low) / self.area.size();
        let size = self.area.size() * units.max_element();
        let middle = 0.5 * self.low + 0.5 * self.high;
        (self.low, self.high) = (middle - 0.5 * size, middle + 0.5 * size);
    }

    /// The map from the axes' own scales to pixels.
    fn map(&self) -> Affine2 {
        let scale = self.area.size() / (self.high - self.low);
        let right = !self.figure.x.reversed;
        let down = self.figure.y.reversed;
        let scale = Vec2::new(if right { scale.x } else { -scale.x }, if down { scale.y } else { -scale.y });
        let from = Vec2::new(
            if right { self.low.x } else { self.high.x },
            if down { self.low.y } else { self.high.y },
        );
        Affine2 { matrix2: Mat2::from_diagonal(scale), translation: self.area.min - from * scale }
    }

    fn across(&self, place: f64) -> f64 {
        self.map().transform_point2(Vec2::new(place, self.low.y)).x
    }

    fn up(&self, place: f64) -> f64 {
        self.map().transform_point2(Vec2::new(self.low.x, place)).y
    }

    fn is_linear(&self) -> bool {
        self.figure.x.scale == Scale::Linear && self.figure.y.scale == Scale::Linear
    }

    pub(super) fn pixel(&self, p: Vec2) -> Vec2 {
        let (x, y) = (self.figure.x.place(p.x), self.figure.y.place(p.y));
        // From the range's own corner, so that a far origin does not shake.
        let map = self.map();
        let low = map.transform_point2(self.low);
        low + map.matrix2 * (Vec2::new(x, y) - self.low)
    }

    /// The path in pixels, without arcs: as it is where axes are linear, else as lines.
    fn path(&self, path: &Path) -> Path {
        let subpath = |subpath: &Subpath| {
            let pieces: Vec<Piece> = match self.is_linear() {
                true => subpath.pieces().iter().flat_map(|piece| self.pieces(piece)).collect(),
                false => {
                    let points: Vec<Vec2> =
                        subpath.pieces().iter().flat_map(|piece| self.points(piece)).collect();
                    let lines = points.windows(2).filter(|pair| pair[0] != pair[1]);
                    lines.filter_map(|pair| Piece::line(pair[0], pair[1]).ok()).collect()
                }
            };
            let open = Subpath::open(pieces).ok()?;
            Some(if subpath.is_closed() { open.into_closed() } else { open })
        };
        Path { subpaths: path.subpaths.iter().filter_map(subpath).collect() }
    }

    fn pieces(&self, piece: &Piece) -> Vec<Piece> {
        let pixels = |points: &[Vec2]| points.iter().map(|&p| self.pixel(p)).collect::<Vec<Vec2>>();
        let cubic = |curve: &Cubic<Vec2>| {
            let [a, b, c, d] = curve.to_array().map(|p| self.pixel(p));
            Cubic::new([a, b, c, d]).map(Piece::Cubic).ok()
        };
        match piece {
            Piece::Line(line) => {
                pixels(&line.to_array()).windows(2).filter_map(|p| Piece::line(p[0], p[1]).ok()).collect()
            }
            Piece::Quadratic(curve) => {
                let image = crate::curve::Quadratic::new(curve.to_array().map(|p| self.pixel(p)));
                image.map(Piece::Quadratic).into_iter().collect()
            }
            Piece::Cubic(curve) => cubic(curve).into_iter().collect(),
            Piece::Arc(arc) => self.cubics(arc).iter().filter_map(cubic).collect(),
        }
    }

    /// The arc as cubics that are not off by more than a pixel's part, or as few as there can be.
    fn cubics(&self, arc: &Arc) -> Vec<Cubic<Vec2>> {
        let unit = (self.high - self.low) / self.area.size();
        let size = arc.axes()[0].length() + arc.axes()[1].length();
        let wished = TOLERANCE * unit.min_element();
        let coarser = [wished, 1e-9 * size, size].into_iter().filter(|tolerance| *tolerance > 0.0);
        let found = coarser.filter_map(|tolerance| arc.cubics(tolerance).ok()).next();
        found.unwrap_or_else(|| {
            Line::new([arc.start(), arc.end()]).map(|line| line.elevated()).into_iter().collect()
        })
    }

    /// Points along a piece, in pixels, close enough that lines between them show the curve on any scale. A line is
    /// drawn straight on every scale.
    fn points(&self, piece: &Piece) -> Vec<Vec2> {
        let ends = [piece.start(), piece.end()].map(|p| self.pixel(p));
        if matches!(piece, Piece::Line(_)) {
            return ends.to_vec();
        }
        let mut points = vec![ends[0]];
        self.halve(piece, [0.0, 1.0], ends, 0, &mut points);
        points
    }

    /// Adds points of a piece until each is a short step from the last and halves stay on their chords.
    fn halve(
        &self,
        piece: &Piece,
        [from, to]: [f64; 2],
        [a, b]: [Vec2; 2],
        depth: u32,
        points: &mut Vec<Vec2>,
    ) {
        let middle = 0.5 * (from + to);
        let between = self.pixel(piece.eval(middle));
        let off = (between - 0.5 * (a + b)).length();
        // A first few halvings see what a single chord would miss; 2^14 points are more than pixels across.
        if depth == 14 || (depth > 4 && off < TOLERANCE) {
            points.push(b);
            return;
        }
        self.halve(piece, [from, middle], [a, between], depth + 1, points);
        self.halve(piece, [middle, to], [between, b], depth + 1, points);
    }

    /// Numbers along the axes, as many as there is room for.
    fn ticks(&self, measures: Measures) -> [Vec<Tick>; 2] {
        let (figure, size, em) = (self.figure, self.area.size(), measures.text);
        let mut most = ((size.x / (3.6 * em)) as usize).clamp(2, 12);
        let mut across = ticks(figure.x.scale, self.low.x, self.high.x, most);
        while most > 1 && !self.fit(&across, em) {
            most -= 1;
            across = ticks(figure.x.scale, self.low.x, self.high.x, most);
        }
        let rows = ((size.y / (2.6 * em)) as usize).clamp(2, 10);
        [across, ticks(figure.y.scale, self.low.y, self.high.y, rows)]
    }

    /// Whether labels side by side leave air between them.
    fn fit(&self, across: &[Tick], em: f64) -> bool {
        let named: Vec<&Tick> = across.iter().filter(|tick| !tick.label.is_empty()).collect();
        named.windows(2).all(|pair| {
            let room = (self.across(pair[1].place) - self.across(pair[0].place)).abs();
            let half = |tick: &Tick| 0.5 * text::width(&tick.label, em);
            half(pair[0]) + half(pair[1]) + 1.2 * em <= room
        })
    }
}

fn segment(from: Vec2, to: Vec2) -> Path {
    Path { subpaths: Subpath::polyline(&[from, to], false).into_iter().collect() }
}

/// Lines at the ticks; those through zero are stronger.
fn grid(frame: &Frame<'_>, across: &[Tick], up: &[Tick], measures: Measures, items: &mut Vec<Item>) {
    let theme = &frame.figure.theme;
    let (area, thin) = (frame.area, (0.45 * measures.line).max(0.75));
    let mut zeros = Vec::new();
    let mut line = |tick: &Tick, scale: Scale, from: Vec2, to: Vec2| {
        let path = segment(from, to);
        if tick.place == 0.0 && scale == Scale::Linear {
            zeros.push(Item::Line { path, width: 1.3 * thin, color: theme.axis, dash: None });
        } else {
            let width = if tick.label.is_empty() { 0.5 * thin } else { thin };
            items.push(Item::Line { path, width, color: theme.grid, dash: None });
        }
    };
    for tick in across {
        let x = frame.across(tick.place);
        line(tick, frame.figure.x.scale, Vec2::new(x, area.min.y), Vec2::new(x, area.max.y));
    }
    for tick in up {
        let y = frame.up(tick.place);
        line(tick, frame.figure.y.scale, Vec2::new(area.min.x, y), Vec2::new(area.max.x, y));
    }
    items.extend(zeros);
}

/// Numbers, names of axes and the title.
fn labels(
    frame: &Frame<'_>,
    across: &[Tick],
    up: &[Tick],
    whole: Area,
    measures: Measures,
    items: &mut Vec<Item>,
) {
    let (figure, area, em) = (frame.figure, frame.area, measures.text);
    let theme = &figure.theme;
    let mut write = |at: Vec2, size: f64, color: Color, anchor: Anchor, upward: bool, content: &str| {
        if !content.is_empty() {
            items.push(Item::Text(Text { at, size, color, anchor, upward, content: content.to_owned() }));
        }
    };
    for tick in across {
        let at = Vec2::new(frame.across(tick.place), area.max.y + 1.45 * em);
        write(at, em, theme.muted, Anchor::Middle, false, &tick.label);
    }
    for tick in up {
        let at = Vec2::new(area.min.x - 0.5 * em, frame.up(tick.place) + 0.36 * em);
        write(at, em, theme.muted, Anchor::End, false, &tick.label);
    }
    let middle = 0.5 * (area.min + area.max);
    write(Vec2::new(middle.x, area.max.y + 3.1 * em), em, theme.text, Anchor::Middle, false, &figure.x.label);
    write(Vec2::new(1.35 * em, middle.y), em, theme.text, Anchor::Middle, true, &figure.y.label);
    let title = shortened(&figure.title, 1.3 * em, whole.size().x - area.min.x - 0.5 * em);
    write(Vec2::new(area.min.x, 2.0 * em), 1.3 * em, theme.text, Anchor::Start, false, &title);
}

/// The text, cut where it would be too wide.
pub(super) fn shortened(content: &str, size: f64, room: f64) -> String {
    if text::width(content, size) <= room {
        return content.to_owned();
    }
    let mut kept: Vec<char> = content.chars().collect();
    while !kept.is_empty() {
        kept.pop();
        let cut: String = kept.iter().chain(['…'].iter()).collect();
        if text::width(&cut, size) <= room {
            return cut;
        }
    }
    String::new()
}

fn draw(layer: &Layer, frame: &Frame<'_>, measures: Measures, items: &mut Vec<Item>) {
    let color = frame.figure.theme.color(layer.ink);
    let width = layer.weight * measures.line;
    let dash = layer.dashed.then_some(3.0 * measures.line);
    match &layer.content {
        Content::Curve(path) => items.push(Item::Line { path: frame.path(path), width, color, dash }),
        Content::Area(path) => {
            items.push(Item::Fill { path: frame.path(path), color: faint(color) });
        }
        Content::Marks(mark, points) => {
            let centers: Vec<Vec2> = points.iter().map(|&p| frame.pixel(p)).collect();
            let background = frame.figure.theme.background;
            marks(*mark, &centers, 1.7 * width, color, background, items);
        }
        Content::Segments(segments) => {
            let line =
                |[a, b]: &[Vec2; 2]| Subpath::polyline(&[frame.pixel(*a), frame.pixel(*b)], false).ok();
            let path = Path { subpaths: segments.iter().filter_map(line).collect() };
            items.push(Item::Line { path, width, color, dash });
        }
        Content::Note(at, content) => {
            let at = frame.pixel(*at) + Vec2::new(0.6, -0.6) * measures.text;
            items.push(Item::Text(Text {
                at,
                size: measures.text,
                color,
                anchor: Anchor::Start,
                upward: false,
                content: content.clone(),
            }));
        }
    }
}

/// Marks of a radius, in pixels.
pub(super) fn marks(
    mark: Mark,
    centers: &[Vec2],
    radius: f64,
    color: Color,
    background: Color,
    items: &mut Vec<Item>,
) {
    let each = |shape: &dyn Fn(Vec2) -> Vec<Vec<Vec2>>, closed: bool| Path {
        subpaths: centers
            .iter()
            .flat_map(|&center| shape(center))
            .filter_map(|points| Subpath::polyline(&points, closed).ok())
            .collect(),
    };
    let corners = |center: Vec2, offsets: &[(f64, f64)]| -> Vec<Vec2> {
        offsets.iter().map(|&offset| center + radius * Vec2::from(offset)).collect()
    };
    match mark {
        Mark::Disc => items.push(Item::Dots { centers: centers.to_vec(), radius, color }),
        Mark::Ring => {
            items.push(Item::Dots { centers: centers.to_vec(), radius: 1.15 * radius, color });
            items.push(Item::Dots {
                centers: centers.to_vec(),
                radius: 0.65 * radius,
                color: opaque(background),
            });
        }
        Mark::Square => {
            let side = [(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)];
            for center in centers {
                let path = Path {
                    subpaths: Subpath::polyline(&corners(*center, &side), true).into_iter().collect(),
                };
                items.push(Item::Fill { path, color });
            }
        }
        Mark::Diamond => {
            let side = [(-1.4, 0.0), (0.0, -1.4), (1.4, 0.0), (0.0, 1.4)];
            for center in centers {
                let path = Path {
                    subpaths: Subpath::polyline(&corners(*center, &side), true).into_iter().collect(),
                };
                items.push(Item::Fill { path: path.clone(), color: opaque(background) });
                items.push(Item::Line { path, width: 0.5 * radius, color, dash: None });
            }
        }
        Mark::Cross => {
            let strokes = |center: Vec2| {
                vec![
                    corners(center, &[(-1.1, -1.1), (1.1, 1.1)]),
                    corners(center, &[(-1.1, 1.1), (1.1, -1.1)]),
                ]
            };
            items.push(Item::Line { path: each(&strokes, false), width: 0.6 * radius, color, dash: None });
        }
    }
}

/// The colour of areas.
pub(super) fn faint([r, g, b, _]: Color) -> Color {
    [r, g, b, FAINT]
}

/// A clear background hides nothing; white stands for it.
fn opaque(color: Color) -> Color {
    if color[3] == 0 { [255; 4] } else { color }
}

/// Points in pixels that show where something is drawn, close enough together for a legend not to slip between.
fn drawn_places(figure: &Figure, frame: &Frame<'_>, measures: Measures) -> Vec<Vec2> {
    let mut places = Vec::new();
    let step = measures.text;
    let walk = |from: Vec2, to: Vec2, places: &mut Vec<Vec2>| {
        let count = ((to - from).length() / step).ceil().clamp(1.0, 1e4) as usize;
        places.extend((0..=count).map(|k| from.lerp(to, k as f64 / count as f64)));
    };
    for layer in &figure.layers {
        match &layer.content {
            Content::Curve(path) | Content::Area(path) => {
                for piece in path.pieces() {
                    let points = frame.points(piece);
                    points.windows(2).for_each(|pair| walk(pair[0], pair[1], &mut places));
                }
            }
            Content::Marks(_, points) => places.extend(points.iter().map(|&p| frame.pixel(p))),
            Content::Segments(segments) => {
                segments.iter().for_each(|[a, b]| walk(frame.pixel(*a), frame.pixel(*b), &mut places));
            }
            Content::Note(at, content) => {
                let from = frame.pixel(*at) + Vec2::new(0.6, -0.9) * measures.text;
                walk(from, from + Vec2::new(text::width(content, measures.text), 0.0), &mut places);
            }
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::svg::read_path;
    use crate::math::{cos, exp, pow, sin};
    use crate::plot::Ink;
    use proptest::prelude::*;

    /// The rectangles that texts take, with their texts.
    fn boxes(scene: &Scene) -> Vec<(Area, String)> {
        let texts =
            scene.items.iter().filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None });
        let area = |text: &Text| {
            let width = text::width(&text.content, text.size);
            let start = match text.anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => -0.5 * width,
                Anchor::End => -width,
            };
            let (low, high) =
                (Vec2::new(start, -0.73 * text.size), Vec2::new(start + width, 0.05 * text.size));
            let turned = |v: Vec2| if text.upward { Vec2::new(v.y, -v.x) } else { v };
            let (a, b) = (text.at + turned(low), text.at + turned(high));
            (Area { min: a.min(b), max: a.max(b) }, text.content.clone())
        };
        texts.map(area).collect()
    }

    /// Texts are in the picture and do not touch each other.
    fn check_texts(figure: &Figure, width: u32, height: u32) {
        let scene = figure.scene(width, height).unwrap();
        let boxes = boxes(&scene);
        let far = Vec2::new(f64::from(width), f64::from(height));
        for (k, (area, text)) in boxes.iter().enumerate() {
            let inside = area.min.cmpge(Vec2::ZERO).all() && area.max.cmple(far).all();
            assert!(inside, "{width}x{height}: {text} at {area:?}");
            for (other, second) in &boxes[k + 1..] {
                let apart = area.max.cmple(other.min).any() || other.max.cmple(area.min).any();
                assert!(apart, "{width}x{height}: {text} over {second}");
            }
        }
    }

    fn chart(scale: Scale, name: &str) -> Figure {
        let curve = |ink: usize, f: &dyn Fn(f64) -> f64| {
            let points: Vec<Vec2> = (1..=40).map(|k| Vec2::new(f64::from(k), f(f64::from(k)))).collect();
            let path = Path { subpaths: vec![Subpath::polyline(&points, false).unwrap()] };
            Layer::curve(path, Ink::Series(ink)).named(format!("{name} {ink}"))
        };
        let layers = vec![
            curve(0, &|x| 3.0 + 2.0 * sin(0.3 * x)),
            curve(1, &|x| 1e3 / x),
            curve(2, &|x| exp(-x) + 1e-9),
            curve(3, &|x| pow(x, 3.0)),
        ];
        let axis = |label: &str| Axis { label: label.into(), scale, reversed: false };
        Figure { title: "A chart".into(), x: axis("time, s"), y: axis("error"), layers, ..Figure::default() }
    }

    fn shape(data: &str) -> Figure {
        let path = read_path(data).unwrap();
        let layers = vec![Layer::curve(path, Ink::Series(0)).named("shape")];
        Figure { equal: true, layers, ..Figure::default() }
    }

    const SIZES: [(u32, u32); 6] =
        [(200, 200), (1200, 900), (2000, 2000), (640, 200), (200, 640), (300, 260)];

    #[test]
    fn texts_keep_apart_at_every_size() {
        let shapes = [
            "M0 0L100 30",
            "M-1e-7 0L2e-7 1e-7",
            "M1e8 1e8l.001.001",
            "M0 0L1e12 3e11",
            "M5 5L5 9",
            "M3 3L3 3",
        ];
        for (width, height) in SIZES {
            for data in shapes {
                check_texts(&shape(data), width, height);
            }
            check_texts(&chart(Scale::Linear, "method"), width, height);
            check_texts(&chart(Scale::Log, "a method with quite a long name, number"), width, height);
        }
    }

    #[test]
    fn the_legend_covers_no_data() {
        for figure in [chart(Scale::Linear, "curve"), chart(Scale::Log, "curve"), spiral()] {
            for (width, height) in SIZES {
                let scene = figure.scene(width, height).unwrap();
                let named: Vec<&str> =
                    figure.layers.iter().filter_map(|layer| layer.name.as_deref()).collect();
                let boxes = boxes(&scene);
                let legend: Vec<&Area> = boxes
                    .iter()
                    .filter(|(_, text)| named.contains(&text.as_str()))
                    .map(|(area, _)| area)
                    .collect();
                let colors: Vec<Color> = (0..6).map(|k| figure.theme.color(Ink::Series(k))).collect();
                for item in &scene.items {
                    let Item::Line { path, color, .. } = item else { continue };
                    let data = path.pieces().count() > 2 && colors.contains(color);
                    for point in path.pieces().map(|piece| piece.eval(0.5)).filter(|_| data) {
                        let covered =
                            |area: &&&Area| point.cmpge(area.min).all() && point.cmple(area.max).all();
                        assert!(!legend.iter().any(|area| covered(&area)), "{width}x{height}: {point}");
                    }
                }
            }
        }
    }

    /// A curve that leaves no corner free.
    fn spiral() -> Figure {
        let at = |k: i32| {
            let angle = 0.05 * f64::from(k);
            Vec2::new(angle * cos(angle), angle * sin(angle))
        };
        let points: Vec<Vec2> = (0..4000).map(at).collect();
        let path = Path { subpaths: vec![Subpath::polyline(&points, false).unwrap()] };
        let layers = vec![Layer::curve(path, Ink::Series(0)).named("a spiral")];
        Figure { layers, ..Figure::default() }
    }

    #[test]
    fn equal_units_are_equal_and_y_runs_as_told() {
        let figure = shape("M0 0L10 0L10 10L0 10z");
        let [low, high] = range(&figure);
        let whole = Area { min: Vec2::ZERO, max: Vec2::new(700.0, 400.0) };
        let mut frame = framed(&figure, [low, high], whole, Measures::of(700, 400), [0.0; 2]);
        let side = |frame: &Frame<'_>, to: Vec2| frame.pixel(to) - frame.pixel(Vec2::ZERO);
        let (x, y) = (side(&frame, Vec2::new(10.0, 0.0)), side(&frame, Vec2::new(0.0, 10.0)));
        assert!((x.x + y.y).abs() < 1e-9 && x.y.abs() < 1e-9 && y.y < 0.0, "{x} {y}");
        let reversed = Figure { y: Axis { reversed: true, ..Axis::default() }, ..figure.clone() };
        frame = framed(&reversed, [low, high], whole, Measures::of(700, 400), [0.0; 2]);
        assert!(side(&frame, Vec2::new(0.0, 10.0)).y > 0.0);
    }

    #[test]
    fn what_cannot_be_drawn_is_an_error() {
        use crate::plot::PlotError;
        let at = |p: Vec2| Figure {
            layers: vec![Layer::new(Content::Note(p, "x".into()), Ink::Text)],
            ..Figure::default()
        };
        for point in [Vec2::NAN, Vec2::new(0.0, f64::INFINITY), Vec2::new(1e151, 0.0)] {
            assert!(matches!(at(point).scene(99, 99), Err(PlotError::OutOfRange { layer: 0, .. })));
        }
        let mut log = at(Vec2::new(1.0, -2.0));
        log.y.scale = Scale::Log;
        assert_eq!(log.scene(99, 99), Err(PlotError::NotPositive { layer: 0, value: -2.0 }));
        for (width, height) in [(0, 99), (99, 31), (16_385, 99), (16_384, 16_384)] {
            assert_eq!(Figure::default().scene(width, height), Err(PlotError::Size { width, height }));
        }
        assert!(Figure::default().scene(99, 99).is_ok());
    }

    proptest! {
        #[test]
        fn everything_drawn_is_in_the_picture(
            points in prop::collection::vec((-1e3..1e3_f64, -1e3..1e3_f64), 2..9), power in -140..140,
        ) {
            let size = pow(10.0, f64::from(power));
            let points: Vec<Vec2> = points.into_iter().map(|p| Vec2::from(p) * size).collect();
            let path = Path { subpaths: vec![Subpath::polyline(&points, true).unwrap()] };
            let figure = Figure { equal: true, layers: vec![Layer::curve(path, Ink::Series(0))], ..Figure::default() };
            let scene = figure.scene(300, 200).unwrap();
            for item in &scene.items {
                if let Item::Line { path, .. } = item {
                    for point in path.pieces().map(Piece::start) {
                        prop_assert!(point.cmpge(Vec2::ZERO).all() && point.x <= 300.0 && point.y <= 200.0, "{}", point);
                    }
                }
            }
        }
    }
}
