//! How many polygons lie in front of lines.
//!
//! (A. Appel, "The notion of quantitative invisibility and the machine rendering of solids", 1967.)

use super::edge_run::{EdgeRun, SHORTEST};
use super::edges::Runs;
use super::halving::{CUT, LINES, VISITED};
use super::intervals::merged;
use super::map::VisibilityMap;
use super::overlaid::{LineRun, sights};
use super::passes::{Pass, Passing, Pieces, passes};
use super::reaches::Reaches;
use super::reporter::{each, finish_item, sort_by};
use super::rims::Rims;
use super::sight::Sight;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, push};
use crate::overlay::Overlay;

/// The place of what has no hidden runs.
const NONE: u32 = u32::MAX;

/// Both ends of a run.
type Ends = [[f64; 2]; 2];

/// From a place of a segment on, so many polygons are in front of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    from: f64,
    layers: u32,
}

/// The depths of several segments, and where those of each begin: before its first, nothing is in front.
#[derive(Default)]
pub(super) struct Depths {
    depths: Vec<Depth>,
    begins: Vec<usize>,
}

impl Depths {
    pub(super) fn of(&self, segment: usize) -> &[Depth] {
        &self.depths[self.begins[segment]..self.begins[segment + 1]]
    }
}

impl VisibilityMap<'_> {
    /// The runs of [`edges`](Self::edges), each with [`EdgeRun::layers`]: hidden ones are cut where the
    /// number of polygons in front of them changes.
    ///
    /// All polygons count that show a side to the camera, once each, be they hidden themselves; but not
    /// the faces that have the edge (of a polygon that is not planar, another face may lie in front). One counts at
    /// least, as where the edge of a shelf lies on the wall that hides the shelf. Time and memory go with how many
    /// lie in front of hidden edges.
    ///
    /// # Errors
    ///
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn edges_in_layers(&self) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(4, |watch| {
            let faces = self.stock.frame.faces;
            let Runs { edges, list } = self.edge_runs(watch)?;
            // The edges with hidden runs, and the number of each among these.
            let (mut hidden, mut sights) = (Vec::new(), Vec::new());
            let mut places: Vec<u32> = collect(edges.iter().map(|_| NONE))?;
            for run in each(watch, CUT, &list) {
                let (run, number) = run?;
                let (edge, place) = (&edges[*number as usize], &mut places[*number as usize]);
                if run.is_visible || *place != NONE {
                    continue;
                }
                let (face, k) = edge.faces[0];
                if let Some(sight) = Sight::new(&self.rims.lines, faces.ends(face, k)) {
                    *place = hidden.len() as u32;
                    push(&mut hidden, *number)?;
                    push(&mut sights, sight)?;
                }
            }
            let is_own = |sight: u32, face: u32| {
                let edge = &edges[hidden[sight as usize] as usize];
                edge.faces.iter().any(|&(own, _)| own == face)
            };
            let depths = self.depths(&sights, is_own, watch)?;
            let mut layered = Vec::new();
            for run in each(watch, VISITED, &list) {
                let (run, number) = run?;
                let place = places[*number as usize] as usize;
                let known = sights.get(place).map(|sight| (sight, depths.of(place)));
                for (ends, layers) in in_layers(run.ends, run.is_visible, known, watch)? {
                    push(&mut layered, EdgeRun { ends, layers: Some(layers), ..*run })?;
                }
            }
            Ok(layered)
        })
    }

    /// The runs of [`lines`](Self::lines), each with [`LineRun::layers`], as
    /// [`edges_in_layers`](Self::edges_in_layers) has those of edges.
    ///
    /// # Errors
    ///
    /// As for `lines`.
    pub fn lines_in_layers(&self, overlay: &Overlay) -> Result<Vec<LineRun>, Error> {
        overlay.expect_no_polygons(self.tree)?;
        self.reporter.watch(3, |watch| {
            let (segments, sights) = sights(&self.rims.lines, overlay, watch)?;
            let runs = self.line_runs(&segments, &sights, watch)?;
            let depths = self.depths(&sights, |_, _| false, watch)?;
            let mut layered = Vec::new();
            let mut runs = runs.iter().peekable();
            for numbered in each(watch, VISITED, segments.iter().enumerate()) {
                let (number, segment) = numbered?;
                let name = (segment.line, segment.number);
                while let Some(run) = runs.next_if(|run| (run.line, run.segment) == name) {
                    let known = Some((&sights[number], depths.of(number)));
                    for (ends, layers) in in_layers(run.ends, run.is_visible, known, watch)? {
                        push(&mut layered, LineRun { ends, layers: Some(layers), ..*run })?;
                    }
                }
            }
            Ok(layered)
        })
    }

    /// How many polygons are in front of segments: two phases. A face that is a segment's own does not count.
    pub(super) fn depths(
        &self,
        sights: &[Sight],
        is_own: impl Fn(u32, u32) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Depths, Error> {
        if sights.is_empty() {
            return Ok(Depths { begins: vec![0], ..Depths::default() });
        }
        let (stock, faces) = (&self.stock, self.stock.frame.faces);
        let mut reaches = Reaches::default();
        // Polygons that do not show hide edges too.
        let mut rims = Rims::new(stock);
        for face in 0..faces.len() {
            let number = face as u32;
            watch.work(1)?;
            if stock.sees(number) {
                watch.work(LINES + stock.edges_work(number) * LINES / 4)?;
                reaches.push(number, rims.outline(stock, number)?)?;
            }
            finish_item(watch, face, faces.len());
        }
        let around = |face: u32| stock.views[face as usize].around;
        let pieces = Pieces { lines: &rims.lines, reaches, face: &|face| face, around: &around };
        let passing = Passing { sights, spots: &[] };
        let found = passes(pieces, passing, |is_behind| is_behind, watch)?;
        let mut passes = found.sights;
        let polygon = |face: u32| faces.polygon(face);
        sort_by(&mut passes, watch, |a, b| {
            let keys = [a, b].map(|pass| (pass.sight, polygon(pass.piece)));
            keys[0].cmp(&keys[1]).then(a.places[0].total_cmp(&b.places[0]))
        })?;
        let (mut depths, mut changes) = (Depths::default(), Vec::new());
        let mut rest = &passes[..];
        for number in each(watch, VISITED, 0..sights.len() as u32) {
            let number = number?;
            let (own, others) = rest.split_at(rest.partition_point(|pass| pass.sight == number));
            rest = others;
            changes.clear();
            watch.work(own.len() * VISITED)?;
            for same in own.chunk_by(|a, b| polygon(a.piece) == polygon(b.piece)) {
                // Each polygon counts once, however many parts of it there are.
                let counts = |pass: &&Pass| !is_own(number, pass.piece);
                for [from, to] in merged(same.iter().filter(counts).map(|pass| pass.places)) {
                    push(&mut changes, (from, 1))?;
                    push(&mut changes, (to, -1))?;
                }
            }
            sort_by(&mut changes, watch, |a, b| a.0.total_cmp(&b.0))?;
            push(&mut depths.begins, depths.depths.len())?;
            let mut layers = 0i64;
            for &(from, change) in &changes {
                layers += change;
                push(&mut depths.depths, Depth { from, layers: layers as u32 })?;
            }
        }
        push(&mut depths.begins, depths.depths.len())?;
        Ok(depths)
    }
}

