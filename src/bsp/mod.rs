//! The tree: building, orders, statistics, validation.

mod accuracy;
mod assemble;
mod auto;
mod axis;
mod build;
mod cell;
mod choose;
mod convex;
mod cost;
mod fragment;
mod gather;
mod heuristic;
mod jobs;
mod live;
mod node;
mod options;
mod order;
mod partitions;
mod peel;
mod progress;
mod stats;
mod traverse;
mod tree;
mod validate;
mod walk;

pub use accuracy::Accuracy;
pub use fragment::Fragment;
pub use heuristic::{Heuristic, ParseHeuristicError};
pub use options::BuildOptions;
pub use partitions::Partition;
pub use progress::Progress;
pub use stats::Stats;
pub use traverse::Ordered;
pub use tree::BspTree;
pub use validate::Invalid;
