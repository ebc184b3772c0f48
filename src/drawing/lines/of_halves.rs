//! The lines of halves, in floats and in integers.

use super::Lines;
use crate::drawing::frame::ExactLine;
use crate::drawing::half::{Half, STEP_BITS, STEPS};
use crate::drawing::key::rounded_edge;
use crate::drawing::rounded::{ROUNDING, Rounded};
use crate::exact::Int;

impl Lines<'_> {
    /// A half's line in floats.
    #[inline]
    pub(in crate::drawing) fn rounded(&self, half: Half) -> Rounded {
        match half.number() {
            Some(line) => self.rounded[line as usize],
            None => {
                let (axis, steps) = half.border();
                let mut k = [-(steps as f64) / STEPS, 0.0, 0.0];
                k[axis + 1] = 1.0;
                Rounded { k, error: 4.0 * ROUNDING * self.reach[axis], slope: 1.0 }
            }
        }
    }

    /// How much the parts of a line's slope may be off.
    pub(in crate::drawing) fn slope_error(&self, line: &Rounded) -> f64 {
        line.error / self.reach[0].min(self.reach[1])
    }

    /// The edge from one lattice point to another in floats, whether its line is one of these or not.
    pub(in crate::drawing) fn rounded_edge(&self, ends: [[f64; 3]; 2]) -> Rounded {
        rounded_edge(&self.frame, ends, self.reach)
    }

    /// A line in floats that is none of these.
    pub(in crate::drawing) fn rounded_other(&self, exact: &ExactLine) -> Rounded {
        Rounded::new(exact, self.reach)
    }

    /// Whether a point is in the picture or at most a pixel beyond: where errors are bounded.
    pub(in crate::drawing) fn shows(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| -1.0 <= at[axis] && at[axis] <= self.reach[axis])
    }

    /// The line of a half, in integers.
    pub(in crate::drawing) fn exact(&self, half: Half) -> ExactLine {
        match half.number() {
            Some(line) => self.exact_of(self.key(line)),
            None => {
                let (axis, steps) = half.border();
                let mut k = [-steps, 0, 0];
                k[axis + 1] = 1 << STEP_BITS;
                k.map(Int::from)
            }
        }
    }
}
