//! What is passed to another thread, and when.

use super::piece::Piece;
use crate::exact::Vertex;

/// Where both sides of a plane have at least this many pieces, one side becomes a job of its own.
/// Smaller: more copying; larger: threads wait for each other at the end.
const JOB: usize = 1024;

/// A set of pieces with their vertices, to be built into a subtree.
pub(super) struct Job {
    pub(super) pieces: Vec<Piece>,
    pub(super) arena: Vec<Vertex>,
    /// How many nodes lie above it.
    pub(super) depth: usize,
}

impl Job {
    /// Whether it is too small to hand any set over: neither side of a plane has more pieces.
    #[cfg(feature = "parallel")]
    pub(super) fn is_the_last(&self) -> bool {
        self.pieces.len() < JOB
    }
}

/// Whether one side of a plane becomes a job of its own, by the numbers of pieces on both sides: only
/// where both are large is there work for another thread.
pub(super) fn is_worth_a_job(back: usize, front: usize) -> bool {
    back.min(front) >= JOB
}
