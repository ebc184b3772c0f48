//! Intersections: pairs of faces that cross each other, and the visible parts of the lines in which the faces
//! cross.

use std::cmp::Ordering;
use std::collections::hash_map::Entry;

use glam::DVec3;
use smallvec::SmallVec;

use super::cell::Cell;
use super::edges::{EdgeKind, EdgeRun, SHORTEST};
use super::graph::Pair;
use super::lines::{HalfPlane, Table};
use super::map::{Hidden, VisibilityMap, each, finish_item, sort_by, sort_unique};
use super::pairs::{Found, sorted};
use super::passes::parts;
use super::primitives::Primitives;
use super::quadtree::{CUT, Growth, NARROWED, VISITED, found_in};
use super::segments::ProjectedSegment;
use crate::exact::{Faces, PlaneId, PreparedPlane, cross};
use crate::progress::Watch;
use crate::{Error, parallel_map};

/// A side of a cell on the line of a cut.
#[derive(Clone, Copy, Debug)]
struct CutSide {
    /// The half-plane on which the line is positive.
    line: HalfPlane,
    face: u32,
    /// The face's edge on this line, if the polygon continues across that edge.
    inner: Option<FaceEdge>,
    /// Whether the cell is on the negative side of the line.
    is_negative: bool,
    /// The ends, as places along the line and in the picture.
    places: [f64; 2],
    ends: [[f64; 2]; 2],
}

/// The common part of two cut sides: a visible part of a crossing.
#[derive(Clone, Copy, Debug)]
struct CommonSide {
    line: HalfPlane,
    /// The faces, the lower number first. If two faces of one polygon meet at the line, the face of the lower
    /// number stands for both, even if only the other face is visible.
    faces: [u32; 2],
    /// The ends, as places along the line and in the picture.
    places: [f64; 2],
    ends: [[f64; 2]; 2],
}

/// Whether two faces, the lower number first, pass through each other. A coplanar neighbour's plane may decide in one
/// line.
type Known = Table<(HalfPlane, [u32; 2]), bool>;

/// For each line of a cut and each face that reaches through the planes of other faces in this line, the other faces.
type Through = Table<(HalfPlane, u32), SmallVec<[u32; 2]>>;

