//! By what planes are chosen.

use super::tuning::Tuning;
use crate::build::heuristic::Heuristic;
use crate::build::progress::Watch;

/// The most pieces of a set that is divided from a table: half as many as the table has room for.
const MOST: usize = 32;

/// By what planes are chosen.
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
        self.heuristic == Heuristic::Auto && pieces <= self.tuning.table.min(MOST)
    }
}
