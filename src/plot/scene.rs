use super::Color;
use crate::curve::Path;
use crate::math::Vec2;

/// A figure laid out: what is drawn where, in pixels from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) background: Color,
    /// In the order of drawing.
    pub(super) items: Vec<Item>,
}

/// One thing to draw. Paths hold no arcs.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Item {
    /// A line of a width, with round caps and joins; dashes as long as they are apart.
    Line { path: Path, width: f64, color: Color, dash: Option<f64> },
    /// The inside of a path, by the even-odd rule.
    Fill { path: Path, color: Color },
    /// Discs.
    Dots { centers: Vec<Vec2>, radius: f64, color: Color },
    /// A line of text whose baseline starts, is centred or ends at a point.
    Text(Text),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Text {
    pub(super) at: Vec2,
    /// Pixels of an em.
    pub(super) size: f64,
    pub(super) color: Color,
    pub(super) anchor: Anchor,
    /// Whether it reads upward.
    pub(super) upward: bool,
    pub(super) content: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Scene {
    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }
}
