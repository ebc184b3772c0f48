//! The progress and the cancellation of a build.

use std::fmt;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, TryLockError};

use crate::Error;

/// The number of pieces examined between two calls of the callback, about a millisecond of work. Too small:
/// time is spent on calls. Too large: cancelling takes longer.
pub(crate) const PULSE: usize = 1 << 16;
/// The number of pieces (or polygons, corners and edges while polygons are prepared) processed between two
/// polls for cancellation. Too small: polling takes time. Too large: cancelling takes longer.
pub(crate) const PIECES_AT_ONCE: usize = 4096;
/// A search for axis planes takes about as long as examining each piece this many times.
pub(crate) const SWEEP: usize = 10;

/// The amount that a finished face adds to `Watch::done`. A piece that was cut `n` times adds 2⁻ⁿ times this
/// amount, so all pieces of a face add up to one face.
const FACE: u64 = 1 << 32;

/// The progress of a build.
///
/// While polygons are read and prepared, `done` is 0 and `total` is the number of polygons read so far. After
/// that, `total` is the number of *faces*: polygons, where a triangulated polygon counts once for each
/// triangle. From then on, `total` does not change, and `done` never decreases. At the end `done` equals
/// `total`. (For the queries of a `VisibilityMap`, `done` and `total` count parts of the query's work.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// The number of faces stored in the tree so far. If only some [fragments](crate::Fragment) of a face are
    /// stored, the face counts as a fraction. The sum is rounded down.
    pub done: usize,
    /// The number of faces, or of polygons while polygons are read; 0 in the first call.
    pub total: usize,
}

/// Serialises calls to the callback, so that the progress that the callback sees never decreases.
///
/// A thread that finds the callback busy continues without calling it. Waiting could last forever: the
/// callback may be running in an outer call on this thread's own stack, and may itself wait for the thread
/// pool.
pub(crate) fn one_at_a_time(
    progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
) -> impl Fn(&Watch<'_>) -> ControlFlow<()> + Sync {
    let progress = Mutex::new(progress);
    move |watch| {
        let mut progress = match progress.try_lock() {
            Ok(progress) => progress,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return ControlFlow::Continue(()),
        };
        if watch.is_cancelled() {
            return ControlFlow::Break(());
        }
        // A panic cancels all work before another thread can call the callback.
        let flow = catch_unwind(AssertUnwindSafe(|| progress(watch.progress())));
        let flow = flow.unwrap_or_else(|panic| {
            watch.stop();
            resume_unwind(panic)
        });
        if flow.is_break() {
            watch.stop();
        }
        flow
    }
}

