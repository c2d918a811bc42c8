//! The program: paths, clock, environment, standard streams and progress live here and nowhere else.
//!
//! Each command is a file: what was typed (its `Args`), what is meant by it, and the doing. A new command is a new file
//! and a row of `Command`.

mod boolean;
mod build;
mod builtins;
mod check;
mod diagnostic;
mod eval;
mod formula;
mod host;
mod info;
mod input;
mod meshing;
mod model;
mod output;
mod patches;
mod plot;
mod render;
mod settings;
mod stop;
mod summary;
mod terminal;
mod watchdog;

use clap::{Parser, Subcommand};
use settings::Settings;
use std::process::ExitCode;
use stop::Stop;
use terminal::Terminal;

const EXIT_CODES: &str = "\
Exit codes:
  0  fine
  1  an error in the script, the input or while writing
  2  a command line that makes no sense
  3  a limit was reached
  4  the result is not closed (--strict)";

/// Solid modelling from scripts: OpenSCAD's language in, watertight meshes out.
#[derive(Parser)]
#[command(name = "ogee", version, after_help = EXIT_CODES, max_term_width = 110)]
struct Typed {
    #[command(flatten)]
    settings: Settings,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Build(build::Args),
    Check(check::Args),
    Info(info::Args),
    Render(Box<render::Args>),
    Plot(Box<plot::Args>),
    Boolean(boolean::Args),
    Eval(eval::Args),
    Builtins(builtins::Args),
}

impl Command {
    fn run(&self, terminal: &Terminal) -> Result<(), Stop> {
        match self {
            Command::Build(args) => build::run(args, terminal),
            Command::Check(args) => check::run(args, terminal),
            Command::Info(args) => info::run(args, terminal),
            Command::Render(args) => render::run(args, terminal),
            Command::Plot(args) => plot::run(args, terminal),
            Command::Boolean(args) => boolean::run(args, terminal),
            Command::Eval(args) => eval::run(args, terminal),
            Command::Builtins(args) => builtins::run(args),
        }
    }
}

/// Runs the program on the arguments of the process.
pub fn run() -> ExitCode {
    let typed = match Typed::try_parse() {
        Ok(typed) => typed,
        Err(help_or_error) => {
            // Nobody is left to tell when this cannot be printed.
            let _ = help_or_error.print();
            return ExitCode::from(help_or_error.exit_code() as u8);
        }
    };
    let terminal = typed.settings.apply();
    let result = typed.command.run(&terminal);
    terminal.close();
    if let Err(stop) = &result {
        terminal.explain(stop);
    }
    ExitCode::from(result.map_or_else(|stop| stop.code(), |()| 0))
}
