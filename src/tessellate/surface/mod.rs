//! Surfaces to triangles, within a tolerance and without cracks.
//!
//! Pieces of surfaces share edges, and corners. The vertices of an edge depend on its curve alone and are computed once,
//! in one direction, so whatever meets there meets to the bit (Moreton, Watertight tessellation using forward
//! differencing, 2001). Inside, rows of vertices are laid out by a metric and joined by strips of triangles; every
//! triangle is then checked, and those that fail are mended by flips and splits of inner edges.
//!
//! The check of a triangle T = (p1, p2, p3) of the parameter plane: at p = sum l_i p_i the flat triangle is off the
//! surface point by at most half of sum l_i |p - p_i|^2 in the norm of the second derivatives, which never exceeds half the
//! squared radius of the smallest circle around T in that norm. Bounds of the second derivatives over the cells that T
//! meets make it a proof (for right triangles: Filip, Magedson, Markot, Surface algorithms using bounds on derivatives,
//! 1986). It bounds the distance from the mesh to the surface and from the surface to the mesh. Where only what bends across
//! the surface counts, see the notes of `slide`.

mod between;
mod caps;
mod check;
mod edge;
mod frame;
mod layout;
mod patches;
mod piece;
mod refine;
mod slide;
mod table;
mod thicken;

pub use caps::{CloseError, capped};
pub use patches::{patch_edges, patches};
pub use thicken::thickened;

use crate::math::Vec3;
use crate::mesh::{Defects, Mesh, TooLarge};
use crate::surface::Surface;
use layout::Layout;
use std::fmt;

/// How closely triangles must follow a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Precision {
    /// No point of either is farther from the other than this.
    Distance(f64),
    /// The distance as seen by a camera.
    View(View),
}

/// A camera, and how large an error may look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the camera is.
    pub eye: Vec3,
    /// Size of a pixel over its distance: `2 tan(field of view / 2) / height in pixels`.
    pub pixel: f64,
    /// The error that is allowed, in pixels.
    pub pixels: f64,
    /// Whatever is nearer counts as this far away.
    pub nearest: f64,
}

/// What the check of a triangle rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guarantee {
    /// Bounds of distances where the surface brings them ([`Surface::triangle_bound`]), or those of second derivatives
    /// ([`Surface::second_bounds`], and fewer triangles with [`Surface::bends`]), else as `Measured`.
    #[default]
    Proven,
    /// Distances at seven points of every triangle and at more between them, and from the surface back to the mesh; where the
    /// surface brings bounds of second derivatives at so many that what lies between them is below a twentieth of the
    /// tolerance, and that is part of the distance that is told. Where more triangles do not help, as along the crease of a
    /// fold, the distance that is told is above the tolerance. Fewer triangles where a surface is unevenly parametrised, such
    /// as around a pole, since sliding along the surface is no error.
    Measured,
}

/// The numbers of a tessellation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceOptions {
    /// How close.
    pub precision: Precision,
    /// Largest turn of edges between neighbouring vertices, and about the largest of the surface inside, in radians;
    /// `None` for any.
    pub angle: Option<f64>,
    /// What it rests on.
    pub guarantee: Guarantee,
    /// Most triangles.
    pub max_triangles: u64,
}

impl SurfaceOptions {
    /// At most this far away, proven where possible, at most fifty million triangles.
    pub fn within(tolerance: f64) -> SurfaceOptions {
        SurfaceOptions {
            precision: Precision::Distance(tolerance),
            angle: None,
            guarantee: Guarantee::Proven,
            max_triangles: 50_000_000,
        }
    }
}

impl Precision {
    /// The distance allowed at a point.
    fn at(&self, point: Vec3) -> f64 {
        match *self {
            Precision::Distance(tolerance) => tolerance,
            Precision::View(view) => view.pixels * view.pixel * (point - view.eye).length().max(view.nearest),
        }
    }

    fn scaled(self, factor: f64) -> Precision {
        match self {
            Precision::Distance(tolerance) => Precision::Distance(tolerance * factor),
            Precision::View(view) => {
                Precision::View(View { eye: view.eye * factor, nearest: view.nearest * factor, ..view })
            }
        }
    }
}

/// Triangles that follow surfaces.
#[derive(Clone, Debug)]
pub struct Tessellation {
    /// The triangles; corners and edges that surfaces share are shared vertices.
    pub mesh: Mesh,
    /// The surface that each triangle belongs to.
    pub surfaces: Vec<u32>,
    /// The parameters of the corners of each triangle, in that surface.
    pub parameters: Vec<[[f64; 2]; 3]>,
    /// How far mesh and surfaces are apart.
    pub error: Achieved,
    /// How the surfaces are joined.
    pub edges: EdgeCounts,
}

/// How surfaces are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Edges, each once, but for those that are a single point.
    pub all: usize,
    /// Those of one side only.
    pub used_once: usize,
    /// Sides that are a single point.
    pub collapsed: usize,
}

