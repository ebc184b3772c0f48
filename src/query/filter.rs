//! Where a ray meets a fragment, in floats, where these are certain.

use super::probe::RayQuery;
use crate::exact::{EdgeLine, Faces, PlaneId, PlaneKind, RoundedNormal};
use crate::tree::Fragment;

/// What floats can say.
pub(super) enum Guess {
    /// The ray does not meet the fragment.
    Misses,
    /// It meets it inside, at a parameter between these, strictly between its ends.
    Meets { low: f64, high: f64, from_front: bool },
    /// They cannot tell.
    Unsure,
}

/// A plane along a ray: `start` + t · `slope`.
struct RoundedAtRay {
    start: f64,
    slope: f64,
    /// The sum of the magnitudes of all products that the components of the normal are made of.
    size: f64,
}

/// Error bounds of a plane at a ray. Let u = 2⁻⁵³, π the sum of [`RoundedAtRay::size`], M the probe's reach and
/// d its speed. Differences of corners are exact, so a component of the normal is off by 2uπᵢ; the
/// origin less a corner by 2uM, the direction by ud. With three products and two sums, the start is off
/// by 7uπM and the slope by 6uπd, less for planes along an axis; a thousandth of that for what
/// [`RayQuery::is_precise`] allows.
/// Smaller: wrong signs pass. Larger: more is decided by integers.
const START_ERROR: f64 = 3.6 * f64::EPSILON;
const SLOPE_ERROR: f64 = 3.1 * f64::EPSILON;

/// Error bound of a bounding plane at the point where the ray meets the face: start · slope of the face's
/// plane − slope · start of the face's plane, as a multiple of the two sizes, M and d. By the bounds
/// above that is (7 + 6) u for each product and its factors, 1u for its rounding, and 2u for that of
/// the difference: 30u.
const MEETING_ERROR: f64 = 15.1 * f64::EPSILON;

impl RoundedAtRay {
    #[inline]
    fn face(probe: &RayQuery, faces: &Faces, face: u32) -> (Self, RoundedNormal) {
        let corners = faces.triangle(face);
        let rounded = RoundedNormal::through(corners);
        let mut at = Self { start: 0.0, slope: 0.0, size: rounded.size };
        for (i, c) in rounded.normal.into_iter().enumerate() {
            at.start += c * (probe.origin[i] - corners[0][i]);
            at.slope += c * probe.direction[i];
        }
        (at, rounded)
    }

    #[inline]
    fn plane(probe: &RayQuery, faces: &Faces, plane: PlaneId) -> Self {
        match plane.kind() {
            PlaneKind::Face(face) => Self::face(probe, faces, face).0,
            PlaneKind::Axis(axis, corner) => Self {
                start: probe.origin[axis] - faces.corner(corner)[axis],
                slope: probe.direction[axis],
                size: 1.0,
            },
        }
    }

    /// The plane through an edge of a face and along an axis.
    #[inline]
    fn edge(probe: &RayQuery, corners: &[[f64; 3]], line: EdgeLine, axis: usize) -> Self {
        let k = line.as_edge().unwrap_or(0) as usize;
        let next = if k + 1 == corners.len() { 0 } else { k + 1 };
        Self::upright(probe, &corners[k], &corners[next], axis)
    }

    /// The plane through two corners and along an axis, in front on the right of the way from one to the
    /// other, seen against the axis.
    #[inline]
    fn upright(probe: &RayQuery, a: &[f64; 3], b: &[f64; 3], axis: usize) -> Self {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let (x, y) = (b[k] - a[k], a[j] - b[j]);
        Self {
            start: x * (probe.origin[j] - a[j]) + y * (probe.origin[k] - a[k]),
            slope: x * probe.direction[j] + y * probe.direction[k],
            size: x.abs() + y.abs(),
        }
    }
}

/// Whether the beginning of a ray certainly is off the plane of a face.
pub(super) fn is_off_plane(probe: &RayQuery, faces: &Faces, face: u32) -> bool {
    let (own, _) = RoundedAtRay::face(probe, faces, face);
    own.start.abs() > START_ERROR * own.size * probe.reach
}

/// Whether a ray meets a fragment, as far as floats can tell.
pub(super) fn guess(probe: &RayQuery, fragment: &Fragment<'_>, faces: &Faces) -> Guess {
    if !probe.is_precise {
        return Guess::Unsure;
    }
    let face = fragment.face();
    let (own, rounded) = RoundedAtRay::face(probe, faces, face);
    let (start_error, slope_error) =
        (START_ERROR * own.size * probe.reach, SLOPE_ERROR * own.size * probe.speed);
    // As if the ray went to the front.
    let turn = own.slope.signum();
    let (start, slope) = (own.start * turn, own.slope * turn);
    if slope <= 2.0 * slope_error {
        // Along the plane, or nearly.
        return Guess::Unsure;
    }
    // It meets the plane between its ends if it begins behind and ends in front.
    let is_after = start < -start_error;
    let is_before = probe.is_endless || start + slope > start_error + slope_error;
    if start > start_error || !probe.is_endless && start + slope < -(start_error + slope_error) {
        return Guess::Misses;
    }
    let mut is_sure = is_after && is_before;
    let error = MEETING_ERROR * own.size * probe.reach * probe.speed;
    let axis = faces.dominant_axis(face).unwrap_or_else(|| rounded.dominant_axis());
    let inwards = -rounded.normal[axis].signum();
    let corners = faces.corners(face);
    for line in fragment.lines() {
        let (bound, inside) = match line.as_cut() {
            Some(plane) => {
                let inside = if line.is_behind() { -1.0 } else { 1.0 };
                (RoundedAtRay::plane(probe, faces, plane), inside)
            }
            None => (RoundedAtRay::edge(probe, corners, line, axis), inwards),
        };
        let side = (bound.start * slope - bound.slope * start) * inside;
        let error = error * bound.size;
        if side < -error {
            return Guess::Misses;
        }
        is_sure &= side > error;
    }
    if !is_sure {
        return Guess::Unsure;
    }
    let t = -start / slope;
    let off = (start_error + t * slope_error) / (slope - slope_error) * 1.001 + t * f64::EPSILON;
    Guess::Meets { low: t - off, high: t + off, from_front: own.slope < 0.0 }
}
