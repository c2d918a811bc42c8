//! Files of Bézier patches: tessellated, closed, described.

use super::input::Source;
use super::output::{self, Output};
use super::stop::Stop;
use super::summary::Summary;
use crate::csg::{self, Body, Csg, Explicit, Shape, SurfaceBody};
use crate::io as formats;
use crate::math::{Aabb, Vec3};
use crate::mesh::{Measures, Mesh};
use crate::surface::{Patch, Surface, area};
use crate::tessellate::{
    Achieved, Guarantee, SurfaceOptions, TessellationError, patch_edges, patches as tessellate,
};
use std::sync::Arc;

/// What `build` understands of files of patches.
#[derive(clap::Args)]
#[command(next_help_heading = "Files of patches (.bpt)")]
pub(super) struct PatchArgs {
    /// Largest turn of edges and about that of normals from vertex to vertex, in degrees
    #[arg(long, value_name = "DEG")]
    angle: Option<f64>,
    /// Measure distances instead of proving them: fewer triangles
    #[arg(long)]
    measured: bool,
    /// Cap open borders and unite the parts: the result is a closed solid
    #[arg(long)]
    close: bool,
    /// Make a plate of this thickness: the result is a closed solid
    #[arg(long, value_name = "T", conflicts_with = "close")]
    thickness: Option<f64>,
}

/// What became of a file of patches.
pub(super) enum Made {
    /// An open mesh with a normal for every corner.
    Open { mesh: Mesh, normals: Vec<[Vec3; 3]>, error: Achieved },
    /// A solid.
    Closed(Mesh),
}

impl PatchArgs {
    /// Whether anything was asked for that only files of patches have.
    pub(super) fn is_given(&self) -> bool {
        let numbers = [self.angle, self.thickness];
        self.measured || self.close || numbers.iter().any(Option::is_some)
    }

    /// The mesh of patches.
    pub(super) fn make(
        &self,
        source: &Source,
        patches: Vec<Patch>,
        tolerance: Option<f64>,
        build: &csg::BuildOptions,
    ) -> Result<Made, Stop> {
        let tolerance = tolerance.unwrap_or_else(|| 1e-3 * hull(&patches).size().max_element());
        if self.close || self.thickness.is_some() {
            return self.closed(source, patches, tolerance, build);
        }
        let options = SurfaceOptions {
            angle: self.angle.map(f64::to_radians),
            guarantee: if self.measured { Guarantee::Measured } else { Guarantee::Proven },
            max_triangles: build.max_triangles,
            ..SurfaceOptions::within(tolerance)
        };
        let made = tessellate(&patches, &options).map_err(|error| explain(source, error))?;
        let surfaces: Vec<&dyn Surface> = patches.iter().map(|patch| patch as &dyn Surface).collect();
        let normals = made.corner_normals(&surfaces);
        Ok(Made::Open { mesh: made.mesh, normals, error: made.error })
    }

    fn closed(
        &self,
        source: &Source,
        patches: Vec<Patch>,
        tolerance: f64,
        build: &csg::BuildOptions,
    ) -> Result<Made, Stop> {
        let thickness = self.thickness;
        let body = SurfaceBody { shape: Explicit::Patches(patches), tolerance, thickness };
        let recipe = Csg::Body(Body::Surface(Arc::new(body)));
        let built = csg::build(&recipe, build).map_err(|error| match error {
            csg::BuildError::Limit { .. } => Stop::Limit(Some(format!("{source}: {error}"))),
            error => Stop::about(source, error),
        })?;
        match built.shape {
            Shape::Solid(solid) => Ok(Made::Closed(solid.into_mesh())),
            Shape::Region(_) => unreachable!("surfaces bound solids"),
        }
    }
}

impl Made {
    pub(super) fn mesh(&self) -> &Mesh {
        match self {
            Made::Open { mesh, .. } | Made::Closed(mesh) => mesh,
        }
    }

    /// Writes it; OBJ files of open meshes get the normals.
    pub(super) fn write(&self, outputs: &[Output]) -> Result<(), Stop> {
        match self {
            Made::Open { mesh, normals, .. } => output::write_with(outputs, mesh, Some(normals)),
            Made::Closed(mesh) => output::write(outputs, mesh),
        }
    }

    /// Adds its measures.
    pub(super) fn describe(&self, summary: &mut Summary) {
        summary.measures(&Measures::of(self.mesh()));
        if let Made::Open { error, .. } = self {
            summary.row("error bound", error.bound).row("error measured", error.measured);
        }
    }
}

/// A mesh that is fine enough to look at.
pub(super) fn shown(source: &Source, patches: &[Patch], build: &csg::BuildOptions) -> Result<Mesh, Stop> {
    let options = SurfaceOptions {
        max_triangles: build.max_triangles,
        ..SurfaceOptions::within(1e-3 * hull(patches).size().max_element())
    };
    Ok(tessellate(patches, &options).map_err(|error| explain(source, error))?.mesh)
}

fn explain(source: &Source, error: TessellationError) -> Stop {
    match error {
        TessellationError::TooLarge { .. } => Stop::Limit(Some(format!("{source}: {error}"))),
        error => Stop::about(source, error),
    }
}

fn hull(patches: &[Patch]) -> Aabb {
    patches.iter().map(Patch::hull_box).fold(Aabb::EMPTY, Aabb::union)
}

/// The patches in a file.
pub(super) fn read(source: &Source) -> Result<Vec<Patch>, Stop> {
    let bytes = source.bytes().map_err(|error| Stop::about(source, error))?;
    formats::bpt::read(&bytes).map_err(|error| Stop::about(source, error))
}

/// Adds what there is to say of patches: counts, box, area, and how they are joined.
pub(super) fn describe(source: &Source, patches: &[Patch], summary: &mut Summary) -> Result<(), Stop> {
    /// Share of the area, and of the box, to which they are right.
    const ACCURACY: f64 = 1e-9;
    let size = hull(patches).size().max_element();
    let edges = patch_edges(patches).map_err(|error| explain(source, error))?;
    let mut bounds = Aabb::EMPTY;
    let mut total = 0.0;
    for patch in patches {
        let own = patch.bounding_box((ACCURACY * size).max(f64::MIN_POSITIVE));
        bounds = bounds.union(own.map_err(|error| Stop::about(source, error))?);
        total += area(patch, ACCURACY);
    }
    let degrees = patches.iter().map(Patch::degrees).fold([0, 0], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
    summary.row("dimension", 3).row("patches", patches.len()).row("degrees", degrees.to_vec());
    summary.bounds(bounds).row("area", total);
    summary.row("edges", edges.all).row("edges used once", edges.used_once);
    summary.row("collapsed edges", edges.collapsed);
    Ok(())
}
