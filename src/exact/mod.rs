//! Exact arithmetic: the scene lattice, faces on it, planes, vertices, predicates, and the split.

pub(crate) mod chain;
mod classify;
mod coplanar;
pub(crate) mod eye;
pub(crate) mod faces;
pub(crate) mod half_space;
pub(crate) mod int;
pub(crate) mod lattice;
pub(crate) mod names;
mod plane;
#[cfg(feature = "save")]
mod saved;
mod split;
pub(crate) mod vertex;

pub use classify::{PreparedPlane, Side};
pub(crate) use coplanar::Outline;
pub use eye::Eye;
pub use faces::Faces;
pub(crate) use int::{Int, gcd};
pub use lattice::LIMIT as LATTICE_LIMIT;
pub use lattice::Lattice;
pub(crate) use lattice::integers;
pub(crate) use names::MAX_NAMES;
pub use names::{EdgeLine, PlaneId, PlaneKind, VertexId, VertexKind};
#[cfg(feature = "drawing")]
pub(crate) use plane::dot;
pub(crate) use plane::{
    Flattener, Off, Plane, RoundedNormal, cross, have_area, is_convex, turns_one_way,
};
pub(crate) use split::Clipper;
pub use split::{StoredVertex, Vertex, split};
pub(crate) use vertex::OFF as POSITION_OFF;
