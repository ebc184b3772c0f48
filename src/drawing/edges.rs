//! Edges of polygons, divided into visible and hidden runs.

use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use smallvec::SmallVec;

use super::crossings::{FaceEdge, InnerEdges};
use super::lines::{Table, ViewFrame};
use super::map::{Hidden, VisibilityMap, finish_item, sort_by, sort_unique};
use super::passes::{Depths, Passing, in_layers, parts};
use super::quadtree::{CUT, VISITED, Visible};
use super::segments::ProjectedSegment;
use crate::Error;
use crate::exact::{Faces, PlaneId};
use crate::progress::Watch;

impl VisibilityMap<'_> {
    /// Returns the edges of polygons, clipped to the picture. Each edge is divided into visible and hidden
    /// [runs](EdgeRun). With [`Hidden::Skip`], only visible runs are returned. Runs are sorted by polygon,
    /// then by edge, then from the start of the edge to its end.
    ///
    /// Visibility is as exact as the map: only the ends of runs are rounded. The polygons that have an edge
    /// do not hide the edge. Exception: if such a polygon is not planar, another part of the polygon may hide
    /// the edge. Two polygons share an edge if the edge has the same two corners in both polygons. A shared
    /// edge is returned once.
    ///
    /// These edges are left out:
    ///
    /// - edges that triangulation made inside a polygon, except silhouettes. (A polygon that is not planar
    ///   may be seen from its front on one side of such an edge, and from behind on the other side.)
    /// - edges of two polygons that lie in one plane within the [tolerance](crate::BspTree#exactness), side by side, if
    ///   both have the whole edge and no third polygon has it;
    /// - edges whose polygons are all seen exactly edge-on, or left out by the [options](super::ViewOptions);
    /// - edges along a border of the picture whose polygons are all outside the picture.
    ///
    /// [`crossings`](Self::crossings) returns the lines in which polygons intersect.
    ///
    /// Takes O(n log n) for n edges and cells, and more time with [`Hidden::Count`].
    ///
    /// # Errors
    ///
    /// If the operation was [cancelled](Self#progress).
    pub fn edges(&self, hidden: Hidden) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(if hidden == Hidden::Count { 3 } else { 2 }, |watch| {
            let (mut edges, numbers) = self.shared_edges(watch)?;
            self.collect(&mut edges, &numbers, watch)?;
            let (mut list, count) = (Vec::new(), edges.len());
            for (number, edge) in (0..).zip(&mut edges) {
                watch.work(CUT + edge.visible.len() * VISITED)?;
                sort_by(&mut edge.visible, watch, |a, b| a[0].total_cmp(&b[0]))?;
                self.add_runs(edge, |run| list.push((run, number)));
                finish_item(watch, number as usize, count);
            }
            let key = |run: &EdgeRun| (run.polygon, run.edge);
            sort_by(&mut list, watch, |(a, _), (b, _)| key(a).cmp(&key(b)))?;
            let is_own = |edge: u32, face: u32| {
                edges[edge as usize].faces.iter().any(|&(own, _)| own == face)
            };
            self.runs(list, hidden, |edge| edges[edge as usize].segment, is_own, watch)
        })
    }

    /// The requested runs of a list, in which each run has the number of its segment. With [`Hidden::Count`],
    /// hidden runs are cut where the number of polygons in front changes, not counting the segment's own
    /// faces. Counts as one phase of the progress.
    pub(super) fn runs(
        &self,
        mut list: Vec<(EdgeRun, u32)>,
        hidden: Hidden,
        segment: impl Fn(u32) -> Option<ProjectedSegment>,
        is_own: impl Fn(u32, u32) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Vec<EdgeRun>, Error> {
        list.retain(|(run, _)| run.is_visible || hidden != Hidden::Skip);
        if hidden != Hidden::Count {
            return Ok(list.into_iter().map(|(run, _)| run).collect());
        }
        let hidden = list.iter().filter(|(run, _)| !run.is_visible);
        let mut hidden: Vec<u32> = hidden.map(|&(_, number)| number).collect();
        sort_unique(&mut hidden, watch)?;
        let segments: Vec<ProjectedSegment> =
            hidden.iter().filter_map(|&number| segment(number)).collect();
        let faces = self.primitives.lines.frame.faces;
        let passes = self.in_front(Passing::new(&segments, &[], faces), true, watch)?.segments;
        let is_own = |place: u32, face: u32| is_own(hidden[place as usize], face);
        let depths = Depths::new(segments.len(), &passes, faces, is_own, watch)?;
        let mut layered = Vec::new();
        for (run, number) in list {
            let known = hidden.binary_search(&number).ok();
            let known = known.map(|place| (&segments[place].course, depths.of(place)));
            let parts = in_layers(run.ends, run.is_visible, known, watch)?.into_iter();
            layered.extend(parts.map(|(ends, layers)| EdgeRun {
                ends,
                layers: Some(layers),
                ..run
            }));
        }
        Ok(layered)
    }

    /// Adds to each edge the places where it is visible. Counts as one phase of the progress.
    fn collect(
        &self,
        all: &mut [SharedEdge],
        numbers: &Numbers,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let primitives = &self.primitives;
        // For a face and a line, the edges of the face that lie on the line.
        let mut edges: Table<(u32, u64), SmallVec<[u32; 1]>> = Table::default();
        let faces = primitives.lines.frame.faces;
        for face in 0..faces.len() as u32 {
            let corners = 0..faces.corners(face).len() as u32;
            for (k, half) in corners.zip(self.primitives.outline(face)) {
                watch.work(VISITED)?;
                if numbers.contains_key(&(face, k)) {
                    edges.entry((face, half.line())).or_default().push(k);
                }
            }
        }
        let count = self.leaves.len();
        for (i, leaf) in self.leaves.iter().enumerate() {
            watch.work(leaf.cells.len() * SIDES)?;
            for Visible { item, cell } in &leaf.cells {
                let face = primitives.face(*item);
                for (i, side) in cell.sides.iter().enumerate() {
                    let end = cell.sides[if i + 1 == cell.sides.len() { 0 } else { i + 1 }].start;
                    for &k in edges.get(&(face, side.half.line())).into_iter().flatten() {
                        let Some(&number) = numbers.get(&(face, k)) else { continue };
                        let edge = &mut all[number as usize];
                        let Some(segment) = &edge.segment else { continue };
                        let course = &segment.course;
                        let [a, b] = [side.start.at, end.at].map(|point| course.place_on(point));
                        edge.visible.push([a.min(b), a.max(b)]);
                    }
                }
            }
            finish_item(watch, i, count);
        }
        Ok(())
    }

    /// Passes the runs of an edge to a function, in the direction in which the polygon of the runs traverses
    /// the edge. There are no runs if all polygons with this edge are edge-on, or left out as back faces.
    fn add_runs(&self, edge: &SharedEdge, give: impl FnMut(EdgeRun)) {
        let Some(segment) = &edge.segment else { return };
        let ViewFrame { rays, faces } = &self.primitives.lines.frame;
        let sides = edge.faces.iter().map(|&(face, _)| self.primitives.views[face as usize].side);
        let sides: SmallVec<[Ordering; 2]> = sides.collect();
        let shows = |side: &Ordering| side.is_gt() || side.is_lt() && !rays.is_front_only();
        let fronts = sides.iter().position(|side| side.is_gt());
        let Some(owner) = fronts.or_else(|| sides.iter().position(shows)) else { return };
        let mut numbered = sides.iter().enumerate();
        // An edge along a border may have no polygon inside the picture.
        if !numbered.any(|(i, side)| shows(side) && edge.is_in_picture(faces, i, *side)) {
            return;
        }
        if edge.is_in_one_plane(faces) {
            return;
        }
        let (face, k) = edge.faces[owner];
        let (polygon, kind) = (faces.polygon(face), edge.kind(faces, &sides));
        let number = faces.outline_edge(face, k);
        let mut runs: SmallVec<[EdgeRun; 4]> = SmallVec::new();
        for (ends, is_visible) in parts(&segment.course, edge.visible.iter().copied()) {
            runs.push(EdgeRun { polygon, edge: number, kind, ends, is_visible, layers: None });
        }
        if edge.is_turned(faces, 0, owner) {
            runs.reverse();
            runs.iter_mut().for_each(|run| run.ends.swap(0, 1));
        }
        runs.into_iter().for_each(give)
    }

    /// All edges of faces that are drawn, and a table of their numbers. Edges that triangulation made are
    /// included only where a polygon that is not planar turns away: without these edges, a silhouette would
    /// have gaps.
    fn shared_edges(&self, watch: &Watch<'_>) -> Result<(Vec<SharedEdge>, Numbers), Error> {
        let primitives = &self.primitives;
        let faces = primitives.lines.frame.faces;
        let side = |face: u32| primitives.views[face as usize].side;
        let mut points: Table<[u64; 3], u32> = Table::default();
        let mut point = |corner: usize| {
            let place = faces.given_corner(corner as u32).map(|c| (c + 0.0).to_bits());
            let next = points.len() as u32;
            *points.entry(place).or_insert(next)
        };
        let mut by_points: Table<[u32; 2], u32> = Table::default();
        let inner = InnerEdges::of(faces, watch)?;
        let mut numbers = Numbers::default();
        let mut all: Vec<SharedEdge> = Vec::new();
        for face in (0..faces.len() as u32).filter(|&face| primitives.opacity(face) > 0.0) {
            let range = faces.corner_range(face);
            for k in 0..range.len() {
                watch.work(CUT)?;
                let next = if k + 1 == range.len() { range.start } else { range.start + k + 1 };
                let [a, b] = [point(range.start + k), point(next)];
                let (points, k, new) = ([a.min(b), a.max(b)], k as u32, all.len() as u32);
                let mut known: SmallVec<[FaceEdge; 2]> = SmallVec::from_slice(&[(face, k)]);
                let number = if faces.outline_edge(face, k).is_some() {
                    *by_points.entry(points).or_insert(new)
                } else {
                    // Each such edge is added once, at the second of its faces.
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
                    let segment = ProjectedSegment::new(&primitives.lines, faces.ends(first, k));
                    all.push(SharedEdge { faces: SmallVec::new(), segment, visible: vec![] });
                }
                all[number as usize].faces.extend_from_slice(&known);
                numbers.extend(known.into_iter().map(|name| (name, number)));
            }
        }
        Ok((all, numbers))
    }
}

