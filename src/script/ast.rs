//! The syntax tree, in one arena, with room for what [`resolve`](super::resolve) finds out about names.

use super::builtins::Builtin;
use super::diagnostic::Span;
use super::names::{Names, Symbol};
use super::value::Text;
use std::rc::Rc;

/// A whole program: the main script and all that it includes and uses.
#[derive(Debug, Default)]
pub(super) struct Program {
    pub(super) names: Names,
    pub(super) expressions: Vec<Expr>,
    pub(super) spans: Vec<Span>,
    pub(super) statements: Vec<Statement>,
    pub(super) functions: Vec<Function>,
    pub(super) modules: Vec<Module>,
    /// The main script first, then used ones.
    pub(super) units: Vec<Unit>,
}

/// Declares an index into one of the arenas of [`Program`].
macro_rules! arena_index {
    ($name:ident, $field:ident, $item:ty) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) struct $name(pub(super) u32);

        impl std::ops::Index<$name> for Program {
            type Output = $item;

            fn index(&self, id: $name) -> &$item {
                &self.$field[id.0 as usize]
            }
        }

        impl std::ops::IndexMut<$name> for Program {
            fn index_mut(&mut self, id: $name) -> &mut $item {
                &mut self.$field[id.0 as usize]
            }
        }
    };
}

arena_index!(ExprId, expressions, Expr);
arena_index!(StatementId, statements, Statement);
arena_index!(FunctionId, functions, Function);
arena_index!(ModuleId, modules, Module);
arena_index!(UnitId, units, Unit);

impl Program {
    /// Where the expression stands.
    pub(super) fn span(&self, id: ExprId) -> Span {
        self.spans[id.0 as usize]
    }
}

/// A script with what it includes: one scope at the top, entered by the main program or through `use`.
#[derive(Debug)]
pub(super) struct Unit {
    /// The one name of its file.
    pub(super) name: String,
    pub(super) body: Block,
    /// What it uses, in order.
    pub(super) uses: Vec<UnitId>,
    pub(super) frame: FrameSize,
}

/// Number of variables a frame has room for.
pub(super) type FrameSize = u32;

/// An expression, or an element of a list, which may stand for any number of values.
#[derive(Debug)]
pub(super) enum Expr {
    Undef,
    Bool(bool),
    Number(f64),
    Text(Rc<Text>),
    Variable {
        name: Symbol,
        place: Place,
    },
    List(Vec<ExprId>),
    Range {
        begin: ExprId,
        step: Option<ExprId>,
        end: ExprId,
    },
    Unary {
        op: UnaryOp,
        operand: ExprId,
    },
    Binary {
        op: BinaryOp,
        left: ExprId,
        right: ExprId,
    },
    Conditional {
        condition: ExprId,
        then: ExprId,
        otherwise: ExprId,
    },
    Index {
        list: ExprId,
        index: ExprId,
    },
    Member {
        object: ExprId,
        name: Symbol,
    },
    Call(Box<Call>),
    Let(Box<Let>),
    Assert {
        arguments: Vec<Argument>,
        body: Option<ExprId>,
    },
    Echo {
        arguments: Vec<Argument>,
        body: Option<ExprId>,
    },
    Function(FunctionId),
    /// All values of a list.
    Each(ExprId),
    /// The elements of `body` for all values of the bindings.
    For(Box<Let>),
    /// `for (init; condition; update) body`.
    While(Box<While>),
    /// An element that may be missing.
    If {
        condition: ExprId,
        then: ExprId,
        otherwise: Option<ExprId>,
    },
}

impl Expr {
    /// Whether it ends with an expression that takes in all that follows.
    pub(super) fn is_open(&self) -> bool {
        matches!(self, Expr::Let(_) | Expr::Assert { .. } | Expr::Echo { .. } | Expr::Function(_))
    }
}

/// Operators before their operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UnaryOp {
    Plus,
    Minus,
    Not,
    BitNot,
}

/// Operators between their operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BinaryOp {
    Or,
    And,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    BitOr,
    BitAnd,
    ShiftLeft,
    ShiftRight,
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
    Power,
}

impl BinaryOp {
    /// How it is written.
    pub(super) fn text(self) -> &'static str {
        match self {
            BinaryOp::Or => "||",
            BinaryOp::And => "&&",
            BinaryOp::Equal => "==",
            BinaryOp::NotEqual => "!=",
            BinaryOp::Less => "<",
            BinaryOp::LessEqual => "<=",
            BinaryOp::Greater => ">",
            BinaryOp::GreaterEqual => ">=",
            BinaryOp::BitOr => "|",
            BinaryOp::BitAnd => "&",
            BinaryOp::ShiftLeft => "<<",
            BinaryOp::ShiftRight => ">>",
            BinaryOp::Add => "+",
            BinaryOp::Subtract => "-",
            BinaryOp::Multiply => "*",
            BinaryOp::Divide => "/",
            BinaryOp::Modulo => "%",
            BinaryOp::Power => "^",
        }
    }
}

impl UnaryOp {
    /// How it is written.
    pub(super) fn text(self) -> &'static str {
        match self {
            UnaryOp::Plus => "+",
            UnaryOp::Minus => "-",
            UnaryOp::Not => "!",
            UnaryOp::BitNot => "~",
        }
    }
}

