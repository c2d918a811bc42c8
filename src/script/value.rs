//! Values of the language.

use super::ast::FunctionId;
use super::heap;
use crate::sdf::Expr;
use std::cell::RefCell;
use std::rc::Rc;

/// Any value. Clones share what they hold.
#[derive(Clone, Debug, Default)]
pub(super) enum Value {
    #[default]
    Undef,
    Bool(bool),
    Number(f64),
    Text(Rc<Text>),
    List(List),
    Range(Rc<Range>),
    Function(Rc<Closure>),
    /// A number that depends on coordinates, while a function is traced.
    Formula(Expr),
}

impl Value {
    /// The name of its type, as a message has it.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Value::Undef => "undef",
            Value::Bool(_) => "bool",
            Value::Number(_) => "number",
            Value::Text(_) => "string",
            Value::List(_) => "list",
            Value::Range(_) => "range",
            Value::Function(_) => "function",
            Value::Formula(_) => "formula",
        }
    }

    /// Whether a condition holds for it: false for `undef`, `false`, 0, the empty text and the empty list.
    pub(super) fn is_true(&self) -> bool {
        match self {
            Value::Undef => false,
            Value::Bool(value) => *value,
            Value::Number(value) => *value != 0.0,
            Value::Text(text) => !text.as_str().is_empty(),
            Value::List(list) => !list.is_empty(),
            Value::Range(_) | Value::Function(_) | Value::Formula(_) => true,
        }
    }

    /// Whether dropping it may drop other values.
    pub(super) fn holds_values(&self) -> bool {
        matches!(self, Value::List(_) | Value::Function(_))
    }

    pub(super) fn is_undef(&self) -> bool {
        matches!(self, Value::Undef)
    }

    /// The number, if it is one.
    pub(super) fn number(&self) -> Option<f64> {
        if let Value::Number(value) = self { Some(*value) } else { None }
    }

    /// The number, if it is one and neither NaN nor infinite.
    pub(super) fn finite(&self) -> Option<f64> {
        self.number().filter(|value| value.is_finite())
    }

    pub(super) fn list(&self) -> Option<&List> {
        if let Value::List(list) = self { Some(list) } else { None }
    }

    pub(super) fn text(&self) -> Option<&str> {
        if let Value::Text(text) = self { Some(text.as_str()) } else { None }
    }

    /// A text.
    pub(super) fn from_text(text: impl Into<String>) -> Value {
        Value::Text(Rc::new(Text::new(text.into())))
    }

    /// A list of numbers.
    pub(super) fn from_numbers(numbers: Vec<f64>) -> Value {
        Value::List(List::new(Items::Numbers(numbers)))
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Value {
        Value::Number(value)
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Value {
        Value::Bool(value)
    }
}

impl FromIterator<Value> for Value {
    fn from_iter<I: IntoIterator<Item = Value>>(values: I) -> Value {
        let mut items = Items::default();
        values.into_iter().for_each(|value| items.push(value));
        Value::List(List::new(items))
    }
}

/// A text, with its length in characters counted once.
#[derive(Debug)]
pub(super) struct Text {
    text: Box<str>,
    chars: usize,
}

impl Text {
    pub(super) fn new(text: String) -> Text {
        heap::took(text.len());
        Text { chars: text.chars().count(), text: text.into() }
    }

    pub(super) fn as_str(&self) -> &str {
        &self.text
    }

    /// Number of characters.
    pub(super) fn len(&self) -> usize {
        self.chars
    }

    /// The character with this index.
    pub(super) fn char(&self, index: usize) -> Option<char> {
        if self.chars == self.text.len() {
            self.text.as_bytes().get(index).map(|&byte| byte as char)
        } else {
            self.text.chars().nth(index)
        }
    }
}

impl Drop for Text {
    fn drop(&mut self) {
        heap::gave_back(self.text.len());
    }
}

/// A list.
#[derive(Clone, Debug)]
pub(super) struct List(Rc<Items>);

/// What a list holds. Numbers alone are kept without the tags of values.
#[derive(Debug)]
pub(super) enum Items {
    Numbers(Vec<f64>),
    Values(Vec<Value>),
}

impl Default for Items {
    fn default() -> Items {
        Items::Numbers(Vec::new())
    }
}

impl Items {
    pub(super) fn len(&self) -> usize {
        match self {
            Items::Numbers(numbers) => numbers.len(),
            Items::Values(values) => values.len(),
        }
    }

    /// Appends a value; numbers stay packed until something else comes.
    pub(super) fn push(&mut self, value: Value) {
        match (&mut *self, value) {
            (Items::Numbers(numbers), Value::Number(number)) => numbers.push(number),
            (Items::Numbers(numbers), value) => {
                let mut values: Vec<Value> = Vec::with_capacity(numbers.len() + 1);
                values.extend(numbers.iter().map(|&number| Value::Number(number)));
                values.push(value);
                *self = Items::Values(values);
            }
            (Items::Values(values), value) => values.push(value),
        }
    }

    /// Appends all of `list`.
    pub(super) fn extend(&mut self, list: &List) {
        match (&mut *self, &*list.0) {
            (Items::Numbers(numbers), Items::Numbers(more)) => numbers.extend_from_slice(more),
            (Items::Values(values), Items::Values(more)) => values.extend_from_slice(more),
            _ => list.iter().for_each(|value| self.push(value)),
        }
    }

    /// Bytes it takes.
    pub(super) fn bytes(&self) -> usize {
        let header = 64;
        header
            + match self {
                Items::Numbers(numbers) => 8 * numbers.capacity(),
                Items::Values(values) => size_of::<Value>() * values.capacity(),
            }
    }
}

impl Drop for Items {
    fn drop(&mut self) {
        if let Items::Values(values) = self
            && values.iter().any(Value::holds_values)
        {
            heap::bury(std::mem::take(values));
        }
    }
}

/// Gives back the weight of a list when the list goes.
impl Drop for List {
    fn drop(&mut self) {
        if Rc::strong_count(&self.0) == 1 {
            heap::gave_back(self.0.bytes());
        }
    }
}

impl List {
    pub(super) fn new(items: Items) -> List {
        heap::took(items.bytes());
        List(Rc::new(items))
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers, if it holds nothing else. An empty list holds nothing else.
    pub(super) fn numbers(&self) -> Option<&[f64]> {
        match &*self.0 {
            Items::Numbers(numbers) => Some(numbers),
            Items::Values(_) => None,
        }
    }

    pub(super) fn get(&self, index: usize) -> Option<Value> {
        match &*self.0 {
            Items::Numbers(numbers) => numbers.get(index).map(|&number| Value::Number(number)),
            Items::Values(values) => values.get(index).cloned(),
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Value> + '_ {
        (0..self.len()).filter_map(|index| self.get(index))
    }
}

/// `[begin : step : end]`; a list that is never written out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) begin: f64,
    pub(super) step: f64,
    pub(super) end: f64,
}

impl Range {
    /// Number of values; infinite for a step of 0, 0 where the step leads away from the end.
    pub(super) fn count(&self) -> f64 {
        let Range { begin, step, end } = *self;
        if begin.is_nan()
            || step.is_nan()
            || end.is_nan()
            || (step > 0.0 && begin > end)
            || (step < 0.0 && begin < end)
        {
            return 0.0;
        }
        if begin == end {
            return 1.0;
        }
        if step == 0.0 {
            return f64::INFINITY;
        }
        // One step of rounding up, so that [0 : 0.1 : 0.3] reaches its end.
        ((end - begin) / step).next_up().floor() + 1.0
    }

    /// The value with this index.
    pub(super) fn at(&self, index: u64) -> f64 {
        if index == 0 { self.begin } else { self.begin + index as f64 * self.step }
    }
}

/// A function as a value, with the variables around it.
#[derive(Debug)]
pub(super) struct Closure {
    pub(super) function: FunctionId,
    pub(super) frame: Rc<Frame>,
}

/// The variables of a scope while it runs, and after that for as long as a function value keeps them.
#[derive(Debug)]
pub(super) struct Frame {
    pub(super) slots: RefCell<Vec<Option<Value>>>,
    pub(super) parent: Option<Rc<Frame>>,
}

impl Frame {
    pub(super) fn new(size: u32, parent: Option<Rc<Frame>>) -> Rc<Frame> {
        heap::took(Frame::bytes(size as usize));
        Rc::new(Frame { slots: RefCell::new(vec![None; size as usize]), parent })
    }

    fn bytes(slots: usize) -> usize {
        64 + size_of::<Option<Value>>() * slots
    }

    #[inline]
    pub(super) fn get(&self, slot: u32) -> Option<Value> {
        self.slots.borrow()[slot as usize].clone()
    }

    pub(super) fn set(&self, slot: u32, value: Option<Value>) {
        let before = std::mem::replace(&mut self.slots.borrow_mut()[slot as usize], value);
        drop(before);
    }
}

impl Drop for Frame {
    fn drop(&mut self) {
        let slots = std::mem::take(self.slots.get_mut());
        heap::gave_back(Frame::bytes(slots.len()));
        if slots.iter().flatten().any(Value::holds_values) {
            heap::bury(slots.into_iter().flatten().collect());
        }
        // A chain of frames is let go one by one.
        let mut parent = self.parent.take();
        while let Some(frame) = parent {
            parent = Rc::into_inner(frame).and_then(|mut frame| frame.parent.take());
        }
    }
}
