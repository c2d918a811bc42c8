//! The evaluator: walks the resolved tree.
//!
//! Expressions give values, statements give shapes ([`Made`]). What goes wrong is said where it happens; a
//! [`Failure`] that comes back has been said already. The stack grows on the heap where scripts recurse deeply
//! ([`with_room`](super::stack::with_room)); tail calls take no stack at all.

mod arguments;
mod call;
mod comprehension;
mod expression;
mod shape;
mod special;
mod statement;
mod trace;

pub(super) use arguments::Invocation;
pub(super) use shape::{Made, Shape};
pub(super) use special::Fragmentation;

use super::ast::{Program, UnitId};
use super::budget::{Budget, Fault, Outcome};
use super::builtins::Random;
use super::diagnostic::{Frame as TraceFrame, Severity, Span};
use super::names::Symbol;
use super::report::Complaint;
use super::resolve::Suggestions;
use super::value::{Frame, Value};
use super::{Evaluated, Failure, Host, Loaded, Options};
use crate::csg::Csg;
use special::Specials;
use statement::Context;
use std::cmp::Ordering;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// Random numbers of a script that gives no seed start here.
const UNSEEDED: u32 = 5489;
/// Times a place may give the same warning.
const MOST_WARNINGS: u32 = 20;
/// Calls of a trace that are shown at each end of a long one.
const TRACE_END: usize = 8;

/// Evaluates a resolved program.
pub(super) fn run(
    program: &Program,
    suggestions: &Suggestions,
    files: Arc<Vec<Loaded>>,
    host: &mut dyn Host,
    options: &Options,
) -> Result<Evaluated, Failure> {
    let mut machine = Machine::new(program, suggestions, files, host, options);
    let result = machine.main();
    machine.forget_frames();
    let made = result?;
    let (recipe, shown) = match machine.root.take() {
        Some((shape, shown)) => (shape.recipe, shown),
        None => {
            (made.shapes.into_iter().next().map_or_else(|| Arc::new(Csg::Nothing), |s| s.recipe), made.shown)
        }
    };
    let shown = shown.into_iter().map(|shape| shape.recipe).collect();
    Ok(Evaluated { recipe, shown, files: machine.files.to_vec() })
}

/// What builtin functions see of the evaluator.
pub(super) struct Session<'p> {
    pub(super) program: &'p Program,
    pub(super) budget: Budget,
    pub(super) random: Random,
    /// Modules that are running, innermost last.
    pub(super) modules: Vec<Symbol>,
}

/// The state of an evaluation.
pub(super) struct Machine<'p> {
    program: &'p Program,
    suggestions: &'p Suggestions,
    files: Arc<Vec<Loaded>>,
    host: &'p mut dyn Host,
    session: Session<'p>,
    specials: Specials,
    /// Arguments of builtin functions on their way.
    stack: Vec<Value>,
    /// Calls that are running, innermost last.
    calls: Vec<Running>,
    /// The unit whose code runs.
    unit: UnitId,
    /// Whether a function runs on symbols.
    tracing: Option<trace::Traced>,
    units: Vec<UnitState>,
    /// The subtree marked with `!`.
    root: Option<(Shape, Vec<Shape>)>,
    said: HashMap<Span, u32>,
    /// Frames that function values keep; they may keep each other alive.
    kept: Vec<std::rc::Weak<Frame>>,
}

/// A call that is running.
#[derive(Clone, Copy)]
struct Running {
    what: What,
    span: Span,
}

#[derive(Clone, Copy)]
enum What {
    Function(Option<Symbol>),
    Module(Symbol),
}

/// The top level of a unit: its variables once they have been computed.
#[derive(Default)]
struct UnitState {
    frame: Option<Rc<Frame>>,
    /// Its `$` variables, which hold while its code is called from other units.
    specials: Vec<(Symbol, Value)>,
}

