//! A ray, prepared to be compared with a tree, and the intersection of the ray and a fragment. Floats compute
//! the intersection if they are certain, otherwise integers do.

use std::cmp::Ordering;

use crate::exact::eye::{AtRay, ExactRay, Parameter};
use crate::exact::lattice::{MAX_CORNER, exponent_of, scaled};
use crate::exact::{EdgeLine, Faces, Lattice, Plane, PlaneId, PlaneKind, RoundedNormal, integers};
use crate::tree::Fragment;
use crate::tree::fragment::{along, plane_points};
use crate::viewpoint::Ray;

/// A ray in lattice units: exact in integers, and rounded to floats.
#[derive(Clone, Debug)]
pub(super) struct RayQuery {
    pub(super) exact: ExactRay,
    pub(super) origin: [f64; 3],
    /// The point of parameter t is at origin + t · direction. For an endless ray, the unit of t is chosen so
    /// that the largest coordinate here is from 2⁵¹ to 2⁵².
    pub(super) direction: [f64; 3],
    /// A bound that exceeds every coordinate of the difference between the origin and a corner.
    pub(super) reach: f64,
    /// The largest magnitude of a coordinate of the direction.
    pub(super) speed: f64,
    pub(super) is_endless: bool,
    /// Whether each coordinate of the direction differs from its integer form by at most 1.001 roundings.
    /// (The coordinates of the origin always satisfy this bound.)
    pub(super) is_precise: bool,
}

/// The number of bits of the largest coordinate of an endless ray's rounded direction.
const SPEED_BITS: i32 = 52;

/// For segments shorter than this share of their largest coordinate, the integer form of the direction loses
/// more than a thousandth of a rounding in floats.
///
/// The grid of a segment's ends has steps of up to 2⁻¹²² of the largest coordinate, and each end is off by
/// half a step: together 2⁻¹²². A thousandth of a rounding is 2⁻⁶³ of the length. So 2⁻⁵⁹ is enough, and this
/// constant is twice as large. (Down to 2⁻⁶⁹ the grid contains the midpoints between two floats. Then
/// rounding to the grid leads to the same float, and nothing is lost.)
///
/// The ray's origin is off by half a step as well, 2⁻¹²³ of the largest coordinate. The rounding of the ray's
/// origin is 2⁻⁵³ of the reach. The reach is at least 2⁵¹, and no lattice is further than 2¹¹⁰ from the
/// world's origin. So the loss is below a thousandth of the rounding, however far away the origin is.
///
/// Too small: floats decide wrongly. Too large: integers decide more cases.
const SHORT: f64 = 1.0 / (1u64 << 58) as f64;

impl RayQuery {
    /// A ray on a scene's lattice. `None` for a ray that meets nothing: see [`Ray`].
    pub(super) fn new(ray: Ray, lattice: &Lattice) -> Option<Self> {
        let exact = ExactRay::new(ray, lattice)?;
        let (from, direction, least) = match ray {
            Ray::Segment { from, to } => {
                let largest = lattice.largest_in_steps(&[from, to])?;
                let direction = std::array::from_fn(|axis| {
                    let [a, b] = [from[axis], to[axis]];
                    if (b - a).is_finite() {
                        lattice.length_to_lattice(b - a)
                    } else {
                        2.0 * lattice.length_to_lattice(0.5 * b - 0.5 * a)
                    }
                });
                (from, direction, largest * SHORT)
            }
            Ray::Endless { from, direction } => {
                let largest = direction.abs().max_element();
                let up = if largest > 0.0 { SPEED_BITS - 1 - exponent_of(largest) } else { 0 };
                (from, direction.to_array().map(|c| scaled(c, up)), f64::MIN_POSITIVE)
            }
        };
        let origin = lattice.to_lattice(from);
        let largest = |v: [f64; 3]| v.into_iter().fold(0.0, |max: f64, c| max.max(c.abs()));
        let (reach, speed) = (largest(origin) + MAX_CORNER, largest(direction));
        Some(Self {
            exact,
            origin,
            direction,
            reach,
            speed,
            is_endless: matches!(ray, Ray::Endless { .. }),
            is_precise: speed >= least,
        })
    }
}

/// The value of a plane's equation along a ray, rounded: `start` + t · `slope`.
struct RoundedAtRay {
    start: f64,
    slope: f64,
    /// The sum of the magnitudes of all products in the components of the normal.
    size: f64,
}

