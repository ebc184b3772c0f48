//! Builds a subtree: a stack of sets of pieces, each divided by a plane until one piece is left.

use std::mem::take;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::choose::{Choice, ChooseContext, Chooser, Peeled, Set, Tuning, settle};
use super::jobs::{Job, Output, is_worth_a_job};
use super::options::BuildOptions;
use super::piece::{Division, Piece, Splitter, compact};
use super::small::SmallSet;
use crate::error::{Error, Kind};
use crate::exact::{Faces, PlaneId, PreparedPlane, Side, Vertex};
use crate::memory::{collect, reserve};
use crate::progress::Watch;
use crate::tree::node::MOST_FRAGMENTS;
use crate::tree::parts::{RawChild, RawNode};

/// Passes a set to another job, and returns the number of that job.
pub(super) type HandOver<'h> = &'h mut dyn FnMut(Job) -> Result<usize, Error>;

/// The smallest arena, in vertices, that is compacted. Too small: time to copy. Too large: memory.
const COMPACT: usize = 1 << 13;

/// The data that all jobs of a build share.
pub(in crate::build) struct Shared<'a> {
    pub(super) faces: &'a Faces,
    options: &'a BuildOptions,
    pub(super) rules: ChooseContext<'a>,
    pub(super) budget: Budget,
    /// The planes of all faces, if the planes were prepared in advance.
    pub(super) planes: &'a [PreparedPlane],
    /// Whether the rounded positions of vertices go into the output.
    keeps_positions: bool,
}

impl<'a> Shared<'a> {
    /// Fails if there are more faces than the largest allowed number of fragments.
    pub(in crate::build) fn new(
        faces: &'a Faces,
        options: &'a BuildOptions,
        tuning: &'a Tuning,
        watch: &'a Watch<'a>,
    ) -> Result<Self, Error> {
        let budget = Budget::new(options, faces.len())?;
        let rules = ChooseContext::new(options, tuning, watch);
        Ok(Self { faces, options, rules, budget, planes: &[], keeps_positions: false })
    }

    /// A set without pieces, for questions about planes and pieces of a table.
    pub(super) fn bare_set<'s>(&self, arena: &'s [Vertex]) -> Set<'s>
    where
        'a: 's,
    {
        Set::new(self.faces, &[], arena).with(self.planes)
    }

    /// Stops all jobs of the build.
    #[cfg(feature = "parallel")]
    pub(in crate::build) fn stop(&self) {
        self.rules.watch.stop();
    }

    /// The same data, with positions in the output.
    pub(in crate::build) fn with_positions(self) -> Self {
        Self { keeps_positions: true, ..self }
    }

    /// The same data, with the planes of all faces.
    pub(in crate::build) fn with_planes(self, planes: &'a [PreparedPlane]) -> Self {
        Self { planes, ..self }
    }
}

/// A set of pieces still to be divided: a range of the stack of pieces.
struct Pending {
    range: Range<usize>,
    /// The length of the arena that the set needs.
    arena: usize,
    /// The number of nodes above the set.
    depth: usize,
    /// The other job that builds the set's subtree, if any.
    job: Option<usize>,
}

/// Builds the subtrees of jobs, one after the other, in reused lists.
#[derive(Default)]
pub(in crate::build) struct Builder {
    chooser: Chooser,
    /// A stack of the sets still to be divided, the next set on top.
    pub(in crate::build) pieces: Vec<Piece>,
    /// The vertices of cut pieces, in the order of the cuts. Vertices of finished sets are truncated from
    /// the end.
    pub(in crate::build) arena: Vec<Vertex>,
    pending: Vec<Pending>,
    /// The length at which the arena is next compacted.
    pub(super) compact_at: usize,
    pub(in crate::build) output: Output,
    /// The plane that divides the current set, and the sides of the set's pieces.
    division: Division,
    /// The pieces of the current set that lie on the dividing plane, in front of this plane, and across this
    /// plane.
    pub(super) own: Vec<Piece>,
    front: Vec<Piece>,
    spanning: Vec<Piece>,
    pub(super) splitter: Splitter,
    pub(super) small: SmallSet,
}

