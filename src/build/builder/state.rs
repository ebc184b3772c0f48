//! What a job works on.

use std::mem::take;
use std::ops::Range;

use super::table::Table;
use crate::Error;
use crate::build::assemble::Output;
use crate::build::budget::Budget;
use crate::build::choose::{Chooser, Rules, Tuning};
use crate::build::job::Job;
use crate::build::options::BuildOptions;
use crate::build::piece::{Piece, Splitter};
use crate::build::progress::Watch;
use crate::exact::{Faces, Side, Vertex};

/// The smallest arena, in vertices, that is compacted. Smaller: time to copy; larger: memory.
pub(super) const COMPACT: usize = 1 << 13;

/// What all jobs of a build share.
pub(in crate::build) struct Shared<'a> {
    pub(super) faces: &'a Faces,
    pub(super) options: &'a BuildOptions,
    pub(super) rules: Rules<'a>,
    pub(super) budget: Budget,
    /// Whether the rounded positions of vertices go into the output.
    pub(super) keeps_positions: bool,
}

impl<'a> Shared<'a> {
    /// An error if there are more faces than the budget allows fragments.
    pub(in crate::build) fn new(
        faces: &'a Faces,
        options: &'a BuildOptions,
        tuning: &'a Tuning,
        watch: &'a Watch<'a>,
    ) -> Result<Self, Error> {
        let budget = Budget::new(options, faces.len())?;
        let rules = Rules { heuristic: options.heuristic, tuning, watch };
        Ok(Self { faces, options, rules, budget, keeps_positions: false })
    }

    /// Stops all jobs of the build.
    #[cfg(feature = "parallel")]
    pub(in crate::build) fn stop(&self) {
        self.rules.watch.stop();
    }

    /// The same, with positions in the output.
    pub(in crate::build) fn with_positions(self) -> Self {
        Self { keeps_positions: true, ..self }
    }
}

/// A set of pieces that is still to be split: a range of the stack of pieces.
pub(super) struct Pending {
    pub(super) range: Range<usize>,
    /// The length of the arena that it needs.
    pub(super) arena: usize,
    pub(super) depth: usize,
    /// Whether peeling has just been tried on this set. Then a small set is split by a plane first.
    pub(super) is_peeled: bool,
    /// The job that builds it, if that is not this one.
    pub(super) job: Option<usize>,
}

impl Pending {
    pub(super) fn new(range: Range<usize>, arena: usize, depth: usize) -> Self {
        Self { range, arena, depth, is_peeled: false, job: None }
    }
}

/// One job's state.
pub(super) struct Builder<'a> {
    pub(super) shared: &'a Shared<'a>,
    pub(super) chooser: Chooser,
    /// A stack of the sets still to be split, the next one on top.
    pub(super) pieces: Vec<Piece>,
    /// The vertices of cut pieces, in the order of the cuts. Those of sets that are built are
    /// truncated from the end.
    pub(super) arena: Vec<Vertex>,
    pub(super) pending: Vec<Pending>,
    /// The length at which the arena is next compacted.
    pub(super) compact_at: usize,
    pub(super) output: Output,
    pub(super) scratch: Scratch,
    pub(super) table: Table,
}

impl<'a> Builder<'a> {
    pub(super) fn new(shared: &'a Shared<'a>, job: Job, memory: &mut Memory) -> Self {
        let Job { pieces, arena, depth } = job;
        let Memory { chooser, pending, output, scratch, table, .. } = take(memory);
        let mut builder = Self {
            shared,
            chooser,
            pending,
            pieces,
            arena,
            compact_at: COMPACT,
            output,
            scratch,
            table,
        };
        builder.output.clear();
        builder.pending.clear();
        let root = Pending::new(0..builder.pieces.len(), builder.arena.len(), depth);
        builder.pending.push(root);
        builder
    }

    /// Gives its lists back, apart from the output.
    pub(super) fn end(self, memory: &mut Memory) -> Output {
        let Self { chooser, pending, pieces, arena, scratch, table, output, .. } = self;
        *memory =
            Memory { chooser, pending, pieces, arena, scratch, table, output: Output::default() };
        output
    }
}

/// The lists of a job, kept to be used again.
#[derive(Default)]
pub(in crate::build) struct Memory {
    chooser: Chooser,
    pending: Vec<Pending>,
    pub(in crate::build) pieces: Vec<Piece>,
    pub(in crate::build) arena: Vec<Vertex>,
    scratch: Scratch,
    table: Table,
    pub(in crate::build) output: Output,
}

/// Buffers that are reused for every set.
#[derive(Default)]
pub(super) struct Scratch {
    pub(super) own: Vec<Piece>,
    pub(super) front: Vec<Piece>,
    pub(super) spanning: Vec<Piece>,
    pub(super) sides: Vec<Side>,
    pub(super) splitter: Splitter,
}
