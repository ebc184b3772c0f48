//! Which polygon shows above which.
//!
//! A polygon that is drawn whole has to come before each that shows where it would be painted too.
//! What is hidden by a third needs no order.

use std::collections::HashSet;
use std::hash::BuildHasherDefault;

use super::cell::are_apart;
use super::lines::Mixer;
use super::order::Pair;
use super::reaches::Reaches;
use super::stock::Stock;
use super::tile::{CUT, Leaf, NARROWED, Visible};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::reserve;
use crate::parallel_map;

/// Leaves with the faces that may reach into them.
struct Entry<'l> {
    leaves: &'l [Leaf],
    reaches: Reaches,
}

/// Leaves are shared out to threads after so many halvings of their list.
const SHARED: usize = 6;

/// All pairs, sorted. `place` gives the place of each face's polygon in the list of those that show, or
/// `u32::MAX`.
pub(super) fn pairs(
    stock: &Stock<'_>,
    leaves: &[Leaf],
    place: &(dyn Fn(u32) -> u32 + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    // Whole faces.
    let mut all = Reaches::default();
    for seen in (0..stock.seen.len() as u32).filter(|&seen| place(seen) != u32::MAX) {
        all.push(seen, stock.outline(seen).iter().copied())?;
    }
    let mut shares = vec![Entry { leaves, reaches: all }];
    for _ in 0..SHARED {
        let mut next = Vec::with_capacity(2 * shares.len());
        for entry in shares {
            match entry.halves(stock)? {
                Some(parts) => next.extend(parts),
                None => next.push(entry),
            }
        }
        shares = next;
    }
    watch.expect(shares.len())?;
    let parts = parallel_map::map(shares, |entry| {
        let pairs = pairs_of(stock, entry, place, watch);
        watch.finish(0);
        pairs
    });
    let mut pairs = Vec::new();
    for part in parts {
        let mut part = part?;
        reserve(&mut pairs, part.len())?;
        pairs.append(&mut part);
    }
    watch.end()?;
    pairs.sort_unstable();
    pairs.dedup();
    Ok(pairs)
}

fn pairs_of(
    stock: &Stock<'_>,
    entry: Entry<'_>,
    place: &(dyn Fn(u32) -> u32 + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let mut found: HashSet<Pair, BuildHasherDefault<Mixer>> = HashSet::default();
    let mut stack = vec![entry];
    while let Some(entry) = stack.pop() {
        watch.work(entry.reaches.list.len() * NARROWED)?;
        if let Some([first, second]) = entry.halves(stock)? {
            stack.push(second);
            stack.push(first);
            continue;
        }
        let Entry { leaves: [leaf], reaches } = &entry else { continue };
        for Visible { item, cell } in &leaf.cells {
            watch.work(reaches.list.len() * CUT)?;
            let above = place(stock.items[*item as usize].seen);
            let around = cell.region();
            for reach in &reaches.list {
                let pair = Pair { below: place(reach.number), above };
                let is_apart = are_apart(&around, &stock.seen[reach.number as usize].region);
                if is_apart || pair.below == above || found.contains(&pair) {
                    continue;
                }
                if cell.meets(&stock.lines, reaches.halves_of(reach))? {
                    found.try_reserve(1).map_err(|_| Error::out_of_memory())?;
                    found.insert(pair);
                }
            }
        }
    }
    Ok(found.into_iter().collect())
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
}

/// The box around leaves.
fn region(leaves: &[Leaf]) -> [[f64; 2]; 2] {
    let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    leaves.iter().fold(none, |[low, high], leaf| {
        let [from, to] = leaf.tile.sides();
        let axes = [0, 1];
        [axes.map(|i: usize| low[i].min(from[i])), axes.map(|i: usize| high[i].max(to[i]))]
    })
}
