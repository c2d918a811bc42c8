//! Everything a script finds there, in one table: help, suggestions and tests are printed from it.

mod color;
mod combine;
mod curves;
mod extrude;
mod fields;
mod lists;
mod math;
mod placement;
mod polyhedron;
mod primitive;
mod random;
mod search;
mod surfaces;
mod text;

pub(super) use random::Random;

use super::Failure;
use super::budget::Outcome;
use super::eval::{Fragmentation, Invocation, Machine, Made, Session};
use super::value::Value;

/// Something the language brings along.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub kind: BuiltinKind,
    /// Names of its parameters. Of a module, those before `positional` may be given without a name.
    pub parameters: &'static [&'static str],
    /// What it does, in one line.
    pub help: &'static str,
    pub(super) positional: usize,
    pub(super) action: Action,
}

/// What a builtin is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BuiltinKind {
    /// A module: it makes or changes shapes.
    Module,
    /// A function: it computes a value.
    Function,
    /// A variable that has a value from the start.
    Variable,
}

/// What a builtin does when it is called.
#[derive(Clone, Copy, Debug)]
pub(super) enum Action {
    Function(FunctionAction),
    /// A function whose arguments may be named; it gets a value for every parameter, `undef` where none was given.
    NamedFunction(NamedAction),
    Module(ModuleAction),
    /// Known to the grammar, or a variable.
    Nothing,
    /// OpenSCAD has it and we do not: to call it is an error.
    Missing,
}

type FunctionAction = fn(&mut Session<'_>, &[Value]) -> Outcome;
pub(super) type NamedAction = fn(&mut Session<'_>, &[Value], Fragmentation) -> Outcome;
type ModuleAction = for<'m, 'p> fn(&'m mut Machine<'p>, &'m Invocation<'m, 'p>) -> Result<Made, Failure>;

impl Builtin {
    /// Whether only its name is known: OpenSCAD has it, and calling it here is an error that says so.
    pub fn is_missing(&self) -> bool {
        matches!(self.action, Action::Missing)
    }
}

/// All builtins: modules, functions, variables, and what is missing.
pub fn builtins() -> impl Iterator<Item = &'static Builtin> {
    TABLES.iter().copied().flatten()
}

/// The builtin function of this name.
pub(super) fn function(name: &str) -> Option<&'static Builtin> {
    builtins().find(|builtin| builtin.kind == BuiltinKind::Function && builtin.name == name)
}

/// The builtin module of this name, be it there or missing.
pub(super) fn module(name: &str) -> Option<&'static Builtin> {
    builtins().find(|builtin| builtin.kind == BuiltinKind::Module && builtin.name == name)
}

pub(super) fn functions() -> impl Iterator<Item = &'static str> {
    builtins().filter(|builtin| builtin.kind == BuiltinKind::Function).map(|builtin| builtin.name)
}

pub(super) fn modules() -> impl Iterator<Item = &'static str> {
    builtins().filter(|builtin| builtin.kind == BuiltinKind::Module).map(|builtin| builtin.name)
}

pub(super) fn constants() -> impl Iterator<Item = &'static str> {
    builtins().filter(|builtin| builtin.kind == BuiltinKind::Variable).map(|builtin| builtin.name)
}

const TABLES: &[&[Builtin]] = &[
    primitive::TABLE,
    polyhedron::TABLE,
    placement::TABLE,
    color::TABLE,
    combine::TABLE,
    extrude::TABLE,
    math::TABLE,
    lists::TABLE,
    curves::TABLE,
    text::TABLE,
    random::TABLE,
    search::TABLE,
    surfaces::TABLE,
    fields::TABLE,
    VARIABLES,
    MISSING,
];

/// A row for a function.
const fn function_row(
    name: &'static str,
    parameters: &'static [&'static str],
    help: &'static str,
    action: FunctionAction,
) -> Builtin {
    let positional = parameters.len();
    Builtin {
        name,
        kind: BuiltinKind::Function,
        parameters,
        help,
        positional,
        action: Action::Function(action),
    }
}