impl VisibilityMap<'_> {
    /// Returns the lines in which polygons intersect, as [runs](EdgeRun) of the kind [`EdgeKind::Crossing`].
    /// Each run is returned once: [`EdgeRun::polygon`] is the lower number of the two polygons, and the kind
    /// contains the higher number. An edge that only touches another polygon is not a crossing;
    /// [`edges`](Self::edges) returns such edges.
    ///
    /// A point of a crossing is visible if one polygon is visible on one side of the line at the point, and
    /// the other polygon is visible on the other side. Crossings are as exact as the map: only the ends of
    /// runs are rounded. At the common edge of two triangles of a triangulated polygon, another polygon
    /// crosses the triangulated polygon if the other polygon lies between the two triangles. A corner no
    /// further from a polygon's plane than the [tolerance](crate::BspTree#exactness) is treated as on the
    /// plane.
    ///
    /// With [`Hidden::Keep`] and [`Hidden::Count`], hidden runs are returned too, but only for some pairs of
    /// polygons: those with visible runs, and those of which each polygon has corners on both sides of the other
    /// polygon's plane, further from that plane than the tolerance. If a polygon is triangulated, each of its
    /// triangles has separate runs.
    ///
    /// Takes O(n log n) for n cells of opaque polygons. With translucent polygons, n also includes the parts
    /// of the picture that [`regions`](Self::regions) are made of. With hidden runs, n also includes all
    /// polygons, and the time is longer if many of their bounding boxes overlap, as at the tip of a cone.
    ///
    /// # Errors
    ///
    /// If the operation was [cancelled](Self#progress).
    pub fn crossings(&self, hidden: Hidden) -> Result<Vec<EdgeRun>, Error> {
        match hidden {
            Hidden::Skip => self.visible_crossings(),
            Hidden::Keep => self.all_crossings(4, hidden),
            Hidden::Count => self.all_crossings(5, hidden),
        }
    }

    fn visible_crossings(&self) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(2, |watch| {
            let inner = InnerEdges::of(self.primitives.lines.frame.faces, watch)?;
            let common = self.common_sides(&inner, watch)?;
            let mut runs = self.visible_runs(common, watch)?;
            sort_by(&mut runs, watch, |a, b| a.polygon.cmp(&b.polygon))?;
            Ok(runs)
        })
    }

    /// The runs that some common sides of cells make together.
    fn visible_runs(
        &self,
        mut common: Vec<CommonSide>,
        watch: &Watch<'_>,
    ) -> Result<Vec<EdgeRun>, Error> {
        let key = |side: &CommonSide| (side.line, self.polygons_of(side.faces));
        sort_by(&mut common, watch, |a, b| {
            key(a).cmp(&key(b)).then(a.places[0].total_cmp(&b.places[0]))
        })?;
        // Crossings of two translucent polygons are found from either side.
        let mut joined: Vec<CommonSide> = Vec::new();
        for side in common {
            match joined.last_mut() {
                Some(before)
                    if key(before) == key(&side)
                        && side.places[0] <= before.places[1] + SHORTEST =>
                {
                    if side.places[1] > before.places[1] {
                        before.places[1] = side.places[1];
                        before.ends[1] = side.ends[1];
                    }
                }
                _ => joined.push(side),
            }
        }
        joined.retain(|side| side.places[1] - side.places[0] >= SHORTEST);
        Ok(joined.iter().map(|side| self.run(side.faces, side.ends, true)).collect())
    }

    /// The common parts of two sides of cells, line by line. The two cells lie on opposite sides of the line,
    /// and the faces of the cells cross each other in the line. Counts as two phases of the progress.
    fn common_sides(
        &self,
        inner: &InnerEdges,
        watch: &Watch<'_>,
    ) -> Result<Vec<CommonSide>, Error> {
        let mut sides = self.cut_sides(inner, watch)?;
        sort_by(&mut sides, watch, |a, b| {
            a.line.cmp(&b.line).then(a.places[0].total_cmp(&b.places[0]))
        })?;
        let mut common = Vec::new();
        let (through, mut known) = (self.through(watch)?, Known::default());
        for line in sides.chunk_by(|a, b| a.line == b.line) {
            for (i, a) in line.iter().enumerate() {
                let ahead = line[i + 1..].iter().take_while(|b| b.places[0] < a.places[1]);
                for b in each(watch, VISITED, ahead) {
                    let b = b?;
                    if b.is_negative == a.is_negative {
                        continue;
                    }
                    let part = CommonSide::new([a, b], inner);
                    if self.do_cross([a, b], &part, inner, &through, &mut known, watch)? {
                        common.push(part);
                    }
                }
            }
        }
        Ok(common)
    }

    /// All sides of cells that lie on lines of cuts or of edges inside polygons, whatever made the sides.
    /// Several planes may have cut along one line. If a border of a tile or a third polygon's edge lies on
    /// the line, cells that end there were not cut again.
    fn cut_sides(&self, inner: &InnerEdges, watch: &Watch<'_>) -> Result<Vec<CutSide>, Error> {
        let bends = self.bends(inner, watch)?;
        let is_wanted =
            |line: HalfPlane| self.primitives.lines.is_cut(line) || bends.contains_key(&line);
        let edges = self.edges_on(is_wanted, inner, watch)?;
        let mut found = Vec::new();
        let add_sides = |item: u32, cell: &Cell| {
            let (face, sides) = (self.primitives.face(item), &cell.sides);
            for (i, side) in sides.iter().enumerate() {
                let line = side.half.positive();
                if !is_wanted(line) {
                    continue;
                }
                let inner = match edges.get(&(face, line)) {
                    // A polygon that ends at the line does not cross another polygon there.
                    Some(None) => continue,
                    Some(inner) => *inner,
                    None => None,
                };
                let end = &sides[if i + 1 == sides.len() { 0 } else { i + 1 }];
                let is_negative = side.half.is_negative();
                let (places, ends) = self.along(line, [side.start.at, end.start.at]);
                found.push(CutSide { line, face, inner, is_negative, places, ends });
            }
            Ok(())
        };
        self.for_each_part(add_sides, watch)?;
        Ok(found)
    }

    /// The outlines of faces, empty for faces outside the picture.
    fn outlines(&self) -> impl Iterator<Item = (u32, &[HalfPlane])> {
        let faces = 0..self.primitives.views.len() as u32;
        faces.map(|face| (face, self.primitives.outline(face)))
    }

    /// The lines of edges inside polygons.
    fn bends(&self, inner: &InnerEdges, watch: &Watch<'_>) -> Result<Table<HalfPlane, ()>, Error> {
        let mut bends = Table::default();
        for (face, halves) in self.outlines() {
            for (k, half) in (0..).zip(halves) {
                if inner.across((face, k)).is_some() {
                    watch.work(VISITED)?;
                    bends.insert(half.positive(), ());
                }
            }
        }
        Ok(bends)
    }

    /// The edges of faces that lie on the wanted lines, by face and line; `None` for edges of outlines.
    /// Counts as one phase of the progress.
    fn edges_on(
        &self,
        is_wanted: impl Fn(HalfPlane) -> bool,
        inner: &InnerEdges,
        watch: &Watch<'_>,
    ) -> Result<Table<(u32, HalfPlane), Option<FaceEdge>>, Error> {
        let mut edges = Table::default();
        for (face, halves) in self.outlines() {
            for (k, half) in (0..).zip(halves) {
                watch.work(VISITED)?;
                let line = half.positive();
                if is_wanted(line) {
                    let edge = inner.across((face, k)).map(|_| (face, k));
                    edges.insert((face, line), edge);
                }
            }
            finish_item(watch, face as usize, self.primitives.views.len());
        }
        Ok(edges)
    }

    /// The ends of a side in order along a line, and their places on the line.
    fn along(&self, line: HalfPlane, mut ends: [[f64; 2]; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        let [_, kx, ky] = self.primitives.lines.rounded(line).k;
        let place = |[x, y]: [f64; 2]| (y * kx - x * ky) / kx.hypot(ky);
        if place(ends[0]) > place(ends[1]) {
            ends.swap(0, 1);
        }
        (ends.map(place), ends)
    }

    /// Whether two faces cross each other in the line between their cells: whether they pass through each other, and
    /// meet in this part of the line.
    fn do_cross(
        &self,
        [a, b]: [&CutSide; 2],
        part: &CommonSide,
        inner: &InnerEdges,
        through: &Through,
        known: &mut Known,
        watch: &Watch<'_>,
    ) -> Result<bool, Error> {
        let (lines, faces) = (&self.primitives.lines, self.primitives.lines.frame.faces);
        if faces.polygon(a.face) == faces.polygon(b.face) {
            return Ok(false);
        }
        let pair = [a.face.min(b.face), a.face.max(b.face)];
        if a.inner.is_some() || b.inner.is_some() {
            watch.work(self.edges_work(pair))?;
            // Only edges on this line count: other edges may end on it.
            let bend = |side: &CutSide, other: u32| inner.bend_at(faces, side.inner?, other);
            return Ok(bend(a, b.face).or_else(|| bend(b, a.face)).is_some());
        }
        let do_pass = match known.entry((a.line, pair)) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(unknown) => {
                let planes_of = |face: u32| through.get(&(a.line, face)).map_or(&[][..], |all| all);
                let count = pair.map(|face| planes_of(face).len()).iter().sum::<usize>();
                watch.work(count + self.edges_work(pair))?;
                // Each reaches through a plane on which the other one lies: its own, or that of the cut.
                let reaches = |face: u32, other: u32| {
                    let is_on = |&plane: &u32| faces.is_on_plane_of(other, plane);
                    faces.straddles(face, other) || planes_of(face).iter().any(is_on)
                };
                let [one, other] = pair;
                let do_pass = reaches(one, other) && reaches(other, one);
                *unknown.insert(do_pass || inner.bend(faces, pair).is_some())
            }
        };
        Ok(do_pass && (lines.is_cut_of(a.line, pair) || lines.do_meet(pair, a.line, part.ends)))
    }

    /// The faces that reach through the planes of cuts.
    fn through(&self, watch: &Watch<'_>) -> Result<Through, Error> {
        let lines = &self.primitives.lines;
        let faces = lines.frame.faces;
        let mut through = Through::default();
        for (line, pair @ [one, other]) in lines.cuts_of_faces() {
            watch.work(VISITED + self.edges_work(pair))?;
            for [face, plane] in [[one, other], [other, one]] {
                if faces.straddles(face, plane) {
                    through.entry((line, face)).or_default().push(plane);
                }
            }
        }
        Ok(through)
    }

    /// The cost of all corners of two faces; see [`Primitives::edges_work`].
    fn edges_work(&self, faces: [u32; 2]) -> usize {
        faces.map(|face| self.primitives.edges_work(face)).iter().sum()
    }

    /// The polygons of two faces, the lower number first.
    fn polygons_of(&self, faces: [u32; 2]) -> [usize; 2] {
        let [a, b] = faces.map(|face| self.primitives.lines.frame.faces.polygon(face));
        [a.min(b), a.max(b)]
    }

    fn run(&self, faces: [u32; 2], ends: [[f64; 2]; 2], is_visible: bool) -> EdgeRun {
        let [polygon, other] = self.polygons_of(faces);
        let kind = EdgeKind::Crossing(other);
        EdgeRun { polygon, edge: None, kind, ends, is_visible, layers: None }
    }
}

