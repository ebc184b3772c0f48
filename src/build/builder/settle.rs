//! Keeps polygons that count as coplanar from cutting each other.
//!
//! The corners of a small polygon are rounded by as much as those of a large one, so its plane is less
//! certain: extended across a large polygon in the same plane, it can leave the tolerance on both sides.
//! The large one's plane has the small one within the tolerance, and divides the set instead.
//!
//! In frames it does so as well where the small one's plane passes beside the large one and cuts nothing:
//! it would come between the large one and others of its plane.

use smallvec::SmallVec;

use super::state::{Builder, Shared};
use super::table::{Row, Slot};
use crate::Error;
use crate::bits::bits;
use crate::build::piece::Piece;
use crate::exact::{PlaneId, PlaneKind, PreparedPlane, Side};

/// The faces whose planes were given up for a set. None is tried again, so the search ends.
type Tried = SmallVec<[u32; 4]>;

impl Builder<'_> {
    /// Classifies the set on top of the stack by a plane, or by the one that divides it instead.
    pub(super) fn settle(&mut self, start: usize, mut plane: PlaneId) -> Result<PlaneId, Error> {
        let mut tried = Tried::new();
        loop {
            self.classify(start, plane)?;
            let PlaneKind::Face(face) = plane.kind() else { return Ok(plane) };
            tried.push(face);
            let pieces = &self.pieces[start..];
            // The plane may not pass beside a piece that is larger than its own: outside of frames it may.
            let least = match self.shared.rules.tuning.quick {
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

/// The square of the diagonal of a piece's box.
fn size(piece: &Piece) -> f64 {
    (0..3).map(|axis| (piece.max[axis] - piece.min[axis]).powi(2)).sum()
}

/// The largest of some pieces on whose own plane a face lies.
fn larger<'p>(
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
