//! What is visible in a picture, found tile by tile.
//!
//! A tile has a list of the pieces that may show in it, front to back. It ends with the first that
//! covers the tile. Where it is short, the tile is a leaf, and what is visible of each piece is
//! subtracted from what is left open; else the tile is halved (J. E. Warnock, "A hidden surface
//! algorithm for computer generated halftone pictures", 1969; with exact leaves in place of pixels).

use super::cell::Cell;
use super::halving::{CUT, NARROWED, found_in};
use super::narrow::List;
use super::region::{Region, are_apart};
use super::stock::Stock;
use super::tile::{IN_VAIN, Tile, in_vain};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};

/// A part of what is visible: all of it in the picture, with nothing opaque before it. Where all items
/// are opaque, none of it is shown by another.
#[derive(Clone, Debug)]
pub(super) struct Visible {
    pub(super) item: u32,
    pub(super) cell: Cell,
}

/// A tile that was not halved, and what is visible in it.
#[derive(Debug)]
pub(super) struct Leaf {
    pub(super) tile: Tile,
    pub(super) cells: Vec<Visible>,
}

/// Tiles with longer lists are halved. Smaller: more tiles, and more cells cut by their borders (16:
/// half as much again for all of a drawing of a scan); larger: more cells compared with more items,
/// though 128 would win another 2 to 4 %.
const SHORT: usize = 64;

/// A tile with the pieces that may show in it.
#[derive(Debug)]
struct Entry {
    tile: Tile,
    list: List,
    /// Items behind this one are missing from the list: they are hidden.
    limit: u32,
    /// How often it was halved in vain: both parts had nearly all items.
    in_vain: u32,
}

/// A part of a tile where nothing shows so far.
struct Open {
    cell: Cell,
    around: Region,
}

impl Open {
    fn new(cell: Cell) -> Self {
        Self { around: cell.region(), cell }
    }
}

/// What is visible of all items, in the order of the tiles.
pub(super) fn visible(
    stock: &Stock<'_>,
    picture: Tile,
    watch: &Watch<'_>,
) -> Result<Vec<Leaf>, Error> {
    let halves = |entry: &Entry| {
        watch.work(entry.list.items.len() * NARROWED)?;
        entry.halves(stock)
    };
    let leaf = |entry: &Entry, leaves: &mut Vec<Leaf>| match entry.list.items.is_empty() {
        true => Ok(()),
        false => push(leaves, entry.leaf(stock, watch)?),
    };
    let mut all = Vec::new();
    for mut part in found_in(Entry::of_picture(stock, picture)?, halves, leaf, watch)? {
        reserve(&mut all, part.len())?;
        all.append(&mut part);
    }
    Ok(all)
}

impl Entry {
    /// The whole picture with all items.
    fn of_picture(stock: &Stock<'_>, tile: Tile) -> Result<Self, Error> {
        let (list, limit) = List::of_all(stock, tile)?;
        Ok(Self { tile, list, limit, in_vain: 0 })
    }

    /// Both halves of the tile, each with what may show in it; `None` of a leaf.
    fn halves(&self, stock: &Stock<'_>) -> Result<Option<[Self; 2]>, Error> {
        if self.is_leaf() {
            return Ok(None);
        }
        let [first, second] = self.tile.halves();
        let mut parts = [self.narrowed(stock, first)?, self.narrowed(stock, second)?];
        let [all, first, second] = [self, &parts[0], &parts[1]].map(|entry| entry.list.items.len());
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, all, [first, second]);
        Ok(Some(parts))
    }

    /// What of the list may show in a part of the tile.
    fn narrowed(&self, stock: &Stock<'_>, tile: Tile) -> Result<Self, Error> {
        let (list, limit) = self.list.narrowed(stock, tile, self.limit)?;
        Ok(Self { tile, list, limit, in_vain: 0 })
    }

    /// Whether the tile need not be halved.
    fn is_leaf(&self) -> bool {
        let items = &self.list.items;
        items.len() <= SHORT || self.in_vain == IN_VAIN || self.tile.is_tiny()
    }

    /// Takes what each piece shows from what is left open of the tile.
    fn leaf(&self, stock: &Stock<'_>, watch: &Watch<'_>) -> Result<Leaf, Error> {
        let Self { tile, list, .. } = self;
        let lines = &stock.lines;
        let mut open = vec![Open::new(Cell::rectangle(lines, tile.low, tile.high))];
        let (mut left, mut outside) = (Vec::new(), Vec::new());
        let mut cells = Vec::new();
        for listed in &list.items {
            if open.is_empty() {
                break;
            }
            watch.work(open.len() * CUT)?;
            let region = &stock.items[listed.item as usize].region;
            let halves = list.halves_of(listed);
            let is_opaque = stock.is_opaque(listed.item);
            let mut i = 0;
            while let Some(Open { cell, around }) = open.get(i) {
                // Where nothing of the piece is, there is no need to cut the cell.
                let shown = match are_apart(around, region) {
                    true => None,
                    false => cell.within(lines, halves, is_opaque.then_some(&mut outside))?,
                };
                match shown {
                    Some(cell) if !is_opaque => {
                        push(&mut cells, Visible { item: listed.item, cell })?;
                        i += 1;
                    }
                    Some(cell) => {
                        push(&mut cells, Visible { item: listed.item, cell })?;
                        open.swap_remove(i);
                        reserve(&mut left, outside.len())?;
                        left.append(&mut outside);
                    }
                    None => {
                        outside.clear();
                        i += 1;
                    }
                }
            }
            reserve(&mut open, left.len())?;
            open.extend(left.drain(..).map(Open::new));
        }
        Ok(Leaf { tile: *tile, cells })
    }
}
