//! The compiled half of the Python package `binspace`: numbers in, numbers out. Shapes and types of arguments are
//! prepared by the other half, in `python/binspace/__init__.py`.

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
