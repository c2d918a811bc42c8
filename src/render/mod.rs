//! Solids to pictures.
//!
//! A tiled rasteriser with sixteen samples a pixel and exact coverage. Light is added up in linear colours and coded as
//! sRGB at the end. The same input gives the same bytes on any number of threads and on every platform.
//!
//! ```
//! use ogee::math::Vec3;
//! use ogee::mesh::cuboid;
//! use ogee::render::{self, Camera, Fit, Style};
//!
//! let mesh = cuboid(Vec3::ZERO, Vec3::new(3.0, 2.0, 1.0)).into_mesh();
//! let style = Style { width: 64, height: 48, ..Style::default() };
//! let image = render::draw(&mesh, &Camera::fitted(&mesh, &Fit::default()), &style)?;
//! assert_eq!(image.pixels.len(), 64 * 48);
//! # Ok::<(), render::RenderError>(())
//! ```

mod camera;
mod color;
mod crease;
mod film;
mod ground;
mod light;
mod lines;
mod occlusion;
mod raster;
mod scene;
#[cfg(test)]
mod tests;

pub use camera::{Camera, Fit, Projection};

use crate::math::{Aabb, Vec3};
use crate::mesh::Mesh;
use crate::par;
use camera::View;
use color::{Encoder, Light, add, decode, mix};
use film::{Film, Pixel};
use ground::Ground;
use lines::Lines;
use scene::{Scene, bin_triangles};
use std::fmt;

/// How a picture looks. Colours are sRGB, each channel from 0 to 1; what is outside is brought inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Pixels in a row, from 1 to [`Style::LARGEST`].
    pub width: u32,
    /// Pixels in a column, from 1 to [`Style::LARGEST`].
    pub height: u32,
    /// Edges whose triangles meet at a larger angle, in radians, are sharp; over the others normals are smoothed. With 0
    /// every triangle is flat.
    pub crease: f64,
    /// Whether and how sharp edges are drawn as lines.
    pub edges: Option<Edges>,
    /// Colour behind everything; `None` is transparent.
    pub background: Option<[f32; 3]>,
    /// Colour and opacity of triangles that have none of their own. Opacity is the share of a pixel's samples that a
    /// surface covers, in sixteenths.
    pub material: [f32; 4],
    /// Colour and opacity of each triangle, `None` for the material; empty, or one for each.
    pub colors: Vec<Option<[f32; 4]>>,
    /// Whether corners get less ambient light.
    pub occlusion: bool,
    /// Whether the model throws a soft shadow on the ground at its lowest point.
    pub shadow: bool,
}

/// Lines along sharp edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edges {
    /// Their colour.
    pub color: [f32; 3],
    /// Their width, in pixels.
    pub width: f64,
}

impl Style {
    /// Most pixels in a row or column.
    pub const LARGEST: u32 = 16384;

    /// Most pixels in a picture; drawing takes about 100 bytes for each.
    pub const MOST_PIXELS: u64 = 1 << 26;
}

impl Default for Style {
    fn default() -> Style {
        Style {
            width: 800,
            height: 600,
            crease: std::f64::consts::PI / 6.0,
            edges: None,
            background: Some([0.965, 0.961, 0.953]),
            material: [0.79, 0.767, 0.735, 1.0],
            colors: Vec::new(),
            occlusion: true,
            shadow: true,
        }
    }
}

impl Default for Edges {
    fn default() -> Edges {
        Edges { color: [0.16, 0.17, 0.19], width: 1.25 }
    }
}

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Pixels in a column.
    pub height: u32,
    /// Red, green, blue (sRGB) and opacity of every pixel, not multiplied; rows from the top, pixels from the left.
    pub pixels: Vec<[u8; 4]>,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq)]
pub enum RenderError {
    /// A side is zero or larger than [`Style::LARGEST`], or there are more than [`Style::MOST_PIXELS`].
    BadSize {
        /// Pixels in a row.
        width: u32,
        /// Pixels in a column.
        height: u32,
    },
    /// A number of the camera is not finite, its eye is its target, its up is zero, or its angle or height is not
    /// positive.
    BadCamera {
        /// The camera.
        camera: Camera,
    },
    /// There are colours, but not one for each triangle.
    ColorCount {
        /// How many there are.
        colors: usize,
        /// How many triangles there are.
        triangles: usize,
    },
    /// A triangle names a position that is not there.
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// Number of positions.
        positions: usize,
    },
    /// A corner is not finite, or too far away for this camera to tell where.
    OutOfSight {
        /// Index of the position.
        vertex: usize,
        /// The position.
        position: Vec3,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RenderError::BadSize { width, height } => write!(
                f,
                "a picture of {width} by {height} pixels: sides must be 1 to {} and the whole at most {} pixels",
                Style::LARGEST,
                Style::MOST_PIXELS
            ),
            RenderError::BadCamera { camera } => write!(f, "the camera cannot see: {camera:?}"),
            RenderError::ColorCount { colors, triangles } => {
                write!(f, "{colors} colours for {triangles} triangles")
            }
            RenderError::IndexOutOfRange { triangle, positions } => {
                write!(f, "triangle {triangle} names a position that is not there; there are {positions}")
            }
            RenderError::OutOfSight { vertex, position } => {
                write!(f, "vertex {vertex} at {position} is not finite or too far away from the camera")
            }
        }
    }
}

