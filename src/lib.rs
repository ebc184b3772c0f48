//! Exact back-to-front orders of polygons from one BSP tree.
//!
//! [`BspTree`] is the library's main type, and its page is the manual. The [`guide`] has a page for each
//! subject, such as frames on a GPU, vector drawings and moving things. A tree stores *fragments*: convex
//! pieces of the polygons, or whole polygons.
//!
//! # Which type do I need?
//!
//! | to | use | example |
//! |---|---|---|
//! | paint polygons back to front | [`BspTree::back_to_front`], [`Fragment`] | |
//! | draw translucent triangles on a GPU | [`BspTree::welded_mesh`], [`mesh::Triangles::write_back_to_front`] | `gpu_transparency` |
//! | leave out fragments that are out of view or turned away | [`Order::culled`], [`Culling`], [`Frustum`] | `level` |
//! | skip subtrees of your choice, such as hidden rooms | [`Order::walk`], [`Part`], [`Flow`]; `occlusion::CoverageMask` | `level` |
//! | order, draw or hit moving polygons, lines and labels together with a static tree | [`overlay::Overlay`] | `level`, `plot` |
//! | build a tree every frame | [`FrameBuilder`] | |
//! | compose rectangles with matrices, as CSS 3D does | `layers::Layers` | `css_layers`, `smooth_layers` |
//! | draw a vector picture: SVG, hidden lines, plots | `BspTree::visibility` | `hidden_lines`, `plot` |
//! | find the hits of a ray, or whether one point is visible from another | [`BspTree::hits`], [`BspTree::is_occluded`], [`Ray`], [`Hit`] | `level` |
//! | find out whether a point is inside a closed body | [`BspTree::winding_number`] | |
//! | find the fragments in a box, or the leaf of a point | [`BspTree::fragments_in`], [`BspTree::locate`], [`Location`] | |
//! | interpolate colours and texture coordinates over cuts | [`Fragment::weights`] | `attributes` |
//! | copy all fragments to another language, a file or a device | [`BspTree::arrays`], [`BspTree::arrays_f32`] | |
//! | choose the partition planes yourself | [`BuildOptions::with_chooser`], [`choose::PieceSet`] | `surface_area` |
//! | write a tree to a file, or read a model | `BspTree::write`, `scene::Scene::read_obj` | |
//! | divide a scene that is too large for one tree | [`partition`] | |
//! | check a picture against a depth buffer | `verify::verify` | |
//!
//! Input and options: [`Polygon`], [`Point`], [`BuildOptions`], [`Heuristic`], [`Tolerance`], [`Progress`],
//! [`Viewpoint`]. Parts and statistics of a tree: [`Node`], [`Child`], [`Facing`], [`Grid`], [`Preparation`],
//! [`Stats`]. The cause of a failure, and the polygon that caused it: [`Error`], [`ErrorKind`].
//!
//! # What works together
//!
//! | | orders, with and without culling | rays, regions | meshes, arrays | drawings | files |
//! |---|---|---|---|---|---|
//! | a tree of [`BspTree::build`] or of a [`FrameBuilder`] | yes | yes | yes | yes | yes |
//! | the tree of a cell of a [`partition`] | yes | yes, but [`BspTree::winding_number`] returns an error | yes | error | yes |
//! | polygons of an [`overlay`] | yes | rays: yes; regions: ignored | meshes: yes, a separate mesh; arrays: no | error | no |
//! | lines and points of an overlay | yes | ignored | no | yes | no |
//!
//! # Conventions
//!
//! - Coordinates are right-handed, in any unit; results are in the same unit.
//! - A polygon's corners are counter-clockwise seen from its **front**; the front of a plane is the side that
//!   its normal points to.
//! - Order: *back to front* is the painting order, furthest first.
//! - Pixels: x to the right, y down, rows from the top; a pixel is sampled at its centre.
//!
//! # Features
//!
//! | feature | default | adds |
//! |---|---|---|
//! | `parallel` | yes | building with rayon's threads; the tree is bit for bit the same as without threads |
//! | `raster` | no | cameras (`view`), an exact painter and z-buffer (`raster`, `paint`), their comparison (`verify`), and occlusion culling (`occlusion`) |
//! | `drawing` | no | module `drawing`: one view as a vector picture with one path per visible polygon; turns on `raster` |
//! | `pdf` | no | vector pictures as PDF; turns on `drawing` |
//! | `layers` | no | module `layers`: rectangles with 4×4 matrices, as in CSS 3D, clipped, cut and in paint order |
//! | `scene` | no | module `scene`: polygons with colours, generated scenes |
//! | `obj` | no | reading Wavefront OBJ files into a `Scene`; turns on `scene` |
//! | `save` | no | trees (and scenes) as files: `BspTree::write` and `BspTree::read` |
//! | `mint` | no | polygons of `mint::Point3`; glam's conversions from and to mint |
//!
//! Without features the library depends on glam and smallvec alone.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod bits;
mod build;
#[cfg(feature = "drawing")]
pub mod drawing;
mod error;
mod exact;
mod faces;
#[cfg(any(doc, doctest))]
pub mod guide;
mod input;
#[cfg(feature = "layers")]
pub mod layers;
mod memory;
#[cfg(feature = "raster")]
pub mod occlusion;
pub mod overlay;
#[cfg(feature = "raster")]
pub mod paint;
mod parallel_map;
pub mod partition;
mod progress;
mod query;
mod random;
#[cfg(feature = "raster")]
pub mod raster;
#[cfg(feature = "save")]
mod save;
#[cfg(feature = "scene")]
pub mod scene;
mod tree;
mod union;
#[cfg(feature = "raster")]
pub mod verify;
#[cfg(feature = "raster")]
pub mod view;
mod viewpoint;