/// Where the value of a variable is found at run time.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    /// Nowhere, and before names are resolved.
    Unknown,
    /// On the stack of a `$` variable.
    Special,
    /// In the frame `up` frames out from the current one.
    Local { up: u32, slot: u32 },
    /// At the top level of a unit.
    Global { unit: UnitId, slot: u32 },
    /// The number pi.
    Pi,
    /// In the first of these places that has been assigned by then.
    FirstOf(Box<[Place]>),
}

/// Where a new variable goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    /// The dynamic scope, for a `$` variable.
    Special,
    /// The current frame.
    Local(u32),
}

/// `name = value`.
#[derive(Debug)]
pub(super) struct Binding {
    /// `None` for a value without a name, which is evaluated and dropped.
    pub(super) name: Option<Symbol>,
    pub(super) value: ExprId,
    pub(super) slot: Slot,
    pub(super) span: Span,
}

/// Bindings with what sees them.
#[derive(Debug)]
pub(super) struct Let {
    pub(super) bindings: Vec<Binding>,
    pub(super) body: ExprId,
    pub(super) room: Room,
}

/// A C-style `for` among the elements of a list.
#[derive(Debug)]
pub(super) struct While {
    pub(super) init: Vec<Binding>,
    pub(super) condition: ExprId,
    pub(super) update: Vec<Binding>,
    pub(super) body: ExprId,
    pub(super) room: Room,
}

/// Where the variables of an inner scope live.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Room {
    /// In the frame around.
    Shared,
    /// In a frame of their own, since a function value may keep them.
    Own(FrameSize),
}

/// An argument of a call.
#[derive(Debug)]
pub(super) struct Argument {
    pub(super) name: Option<Symbol>,
    pub(super) value: ExprId,
    pub(super) span: Span,
}

/// A call of a function.
#[derive(Debug)]
pub(super) struct Call {
    pub(super) callee: Callee,
    pub(super) arguments: Vec<Argument>,
    /// Whether some argument is a `$` variable, which lives until the call is over.
    pub(super) has_special: bool,
}

/// What is called.
#[derive(Debug)]
pub(super) enum Callee {
    /// `name(...)`: the value of the variable where that is a function, else the named function.
    Name { name: Symbol, variable: Place, function: Target<FunctionId> },
    /// The value of an expression.
    Value(ExprId),
}

/// What a name of a function or a module means.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target<Id> {
    Unknown,
    Builtin(&'static Builtin),
    User { id: Id, home: Home },
}

/// The frame in which something was defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Home {
    /// Frames out from the current one.
    Up(u32),
    /// The top level of a unit.
    Unit(UnitId),
}

/// A parameter of a function or a module.
#[derive(Debug)]
pub(super) struct Parameter {
    pub(super) name: Symbol,
    pub(super) default: Option<ExprId>,
    pub(super) slot: Slot,
}

/// A function, named or a value.
#[derive(Debug)]
pub(super) struct Function {
    pub(super) name: Option<Symbol>,
    pub(super) parameters: Vec<Parameter>,
    pub(super) body: ExprId,
    pub(super) frame: FrameSize,
}

/// A module.
#[derive(Debug)]
pub(super) struct Module {
    pub(super) name: Symbol,
    pub(super) parameters: Vec<Parameter>,
    pub(super) body: Block,
    pub(super) frame: FrameSize,
}

/// Statements with a scope of their own. Definitions hold throughout, wherever they stand; assignments are made
/// before any statement is carried out.
#[derive(Debug, Default)]
pub(super) struct Block {
    pub(super) assignments: Vec<Binding>,
    pub(super) functions: Vec<(Symbol, FunctionId)>,
    pub(super) modules: Vec<(Symbol, ModuleId)>,
    pub(super) statements: Vec<StatementId>,
    /// Whether a function value stands in it.
    pub(super) has_literal: bool,
    pub(super) room: Option<Room>,
}

/// Something that makes geometry.
#[derive(Debug)]
pub(super) struct Statement {
    pub(super) modifiers: Modifiers,
    pub(super) kind: StatementKind,
    pub(super) span: Span,
}

/// The marks before a statement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Modifiers {
    /// `*`: leave it out.
    pub(super) disable: bool,
    /// `!`: make this alone.
    pub(super) root: bool,
    /// `#`: show it as well.
    pub(super) highlight: bool,
    /// `%`: only show it.
    pub(super) background: bool,
}

/// The kinds of statement.
#[derive(Debug)]
pub(super) enum StatementKind {
    Call(ModuleCall),
    If { condition: ExprId, then: Block, otherwise: Option<Block> },
    For { bindings: Vec<Binding>, body: Block, room: Room, intersect: bool },
    Let { bindings: Vec<Binding>, body: Block, room: Room },
    Block(Block),
}

/// A call of a module with its children.
#[derive(Debug)]
pub(super) struct ModuleCall {
    pub(super) name: Symbol,
    pub(super) target: Target<ModuleId>,
    pub(super) arguments: Vec<Argument>,
    pub(super) children: Block,
}
