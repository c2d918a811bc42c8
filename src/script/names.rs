//! Names as small numbers.

use std::collections::HashMap;
use std::rc::Rc;

/// A name that has been seen; two are equal when their texts are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Symbol(u32);

impl Symbol {
    /// Whether the name starts with `$`: its variable is found by who calls, not by where it is written.
    pub(super) fn is_special(self) -> bool {
        self.0 & 1 == 1
    }

    /// A small number, one for each name.
    pub(super) fn index(self) -> usize {
        (self.0 >> 1) as usize
    }
}

/// All names of a program.
#[derive(Debug, Default)]
pub(super) struct Names {
    known: HashMap<Rc<str>, Symbol>,
    texts: Vec<Rc<str>>,
}

impl Names {
    /// The symbol of `text`.
    pub(super) fn symbol(&mut self, text: &str) -> Symbol {
        if let Some(&symbol) = self.known.get(text) {
            return symbol;
        }
        let symbol = Symbol((self.texts.len() as u32) << 1 | u32::from(text.starts_with('$')));
        let text: Rc<str> = text.into();
        self.texts.push(text.clone());
        self.known.insert(text, symbol);
        symbol
    }

    /// The symbol of `text` if it occurs in the program at all.
    pub(super) fn find(&self, text: &str) -> Option<Symbol> {
        self.known.get(text).copied()
    }

    /// The text of `symbol`.
    pub(super) fn text(&self, symbol: Symbol) -> &str {
        &self.texts[symbol.index()]
    }

    /// How many names there are.
    pub(super) fn len(&self) -> usize {
        self.texts.len()
    }
}
