//! Orders of a tree's fragments for a viewpoint.

pub(crate) mod eye_sides;
mod fragments;
pub(super) mod indices;
pub(crate) mod layout;
pub(crate) mod planes;
pub(crate) mod schedule;
mod twig;
mod walk;

pub use fragments::Ordered;
pub use walk::{Flow, Part};
