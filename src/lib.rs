//! Exact back-to-front orders of polygons from one BSP tree.

mod error;
pub mod geom;
pub mod scene;

pub use error::Error;
pub use geom::{Point, Polygon, Viewpoint};
pub use glam;
