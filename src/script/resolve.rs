//! Names to places: every variable gets a slot in a frame, every call its target, once and before anything runs.
//!
//! A scope's definitions hold throughout it, and its assignments are carried out in order before anything else. So a
//! name may be used where its variable has a slot but no value yet; the variable of a scope further out is meant then
//! ([`Place::FirstOf`]). Function values and bodies of named functions run later, and see whatever is there by then.

use super::ast::{
    Argument, Binding, Block, Call, Callee, Expr, ExprId, FrameSize, Function, FunctionId, Home, Module,
    ModuleId, Parameter, Place, Program, Room, Slot, Statement, StatementId, StatementKind, Target, UnitId,
};
use super::builtins;
use super::names::Symbol;
use super::report::Complaint;
use super::stack::with_room;
use super::suggest;
use std::collections::HashMap;

/// Deepest expression: longer chains of operators are taken for an accident.
const DEEPEST: u32 = 100_000;
/// Names for which a better one is looked for.
const MOST_SUGGESTIONS: usize = 50;

/// Hints for names that mean nothing, by name.
#[derive(Debug, Default)]
pub(super) struct Suggestions {
    pub(super) variables: HashMap<Symbol, String>,
    pub(super) functions: HashMap<Symbol, String>,
    pub(super) modules: HashMap<Symbol, String>,
}

/// Resolves all names of `program`.
pub(super) fn resolve(program: &mut Program, complaints: &mut Vec<Complaint>) -> Suggestions {
    let definitions = program.units.iter().map(|unit| Scope::of(&unit.body)).collect();
    let suggestions = Suggestions::default();
    let first = UnitId(0);
    let mut resolver =
        Resolver { program, complaints, definitions, suggestions, unit: first, frames: Vec::new(), depth: 0 };
    for unit in 0..resolver.program.units.len() as u32 {
        resolver.unit(UnitId(unit));
    }
    resolver.suggestions
}

/// How far the evaluation of a scope has come where a name is looked up.
#[derive(Clone, Copy, PartialEq)]
enum State {
    /// The variable has its value.
    Ready,
    /// The variable may not have it yet.
    Pending,
    /// The variable is being bound: only function values, which run later, see it.
    Opening,
}

/// Names that hold in a stretch of text.
#[derive(Default)]
struct Scope {
    variables: HashMap<Symbol, (u32, State)>,
    functions: HashMap<Symbol, FunctionId>,
    modules: HashMap<Symbol, ModuleId>,
}

impl Scope {
    /// The definitions of `block`.
    fn of(block: &Block) -> Scope {
        Scope {
            variables: HashMap::new(),
            functions: block.functions.iter().copied().collect(),
            modules: block.modules.iter().copied().collect(),
        }
    }
}

/// The scopes that share a frame, innermost last.
#[derive(Default)]
struct Frame {
    scopes: Vec<Scope>,
    used: u32,
    size: FrameSize,
}

struct Resolver<'a> {
    program: &'a mut Program,
    complaints: &'a mut Vec<Complaint>,
    /// Definitions at the top level of each unit.
    definitions: Vec<Scope>,
    suggestions: Suggestions,
    unit: UnitId,
    /// Innermost last; the first is that of the unit.
    frames: Vec<Frame>,
    depth: u32,
}

