//! Visibility maps and drawings, against pictures whose every pixel is decided by integers of another
//! hand, and against rays.

mod between;
mod coincidences;
mod crossings;
mod hidden;
mod in_front;
mod lines;
mod overlay;
mod pen;
mod progress;
mod scenes;
mod sightlines;
#[path = "../support/mod.rs"]
mod support;
mod translucent;
