//! From a field to a closed mesh within a tolerance of its surface.
//!
//! [`mesh`] halves tetrahedra (Maubach 1995) until ranges prove them free of the surface or the piece of it within is
//! near enough to a polygon; creases and corners of the surface get vertices of their own. The mesh is closed,
//! two-manifold and free of self-crossings by construction, whatever the field: vertices lie strictly within edges,
//! faces and tetrahedra, and each tetrahedron's piece stays within it. What ranges cannot prove is said in the
//! [`Report`].

mod bounds;
mod certify;
mod cover;
mod crossing;
mod cubes;
mod extract;
mod lattice;
mod near;
mod patch;
mod refine;
mod tetrahedron;

use crate::math::{Aabb, Vec3};
use crate::mesh::{Defects, Solid};
use crate::sdf::Field;
use extract::{Extracted, extract};
use refine::{Refinement, Sizes};
use std::fmt;

pub use bounds::find_bounds;
pub use cubes::{GridMethod, mesh_on_grid};

/// What a meshing is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Greatest distance between mesh and surface, either way, in model units.
    pub tolerance: f64,
    /// Where to look, and where the solid is cut off; found from the field when absent.
    pub bounds: Option<Aabb>,
    /// Parts of the shape are searched for down to this size where the field proves nothing: what is thinner, and has
    /// ranges too wide to see it, may be missed and is then listed in [`Report::unproven`]. By default the longest
    /// side of the box over 128, or over 24 when the field brings no ranges.
    pub search: Option<f64>,
    /// Most tetrahedra held at a time, about 250 bytes each.
    pub most_cells: usize,
    /// Whether to prove the tolerance afterwards, and to refine where the proof fails.
    pub certify: bool,
}

impl Options {
    /// The defaults with this tolerance.
    pub fn new(tolerance: f64) -> Options {
        Options { tolerance, bounds: None, search: None, most_cells: 8_000_000, certify: true }
    }
}

/// A solid and what is known of it.
#[derive(Clone, Debug)]
pub struct Meshed {
    /// The solid: closed, two-manifold, free of self-crossings.
    pub mesh: Solid,
    /// How it went.
    pub report: Report,
}

/// How well a mesh stands for the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The box that was meshed.
    pub bounds: Aabb,
    /// Triangles on the box, where the shape leaves it.
    pub capped: usize,
    /// The proven bound of the distance between mesh and surface, either way and but for caps, places without a value and
    /// jumps: the tolerance. `None` when the field brings no ranges, no proof was asked for, or it failed somewhere.
    pub certified: Option<f64>,
    /// The greatest distance measured at the middles of triangles; no bound.
    pub measured: f64,
    /// Tetrahedra in the end.
    pub cells: usize,
    /// Tetrahedra looked at.
    pub visited: usize,
    /// Cells at which the tolerance is not proven: too small to refine, or of a shape whose ranges prove nothing.
    pub unproven: Places,
    /// Cells in which the field has no value.
    pub undefined: Places,
    /// Edges along which the sign changes by a jump, so that the mesh follows no zero there.
    pub jumps: Places,
    /// Cells in which the field reaches zero and does not become negative: no surface, since zero is outside.
    pub unsigned: Places,
}

/// How many there are, and where the first few are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// How many.
    pub count: usize,
    /// The first, at most 8.
    pub first: Vec<Aabb>,
}

impl Places {
    pub(crate) fn add(&mut self, place: Aabb) {
        self.count += 1;
        if self.first.len() < 8 {
            self.first.push(place);
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum IsoError {
    /// A tolerance or a size that is not positive and finite.
    BadNumber {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
    },
    /// A box that is empty, flat or not finite.
    BadBounds(Aabb),
    /// No box that holds the surface was found.
    Unbounded {
        /// Boxes up to this half side were tried; 0 when the field brings no ranges to try with.
        searched: f64,
    },
    /// The tolerance is below what numbers resolve at the box's place.
    TooFine {
        /// Asked for.
        tolerance: f64,
        /// The least that can be asked for in this box.
        least: f64,
    },
    /// More tetrahedra than allowed.
    TooManyCells {
        /// The limit.
        limit: usize,
    },
    /// The field's ranges do not hold its values: the mesh did not close.
    Contradiction(Defects),
    /// Surface nets in which two sheets share an edge, as they may where a face of the grid is passed twice.
    Pinched(Defects),
}

impl fmt::Display for IsoError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            IsoError::BadNumber { name, value } => {
                write!(f, "the {name} must be positive and finite, it is {value}")
            }
            IsoError::BadBounds(b) => {
                write!(f, "the box from {} to {} is empty, flat or not finite", b.min, b.max)
            }
            IsoError::Unbounded { searched: 0.0 } => {
                f.write_str("the field brings no ranges to find its bounds with; give a box")
            }
            IsoError::Unbounded { searched } => {
                write!(f, "no box up to half side {searched} is proven to hold the shape; give one")
            }
            IsoError::TooFine { tolerance, least } => {
                write!(
                    f,
                    "a tolerance of {tolerance} is too fine for numbers in this box; the least is {least:e}"
                )
            }
            IsoError::TooManyCells { limit } => {
                write!(f, "more than {limit} cells are needed; allow more, or a larger tolerance")
            }
            IsoError::Pinched(defects) => write!(
                f,
                "sheets share {} edges on this grid; use a finer one, or marching cubes",
                defects.non_manifold_edges
            ),
            IsoError::Contradiction(_) => {
                f.write_str("the field's ranges do not hold its values, so the mesh did not close")
            }
        }
    }
}

impl std::error::Error for IsoError {}

