//! Visibility maps and drawings, against pictures whose every pixel is decided by integers of another
//! hand, and against rays.

mod coincidences;
mod crossings;
mod hidden;
mod lines;
mod mixed;
mod pen;
mod progress;
mod scenes;
#[path = "../support/mod.rs"]
mod support;
mod translucent;
