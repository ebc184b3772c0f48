//! Where the viewer is.

use glam::DVec3;

/// Where a picture is seen from: a point, or, for a parallel projection, a direction.
///
/// Every value has an order, so nothing fails or panics:
///
/// | coordinates | count as |
/// |---|---|
/// | NaN in an eye | that of the middle of the scene's bounding box |
/// | NaN in a direction | 0 |
/// | ±∞ in an eye | an eye infinitely far away: a parallel projection from that side, in which only the infinite coordinates matter, all equally |
/// | ±∞ in a direction | likewise, only the infinite coordinates matter |
/// | a direction of zeros | (0, 0, −1), as seen from the side of positive z |
///
/// Eyes are rounded to the scene's grid, or, beyond 500 extents, to one part in 2⁶¹ of their distance;
/// directions to one part in 2⁵². Of eyes beyond about 2³⁷⁰ extents only the direction counts, and a
/// coordinate beyond about 2⁹⁷⁰ extents counts as infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// The point where the eye is.
    Eye(DVec3),
    /// The direction in which the viewer looks, from infinitely far away; its length is ignored.
    Direction(DVec3),
}

impl Viewpoint {
    /// The point where the eye is.
    pub fn eye(point: impl Into<DVec3>) -> Self {
        Self::Eye(point.into())
    }

    /// The direction in which the viewer looks, from infinitely far away.
    pub fn direction(direction: impl Into<DVec3>) -> Self {
        Self::Direction(direction.into())
    }
}
