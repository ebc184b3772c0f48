//! Shared by several test programs: hard scenes, and an exact model to compare the library with.

#![allow(dead_code, reason = "every test program uses its own part")]

pub(crate) mod cell_cover;
pub(crate) mod cell_orders;
pub(crate) mod checks;
pub(crate) mod decode;
pub(crate) mod dice;
pub(crate) mod divided;
#[cfg(feature = "drawing")]
pub(crate) mod fill;
#[cfg(feature = "drawing")]
pub(crate) mod fragment_pixels;
pub(crate) mod hard;
pub(crate) mod hits;
pub(crate) mod homogeneous;
pub(crate) mod judge;
#[cfg(feature = "drawing")]
pub(crate) mod layered;
pub(crate) mod model;
pub(crate) mod orders;
pub(crate) mod quick_hits;
pub(crate) mod rational;
pub(crate) mod rays;
pub(crate) mod real_scenes;
pub(crate) mod saved;
pub(crate) mod shapes;
pub(crate) mod shots;
pub(crate) mod slivers;
pub(crate) mod snapshot;
pub(crate) mod tally;
pub(crate) mod targets;
pub(crate) mod views;
