//! Trees of large scenes, judged independently of the library: by the polygons as given and the library's
//! guarantees, in separate big integers.
//!
//! Rays are shot at the *source polygons*: these hits and their depths are exact. The fragment at a hit is
//! found by its rounded vertices, and if these cannot decide, by the cells that
//! [`nodes`](binspace::BspTree::nodes) describes. Then every pair must come far before near, pairs in one
//! plane in input order, and every hit must find its polygon covered once.

pub mod cells;
pub mod drawing;
pub mod exact;
pub mod ray;
pub mod scene;
pub mod trees_by_rays;
pub mod view;
