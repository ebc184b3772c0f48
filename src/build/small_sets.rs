//! Divides small sets of a frame: a table of where each piece lies against the plane of each.

use super::subtree::{Builder, Pending, Shared, is_leaf_of_table};
use crate::Error;
use crate::bits::bits;
use crate::build::choose::{Best, ChooseContext, FrameTuning, MOST_IN_TABLE, Set, crosses};
use crate::build::piece::Piece;
use crate::exact::{PlaneId, PreparedPlane, Side};
use crate::tree::parts::{RawChild, RawNode};

/// The most pieces in a table.
pub(super) const SLOTS: usize = 2 * MOST_IN_TABLE;
const _: () = assert!(SLOTS == u64::BITS as usize, "a bit of a mask each");

/// The pieces of a small set, and the planes of their faces.
///
/// Each piece has a slot, and sets of pieces are masks, so that planes are compared by counting bits.
/// A piece is classified against a plane once, when that is first asked for; what a cut makes takes a
/// slot of its own, and is classified against those planes only that go through the whole piece.
#[derive(Debug, Default)]
pub(super) struct Table {
    pub(super) slots: Vec<Slot>,
    /// Slots that hold no piece.
    pub(super) free: u64,
    pub(super) planes: Vec<Row>,
    /// The sets that are still to be divided, the next one on top.
    pub(super) sets: Vec<Open>,
}

/// A set that is still to be divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    pub(super) set: u64,
    /// How many nodes lie above it.
    pub(super) depth: usize,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pub(super) piece: Piece,
    /// The row of the plane of its face.
    pub(super) row: usize,
}

/// A plane, and which pieces reach in front of it and behind it: both if it cuts them, neither if
/// they lie on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) plane: PlaneId,
    pub(super) prepared: PreparedPlane,
    pub(super) front: u64,
    pub(super) back: u64,
    /// Of which pieces that is known.
    pub(super) known: u64,
}

impl Row {
    pub(super) fn new(plane: PlaneId, prepared: PreparedPlane) -> Self {
        Self { plane, prepared, front: 0, back: 0, known: 0 }
    }

    pub(super) fn set(&mut self, slot: usize, side: Side) {
        let bit = 1 << slot;
        self.known |= bit;
        self.front &= !bit;
        self.back &= !bit;
        self.front |= if matches!(side, Side::Front | Side::Spanning) { bit } else { 0 };
        self.back |= if matches!(side, Side::Back | Side::Spanning) { bit } else { 0 };
    }
}

