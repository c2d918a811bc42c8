//! Operators on values; pure functions that know no places in the text.

use super::ast::{BinaryOp, UnaryOp};
use super::budget::{Budget, Fault, Outcome, undefined};
use super::formula;
use super::value::{List, Value};
use crate::math;
use std::cmp::Ordering;

/// The value of `op operand`.
pub(super) fn unary(op: UnaryOp, operand: &Value, budget: &mut Budget) -> Outcome {
    match (op, operand) {
        (op, Value::Formula(expr)) => formula::unary(op, expr),
        (UnaryOp::Plus, value) => Ok(value.clone()),
        (UnaryOp::Not, value) => Ok(Value::Bool(!value.is_true())),
        (UnaryOp::Minus, Value::Number(value)) => Ok(Value::Number(-value)),
        (UnaryOp::Minus, Value::List(list)) => each(list, budget, |value, budget| unary(op, value, budget)),
        (UnaryOp::BitNot, Value::Number(value)) => Ok(Value::Number(!(*value as i64) as f64)),
        (UnaryOp::Minus | UnaryOp::BitNot, value) => {
            undefined(format!("{}{} is undefined", op.text(), value.kind()))
        }
    }
}

/// The value of `a op b`; `&&` and `||` are decided by their left side before they come here.
pub(super) fn binary(op: BinaryOp, a: &Value, b: &Value, budget: &mut Budget) -> Outcome {
    use BinaryOp as Op;
    if let Some(outcome) = traced(op, a, b) {
        return outcome;
    }
    match op {
        Op::Or => Ok(Value::Bool(a.is_true() || b.is_true())),
        Op::And => Ok(Value::Bool(a.is_true() && b.is_true())),
        Op::Equal => Ok(Value::Bool(equal(a, b, budget)?)),
        Op::NotEqual => Ok(Value::Bool(!equal(a, b, budget)?)),
        Op::Less | Op::LessEqual | Op::Greater | Op::GreaterEqual => comparison(op, a, b, budget),
        Op::Add | Op::Subtract => sum(op, a, b, budget),
        Op::Multiply => product(a, b, budget),
        Op::Divide => quotient(a, b, budget),
        Op::Modulo | Op::Power => match (a, b) {
            (Value::Number(a), Value::Number(b)) if op == Op::Modulo => Ok(Value::Number(a % b)),
            (Value::Number(a), Value::Number(b)) => Ok(Value::Number(math::pow(*a, *b))),
            _ => mismatch(op, a, b),
        },
        Op::BitOr | Op::BitAnd | Op::ShiftLeft | Op::ShiftRight => bits(op, a, b),
    }
}

/// What there is to say of an operation where a formula is one of the operands; `None` for a formula and a list, and
/// where there is no formula.
fn traced(op: BinaryOp, a: &Value, b: &Value) -> Option<Outcome> {
    if !matches!((a, b), (Value::Formula(_), _) | (_, Value::Formula(_))) {
        return None;
    }
    match (formula::expr(a), formula::expr(b)) {
        (Some(a), Some(b)) => Some(formula::binary(op, &a, &b)),
        _ if matches!((a, b), (Value::List(_), _) | (_, Value::List(_))) => {
            let elementwise = matches!(op, BinaryOp::Multiply | BinaryOp::Divide);
            (!elementwise).then(|| mismatch(op, a, b))
        }
        _ => Some(mismatch(op, a, b)),
    }
}

fn mismatch<T>(op: BinaryOp, a: &Value, b: &Value) -> Result<T, Fault> {
    undefined(format!("{} {} {} is undefined", a.kind(), op.text(), b.kind()))
}

/// `f` of each element; an element for which it is undefined becomes `undef`.
fn each(list: &List, budget: &mut Budget, f: impl Fn(&Value, &mut Budget) -> Outcome) -> Outcome {
    budget.spend(list.len() as u64)?;
    budget.deeper(|budget| list.iter().map(|value| defined(f(&value, budget))).collect())
}

/// `undef` for what is undefined.
fn defined(outcome: Outcome) -> Outcome {
    match outcome {
        Err(Fault::Undefined(_)) => Ok(Value::Undef),
        other => other,
    }
}

