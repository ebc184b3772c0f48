//! The finished tree, one file an operation.

pub(crate) mod apart;
pub(crate) mod bsp_tree;
mod facing;
mod fragment;
mod mesh;
pub(crate) mod node;
pub(crate) mod order;
mod partitions;
pub(crate) mod parts;
#[cfg(feature = "save")]
mod saved;
mod stats;
mod validate;
pub(crate) mod walk;

pub use bsp_tree::BspTree;
pub use fragment::{Fragment, Fragments};
pub use mesh::{Mesh, MeshVertex, Triangles};
pub use order::Ordered;
pub use partitions::{Partition, Partitions};
pub use stats::Stats;
pub use validate::Invalid;
