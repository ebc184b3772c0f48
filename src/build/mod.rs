//! Building a tree.
//!
//! | file | decides |
//! |---|---|
//! | `options`, `heuristic` | what users ask for |
//! | `driver` | the steps from polygons to a tree |
//! | `builder` | how a set of pieces becomes a node: a leaf, a plane, layers that are peeled off |
//! | `choose` | which plane divides a set |
//! | `piece` | what a piece is on its way down, and how it is cut |
//! | `threads`, `job` | which subtrees threads are given, and when |
//! | `assemble` | how the subtrees become one tree |
//! | `budget`, `progress` | when a build ends early |
//! | `frame_builder`, `extend` | trees of frames, and with more polygons |
//! | `build_cell`, `overlay_builder` | trees of one cell of a scene, and of what an overlay has in one place |

mod assemble;
mod budget;
mod build_cell;
mod builder;
pub(crate) mod choose;
pub(crate) mod driver;
mod extend;
mod frame_builder;
mod heuristic;
mod job;
mod options;
pub(crate) mod overlay_builder;
pub(crate) mod piece;
pub(crate) mod progress;
mod threads;

pub use frame_builder::FrameBuilder;
pub use heuristic::{Heuristic, ParseHeuristicError};
pub use options::BuildOptions;
pub use progress::Progress;
