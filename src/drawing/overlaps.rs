//! Which pieces overlap in the picture, nothing hidden.

use std::collections::HashSet;
use std::hash::BuildHasherDefault;

use super::cell::Cell;
use super::lines::Mixer;
use super::order::Pair;
use super::reaches::Reaches;
use super::stock::Stock;
use super::tile::{CUT, IN_VAIN, NARROWED, Tile, in_vain};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};
use crate::parallel_map;

/// A tile with the items that may be in it, front to back.
struct Entry {
    tile: Tile,
    reaches: Reaches,
    /// How often it was halved in vain: both parts had nearly all items that do not cover them.
    in_vain: u32,
}

type Found = HashSet<Pair, BuildHasherDefault<Mixer>>;

/// Tiles are not halved where at most so many items lie between two that cover them. Larger: more
/// pairs are compared; smaller: more tiles.
const SHORT: usize = 8;
/// Tiles are shared out to threads after so many halvings.
const SHARED: usize = 6;

/// Pairs of items, by their numbers, that overlap in the picture, sorted: all that an order needs. Where
/// an item covers a tile, pairs with it stand for those of what is behind and in front of it.
pub(super) fn overlaps(
    stock: &Stock<'_>,
    picture: Tile,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let mut reaches = Reaches::default();
    for (number, item) in (0..).zip(&stock.items) {
        let halves = stock.outline(item.seen).iter().chain(stock.cuts(number));
        reaches.push(number, halves.copied())?;
    }
    let all = Entry { tile: picture, reaches, in_vain: 0 };
    let mut shares = vec![all.narrowed(stock, picture)?];
    for _ in 0..SHARED {
        let mut next = Vec::with_capacity(2 * shares.len());
        for entry in shares {
            match entry.is_leaf() {
                true => next.push(entry),
                false => {
                    watch.work(entry.reaches.list.len() * NARROWED)?;
                    next.extend(entry.halves(stock)?);
                }
            }
        }
        shares = next;
    }
    watch.expect(shares.len())?;
    let parts = parallel_map::map(shares, |entry| {
        let pairs = overlaps_in(stock, entry, watch);
        watch.finish(0);
        pairs
    });
    let mut pairs = Vec::new();
    for part in parts {
        let part = part?;
        reserve(&mut pairs, part.len())?;
        pairs.extend(part);
    }
    watch.end()?;
    pairs.sort_unstable();
    pairs.dedup();
    Ok(pairs)
}

fn overlaps_in(stock: &Stock<'_>, entry: Entry, watch: &Watch<'_>) -> Result<Found, Error> {
    let (mut found, mut stack) = (Found::default(), vec![entry]);
    while let Some(entry) = stack.pop() {
        if entry.is_leaf() {
            entry.leaf(stock, &mut found, watch)?;
            continue;
        }
        watch.work(entry.reaches.list.len() * NARROWED)?;
        let [first, second] = entry.halves(stock)?;
        push(&mut stack, second)?;
        push(&mut stack, first)?;
    }
    Ok(found)
}

impl Entry {
    fn is_leaf(&self) -> bool {
        let between = self.reaches.list.split(|reach| reach.covers());
        let most = between.map(<[_]>::len).max().unwrap_or(0);
        most <= SHORT || self.in_vain == IN_VAIN || self.tile.is_tiny()
    }

    fn halves(&self, stock: &Stock<'_>) -> Result<[Self; 2], Error> {
        let [first, second] = self.tile.halves();
        let mut parts = [self.narrowed(stock, first)?, self.narrowed(stock, second)?];
        let open = |entry: &Self| entry.reaches.list.iter().filter(|reach| !reach.covers()).count();
        let counts = [open(&parts[0]), open(&parts[1])];
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, open(self), counts);
        Ok(parts)
    }

    fn narrowed(&self, stock: &Stock<'_>, tile: Tile) -> Result<Self, Error> {
        let around = |item: u32| stock.seen[stock.items[item as usize].seen as usize].region;
        let reaches = self.reaches.narrowed(&stock.lines, &tile.sides(), around)?;
        Ok(Self { tile, reaches, in_vain: 0 })
    }

    /// Adds the pairs of the tile.
    fn leaf(&self, stock: &Stock<'_>, found: &mut Found, watch: &Watch<'_>) -> Result<(), Error> {
        let lines = &stock.lines;
        let mut add = |below: u32, above: u32| {
            found.try_reserve(1).map_err(|_| Error::out_of_memory())?;
            found.insert(Pair { below, above });
            Ok::<(), Error>(())
        };
        // The last item that covers the tile, and those behind it so far, with what they cover.
        let mut cover: Option<u32> = None;
        let mut behind: Vec<(u32, Cell)> = Vec::new();
        for reach in &self.reaches.list {
            watch.work((1 + behind.len()) * CUT)?;
            let item = reach.number;
            if reach.covers() {
                if let (Some(cover), true) = (cover, behind.is_empty()) {
                    add(item, cover)?;
                }
                for (above, _) in behind.drain(..) {
                    add(item, above)?;
                }
                cover = Some(item);
                continue;
            }
            let whole = Cell::rectangle(lines, self.tile.low, self.tile.high);
            let halves = self.reaches.halves_of(reach);
            let Some(cell) = whole.within(lines, halves, None)? else { continue };
            if let Some(cover) = cover {
                add(item, cover)?;
            }
            let face = |item: u32| stock.items[item as usize].seen;
            for (above, other) in &behind {
                if face(*above) != face(item) && other.meets(lines, halves)? {
                    add(item, *above)?;
                }
            }
            push(&mut behind, (item, cell))?;
        }
        Ok(())
    }
}
