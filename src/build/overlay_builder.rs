//! Small trees of an overlay's pieces, each of those that meet in one cell of the tree.

use std::mem::take;

use super::builder::{Memory, Shared};
use super::choose::Tuning;
use super::job::Job;
use super::options::BuildOptions;
use super::piece::Piece;
use super::progress::Watch;
use super::threads;
use crate::error::Error;
use crate::exact::{Faces, Vertex};
use crate::memory::reserve;
use crate::tree::node_record::MOST_FRAGMENTS;
use crate::tree::parts::Parts;

/// Builds a tree of the pieces in each cell, in memory that it keeps.
#[derive(Default)]
pub(crate) struct OverlayBuilder {
    memory: Memory,
}

impl OverlayBuilder {
    /// A tree of some pieces, with the positions of its vertices. Give the parts back to
    /// [`keep`](Self::keep) when they are read.
    ///
    /// # Errors
    ///
    /// If there are too many fragments, if it is cancelled, or if memory runs out.
    pub(crate) fn build(
        &mut self,
        faces: &Faces,
        pieces: &[Piece],
        arena: &[Vertex],
        watch: &Watch<'_>,
    ) -> Result<Parts, Error> {
        let Self { memory } = self;
        let mut job =
            Job { pieces: take(&mut memory.pieces), arena: take(&mut memory.arena), depth: 0 };
        job.pieces.clear();
        job.arena.clear();
        reserve(&mut job.pieces, pieces.len())?;
        for piece in pieces {
            job.pieces.push(piece.copied(arena, &mut job.arena)?);
        }
        // The budget counts all faces, the tree's among them.
        let options = BuildOptions::DEFAULT.with_max_fragments(MOST_FRAGMENTS);
        let shared = Shared::new(faces, &options, &Tuning::FRAMES, watch)?;
        threads::run(&shared.with_positions(), job, memory)
    }

    /// Keeps the memory of a tree for the next.
    pub(crate) fn keep(&mut self, parts: Parts) {
        self.memory.output.parts = parts;
    }
}