/// A stage of the work, for those who show progress or measure time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Looking for the box.
    Bounds,
    /// Halving tetrahedra.
    Refine,
    /// Making triangles.
    Extract,
    /// Proving the tolerance.
    Certify,
}

/// The closed mesh of a field's surface within a tolerance.
///
/// The solid is where the field is negative; zero is outside. Every vertex lies on the surface to within a
/// thousandth of the tolerance, but for those on creases. Time and memory grow with the area of the surface over the
/// tolerance times its radius of curvature.
///
/// ```
/// use ogee::isosurface::{self, Options};
/// use ogee::sdf::{Implicit, Primitive};
///
/// let ring = Implicit::primitive(Primitive::Torus { major: 0.8, minor: 0.25 })?;
/// let meshed = isosurface::mesh(&ring.tape(), &Options::new(0.01))?;
/// assert_eq!(meshed.mesh.measures().genus, Some(1));
/// assert_eq!(meshed.report.certified, Some(0.01));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Numbers that make no sense, no box where none is given and none can be proven, and limits; see [`IsoError`].
pub fn mesh(field: &dyn Field, options: &Options) -> Result<Meshed, IsoError> {
    mesh_with_progress(field, options, &mut |_| {})
}

/// [`mesh`], with a call at the start of each stage; some come more than once.
///
/// # Errors
/// As [`mesh`].
pub fn mesh_with_progress(
    field: &dyn Field,
    options: &Options,
    show: &mut dyn FnMut(Stage),
) -> Result<Meshed, IsoError> {
    check("tolerance", options.tolerance)?;
    show(Stage::Bounds);
    let bounds = match options.bounds {
        Some(bounds) => bounds::checked(bounds)?,
        None => find_bounds(field)?,
    };
    let found = bounds::tightened(field, bounds, options.bounds.is_none());
    let mut report = Report {
        bounds: found.bounds,
        capped: 0,
        certified: None,
        measured: 0.0,
        cells: 0,
        visited: 0,
        unproven: Places::default(),
        undefined: found.undefined,
        jumps: Places::default(),
        unsigned: found.unsigned,
    };
    if found.bounds.is_empty() {
        report.certified = Some(options.tolerance);
        return Ok(Meshed { mesh: Solid::default(), report });
    }
    let sizes = sizes(found.bounds, field.range(found.bounds).is_some(), options)?;
    let mut refinement = Refinement::new(field, found.bounds, sizes);
    show(Stage::Refine);
    refinement.run()?;
    show(Stage::Extract);
    let mut extracted = extract(&refinement);
    if options.certify && refinement.is_ranged() {
        let most = PROOF_GROWTH * (refinement.leaf_count() + 1000);
        loop {
            show(Stage::Certify);
            let mut proof = certify::prove(&refinement, &extracted);
            refinement.note_proven(&proof.proven);
            if proof.failed.is_empty() || refinement.leaf_count() > most {
                proof.give_up(&refinement);
                report.unproven = proof.unproven;
                break;
            }
            show(Stage::Refine);
            refinement.halve_leaves(&proof.failed)?;
            show(Stage::Extract);
            extracted = extract(&refinement);
        }
        report.certified = report.unproven.is_empty().then_some(options.tolerance);
    } else if refinement.is_ranged() {
        report.unproven = refinement.given_up();
    }
    report.complete(&refinement, &extracted);
    Ok(Meshed { mesh: closed(extracted)?, report })
}

impl Report {
    fn complete(&mut self, refinement: &Refinement<'_>, extracted: &Extracted) {
        self.capped = extracted.mesh.triangles.len() - extracted.caps_from;
        self.cells = refinement.leaf_count();
        self.visited = refinement.visited;
        self.measured = refinement.measured(extracted);
        self.jumps = refinement.jumps();
        for (whole, more) in
            [(&mut self.undefined, &refinement.undefined), (&mut self.unsigned, &refinement.unsigned)]
        {
            let room = 8_usize.saturating_sub(whole.first.len());
            whole.count += more.count;
            whole.first.extend(more.first.iter().take(room));
        }
    }
}

/// What is refined for the proof alone may multiply the cells by no more than this: ranges of some formulas (the cube of
/// a distance) prove nothing before cells are as small as the tolerance, though the mesh has long been good enough.
const PROOF_GROWTH: usize = 8;

/// The solid. That it does not cross itself follows from where its vertices are.
fn closed(extracted: Extracted) -> Result<Solid, IsoError> {
    let solid = Solid::new(extracted.mesh).map_err(IsoError::Contradiction)?;
    Ok(Solid::assume(solid.into_mesh(), true))
}

fn check(name: &'static str, value: f64) -> Result<(), IsoError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(IsoError::BadNumber { name, value }) }
}

/// Tetrahedra are not halved below this part of the largest coordinate: points within them must be told apart.
const FINEST: f64 = 1.0 / (1_u64 << 28) as f64;

fn sizes(bounds: Aabb, ranged: bool, options: &Options) -> Result<Sizes, IsoError> {
    let (longest, tolerance) = (bounds.size().max_element(), options.tolerance);
    let search = options.search.unwrap_or(longest / if ranged { 128.0 } else { 24.0 });
    check("search size", search)?;
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let finest = FINEST * largest;
    if tolerance < finest {
        return Err(IsoError::TooFine { tolerance, least: finest });
    }
    let least = (0.25 * tolerance).max(finest).min(search);
    Ok(Sizes { tolerance, search, least, most_cells: options.most_cells })
}

/// The corners of a box.
fn corners_of(bounds: Aabb) -> [Vec3; 8] {
    std::array::from_fn(|i| {
        Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 0 { bounds.min[k] } else { bounds.max[k] }))
    })
}
