//! Work on all threads: a function mapped over items, and two functions at the same time. (Subtrees are
//! built by `build/jobs.rs`.)

/// Maps a function over items; the results are in the order of the items.
///
/// # Errors
///
/// The error of the first item in the list that fails, even if a later item fails earlier in time. After a
/// failure, later items are not started.
pub(crate) fn map<T: Send, U: Send, E: Send>(
    items: Vec<T>,
    function: impl Fn(T) -> Result<U, E> + Sync,
) -> Result<Vec<U>, E> {
    // A single item needs no other thread, and waking a thread takes time.
    #[cfg(feature = "parallel")]
    if items.len() >= 2 && are_running() {
        use std::sync::atomic::{AtomicUsize, Ordering};
        use std::sync::{Mutex, PoisonError};

        // The smallest number of an item that has failed. Items with smaller numbers are never skipped, so
        // the first error is among the results.
        let failed = AtomicUsize::new(usize::MAX);
        let places: Vec<_> = items.into_iter().map(|item| Mutex::new((Some(item), None))).collect();
        for_each_number(places.len(), &|number| {
            if failed.load(Ordering::Relaxed) < number {
                return;
            }
            // Each lock is taken once.
            let mut place = places[number].lock().unwrap_or_else(PoisonError::into_inner);
            let result = place.0.take().map(&function);
            if let Some(Err(_)) = result {
                failed.fetch_min(number, Ordering::Relaxed);
            }
            place.1 = result;
        });
        let results = places
            .into_iter()
            .map(|place| place.into_inner().unwrap_or_else(PoisonError::into_inner).1);
        return results.flatten().collect();
    }
    items.into_iter().map(function).collect()
}

/// Calls a function with each number below `count`, on all threads. The machinery of rayon is compiled once for
/// all functions.
#[cfg(feature = "parallel")]
fn for_each_number(count: usize, function: &(dyn Fn(usize) + Sync)) {
    use rayon::prelude::*;

    (0..count).into_par_iter().for_each(function);
}

/// Calls `here` on this thread and `other` on a second thread at the same time, if the work is worth waking a
/// thread. If not, calls `other` and then `here`.
#[cfg(feature = "save")]
#[cfg_attr(not(feature = "parallel"), expect(unused_variables, reason = "there is one thread"))]
pub(crate) fn beside<T>(
    is_worth_it: bool,
    other: impl FnOnce() + Send,
    here: impl FnOnce() -> T,
) -> T {
    #[cfg(feature = "parallel")]
    if is_worth_it && are_running() {
        return rayon::in_place_scope(|scope| {
            scope.spawn(|_| other());
            here()
        });
    }
    other();
    here()
}

/// Whether rayon's threads run; if not, the calling thread does all work.
///
/// The first call starts the threads. If the threads cannot be started, for lack of memory or because of a
/// limit on threads, the result is false; without this test, rayon would panic.
#[cfg(feature = "parallel")]
pub(crate) fn are_running() -> bool {
    static ARE_RUNNING: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    // On targets without threads rayon uses the calling thread.
    cfg!(target_family = "wasm")
        || rayon::current_thread_index().is_some()
        || *ARE_RUNNING.get_or_init(|| {
            // An error without a cause means that the threads run already. (This error cannot be
            // distinguished from the error of an earlier failed attempt of the program itself.)
            let started = rayon::ThreadPoolBuilder::new().build_global();
            started.map_or_else(|error| std::error::Error::source(&error).is_none(), |()| true)
        })
}

#[cfg(all(test, feature = "parallel"))]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::map;

    fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
    }

    #[test]
    fn no_item_after_an_error_is_started() {
        let calls = AtomicUsize::new(0);
        let function = |item: u32| {
            calls.fetch_add(1, Ordering::Relaxed);
            if item == 10 { Err(item) } else { Ok(item) }
        };
        // A single thread processes items from the first to the last.
        let found = with_threads(1, || map((0..1000).collect(), function));
        assert_eq!((found, calls.into_inner()), (Err(10), 11));
    }

    #[test]
    fn the_error_of_the_first_failing_item_is_returned() {
        for first in [0, 1, 17, 500, 998, 999] {
            // Later items fail sooner.
            let function = |item: u32| {
                let turns = if item == first { 20_000 } else { 0 };
                (0..turns).for_each(|turn| _ = std::hint::black_box(turn));
                if item < first { Ok(item) } else { Err(item) }
            };
            for threads in [1, 2, 8] {
                let found = with_threads(threads, || map((0..1000).collect(), function));
                assert_eq!(found, Err(first), "{threads} threads");
            }
        }
        let found = with_threads(4, || map((0..1000).collect(), |item: u32| Ok::<_, ()>(2 * item)));
        assert!(found.unwrap().into_iter().eq((0..2000).step_by(2)));
    }
}
