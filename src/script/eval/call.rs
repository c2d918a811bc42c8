//! Calls of functions.

use super::expression::{ancestor, room};
use super::{Failure, Machine, Running, What};
use crate::script::ast::{
    Argument, Call, Callee, Expr, ExprId, FunctionId, Home, Parameter, Room, Slot, Target, UnitId,
};
use crate::script::budget::{Fault, Outcome};
use crate::script::builtins::{Action, Builtin, NamedAction};
use crate::script::diagnostic::Span;
use crate::script::names::Symbol;
use crate::script::report::Complaint;
use crate::script::value::{Frame, Value};
use std::rc::Rc;

/// A function found for a call.
enum Found {
    Function(Ready),
    Builtin(&'static Builtin),
    Nothing,
}

/// A function of the script with the frame around it.
struct Ready {
    function: FunctionId,
    around: Option<Rc<Frame>>,
    unit: UnitId,
}

/// A call with its arguments in place.
pub(super) struct Pending {
    pub(super) function: FunctionId,
    pub(super) frame: Rc<Frame>,
    pub(super) unit: UnitId,
    pub(super) span: Span,
}

/// What an expression at the end of a function comes to: its value, or a call that has it.
enum Tail {
    Value(Value),
    Call(Pending),
}

impl<'p> Machine<'p> {
    /// The value of a call.
    pub(super) fn call(&mut self, call: &'p Call, id: ExprId, frame: &Rc<Frame>) -> Result<Value, Failure> {
        let span = self.program.span(id);
        match self.find(call, span, frame)? {
            Found::Function(ready) => {
                let mark = self.specials.mark();
                let pending = self.prepare(ready, call, span, frame)?;
                let value = self.run(pending)?;
                self.specials.restore(mark);
                Ok(value)
            }
            Found::Builtin(builtin) => self.call_builtin(builtin, &call.arguments, span, frame),
            Found::Nothing => Ok(Value::Undef),
        }
    }

    /// What is called; a warning where that is nothing.
    fn find(&mut self, call: &'p Call, span: Span, frame: &Rc<Frame>) -> Result<Found, Failure> {
        let (name, variable, function) = match &call.callee {
            Callee::Value(value) => {
                let value = self.eval(*value, frame)?;
                return Ok(self.found(&value).unwrap_or_else(|| {
                    self.warn(span, format!("{} cannot be called, only functions can", value.kind()));
                    Found::Nothing
                }));
            }
            Callee::Name { name, variable, function } => (*name, variable, function),
        };
        if let Some(value) = self.look_up(name, variable, frame)?
            && let Some(found) = self.found(&value)
        {
            return Ok(found);
        }
        Ok(match *function {
            Target::Builtin(builtin) => Found::Builtin(builtin),
            Target::User { id, home } => {
                let (around, unit) = self.home(home, frame)?;
                Found::Function(Ready { function: id, around: Some(around), unit })
            }
            Target::Unknown => {
                let text = format!("unknown function {}", self.program.names.text(name));
                let complaint = Complaint::warning(span, text);
                self.say(Self::did_you_mean(complaint, self.suggestions.functions.get(&name)));
                Found::Nothing
            }
        })
    }

    fn found(&self, value: &Value) -> Option<Found> {
        let Value::Function(closure) = value else { return None };
        let around = Some(closure.frame.clone());
        Some(Found::Function(Ready { function: closure.function, around, unit: self.unit }))
    }

    /// The frame in which something was defined, and the unit its code belongs to.
    pub(super) fn home(&mut self, home: Home, frame: &Rc<Frame>) -> Result<(Rc<Frame>, UnitId), Failure> {
        Ok(match home {
            Home::Up(up) => (ancestor(frame, up).clone(), self.unit),
            Home::Unit(unit) => (self.unit_frame(unit)?, unit),
        })
    }

    /// Evaluates the arguments of a call and puts them in place.
    fn prepare(
        &mut self,
        ready: Ready,
        call: &'p Call,
        span: Span,
        frame: &Rc<Frame>,
    ) -> Result<Pending, Failure> {
        let function = &self.program[ready.function];
        let Ready { around, unit, .. } = ready;
        let inner = Frame::new(function.frame, around);
        self.enter_unit(unit);
        self.bind(&function.parameters, &call.arguments, &inner, frame, span)?;
        Ok(Pending { function: ready.function, frame: inner, unit, span })
    }

    /// Puts the `$` variables of another unit in force when its code is called.
    pub(super) fn enter_unit(&mut self, unit: UnitId) {
        if unit != self.unit {
            for (name, value) in self.units[unit.0 as usize].specials.clone() {
                self.specials.set(name, value);
            }
        }
    }

