//! What is said to the user, on standard output and on standard error.

use std::fmt::Display;
use std::io::Write;

use anstyle::{AnsiColor, Style};

use crate::failure::Failure;

/// For verdicts that all is well.
pub(crate) const GOOD: Style = AnsiColor::Green.on_default().bold();
/// For verdicts that something is wrong.
pub(crate) const BAD: Style = AnsiColor::Red.on_default().bold();
/// For what one reads first.
pub(crate) const HEAD: Style = Style::new().bold();

/// Writes a line to standard output, in colour only where that is a terminal.
pub(crate) fn say(line: impl Display) -> Result<(), Failure> {
    let mut out = anstream::stdout().lock();
    let written = writeln!(out, "{line}").and_then(|()| out.flush());
    written.map_err(|error| Failure::of_output(&error))
}

/// A text in a style.
pub(crate) fn styled(style: Style, text: impl Display) -> String {
    format!("{style}{text}{style:#}")
}

/// Says why the program stops.
pub(crate) fn error(message: &str) {
    to_stderr(BAD, "error:", message);
}

/// Says what the user should know, though it stops nothing.
pub(crate) fn note(message: &str) {
    to_stderr(AnsiColor::Cyan.on_default().bold(), "note:", message);
}

fn to_stderr(style: Style, label: &str, message: &str) {
    // There is nowhere left to report a failure to.
    let _ = writeln!(anstream::stderr().lock(), "{style}{label}{style:#} {message}");
}
