//! Where segments pass in front of pieces or behind them.

use super::cell::Cell;
use super::halving::{CUT, NARROWED, found_in};
use super::reaches::Reaches;
use super::region::{Region, are_apart};
use super::sight::Sight;
use super::stock::Stock;
use super::tile::{IN_VAIN, Tile, in_vain};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};

/// A part of a segment that passes a piece in the picture, over its inside or along its border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    /// The segment and the piece, by their numbers.
    pub(super) sight: u32,
    pub(super) piece: u32,
    /// Whether the piece is in front of it.
    pub(super) is_behind: bool,
    /// From where to where, along the segment.
    pub(super) places: [f64; 2],
}

/// Convex pieces of faces, all by their numbers.
pub(super) struct Pieces<'a> {
    pub(super) stock: &'a Stock<'a>,
    pub(super) reaches: Reaches,
    /// The place in the stock of a piece's face.
    pub(super) seen: &'a (dyn Fn(u32) -> u32 + Sync),
    /// A box around a piece.
    pub(super) around: &'a (dyn Fn(u32) -> Region + Sync),
}

/// Tiles are not halved where at most so many pieces reach into them without covering them. Larger: more
/// segments are compared with more pieces; smaller: more tiles, and more parts of segments.
const FEW: usize = 8;

/// A tile with the pieces and segments that may be in it.
struct Entry {
    tile: Tile,
    reaches: Reaches,
    sights: Vec<u32>,
    in_vain: u32,
}

/// All passes that are wanted, by whether the piece is in front; one segment may pass a piece in several
/// parts.
pub(super) fn passes(
    mut pieces: Pieces<'_>,
    sights: &[Sight],
    is_wanted: impl Fn(bool) -> bool + Sync,
    watch: &Watch<'_>,
) -> Result<Vec<Pass>, Error> {
    let picture = Tile::picture(pieces.stock.lines.frame.rays.size());
    let reaches = std::mem::take(&mut pieces.reaches);
    let numbers = (0..sights.len() as u32).collect();
    let all = Entry { tile: picture, reaches, sights: numbers, in_vain: 0 };
    let halves = |entry: &Entry| {
        watch.work((entry.reaches.list.len() + entry.sights.len()) * NARROWED)?;
        entry.halves(&pieces, sights)
    };
    let leaf = |entry: &Entry, found: &mut Vec<Pass>| {
        entry.leaf(&pieces, sights, &is_wanted, found, watch)
    };
    let mut passes = Vec::new();
    for mut found in found_in(all.narrowed(&pieces, sights, picture)?, halves, leaf, watch)? {
        reserve(&mut passes, found.len())?;
        passes.append(&mut found);
    }
    Ok(passes)
}

impl Entry {
    /// How many pieces do not cover the tile.
    fn open(&self) -> usize {
        self.reaches.list.iter().filter(|reach| !reach.covers()).count()
    }

    fn is_leaf(&self) -> bool {
        let is_done = self.sights.is_empty() || self.open() <= FEW;
        is_done || self.in_vain == IN_VAIN || self.tile.is_tiny()
    }

    /// Both halves of the tile; `None` of a leaf.
    fn halves(&self, pieces: &Pieces<'_>, sights: &[Sight]) -> Result<Option<[Self; 2]>, Error> {
        if self.is_leaf() {
            return Ok(None);
        }
        let [first, second] = self.tile.halves();
        let narrowed = |tile| self.narrowed(pieces, sights, tile);
        let mut parts = [narrowed(first)?, narrowed(second)?];
        let counts = [parts[0].open(), parts[1].open()];
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, self.open(), counts);
        Ok(Some(parts))
    }

    fn narrowed(&self, pieces: &Pieces<'_>, sights: &[Sight], tile: Tile) -> Result<Self, Error> {
        let sides = tile.sides();
        let reaches = self.reaches.narrowed(&pieces.stock.lines, &sides, pieces.around)?;
        let mut kept = Vec::new();
        reserve(&mut kept, self.sights.len())?;
        kept.extend(self.sights.iter().filter(|&&number| {
            let sight = &sights[number as usize];
            !are_apart(&sides, &sight.region) && sight.may_meet(&sides)
        }));
        Ok(Self { tile, reaches, sights: kept, in_vain: 0 })
    }

    /// Adds the passes in the tile.
    fn leaf(
        &self,
        pieces: &Pieces<'_>,
        sights: &[Sight],
        is_wanted: &impl Fn(bool) -> bool,
        found: &mut Vec<Pass>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        if self.sights.is_empty() {
            return Ok(());
        }
        let (stock, lines) = (pieces.stock, &pieces.stock.lines);
        let whole = Cell::rectangle(lines, self.tile.low, self.tile.high);
        for reach in &self.reaches.list {
            watch.work((1 + self.sights.len()) * CUT)?;
            let Some(cell) = whole.within(lines, self.reaches.halves_of(reach), None)? else {
                continue;
            };
            let (around, piece) = (cell.region(), reach.number);
            let face = stock.seen[(pieces.seen)(piece) as usize].face;
            let side = lines.frame.seen_side(face);
            for &sight in &self.sights {
                let segment = &sights[sight as usize];
                if are_apart(&around, &segment.region) || !segment.may_meet(&around) {
                    continue;
                }
                let Some(chord) = segment.chord(lines, &cell) else { continue };
                let mut add = |is_behind: bool, [from, to]: [f64; 2]| {
                    let places = [from.max(chord[0]), to.min(chord[1])];
                    let is_any = is_wanted(is_behind) && places[0] < places[1];
                    let pass = Pass { sight, piece, is_behind, places };
                    if is_any { push(found, pass) } else { Ok(()) }
                };
                let [from, to] = segment.behind(lines, face, side).unwrap_or([f64::INFINITY; 2]);
                add(true, [from, to])?;
                add(false, [f64::NEG_INFINITY, from])?;
                add(false, [to, f64::INFINITY])?;
            }
        }
        Ok(())
    }
}
