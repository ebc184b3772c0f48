//! Judges trees of large scenes independently of the library: by the given polygons and the library's
//! guarantees, in separate big integers.
//!
//! Rays are shot at the *source polygons*, so hits and their depths are exact. The rounded vertices of
//! fragments tell which fragment is at a hit. If they cannot decide, the cells that
//! [`nodes`](binspace::BspTree::nodes) describes decide. Then, in every pair of hits, the further must come
//! before the nearer in the order. Pairs in one plane must be in input order. At every hit, exactly one
//! fragment must cover the polygon.

pub mod cells;
pub mod drawing;
pub mod exact;
pub mod ray;
pub mod scene;
pub mod trees_by_rays;
pub mod view;
