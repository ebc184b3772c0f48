//! Where segments pass in front of pieces or behind them.

use super::cell::Cell;
use super::halving::{CUT, NARROWED, found_in};
use super::lines::Lines;
use super::reaches::Reaches;
use super::rect::{Rect, are_apart};
use super::reporter::each;
use super::sight::Sight;
use super::spot::Spot;
use super::tile::{IN_VAIN, Tile, in_vain};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, push, reserve};

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

/// A point that is in a piece in the picture, or on its border.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpotPass {
    pub(super) spot: u32,
    pub(super) piece: u32,
    /// Whether the piece is in front of it.
    pub(super) is_behind: bool,
}

/// What passes pieces.
#[derive(Clone, Copy)]
pub(super) struct Passing<'a> {
    pub(super) sights: &'a [Sight],
    pub(super) spots: &'a [Spot],
}

/// What was found: one segment may pass a piece in several parts, and one point be found twice.
#[derive(Default)]
pub(super) struct Passes {
    pub(super) sights: Vec<Pass>,
    pub(super) spots: Vec<SpotPass>,
}

/// Convex pieces of faces, all by their numbers.
pub(super) struct Pieces<'a> {
    pub(super) lines: &'a Lines<'a>,
    pub(super) reaches: Reaches,
    /// The face of a piece.
    pub(super) face: &'a (dyn Fn(u32) -> u32 + Sync),
    /// A box around a piece.
    pub(super) around: &'a (dyn Fn(u32) -> Rect + Sync),
}

/// Tiles are not halved where at most so many pieces reach into them without covering them. Larger: more
/// segments are compared with more pieces; smaller: more tiles, and more parts of segments (8: twice the
/// time, of crossing triangles five times; 128: up to a sixth less).
const FEW: usize = 64;

/// A tile with the pieces, segments and points that may be in it.
struct TilePasses {
    tile: Tile,
    reaches: Reaches,
    sights: Vec<u32>,
    spots: Vec<u32>,
    in_vain: u32,
}

/// All passes that are wanted, by whether the piece is in front: a phase.
pub(super) fn passes(
    mut pieces: Pieces<'_>,
    passing: Passing<'_>,
    is_wanted: impl Fn(bool) -> bool + Sync,
    watch: &Watch<'_>,
) -> Result<Passes, Error> {
    let tile = Tile::picture(pieces.lines.frame.rays.size());
    let reaches = std::mem::take(&mut pieces.reaches);
    let sights = collect(0..passing.sights.len() as u32)?;
    let spots = collect(0..passing.spots.len() as u32)?;
    let all = TilePasses { tile, reaches, sights, spots, in_vain: 0 };
    let halves = |part: &TilePasses, _: &mut Passes| part.halves(&pieces, passing, watch);
    let leaf = |part: &TilePasses, found: &mut Passes| {
        part.leaf(&pieces, passing, &is_wanted, found, watch)
    };
    let (all, mut passes) = (all.narrowed(&pieces, passing, tile, watch)?, Passes::default());
    for mut found in found_in(all, Passes::default, halves, leaf, watch)? {
        watch.work(found.sights.len() + found.spots.len())?;
        reserve(&mut passes.sights, found.sights.len())?;
        passes.sights.append(&mut found.sights);
        reserve(&mut passes.spots, found.spots.len())?;
        passes.spots.append(&mut found.spots);
    }
    Ok(passes)
}

impl TilePasses {
    /// How many pieces do not cover the tile.
    fn open(&self) -> usize {
        self.reaches.list.iter().filter(|reach| !reach.covers()).count()
    }

    fn is_leaf(&self) -> bool {
        let is_done = self.sights.is_empty() && self.spots.is_empty() || self.open() <= FEW;
        is_done || self.in_vain == IN_VAIN || self.tile.is_tiny()
    }

    /// Both halves of the tile; `None` of a leaf.
    fn halves(
        &self,
        pieces: &Pieces<'_>,
        passing: Passing<'_>,
        watch: &Watch<'_>,
    ) -> Result<Option<[Self; 2]>, Error> {
        if self.is_leaf() {
            return Ok(None);
        }
        let [first, second] = self.tile.halves();
        let narrowed = |tile| self.narrowed(pieces, passing, tile, watch);
        let mut parts = [narrowed(first)?, narrowed(second)?];
        let counts = [parts[0].open(), parts[1].open()];
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, self.open(), counts);
        Ok(Some(parts))
    }

    fn narrowed(
        &self,
        pieces: &Pieces<'_>,
        passing: Passing<'_>,
        tile: Tile,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let sides = tile.sides();
        let reaches = self.reaches.narrowed(pieces.lines, &sides, pieces.around, watch)?;
        let may_meet = |number: u32| passing.sights[number as usize].may_meet(&sides);
        let sights = kept(&self.sights, may_meet, watch)?;
        let is_near = |number: u32| !are_apart(&sides, &passing.spots[number as usize].around());
        let spots = kept(&self.spots, is_near, watch)?;
        Ok(Self { tile, reaches, sights, spots, in_vain: 0 })
    }

    /// Adds the passes in the tile.
    fn leaf(
        &self,
        pieces: &Pieces<'_>,
        passing: Passing<'_>,
        is_wanted: &impl Fn(bool) -> bool,
        found: &mut Passes,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        if self.sights.is_empty() && self.spots.is_empty() {
            return Ok(());
        }
        let lines = pieces.lines;
        let whole = Cell::rectangle(lines, self.tile.low, self.tile.high);
        for reach in &self.reaches.list {
            watch.work(CUT)?;
            let halves = self.reaches.halves_of(reach);
            let Some(cell) = whole.within(lines, halves, None, watch)? else { continue };
            let (around, piece) = (cell.around(), reach.number);
            let face = (pieces.face)(piece);
            let side = lines.frame.seen_side(face);
            for number in each(watch, CUT, &self.sights) {
                let number = *number?;
                let sight = &passing.sights[number as usize];
                if !sight.may_meet(&around) {
                    continue;
                }
                let Some(chord) = sight.chord(lines, &cell) else { continue };
                let mut add = |is_behind: bool, [from, to]: [f64; 2]| {
                    let places = [from.max(chord[0]), to.min(chord[1])];
                    let pass = Pass { sight: number, piece, is_behind, places };
                    let is_any = is_wanted(is_behind) && places[0] < places[1];
                    if is_any { push(&mut found.sights, pass) } else { Ok(()) }
                };
                let [from, to] = sight.behind(lines, face, side).unwrap_or([f64::INFINITY; 2]);
                add(true, [from, to])?;
                add(false, [f64::NEG_INFINITY, from])?;
                add(false, [to, f64::INFINITY])?;
            }
            for number in each(watch, CUT, &self.spots) {
                let number = *number?;
                let spot = &passing.spots[number as usize];
                if !are_apart(&around, &spot.around()) && spot.is_in(lines, &cell) {
                    let is_behind = spot.is_behind(lines, face, side);
                    if is_wanted(is_behind) {
                        push(&mut found.spots, SpotPass { spot: number, piece, is_behind })?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Those of some numbers that a function keeps.
pub(super) fn kept(
    numbers: &[u32],
    keep: impl Fn(u32) -> bool,
    watch: &Watch<'_>,
) -> Result<Vec<u32>, Error> {
    let mut kept = Vec::new();
    reserve(&mut kept, numbers.len())?;
    for number in each(watch, NARROWED, numbers) {
        let number = *number?;
        if keep(number) {
            kept.push(number);
        }
    }
    Ok(kept)
}
