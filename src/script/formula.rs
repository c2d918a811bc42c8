//! Numbers that are not known yet: what a function does with them is written down as a formula.
//!
//! `implicit(function(p) ...)` calls its function once, with symbols for coordinates. Arithmetic, the functions of
//! numbers, comparisons and `?:` on symbols make formulas; whatever would have to know the number cannot be traced, and
//! is an error where it stands.

use super::ast::{BinaryOp, UnaryOp};
use super::budget::{Budget, Fault, Outcome, undefined};
use super::heap;
use super::value::{List, Value};
use crate::sdf::{Binary, Expr, Unary};
use std::f64::consts::PI;

/// Bytes an operation of a formula takes, roughly. Formulas share what they are made of: they are counted, and never
/// given back.
const NODE: usize = 160;

/// A formula as a value; a number where it is known after all.
pub(super) fn value(expr: Expr) -> Value {
    match expr.as_constant() {
        Some(x) => Value::Number(x),
        None => {
            heap::took(NODE);
            Value::Formula(expr)
        }
    }
}

/// A number or a formula as a formula.
pub(super) fn expr(value: &Value) -> Option<Expr> {
    match value {
        Value::Number(x) => Some(Expr::constant(*x)),
        Value::Bool(holds) => Some(Expr::constant(f64::from(u8::from(*holds)))),
        Value::Formula(expr) => Some(expr.clone()),
        _ => None,
    }
}

/// Whether a formula is part of a value: a number, a vector or a matrix.
pub(super) fn is_in(value: &Value) -> bool {
    match value {
        Value::Formula(_) => true,
        Value::List(list) => is_in_list(list),
        _ => false,
    }
}

/// Whether a formula is part of a vector or a matrix.
pub(super) fn is_in_list(list: &List) -> bool {
    let in_row = |row: &List| row.iter().any(|value| matches!(value, Value::Formula(_)));
    list.numbers().is_none()
        && list.iter().any(|value| match &value {
            Value::Formula(_) => true,
            Value::List(row) => row.numbers().is_none() && in_row(row),
            _ => false,
        })
}

/// `op` of a formula.
pub(super) fn unary(op: UnaryOp, a: &Expr) -> Outcome {
    match op {
        UnaryOp::Plus => Ok(value(a.clone())),
        UnaryOp::Minus => Ok(value(-a)),
        UnaryOp::Not => Ok(value(a.not())),
        UnaryOp::BitNot => undefined("the bits of a coordinate are not known"),
    }
}

/// `a op b` where either is a formula and both are numbers; conditions are 0 where they do not hold.
pub(super) fn binary(op: BinaryOp, a: &Expr, b: &Expr) -> Outcome {
    let order = || a.compare(b);
    Ok(value(match op {
        BinaryOp::Add => a + b,
        BinaryOp::Subtract => a - b,
        BinaryOp::Multiply => a * b,
        BinaryOp::Divide => a / b,
        // The remainder has the sign of a.
        BinaryOp::Modulo => a.compare(0.0) * a.abs().modulo(b.abs()),
        BinaryOp::Power => a.pow(b),
        BinaryOp::Less => order().min(0.0),
        BinaryOp::Greater => order().max(0.0),
        BinaryOp::LessEqual => order().max(0.0).not(),
        BinaryOp::GreaterEqual => order().min(0.0).not(),
        BinaryOp::Equal => order().not(),
        BinaryOp::NotEqual => order(),
        BinaryOp::And => a.and(b),
        BinaryOp::Or => a.or(b),
        BinaryOp::BitOr | BinaryOp::BitAnd | BinaryOp::ShiftLeft | BinaryOp::ShiftRight => {
            return undefined("the bits of a coordinate are not known");
        }
    }))
}

/// `condition ? then : otherwise`: both are computed, and each place has its own.
pub(super) fn select(condition: &Expr, then: &Value, otherwise: &Value, budget: &mut Budget) -> Outcome {
    if let (Some(then), Some(otherwise)) = (expr(then), expr(otherwise)) {
        let chosen = condition.and(then).or(condition.not().and(otherwise));
        return Ok(value(chosen));
    }
    match (then, otherwise) {
        (Value::List(a), Value::List(b)) if a.len() == b.len() => budget.deeper(|budget| {
            a.iter().zip(b.iter()).map(|(a, b)| select(condition, &a, &b, budget)).collect()
        }),
        _ => undefined(format!("{} or {}, by a coordinate", then.kind(), otherwise.kind())),
    }
}

