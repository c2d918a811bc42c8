//! Functions of numbers.

use super::{Builtin, function_row};
use crate::math;
use crate::script::budget::{Outcome, undefined};
use crate::script::degrees;
use crate::script::eval::Session;
use crate::script::value::{List, Value};

pub(super) const TABLE: &[Builtin] = &[
    function_row("abs", &["x"], "The number without its sign.", |_, a| of_number(a, f64::abs)),
    function_row("sign", &["x"], "-1, 0 or 1.", |_, a| of_number(a, sign)),
    function_row("sin", &["degrees"], "Sine of an angle in degrees.", |_, a| of_number(a, degrees::sin)),
    function_row("cos", &["degrees"], "Cosine of an angle in degrees.", |_, a| of_number(a, degrees::cos)),
    function_row("tan", &["degrees"], "Tangent of an angle in degrees.", |_, a| of_number(a, degrees::tan)),
    function_row("asin", &["x"], "Angle in degrees whose sine is x.", |_, a| of_number(a, degrees::asin)),
    function_row("acos", &["x"], "Angle in degrees whose cosine is x.", |_, a| of_number(a, degrees::acos)),
    function_row("atan", &["x"], "Angle in degrees whose tangent is x.", |_, a| of_number(a, degrees::atan)),
    function_row("atan2", &["y", "x"], "Angle of the vector (x, y) in degrees.", |_, a| {
        of_two(a, degrees::atan2)
    }),
    function_row("floor", &["x"], "Largest whole number not above x.", |_, a| of_number(a, f64::floor)),
    function_row("round", &["x"], "Nearest whole number, halves away from 0.", |_, a| {
        of_number(a, f64::round)
    }),
    function_row("ceil", &["x"], "Smallest whole number not below x.", |_, a| of_number(a, f64::ceil)),
    function_row("ln", &["x"], "Natural logarithm.", |_, a| of_number(a, math::ln)),
    function_row("log", &["x"], "Logarithm to base 10.", |_, a| of_number(a, math::log10)),
    function_row("exp", &["x"], "e to the power of x.", |_, a| of_number(a, math::exp)),
    function_row("pow", &["x", "y"], "x to the power of y.", |_, a| of_two(a, math::pow)),
    function_row("sqrt", &["x"], "Square root.", |_, a| of_number(a, f64::sqrt)),
    function_row("max", &["values"], "Largest of its arguments, or of one list.", |_, a| {
        extreme(a, |x, y| x > y)
    }),
    function_row("min", &["values"], "Smallest of its arguments, or of one list.", |_, a| {
        extreme(a, |x, y| x < y)
    }),
    function_row("norm", &["v"], "Length of a vector.", |_, a| norm(a)),
    function_row("cross", &["a", "b"], "Cross product of two vectors in space or in the plane.", |_, a| {
        cross(a)
    }),
    function_row(
        "version",
        &[],
        "Version of OpenSCAD whose language this is, as [year, month, day].",
        |_, a| none(a, Value::from_numbers(VERSION.to_vec())),
    ),
    function_row("version_num", &[], "The same as one number, 10000 year + 100 month + day.", |_, a| {
        none(a, Value::Number(1e4 * VERSION[0] + 1e2 * VERSION[1] + VERSION[2]))
    }),
    function_row("parent_module", &["n"], "Name of the module n modules further out.", parent_module),
];

/// What scripts test for: the release whose language is complete here.
const VERSION: [f64; 3] = [2021.0, 1.0, 0.0];

fn of_number(arguments: &[Value], f: impl Fn(f64) -> f64) -> Outcome {
    match arguments {
        [Value::Number(x)] => Ok(Value::Number(f(*x))),
        [other] => undefined(format!("a number is needed, not {}", other.kind())),
        _ => count(1, arguments),
    }
}

fn of_two(arguments: &[Value], f: impl Fn(f64, f64) -> f64) -> Outcome {
    match arguments {
        [Value::Number(a), Value::Number(b)] => Ok(Value::Number(f(*a, *b))),
        [a, b] => undefined(format!("two numbers are needed, not {} and {}", a.kind(), b.kind())),
        _ => count(2, arguments),
    }
}

fn none(arguments: &[Value], value: Value) -> Outcome {
    if arguments.is_empty() { Ok(value) } else { count(0, arguments) }
}

/// The complaint about a wrong number of arguments.
pub(super) fn count(wanted: usize, arguments: &[Value]) -> Outcome {
    let plural = if wanted == 1 { "" } else { "s" };
    undefined(format!("{wanted} argument{plural} needed, {} given", arguments.len()))
}

fn sign(x: f64) -> f64 {
    f64::from(i8::from(x > 0.0) - i8::from(x < 0.0))
}

/// The first argument that no later one beats.
fn extreme(arguments: &[Value], beats: impl Fn(f64, f64) -> bool) -> Outcome {
    let values: Vec<Value> = match arguments {
        [Value::List(list)] => list.iter().collect(),
        _ => arguments.to_vec(),
    };
    let mut best: Option<f64> = None;
    for value in &values {
        let Value::Number(x) = value else {
            return undefined(format!("numbers are needed, not {}", value.kind()));
        };
        if best.is_none_or(|best| beats(*x, best)) {
            best = Some(*x);
        }
    }
    best.map_or_else(|| undefined("at least one number is needed"), |best| Ok(Value::Number(best)))
}

fn norm(arguments: &[Value]) -> Outcome {
    let [Value::List(list)] = arguments else { return undefined("one list of numbers is needed") };
    match list.numbers() {
        Some(numbers) => Ok(Value::Number(numbers.iter().map(|x| x * x).sum::<f64>().sqrt())),
        None => undefined("a list of numbers is needed"),
    }
}

fn cross(arguments: &[Value]) -> Outcome {
    let [Value::List(a), Value::List(b)] = arguments else { return undefined("two vectors are needed") };
    let finite = |list: &List| list.numbers().is_some_and(|numbers| numbers.iter().all(|x| x.is_finite()));
    if !finite(a) || !finite(b) {
        return undefined("the vectors must hold finite numbers");
    }
    match (a.numbers(), b.numbers()) {
        (Some([a0, a1]), Some([b0, b1])) => Ok(Value::Number(a0 * b1 - a1 * b0)),
        (Some([a0, a1, a2]), Some([b0, b1, b2])) => {
            Ok(Value::from_numbers(vec![a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0]))
        }
        _ => undefined(format!("vectors of lengths {} and {} have no cross product", a.len(), b.len())),
    }
}

fn parent_module(session: &mut Session<'_>, arguments: &[Value]) -> Outcome {
    let index = match arguments {
        [] => 1.0,
        [Value::Number(index)] => index.trunc(),
        _ => return undefined("a number is needed"),
    };
    let depth = session.modules.len();
    if !(0.0..depth as f64).contains(&index) {
        return undefined(format!("there is no module {index} levels further out, only {depth} in all"));
    }
    let name = session.modules[depth - 1 - index as usize];
    Ok(Value::from_text(session.program.names.text(name)))
}
