//! What is visible in a picture, found tile by tile.
//!
//! A tile has a list of the pieces that may show in it, front to back. It ends with the first that
//! covers the tile. Where it is short, the tile is a leaf, and what is visible of each piece is
//! subtracted from what is left open; else the tile is halved (J. E. Warnock, "A hidden surface
//! algorithm for computer generated halftone pictures", 1969; with exact leaves in place of pixels).

use super::cell::{Cell, Side};
use super::halving::{CUT, found_in};
use super::lines::Adopted;
use super::narrow::List;
use super::rect::{Rect, are_apart};
use super::reporter::finish_item;
use super::rims::Rims;
use super::stock::{FEW_CORNERS, Stock};
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
struct TileList {
    tile: Tile,
    list: List,
    /// How often it was halved in vain: both parts had nearly all items.
    in_vain: u32,
}

/// What a thread finds in its part of the picture, with the lines that it needed.
struct Found<'t> {
    rims: Rims<'t>,
    leaves: Vec<Leaf>,
}

/// A part of a tile where nothing shows so far.
struct Open {
    cell: Cell,
    around: Rect,
}

impl Open {
    fn new(cell: Cell) -> Self {
        Self { around: cell.around(), cell }
    }
}

/// What is visible of all items, in the order of the tiles, by lines that are made for it: two phases.
pub(super) fn visible<'t>(
    stock: &Stock<'t>,
    picture: Tile,
    watch: &Watch<'_>,
) -> Result<(Vec<Leaf>, Rims<'t>), Error> {
    let new = || Found { rims: Rims::new(stock), leaves: vec![] };
    let halves =
        |part: &TileList, found: &mut Found<'t>| part.halves(stock, &mut found.rims, watch);
    let leaf = |part: &TileList, found: &mut Found<'t>| {
        if part.list.items.is_empty() {
            return Ok(());
        }
        let leaf = part.leaf(stock, &mut found.rims, watch)?;
        push(&mut found.leaves, leaf)
    };
    let mut rims = Rims::new(stock);
    let list = List::of_all(stock, &mut rims, picture, watch)?;
    let all = TileList { tile: picture, list, in_vain: 0 };
    let mut leaves = Vec::new();
    let shares = found_in(all, new, halves, leaf, watch)?;
    let count = shares.len();
    for (i, mut found) in shares.into_iter().enumerate() {
        let mut adopted = Adopted::of(&found.rims.lines)?;
        for Leaf { cells, .. } in &mut found.leaves {
            watch.work(cells.len() * CUT)?;
            for Side { half, .. } in cells.iter_mut().flat_map(|visible| &mut visible.cell.sides) {
                *half = rims.lines.adopted(&found.rims.lines, *half, &mut adopted)?;
            }
        }
        rims.lines.adopt_cuts(&found.rims.lines, &adopted)?;
        reserve(&mut leaves, found.leaves.len())?;
        leaves.append(&mut found.leaves);
        finish_item(watch, i, count);
    }
    Ok((leaves, rims))
}

impl TileList {
    /// Both halves of the tile, each with what may show in it; `None` of a leaf.
    fn halves<'t>(
        &self,
        stock: &Stock<'t>,
        rims: &mut Rims<'t>,
        watch: &Watch<'_>,
    ) -> Result<Option<[Self; 2]>, Error> {
        if self.is_leaf() {
            return Ok(None);
        }
        let tiles = self.tile.halves();
        let first = self.list.narrowed(stock, rims, tiles[0], watch)?;
        let second = self.list.narrowed(stock, rims, tiles[1], watch)?;
        let counts = [&first, &second].map(|list| list.items.len());
        let in_vain = in_vain(self.in_vain, self.list.items.len(), counts);
        Ok(Some([
            Self { tile: tiles[0], list: first, in_vain: in_vain[0] },
            Self { tile: tiles[1], list: second, in_vain: in_vain[1] },
        ]))
    }

    /// Whether the tile need not be halved.
    fn is_leaf(&self) -> bool {
        let items = &self.list.items;
        items.len() <= SHORT || self.in_vain == IN_VAIN || self.tile.is_tiny()
    }

    /// Takes what each piece shows from what is left open of the tile.
    fn leaf<'t>(
        &self,
        stock: &Stock<'t>,
        rims: &mut Rims<'t>,
        watch: &Watch<'_>,
    ) -> Result<Leaf, Error> {
        let Self { tile, list, .. } = self;
        let sides = tile.sides();
        let mut open = vec![Open::new(Cell::rectangle(&rims.lines, tile.low, tile.high))];
        let (mut left, mut outside) = (Vec::new(), Vec::new());
        let mut cells = Vec::new();
        for &item in &list.items {
            if open.is_empty() {
                break;
            }
            watch.work(open.len() * CUT)?;
            let of_item = &stock.items[item as usize].around;
            // Where nothing of the piece is, there is no need for its lines.
            if open.iter().all(|open| are_apart(&open.around, of_item)) {
                continue;
            }
            let Some(halves) = rims.crossing(stock, item, &sides)? else { continue };
            // Of others it is counted above.
            if halves.len() > FEW_CORNERS {
                watch.work(open.len() * halves.len())?;
            }
            let (lines, is_opaque) = (&rims.lines, stock.is_opaque(item));
            let mut i = 0;
            while let Some(Open { cell, around }) = open.get(i) {
                let shown = match are_apart(around, of_item) {
                    true => None,
                    false => {
                        cell.within(lines, &halves, is_opaque.then_some(&mut outside), watch)?
                    }
                };
                match shown {
                    Some(cell) if !is_opaque => {
                        push(&mut cells, Visible { item, cell })?;
                        i += 1;
                    }
                    Some(cell) => {
                        push(&mut cells, Visible { item, cell })?;
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
