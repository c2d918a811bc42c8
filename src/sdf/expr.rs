use super::op::{Binary, Blend, Unary};
use super::primitive::Primitive;
use super::real::Real;
use super::{Field, Tape};
use crate::math::{Affine3, Vec3};
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

/// A formula over the coordinates x, y, z. Copies are cheap and share what they are made of.
///
/// Arithmetic operators and the methods build it; [`Expr::compile`] makes the [`Tape`] that evaluates it, in which equal
/// parts are computed once.
///
/// ```
/// use ogee::math::Vec3;
/// use ogee::sdf::{Expr, Field};
///
/// let [x, y, z] = Expr::axes();
/// let ball = (x.square() + y.square() + z.square()).sqrt() - 1.0;
/// let half = ball.max(-z);
/// assert_eq!(half.compile().value(Vec3::new(0.0, 3.0, 4.0)), 4.0);
/// ```
#[derive(Clone)]
pub struct Expr(Arc<Node>);

/// An operation and what it is applied to.
pub(super) struct Node {
    pub(super) op: Op,
    pub(super) args: Vec<Expr>,
}

/// What a node does with its arguments.
#[derive(Clone)]
pub(super) enum Op {
    /// A coordinate; no argument.
    Axis(u8),
    /// No argument.
    Constant(f64),
    Unary(Unary),
    Binary(Binary),
    /// To the power of a constant.
    Power(f64),
    /// The scalar product of a row with up to three arguments, plus a constant.
    Linear([f64; 4]),
    /// The Euclidean norm of two or three arguments.
    Norm,
    /// The distance from an orthant of two or three arguments.
    Corner,
    /// The lesser of two, blended.
    Blend(Blend),
    /// Of three coordinates.
    Primitive(Primitive),
    /// A field at three coordinates.
    Field(Arc<dyn Field>),
    /// The first argument with its coordinates replaced by the other three.
    Place,
}

impl Expr {
    pub(super) fn new(op: Op, args: Vec<Expr>) -> Expr {
        Expr(Arc::new(Node { op, args }))
    }

    pub(super) fn node(&self) -> &Node {
        &self.0
    }

    /// A name for the node that lives as long as it does.
    pub(super) fn address(&self) -> usize {
        Arc::as_ptr(&self.0) as usize
    }

    /// The number, when it is a constant.
    pub fn as_constant(&self) -> Option<f64> {
        if let Op::Constant(x) = self.0.op { Some(x) } else { None }
    }

    /// The first coordinate.
    pub fn x() -> Expr {
        Expr::new(Op::Axis(0), Vec::new())
    }

    /// The second coordinate.
    pub fn y() -> Expr {
        Expr::new(Op::Axis(1), Vec::new())
    }

    /// The third coordinate.
    pub fn z() -> Expr {
        Expr::new(Op::Axis(2), Vec::new())
    }

    /// The three coordinates.
    pub fn axes() -> [Expr; 3] {
        [Expr::x(), Expr::y(), Expr::z()]
    }

    /// A number.
    pub fn constant(x: f64) -> Expr {
        Expr::new(Op::Constant(x), Vec::new())
    }

    /// An operation on one formula.
    pub fn unary(op: Unary, a: &Expr) -> Expr {
        match (op, &a.0.op) {
            (_, &Op::Constant(x)) => Expr::constant(op.apply(x)),
            (Unary::Neg, Op::Unary(Unary::Neg)) => a.0.args[0].clone(),
            _ => Expr::new(Op::Unary(op), vec![a.clone()]),
        }
    }

    /// An operation on two formulas.
    pub fn binary(op: Binary, a: &Expr, b: &Expr) -> Expr {
        match (op, a.as_constant(), b.as_constant()) {
            (_, Some(x), Some(y)) => Expr::constant(op.apply(x, y)),
            (Binary::Mul | Binary::Div, None, Some(1.0)) => a.clone(),
            (Binary::Pow, None, Some(exponent)) => Expr::new(Op::Power(exponent), vec![a.clone()]),
            _ => Expr::new(Op::Binary(op), vec![a.clone(), b.clone()]),
        }
    }

    /// A primitive at these coordinates.
    pub fn primitive(primitive: Primitive) -> Expr {
        Expr::new(Op::Primitive(primitive), Expr::axes().to_vec())
    }

    /// Any field as a part of a formula.
    pub fn field(field: Arc<dyn Field>) -> Expr {
        Expr::new(Op::Field(field), Expr::axes().to_vec())
    }

