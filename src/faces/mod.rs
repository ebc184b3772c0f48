//! Preparation: from input polygons to convex planar faces on the lattice.

mod lists;
mod polygon;
mod prepare;
mod read;
mod tolerance;
mod triangulate;

pub use prepare::Preparation;
pub(crate) use prepare::Preparer;
pub use tolerance::{DEFAULT_TOLERANCE, Tolerance};
pub(crate) use tolerance::{Precision, empty_faces};
