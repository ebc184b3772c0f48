//! Where each piece of a small set lies against each plane.

use crate::build::choose::MOST_IN_TABLE;
use crate::build::piece::Piece;
use crate::exact::{PlaneId, PreparedPlane, Side};

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
