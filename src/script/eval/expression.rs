use super::{Failure, Machine};
use crate::script::ast::{Argument, BinaryOp, Binding, Expr, ExprId, Let, Place, Room, Slot};
use crate::script::diagnostic::{Severity, Span};
use crate::script::format;
use crate::script::names::Symbol;
use crate::script::operators;
use crate::script::report::Complaint;
use crate::script::stack::with_room;
use crate::script::value::{Closure, Frame, Items, List, Range, Value};
use std::rc::Rc;

impl<'p> Machine<'p> {
    /// The value of an expression.
    #[inline]
    pub(super) fn eval(&mut self, id: ExprId, frame: &Rc<Frame>) -> Result<Value, Failure> {
        match &self.program[id] {
            Expr::Number(value) => Ok(Value::Number(*value)),
            Expr::Variable { name, place } => {
                if let Place::Local { up: 0, slot } = place
                    && let Some(value) = frame.get(*slot)
                {
                    return Ok(value);
                }
                self.variable(*name, place, id, frame)
            }
            Expr::Undef => Ok(Value::Undef),
            Expr::Bool(value) => Ok(Value::Bool(*value)),
            Expr::Text(text) => Ok(Value::Text(text.clone())),
            // No level deeper, so no look at the stack: most of what loops are made of.
            Expr::Binary { op, left, right } if self.is_leaf(*left) && self.is_leaf(*right) => {
                self.binary(*op, *left, *right, id, frame)
            }
            _ => {
                let entered = self.session.budget.enter_level();
                self.allow(entered, self.program.span(id))?;
                let value = with_room(|| self.eval_compound(id, frame))?;
                self.session.budget.leave_level();
                Ok(value)
            }
        }
    }

    fn is_leaf(&self, id: ExprId) -> bool {
        matches!(self.program[id], Expr::Number(_) | Expr::Variable { .. })
    }

    fn eval_compound(&mut self, id: ExprId, frame: &Rc<Frame>) -> Result<Value, Failure> {
        let program = self.program;
        match &program[id] {
            Expr::Binary { op, left, right } => self.binary(*op, *left, *right, id, frame),
            Expr::Unary { op, operand } => {
                let operand = self.eval(*operand, frame)?;
                let outcome = operators::unary(*op, &operand, &mut self.session.budget);
                self.settle_traced(outcome, &[operand], program.span(id))
            }
            Expr::Conditional { condition, then, otherwise } => {
                let chosen = match self.eval(*condition, frame)? {
                    Value::Formula(condition) => {
                        return self.either(&condition, *then, *otherwise, id, frame);
                    }
                    condition if condition.is_true() => then,
                    _ => otherwise,
                };
                self.eval(*chosen, frame)
            }
            Expr::Call(call) => self.call(call, id, frame),
            Expr::Index { list, index } => {
                let list = self.eval(*list, frame)?;
                let index = self.eval(*index, frame)?;
                self.refuse_formula(&index, "an index", program.span(id))?;
                Ok(element(&list, &index))
            }
            Expr::Member { object, name } => {
                let object = self.eval(*object, frame)?;
                Ok(member(&object, program.names.text(*name)))
            }
            Expr::Range { begin, step, end } => self.range(*begin, *step, *end, id, frame),
            Expr::Let(inner) => self.in_let(inner, frame, |machine, frame| machine.eval(inner.body, frame)),
            Expr::Assert { arguments, body } => {
                self.assert(arguments, program.span(id), frame)?;
                body.map_or(Ok(Value::Undef), |body| self.eval(body, frame))
            }
            Expr::Echo { arguments, body } => {
                self.echo(arguments, program.span(id), frame)?;
                body.map_or(Ok(Value::Undef), |body| self.eval(body, frame))
            }
            Expr::Function(function) => {
                self.keep(frame);
                Ok(Value::Function(Rc::new(Closure { function: *function, frame: frame.clone() })))
            }
            _ => {
                let mut items = Items::default();
                match &program[id] {
                    Expr::List(elements) => {
                        for &element in elements {
                            self.elements(element, frame, &mut items)?;
                        }
                    }
                    _ => self.elements(id, frame, &mut items)?,
                }
                let list = Value::List(List::new(items));
                let spent = self.session.budget.reserve(0);
                self.allow(spent, program.span(id))?;
                Ok(list)
            }
        }
    }

    /// Remembers a frame that a function value keeps.
    fn keep(&mut self, frame: &Rc<Frame>) {
        // Those that are gone are forgotten whenever the list is about to grow.
        if self.kept.len() == self.kept.capacity() {
            self.kept.retain(|frame| frame.strong_count() > 0);
            self.kept.reserve(self.kept.len() + 16);
        }
        self.kept.push(Rc::downgrade(frame));
    }