impl Resolver<'_> {
    fn unit(&mut self, unit: UnitId) {
        self.unit = unit;
        let mut body = std::mem::take(&mut self.program[unit].body);
        let frame = self.in_frame(|resolver| resolver.block_body(&mut body));
        self.program[unit].body = body;
        self.program[unit].frame = frame;
    }

    /// Runs `f` with a new innermost frame, and hands back the frame's size.
    fn in_frame(&mut self, f: impl FnOnce(&mut Self)) -> FrameSize {
        self.frames.push(Frame { scopes: vec![Scope::default()], ..Frame::default() });
        f(self);
        self.frames.pop().map_or(0, |frame| frame.size)
    }

    /// Runs `f` in an inner scope with room for its variables.
    fn in_room(&mut self, room: &mut Room, f: impl FnOnce(&mut Self)) {
        match room {
            Room::Own(size) => *size = self.in_frame(f),
            Room::Shared => {
                let used = self.frame().used;
                self.frame().scopes.push(Scope::default());
                f(self);
                self.frame().scopes.pop();
                self.frame().used = used;
            }
        }
    }

    /// The innermost frame; there is one while anything is resolved.
    fn frame(&mut self) -> &mut Frame {
        if self.frames.is_empty() {
            self.frames.push(Frame { scopes: vec![Scope::default()], ..Frame::default() });
        }
        let last = self.frames.len() - 1;
        &mut self.frames[last]
    }

    fn declare(&mut self, name: Symbol, state: State) -> Slot {
        if name.is_special() {
            return Slot::Special;
        }
        let frame = self.frame();
        let slot = frame.used;
        let Some(scope) = frame.scopes.last_mut() else { return Slot::Special };
        if let Some((slot, known)) = scope.variables.get_mut(&name) {
            *known = state;
            return Slot::Local(*slot);
        }
        scope.variables.insert(name, (slot, state));
        frame.used += 1;
        frame.size = frame.size.max(frame.used);
        Slot::Local(slot)
    }

    /// A block among children, with a scope of its own.
    fn block(&mut self, block: &mut Block) {
        let keeps = block.has_literal && !block.assignments.is_empty();
        let mut room = if keeps { Room::Own(0) } else { Room::Shared };
        self.in_room(&mut room, |resolver| resolver.block_body(block));
        block.room = Some(room);
    }

    /// A block in the scope that is open.
    fn block_body(&mut self, block: &mut Block) {
        let Scope { functions, modules, .. } = Scope::of(block);
        if let Some(scope) = self.frame().scopes.last_mut() {
            (scope.functions, scope.modules) = (functions, modules);
        }
        for binding in &mut block.assignments {
            if let Some(name) = binding.name {
                binding.slot = self.declare(name, State::Pending);
            }
        }
        for &(_, id) in &block.functions {
            self.function(id);
        }
        for &(_, id) in &block.modules {
            self.module(id);
        }
        for binding in &mut block.assignments {
            self.expr(binding.value);
            if let Some(name) = binding.name {
                self.declare(name, State::Ready);
            }
        }
        for &id in &block.statements {
            self.statement(id);
        }
    }

    fn function(&mut self, id: FunctionId) {
        let placeholder = Function { name: None, parameters: Vec::new(), body: ExprId(0), frame: 0 };
        let mut function = std::mem::replace(&mut self.program[id], placeholder);
        self.defaults(&function.parameters);
        function.frame = self.in_frame(|resolver| {
            resolver.parameters(&mut function.parameters);
            resolver.expr(function.body);
        });
        self.program[id] = function;
    }

    fn module(&mut self, id: ModuleId) {
        let name = self.program[id].name;
        let placeholder = Module { name, parameters: Vec::new(), body: Block::default(), frame: 0 };
        let mut module = std::mem::replace(&mut self.program[id], placeholder);
        self.defaults(&module.parameters);
        module.frame = self.in_frame(|resolver| {
            resolver.parameters(&mut module.parameters);
            resolver.block_body(&mut module.body);
        });
        self.program[id] = module;
    }

    /// Defaults are evaluated where the function or module was defined, and do not see the parameters.
    fn defaults(&mut self, parameters: &[Parameter]) {
        for default in parameters.iter().filter_map(|parameter| parameter.default) {
            self.expr(default);
        }
    }

    fn parameters(&mut self, parameters: &mut [Parameter]) {
        for parameter in parameters {
            parameter.slot = self.declare(parameter.name, State::Ready);
        }
    }

    fn statement(&mut self, id: StatementId) {
        let modifiers = self.program[id].modifiers;
        let span = self.program[id].span;
        let placeholder = Statement { modifiers, kind: StatementKind::Block(Block::default()), span };
        let mut statement = std::mem::replace(&mut self.program[id], placeholder);
        with_room(|| self.statement_kind(&mut statement.kind));
        self.program[id] = statement;
    }

    fn statement_kind(&mut self, kind: &mut StatementKind) {
        match kind {
            StatementKind::Block(block) => self.block(block),
            StatementKind::If { condition, then, otherwise } => {
                self.expr(*condition);
                self.block(then);
                if let Some(otherwise) = otherwise {
                    self.block(otherwise);
                }
            }
            StatementKind::For { bindings, body, room, .. } | StatementKind::Let { bindings, body, room } => {
                self.in_room(room, |resolver| {
                    resolver.bindings(bindings);
                    resolver.block(body);
                });
            }
            StatementKind::Call(call) => {
                call.target = self.module_target(call.name);
                self.arguments(&call.arguments);
                self.block(&mut call.children);
            }
        }
    }

    fn arguments(&mut self, arguments: &[Argument]) {
        for argument in arguments {
            self.expr(argument.value);
        }
    }

    /// Bindings one after the other, each seen by the next and by function values in itself.
    fn bindings(&mut self, bindings: &mut [Binding]) {
        for binding in bindings {
            match binding.name {
                None => self.expr(binding.value),
                Some(name) => {
                    let known =
                        self.frame().scopes.last().and_then(|scope| scope.variables.get(&name)).is_some();
                    if !known {
                        self.declare(name, State::Opening);
                    }
                    self.expr(binding.value);
                    binding.slot = self.declare(name, State::Ready);
                }
            }
        }
    }

    fn expr(&mut self, id: ExprId) {
        if self.depth == DEEPEST {
            let text = format!("this expression is more than {DEEPEST} levels deep");
            self.complaints.push(Complaint::error(self.program.span(id), text));
            return;
        }
        self.depth += 1;
        let mut expr = std::mem::replace(&mut self.program[id], Expr::Undef);
        with_room(|| self.expr_kind(&mut expr));
        self.program[id] = expr;
        self.depth -= 1;
    }

    fn expr_kind(&mut self, expr: &mut Expr) {
        match expr {
            Expr::Undef | Expr::Bool(_) | Expr::Number(_) | Expr::Text(_) => {}
            Expr::Variable { name, place } => *place = self.variable(*name),
            Expr::List(elements) => elements.iter().for_each(|&element| self.expr(element)),
            Expr::Range { begin, step, end } => {
                self.expr(*begin);
                step.iter().for_each(|&step| self.expr(step));
                self.expr(*end);
            }
            Expr::Unary { operand, .. } => self.expr(*operand),
            Expr::Binary { left, right, .. } | Expr::Index { list: left, index: right } => {
                self.expr(*left);
                self.expr(*right);
            }
            Expr::Conditional { condition, then, otherwise } => {
                for part in [*condition, *then, *otherwise] {
                    self.expr(part);
                }
            }
            Expr::If { condition, then, otherwise } => {
                self.expr(*condition);
                self.expr(*then);
                otherwise.iter().for_each(|&part| self.expr(part));
            }
            Expr::Member { object: operand, .. } | Expr::Each(operand) => self.expr(*operand),
            Expr::Call(call) => self.call(call),
            Expr::Let(inner) | Expr::For(inner) => {
                let (bindings, body) = (&mut inner.bindings, inner.body);
                self.in_room(&mut inner.room, |resolver| {
                    resolver.bindings(bindings);
                    resolver.expr(body);
                });
            }
            Expr::While(inner) => {
                let (init, update) = (&mut inner.init, &mut inner.update);
                let (condition, body) = (inner.condition, inner.body);
                self.in_room(&mut inner.room, |resolver| {
                    resolver.bindings(init);
                    resolver.expr(condition);
                    resolver.expr(body);
                    resolver.bindings(update);
                });
            }
            Expr::Assert { arguments, body } | Expr::Echo { arguments, body } => {
                self.arguments(arguments);
                body.iter().for_each(|&body| self.expr(body));
            }
            Expr::Function(id) => self.function(*id),
        }
    }

    fn call(&mut self, call: &mut Call) {
        match &mut call.callee {
            Callee::Value(value) => self.expr(*value),
            Callee::Name { name, variable, function } => {
                (*variable, *function) = self.function_target(*name);
            }
        }
        self.arguments(&call.arguments);
    }

    /// Where a variable is, as far as can be told now.
    fn variable(&mut self, name: Symbol) -> Place {
        if name.is_special() {
            return Place::Special;
        }
        let mut places = self.places(name, |_| false);
        if self.program.names.text(name) == "PI" {
            places.push(Place::Pi);
        }
        if places.is_empty() && self.suggestions.variables.len() < MOST_SUGGESTIONS {
            let known =
                self.frames.iter().flat_map(|frame| &frame.scopes).flat_map(|scope| scope.variables.keys());
            let hint = self.suggest(name, known.copied().collect(), builtins::constants());
            self.suggestions.variables.insert(name, hint);
        }
        first_of(places)
    }

    /// The places where `name` may be, nearest first, up to the first that is certain and to the first scope where
    /// `stop` holds.
    fn places(&self, name: Symbol, stop: impl Fn(&Scope) -> bool) -> Vec<Place> {
        let mut places = Vec::new();
        for (up, (index, frame)) in self.frames.iter().enumerate().rev().enumerate() {
            for scope in frame.scopes.iter().rev() {
                if stop(scope) {
                    return places;
                }
                let Some(&(slot, state)) = scope.variables.get(&name) else { continue };
                if state == State::Opening && up == 0 {
                    continue;
                }
                places.push(match index {
                    0 => Place::Global { unit: self.unit, slot },
                    _ => Place::Local { up: up as u32, slot },
                });
                if state == State::Ready {
                    return places;
                }
            }
        }
        places
    }

    /// What `name(...)` calls: the variable where it holds a function, else the function. In one scope the function
    /// comes first.
    fn function_target(&mut self, name: Symbol) -> (Place, Target<FunctionId>) {
        let found = self.definition(|scope| scope.functions.get(&name).copied());
        let places = self.places(name, |scope| scope.functions.contains_key(&name));
        let function = match (found, builtins::function(self.program.names.text(name))) {
            (Some((id, home)), _) => Target::User { id, home },
            (None, Some(builtin)) => Target::Builtin(builtin),
            (None, None) => Target::Unknown,
        };
        let unknown = places.is_empty() && !name.is_special() && matches!(function, Target::Unknown);
        if unknown && self.suggestions.functions.len() < MOST_SUGGESTIONS {
            let known = self.known(|scope| scope.functions.keys().copied().collect());
            let hint = self.suggest(name, known, builtins::functions());
            self.suggestions.functions.insert(name, hint);
        }
        (if name.is_special() { Place::Special } else { first_of(places) }, function)
    }

    fn module_target(&mut self, name: Symbol) -> Target<ModuleId> {
        if let Some((id, home)) = self.definition(|scope| scope.modules.get(&name).copied()) {
            return Target::User { id, home };
        }
        if let Some(builtin) = builtins::module(self.program.names.text(name)) {
            return Target::Builtin(builtin);
        }
        if self.suggestions.modules.len() < MOST_SUGGESTIONS {
            let known = self.known(|scope| scope.modules.keys().copied().collect());
            let hint = self.suggest(name, known, builtins::modules());
            self.suggestions.modules.insert(name, hint);
        }
        Target::Unknown
    }

    /// The nearest definition: in the scopes around, then in the used units, the last one first.
    fn definition<Id>(&self, find: impl Fn(&Scope) -> Option<Id>) -> Option<(Id, Home)> {
        for (up, (index, frame)) in self.frames.iter().enumerate().rev().enumerate() {
            if let Some(id) = frame.scopes.iter().rev().find_map(&find) {
                let home = if index == 0 { Home::Unit(self.unit) } else { Home::Up(up as u32) };
                return Some((id, home));
            }
        }
        let uses = self.program[self.unit].uses.iter().rev();
        uses.copied().find_map(|unit| Some((find(&self.definitions[unit.0 as usize])?, Home::Unit(unit))))
    }

    /// All names of a kind that hold here.
    fn known(&self, names: impl Fn(&Scope) -> Vec<Symbol>) -> Vec<Symbol> {
        let uses = self.program[self.unit].uses.iter().map(|unit| &self.definitions[unit.0 as usize]);
        self.frames.iter().flat_map(|frame| &frame.scopes).chain(uses).flat_map(names).collect()
    }

    fn suggest(
        &self,
        name: Symbol,
        known: Vec<Symbol>,
        builtins: impl Iterator<Item = &'static str>,
    ) -> String {
        let names = &self.program.names;
        let mut candidates: Vec<&str> = known.into_iter().map(|symbol| names.text(symbol)).collect();
        builtins.for_each(|name| candidates.push(name));
        candidates.sort_unstable();
        suggest::closest(names.text(name), candidates).map_or_else(String::new, str::to_owned)
    }
}

fn first_of(mut places: Vec<Place>) -> Place {
    match places.len() {
        0 => Place::Unknown,
        1 => places.remove(0),
        _ => Place::FirstOf(places.into()),
    }
}
