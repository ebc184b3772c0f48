//! Building a tree: a stack of sets of pieces, each split by a plane until one piece is left.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::assemble::{Child, Output, RawNode, assemble};
use super::choose::{Choice, Chooser};
use super::convex::Taken;
use super::jobs::{self, Job};
use super::live::Live;
use super::node::MOST_FRAGMENTS;
use super::progress::Watch;
use super::{BspTree, BuildOptions};
use crate::Error;
use crate::geom::{Faces, Kernel, PlaneId, Polygon, Preparation, Side, split};

/// Sets on both sides of a plane with at least this many pieces are built as jobs of their own.
/// Smaller: more copies; larger: threads wait for each other at the end.
const JOB: usize = 1024;

/// The least vertices at which an arena is compacted. Smaller: copies; larger: memory.
const COMPACT: usize = 1 << 16;

/// So many pieces are put on sides of a plane before it is asked whether to go on. Smaller: time
/// for asking; larger: it takes longer to stop.
const AT_ONCE: usize = 4096;
/// To cut a piece is as much work as to look at so many.
const CUT: usize = 64;

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

/// Whether pieces need no plane to be put in order: pieces of one face never hide each other.
fn is_leaf(pieces: &[Live]) -> bool {
    pieces.iter().all(|piece| piece.face == pieces[0].face)
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
        let (plane, middle) = if is_leaf(set) {
            // Only the root can be a leaf here: others went out with their parents.
            let Some(first) = set.first() else { return Ok(()) };
            let plane = PlaneId::face(first.face);
            (plane, self.partition(start, plane)?)
        } else {
            let count = set.len();
            let plane = match self.chooser.choose(set, &self.arena, pending.depth) {
                Choice::Split(plane) => plane,
                Choice::TakeApart(list) => return self.emit_list(start, pending.depth, &list),
            };
            self.classify(start, plane)?;
            if self.makes_progress(count) {
                (plane, self.divide(start, plane)?)
            } else {
                // Counted by rounded distances, a free plane can promise what exact ones deny.
                let plane = PlaneId::face(self.pieces[start].face);
                (plane, self.partition(start, plane)?)
            }
        };
        self.emit(plane, start, middle, depth, hand_over);
        Ok(())
    }

    fn classify(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        let (kernel, faces) = (self.shared.kernel, self.shared.faces);
        let splitter = kernel.splitter(faces, plane);
        let arena = &self.arena;
        let side = |live: &Live| kernel.classify(faces, &splitter, live.piece(arena));
        self.scratch.sides.clear();
        for pieces in self.pieces[start..].chunks(AT_ONCE) {
            self.shared.watch.work(pieces.len())?;
            self.scratch.sides.extend(pieces.iter().map(side));
        }
        Ok(())
    }

    fn makes_progress(&self, count: usize) -> bool {
        let sides = &self.scratch.sides;
        let reach = |other: Side| {
            sides.iter().filter(|&&side| side == other || side == Side::Spanning).count()
        };
        reach(Side::Front) < count && reach(Side::Back) < count
    }

    fn partition(&mut self, start: usize, plane: PlaneId) -> Result<usize, Error> {
        self.classify(start, plane)?;
        self.divide(start, plane)
    }

    /// Divides the set on top of the stack by the sides just found: behind first, then in front;
    /// gives where the front begins. What is on the plane is left in `scratch.own`.
    fn divide(&mut self, start: usize, plane: PlaneId) -> Result<usize, Error> {
        let scratch = &mut self.scratch;
        scratch.own.clear();
        scratch.front.clear();
        scratch.spanning.clear();
        let mut back = start;
        for (i, &side) in scratch.sides.iter().enumerate() {
            let piece = self.pieces[start + i];
            match side {
                Side::Back => {
                    self.pieces[back] = piece;
                    back += 1;
                }
                Side::Front => scratch.front.push(piece),
                Side::Coplanar => scratch.own.push(piece),
                Side::Spanning => scratch.spanning.push(piece),
            }
        }
        self.pieces.truncate(back);
        self.shared.count(self.scratch.spanning.len())?;
        self.cut_spanning(plane)?;
        let middle = self.pieces.len();
        self.pieces.extend_from_slice(&self.scratch.front);
        Ok(middle)
    }

    fn cut_spanning(&mut self, plane: PlaneId) -> Result<(), Error> {
        let (kernel, faces) = (self.shared.kernel, self.shared.faces);
        let splitter = kernel.splitter(faces, plane);
        let scratch = &mut self.scratch;
        for live in &scratch.spanning {
            self.shared.watch.work(CUT)?;
            scratch.outline.clear();
            match live.piece(&self.arena).cut {
                Some(vertices) => scratch.outline.extend_from_slice(vertices),
                None => {
                    let corners = 0..faces.corners(live.face).len() as u32;
                    scratch.outline.extend(corners.map(|k| kernel.corner(faces, live.face, k)));
                }
            }
            scratch.front_part.clear();
            scratch.back_part.clear();
            split(
                &kernel,
                faces,
                (plane, &splitter),
                live.face,
                &scratch.outline,
                &mut scratch.front_part,
                &mut scratch.back_part,
            );
            for (part, list) in
                [(&scratch.back_part, &mut self.pieces), (&scratch.front_part, &mut scratch.front)]
            {
                let start = self.arena.len();
                self.arena.extend_from_slice(part);
                list.push(Live::cut::<K>(live, &self.arena, start));
            }
        }
        Ok(())
    }

    fn emit(
        &mut self,
        plane: PlaneId,
        start: usize,
        middle: usize,
        depth: usize,
        hand_over: &mut impl FnMut(Job<K::Vertex>) -> usize,
    ) {
        let end = self.pieces.len();
        // Coplanar polygons are painted in input order.
        self.scratch.own.sort_by_key(|piece| piece.face);
        let own = self.scratch.own.len();
        for i in 0..own {
            self.store(self.scratch.own[i]);
        }
        let [back, front] = [start..middle, middle..end].map(|range| {
            let is_leaf = is_leaf(&self.pieces[range.clone()]);
            (range, is_leaf)
        });
        let mut child = |(range, is_leaf): &(std::ops::Range<usize>, bool)| {
            if !is_leaf {
                return Child::Node;
            }
            for i in range.clone() {
                self.store(self.pieces[i]);
            }
            Child::Leaf(range.len() as u32)
        };
        let node = RawNode { plane, own: own as u32, front: child(&front), back: child(&back) };
        self.output.nodes.push(node);
        let arena = self.arena.len();
        if !back.1 {
            let range = back.0;
            let both_large = range.len() >= JOB && front.0.len() >= JOB && !front.1;
            let job = both_large.then(|| hand_over(self.copy(range.clone(), depth)));
            self.pending.push(Pending { start: range.start, end: range.end, arena, depth, job });
        }
        if !front.1 {
            let (start, end) = (front.0.start, front.0.end);
            self.pending.push(Pending { start, end, arena, depth, job: None });
        }
    }

    /// Emits the nodes of pieces that are taken off a set, each behind or in front of the one
    /// before, and puts off what is left.
    fn emit_list(&mut self, start: usize, depth: usize, list: &[Taken]) -> Result<(), Error> {
        let depth = depth + list.len();
        if depth > self.shared.options.max_depth {
            return Err(Error::depth(self.shared.options.max_depth));
        }
        let mut left = vec![true; self.pieces.len() - start];
        for taken in list {
            let own = &mut self.scratch.own;
            own.clear();
            for &piece in &taken.pieces {
                left[piece as usize] = false;
                own.push(self.pieces[start + piece as usize]);
            }
            own.sort_by_key(|piece| piece.face);
            let own = own.len();
            (0..own).for_each(|i| self.store(self.scratch.own[i]));
            let child = |side| if taken.rest == side { Child::Node } else { Child::Leaf(0) };
            let (front, back) = (child(Side::Front), child(Side::Back));
            self.output.nodes.push(RawNode { plane: taken.plane, own: own as u32, front, back });
        }
        let mut left = left.iter();
        let mut next = start;
        for i in start..self.pieces.len() {
            if left.next() == Some(&true) {
                self.pieces[next] = self.pieces[i];
                next += 1;
            }
        }
        self.pieces.truncate(next);
        if is_leaf(&self.pieces[start..]) {
            (start..next).for_each(|i| self.store(self.pieces[i]));
            if let Some(node) = self.output.nodes.last_mut() {
                let child = Child::Leaf((next - start) as u32);
                let side = if node.front == Child::Node { &mut node.front } else { &mut node.back };
                *side = child;
            }
        } else {
            let arena = self.arena.len();
            self.pending.push(Pending { start, end: next, arena, depth, job: None });
        }
        Ok(())
    }

    /// Clears the arena of the vertices of pieces that have since been cut, so that it stays within
    /// twice of what the sets still to be split need, however often one piece is cut.
    fn compact(&mut self) -> Result<(), Error> {
        let mut arena = Vec::new();
        for pending in &mut self.pending {
            if pending.job.is_none() {
                for live in &mut self.pieces[pending.start..pending.end] {
                    let start = arena.len();
                    arena.extend_from_slice(live.piece(&self.arena).cut.unwrap_or_default());
                    *live = live.moved_to(start);
                }
            }
            pending.arena = arena.len();
        }
        self.arena = arena;
        self.compact_at = COMPACT.max(2 * self.arena.len());
        // Pieces name their vertices by 32 bits.
        let limit = self.shared.options.max_fragments;
        if self.arena.len() > 1 << 31 { Err(Error::fragments(limit)) } else { Ok(()) }
    }

    /// A set with an arena of its own.
    fn copy(&self, range: std::ops::Range<usize>, depth: usize) -> Job<K::Vertex> {
        let mut arena = Vec::new();
        let pieces = self.pieces[range].iter().map(|live| {
            let start = arena.len();
            arena.extend_from_slice(live.piece(&self.arena).cut.unwrap_or_default());
            live.moved_to(start)
        });
        Job { pieces: pieces.collect(), arena, depth }
    }

    fn store(&mut self, live: Live) {
        let kernel = self.shared.kernel;
        let vertices = live.piece(&self.arena).cut.unwrap_or_default();
        self.output.push(live.face, vertices.iter().map(|vertex| kernel.store(vertex)));
        self.shared.watch.finish(live.cuts);
    }
}
