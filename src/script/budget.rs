//! How much a script may still do.

use super::Options;
use super::heap;
use super::stack::with_room;
use super::value::Value;

/// Levels of expression a level of calls may take, on average.
const LEVELS_A_CALL: u32 = 64;

/// Bytes of stack a level of calls takes, roughly.
const STACK_A_CALL: usize = 4096;

/// Steps between two looks at memory.
const STEPS_A_LOOK: u64 = 256;

/// Why an operation has no value.
#[derive(Debug, PartialEq)]
pub(super) enum Fault {
    /// Its value is `undef`, which deserves a warning.
    Undefined(String),
    /// The script has to stop.
    Limit(String),
}

/// A value, or why there is none.
pub(super) type Outcome = Result<Value, Fault>;

/// A fault with a value of `undef`.
pub(super) fn undefined<T>(text: impl Into<String>) -> Result<T, Fault> {
    Err(Fault::Undefined(text.into()))
}

/// What is left of the limits of [`Options`].
#[derive(Debug)]
pub(super) struct Budget {
    steps_left: u64,
    most_steps: u64,
    calls: u32,
    most_calls: u32,
    levels: u32,
    /// Bytes alive when evaluation began.
    base: usize,
    most_bytes: u64,
}

impl Budget {
    pub(super) fn new(options: &Options) -> Budget {
        Budget {
            steps_left: options.max_steps,
            most_steps: options.max_steps,
            calls: 0,
            most_calls: options.max_depth,
            levels: 0,
            base: heap::alive(),
            most_bytes: options.max_bytes,
        }
    }

    /// Takes `steps` of those allowed, and looks at memory every now and then.
    #[inline]
    pub(super) fn spend(&mut self, steps: u64) -> Result<(), Fault> {
        if self.steps_left < steps {
            self.steps_left = 0;
            return Err(Fault::Limit(format!("the script takes more than {} steps", self.most_steps)));
        }
        self.steps_left -= steps;
        if self.steps_left % STEPS_A_LOOK < steps { self.reserve(0) } else { Ok(()) }
    }

    /// Whether `bytes` more may be taken.
    #[inline]
    pub(super) fn reserve(&self, bytes: usize) -> Result<(), Fault> {
        let alive = heap::alive().saturating_sub(self.base).saturating_add(bytes);
        if alive as u64 > self.most_bytes {
            return Err(Fault::Limit(format!(
                "the values of the script take more than {} bytes",
                self.most_bytes
            )));
        }
        Ok(())
    }

    /// Enters a call that is not a tail call; [`Budget::leave_call`] is its counterpart.
    pub(super) fn enter_call(&mut self) -> Result<(), Fault> {
        if self.calls == self.most_calls {
            return Err(Fault::Limit(format!("calls are nested more than {} deep", self.most_calls)));
        }
        self.reserve(STACK_A_CALL * self.calls as usize)?;
        self.calls += 1;
        Ok(())
    }

    pub(super) fn leave_call(&mut self) {
        self.calls -= 1;
    }

    /// Enters an expression or a value within another.
    #[inline]
    pub(super) fn enter_level(&mut self) -> Result<(), Fault> {
        if self.levels >= self.most_calls.saturating_mul(LEVELS_A_CALL) {
            return Err(Fault::Limit("expressions or values are nested too deep".to_owned()));
        }
        self.levels += 1;
        Ok(())
    }

    #[inline]
    pub(super) fn leave_level(&mut self) {
        self.levels -= 1;
    }

    /// Runs `f` one level deeper, with room on the stack.
    pub(super) fn deeper<R>(&mut self, f: impl FnOnce(&mut Budget) -> Result<R, Fault>) -> Result<R, Fault> {
        self.enter_level()?;
        let result = with_room(|| f(self));
        self.leave_level();
        result
    }
}
