//! Evidence about binspace: other methods to decide visibility, the library's builder with rounded
//! decisions, families of hard scenes, and measures of error against exact truth. Users of the
//! library do not compile this crate.

mod accuracy;
pub mod antialias;
pub mod culling;
mod family;
pub mod interior;
pub mod layers;
pub mod measure;
pub mod method;
pub mod overdraw;
pub mod patches;
mod pieces;
mod place;
pub mod portals;
mod residue;
pub mod room;
mod rounded;
pub mod shadows;
pub mod translucent;
mod tree;

pub use accuracy::{Accuracy, accuracy};
pub use family::{Family, FamilyError};
pub use rounded::{Float, FloatSplitter, FloatVertex, Precision};
pub use tree::KernelTree;
