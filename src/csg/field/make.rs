//! Making fields and their meshes.

use super::faces::Surface;
use super::plan::{self, FieldPlan, Way, composed};
use crate::csg::arena::NodeId;
use crate::csg::build::{BuildError, Stage};
use crate::csg::plan::{self as solids, Spot};
use crate::csg::solve::{Leaf, Solver};
use crate::csg::{Csg, FieldBody};
use crate::isosurface::{self, Meshed, Options, Places};
use crate::math::{Aabb, Affine3, Vec3};
use crate::mesh::Solid;
use crate::sdf::{Implicit, greatest_stretch};
use crate::simplify;

/// A mesh that was made of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Meshing {
    /// Greatest distance of its faces from what was asked for, in model units: the tolerance of the mesh, and those of
    /// meshes whose distance was taken on the way, stretched as the maps around them do.
    pub error: f64,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of triangles before those were left out that the tolerance does not need.
    pub triangles_before: usize,
    /// How it went, and what could not be proven.
    pub report: isosurface::Report,
}

/// A field, and how far its surface may be from that of the recipe.
struct Made {
    field: Implicit,
    error: f64,
}

/// Most tetrahedra of a meshing: about a gigabyte.
const MOST_CELLS: u64 = 4_000_000;

/// Most edges of an outline: a point looks at all of them, and at a mesh in about the time of two hundred.
const MOST_EDGES: usize = 200;

/// Largest tolerance as a part of the size of the shape.
pub(super) const COARSEST: f64 = 1.0 / 16.0;

/// A mesh has about so many tetrahedra a triangle, at most.
const CELLS_A_TRIANGLE: u64 = 16;

impl Solver<'_, '_> {
    /// The mesh of a field that is a leaf.
    pub(in crate::csg) fn field_leaf(&mut self, node: NodeId, body: &FieldBody) -> Result<Leaf, BuildError> {
        if let Some(direct) = body.direct() {
            self.check_limit(direct.triangles())?;
            let solid = direct.solid()?;
            if let Some(error) = direct.error() {
                self.note_round(node, body, &solid, error);
            }
            let leaf = Leaf::of(solid);
            if !direct.is_round() {
                return Ok(leaf);
            }
            return Ok(leaf.near(Surface::new(body.implicit()?.tape(), body.tolerance)));
        }
        let field = body.implicit()?;
        let (bounds, cut) = (body.bounds(), body.cut());
        if bounds.is_empty() {
            return Ok(Leaf::of(Solid::default()));
        }
        let solid = self.meshed(node, &field, cut.unwrap_or(bounds), cut.is_some(), [body.tolerance, 0.0])?;
        Ok(Leaf::of(solid).near(Surface::new(field.tape(), body.tolerance)))
    }

    /// Reports a round body that was made without a search.
    fn note_round(&mut self, node: NodeId, body: &FieldBody, solid: &Solid, error: f64) {
        let report = isosurface::Report {
            bounds: body.bounds(),
            capped: 0,
            certified: Some(error),
            measured: error,
            cells: 0,
            visited: 0,
            unproven: Places::default(),
            undefined: Places::default(),
            jumps: Places::default(),
            unsigned: Places::default(),
        };
        let error = body.tolerance * self.stretch_of(node);
        let triangles = solid.triangles().len();
        self.report.meshings.push(Meshing { error, triangles, triangles_before: triangles, report });
    }

    /// The mesh of a smooth boolean or an offset.
    pub(in crate::csg) fn smooth_leaf(&mut self, node: NodeId) -> Result<Leaf, BuildError> {
        let tolerance = match self.arena.get(node).recipe {
            Csg::Blend { tolerance, .. } | Csg::Offset { tolerance, .. } => *tolerance,
            _ => unreachable!("only smooth operators are made so"),
        };
        let Some(plan) = plan::plan(self.arena, node, &mut self.report)? else {
            return Ok(Leaf::of(Solid::default()));
        };
        let Made { field, error } = self.field(node, &plan, tolerance)?;
        let bounds = self.arena.get(node).bounds;
        let solid = self.meshed(node, &field, bounds, false, [tolerance - error, error])?;
        Ok(Leaf::of(solid).near(Surface::new(field.tape(), tolerance)))
    }