/// Whether two values are the same; values of different types never are.
pub(super) fn equal(a: &Value, b: &Value, budget: &mut Budget) -> Result<bool, Fault> {
    Ok(match (a, b) {
        (Value::Undef, Value::Undef) => true,
        (Value::Bool(a), Value::Bool(b)) => a == b,
        (Value::Number(a), Value::Number(b)) => a == b,
        (Value::Text(a), Value::Text(b)) => a.as_str() == b.as_str(),
        (Value::Range(a), Value::Range(b)) => a == b,
        (Value::Function(a), Value::Function(b)) => std::rc::Rc::ptr_eq(a, b),
        (Value::Formula(_), _) | (_, Value::Formula(_)) => {
            return undefined("whether coordinates are equal is not known");
        }
        (Value::List(a), Value::List(b)) if a.len() == b.len() => {
            budget.spend(a.len() as u64)?;
            match (a.numbers(), b.numbers()) {
                (Some(a), Some(b)) => a == b,
                _ => budget.deeper(|budget| {
                    for (a, b) in a.iter().zip(b.iter()) {
                        if !equal(&a, &b, budget)? {
                            return Ok(false);
                        }
                    }
                    Ok(true)
                })?,
            }
        }
        _ => false,
    })
}

fn comparison(op: BinaryOp, a: &Value, b: &Value, budget: &mut Budget) -> Outcome {
    if let (Value::Number(a), Value::Number(b)) = (a, b) {
        return Ok(Value::Bool(holds(op, a.partial_cmp(b))));
    }
    match order(a, b, budget)? {
        Some(order) => Ok(Value::Bool(holds(op, order))),
        None => mismatch(op, a, b),
    }
}

fn holds(op: BinaryOp, order: Option<Ordering>) -> bool {
    match op {
        BinaryOp::Less => order == Some(Ordering::Less),
        BinaryOp::LessEqual => matches!(order, Some(Ordering::Less | Ordering::Equal)),
        BinaryOp::Greater => order == Some(Ordering::Greater),
        _ => matches!(order, Some(Ordering::Greater | Ordering::Equal)),
    }
}

/// How two values compare: `None` for types that do not, `Some(None)` where a NaN is in the way. Lists compare by
/// the first elements that differ.
fn order(a: &Value, b: &Value, budget: &mut Budget) -> Result<Option<Option<Ordering>>, Fault> {
    Ok(match (a, b) {
        (Value::Number(a), Value::Number(b)) => Some(a.partial_cmp(b)),
        (Value::Bool(a), Value::Bool(b)) => Some(Some(a.cmp(b))),
        (Value::Text(a), Value::Text(b)) => Some(Some(a.as_str().cmp(b.as_str()))),
        (Value::Range(a), Value::Range(b)) => {
            Some([a.begin, a.step, a.end].partial_cmp(&[b.begin, b.step, b.end]))
        }
        (Value::List(a), Value::List(b)) => {
            budget.spend(a.len().min(b.len()) as u64)?;
            budget.deeper(|budget| {
                for (a, b) in a.iter().zip(b.iter()) {
                    match order(&a, &b, budget)? {
                        Some(Some(Ordering::Equal)) => {}
                        other => return Ok(other),
                    }
                }
                Ok(Some(Some(a.len().cmp(&b.len()))))
            })?
        }
        _ => None,
    })
}

/// Sums and differences of numbers, and of lists element by element up to the end of the shorter.
fn sum(op: BinaryOp, a: &Value, b: &Value, budget: &mut Budget) -> Outcome {
    if let Some(outcome) = traced(op, a, b) {
        return outcome;
    }
    let of_numbers = |a: f64, b: f64| if op == BinaryOp::Add { a + b } else { a - b };
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => Ok(Value::Number(of_numbers(*a, *b))),
        (Value::List(a), Value::List(b)) => {
            budget.spend(a.len().min(b.len()) as u64)?;
            if let (Some(a), Some(b)) = (a.numbers(), b.numbers()) {
                return Ok(Value::from_numbers(a.iter().zip(b).map(|(&a, &b)| of_numbers(a, b)).collect()));
            }
            budget.deeper(|budget| {
                a.iter().zip(b.iter()).map(|(a, b)| defined(sum(op, &a, &b, budget))).collect()
            })
        }
        _ => mismatch(op, a, b),
    }
}

