//! Exact back-to-front orders of polygons from one BSP tree.
//!
//! [`BspTree`] is the library's main type, and its page the manual. Around it:
//!
//! | module | holds |
//! |---|---|
//! | [`geom`] | the scene lattice, faces, exact predicates, kernels, the split |
//! | [`view`] | cameras |
//! | [`raster`] | a painter and a z-buffer that decide every pixel exactly, and their comparison |
//! | [`method`] | other ways to decide visibility, behind one trait, to be measured side by side |
//! | [`scene`] | polygons with colours: generated scenes and OBJ files |
//!
//! # Conventions
//!
//! - Coordinates are right-handed, in any unit; results are in the same.
//! - A polygon's corners run counter-clockwise seen from its **front**; the front of a plane is the
//!   side that its normal points to.
//! - Order: *back to front* is the order to paint in, the furthest first.
//! - Pixels: x to the right, y down, rows from the top; a pixel is judged at its centre.
//!
//! # Features
//!
//! All are on by default; without them the library depends on glam and smallvec alone.
//!
//! - `triangulate`: ear clipping for polygons that are not convex; without it they are an error.
//! - `parallel`: building with rayon's threads. The tree is the same, bit for bit.
//! - `obj`: reading Wavefront OBJ files.

mod bsp;
mod error;
pub mod geom;
pub mod measure;
pub mod method;
mod random;
pub mod raster;
pub mod scene;
mod verify;
pub mod view;

pub use bsp::{
    Accuracy, BspTree, BuildOptions, Fragment, Heuristic, Invalid, Ordered, ParseHeuristicError,
    Partition, Progress, Stats,
};
pub use error::Error;
pub use geom::{Point, Polygon, Viewpoint};
pub use glam;
pub use verify::{Verification, paint_tree, paint_tree_in_colour, verify};

/// The README's examples are tested as they stand.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
