//! Builds with callbacks, cancelled by their caller, or limited by a budget.

use super::super::super::dice::Dice;
use super::super::super::judge::{Verdict, ensure};
use super::super::super::snapshot::Snapshot;
use super::{Base, pools};
use binspace::glam::DVec3;
use binspace::{BspTree, BuildOptions, Error, ErrorKind, Progress};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A build, its reports, and the number of polygons that it read after it was cancelled.
pub(super) struct Watched {
    pub(super) result: Result<BspTree, Error>,
    pub(super) heard: Vec<Progress>,
    read_late: usize,
}

/// Builds by this many threads, and cancels at a call.
pub(super) fn watch(
    options: &BuildOptions,
    polygons: &[Vec<DVec3>],
    stop: usize,
    threads: usize,
) -> Watched {
    let mut heard = Vec::new();
    let (stopped, read_late) = (AtomicBool::new(false), AtomicUsize::new(0));
    let read = polygons.iter().inspect(|_| {
        read_late.fetch_add(usize::from(stopped.load(Ordering::Relaxed)), Ordering::Relaxed);
    });
    let result = pools::with_threads(threads, || {
        options.build_with_progress(read, |progress| {
            heard.push(progress);
            if heard.len() < stop {
                return ControlFlow::Continue(());
            }
            stopped.store(true, Ordering::Relaxed);
            ControlFlow::Break(())
        })
    });
    Watched { result, heard, read_late: read_late.into_inner() }
}

/// Checks that progress counts first the polygons and then the faces, that `done` never decreases, and that
/// it equals the total at the end.
pub(super) fn progress(heard: &[Progress], faces: usize) -> Verdict {
    let pairs = || heard.windows(2).map(|pair| (pair[0], pair[1]));
    let done = pairs().all(|(before, after)| before.done <= after.done);
    let first = heard.iter().position(|progress| progress.done > 0).unwrap_or(heard.len());
    let total = heard[first..].iter().all(|progress| progress.total == faces);
    let within = heard.iter().all(|progress| progress.done <= progress.total);
    let end = heard.last().is_some_and(|last| (last.done, last.total) == (faces, faces));
    ensure(done && total && within && end, || format!("of {faces} faces: {heard:?}"))
}

impl Base<'_> {
    /// Checks that a cancelled build returns `Cancelled`, and neither reports nor reads more.
    pub(super) fn cancel(&self, dice: &mut Dice) -> Verdict {
        for threads in [1, 1 + dice.below(pools::MOST_THREADS)] {
            let stop = match dice.below(4) {
                0 => self.heard.len(),
                1 => 1 + dice.below(4.min(self.heard.len())),
                _ => 1 + dice.below(self.heard.len()),
            };
            let cut = watch(&self.options, self.polygons, stop, threads);
            let what = || format!("cancelled at call {stop} of {threads} threads, {:?}", cut.heard);
            ensure(cut.heard.len() <= stop && cut.read_late == 0, what)?;
            match &cut.result {
                Err(error) => {
                    let only = error.kind() == ErrorKind::Cancelled;
                    ensure(only && cut.heard.len() == stop, || format!("{error}, {}", what()))?;
                }
                // Several threads may pass two marks together, and then make one call less.
                Ok(tree) => {
                    ensure(threads > 1 && cut.heard.len() < stop, what)?;
                    ensure(Snapshot::of(tree) == Snapshot::of(self.tree), what)?;
                }
            }
        }
        Ok(())
    }

    /// Checks that a budget ends in an error exactly if the tree without a budget exceeds it.
    pub(super) fn budgets(&self, dice: &mut Dice) -> Verdict {
        let depth = self.tree.stats().depth_max;
        let fragments = self.tree.len().max(self.polygons.len());
        for (needed, with) in [
            (fragments, BuildOptions::with_max_fragments as fn(BuildOptions, usize) -> _),
            (depth, BuildOptions::with_max_depth),
        ] {
            for limit in [needed, needed.saturating_sub(1), dice.below(needed + 1)] {
                self.budget(with(self.options.clone(), limit), limit, needed, dice)?;
            }
        }
        Ok(())
    }

    fn budget(
        &self,
        options: BuildOptions,
        limit: usize,
        needed: usize,
        dice: &mut Dice,
    ) -> Verdict {
        let threads = 1 + dice.below(pools::MOST_THREADS);
        let what = || format!("{threads} threads, {needed} of {options:?}");
        match pools::with_threads(threads, || options.build(self.polygons)) {
            Ok(tree) => {
                ensure(limit >= needed, what)?;
                ensure(Snapshot::of(&tree) == Snapshot::of(self.tree), what)
            }
            Err(error) => {
                let says = error.kind() == ErrorKind::OverBudget
                    && error.to_string().contains(&limit.to_string());
                ensure(says && limit < needed, || format!("{error}: {}", what()))
            }
        }
    }
}
