//! Lines of the picture in floats.

use super::frame::ExactLine;
use crate::exact::lattice::{exponent_of, scaled};

/// The relative error of one rounding.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Lines that are further off in floats, in pixels, are computed from integers.
const FINE: f64 = 1.0 / (1u64 << 32) as f64;

/// A line in floats, scaled so that the longer part of its slope is near 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub(super) k: [f64; 3],
    /// The largest error of its values anywhere in the picture, computed as `k[0] + x·k[1] + y·k[2]`; and
    /// of its slope, times the picture's size.
    pub(super) error: f64,
    /// At least the length of its slope.
    pub(super) slope: f64,
}

impl Rounded {
    /// From exact coefficients, for a picture of this size.
    pub(super) fn new(exact: &ExactLine, reach: [f64; 2]) -> Self {
        let k = exact.each_ref().map(|c| c.to_f64());
        let sum = k[0].abs() + k[1].abs() * reach[0] + k[2].abs() * reach[1];
        Self::scaled(k, 8.0 * ROUNDING * sum)
    }

    pub(super) fn scaled(k: [f64; 3], error: f64) -> Self {
        let size = k[1].abs().max(k[2].abs());
        // A power of two: nothing is rounded. (A line without slope may have any scale.)
        let scale = if size > 0.0 { scaled(1.0, -exponent_of(size)) } else { 1.0 };
        Self { k: k.map(|c| c * scale), error: error * scale, slope: 1.01 * 1.42 * size * scale }
    }

    /// The same with its signs changed, if `flip`.
    pub(super) fn flipped(self, flip: bool) -> Self {
        if flip { Self { k: self.k.map(|c| -c), ..self } } else { self }
    }

    /// Whether it is off by so little that the line is not needed in integers to look at it.
    pub(super) fn is_fine(&self) -> bool {
        self.error < FINE
    }

    /// The value at a point, rounded.
    #[inline]
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.k[0] + (self.k[1] * x + self.k[2] * y)
    }
}
