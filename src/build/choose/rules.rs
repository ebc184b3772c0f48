//! What the chooser is told, and what it answers.

use super::peel::Peeled;
use super::tuning::{Quick, Tuning};
use crate::build::heuristic::Heuristic;
use crate::build::progress::Watch;
use crate::exact::PlaneId;

/// The most pieces of a set that is divided from a table: half as many as a table has room for.
pub(in crate::build) const MOST_IN_TABLE: usize = 32;

/// What is to be done with a set.
#[derive(Debug)]
pub(in crate::build) enum Choice {
    /// It is divided by this plane.
    Split(PlaneId),
    /// These pieces are taken off it.
    Peel(Peeled),
}

/// The settings of the chooser.
#[derive(Clone, Copy, Debug)]
pub(in crate::build) struct Rules<'a> {
    pub(in crate::build) heuristic: Heuristic,
    pub(in crate::build) tuning: &'a Tuning,
    /// Once a build is cancelled, any plane is chosen, quickly.
    pub(in crate::build) watch: &'a Watch<'a>,
}

impl<'a> Rules<'a> {
    /// How a set is divided from a table of all pieces against all planes; `None` if it is not.
    pub(in crate::build) fn tabled(&self, pieces: usize) -> Option<&'a Quick> {
        let quick = self.tuning.quick.as_ref()?;
        let is_tabled =
            self.heuristic == Heuristic::Auto && pieces <= quick.table.min(MOST_IN_TABLE);
        is_tabled.then_some(quick)
    }
}
