//! Preparation: from input polygons to convex planar faces on the lattice.

mod duplicates;
mod prepare;
mod triangulate;

pub use prepare::{DEFAULT_TOLERANCE, Preparation, Tolerance};
pub(crate) use prepare::{Precision, Preparer, empty_faces};
