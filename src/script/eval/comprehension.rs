//! Elements of lists, and everything that runs over the values of another.

use super::expression::room;
use super::{Failure, Machine};
use crate::script::ast::{Binding, Expr, ExprId, Room, While};
use crate::script::diagnostic::Span;
use crate::script::value::{Frame, Items, List, Range, Value};
use std::rc::Rc;

/// What is done for each value of a loop.
type Body<'b, 'p> = &'b mut dyn FnMut(&mut Machine<'p>, &Rc<Frame>) -> Result<(), Failure>;

impl<'p> Machine<'p> {
    /// Appends the values an element of a list stands for.
    pub(super) fn elements(&mut self, id: ExprId, frame: &Rc<Frame>, out: &mut Items) -> Result<(), Failure> {
        let program = self.program;
        match &program[id] {
            Expr::Each(inner) => {
                let mut lists = Items::default();
                self.elements(*inner, frame, &mut lists)?;
                self.spread(&Value::List(List::new(lists)), program.span(id), &mut |machine, list| {
                    machine.spread(&list, program.span(id), &mut |_, value| {
                        out.push(value);
                        Ok(())
                    })
                })
            }
            Expr::For(inner) => self.for_each(&inner.bindings, inner.room, frame, &mut |machine, frame| {
                machine.elements(inner.body, frame, out)
            }),
            Expr::While(inner) => self.while_elements(inner, id, frame, out),
            Expr::If { condition, then, otherwise } => {
                if self.decided(*condition, frame)? {
                    self.elements(*then, frame, out)
                } else {
                    otherwise.map_or(Ok(()), |otherwise| self.elements(otherwise, frame, out))
                }
            }
            Expr::Let(inner) => {
                let mark = self.specials.mark();
                let frame = room(inner.room, frame);
                self.bind_all(&inner.bindings, &frame)?;
                self.elements(inner.body, &frame, out)?;
                self.specials.restore(mark);
                Ok(())
            }
            _ => {
                let value = self.eval(id, frame)?;
                out.push(value);
                // Lists grow in powers of two: memory is looked at when one is full.
                if out.len() >= 1024 && out.len().is_power_of_two() {
                    let room = self.session.budget.reserve(2 * out.bytes());
                    self.allow(room, program.span(id))?;
                }
                Ok(())
            }
        }
    }

    fn while_elements(
        &mut self,
        inner: &'p While,
        id: ExprId,
        frame: &Rc<Frame>,
        out: &mut Items,
    ) -> Result<(), Failure> {
        let mark = self.specials.mark();
        let mut frame = room(inner.room, frame);
        self.bind_all(&inner.init, &frame)?;
        while self.decided(inner.condition, &frame)? {
            self.step(self.program.span(id))?;
            self.elements(inner.body, &frame, out)?;
            frame = self.fresh(inner.room, &frame);
            self.assign(&inner.update, &frame)?;
        }
        self.specials.restore(mark);
        Ok(())
    }

    /// Runs `body` for all values of the bindings, the last of them fastest.
    pub(super) fn for_each(
        &mut self,
        bindings: &'p [Binding],
        kind: Room,
        frame: &Rc<Frame>,
        body: Body<'_, 'p>,
    ) -> Result<(), Failure> {
        self.for_rest(bindings, kind, &room(kind, frame), body)
    }

    fn for_rest(
        &mut self,
        bindings: &'p [Binding],
        kind: Room,
        frame: &Rc<Frame>,
        body: Body<'_, 'p>,
    ) -> Result<(), Failure> {
        let Some((binding, rest)) = bindings.split_first() else { return body(self, frame) };
        let values = self.eval(binding.value, frame)?;
        self.spread(&values, binding.span, &mut |machine, value| {
            let mark = machine.specials.mark();
            let frame = machine.fresh(kind, frame);
            if let Some(name) = binding.name {
                machine.set(binding.slot, name, value, &frame);
            }
            machine.for_rest(rest, kind, &frame, body)?;
            machine.specials.restore(mark);
            Ok(())
        })
    }

    /// The frame for the next round of a loop: a copy where function values may keep the last one.
    fn fresh(&mut self, kind: Room, frame: &Rc<Frame>) -> Rc<Frame> {
        match kind {
            Room::Shared => frame.clone(),
            Room::Own(size) => {
                let copy = Frame::new(size, frame.parent.clone());
                copy.slots.borrow_mut().clone_from(&frame.slots.borrow());
                copy
            }
        }
    }

    /// Hands the values that `value` stands for in a loop to `f`: those of a list or a range, the characters of a
    /// string, none for `undef`, and any other value itself.
    pub(super) fn spread(
        &mut self,
        value: &Value,
        span: Span,
        f: &mut dyn FnMut(&mut Self, Value) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        match value {
            Value::Undef => Ok(()),
            Value::List(list) => list.iter().try_for_each(|value| {
                self.step(span)?;
                f(self, value)
            }),
            Value::Text(text) => text.as_str().chars().try_for_each(|c| {
                self.step(span)?;
                f(self, Value::from_text(c))
            }),
            Value::Range(range) => {
                let count = self.count(range, span);
                (0..count).try_for_each(|index| {
                    self.step(span)?;
                    f(self, Value::Number(range.at(index)))
                })
            }
            other => f(self, other.clone()),
        }
    }

    /// Number of values of a range, with a warning for one that has none or no end.
    fn count(&mut self, range: &Range, span: Span) -> u64 {
        let count = range.count();
        if count.is_infinite() {
            self.warn(span, "a range with infinitely many values gives none");
            return 0;
        }
        if count == 0.0 && !(range.begin.is_nan() || range.step.is_nan() || range.end.is_nan()) {
            let way = if range.step > 0.0 {
                "begins above its end, but its step is positive"
            } else {
                "begins below its end, but its step is negative"
            };
            self.warn(span, format!("the range {way}"));
        }
        count as u64
    }

    /// Counts one step.
    #[inline]
    pub(super) fn step(&mut self, span: Span) -> Result<(), Failure> {
        let spent = self.session.budget.spend(1);
        self.allow(spent, span)
    }
}
