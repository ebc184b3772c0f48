//! Which polygon shows above which.
//!
//! An opaque polygon that is drawn whole has to come before each opaque one that shows where it would be
//! painted too; a piece of a translucent one, before or after each that shows there, as they lie. What is
//! hidden by a third needs no order.

use super::halving::{CUT, NARROWED, found_in};
use super::pairs::{Found, Pair, add, sorted};
use super::reaches::Reaches;
use super::region::{Region, are_apart};
use super::stock::Stock;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::progress::Watch;

/// Leaves with the opaque faces that may reach into them, and the translucent items.
struct Entry<'l> {
    leaves: &'l [Leaf],
    reaches: Reaches,
    translucent: Reaches,
}

/// All pairs, sorted. `place` gives a number to each face's polygon, or `u32::MAX` if it does not show; in
/// pairs, opaque polygons have that, translucent items their own.
pub(super) fn pairs<'l>(
    stock: &Stock<'_>,
    leaves: &'l [Leaf],
    place: &(dyn Fn(u32) -> u32 + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let (mut reaches, mut translucent) = (Reaches::default(), Reaches::default());
    let shows = |seen: &u32| place(*seen) != u32::MAX;
    for seen in (0..stock.seen.len() as u32).filter(shows) {
        if stock.seen[seen as usize].is_opaque {
            reaches.push(seen, stock.outline(seen))?;
        }
    }
    for item in 0..stock.items.len() as u32 {
        if !stock.is_opaque(item) && shows(&stock.seen_of(item)) {
            translucent.push(item, stock.halves(item))?;
        }
    }
    let halves = |entry: &Entry<'l>| {
        watch.work((entry.reaches.list.len() + entry.translucent.list.len()) * NARROWED)?;
        entry.halves(stock)
    };
    let leaf = |entry: &Entry<'l>, found: &mut Found| entry.leaf(stock, place, found, watch);
    sorted(found_in(Entry { leaves, reaches, translucent }, halves, leaf, watch)?)
}

impl<'l> Entry<'l> {
    /// The first and the second half of the leaves; `None` of a single one.
    fn halves(&self, stock: &Stock<'_>) -> Result<Option<[Self; 2]>, Error> {
        if self.leaves.len() < 2 {
            return Ok(None);
        }
        let (first, second) = self.leaves.split_at(self.leaves.len() / 2);
        let part = |leaves: &'l [Leaf]| {
            let (lines, region) = (&stock.lines, region(leaves));
            let of_face = |seen: u32| stock.seen[seen as usize].region;
            let of_item = |item: u32| stock.items[item as usize].region;
            let reaches = self.reaches.narrowed(lines, &region, of_face)?;
            let translucent = self.translucent.narrowed(lines, &region, of_item)?;
            Ok(Self { leaves, reaches, translucent })
        };
        Ok(Some([part(first)?, part(second)?]))
    }

    /// Adds the pairs of a single leaf.
    fn leaf(
        &self,
        stock: &Stock<'_>,
        place: &(dyn Fn(u32) -> u32 + Sync),
        found: &mut Found,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let Self { leaves, reaches, .. } = self;
        for visible in leaves.iter().flat_map(|leaf| &leaf.cells) {
            let Visible { item, cell } = visible;
            if !self.translucent.list.is_empty() {
                self.add_blended(stock, place, visible, found, watch)?;
            }
            if !stock.is_opaque(*item) {
                continue;
            }
            watch.work(reaches.list.len() * CUT)?;
            let above = place(stock.seen_of(*item));
            let around = cell.region();
            for reach in &reaches.list {
                let pair = Pair { below: place(reach.number), above };
                let is_apart = are_apart(&around, &stock.seen[reach.number as usize].region);
                if is_apart || pair.below == above || found.contains(&pair) {
                    continue;
                }
                if cell.meets(&stock.lines, reaches.halves_of(reach))? {
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
        place: &(dyn Fn(u32) -> u32 + Sync),
        &Visible { item, ref cell }: &Visible,
        found: &mut Found,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        watch.work(self.translucent.list.len() * CUT)?;
        let (seen, is_opaque) = (stock.seen_of(item), stock.is_opaque(item));
        let own = if is_opaque { place(seen) } else { item };
        let around = cell.region();
        for reach in &self.translucent.list {
            let other = reach.number;
            let pair = match other < item {
                true => Pair { below: own, above: other },
                false if is_opaque => Pair { below: other, above: own },
                false => break,
            };
            let is_apart = are_apart(&around, &stock.items[other as usize].region);
            if is_apart || stock.seen_of(other) == seen || found.contains(&pair) {
                continue;
            }
            if cell.meets(&stock.lines, self.translucent.halves_of(reach))? {
                add(found, pair)?;
            }
        }
        Ok(())
    }
}

/// The box around leaves.
fn region(leaves: &[Leaf]) -> Region {
    let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    leaves.iter().fold(none, |[low, high], leaf| {
        let [from, to] = leaf.tile.sides();
        let axes = [0, 1];
        [axes.map(|i: usize| low[i].min(from[i])), axes.map(|i: usize| high[i].max(to[i]))]
    })
}
