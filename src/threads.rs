//! Whether there are threads to work with.

use std::error::Error;
use std::sync::OnceLock;

/// Whether rayon's threads run; if not, all work is for the calling thread.
///
/// They are started here at the first use: where that fails, because memory for their stacks or a
/// limit on threads is lacking, rayon itself would panic.
pub(crate) fn are_running() -> bool {
    static ARE_RUNNING: OnceLock<bool> = OnceLock::new();
    // For targets without threads rayon uses the calling one.
    cfg!(target_family = "wasm")
        || rayon::current_thread_index().is_some()
        || *ARE_RUNNING.get_or_init(start)
}

/// If the program itself tried to start rayon's threads before, and failed, this cannot tell.
fn start() -> bool {
    // An error without a cause means that they run already.
    let started = rayon::ThreadPoolBuilder::new().build_global();
    started.map_or_else(|error| error.source().is_none(), |()| true)
}
