//! Formulas in plain operations: primitives, norms and blends taken apart, for formats that know no others.

use super::Expr;
use super::expr::Op;
use super::graph::Graph;
use super::op::{Binary, Unary};
use super::real::Real;
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A plain operation; arguments are indices of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// A coordinate: 0, 1 or 2.
    Axis(u8),
    /// A number.
    Constant(f64),
    /// Of one argument.
    Unary(Unary, u32),
    /// Of two arguments.
    Binary(Binary, u32, u32),
}

impl Expr {
    /// The formula of plain operations, the last of which is the result; arguments must be earlier ones.
    ///
    /// ```
    /// use ogee::math::Vec3;
    /// use ogee::sdf::Expr;
    ///
    /// let [x, y, _] = Expr::axes();
    /// let wave = x.sin() * 2.0 + y;
    /// let again = Expr::of_operations(&wave.operations().unwrap());
    /// assert_eq!(again.eval(Vec3::ONE), wave.eval(Vec3::ONE));
    /// ```
    ///
    /// # Panics
    /// When there is no operation, or an argument is not an earlier one.
    pub fn of_operations(operations: &[Operation]) -> Expr {
        let mut made: Vec<Expr> = Vec::with_capacity(operations.len());
        for &operation in operations {
            let expr = match operation {
                Operation::Axis(axis) => Expr::axes()[usize::from(axis)].clone(),
                Operation::Constant(x) => Expr::constant(x),
                Operation::Unary(op, a) => Expr::unary(op, &made[a as usize]),
                Operation::Binary(op, a, b) => Expr::binary(op, &made[a as usize], &made[b as usize]),
            };
            made.push(expr);
        }
        made.pop().expect("there is a result")
    }

    /// The formula in plain operations, the result last; equal ones are there once. They give the same numbers,
    /// though not always the same zero. `None` when a field that is no formula (a mesh, a polygon, a tube) is part of
    /// it.
    pub fn operations(&self) -> Option<Vec<Operation>> {
        let (graph, root) = Graph::of(self);
        let sheet = Sheet::default();
        let mut symbols: Vec<Symbol<'_>> = Vec::with_capacity(graph.steps.len());
        for step in &graph.steps {
            let mut args = [Symbol::Number(0.0); 3];
            for (slot, &arg) in args.iter_mut().zip(step.args()) {
                *slot = symbols[arg as usize];
            }
            symbols.push(match step.op {
                Op::Field(_) => return None,
                Op::Axis(axis) => sheet.write(Operation::Axis(axis)),
                _ => step.op.apply(args, usize::from(step.arity)),
            });
        }
        let result = sheet.id(symbols[root as usize]);
        drop(symbols);
        Some(needed(&sheet.operations.into_inner(), result))
    }
}

/// The operations that a result needs, renumbered, the result last.
fn needed(all: &[Operation], result: u32) -> Vec<Operation> {
    let mut used = vec![false; all.len()];
    used[result as usize] = true;
    for (id, operation) in all.iter().enumerate().rev().filter(|&(id, _)| id <= result as usize) {
        if used[id] {
            operation.args().for_each(|arg| used[arg as usize] = true);
        }
    }
    let mut names = vec![0; all.len()];
    let mut kept = Vec::new();
    for (id, operation) in all.iter().enumerate().filter(|&(id, _)| used[id]) {
        names[id] = kept.len() as u32;
        kept.push(operation.renamed(|arg| names[arg as usize]));
    }
    kept
}

impl Operation {
    /// Indices of its arguments.
    pub fn args(self) -> impl Iterator<Item = u32> {
        let (first, second) = match self {
            Operation::Axis(_) | Operation::Constant(_) => (None, None),
            Operation::Unary(_, a) => (Some(a), None),
            Operation::Binary(_, a, b) => (Some(a), Some(b)),
        };
        first.into_iter().chain(second)
    }

    fn renamed(self, name: impl Fn(u32) -> u32) -> Operation {
        match self {
            Operation::Unary(op, a) => Operation::Unary(op, name(a)),
            Operation::Binary(op, a, b) => Operation::Binary(op, name(a), name(b)),
            other => other,
        }
    }
}

