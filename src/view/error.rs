//! Why there is no such camera.

use std::fmt;

/// Why a camera, or its rays through a scene, cannot be made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CameraError {
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    NonFinite,
    NoDirection,
    UpAlongView,
    FieldOfView,
    Height,
    Size { width: u32, height: u32 },
    TooFar,
    TooNarrow,
    TooWide,
}

impl From<Kind> for CameraError {
    fn from(kind: Kind) -> Self {
        Self { kind }
    }
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            Kind::NonFinite => f.write_str("the camera has a number that is infinite or not one"),
            Kind::NoDirection => f.write_str(
                "the camera looks nowhere: its eye and target are the same, or its direction is \
                 zero",
            ),
            Kind::UpAlongView => {
                f.write_str("the camera's up vector is zero or along its direction of view")
            }
            Kind::FieldOfView => {
                f.write_str("the field of view must be more than 0 and less than π radians")
            }
            Kind::Height => f.write_str("the height that a parallel camera shows must be positive"),
            Kind::Size { width, height } => write!(
                f,
                "a picture must have 1 to {} pixels each way and at most {} in all, not \
                 {width}x{height}",
                super::Camera::MAX_SIDE,
                super::Camera::MAX_PIXELS
            ),
            Kind::TooFar => f.write_str("the eye is too far from the scene: use a parallel camera"),
            Kind::TooNarrow => f.write_str(
                "a pixel of the camera is finer than the scene's coordinates: widen its view",
            ),
            Kind::TooWide => f.write_str(
                "the parallel camera shows, or is centred on, a region too far from the scene",
            ),
        }
    }
}

impl std::error::Error for CameraError {}