/// Error bounds of the start and the slope in [`RoundedAtRay`]. Let u = 2⁻⁵³, π the sum of
/// [`RoundedAtRay::size`], M the query's reach and d its speed. Differences of corners are exact, so a
/// component of the normal is off by 2uπᵢ. The origin minus a corner is off by 2uM, and the direction by ud.
/// With three products and two sums, the start is off by 7uπM and the slope by 6uπd; less for planes along an
/// axis. [`RayQuery::is_precise`] adds a thousandth of these errors. Too small: wrong signs pass. Too large:
/// more signs are computed in integers.
const START_ERROR: f64 = 3.6 * f64::EPSILON;
const SLOPE_ERROR: f64 = 3.1 * f64::EPSILON;

/// Error bound of a bounding plane's value at the point where the ray meets the face: start · slope of the
/// face's plane − slope · start of the face's plane, as a multiple of the two sizes, M and d. By the bounds
/// above, each product is off by (7 + 6) u for the factors and 1u for the rounding of the product. The
/// difference adds 2u: 30u in total.
const MEETING_ERROR: f64 = 15.1 * f64::EPSILON;

impl RoundedAtRay {
    #[inline]
    fn face(query: &RayQuery, faces: &Faces, face: u32) -> (Self, RoundedNormal) {
        let corners = faces.triangle(face);
        let rounded = RoundedNormal::through(corners);
        let mut at = Self { start: 0.0, slope: 0.0, size: rounded.size };
        for (i, c) in rounded.normal.into_iter().enumerate() {
            at.start += c * (query.origin[i] - corners[0][i]);
            at.slope += c * query.direction[i];
        }
        (at, rounded)
    }

    #[inline]
    fn plane(query: &RayQuery, faces: &Faces, plane: PlaneId) -> Self {
        match plane.kind() {
            PlaneKind::Face(face) => Self::face(query, faces, face).0,
            PlaneKind::Axis(axis, corner) => Self {
                start: query.origin[axis] - faces.corner(corner)[axis],
                slope: query.direction[axis],
                size: 1.0,
            },
        }
    }

    /// The plane through an edge of a face and parallel to an axis. Seen against the axis, the front of the
    /// plane is on the right of the edge.
    #[inline]
    fn edge(query: &RayQuery, corners: &[[f64; 3]], line: EdgeLine, axis: usize) -> Self {
        let k = line.as_edge().unwrap_or(0) as usize;
        let next = if k + 1 == corners.len() { 0 } else { k + 1 };
        let ([a, b], (j, k)) = ([corners[k], corners[next]], ((axis + 1) % 3, (axis + 2) % 3));
        let (x, y) = (b[k] - a[k], a[j] - b[j]);
        Self {
            start: x * (query.origin[j] - a[j]) + y * (query.origin[k] - a[k]),
            slope: x * query.direction[j] + y * query.direction[k],
            size: x.abs() + y.abs(),
        }
    }
}

/// The definition of a point of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// The start of the ray.
    Start,
    /// The end of the segment.
    End,
    /// The intersection of the ray and a plane.
    Plane(PlaneId),
    /// The intersection of the ray, which lies in the plane of a face, and the line of an edge of the face.
    Edge(u32, u32),
}

impl Spot {
    /// The parameter of the spot along the ray.
    pub(super) fn parameter(self, ray: &ExactRay, faces: &Faces) -> Parameter {
        match self {
            Self::Start => Parameter::ZERO,
            Self::End => Parameter::ONE,
            Self::Plane(plane) => ray.at(&faces.plane(plane)).zero(),
            Self::Edge(face, k) => ray.at(&upright(faces, face, k as usize).0).zero(),
        }
    }

    /// Three lattice points of the plane through the spot; `None` for an end of the ray.
    pub(super) fn grid_points(self, faces: &Faces) -> Option<[[i64; 3]; 3]> {
        match self {
            Self::Start | Self::End => None,
            Self::Plane(plane) => Some(plane_points(faces, plane)),
            Self::Edge(face, k) => {
                let corners = faces.corners(face);
                let (k, n) = (k as usize, corners.len());
                let [a, b] = [k, (k + 1) % n].map(|k| integers(corners[k]));
                Some([a, b, along(a, dominant_axis(faces, face))])
            }
        }
    }
}

/// The plane through an edge of a face and parallel to the axis in which the face is least steep, and the
/// face's side of this plane.
pub(super) fn upright(faces: &Faces, face: u32, k: usize) -> (Plane, Ordering) {
    let own = faces.plane(PlaneId::face(face));
    let axis = dominant_axis(faces, face);
    let corners = faces.corners(face);
    let next = if k + 1 == corners.len() { 0 } else { k + 1 };
    let inside = if own.normal()[axis] < 0 { Ordering::Greater } else { Ordering::Less };
    (Plane::upright(corners[k], corners[next], axis), inside)
}

