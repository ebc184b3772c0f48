//! Builds a subtree: a stack of sets of pieces, each split by a plane until one piece is left.

use std::mem::take;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use smallvec::SmallVec;

use super::choose::{Choice, ChooseContext, Chooser, Peeled, Set, Tuning};
use super::jobs::{Job, Output, is_worth_a_job};
use super::options::BuildOptions;
use super::piece::{Piece, Splitter};
use super::small_sets::{Row, Slot, Table};
use crate::bits::bits;
use crate::error::{Error, Kind};
use crate::exact::{Faces, PlaneId, PlaneKind, PreparedPlane, Side, Vertex};
use crate::memory::{collect, push, reserve};
use crate::progress::{PIECES_AT_ONCE, Watch};
use crate::tree::node::MOST_FRAGMENTS;
use crate::tree::parts::{RawChild, RawNode};

/// Builds the subtree of a job. Large sets are passed to `hand_over`, which returns the number of the
/// job that will build them.
pub(super) fn build<'a>(
    shared: &'a Shared<'a>,
    job: Job,
    memory: &mut Memory,
    mut hand_over: impl FnMut(Job) -> Result<usize, Error>,
) -> Result<Output, Error> {
    let mut builder = Builder::new(shared, job, memory);
    while let Some(pending) = builder.pending.pop() {
        shared.rules.watch.work(0)?;
        if let Some(job) = pending.job {
            builder.output.continue_in(job)?;
            continue;
        }
        builder.pieces.truncate(pending.range.end);
        builder.arena.truncate(pending.arena);
        builder.step(&pending, &mut hand_over)?;
        if builder.arena.len() > builder.compact_at {
            builder.compact()?;
        }
    }
    Ok(builder.end(memory))
}

/// The smallest arena, in vertices, that is compacted. Smaller: time to copy; larger: memory.
const COMPACT: usize = 1 << 13;

/// What all jobs of a build share.
pub(in crate::build) struct Shared<'a> {
    pub(super) faces: &'a Faces,
    pub(super) options: &'a BuildOptions,
    pub(super) rules: ChooseContext<'a>,
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
        let rules = ChooseContext { heuristic: options.heuristic, tuning, watch };
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
    fn new(shared: &'a Shared<'a>, job: Job, memory: &mut Memory) -> Self {
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
    fn end(self, memory: &mut Memory) -> Output {
        let Self { chooser, pending, pieces, arena, scratch, table, output, .. } = self;
        *memory =
            Memory { chooser, pending, pieces, arena, scratch, table, output: Output::default() };
        output
    }
}

