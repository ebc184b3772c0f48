//! The finished tree.

pub(crate) mod bounds;
pub(crate) mod bsp_tree;
pub(crate) mod culling;
pub(crate) mod fragment;
mod mesh;
pub(crate) mod node;
pub(crate) mod order;
pub(crate) mod parts;
#[cfg(feature = "save")]
mod saved;
#[cfg(test)]
mod tests;
#[cfg(feature = "validate")]
mod validate;

pub(crate) use bounds::{Flat, HalfSpace, rounding};
pub use bsp_tree::{BspTree, Stats};
pub use culling::Culling;
pub use fragment::{Fragment, FragmentArrays, Grid};
pub(crate) use mesh::Source;
pub use mesh::{Mesh, MeshVertex, Triangles};
pub use node::{Child, Node};
pub use order::{Flow, Order, Ordered, Part};
