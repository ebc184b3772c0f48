//! What is chosen.

use super::peel::Peeled;
use crate::exact::PlaneId;

/// What is to be done with a set.
#[derive(Debug)]
pub(in crate::build) enum Choice {
    /// It is divided by this plane.
    Split(PlaneId),
    /// These pieces are taken off it.
    Peel(Peeled),
}
