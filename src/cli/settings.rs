use super::host::FileHost;
use super::input;
use super::stop::Stop;
use super::terminal::{Style, Terminal};
use super::watchdog::Watchdog;
use crate::csg;
use crate::io::Format;
use crate::par;
use crate::script;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum, ValueHint};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Duration;

/// What every command understands.
#[derive(Args)]
#[command(next_help_heading = "Everywhere")]
pub(super) struct Settings {
    /// Print errors only: no echo, no warnings, no progress
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Print each message on one line, as OpenSCAD does
    #[arg(long, global = true)]
    oneline: bool,
    /// When to colour messages; `auto` means on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    color: Color,
    /// Number of threads; 0 means one per core
    #[arg(long, global = true, default_value_t = 0, value_name = "N")]
    jobs: usize,
}

#[derive(Clone, Copy, ValueEnum)]
enum Color {
    Auto,
    Always,
    Never,
}

impl Settings {
    /// Sets the number of threads and makes the terminal.
    pub(super) fn apply(&self) -> Terminal {
        par::set_threads(self.jobs);
        let on_terminal = std::io::stderr().is_terminal();
        let no_color = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let colored = match self.color {
            Color::Auto => on_terminal && !no_color,
            Color::Always => true,
            Color::Never => false,
        };
        let style = Style { colored, oneline: self.oneline };
        Terminal::new(style, self.quiet, on_terminal)
    }
}

/// What every command understands that may evaluate a script.
#[derive(Args)]
pub(super) struct ScriptArgs {
    /// Override a variable at the top level of the script; may be repeated
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = definition)]
    define: Vec<String>,
    /// Let the script read files in this folder too; may be repeated. Without it: the script's own folder and
    /// those in OPENSCADPATH
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    allow: Vec<PathBuf>,
    /// Take coordinates for equal that differ by less than this part of the model's size; 0 keeps all bits
    #[arg(long, value_name = "R", default_value = "1e-12", value_parser = resolution)]
    resolution: f64,
    /// Keep all triangles of meshed fields and formulas, also those that the tolerance does not need
    #[arg(long)]
    no_coarsen: bool,
    #[command(flatten, next_help_heading = "Limits")]
    limits: Limits,
}

fn resolution(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=0.001).contains(&value) { Ok(value) } else { Err("it must be from 0 to 0.001".to_owned()) }
}

#[derive(Args)]
struct Limits {
    /// Most steps of evaluation: statements, calls, elements of lists
    #[arg(long, value_name = "N", default_value_t = script::Options::default().max_steps)]
    limit_steps: u64,
    /// Deepest nesting of calls; tail calls are free
    #[arg(long, value_name = "N", default_value_t = script::Options::default().max_depth)]
    limit_depth: u32,
    /// Most memory for the script's values, in MiB
    #[arg(long, value_name = "MIB", default_value_t = script::Options::default().max_bytes >> 20)]
    limit_memory: u64,
    /// Most triangles of all shapes that take part, and of the result
    #[arg(long, value_name = "N", default_value_t = csg::BuildOptions::default().max_triangles)]
    limit_triangles: u64,
    /// Most time for evaluating and building, in seconds; none by default
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    limit_seconds: Option<Duration>,
}

impl ScriptArgs {
    /// The evaluator's options, with this first value of `$fe`.
    pub(super) fn options_within(&self, tolerance: f64) -> script::Options {
        script::Options { tolerance, ..self.options() }
    }

    /// The evaluator's options.
    pub(super) fn options(&self) -> script::Options {
        script::Options {
            define: self.define.clone(),
            max_steps: self.limits.limit_steps,
            max_depth: self.limits.limit_depth,
            max_bytes: self.limits.limit_memory.saturating_mul(1 << 20),
            ..script::Options::default()
        }
    }

    /// The builder's options.
    pub(super) fn build_options(&self) -> csg::BuildOptions {
        csg::BuildOptions {
            max_triangles: self.limits.limit_triangles,
            resolution: self.resolution,
            coarsen: !self.no_coarsen,
        }
    }

    /// The files that the script `main` may read.
    pub(super) fn host<'a>(
        &self,
        main: &input::Source,
        terminal: &'a Terminal,
    ) -> Result<FileHost<'a>, Stop> {
        let path = std::env::var_os("OPENSCADPATH").unwrap_or_default();
        let search: Vec<PathBuf> = std::env::split_paths(&path).collect();
        FileHost::new(main, &search, &self.allow, terminal)
    }

    /// Ends the process when it takes too long, until it is dropped.
    pub(super) fn watchdog(&self) -> Option<Watchdog> {
        self.limits.limit_seconds.map(Watchdog::start)
    }
}

/// Parses the name of a mesh format, and lists the names in the help.
pub(super) fn format() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::ALL.map(Format::name))
        .try_map(|name| Format::from_name(&name).ok_or_else(|| format!("no format is called {name}")))
}

/// Checks the form of `name=value`; the value is the script's to understand.
fn definition(text: &str) -> Result<String, String> {
    let name = text.split_once('=').map(|(name, _)| name.trim()).unwrap_or_default();
    let ordinary = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let plain = name.strip_prefix('$').unwrap_or(name);
    if !plain.is_empty() && plain.chars().all(ordinary) {
        Ok(text.to_owned())
    } else {
        Err("expected name=value, such as -D width=20 or -D 'label=\"A\"'".to_owned())
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions() {
        for fine in ["a=1", "$fn=50", "label=\"a=b\"", "v=[1,2]", "2d=true", "x="] {
            assert_eq!(definition(fine).as_deref(), Ok(fine));
        }
        for wrong in ["a", "=1", "a-b=1", "$=1", ""] {
            assert!(definition(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn spans_of_time() {
        assert_eq!(seconds("0.5"), Ok(Duration::from_millis(500)));
        for wrong in ["-1", "nan", "1e40", "soon"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}
