//! The Python package `bezier` by script: its own CPU time, its numbers as JSON.

use crate::Runner;
use ogee::curve::{Bernstein, Cubic};
use ogee::math::Vec2;
use serde_json::{Value, json};
use std::io::Write;
use std::process::{Command, Stdio};

fn ask(runner: &Runner, question: &Value) -> Option<Value> {
    let python = runner.options.python.as_ref()?;
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/curves.py");
    let mut child =
        Command::new(python).arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().ok()?;
    child.stdin.take()?.write_all(question.to_string().as_bytes()).ok()?;
    let output = child.wait_with_output().ok()?;
    let answer = serde_json::from_slice(&output.stdout).ok();
    if answer.is_none() {
        eprintln!("{} gave no answer", python.display());
    }
    answer
}

fn rows(points: &[Vec2]) -> Value {
    let axis = |f: fn(&Vec2) -> f64| points.iter().map(f).collect::<Vec<f64>>();
    json!([axis(|p| p.x), axis(|p| p.y)])
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

/// Nanoseconds a point, and the points.
pub(crate) fn evaluation(runner: &Runner, points: &[Vec2], parameters: &[f64]) -> Option<(f64, Vec<Vec2>)> {
    let answer = ask(runner, &json!({ "points": rows(points), "parameters": parameters }))?;
    let (x, y) = (numbers(&answer["values"][0]), numbers(&answer["values"][1]));
    Some((answer["ns"].as_f64()?, x.into_iter().zip(y).map(Vec2::from).collect()))
}

/// Nanoseconds a pair, and the parameters of the meetings; a pair that it refuses has none.
pub(crate) fn intersections(
    runner: &Runner,
    pairs: &[[Cubic<Vec2>; 2]],
) -> Option<(f64, Vec<Vec<(f64, f64)>>)> {
    let question: Vec<Value> =
        pairs.iter().map(|[a, b]| json!([rows(a.points()), rows(b.points())])).collect();
    let answer = ask(runner, &json!({ "pairs": question }))?;
    let pair = |value: &Value| {
        let (s, t) = (numbers(&value[0]), numbers(&value[1]));
        s.into_iter().zip(t).collect()
    };
    Some((answer["ns"].as_f64()?, answer["found"].as_array()?.iter().map(pair).collect()))
}
