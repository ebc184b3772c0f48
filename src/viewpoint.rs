//! Viewpoints, rays and frusta.

use std::cmp::Ordering;

use glam::{DMat4, DVec3, DVec4};
use smallvec::SmallVec;

/// The point from which a picture is seen, or the direction of view of a parallel projection.
///
/// Every value of a coordinate has a meaning; no call fails or panics:
///
/// | coordinates | count as |
/// |---|---|
/// | NaN in an eye | the coordinate of the centre of the scene's bounding box |
/// | NaN in a direction | 0 |
/// | ±∞ in an eye | an eye infinitely far away, so a parallel projection from that side: infinite coordinates count as ±1, finite coordinates as 0 |
/// | ±∞ in a direction | infinite coordinates count as ±1, finite coordinates as 0 |
/// | a direction of zeros | (0, 0, −1), a view from the side of positive z |
///
/// Viewpoints are rounded before use. The *extent* is the longest side of the scene's bounding box:
///
/// | viewpoint | rounded to |
/// |---|---|
/// | an eye up to 500 extents away | the tree's [grid](crate::BspTree::grid) |
/// | an eye further away | one part in 2⁶¹ of its distance |
/// | an eye beyond about 2³⁷⁰ extents | a direction |
/// | an eye with a coordinate beyond about 2⁹⁷⁰ extents | an eye with that coordinate infinite |
/// | a direction | one part in 2⁵² |
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// The point where the eye is.
    Eye(DVec3),
    /// The direction in which the viewer looks, from infinitely far away; the vector's length is ignored.
    Direction(DVec3),
}

impl Viewpoint {
    /// Creates a viewpoint at a point, the eye.
    pub fn eye(point: impl Into<DVec3>) -> Self {
        Self::Eye(point.into())
    }

    /// Creates a viewpoint infinitely far away, given the direction in which the viewer looks.
    pub fn direction(direction: impl Into<DVec3>) -> Self {
        Self::Direction(direction.into())
    }
}

/// The visible side of a polygon or plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Facing {
    /// The front: corners are counter-clockwise, and the normal points to the eye.
    Front,
    /// The back: corners are clockwise, and the normal points away from the eye.
    Back,
    /// Neither: the eye lies in the plane, or the direction is parallel to the plane.
    EdgeOn,
}

/// The sign of a distance from the plane: positive is the front.
impl From<Ordering> for Facing {
    fn from(side: Ordering) -> Self {
        match side {
            Ordering::Greater => Self::Front,
            Ordering::Less => Self::Back,
            Ordering::Equal => Self::EdgeOn,
        }
    }
}

/// The sign of a distance from the plane: the front is positive.
impl From<Facing> for Ordering {
    fn from(facing: Facing) -> Self {
        match facing {
            Facing::Front => Self::Greater,
            Facing::Back => Self::Less,
            Facing::EdgeOn => Self::Equal,
        }
    }
}

/// A ray, or the segment between two points, as for [`BspTree::hits`](crate::BspTree::hits).
///
/// The points of the ray are `from + t * direction`, where `t` is the *parameter*. A segment's direction is
/// the difference of its ends, so its parameters are 0 to 1, both included.
///
/// Coordinates are in the polygons' unit. All decisions about a ray are exact for the given coordinates,
/// except that very small digits are ignored:
///
/// - in a direction, digits below 2⁻¹²⁰ of the direction's largest coordinate;
/// - in a point, digits below 2⁻¹²⁰ of the largest of these lengths: the extent (the longest side of the
///   scene's bounding box), the distance of the scene from the origin, and the distances of the ray's points
///   from the origin. Near the origin, an `f64` larger than 2⁻⁶⁸ of the extent has no such digits.
///
/// | coordinates | the ray |
/// |---|---|
/// | any NaN or ±∞ | meets nothing |
/// | a point further from the scene than 2⁶⁸ extents | may meet nothing |
/// | a direction of zeros, or two equal ends | is a point, and meets the polygons that contain the point |
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ray {
    /// A ray from a point in a direction, without end. The direction may have any length; that length is the
    /// unit of the parameter.
    Endless {
        /// The point where `t` is 0.
        from: DVec3,
        /// The vector to the point where `t` is 1.
        direction: DVec3,
    },
    /// The segment from one point to another.
    Segment {
        /// The point where `t` is 0.
        from: DVec3,
        /// The point where `t` is 1.
        to: DVec3,
    },
}

impl Ray {
    /// Creates the ray from a point in a direction, without end.
    pub fn new(from: impl Into<DVec3>, direction: impl Into<DVec3>) -> Self {
        Self::Endless { from: from.into(), direction: direction.into() }
    }

    /// Creates the segment between two points, both included.
    pub fn between(from: impl Into<DVec3>, to: impl Into<DVec3>) -> Self {
        Self::Segment { from: from.into(), to: to.into() }
    }
}

/// A convex region: the points in front of several planes, such as the four sides of a camera's view.
///
/// A plane is given by a normal, of any length, and an offset. The points p with `normal.dot(p) >= offset`
/// are in front of the plane; all other points are outside the region. Without planes, the region is the
/// whole space. A plane with an infinite or NaN number excludes no point.
///
/// ```
/// use binspace::Frustum;
/// use binspace::glam::DVec3;
///
/// // 1 ≤ x ≤ 2.
/// let slab = Frustum::new([(DVec3::X, 1.0), (DVec3::NEG_X, -2.0)]);
/// assert!(slab.meets([DVec3::ZERO, DVec3::splat(1.5)]));
/// assert!(!slab.meets([DVec3::ZERO, DVec3::splat(0.5)]));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frustum {
    planes: SmallVec<[(DVec3, f64); 6]>,
}

