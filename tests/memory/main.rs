//! The number and size of allocations of the whole process: a separate program, because its allocator
//! counts the allocations of all threads.

mod input_limits;
mod layers;
mod loading;
mod orders_and_frames;

use dhat::{HeapStats, Profiler};
use std::sync::{Mutex, PoisonError};

#[global_allocator]
static COUNTING: dhat::Alloc = dhat::Alloc;

/// Runs `work` while no other test of this program runs, and counts.
fn counted(work: impl FnOnce()) {
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let _profiler = Profiler::builder().testing().trim_backtraces(Some(4)).build();
    work();
}

/// The number of allocations while `work` runs.
fn allocations(work: impl FnOnce()) -> u64 {
    let before = HeapStats::get().total_blocks;
    work();
    HeapStats::get().total_blocks - before
}

/// The fewest allocations of many runs. The test runner starts and ends threads while a test runs, and these
/// allocate. So a test fails only if every run allocates.
fn least_allocations(mut work: impl FnMut()) -> u64 {
    let mut least = u64::MAX;
    for _ in 0..1000 {
        least = least.min(allocations(&mut work));
        if least == 0 {
            break;
        }
    }
    least
}

/// The largest memory in use at once.
fn most_bytes() -> usize {
    HeapStats::get().max_bytes
}
