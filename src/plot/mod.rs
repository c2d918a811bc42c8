//! Figures of curves and data, as SVG and as pixels.
//!
//! A [`Figure`] says what is to be seen: layers of curves, areas, marks and notes over two axes. [`Figure::scene`] lays
//! it out for a size, choosing ticks, margins and a place for the legend that covers nothing; [`Scene::svg`] and
//! [`Scene::pixels`] draw one and the same scene. [`overlay()`] makes layers that explain curves: control polygons,
//! constructions, tangents, curvature, inflections, intersections.
//!
//! Colours are told apart with any kind of colour vision (Okabe, Ito, Color universal design, 2008; lightened on dark
//! grounds) and lines by dashes once colours repeat. Pictures hold text in DejaVu Sans.
//!
//! ```
//! use ogee::plot::{Figure, Ink, Layer, Theme};
//!
//! let path = ogee::io::svg::read_path("M0 0C0 4 6 4 6 0")?;
//! let figure = Figure { title: "An arch".into(), layers: vec![Layer::curve(path, Ink::Series(0))], ..Figure::default() };
//! let scene = figure.scene(400, 300)?;
//! let mut svg = Vec::new();
//! scene.svg(&mut svg)?;
//! assert_eq!(scene.pixels().len(), 400 * 300);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod figure;
mod layout;
mod legend;
mod overlay;
mod raster;
mod scene;
mod text;
mod theme;
mod ticks;
mod vector;

pub use figure::{Axis, Content, Figure, Ink, Layer, Mark, PlotError, Scale};
pub use overlay::{Overlay, Show, overlay};
pub use scene::Scene;
pub use theme::{Color, Theme};
