//! The coefficients of lines, in floats and in integers.

use super::{Key, Lines};
use crate::drawing::frame::{ExactLine, Frame};
use crate::drawing::half::{Half, STEP_BITS, STEPS};
use crate::drawing::rounded::{ROUNDING, Rounded};
use crate::exact::{Int, PlaneId};
use crate::raster::{Sheet, edge};

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
        let (k, error) = edge(&self.frame.rays, ends);
        let rounded = Rounded::scaled(k, 4.0 * error);
        if rounded.is_fine() { rounded } else { self.rounded_other(&self.frame.edge(ends)) }
    }

    /// A line in floats that is none of these.
    pub(in crate::drawing) fn rounded_other(&self, exact: &ExactLine) -> Rounded {
        Rounded::new(exact, self.reach)
    }

    /// Whether a point is in the picture or at most a pixel beyond: where errors are bounded.
    pub(in crate::drawing) fn shows(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| -1.0 <= at[axis] && at[axis] <= self.reach[axis])
    }

    /// A line in floats.
    pub(super) fn rounded_of(&self, key: Key) -> Rounded {
        let Frame { rays, faces } = &self.frame;
        let sheet = |plane| Sheet::new(rays, faces, plane);
        let (k, error) = match key {
            Key::Edge(points) => return self.rounded_edge(self.ends(points)),
            Key::Upright(face, k) => {
                let ([a, b], axis) = self.upright(face, k);
                sheet(PlaneId::face(face)).cut(&Sheet::upright(rays, a, b, axis))
            }
            Key::Cut(face, plane) => sheet(PlaneId::face(face)).cut(&sheet(plane)),
        };
        // The picture may end half a pixel beyond the pixels that the error is for, and its lists reach a
        // pixel further.
        let rounded = Rounded::scaled(k, 4.0 * error);
        if rounded.is_fine() { rounded } else { Rounded::new(&self.exact_of(key), self.reach) }
    }

    /// A line in integers.
    pub(super) fn exact_of(&self, key: Key) -> ExactLine {
        let frame = &self.frame;
        match key {
            Key::Edge(points) => frame.edge(self.ends(points)),
            Key::Upright(face, k) => {
                let (ends, axis) = self.upright(face, k);
                frame.sheet(PlaneId::face(face)).cut(&frame.upright(ends, axis))
            }
            Key::Cut(face, plane) => frame.sheet(PlaneId::face(face)).cut(&frame.sheet(plane)),
        }
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

    /// The ends of an edge.
    fn ends(&self, points: [u32; 2]) -> [[f64; 3]; 2] {
        points.map(|point| self.frame.faces.corner(self.corners[point as usize]))
    }

    /// The ends of a face's edge `k`, and the axis along which they were moved onto the face's plane.
    fn upright(&self, face: u32, k: u32) -> ([[f64; 3]; 2], usize) {
        let corners = self.frame.faces.corners(face);
        let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
        let axis = self.frame.faces.upright_axis(face).unwrap_or_default();
        ([corners[k as usize], corners[next]], axis)
    }
}
