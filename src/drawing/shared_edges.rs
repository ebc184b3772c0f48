//! Edges, each by the faces that have it.

use std::cmp::Ordering;

use glam::DVec3;
use smallvec::SmallVec;

use super::edge_run::EdgeKind;
use super::halving::{CUT, VISITED};
use super::inner_edges::{FaceEdge, InnerEdges};
use super::lines::Lines;
use super::reporter::each;
use super::sight::{Course, Sight};
use super::table::{Table, insert};
use crate::Error;
use crate::build::progress::Watch;
use crate::exact::{Faces, PlaneId};

/// The number of an edge, by a face and which of its edges it is.
pub(super) type Numbers = Table<FaceEdge, u32>;

/// An edge of at least one face.
#[derive(Debug)]
pub(super) struct SharedEdge {
    /// Faces, and which of their edges it is.
    pub(super) faces: SmallVec<[FaceEdge; 2]>,
    /// Where the edge of the first of the faces is in the picture; `None` if that does not show it as a line.
    pub(super) course: Option<Course>,
    /// The side of that edge's line on which the picture lies, if it runs along a border of it; else `Equal`.
    picture: Ordering,
    /// Where it shows: places along it.
    pub(super) visible: Vec<[f64; 2]>,
}

/// All edges of faces that are drawn, and the number of each by face and edge of it. Of the edges that
/// triangulation made, those alone where a polygon that is not planar turns away: a silhouette would have gaps
/// without them.
pub(super) fn shared_edges(
    lines: &Lines<'_>,
    is_drawn: impl Fn(u32) -> bool,
    mut side: impl FnMut(u32) -> Ordering,
    watch: &Watch<'_>,
) -> Result<(Vec<SharedEdge>, Numbers), Error> {
    let faces = lines.frame.faces;
    let mut points: Table<[u64; 3], u32> = Table::default();
    let mut point = |corner: usize| -> Result<u32, Error> {
        let place = faces.given_corner(corner as u32).map(|c| (c + 0.0).to_bits());
        points.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        let next = points.len() as u32;
        Ok(*points.entry(place).or_insert(next))
    };
    let mut by_points: Table<[u32; 2], u32> = Table::default();
    let inner = InnerEdges::of(faces, watch)?;
    let mut numbers = Numbers::default();
    let mut all: Vec<SharedEdge> = Vec::new();
    for face in each(watch, VISITED, 0..faces.len() as u32) {
        let face = face?;
        if !is_drawn(face) {
            continue;
        }
        let range = faces.corner_range(face);
        for k in 0..faces.reach(face).saturating_sub(usize::from(faces.reach(face) < 3)) {
            watch.work(CUT / 2)?;
            let next = if k + 1 == range.len() { range.start } else { range.start + k + 1 };
            let [a, b] = [point(range.start + k)?, point(next)?];
            let (points, k, new) = ([a.min(b), a.max(b)], k as u32, all.len() as u32);
            let mut known: SmallVec<[FaceEdge; 2]> = SmallVec::from_slice(&[(face, k)]);
            let number = if faces.outline_edge(face, k).is_some() {
                by_points.try_reserve(1).map_err(|_| Error::out_of_memory())?;
                *by_points.entry(points).or_insert(new)
            } else {
                // Each once, with the second of its faces.
                let before = inner.across((face, k)).filter(|other| {
                    *other < (face, k) && faces.outline_edge(other.0, other.1).is_none()
                });
                let Some(other) = before.filter(|other| side(other.0) != side(face)) else {
                    continue;
                };
                known.insert(0, other);
                new
            };
            if number == new {
                let (first, k) = known[0];
                let sight = Sight::new(lines, faces.ends(first, k));
                let (course, picture) = match sight {
                    Some(Sight { course, picture, .. }) => (Some(course), picture),
                    None => (None, Ordering::Equal),
                };
                // Lists of edges that grow by an eighth are moved too often.
                all.try_reserve(1).map_err(|_| Error::out_of_memory())?;
                let faces = SmallVec::new();
                all.push(SharedEdge { faces, course, picture, visible: vec![] });
            }
            for name in known {
                all[number as usize].faces.push(name);
                insert(&mut numbers, name, number)?;
            }
        }
    }
    Ok((all, numbers))
}

impl Faces {
    /// Where a face's edge `k` begins and ends.
    pub(super) fn ends(&self, face: u32, k: u32) -> [[f64; 3]; 2] {
        let corners = self.corners(face);
        let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
        [corners[k as usize], corners[next]]
    }

    /// Where a face's edge `k` begins, as given.
    fn given_start(&self, face: u32, k: u32) -> [f64; 3] {
        self.given_corner(self.corner_range(face).start as u32 + k)
    }
}

impl SharedEdge {
    /// Whether two of the faces run along it in opposite ways.
    pub(super) fn is_turned(&self, faces: &Faces, one: usize, other: usize) -> bool {
        let [a, b] = [one, other].map(|i| faces.given_start(self.faces[i].0, self.faces[i].1));
        a != b
    }

    /// Whether the face that has this number at the edge, and shows this side, is beside it in the picture. (A face whose
    /// front is seen is where its edges are negative.)
    pub(super) fn is_in_picture(&self, faces: &Faces, number: usize, side: Ordering) -> bool {
        let is_turned = self.is_turned(faces, 0, number);
        let inside = if is_turned { side } else { side.reverse() };
        self.picture.is_eq() || self.picture == inside
    }

    /// What it is, by the sides that its faces show.
    pub(super) fn kind(&self, faces: &Faces, sides: &[Ordering]) -> EdgeKind {
        let &[(one, _), (other, _)] = &self.faces[..] else { return EdgeKind::Border };
        // Where two polygons have their fronts on one side, they run along the edge in opposite ways.
        let is_folded = !self.is_turned(faces, 0, 1);
        let second = if is_folded { sides[1].reverse() } else { sides[1] };
        if sides[0] != second || sides[0].is_eq() {
            return EdgeKind::Silhouette;
        }
        let normal = |face: u32| {
            let normal = faces.plane(PlaneId::face(face)).normal_f64();
            (normal / normal.abs().max_element()).normalize_or_zero()
        };
        let (a, b): (DVec3, DVec3) = (normal(one), normal(other));
        let b = if is_folded { -b } else { b };
        EdgeKind::Crease(a.cross(b).length().atan2(a.dot(b)))
    }
}
