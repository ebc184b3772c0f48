//! How far a build has come, and whether it is to go on.

use std::fmt;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::Error;

/// The callback hears from a build each time about so many pieces more have been looked at, which
/// is a millisecond's work. Smaller: time spent on calls; larger: it takes longer to cancel.
const PULSE: usize = 1 << 16;

/// A face that is in the tree with all its fragments. A piece of it that was cut `n` times counts
/// for 2⁻ⁿ of that.
const FACE: u64 = 1 << 32;

/// How far a build has come.
///
/// In one build `done` never falls and `total` stays the same, but for the start: while polygons
/// are read and prepared, `done` is 0 and `total` the number of polygons so far. At the end both
/// are the number of faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// How many faces are in the tree with all their fragments, halves and quarters added up.
    pub done: usize,
    /// How many faces there are.
    pub total: usize,
}

/// Lets a function of one thread hear from all: one at a time, so that what it hears never falls.
pub(super) fn one_at_a_time(
    progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
) -> impl Fn(&Watch<'_>) -> ControlFlow<()> + Sync {
    let progress = Mutex::new(progress);
    move |watch| {
        let mut progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
        // It may have broken off while this thread waited.
        if watch.is_cancelled() {
            return ControlFlow::Break(());
        }
        let flow = progress(watch.progress());
        if flow.is_break() {
            watch.cancelled.store(true, Ordering::Relaxed);
        }
        flow
    }
}

type Callback<'a> = &'a (dyn Fn(&Watch<'_>) -> ControlFlow<()> + Sync);

/// What the jobs of a build tell their caller, and hear from it.
#[derive(Default)]
pub(super) struct Watch<'a> {
    callback: Option<Callback<'a>>,
    total: AtomicUsize,
    /// In units of 1/`FACE`.
    done: AtomicU64,
    /// How many pieces have been looked at.
    work: AtomicUsize,
    cancelled: AtomicBool,
}

impl<'a> Watch<'a> {
    pub(super) fn new(callback: Callback<'a>) -> Self {
        Self { callback: Some(callback), ..Self::default() }
    }

    /// Says that there are so many polygons, or faces.
    pub(super) fn expect(&self, total: usize) -> Result<(), Error> {
        self.total.store(total, Ordering::Relaxed);
        self.call()
    }

    /// Counts pieces that are looked at; an error if the build is to stop.
    #[inline]
    pub(super) fn work(&self, pieces: usize) -> Result<(), Error> {
        if self.callback.is_none() {
            return Ok(());
        }
        if self.is_cancelled() {
            return Err(Error::cancelled());
        }
        let before = self.work.fetch_add(pieces, Ordering::Relaxed);
        if before / PULSE == before.wrapping_add(pieces) / PULSE { Ok(()) } else { self.call() }
    }

    /// Counts a piece that is in the tree, after so many cuts.
    #[inline]
    pub(super) fn finish(&self, cuts: u8) {
        if self.callback.is_some() {
            let share = FACE.checked_shr(cuts.into()).unwrap_or(0);
            self.done.fetch_add(share, Ordering::Relaxed);
        }
    }

    /// Says that the tree is complete.
    pub(super) fn end(&self) -> Result<(), Error> {
        // Pieces cut more than 32 times counted for nothing.
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

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
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
