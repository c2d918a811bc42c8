//! From a formula to a solid.

use super::input::Source;
use super::meshing::{self, Clock};
use super::model::Times;
use super::stop::Stop;
use super::summary::Summary;
use super::terminal::Terminal;
use crate::io::vm;
use crate::isosurface::{self, IsoError, Meshed, Options};
use crate::math::{Aabb, Vec3};
use crate::mesh::Solid;
use crate::simplify;

/// What formulas are meshed by.
#[derive(clap::Args)]
#[command(next_help_heading = "Formulas (.vm)")]
pub(super) struct FormulaArgs {
    /// Where to look for the surface, and where to cut it off; found from the formula when not given
    #[arg(long = "box", value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = corners, allow_hyphen_values = true)]
    bounds: Option<Aabb>,
}

impl FormulaArgs {
    /// Whether anything was asked for that only formulas have.
    pub(super) fn is_given(&self) -> bool {
        self.bounds.is_some()
    }

    /// Reads the formula and meshes it.
    pub(super) fn build(
        &self,
        source: &Source,
        tolerance: Option<f64>,
        coarsen: bool,
        times: &mut Times,
        summary: &mut Summary,
        terminal: &Terminal,
    ) -> Result<Solid, Stop> {
        let Some(tolerance) = tolerance else {
            return Err(Stop::Usage(
                "a formula needs --tolerance, the greatest error of the mesh".to_owned(),
            ));
        };
        let formula = times.stage(terminal, "read", "reading", || {
            let bytes = source.bytes().map_err(|error| Stop::about(source, error))?;
            vm::read(&bytes).map_err(|error| Stop::about(source, error))
        })?;
        let options = Options { bounds: self.bounds, ..Options::new(tolerance) };
        let mut clock = Clock::default();
        let field = formula.compile();
        let meshed = isosurface::mesh_with_progress(&field, &options, &mut |stage| {
            terminal.stage(clock.start(stage));
        });
        let Meshed { mut mesh, mut report } = meshed.map_err(|error| explain(source, &error))?;
        let triangles_before = mesh.triangles().len();
        if coarsen {
            terminal.stage(clock.start_coarsening());
            let fewer = simplify::to_field(&field, &mesh, tolerance);
            mesh = fewer.mesh;
            report.measured = report.measured.max(fewer.measured);
        }
        times.append(&clock.into_times());
        meshing::warn(source, "the formula", &report, mesh.is_empty(), terminal);
        meshing::row(&report, triangles_before, summary);
        Ok(mesh)
    }
}

fn explain(source: &Source, error: &IsoError) -> Stop {
    let text = format!("{source}: {error}");
    match error {
        IsoError::TooManyCells { .. } => Stop::Limit(Some(text)),
        _ => Stop::Error(text),
    }
}

/// The box that was typed.
fn corners(text: &str) -> Result<Aabb, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse::<f64>()).collect();
    let numbers = numbers.map_err(|error| error.to_string())?;
    let [a, b, c, d, e, f] = numbers[..] else {
        return Err(format!("six numbers are needed, there are {}", numbers.len()));
    };
    Ok(Aabb { min: Vec3::new(a, b, c), max: Vec3::new(d, e, f) })
}
