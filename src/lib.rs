//! Exact back-to-front orders of polygons from one BSP tree.
//!
//! [`BspTree`] is the library's main type, and its page is the manual. Around it:
//!
//! | | |
//! |---|---|
//! | [`BuildOptions`], [`Heuristic`], [`Progress`] | how a tree is built, and how far it is |
//! | [`FrameBuilder`] | trees built anew every frame |
//! | [`Overlay`], [`Shapes`], [`Shape`], [`Overlaid`] | polygons that move, lines and points, in one order with a tree that stays |
//! | [`Segment`], [`Marker`] | what lines and points become there |
//! | [`Polygon`], [`Point`] | the input of a tree |
//! | [`Partition`], [`Extent`] | scenes too large for one tree: cells, each with a tree of its own |
//! | [`Viewpoint`] | an eye or a direction, for which a tree is ordered |
//! | [`Fragment`], [`Node`] | the parts of a tree |
//! | [`Bounds`], [`Culling`], [`Frustum`] | what need not be drawn |
//! | [`Ray`], [`Hit`], [`Location`] | what a ray hits, and where a point is |
//! | [`Grid`] | the grid of a tree's exact numbers |
//! | [`Tolerance`], [`Preparation`], [`Stats`] | what counts as coplanar, how the input was prepared, a tree's figures |
//! | [`Error`] | why something failed, and at which polygon |
//! | [`Mesh`], [`Triangles`] | vertex and index buffers |
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
//! | feature | default | adds |
//! |---|---|---|
//! | `parallel` | yes | building with rayon's threads; the tree is the same, bit for bit |
//! | `raster` | no | modules `view` and `raster`: cameras, a painter and a z-buffer that decide every pixel exactly, and `verify`, which compares them |
//! | `drawing` | no | module `drawing`: one view as a vector picture, one path a visible polygon; turns on `raster` |
//! | `layers` | no | module `layers`: rectangles with 4×4 matrices, as in CSS 3D, clipped, cut and in paint order |
//! | `scene` | no | module `scene`: polygons with colours, generated scenes |
//! | `obj` | no | reading Wavefront OBJ files into a `Scene`; turns on `scene` |
//! | `save` | no | trees (and scenes) as files: `BspTree::write` and `BspTree::read` |
//! | `mint` | no | polygons of `mint::Point3`; glam's conversions from and to mint |
//!
//! Without features the library depends on glam and smallvec alone.

mod build;
#[cfg(feature = "drawing")]
pub mod drawing;
mod error;
mod exact;
mod faces;
mod frustum;
mod input;
#[cfg(feature = "layers")]
pub mod layers;
mod memory;
#[cfg(feature = "raster")]
mod occlusion;
mod overlay;
mod parallel_map;
mod partition;
mod query;
mod random;
#[cfg(feature = "raster")]
pub mod raster;
mod ray;
#[cfg(feature = "save")]
mod save;
#[cfg(feature = "scene")]
pub mod scene;
mod tree;
#[cfg(feature = "raster")]
mod verify;
#[cfg(feature = "raster")]
pub mod view;
mod viewpoint;

pub use build::{BuildOptions, FrameBuilder, Heuristic, ParseHeuristicError, Progress};
pub use error::Error;
#[cfg(feature = "raster")]
pub use exact::Faces;
pub use faces::{Preparation, Tolerance};
pub use frustum::Frustum;
pub use glam;
pub use input::{MAX_CORNERS, Point, Polygon};
#[cfg(feature = "raster")]
pub use occlusion::CoverageMask;
pub use overlay::{Marker, Overlaid, Overlay, Segment, Shape, Shapes};
pub use partition::{Extent, Partition};
pub use query::{FragmentsIn, Hit, Hits, Location};
pub use ray::Ray;
#[cfg(feature = "save")]
pub use save::LoadError;
pub use tree::{
    Bounds, BspTree, Child, Culling, Flow, Fragment, Fragments, Grid, Invalid, Mesh, MeshVertex,
    Node, Nodes, Ordered, Part, Sides, Stats, Triangles,
};
#[cfg(feature = "raster")]
pub use verify::{
    OrderFault, Verification, check_orders, for_each_painted, paint_tree, paint_tree_in_colour,
    verify, verify_fronts,
};
pub use viewpoint::Viewpoint;

/// What the project's own programs, tests and benches need of the library's insides. It may change in
/// any release.
#[doc(hidden)]
pub mod internals {
    pub use crate::build::choose::{Quick, Tuning};
    pub use crate::build::driver::{parts, tree_of};
    pub use crate::exact::{
        Exact, ExactSplitter, ExactStored, ExactVertex, Eye, Faces, Kernel, LATTICE_LIMIT, Lattice,
        Line, Piece, PlaneId, PlaneKind, Side, Symbol, SymbolKind, Vertex, split,
    };
    pub use crate::faces::DEFAULT_TOLERANCE;
    pub use crate::query::Spot;
    pub use crate::random::{SplitMix64, mix};
    #[cfg(feature = "scene")]
    pub use crate::scene::cuboid::cuboid;
    #[cfg(feature = "scene")]
    pub use crate::scene::turn::unit_circle;
    pub use crate::tree::apart::parts_of_tree;
    pub use crate::tree::parts::{Parts, RawChild, RawNode, Record};
    #[cfg(feature = "raster")]
    pub use crate::verify::paint_order;
}

/// The README's examples are tested as they stand.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
