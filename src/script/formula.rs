//! Formulas: what functions of the script come to when they are called with symbols instead of numbers.

use super::ast::BinaryOp;
use super::budget::{Fault, Outcome, undefined};
use super::value::{List, Value};
use crate::sdf::{Binary, Expr};
use std::f64::consts::{LN_10, PI};

/// Why a formula decides nothing.
pub(super) const UNDECIDED: &str = "this depends on the parameters of the surface, which have no value here; min, max, abs and sign do instead of conditions";

/// A number or a formula as a formula.
pub(super) fn of(value: &Value) -> Option<Expr> {
    match value {
        Value::Number(x) => Some(Expr::constant(*x)),
        Value::Formula(expr) => Some(expr.clone()),
        _ => None,
    }
}

/// Both sides as formulas, where at least one is.
fn both(a: &Value, b: &Value) -> Option<(Expr, Expr)> {
    let has_formula = matches!(a, Value::Formula(_)) || matches!(b, Value::Formula(_));
    if has_formula { Some((of(a)?, of(b)?)) } else { None }
}

/// The formula of `a op b`; `None` where neither side is one, or one side is something else.
pub(super) fn binary(op: BinaryOp, a: &Value, b: &Value) -> Option<Value> {
    let (a, b) = both(a, b)?;
    let expr = match op {
        BinaryOp::Add => a + b,
        BinaryOp::Subtract => a - b,
        BinaryOp::Multiply => a * b,
        BinaryOp::Divide => a / b,
        BinaryOp::Power => a.pow(b),
        // The remainder has the sign of the left side.
        BinaryOp::Modulo => a.compare(0.0) * a.abs().modulo(b.abs()),
        _ => return None,
    };
    Some(Value::Formula(expr))
}

/// Whether equality with another value cannot be decided.
pub(super) fn undecided(a: &Value, b: &Value) -> Result<(), Fault> {
    if both(a, b).is_some() { Err(Fault::Wrong(UNDECIDED.to_owned())) } else { Ok(()) }
}

/// Whether a list of lists, or of numbers, holds a formula.
pub(super) fn is_in(list: &List) -> bool {
    list.numbers().is_none()
        && list.iter().any(|value| match &value {
            Value::Formula(_) => true,
            Value::List(inner) => {
                inner.numbers().is_none() && inner.iter().any(|v| matches!(v, Value::Formula(_)))
            }
            _ => false,
        })
}

/// The product of vectors and matrices among whose elements are formulas.
pub(super) fn product(a: &List, b: &List) -> Outcome {
    match (rows(a), rows(b)) {
        (None, None) => dot(a, b),
        (Some(rows), None) => rows.iter().map(|row| dot(row, b)).collect(),
        (None, Some(rows)) => combination(a, &rows),
        (Some(left), Some(right)) => left.iter().map(|row| combination(row, &right)).collect(),
    }
}

/// The rows of a matrix; `None` for a vector.
fn rows(list: &List) -> Option<Vec<List>> {
    list.iter().map(|value| value.list().cloned()).collect()
}

fn elements(list: &List) -> Result<Vec<Expr>, Fault> {
    let all: Option<Vec<Expr>> = list.iter().map(|value| of(&value)).collect();
    all.map_or_else(|| undefined("a product of lists needs numbers"), Ok)
}

fn dot(a: &List, b: &List) -> Outcome {
    let (a, b) = (elements(a)?, elements(b)?);
    if a.len() != b.len() {
        return undefined(format!("a product of lists of lengths {} and {} is undefined", a.len(), b.len()));
    }
    let terms = a.iter().zip(&b).map(|(a, b)| a * b);
    Ok(Value::Formula(terms.reduce(|sum, term| sum + term).unwrap_or_else(|| Expr::constant(0.0))))
}

/// The sum of rows, each times its weight.
fn combination(weights: &List, rows: &[List]) -> Outcome {
    let width = rows.first().map_or(0, List::len);
    if weights.len() != rows.len() || rows.iter().any(|row| row.len() != width) {
        return undefined(format!(
            "{} numbers times a matrix of {} rows is undefined",
            weights.len(),
            rows.len()
        ));
    }
    let column = |k: usize| rows.iter().filter_map(|row| row.get(k)).collect::<Value>();
    let columns = (0..width).map(|k| match column(k) {
        Value::List(column) => dot(weights, &column),
        _ => Ok(Value::Undef),
    });
    columns.collect()
}

