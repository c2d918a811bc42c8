use super::scene::Scene;
use super::{Theme, layout};
use crate::curve::{Bounds, Path};
use crate::math::Vec2;
use std::fmt;

/// What is to be seen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// Above everything; may be empty.
    pub title: String,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upward.
    pub y: Axis,
    /// Whether a unit is as long on both axes, which shapes need and charts do not.
    pub equal: bool,
    /// What is drawn, the first at the bottom.
    pub layers: Vec<Layer>,
    /// The colours.
    pub theme: Theme,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What it measures; may be empty.
    pub label: String,
    /// How numbers become places.
    pub scale: Scale,
    /// Whether it runs down, or to the left, as y does in SVG.
    pub reversed: bool,
}

/// How numbers become places on an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    #[default]
    Linear,
    /// Equal steps for equal ratios; all numbers must be positive.
    Log,
}

/// Something drawn in one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What.
    pub content: Content,
    /// In what colour.
    pub ink: Ink,
    /// Width of lines and size of marks; 1 is that of data.
    pub weight: f64,
    /// Whether lines are dashed.
    pub dashed: bool,
    /// Its name in the legend; without one it is not there.
    pub name: Option<String>,
}

/// What a layer holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Lines along a path.
    Curve(Path),
    /// The inside of closed paths, by the even-odd rule, faint.
    Area(Path),
    /// A mark at every point.
    Marks(Mark, Vec<Vec2>),
    /// Straight lines.
    Segments(Vec<[Vec2; 2]>),
    /// A text beside a point.
    Note(Vec2, String),
}

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A filled disc.
    Disc,
    /// A circle around the background.
    Ring,
    /// A filled square.
    Square,
    /// A square on its corner, around the background.
    Diamond,
    /// Two crossed lines.
    Cross,
}

/// Which colour of the theme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// That of a series of data; they repeat after six.
    Series(usize),
    /// That of text.
    Text,
    /// That of labels.
    Muted,
    /// That of what must be seen first.
    Accent,
}

/// Why a figure cannot be drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum PlotError {
    /// A point is NaN or infinite, or beyond [`Figure::LARGEST`].
    OutOfRange {
        /// Index of the layer.
        layer: usize,
        /// The point.
        point: Vec2,
    },
    /// A number on a logarithmic axis is not positive.
    NotPositive {
        /// Index of the layer.
        layer: usize,
        /// The number.
        value: f64,
    },
    /// The picture has no pixels, or too many.
    Size {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
}

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlotError::OutOfRange { point, .. } => {
                write!(f, "the point ({:e}, {:e}) is too far out to be drawn", point.x, point.y)
            }
            PlotError::NotPositive { value, .. } => {
                write!(f, "{value} has no place on a logarithmic axis, which holds positive numbers")
            }
            PlotError::Size { width, height } => {
                let (least, most) = (Figure::SMALLEST, Figure::WIDEST);
                write!(f, "{width} x {height} pixels: figures have sides from {least} to {most} pixels")
            }
        }
    }
}

impl std::error::Error for PlotError {}

impl Layer {
    /// A layer of the weight of data, without a name.
    pub fn new(content: Content, ink: Ink) -> Layer {
        Layer { content, ink, weight: 1.0, dashed: false, name: None }
    }

    /// A curve.
    pub fn curve(path: Path, ink: Ink) -> Layer {
        Layer::new(Content::Curve(path), ink)
    }

    /// The same with a name in the legend.
    pub fn named(self, name: impl Into<String>) -> Layer {
        Layer { name: Some(name.into()), ..self }
    }

    /// The same with lines and marks of another size.
    pub fn weighing(self, weight: f64) -> Layer {
        Layer { weight, ..self }
    }

    /// The box around all of it; `None` where there is nothing.
    pub(super) fn bounds(&self) -> Option<Bounds<Vec2>> {
        let of = |points: &mut dyn Iterator<Item = Vec2>| {
            let boxes = points.map(|point| Bounds { min: point, max: point });
            boxes.reduce(|a, b| Bounds { min: a.min.min(b.min), max: a.max.max(b.max) })
        };
        match &self.content {
            Content::Curve(path) | Content::Area(path) => path.bounding_box(),
            Content::Marks(_, points) => of(&mut points.iter().copied()),
            Content::Segments(segments) => of(&mut segments.iter().flatten().copied()),
            Content::Note(at, _) => of(&mut [*at].into_iter()),
        }
    }

    /// A point that no figure can hold.
    fn misfit(&self) -> Option<Vec2> {
        let wrong = |point: &Vec2| point.is_nan() || point.abs().max_element() > Figure::LARGEST;
        match &self.content {
            Content::Curve(path) | Content::Area(path) => {
                let corners = path.bounding_box().map(|b| [b.min, b.max])?;
                corners.into_iter().find(wrong)
            }
            Content::Marks(_, points) => points.iter().copied().find(wrong),
            Content::Segments(segments) => segments.iter().flatten().copied().find(wrong),
            Content::Note(at, _) => Some(*at).filter(wrong),
        }
    }
}

impl Figure {
    /// The largest coordinate that can be drawn: differences and squares of it are numbers still.
    pub const LARGEST: f64 = 1e150;
    /// The shortest side of a picture, in pixels.
    pub const SMALLEST: u32 = 32;
    /// The longest side.
    pub const WIDEST: u32 = 16_384;

    /// Lays the figure out for a picture of this many pixels.
    ///
    /// # Errors
    /// [`PlotError`] names what cannot be drawn.
    pub fn scene(&self, width: u32, height: u32) -> Result<Scene, PlotError> {
        let sides = [width, height];
        let largest = u64::from(Figure::WIDEST) * u64::from(Figure::WIDEST) / 4;
        let fits = |side: &u32| (Figure::SMALLEST..=Figure::WIDEST).contains(side);
        if !sides.iter().all(fits) || u64::from(width) * u64::from(height) > largest {
            return Err(PlotError::Size { width, height });
        }
        for (layer, content) in self.layers.iter().enumerate() {
            if let Some(point) = content.misfit() {
                return Err(PlotError::OutOfRange { layer, point });
            }
            let Some(bounds) = content.bounds() else { continue };
            for (axis, least) in [(&self.x, bounds.min.x), (&self.y, bounds.min.y)] {
                if axis.scale == Scale::Log && least <= 0.0 {
                    return Err(PlotError::NotPositive { layer, value: least });
                }
            }
        }
        Ok(layout::scene(self, width, height))
    }
}
