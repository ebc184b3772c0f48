//! The formats of stored depths, and the values that are interpolated for them.

use std::fmt;
use std::marker::PhantomData;

use glam::DVec3;

use super::super::clip::Range;
use super::super::space::CameraSpace;
use super::gradient::Sample;
use crate::Precision;

/// The content of a depth buffer.
///
/// With n and f the near and the far plane's depths, z is the depth after the perspective divide, as in
/// graphics libraries: f (w − n) / (w (f − n)), 0 at the near plane and 1 at the far plane. Half of the
/// values of z are used for depths below 2 n. For parallel cameras, z is (w − n) / (f − n).
///
/// Lapidous & Jiao, "Optimal depth buffer for low-cost graphics hardware" (1999), compare these and
/// more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthFormat {
    /// z in steps of 1 / (2^bits − 1), rounded to the nearest; 1 to 32 bits.
    Integer(u8),
    /// z as an `f32`. Most `f32` numbers are near 0, where z is small and depths are near. So far depths have
    /// the worst resolution.
    Float,
    /// 1 − z as an `f32`, interpolated as n (f − w) / (w (f − n)), where larger numbers are
    /// nearer. The uneven steps of z and of `f32` almost cancel.
    FloatReversed,
    /// The depth w itself, linear between near and far, in steps of 1 / (2^bits − 1): 1 / w is
    /// interpolated and inverted in each pixel.
    LinearInteger(u8),
    /// The depth w itself as an `f32`: 1 / w is interpolated and inverted in each pixel.
    LinearFloat,
}

impl DepthFormat {
    /// Whether all steps are rounded to `f32`.
    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::Float | Self::FloatReversed | Self::LinearFloat)
    }
}

impl fmt::Display for DepthFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(bits) => write!(f, "z {bits}"),
            Self::Float => f.write_str("z f32"),
            Self::FloatReversed => f.write_str("z f32 reversed"),
            Self::LinearInteger(bits) => write!(f, "w {bits}"),
            Self::LinearFloat => f.write_str("w f32"),
        }
    }
}

/// The interpolation of depths from the corners of a face to the pixels within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// By the plane's equation in each pixel: z₀ + (y − y₀)·(−B/C) + (x − x₀)·(−A/C), from the left. The
    /// pixels that a face covers are decided exactly, so there are no spills. A face within the range of
    /// depths has no holes either. A face that leaves the range, as every face that reaches behind the eye
    /// does, is cut off there by its depths in `f64`. If the eye touches a face, its whole visible part may
    /// be cut off.
    EdgeFunctions,
    /// Scanline by scanline, as in Catmull's thesis (1974) and, without a buffer, in Wylie, Romney, Evans &
    /// Erdahl (1967) and Bouknight (1970). x and z grow by a constant along the edges from one scanline to
    /// the next, and z by −A/C from one pixel to the next. The same sums decide which pixels a face covers,
    /// so pixels at its edges may be missing or superfluous.
    Incremental,
    /// Trapezoid by trapezoid: between the heights of two vertices a convex face has one edge on the left and
    /// one on the right. Let m be the slope of the left edge. From one scanline to the next, x grows by 1/m
    /// and z by −(A/m + B)/C; if the edge is vertical, z grows by −B/C. From pixel to pixel, z grows by −A/C.
    /// (In textbooks, y points upwards and scanlines are taken from above: x − 1/m, and z + (A/m + B)/C.) The
    /// sums begin again in each trapezoid, at the ends of the edges.
    Trapezoids,
    /// Edges in integers, as Bresenham (1965) walks along lines: vertices are rounded to 1/256 of a pixel.
    /// After this rounding, the pixel centres between two edges are exact. z follows from the plane's
    /// equation at the first pixel of a scanline, and grows by −A/C from there.
    IntegerEdges,
}

impl Interpolation {
    /// All ways to interpolate.
    pub const ALL: [Self; 4] =
        [Self::EdgeFunctions, Self::Incremental, Self::Trapezoids, Self::IntegerEdges];
}

