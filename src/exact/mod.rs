//! Exact arithmetic: the scene lattice, faces on it, planes, vertices, predicates, and the split.
//!
//! | file | decides |
//! |---|---|
//! | `lattice` | how corners are rounded to the grid |
//! | `faces` | which corners make a face, and which plane it has |
//! | `names` | by which points and planes a vertex is named |
//! | `plane` | the plane of a face, in integers and rounded |
//! | `edge` | what an edge of a face is, and where corners off its plane are moved |
//! | `vertex` | on which side of a plane a vertex lies, in integers; its weights |
//! | `position` | where a vertex is, rounded |
//! | `classify` | where a piece lies against a plane |
//! | `split` | how a piece is cut |
//! | `cell` | which part of a face is in a cell of a larger scene |
//! | `eye` | how viewpoints and rays are rounded, and where they lie against a plane |
//! | `half_space` | whether a fragment meets several half-spaces |
//! | `int` | integers of fixed width |

pub(crate) mod cell;
mod classify;
mod edge;
pub(crate) mod eye;
pub(crate) mod faces;
pub(crate) mod half_space;
pub(crate) mod int;
pub(crate) mod lattice;
pub(crate) mod names;
mod plane;
mod position;
mod split;
pub(crate) mod vertex;

pub use classify::{PreparedPlane, Side};
pub(crate) use edge::Flattener;
pub use eye::Eye;
pub use faces::Faces;
pub(crate) use faces::{is_convex, turns_one_way};
pub(crate) use int::Int;
pub use lattice::LIMIT as LATTICE_LIMIT;
pub use lattice::Lattice;
pub(crate) use lattice::integers;
pub(crate) use names::MAX_NAMES;
pub use names::{EdgeLine, PlaneId, PlaneKind, VertexId, VertexKind};
#[cfg(feature = "drawing")]
pub(crate) use plane::dot;
pub(crate) use plane::{Plane, RoundedNormal, cross, have_area};
pub(crate) use position::OFF as POSITION_OFF;
pub use split::{StoredVertex, Vertex, split};
