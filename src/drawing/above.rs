//! Which polygon shows above which.
//!
//! A polygon that is drawn whole has to come before each that shows where it would be painted too.
//! What is hidden by a third needs no order.

use super::halving::{CUT, NARROWED, found_in};
use super::pairs::{Found, Pair, add, sorted};
use super::reaches::Reaches;
use super::region::{Region, are_apart};
use super::stock::Stock;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::progress::Watch;

/// Leaves with the faces that may reach into them.
struct Entry<'l> {
    leaves: &'l [Leaf],
    reaches: Reaches,
}

/// All pairs, sorted. `place` gives the place of each face's polygon in the list of those that show, or
/// `u32::MAX`.
pub(super) fn pairs<'l>(
    stock: &Stock<'_>,
    leaves: &'l [Leaf],
    place: &(dyn Fn(u32) -> u32 + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    // Whole faces.
    let mut all = Reaches::default();
    for seen in (0..stock.seen.len() as u32).filter(|&seen| place(seen) != u32::MAX) {
        all.push(seen, stock.outline(seen))?;
    }
    let halves = |entry: &Entry<'l>| {
        watch.work(entry.reaches.list.len() * NARROWED)?;
        entry.halves(stock)
    };
    let leaf = |entry: &Entry<'l>, found: &mut Found| entry.leaf(stock, place, found, watch);
    sorted(found_in(Entry { leaves, reaches: all }, halves, leaf, watch)?)
}

impl<'l> Entry<'l> {
    /// The first and the second half of the leaves; `None` of a single one.
    fn halves(&self, stock: &Stock<'_>) -> Result<Option<[Self; 2]>, Error> {
        if self.leaves.len() < 2 {
            return Ok(None);
        }
        let (first, second) = self.leaves.split_at(self.leaves.len() / 2);
        let part = |leaves: &'l [Leaf]| {
            let around = |seen: u32| stock.seen[seen as usize].region;
            let reaches = self.reaches.narrowed(&stock.lines, &region(leaves), around)?;
            Ok(Self { leaves, reaches })
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
        let Self { leaves, reaches } = self;
        for Visible { item, cell } in leaves.iter().flat_map(|leaf| &leaf.cells) {
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
}

/// The box around leaves.
pub(super) fn region(leaves: &[Leaf]) -> Region {
    let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    leaves.iter().fold(none, |[low, high], leaf| {
        let [from, to] = leaf.tile.sides();
        let axes = [0, 1];
        [axes.map(|i: usize| low[i].min(from[i])), axes.map(|i: usize| high[i].max(to[i]))]
    })
}
