//! `$` variables: a stack of values for each, so that whoever is called sees the latest.

use crate::script::Options;
use crate::script::names::{Names, Symbol};
use crate::script::value::Value;

/// The values of all `$` variables.
pub(super) struct Specials {
    stacks: Vec<Vec<Value>>,
    /// The variables that were set, in order.
    log: Vec<Symbol>,
    known: Known,
    /// The first value of `$fe`.
    tolerance: f64,
}

/// The symbols the evaluator itself asks for; `None` where no script names them.
pub(super) struct Known {
    pub(super) children: Option<Symbol>,
    pub(super) parent_modules: Option<Symbol>,
    fragments: [Option<Symbol>; 4],
}

/// What decides the number of fragments of a circle.
#[derive(Clone, Copy, Debug)]
pub(in crate::script) struct Fragmentation {
    pub(in crate::script) count: f64,
    pub(in crate::script) angle: f64,
    pub(in crate::script) size: f64,
    pub(in crate::script) error: f64,
}

/// How far the log was written at some moment.
#[derive(Clone, Copy)]
pub(super) struct Mark(usize);

impl Specials {
    pub(super) fn new(names: &Names, options: &Options) -> Specials {
        let known = Known {
            children: names.find("$children"),
            parent_modules: names.find("$parent_modules"),
            fragments: ["$fn", "$fa", "$fs", "$fe"].map(|name| names.find(name)),
        };
        let stacks = vec![Vec::new(); names.len()];
        let mut specials = Specials { stacks, log: Vec::new(), known, tolerance: options.tolerance };
        let point = |x: f64, y: f64, z: f64| Value::from_numbers(vec![x, y, z]);
        let initial = [
            ("$fn", Value::Number(0.0)),
            ("$fa", Value::Number(12.0)),
            ("$fs", Value::Number(2.0)),
            ("$fe", Value::Number(options.tolerance)),
            ("$t", Value::Number(options.time)),
            ("$vpr", point(55.0, 0.0, 25.0)),
            ("$vpt", point(0.0, 0.0, 0.0)),
            ("$vpd", Value::Number(140.0)),
            ("$vpf", Value::Number(22.5)),
            ("$preview", Value::Bool(false)),
            ("$children", Value::Number(0.0)),
            ("$parent_modules", Value::Number(0.0)),
        ];
        for (name, value) in initial {
            if let Some(symbol) = names.find(name) {
                specials.set(symbol, value);
            }
        }
        specials
    }

    pub(super) fn known(&self) -> &Known {
        &self.known
    }

    pub(super) fn get(&self, name: Symbol) -> Option<Value> {
        self.stacks[name.index()].last().cloned()
    }

    /// Sets a variable until the log is taken back to a mark made before.
    pub(super) fn set(&mut self, name: Symbol, value: Value) {
        self.stacks[name.index()].push(value);
        self.log.push(name);
    }

    pub(super) fn mark(&self) -> Mark {
        Mark(self.log.len())
    }

    /// Takes back all that was set since `mark`.
    #[inline]
    pub(super) fn restore(&mut self, mark: Mark) {
        while self.log.len() > mark.0 {
            self.pop();
        }
    }

    /// Takes back all that was set since `mark` and hands it over, in the order in which it was set.
    pub(super) fn take_since(&mut self, mark: Mark) -> Vec<(Symbol, Value)> {
        let mut taken = Vec::new();
        while self.log.len() > mark.0 {
            taken.extend(self.pop());
        }
        taken.reverse();
        taken
    }

    fn pop(&mut self) -> Option<(Symbol, Value)> {
        let name = self.log.pop()?;
        Some((name, self.stacks[name.index()].pop()?))
    }

    /// `$fn`, `$fa`, `$fs` and `$fe`; those that are no numbers have their first values.
    pub(super) fn fragmentation(&self) -> Fragmentation {
        let number = |index: usize, usual: f64| {
            let value = self.known.fragments[index].and_then(|name| self.stacks[name.index()].last());
            value.and_then(Value::number).filter(|value| !value.is_nan()).unwrap_or(usual)
        };
        Fragmentation {
            count: number(0, 0.0),
            angle: number(1, 12.0),
            size: number(2, 2.0),
            error: number(3, self.tolerance),
        }
    }
}
