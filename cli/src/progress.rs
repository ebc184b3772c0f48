//! Progress of long phases, shown on a terminal if they take more than a second.

use std::io::IsTerminal;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::terminal::is_quiet;

/// Phases shorter than this are not shown.
const PATIENCE: Duration = Duration::from_secs(1);

/// A phase of the work, which ends when the value is dropped.
///
/// Nothing is written where standard error is not a terminal, or if only errors are asked for.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    alarm: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// A phase of unknown length.
    pub fn spinner(message: impl Into<String>) -> Self {
        Self::start(ProgressBar::no_length(), "{spinner} {msg} {elapsed}", message.into())
    }

    /// A phase with a known number of steps.
    pub fn steps(message: impl Into<String>, steps: u64) -> Self {
        let template = "{spinner} {msg} {pos}/{len} {bar:30} {elapsed}";
        Self::start(ProgressBar::new(steps), template, message.into())
    }

    /// A phase that reports the share of its work done.
    pub fn share(message: impl Into<String>) -> Self {
        Self::start(
            ProgressBar::new(0),
            "{spinner} {msg} {percent}% {bar:30} {elapsed}",
            message.into(),
        )
    }

    fn start(bar: ProgressBar, template: &str, message: String) -> Self {
        bar.set_draw_target(ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_message(message);
        let is_shown = !is_quiet() && std::io::stderr().is_terminal();
        let alarm = is_shown.then(|| {
            let (sender, receiver) = mpsc::channel();
            let late = bar.clone();
            // Without a thread to show it, there is no progress to see.
            let thread = thread::Builder::new().spawn(move || {
                if receiver.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                    late.set_draw_target(ProgressDrawTarget::stderr());
                    late.enable_steady_tick(Duration::from_millis(100));
                }
            });
            thread.ok().map(|thread| (sender, thread))
        });
        Self { bar, alarm: alarm.flatten() }
    }

    /// Counts one more step as done.
    pub fn step(&self) {
        self.bar.inc(1);
    }

    /// Sets the work done and the total.
    pub fn set(&self, done: usize, total: usize) {
        // Setting a new length redraws at once each time, so it is set only if it changes.
        if self.bar.length() != Some(total as u64) {
            self.bar.set_length(total as u64);
        }
        self.bar.set_position(done as u64);
    }

    /// Hides the progress while `write` writes to the terminal.
    pub fn suspend<T>(&self, write: impl FnOnce() -> T) -> T {
        self.bar.suspend(write)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.alarm.take() {
            drop(sender);
            // The thread does nothing that could fail.
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}
