//! Functions of strings.

use super::math::count;
use super::{Builtin, function_row};
use crate::script::budget::{Fault, Outcome, undefined};
use crate::script::eval::Session;
use crate::script::format;
use crate::script::value::Value;

pub(super) const TABLE: &[Builtin] = &[
    function_row("str", &["values"], "All values as one string.", str),
    function_row(
        "chr",
        &["codes"],
        "The characters with these codes: numbers, lists or ranges of them.",
        chr,
    ),
    function_row("ord", &["string"], "Code of the first character.", |_, a| ord(a)),
];

fn str(session: &mut Session<'_>, arguments: &[Value]) -> Outcome {
    let mut text = String::new();
    for value in arguments {
        if let Some(part) = value.text() {
            session.budget.reserve(text.len() + part.len())?;
            text.push_str(part);
        } else {
            format::value(value, session.program, &mut session.budget, &mut text)?;
        }
    }
    Ok(Value::from_text(text))
}

fn chr(session: &mut Session<'_>, arguments: &[Value]) -> Outcome {
    let mut text = String::new();
    for value in arguments {
        match value {
            Value::List(list) => {
                session.budget.spend(list.len() as u64)?;
                text.extend(list.iter().filter_map(|code| char_of(code.number()?)));
            }
            Value::Range(range) => {
                let count = range.count();
                if count.is_infinite() {
                    return undefined("the range has no end");
                }
                session.budget.reserve(text.len())?;
                session.budget.spend(count as u64)?;
                text.extend((0..count as u64).filter_map(|index| char_of(range.at(index))));
            }
            value => text.extend(value.number().and_then(char_of)),
        }
    }
    Ok(Value::from_text(text))
}

/// The character with a code; none for 0, since a string ends there in OpenSCAD.
fn char_of(code: f64) -> Option<char> {
    if code >= 1.0 && code <= f64::from(u32::MAX) { char::from_u32(code as u32) } else { None }
}

fn ord(arguments: &[Value]) -> Result<Value, Fault> {
    match arguments {
        [Value::Text(text)] => {
            Ok(text.char(0).map_or(Value::Undef, |c| Value::Number(f64::from(u32::from(c)))))
        }
        [other] => undefined(format!("a string is needed, not {}", other.kind())),
        _ => count(1, arguments),
    }
}
