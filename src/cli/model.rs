//! From an input to a shape, with the time each stage took.

use super::input::Source;
use super::meshing::{self, Clock};
use super::settings::ScriptArgs;
use super::stop::Stop;
use super::terminal::Terminal;
use crate::csg::{self, BuildError, Built, Csg, Meshing, Progress, Stage};
use crate::isosurface::IsoError;
use crate::script::{self, Evaluated, Failure};
use serde_json::{Map, Value};
use std::sync::Arc;
use std::time::Instant;

/// The seconds that each stage took, in order.
#[derive(Default)]
pub(super) struct Times {
    stages: Map<String, Value>,
}

impl Times {
    /// Does `work` as the stage `name`, which the terminal shows as `doing`.
    pub(super) fn stage<R>(
        &mut self,
        terminal: &Terminal,
        name: &str,
        doing: &str,
        work: impl FnOnce() -> R,
    ) -> R {
        terminal.stage(doing);
        let start = Instant::now();
        let result = work();
        self.stages.insert(name.to_owned(), start.elapsed().as_secs_f64().into());
        result
    }

    /// Adds to the seconds of a stage.
    pub(super) fn add(&mut self, name: &str, seconds: f64) {
        let before = self.stages.get(name).and_then(Value::as_f64).unwrap_or(0.0);
        self.stages.insert(name.to_owned(), (before + seconds).into());
    }

    /// Adds the seconds of stages.
    pub(super) fn append(&mut self, other: &Times) {
        other.stages.iter().for_each(|(name, seconds)| self.add(name, seconds.as_f64().unwrap_or(0.0)));
    }

    /// Names and seconds.
    pub(super) fn rows(&self) -> Map<String, Value> {
        self.stages.clone()
    }

    /// All stages together, in seconds.
    pub(super) fn total(&self) -> f64 {
        self.stages.values().filter_map(Value::as_f64).sum()
    }
}

/// Evaluates the script in `source`.
pub(super) fn evaluate(source: &Source, args: &ScriptArgs, terminal: &Terminal) -> Result<Evaluated, Stop> {
    evaluate_within(source, args, 0.0, terminal)
}

fn evaluate_within(
    source: &Source,
    args: &ScriptArgs,
    tolerance: f64,
    terminal: &Terminal,
) -> Result<Evaluated, Stop> {
    let mut host = args.host(source, terminal)?;
    let main = host.main(source)?;
    script::evaluate(main, &mut host, &args.options_within(tolerance)).map_err(|failure| match failure {
        Failure::Error => Stop::Explained,
        Failure::Limit => Stop::Limit(None),
    })
}

/// Evaluates the script in `source` and builds its shape. When `strict`, a mesh in it that is not closed is
/// [`Stop::NotClosed`].
pub(super) fn build(
    source: &Source,
    args: &ScriptArgs,
    strict: bool,
    times: &mut Times,
    terminal: &Terminal,
) -> Result<Built, Stop> {
    let _watchdog = args.watchdog();
    let evaluated = times.stage(terminal, "evaluate", "evaluating", || evaluate(source, args, terminal))?;
    build_recipe(source, &evaluated.recipe, args, strict, times, terminal)
}

/// The recipe of the script in `source`, evaluated with this first value of `$fe`.
pub(super) fn recipe(
    source: &Source,
    args: &ScriptArgs,
    tolerance: Option<f64>,
    times: &mut Times,
    terminal: &Terminal,
) -> Result<Arc<Csg>, Stop> {
    let tolerance = tolerance.unwrap_or(0.0);
    let work = || evaluate_within(source, args, tolerance, terminal);
    Ok(times.stage(terminal, "evaluate", "evaluating", work)?.recipe)
}

/// How a recipe will be built, in words.
pub(super) fn explanation(source: &Source, recipe: &Csg) -> Result<String, Stop> {
    csg::explain(recipe).map_err(|error| explain(source, &error, false))
}

/// Builds the shape of a recipe; what fields take has stages of its own. See [`build`].
pub(super) fn build_recipe(
    source: &Source,
    recipe: &Csg,
    args: &ScriptArgs,
    strict: bool,
    times: &mut Times,
    terminal: &Terminal,
) -> Result<Built, Stop> {
    let mut clock = Clock::default();
    let mut show = |Progress { done, total, stage }: Progress| {
        let doing = match stage {
            Stage::Fields(stage) => clock.start(stage),
            Stage::Coarsen => clock.start_coarsening(),
            Stage::Solids => {
                clock.stop();
                "building"
            }
        };
        terminal.stage(format!("{doing}, {done} of {total} steps"));
    };
    let built = times.stage(terminal, "build", "building", || {
        csg::build_with_progress(recipe, &args.build_options(), &mut show)
    });
    let fields = clock.into_times();
    times.add("build", -fields.total());
    times.append(&fields);
    let built = built.map_err(|error| explain(source, &error, strict))?;
    built.report.notes.iter().for_each(|note| terminal.warn(note.to_string()));
    for Meshing { report, triangles, .. } in &built.report.meshings {
        meshing::warn(source, "a field", report, *triangles == 0, terminal);
    }
    Ok(built)
}

fn explain(source: &Source, error: &BuildError, strict: bool) -> Stop {
    let text = format!("{source}: {error}");
    match error {
        BuildError::Limit { .. }
        | BuildError::TooDeep { .. }
        | BuildError::TooManyShapes { .. }
        | BuildError::Meshing(IsoError::TooManyCells { .. }) => Stop::Limit(Some(text)),
        BuildError::NotClosed { .. } if strict => Stop::NotClosed(text),
        BuildError::NotClosed { .. }
        | BuildError::NonFinite { .. }
        | BuildError::Sweep(_)
        | BuildError::Hull(_)
        | BuildError::Surface(_)
        | BuildError::Curves(_)
        | BuildError::Field(_)
        | BuildError::Meshing(_) => Stop::Error(text),
    }
}
