//! Cameras: from where a picture is taken, and where in it a point of the world appears.
//!
//! A picture is `width` × `height` pixels; x runs right, y runs down, pixel (0, 0) is the top left
//! one and covers the square from (0, 0) to (1, 1), so that its centre is at (0.5, 0.5).

mod camera;
mod vantage;

pub(crate) use camera::CameraProblem;
pub use camera::{Camera, CameraError, Projection};
pub use vantage::views;
