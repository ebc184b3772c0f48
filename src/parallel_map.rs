//! Maps a function over items on all threads.

/// Maps a function over items; the results are in the order of the items.
#[cfg(feature = "parallel")]
pub(crate) fn map<T: Send, U: Send>(items: Vec<T>, function: impl Fn(T) -> U + Sync) -> Vec<U> {
    use rayon::prelude::*;

    // A single item needs no other thread, and waking one takes time.
    if items.len() < 2 || !crate::threads::are_running() {
        return items.into_iter().map(function).collect();
    }
    items.into_par_iter().map(&function).collect()
}

/// As above, one after the other.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<T, U>(items: Vec<T>, function: impl Fn(T) -> U) -> Vec<U> {
    items.into_iter().map(function).collect()
}
