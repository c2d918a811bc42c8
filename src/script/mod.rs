//! The script language: text to recipe.
//!
//! The language is OpenSCAD's. Evaluating a script makes a [`Csg`] recipe and never a mesh; what it needs from outside
//! (the texts of other files, meshes) it asks of a [`Host`], and what it has to say on the way (echo, warnings, errors)
//! it hands to the host as a [`Message`].
//!
//! ```
//! use ogee::script::{Host, Loaded, Message, Options, evaluate};
//!
//! struct Alone(Vec<String>);
//!
//! impl Host for Alone {
//!     fn script(&mut self, name: &str, _from: &str) -> Result<Loaded, String> {
//!         Err(format!("{name} cannot be read here"))
//!     }
//!     fn mesh(&mut self, name: &str, _from: &str) -> Result<std::sync::Arc<ogee::mesh::Mesh>, String> {
//!         Err(format!("{name} cannot be read here"))
//!     }
//!     fn say(&mut self, message: Message) {
//!         self.0.push(message.text);
//!     }
//! }
//!
//! let text = "module ring(n) for (i = [1:n]) rotate(360 * i / n) translate([9, 0]) cube(1); ring(5); echo(sin(30));";
//! let mut host = Alone(Vec::new());
//! let main = Loaded { name: "ring.scad".into(), text: text.into() };
//! let evaluated = evaluate(main, &mut host, &Options::default()).expect("the script is right");
//! assert!(evaluated.recipe.dimension().is_some());
//! assert_eq!(host.0, ["0.5"]);
//! ```
//!
//! The stages stand in files of their own: `lexer`, `source` (includes), `parser`, `ast`, `resolve` (names to
//! slots), `eval`, and `builtins`, one table from which help is printed.
//!
//! # Where it differs from OpenSCAD
//!
//! The grammar is that of the development snapshots; where they and the release 2021.01 differ in meaning, the
//! snapshots are followed (a range that counts down without a step is empty; a function value keeps the variables of
//! its own round of a loop; in one scope a named function comes before a variable).
//!
//! - The same script always makes the same: `rands` without a seed starts from a fixed one.
//! - A number too large, an open polyhedron, a missing file for `import` and a failed limit stop the script.
//! - A polyhedron that is inside out is turned, with a warning.
//! - What is not there yet ([`Builtin::is_missing`]) is an error that names it.
//! - Variables of a used file are computed once, when they are first needed.
//! - `$preview` is always false, and `version()` is that of the release whose language is complete here.
//! - Ranges may have any number of values; [`Options::max_steps`] bounds them.

mod ast;
mod budget;
mod builtins;
mod degrees;
mod diagnostic;
mod eval;
mod extent;
mod facets;
mod format;
mod formula;
mod heap;
mod lexer;
mod names;
mod operators;
mod parser;
mod report;
mod resolve;
mod source;
mod stack;
mod suggest;
#[cfg(test)]
mod tests;
mod value;

pub use builtins::{Builtin, BuiltinKind, builtins};
pub use diagnostic::{FileId, Frame, Label, Message, Severity, Span};

use crate::csg::Csg;
use crate::mesh::Mesh;
use crate::surface::Patch;
use std::sync::Arc;

/// What a script asks of the world around it.
pub trait Host {
    /// The text of the script `name` as written in an `include` or `use` of the file `from`, with the name by which
    /// the same file is known however it was reached.
    ///
    /// # Errors
    /// A sentence for the user: not found, not text, not allowed.
    fn script(&mut self, name: &str, from: &str) -> Result<Loaded, String>;

    /// The mesh in the file `name` as written in an `import` of the file `from`.
    ///
    /// # Errors
    /// A sentence for the user: not found, not a mesh, not allowed.
    fn mesh(&mut self, name: &str, from: &str) -> Result<Arc<Mesh>, String>;

    /// The Bézier patches in the file `name` as written in a `bezier_surface` of the file `from`; by default there are
    /// none.
    ///
    /// # Errors
    /// As [`Host::mesh`].
    fn patches(&mut self, _name: &str, _from: &str) -> Result<Vec<Patch>, String> {
        Err("files of patches cannot be read here".to_owned())
    }

    /// Takes what the script says, in order: echoes, warnings, errors.
    fn say(&mut self, message: Message);
}

/// The text of a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loaded {
    /// Its one name, for cycles, traces and for finding what it names in turn.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// What bounds an evaluation and sets its stage.
#[derive(Clone, Debug)]
pub struct Options {
    /// Assignments that override those at the top level of the script, each `name=expression`.
    pub define: Vec<String>,
    /// Value of `$t`.
    pub time: f64,
    /// First value of `$fe`, the largest distance of fragments from what they stand for; 0 leaves it to `$fa` and `$fs`.
    pub tolerance: f64,
    /// Most steps (statements, calls, elements of lists) before evaluation stops with [`Failure::Limit`].
    pub max_steps: u64,
    /// Deepest nesting of calls that are not tail calls.
    pub max_depth: u32,
    /// Most bytes of values alive at once, roughly counted.
    pub max_bytes: u64,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            define: Vec::new(),
            time: 0.0,
            tolerance: 0.0,
            max_steps: 200_000_000,
            max_depth: 20_000,
            max_bytes: 2 << 30,
        }
    }
}

/// What a script makes.
#[derive(Clone, Debug)]
pub struct Evaluated {
    /// The shape: what the script builds at its top level, joined.
    pub recipe: Arc<Csg>,
    /// What is marked with `#` or `%`, to be shown beside the shape.
    pub shown: Vec<Arc<Csg>>,
    /// The texts that took part; a [`FileId`] is an index into them.
    pub files: Vec<Loaded>,
}

/// Why there is no recipe. The message that says it has gone to [`Host::say`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The script is wrong.
    Error,
    /// A limit of [`Options`] was reached.
    Limit,
}

/// Evaluates the script `main` and all that it includes and uses.
///
/// # Errors
/// When the script is wrong or takes more than `options` allow; the host has been told why, and where.
pub fn evaluate(main: Loaded, host: &mut dyn Host, options: &Options) -> Result<Evaluated, Failure> {
    let source::Source { mut program, files, mut complaints } = source::load(main, &options.define, host);
    let files = Arc::new(files);
    let broken = complaints.iter().any(|complaint| complaint.severity == Severity::Error);
    let suggestions =
        if broken { Default::default() } else { resolve::resolve(&mut program, &mut complaints) };
    let failed = complaints.iter().any(|complaint| complaint.severity == Severity::Error);
    for complaint in complaints {
        host.say(complaint.into_message(Vec::new(), files.clone()));
    }
    if failed {
        return Err(Failure::Error);
    }
    eval::run(&program, &suggestions, files, host, options)
}