impl Builder {
    /// Builds the subtree of a job. Hands large sets over to other jobs, if `hand_over` is given.
    pub(super) fn build(
        &mut self,
        shared: &Shared<'_>,
        job: Job,
        mut hand_over: Option<HandOver<'_>>,
    ) -> Result<Output, Error> {
        let Job { pieces, arena, depth } = job;
        (self.pieces, self.arena, self.compact_at) = (pieces, arena, COMPACT);
        self.output.clear();
        self.pending.clear();
        self.push_pending(0, depth, None);
        while let Some(pending) = self.pending.pop() {
            shared.rules.watch.work(0)?;
            if let Some(job) = pending.job {
                self.output.continue_in(job);
                continue;
            }
            self.pieces.truncate(pending.range.end);
            self.arena.truncate(pending.arena);
            self.step(shared, &pending, &mut hand_over)?;
            if self.arena.len() > self.compact_at {
                self.compact(shared)?;
            }
        }
        Ok(take(&mut self.output))
    }

    /// Records that the pieces on top of the stack are still to be divided, here or by another job.
    fn push_pending(&mut self, start: usize, depth: usize, job: Option<usize>) {
        let (range, arena) = (start..self.pieces.len(), self.arena.len());
        self.pending.push(Pending { range, arena, depth, job });
    }

    /// Writes the node of the set on top of the stack, and puts the set's two sides on the stack.
    fn step(
        &mut self,
        shared: &Shared<'_>,
        pending: &Pending,
        hand_over: &mut Option<HandOver<'_>>,
    ) -> Result<(), Error> {
        let start = pending.range.start;
        let Self { chooser, division, pieces, arena, small, .. } = self;
        let Some(first) = pieces.get(start) else { return Ok(()) };
        shared.budget.check_depth(pending.depth + 1)?;
        let mut set = Set::new(shared.faces, &pieces[start..], arena);
        set.planes = shared.planes;
        set.depth = pending.depth;
        let own = PlaneId::face(first.face);
        let choice = if is_leaf(set.pieces) {
            // Only the root can be a leaf here: other leaves were stored with their parents.
            division.plane = None;
            Choice::Split(own)
        } else {
            chooser.choose(&shared.rules, &set, division)?
        };
        let plane = match choice {
            Choice::Split(plane) => plane,
            Choice::Table if shared.rules.given.is_none() => {
                return self.build_small(shared, start, pending.depth);
            }
            // The caller's function is asked again at each set.
            Choice::Table => small.plane(&shared.rules, &set)?,
            Choice::Peel(peeled) => return self.emit_peeled(shared, start, pending.depth, &peeled),
        };
        settle(&shared.rules, &set, division, plane)?;
        if !is_leaf(set.pieces) && !division.makes_progress() {
            // Free planes are scored by rounded distances, so the exact decisions may show that a free plane
            // separates nothing. A piece's own plane always separates that piece.
            division.plane = None;
            settle(&shared.rules, &set, division, own)?;
        }
        self.divide(shared, start)?;
        self.emit(shared, start, pending.depth + 1, hand_over)
    }

    /// [Compacts](compact) the arena. So it is at most twice as large as the remaining sets need, however often one
    /// piece is cut.
    fn compact(&mut self, shared: &Shared<'_>) -> Result<(), Error> {
        // The pieces of sets that other jobs build have been removed.
        let pieces = self.pieces.iter_mut();
        let lens = self.pending.iter_mut().map(|pending| &mut pending.arena);
        compact(&mut self.arena, 0, pieces, lens)?;
        self.compacted(shared)
    }

    /// Sets the length at which the arena is compacted next.
    pub(super) fn compacted(&mut self, shared: &Shared<'_>) -> Result<(), Error> {
        self.compact_at = COMPACT.max(2 * self.arena.len());
        // Pieces index their vertices with 32 bits.
        let limit = shared.options.max_fragments;
        if self.arena.len() > 1 << 31 { Err(Kind::Fragments(limit).error()) } else { Ok(()) }
    }

    /// Moves the set on top of the stack into a job with a separate arena.
    fn take(&mut self, start: usize, depth: usize) -> Result<Job, Error> {
        let mut arena = Vec::new();
        let mut pieces =
            if start == 0 { take(&mut self.pieces) } else { collect(self.pieces.drain(start..))? };
        reserve(&mut arena, pieces.iter().map(Piece::cut_len).sum())?;
        for piece in &mut pieces {
            *piece = piece.copied(&self.arena, &mut arena);
        }
        pieces.shrink_to_fit();
        Ok(Job { pieces, arena, depth })
    }

