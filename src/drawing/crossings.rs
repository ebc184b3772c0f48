//! Lines in which polygons go through one another.

use super::cell::Cell;
use super::edge_run::{EdgeKind, EdgeRun, SHORTEST};
use super::frame::compare;
use super::half::Half;
use super::halving::VISITED;
use super::inner_edges::{FaceEdge, InnerEdges};
use super::map::VisibilityMap;
use super::near::distance;
use super::reporter::{each, finish_item, sort_by};
use super::table::{Table, insert};
use crate::Error;
use crate::build::progress::Watch;
use crate::exact::PlaneId;
use crate::memory::push;

/// A side of a cell on the line of a cut.
#[derive(Clone, Copy, Debug)]
struct CutSide {
    /// On which the line is positive.
    line: Half,
    face: u32,
    /// The edge of its face that lies there, inside the polygon, which goes on across it.
    inner: Option<FaceEdge>,
    /// Whether the cell is where the line is negative.
    is_negative: bool,
    /// Where it begins and ends along the line, and in the picture.
    places: [f64; 2],
    ends: [[f64; 2]; 2],
}

/// What two such sides have in common: a part of a crossing that shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct CommonSide {
    line: Half,
    /// The lower number first. Of two faces that meet at the line it is the one of the lower number, though the
    /// other shows.
    pub(super) faces: [u32; 2],
    pub(super) ends: [[f64; 2]; 2],
}

/// Whether two faces go through one another in a line: by the line and the faces.
type Known = Table<(Half, [u32; 2]), bool>;

