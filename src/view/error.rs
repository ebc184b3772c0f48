//! Why a camera cannot be made.

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
    Size { size: [u32; 2], max_side: u32, max_pixels: u64 },
    Samples { samples: u32 },
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
            Kind::NonFinite => f.write_str("a camera parameter is NaN or infinite"),
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
            Kind::Size { size: [width, height], max_side, max_pixels } => write!(
                f,
                "a picture must have 1 to {max_side} pixels each way and at most {max_pixels} in all, not \
                 {width}x{height}"
            ),
            Kind::Samples { samples } => write!(
                f,
                "{samples} samples each way in a pixel: there must be 1 or more, and fewer than 2³² across the picture"
            ),
            Kind::TooFar => f.write_str("the eye is too far from the scene: use a parallel camera"),
            Kind::TooNarrow => f.write_str(
                "the camera's view is so narrow that rays would be off by a thousandth of a pixel: widen it",
            ),
            Kind::TooWide => f.write_str(
                "the parallel camera shows, or is centred on, a region too far from the scene",
            ),
        }
    }
}

impl std::error::Error for CameraError {}