/// The axis in which a face is least steep; if corners of the face were moved, the axis along which they were
/// moved.
fn dominant_axis(faces: &Faces, face: u32) -> usize {
    faces.moved_axis(face).unwrap_or_else(|| faces.plane(PlaneId::face(face)).dominant_axis())
}

/// The distance of a spot along a ray. The spot defines the distance exactly; an interval of rounded
/// parameters contains the distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    pub(super) spot: Spot,
    pub(super) low: f64,
    pub(super) high: f64,
}

/// A rounded parameter is off by less than this share of the parameter.
///
/// With ε = 2⁻⁵², a quotient of integers loses one rounding, ε / 2, and the digits of the quotient's second
/// part, some ε². The product with 1 ± this share loses another ε / 2. So this share is about four times as
/// large as necessary. Too small: depths compare in the wrong order. Too large: integers compare more depths.
const QUOTIENT_ERROR: f64 = 4.0 * f64::EPSILON;

impl Depth {
    const START: Self = Self { spot: Spot::Start, low: 0.0, high: 0.0 };
    const END: Self = Self { spot: Spot::End, low: 1.0, high: 1.0 };

    fn new((spot, t): (Spot, Parameter), ray: &ExactRay) -> Self {
        let t = ray.rescaled(&t, SPEED_BITS);
        Self { spot, low: t * (1.0 - QUOTIENT_ERROR), high: t * (1.0 + QUOTIENT_ERROR) }
    }

    /// Compares the depths of two spots of a ray, exactly.
    pub(super) fn compare(&self, other: &Self, query: &RayQuery, faces: &Faces) -> Ordering {
        if self.high < other.low {
            return Ordering::Less;
        }
        if self.low > other.high {
            return Ordering::Greater;
        }
        if self.spot == other.spot {
            return Ordering::Equal;
        }
        let [t, other] = [self, other].map(|depth| depth.spot.parameter(&query.exact, faces));
        t.compare(&other)
    }
}

/// The intersection of a ray and a fragment: a point, or a segment of the ray.
///
/// A fragment is closed: the fragment includes its edges and vertices. The bounding planes of a fragment are
/// the planes that cut the face along the fragment's edges and, for an edge of the face, the plane through
/// that edge along the axis in which the face is least steep. The fragment is the part of the face's plane on
/// the inner sides of all bounding planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    pub(super) fragment: u32,
    pub(super) face: u32,
    pub(super) enter: Depth,
    pub(super) leave: Depth,
    /// The side of the fragment that the ray comes from; `Equal` if the ray lies in the plane.
    pub(super) facing: Ordering,
}

impl Interval {
    /// Intersects a ray and a fragment. `None` if the ray and the fragment do not meet.
    pub(super) fn new(query: &RayQuery, fragment: &Fragment<'_>, faces: &Faces) -> Option<Self> {
        let guess = Self::guess(query, fragment, faces);
        guess.unwrap_or_else(|| Self::exact(&query.exact, fragment, faces))
    }

    /// Computes the intersection by floats. Floats can decide that there is no intersection, or that the
    /// intersection is a point strictly inside the fragment and strictly between the ends of the ray. `None`
    /// if floats cannot decide.
    fn guess(query: &RayQuery, fragment: &Fragment<'_>, faces: &Faces) -> Option<Option<Self>> {
        if !query.is_precise {
            return None;
        }
        let face = fragment.face();
        let (own, rounded) = RoundedAtRay::face(query, faces, face);
        let (start_error, slope_error) =
            (START_ERROR * own.size * query.reach, SLOPE_ERROR * own.size * query.speed);
        // Signs as for a ray that leads to the front.
        let turn = own.slope.signum();
        let (start, slope) = (own.start * turn, own.slope * turn);
        if slope <= 2.0 * slope_error {
            // The ray is parallel to the plane, or nearly.
            return None;
        }
        // The ray meets the plane between its ends if it begins behind and ends in front.
        let is_after = start < -start_error;
        let is_before = query.is_endless || start + slope > start_error + slope_error;
        if start > start_error || !query.is_endless && start + slope < -(start_error + slope_error)
        {
            return Some(None);
        }
        let mut is_sure = is_after && is_before;
        let error = MEETING_ERROR * own.size * query.reach * query.speed;
        let axis = faces.moved_axis(face).unwrap_or_else(|| rounded.dominant_axis());
        let inwards = -rounded.normal[axis].signum();
        let corners = faces.corners(face);
        for line in fragment.lines() {
            let (bound, inside) = match line.as_cut() {
                Some(plane) => {
                    let inside = if line.is_behind() { -1.0 } else { 1.0 };
                    (RoundedAtRay::plane(query, faces, plane), inside)
                }
                None => (RoundedAtRay::edge(query, corners, line, axis), inwards),
            };
            let side = (bound.start * slope - bound.slope * start) * inside;
            let error = error * bound.size;
            if side < -error {
                return Some(None);
            }
            is_sure &= side > error;
        }
        if !is_sure {
            return None;
        }
        let t = -start / slope;
        let off =
            (start_error + t * slope_error) / (slope - slope_error) * 1.001 + t * f64::EPSILON;
        let spot = Spot::Plane(PlaneId::face(face));
        let depth = Depth { spot, low: t - off, high: t + off };
        let facing = if own.slope < 0.0 { Ordering::Greater } else { Ordering::Less };
        let fragment = fragment.index();
        Some(Some(Self { fragment, face, enter: depth, leave: depth, facing }))
    }

