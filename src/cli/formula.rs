//! From a formula to a solid.

use super::input::Source;
use super::model::Times;
use super::stop::Stop;
use super::summary::Summary;
use super::terminal::Terminal;
use crate::io::vm;
use crate::isosurface::{self, IsoError, Meshed, Options, Places, Report, Stage};
use crate::math::{Aabb, Vec3};
use crate::mesh::Solid;
use serde_json::json;
use std::time::Instant;

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
        let mut clock = Clock { times, running: None };
        let meshed = isosurface::mesh_with_progress(&formula.compile(), &options, &mut |stage| {
            terminal.stage(clock.start(stage));
        });
        clock.stop();
        let Meshed { mesh, report } = meshed.map_err(|error| explain(source, &error))?;
        warn(source, &mesh, &report, terminal);
        row(&report, summary);
        Ok(mesh)
    }
}

/// Seconds by stage; stages may come again.
struct Clock<'t> {
    times: &'t mut Times,
    running: Option<(&'static str, Instant)>,
}

impl Clock<'_> {
    /// Starts a stage and hands back what to show.
    fn start(&mut self, stage: Stage) -> &'static str {
        self.stop();
        let (name, doing) = match stage {
            Stage::Bounds => ("bounds", "looking for the box"),
            Stage::Refine => ("refine", "refining"),
            Stage::Extract => ("extract", "making triangles"),
            Stage::Certify => ("certify", "proving the tolerance"),
        };
        self.running = Some((name, Instant::now()));
        doing
    }

    fn stop(&mut self) {
        if let Some((name, since)) = self.running.take() {
            self.times.add(name, since.elapsed().as_secs_f64());
        }
    }
}

fn explain(source: &Source, error: &IsoError) -> Stop {
    let text = format!("{source}: {error}");
    match error {
        IsoError::TooManyCells { .. } => Stop::Limit(Some(text)),
        _ => Stop::Error(text),
    }
}

/// Says what a user should know before using the mesh.
fn warn(source: &Source, mesh: &Solid, report: &Report, terminal: &Terminal) {
    let say = |places: &Places, what: &str| {
        if let Some(first) = places.first.first() {
            let cells = if places.count == 1 { "cell" } else { "cells" };
            terminal.warn(format!("{source}: {} {cells} {what}, first at {}", places.count, first.center()));
        }
    };
    say(&report.unproven, "where the tolerance is not proven");
    say(&report.undefined, "where the formula has no value, taken for outside");
    say(&report.jumps, "where the sign changes by a jump");
    if mesh.is_empty() {
        say(&report.unsigned, "where the formula reaches zero but never becomes negative");
    }
    if report.capped > 0 {
        terminal.warn(format!("{source}: the shape leaves the box and is cut off there"));
    }
}

fn row(report: &Report, summary: &mut Summary) {
    summary.row(
        "surface",
        json!({
            "certified": report.certified,
            "measured": report.measured,
            "capped": report.capped,
            "cells": report.cells,
            "visited": report.visited,
            "unproven": report.unproven.count,
            "undefined": report.undefined.count,
            "jumps": report.jumps.count,
            "unsigned": report.unsigned.count,
        }),
    );
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