impl Builder<'_> {
    /// Writes the node of the set on top of the stack, and puts its two sides on the stack.
    fn step(
        &mut self,
        pending: &Pending,
        hand_over: &mut impl FnMut(Job) -> Result<usize, Error>,
    ) -> Result<(), Error> {
        let start = pending.range.start;
        let set = &self.pieces[start..];
        let depth = pending.depth + 1;
        if !set.is_empty() {
            self.shared.budget.check_depth(depth)?;
        }
        if !is_leaf(set)
            && let Some(frames) = self.shared.rules.tabled(set.len())
        {
            return self.divide_tabled(start, pending.depth, frames);
        }
        let plane = if is_leaf(set) {
            // Only the root can be a leaf here: other leaves were stored with their parents.
            let Some(first) = set.first() else { return Ok(()) };
            let plane = PlaneId::face(first.face);
            self.partition(start, plane)?;
            plane
        } else {
            let count = set.len();
            let Shared { faces, rules, .. } = self.shared;
            let set = Set::new(faces, set, &self.arena);
            let plane = match self.chooser.choose(rules, &set, pending.is_peeled)? {
                Choice::Split(plane) => plane,
                Choice::Peel(peeled) => return self.emit_peeled(start, pending.depth, &peeled),
            };
            let plane = self.settle(start, plane)?;
            if self.makes_progress(count) {
                self.divide(start, plane)?;
                plane
            } else {
                // Free planes are counted by rounded distances, so exact decisions can show that one
                // separates nothing. A piece's own plane always does.
                let plane = self.settle(start, PlaneId::face(self.pieces[start].face))?;
                self.divide(start, plane)?;
                plane
            }
        };
        self.emit(plane, start, depth, hand_over)
    }

    /// Removes the vertices of pieces that have since been cut. The arena so stays within twice the
    /// size that the sets still to be split need, however often one piece is cut.
    fn compact(&mut self) -> Result<(), Error> {
        let mut arena = Vec::new();
        for pending in &mut self.pending {
            // Empty if another job builds the set.
            for piece in &mut self.pieces[pending.range.clone()] {
                *piece = piece.copied(&self.arena, &mut arena)?;
            }
            pending.arena = arena.len();
        }
        self.arena = arena;
        self.compact_at = COMPACT.max(2 * self.arena.len());
        // Pieces index their vertices with 32 bits.
        let limit = self.shared.options.max_fragments;
        if self.arena.len() > 1 << 31 { Err(Kind::Fragments(limit).error()) } else { Ok(()) }
    }

    /// Removes the set on top of the stack and gives it an arena of its own.
    fn take(&mut self, start: usize, depth: usize) -> Result<Job, Error> {
        let mut arena = Vec::new();
        let mut pieces =
            if start == 0 { take(&mut self.pieces) } else { collect(self.pieces.drain(start..))? };
        for piece in &mut pieces {
            *piece = piece.copied(&self.arena, &mut arena)?;
        }
        pieces.shrink_to_fit();
        Ok(Job { pieces, arena, depth })
    }

    /// Appends a piece to the output as a fragment.
    pub(super) fn store(&mut self, piece: Piece) -> Result<(), Error> {
        let vertices = piece.cut_vertices(&self.arena).unwrap_or_default();
        self.output.push(piece.face, vertices.iter().map(Vertex::stored))?;
        if self.shared.keeps_positions {
            self.output.push_positions(vertices.iter().map(Vertex::position))?;
        }
        self.shared.rules.watch.finish(piece.cuts);
        Ok(())
    }

    /// Finds the side of each piece of the set on top of the stack, into `scratch.sides`.
    fn classify(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        let faces = self.shared.faces;
        let prepared = PreparedPlane::new(faces, plane);
        let arena = &self.arena;
        let side = |piece: &Piece| piece.side(faces, &prepared, arena);
        self.scratch.sides.clear();
        reserve(&mut self.scratch.sides, self.pieces.len() - start)?;
        for pieces in self.pieces[start..].chunks(PIECES_AT_ONCE) {
            self.shared.rules.watch.work(pieces.len())?;
            self.scratch.sides.extend(pieces.iter().map(side));
        }
        Ok(())
    }

    /// Whether both sides of the plane have fewer pieces than the set, of `count`.
    fn makes_progress(&self, count: usize) -> bool {
        let sides = &self.scratch.sides;
        let reach = |other: Side| {
            sides.iter().filter(|&&side| side == other || side == Side::Spanning).count()
        };
        reach(Side::Front) < count && reach(Side::Back) < count
    }

    /// Classifies the set on top of the stack, and divides it.
    fn partition(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        self.classify(start, plane)?;
        self.divide(start, plane)
    }

    /// Divides the set on top of the stack by `scratch.sides`: pieces behind stay on the stack, pieces
    /// in front go to `scratch.front`, and pieces on the plane to `scratch.own`.
    fn divide(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        let scratch = &mut self.scratch;
        scratch.own.clear();
        scratch.front.clear();
        scratch.spanning.clear();
        let count = |of: Side| scratch.sides.iter().filter(|&&side| side == of).count();
        let [front, own, spanning] = [Side::Front, Side::Coplanar, Side::Spanning].map(count);
        reserve(&mut scratch.front, front + spanning)?;
        reserve(&mut scratch.own, own)?;
        reserve(&mut scratch.spanning, spanning)?;
        let mut back = start;
        for (i, &side) in scratch.sides.iter().enumerate() {
            let piece = self.pieces[start + i];
            match side {
                // Moved down in place: `back` never overtakes `start + i`, so nothing unread is lost.
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
        // The budget is checked before the cuts, so that a set that explodes is stopped in time.
        self.shared.budget.count(self.scratch.spanning.len())?;
        self.cut_spanning(plane)
    }

    /// Cuts the pieces in `scratch.spanning`, and adds their parts to both sides.
    fn cut_spanning(&mut self, plane: PlaneId) -> Result<(), Error> {
        let prepared = PreparedPlane::new(self.shared.faces, plane);
        for i in 0..self.scratch.spanning.len() {
            let whole = self.scratch.spanning[i];
            let [front, back] = self.cut(&whole, &prepared)?;
            reserve(&mut self.pieces, 1)?;
            self.pieces.push(back);
            reserve(&mut self.scratch.front, 1)?;
            self.scratch.front.push(front);
        }
        Ok(())
    }

    /// Cuts a piece, and gives the parts in front and behind.
    pub(super) fn cut(
        &mut self,
        piece: &Piece,
        prepared: &PreparedPlane,
    ) -> Result<[Piece; 2], Error> {
        self.shared.rules.watch.work(CUT)?;
        let Self { shared, arena, scratch, .. } = self;
        self.output.parts.cuts += 1;
        scratch.splitter.cut(shared.faces, prepared, piece, arena)
    }

    /// Writes the node of a set that has been divided, and puts its two sides on the stack.
    fn emit(
        &mut self,
        plane: PlaneId,
        start: usize,
        depth: usize,
        hand_over: &mut impl FnMut(Job) -> Result<usize, Error>,
    ) -> Result<(), Error> {
        // Coplanar polygons are painted in input order.
        self.scratch.own.sort_unstable_by_key(Piece::rank);
        let own = self.scratch.own.len();
        (0..own).try_for_each(|i| self.store(self.scratch.own[i]))?;
        let (back, front) = (self.pieces.len() - start, self.scratch.front.len());
        let back_is_leaf = is_leaf(&self.pieces[start..]);
        let front_is_leaf = is_leaf(&self.scratch.front);
        // Leaves are stored here, right behind the node's own fragments and front before back: orders
        // rely on these numbers.
        if front_is_leaf {
            (0..front).try_for_each(|i| self.store(self.scratch.front[i]))?;
        }
        if back_is_leaf {
            (start..start + back).try_for_each(|i| self.store(self.pieces[i]))?;
            self.pieces.truncate(start);
        }
        let child =
            |is_leaf, len: usize| if is_leaf { RawChild::Leaf(len as u32) } else { RawChild::Node };
        let (back_child, front_child) = (child(back_is_leaf, back), child(front_is_leaf, front));
        let node = RawNode { plane, own: own as u32, front: front_child, back: back_child };
        self.output.push_node(node)?;
        // The back goes below the front, so that the front is built first, as nodes stand depth first.
        if !back_is_leaf {
            // The back is handed over because it is on top of the stack just now; this thread goes on
            // with the front.
            let job = match is_worth_a_job(back, front) {
                true => Some(hand_over(self.take(start, depth)?)?),
                false => None,
            };
            let range = start..self.pieces.len();
            let back = Pending::new(range, self.arena.len(), depth);
            push(&mut self.pending, Pending { job, ..back })?;
        }
        if front_is_leaf { Ok(()) } else { self.push_front(depth) }
    }

    /// Puts the pieces in `scratch.front` on the stack.
    fn push_front(&mut self, depth: usize) -> Result<(), Error> {
        let start = self.pieces.len();
        // An empty stack takes the list as it is, so that a large set is not in memory twice.
        if start == 0 {
            std::mem::swap(&mut self.pieces, &mut self.scratch.front);
        } else {
            reserve(&mut self.pieces, self.scratch.front.len())?;
            self.pieces.extend_from_slice(&self.scratch.front);
        }
        let front = Pending::new(start..self.pieces.len(), self.arena.len(), depth);
        push(&mut self.pending, front)
    }

    /// Writes one node for each layer of pieces that is peeled off a set, and puts the rest of the set
    /// on the stack. Each layer's node is the only child of the one before.
    fn emit_peeled(&mut self, start: usize, depth: usize, peeled: &Peeled) -> Result<(), Error> {
        let depth = depth + peeled.layers().len();
        self.shared.budget.check_depth(depth)?;
        let mut left = collect((start..self.pieces.len()).map(|_| true))?;
        for layer in peeled.layers() {
            let own = &mut self.scratch.own;
            own.clear();
            reserve(own, peeled.pieces(layer).len())?;
            // Pieces are marked and not removed yet: all layers name them by their places in the set.
            for &piece in peeled.pieces(layer) {
                left[piece as usize] = false;
                own.push(self.pieces[start + piece as usize]);
            }
            own.sort_unstable_by_key(Piece::rank);
            let own = own.len();
            (0..own).try_for_each(|i| self.store(self.scratch.own[i]))?;
            let child = |side| if layer.rest == side { RawChild::Node } else { RawChild::Leaf(0) };
            let (front, back) = (child(Side::Front), child(Side::Back));
            let node = RawNode { plane: layer.plane, own: own as u32, front, back };
            self.output.push_node(node)?;
        }
        let mut next = start;
        for (i, &is_left) in (start..).zip(&left) {
            if is_left {
                self.pieces[next] = self.pieces[i];
                next += 1;
            }
        }
        self.pieces.truncate(next);
        if is_leaf(&self.pieces[start..]) {
            (start..next).try_for_each(|i| self.store(self.pieces[i]))?;
            // The last layer's node was written with a child node that now turns out to be a leaf.
            if let Some(node) = self.output.parts.nodes.last_mut() {
                let child = RawChild::Leaf((next - start) as u32);
                let side =
                    if node.front == RawChild::Node { &mut node.front } else { &mut node.back };
                *side = child;
            }
        } else {
            let rest = Pending::new(start..next, self.arena.len(), depth);
            push(&mut self.pending, Pending { is_peeled: true, ..rest })?;
        }
        Ok(())
    }

    /// Classifies the set on top of the stack by a plane, or by the one that divides it instead: polygons
    /// that are treated as coplanar do not cut each other.
    ///
    /// The corners of a small polygon are rounded by as much as those of a large one, so its plane is
    /// less certain: extended across a large polygon in the same plane, it can leave the tolerance on
    /// both sides. The plane of the large one has the small one within the tolerance, and divides the
    /// set instead. In frames it also does where the plane of the small one passes beside the large one
    /// and cuts nothing: it would come between the large one and others of its plane.
    fn settle(&mut self, start: usize, mut plane: PlaneId) -> Result<PlaneId, Error> {
        let mut tried = Tried::new();
        loop {
            self.classify(start, plane)?;
            let PlaneKind::Face(face) = plane.kind() else { return Ok(plane) };
            tried.push(face);
            let pieces = &self.pieces[start..];
            // The plane may not pass beside a piece that is larger than its own: outside of frames it may.
            let least = match self.shared.rules.tuning.frames {
                Some(_) => {
                    let own = pieces.iter().filter(|piece| piece.face == face);
                    own.map(size).fold(0.0, f64::max)
                }
                None => f64::INFINITY,
            };
            let is_rival = |(piece, side): &(&Piece, &Side)| match side {
                Side::Spanning => !tried.contains(&piece.face),
                Side::Coplanar => false,
                Side::Front | Side::Back => size(piece) > least && !tried.contains(&piece.face),
            };
            let rivals = pieces.iter().zip(&self.scratch.sides).filter(is_rival);
            let Some(larger) = larger(self.shared, face, rivals.map(|(piece, _)| piece))? else {
                return Ok(plane);
            };
            plane = PlaneId::face(larger.face);
        }
    }

    /// The same in a table, for the plane of the piece in a slot.
    pub(super) fn settle_row(&mut self, set: u64, mut slot: usize) -> Result<Row, Error> {
        let mut tried = 0u64;
        loop {
            let row = self.table.slots[slot].row;
            let Row { front, back, .. } = self.table.planes[row];
            tried |= 1 << slot;
            let least = size(&self.table.slots[slot].piece);
            let mut best: Option<(f64, usize)> = None;
            for other in bits(set & (front | back) & !tried) {
                let Slot { piece, row } = self.table.slots[other];
                let is_cut = front & back & 1 << other != 0;
                if !is_cut && size(&piece) <= least {
                    continue;
                }
                self.complete(1 << slot, row)?;
                let Row { front, back, .. } = self.table.planes[row];
                if (front | back) >> slot & 1 == 0
                    && best.is_none_or(|(most, _)| size(&piece) > most)
                {
                    best = Some((size(&piece), other));
                }
            }
            let Some((_, larger)) = best else { return Ok(self.table.planes[row]) };
            slot = larger;
            self.complete(set, self.table.slots[slot].row)?;
        }
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

/// Whether a set is small enough to need no plane.
pub(super) fn is_leaf(pieces: &[Piece]) -> bool {
    pieces.len() <= 1
}

/// As above, of a set of slots of a table.
pub(super) fn is_leaf_of_table(set: u64) -> bool {
    set.count_ones() <= 1
}

/// Cutting a piece counts as the work of classifying this many.
const CUT: usize = 64;

/// The faces whose planes were given up for a set. None is tried again, so the search ends.
type Tried = SmallVec<[u32; 4]>;

/// The square of the diagonal of a piece's box.
fn size(piece: &Piece) -> f64 {
    (0..3).map(|axis| (piece.max[axis] - piece.min[axis]).powi(2)).sum()
}

/// The largest of some pieces on whose own plane a face lies.
pub(super) fn larger<'p>(
    shared: &Shared<'_>,
    face: u32,
    pieces: impl Iterator<Item = &'p Piece>,
) -> Result<Option<&'p Piece>, Error> {
    let Shared { faces, rules, .. } = shared;
    let mut best: Option<(f64, &Piece)> = None;
    for piece in pieces {
        rules.watch.work(1)?;
        let prepared = PreparedPlane::new(faces, PlaneId::face(piece.face));
        if best.is_none_or(|(most, _)| size(piece) > most)
            && prepared.classify(faces, face, None) == Side::Coplanar
        {
            best = Some((size(piece), piece));
        }
    }
    Ok(best.map(|(_, piece)| piece))
}

/// What all jobs of a build may use together.
pub(super) struct Budget {
    /// The pieces that exist by now, over all jobs.
    fragments: AtomicUsize,
    max_fragments: usize,
    max_depth: usize,
}

impl Budget {
    /// The budgets of a build that begins with so many faces.
    pub(super) fn new(options: &BuildOptions, faces: usize) -> Result<Self, Error> {
        let budget = Self {
            fragments: AtomicUsize::new(faces),
            max_fragments: options.max_fragments.min(MOST_FRAGMENTS),
            max_depth: options.max_depth,
        };
        budget.count(0)?;
        Ok(budget)
    }

    /// Counts new pieces; an error if there are too many.
    pub(super) fn count(&self, new: usize) -> Result<(), Error> {
        let total = self.fragments.fetch_add(new, Ordering::Relaxed) + new;
        if total > self.max_fragments {
            Err(Kind::Fragments(self.max_fragments).error())
        } else {
            Ok(())
        }
    }

    /// Checks the depth of a node; an error if it is too deep.
    pub(super) fn check_depth(&self, depth: usize) -> Result<(), Error> {
        if depth > self.max_depth { Err(Kind::Depth(self.max_depth).error()) } else { Ok(()) }
    }
}
