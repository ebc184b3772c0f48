//! Scenes that are built and drawn cell by cell: folders of `binspace build --cells`.

pub(crate) mod build;
pub(crate) mod draw;
pub(crate) mod folder;
mod source;
