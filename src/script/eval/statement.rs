//! Statements: what makes shapes.

use super::expression::room;
use super::{Failure, Machine, Made, Running, Shape, What};
use crate::boolean::Op;
use crate::script::ast::{
    Binding, Block, Home, ModuleCall, ModuleId, Room, Slot, Statement, StatementId, StatementKind, Target,
    UnitId,
};
use crate::script::builtins::Action;
use crate::script::diagnostic::Span;
use crate::script::report::Complaint;
use crate::script::stack::with_room;
use crate::script::value::{Frame, Value};
use std::rc::Rc;

/// Where statements run.
#[derive(Clone)]
pub(in crate::script) struct Context<'p> {
    /// The variables.
    pub(super) frame: Rc<Frame>,
    /// The children given to the module whose body this is.
    pub(super) children: Option<Rc<Children<'p>>>,
}

/// The children of a call of a module, with the place they were written in.
pub(super) struct Children<'p> {
    block: &'p Block,
    context: Context<'p>,
    unit: UnitId,
}

impl<'p> Machine<'p> {
    /// What the statements of an inner block make.
    pub(in crate::script) fn block(
        &mut self,
        block: &'p Block,
        context: &Context<'p>,
    ) -> Result<Made, Failure> {
        self.chosen(block, context, |machine, context| machine.statements(&block.statements, context))
    }

