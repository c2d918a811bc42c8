//! From an input to a shape, with the time each stage took.

use super::input::Source;
use super::settings::ScriptArgs;
use super::stop::Stop;
use super::terminal::Terminal;
use crate::csg::{self, BuildError, Built, Progress};
use crate::isosurface::IsoError;
use crate::script::{self, Evaluated, Failure};
use serde_json::{Map, Value};
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
    let mut host = args.host(source, terminal)?;
    let main = host.main(source)?;
    script::evaluate(main, &mut host, &args.options()).map_err(|failure| match failure {
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
    let mut show = |progress: Progress| {
        terminal.stage(format!("building, {} of {} steps", progress.done, progress.total));
    };
    let built = times.stage(terminal, "build", "building", || {
        csg::build_with_progress(&evaluated.recipe, &args.build_options(), &mut show)
    });
    let built = built.map_err(|error| explain(source, &error, strict))?;
    built.report.notes.iter().for_each(|note| terminal.warn(note.to_string()));
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
