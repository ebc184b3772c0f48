//! Building a tree.
//!
//! `driver` contains the steps from polygons to a tree. `subtree` divides a set of pieces by the planes that
//! `choose` finds; `small` divides all of a small set by a table. `jobs` spreads large sets over threads and
//! joins the results.

pub(crate) mod choose;
pub(crate) mod driver;
pub(crate) mod frames;
#[cfg_attr(not(feature = "parallel"), expect(dead_code, reason = "one thread hands no sets over"))]
mod jobs;
mod options;
pub(crate) mod piece;
mod small;
mod subtree;

pub use choose::{PieceSet, SplitPlane};
pub use frames::FrameBuilder;
pub use options::{BuildOptions, Heuristic};