/// The cost of the sides of a cell, in pieces that a build examines.
const SIDES: usize = 16;

/// The numbers of shared edges, by a face and the edge's number in that face.
type Numbers = Table<FaceEdge, u32>;

/// An edge of at least one face.
#[derive(Debug)]
struct SharedEdge {
    /// The faces that have the edge, each with the edge's number in the face.
    faces: SmallVec<[FaceEdge; 2]>,
    /// The first face's edge in the picture; `None` if the picture does not show the edge as a line.
    segment: Option<ProjectedSegment>,
    /// The visible parts: intervals of places along the edge.
    visible: Vec<[f64; 2]>,
}

impl Faces {
    /// The ends of a face's edge `k`.
    pub(super) fn ends(&self, face: u32, k: u32) -> [[f64; 3]; 2] {
        let corners = self.corners(face);
        let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
        [corners[k as usize], corners[next]]
    }

    /// The ends of a face's edge `k`: the given corners, before the tolerance moved them.
    pub(super) fn given_ends(&self, face: u32, k: u32) -> [[f64; 3]; 2] {
        let range = self.corner_range(face);
        let corner = range.start + k as usize;
        let next = if corner + 1 == range.end { range.start } else { corner + 1 };
        [corner, next].map(|corner| self.given_corner(corner as u32))
    }