impl CommonSide {
    fn new([a, b]: [&CutSide; 2], inner: &InnerEdges) -> Self {
        let start = if a.places[0] > b.places[0] { a } else { b };
        let end = if a.places[1] < b.places[1] { a } else { b };
        let places = [start.places[0], end.places[1]];
        let first = |side: &CutSide| {
            let across = side.inner.and_then(|edge| inner.across(edge));
            across.map_or(side.face, |(face, _)| face.min(side.face))
        };
        let (one, other) = (first(a), first(b));
        let faces = [one.min(other), one.max(other)];
        Self { line: a.line, faces, places, ends: [start.ends[0], end.ends[1]] }
    }
}

/// The number of pairs in one job of a thread. Too small: overhead per job. Too large: threads wait for each
/// other.
const SHARE: usize = 256;

/// Two faces, and the line in which they cross each other.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// The faces, in the order of [`CommonSide::faces`].
    faces: [u32; 2],
    segment: ProjectedSegment,
}

impl VisibilityMap<'_> {
    /// The runs of all crossings in the picture. The operation has `phases` phases.
    fn all_crossings(&self, phases: usize, hidden: Hidden) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(phases, |watch| {
            let primitives = &self.primitives;
            let faces = primitives.lines.frame.faces;
            let inner = InnerEdges::of(faces, watch)?;
            let mut shown = self.common_sides(&inner, watch)?;
            sort_by(&mut shown, watch, |a, b| a.faces.cmp(&b.faces))?;
            let mut pairs = straddling(primitives, &inner, watch)?;
            // These pairs lack visible crossings of polygons that reach through another polygon's plane by no
            // more than the tolerance.
            let of_shown = shown.iter().map(|side| side.faces);
            pairs.extend(of_shown.map(|[below, above]| Pair { below, above }));
            sort_unique(&mut pairs, watch)?;
            let crossings = crossings_of(&pairs, primitives, &inner, watch)?;
            // Visible runs are those of `Hidden::Skip`: a crossing with a flat surface of several faces shows
            // in the line of any of their planes.
            let visible_runs = self.visible_runs(shown.clone(), watch)?.into_iter();
            let mut list: Vec<(EdgeRun, u32)> = visible_runs.map(|run| (run, u32::MAX)).collect();
            let mut visible = Vec::new();
            for (number, crossing) in (0..).zip(&crossings) {
                let course = &crossing.segment.course;
                let first = shown.partition_point(|side| side.faces < crossing.faces);
                let own = shown[first..].iter().take_while(|side| side.faces == crossing.faces);
                visible.clear();
                visible.extend(own.map(|side| {
                    let [a, b] = side.ends.map(|end| course.place_on(end));
                    [a.min(b), a.max(b)]
                }));
                sort_by(&mut visible, watch, |a, b| a[0].total_cmp(&b[0]))?;
                let parts = parts(course, visible.iter().copied()).into_iter();
                let hidden = parts.filter(|&(_, is_visible)| !is_visible);
                let run = |(ends, _)| (self.run(crossing.faces, ends, false), number);
                list.extend(hidden.map(run));
            }
            sort_by(&mut list, watch, |(a, _), (b, _)| a.polygon.cmp(&b.polygon))?;
            let segment = |number: u32| Some(crossings[number as usize].segment);
            let is_own = |number: u32, face: u32| crossings[number as usize].faces.contains(&face);
            self.runs(list, hidden, segment, is_own, watch)
        })
    }
}

