//! What values weigh, and how they die.
//!
//! The bytes of lists and texts alive on this thread are counted as they come and go, so that a script can be stopped
//! before it takes all memory. A list may hold a list may hold a list, millions deep: when the last reference to the
//! outermost goes, those inside are dropped one after the other, not one within the other.

use super::value::Value;
use std::cell::{Cell, RefCell};

thread_local! {
    static ALIVE: Cell<usize> = const { Cell::new(0) };
    static GRAVES: RefCell<Option<Vec<Vec<Value>>>> = const { RefCell::new(None) };
}

/// Bytes of the values alive on this thread.
pub(super) fn alive() -> usize {
    ALIVE.get()
}

/// Counts `bytes` that were taken.
pub(super) fn took(bytes: usize) {
    ALIVE.set(ALIVE.get() + bytes);
}

/// Counts `bytes` that were given back.
pub(super) fn gave_back(bytes: usize) {
    // A value may outlive the thread-local counter at the end of a thread.
    let _ = ALIVE.try_with(|alive| alive.set(alive.get().saturating_sub(bytes)));
}

/// Drops `values`; when this happens within another such drop, after it.
pub(super) fn bury(values: Vec<Value>) {
    if !values.iter().any(Value::holds_values) {
        return;
    }
    let mut waiting = Some(values);
    let outermost = GRAVES.try_with(|graves| {
        let mut graves = graves.borrow_mut();
        match graves.as_mut() {
            Some(graves) => {
                graves.extend(waiting.take());
                false
            }
            None => {
                *graves = Some(Vec::new());
                true
            }
        }
    });
    drop(waiting);
    if outermost != Ok(true) {
        return;
    }
    let next = || GRAVES.with(|graves| graves.borrow_mut().as_mut().and_then(Vec::pop));
    while let Some(values) = next() {
        drop(values);
    }
    GRAVES.with(|graves| *graves.borrow_mut() = None);
}
