//! Orders of a tree's fragments for a viewpoint.

pub(crate) mod eye;
pub(crate) mod iterate;
pub(crate) mod layout;

pub use iterate::{Flow, Ordered, Part};
