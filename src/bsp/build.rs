//! Building a tree: a stack of sets of pieces, each split by a plane until one piece is left.

mod arena;
mod divide;
mod emit;

use std::sync::atomic::{AtomicUsize, Ordering};

use super::assemble::{Output, assemble};
use super::choose::{Choice, Chooser};
use super::jobs::{self, Job};
use super::live::Live;
use super::node::MOST_FRAGMENTS;
use super::progress::Watch;
use super::{BspTree, BuildOptions};
use crate::Error;
use crate::geom::{Faces, Kernel, PlaneId, Polygon, Preparation, Side};

/// Sets on both sides of a plane with at least this many pieces are built as jobs of their own.
/// Smaller: more copies; larger: threads wait for each other at the end.
const JOB: usize = 1024;

/// The least vertices at which an arena is compacted. Smaller: copies; larger: memory.
const COMPACT: usize = 1 << 13;

/// Builds a tree of polygons.
pub(super) fn tree<K: Kernel, P: Polygon>(
    kernel: K,
    options: &BuildOptions,
    polygons: impl IntoIterator<Item = P>,
    watch: &Watch<'_>,
) -> Result<BspTree<K>, Error> {
    let (faces, preparation) =
        Faces::prepare(polygons, options.tolerance, options.max_fragments, &mut |polygons| {
            watch.expect(polygons)
        })?;
    watch.expect(faces.len())?;
    tree_of(kernel, options, faces, preparation, watch)
}

/// Builds a tree of faces.
pub(super) fn tree_of<K: Kernel>(
    kernel: K,
    options: &BuildOptions,
    faces: Faces,
    preparation: Preparation,
    watch: &Watch<'_>,
) -> Result<BspTree<K>, Error> {
    let live: Vec<Live> = (0..faces.len() as u32).map(|face| Live::whole(&faces, face)).collect();
    let fragments = AtomicUsize::new(live.len());
    let shared = Shared { kernel, faces: &faces, options, watch, fragments };
    shared.count(0)?;
    let outputs = jobs::run(&shared, Job { pieces: live, arena: Vec::new(), depth: 0 })?;
    let parts = assemble(outputs);
    watch.end()?;
    Ok(BspTree::new(kernel, faces, preparation, parts))
}

/// What all jobs of a build share.
pub(super) struct Shared<'a, K> {
    kernel: K,
    faces: &'a Faces,
    options: &'a BuildOptions,
    watch: &'a Watch<'a>,
    /// How many pieces there are by now, over all jobs.
    fragments: AtomicUsize,
}

impl<K> Shared<'_, K> {
    /// Counts new pieces against the budget.
    fn count(&self, new: usize) -> Result<(), Error> {
        let limit = self.options.max_fragments.min(MOST_FRAGMENTS);
        let total = self.fragments.fetch_add(new, Ordering::Relaxed) + new;
        if total > limit { Err(Error::fragments(limit)) } else { Ok(()) }
    }
}

/// A set of pieces that is still to be split: a range of the stack of pieces.
struct Pending {
    start: usize,
    end: usize,
    /// How much of the arena it needs.
    arena: usize,
    depth: usize,
    /// Where it goes instead of being built here.
    job: Option<usize>,
}

/// One job's state.
struct Builder<'a, K: Kernel> {
    shared: &'a Shared<'a, K>,
    chooser: Chooser<'a, K>,
    /// A stack: the sets still to be split, the next one on top.
    pieces: Vec<Live>,
    /// The vertices of cut pieces, in the order of the cuts: what belongs to sets already built
    /// is dropped from its end.
    arena: Vec<K::Vertex>,
    pending: Vec<Pending>,
    /// The length from which the arena is cleared of what cut pieces left behind.
    compact_at: usize,
    output: Output<K::Stored>,
    scratch: Scratch<K::Vertex>,
}

/// Lists kept to be used again.
struct Scratch<V> {
    own: Vec<Live>,
    front: Vec<Live>,
    spanning: Vec<Live>,
    sides: Vec<Side>,
    outline: Vec<V>,
    front_part: Vec<V>,
    back_part: Vec<V>,
}

/// Builds the tree of a job's pieces. Sets that are worth it go to `hand_over`, which gives back
/// a number for them.
pub(super) fn build<'a, K: Kernel>(
    shared: &'a Shared<'a, K>,
    job: Job<K::Vertex>,
    mut hand_over: impl FnMut(Job<K::Vertex>) -> usize,
) -> Result<Output<K::Stored>, Error> {
    let chooser = Chooser::new(shared.kernel, shared.faces, shared.options.heuristic, shared.watch);
    let end = job.pieces.len();
    let first = Pending { start: 0, end, arena: job.arena.len(), depth: job.depth, job: None };
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

/// Whether a set needs no plane to be put in order.
fn is_leaf(pieces: &[Live]) -> bool {
    pieces.len() <= 1
}

impl<K: Kernel> Builder<'_, K> {
    /// Emits a node for a set and puts off its two sides.
    fn step(
        &mut self,
        pending: &Pending,
        hand_over: &mut impl FnMut(Job<K::Vertex>) -> usize,
    ) -> Result<(), Error> {
        let depth = pending.depth + 1;
        if depth > self.shared.options.max_depth {
            return Err(Error::depth(self.shared.options.max_depth));
        }
        let start = pending.start;
        let set = &self.pieces[start..];
        let plane = if is_leaf(set) {
            // Only the root can be a leaf here: others went out with their parents.
            let Some(first) = set.first() else { return Ok(()) };
            let plane = PlaneId::face(first.face);
            self.partition(start, plane)?;
            plane
        } else {
            let count = set.len();
            let plane = match self.chooser.choose(set, &self.arena, pending.depth) {
                Choice::Split(plane) => plane,
                Choice::TakeApart => return self.emit_list(start, pending.depth),
            };
            self.classify(start, plane)?;
            if self.makes_progress(count) {
                self.divide(start, plane)?;
                plane
            } else {
                // Counted by rounded distances, a free plane can promise what exact ones deny.
                let plane = PlaneId::face(self.pieces[start].face);
                self.partition(start, plane)?;
                plane
            }
        };
        self.emit(plane, start, depth, hand_over);
        Ok(())
    }
}
