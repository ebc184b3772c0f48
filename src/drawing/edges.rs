//! Edges of polygons as they show: visible runs and hidden ones.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::edge_run::EdgeRun;
use super::halving::VISITED;
use super::intervals::parts;
use super::map::VisibilityMap;
use super::reporter::{each, finish_item, sort_by};
use super::shared_edges::{Numbers, SharedEdge, shared_edges};
use super::sight::Course;
use super::table::Table;
use super::visible::Visible;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};

/// Edges with the runs of those that a polygon shows.
pub(super) struct Runs {
    pub(super) edges: Vec<SharedEdge>,
    /// Each with the number of its edge.
    pub(super) list: Vec<(EdgeRun, u32)>,
}

impl VisibilityMap<'_> {
    /// All edges of polygons that show a side to the camera, as far as they are in the picture, in runs
    /// that are visible or hidden. Runs of one polygon follow one another, and those of an edge from its
    /// beginning to its end.
    ///
    /// What is visible is read off the map, so it is as exact: only the ends of runs are rounded. An edge
    /// is hidden by what lies before it, not by the faces that have it (though by another part of a polygon that is
    /// not planar). Polygons have an edge in common
    /// if both of its corners are the same. Edges inside a polygon, which triangulation made, are none, but
    /// for silhouettes: a polygon that is not planar may be seen from its front on one side of such an edge,
    /// and from behind on the other. Nor are edges at which all polygons are seen exactly edge-on, nor
    /// those along a border of the picture with all polygons on its other side. Where polygons go through one
    /// another, [`crossings`](Self::crossings) tells.
    ///
    /// O(n log n) for n edges and cells. (What is hidden, and how to tell for lines: A. Appel, "The notion
    /// of quantitative invisibility and the machine rendering of solids", 1967.)
    ///
    /// # Errors
    ///
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn edges(&self) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(2, |watch| {
            let list = self.edge_runs(watch)?.list;
            let mut runs = Vec::new();
            reserve(&mut runs, list.len())?;
            for run in each(watch, 1, list) {
                runs.push(run?.0);
            }
            Ok(runs)
        })
    }

    /// The runs of all edges: two phases.
    pub(super) fn edge_runs(&self, watch: &Watch<'_>) -> Result<Runs, Error> {
        let is_drawn = |face| self.stock.opacity(face) > 0.0;
        let mut views = Views { map: self, sides: Table::default() };
        let side = |face| views.side(face);
        let (mut edges, numbers) = shared_edges(&self.rims.lines, is_drawn, side, watch)?;
        self.collect(&mut edges, &numbers, watch)?;
        let (mut list, count) = (Vec::new(), edges.len());
        reserve(&mut list, count)?;
        for numbered in each(watch, VISITED, edges.iter_mut().enumerate()) {
            let (number, edge) = numbered?;
            if let Some(course) = edge.course {
                let first = list.len();
                sort_by(&mut edge.visible, watch, |a, b| a[0].total_cmp(&b[0]))?;
                views.runs(edge, &course, |run| push(&mut list, (run, number as u32)))?;
                watch.work((list.len() - first) * VISITED)?;
            }
            finish_item(watch, number, count);
        }
        sort_by(&mut list, watch, |(a, _), (b, _)| (a.polygon, a.edge).cmp(&(b.polygon, b.edge)))?;
        Ok(Runs { edges, list })
    }

    /// Adds to each edge where it shows: a phase.
    fn collect(
        &self,
        all: &mut [SharedEdge],
        numbers: &Numbers,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let stock = &self.stock;
        // Which edges of a face lie on a line.
        let mut edges: Table<(u32, u64), SmallVec<[u32; 1]>> = Table::default();
        let faces = stock.frame.faces;
        for face in each(watch, VISITED, 0..faces.len() as u32) {
            let face = face?;
            // Faces of polygons that do not show have no lines.
            let corners = 0..faces.corners(face).len() as u32;
            for (k, half) in corners.zip(self.rims.known_outline(face)) {
                watch.work(VISITED)?;
                if numbers.contains_key(&(face, k)) {
                    edges.try_reserve(1).map_err(|_| Error::out_of_memory())?;
                    edges.entry((face, half.line())).or_default().push(k);
                }
            }
        }
        let count = self.leaves.len();
        for (i, leaf) in self.leaves.iter().enumerate() {
            for visible in each(watch, SIDES, &leaf.cells) {
                let Visible { item, cell } = visible?;
                let face = stock.face(*item);
                for (i, side) in cell.sides.iter().enumerate() {
                    let end = cell.sides[if i + 1 == cell.sides.len() { 0 } else { i + 1 }].start;
                    for &k in edges.get(&(face, side.half.line())).into_iter().flatten() {
                        let Some(&number) = numbers.get(&(face, k)) else { continue };
                        let edge = &mut all[number as usize];
                        let Some(course) = &edge.course else { continue };
                        let [a, b] = [side.start.at, end.at].map(|point| course.place_on(point));
                        push(&mut edge.visible, [a.min(b), a.max(b)])?;
                    }
                }
            }
            finish_item(watch, i, count);
        }
        Ok(())
    }
}

/// To look at the sides of a cell takes as long as a build takes to examine so many pieces.
const SIDES: usize = 16;

/// From which sides faces are seen.
struct Views<'m> {
    map: &'m VisibilityMap<'m>,
    sides: Table<u32, Ordering>,
}

impl Views<'_> {
    fn side(&mut self, face: u32) -> Ordering {
        let frame = &self.map.stock.frame;
        *self.sides.entry(face).or_insert_with(|| frame.seen_side(face))
    }

    /// Gives the runs of an edge, in the direction of that of its faces which they are told of, unless no
    /// polygon shows a side there.
    fn runs(
        &mut self,
        edge: &SharedEdge,
        course: &Course,
        give: impl FnMut(EdgeRun) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let fronts_only = self.map.stock.frame.rays.is_front_only();
        let sides: SmallVec<[Ordering; 2]> =
            edge.faces.iter().map(|&(face, _)| self.side(face)).collect();
        let shows = |side: &Ordering| side.is_gt() || side.is_lt() && !fronts_only;
        let fronts = sides.iter().position(|side| side.is_gt());
        let Some(owner) = fronts.or_else(|| sides.iter().position(shows)) else { return Ok(()) };
        let faces = self.map.stock.frame.faces;
        let mut numbered = sides.iter().enumerate();
        // Of an edge along a border of the picture, none may be in the picture.
        if !numbered.any(|(i, side)| shows(side) && edge.is_in_picture(faces, i, *side)) {
            return Ok(());
        }
        let (face, k) = edge.faces[owner];
        let (polygon, kind) = (faces.polygon(face), edge.kind(faces, &sides));
        let number = faces.outline_edge(face, k);
        let mut runs: SmallVec<[EdgeRun; 4]> = SmallVec::new();
        for (ends, is_visible) in parts(course, edge.visible.iter().copied()) {
            runs.push(EdgeRun { polygon, edge: number, kind, ends, is_visible, layers: None });
        }
        if edge.is_turned(faces, 0, owner) {
            runs.reverse();
            runs.iter_mut().for_each(|run| run.ends.swap(0, 1));
        }
        runs.into_iter().try_for_each(give)
    }
}