/// The crossings of pairs of faces in the picture. Counts as one phase of the progress.
fn crossings_of(
    pairs: &[Pair],
    primitives: &Primitives<'_>,
    inner: &InnerEdges,
    watch: &Watch<'_>,
) -> Result<Vec<Crossing>, Error> {
    let shares: Vec<_> = pairs.chunks(SHARE).enumerate().collect();
    let count = shares.len();
    let share = |(i, pairs): (usize, &[Pair])| {
        let mut found = Vec::new();
        for &Pair { below, above } in pairs {
            let faces = [below, above];
            let corners: usize = faces.map(|face| primitives.edges_work(face)).iter().sum();
            watch.work(CUT + corners)?;
            let segment = match inner.bend(primitives.lines.frame.faces, faces) {
                Some(bend) => bent(&bend, primitives, watch)?,
                None => straight(faces, primitives, watch)?,
            };
            found.extend(segment.map(|segment| Crossing { faces, segment }));
        }
        finish_item(watch, i, count);
        Ok(found)
    };
    Ok(parallel_map::map(shares, share)?.into_iter().flatten().collect())
}

/// The crossing of two faces: the line on which their planes have equal depth, clipped to both faces and to
/// the picture.
fn straight(
    faces: [u32; 2],
    primitives: &Primitives<'_>,
    watch: &Watch<'_>,
) -> Result<Option<ProjectedSegment>, Error> {
    let lines = &primitives.lines;
    let halves = faces.map(|face| primitives.outline(face)).concat();
    let common = Cell::picture(lines).within(lines, &halves, None, watch)?;
    Ok(common.and_then(|common| ProjectedSegment::crossing(lines, faces, &common)))
}

