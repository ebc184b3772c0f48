//! Exact geometry: the lattice, faces, planes, predicates, and how pieces are cut.

mod drift;
mod duplicates;
mod exact;
mod exact_kernel;
mod eye;
mod faces;
mod float_kernel;
mod growth;
mod int;
mod kernel;
mod label;
mod lattice;
pub(crate) mod parallel;
mod polygon;
mod prepare;
mod residue;
mod split;
mod triangulate;

pub(crate) use exact::Plane;
pub use exact_kernel::{Exact, ExactSplitter, ExactStored, ExactVertex};
pub use eye::{Eye, Viewpoint};
pub use faces::Faces;
pub use float_kernel::{Float, FloatSplitter, FloatVertex, Precision};
pub(crate) use growth::reserve;
pub use int::Int;
pub use kernel::{Kernel, Piece, Side, Vertex};
pub use label::{Line, MAX_LABELS, PlaneId, PlaneKind, Symbol, SymbolKind};
pub(crate) use lattice::LIMIT as LATTICE_LIMIT;
pub use lattice::Lattice;
pub use polygon::{Point, Polygon};
pub use prepare::{DEFAULT_TOLERANCE, Preparation};
pub(crate) use residue::Residue;
pub use split::split;
