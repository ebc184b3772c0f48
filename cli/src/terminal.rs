//! Messages to the user on standard output and standard error.

use std::fmt::Display;
use std::io::Write;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, PoisonError};

use anstyle::{AnsiColor, Style};

use crate::failure::Failure;

/// The style of good verdicts.
pub const GOOD: Style = AnsiColor::Green.on_default().bold();
/// The style of bad verdicts.
pub const BAD: Style = AnsiColor::Red.on_default().bold();
/// The style of headings.
pub const HEAD: Style = Style::new().bold();

/// Writes a line to standard output, in colour only where that is a terminal.
pub fn say(line: impl Display) -> Result<(), Failure> {
    let mut out = anstream::stdout().lock();
    let written = writeln!(out, "{line}").and_then(|()| out.flush());
    written.map_err(|error| Failure::of_output(&error))
}

/// A text in a style.
pub fn styled(style: Style, text: impl Display) -> String {
    format!("{style}{text}{style:#}")
}

/// Prints why the program stops.
pub fn error(message: &str) {
    to_stderr(BAD, "error:", message);
}

/// The notes that are printed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Notes {
    /// The notes on a scene in one line.
    Brief,
    /// Each note on a separate line.
    Each,
    /// No notes, and no progress.
    None,
}

/// The choice of notes. Without options for this choice, as in `binspace-lab`, each note is printed at once.
static NOTES: AtomicU8 = AtomicU8::new(Notes::Each as u8);
/// The notes on scenes that are still to be printed.
static WAITING: Mutex<Vec<Remark>> = Mutex::new(Vec::new());

/// A note on a scene.
#[derive(Debug)]
struct Remark {
    scene: String,
    brief: String,
    full: String,
}

/// Sets which notes are printed from now on.
pub(crate) fn set_notes(notes: Notes) {
    NOTES.store(notes as u8, Ordering::Relaxed);
}

/// Whether only errors are printed.
pub(crate) fn is_quiet() -> bool {
    NOTES.load(Ordering::Relaxed) == Notes::None as u8
}

/// Prints a note that does not stop the program.
pub fn note(message: &str) {
    if !is_quiet() {
        to_stderr(AnsiColor::Cyan.on_default().bold(), "note:", message);
    }
}

/// Notes something about a scene. The notes on a scene are printed together: see [`print_remarks`].
pub(crate) fn remark(scene: &str, brief: impl Display, full: impl Display) {
    if NOTES.load(Ordering::Relaxed) == Notes::Each as u8 {
        return note(&format!("{scene}: {full}"));
    }
    let remark = Remark { scene: scene.into(), brief: brief.to_string(), full: full.to_string() };
    WAITING.lock().unwrap_or_else(PoisonError::into_inner).push(remark);
}

/// Prints the notes on scenes that are waiting: a line for each scene, in short if there are several.
pub(crate) fn print_remarks() {
    let waiting = std::mem::take(&mut *WAITING.lock().unwrap_or_else(PoisonError::into_inner));
    for remarks in waiting.chunk_by(|a, b| a.scene == b.scene) {
        let scene = &remarks[0].scene;
        note(&match remarks {
            [Remark { full, .. }] => format!("{scene}: {full}"),
            several => {
                let brief: Vec<&str> = several.iter().map(|remark| &*remark.brief).collect();
                format!("{scene}: {}; --notes for each", brief.join("; "))
            }
        });
    }
}

fn to_stderr(style: Style, label: &str, message: &str) {
    // If standard error fails, there is nowhere left to report it.
    let _ = writeln!(anstream::stderr().lock(), "{style}{label}{style:#} {message}");
}