impl VisibilityMap<'_> {
    /// Where polygons go through one another, as far as it shows: runs of [`EdgeKind::Crossing`], all
    /// visible, each once, with the polygon of the lower number first.
    ///
    /// A point is on a crossing if both polygons show at it, one on each side. This is read off the map,
    /// so it is as exact: only the ends of runs are rounded. Where an edge of a polygon only touches
    /// another, [`edges`](Self::edges) has it; and [`crossings_with_hidden`](Self::crossings_with_hidden) what is hidden
    /// of crossings. Along an edge that triangulation made, a polygon is crossed where the other one lies
    /// between the two triangles there; what is no further from a plane than the tolerance counts as on it.
    ///
    /// O(n log n) for n cells of opaque polygons; with opacities, for the parts in which
    /// [`regions`](Self::regions) are found as well.
    ///
    /// # Errors
    ///
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn crossings(&self) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(2, |watch| {
            let inner = InnerEdges::of(self.stock.frame.faces, watch)?;
            let common = self.common_sides(&inner, watch)?;
            let mut runs = Vec::new();
            for line in common.chunk_by(|a, b| a.line == b.line) {
                let first = runs.len();
                for side in each(watch, VISITED, line) {
                    push(&mut runs, self.run(side?))?;
                }
                merge(&mut runs, first, watch)?;
            }
            runs.retain(|run| distance(run.ends[0], run.ends[1]) >= SHORTEST);
            sort_by(&mut runs, watch, |a, b| a.polygon.cmp(&b.polygon))?;
            Ok(runs)
        })
    }

    /// What sides of cells have in common that lie on either side of a line in which their faces go through one
    /// another, line by line: two phases.
    pub(super) fn common_sides(
        &self,
        inner: &InnerEdges,
        watch: &Watch<'_>,
    ) -> Result<Vec<CommonSide>, Error> {
        let mut sides = self.cut_sides(inner, watch)?;
        sort_by(&mut sides, watch, |a, b| {
            a.line.cmp(&b.line).then(a.places[0].total_cmp(&b.places[0]))
        })?;
        let mut common = Vec::new();
        let mut are_crossing = Known::default();
        for line in sides.chunk_by(|a, b| a.line == b.line) {
            for (i, a) in line.iter().enumerate() {
                let ahead = line[i + 1..].iter().take_while(|b| b.places[0] < a.places[1]);
                for b in each(watch, VISITED, ahead) {
                    let b = b?;
                    if b.is_negative != a.is_negative
                        && self.do_cross(a, b, inner, &mut are_crossing)?
                    {
                        push(&mut common, CommonSide::new([a, b], inner))?;
                    }
                }
            }
        }
        Ok(common)
    }

    /// All sides of cells on lines of cuts or of edges inside polygons, whatever made them: several planes may have
    /// cut along one line, and what is beyond a border of a tile or a third polygon's edge was not cut again.
    fn cut_sides(&self, inner: &InnerEdges, watch: &Watch<'_>) -> Result<Vec<CutSide>, Error> {
        let bends = self.bends(inner, watch)?;
        let is_wanted = |line: Half| self.rims.lines.is_cut(line) || bends.contains_key(&line);
        let edges = self.edges_on(is_wanted, inner, watch)?;
        let mut found = Vec::new();
        let add_sides = |item: u32, cell: &Cell| {
            let (face, sides) = (self.stock.face(item), &cell.sides);
            for (i, side) in sides.iter().enumerate() {
                let line = side.half.positive();
                if !is_wanted(line) {
                    continue;
                }
                let inner = match edges.get(&(face, line)) {
                    // A polygon that ends there does not go through another.
                    Some(None) => continue,
                    Some(inner) => *inner,
                    None => None,
                };
                let end = &sides[if i + 1 == sides.len() { 0 } else { i + 1 }];
                let is_negative = side.half.is_negative();
                let (places, ends) = self.along(line, [side.start.at, end.start.at]);
                push(&mut found, CutSide { line, face, inner, is_negative, places, ends })?;
            }
            Ok(())
        };
        self.for_each_part(add_sides, watch)?;
        Ok(found)
    }

    /// The outlines of faces. (Those of polygons that do not show have no lines.)
    fn outlines(&self) -> impl Iterator<Item = (u32, &[Half])> {
        let faces = 0..self.stock.views.len() as u32;
        faces.map(|face| (face, self.rims.known_outline(face)))
    }

    /// The lines of edges inside polygons.
    fn bends(&self, inner: &InnerEdges, watch: &Watch<'_>) -> Result<Table<Half, ()>, Error> {
        let mut bends = Table::default();
        for outline in each(watch, 1, self.outlines()) {
            let (face, halves) = outline?;
            for (k, half) in (0..).zip(halves) {
                if inner.across((face, k)).is_some() {
                    watch.work(VISITED)?;
                    insert(&mut bends, half.positive(), ())?;
                }
            }
        }
        Ok(bends)
    }

    /// The edges of faces that lie on some lines, by face and line, `None` for those of outlines: a phase.
    fn edges_on(
        &self,
        is_wanted: impl Fn(Half) -> bool,
        inner: &InnerEdges,
        watch: &Watch<'_>,
    ) -> Result<Table<(u32, Half), Option<FaceEdge>>, Error> {
        let mut edges = Table::default();
        for outline in each(watch, 1, self.outlines()) {
            let (face, halves) = outline?;
            for (k, half) in (0..).zip(halves) {
                watch.work(VISITED)?;
                let line = half.positive();
                if is_wanted(line) {
                    let edge = inner.across((face, k)).map(|_| (face, k));
                    insert(&mut edges, (face, line), edge)?;
                }
            }
            finish_item(watch, face as usize, self.stock.views.len());
        }
        Ok(edges)
    }

    /// The ends of a side in the order in which they are along a line, and where that is.
    fn along(&self, line: Half, mut ends: [[f64; 2]; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        let [_, kx, ky] = self.rims.lines.rounded(line).k;
        let place = |[x, y]: [f64; 2]| (y * kx - x * ky) / kx.hypot(ky);
        if place(ends[0]) > place(ends[1]) {
            ends.swap(0, 1);
        }
        (ends.map(place), ends)
    }

    /// Whether two faces go through one another in the line between cells of theirs.
    fn do_cross(
        &self,
        a: &CutSide,
        b: &CutSide,
        inner: &InnerEdges,
        known: &mut Known,
    ) -> Result<bool, Error> {
        let (lines, faces) = (&self.rims.lines, self.stock.frame.faces);
        if faces.polygon(a.face) == faces.polygon(b.face) {
            return Ok(false);
        }
        let [one, other] = [a.face.min(b.face), a.face.max(b.face)];
        let is_bent = a.inner.is_some() || b.inner.is_some();
        if !is_bent && lines.is_cut_of(a.line, [one, other]) {
            return Ok(true);
        }
        known.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        Ok(*known.entry((a.line, [one, other])).or_insert_with(|| {
            if is_bent {
                // Of the edges of both only those on this line: others may end on it.
                let bend = |side: &CutSide, other: u32| inner.bend_at(faces, side.inner?, other);
                return bend(a, b.face).or_else(|| bend(b, a.face)).is_some();
            }
            let [one, other] = [one, other].map(|face| lines.frame.sheet(PlaneId::face(face)));
            let cut = one.cut(&other);
            // Faces of one plane have no line in common but all of it.
            let is_line = cut.iter().any(|c| c.sign().is_ne());
            is_line && compare(&cut, &lines.exact(a.line)).is_eq()
        }))
    }

    fn run(&self, side: &CommonSide) -> EdgeRun {
        let [a, b] = side.faces.map(|face| self.stock.frame.faces.polygon(face));
        let (polygon, kind) = (a.min(b), EdgeKind::Crossing(a.max(b)));
        EdgeRun { polygon, edge: None, kind, ends: side.ends, is_visible: true, layers: None }
    }
}

