use super::arena::Arena;
use super::frame::is_finite;
use super::plan::{self, Spot, Uses};
use super::solve::Solver;
use super::{Body, Csg, Dimension, Flat, Meshing, Seams};
use crate::boolean::{BooleanError, Certificate};
use crate::isosurface::{self, IsoError};
use crate::math::Affine3;
use crate::mesh::{Defects, Solid, TooLarge};
use crate::numeric::Unfit;
use crate::polygon::{Region, RegionError};
use crate::sdf::BadNumber;
use crate::surface::SurfaceError;
use crate::tessellate::{CloseError, SweepError};
use std::fmt;

/// Red, green, blue and opacity, each from 0 to 1.
pub type Color = [f32; 4];

/// What bounds a build.
#[derive(Clone, Debug)]
pub struct BuildOptions {
    /// Most triangles of all leaves together, each counted as often as it takes part, and of any result. Vertices count
    /// instead of triangles where there are no triangles yet.
    pub max_triangles: u64,
    /// Coordinates that differ by less than about this part of the size of the whole model are taken for equal, so that
    /// parts which were meant to be flush, and miss each other by rounding errors (0.1 + 0.2 is not 0.3), leave no film
    /// and no gap. 0 keeps all bits.
    pub resolution: f64,
    /// Whether meshes of fields lose the triangles that their tolerance does not need.
    pub coarsen: bool,
}

impl Default for BuildOptions {
    /// Fifty million triangles; a resolution of 1e-12; no more triangles than needed.
    fn default() -> BuildOptions {
        BuildOptions { max_triangles: 50_000_000, resolution: 1e-12, coarsen: true }
    }
}

/// What a recipe makes.
#[derive(Clone, Debug)]
pub struct Built {
    /// The shape; the empty solid for a recipe of no dimension.
    pub shape: Shape,
    /// The colour of each triangle of a solid, `None` where it has none; empty where nothing has a colour.
    pub colors: Vec<Option<Color>>,
    /// How it went.
    pub report: Report,
}

/// A plane region or a solid.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A plane region.
    Region(Region),
    /// A solid.
    Solid(Solid),
}

/// How a build went.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Leaves, hulls and extrusions that were made; equal ones are made once.
    pub made: u64,
    /// Booleans that were taken.
    pub booleans: u64,
    /// Times something made before was used again instead of being made.
    pub reused: u64,
    /// Leaves that were left out, unmade, because they cannot matter.
    pub skipped: u64,
    /// What is known of all results of booleans together.
    pub certificate: Certificate,
    /// Meshes that were made of fields, in the order in which they were made.
    pub meshings: Vec<Meshing>,
    /// What became of the curves in which curved surfaces of fields cut what they are combined with.
    pub seams: Seams,
    /// What the user may want to know, each kind once.
    pub notes: Vec<Note>,
}

impl Report {
    pub(super) fn skip(&mut self, leaves: u64) {
        self.skipped = self.skipped.saturating_add(leaves);
    }

    pub(super) fn note(&mut self, note: Note) {
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }
}

/// Something about a recipe that is not wrong but may not be meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Note {
    /// A map flattens what it moves, which then encloses nothing.
    SingularMap,
    /// Plane regions and solids are mixed; only those of the first one's dimension take part.
    MixedDimensions,
    /// Faces so near each other that their triangles pass through each other once positions are rounded.
    CrossingsLeft,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Note::SingularMap => "a transform flattens its child, which then encloses nothing",
            Note::CrossingsLeft => {
                "parts miss each other by rounding errors only; some triangles of the result pass through each other"
            }
            Note::MixedDimensions => {
                "plane and solid children are mixed; those unlike the first are left out"
            }
        })
    }
}