    /// This formula with its coordinates replaced: its value at the point that `coordinates` give.
    pub fn at(&self, coordinates: [Expr; 3]) -> Expr {
        if self.as_constant().is_some() {
            return self.clone();
        }
        let [x, y, z] = coordinates;
        Expr::new(Op::Place, vec![self.clone(), x, y, z])
    }

    /// This formula at points that are mapped first: moves what it describes by the *inverse* of the map.
    pub fn at_affine(&self, map: &Affine3) -> Expr {
        let (m, t) = (map.matrix3, map.translation);
        self.at(std::array::from_fn(|i| {
            Expr::linear([m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]], &Expr::axes())
        }))
    }

    /// The scalar product of the first numbers of `row` with `args`, plus its last number.
    pub(super) fn linear(row: [f64; 4], args: &[Expr; 3]) -> Expr {
        Expr::new(Op::Linear(row), args.to_vec())
    }

    /// The Euclidean norm of two formulas; its gradient at zero is zero.
    pub fn norm2(a: &Expr, b: &Expr) -> Expr {
        Expr::new(Op::Norm, vec![a.clone(), b.clone()])
    }

    /// The distance from where both are negative, when both are distances whose gradients are at right angles: the
    /// extrusion of an outline `a` between two planes `b`. Exact when they are.
    pub fn corner2(a: &Expr, b: &Expr) -> Expr {
        Expr::new(Op::Corner, vec![a.clone(), b.clone()])
    }

    /// The lesser of two with the edge between them filled.
    pub fn blend_min(&self, other: &Expr, blend: Blend) -> Expr {
        if blend.size() == 0.0 {
            return self.min(other);
        }
        Expr::new(Op::Blend(blend), vec![self.clone(), other.clone()])
    }

    /// The greater of two with the edge between them filled.
    pub fn blend_max(&self, other: &Expr, blend: Blend) -> Expr {
        -(-self).blend_min(&-other, blend)
    }

    /// The form that can be evaluated.
    pub fn compile(&self) -> Tape {
        Tape::new(self)
    }

    /// The value at a point; compile it when there are more.
    pub fn eval(&self, point: Vec3) -> f64 {
        self.compile().value(point)
    }
}

