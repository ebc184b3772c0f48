//! The commands, one a file.

pub(crate) mod build;
pub(crate) mod demo;
pub(crate) mod draw;
pub(crate) mod export;
pub(crate) mod order;
pub(crate) mod page;
pub(crate) mod render;
pub(crate) mod scenes;
pub(crate) mod stats;
pub(crate) mod verify;
