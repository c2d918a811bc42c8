//! `search`, which finds values in strings, lists and tables.

use super::{Builtin, function_row};
use crate::script::budget::{Budget, Fault, Outcome, undefined};
use crate::script::eval::Session;
use crate::script::operators::equal;
use crate::script::value::{Items, List, Value};

pub(super) const TABLE: &[Builtin] = &[function_row(
    "search",
    &["what", "table", "matches", "column"],
    "Indices at which values are found; at most so many matches of each, 0 for all.",
    search,
)];

/// What is looked for where.
struct Search<'a> {
    table: &'a Value,
    /// Most matches of each value; `usize::MAX` for all.
    most: usize,
    /// Whether only the first match counts, which is then no list.
    single: bool,
    column: usize,
}

fn search(session: &mut Session<'_>, arguments: &[Value]) -> Outcome {
    let ([what, table, options @ ..], true) = (arguments, arguments.len() <= 4) else {
        return undefined(format!("2 to 4 arguments needed, {} given", arguments.len()));
    };
    let option =
        |index: usize, usual: f64| options.get(index).and_then(Value::finite).unwrap_or(usual).max(0.0);
    let matches = option(0, 1.0) as usize;
    let most = if matches == 0 { usize::MAX } else { matches };
    let search = Search { table, most, single: matches == 1, column: option(1, 0.0) as usize };
    let budget = &mut session.budget;
    match what {
        Value::Number(_) => Ok(indices(&search.of_value(what, budget)?)),
        Value::Text(text) => {
            let mut found = Items::default();
            for c in text.as_str().chars() {
                let hits = search.of_char(c, budget)?;
                // A character that is not there leaves no trace among single matches.
                if !search.single {
                    found.push(indices(&hits));
                } else if let Some(first) = hits.first() {
                    found.push(Value::Number(*first as f64));
                }
            }
            Ok(Value::List(List::new(found)))
        }
        Value::List(list) => {
            let mut found = Items::default();
            for value in list.iter() {
                let hits = search.of_value(&value, budget)?;
                found.push(match hits.first() {
                    Some(first) if search.single => Value::Number(*first as f64),
                    _ => indices(&hits),
                });
            }
            Ok(Value::List(List::new(found)))
        }
        other => undefined(format!("a number, a string or a list can be searched for, not {}", other.kind())),
    }
}

fn indices(hits: &[usize]) -> Value {
    Value::from_numbers(hits.iter().map(|&index| index as f64).collect())
}

impl Search<'_> {
    /// Where an element of the table, or its column, is `value`.
    fn of_value(&self, value: &Value, budget: &mut Budget) -> Result<Vec<usize>, Fault> {
        let Value::List(table) = self.table else { return Ok(Vec::new()) };
        let mut hits = Vec::new();
        for (index, row) in table.iter().enumerate() {
            budget.spend(1)?;
            let cell = row.list().and_then(|row| row.get(self.column));
            let mut found = self.column == 0 && equal(value, &row, budget)?;
            if let (false, Some(cell)) = (found, cell) {
                found = equal(value, &cell, budget)?;
            }
            if found {
                hits.push(index);
                if hits.len() == self.most {
                    break;
                }
            }
        }
        Ok(hits)
    }

    /// Where the character stands in a string, or starts the column of an element of a list.
    fn of_char(&self, c: char, budget: &mut Budget) -> Result<Vec<usize>, Fault> {
        match self.table {
            Value::Text(text) => {
                budget.spend(text.len() as u64)?;
                let hits = text.as_str().chars().enumerate().filter(|(_, found)| *found == c);
                Ok(hits.map(|(index, _)| index).take(self.most).collect())
            }
            Value::List(table) => {
                budget.spend(table.len() as u64)?;
                let starts = |row: Value| row.list()?.get(self.column)?.text()?.chars().next();
                let hits = table.iter().enumerate().filter(|(_, row)| starts(row.clone()) == Some(c));
                Ok(hits.map(|(index, _)| index).take(self.most).collect())
            }
            _ => Ok(Vec::new()),
        }
    }
}