macro_rules! methods {
    ({ $($(#[$one:meta])* $unary:ident $one_op:ident;)* } { $($(#[$two:meta])* $binary:ident $two_op:ident;)* }) => {
        impl Expr {
            $($(#[$one])* pub fn $unary(&self) -> Expr { Expr::unary(Unary::$one_op, self) })*
            $($(#[$two])* pub fn $binary(&self, other: impl Into<Expr>) -> Expr {
                Expr::binary(Binary::$two_op, self, &other.into())
            })*
        }
    };
}

methods! { {
    /// The magnitude.
    abs Abs;
    /// One divided by it.
    recip Recip;
    /// The square root; NaN of negative numbers.
    sqrt Sqrt;
    /// The cube root.
    cbrt Cbrt;
    /// The square.
    square Square;
    /// The greatest whole number not above.
    floor Floor;
    /// The least whole number not below.
    ceil Ceil;
    /// The nearest whole number, halves away from zero.
    round Round;
    /// The sine of an angle in radians.
    sin Sin;
    /// The cosine of an angle in radians.
    cos Cos;
    /// The tangent of an angle in radians.
    tan Tan;
    /// The arc sine, in radians.
    asin Asin;
    /// The arc cosine, in radians.
    acos Acos;
    /// The arc tangent, in radians.
    atan Atan;
    /// e to this power.
    exp Exp;
    /// The natural logarithm.
    ln Ln;
    /// 1 where it is zero, otherwise 0.
    not Not;
} {
    /// The lesser of two.
    min Min;
    /// The greater of two.
    max Max;
    /// The angle of the point (other, self), in radians.
    atan2 Atan2;
    /// -1, 0 or 1 as it is less than, equal to or greater than the other.
    compare Compare;
    /// The least remainder that is not negative.
    modulo Mod;
    /// To the power of the other.
    pow Pow;
    /// This one where it is zero, otherwise the other.
    and And;
    /// This one where it is not zero, otherwise the other.
    or Or;
} }

impl From<f64> for Expr {
    fn from(x: f64) -> Expr {
        Expr::constant(x)
    }
}

impl From<&Expr> for Expr {
    fn from(expr: &Expr) -> Expr {
        expr.clone()
    }
}

macro_rules! operators {
    ($($name:ident $method:ident $op:ident;)*) => {$(
        impl<T: Into<Expr>> $name<T> for &Expr {
            type Output = Expr;

            fn $method(self, other: T) -> Expr {
                Expr::binary(Binary::$op, self, &other.into())
            }
        }

        impl<T: Into<Expr>> $name<T> for Expr {
            type Output = Expr;

            fn $method(self, other: T) -> Expr {
                Expr::binary(Binary::$op, &self, &other.into())
            }
        }

        impl $name<&Expr> for f64 {
            type Output = Expr;

            fn $method(self, other: &Expr) -> Expr {
                Expr::binary(Binary::$op, &self.into(), other)
            }
        }

        impl $name<Expr> for f64 {
            type Output = Expr;

            fn $method(self, other: Expr) -> Expr {
                Expr::binary(Binary::$op, &self.into(), &other)
            }
        }
    )*};
}

operators! {
    Add add Add;
    Sub sub Sub;
    Mul mul Mul;
    Div div Div;
}

impl Neg for &Expr {
    type Output = Expr;

    fn neg(self) -> Expr {
        Expr::unary(Unary::Neg, self)
    }
}

impl Neg for Expr {
    type Output = Expr;

    fn neg(self) -> Expr {
        Expr::unary(Unary::Neg, &self)
    }
}

impl fmt::Debug for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tape = self.compile();
        for (id, step) in tape.steps.iter().enumerate() {
            write!(f, "_{id} {:?} {:?}; ", step.op, step.args())?;
        }
        Ok(())
    }
}

impl fmt::Debug for Op {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Op::Axis(axis) => write!(f, "Axis({axis})"),
            Op::Constant(x) => write!(f, "Constant({x:?})"),
            Op::Unary(op) => op.fmt(f),
            Op::Binary(op) => op.fmt(f),
            Op::Power(exponent) => write!(f, "Power({exponent:?})"),
            Op::Linear(row) => write!(f, "Linear({row:?})"),
            Op::Norm => f.write_str("Norm"),
            Op::Corner => f.write_str("Corner"),
            Op::Blend(blend) => blend.fmt(f),
            Op::Primitive(primitive) => primitive.fmt(f),
            Op::Field(_) => f.write_str("Field"),
            Op::Place => f.write_str("Place"),
        }
    }
}

/// Takes long chains apart one by one: dropping them by recursion would run out of stack.
impl Drop for Node {
    fn drop(&mut self) {
        let mut left = std::mem::take(&mut self.args);
        while let Some(Expr(node)) = left.pop() {
            if let Some(mut node) = Arc::into_inner(node) {
                left.append(&mut node.args);
            }
        }
    }
}

impl Op {
    /// The operation on plain numbers and all other kinds of numbers.
    ///
    /// Fields are not among them: they are asked for values, ranges and slopes by those who evaluate.
    #[inline(always)]
    pub(super) fn apply<T: Real>(&self, args: [T; 3], arity: usize) -> T {
        let [a, b, c] = args;
        match self {
            Op::Unary(op) => op.apply(a),
            Op::Binary(op) => op.apply(a, b),
            Op::Power(exponent) => a.power(*exponent),
            Op::Linear(row) => linear(row, args),
            Op::Norm if arity == 2 => T::norm([a, b]),
            Op::Norm => T::norm([a, b, c]),
            Op::Corner if arity == 2 => T::corner([a, b]),
            Op::Corner => T::corner([a, b, c]),
            Op::Blend(blend) => blend.min(a, b),
            Op::Primitive(primitive) => primitive.apply(args),
            Op::Constant(x) => T::of(*x),
            Op::Axis(_) | Op::Field(_) | Op::Place => a,
        }
    }
}

/// A row of a matrix with a vector, plus a constant; what is zero is left out, so that it cannot make NaN of infinity.
#[inline(always)]
pub(super) fn linear<T: Real>(row: &[f64; 4], args: [T; 3]) -> T {
    let mut sum: Option<T> = None;
    for (&factor, x) in row.iter().zip(args) {
        if factor != 0.0 {
            let term = if factor == 1.0 { x } else { T::of(factor) * x };
            sum = Some(sum.map_or(term, |sum| sum + term));
        }
    }
    match sum {
        Some(sum) if row[3] == 0.0 => sum,
        Some(sum) => sum + T::of(row[3]),
        None => T::of(row[3]),
    }
}
