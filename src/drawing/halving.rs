//! Halving the picture until its parts are simple, on all threads.

use super::reporter::finish_item;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::push;
use crate::parallel_map;

/// The picture is halved so often before its parts are shared out to threads.
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
    let mut shares = vec![all];
    for _ in 0..SHARED {
        let mut next = Vec::with_capacity(2 * shares.len());
        for parts in parallel_map::map(shares, |part| Ok((halves(&part, &mut new())?, part))) {
            match parts? {
                (Some(parts), _) => next.extend(parts),
                (None, part) => next.push(part),
            }
        }
        shares = next;
    }
    let count = shares.len();
    let found = parallel_map::map(shares.into_iter().enumerate().collect(), |(i, share)| {
        let (mut found, mut stack) = (new(), vec![share]);
        while let Some(part) = stack.pop() {
            match halves(&part, &mut found)? {
                Some([first, second]) => {
                    push(&mut stack, second)?;
                    push(&mut stack, first)?;
                }
                None => leaf(&part, &mut found)?,
            }
        }
        finish_item(watch, i, count);
        Ok(found)
    });
    found.into_iter().collect()
}