/// What symbols are written on.
#[derive(Default)]
struct Sheet {
    operations: RefCell<Vec<Operation>>,
}

impl Sheet {
    fn write(&self, operation: Operation) -> Symbol<'_> {
        let mut operations = self.operations.borrow_mut();
        operations.push(operation);
        Symbol::Written { sheet: self, id: operations.len() as u32 - 1 }
    }

    fn id(&self, symbol: Symbol<'_>) -> u32 {
        match symbol {
            Symbol::Written { id, .. } => id,
            Symbol::Number(x) => {
                self.write(Operation::Constant(x));
                self.operations.borrow().len() as u32 - 1
            }
        }
    }
}

/// A number, or the name of an operation.
#[derive(Clone, Copy)]
enum Symbol<'a> {
    Number(f64),
    Written { sheet: &'a Sheet, id: u32 },
}

impl<'a> Symbol<'a> {
    fn unary(self, op: Unary) -> Symbol<'a> {
        match self {
            Symbol::Number(x) => Symbol::Number(op.apply(x)),
            Symbol::Written { sheet, id } => sheet.write(Operation::Unary(op, id)),
        }
    }

    fn binary(self, op: Binary, other: Symbol<'a>) -> Symbol<'a> {
        let sheet = match (self, other) {
            (Symbol::Number(a), Symbol::Number(b)) => return Symbol::Number(op.apply(a, b)),
            (Symbol::Written { sheet, .. }, _) | (_, Symbol::Written { sheet, .. }) => sheet,
        };
        let (a, b) = (sheet.id(self), sheet.id(other));
        sheet.write(Operation::Binary(op, a, b))
    }
}

macro_rules! symbolic {
    (operators: $($name:ident $method:ident),*; unary: $($unary:ident $one:ident)*; binary: $($binary:ident $two:ident)*) => {
        $(
            impl<'a> $name for Symbol<'a> {
                type Output = Symbol<'a>;

                fn $method(self, other: Symbol<'a>) -> Symbol<'a> {
                    self.binary(Binary::$name, other)
                }
            }
        )*

        impl<'a> Real for Symbol<'a> {
            $(fn $unary(self) -> Symbol<'a> { self.unary(Unary::$one) })*
            $(fn $binary(self, other: Symbol<'a>) -> Symbol<'a> { self.binary(Binary::$two, other) })*

            fn of(x: f64) -> Symbol<'a> {
                Symbol::Number(x)
            }

            fn power(self, exponent: f64) -> Symbol<'a> {
                self.binary(Binary::Pow, Symbol::Number(exponent))
            }

            /// -1 below zero and otherwise 0 is the condition; what it does not hold for becomes 0.
            fn select(self, negative: Symbol<'a>, otherwise: Symbol<'a>) -> Symbol<'a> {
                let zero = Symbol::Number(0.0);
                let below = self.compare(zero).min(zero);
                below.and(negative).or(below.not().and(otherwise))
            }

            fn sided(self, negative: Symbol<'a>, otherwise: Symbol<'a>) -> Symbol<'a> {
                self.select(negative, otherwise)
            }

            fn switched(self, zero: Symbol<'a>, otherwise: Symbol<'a>) -> Symbol<'a> {
                self.not().and(zero).or(self.and(otherwise))
            }

            fn is_certain(self) -> bool {
                matches!(self, Symbol::Number(_))
            }
        }
    };
}

symbolic! {
    operators: Add add, Sub sub, Mul mul, Div div;
    unary: abs Abs square Square sqrt Sqrt cbrt Cbrt recip Recip floor Floor ceil Ceil round Round sin Sin cos Cos
        tan Tan asin Asin acos Acos atan Atan exp Exp ln Ln not Not;
    binary: atan2 Atan2 min Min max Max compare Compare modulo Mod pow Pow and And or Or
}

impl<'a> Neg for Symbol<'a> {
    type Output = Symbol<'a>;

    fn neg(self) -> Symbol<'a> {
        self.unary(Unary::Neg)
    }
}
