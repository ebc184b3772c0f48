//! The commands, one a file.

pub(crate) mod build;
pub(crate) mod draw;
pub(crate) mod lecture;
pub(crate) mod order;
pub(crate) mod page;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod scenes;
pub(crate) mod stats;
pub(crate) mod tour;
pub(crate) mod verify;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// As it should.
    Done,
    /// An image differs from what it should be.
    Differs,
}
