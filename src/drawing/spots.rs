//! Boxes around points in the picture, computed once for all faces at a point.

use super::cell::{NOWHERE, Rect};
use crate::raster::Rays;

/// The place of a point in the picture, with bounds on its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// A box around the point, if the point is ahead of the eye.
    around: Rect,
    /// For the left, right, upper and lower side of the picture, whether the point is certainly beyond it.
    is_beyond: [bool; 4],
    is_ahead: bool,
    is_behind: bool,
}

/// The space around a point, in pixels. Too small: boxes lose points to rounding. Too large: more boxes meet.
const MARGIN: f64 = 1.0 / 256.0;
/// Points at most this far outside the picture, in pixels, are not beyond it.
const BESIDE: f64 = 1.0;

impl Spot {
    pub(super) fn of(rays: &Rays, point: [f64; 3]) -> Self {
        let ([x, y, z], [x_error, y_error, slack]) = rays.project(point);
        let (at, errors, size) = ([x, y], [x_error, y_error], rays.size().map(f64::from));
        let (mut around, mut is_beyond) = (NOWHERE, [false; 4]);
        for axis in 0..2 {
            let far = size[axis] + BESIDE;
            let off = errors[axis] + far * slack;
            is_beyond[2 * axis] = at[axis] + BESIDE * z < -off;
            is_beyond[2 * axis + 1] = far * z - at[axis] < -off;
            let place = at[axis] / z;
            let pad = (errors[axis] + place.abs() * slack) / (z - slack) + MARGIN;
            around[0][axis] = place - pad;
            around[1][axis] = place + pad;
        }
        Self { around, is_beyond, is_ahead: z > 4.0 * slack, is_behind: z < -slack }
    }

    /// A box around the convex hull of points; `None` if the hull is outside the picture. The box is infinite if
    /// the hull reaches behind the eye.
    pub(super) fn hull(spots: impl Iterator<Item = Self>) -> Option<Rect> {
        let mut all =
            Self { around: NOWHERE, is_beyond: [true; 4], is_ahead: true, is_behind: true };
        for spot in spots {
            for axis in 0..2 {
                all.around[0][axis] = all.around[0][axis].min(spot.around[0][axis]);
                all.around[1][axis] = all.around[1][axis].max(spot.around[1][axis]);
            }
            for (all, is_beyond) in all.is_beyond.iter_mut().zip(spot.is_beyond) {
                *all &= is_beyond;
            }
            all.is_ahead &= spot.is_ahead;
            all.is_behind &= spot.is_behind;
        }
        if all.is_behind || all.is_beyond.contains(&true) {
            return None;
        }
        Some(if all.is_ahead { all.around } else { [[f64::NEG_INFINITY; 2], [f64::INFINITY; 2]] })
    }
}
