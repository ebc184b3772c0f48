//! Keeps polygons that count as coplanar from cutting each other.
//!
//! The corners of a small polygon are rounded by as much as those of a large one, so its plane is less
//! certain: extended across a large polygon in the same plane, it can leave the tolerance on both sides.
//! The large one's plane has the small one within the tolerance, and divides the set instead.

use smallvec::SmallVec;

use super::state::{Builder, Shared};
use super::table::{Row, Slot};
use crate::Error;
use crate::bits::bits;
use crate::build::live::Live;
use crate::exact::{Kernel, Piece, PlaneId, PlaneKind, Side};

/// The faces whose planes were given up for a set. None is tried again, so the search ends.
type Tried = SmallVec<[u32; 4]>;

impl<K: Kernel> Builder<'_, K> {
    /// Classifies the set on top of the stack by a plane, or by the one that divides it instead.
    pub(super) fn settle(&mut self, start: usize, mut plane: PlaneId) -> Result<PlaneId, Error> {
        let mut tried = Tried::new();
        loop {
            self.classify(start, plane)?;
            let pieces = self.pieces[start..].iter().zip(&self.scratch.sides);
            let cut = pieces.filter(|&(_, &side)| side == Side::Spanning).map(|(piece, _)| piece);
            let Some(larger) = larger(self.shared, plane, cut, &mut tried)? else {
                return Ok(plane);
            };
            plane = PlaneId::face(larger.face);
        }
    }

    /// The same in a table, for the plane of the piece in a slot.
    pub(super) fn settle_row(&mut self, set: u64, mut slot: usize) -> Result<Row<K>, Error> {
        let mut tried = 0u64;
        loop {
            let row = self.table.slots[slot].row;
            let Row { front, back, .. } = self.table.planes[row];
            tried |= 1 << slot;
            let mut best: Option<(f64, usize)> = None;
            for other in bits(set & front & back & !tried) {
                let Slot { piece, row } = self.table.slots[other];
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

/// The square of the diagonal of a piece's box.
fn size(piece: &Live) -> f64 {
    (0..3).map(|axis| (piece.max[axis] - piece.min[axis]).powi(2)).sum()
}

/// The largest of the pieces that a plane cuts and on whose own plane the plane's face lies.
fn larger<'p, K: Kernel>(
    shared: &Shared<'_, K>,
    plane: PlaneId,
    cut: impl Iterator<Item = &'p Live>,
    tried: &mut Tried,
) -> Result<Option<&'p Live>, Error> {
    let PlaneKind::Face(face) = plane.kind() else { return Ok(None) };
    let Shared { kernel, faces, rules, .. } = shared;
    tried.push(face);
    let mut best: Option<(f64, &Live)> = None;
    for piece in cut {
        rules.watch.work(1)?;
        let splitter = kernel.splitter(faces, PlaneId::face(piece.face));
        if best.is_none_or(|(most, _)| size(piece) > most)
            && !tried.contains(&piece.face)
            && kernel.classify(faces, &splitter, Piece { face, cut: None }) == Side::Coplanar
        {
            best = Some((size(piece), piece));
        }
    }
    Ok(best.map(|(_, piece)| piece))
}