    fn variable(
        &mut self,
        name: Symbol,
        place: &Place,
        id: ExprId,
        frame: &Rc<Frame>,
    ) -> Result<Value, Failure> {
        if let Some(value) = self.look_up(name, place, frame)? {
            return Ok(value);
        }
        let text = format!("unknown variable {}", self.program.names.text(name));
        let complaint = Complaint::warning(self.program.span(id), text);
        self.say(Self::did_you_mean(complaint, self.suggestions.variables.get(&name)));
        Ok(Value::Undef)
    }

    /// The value at a place, if there is one by now.
    #[inline]
    pub(super) fn look_up(
        &mut self,
        name: Symbol,
        place: &Place,
        frame: &Rc<Frame>,
    ) -> Result<Option<Value>, Failure> {
        Ok(match place {
            Place::Local { up: 0, slot } => frame.get(*slot),
            Place::Local { up, slot } => ancestor(frame, *up).get(*slot),
            Place::Global { unit, slot } => match &self.units[unit.0 as usize].frame {
                Some(frame) => frame.get(*slot),
                None => self.unit_frame(*unit)?.get(*slot),
            },
            Place::Special => self.specials.get(name),
            Place::Pi => Some(Value::Number(std::f64::consts::PI)),
            Place::Unknown => None,
            Place::FirstOf(places) => {
                for place in places {
                    if let Some(value) = self.look_up(name, place, frame)? {
                        return Ok(Some(value));
                    }
                }
                None
            }
        })
    }

    fn binary(
        &mut self,
        op: BinaryOp,
        left: ExprId,
        right: ExprId,
        id: ExprId,
        frame: &Rc<Frame>,
    ) -> Result<Value, Failure> {
        let a = self.eval(left, frame)?;
        match op {
            _ if matches!(a, Value::Formula(_)) => {}
            BinaryOp::And if !a.is_true() => return Ok(Value::Bool(false)),
            BinaryOp::Or if a.is_true() => return Ok(Value::Bool(true)),
            _ => {}
        }
        let b = self.eval(right, frame)?;
        // What loops are made of, without a detour.
        if let (Value::Number(a), Value::Number(b)) = (&a, &b) {
            match op {
                BinaryOp::Add => return Ok(Value::Number(a + b)),
                BinaryOp::Subtract => return Ok(Value::Number(a - b)),
                BinaryOp::Multiply => return Ok(Value::Number(a * b)),
                BinaryOp::Less => return Ok(Value::Bool(a < b)),
                BinaryOp::Equal => return Ok(Value::Bool(a == b)),
                _ => {}
            }
        }
        let outcome = operators::binary(op, &a, &b, &mut self.session.budget);
        self.settle_traced(outcome, &[a, b], self.program.span(id))
    }

    fn range(
        &mut self,
        begin: ExprId,
        step: Option<ExprId>,
        end: ExprId,
        id: ExprId,
        frame: &Rc<Frame>,
    ) -> Result<Value, Failure> {
        let begin = self.eval(begin, frame)?;
        let step = step.map_or(Ok(Value::Number(1.0)), |step| self.eval(step, frame))?;
        let end = self.eval(end, frame)?;
        for value in [&begin, &step, &end] {
            self.refuse_formula(value, "an end of a range", self.program.span(id))?;
        }
        Ok(match (begin, step, end) {
            (Value::Number(begin), Value::Number(step), Value::Number(end)) => {
                Value::Range(Rc::new(Range { begin, step, end }))
            }
            _ => Value::Undef,
        })
    }

    /// Runs `body` with the bindings of a `let` in force.
    fn in_let(
        &mut self,
        inner: &'p Let,
        frame: &Rc<Frame>,
        body: impl FnOnce(&mut Self, &Rc<Frame>) -> Result<Value, Failure>,
    ) -> Result<Value, Failure> {
        let mark = self.specials.mark();
        let frame = room(inner.room, frame);
        self.bind_all(&inner.bindings, &frame)?;
        let value = body(self, &frame)?;
        self.specials.restore(mark);
        Ok(value)
    }

    /// Carries out the bindings of a `let`, in order. Of two with one name the first counts.
    pub(super) fn bind_all(&mut self, bindings: &'p [Binding], frame: &Rc<Frame>) -> Result<(), Failure> {
        for (index, binding) in bindings.iter().enumerate() {
            let value = self.eval(binding.value, frame)?;
            let Some(name) = binding.name else {
                self.warn(binding.span, "a value without a name does nothing here");
                continue;
            };
            if bindings[..index].iter().any(|earlier| earlier.name == Some(name)) {
                let text =
                    format!("{} is bound twice; the first value counts", self.program.names.text(name));
                self.warn(binding.span, text);
                continue;
            }
            self.set(binding.slot, name, value, frame);
        }
        Ok(())
    }

