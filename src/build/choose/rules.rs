//! The settings of the chooser.

use super::tuning::Tuning;
use crate::build::heuristic::Heuristic;
use crate::build::progress::Watch;

/// The most pieces of a set that is divided from a table: half as many as a table has room for.
pub(in crate::build) const MOST_IN_TABLE: usize = 32;

/// The settings of the chooser.
#[derive(Clone, Copy, Debug)]
pub(in crate::build) struct Rules<'a> {
    pub(in crate::build) heuristic: Heuristic,
    pub(in crate::build) tuning: &'a Tuning,
    /// Once a build is cancelled, any plane is chosen, quickly.
    pub(in crate::build) watch: &'a Watch<'a>,
}

impl Rules<'_> {
    /// Whether a set is divided from a table of all pieces against all planes.
    pub(in crate::build) fn is_small(&self, pieces: usize) -> bool {
        self.heuristic == Heuristic::Auto && pieces <= self.tuning.table.min(MOST_IN_TABLE)
    }
}
