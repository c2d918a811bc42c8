//! Modules that put their children together, and those the grammar knows.

use super::{Builtin, BuiltinKind, module_row, row};
use crate::boolean::Op;
use crate::script::Failure;
use crate::script::eval::{Invocation, Machine, Made};

pub(super) const TABLE: &[Builtin] = &[
    module_row("union", &[], 0, "All children as one.", join),
    module_row("difference", &[], 0, "The first child without the others.", |machine, call| {
        combine(machine, call, Op::Difference)
    }),
    module_row("intersection", &[], 0, "What all children have in common.", |machine, call| {
        combine(machine, call, Op::Intersection)
    }),
    module_row("hull", &[], 0, "The convex hull of all children together.", hull),
    module_row("group", &[], 0, "All children as one.", join),
    module_row("render", &["convexity"], 1, "All children as one; shapes are always computed in full.", join),
    module_row(
        "children",
        &["index"],
        1,
        "Children of the module: all, or those with these indices.",
        children,
    ),
    row(BuiltinKind::Module, "for", "The children for all values of the bindings, as one."),
    row(
        BuiltinKind::Module,
        "intersection_for",
        "What the children for all values of the bindings have in common.",
    ),
    row(BuiltinKind::Module, "let", "The children with the bindings in force."),
    row(BuiltinKind::Module, "assign", "The same as let, deprecated."),
    row(BuiltinKind::Module, "echo", "Prints its arguments."),
    row(BuiltinKind::Module, "assert", "Stops unless its first argument holds."),
];

fn join<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    combine(machine, call, Op::Union)
}

fn combine<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>, op: Op) -> Result<Made, Failure> {
    let children = machine.children_of(call)?;
    machine.combined(op, children, call.span)
}

fn hull<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let children = machine.children_of(call)?;
    machine.hulled(children, call.span)
}

fn children<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let made = machine.given_children(call.arguments.get("index"), call.span, call.context)?;
    machine.joined(made, call.span)
}