    /// Appends a piece to the output as a fragment.
    pub(super) fn store(&mut self, shared: &Shared<'_>, piece: &Piece) -> Result<(), Error> {
        let vertices = piece.cut_vertices(&self.arena).unwrap_or_default();
        shared.rules.watch.finish(piece.cuts);
        self.output.push(piece.face, vertices, shared.keeps_positions)
    }

    /// Appends the pieces on the plane of a node. Coplanar polygons are painted in input order.
    pub(super) fn store_own(&mut self, shared: &Shared<'_>) -> Result<u32, Error> {
        let mut own = take(&mut self.own);
        own.sort_unstable_by_key(Piece::rank);
        own.iter().try_for_each(|piece| self.store(shared, piece))?;
        self.own = own;
        Ok(self.own.len() as u32)
    }

    /// Appends the piece of a leaf, which is on top of the stack, unless the leaf is empty.
    fn store_leaf(&mut self, shared: &Shared<'_>, start: usize) -> Result<(), Error> {
        let piece = if self.pieces.len() > start { self.pieces.pop() } else { None };
        piece.map_or(Ok(()), |piece| self.store(shared, &piece))
    }

    /// Divides the set on top of the stack: pieces behind the plane stay on the stack, pieces in front go to
    /// `front`, and pieces on the plane to `own`. Pieces that span the plane are cut.
    fn divide(&mut self, shared: &Shared<'_>, start: usize) -> Result<(), Error> {
        let Self { division, own, front, spanning, pieces, arena, splitter, .. } = self;
        let Some(plane) = &division.plane else { return Ok(()) };
        let cuts = division.count(Side::Spanning);
        // The budget is checked before the cuts, so that a set with too many pieces is stopped in time.
        shared.budget.count(cuts)?;
        shared.rules.watch.work(cuts * CUT)?;
        own.clear();
        front.clear();
        spanning.clear();
        reserve(front, division.count(Side::Front) + cuts)?;
        reserve(own, division.count(Side::Coplanar))?;
        reserve(spanning, cuts)?;
        let mut back = start;
        for (i, &side) in (start..).zip(&division.sides) {
            match side {
                // Moved down in place: `back` never overtakes `i`, so nothing unread is lost.
                Side::Back => {
                    if back < i {
                        pieces[back] = pieces[i];
                    }
                    back += 1;
                }
                Side::Front => front.push(pieces[i]),
                Side::Coplanar => own.push(pieces[i]),
                Side::Spanning => spanning.push(pieces[i]),
            }
        }
        pieces.truncate(back);
        reserve(pieces, cuts)?;
        for whole in &*spanning {
            let parts = splitter.cut(shared.faces, plane, whole, arena)?;
            front.push(parts[0]);
            pieces.push(parts[1]);
        }
        self.output.parts.cuts += cuts;
        Ok(())
    }

    /// Writes the node of a set that has been divided, and puts the set's two sides on the stack.
    fn emit(
        &mut self,
        shared: &Shared<'_>,
        start: usize,
        depth: usize,
        hand_over: &mut Option<HandOver<'_>>,
    ) -> Result<(), Error> {
        let Some(plane) = self.division.plane.map(|plane| plane.id()) else { return Ok(()) };
        let own = self.store_own(shared)?;
        let (back, front) = (self.pieces.len() - start, self.front.len());
        let back_is_leaf = is_leaf(&self.pieces[start..]);
        let front_is_leaf = is_leaf(&self.front);
        // Leaves are stored here, directly after the node's own fragments and front before back: orders
        // rely on these numbers.
        if front_is_leaf && let Some(piece) = self.front.pop() {
            self.store(shared, &piece)?;
        }
        if back_is_leaf {
            self.store_leaf(shared, start)?;
        }
        let child =
            |is_leaf, len: usize| if is_leaf { RawChild::Leaf(len as u32) } else { RawChild::Node };
        let (back_child, front_child) = (child(back_is_leaf, back), child(front_is_leaf, front));
        self.output.push_node(RawNode { plane, own, front: front_child, back: back_child })?;
        // The back is below the front on the stack, so that the front is built first, because nodes are
        // stored depth first.
        if !back_is_leaf {
            // The back is handed over because it is on top of the stack now; this thread continues with the
            // front.
            let job = match hand_over {
                Some(hand_over) if is_worth_a_job(back, front) => {
                    Some(hand_over(self.take(start, depth)?)?)
                }
                _ => None,
            };
            self.push_pending(start, depth, job);
        }
        if !front_is_leaf {
            let start = self.pieces.len();
            // An empty stack takes over the whole list, so that a large set is not in memory twice.
            if start == 0 {
                std::mem::swap(&mut self.pieces, &mut self.front);
            } else {
                reserve(&mut self.pieces, front)?;
                self.pieces.extend_from_slice(&self.front);
            }
            self.push_pending(start, depth, None);
        }
        Ok(())
    }

