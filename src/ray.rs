//! Where a query looks.

use glam::DVec3;

/// A ray, or the segment between two points: what [`BspTree::hits`](crate::BspTree::hits) follows.
///
/// Its points are `from + t * direction`, where `t` is the *parameter*. A segment's direction leads
/// from one end to the other, so that its parameters are 0 to 1, both included.
///
/// Coordinates are in the polygons' unit and are taken as they are given, up to digits below 2⁻¹²⁰ of
/// the scene's extent, or of the distance of the scene or of a point from the origin, if that is larger;
/// those of a direction, up to digits below 2⁻¹²⁰ of its largest. Near the origin, no `f64` of more than
/// 2⁻⁶⁸ of the extent has such digits: what is decided about a ray is exact for the very numbers that it
/// is made of.
///
/// | coordinates | the ray |
/// |---|---|
/// | any NaN or ±∞ | meets nothing |
/// | a point further from the scene than 2⁶⁸ extents | may meet nothing |
/// | a direction of zeros, or two equal ends | is a point: it meets what contains it |
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ray {
    /// From a point in a direction, without end. The direction may have any length: it is the unit of
    /// the parameter.
    Endless {
        /// The point where `t` is 0.
        from: DVec3,
        /// From there to the point where `t` is 1.
        direction: DVec3,
    },
    /// From a point to another.
    Segment {
        /// The point where `t` is 0.
        from: DVec3,
        /// The point where `t` is 1.
        to: DVec3,
    },
}

impl Ray {
    /// The ray from a point in a direction, without end.
    pub fn new(from: impl Into<DVec3>, direction: impl Into<DVec3>) -> Self {
        Self::Endless { from: from.into(), direction: direction.into() }
    }

    /// The segment between two points, both included.
    pub fn between(from: impl Into<DVec3>, to: impl Into<DVec3>) -> Self {
        Self::Segment { from: from.into(), to: to.into() }
    }
}
