//! Work that is the same for each of many items, by all threads.

/// What a function makes of each item, in the order of the items.
#[cfg(feature = "parallel")]
pub(crate) fn map<T: Send, U: Send>(items: Vec<T>, function: impl Fn(T) -> U + Sync) -> Vec<U> {
    use rayon::prelude::*;

    // To wake other threads takes longer than little work.
    if items.len() < 2 {
        return items.into_iter().map(function).collect();
    }
    items.into_par_iter().map(&function).collect()
}

/// What a function makes of each item, in the order of the items.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<T, U>(items: Vec<T>, function: impl Fn(T) -> U) -> Vec<U> {
    items.into_iter().map(function).collect()
}
