//! From an input to a shape, with the time each stage took.

use super::input::Source;
use super::settings::ScriptArgs;
use super::stop::Stop;
use super::terminal::Terminal;
use crate::mesh::Solid;
use crate::polygon::Region;
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
        doing: &'static str,
        work: impl FnOnce() -> R,
    ) -> R {
        terminal.stage(doing);
        let start = Instant::now();
        let result = work();
        self.stages.insert(name.to_owned(), start.elapsed().as_secs_f64().into());
        result
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

/// What a script makes.
pub(super) enum Shape {
    /// A plane region.
    Region(Region),
    /// A solid.
    Solid(Solid),
}

/// Evaluates the script in `source`.
pub(super) fn evaluate(source: &Source, args: &ScriptArgs, terminal: &Terminal) -> Result<(), Stop> {
    let mut host = args.host(source, terminal)?;
    let _ = (host.main(source)?, args.options());
    Err(Stop::about(source, "scripts cannot be evaluated yet"))
}

/// Evaluates the script in `source` and builds its shape.
pub(super) fn build(
    source: &Source,
    args: &ScriptArgs,
    times: &mut Times,
    terminal: &Terminal,
) -> Result<Shape, Stop> {
    let _watchdog = args.watchdog();
    times.stage(terminal, "evaluate", "evaluating", || evaluate(source, args, terminal))?;
    Ok(Shape::Solid(Solid::default()))
}
