//! Functions run on symbols: see [`formula`](crate::script::formula).

use super::call::Pending;
use super::{Failure, Machine};
use crate::script::ast::ExprId;
use crate::script::budget::{Fault, Outcome};
use crate::script::diagnostic::Span;
use crate::script::formula;
use crate::script::report::Complaint;
use crate::script::value::{Closure, Frame, Value};
use crate::sdf::Expr;
use std::rc::Rc;

/// What the symbols of a function stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Traced {
    /// The coordinates of a point.
    Point,
    /// The two parameters of a surface.
    Surface,
}

impl Machine<'_> {
    /// The value of a function at symbols for the coordinates: of one parameter as a vector, or of three.
    pub(in crate::script) fn traced(&mut self, closure: &Closure, span: Span) -> Result<Value, Failure> {
        let axes = Expr::axes().map(formula::value);
        match self.needed(closure) {
            (0 | 1, 1..) => self.traced_at(closure, vec![axes.into_iter().collect()], Traced::Point, span),
            (3, _) => self.traced_at(closure, axes.to_vec(), Traced::Point, span),
            (count, _) => {
                let text = format!("a function of a point has the parameter p, or x, y and z, not {count}");
                Err(self.error(span, text))
            }
        }
    }

    /// The value of a function at symbols for its two parameters, which are called x and y.
    pub(in crate::script) fn traced_in_plane(
        &mut self,
        closure: &Closure,
        span: Span,
    ) -> Result<Value, Failure> {
        let [x, y, _] = Expr::axes().map(formula::value);
        match self.needed(closure) {
            (0..=2, 2..) => self.traced_at(closure, vec![x, y], Traced::Surface, span),
            (count, _) => {
                let text = format!("a function of a surface has the parameters u and v, not {count}");
                Err(self.error(span, text))
            }
        }
    }

    /// How many parameters of a function have no default, and how many there are.
    fn needed(&self, closure: &Closure) -> (usize, usize) {
        let parameters = &self.program[closure.function].parameters;
        (parameters.iter().filter(|parameter| parameter.default.is_none()).count(), parameters.len())
    }

    fn traced_at(
        &mut self,
        closure: &Closure,
        given: Vec<Value>,
        traced: Traced,
        span: Span,
    ) -> Result<Value, Failure> {
        let function = &self.program[closure.function];
        let frame = Frame::new(function.frame, Some(closure.frame.clone()));
        let mark = self.specials.mark();
        let mut given = given.into_iter();
        for parameter in &function.parameters {
            let value = match (given.next(), parameter.default) {
                (Some(value), _) => value,
                (None, Some(default)) => self.eval(default, &closure.frame)?,
                (None, None) => Value::Undef,
            };
            self.set(parameter.slot, parameter.name, value, &frame);
        }
        let pending = Pending { function: closure.function, frame, unit: self.unit, span };
        let outer = self.tracing.replace(traced);
        let value = self.run(pending)?;
        self.tracing = outer;
        self.specials.restore(mark);
        Ok(value)
    }

    /// Both values of `condition ? then : otherwise`, one or the other by the place.
    pub(super) fn either(
        &mut self,
        condition: &Expr,
        then: ExprId,
        otherwise: ExprId,
        id: ExprId,
        frame: &Rc<Frame>,
    ) -> Result<Value, Failure> {
        if self.tracing == Some(Traced::Surface) {
            // A surface that jumps has no tolerance.
            return Err(self.unknown("this condition", self.program.span(id)));
        }
        let (then, otherwise) = (self.eval(then, frame)?, self.eval(otherwise, frame)?);
        let outcome = formula::select(condition, &then, &otherwise, &mut self.session.budget);
        self.settle_traced(outcome, &[Value::Formula(condition.clone())], self.program.span(id))
    }

    /// Whether a condition holds that must be known now.
    pub(super) fn decided(&mut self, condition: ExprId, frame: &Rc<Frame>) -> Result<bool, Failure> {
        let value = self.eval(condition, frame)?;
        self.refuse_formula(&value, "this condition", self.program.span(condition))?;
        Ok(value.is_true())
    }

    /// The outcome at a place; what is undefined since an operand depends on coordinates is an error.
    pub(super) fn settle_traced(
        &mut self,
        outcome: Outcome,
        operands: &[Value],
        span: Span,
    ) -> Result<Value, Failure> {
        match outcome {
            Err(Fault::Undefined(text)) if operands.iter().any(formula::is_in) => {
                Err(self.untraceable(&text, span))
            }
            outcome => self.settle(outcome, span),
        }
    }

    /// An error where a value has to be known and depends on coordinates.
    pub(super) fn refuse_formula(&mut self, value: &Value, what: &str, span: Span) -> Result<(), Failure> {
        match value {
            Value::Formula(_) => Err(self.unknown(what, span)),
            _ => Ok(()),
        }
    }

    /// The value of a builtin of which some arguments are formulas; `None` where it is to be called.
    pub(super) fn traced_call(&self, name: &str, base: usize) -> Option<Value> {
        let arguments = &self.stack[base..];
        if self.tracing.is_some() && arguments.iter().any(formula::is_in) {
            formula::call(name, arguments)
        } else {
            None
        }
    }

    /// An error where a builtin makes nothing of arguments since they depend on coordinates.
    pub(super) fn refuse_untraced(
        &mut self,
        outcome: &Outcome,
        arguments: &[Value],
        name: &str,
        span: Span,
    ) -> Result<(), Failure> {
        match outcome {
            Err(Fault::Undefined(text)) if arguments.iter().any(formula::is_in) => {
                Err(self.untraceable(&format!("{name}(): {text}"), span))
            }
            Ok(Value::Text(_)) if arguments.iter().any(formula::is_in) => {
                Err(self.unknown(&format!("the text of {name}()"), span))
            }
            _ => Ok(()),
        }
    }

    fn unknown(&mut self, what: &str, span: Span) -> Failure {
        let on = match self.tracing {
            Some(Traced::Surface) => "the parameters of the surface",
            _ => "a coordinate",
        };
        self.untraceable(&format!("{what} depends on {on}"), span)
    }

    fn untraceable(&mut self, why: &str, span: Span) -> Failure {
        let complaint = Complaint::error(span, format!("this cannot be traced into a formula: {why}"));
        let hint = match self.tracing {
            Some(Traced::Surface) => {
                "parametric() calls its function once, for all u and v: arithmetic, min, max, abs, sqrt, sin and the like can be traced"
            }
            _ => {
                "implicit() calls its function once, for all points: arithmetic, min, max, abs, sqrt, sin, ?: and the like can be traced"
            }
        };
        self.say(complaint.hint(hint));
        Failure::Error
    }
}
