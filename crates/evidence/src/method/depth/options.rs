//! The properties of a depth buffer.

use super::format::{DepthFormat, Interpolation};
use super::rules::DepthRules;

/// The depth buffer (Catmull 1974) with depths of limited precision.
///
/// A pixel shows the face of the least stored depth. If two faces have the same stored depth, the *earlier*
/// one shows (the test `LESS` of graphics libraries). A pixel without a face is beyond any depth. Other
/// [rules](DepthRules) can be given.
///
/// # Roundings
///
/// Corners are placed in the camera's coordinates and clipped to the picture and to the range of depths in
/// `f64`. After this, every operation is rounded: to `f32` for the floating-point formats, and to `f64` for
/// the integer formats. R stands for one such rounding. The operations are:
///
/// 1. the place: x, y and the depth w, one R each;
/// 2. the position on the picture: x / (w · pixel) + half the width, y likewise;
/// 3. the interpolated value. Perspective: (a · w + b) / w with a and b from near and far, as in graphics
///    libraries. For w-buffers: 1 / w. Parallel: (w − near) / (far − near);
/// 4. the slopes −A/C and −B/C of the plane Ax + By + Cz + D = 0 through three of these points. If a face has
///    more corners, the first corner and the two neighbours that span the largest triangle with it;
/// 5. the value in a pixel, as [`Interpolation`] describes;
/// 6. the stored number: see [`DepthFormat`].
///
/// So an integer format has only the error of its steps, like hardware with wide interpolators. A
/// floating-point format has the errors of a pipeline of `f32`. (A real pipeline has larger errors in 1,
/// where it also multiplies matrices in `f32`, and in 2, where its positions have fewer bits.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthBuffer {
    /// The stored number.
    pub format: DepthFormat,
    /// The interpolation of depths from the corners to the pixels.
    pub interpolation: Interpolation,
    /// The least depth that is shown, in world units along the direction of view. Depths start at the eye, or
    /// at the centre of a parallel camera's picture. Default: `None`, the least visible depth, but at least
    /// 2⁻⁴⁴ of the furthest depth.
    pub near: Option<f64>,
    /// The largest depth that is shown. Default: `None`, the largest visible depth.
    pub far: Option<f64>,
    /// The buffer's first value, its test and its writes.
    pub rules: DepthRules,
    /// The sections of the picture, drawn one after another. Default: `None`, the whole picture at once.
    pub sections: Option<Sections>,
}

/// How a picture is drawn in sections, so that the depths of the whole picture are never in memory at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sections {
    /// The number of rows of a section; at least 1.
    pub rows: u32,
    /// The number of sections that are drawn at the same time; at least 1.
    pub threads: usize,
}

impl DepthBuffer {
    /// Creates a buffer of this format with edge functions and the scene's own range.
    pub const fn new(format: DepthFormat) -> Self {
        Self {
            format,
            interpolation: Interpolation::EdgeFunctions,
            near: None,
            far: None,
            rules: DepthRules::DEFAULT,
            sections: None,
        }
    }

    /// Sets the way to interpolate.
    #[must_use]
    pub const fn with_interpolation(self, interpolation: Interpolation) -> Self {
        Self { interpolation, ..self }
    }

    /// Sets the near and the far plane, in world units.
    #[must_use]
    pub const fn with_range(self, near: f64, far: f64) -> Self {
        Self { near: Some(near), far: Some(far), ..self }
    }

    /// Sets the rules.
    #[must_use]
    pub const fn with_rules(self, rules: DepthRules) -> Self {
        Self { rules, ..self }
    }

    /// Draws pictures in sections of `rows` rows, by `threads` threads.
    #[must_use]
    pub const fn with_sections(self, rows: u32, threads: usize) -> Self {
        Self { sections: Some(Sections { rows, threads }), ..self }
    }
}