    /// Runs `f` in the scope of an inner block.
    fn chosen(
        &mut self,
        block: &'p Block,
        context: &Context<'p>,
        f: impl FnOnce(&mut Self, &Context<'p>) -> Result<Made, Failure>,
    ) -> Result<Made, Failure> {
        if block.assignments.is_empty() {
            return f(self, context);
        }
        let mark = self.specials.mark();
        let frame = room(block.room.unwrap_or(Room::Shared), &context.frame);
        for binding in &block.assignments {
            // The block may have run before: its variables have no values yet.
            if let Slot::Local(slot) = binding.slot {
                frame.set(slot, None);
            }
        }
        let context = Context { frame, children: context.children.clone() };
        self.assign(&block.assignments, &context.frame)?;
        let made = f(self, &context)?;
        self.specials.restore(mark);
        Ok(made)
    }

    /// What a block makes whose frame is that of `context`: the body of a module or of a unit.
    pub(super) fn block_body(&mut self, block: &'p Block, context: &Context<'p>) -> Result<Made, Failure> {
        self.assign(&block.assignments, &context.frame)?;
        self.statements(&block.statements, context)
    }

    fn statements(&mut self, statements: &'p [StatementId], context: &Context<'p>) -> Result<Made, Failure> {
        let mut all = Made::default();
        for &id in statements {
            let made = self.statement(&self.program[id], context)?;
            all.shapes.extend(made.shapes);
            all.shown.extend(made.shown);
        }
        Ok(all)
    }

    fn statement(&mut self, statement: &'p Statement, context: &Context<'p>) -> Result<Made, Failure> {
        let Statement { modifiers, kind, span } = statement;
        if modifiers.disable {
            return Ok(Made::default());
        }
        let entered = self.session.budget.enter_level();
        self.allow(entered, *span)?;
        self.step(*span)?;
        let mut made = with_room(|| self.statement_kind(kind, *span, context))?;
        self.session.budget.leave_level();
        if modifiers.highlight || modifiers.background {
            made.shown.extend(made.shapes.iter().filter(|shape| shape.dimension.is_some()).cloned());
        }
        if modifiers.background {
            made.shapes.clear();
        }
        if modifiers.root {
            self.set_root(&made, *span)?;
        }
        Ok(made)
    }

    /// Makes a subtree marked with `!` the whole result.
    fn set_root(&mut self, made: &Made, span: Span) -> Result<(), Failure> {
        if self.root.is_some() {
            self.warn(span, "only one shape can be marked with `!`; the first one counts");
            return Ok(());
        }
        let Made { shapes, shown } = self.joined(made.clone(), span)?;
        self.root = shapes.into_iter().next().map(|shape: Shape| (shape, shown));
        Ok(())
    }

    fn statement_kind(
        &mut self,
        kind: &'p StatementKind,
        span: Span,
        context: &Context<'p>,
    ) -> Result<Made, Failure> {
        let made = match kind {
            StatementKind::Block(block) => self.block(block, context)?,
            StatementKind::If { condition, then, otherwise } => {
                let chosen = match self.eval(*condition, &context.frame)?.is_true() {
                    true => Some(then),
                    false => otherwise.as_ref(),
                };
                match chosen {
                    Some(block) => self.block(block, context)?,
                    None => return Ok(Made::default()),
                }
            }
            StatementKind::For { bindings, body, room, intersect } => {
                return self.for_statement(bindings, body, *room, *intersect, span, context);
            }
            StatementKind::Let { bindings, body, room: kind } => {
                let mark = self.specials.mark();
                let context =
                    Context { frame: room(*kind, &context.frame), children: context.children.clone() };
                self.bind_all(bindings, &context.frame)?;
                let made = self.block(body, &context)?;
                self.specials.restore(mark);
                made
            }
            StatementKind::Call(call) => return self.call_module(call, span, context),
        };
        self.joined(made, span)
    }

    fn for_statement(
        &mut self,
        bindings: &'p [Binding],
        body: &'p Block,
        room: Room,
        intersect: bool,
        span: Span,
        context: &Context<'p>,
    ) -> Result<Made, Failure> {
        let mut all = Made::default();
        self.for_each(bindings, room, &context.frame, &mut |machine, frame| {
            let context = Context { frame: frame.clone(), children: context.children.clone() };
            let mut made = machine.block(body, &context)?;
            if intersect {
                made = machine.joined(made, span)?;
            }
            all.shapes.extend(made.shapes);
            all.shown.extend(made.shown);
            Ok(())
        })?;
        self.combined(if intersect { Op::Intersection } else { Op::Union }, all, span)
    }

    fn call_module(
        &mut self,
        call: &'p ModuleCall,
        span: Span,
        context: &Context<'p>,
    ) -> Result<Made, Failure> {
        let name = self.program.names.text(call.name);
        let builtin = match call.target {
            Target::User { id, home } => return self.call_user_module(id, home, call, span, context),
            Target::Builtin(builtin) => builtin,
            Target::Unknown => {
                let complaint = Complaint::warning(span, format!("unknown module {name}"));
                self.say(Self::did_you_mean(complaint, self.suggestions.modules.get(&call.name)));
                return Ok(Made::default());
            }
        };
        match (name, builtin.action) {
            ("echo", _) => self.echo(&call.arguments, span, &context.frame)?,
            ("assert", _) => self.assert(&call.arguments, span, &context.frame)?,
            (_, Action::Module(action)) => {
                let mark = self.specials.mark();
                let made = self.invoke(builtin, action, call, context, span)?;
                self.specials.restore(mark);
                return Ok(made);
            }
            (_, Action::Missing) => return Err(self.missing(span, name)),
            _ => {}
        }
        if call.children.statements.is_empty() {
            return Ok(Made::default());
        }
        let made = self.block(&call.children, context)?;
        self.joined(made, span)
    }

    fn call_user_module(
        &mut self,
        id: ModuleId,
        home: Home,
        call: &'p ModuleCall,
        span: Span,
        context: &Context<'p>,
    ) -> Result<Made, Failure> {
        let module = &self.program[id];
        let (around, unit) = self.home(home, &context.frame)?;
        let entered = self.session.budget.enter_call();
        self.allow(entered, span)?;
        let mark = self.specials.mark();
        let frame = Frame::new(module.frame, Some(around));
        self.enter_unit(unit);
        self.bind(&module.parameters, &call.arguments, &frame, &context.frame, span)?;
        self.calls.push(Running { what: What::Module(module.name), span });
        self.session.modules.push(module.name);
        self.set_known_specials(call.children.statements.len());
        let children = Children { block: &call.children, context: context.clone(), unit: self.unit };
        let outer = std::mem::replace(&mut self.unit, unit);
        let made = self.block_body(&module.body, &Context { frame, children: Some(Rc::new(children)) })?;
        let made = self.joined(made, span)?;
        self.unit = outer;
        self.session.modules.pop();
        self.calls.pop();
        self.specials.restore(mark);
        self.session.budget.leave_call();
        Ok(made)
    }

    fn set_known_specials(&mut self, children: usize) {
        if let Some(name) = self.specials.known().children {
            self.specials.set(name, Value::Number(children as f64));
        }
        if let Some(name) = self.specials.known().parent_modules {
            self.specials.set(name, Value::Number(self.session.modules.len() as f64));
        }
    }

    /// The children that `context` was given: all of them, or those that `which` names by number, list or range.
    pub(in crate::script) fn given_children(
        &mut self,
        which: Option<&Value>,
        span: Span,
        context: &Context<'p>,
    ) -> Result<Made, Failure> {
        let Some(children) = context.children.clone() else { return Ok(Made::default()) };
        let statements = &children.block.statements;
        let mut chosen = Vec::new();
        match which {
            None => chosen.extend_from_slice(statements),
            Some(which) => {
                let count = statements.len();
                self.spread(which, span, &mut |machine, index| {
                    chosen.extend(machine.index_of_child(&index, count, span).map(|index| statements[index]));
                    Ok(())
                })?;
            }
        }
        let outer = std::mem::replace(&mut self.unit, children.unit);
        let mark = self.specials.mark();
        // Where the children were written, $children is the number of those of the module around them.
        let around = children.context.children.as_ref().map_or(0, |outer| outer.block.statements.len());
        if let Some(name) = self.specials.known().children {
            self.specials.set(name, Value::Number(around as f64));
        }
        let made = self.chosen(children.block, &children.context, |machine, context| {
            let mut all = Made::default();
            for id in chosen {
                let made = machine.statement(&machine.program[id], context)?;
                all.shapes.extend(made.shapes);
                all.shown.extend(made.shown);
            }
            Ok(all)
        })?;
        self.specials.restore(mark);
        self.unit = outer;
        Ok(made)
    }

    /// The index of a child; a warning where there is none.
    fn index_of_child(&mut self, index: &Value, count: usize, span: Span) -> Option<usize> {
        let Some(number) = index.number() else {
            self.warn(span, format!("a child is chosen by a number, not by {}", index.kind()));
            return None;
        };
        let number = number.trunc();
        if number < 0.0 || number >= count as f64 || number.is_nan() {
            self.warn(span, format!("there is no child {number}, there are {count}, counted from 0"));
            return None;
        }
        Some(number as usize)
    }
}
