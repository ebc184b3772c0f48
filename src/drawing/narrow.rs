//! The pieces that may show in a tile.

use smallvec::SmallVec;

use super::cell::are_apart;
use super::lines::Half;
use super::stock::Stock;
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
    /// Where the halves that bound the whole face begin, then those of its cuts, and where they end.
    halves: [u32; 3],
}

impl List {
    /// What of all items may show in a tile; and which is the last that is not certainly hidden.
    pub(super) fn of_all(stock: &Stock<'_>, tile: Tile) -> Result<(Self, u32), Error> {
        let mut builder = Narrow::new(stock, tile, u32::MAX, &Self::default())?;
        for (number, item) in (0..).zip(&stock.items) {
            if !builder.add(number, stock.outline(item.seen), stock.cuts(number))? {
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
            let [start, cuts, end] = listed.halves.map(|place| place as usize);
            if !builder.add(listed.item, &self.halves[start..cuts], &self.halves[cuts..end])? {
                break;
            }
        }
        Ok(builder.finish())
    }

    /// The lines of an item that may cross the tile.
    pub(super) fn halves_of(&self, listed: &Listed) -> &[Half] {
        let [start, _, end] = listed.halves;
        &self.halves[start as usize..end as usize]
    }
}

/// Makes the list of a tile.
struct Narrow<'a, 'b> {
    stock: &'a Stock<'b>,
    sides: [[f64; 2]; 2],
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

    /// Adds an item, with the lines of its face and its cuts that may cross the tile, unless it is
    /// certain that the tile shows nothing of it; false if no item behind it can show.
    fn add(&mut self, item: u32, rim: &[Half], cuts: &[Half]) -> Result<bool, Error> {
        if item > self.limit {
            return Ok(false);
        }
        let Self { stock, sides, list, .. } = self;
        if are_apart(sides, &stock.seen[stock.seen_of(item) as usize].region) {
            return Ok(true);
        }
        let start = list.halves.len();
        let mut middle = start;
        for (is_rim, halves) in [(true, rim), (false, cuts)] {
            for &half in halves {
                match stock.lines.across(half, sides) {
                    Across::Inside => continue,
                    Across::Outside => {
                        list.halves.truncate(start);
                        return Ok(true);
                    }
                    Across::Maybe => {}
                }
                push(&mut list.halves, half)?;
                middle += usize::from(is_rim);
            }
        }
        let halves = [place(start)?, place(middle)?, place(list.halves.len())?];
        push(&mut list.items, Listed { item, halves })?;
        if start == list.halves.len() {
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
        let Self { stock, list, limit, .. } = self;
        let seen = |listed: &Listed| stock.items[listed.item as usize].seen;
        let mut end = *limit;
        let mut tried: SmallVec<[u32; 8]> = SmallVec::new();
        for (place, listed) in list.items.iter().enumerate() {
            if listed.item >= end || tried.len() == FACES {
                break;
            }
            let [start, cuts, _] = listed.halves;
            let face = seen(listed);
            // If pieces of it are missing from the list, the others alone may not cover the tile.
            if start < cuts || tried.contains(&face) || stock.seen[face as usize].last > *limit {
                continue;
            }
            tried.push(face);
            let mut siblings = list.items[place..].iter().filter(|other| seen(other) == face);
            end = siblings.next_back().map_or(end, |last| end.min(last.item));
        }
        *limit = end;
        let len = list.items.partition_point(|listed| listed.item <= end);
        list.items.truncate(len);
    }
}
