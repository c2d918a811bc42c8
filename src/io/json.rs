//! Lists of points in JSON.

use super::{Place, Problem, ReadError};
use crate::math::Vec2;
use serde_json::Value;

/// A list of points, with its name where it has one.
#[derive(Clone, Debug, PartialEq)]
pub struct PointList {
    /// Its key in the object that holds it.
    pub name: Option<String>,
    /// The points in order.
    pub points: Vec<Vec2>,
}

/// Reads lists of points: `[[x, y], ...]`, several of them in a list, or an object of them by name, such as
/// `{"upper": [[0, 0], [1, 2]], "lower": [[0, 0], [1, -2]]}`. Points are lists of two numbers or objects with `x` and
/// `y`.
///
/// # Errors
/// [`Problem::Malformed`], with its place for what is no JSON, and with the indices of a point for anything else in
/// its place.
pub fn read_points(bytes: &[u8]) -> Result<Vec<PointList>, ReadError> {
    let value: Value = serde_json::from_slice(bytes).map_err(|error| {
        let at = Place::Character { line: error.line().max(1), column: error.column().max(1) };
        let text = error.to_string();
        let reason = text.rsplit_once(" at line ").map_or(text.as_str(), |(reason, _)| reason).to_owned();
        ReadError { at, problem: Problem::Malformed { reason } }
    })?;
    match &value {
        Value::Object(lists) => lists
            .iter()
            .map(|(name, list)| read_list(list, Some(name.clone()), &format!("{name:?}")))
            .collect(),
        Value::Array(items) if items.first().is_some_and(is_list_of_points) => {
            items.iter().enumerate().map(|(k, list)| read_list(list, None, &format!("list {k}"))).collect()
        }
        list => Ok(vec![read_list(list, None, "the list")?]),
    }
}

/// Whether this is a list whose first element is a point itself, or an empty list.
fn is_list_of_points(value: &Value) -> bool {
    value.as_array().is_some_and(|items| items.first().is_none_or(|item| !item.is_number()))
}

fn read_list(value: &Value, name: Option<String>, called: &str) -> Result<PointList, ReadError> {
    let wrong = |expected: &'static str, value: &Value, place: String| {
        let found = Problem::expected(expected, value.to_string().as_bytes());
        ReadError { at: Place::Line(1), problem: Problem::Malformed { reason: format!("{place}: {found}") } }
    };
    let Some(items) = value.as_array() else {
        return Err(wrong("a list of points", value, called.to_owned()));
    };
    let place = |k: usize| format!("point {k} of {called}");
    let points = items.iter().enumerate();
    let points = points.map(|(k, item)| point(item).ok_or_else(|| wrong("a point [x, y]", item, place(k))));
    Ok(PointList { name, points: points.collect::<Result<_, _>>()? })
}

fn point(value: &Value) -> Option<Vec2> {
    let number = |value: &Value| value.as_f64().filter(|x| x.is_finite());
    match value {
        Value::Array(pair) if pair.len() == 2 => Some(Vec2::new(number(&pair[0])?, number(&pair[1])?)),
        Value::Object(_) => Some(Vec2::new(number(value.get("x")?)?, number(value.get("y")?)?)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form() {
        let square = vec![Vec2::new(0.0, 0.5), Vec2::new(1.0, -2.0)];
        for (text, count) in [
            ("[[0, 0.5], [1, -2]]", 1),
            ("[{\"x\": 0, \"y\": 0.5}, {\"y\": -2, \"x\": 1}]", 1),
            ("[[[0, 0.5], [1, -2]], [[0, 0.5], [1, -2]]]", 2),
            ("{\"a\": [[0, 0.5], [1, -2]]}", 1),
        ] {
            let lists = read_points(text.as_bytes()).unwrap();
            assert_eq!(lists.len(), count, "{text}");
            assert!(lists.iter().all(|list| list.points == square), "{text}");
        }
        assert_eq!(read_points(b"{\"a\": []}").unwrap()[0].name.as_deref(), Some("a"));
        assert_eq!(read_points(b"[]").unwrap()[0].points, []);
    }

    #[test]
    fn errors_name_the_place() {
        for (text, expected) in [
            ("[[0, 0], [1]]", "line 1: point 1 of the list: expected a point [x, y], found `[1]`"),
            ("[[0, 0], [1, null]]", "line 1: point 1 of the list: expected a point [x, y], found `[1,null]`"),
            ("{\"a\": 3}", "line 1: \"a\": expected a list of points, found `3`"),
            ("[[[0,0]],[[0,0],7]]", "line 1: point 1 of list 1: expected a point [x, y], found `7`"),
            ("[[0, 0],\n x]", "line 2, column 2: expected value"),
            ("", "line 1, column 1: EOF while parsing a value"),
            ("[[1e999, 0]]", "line 1, column 7: number out of range"),
        ] {
            assert_eq!(read_points(text.as_bytes()).unwrap_err().to_string(), expected, "{text}");
        }
        // Deeper than the parser goes.
        assert!(read_points("[".repeat(100_000).as_bytes()).is_err());
    }
}