/// Why a recipe could not be built.
#[derive(Clone, Debug, PartialEq)]
pub enum BuildError {
    /// A number is NaN or infinite, or became so.
    NonFinite {
        /// The kind of shape or map it belongs to.
        what: &'static str,
    },
    /// More triangles than [`BuildOptions::max_triangles`].
    Limit {
        /// How many there would be, at least.
        triangles: u64,
        /// How many there may be.
        most: u64,
    },
    /// Booleans nested too deeply, other than unions in unions and the like.
    TooDeep {
        /// Deepest nesting that is possible.
        most: u32,
    },
    /// A mesh does not bound a volume.
    NotClosed {
        /// What is wrong with it.
        defects: Box<Defects>,
    },
    /// A region could not be swept.
    Sweep(SweepError),
    /// Points of a hull are too far apart in size.
    Hull(Unfit),
    /// A surface could not be tessellated or closed.
    Surface(CloseError),
    /// What a surface is made of does not make one.
    Curves(SurfaceError),
    /// What a field is made of does not make one.
    Field(BadNumber),
    /// A field could not be meshed.
    Meshing(IsoError),
    /// More shapes in one field than can be told apart in reasonable time.
    TooManyShapes {
        /// How many there are.
        shapes: u64,
        /// How many there may be.
        most: u64,
    },
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuildError::NonFinite { what } => write!(f, "{what}: a number is not finite"),
            BuildError::Limit { triangles, most } => {
                write!(f, "{triangles} triangles or more, where {most} are allowed")
            }
            BuildError::TooDeep { most } => write!(f, "booleans are nested more than {most} deep"),
            BuildError::NotClosed { defects } => {
                let wrong = defects.rows().into_iter().filter(|&(_, count)| count > 0);
                let list: Vec<String> = wrong.map(|(name, count)| format!("{count} {name}")).collect();
                write!(f, "a mesh bounds no volume: {}", list.join(", "))
            }
            BuildError::Sweep(error) => error.fmt(f),
            BuildError::Hull(error) => write!(f, "hull: {error}"),
            BuildError::Surface(error) => error.fmt(f),
            BuildError::Curves(error) => error.fmt(f),
            BuildError::Field(error) => write!(f, "field: {error}"),
            BuildError::Meshing(error) => write!(f, "meshing a field: {error}"),
            BuildError::TooManyShapes { shapes, most } => {
                write!(f, "{shapes} shapes in one field, where {most} are allowed")
            }
        }
    }
}

impl std::error::Error for BuildError {}

impl From<SweepError> for BuildError {
    fn from(error: SweepError) -> BuildError {
        BuildError::Sweep(error)
    }
}

impl From<BadNumber> for BuildError {
    fn from(error: BadNumber) -> BuildError {
        BuildError::Field(error)
    }
}

impl From<IsoError> for BuildError {
    fn from(error: IsoError) -> BuildError {
        BuildError::Meshing(error)
    }
}

impl From<TooLarge> for BuildError {
    fn from(error: TooLarge) -> BuildError {
        BuildError::Limit { triangles: error.triangles, most: TooLarge::MOST }
    }
}

impl From<Unfit> for BuildError {
    fn from(error: Unfit) -> BuildError {
        match error {
            Unfit::NonFinite { .. } => BuildError::NonFinite { what: "hull" },
            Unfit::Range { .. } => BuildError::Hull(error),
        }
    }
}

impl From<RegionError> for BuildError {
    fn from(error: RegionError) -> BuildError {
        match error {
            RegionError::NotFinite { .. } => BuildError::NonFinite { what: "polygon" },
        }
    }
}

impl From<BooleanError> for BuildError {
    fn from(error: BooleanError) -> BuildError {
        match error {
            BooleanError::NotClosed { defects, .. } => BuildError::NotClosed { defects },
            BooleanError::NoSuchOperand { index, count } => {
                unreachable!("trees are made with their operands: {index} of {count}")
            }
        }
    }
}

/// How far a build has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Steps done.
    pub done: u64,
    /// Steps in all, as far as can be foreseen; never less than `done`.
    pub total: u64,
    /// What is being done.
    pub stage: Stage,
}

/// What a build is at, for those who measure time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Making shapes and joining them.
    Solids,
    /// Meshing a field.
    Fields(isosurface::Stage),
    /// Leaving out triangles of a field's mesh.
    Coarsen,
}

