//! Builds a subtree: a stack of sets of pieces, each split by a plane until one piece is left.

mod arena;
mod divide;
mod emit;

use super::assemble::Output;
use super::budget::Budget;
use super::choose::{Choice, Chooser, Normals, Set, Tuning};
use super::live::Live;
use super::options::BuildOptions;
use super::progress::Watch;
use crate::Error;
use crate::exact::{Faces, Kernel, PlaneId, Side};

/// Where both sides of a plane have at least this many pieces, one side becomes a job of its own.
/// Smaller: more copying; larger: threads wait for each other at the end.
const JOB: usize = 1024;

/// The smallest arena, in vertices, that is compacted. Smaller: time to copy; larger: memory.
const COMPACT: usize = 1 << 13;

/// A set of pieces with their vertices, to be built into a subtree.
pub(super) struct Job<V> {
    pub(super) pieces: Vec<Live>,
    pub(super) arena: Vec<V>,
    /// How many nodes lie above it.
    pub(super) depth: usize,
}

/// What all jobs of a build share.
pub(super) struct Shared<'a, K> {
    kernel: K,
    faces: &'a Faces,
    normals: Normals,
    options: &'a BuildOptions,
    tuning: &'a Tuning,
    watch: &'a Watch<'a>,
    budget: Budget,
}

impl<'a, K> Shared<'a, K> {
    /// An error if there are more faces than the budget allows fragments.
    pub(super) fn new(
        kernel: K,
        faces: &'a Faces,
        options: &'a BuildOptions,
        tuning: &'a Tuning,
        watch: &'a Watch<'a>,
    ) -> Result<Self, Error> {
        let normals = Normals::new(faces);
        let budget = Budget::new(options, faces.len())?;
        Ok(Self { kernel, faces, normals, options, tuning, watch, budget })
    }
}

/// A set of pieces that is still to be split: a range of the stack of pieces.
struct Pending {
    start: usize,
    end: usize,
    /// The length of the arena that it needs.
    arena: usize,
    depth: usize,
    /// Whether peeling has just been tried on this set. Then a small set is split by a plane first.
    is_peeled: bool,
    /// The job that builds it, if that is not this one.
    job: Option<usize>,
}

/// One job's state.
struct Builder<'a, K: Kernel> {
    shared: &'a Shared<'a, K>,
    chooser: Chooser<'a>,
    /// A stack of the sets still to be split, the next one on top.
    pieces: Vec<Live>,
    /// The vertices of cut pieces, in the order of the cuts. Those of sets that are built are
    /// truncated from the end.
    arena: Vec<K::Vertex>,
    pending: Vec<Pending>,
    /// The length at which the arena is next compacted.
    compact_at: usize,
    output: Output<K::Stored>,
    scratch: Scratch<K::Vertex>,
}

/// Buffers that are reused for every set.
struct Scratch<V> {
    own: Vec<Live>,
    front: Vec<Live>,
    spanning: Vec<Live>,
    sides: Vec<Side>,
    outline: Vec<V>,
    front_part: Vec<V>,
    back_part: Vec<V>,
}

/// Builds the subtree of a job. Large sets are passed to `hand_over`, which returns the number of the
/// job that will build them.
pub(super) fn build<'a, K: Kernel>(
    shared: &'a Shared<'a, K>,
    job: Job<K::Vertex>,
    mut hand_over: impl FnMut(Job<K::Vertex>) -> usize,
) -> Result<Output<K::Stored>, Error> {
    let chooser = Chooser::new(shared.options.heuristic, shared.tuning, shared.watch);
    let end = job.pieces.len();
    let first = Pending {
        start: 0,
        end,
        arena: job.arena.len(),
        depth: job.depth,
        is_peeled: false,
        job: None,
    };
    let scratch = Scratch {
        own: vec![],
        front: vec![],
        spanning: vec![],
        sides: vec![],
        outline: vec![],
        front_part: vec![],
        back_part: vec![],
    };
    let (pieces, arena, output) = (job.pieces, job.arena, Output::default());
    let (pending, compact_at) = (vec![first], COMPACT);
    let mut builder =
        Builder { shared, chooser, pieces, arena, pending, compact_at, output, scratch };
    while let Some(pending) = builder.pending.pop() {
        if let Some(job) = pending.job {
            builder.output.continue_in(job);
            continue;
        }
        builder.pieces.truncate(pending.end);
        builder.arena.truncate(pending.arena);
        builder.step(&pending, &mut hand_over)?;
        if builder.arena.len() > builder.compact_at {
            builder.compact()?;
        }
    }
    Ok(builder.output)
}

/// Whether a set is small enough to need no plane.
fn is_leaf(pieces: &[Live]) -> bool {
    pieces.len() <= 1
}

impl<K: Kernel> Builder<'_, K> {
    /// Writes the node of the set on top of the stack, and puts its two sides on the stack.
    fn step(
        &mut self,
        pending: &Pending,
        hand_over: &mut impl FnMut(Job<K::Vertex>) -> usize,
    ) -> Result<(), Error> {
        let start = pending.start;
        let set = &self.pieces[start..];
        let depth = pending.depth + 1;
        if !set.is_empty() {
            self.shared.budget.check_depth(depth)?;
        }
        let plane = if is_leaf(set) {
            // Only the root can be a leaf here: other leaves were stored with their parents.
            let Some(first) = set.first() else { return Ok(()) };
            let plane = PlaneId::face(first.face);
            self.partition(start, plane)?;
            plane
        } else {
            let count = set.len();
            let Shared { kernel, faces, normals, .. } = self.shared;
            let set = Set::new(kernel, faces, normals, (set, &self.arena));
            let plane = match self.chooser.choose(&set, pending.is_peeled) {
                Choice::Split(plane) => plane,
                Choice::Peel(peeled) => return self.emit_peeled(start, pending.depth, &peeled),
            };
            self.classify(start, plane)?;
            if self.makes_progress(count) {
                self.divide(start, plane)?;
                plane
            } else {
                // Free planes are counted by rounded distances, so exact decisions can show that one
                // separates nothing. A piece's own plane always does.
                let plane = PlaneId::face(self.pieces[start].face);
                self.partition(start, plane)?;
                plane
            }
        };
        self.emit(plane, start, depth, hand_over)
    }
}
