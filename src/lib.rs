//! Exact back-to-front orders of polygons from one BSP tree.

pub mod geom;
pub mod scene;

pub use glam;