/// How far a mesh and a surface are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Achieved {
    /// A proven bound of the distance both ways; `None` when some surface brings no bounds or none were asked for.
    pub bound: Option<f64>,
    /// The largest distance found: of seven points of every triangle from the surface where a bound is proven, else both ways
    /// as [`Guarantee::Measured`] tells.
    pub measured: f64,
}

/// Why surfaces could not be tessellated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TessellationError {
    /// A tolerance, angle or size of a pixel is not a positive number.
    Option {
        /// Its name.
        name: &'static str,
        /// What it is.
        value: f64,
    },
    /// The tolerance is below the rounding of numbers of this size.
    ToleranceTooFine {
        /// What was asked for.
        value: f64,
        /// About the finest that can be kept.
        finest: f64,
    },
    /// A surface has a point that is NaN or infinite.
    NotFinite {
        /// Index of the surface.
        surface: usize,
        /// The parameters.
        parameters: [f64; 2],
    },
    /// The tolerance cannot be met although triangles have become tiny: the surface tears or has a cusp there.
    NotReached {
        /// Index of the surface.
        surface: usize,
        /// The parameters.
        parameters: [f64; 2],
    },
    /// Vertices are so near each other for the tolerance that triangles or edges coincide, also with more of them: the
    /// surface folds back onto itself.
    Tangled {
        /// Edges with more than two triangles.
        edges: usize,
        /// Triangles that come twice.
        triangles: usize,
    },
    /// More triangles than allowed.
    TooLarge {
        /// How many there would be, about.
        triangles: u64,
        /// How many there may be.
        most: u64,
    },
}

impl fmt::Display for TessellationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TessellationError::Option { name, value } => {
                write!(f, "{name} of {value} is not a positive number")
            }
            TessellationError::ToleranceTooFine { value, finest } => {
                write!(f, "a tolerance of {value} is below the rounding of this surface, about {finest}")
            }
            TessellationError::NotFinite { surface, parameters: [u, v] } => {
                write!(f, "surface {surface} is not finite at u = {u:.9}, v = {v:.9}")
            }
            TessellationError::NotReached { surface, parameters: [u, v] } => {
                write!(
                    f,
                    "surface {surface} cannot be followed at u = {u:.9}, v = {v:.9}: it has a tear or a cusp there"
                )
            }
            TessellationError::Tangled { edges, triangles } => {
                write!(
                    f,
                    "the surface folds back onto itself: {edges} edges have more than two triangles and {triangles} triangles come twice"
                )
            }
            TessellationError::TooLarge { triangles, most } => {
                write!(f, "{triangles} triangles or more, where {most} are allowed")
            }
        }
    }
}

impl std::error::Error for TessellationError {}

/// Tessellates one surface; its sides that lie together ([`Surface::sides`]) are welded.
///
/// ```
/// use ogee::mesh::Solid;
/// use ogee::surface::Classic;
/// use ogee::tessellate::{SurfaceOptions, surface};
///
/// let torus = Classic::Torus { major: 2.0, minor: 1.0 };
/// let made = surface(&torus, &SurfaceOptions::within(0.01))?;
/// assert!(made.error.measured <= 0.01);
/// assert!(Solid::new(made.mesh).is_ok());
/// # Ok::<(), ogee::tessellate::TessellationError>(())
/// ```
///
/// # Errors
/// [`TessellationError`].
pub fn surface(surface: &dyn Surface, options: &SurfaceOptions) -> Result<Tessellation, TessellationError> {
    surfaces(&[surface], options)
}

/// Tessellates surfaces together. Sides with equal control points, forward or backward, are one edge, and so are
/// sides of one surface that lie together; others stay apart.
///
/// # Errors
/// [`TessellationError`].
pub fn surfaces(
    surfaces: &[&dyn Surface],
    options: &SurfaceOptions,
) -> Result<Tessellation, TessellationError> {
    check_options(options)?;
    // Coarse vertices can name one edge twice, and beside a straight side of a twisted surface long edges can be too far
    // off; more vertices on every edge help with both.
    const ATTEMPTS: [usize; 8] = [1, 2, 3, 5, 9, 17, 33, 65];
    let layout = Layout::new(surfaces)?;
    layout.check_precision(options)?;
    let mut failed = None;
    for least in ATTEMPTS {
        let mut made = attempt(&layout, options, Care { least, by_place: false });
        if failed.is_none() && matches!(made, Err(TessellationError::NotReached { .. })) {
            made = attempt(&layout, options, Care { least, by_place: true });
        }
        if let (true, Ok(first)) = (failed.is_none(), &made)
            && first.is_farther_than(options.precision)
            && let Ok(second) = attempt(&layout, &more_than(first, options), Care { least, by_place: true })
            && second.error.measured < first.error.measured
        {
            made = Ok(second);
        }
        let tessellation = match made {
            Ok(tessellation) => tessellation,
            Err(error @ TessellationError::NotReached { .. }) => {
                failed.get_or_insert(error);
                continue;
            }
            Err(error) => return Err(failed.unwrap_or(error)),
        };
        let defects = Defects::of(&tessellation.mesh);
        let edges = defects.non_manifold_edges.saturating_sub(layout.crowded_edges());
        if edges == 0 && defects.duplicate_triangles == 0 {
            return Ok(tessellation);
        }
        failed.get_or_insert(TessellationError::Tangled { edges, triangles: defects.duplicate_triangles });
    }
    Err(failed.expect("there was an attempt"))
}