impl std::error::Error for RenderError {}

/// How far things take ambient light from each other, relative to the diagonal of the model.
const OCCLUSION_REACH: f64 = 0.09;

/// Draws `mesh` as `camera` sees it. Triangles are seen from both sides; those without area are not seen.
///
/// # Errors
/// See [`RenderError`].
pub fn draw(mesh: &Mesh, camera: &Camera, style: &Style) -> Result<Image, RenderError> {
    let (width, height) = (style.width, style.height);
    let sound = |side: u32| (1..=Style::LARGEST).contains(&side);
    if !sound(width) || !sound(height) || u64::from(width) * u64::from(height) > Style::MOST_PIXELS {
        return Err(RenderError::BadSize { width, height });
    }
    if !style.colors.is_empty() && style.colors.len() != mesh.triangles.len() {
        return Err(RenderError::ColorCount { colors: style.colors.len(), triangles: mesh.triangles.len() });
    }
    let view = View::new(camera, width, height)?;
    let scene = Scene::new(mesh, &view, style)?;
    let lines = style.edges.map(|edges| Lines::new(&scene, edges.width, width, height));
    let film = Film::expose(&scene, &bin_triangles(&scene, width, height), lines.as_ref(), width, height);
    let ambient = style.occlusion.then(|| occlusion::ambient_light(&film, &view, reach(&scene)));
    let ground = if style.shadow { Ground::under(&scene) } else { None };
    Ok(develop(&film, &view, style, ambient.as_deref(), ground.as_ref()))
}

/// The distance, in view lengths, over which things take light from each other.
fn reach(scene: &Scene<'_>) -> f64 {
    let used = scene.indices.iter().flatten().map(|&v| scene.placed[v as usize]);
    OCCLUSION_REACH * Aabb::of(used).size().length()
}

/// Light to bytes.
fn develop(
    film: &Film,
    view: &View,
    style: &Style,
    ambient: Option<&[f32]>,
    ground: Option<&Ground>,
) -> Image {
    let background = style.background.map(decode);
    let encoder = Encoder::new();
    let line_color = style.edges.map_or([0.0; 3], |edges| decode(edges.color));
    let rows: Vec<usize> = (0..film.height).collect();
    let pixel = |x: usize, y: usize| {
        let pixel = &film.pixels[y * film.width + x];
        let light = ambient.map_or(1.0, |ambient| ambient[y * film.width + x]);
        let darkness = match ground {
            Some(ground) if pixel.coverage < 1.0 => {
                ground.darkness(view, view.ray(x as f64 + 0.5, y as f64 + 0.5)) as f32
            }
            _ => 0.0,
        };
        let (light, opacity) = finish(pixel, light, darkness, background, line_color);
        let [r, g, b] = encoder.encode(light);
        [r, g, b, (opacity * 255.0).round() as u8]
    };
    let pixels =
        par::map_above(2, &rows, |&y| (0..film.width).map(|x| pixel(x, y)).collect::<Vec<_>>()).concat();
    Image { width: style.width, height: style.height, pixels }
}

/// Surface over shadowed ground or nothing, lines over both: a colour and its opacity.
fn finish(
    pixel: &Pixel,
    ambient: f32,
    darkness: f32,
    background: Option<Light>,
    line_color: Light,
) -> (Light, f32) {
    // A corner that gets little from the sky gets less from the lamps too, which are no points.
    let surface = add(pixel.direct.map(|x| x * (0.5 + 0.5 * ambient)), pixel.ambient, ambient);
    let free = 1.0 - pixel.coverage;
    let behind = background.unwrap_or([0.0; 3]);
    let opacity = if background.is_some() { 1.0 } else { pixel.coverage + free * darkness };
    let light = mix(add(surface, behind, free * (1.0 - darkness)), line_color, pixel.line);
    let opacity = opacity + (1.0 - opacity) * pixel.line;
    (if opacity > 0.0 { light.map(|c| c / opacity) } else { light }, opacity)
}
