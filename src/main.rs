//! The program `ogee`; everything it does is in [`ogee::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    ogee::cli::run()
}