/// The largest or smallest of some numbers and formulas; `None` where there is no formula, or something else.
pub(super) fn extreme(op: Binary, values: &[Value]) -> Option<Value> {
    if !values.iter().any(|value| matches!(value, Value::Formula(_))) {
        return None;
    }
    let all: Option<Vec<Expr>> = values.iter().map(of).collect();
    all?.into_iter().reduce(|a, b| Expr::binary(op, &a, &b)).map(Value::Formula)
}

/// The length of a vector; `None` where something in it is neither number nor formula.
pub(super) fn norm(list: &List) -> Option<Value> {
    let all: Vec<Expr> = list.iter().map(|value| of(&value)).collect::<Option<_>>()?;
    let sum = all.iter().map(Expr::square).reduce(|sum, square| sum + square)?;
    Some(Value::Formula(sum.sqrt()))
}

/// The cross product of two vectors in space or in the plane; `None` where there is none.
pub(super) fn cross(a: &List, b: &List) -> Option<Value> {
    let [a, b] = [a, b].map(|list| list.iter().map(|value| of(&value)).collect::<Option<Vec<Expr>>>());
    let (a, b) = (a?, b?);
    let minor = |i: usize, j: usize| Value::Formula(&a[i] * &b[j] - &a[j] * &b[i]);
    match (a.len(), b.len()) {
        (2, 2) => Some(minor(0, 1)),
        (3, 3) => Some([minor(1, 2), minor(2, 0), minor(0, 1)].into_iter().collect()),
        _ => None,
    }
}

fn radians(degrees: &Expr) -> Expr {
    degrees * (PI / 180.0)
}

fn degrees(radians: &Expr) -> Expr {
    radians * (180.0 / PI)
}

pub(super) fn sign(x: &Expr) -> Expr {
    x.compare(0.0)
}

pub(super) fn sin(x: &Expr) -> Expr {
    radians(x).sin()
}

pub(super) fn cos(x: &Expr) -> Expr {
    radians(x).cos()
}

pub(super) fn tan(x: &Expr) -> Expr {
    radians(x).tan()
}

pub(super) fn asin(x: &Expr) -> Expr {
    degrees(&x.asin())
}

pub(super) fn acos(x: &Expr) -> Expr {
    degrees(&x.acos())
}

pub(super) fn atan(x: &Expr) -> Expr {
    degrees(&x.atan())
}

pub(super) fn atan2(y: &Expr, x: &Expr) -> Expr {
    degrees(&y.atan2(x))
}

pub(super) fn log10(x: &Expr) -> Expr {
    x.ln() / LN_10
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{self, Vec3};
    use crate::script::degrees as exact;

    #[test]
    fn formulas_have_the_values_of_the_functions() {
        type Pair = (fn(&Expr) -> Expr, fn(f64) -> f64);
        let pairs: [Pair; 7] = [
            (sin, exact::sin),
            (cos, exact::cos),
            (tan, exact::tan),
            (asin, exact::asin),
            (acos, exact::acos),
            (atan, exact::atan),
            (log10, math::log10),
        ];
        for (index, (symbolic, numeric)) in pairs.into_iter().enumerate() {
            for k in 1..20 {
                let x = f64::from(k) / 20.0 * if (3..5).contains(&index) { 1.0 } else { 80.0 };
                let mine = symbolic(&Expr::x()).eval(Vec3::new(x, 0.0, 0.0));
                assert!((mine - numeric(x)).abs() <= 1e-13 * (1.0 + numeric(x).abs()), "{index} {x}");
            }
        }
        let quotients = [(7.5, 2.0), (-7.5, 2.0), (7.5, -2.0), (-7.5, -2.0), (0.0, 3.0)];
        for (a, b) in quotients {
            let rest = binary(BinaryOp::Modulo, &Value::Formula(Expr::x()), &Value::Number(b));
            let Some(Value::Formula(rest)) = rest else { panic!("a formula") };
            assert_eq!(rest.eval(Vec3::new(a, 0.0, 0.0)), a % b, "{a} {b}");
        }
    }
}