impl Frustum {
    /// The region without planes: the whole space.
    pub const EVERYWHERE: Self = Self { planes: SmallVec::new_const() };

    /// Creates the region of the points in front of all these planes.
    pub fn new(planes: impl IntoIterator<Item = (DVec3, f64)>) -> Self {
        let mut all = Self::default();
        // Pushes one by one, because a wrong size hint must not allocate memory.
        planes.into_iter().for_each(|plane| all.planes.push(plane));
        all
    }

    /// Creates the region of a box, given by the box's least and largest coordinates. With a
    /// [`Culling`](crate::Culling), orders keep the [fragments](crate::Fragment) whose bounding boxes meet
    /// the region. [`BspTree::fragments_in`](crate::BspTree::fragments_in) finds exactly the fragments that
    /// meet the region.
    ///
    /// ```
    /// use binspace::glam::DVec3;
    /// use binspace::{BspTree, Culling, Frustum, Viewpoint};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build((0..100).map(|k| square(f64::from(k))))?;
    /// let region = Frustum::from_box([DVec3::new(0.2, 0.2, 6.5), DVec3::new(0.7, 0.4, 9.0)]);
    /// let culling = Culling::NONE.with_frustum(region);
    /// let order = tree.order(Viewpoint::direction([0.0, 0.0, 1.0])).front_to_back();
    /// let inside = order.culled(&culling).into_iter().map(|fragment| fragment.polygon());
    /// assert!(inside.eq([7, 8, 9]));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn from_box([low, high]: [DVec3; 2]) -> Self {
        let sides = |axis: usize| {
            let normal = DVec3::AXES[axis];
            [(normal, low[axis]), (-normal, -high[axis])]
        };
        Self::new([0, 1, 2].map(sides).into_iter().flatten())
    }

    /// Creates the region of the points that a matrix maps into −w ≤ x ≤ w and −w ≤ y ≤ w. For a projection
    /// matrix of OpenGL, Vulkan, Direct3D or WebGPU, the camera sees exactly this region: the planes through
    /// the eye and the four sides of the picture bound it. Depth is ignored, so there is no near and no far
    /// plane.
    ///
    /// Rounding of the matrix may exclude points exactly on the sides. To include them, use a slightly wider
    /// projection.
    pub fn from_matrix(matrix: DMat4) -> Self {
        let [x, y, w] = [matrix.row(0), matrix.row(1), matrix.row(3)];
        // Two opposite sides together imply w ≥ 0, but a separate plane for w ≥ 0 rejects more boxes.
        Self::new([w + x, w - x, w + y, w - y, w].map(|row: DVec4| (row.truncate(), -row.w)))
    }

    /// Returns the planes that bound the region, each as a normal and an offset.
    pub fn planes(&self) -> &[(DVec3, f64)] {
        &self.planes
    }

    /// Returns whether a box, given by the box's least and largest coordinates, may have points in the
    /// region: whether no plane has the whole box behind it.
    ///
    /// Rounding never makes the result false: the test enlarges the box by about 10⁻¹⁵ of the box's distance
    /// from the origin. The result is also true for a box that lies outside the region, but behind no single
    /// plane.
    pub fn meets(&self, [low, high]: [DVec3; 2]) -> bool {
        let reach = low.abs().max(high.abs());
        !self.planes.iter().any(|&(normal, offset)| {
            let size = normal.abs().dot(reach) + offset.abs();
            let furthest = DVec3::select(normal.cmpgt(DVec3::ZERO), high, low);
            normal.dot(furthest) < offset - (size * ROUNDINGS + f64::MIN_POSITIVE)
        })
    }
}

/// A bound on the roundings of a scalar product of three terms, of the comparison, and of the bound itself,
/// as a share of the sum of the terms' magnitudes.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

#[cfg(test)]
mod frustum_tests {
    use super::*;

    #[test]
    fn a_matrix_keeps_the_points_that_it_maps_into_the_picture() {
        let view = DMat4::from_translation(DVec3::new(0.0, 0.0, -5.0));
        // A perspective of 1.5 radians, whose width is 1.5 times its height, with w = −z.
        let mut perspective = DMat4::from_scale(DVec3::new(1.0 / 1.5, 1.0, -1.0) / 0.75_f64.tan());
        (perspective.z_axis.w, perspective.w_axis.w) = (-1.0, 0.0);
        let frustum = Frustum::from_matrix(perspective * view);
        let meets = |x: f64, y: f64, z: f64| frustum.meets([DVec3::new(x, y, z); 2]);
        // From z = 5 along −z: half the height at distance 5 is 5 tan 0.75 = 4.66.
        assert!(meets(0.0, 4.6, 0.0) && !meets(0.0, 4.7, 0.0));
        assert!(meets(-6.9, 0.0, 0.0) && !meets(-7.1, 0.0, 0.0));
        assert!(meets(0.0, 0.0, 4.99) && !meets(0.0, 0.0, 5.01) && meets(0.0, 0.0, -1e9));
    }

    #[test]
    fn planes_with_nan_or_infinite_numbers_reject_no_box() {
        let boxes = [[DVec3::ZERO; 2], [DVec3::MIN, DVec3::MAX], [DVec3::splat(1e300); 2]];
        let numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        for bounds in boxes {
            for number in numbers {
                assert!(Frustum::new([(DVec3::X, number)]).meets(bounds));
                assert!(Frustum::new([(DVec3::new(0.0, number, 1.0), 0.0)]).meets(bounds));
            }
            assert!(Frustum::default().meets(bounds));
        }
    }
}
