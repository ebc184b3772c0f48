//! The finished tree.

mod between;
mod bounds;
pub(crate) mod bsp_tree;
mod culling;
mod fragment;
pub(crate) mod grid;
mod mesh;
mod node;
pub(crate) mod node_record;
pub(crate) mod order;
pub(crate) mod parts;
#[cfg(feature = "save")]
mod saved;
mod stats;
#[cfg(test)]
mod tests;
mod validate;
pub(crate) mod walk;

pub use bounds::Bounds;
pub(crate) use bounds::boxes::{BLOCK, Flat};
pub(crate) use bounds::half_space::HalfSpace;
pub(crate) use bounds::rounding;
pub use bsp_tree::BspTree;
pub use culling::{Culling, Sides};
pub use fragment::{Fragment, Fragments};
pub use grid::Grid;
pub use mesh::{Mesh, MeshVertex, Triangles};
pub use node::{Child, Node, Nodes};
pub use order::{Flow, Ordered, Part};
pub use stats::Stats;
pub use validate::Invalid;
