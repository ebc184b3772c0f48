//! The arena of cut pieces' vertices: compacts it, and moves a set out of it.

use std::mem::take;

use super::state::{Builder, COMPACT};
use crate::build::job::Job;
use crate::error::{Error, Limit};
use crate::memory::collect;

impl Builder<'_> {
    /// Removes the vertices of pieces that have since been cut. The arena so stays within twice the
    /// size that the sets still to be split need, however often one piece is cut.
    pub(super) fn compact(&mut self) -> Result<(), Error> {
        let mut arena = Vec::new();
        for pending in &mut self.pending {
            // Empty if another job builds the set.
            for live in &mut self.pieces[pending.range.clone()] {
                *live = live.copied(&self.arena, &mut arena)?;
            }
            pending.arena = arena.len();
        }
        self.arena = arena;
        self.compact_at = COMPACT.max(2 * self.arena.len());
        // Pieces index their vertices with 32 bits.
        let limit = self.shared.options.max_fragments;
        if self.arena.len() > 1 << 31 { Err(Limit::Fragments(limit).error()) } else { Ok(()) }
    }

    /// Removes the set on top of the stack and gives it an arena of its own.
    pub(super) fn take(&mut self, start: usize, depth: usize) -> Result<Job, Error> {
        let mut arena = Vec::new();
        let mut pieces =
            if start == 0 { take(&mut self.pieces) } else { collect(self.pieces.drain(start..))? };
        for live in &mut pieces {
            *live = live.copied(&self.arena, &mut arena)?;
        }
        pieces.shrink_to_fit();
        Ok(Job { pieces, arena, depth })
    }
}
