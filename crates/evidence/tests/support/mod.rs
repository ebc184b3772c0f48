//! The exact model that the library's own tests hold it against.

#![allow(dead_code, reason = "the library's tests use more of it")]

#[path = "../../../../tests/support/hard.rs"]
pub(crate) mod hard;
#[path = "../../../../tests/support/homogeneous.rs"]
pub(crate) mod homogeneous;
#[path = "../../../../tests/support/model.rs"]
pub(crate) mod model;
#[path = "../../../../tests/support/rational.rs"]
pub(crate) mod rational;
#[path = "../../../../tests/support/shapes.rs"]
pub(crate) mod shapes;
