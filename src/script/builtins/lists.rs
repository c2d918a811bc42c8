//! Functions of lists, and of the types of values.

use super::math::count;
use super::{Builtin, function_row};
use crate::script::budget::{Fault, Outcome, undefined};
use crate::script::eval::Session;
use crate::script::value::{Items, List, Value};

pub(super) const TABLE: &[Builtin] = &[
    function_row("len", &["value"], "Number of elements of a list or of characters of a string.", |_, a| {
        len(a)
    }),
    function_row(
        "concat",
        &["values"],
        "One list of all elements of lists; other values stand for themselves.",
        concat,
    ),
    function_row(
        "lookup",
        &["key", "table"],
        "Value at the key, linear between the rows [key, value].",
        lookup,
    ),
    function_row("is_undef", &["value"], "Whether the value is undef.", |_, a| test(a, Value::is_undef)),
    function_row("is_bool", &["value"], "Whether the value is true or false.", |_, a| {
        test(a, |value| matches!(value, Value::Bool(_)))
    }),
    function_row("is_num", &["value"], "Whether the value is a number, and not NaN.", |_, a| {
        test(a, |value| value.number().is_some_and(|x| !x.is_nan()))
    }),
    function_row("is_string", &["value"], "Whether the value is a string.", |_, a| {
        test(a, |value| matches!(value, Value::Text(_)))
    }),
    function_row("is_list", &["value"], "Whether the value is a list.", |_, a| {
        test(a, |value| matches!(value, Value::List(_)))
    }),
    function_row("is_object", &["value"], "Whether the value is an object; there are none yet.", |_, a| {
        test(a, |_| false)
    }),
    function_row("is_function", &["value"], "Whether the value is a function.", |_, a| {
        test(a, |value| matches!(value, Value::Function(_)))
    }),
];

fn test(arguments: &[Value], holds: impl Fn(&Value) -> bool) -> Outcome {
    match arguments {
        [value] => Ok(Value::Bool(holds(value))),
        _ => count(1, arguments),
    }
}

fn len(arguments: &[Value]) -> Outcome {
    match arguments {
        [Value::List(list)] => Ok(Value::Number(list.len() as f64)),
        [Value::Text(text)] => Ok(Value::Number(text.len() as f64)),
        [other] => undefined(format!("a list or a string is needed, not {}", other.kind())),
        _ => count(1, arguments),
    }
}

fn concat(session: &mut Session<'_>, arguments: &[Value]) -> Outcome {
    let total: usize = arguments.iter().map(|value| value.list().map_or(1, List::len)).sum();
    session.budget.reserve(total.saturating_mul(size_of::<Value>()))?;
    session.budget.spend(total as u64)?;
    let mut items = Items::default();
    for value in arguments {
        match value {
            Value::List(list) => items.extend(list),
            other => items.push(other.clone()),
        }
    }
    Ok(Value::List(List::new(items)))
}

fn lookup(session: &mut Session<'_>, arguments: &[Value]) -> Outcome {
    let [key, table] = arguments else { return count(2, arguments) };
    let Some(key) = key.finite() else { return undefined("the key must be a finite number") };
    let Value::List(table) = table else {
        return undefined(format!("a list is needed, not {}", table.kind()));
    };
    session.budget.spend(table.len() as u64)?;
    let rows = table.iter().filter_map(|row| match row.list()?.numbers()? {
        [key, value, ..] => Some((*key, *value)),
        _ => None,
    });
    let mut below: Option<(f64, f64)> = None;
    let mut above: Option<(f64, f64)> = None;
    for row in rows {
        if row.0 <= key && below.is_none_or(|below| row.0 > below.0) {
            below = Some(row);
        }
        if row.0 >= key && above.is_none_or(|above| row.0 < above.0) {
            above = Some(row);
        }
    }
    between(key, below, above)
}

/// The value at `key` between two rows; beyond the ends of the table the row at the end counts.
fn between(key: f64, below: Option<(f64, f64)>, above: Option<(f64, f64)>) -> Result<Value, Fault> {
    match (below, above) {
        (Some(low), Some(high)) if low.0 < high.0 => {
            let part = (key - low.0) / (high.0 - low.0);
            Ok(Value::Number(high.1 * part + low.1 * (1.0 - part)))
        }
        (Some((_, value)), _) | (None, Some((_, value))) => Ok(Value::Number(value)),
        (None, None) => Ok(Value::Undef),
    }
}
