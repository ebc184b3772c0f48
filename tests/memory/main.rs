//! The number and size of allocations of the whole process: a separate program, because its allocator
//! counts the allocations of all threads.

mod input_limits;
mod layers;
mod loading;
mod orders_and_frames;

use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use stats_alloc::StatsAlloc;
use std::alloc::System;
use std::sync::{Mutex, PoisonError};

static COUNTING: StatsAlloc<System> = StatsAlloc::system();

#[global_allocator]
static MEASURING: PeakMemAlloc<&StatsAlloc<System>> = PeakMemAlloc::new(&COUNTING);

/// Runs `work` while no other test of this program runs, and counts. All that a test allocates is in its `work`.
fn counted(work: impl FnOnce()) {
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    count_from_here();
    work();
}

/// Counts bytes from here on.
fn count_from_here() {
    MEASURING.reset_peak_memory();
}

/// The number of allocations while `work` runs.
fn allocations(work: impl FnOnce()) -> usize {
    let all = || {
        let stats = COUNTING.stats();
        stats.allocations + stats.reallocations
    };
    let before = all();
    work();
    all() - before
}

/// The fewest allocations of many runs. The test runner starts and ends threads while a test runs, and these
/// allocate. So a test fails only if every run allocates.
fn least_allocations(mut work: impl FnMut()) -> usize {
    let mut least = usize::MAX;
    for _ in 0..1000 {
        least = least.min(allocations(&mut work));
        if least == 0 {
            break;
        }
    }
    least
}

/// The largest memory in use at once, besides what was in use where counting began.
fn most_bytes() -> usize {
    MEASURING.get_peak_memory()
}

#[test]
fn allocations_and_bytes_are_counted() {
    counted(|| {
        let mut list = vec![1_u8];
        assert!(allocations(|| list = vec![0; 1 << 20]) > 0);
        assert!(allocations(|| list.reserve(1 << 20)) > 0);
        // Threads of other tests that end return a few bytes.
        assert!((2_000_000..3_000_000).contains(&most_bytes()), "{}", most_bytes());
    });
}
