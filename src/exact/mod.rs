//! Exact arithmetic: the scene lattice, faces on it, planes, vertices, predicates, and the split.
//!
//! | file | decides |
//! |---|---|
//! | `lattice` | how corners are rounded to the grid |
//! | `faces` | which corners make a face, and which plane it has |
//! | `label` | by which points and planes a vertex is named |
//! | `plane` | the integers of a plane |
//! | `vertex` | on which side of a plane a vertex lies, in integers |
//! | `rounded_vertex` | where a vertex is, rounded |
//! | `normal` | how a face's plane lies, rounded |
//! | `classify` | where a piece lies against a plane |
//! | `edge` | what an edge of a face is |
//! | `flatten` | where corners off their face's plane are moved |
//! | `split` | how a piece is cut |
//! | `barycentric` | of which corners, and with which weights, a vertex consists |
//! | `int` | integers of fixed width |
//! | `cell` | which part of a face is in a cell of a larger scene |
//! | `convex_outline` | whether an outline is convex |
//! | `along` | in which order points of one line come |
//! | `eye` | how a viewpoint is rounded, and on which side of a plane it lies |
//! | `exact_ray` | where a ray meets planes, and in which order |
//! | `half_space` | whether a fragment meets several half-spaces |

pub(crate) mod along;
mod barycentric;
pub(crate) mod cell;
mod classify;
mod convex_outline;
mod edge;
pub(crate) mod exact_ray;
mod eye;
pub(crate) mod faces;
mod flatten;
pub(crate) mod half_space;
pub(crate) mod int;
pub(crate) mod label;
pub(crate) mod lattice;
mod normal;
mod plane;
mod rounded_vertex;
mod split;
pub(crate) mod vertex;

pub use classify::{PreparedPlane, Side};
pub(crate) use convex_outline::{is_convex, turns_one_way};
pub use eye::Eye;
pub use faces::Faces;
pub(crate) use flatten::Flattener;
pub(crate) use int::Int;
pub(crate) use label::MAX_LABELS;
pub use label::{Line, PlaneId, PlaneKind, Symbol, SymbolKind};
pub use lattice::LIMIT as LATTICE_LIMIT;
pub use lattice::Lattice;
pub(crate) use lattice::integers;
pub(crate) use normal::{RoundedNormal, have_area};
#[cfg(feature = "drawing")]
pub(crate) use plane::dot;
pub(crate) use plane::{Plane, cross};
pub(crate) use rounded_vertex::OFF as POSITION_OFF;
pub use split::{StoredVertex, Vertex, split};
