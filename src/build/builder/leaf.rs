//! Which sets are leaves, and how their pieces are stored.

use super::state::Builder;
use crate::Error;
use crate::build::piece::Piece;
use crate::exact::Vertex;

/// Whether a set is small enough to need no plane.
pub(super) fn is_leaf(pieces: &[Piece]) -> bool {
    pieces.len() <= 1
}

/// As above, of a set of slots of a table.
pub(super) fn is_leaf_of_table(set: u64) -> bool {
    set.count_ones() <= 1
}

impl Builder<'_> {
    /// Appends a piece to the output as a fragment.
    pub(super) fn store(&mut self, live: Piece) -> Result<(), Error> {
        let vertices = live.cut_vertices(&self.arena).unwrap_or_default();
        self.output.push(live.face, vertices.iter().map(Vertex::stored))?;
        if self.shared.keeps_positions {
            self.output.push_positions(vertices.iter().map(Vertex::position))?;
        }
        self.shared.rules.watch.finish(live.cuts);
        Ok(())
    }
}