/// A row for a function whose arguments may be named, and that asks for `$fn`, `$fa`, `$fs` and `$fe`.
const fn named_row(
    name: &'static str,
    parameters: &'static [&'static str],
    help: &'static str,
    action: NamedAction,
) -> Builtin {
    let positional = parameters.len();
    let kind = BuiltinKind::Function;
    Builtin { name, kind, parameters, help, positional, action: Action::NamedFunction(action) }
}

/// A row for a module, with the number of parameters that may be given without a name.
const fn module_row(
    name: &'static str,
    parameters: &'static [&'static str],
    positional: usize,
    help: &'static str,
    action: ModuleAction,
) -> Builtin {
    Builtin { name, kind: BuiltinKind::Module, parameters, help, positional, action: Action::Module(action) }
}

/// A row for what the grammar or the evaluator knows by itself.
const fn row(kind: BuiltinKind, name: &'static str, help: &'static str) -> Builtin {
    Builtin { name, kind, parameters: &[], help, positional: 0, action: Action::Nothing }
}

const fn variable(name: &'static str, help: &'static str) -> Builtin {
    row(BuiltinKind::Variable, name, help)
}

/// A row for what is not there yet.
const fn missing(kind: BuiltinKind, name: &'static str, help: &'static str) -> Builtin {
    Builtin { action: Action::Missing, ..row(kind, name, help) }
}

const VARIABLES: &[Builtin] = &[
    variable("PI", "Circumference of a circle of diameter 1."),
    variable("$fn", "Number of fragments of a full circle; 0 leaves it to $fa and $fs."),
    variable("$fa", "Least angle of a fragment, in degrees."),
    variable("$fs", "Least length of a fragment."),
    variable("$fe", "Largest distance of a fragment from its circle; 0 leaves it to $fa and $fs."),
    variable("$t", "Time of an animation, from 0 to 1."),
    variable("$vpr", "Rotation of the view, in degrees."),
    variable("$vpt", "Point the view looks at."),
    variable("$vpd", "Distance of the view."),
    variable("$vpf", "Field of view, in degrees."),
    variable("$preview", "Whether a picture is made for a quick look: always false."),
    variable("$children", "In a module, number of its children."),
    variable("$parent_modules", "Number of modules around."),
];

const MISSING: &[Builtin] = &[
    missing(BuiltinKind::Module, "text", "Letters as a plane shape."),
    missing(BuiltinKind::Module, "offset", "A plane shape grown or shrunk."),
    missing(BuiltinKind::Module, "minkowski", "The sum of shapes: one moved along all of another."),
    missing(BuiltinKind::Module, "projection", "The shadow or a cut of a solid."),
    missing(BuiltinKind::Module, "resize", "A shape scaled to a size."),
    missing(BuiltinKind::Module, "surface", "A solid below the heights of a grid or a picture."),
    missing(BuiltinKind::Module, "roof", "A roof over a plane shape."),
    missing(BuiltinKind::Module, "fill", "A plane shape without its holes."),
    missing(BuiltinKind::Function, "textmetrics", "Extents of a text."),
    missing(BuiltinKind::Function, "fontmetrics", "Extents of a font."),
    missing(BuiltinKind::Function, "import", "The data in a file."),
    missing(BuiltinKind::Function, "dxf_dim", "A dimension of a drawing."),
    missing(BuiltinKind::Function, "dxf_cross", "Where two lines of a drawing cross."),
    missing(BuiltinKind::Function, "object", "A value with named members."),
    missing(BuiltinKind::Function, "has_key", "Whether an object has a member."),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn names_are_unique_and_helped() {
        let mut seen = HashSet::new();
        for builtin in builtins() {
            assert!(seen.insert((builtin.kind, builtin.name)), "{} stands twice", builtin.name);
            assert!(
                builtin.help.ends_with('.') && builtin.help.len() < 110,
                "{}: {}",
                builtin.name,
                builtin.help
            );
            assert!(builtin.positional <= builtin.parameters.len(), "{}", builtin.name);
        }
    }
}
