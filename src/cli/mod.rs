//! The program: paths, clock, environment, standard streams and progress live here and nowhere else.

use std::process::ExitCode;

/// Runs the program on the arguments of the process.
pub fn run() -> ExitCode {
    ExitCode::SUCCESS
}