impl CommonSide {
    fn new([a, b]: [&CutSide; 2], inner: &InnerEdges) -> Self {
        let start = if a.places[0] > b.places[0] { a } else { b }.ends[0];
        let end = if a.places[1] < b.places[1] { a } else { b }.ends[1];
        let first = |side: &CutSide| {
            let across = side.inner.and_then(|edge| inner.across(edge));
            across.map_or(side.face, |(face, _)| face.min(side.face))
        };
        let (one, other) = (first(a), first(b));
        let faces = [one.min(other), one.max(other)];
        Self { line: a.line, faces, ends: [start, end] }
    }
}

/// How far the second of two runs along a line begins behind the end of the first, if it does.
fn gap(before: &EdgeRun, run: &EdgeRun) -> f64 {
    let reach = distance(before.ends[0], before.ends[1]);
    distance(before.ends[0], run.ends[0]) - reach
}

/// Joins runs of the same polygons, from the `first` on, where one begins where another ends or before: they are
/// on one line, in its direction. (Runs of two translucent polygons are found from either side.)
fn merge(runs: &mut Vec<EdgeRun>, first: usize, watch: &Watch<'_>) -> Result<(), Error> {
    let other = |run: &EdgeRun| match run.kind {
        EdgeKind::Crossing(other) => other,
        _ => 0,
    };
    // Stable: runs of one pair stay in their order along the line.
    let mut rest = runs.split_off(first);
    let key = |run: &EdgeRun| (run.polygon, other(run));
    sort_by(&mut rest, watch, |a, b| key(a).cmp(&key(b)))?;
    for run in each(watch, 1, rest) {
        let run = run?;
        let goes_on = |before: &&mut EdgeRun| {
            (before.polygon, before.kind) == (run.polygon, run.kind)
                && gap(before, &run) <= SHORTEST
        };
        match runs[first..].last_mut().filter(goes_on) {
            Some(before) => {
                let [start, end] = [before.ends[1], run.ends[1]];
                if distance(before.ends[0], end) > distance(before.ends[0], start) {
                    before.ends[1] = end;
                }
            }
            None => push(runs, run)?,
        }
    }
    Ok(())
}