/// Converts depths to interpolated values, and interpolated values to stored numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale<P> {
    format: DepthFormat,
    range: Range,
    perspective: bool,
    /// The interpolated value is a · w + b, divided by w for a perspective.
    a: f64,
    b: f64,
    /// The largest step of an integer format.
    steps: f64,
    precision: PhantomData<P>,
}

impl<P: Precision> Scale<P> {
    pub(super) fn new(format: DepthFormat, range: Range, perspective: bool) -> Self {
        let Range { near, far } = range;
        let (a, b) = match (format, perspective) {
            (DepthFormat::FloatReversed, true) => (-near / (far - near), near * far / (far - near)),
            (DepthFormat::LinearInteger(_) | DepthFormat::LinearFloat, true) => (0.0, 1.0),
            (_, true) => (far / (far - near), -near * far / (far - near)),
            (DepthFormat::FloatReversed, false) => (-1.0 / (far - near), far / (far - near)),
            (_, false) => (1.0 / (far - near), -near / (far - near)),
        };
        let steps = match format {
            DepthFormat::Integer(bits) | DepthFormat::LinearInteger(bits) => {
                2f64.powi(i32::from(bits.clamp(1, 32))) - 1.0
            }
            _ => 1.0,
        };
        let (a, b) = (P::round(a), P::round(b));
        Self { format, range, perspective, a, b, steps, precision: PhantomData }
    }

    /// The number of steps of an integer format.
    pub(super) fn steps(&self) -> f64 {
        self.steps
    }

    /// The least and the largest key: the keys of the near and the far plane.
    pub(super) fn ends(&self) -> [u32; 2] {
        let Range { near, far } = self.range;
        match self.format {
            DepthFormat::Integer(_) | DepthFormat::LinearInteger(_) => [0, self.steps as u32],
            DepthFormat::Float => [bits(0.0), bits(1.0)],
            DepthFormat::FloatReversed => [!bits(1.0), !bits(0.0)],
            DepthFormat::LinearFloat if self.perspective => [bits(near), bits(far)],
            DepthFormat::LinearFloat => [bits(0.0), bits(1.0)],
        }
    }

    /// The interpolated value of a depth w, which is rounded already.
    pub(super) fn value(&self, w: f64) -> f64 {
        let value = P::round(P::round(self.a * w) + self.b);
        if self.perspective { P::round(value / w) } else { value }
    }

    /// A vertex on the picture with its interpolated value.
    pub(super) fn sample(&self, space: &CameraSpace, at: DVec3) -> Sample {
        let [x, y, w] = at.to_array().map(P::round);
        let pixel = P::round(space.pixel);
        let unit = if self.perspective { P::round(w * pixel) } else { pixel };
        let [width, height] = space.size.map(f64::from);
        let position = |c: f64, side: f64| P::round(P::round(c / unit) + 0.5 * side);
        Sample { x: position(x, width), y: position(y, height), value: self.value(w) }
    }

    /// The stored number of an interpolated value. Smaller numbers are nearer.
    #[inline]
    pub(super) fn key(&self, value: f64) -> u32 {
        match self.format {
            DepthFormat::Integer(_) => self.step(value),
            DepthFormat::Float => bits(value.clamp(0.0, 1.0)),
            DepthFormat::FloatReversed => !bits(value.clamp(0.0, 1.0)),
            DepthFormat::LinearInteger(_) => {
                let Range { near, far } = self.range;
                self.step(if self.perspective {
                    (1.0 / value - near) / (far - near)
                } else {
                    value
                })
            }
            DepthFormat::LinearFloat if self.perspective => {
                let Range { near, far } = self.range;
                bits(P::round(1.0 / value).clamp(near, far))
            }
            DepthFormat::LinearFloat => bits(value.clamp(0.0, 1.0)),
        }
    }

    /// The nearest step; values beyond an end give the step of this end.
    #[inline]
    fn step(&self, value: f64) -> u32 {
        // A conversion alone, which limits the result to 0 or more: `round` is a function call on some
        // machines.
        ((value * self.steps + 0.5) as u32).min(self.steps as u32)
    }
}

/// The bits of a non-negative number as an `f32`. Their order as integers is the order of the numbers.
#[inline]
fn bits(value: f64) -> u32 {
    (value as f32 + 0.0).to_bits()
}
