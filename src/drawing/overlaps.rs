//! Which pieces overlap in the picture, nothing hidden.

use super::cell::Cell;
use super::halving::{CUT, found_in};
use super::lines::Lines;
use super::pairs::{Found, Pair, add, sorted};
use super::reaches::Reaches;
use super::reporter::each;
use super::rims::Rims;
use super::stock::Stock;
use super::tile::{IN_VAIN, Tile, in_vain};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::push;

/// A tile with the items that may be in it, front to back.
struct TileStack {
    tile: Tile,
    reaches: Reaches,
    /// How often it was halved in vain: both parts had nearly all items that do not cover them.
    in_vain: u32,
}

/// Tiles are not halved where at most so many items lie between two that cover them. Larger: more
/// pairs are compared; smaller: more tiles.
const FEW: usize = 8;

/// Pairs of items, by their numbers, that overlap in the picture, sorted: all that an order needs. Where
/// an item covers a tile, pairs with it stand for those of what is behind and in front of it.
pub(super) fn overlaps(
    stock: &Stock<'_>,
    rims: &Rims<'_>,
    picture: Tile,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let mut reaches = Reaches::default();
    for item in each(watch, 2, 0..stock.items.len() as u32) {
        let item = item?;
        reaches.push(item, rims.known_item(stock, item))?;
    }
    let all = TileStack { tile: picture, reaches, in_vain: 0 };
    let halves = |part: &TileStack, _: &mut Found| part.halves(stock, &rims.lines, watch);
    let leaf = |part: &TileStack, found: &mut Found| part.leaf(stock, &rims.lines, found, watch);
    let all = all.narrowed(stock, &rims.lines, picture, watch)?;
    sorted(found_in(all, Found::default, halves, leaf, watch)?, watch)
}

impl TileStack {
    fn is_leaf(&self) -> bool {
        let between = self.reaches.list.split(|reach| reach.covers());
        let most = between.map(<[_]>::len).max().unwrap_or(0);
        most <= FEW || self.in_vain == IN_VAIN || self.tile.is_tiny()
    }

    /// Both halves of the tile; `None` of a leaf.
    fn halves(
        &self,
        stock: &Stock<'_>,
        lines: &Lines<'_>,
        watch: &Watch<'_>,
    ) -> Result<Option<[Self; 2]>, Error> {
        if self.is_leaf() {
            return Ok(None);
        }
        let [first, second] = self.tile.halves();
        let narrowed = |tile| self.narrowed(stock, lines, tile, watch);
        let mut parts = [narrowed(first)?, narrowed(second)?];
        let open = |part: &Self| part.reaches.list.iter().filter(|reach| !reach.covers()).count();
        let counts = [open(&parts[0]), open(&parts[1])];
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, open(self), counts);
        Ok(Some(parts))
    }

    fn narrowed(
        &self,
        stock: &Stock<'_>,
        lines: &Lines<'_>,
        tile: Tile,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let around = |item: u32| stock.items[item as usize].around;
        let reaches = self.reaches.narrowed(lines, &tile.sides(), around, watch)?;
        Ok(Self { tile, reaches, in_vain: 0 })
    }

    /// Adds the pairs of the tile.
    fn leaf(
        &self,
        stock: &Stock<'_>,
        lines: &Lines<'_>,
        found: &mut Found,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let mut add = |below: u32, above: u32| add(found, Pair { below, above });
        // The last item that covers the tile, and those behind it so far, with what they cover.
        let mut cover: Option<u32> = None;
        let mut behind: Vec<(u32, Cell)> = Vec::new();
        for reach in &self.reaches.list {
            watch.work(CUT)?;
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
            let Some(cell) = whole.within(lines, halves, None, watch)? else { continue };
            if let Some(cover) = cover {
                add(item, cover)?;
            }
            let face = |item: u32| stock.face(item);
            for part in each(watch, CUT, &behind) {
                let (above, other) = part?;
                if face(*above) != face(item) && other.meets(lines, halves, watch)? {
                    add(item, *above)?;
                }
            }
            push(&mut behind, (item, cell))?;
        }
        Ok(())
    }
}