    /// The start of a face's edge `k`: the given corner, before the tolerance moved it.
    fn given_start(&self, face: u32, k: u32) -> [f64; 3] {
        self.given_corner(self.corner_range(face).start as u32 + k)
    }
}

impl SharedEdge {
    /// Whether two of the faces traverse the edge in opposite directions.
    fn is_turned(&self, faces: &Faces, one: usize, other: usize) -> bool {
        let [a, b] = [one, other].map(|i| faces.given_start(self.faces[i].0, self.faces[i].1));
        a != b
    }

    /// Whether a face is inside the picture at the edge. `number` is the face's index in `faces`, and `side`
    /// is the side that the face shows. (A face seen from its front lies on the negative side of its edges.)
    fn is_in_picture(&self, faces: &Faces, number: usize, side: Ordering) -> bool {
        let is_turned = self.is_turned(faces, 0, number);
        let inside = if is_turned { side } else { side.reverse() };
        self.segment.is_some_and(|segment| segment.picture.is_eq() || segment.picture == inside)
    }

    /// Whether the edge only divides a flat surface: its two faces are coplanar, and neither is folded back on
    /// the other.
    fn is_in_one_plane(&self, faces: &Faces) -> bool {
        let &[(one, _), (other, _)] = &self.faces[..] else { return false };
        faces.are_coplanar(one, other) && self.angle(faces, [one, other]) < FRAC_PI_2
    }

