//! Which pixels a polygon may cover.

use std::ops::Range;

use glam::DVec3;

use super::rays::{RayOrigin, Rays, float};

/// Columns and rows of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) columns: Range<u32>,
    pub(super) rows: Range<u32>,
}

/// The largest error of a vertex's coordinate, in lattice units: 2, and room for the rounding of
/// coordinates beyond 2⁵³.
pub(crate) const VERTEX_ERROR: f64 = 2.5;
/// Margin around a polygon's projection, in pixels, for the rounding of the projection.
const MARGIN: f64 = 1.0 / 256.0;

impl Rays {
    /// All pixels whose rays may meet the convex hull of these points, each given to within
    /// `VERTEX_ERROR`; `None` if there are none.
    ///
    /// A polygon that reaches behind the eye may be anywhere in the picture, unless all of it is
    /// beyond one of the picture's sides.
    pub(super) fn window(&self, points: &[[f64; 3]]) -> Option<Window> {
        let [[left, top], [right, bottom]] = self.region(points, VERTEX_ERROR)?;
        let range = |axis: usize, low: f64, high: f64| {
            let first = low.ceil().max(0.0) as u32;
            let last = high.floor().min(f64::from(self.size[axis]) - 1.0);
            if last < 0.0 { 0..0 } else { first..last as u32 + 1 }
        };
        let window = Window { columns: range(0, left, right), rows: range(1, top, bottom) };
        if window.columns.is_empty() || window.rows.is_empty() { None } else { Some(window) }
    }

    /// A box in the picture, least and largest coordinates in pixels from the centre of the first one,
    /// that has all of the convex hull of these points, each given to within `off` lattice units along each axis;
    /// `None` if the picture shows nothing of it. It is infinite for a polygon that reaches behind the eye.
    pub(crate) fn region(&self, points: &[[f64; 3]], off: f64) -> Option<[[f64; 2]; 2]> {
        let [width, height] = self.size.map(f64::from);
        // The picture's sides, in pixels from the middle of the picture of which it is a part.
        let top = f64::from(self.above) - 0.5 * f64::from(self.whole_height);
        let sides = [[-0.5 * width, 0.5 * width], [top, top + height]];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (mut ahead, mut behind) = (true, true);
        // Whether all points so far are beyond the left, right, upper, lower side.
        let mut beyond = [true; 4];
        for &point in points {
            let (at, error) = self.in_picture(point, off);
            let (z, slack) = (at.z, error.z);
            ahead &= z > 4.0 * slack;
            behind &= z < -slack;
            for (axis, [first, last]) in sides.into_iter().enumerate() {
                let (p, e) = (at[axis], error[axis] + (first.abs().max(last.abs()) + 1.0) * slack);
                beyond[2 * axis] &= p - (first - 1.0) * z < -e;
                beyond[2 * axis + 1] &= (last + 1.0) * z - p < -e;
                let position = p / z;
                let pad = (error[axis] + position.abs() * slack) / (z - slack) + MARGIN;
                low[axis] = low[axis].min(position - pad);
                high[axis] = high[axis].max(position + pad);
            }
        }
        if behind || beyond.contains(&true) {
            return None;
        }
        if !ahead {
            return Some([[f64::NEG_INFINITY; 2], [f64::INFINITY; 2]]);
        }
        // From the middle of the whole picture to the centre of pixel 0.
        let shift = [0, 1].map(|axis: usize| -sides[axis][0] - 0.5);
        Some([low, high].map(|end| [end[0] + shift[0], end[1] + shift[1]]))
    }

    /// A lattice point in homogeneous coordinates of the picture, rounded: x and y in pixels from the
    /// centre of the first one, times the last, which is positive ahead of the eye. With bounds on their errors.
    #[cfg(feature = "drawing")]
    pub(crate) fn project(&self, point: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let (at, error) = self.in_picture(point, VERTEX_ERROR);
        let ([x, y, z], [ex, ey, ez]) = (at.to_array(), error.to_array());
        let top = f64::from(self.above) - 0.5 * f64::from(self.whole_height);
        let shift = [0.5 * f64::from(self.size[0]) - 0.5, -top - 0.5];
        // Each product and each sum is rounded once.
        let off = |part: f64, error: f64, shift: f64| {
            error + shift.abs() * ez + 4.0 * f64::EPSILON * (part.abs() + (shift * z).abs())
        };
        let errors = [off(x, ex, shift[0]), off(y, ey, shift[1]), ez];
        ([x + shift[0] * z, y + shift[1] * z, z], errors)
    }

    /// A point, given to within `off`, in multiples of right, down and the direction through the middle (the last
    /// is 1 for parallel rays), with bounds on their errors.
    #[inline]
    fn in_picture(&self, point: [f64; 3], off: f64) -> (DVec3, DVec3) {
        let (arm, parallel) = match self.pencil {
            RayOrigin::From { .. } => (-DVec3::from_array(self.origin_from(point)), false),
            RayOrigin::Along { .. } => (DVec3::from_array(point) - float(self.middle), true),
        };
        // The matrix is the inverse of one with nearly perpendicular columns. So the errors of its
        // entries, and of their products with the arm, are far below the 2⁻⁴⁶ allowed here.
        let slack = off + arm.abs().max_element() * 2f64.powi(-46);
        let [a, b, c] = self.to_picture;
        let norm = |row: DVec3| row.abs().element_sum() * slack;
        let mut at = DVec3::new(a.dot(arm), b.dot(arm), c.dot(arm));
        let mut error = DVec3::new(norm(a), norm(b), norm(c));
        if parallel {
            at.z = 1.0;
            error.z = 0.0;
        }
        (at, error)
    }
}
