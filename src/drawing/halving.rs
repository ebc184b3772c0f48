//! Halving the picture until its parts are simple, on all threads.

use std::ops::Range;

use super::reporter::finish_item;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};
use crate::parallel_map;

/// So often both halves of a part are offered to all threads; deeper, one goes on alone.
const SHARED: usize = 6;
/// To compare an item with a tile takes as long as a build takes to examine so many pieces.
pub(super) const NARROWED: usize = 8;
/// So does cutting a cell with an item.
pub(super) const CUT: usize = 64;
/// And making the lines of a piece.
pub(super) const LINES: usize = 64;
/// And visiting a node of a graph.
pub(super) const VISITED: usize = 4;

/// Halves a part again and again, until `halves` gives none, and lets `leaf` add what it finds there: to one
/// `new` thing for each of the parts that are shared out to threads. What is found, and in which order, does
/// not depend on how many threads there are. It is one phase of the operation that is watched.
pub(super) fn found_in<P: Send, F: Send>(
    all: P,
    new: impl Fn() -> F + Sync,
    halves: impl Fn(&P, &mut F) -> Result<Option<[P; 2]>, Error> + Sync,
    leaf: impl Fn(&P, &mut F) -> Result<(), Error> + Sync,
    watch: &Watch<'_>,
) -> Result<Vec<F>, Error> {
    shared(all, 0..1 << SHARED, &new, &halves, &leaf, watch)
}

/// What is found in a part that stands for these of the shares. Both halves of it are for whichever threads are
/// free: none waits until all parts of a size are halved.
fn shared<P: Send, F: Send>(
    part: P,
    shares: Range<usize>,
    new: &(impl Fn() -> F + Sync),
    halves: &(impl Fn(&P, &mut F) -> Result<Option<[P; 2]>, Error> + Sync),
    leaf: &(impl Fn(&P, &mut F) -> Result<(), Error> + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<F>, Error> {
    let parts = if shares.len() == 1 { None } else { halves(&part, &mut new())? };
    let Some([first, second]) = parts else {
        let found = alone(part, new(), halves, leaf)?;
        shares.for_each(|i| finish_item(watch, i, 1 << SHARED));
        return Ok(vec![found]);
    };
    drop(part);
    let middle = shares.start + shares.len() / 2;
    let parts = vec![(first, shares.start..middle), (second, middle..shares.end)];
    let found = |(part, shares)| shared(part, shares, new, halves, leaf, watch);
    let mut all = Vec::new();
    for mut part in parallel_map::map(parts, found)? {
        reserve(&mut all, part.len())?;
        all.append(&mut part);
    }
    Ok(all)
}

/// What one thread finds in a part.
fn alone<P, F>(
    part: P,
    mut found: F,
    halves: &impl Fn(&P, &mut F) -> Result<Option<[P; 2]>, Error>,
    leaf: &impl Fn(&P, &mut F) -> Result<(), Error>,
) -> Result<F, Error> {
    let mut stack = vec![part];
    while let Some(part) = stack.pop() {
        match halves(&part, &mut found)? {
            Some([first, second]) => {
                push(&mut stack, second)?;
                push(&mut stack, first)?;
            }
            None => leaf(&part, &mut found)?,
        }
    }
    Ok(found)
}
