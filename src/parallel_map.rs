//! Work on all threads: a function mapped over items, and two functions at the same time.

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

/// Calls a function here and another one beside it, if that is worth waking a thread; else before it.
#[cfg(all(feature = "parallel", feature = "save"))]
pub(crate) fn beside<T>(
    is_worth_it: bool,
    other: impl FnOnce() + Send,
    here: impl FnOnce() -> T,
) -> T {
    if is_worth_it && crate::threads::are_running() {
        return rayon::in_place_scope(|scope| {
            scope.spawn(|_| other());
            here()
        });
    }
    other();
    here()
}

/// As above, one after the other.
#[cfg(all(not(feature = "parallel"), feature = "save"))]
pub(crate) fn beside<T>(_: bool, other: impl FnOnce(), here: impl FnOnce() -> T) -> T {
    other();
    here()
}
