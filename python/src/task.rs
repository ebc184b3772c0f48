//! Long operations: the interpreter is released, Ctrl-C and a progress callback can cancel, and errors of the library
//! become exceptions.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use binspace::{Error, ErrorKind, Progress};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The interval at which the calling thread handles signals and calls the callback. Too small: this thread
/// takes the interpreter from other threads. Too large: Ctrl-C takes effect late.
const PULSE: Duration = Duration::from_millis(20);

/// The progress of an operation, and whether the operation is cancelled. The calling thread and the workers
/// share a watch.
#[derive(Default)]
pub(crate) struct Watch {
    done: AtomicUsize,
    total: AtomicUsize,
    is_cancelled: AtomicBool,
}

impl Watch {
    pub(crate) fn report(&self, progress: Progress) -> ControlFlow<()> {
        self.done.store(progress.done, Ordering::Relaxed);
        self.total.store(progress.total, Ordering::Relaxed);
        match self.is_cancelled.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Lets signal handlers and the callback run.
    fn pulse(&self, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        Python::attach(|py| {
            py.check_signals()?;
            if let Some(progress) = progress {
                let [done, total] = [&self.done, &self.total].map(|n| n.load(Ordering::Relaxed));
                progress.call1(py, (done, total))?;
            }
            Ok(())
        })
    }
}

/// Lets the operations of a visibility map run one after the other. A map has only one callback, which
/// reports to the watch of the current operation.
#[derive(Default)]
pub(crate) struct Turns {
    turn: Mutex<()>,
    watch: Mutex<Arc<Watch>>,
}

impl Turns {
    /// Waits until no other operation of the map runs.
    fn take(&self, watch: &Arc<Watch>) -> MutexGuard<'_, ()> {
        let turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        *self.watch.lock().unwrap_or_else(PoisonError::into_inner) = watch.clone();
        turn
    }

    pub(crate) fn report(&self, progress: Progress) -> ControlFlow<()> {
        self.watch.lock().unwrap_or_else(PoisonError::into_inner).report(progress)
    }
}

/// Runs `work` in another thread, without the interpreter. `turns` belongs to a visibility map: if `turns` is
/// given, `work` begins when no other operation of the map runs. The calling thread handles signals, and
/// calls `progress` with the finished and the total work. An exception in a signal handler or in `progress`
/// cancels the work.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    watch: &Arc<Watch>,
    turns: Option<&Turns>,
    work: impl FnOnce() -> Result<T, Error> + Send,
) -> PyResult<T> {
    py.detach(|| {
        let pool = pool()?;
        let mut failed = None;
        let result = std::thread::scope(|scope| {
            let (end, ended) = channel::<()>();
            let worker = scope.spawn(move || {
                // Waits outside the pool. Otherwise a pool thread that waits for a part of other work could
                // block here.
                let _turn = turns.map(|turns| turns.take(watch));
                let result = pool.install(work);
                drop(end);
                result
            });
            while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(PULSE) {
                if failed.is_none()
                    && let Err(error) = watch.pulse(progress.as_ref())
                {
                    watch.is_cancelled.store(true, Ordering::Relaxed);
                    failed = Some(error);
                }
            }
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        });
        if let Some(error) = failed {
            return Err(error);
        }
        let result = result.map_err(exception)?;
        if progress.is_some() {
            watch.pulse(progress.as_ref())?;
        }
        Ok(result)
    })
}

/// The number of items after which `for_each` handles signals. Too small: this thread waits often for the
/// interpreter. Too large: Ctrl-C takes effect late.
const CHUNK: usize = 256;

/// Calls `work` for each item, without the interpreter. An exception in a signal handler ends the calls.
pub(crate) fn for_each<T>(
    py: Python<'_>,
    mut items: impl Iterator<Item = T> + Send,
    mut work: impl FnMut(T) + Send,
) -> PyResult<()> {
    loop {
        let count = py.detach(|| items.by_ref().take(CHUNK).map(&mut work).count());
        if count < CHUNK {
            return Ok(());
        }
        py.check_signals()?;
    }
}

/// The thread pool of this process. A forked process gets a new pool, because the threads of its parent do
/// not exist in the forked process, which would wait for them forever.
fn pool() -> PyResult<Arc<ThreadPool>> {
    static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match &*pool {
        Some((of, pool)) if *of == process => return Ok(pool.clone()),
        // Dropping the parent's pool would wait for the pool's threads.
        Some((_, parents)) => std::mem::forget(parents.clone()),
        None => {}
    }
    let threads = ThreadPoolBuilder::new().build();
    let threads = threads.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let (_, threads) = pool.insert((process, Arc::new(threads)));
    Ok(threads.clone())
}

/// The Python exception for an error of the library, with the same text.
pub(crate) fn exception(error: Error) -> PyErr {
    let text = error.to_string();
    match error.kind() {
        ErrorKind::OutOfMemory => PyMemoryError::new_err(text),
        ErrorKind::Cancelled => PyRuntimeError::new_err(text),
        _ => PyValueError::new_err(text),
    }
}
