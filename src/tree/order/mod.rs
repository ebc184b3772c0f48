//! Orders of a tree's fragments for a viewpoint.

mod fragments;
pub(super) mod indices;
pub(crate) mod layout;
pub(crate) mod planes;
mod same;
pub(crate) mod sides;
mod twig;
mod walk;

pub use fragments::Ordered;
pub use walk::{Flow, Part};
