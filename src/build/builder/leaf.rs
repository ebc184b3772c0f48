//! Which sets are leaves, and how their pieces are stored.

use super::state::Builder;
use crate::Error;
use crate::build::live::Live;
use crate::exact::{Kernel, Vertex};

/// Whether a set is small enough to need no plane.
pub(super) fn is_leaf(pieces: &[Live]) -> bool {
    pieces.len() <= 1
}

/// As above, of a set of slots of a table.
pub(super) fn is_leaf_of_table(set: u64) -> bool {
    set.count_ones() <= 1
}

impl<K: Kernel> Builder<'_, K> {
    /// Appends a piece to the output as a fragment.
    pub(super) fn store(&mut self, live: Live) -> Result<(), Error> {
        let kernel = self.shared.kernel;
        let vertices = live.piece(&self.arena).cut.unwrap_or_default();
        self.output.push(live.face, vertices.iter().map(|vertex| kernel.store(vertex)))?;
        if self.shared.keeps_positions {
            self.output.push_positions(vertices.iter().map(K::Vertex::position))?;
        }
        self.shared.rules.watch.finish(live.cuts);
        Ok(())
    }
}
