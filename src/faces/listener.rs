//! Who follows a preparation.

use crate::Error;

/// Is told how far a preparation has come, from any thread, and may stop it by an error.
pub(crate) trait Listener: Sync {
    /// This many polygons have been read so far.
    fn read(&self, polygons: usize) -> Result<(), Error>;

    /// This many more steps of work have been taken.
    fn work(&self, steps: usize) -> Result<(), Error>;
}

/// Ignores all, and stops nothing.
pub(super) struct Unheard;

impl Listener for Unheard {
    fn read(&self, _: usize) -> Result<(), Error> {
        Ok(())
    }

    fn work(&self, _: usize) -> Result<(), Error> {
        Ok(())
    }
}
