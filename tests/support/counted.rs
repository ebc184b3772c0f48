//! How often memory is asked for, in programs that count what all threads allocate.

use dhat::HeapStats;

#[global_allocator]
static COUNTING: dhat::Alloc = dhat::Alloc;

/// How often memory was asked for while something ran.
pub(crate) fn allocations(work: impl FnOnce()) -> u64 {
    let before = HeapStats::get().total_blocks;
    work();
    HeapStats::get().total_blocks - before
}