/// The parts of a run, and how many layers are in front of each: one at least if it is hidden. Parts that
/// rounding has left are not told from those before them.
pub(super) fn in_layers(
    ends: Ends,
    is_visible: bool,
    depths: Option<(&Sight, &[Depth])>,
    watch: &Watch<'_>,
) -> Result<Vec<(Ends, u32)>, Error> {
    let Some((sight, depths)) = depths.filter(|_| !is_visible) else {
        return Ok(vec![(ends, u32::from(!is_visible))]);
    };
    let [a, b] = ends.map(|end| sight.course.place(end));
    let (low, high) = (a.min(b), a.max(b));
    // Where each part begins, as a share of the run.
    let mut parts: Vec<(f64, u32)> = Vec::new();
    let first = depths.partition_point(|depth| depth.from <= low);
    let before = first.checked_sub(1).map_or(0, |before| depths[before].layers);
    let inside = depths[first..].iter().take_while(|depth| depth.from < high);
    let begins = inside.map(|depth| (depth.from, depth.layers));
    let mut begins = [(low, before)].into_iter().chain(begins).peekable();
    while let Some((from, layers)) = begins.next() {
        watch.work(1)?;
        let to = begins.peek().map_or(high, |next| next.0);
        let layers = layers.max(1);
        let goes_on = parts.last().is_some_and(|last| last.1 == layers);
        if to - from >= SHORTEST && !goes_on {
            let start = if parts.is_empty() { low } else { from };
            push(&mut parts, (start, layers))?;
        }
    }
    if parts.is_empty() {
        return Ok(vec![(ends, before.max(1))]);
    }
    let at = |place: f64| {
        let share = (place - a) / (b - a);
        [0, 1].map(|i: usize| ends[0][i] + (ends[1][i] - ends[0][i]) * share)
    };
    let count = parts.len();
    let cut = |i: usize| if i == 0 || i == count { None } else { Some(at(parts[i].0)) };
    let end = |i: usize| cut(i).unwrap_or(ends[usize::from((i == 0) != (a < b))]);
    let mut all: Vec<_> = (0..count).map(|i| ([end(i), end(i + 1)], parts[i].1)).collect();
    if a > b {
        all.reverse();
        all.iter_mut().for_each(|(ends, _)| ends.swap(0, 1));
    }
    Ok(all)
}
