use super::input::Source;
use super::model::{self, Times};
use super::settings::ScriptArgs;
use super::stop::Stop;
use super::terminal::Terminal;
use clap::ValueHint;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  ogee check bracket.scad
  ogee check --oneline bracket.scad -D width=-1";

/// Evaluate a script and print what it has to say; build nothing
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// The script; `-` reads it from standard input
    #[arg(value_name = "IN.scad", value_hint = ValueHint::FilePath)]
    input: PathBuf,
    #[command(flatten)]
    script: ScriptArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<(), Stop> {
    let source = Source::typed(&args.input);
    let _watchdog = args.script.watchdog();
    let mut times = Times::default();
    times.stage(terminal, "evaluate", "evaluating", || model::evaluate(&source, &args.script, terminal))?;
    let [warnings, _] = terminal.counts();
    terminal.note(format_args!("{source}: {warnings} warnings, {:.2} s", times.total()));
    Ok(())
}
