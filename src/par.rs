//! The only place that starts threads: ordered maps over slices, a plain loop where the work is small.
//!
//! Results come back in the order of the input, so nothing that is built from them depends on the number of
//! threads. The size of the pool is set once, by [`set_threads`].

use rayon::prelude::*;

/// Below this many items a plain loop is faster than waking the pool.
const SEQUENTIAL_BELOW: usize = 2048;

/// Sets the number of threads of the pool; 0 means one per core. Only the first call has an effect; later ones
/// (and calls after the pool has been used) return `false` and change nothing.
pub fn set_threads(count: usize) -> bool {
    rayon::ThreadPoolBuilder::new().num_threads(count).build_global().is_ok()
}

/// `f` of every item, in order. Runs on the pool when there are many items.
pub fn map<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    map_above(SEQUENTIAL_BELOW, items, f)
}

/// [`map`] with a threshold of its own, for items that are each a lot of work.
pub fn map_above<T: Sync, R: Send>(
    sequential_below: usize,
    items: &[T],
    f: impl Fn(&T) -> R + Sync + Send,
) -> Vec<R> {
    if items.len() < sequential_below {
        items.iter().map(f).collect()
    } else {
        items.par_iter().map(f).collect()
    }
}