/// The crossing of a face and a polygon along an edge inside the polygon.
fn bent(
    bend: &Bend,
    primitives: &Primitives<'_>,
    watch: &Watch<'_>,
) -> Result<Option<ProjectedSegment>, Error> {
    let Bend { edge: (face, k), other, other_edge, .. } = *bend;
    let lines = &primitives.lines;
    let faces = lines.frame.faces;
    let segment = ProjectedSegment::new(lines, faces.ends(face, k));
    // A line along a border of the picture has only one side in the picture.
    let Some(segment) = segment.filter(|segment| segment.picture.is_eq()) else { return Ok(None) };
    let common = match other_edge {
        Some(k) => ProjectedSegment::new(lines, faces.ends(other, k)).map(|along| {
            let [a, b] = along.course.places.map(|at| segment.course.place(along.course.at(at)));
            [a.min(b), a.max(b)]
        }),
        None => {
            let cell =
                Cell::picture(lines).within(lines, primitives.outline(other), None, watch)?;
            cell.and_then(|cell| segment.chord(lines, &cell))
        }
    };
    Ok(common.and_then(|common| segment.within(common)))
}

/// Blocks of at most this many faces are not halved. Too small: more blocks. Too large: more pairs are
/// compared.
const FEW: usize = 16;
/// A box in the scene: its least and its largest coordinates.
type Aabb = [[f64; 3]; 2];

