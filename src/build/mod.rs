//! Building a tree: options, progress, the driver, the jobs of its threads, the choice of planes.

mod assemble;
mod budget;
mod builder;
pub(crate) mod cell;
mod cells;
pub(crate) mod choose;
pub(crate) mod driver;
mod extend;
mod frame_builder;
mod heuristic;
mod job;
mod jobs;
pub(crate) mod knife;
pub(crate) mod live;
mod options;
pub(crate) mod progress;

pub use frame_builder::FrameBuilder;
pub use heuristic::{Heuristic, ParseHeuristicError};
pub use options::BuildOptions;
pub use progress::Progress;