    /// Computes the intersection by integers: intersects the ray with the plane of the face, and then clips
    /// the intersection by each bounding plane (Cyrus and Beck 1978).
    fn exact(ray: &ExactRay, fragment: &Fragment<'_>, faces: &Faces) -> Option<Self> {
        let face = fragment.face();
        let own = ray.at(&faces.plane(PlaneId::face(face)));
        let (mut enter, mut leave) = ((Spot::Start, Parameter::ZERO), None);
        if own.slope().is_ne() {
            enter = (Spot::Plane(PlaneId::face(face)), own.zero());
            leave = ray.has(&enter.1).then_some(enter);
            leave?;
        } else if own.start().is_ne() {
            return None;
        } else if ray.is_point() {
            leave = Some(enter);
        } else if let Some(end) = ray.end() {
            leave = Some((Spot::End, end));
        }
        for line in fragment.lines() {
            let (spot, at, inside) = bound(ray, line, face, faces);
            let is_outside = |t: &Parameter| at.side(t) == inside.reverse();
            if at.slope() == inside.reverse() {
                if leave.is_none_or(|(_, end)| is_outside(&end)) {
                    leave = Some((spot, at.zero()));
                }
            } else if is_outside(&enter.1) {
                if at.slope().is_eq() {
                    return None;
                }
                enter = (spot, at.zero());
            }
            if leave.is_some_and(|(_, end)| end.compare(&enter.1).is_lt()) {
                return None;
            }
        }
        // An endless ray leaves through a bounding plane.
        let leave = Depth::new(leave.unwrap_or(enter), ray);
        let (enter, fragment) = (Depth::new(enter, ray), fragment.index());
        // A ray that leads to the back comes from the front.
        Some(Self { fragment, face, enter, leave, facing: own.slope().reverse() })
    }

    /// Whether the interval contains a point that is not an end of the ray.
    pub(super) fn has_inner_point(&self, query: &RayQuery, faces: &Faces) -> bool {
        let Self { enter, leave, .. } = self;
        let is_before_end = query.is_endless || enter.compare(&Depth::END, query, faces).is_lt();
        is_before_end && enter.compare(&Depth::START, query, faces).is_gt()
            // An interval that is more than a point contains more than ends.
            || enter.compare(leave, query, faces).is_lt()
    }

    /// Orders intervals nearest first; at the same point, in input order.
    pub(super) fn compare(&self, other: &Self, query: &RayQuery, faces: &Faces) -> Ordering {
        // Faces are numbered in the order of their polygons.
        self.enter
            .compare(&other.enter, query, faces)
            .then(self.face.cmp(&other.face))
            .then(self.fragment.cmp(&other.fragment))
    }
}

/// A bounding plane of a fragment: the spot where the ray meets the plane, the plane's equation along the
/// ray, and the side of the plane on which the fragment lies.
fn bound(ray: &ExactRay, line: EdgeLine, face: u32, faces: &Faces) -> (Spot, AtRay, Ordering) {
    match line.as_cut() {
        Some(plane) => {
            let inside = if line.is_behind() { Ordering::Less } else { Ordering::Greater };
            (Spot::Plane(plane), ray.at(&faces.plane(plane)), inside)
        }
        None => {
            let k = line.as_edge().unwrap_or(0);
            let (plane, inside) = upright(faces, face, k as usize);
            (Spot::Edge(face, k), ray.at(&plane), inside)
        }
    }
}

#[cfg(test)]
mod tests;