impl Builder<'_> {
    /// Divides the set on top of the stack, of at most half as many pieces as a table has slots, down
    /// to the leaves.
    pub(super) fn divide_tabled(
        &mut self,
        start: usize,
        depth: usize,
        frames: &FrameTuning,
    ) -> Result<(), Error> {
        self.fill_table(start);
        let all = u64::MAX >> (SLOTS - self.table.slots.len());
        self.table.sets.push(Open { set: all, depth });
        while let Some(Open { set, depth }) = self.table.sets.pop() {
            let row = self.best_of_table(set, frames)?;
            let spanning = set & row.front & row.back;
            if spanning.count_ones() > self.table.free.count_ones() {
                // There are not enough slots, so smaller sets get tables of their own.
                self.table.sets.push(Open { set, depth });
                self.leave_table();
                return Ok(());
            }
            self.shared.budget.check_depth(depth + 1)?;
            self.shared.budget.count(spanning.count_ones() as usize)?;
            let mut sides = [set & row.front & !spanning, set & row.back & !spanning];
            // Those on the plane are done with.
            let left = set & (row.front | row.back);
            for slot in bits(spanning) {
                let parts = self.cut_slot(slot, left, &row.prepared)?;
                sides[0] |= 1 << parts[0];
                sides[1] |= 1 << parts[1];
            }
            self.emit_tabled(&row, set & !row.front & !row.back, sides, depth + 1)?;
        }
        Ok(())
    }

    /// Moves the pieces on top of the stack into slots, and prepares the planes of their faces.
    fn fill_table(&mut self, start: usize) {
        let faces = self.shared.faces;
        let table = &mut self.table;
        let count = self.pieces.len() - start;
        table.sets.clear();
        table.planes.clear();
        table.slots.clear();
        for &piece in &self.pieces[start..] {
            let plane = PlaneId::face(piece.face);
            // A whole face has no other piece.
            let known = match piece.is_whole() {
                true => None,
                false => table.planes.iter().position(|row| row.plane == plane),
            };
            let row = known.unwrap_or(table.planes.len());
            if known.is_none() {
                let prepared = PreparedPlane::new(faces, plane);
                table.planes.push(Row::new(plane, prepared));
            }
            table.slots.push(Slot { piece, row });
        }
        self.pieces.truncate(start);
        table.free = !(u64::MAX >> (SLOTS - count));
    }

    /// The best plane for a set: the first of its own that divides it evenly and cuts nothing, or that
    /// cuts few pieces, all of which cross its own piece; else the best of those that cut nothing, a
    /// free plane that cuts nothing, or the best of its own. (Where an own plane cannot be trusted, free
    /// planes come first.)
    fn best_of_table(&mut self, set: u64, frames: &FrameTuning) -> Result<Row, Error> {
        let (slot, ends_search) = self.best_own_of_table(set, frames)?;
        if !ends_search && let Some(free) = self.free_of_table(set) {
            return Ok(free);
        }
        self.settle_row(set, slot)
    }

    /// The slot of the best own plane of a set, and whether no free plane is better.
    fn best_own_of_table(
        &mut self,
        set: u64,
        frames: &FrameTuning,
    ) -> Result<(usize, bool), Error> {
        let Shared { faces, rules: ChooseContext { tuning, .. }, .. } = self.shared;
        let mut best: Option<Best> = None;
        for slot in bits(set) {
            let row = self.table.slots[slot].row;
            self.complete(set, row)?;
            let Row { front, back, .. } = self.table.planes[row];
            let cut = set & front & back;
            // What crosses the piece has to be cut anyway, or the piece.
            let is_needed = cut != 0
                && cut.count_ones() as usize <= frames.crossings
                && self.cuts_what_crosses(slot, cut)?;
            let slots = &self.table.slots;
            if is_needed && !frames.is_coarse(faces) {
                return Ok((slot, true));
            }
            let best = best.get_or_insert_with(|| {
                Best::new(bits(set).map(|slot| &slots[slot].piece), faces, tuning, frames)
            });
            let piece = &slots[slot].piece;
            if is_needed && best.is_trusted(piece) {
                return Ok((slot, true));
            }
            best.see(slot, piece, [set & front, set & back]);
            if best.is_even() {
                break;
            }
        }
        let first = set.trailing_zeros() as usize;
        let slot = best.as_ref().map_or(first, Best::slot);
        Ok((slot, best.is_some_and(|best| best.is_sure())))
    }

    /// Finds out where pieces lie against a plane of which that is not known.
    pub(super) fn complete(&mut self, set: u64, row: usize) -> Result<(), Error> {
        let Shared { faces, rules, .. } = self.shared;
        let table = &mut self.table;
        let row = &mut table.planes[row];
        let unknown = set & !row.known;
        if unknown != 0 {
            rules.watch.work(unknown.count_ones() as usize)?;
        }
        for slot in bits(unknown) {
            let piece = &table.slots[slot].piece;
            row.set(slot, piece.side(faces, &row.prepared, &self.arena));
        }
        Ok(())
    }

    /// Whether all of some pieces that the plane of a piece cuts cross the piece, and have planes that
    /// cut it.
    fn cuts_what_crosses(&mut self, slot: usize, cut: u64) -> Result<bool, Error> {
        for other in bits(cut) {
            let row = self.table.slots[other].row;
            self.complete(1 << slot, row)?;
            let Row { front, back, .. } = self.table.planes[row];
            let [piece, other] = [slot, other].map(|slot| &self.table.slots[slot].piece);
            if front & back & 1 << slot == 0
                || !crosses(self.shared.faces, &self.arena, piece, other)
            {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// A free plane that cuts nothing of a set.
    fn free_of_table(&mut self, set: u64) -> Option<Row> {
        let Shared { faces, rules, .. } = self.shared;
        let listed = &mut self.scratch.own;
        listed.clear();
        listed.extend(bits(set).map(|slot| self.table.slots[slot].piece));
        let pieces = Set::new(faces, listed, &self.arena);
        let plane = self.chooser.clean(rules, &pieces)?;
        let mut row = Row::new(plane, PreparedPlane::new(faces, plane));
        for slot in bits(set) {
            let piece = &self.table.slots[slot].piece;
            row.set(slot, piece.side(faces, &row.prepared, &self.arena));
        }
        // Free planes are found by rounded distances, so exact decisions can show that one separates
        // nothing.
        let separates = set & !row.front != 0 && set & !row.back != 0;
        separates.then_some(row)
    }

    /// Cuts the piece in a slot, and gives the slots of its parts, the one in front first.
    fn cut_slot(
        &mut self,
        slot: usize,
        set: u64,
        prepared: &PreparedPlane,
    ) -> Result<[usize; 2], Error> {
        let whole = self.table.slots[slot];
        let [front, back] = self.cut(&whole.piece, prepared)?;
        let table = &mut self.table;
        let other = table.free.trailing_zeros() as usize;
        table.free &= table.free - 1;
        if other == table.slots.len() {
            table.slots.push(whole);
        }
        table.slots[slot].piece = front;
        table.slots[other] = Slot { piece: back, ..whole };
        // Only the planes of pieces that are left in the set will be asked for.
        let asked = bits(set).fold(0u64, |rows, slot| rows | 1 << table.slots[slot].row);
        for row in bits(asked) {
            let row = &mut table.planes[row];
            row.known &= !(1 << other);
            if row.known >> slot & 1 == 0 {
                continue;
            }
            match [row.front >> slot & 1, row.back >> slot & 1] {
                // Where the parts lie will be found out when it is asked for.
                [1, 1] => row.known &= !(1 << slot),
                [1, 0] => row.set(other, Side::Front),
                [0, 1] => row.set(other, Side::Back),
                _ => row.set(other, Side::Coplanar),
            }
        }
        Ok([slot, other])
    }

    /// Writes a node with what is on its plane and in its leaves, and puts its other sides on the stack.
    fn emit_tabled(
        &mut self,
        row: &Row,
        own: u64,
        sides: [u64; 2],
        depth: usize,
    ) -> Result<(), Error> {
        let listed = &mut self.scratch.own;
        listed.clear();
        listed.extend(bits(own).map(|slot| self.table.slots[slot].piece));
        listed.sort_unstable_by_key(Piece::rank);
        let own_len = listed.len() as u32;
        (0..listed.len()).try_for_each(|i| self.store(self.scratch.own[i]))?;
        self.table.free |= own;
        let children = sides.map(|side| {
            if is_leaf_of_table(side) { RawChild::Leaf(side.count_ones()) } else { RawChild::Node }
        });
        for side in sides.into_iter().filter(|&side| is_leaf_of_table(side)) {
            bits(side).try_for_each(|slot| self.store(self.table.slots[slot].piece))?;
            self.table.free |= side;
        }
        let [front, back] = children;
        self.output.push_node(RawNode { plane: row.plane, own: own_len, front, back })?;
        // The front comes off first, as nodes stand depth first.
        let kept = sides.into_iter().rev().filter(|&side| !is_leaf_of_table(side));
        self.table.sets.extend(kept.map(|set| Open { set, depth }));
        Ok(())
    }

    /// Puts the sets that are not yet divided back on the stack.
    fn leave_table(&mut self) {
        let arena = self.arena.len();
        for i in 0..self.table.sets.len() {
            let Open { set, depth } = self.table.sets[i];
            let start = self.pieces.len();
            self.pieces.reserve(set.count_ones() as usize);
            self.pieces.extend(bits(set).map(|slot| self.table.slots[slot].piece));
            self.pending.push(Pending::new(start..self.pieces.len(), arena, depth));
        }
    }
}
