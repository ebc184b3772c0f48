//! Work on all threads: a function mapped over items, and two functions at the same time. (Subtrees are
//! built by `build/threads.rs`.)

/// Maps a function over items; the results are in the order of the items.
#[cfg(feature = "parallel")]
pub(crate) fn map<T: Send, U: Send>(items: Vec<T>, function: impl Fn(T) -> U + Sync) -> Vec<U> {
    use rayon::prelude::*;

    // A single item needs no other thread, and waking one takes time.
    if items.len() < 2 || !are_running() {
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
    if is_worth_it && are_running() {
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

/// Whether rayon's threads run; if not, all work is for the calling thread.
///
/// They are started here at the first use: where that fails, because memory for their stacks or a
/// limit on threads is lacking, rayon itself would panic.
#[cfg(feature = "parallel")]
pub(crate) fn are_running() -> bool {
    static ARE_RUNNING: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    // For targets without threads rayon uses the calling one.
    cfg!(target_family = "wasm")
        || rayon::current_thread_index().is_some()
        || *ARE_RUNNING.get_or_init(start)
}

/// If the program itself tried to start rayon's threads before, and failed, this cannot tell.
#[cfg(feature = "parallel")]
fn start() -> bool {
    // An error without a cause means that they run already.
    let started = rayon::ThreadPoolBuilder::new().build_global();
    started.map_or_else(|error| std::error::Error::source(&error).is_none(), |()| true)
}
