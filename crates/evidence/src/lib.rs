//! Evidence about binspace: other methods to decide visibility, the library's builder with rounded
//! decisions, families of hard scenes, and measures of error against exact truth. Users of the
//! library do not compile this crate.

mod accuracy;
pub mod curved;
mod family;
pub mod fighting;
pub mod measure;
pub mod method;
pub mod panes;
mod place;
pub mod plain;
mod residue;
mod rounded;
mod tree;

pub use accuracy::{Accuracy, accuracy};
pub use family::{Family, FamilyError};
pub use rounded::{Float, FloatSplitter, FloatVertex, Precision};
pub use tree::KernelTree;