    /// Writes one node for each layer of pieces that is peeled off a set, and pushes the remaining pieces
    /// onto the stack. Each layer's node is the only child of the previous node.
    fn emit_peeled(
        &mut self,
        shared: &Shared<'_>,
        start: usize,
        depth: usize,
        peeled: &Peeled,
    ) -> Result<(), Error> {
        let depth = depth + peeled.layers().len();
        shared.budget.check_depth(depth)?;
        let mut left = collect((start..self.pieces.len()).map(|_| true))?;
        for layer in peeled.layers() {
            self.own.clear();
            reserve(&mut self.own, peeled.pieces(layer).len())?;
            // Pieces are marked and not removed yet: all layers refer to them by their places in the set.
            for &piece in peeled.pieces(layer) {
                left[piece as usize] = false;
                self.own.push(self.pieces[start + piece as usize]);
            }
            let own = self.store_own(shared)?;
            let child = |side| if layer.rest == side { RawChild::Node } else { RawChild::Leaf(0) };
            let (front, back) = (child(Side::Front), child(Side::Back));
            self.output.push_node(RawNode { plane: layer.plane, own, front, back })?;
        }
        let mut next = start;
        for (i, &is_left) in (start..).zip(&left) {
            if is_left {
                self.pieces[next] = self.pieces[i];
                next += 1;
            }
        }
        self.pieces.truncate(next);
        if !is_leaf(&self.pieces[start..]) {
            self.push_pending(start, depth, None);
            return Ok(());
        }
        // The last layer's node was written with a child node that now turns out to be a leaf.
        if let Some(node) = self.output.parts.nodes.last_mut() {
            let side = if node.front == RawChild::Node { &mut node.front } else { &mut node.back };
            *side = RawChild::Leaf((next - start) as u32);
        }
        self.store_leaf(shared, start)
    }
}

/// Whether a set is small enough to need no plane.
fn is_leaf(pieces: &[Piece]) -> bool {
    pieces.len() <= 1
}

/// Cutting a piece counts as the work of classifying this many pieces.
pub(super) const CUT: usize = 64;

/// The budget shared by all jobs of a build.
pub(super) struct Budget {
    /// The number of pieces so far, over all jobs.
    fragments: AtomicUsize,
    max_fragments: usize,
    max_depth: usize,
}

impl Budget {
    /// The budget of a build that begins with `faces` faces.
    fn new(options: &BuildOptions, faces: usize) -> Result<Self, Error> {
        let budget = Self {
            fragments: AtomicUsize::new(faces),
            max_fragments: options.max_fragments.min(MOST_FRAGMENTS),
            max_depth: options.max_depth,
        };
        budget.count(0)?;
        Ok(budget)
    }

    /// Counts new pieces. Returns an error if there are too many.
    pub(super) fn count(&self, new: usize) -> Result<(), Error> {
        let total = self.fragments.fetch_add(new, Ordering::Relaxed) + new;
        if total > self.max_fragments { Err(self.exceeded()) } else { Ok(()) }
    }

    /// Returns an error if a node at this depth is too deep.
    pub(super) fn check_depth(&self, depth: usize) -> Result<(), Error> {
        if depth > self.max_depth { Err(self.exceeded()) } else { Ok(()) }
    }

    /// The error of both budgets. Which of the two a build exceeds first depends on the timing of threads.
    fn exceeded(&self) -> Error {
        let &Self { max_fragments, max_depth, .. } = self;
        match max_depth {
            usize::MAX => Kind::Fragments(max_fragments).error(),
            _ => Kind::Budgets { max_fragments, max_depth }.error(),
        }
    }
}