    /// The field of a plan, good to half of `tolerance`, as a part of the leaf `node`.
    fn field(&mut self, node: NodeId, plan: &FieldPlan, tolerance: f64) -> Result<Made, BuildError> {
        if plan.is_formula {
            return Ok(Made { field: plan.promise().clone(), error: 0.0 });
        }
        match &plan.way {
            Way::Solved => {
                let solid = self.solved(plan.node)?;
                Ok(Made { field: distance(&solid)?, error: 0.0 })
            }
            Way::Extruded => Ok(Made { field: self.extruded(plan.node)?, error: 0.0 }),
            Way::Remeshed => {
                let part = self.field(node, &plan.parts[0], 0.5 * tolerance)?;
                let rest = 0.5 * tolerance - part.error;
                let solid =
                    self.meshed(node, &part.field, plan.parts[0].bounds, false, [rest, part.error])?;
                Ok(Made { field: distance(&solid)?, error: 0.5 * tolerance })
            }
            Way::Moved(map) => {
                let stretch = greatest_stretch(map.matrix3);
                let part = self.field(node, &plan.parts[0], tolerance / stretch)?;
                Ok(Made {
                    field: composed(&plan.way, &[part.field], &plan.parts)?,
                    error: part.error * stretch,
                })
            }
            way => {
                // Where gradients agree, a blend adds up the errors of both.
                let share = if matches!(way, Way::Smooth(..)) { 0.5 } else { 1.0 };
                let parts: Result<Vec<Made>, BuildError> =
                    plan.parts.iter().map(|part| self.field(node, part, share * tolerance)).collect();
                let parts = parts?;
                let error = parts.iter().map(|part| part.error).fold(0.0, f64::max) / share;
                let fields: Vec<Implicit> = parts.into_iter().map(|part| part.field).collect();
                Ok(Made { field: composed(way, &fields, &plan.parts)?, error })
            }
        }
    }

    /// The distance from an extrusion that goes straight up: by its outline, or by its mesh where that is long.
    fn extruded(&mut self, node: NodeId) -> Result<Implicit, BuildError> {
        let of = self.arena.get(node);
        let Csg::LinearExtrude { sweep, .. } = of.recipe else { unreachable!("only extrusions are made so") };
        let region = self.region(of.children[0])?;
        let edges: usize = region.contours().iter().map(Vec::len).sum();
        if edges > MOST_EDGES {
            return distance(&self.solved(node)?);
        }
        if edges == 0 {
            return Ok(Implicit::nothing());
        }
        let height = sweep.vector.z;
        let middle = if sweep.center { 0.0 } else { 0.5 * height };
        let field = Implicit::polygon(region.contours())?.extrude(0.5 * height.abs())?;
        Ok(if middle == 0.0 { field } else { field.translate(Vec3::new(0.0, 0.0, middle))? })
    }

    /// How much the maps above a field stretch it.
    fn stretch_of(&mut self, node: NodeId) -> f64 {
        let arena = self.arena;
        let known = self.stretches.get_or_insert_with(|| arena.stretches());
        known.get(&arena.get(node).key).copied().unwrap_or(1.0)
    }

    /// The solid of a node in its own coordinates.
    fn solved(&mut self, node: NodeId) -> Result<Solid, BuildError> {
        let spot = Spot { node, map: Affine3::IDENTITY, color: None };
        match solids::plan(self.arena, self.uses, spot, &mut self.report)? {
            Some(plan) => Ok(self.solid_of(&plan)?.0),
            None => Ok(Solid::default()),
        }
    }

    /// The mesh of a field whose inside lies within a box, or is cut off there, within a tolerance; `before` is how far
    /// the field itself may be off. It is the leaf `node`, or a part of it.
    fn meshed(
        &mut self,
        node: NodeId,
        field: &Implicit,
        bounds: Aabb,
        cut: bool,
        [tolerance, before]: [f64; 2],
    ) -> Result<Solid, BuildError> {
        let room = Aabb { min: field.bounds().min.max(bounds.min), max: field.bounds().max.min(bounds.max) };
        if room.is_empty() {
            return Ok(Solid::default());
        }
        // What is larger than a part of the shape itself would say nothing of it.
        let tolerance = tolerance.min(COARSEST * room.size().max_element());
        let known = Implicit::formula(field.expr().clone(), field.lipschitz(), margined(room));
        let most_cells = MOST_CELLS.min(self.max_triangles().saturating_mul(CELLS_A_TRIANGLE)) as usize;
        let options = Options { bounds: cut.then_some(bounds), most_cells, ..Options::new(tolerance) };
        let tape = known.tape();
        let meshed = isosurface::mesh_with_progress(&tape, &options, &mut |stage| {
            self.show(Stage::Fields(stage));
        });
        let Meshed { mut mesh, mut report } = meshed?;
        let triangles_before = mesh.triangles().len();
        if self.coarsens() {
            self.show(Stage::Coarsen);
            let fewer = simplify::to_field(&tape, &mesh, tolerance);
            mesh = fewer.mesh;
            report.measured = report.measured.max(fewer.measured);
        }
        self.show(Stage::Solids);
        let triangles = mesh.triangles().len();
        self.check_limit(triangles as u64)?;
        let error = (tolerance + before) * self.stretch_of(node);
        self.report.meshings.push(Meshing { error, triangles, triangles_before, report });
        Ok(mesh)
    }
}

/// The distance from a solid; everywhere outside where there is none.
fn distance(solid: &Solid) -> Result<Implicit, BuildError> {
    if solid.is_empty() { Ok(Implicit::nothing()) } else { Ok(Implicit::mesh(solid)?) }
}

/// A box larger by more than rounding.
fn margined(bounds: Aabb) -> Aabb {
    let margin = Vec3::splat(1e-9 * bounds.size().max_element());
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}
