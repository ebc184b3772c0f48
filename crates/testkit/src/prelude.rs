//! The imports of most tests.

pub use super::dice::Dice;
pub use super::effort::{cases, seeds, times};
pub use super::rational::{self, Rational};
pub use super::shapes::Corners;
pub use super::tally::{fail, tally};
pub use super::{hard, model};
pub use crate::enough;
pub use crate::fill::with_opacities;
pub use binspace::drawing::{Drawing, Hidden, ViewOptions, VisibilityMap};
pub use binspace::glam::{DVec2, DVec3, dvec2, dvec3};
pub use binspace::internals::{Faces, PlaneId};
pub use binspace::raster::Rays;
pub use binspace::scene::{self, Builtin, Scene};
pub use binspace::view::Camera;
pub use binspace::{BspTree, BuildOptions, FrameBuilder, Heuristic, Polygon, Viewpoint};
pub use num_traits::{Signed, Zero};
pub use std::cmp::Ordering;
pub use std::ops::ControlFlow;
