//! How often a triangulation asks whether to go on.

use crate::Error;

/// Hears of steps of work, each about as long as it takes to find a corner's place among sorted
/// ones, and stops it all by an error.
pub(in crate::faces) type Work<'a> = &'a dyn Fn(usize) -> Result<(), Error>;

/// How many steps are taken before it is asked whether to go on. Smaller: time for asking; larger:
/// it takes longer to stop.
pub(super) const AT_ONCE: usize = 1 << 10;