    /// Evaluates `arguments` in `outer` and puts them into the parameters' slots of `inner`.
    pub(super) fn bind(
        &mut self,
        parameters: &'p [Parameter],
        arguments: &'p [Argument],
        inner: &Rc<Frame>,
        outer: &Rc<Frame>,
        span: Span,
    ) -> Result<(), Failure> {
        let mut given = Given { special: Vec::new(), unnamed: 0 };
        for argument in arguments {
            let value = self.eval(argument.value, outer)?;
            self.bind_one(parameters, argument, value, inner, &mut given);
        }
        for parameter in parameters {
            if !given.has(parameter, inner) {
                let value = match (parameter.default, &inner.parent) {
                    (Some(default), Some(around)) => self.eval(default, around)?,
                    _ => Value::Undef,
                };
                match parameter.slot {
                    Slot::Local(slot) => inner.set(slot, Some(value)),
                    Slot::Special => given.special.insert(0, (parameter.name, value)),
                }
            }
        }
        for (name, value) in given.special {
            self.specials.set(name, value);
        }
        self.step(span)
    }

    fn bind_one(
        &mut self,
        parameters: &[Parameter],
        argument: &Argument,
        value: Value,
        inner: &Rc<Frame>,
        given: &mut Given,
    ) {
        let index = match argument.name {
            None => {
                given.unnamed += 1;
                Some(given.unnamed - 1).filter(|&index| index < parameters.len())
            }
            Some(name) => parameters.iter().position(|parameter| parameter.name == name),
        };
        match (index, argument.name) {
            (Some(index), _) => {
                if given.has(&parameters[index], inner) {
                    let name = self.program.names.text(parameters[index].name);
                    self.warn(
                        argument.span,
                        format!("the argument {name} is given twice; the last one counts"),
                    );
                }
                match parameters[index].slot {
                    Slot::Local(slot) => inner.set(slot, Some(value)),
                    Slot::Special => given.special.push((parameters[index].name, value)),
                }
            }
            (None, Some(name)) if name.is_special() => given.special.push((name, value)),
            (None, Some(name)) => self.warn_of_unknown_parameter(name, parameters, argument.span),
            (None, None) => {
                let text = format!("too many arguments: there are {} parameters", parameters.len());
                self.warn(argument.span, text);
            }
        }
    }

    fn warn_of_unknown_parameter(&mut self, name: Symbol, parameters: &[Parameter], span: Span) {
        let names = &self.program.names;
        let known: Vec<&str> = parameters.iter().map(|parameter| names.text(parameter.name)).collect();
        self.warn_of_unknown_name(names.text(name), &known, span);
    }

    fn warn_of_unknown_name(&mut self, name: &str, known: &[&str], span: Span) {
        let hint = match crate::script::suggest::closest(name, known.iter().copied()) {
            Some(meant) => format!("did you mean {meant}?"),
            None if known.is_empty() => "there are no parameters".to_owned(),
            None => format!("the parameters are {}", known.join(", ")),
        };
        self.say(Complaint::warning(span, format!("there is no parameter {name}")).hint(hint));
    }

    /// Runs a call and all that it ends in.
    pub(super) fn run(&mut self, mut pending: Pending) -> Result<Value, Failure> {
        let entered = self.session.budget.enter_call();
        self.allow(entered, pending.span)?;
        let outer = self.unit;
        let depth = self.calls.len();
        let value = loop {
            let function = &self.program[pending.function];
            self.unit = pending.unit;
            self.calls.truncate(depth);
            self.calls.push(Running { what: What::Function(function.name), span: pending.span });
            match self.tail(function.body, pending.frame)? {
                Tail::Value(value) => break value,
                Tail::Call(next) => pending = next,
            }
        };
        self.calls.truncate(depth);
        self.unit = outer;
        self.session.budget.leave_call();
        Ok(value)
    }

    /// Evaluates an expression at the end of a function, up to a call that has its value.
    fn tail(&mut self, mut id: ExprId, mut frame: Rc<Frame>) -> Result<Tail, Failure> {
        let program = self.program;
        loop {
            match &program[id] {
                Expr::Conditional { condition, then, otherwise } => {
                    id = match self.eval(*condition, &frame)? {
                        Value::Formula(condition) => {
                            return self.either(&condition, *then, *otherwise, id, &frame).map(Tail::Value);
                        }
                        condition if condition.is_true() => *then,
                        _ => *otherwise,
                    };
                }
                Expr::Let(inner) if inner.bindings.iter().all(|b| matches!(b.slot, Slot::Local(_))) => {
                    if let Room::Own(_) = inner.room {
                        frame = room(inner.room, &frame);
                    }
                    self.bind_all(&inner.bindings, &frame)?;
                    id = inner.body;
                }
                Expr::Assert { arguments, body: Some(body) } => {
                    self.assert(arguments, program.span(id), &frame)?;
                    id = *body;
                }
                Expr::Echo { arguments, body: Some(body) } => {
                    self.echo(arguments, program.span(id), &frame)?;
                    id = *body;
                }
                Expr::Call(call) if !call.has_special => return self.tail_call(call, id, &frame),
                _ => return self.eval(id, &frame).map(Tail::Value),
            }
        }
    }

