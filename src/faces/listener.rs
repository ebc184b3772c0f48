//! Who follows a preparation.

use crate::Error;

/// How many steps of one polygon are taken before they are told. Smaller: time for telling; larger: it
/// takes longer to stop.
pub(super) const STEPS_AT_ONCE: usize = 1 << 10;

/// Is told how far a preparation has come, from any thread, and may stop it by an error.
pub(crate) trait Listener: Sync {
    /// This many polygons have been read so far.
    fn read(&self, polygons: usize) -> Result<(), Error>;

    /// This many more steps of work have been taken, each about as long as it takes to find a corner's
    /// place among sorted ones.
    fn work(&self, steps: usize) -> Result<(), Error>;
}

/// Ignores all, and stops nothing.
pub(super) struct NoListener;

impl Listener for NoListener {
    fn read(&self, _: usize) -> Result<(), Error> {
        Ok(())
    }

    fn work(&self, _: usize) -> Result<(), Error> {
        Ok(())
    }
}
