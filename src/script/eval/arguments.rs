//! Arguments of builtin modules.

use super::special::Fragmentation;
use super::statement::Context;
use super::{Failure, Machine, Made};
use crate::script::ast::{Argument, ModuleCall};
use crate::script::builtins::Builtin;
use crate::script::diagnostic::Span;
use crate::script::names::Symbol;
use crate::script::report::Complaint;
use crate::script::suggest;
use crate::script::value::Value;

/// Arguments by parameter.
pub(in crate::script) struct Bound {
    builtin: &'static Builtin,
    values: Vec<Option<Value>>,
}

impl Bound {
    /// The argument for a parameter; `None` where none was given or it is `undef`.
    pub(in crate::script) fn get(&self, parameter: &str) -> Option<&Value> {
        let index = self.builtin.parameters.iter().position(|name| *name == parameter)?;
        self.values[index].as_ref().filter(|value| !value.is_undef())
    }

    /// The argument if it is a number.
    pub(in crate::script) fn number(&self, parameter: &str) -> Option<f64> {
        self.get(parameter)?.number()
    }

    /// Whether the argument holds; `false` where there is none.
    pub(in crate::script) fn is_true(&self, parameter: &str) -> bool {
        self.get(parameter).is_some_and(Value::is_true)
    }
}

/// A call of a builtin module on its way.
pub(in crate::script) struct Invocation<'m, 'p> {
    pub(in crate::script) arguments: Bound,
    pub(in crate::script) span: Span,
    pub(super) call: &'p ModuleCall,
    pub(in crate::script) context: &'m Context<'p>,
}

impl<'p> Machine<'p> {
    /// Calls a builtin module; its `$` arguments hold for its children.
    pub(super) fn invoke(
        &mut self,
        builtin: &'static Builtin,
        action: ModuleAction,
        call: &'p ModuleCall,
        context: &Context<'p>,
        span: Span,
    ) -> Result<Made, Failure> {
        let mut arguments = Bound { builtin, values: vec![None; builtin.parameters.len()] };
        let mut special: Vec<(Symbol, Value)> = Vec::new();
        let mut unnamed = 0;
        for argument in &call.arguments {
            let value = self.eval(argument.value, &context.frame)?;
            match argument.name {
                Some(name) if name.is_special() => special.push((name, value)),
                name => self.bind_builtin(name, argument, value, &mut arguments, &mut unnamed),
            }
        }
        for (name, value) in special {
            self.specials.set(name, value);
        }
        action(self, &Invocation { arguments, span, call, context })
    }

    fn bind_builtin(
        &mut self,
        name: Option<Symbol>,
        argument: &Argument,
        value: Value,
        bound: &mut Bound,
        unnamed: &mut usize,
    ) {
        let builtin = bound.builtin;
        let index = match name {
            None => {
                *unnamed += 1;
                Some(*unnamed - 1).filter(|&index| index < builtin.positional)
            }
            Some(name) => builtin.parameters.iter().position(|known| *known == self.program.names.text(name)),
        };
        if let Some(index) = index {
            bound.values[index] = Some(value);
            return;
        }
        let Some(name) = name.map(|name| self.program.names.text(name)) else {
            let most = builtin.positional;
            return self
                .warn(argument.span, format!("{} takes {most} arguments without names", builtin.name));
        };
        let complaint =
            Complaint::warning(argument.span, format!("{} has no parameter {name}", builtin.name));
        self.say(match suggest::closest(name, builtin.parameters.iter().copied()) {
            Some(meant) => complaint.hint(format!("did you mean {meant}?")),
            None if builtin.parameters.is_empty() => complaint,
            None => complaint.hint(format!("its parameters are {}", builtin.parameters.join(", "))),
        });
    }

    /// The children of a call, one shape for each that makes any.
    pub(in crate::script) fn children_of(
        &mut self,
        invocation: &Invocation<'_, 'p>,
    ) -> Result<Made, Failure> {
        self.block(&invocation.call.children, invocation.context)
    }

    /// A value as it is printed, for messages.
    pub(in crate::script) fn shown_value(&mut self, value: &Value, span: Span) -> Result<String, Failure> {
        let mut text = String::new();
        self.print(value, span, &mut text)?;
        if text.len() > 60 {
            let cut = text.char_indices().nth(50).map_or(text.len(), |(index, _)| index);
            text.truncate(cut);
            text.push_str(" ...");
        }
        Ok(text)
    }

    /// The `$` variables that rule fragments.
    pub(in crate::script) fn fragmentation(&self) -> Fragmentation {
        self.specials.fragmentation()
    }

    /// What evaluation may still spend.
    pub(in crate::script) fn budget(&mut self) -> &mut crate::script::budget::Budget {
        &mut self.session.budget
    }

    /// The Bézier patches in a file, by the host.
    pub(in crate::script) fn host_patches(
        &mut self,
        name: &str,
        span: Span,
    ) -> Result<Vec<crate::surface::Patch>, String> {
        let from = self.files[span.file.0 as usize].name.clone();
        self.host.patches(name, &from)
    }

    /// The mesh in a file, by the host.
    pub(in crate::script) fn host_mesh(
        &mut self,
        name: &str,
        span: Span,
    ) -> Result<std::sync::Arc<crate::mesh::Mesh>, String> {
        let from = self.files[span.file.0 as usize].name.clone();
        self.host.mesh(name, &from)
    }
}

/// What a builtin module does.
type ModuleAction = for<'m, 'p> fn(&'m mut Machine<'p>, &'m Invocation<'m, 'p>) -> Result<Made, Failure>;
