//! Which polygon shows above which.
//!
//! An opaque polygon that is drawn whole has to come before each opaque one that shows where it would be
//! painted too; a piece of a translucent one, before or after each that shows there, as they lie. What is
//! hidden by a third needs no order.

use super::halving::{CUT, VISITED, found_in};
use super::lines::Lines;
use super::pairs::{Found, Pair, add, sorted};
use super::reaches::{Reach, Reaches};
use super::rect::{NOWHERE, Rect, are_apart};
use super::reporter::each;
use super::rims::Rims;
use super::stock::{FEW_CORNERS, Stock};
use super::tile::Tile;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, push, reserve};

/// Leaves with the opaque faces that may reach into them, and the translucent items.
struct LeafReaches<'l> {
    leaves: &'l [Leaf],
    reaches: Reaches,
    translucent: Reaches,
}

/// All pairs, sorted. `place` gives a number to each face's polygon, or `u32::MAX` if it does not show; in
/// pairs, opaque polygons have that, translucent items their own.
pub(super) fn pairs<'l>(
    stock: &Stock<'_>,
    rims: &Rims<'_>,
    leaves: &'l [Leaf],
    place: &(dyn Fn(u32) -> u32 + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let (mut reaches, mut translucent) = (Reaches::default(), Reaches::default());
    let shows = |face: &u32| place(*face) != u32::MAX;
    for face in each(watch, 2, 0..stock.views.len() as u32) {
        let face = face?;
        if !shows(&face) {
            continue;
        }
        if stock.views[face as usize].is_opaque {
            reaches.push(face, rims.known_outline(face))?;
        }
    }
    for item in each(watch, 2, 0..stock.items.len() as u32) {
        let item = item?;
        if !stock.is_opaque(item) && shows(&stock.face(item)) {
            translucent.push(item, rims.known_item(stock, item))?;
        }
    }
    let halves = |part: &LeafReaches<'l>, _: &mut Found| part.halves(stock, &rims.lines, watch);
    let leaf =
        |part: &LeafReaches<'l>, found: &mut Found| part.leaf(stock, rims, place, found, watch);
    let all = LeafReaches { leaves, reaches, translucent };
    sorted(found_in(all, Found::default, halves, leaf, watch)?, watch)
}

impl<'l> LeafReaches<'l> {
    /// The first and the second half of the leaves; `None` of a single one.
    fn halves(
        &self,
        stock: &Stock<'_>,
        lines: &Lines<'_>,
        watch: &Watch<'_>,
    ) -> Result<Option<[Self; 2]>, Error> {
        if self.leaves.len() < 2 {
            return Ok(None);
        }
        let (first, second) = self.leaves.split_at(self.leaves.len() / 2);
        let part = |leaves: &'l [Leaf]| {
            let around = around(leaves);
            let of_face = |face: u32| stock.views[face as usize].around;
            let of_item = |item: u32| stock.items[item as usize].around;
            let reaches = self.reaches.narrowed(lines, &around, of_face, watch)?;
            let translucent = self.translucent.narrowed(lines, &around, of_item, watch)?;
            Ok(Self { leaves, reaches, translucent })
        };
        Ok(Some([part(first)?, part(second)?]))
    }

    /// Adds the pairs of a single leaf.
    fn leaf(
        &self,
        stock: &Stock<'_>,
        rims: &Rims<'_>,
        place: &(dyn Fn(u32) -> u32 + Sync),
        found: &mut Found,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let Self { leaves, reaches, .. } = self;
        // Nothing opaque shows above a face of which all shows that is in the tile.
        let cells = || leaves.iter().flat_map(|leaf| &leaf.cells);
        let mut whole: Vec<u32> = Vec::new();
        for Leaf { tile, cells } in *leaves {
            for visible in each(watch, VISITED, cells) {
                let visible = visible?;
                let face = stock.face(visible.item);
                watch.work(stock.edges_work(face))?;
                if is_whole(stock, rims, tile, visible)? {
                    push(&mut whole, face)?;
                }
            }
        }
        whole.sort_unstable();
        let mut below: Vec<Reach> = Vec::new();
        reserve(&mut below, reaches.list.len())?;
        let is_below = |reach: &&Reach| whole.binary_search(&reach.number).is_err();
        below.extend(reaches.list.iter().filter(is_below));
        for visible in cells() {
            let Visible { item, cell } = visible;
            if !self.translucent.list.is_empty() {
                self.add_blended(stock, rims, place, visible, found, watch)?;
            }
            if !stock.is_opaque(*item) {
                continue;
            }
            let above = place(stock.face(*item));
            let around = cell.around();
            for reach in each(watch, CUT, &below) {
                let reach = reach?;
                let pair = Pair { below: place(reach.number), above };
                let is_apart = are_apart(&around, &stock.views[reach.number as usize].around);
                if is_apart || pair.below == above || found.contains(&pair) {
                    continue;
                }
                if cell.meets(&rims.lines, reaches.halves_of(reach), watch)? {
                    add(found, pair)?;
                }
            }
        }
        Ok(())
    }

    /// Adds the pairs of what is visible with translucent items. What is visible of two of these needs one
    /// pair, that of the one behind.
    fn add_blended(
        &self,
        stock: &Stock<'_>,
        rims: &Rims<'_>,
        place: &(dyn Fn(u32) -> u32 + Sync),
        &Visible { item, ref cell }: &Visible,
        found: &mut Found,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let (face, is_opaque) = (stock.face(item), stock.is_opaque(item));
        let own = if is_opaque { place(face) } else { item };
        let around = cell.around();
        for reach in each(watch, CUT, &self.translucent.list) {
            let reach = reach?;
            let other = reach.number;
            let pair = match other < item {
                true => Pair { below: own, above: other },
                false if is_opaque => Pair { below: other, above: own },
                false => break,
            };
            let is_apart = are_apart(&around, &stock.items[other as usize].around);
            if is_apart || stock.face(other) == face || found.contains(&pair) {
                continue;
            }
            if cell.meets(&rims.lines, self.translucent.halves_of(reach), watch)? {
                add(found, pair)?;
            }
        }
        Ok(())
    }
}

/// Whether all of a face that is in a tile is one cell: borders of the tile and edges of its own bound it.
fn is_whole(
    stock: &Stock<'_>,
    rims: &Rims<'_>,
    tile: &Tile,
    visible: &Visible,
) -> Result<bool, Error> {
    let outline = rims.known_outline(stock.face(visible.item));
    let sides = visible.cell.sides.iter().map(|side| side.half);
    // Edges of others may lie where tiles elsewhere have borders.
    let mut sides = sides.filter(|half| !tile.has_border(*half));
    // Of most faces, to look at all edges is quicker.
    if outline.len() <= FEW_CORNERS {
        return Ok(sides.all(|side| outline.iter().any(|half| half.line() == side.line())));
    }
    let mut own = collect(outline.iter().map(|half| half.line()))?;
    own.sort_unstable();
    Ok(sides.all(|side| own.binary_search(&side.line()).is_ok()))
}

/// The box around leaves.
pub(super) fn around(leaves: &[Leaf]) -> Rect {
    leaves.iter().fold(NOWHERE, |[low, high], leaf| {
        let [from, to] = leaf.tile.sides();
        let axes = [0, 1];
        [axes.map(|i: usize| low[i].min(from[i])), axes.map(|i: usize| high[i].max(to[i]))]
    })
}
