//! What is told of meshes made of fields, and how long they took.

use super::model::Times;
use super::summary::Summary;
use super::terminal::Terminal;
use crate::csg::Meshing;
use crate::isosurface::{Places, Report, Stage};
use serde_json::json;
use std::fmt::Display;
use std::time::Instant;

/// Seconds by stage; stages may come again.
#[derive(Default)]
pub(super) struct Clock {
    times: Times,
    running: Option<(&'static str, Instant)>,
}

impl Clock {
    /// Starts a stage and hands back what to show.
    pub(super) fn start(&mut self, stage: Stage) -> &'static str {
        let (name, doing) = match stage {
            Stage::Bounds => ("bounds", "looking for the box"),
            Stage::Refine => ("refine", "refining"),
            Stage::Extract => ("extract", "making triangles"),
            Stage::Certify => ("certify", "proving the tolerance"),
        };
        self.run(name);
        doing
    }

    /// Starts to leave out triangles and hands back what to show.
    pub(super) fn start_coarsening(&mut self) -> &'static str {
        self.run("coarsen");
        "coarsening"
    }

    fn run(&mut self, name: &'static str) {
        self.stop();
        self.running = Some((name, Instant::now()));
    }

    /// Ends the stage that runs.
    pub(super) fn stop(&mut self) {
        if let Some((name, since)) = self.running.take() {
            self.times.add(name, since.elapsed().as_secs_f64());
        }
    }

    /// What all stages took.
    pub(super) fn into_times(mut self) -> Times {
        self.stop();
        self.times
    }
}

/// Says what a user should know before using a mesh. `what` is what was meshed, such as "the formula".
pub(super) fn warn(source: impl Display, what: &str, report: &Report, is_empty: bool, terminal: &Terminal) {
    let say = |places: &Places, problem: &str| {
        if let Some(first) = places.first.first() {
            let cells = if places.count == 1 { "cell" } else { "cells" };
            terminal.warn(format!(
                "{source}: {} {cells} {problem}, first at {}",
                places.count,
                first.center()
            ));
        }
    };
    say(&report.unproven, "where the tolerance is not proven");
    say(&report.undefined, &format!("where {what} has no value, taken for outside"));
    say(&report.jumps, &format!("where the sign of {what} changes by a jump"));
    if is_empty {
        say(&report.unsigned, &format!("where {what} reaches zero but never becomes negative"));
    }
    if report.capped > 0 {
        terminal.warn(format!("{source}: the shape leaves the box and is cut off there"));
    }
}

/// The row of a formula.
pub(super) fn row(report: &Report, triangles_before: usize, summary: &mut Summary) {
    summary.row(
        "surface",
        json!({
            "triangles before coarsening": triangles_before,
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

/// The row of all fields of a script together.
pub(super) fn rows(meshings: &[Meshing], summary: &mut Summary) {
    let sum = |count: fn(&Report) -> usize| meshings.iter().map(|m| count(&m.report)).sum::<usize>();
    let largest = |error: fn(&Meshing) -> f64| meshings.iter().map(error).fold(0.0, f64::max);
    summary.row(
        "fields",
        json!({
            "meshed": meshings.len(),
            "triangles": meshings.iter().map(|m| m.triangles).sum::<usize>(),
            "triangles before coarsening": meshings.iter().map(|m| m.triangles_before).sum::<usize>(),
            "error bound": largest(|m| m.error),
            "measured": largest(|m| m.report.measured),
            "uncertified": meshings.iter().filter(|m| m.report.certified.is_none()).count(),
            "capped": sum(|r| r.capped),
            "cells": sum(|r| r.cells),
            "visited": sum(|r| r.visited),
            "unproven": sum(|r| r.unproven.count),
            "undefined": sum(|r| r.undefined.count),
            "jumps": sum(|r| r.jumps.count),
            "unsigned": sum(|r| r.unsigned.count),
        }),
    );
}
