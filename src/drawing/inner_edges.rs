//! Edges inside polygons, which triangulation made, and what goes through polygons along them.

use std::cmp::Ordering;

use glam::DVec3;

use super::halving::VISITED;
use super::reporter::each;
use super::table::{Table, insert};
use crate::Error;
use crate::build::progress::Watch;
use crate::exact::{Faces, PlaneId, PreparedPlane, cross};

/// A face, and which of its edges.
pub(super) type FaceEdge = (u32, u32);

/// The edges inside polygons, each of two faces. Of polygons that cross themselves or run along an edge twice, edges of
/// their outlines may be among them.
pub(super) struct InnerEdges(Table<FaceEdge, FaceEdge>);

/// Where two polygons go through one another along an edge inside one of them.
pub(super) struct Bend {
    pub(super) edge: FaceEdge,
    /// A face of the other polygon, and its edge there if that is bent, too.
    pub(super) other: u32,
    pub(super) other_edge: Option<u32>,
    /// A face of each polygon, the lower number first: of two that meet there, that of the lower number.
    pub(super) faces: [u32; 2],
}

impl InnerEdges {
    pub(super) fn of(faces: &Faces, watch: &Watch<'_>) -> Result<Self, Error> {
        let mut across = Table::default();
        // Edges of which one face was met. First inner ones with inner ones; what is left of these may be an
        // outline's on the other side.
        let mut open: Table<(usize, [[u64; 3]; 2]), FaceEdge> = Table::default();
        for is_inner in [true, false] {
            for numbered in each(watch, VISITED, &faces.numbered) {
                let face = numbered?.0;
                let edges = 0..faces.corners(face).len() as u32;
                for k in edges.filter(|&k| faces.outline_edge(face, k).is_none() == is_inner) {
                    let mut ends = faces.ends(face, k).map(|end| end.map(|c| (c + 0.0).to_bits()));
                    ends.sort_unstable();
                    let key = (faces.polygon(face), ends);
                    match open.remove(&key) {
                        Some(other) => {
                            insert(&mut across, (face, k), other)?;
                            insert(&mut across, other, (face, k))?;
                        }
                        None => insert(&mut open, key, (face, k))?,
                    }
                }
            }
        }
        Ok(Self(across))
    }

    /// The face on the other side of an edge, and which of its edges it is.
    pub(super) fn across(&self, edge: FaceEdge) -> Option<FaceEdge> {
        self.0.get(&edge).copied()
    }

    /// Where two polygons go through one another along an edge inside one of them, by a face of each: where the faces
    /// on either side of the edge lie on opposite sides of the other polygon.
    pub(super) fn bend(&self, faces: &Faces, [one, other]: [u32; 2]) -> Option<Bend> {
        if self.0.is_empty() {
            return None;
        }
        // Triangulation makes triangles.
        let edges = |face: u32| (0..3).map(move |k| (face, k));
        let mut of_one = edges(one).filter_map(|edge| self.bend_at(faces, edge, other));
        let mut of_other = edges(other).filter_map(|edge| self.bend_at(faces, edge, one));
        of_one.next().or_else(|| of_other.next())
    }

    /// The same for an edge of a polygon, and a face of the other.
    pub(super) fn bend_at(&self, faces: &Faces, edge: FaceEdge, other: u32) -> Option<Bend> {
        let across = self.across(edge)?;
        let ends = faces.ends(edge.0, edge.1);
        let is_on = |face: u32| ends.iter().all(|end| side(faces, face, end).is_eq());
        if !is_on(other) {
            return None;
        }
        let found = |other_edge: Option<u32>, behind: u32| {
            let (one, two) = (edge.0.min(across.0), other.min(behind));
            Some(Bend { edge, other, other_edge, faces: [one.min(two), one.max(two)] })
        };
        let is_on_line = |&k: &u32| {
            faces.ends(other, k).iter().all(|&end| cross(ends[0], ends[1], end) == [0; 3])
        };
        let Some(k) = (0..faces.corners(other).len() as u32).find(is_on_line) else {
            let sides = [edge, across].map(|edge| side(faces, other, &third(faces, edge)));
            let is_crossed = sides[0].is_ne() && sides[0] == sides[1].reverse();
            return found(None, other).filter(|_| {
                is_crossed && [edge, across].iter().any(|edge| faces.straddles(other, edge.0))
            });
        };
        // The other has an edge there as well: it is bent too, or ends.
        let behind = self.across((other, k)).filter(|behind| is_on(behind.0))?;
        let along = way(faces, edge);
        let is_between = |x| is_between(faces, along, [edge, across], x);
        let places = [(other, k), behind].map(is_between);
        let is_crossed = places == [Some(true), Some(false)] || places == [Some(false), Some(true)];
        found(Some(k), behind.0).filter(|_| is_crossed)
    }
}

/// On which side of a face's plane a point lies, further from it than the tolerance.
fn side(faces: &Faces, face: u32, point: &[f64; 3]) -> Ordering {
    PreparedPlane::new(faces, PlaneId::face(face)).side_beyond(faces, point)
}

/// The direction of an edge.
fn way(faces: &Faces, (face, k): FaceEdge) -> DVec3 {
    let [a, b] = faces.ends(face, k).map(DVec3::from);
    b - a
}

/// The corner of a triangle that is not on an edge.
fn third(faces: &Faces, (face, k): FaceEdge) -> [f64; 3] {
    let corners = faces.corners(face);
    corners[(k as usize + 2) % corners.len()]
}

/// Whether, turning to the left around a line, one comes from the first of two triangles at the line to a third
/// before one comes to the second; `None` if the third lies on one of the two.
fn is_between(
    faces: &Faces,
    along: DVec3,
    [from, to]: [FaceEdge; 2],
    third_edge: FaceEdge,
) -> Option<bool> {
    // Whether one triangle lies to the left of another: by the plane that runs with the line.
    let turn = |a: FaceEdge, b: FaceEdge| {
        let side = side(faces, a.0, &third(faces, b));
        if way(faces, a).dot(along) > 0.0 { side } else { side.reverse() }
    };
    let turns = [turn(from, third_edge), turn(third_edge, to)];
    let (is_left, is_right) = (turns.map(Ordering::is_gt), turns.map(Ordering::is_lt));
    match turn(from, to) {
        Ordering::Greater if is_left == [true; 2] => Some(true),
        Ordering::Greater => is_right.contains(&true).then_some(false),
        Ordering::Less if is_right == [true; 2] => Some(false),
        Ordering::Less => is_left.contains(&true).then_some(true),
        Ordering::Equal if is_left == [true; 2] => Some(true),
        Ordering::Equal => (is_right == [true; 2]).then_some(false),
    }
}