/// The product of vectors and matrices whose elements are numbers and formulas.
pub(super) fn product(a: &List, b: &List, budget: &mut Budget) -> Outcome {
    let is_matrix = |list: &List| matches!(list.get(0), Some(Value::List(_)));
    let rows = |list: &List| -> Result<Vec<Vec<Expr>>, Fault> {
        list.iter().map(|row| scalars(row.list().ok_or_else(not_a_matrix)?)).collect()
    };
    budget.spend((a.len() as u64).saturating_mul(b.len() as u64))?;
    match (is_matrix(a), is_matrix(b)) {
        (false, false) => dot(&scalars(a)?, &scalars(b)?),
        (true, false) => {
            let vector = scalars(b)?;
            rows(a)?.iter().map(|row| dot(row, &vector)).collect()
        }
        (false, true) => combination(&scalars(a)?, &rows(b)?),
        (true, true) => {
            let right = rows(b)?;
            rows(a)?.iter().map(|row| combination(row, &right)).collect()
        }
    }
}

fn not_a_matrix() -> Fault {
    Fault::Undefined("a product of lists takes vectors and matrices".to_owned())
}

fn scalars(list: &List) -> Result<Vec<Expr>, Fault> {
    list.iter().map(|value| expr(&value).ok_or_else(not_a_matrix)).collect()
}

fn dot(a: &[Expr], b: &[Expr]) -> Outcome {
    if a.len() != b.len() {
        return undefined(format!("a product of lists of lengths {} and {} is undefined", a.len(), b.len()));
    }
    // Matrices that turn and mirror are mostly zeros, which must not make NaN of infinity.
    let is_zero = |x: &Expr| x.as_constant() == Some(0.0);
    let pairs = a.iter().zip(b).filter(|(a, b)| !is_zero(a) && !is_zero(b));
    let terms = pairs.map(|(a, b)| a * b);
    Ok(value(terms.reduce(|sum, term| sum + term).unwrap_or(Expr::constant(0.0))))
}

/// Sum of the rows, each times its weight.
fn combination(weights: &[Expr], rows: &[Vec<Expr>]) -> Outcome {
    let width = rows.first().map_or(0, Vec::len);
    if rows.iter().any(|row| row.len() != width) {
        return Err(not_a_matrix());
    }
    let column = |index: usize| rows.iter().map(|row| row[index].clone()).collect::<Vec<_>>();
    (0..width).map(|index| dot(weights, &column(index))).collect()
}

/// A built-in function of numbers, some of them formulas; `None` where it cannot be traced.
pub(super) fn call(name: &str, arguments: &[Value]) -> Option<Value> {
    let scalars = || arguments.iter().map(expr).collect::<Option<Vec<Expr>>>();
    let traced = match (name, &scalars()) {
        ("max" | "min", _) => extreme(name == "max", arguments)?,
        ("norm", None) => norm(arguments)?,
        ("cross", None) => return cross(arguments),
        ("is_num", Some(_)) => return Some(Value::Bool(true)),
        ("abs" | "floor" | "round" | "ceil" | "ln" | "exp" | "sqrt", Some(one)) if one.len() == 1 => {
            Expr::unary(Unary::from_name(name)?, &one[0])
        }
        ("sign", Some(one)) if one.len() == 1 => one[0].compare(0.0),
        ("log", Some(one)) if one.len() == 1 => one[0].ln() * std::f64::consts::LOG10_E,
        ("sin" | "cos" | "tan", Some(one)) if one.len() == 1 => {
            Expr::unary(Unary::from_name(name)?, &(&one[0] * (PI / 180.0)))
        }
        ("asin" | "acos" | "atan", Some(one)) if one.len() == 1 => {
            Expr::unary(Unary::from_name(name)?, &one[0]) * (180.0 / PI)
        }
        ("atan2", Some(two)) if two.len() == 2 => {
            Expr::binary(Binary::Atan2, &two[0], &two[1]) * (180.0 / PI)
        }
        ("pow", Some(two)) if two.len() == 2 => two[0].pow(&two[1]),
        _ => return None,
    };
    Some(value(traced))
}

fn extreme(largest: bool, arguments: &[Value]) -> Option<Expr> {
    let values = match arguments {
        [Value::List(list)] => list.iter().map(|value| expr(&value)).collect::<Option<Vec<Expr>>>()?,
        _ => arguments.iter().map(expr).collect::<Option<Vec<Expr>>>()?,
    };
    values.into_iter().reduce(|a, b| if largest { a.max(b) } else { a.min(b) })
}

fn norm(arguments: &[Value]) -> Option<Expr> {
    let [Value::List(list)] = arguments else { return None };
    let squares = list.iter().map(|value| Some(expr(&value)?.square())).collect::<Option<Vec<Expr>>>()?;
    let sum = squares.into_iter().reduce(|sum, square| sum + square)?;
    Some(sum.sqrt())
}

fn cross(arguments: &[Value]) -> Option<Value> {
    let [Value::List(a), Value::List(b)] = arguments else { return None };
    let (a, b) = (scalars(a).ok()?, scalars(b).ok()?);
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    match (a.len(), b.len()) {
        (2, 2) => Some(value(minor(0, 1))),
        (3, 3) => Some([minor(1, 2), minor(2, 0), minor(0, 1)].into_iter().map(value).collect()),
        _ => None,
    }
}
