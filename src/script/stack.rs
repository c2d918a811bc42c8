//! Room for recursion: scripts may nest and recurse far deeper than the stack of a thread.

/// Left on the stack when more is taken: enough for the longest run of calls between two uses of [`with_room`].
const RED_ZONE: usize = 128 << 10;
/// Taken at a time.
const SEGMENT: usize = 4 << 20;

/// Runs `f` with room on the stack, on a new segment of it where little is left.
#[inline]
pub(super) fn with_room<R>(f: impl FnOnce() -> R) -> R {
    stacker::maybe_grow(RED_ZONE, SEGMENT, f)
}
