//! Progress of what a map is asked for, and its cancellation.

use std::cmp::Ordering;
use std::fmt;
use std::ops::ControlFlow;

use crate::Error;
use crate::build::Progress;
use crate::build::progress::{Watch, one_at_a_time};

/// Each phase of an operation has so many parts.
const PARTS: usize = 64;
/// Loops look for cancellation each time they have worked as long as a build takes to examine so many pieces: a
/// tenth of a millisecond.
const STRETCH: usize = 1 << 12;
/// To sort a list takes, for each of its items, as long as a build takes to examine so many pieces.
const SORTED: usize = 6;

type Report<'c> = dyn Fn(&Watch<'_>) -> ControlFlow<()> + Send + Sync + 'c;

/// Tells a callback how far operations are, each from its beginning to its end, and lets it cancel them; or
/// tells nobody.
#[derive(Default)]
pub(super) struct Reporter<'c>(Option<Box<Report<'c>>>);

impl<'c> Reporter<'c> {
    pub(super) fn new(progress: impl FnMut(Progress) -> ControlFlow<()> + Send + 'c) -> Self {
        Self(Some(Box::new(one_at_a_time(progress))))
    }

    /// Does an operation of so many phases. Only its end is the end of the last part.
    pub(super) fn watch<T>(
        &self,
        phases: usize,
        operation: impl FnOnce(&Watch<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let watch = match &self.0 {
            Some(callback) => Watch::new(&**callback),
            None => Watch::default(),
        };
        watch.expect(phases * PARTS + 1)?;
        let result = operation(&watch)?;
        watch.end()?;
        Ok(result)
    }
}

impl fmt::Debug for Reporter<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = if self.0.is_some() { "Reporter(callback)" } else { "Reporter(nobody)" };
        f.write_str(name)
    }
}

/// Counts item `i` of the `n` items of a phase as done.
pub(super) fn finish_item(watch: &Watch<'_>, i: usize, n: usize) {
    for _ in i * PARTS / n..(i + 1) * PARTS / n {
        watch.finish(0);
    }
}

/// The items of a loop that hears cancellation; each takes as long as a build takes to examine so many pieces.
pub(super) fn each<T>(
    watch: &Watch<'_>,
    pieces: usize,
    items: impl IntoIterator<Item = T>,
) -> impl Iterator<Item = Result<T, Error>> {
    let mut items = items.into_iter();
    let mut done = Done { watch, work: 0 };
    std::iter::from_fn(move || {
        let item = items.next();
        done.work += pieces;
        if done.work >= STRETCH || item.is_none() {
            return done.tell().err().map(Err).or(item.map(Ok));
        }
        item.map(Ok)
    })
}

/// Work that is done and not yet counted. It is counted too where a loop is left early.
struct Done<'w, 'c> {
    watch: &'w Watch<'c>,
    work: usize,
}

impl Done<'_, '_> {
    fn tell(&mut self) -> Result<(), Error> {
        self.watch.work(std::mem::take(&mut self.work))
    }
}

impl Drop for Done<'_, '_> {
    fn drop(&mut self) {
        // If it was cancelled, the next one to ask hears it.
        let _ = self.tell();
    }
}

/// Sorts a list, stably, unless it was cancelled before.
pub(super) fn sort_by<T>(
    list: &mut [T],
    watch: &Watch<'_>,
    compare: impl Fn(&T, &T) -> Ordering,
) -> Result<(), Error> {
    watch.work(list.len() * SORTED)?;
    list.sort_by(compare);
    Ok(())
}

/// Sorts a list and keeps one of those that are equal.
pub(super) fn sort_unique<T: Ord>(list: &mut Vec<T>, watch: &Watch<'_>) -> Result<(), Error> {
    sort_by(list, watch, T::cmp)?;
    watch.work(list.len())?;
    list.dedup();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Calls the callback at each step and cancels at one: nothing more is done.
    #[test]
    fn loops_and_sorts_end_where_they_are_cancelled() {
        for calls in 1..8 {
            let mut left = calls;
            let reporter = Reporter::new(|_| {
                left -= 1;
                if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            let mut done = 0;
            let result = reporter.watch(1, |watch| {
                let mut list: Vec<u32> = (0..1 << 17).rev().collect();
                for item in each(watch, 1, 0..1 << 18) {
                    item?;
                    done += 1;
                }
                sort_by(&mut list, watch, u32::cmp)
            });
            assert!(result.unwrap_err().is_cancelled());
            drop(reporter);
            assert_eq!(left, 0);
            assert!(done <= (calls - 1) << 16, "{done} by call {calls}");
        }
    }

    #[test]
    fn all_parts_of_a_phase_are_done_in_the_end() {
        for n in [1, 2, 3, 63, 64, 65, 1000] {
            let mut last = None;
            let reporter = Reporter::new(|progress: Progress| {
                last = Some([progress.done, progress.total]);
                ControlFlow::Continue(())
            });
            let phase = |watch: &Watch<'_>| {
                (0..n).for_each(|i| finish_item(watch, i, n));
                watch.work(1 << 16)?;
                Err::<(), _>(Error::cancelled())
            };
            reporter.watch(2, phase).unwrap_err();
            drop(reporter);
            assert_eq!(last, Some([PARTS, 2 * PARTS + 1]), "{n}");
        }
    }
}