type Callback<'a> = &'a (dyn Fn(&Watch<'_>) -> ControlFlow<()> + Sync);

/// Shared by the jobs of a build: counts the jobs' work, calls the callback, and stops the jobs.
#[derive(Default)]
pub(crate) struct Watch<'a> {
    callback: Option<Callback<'a>>,
    total: AtomicUsize,
    /// The faces stored, in units of 1/`FACE`.
    done: AtomicU64,
    /// The number of pieces examined.
    work: AtomicUsize,
    cancelled: AtomicBool,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(callback: Callback<'a>) -> Self {
        Self { callback: Some(callback), ..Self::default() }
    }

    /// Sets the number of polygons or faces, and calls the callback.
    pub(crate) fn expect(&self, total: usize) -> Result<(), Error> {
        self.total.store(total, Ordering::Relaxed);
        self.call()
    }

    /// Counts pieces that are about to be examined; an error if the build was cancelled.
    #[inline]
    pub(crate) fn work(&self, pieces: usize) -> Result<(), Error> {
        if self.is_cancelled() {
            return Err(Error::cancelled());
        }
        if self.callback.is_none() || pieces == 0 {
            // All threads share the counter, so avoid writing to it.
            return Ok(());
        }
        let before = self.work.fetch_add(pieces, Ordering::Relaxed);
        if before / PULSE == before.wrapping_add(pieces) / PULSE { Ok(()) } else { self.call() }
    }

    /// Counts a piece that has been stored in the tree after `cuts` cuts.
    #[inline]
    pub(crate) fn finish(&self, cuts: u8) {
        if self.callback.is_some() {
            let share = FACE.checked_shr(cuts.into()).unwrap_or(0);
            self.done.fetch_add(share, Ordering::Relaxed);
        }
    }

    /// Reports the end of the build.
    pub(crate) fn end(&self) -> Result<(), Error> {
        // Shares of pieces cut more than 32 times were rounded to 0, so the sum may be too small.
        let total = self.total.load(Ordering::Relaxed) as u64;
        self.done.store(total * FACE, Ordering::Relaxed);
        self.call()
    }

    fn call(&self) -> Result<(), Error> {
        match self.callback.map(|callback| callback(self)) {
            Some(ControlFlow::Break(())) => Err(Error::cancelled()),
            _ => Ok(()),
        }
    }

    /// Makes all further work fail, as after a cancellation.
    pub(crate) fn stop(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// The amount of work counted.
    #[cfg(test)]
    pub(crate) fn examined(&self) -> usize {
        self.work.load(Ordering::Relaxed)
    }

    fn progress(&self) -> Progress {
        let done = (self.done.load(Ordering::Relaxed) / FACE) as usize;
        Progress { done, total: self.total.load(Ordering::Relaxed) }
    }
}

impl fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Watch").field("total", &self.total).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::{
        AssertUnwindSafe, ControlFlow, Mutex, Progress, Watch, catch_unwind, one_at_a_time,
    };
    use crate::{BuildOptions, Heuristic};

    #[test]
    fn the_callback_is_not_called_again_after_it_cancelled() {
        let calls = Mutex::new(0);
        let callback = one_at_a_time(|_| {
            *calls.lock().unwrap() += 1;
            ControlFlow::Break(())
        });
        let watch = Watch::new(&callback);
        assert!(watch.work(1).is_ok() && watch.expect(5).is_err());
        assert!(watch.work(1).is_err() && watch.expect(5).is_err() && watch.end().is_err());
        assert_eq!(*calls.lock().unwrap(), 1);
    }

    #[test]
    fn a_panic_of_the_callback_cancels_all_other_work() {
        let callback = one_at_a_time(|_| panic!("the caller's fault"));
        let watch = Watch::new(&callback);
        assert!(watch.work(1).is_ok());
        assert!(catch_unwind(AssertUnwindSafe(|| watch.expect(5))).is_err());
        assert!(
            watch.work(1).is_err_and(|error| error.kind() == crate::ErrorKind::Cancelled)
                && watch.end().is_err()
        );
    }

    #[test]
    fn pieces_whose_share_is_rounded_to_0_are_done_at_the_end() {
        let heard = Mutex::new(vec![]);
        let callback = one_at_a_time(|progress| {
            heard.lock().unwrap().push(progress);
            ControlFlow::Continue(())
        });
        let watch = Watch::new(&callback);
        watch.expect(2).unwrap();
        [0, 1, 2, 200].into_iter().for_each(|cuts| watch.finish(cuts));
        watch.expect(2).unwrap();
        watch.end().unwrap();
        let expected = [0, 1, 2].map(|done| Progress { done, total: 2 });
        assert_eq!(*heard.lock().unwrap(), expected);
    }

    /// With `Heuristic::First`, layers become a list of nodes, and each node examines all remaining layers.
    #[test]
    fn a_pass_over_a_set_counts_as_work_even_if_it_cuts_nothing() {
        let layers = (0..2000)
            .map(|z| [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| [x, y, f64::from(z)]));
        let mut calls = 0;
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        let tree = options.build_with_progress(layers, |_| {
            calls += 1;
            ControlFlow::Continue(())
        });
        assert_eq!(tree.unwrap().stats().nodes, 1999);
        assert!(calls >= 1999 * 1000 / super::PULSE, "{calls}");
    }

    #[test]
    fn at_the_end_a_triangulated_polygon_counts_as_several_faces() {
        let corner = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let polygon = corner.map(|[x, y]| [x, y, 0.0]);
        let mut last = None;
        let tree = BuildOptions::DEFAULT.build_with_progress([polygon], |progress| {
            last = Some(progress);
            ControlFlow::Continue(())
        });
        assert_eq!(tree.unwrap().len(), 4);
        assert_eq!(last, Some(Progress { done: 4, total: 4 }));
        // Pieces also count against the budget, before any piece is cut.
        let build = |most| BuildOptions::DEFAULT.with_max_fragments(most).build([polygon]);
        assert!(build(4).is_ok() && build(3).unwrap_err().kind() == crate::ErrorKind::OverBudget);
    }
}
