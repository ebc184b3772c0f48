//! Tiles divided into parts of which each shows the same items.

use smallvec::SmallVec;

use super::cell::Cell;
use super::half::Half;
use super::halving::{CUT, VISITED};
use super::lines::Lines;
use super::map::VisibilityMap;
use super::rect::{Rect, are_apart};
use super::reporter::{each, finish_item};
use super::stock::Stock;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};

/// A tile in convex parts.
pub(super) struct Divided {
    pub(super) cells: Vec<LayeredCell>,
    /// Each comes after the one in front of it. The first is of no item.
    pub(super) layers: Vec<ItemLayer>,
}

/// A convex part: all of it shows the same items.
pub(super) struct LayeredCell {
    pub(super) cell: Cell,
    around: Rect,
    /// The last of its layers; the first one of all, of no item, if nothing shows.
    pub(super) layer: u32,
}

/// An item that shows, and what is in front of it. Cells have them in common, so that they take no more memory
/// where many items lie over one another.
pub(super) struct ItemLayer {
    pub(super) item: u32,
    pub(super) before: u32,
    /// The newest of those that have this one before them.
    newest: u32,
}

impl Divided {
    /// What is visible in a tile is laid over what was there, front to back.
    pub(super) fn new(
        leaf: &Leaf,
        stock: &Stock<'_>,
        lines: &Lines<'_>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let none = ItemLayer { item: u32::MAX, before: 0, newest: 0 };
        let mut divided = Self { cells: vec![], layers: vec![none] };
        if is_opaque(leaf, stock) {
            for visible in each(watch, CUT, &leaf.cells) {
                let Visible { item, cell } = visible?;
                let layer = divided.behind(0, *item)?;
                push(&mut divided.cells, LayeredCell::new(cell.clone(), layer))?;
            }
            return Ok(divided);
        }
        let tile = Cell::rectangle(lines, leaf.tile.low, leaf.tile.high);
        let mut open = vec![LayeredCell::new(tile, 0)];
        let (mut left, mut outside) = (Vec::new(), Vec::new());
        for Visible { item, cell } in &leaf.cells {
            watch.work(CUT)?;
            let halves: SmallVec<[Half; 8]> = cell.sides.iter().map(|side| side.half).collect();
            let around = cell.around();
            let mut i = 0;
            while let Some(part) = open.get(i) {
                watch.work(VISITED)?;
                let common = match are_apart(&part.around, &around) {
                    true => None,
                    false => part.cell.within(lines, &halves, Some(&mut outside), watch)?,
                };
                let Some(common) = common else {
                    outside.clear();
                    i += 1;
                    continue;
                };
                watch.work(CUT)?;
                let LayeredCell { layer, .. } = open.swap_remove(i);
                reserve(&mut left, outside.len() + 1)?;
                left.extend(outside.drain(..).map(|cell| LayeredCell::new(cell, layer)));
                let behind = LayeredCell::new(common, divided.behind(layer, *item)?);
                push(if stock.is_opaque(*item) { &mut divided.cells } else { &mut left }, behind)?;
            }
            reserve(&mut open, left.len())?;
            open.append(&mut left);
        }
        open.retain(|part| part.layer != 0);
        reserve(&mut divided.cells, open.len())?;
        divided.cells.append(&mut open);
        Ok(divided)
    }

    /// The layer of an item behind another layer.
    fn behind(&mut self, before: u32, item: u32) -> Result<u32, Error> {
        let newest = self.layers[before as usize].newest;
        if newest != 0 && self.layers[newest as usize].item == item {
            return Ok(newest);
        }
        let layer = self.layers.len() as u32;
        push(&mut self.layers, ItemLayer { item, before, newest: 0 })?;
        self.layers[before as usize].newest = layer;
        Ok(layer)
    }

    /// The items that show in a part, back to front.
    fn items(&self, part: &LayeredCell) -> impl Iterator<Item = u32> {
        let at = |layer: u32| (layer != 0).then(|| &self.layers[layer as usize]);
        std::iter::successors(at(part.layer), move |layer| at(layer.before)).map(|layer| layer.item)
    }
}

impl VisibilityMap<'_> {
    /// Calls a function with each convex part of the picture, once for each item that shows there: a phase.
    pub(super) fn for_each_part(
        &self,
        mut see: impl FnMut(u32, &Cell) -> Result<(), Error>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let count = self.leaves.len();
        for (i, leaf) in self.leaves.iter().enumerate() {
            if is_opaque(leaf, &self.stock) {
                for visible in each(watch, CUT, &leaf.cells) {
                    let Visible { item, cell } = visible?;
                    see(*item, cell)?;
                }
            } else {
                let divided = Divided::new(leaf, &self.stock, &self.rims.lines, watch)?;
                for part in &divided.cells {
                    for item in each(watch, CUT, divided.items(part)) {
                        see(item?, &part.cell)?;
                    }
                }
            }
            finish_item(watch, i, count);
        }
        Ok(())
    }
}

impl LayeredCell {
    fn new(cell: Cell, layer: u32) -> Self {
        Self { around: cell.around(), cell, layer }
    }
}

/// Whether nothing shows through anything in a tile.
fn is_opaque(leaf: &Leaf, stock: &Stock<'_>) -> bool {
    leaf.cells.iter().all(|visible| stock.is_opaque(visible.item))
}