    /// The angle at which two faces meet at the edge: 0 on a flat surface.
    fn angle(&self, faces: &Faces, both: [u32; 2]) -> f64 {
        let normal = |face: u32| {
            let normal = faces.plane(PlaneId::face(face)).normal_f64();
            (normal / normal.abs().max_element()).normalize_or_zero()
        };
        let [a, b]: [DVec3; 2] = both.map(normal);
        // Two polygons that traverse the edge in one direction have their fronts on different sides.
        let b = if self.is_turned(faces, 0, 1) { b } else { -b };
        a.cross(b).length().atan2(a.dot(b))
    }

    /// The kind of the edge, given the sides that the edge's faces show. At least one face is not edge-on.
    fn kind(&self, faces: &Faces, sides: &[Ordering]) -> EdgeKind {
        let &[(one, _), (other, _)] = &self.faces[..] else { return EdgeKind::Border };
        // If two polygons have their fronts on the same side, they traverse the edge in opposite directions.
        let is_folded = !self.is_turned(faces, 0, 1);
        let second = if is_folded { sides[1].reverse() } else { sides[1] };
        if sides[0] != second {
            return EdgeKind::Silhouette;
        }
        EdgeKind::Crease(self.angle(faces, [one, other]))
    }
}

/// The kind of the line that an [`EdgeRun`] is a part of.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EdgeKind {
    /// The run's [polygon](EdgeRun::polygon) shares the edge with no other polygon, or with several other
    /// polygons.
    Border,
    /// One polygon at the edge is seen from its front and the other polygon from behind, or one of the two
    /// polygons is seen edge-on. Seen from the eye, a body ends at a silhouette. Two parts of one polygon
    /// that is not planar can also form a silhouette. (If the fronts of the two polygons are on different
    /// sides of the surface, one polygon counts as reversed.)
    Silhouette,
    /// Two polygons meet at this angle, in radians: near 0 on a smooth surface, π if one polygon is folded
    /// back on the other.
    Crease(f64),
    /// The run's [polygon](EdgeRun::polygon) intersects the polygon with this index, in input order.
    Crossing(usize),
}

/// A part of a polygon's [edge](VisibilityMap::edges) or of a [crossing](VisibilityMap::crossings), either
/// entirely visible or entirely hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EdgeRun {
    /// The index of a polygon that has the edge and is not seen edge-on. At a crossing, the lower index of
    /// the two polygons; the [kind](EdgeKind::Crossing) contains the higher index.
    pub polygon: usize,
    /// The number of the polygon's corner where the edge begins; `None` for a crossing, and for a silhouette
    /// inside a polygon that is not planar.
    pub edge: Option<u32>,
    /// The kind of the line.
    pub kind: EdgeKind,
    /// The start and the end of the run in the picture, in pixels, in the direction in which the polygon
    /// traverses the edge. A crossing may have either direction.
    pub ends: [[f64; 2]; 2],
    /// Whether the run is visible.
    pub is_visible: bool,
    /// The number of polygons in front of a hidden run, including translucent polygons; 0 for a visible run.
    /// `None` unless the polygons were [counted](Hidden::Count).
    pub layers: Option<u32>,
}

/// Runs and gaps shorter than this, in pixels, are caused by rounding.
pub(super) const SHORTEST: f64 = 1e-6;
