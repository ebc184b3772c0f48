//! Lines in which polygons go through one another.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use super::edges::{EdgeKind, EdgeRun, SHORTEST};
use super::frame::is_same_line;
use super::lines::{Half, Key, Mixer};
use super::map::VisibilityMap;
use crate::Error;
use crate::exact::PlaneId;
use crate::memory::{push, reserve};

/// A side of a cell on the line of a cut.
#[derive(Clone, Copy, Debug)]
struct Border {
    line: u32,
    face: u32,
    /// Whether the cell is where the line is negative.
    is_negative: bool,
    /// Where it begins and ends along the line, and in the picture.
    places: [f64; 2],
    ends: [[f64; 2]; 2],
}

/// Two faces, by the line between cells of theirs.
type Pairs = HashMap<(u32, [u32; 2]), bool, BuildHasherDefault<Mixer>>;

impl VisibilityMap<'_> {
    /// Where polygons go through one another, as far as it shows: runs of [`EdgeKind::Crossing`], all
    /// visible, each once, with the polygon of the lower number first.
    ///
    /// A point is on a crossing if both polygons show at it, one on each side. This is read off the map,
    /// so it is as exact: only the ends of runs are rounded. Where an edge of a polygon only touches
    /// another, [`edges`](Self::edges) has it.
    ///
    /// O(n log n) for n cells.
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn crossings(&self) -> Result<Vec<EdgeRun>, Error> {
        let mut borders = self.borders()?;
        borders
            .sort_unstable_by(|a, b| a.line.cmp(&b.line).then(a.places[0].total_cmp(&b.places[0])));
        let mut runs = Vec::new();
        let mut are_crossing = Pairs::default();
        for line in borders.chunk_by(|a, b| a.line == b.line) {
            let first = runs.len();
            for (i, a) in line.iter().enumerate() {
                let ahead = line[i + 1..].iter().take_while(|b| b.places[0] < a.places[1]);
                for b in ahead.filter(|b| b.is_negative != a.is_negative) {
                    if self.do_cross(a, b, &mut are_crossing)? {
                        push(&mut runs, self.common([a, b]))?;
                    }
                }
            }
            merge(&mut runs, first);
        }
        runs.retain(|run| distance(run.ends) >= SHORTEST);
        runs.sort_by_key(|run| run.polygon);
        Ok(runs)
    }

    /// All sides of cells on lines of cuts.
    fn borders(&self) -> Result<Vec<Border>, Error> {
        let lines = &self.stock.lines;
        let mut borders = Vec::new();
        for visible in self.leaves.iter().flat_map(|leaf| &leaf.cells) {
            let face = self.stock.seen[self.stock.seen_of(visible.item) as usize].face;
            let sides = &visible.cell.sides;
            for (i, side) in sides.iter().enumerate() {
                let Some(line) = side.half.number() else { continue };
                if !matches!(lines.key(line), Key::Cut(..)) {
                    continue;
                }
                let [_, kx, ky] = lines.rounded(side.half).k;
                let end = &sides[if i + 1 == sides.len() { 0 } else { i + 1 }];
                let place = |[x, y]: [f64; 2]| (y * kx - x * ky) / kx.hypot(ky);
                let mut ends = [side.start.at, end.start.at];
                if place(ends[0]) > place(ends[1]) {
                    ends.swap(0, 1);
                }
                let is_negative = side.half.is_negative();
                let places = ends.map(place);
                reserve(&mut borders, 1)?;
                borders.push(Border { line, face, is_negative, places, ends });
            }
        }
        Ok(borders)
    }

    /// Whether two faces go through one another in the line between cells of theirs.
    fn do_cross(&self, a: &Border, b: &Border, known: &mut Pairs) -> Result<bool, Error> {
        let (lines, faces) = (&self.stock.lines, self.stock.lines.frame.faces);
        if faces.polygon(a.face) == faces.polygon(b.face) {
            return Ok(false);
        }
        let [one, other] = [a.face.min(b.face), a.face.max(b.face)];
        if lines.key(a.line) == Key::Cut(one, PlaneId::face(other)) {
            return Ok(true);
        }
        known.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        Ok(*known.entry((a.line, [one, other])).or_insert_with(|| {
            let [one, other] = [one, other].map(|face| lines.frame.sheet(PlaneId::face(face)));
            is_same_line(&one.cut(&other), &lines.exact(Half::of(a.line)))
        }))
    }

    /// What two borders have in common.
    fn common(&self, borders: [&Border; 2]) -> EdgeRun {
        let polygon = |border: &Border| self.stock.lines.frame.faces.polygon(border.face);
        let [a, b] = borders.map(polygon);
        let [first, second] = borders;
        let start = if first.places[0] > second.places[0] { first } else { second }.ends[0];
        let end = if first.places[1] < second.places[1] { first } else { second }.ends[1];
        let kind = EdgeKind::Crossing(a.max(b));
        EdgeRun { polygon: a.min(b), edge: None, kind, ends: [start, end], is_visible: true }
    }
}

/// Joins runs of the same polygons, from the `first` on, where one begins where another ends: they are on
/// one line, in its direction.
fn merge(runs: &mut Vec<EdgeRun>, first: usize) {
    let mut merged: Vec<EdgeRun> = Vec::new();
    for run in runs.drain(first..) {
        let is_same = |other: &EdgeRun| (other.polygon, other.kind) == (run.polygon, run.kind);
        let before = merged.iter_mut().rev().find(|other| is_same(other));
        match before {
            Some(before) if distance([before.ends[1], run.ends[0]]) <= SHORTEST => {
                before.ends[1] = run.ends[1];
            }
            _ => merged.push(run),
        }
    }
    runs.append(&mut merged);
}

fn distance([a, b]: [[f64; 2]; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