    /// Carries out assignments.
    pub(super) fn assign(&mut self, assignments: &'p [Binding], frame: &Rc<Frame>) -> Result<(), Failure> {
        for binding in assignments {
            let value = self.eval(binding.value, frame)?;
            if let Some(name) = binding.name {
                self.set(binding.slot, name, value, frame);
            }
        }
        Ok(())
    }

    #[inline]
    pub(super) fn set(&mut self, slot: Slot, name: Symbol, value: Value, frame: &Rc<Frame>) {
        match slot {
            Slot::Local(slot) => frame.set(slot, Some(value)),
            Slot::Special => self.specials.set(name, value),
        }
    }

    /// Stops the script unless the first argument, or `condition`, holds.
    pub(super) fn assert(
        &mut self,
        arguments: &'p [Argument],
        span: Span,
        frame: &Rc<Frame>,
    ) -> Result<(), Failure> {
        let text = |name: Symbol| self.program.names.text(name);
        let named = |wanted: &str| arguments.iter().find(|a| a.name.is_some_and(|name| text(name) == wanted));
        let mut unnamed = arguments.iter().filter(|argument| argument.name.is_none());
        let Some(condition) = named("condition").or_else(|| unnamed.next()) else {
            return Err(self.error(span, "assert needs a condition"));
        };
        let message = named("message").or_else(|| unnamed.next());
        if self.decided(condition.value, frame)? {
            return Ok(());
        }
        let place = self.program.span(condition.value);
        let source = &self.files[place.file.0 as usize].text;
        let condition = source.get(place.start as usize..place.end as usize).unwrap_or_default();
        let mut text = format!("assertion `{condition}` failed");
        if let Some(message) = message {
            let value = self.eval(message.value, frame)?;
            text.push_str(": ");
            match value.text() {
                Some(message) => text.push_str(message),
                None => self.print(&value, span, &mut text)?,
            }
        }
        Err(self.error(place, text))
    }

    /// Says the arguments.
    pub(super) fn echo(
        &mut self,
        arguments: &'p [Argument],
        span: Span,
        frame: &Rc<Frame>,
    ) -> Result<(), Failure> {
        let mut text = String::new();
        for argument in arguments {
            let value = self.eval(argument.value, frame)?;
            if !text.is_empty() {
                text.push_str(", ");
            }
            if let Some(name) = argument.name {
                text.extend([self.program.names.text(name), " = "]);
            }
            self.print(&value, span, &mut text)?;
        }
        self.say(Complaint { severity: Severity::Echo, ..Complaint::error(span, text) });
        Ok(())
    }

    /// Appends a value as text.
    pub(in crate::script) fn print(
        &mut self,
        value: &Value,
        span: Span,
        text: &mut String,
    ) -> Result<(), Failure> {
        let printed = format::value(value, self.program, &mut self.session.budget, text);
        self.allow(printed, span)
    }
}

/// The frame for the variables of an inner scope.
pub(super) fn room(room: Room, frame: &Rc<Frame>) -> Rc<Frame> {
    match room {
        Room::Shared => frame.clone(),
        Room::Own(size) => Frame::new(size, Some(frame.clone())),
    }
}

/// The frame `up` frames out. The resolver counted them, so they are there.
pub(super) fn ancestor(frame: &Rc<Frame>, up: u32) -> &Rc<Frame> {
    (0..up).fold(frame, |frame, _| frame.parent.as_ref().unwrap_or(frame))
}

/// `list[index]`; `undef` where there is nothing.
fn element(list: &Value, index: &Value) -> Value {
    let Some(index) = index.number().map(f64::trunc).filter(|index| (0.0..4e9).contains(index)) else {
        return Value::Undef;
    };
    let index = index as usize;
    match list {
        Value::List(list) => list.get(index).unwrap_or_default(),
        Value::Text(text) => text.char(index).map_or(Value::Undef, Value::from_text),
        Value::Range(range) => {
            [range.begin, range.step, range.end].get(index).copied().map_or(Value::Undef, Value::Number)
        }
        _ => Value::Undef,
    }
}

/// `object.name`: components of a vector, alone or several at once, and parts of a range.
fn member(object: &Value, name: &str) -> Value {
    match object {
        Value::Range(range) => match name {
            "begin" => Value::Number(range.begin),
            "step" => Value::Number(range.step),
            "end" => Value::Number(range.end),
            _ => Value::Undef,
        },
        Value::List(list) => {
            let component =
                |c: char| "xyzw".find(c).or_else(|| "rgba".find(c)).and_then(|index| list.get(index));
            let mut components = name.chars().map(component);
            if name.len() == 1 {
                return components.next().flatten().unwrap_or_default();
            }
            components.collect::<Option<Vec<Value>>>().map_or(Value::Undef, Value::from_iter)
        }
        _ => Value::Undef,
    }
}
