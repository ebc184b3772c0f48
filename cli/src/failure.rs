//! Why a command stopped.

use std::fmt::Display;
use std::io;

/// The reason why a command stopped before its end.
#[derive(Debug)]
pub enum Failure {
    /// Bad usage or input, in words for the user.
    Message(String),
    /// A wrong command line; the message has already been printed.
    Usage,
    /// The reader of standard output has closed the pipe, so the rest of the output is not needed.
    ClosedPipe,
}

impl Failure {
    /// A failure whose message begins with its subject.
    pub fn about(subject: impl Display, problem: impl Display) -> Self {
        Self::Message(format!("{subject}: {problem}"))
    }

    /// A failure of writing to standard output.
    pub fn of_output(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ClosedPipe,
            _ => Self::about("standard output", error),
        }
    }
}