pub use build::{BuildOptions, FrameBuilder, Heuristic};
pub use error::{Error, ErrorKind};
pub use faces::{Preparation, Tolerance};
pub use glam;
pub use input::{Point, Polygon};
pub use progress::Progress;
pub use query::{Hit, Location};
pub use tree::{BspTree, Child, Culling, Flow, Fragment, Grid, Node, Order, Ordered, Part, Stats};
pub use viewpoint::{Facing, Frustum, Ray, Viewpoint};

/// Types for a custom heuristic, [`BuildOptions::with_chooser`]: its input and its output.
pub mod choose {
    pub use crate::build::{PieceSet, SplitPlane};
    pub use crate::exact::Side;
}

/// Vertex and index buffers of a tree, [`BspTree::mesh`]; all fragments as arrays, [`BspTree::arrays`].
pub mod mesh {
    pub use crate::tree::{FragmentArrays, Mesh, MeshVertex, Triangles};
}

/// Internals for the project's own programs, tests and benches. The items of this module may change in any
/// release.
#[doc(hidden)]
pub mod internals {
    pub use crate::build::choose::{FrameTuning, Tuning};
    pub use crate::build::driver::tree_of;
    pub use crate::exact::{
        EdgeLine, Eye, Faces, LATTICE_LIMIT, Lattice, PlaneId, PlaneKind, PreparedPlane, Side,
        StoredVertex, Vertex, VertexId, VertexKind, split,
    };
    pub use crate::faces::DEFAULT_TOLERANCE;
    pub use crate::input::MAX_CORNERS;
    #[cfg(feature = "raster")]
    pub use crate::paint::Pieces;
    pub use crate::query::Spot;
    pub use crate::random::{SplitMix64, mix};
    #[cfg(feature = "scene")]
    pub use crate::scene::generated::{cuboid, unit_circle};
    #[cfg(feature = "obj")]
    pub use crate::scene::obj::{Decimals, open_regular};
}

/// Tests the README's examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
