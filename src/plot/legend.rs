//! The legend: a box of names that covers nothing.

use super::figure::{Content, Figure, Layer};
use super::layout::{Area, Measures, faint, marks, shortened};
use super::scene::{Anchor, Item, Text};
use super::text;
use crate::curve::{Path, Subpath};
use crate::math::Vec2;

/// Names with their samples, one above the other.
pub(super) struct Legend {
    /// Indices of layers and their names.
    rows: Vec<(Option<usize>, String)>,
    em: f64,
    size: Vec2,
}

impl Legend {
    /// The legend of a figure no wider and higher than so many pixels, if it names anything. Rows that do not fit are
    /// counted in the last one.
    pub(super) fn of(figure: &Figure, measures: Measures, widest: f64, highest: f64) -> Option<Legend> {
        let em = measures.text;
        let room = widest - 3.4 * em;
        let named =
            figure.layers.iter().enumerate().filter_map(|(index, layer)| Some((index, layer.name.as_ref()?)));
        let mut rows: Vec<(Option<usize>, String)> =
            named.map(|(index, name)| (Some(index), shortened(name, em, room))).collect();
        let most = ((highest / em - 0.5) / 1.6).max(1.0) as usize;
        if rows.len() > most {
            let more = rows.len() - most + 1;
            rows.truncate(most - 1);
            rows.push((None, format!("and {more} more")));
        }
        if rows.is_empty() {
            return None;
        }
        let widest = rows.iter().map(|(_, name)| text::width(name, em)).fold(0.0, f64::max);
        let size = Vec2::new(widest + 3.4 * em, (1.6 * rows.len() as f64 + 0.5) * em);
        Some(Legend { rows, em, size })
    }

    /// Its width and height in pixels.
    pub(super) fn size(&self) -> Vec2 {
        self.size
    }

    pub(super) fn draw(&self, corner: Vec2, figure: &Figure, measures: Measures, items: &mut Vec<Item>) {
        let em = self.em;
        let [r, g, b, opacity] = figure.theme.background;
        if opacity > 0 {
            // Lines of the grid shine through.
            let far = corner + self.size;
            let corners = [corner, Vec2::new(far.x, corner.y), far, Vec2::new(corner.x, far.y)];
            let path = Path { subpaths: Subpath::polyline(&corners, true).into_iter().collect() };
            items.push(Item::Fill { path, color: [r, g, b, 220] });
        }
        for (row, (index, name)) in self.rows.iter().enumerate() {
            let middle = corner + Vec2::new(0.0, (1.6 * row as f64 + 1.05) * em);
            let [from, to] = [0.5, 2.3].map(|x| middle + Vec2::new(x * em, 0.0));
            if let Some(index) = index {
                sample(&figure.layers[*index], from, to, figure, measures, items);
            }
            items.push(Item::Text(Text {
                at: middle + Vec2::new(2.9 * em, 0.36 * em),
                size: em,
                color: figure.theme.text,
                anchor: Anchor::Start,
                upward: false,
                content: name.clone(),
            }));
        }
    }
}

/// What a layer looks like, in the space between two points.
fn sample(layer: &Layer, from: Vec2, to: Vec2, figure: &Figure, measures: Measures, items: &mut Vec<Item>) {
    let color = figure.theme.color(layer.ink);
    let width = layer.weight * measures.line;
    match &layer.content {
        Content::Marks(mark, _) => {
            let background = figure.theme.background;
            marks(*mark, &[0.5 * (from + to)], 1.7 * width, color, background, items);
        }
        Content::Area(_) => {
            let half = Vec2::new(0.0, 0.4 * measures.text);
            let corners = [from - half, to - half, to + half, from + half];
            let path = Path { subpaths: Subpath::polyline(&corners, true).into_iter().collect() };
            items.push(Item::Fill { path, color: faint(color) });
        }
        _ => {
            let path = Path { subpaths: Subpath::polyline(&[from, to], false).into_iter().collect() };
            let dash = layer.dashed.then_some(3.0 * measures.line);
            items.push(Item::Line { path, width, color, dash });
        }
    }
}

/// The upper left corner of the first place along the frame where the legend covers none of the points; corners come
/// before sides.
pub(super) fn free_corner(legend: &Legend, area: &Area, drawn: &[Vec2]) -> Option<Vec2> {
    let air = 0.4 * legend.em;
    let (near, far) = (area.min + air, area.max - air - legend.size);
    if far.cmplt(near).any() {
        return None;
    }
    let middle = 0.5 * (near + far);
    let places = [
        Vec2::new(far.x, near.y),
        near,
        far,
        Vec2::new(near.x, far.y),
        Vec2::new(far.x, middle.y),
        Vec2::new(near.x, middle.y),
        Vec2::new(middle.x, near.y),
        Vec2::new(middle.x, far.y),
    ];
    let free = |corner: &Vec2| {
        // Lines are walked in steps of an em, and half of one passes between.
        let (low, high) = (*corner - 0.6 * legend.em, *corner + legend.size + 0.6 * legend.em);
        !drawn.iter().any(|p| p.cmpge(low).all() && p.cmple(high).all())
    };
    places.into_iter().find(free)
}
