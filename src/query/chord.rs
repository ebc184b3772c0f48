//! Where a ray meets a fragment, in integers.
//!
//! A fragment is closed: its edges and vertices belong to it. It is the part of its face's plane on
//! the inner sides of the planes that bound it, which are those that cut it, and for an edge of the face
//! the plane through that edge along the axis in which the face is least steep.

use std::cmp::Ordering;

use crate::exact::eye::{AtRay, ExactRay, Parameter};
use crate::exact::{EdgeLine, Faces, Plane, PlaneId, integers};
use crate::tree::Fragment;
use crate::tree::fragment::{along, plane_points};

/// A point of a ray by what defines it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// Where the ray begins.
    Start,
    /// Where the segment ends.
    End,
    /// Where the ray meets a plane.
    Plane(PlaneId),
    /// Where the ray, which lies in the plane of a face, meets the line of an edge of it.
    Edge(u32, u32),
}

/// What a ray and a fragment have in common: a point, or a segment of the ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) enter: Spot,
    pub(super) leave: Spot,
    /// The side of the fragment that the ray comes from; `Equal` if it lies in the plane.
    pub(super) facing: Ordering,
}

impl Spot {
    /// How far along the ray it is.
    pub(super) fn parameter(self, ray: &ExactRay, faces: &Faces) -> Parameter {
        match self {
            Self::Start => Parameter::ZERO,
            Self::End => Parameter::ONE,
            Self::Plane(plane) => ray.at(&faces.plane(plane)).zero(),
            Self::Edge(face, k) => ray.at(&upright(faces, face, k as usize).0).zero(),
        }
    }

    /// Three lattice points of the plane that it is on; `None` for an end of the ray.
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

/// The plane through an edge of a face and along the axis in which the face is least steep, and the
/// side of it on which the face is.
pub(super) fn upright(faces: &Faces, face: u32, k: usize) -> (Plane, Ordering) {
    let own = faces.plane(PlaneId::face(face));
    let axis = dominant_axis(faces, face);
    let corners = faces.corners(face);
    let next = if k + 1 == corners.len() { 0 } else { k + 1 };
    let inside = if own.normal()[axis] < 0 { Ordering::Greater } else { Ordering::Less };
    (Plane::upright(corners[k], corners[next], axis), inside)
}

/// The axis in which a face is least steep: the one along which its corners were moved, if they were.
fn dominant_axis(faces: &Faces, face: u32) -> usize {
    faces.dominant_axis(face).unwrap_or_else(|| faces.plane(PlaneId::face(face)).dominant_axis())
}

/// A plane that bounds a fragment.
struct Bound {
    spot: Spot,
    at: AtRay,
    /// The side of it on which the fragment is.
    inside: Ordering,
}

/// The planes that bound a fragment, along a ray.
fn bounds(ray: &ExactRay, fragment: &Fragment<'_>, faces: &Faces) -> impl Iterator<Item = Bound> {
    let face = fragment.face();
    fragment.lines().map(move |line: EdgeLine| match (line.as_cut(), line.as_edge()) {
        (Some(plane), _) => Bound {
            spot: Spot::Plane(plane),
            at: ray.at(&faces.plane(plane)),
            inside: if line.is_behind() { Ordering::Less } else { Ordering::Greater },
        },
        (None, edge) => {
            let k = edge.unwrap_or(0);
            let (plane, inside) = upright(faces, face, k as usize);
            Bound { spot: Spot::Edge(face, k), at: ray.at(&plane), inside }
        }
    })
}

/// What a ray has in common with a fragment; `None` if nothing.
pub(super) fn chord(ray: &ExactRay, fragment: &Fragment<'_>, faces: &Faces) -> Option<Chord> {
    let plane = PlaneId::face(fragment.face());
    let own = ray.at(&faces.plane(plane));
    if own.slope().is_eq() {
        return if own.start().is_eq() { in_plane(ray, fragment, faces) } else { None };
    }
    let t = own.zero();
    let is_inside = |bound: Bound| bound.at.side(&t) != bound.inside.reverse();
    let meets = ray.has(&t) && bounds(ray, fragment, faces).all(is_inside);
    let spot = Spot::Plane(plane);
    // A ray that goes to the back comes from the front.
    meets.then_some(Chord { enter: spot, leave: spot, facing: own.slope().reverse() })
}

/// The same for a ray in the plane of the fragment: it is cut off by one bound after the other
/// (Cyrus and Beck 1978).
fn in_plane(ray: &ExactRay, fragment: &Fragment<'_>, faces: &Faces) -> Option<Chord> {
    let mut enter = (Spot::Start, Parameter::ZERO);
    let mut leave =
        if ray.is_point() { Some(enter) } else { ray.end().map(|end| (Spot::End, end)) };
    for Bound { spot, at, inside } in bounds(ray, fragment, faces) {
        if at.slope().is_eq() {
            if at.start() == inside.reverse() {
                return None;
            }
            continue;
        }
        let t = at.zero();
        if at.slope() == inside {
            if t.compare(&enter.1).is_gt() {
                enter = (spot, t);
            }
        } else if leave.as_ref().is_none_or(|(_, end)| t.compare(end).is_lt()) {
            leave = Some((spot, t));
        }
        if leave.as_ref().is_some_and(|(_, end)| end.compare(&enter.1).is_lt()) {
            return None;
        }
    }
    // An endless ray leaves by one of the bounds.
    let leave = leave.map_or(enter.0, |(spot, _)| spot);
    Some(Chord { enter: enter.0, leave, facing: Ordering::Equal })
}
