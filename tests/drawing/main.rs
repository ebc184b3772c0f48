//! Visibility maps and drawings, against pictures whose every pixel is decided by integers of another
//! hand, and against rays.

mod coincidences;
mod fill;
mod hidden;
mod lines;
mod pen;
mod scenes;
#[path = "../support/mod.rs"]
mod support;
