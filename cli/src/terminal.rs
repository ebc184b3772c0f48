//! Messages to the user on standard output and standard error.

use std::fmt::Display;
use std::io::Write;

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

/// Prints a note that does not stop the program.
pub fn note(message: &str) {
    to_stderr(AnsiColor::Cyan.on_default().bold(), "note:", message);
}

fn to_stderr(style: Style, label: &str, message: &str) {
    // If standard error fails, there is nowhere left to report it.
    let _ = writeln!(anstream::stderr().lock(), "{style}{label}{style:#} {message}");
}
