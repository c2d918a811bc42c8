use crate::math::Interval;

/// What a field's values over a cell are proven to be.
///
/// After IEEE 1788-2015, whose decorations say the same in one word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Holds every value that is a number; empty when there is none.
    pub interval: Interval,
    /// Every point of the cell has a value: none is NaN.
    pub defined: bool,
    /// The values change continuously over the cell.
    pub continuous: bool,
}

impl Range {
    /// Anything at all.
    pub const UNKNOWN: Range = Range { interval: Interval::ENTIRE, defined: false, continuous: false };

    /// Values that are defined everywhere and change continuously.
    #[inline]
    pub fn of(interval: Interval) -> Range {
        Range { interval, defined: true, continuous: true }
    }

    /// Whether the whole cell is inside: every point has a value and it is negative.
    #[inline]
    pub fn is_inside(self) -> bool {
        self.defined && self.interval.hi < 0.0
    }

    /// Whether the whole cell is outside: every point has a value and none is negative.
    #[inline]
    pub fn is_outside(self) -> bool {
        self.defined && self.interval.lo >= 0.0
    }

    /// Whether no point of the cell has a value.
    #[inline]
    pub fn is_undefined(self) -> bool {
        self.interval.is_empty()
    }
}
