//! Divides a set of pieces by a plane, and cuts the pieces that span it.

use super::state::Builder;
use crate::Error;
use crate::build::piece::Piece;
use crate::build::progress::PIECES_AT_ONCE;
use crate::exact::{PlaneId, PreparedPlane, Side};
use crate::memory::reserve;

/// Cutting a piece counts as the work of classifying this many.
const CUT: usize = 64;

impl Builder<'_> {
    /// Finds the side of each piece of the set on top of the stack, into `scratch.sides`.
    pub(super) fn classify(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
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
    pub(super) fn makes_progress(&self, count: usize) -> bool {
        let sides = &self.scratch.sides;
        let reach = |other: Side| {
            sides.iter().filter(|&&side| side == other || side == Side::Spanning).count()
        };
        reach(Side::Front) < count && reach(Side::Back) < count
    }

    /// Classifies the set on top of the stack, and divides it.
    pub(super) fn partition(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        self.classify(start, plane)?;
        self.divide(start, plane)
    }

    /// Divides the set on top of the stack by `scratch.sides`: pieces behind stay on the stack, pieces
    /// in front go to `scratch.front`, and pieces on the plane to `scratch.own`.
    pub(super) fn divide(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
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
        live: &Piece,
        prepared: &PreparedPlane,
    ) -> Result<[Piece; 2], Error> {
        self.shared.rules.watch.work(CUT)?;
        let Self { shared, arena, scratch, .. } = self;
        self.output.parts.cuts += 1;
        scratch.splitter.cut(shared.faces, prepared, live, arena)
    }
}
