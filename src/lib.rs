//! Exact back-to-front orders of polygons from one BSP tree.

mod bsp;
mod error;
pub mod geom;
pub mod raster;
pub mod scene;
mod verify;
pub mod view;

pub use bsp::{
    BspTree, BuildOptions, Fragment, Heuristic, Invalid, Ordered, ParseHeuristicError, Partition,
    Stats,
};
pub use error::Error;
pub use geom::{Point, Polygon, Viewpoint};
pub use glam;
pub use verify::{Verification, paint_tree, verify};
