//! The space in which methods decide.

use std::fmt;

/// The space in which a method decides visibility: I. E. Sutherland, R. F. Sproull & R. A. Schumacker, "A
/// characterization of ten hidden-surface algorithms" (1974).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Among the polygons of the scene, at any resolution of the picture.
    Object,
    /// In each pixel.
    Image,
    /// In both: priorities among the polygons, and overlaps in the picture.
    Both,
    /// The method does not decide visibility.
    Neither,
}

impl fmt::Display for Space {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Object => "object space",
            Self::Image => "image space",
            Self::Both => "both",
            Self::Neither => "neither",
        })
    }
}