impl<'p> Machine<'p> {
    fn new(
        program: &'p Program,
        suggestions: &'p Suggestions,
        files: Arc<Vec<Loaded>>,
        host: &'p mut dyn Host,
        options: &Options,
    ) -> Machine<'p> {
        let random = Random::new(UNSEEDED);
        let session = Session { program, budget: Budget::new(options), random, modules: Vec::new() };
        Machine {
            program,
            suggestions,
            files,
            host,
            session,
            specials: Specials::new(&program.names, options),
            stack: Vec::new(),
            calls: Vec::new(),
            unit: UnitId(0),
            tracing: None,
            units: program.units.iter().map(|_| UnitState::default()).collect(),
            root: None,
            said: HashMap::new(),
            kept: Vec::new(),
        }
    }

    /// The main program: its assignments, then its statements.
    fn main(&mut self) -> Result<Made, Failure> {
        let unit = &self.program[UnitId(0)];
        let frame = Frame::new(unit.frame, None);
        self.units[0].frame = Some(frame.clone());
        let context = Context { frame, children: None };
        let made = self.block_body(&unit.body, &context)?;
        let span = Span { file: super::FileId(0), start: 0, end: 0 };
        self.joined(made, span)
    }

    /// The variables of a unit; computed when they are first needed, with the `$` variables of that moment.
    fn unit_frame(&mut self, unit: UnitId) -> Result<Rc<Frame>, Failure> {
        let index = unit.0 as usize;
        if let Some(frame) = &self.units[index].frame {
            return Ok(frame.clone());
        }
        let frame = Frame::new(self.program[unit].frame, None);
        self.units[index].frame = Some(frame.clone());
        let mark = self.specials.mark();
        let outer = std::mem::replace(&mut self.unit, unit);
        self.assign(&self.program[unit].body.assignments, &frame)?;
        self.unit = outer;
        self.units[index].specials = self.specials.take_since(mark);
        Ok(frame)
    }

    /// Breaks the circles of frames and function values that keep each other alive.
    fn forget_frames(&mut self) {
        for frame in std::mem::take(&mut self.kept).into_iter().filter_map(|frame| frame.upgrade()) {
            let slots = std::mem::take(&mut *frame.slots.borrow_mut());
            super::heap::gave_back(size_of::<Option<Value>>() * slots.len());
            drop(slots);
        }
        self.units.clear();
    }

    /// The value of an outcome at `span`: `undef` with a warning where there is none.
    fn settle(&mut self, outcome: Outcome, span: Span) -> Result<Value, Failure> {
        match outcome {
            Ok(value) => Ok(value),
            Err(Fault::Undefined(text)) => {
                self.warn(span, text);
                Ok(Value::Undef)
            }
            Err(fault @ Fault::Limit(_)) => Err(self.stop(fault, span)),
        }
    }

    /// Carries on where a limit allows it.
    fn allow<T>(&mut self, result: Result<T, Fault>, span: Span) -> Result<T, Failure> {
        result.map_err(|fault| self.stop(fault, span))
    }

    fn stop(&mut self, fault: Fault, span: Span) -> Failure {
        match fault {
            Fault::Limit(text) => {
                self.say(Complaint::error(span, text));
                Failure::Limit
            }
            Fault::Undefined(text) => self.error(span, text),
        }
    }

    /// Stops the script because of a limit.
    pub(super) fn limit(&mut self, span: Span, text: impl Into<String>) -> Failure {
        self.stop(Fault::Limit(text.into()), span)
    }

    /// Stops the script.
    pub(super) fn error(&mut self, span: Span, text: impl Into<String>) -> Failure {
        self.say(Complaint::error(span, text));
        Failure::Error
    }

    /// Stops the script because it calls what is not there yet.
    fn missing(&mut self, span: Span, name: &str) -> Failure {
        self.error(span, format!("ogee does not have {name}() yet"))
    }

    pub(super) fn warn(&mut self, span: Span, text: impl Into<String>) {
        self.say(Complaint::warning(span, text));
    }

    /// Says something with the calls that led there. A place that keeps warning is cut short.
    pub(super) fn say(&mut self, mut complaint: Complaint) {
        if complaint.severity == Severity::Warning {
            let said = self.said.entry(complaint.span).or_insert(0);
            *said += 1;
            match (*said).cmp(&MOST_WARNINGS) {
                Ordering::Less => {}
                Ordering::Equal => complaint = complaint.hint("further warnings of this place are not shown"),
                Ordering::Greater => return,
            }
        }
        let trace = if complaint.severity == Severity::Echo { Vec::new() } else { self.trace() };
        self.host.say(complaint.into_message(trace, self.files.clone()));
    }

    /// The running calls, innermost first; the middle of a long trace is left out.
    fn trace(&self) -> Vec<TraceFrame> {
        let frame = |call: &Running| TraceFrame { name: self.name_of(call.what), span: call.span };
        let count = self.calls.len();
        if count <= 2 * TRACE_END {
            return self.calls.iter().rev().map(frame).collect();
        }
        let hidden = &self.calls[TRACE_END..count - TRACE_END];
        let gap = hidden
            .last()
            .map(|call| TraceFrame { name: format!("... {} more calls", hidden.len()), span: call.span });
        let inner = self.calls[count - TRACE_END..].iter().rev().map(frame);
        inner.chain(gap).chain(self.calls[..TRACE_END].iter().rev().map(frame)).collect()
    }

    fn name_of(&self, what: What) -> String {
        match what {
            What::Function(Some(name)) => format!("function {}", self.program.names.text(name)),
            What::Function(None) => "a function value".to_owned(),
            What::Module(name) => format!("module {}", self.program.names.text(name)),
        }
    }

    /// A hint from a suggestion, which is empty where there is none.
    fn did_you_mean(complaint: Complaint, suggestion: Option<&String>) -> Complaint {
        match suggestion.filter(|name| !name.is_empty()) {
            Some(name) => complaint.hint(format!("did you mean {name}?")),
            None => complaint,
        }
    }
}