fn product(a: &Value, b: &Value, budget: &mut Budget) -> Outcome {
    if let Some(outcome) = traced(BinaryOp::Multiply, a, b) {
        return outcome;
    }
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => Ok(Value::Number(a * b)),
        (Value::Number(_) | Value::Formula(_), Value::List(list)) => {
            each(list, budget, |value, budget| product(a, value, budget))
        }
        (Value::List(list), Value::Number(_) | Value::Formula(_)) => {
            each(list, budget, |value, budget| product(value, b, budget))
        }
        (Value::List(a), Value::List(b)) => product_of_lists(a, b, budget),
        _ => mismatch(BinaryOp::Multiply, a, b),
    }
}

fn product_of_lists(a: &List, b: &List, budget: &mut Budget) -> Outcome {
    if a.is_empty() || b.is_empty() {
        return undefined("a product with an empty list is undefined");
    }
    budget.spend(a.len() as u64 + b.len() as u64)?;
    if formula::is_in_list(a) || formula::is_in_list(b) {
        return formula::product(a, b, budget);
    }
    match (a.numbers(), b.numbers()) {
        (Some(a), Some(b)) => dot(a, b),
        (None, Some(vector)) => {
            let rows = rows(a)?;
            rows.iter().map(|row| dot(numbers(row)?, vector)).collect()
        }
        (Some(vector), None) => combination(vector, &rows(b)?),
        (None, None) => {
            let (left, right) = (rows(a)?, rows(b)?);
            budget.spend(left.len() as u64 * right.len() as u64)?;
            left.iter().map(|row| combination(numbers(row)?, &right)).collect()
        }
    }
}

/// The rows of a matrix.
fn rows(matrix: &List) -> Result<Vec<List>, Fault> {
    let row = |value: Value| match value {
        Value::List(row) if row.numbers().is_some() => Ok(row),
        value => {
            undefined(format!("in a product of lists, {} stands where a row of numbers should", value.kind()))
        }
    };
    matrix.iter().map(row).collect()
}

fn numbers(row: &List) -> Result<&[f64], Fault> {
    row.numbers().map_or_else(|| undefined("a row of a matrix holds other things than numbers"), Ok)
}

/// Sum of the products of the elements.
fn dot(a: &[f64], b: &[f64]) -> Outcome {
    if a.len() != b.len() {
        return undefined(format!("a product of lists of lengths {} and {} is undefined", a.len(), b.len()));
    }
    Ok(Value::Number(a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() + 0.0))
}

/// Sum of the rows, each times its weight.
fn combination(weights: &[f64], rows: &[List]) -> Outcome {
    let width = rows.first().map_or(0, List::len);
    if weights.len() != rows.len() || rows.iter().any(|row| row.len() != width) {
        return undefined(format!(
            "{} numbers times a matrix of {} rows is undefined",
            weights.len(),
            rows.len()
        ));
    }
    let mut sum = vec![0.0; width];
    for (weight, row) in weights.iter().zip(rows) {
        for (sum, value) in sum.iter_mut().zip(numbers(row)?) {
            *sum += weight * value;
        }
    }
    Ok(Value::from_numbers(sum))
}

fn quotient(a: &Value, b: &Value, budget: &mut Budget) -> Outcome {
    if let Some(outcome) = traced(BinaryOp::Divide, a, b) {
        return outcome;
    }
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => Ok(Value::Number(a / b)),
        (Value::List(list), Value::Number(_) | Value::Formula(_)) => {
            each(list, budget, |value, budget| quotient(value, b, budget))
        }
        (Value::Number(_) | Value::Formula(_), Value::List(list)) => {
            each(list, budget, |value, budget| quotient(a, value, budget))
        }
        _ => mismatch(BinaryOp::Divide, a, b),
    }
}

/// Operators on the bits of whole numbers of 64 bits; fractions are cut off.
fn bits(op: BinaryOp, a: &Value, b: &Value) -> Outcome {
    let (Value::Number(a), Value::Number(b)) = (a, b) else { return mismatch(op, a, b) };
    let (a, b) = (*a as i64, *b as i64);
    let shift = || match u32::try_from(b) {
        Ok(shift @ 0..=63) => Ok(shift),
        _ => undefined(format!("a shift by {b} is undefined")),
    };
    let value = match op {
        BinaryOp::BitOr => a | b,
        BinaryOp::BitAnd => a & b,
        BinaryOp::ShiftLeft => a << shift()?,
        _ => a >> shift()?,
    };
    Ok(Value::Number(value as f64))
}
