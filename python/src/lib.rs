//! The compiled half of the Python package `binspace`. The other half, `python/binspace/__init__.py`,
//! converts arguments to the shapes and types that this half expects.

mod arrays;
mod drawing;
mod input;
mod overlay;
mod task;
mod tree;

use pyo3::prelude::*;

#[pymodule]
mod _binspace {
    #[pymodule_export]
    use crate::drawing::{Camera, Drawing, EdgeRuns, Visibility, VisiblePolygons};
    #[pymodule_export]
    use crate::overlay::{LineRuns, Markers, Overlay, Pieces};
    #[pymodule_export]
    use crate::tree::{Fragments, Hits, Tree};
}