/// A part of the scene, with the faces that may reach into it.
struct Block {
    bounds: Aabb,
    faces: Vec<u32>,
    growth: Growth,
}

/// Pairs of faces of different polygons that may cross each other. Each face of a pair has corners on both
/// sides of the other face's plane, further from that plane than the tolerance. Counts as one phase of the
/// progress.
fn straddling(
    primitives: &Primitives<'_>,
    inner: &InnerEdges,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let faces = primitives.lines.frame.faces;
    let boxes: Vec<Aabb> =
        ((0..faces.len() as u32).map(|face| aabb(faces.corners(face)))).collect();
    let (mut seen, mut all) = (Vec::new(), NOTHING);
    for face in 0..faces.len() as u32 {
        if primitives.sees(face) {
            seen.push(face);
            all = around(all, boxes[face as usize]);
        }
    }
    let all = Block { bounds: all, faces: seen, growth: Growth::NONE };
    let halves = |block: &Block| block.halves(&boxes, watch);
    let leaf = |block: &Block, found: &mut Found| {
        for (i, &a) in block.faces.iter().enumerate() {
            for b in each(watch, NARROWED, &block.faces[i + 1..]) {
                let b = *b?;
                let is_near = !are_apart(&boxes[a as usize], &boxes[b as usize]);
                if !is_near || faces.polygon(a) == faces.polygon(b) {
                    continue;
                }
                let is_crossed = faces.straddles(a, b) && faces.straddles(b, a);
                let bend = || inner.bend(faces, [a, b]).map(|bend| bend.faces);
                if let Some([below, above]) =
                    if is_crossed { Some([a.min(b), a.max(b)]) } else { bend() }
                {
                    found.insert(Pair { below, above });
                }
            }
        }
        Ok(())
    };
    sorted(found_in(all, halves, leaf, watch)?, watch)
}

impl Faces {
    /// Whether a face has corners on both sides of another face's plane, further from the plane than the
    /// tolerance.
    pub(super) fn straddles(&self, face: u32, other: u32) -> bool {
        let prepared = PreparedPlane::new(self, PlaneId::face(other));
        let mut sides = self.corners(face).iter().map(|at| prepared.side_beyond(self, at));
        let Some(first) = sides.find(|side| side.is_ne()) else { return false };
        sides.any(|side| side == first.reverse())
    }
}

impl Block {
    /// The two halves of the block, across its longest side; `None` if the block is not halved.
    fn halves(&self, boxes: &[Aabb], watch: &Watch<'_>) -> Result<Option<[Self; 2]>, Error> {
        if self.faces.len() <= FEW || self.growth.is_too_much() {
            return Ok(None);
        }
        let [low, high] = self.bounds;
        let length = |&axis: &usize| high[axis] - low[axis];
        let longest = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)));
        let axis = longest.unwrap_or_default();
        let middle = 0.5 * (low[axis] + high[axis]);
        let part = || Self { bounds: self.bounds, faces: vec![], growth: Growth::NONE };
        let mut parts = [part(), part()];
        parts[0].bounds[1][axis] = middle;
        parts[1].bounds[0][axis] = middle;
        for face in each(watch, NARROWED, &self.faces) {
            let face = *face?;
            let [from, to] = boxes[face as usize];
            if from[axis] <= middle {
                parts[0].faces.push(face);
            }
            if to[axis] >= middle {
                parts[1].faces.push(face);
            }
        }
        let counts = parts.each_ref().map(|part| part.faces.len());
        let growth = self.growth.after(self.faces.len(), counts);
        parts.iter_mut().for_each(|part| part.growth = growth);
        Ok(Some(parts))
    }
}

const NOTHING: Aabb = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