/// Cooks a recipe.
///
/// Bounding boxes decide first what can matter: the rest is never made, and what is far apart is never joined. Booleans in
/// booleans become one expression over the leaves, taken exactly; leaves are rounded once, where their maps put them, and
/// results once, on leaving. What is turned other than by right angles is solved before it is turned, together with its
/// siblings that are turned the same way.
///
/// ```
/// use ogee::boolean::Op;
/// use ogee::csg::{build, Body, BuildOptions, Csg, Shape};
/// use ogee::math::Vec3;
/// use std::sync::Arc;
///
/// let cube = |min: f64| Csg::Body(Body::Cuboid { min: Vec3::splat(min), max: Vec3::splat(min + 2.0) });
/// let notched = Csg::Combine { op: Op::Difference, children: vec![Arc::new(cube(0.0)), Arc::new(cube(1.0))] };
/// let built = build(&notched, &BuildOptions::default())?;
/// let Shape::Solid(solid) = built.shape else { panic!("a difference of cubes is a solid") };
/// assert_eq!(solid.positions().len(), 14);
/// # Ok::<(), ogee::csg::BuildError>(())
/// ```
///
/// # Errors
/// [`BuildError`].
pub fn build(recipe: &Csg, options: &BuildOptions) -> Result<Built, BuildError> {
    build_with_progress(recipe, options, &mut |_| ())
}

/// [`build`], with a call after every step and wherever the stage changes.
///
/// # Errors
/// [`BuildError`].
pub fn build_with_progress(
    recipe: &Csg,
    options: &BuildOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<Built, BuildError> {
    let arena = Arena::new(recipe);
    check_all(&arena)?;
    let uses = Uses::of(&arena);
    let spot = Spot { node: arena.root_id(), map: Affine3::IDENTITY, color: None };
    let mut report = Report::default();
    let plan = plan::plan(&arena, &uses, spot, &mut report)?;
    let total = plan.as_ref().map_or(0, plan::Plan::steps);
    let mut solver = Solver::new(&arena, &uses, options, report, progress, total);
    let is_flat = arena.root().dimension == Some(Dimension::Two);
    let (shape, colors) = match plan {
        None if is_flat => (Shape::Region(Region::default()), Vec::new()),
        None => (Shape::Solid(Solid::default()), Vec::new()),
        Some(plan) if is_flat => (Shape::Region(solver.region_of(&plan)?), Vec::new()),
        Some(plan) => {
            let (solid, colors) = solver.solid_of(&plan)?;
            (Shape::Solid(solid), colors)
        }
    };
    Ok(Built { shape, colors, report: solver.into_report() })
}

/// Refuses numbers that cannot be used.
pub(super) fn check_all(arena: &Arena<'_>) -> Result<(), BuildError> {
    arena.nodes().iter().try_for_each(|node| check_numbers(node.recipe))
}

fn check_numbers(recipe: &Csg) -> Result<(), BuildError> {
    let (what, is_sound) = match recipe {
        Csg::Nothing | Csg::Color { .. } | Csg::Combine { .. } | Csg::Hull { .. } => return Ok(()),
        // Sweeps check their own numbers, meshes and polygons are checked with their topology.
        Csg::LinearExtrude { .. } | Csg::RotateExtrude { .. } => return Ok(()),
        Csg::Transform { map, .. } => ("transform", is_finite(map)),
        Csg::Flat(Flat::Rectangle { min, max }) => ("square", min.is_finite() && max.is_finite()),
        Csg::Flat(Flat::Circle { radius, .. }) => ("circle", radius.is_finite()),
        Csg::Flat(Flat::Polygon { contours }) => {
            ("polygon", contours.iter().flatten().all(|point| point.is_finite()))
        }
        Csg::Body(Body::Cuboid { min, max }) => ("cube", min.is_finite() && max.is_finite()),
        Csg::Body(Body::Sphere { radius, .. }) => ("sphere", radius.is_finite()),
        Csg::Body(Body::Frustum { heights, radii, .. }) => {
            ("cylinder", heights.iter().chain(radii).all(|number| number.is_finite()))
        }
        Csg::Body(Body::Mesh(mesh)) => ("polyhedron", mesh.positions.iter().all(|point| point.is_finite())),
        Csg::Body(Body::Surface(surface)) => ("surface", surface.is_sound()),
        Csg::Body(Body::Field(field)) => return Ok(field.check()?),
        Csg::Blend { blend, tolerance, .. } => {
            ("smooth boolean", blend.size().is_finite() && tolerance.is_finite())
        }
        Csg::Offset { how, tolerance, .. } => {
            ("offset of a solid", how.size().is_finite() && tolerance.is_finite())
        }
    };
    if is_sound { Ok(()) } else { Err(BuildError::NonFinite { what }) }
}
