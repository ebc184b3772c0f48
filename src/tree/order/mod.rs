//! Orders of a tree's fragments for a viewpoint.

mod fragments;
mod indices;
pub(crate) mod layout;
pub(crate) mod planes;
mod same;
pub(crate) mod sides;
mod twig;

pub use fragments::Ordered;
