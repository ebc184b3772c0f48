//! Writes pieces where they stay.

use std::ops::Range;

use super::placer::{Placer, Work};
use super::skeleton::SlotSide;
use crate::error::Error;
use crate::exact::{StoredVertex, Vertex};
use crate::memory::reserve;
use crate::tree::parts::{Parts, Record};

impl Work<'_> {
    /// Adds fragments of the cell's tree to the pieces in place, and then so many of `own`, in input
    /// order.
    pub(super) fn store_all(
        &mut self,
        fragments: Range<u32>,
        own: usize,
    ) -> Result<SlotSide, Error> {
        let first = self.pieces.records.len() as u32;
        for fragment in fragments {
            let fragment = fragment as usize;
            let Parts { records, vertices, positions, .. } = &self.placer.cell.parts;
            let end =
                records.get(fragment + 1).map_or(vertices.len(), |next| next.vertices as usize);
            let range = records[fragment].vertices as usize..end;
            let (symbols, places) = (&vertices[range.clone()], &positions[range]);
            let face = records[fragment].face;
            add(self.pieces, face, symbols.iter().copied(), places.iter().copied())?;
        }
        let Placer { own: list, arena, .. } = &*self.placer;
        // Coplanar polygons are painted in input order, which sets keep when they are divided.
        debug_assert!(list[..own].is_sorted_by_key(|piece| piece.face), "in input order");
        for live in &list[..own] {
            let cut = live.cut_vertices(arena).unwrap_or_default();
            let symbols = cut.iter().map(|vertex| vertex.stored());
            add(self.pieces, live.face, symbols, cut.iter().map(Vertex::position))?;
            self.watch.finish(live.cuts);
        }
        self.skeleton.group(first..self.pieces.records.len() as u32)
    }

    /// Appends the fragments of a small tree to the overlay's pieces, and gives the number of the first.
    pub(super) fn store_tree(&mut self, tree: &Parts) -> Result<u32, Error> {
        let pieces = &mut *self.pieces;
        let first = pieces.records.len() as u32;
        let shift = pieces.vertices.len() as u32;
        reserve(&mut pieces.records, tree.records.len())?;
        let moved = |record: &Record| Record { vertices: record.vertices + shift, ..*record };
        pieces.records.extend(tree.records.iter().map(moved));
        reserve(&mut pieces.vertices, tree.vertices.len())?;
        pieces.vertices.extend_from_slice(&tree.vertices);
        reserve(&mut pieces.positions, tree.positions.len())?;
        pieces.positions.extend_from_slice(&tree.positions);
        Ok(first)
    }
}

/// Adds a piece to those that are in place.
fn add(
    pieces: &mut Parts,
    face: u32,
    symbols: impl ExactSizeIterator<Item = StoredVertex>,
    places: impl ExactSizeIterator<Item = [f64; 3]>,
) -> Result<(), Error> {
    let Parts { records, vertices, positions, .. } = pieces;
    reserve(records, 1)?;
    records.push(Record { face, vertices: vertices.len() as u32 });
    reserve(vertices, symbols.len())?;
    vertices.extend(symbols);
    reserve(positions, places.len())?;
    positions.extend(places);
    Ok(())
}
