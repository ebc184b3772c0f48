//! The pieces that may show in a tile.

use smallvec::SmallVec;

use super::halving::NARROWED;
use super::rect::{Rect, are_apart, reaches_across};
use super::reporter::each;
use super::rims::Rims;
use super::stock::{Item, Stock};
use super::tile::{Across, Tile};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};

/// Of so many faces at most, the front ones, it is asked whether all their pieces cover a tile.
const FACES: usize = 8;

/// Items that may show in a tile, front to back.
#[derive(Debug)]
pub(super) struct List {
    pub(super) items: Vec<u32>,
    /// Items behind this one are missing from the list: they are hidden.
    limit: u32,
}

impl List {
    /// What of all items may show in a tile.
    pub(super) fn of_all<'t>(
        stock: &Stock<'t>,
        rims: &mut Rims<'t>,
        tile: Tile,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut narrow = Narrow::new(stock, rims, tile, u32::MAX, stock.items.len())?;
        for item in each(watch, NARROWED, 0..stock.items.len() as u32) {
            if !narrow.add(item?)? {
                break;
            }
        }
        narrow.finish(watch)
    }

    /// What of the list may show in a part of the tile.
    pub(super) fn narrowed<'t>(
        &self,
        stock: &Stock<'t>,
        rims: &mut Rims<'t>,
        tile: Tile,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut narrow = Narrow::new(stock, rims, tile, self.limit, self.items.len())?;
        for item in each(watch, NARROWED, &self.items) {
            if !narrow.add(*item?)? {
                break;
            }
        }
        narrow.finish(watch)
    }
}

/// Makes the list of a tile.
struct Narrow<'a, 't> {
    stock: &'a Stock<'t>,
    rims: &'a mut Rims<'t>,
    sides: Rect,
    list: List,
}

impl<'a, 't> Narrow<'a, 't> {
    /// The list will be of so many items at most, none behind `limit`.
    fn new(
        stock: &'a Stock<'t>,
        rims: &'a mut Rims<'t>,
        tile: Tile,
        limit: u32,
        most: usize,
    ) -> Result<Self, Error> {
        let mut items = Vec::new();
        reserve(&mut items, most)?;
        Ok(Self { stock, rims, sides: tile.sides(), list: List { items, limit } })
    }

    /// Adds an item unless it is certain that the tile shows nothing of it; false if no item behind it can
    /// show.
    fn add(&mut self, item: u32) -> Result<bool, Error> {
        let Self { stock, rims, sides, list } = self;
        if item > list.limit {
            return Ok(false);
        }
        let Item { ref around, .. } = stock.items[item as usize];
        if are_apart(sides, around) {
            return Ok(true);
        }
        // Lines are made and looked at only where they may tell more than boxes.
        if reaches_across(around, sides) {
            match rims.across_item(stock, item, sides)? {
                Across::Inside if stock.is_opaque(item) => list.limit = item,
                Across::Outside => return Ok(true),
                Across::Inside | Across::Maybe => {}
            }
        }
        push(&mut list.items, item)?;
        Ok(item < list.limit)
    }

    /// Ends the list with the last piece of a face that covers the tile, in however many pieces.
    fn finish(self, watch: &Watch<'_>) -> Result<List, Error> {
        let Self { stock, rims, sides, mut list } = self;
        let mut end = list.limit;
        let mut tried: SmallVec<[u32; FACES]> = SmallVec::new();
        for (place, &item) in list.items.iter().enumerate() {
            if item >= end || tried.len() == FACES {
                break;
            }
            let face = stock.face(item);
            // If pieces of it are missing from the list, the others alone may not cover the tile.
            if tried.contains(&face)
                || !stock.is_opaque(item)
                || stock.views[face as usize].last > list.limit
                || !rims.covers(stock, face, &sides)?
            {
                continue;
            }
            tried.push(face);
            watch.work(list.items.len() - place)?;
            let mut siblings =
                list.items[place..].iter().filter(|&&other| stock.face(other) == face);
            end = siblings.next_back().map_or(end, |&last| end.min(last));
        }
        list.limit = end;
        let len = list.items.partition_point(|&item| item <= end);
        list.items.truncate(len);
        Ok(list)
    }
}
