//! The pieces that may show in a tile.

use smallvec::SmallVec;

use super::half::Half;
use super::region::{Region, are_apart, is_within};
use super::stock::{Item, Stock};
use super::tile::{Across, Tile};
use crate::Error;
use crate::memory::{place, push, reserve};

/// Of so many faces at most, the front ones, it is asked whether all their pieces cover a tile.
const FACES: usize = 8;

/// Items, front to back, each with those of its lines that may cross a tile.
#[derive(Debug, Default)]
pub(super) struct List {
    pub(super) items: Vec<Listed>,
    halves: Vec<Half>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Listed {
    pub(super) item: u32,
    /// Its face, by its place in [`Stock::seen`].
    seen: u32,
    /// Where its halves begin and end.
    halves: [u32; 2],
}

impl List {
    /// What of all items may show in a tile; and which is the last that is not certainly hidden.
    pub(super) fn of_all(stock: &Stock<'_>, tile: Tile) -> Result<(Self, u32), Error> {
        let mut builder = Narrow::new(stock, tile, u32::MAX, &Self::default())?;
        for number in 0..stock.items.len() as u32 {
            if !builder.add(number, stock.halves(number))? {
                break;
            }
        }
        Ok(builder.finish())
    }

    /// The same of what is in the list, for a part of the tile; items behind `limit` are hidden.
    pub(super) fn narrowed(
        &self,
        stock: &Stock<'_>,
        tile: Tile,
        limit: u32,
    ) -> Result<(Self, u32), Error> {
        let mut builder = Narrow::new(stock, tile, limit, self)?;
        for listed in &self.items {
            if !builder.add(listed.item, self.halves_of(listed))? {
                break;
            }
        }
        Ok(builder.finish())
    }

    /// The lines of an item that may cross the tile.
    pub(super) fn halves_of(&self, listed: &Listed) -> &[Half] {
        let [start, end] = listed.halves;
        &self.halves[start as usize..end as usize]
    }
}

/// Makes the list of a tile.
struct Narrow<'a, 'b> {
    stock: &'a Stock<'b>,
    sides: Region,
    list: List,
    limit: u32,
}

impl<'a, 'b> Narrow<'a, 'b> {
    /// The list will be a part of another.
    fn new(stock: &'a Stock<'b>, tile: Tile, limit: u32, whole: &List) -> Result<Self, Error> {
        let mut list = List::default();
        reserve(&mut list.items, whole.items.len())?;
        reserve(&mut list.halves, whole.halves.len())?;
        Ok(Self { stock, sides: tile.sides(), list, limit })
    }

    /// Adds an item, with those of its lines that may cross the tile, unless it is certain that the tile
    /// shows nothing of it; false if no item behind it can show.
    fn add(&mut self, item: u32, halves: &[Half]) -> Result<bool, Error> {
        if item > self.limit {
            return Ok(false);
        }
        let Self { stock, sides, list, .. } = self;
        let Item { seen, ref region, .. } = stock.items[item as usize];
        if are_apart(sides, region) {
            return Ok(true);
        }
        let start = list.halves.len();
        reserve(&mut list.halves, halves.len())?;
        if is_within(region, sides) {
            list.halves.extend_from_slice(halves);
        } else {
            for &half in halves {
                match stock.lines.across(half, sides) {
                    Across::Inside => continue,
                    Across::Outside => {
                        list.halves.truncate(start);
                        return Ok(true);
                    }
                    Across::Maybe => list.halves.push(half),
                }
            }
        }
        let halves = [place(start)?, place(list.halves.len())?];
        push(&mut list.items, Listed { item, seen, halves })?;
        if start == list.halves.len() && stock.is_opaque(item) {
            // It covers the tile.
            self.limit = item;
        }
        Ok(item < self.limit)
    }

    fn finish(mut self) -> (List, u32) {
        self.cover_by_faces();
        (self.list, self.limit)
    }

    /// Ends the list with the last piece of a face that covers the tile, in however many pieces.
    fn cover_by_faces(&mut self) {
        let Self { stock, sides, list, limit } = self;
        let mut end = *limit;
        let mut tried: SmallVec<[u32; FACES]> = SmallVec::new();
        for (place, listed) in list.items.iter().enumerate() {
            if listed.item >= end || tried.len() == FACES {
                break;
            }
            let face = listed.seen;
            // If pieces of it are missing from the list, the others alone may not cover the tile.
            if tried.contains(&face)
                || !stock.is_opaque(listed.item)
                || stock.seen[face as usize].last > *limit
                || !stock.covers(face, sides)
            {
                continue;
            }
            tried.push(face);
            let mut siblings = list.items[place..].iter().filter(|other| other.seen == face);
            end = siblings.next_back().map_or(end, |last| end.min(last.item));
        }
        *limit = end;
        let len = list.items.partition_point(|listed| listed.item <= end);
        list.items.truncate(len);
    }
}