/// The options with room for what may be mended by more triangles: where it takes still more, the surface is hardly one.
fn more_than(first: &Tessellation, options: &SurfaceOptions) -> SurfaceOptions {
    const TIMES: u64 = 8;
    let most = TIMES * first.mesh.triangles.len() as u64;
    SurfaceOptions { max_triangles: most.min(options.max_triangles), ..*options }
}

/// How an attempt goes about it.
#[derive(Clone, Copy)]
struct Care {
    /// Segments that every edge has.
    least: usize,
    /// Edges keep their tolerance from place to place, as they are parametrised, not only as a whole; and triangles are
    /// halved where they are longest in space, without flips. That takes more triangles, and ends wherever the surface is
    /// continuous: what has shrunk to a point is no longer off. Folds and cusps need it.
    by_place: bool,
}

fn attempt(
    layout: &Layout<'_>,
    options: &SurfaceOptions,
    care: Care,
) -> Result<Tessellation, TessellationError> {
    let edges = edge::sample_all(layout, options, care)?;
    let room = options.max_triangles.min(TooLarge::MOST);
    let made = crate::par::map_above(2, &layout.pieces, |piece| {
        piece::tessellate(layout, piece, &edges, options, care, room)
    });
    let mut tessellation = Tessellation {
        mesh: Mesh::new(edges.positions.clone(), Vec::new()),
        surfaces: Vec::new(),
        parameters: Vec::new(),
        error: Achieved { bound: Some(0.0), measured: 0.0 },
        edges: layout.edge_counts(),
    };
    for (piece, made) in layout.pieces.iter().zip(made) {
        append(&mut tessellation, piece.surface as u32, made?);
        let triangles = tessellation.mesh.triangles.len() as u64;
        if triangles > room {
            return Err(TessellationError::TooLarge { triangles, most: room });
        }
    }
    Ok(tessellation)
}

/// Adds the vertices and triangles of a piece.
fn append(all: &mut Tessellation, surface: u32, piece: piece::Made) {
    let base = all.mesh.positions.len() as u32;
    all.mesh.positions.extend(piece.positions);
    all.surfaces.extend(std::iter::repeat_n(surface, piece.triangles.len()));
    all.mesh.triangles.extend(piece.triangles.iter().map(|vertices| vertices.map(|v| v.resolved(base))));
    all.parameters.extend(piece.parameters);
    all.error.measured = all.error.measured.max(piece.measured);
    all.error.bound = all.error.bound.zip(piece.bound).map(|(a, b)| a.max(b));
}

fn check_options(options: &SurfaceOptions) -> Result<(), TessellationError> {
    let mut numbers = match options.precision {
        Precision::Distance(tolerance) => vec![("tolerance", tolerance)],
        Precision::View(View { pixel, pixels, nearest, .. }) => {
            vec![("pixel size", pixel), ("error in pixels", pixels), ("nearest distance", nearest)]
        }
    };
    numbers.extend(options.angle.map(|angle| ("angle", angle)));
    match numbers.into_iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
        Some((name, value)) => Err(TessellationError::Option { name, value }),
        None => Ok(()),
    }
}

impl Tessellation {
    /// Whether the distance that is told is more than was asked for everywhere alike.
    fn is_farther_than(&self, precision: Precision) -> bool {
        matches!(precision, Precision::Distance(tolerance) if self.error.measured > tolerance)
    }

    /// A unit normal for every corner of every triangle, those of poles as the limit from that triangle; corners of one
    /// surface at one vertex have the same, so smooth shading is smooth and edges between surfaces stay as they are.
    /// Where a surface has no normal it is that of the triangle.
    pub fn corner_normals(&self, surfaces: &[&dyn Surface]) -> Vec<[Vec3; 3]> {
        let indices: Vec<usize> = (0..self.mesh.triangles.len()).collect();
        crate::par::map(&indices, |&index| {
            let surface = surfaces[self.surfaces[index] as usize];
            let [a, b, c] = self.mesh.corners(index);
            let flat = (b - a).cross(c - a).normalize_or_zero();
            self.parameters[index].map(|[u, v]| surface.normal(u, v).unwrap_or(flat))
        })
    }
}