    fn tail_call(&mut self, call: &'p Call, id: ExprId, frame: &Rc<Frame>) -> Result<Tail, Failure> {
        let span = self.program.span(id);
        match self.find(call, span, frame)? {
            Found::Builtin(builtin) => {
                self.call_builtin(builtin, &call.arguments, span, frame).map(Tail::Value)
            }
            Found::Nothing => Ok(Tail::Value(Value::Undef)),
            Found::Function(ready) => {
                let parameters = &self.program[ready.function].parameters;
                let has_special = parameters.iter().any(|parameter| parameter.slot == Slot::Special);
                let enters =
                    ready.unit != self.unit && !self.units[ready.unit.0 as usize].specials.is_empty();
                let mark = self.specials.mark();
                let pending = self.prepare(ready, call, span, frame)?;
                if !has_special && !enters {
                    return Ok(Tail::Call(pending));
                }
                // Its `$` variables go when it is over, so this is no tail call.
                let value = crate::script::stack::with_room(|| self.run(pending))?;
                self.specials.restore(mark);
                Ok(Tail::Value(value))
            }
        }
    }

    fn call_builtin(
        &mut self,
        builtin: &'static Builtin,
        arguments: &'p [Argument],
        span: Span,
        frame: &Rc<Frame>,
    ) -> Result<Value, Failure> {
        if let Action::NamedFunction(action) = builtin.action {
            return self.call_named(builtin, action, arguments, span, frame);
        }
        let base = self.stack.len();
        for argument in arguments {
            // A question that may be asked about names that mean nothing.
            let value = match &self.program[argument.value] {
                Expr::Variable { name, place } if builtin.name == "is_undef" => {
                    self.look_up(*name, place, frame)?.unwrap_or_default()
                }
                _ => self.eval(argument.value, frame)?,
            };
            self.stack.push(value);
        }
        let outcome = match builtin.action {
            Action::Function(action) => {
                let spent = self.session.budget.spend(1);
                spent.and_then(|()| match self.traced_call(builtin.name, base) {
                    Some(value) => Ok(value),
                    None => action(&mut self.session, &self.stack[base..]),
                })
            }
            Action::Missing => return Err(self.missing(span, builtin.name)),
            Action::Module(_) | Action::NamedFunction(_) | Action::Nothing => Ok(Value::Undef),
        };
        if self.tracing.is_some() && matches!(outcome, Err(_) | Ok(Value::Text(_))) {
            let arguments = self.stack.split_off(base);
            self.refuse_untraced(&outcome, &arguments, builtin.name, span)?;
        }
        self.stack.truncate(base);
        self.settle_builtin(builtin, outcome, span)
    }

    /// Calls a builtin whose arguments may be named. `$` variables among them hold during the call.
    fn call_named(
        &mut self,
        builtin: &'static Builtin,
        action: NamedAction,
        arguments: &'p [Argument],
        span: Span,
        frame: &Rc<Frame>,
    ) -> Result<Value, Failure> {
        let mut values = vec![Value::Undef; builtin.parameters.len()];
        let (mut unnamed, mut specials) = (0, Vec::new());
        for argument in arguments {
            let value = self.eval(argument.value, frame)?;
            match argument.name {
                Some(name) if name.is_special() => specials.push((name, value)),
                Some(name) => {
                    let text = self.program.names.text(name);
                    match builtin.parameters.iter().position(|parameter| *parameter == text) {
                        Some(index) => values[index] = value,
                        None => self.warn_of_unknown_name(text, builtin.parameters, argument.span),
                    }
                }
                None if unnamed < values.len() => {
                    values[unnamed] = value;
                    unnamed += 1;
                }
                None => {
                    let text = format!("too many arguments: there are {} parameters", values.len());
                    self.warn(argument.span, text);
                }
            }
        }
        let mark = self.specials.mark();
        specials.into_iter().for_each(|(name, value)| self.specials.set(name, value));
        let fragmentation = self.specials.fragmentation();
        let spent = self.session.budget.spend(1);
        let outcome = spent.and_then(|()| action(&mut self.session, &values, fragmentation));
        self.specials.restore(mark);
        self.refuse_untraced(&outcome, &values, builtin.name, span)?;
        self.settle_builtin(builtin, outcome, span)
    }

    /// The value of a builtin; a warning that names it where it has none.
    fn settle_builtin(&mut self, builtin: &Builtin, outcome: Outcome, span: Span) -> Result<Value, Failure> {
        match outcome {
            Err(Fault::Undefined(text)) => {
                self.warn(span, format!("{}(): {text}", builtin.name));
                Ok(Value::Undef)
            }
            other => self.settle(other, span),
        }
    }
}

/// What a call has given so far.
struct Given {
    /// Values of `$` variables, in force when all arguments are evaluated.
    special: Vec<(Symbol, Value)>,
    unnamed: usize,
}

impl Given {
    /// Whether a parameter has its value, in the fresh frame of the call or among the `$` variables.
    fn has(&self, parameter: &Parameter, inner: &Rc<Frame>) -> bool {
        match parameter.slot {
            Slot::Local(slot) => inner.get(slot).is_some(),
            Slot::Special => self.special.iter().any(|(name, _)| *name == parameter.name),
        }
    }
}