fn aabb(corners: &[[f64; 3]]) -> Aabb {
    corners.iter().fold(NOTHING, |bounds, &corner| around(bounds, [corner; 2]))
}

fn around(a: Aabb, b: Aabb) -> Aabb {
    let axes = [0, 1, 2];
    [axes.map(|i: usize| a[0][i].min(b[0][i])), axes.map(|i: usize| a[1][i].max(b[1][i]))]
}

fn are_apart([low, high]: &Aabb, [from, to]: &Aabb) -> bool {
    (0..3).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
}

/// A face, and the number of its edge.
pub(super) type FaceEdge = (u32, u32);

/// The edges inside polygons, each shared by two faces. For polygons that cross themselves or traverse an
/// edge twice, some edges of their outlines may be included.
pub(super) struct InnerEdges(Table<FaceEdge, FaceEdge>);

/// The crossing of two polygons along an edge inside one polygon.
pub(super) struct Bend {
    pub(super) edge: FaceEdge,
    /// A face of the other polygon; and, if the other polygon is bent at the crossing too, this face's edge
    /// there.
    pub(super) other: u32,
    pub(super) other_edge: Option<u32>,
    /// A face of each polygon, the lower number first. If two faces of one polygon meet at the edge, the face
    /// of the lower number stands for both.
    pub(super) faces: [u32; 2],
}

impl InnerEdges {
    pub(super) fn of(faces: &Faces, watch: &Watch<'_>) -> Result<Self, Error> {
        let mut across = Table::default();
        // Edges of which one face has been visited. Inner edges are first paired with inner edges. The face
        // on the other side of an unpaired inner edge may have the edge in its outline.
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
                            across.insert((face, k), other);
                            across.insert(other, (face, k));
                        }
                        None => {
                            open.insert(key, (face, k));
                        }
                    }
                }
            }
        }
        Ok(Self(across))
    }

    /// The face on the other side of an edge, and the edge's number in that face.
    pub(super) fn across(&self, edge: FaceEdge) -> Option<FaceEdge> {
        self.0.get(&edge).copied()
    }

    /// The crossing of two polygons along an edge inside one polygon, given a face of each polygon. The faces
    /// on the two sides of the edge lie on opposite sides of the other polygon.
    pub(super) fn bend(&self, faces: &Faces, [one, other]: [u32; 2]) -> Option<Bend> {
        if self.0.is_empty() {
            return None;
        }
        // Faces with inner edges are triangles.
        let edges = |face: u32| (0..3).map(move |k| (face, k));
        let mut of_one = edges(one).filter_map(|edge| self.bend_at(faces, edge, other));
        let mut of_other = edges(other).filter_map(|edge| self.bend_at(faces, edge, one));
        of_one.next().or_else(|| of_other.next())
    }

    /// Like [`bend`](Self::bend), given an edge of one polygon and a face of the other.
    fn bend_at(&self, faces: &Faces, edge: FaceEdge, other: u32) -> Option<Bend> {
        let across = self.across(edge)?;
        let ends = faces.ends(edge.0, edge.1);
        if ends.iter().any(|end| side(faces, other, end).is_ne()) {
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
        // The other polygon has an edge there as well: that polygon is bent, too, or ends there.
        let behind = self.across((other, k))?;
        let along = way(faces, edge);
        let is_between = |x| is_between(faces, along, [edge, across], x);
        let places = [(other, k), behind].map(is_between);
        let is_crossed = places == [Some(true), Some(false)] || places == [Some(false), Some(true)];
        found(Some(k), behind.0).filter(|_| is_crossed)
    }
}

/// The side of a face's plane on which a point lies; `Equal` within the tolerance.
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

/// Whether a half-plane that turns to the left around a line, starting at the triangle `from`, reaches a
/// third triangle before the triangle `to`; `None` if the third triangle lies on `from` or `to`.
fn is_between(
    faces: &Faces,
    along: DVec3,
    [from, to]: [FaceEdge; 2],
    third_edge: FaceEdge,
) -> Option<bool> {
    // Whether one triangle lies to the left of another, by the plane through the line.
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
