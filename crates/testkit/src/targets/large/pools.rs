//! Pools of one, two and three threads, made once.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::LazyLock;

/// With more, threads wait for each other.
pub(super) const MOST_THREADS: usize = 3;

/// Runs in a pool of this many threads.
pub(super) fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    static POOLS: LazyLock<[ThreadPool; MOST_THREADS]> = LazyLock::new(|| {
        let pool = |before: usize| ThreadPoolBuilder::new().num_threads(before + 1).build();
        std::array::from_fn(|before| pool(before).expect("a pool"))
    });
    POOLS[threads - 1].install(work)
}
