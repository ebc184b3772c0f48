//! How many polygons lie in front of lines.
//!
//! (A. Appel, "The notion of quantitative invisibility and the machine rendering of solids", 1967.)

use super::edges::{EdgeRun, SHORTEST, ends_of};
use super::map::VisibilityMap;
use super::overlaid::{LineRun, sights};
use super::passes::{Passing, Pieces, passes};
use super::reaches::Reaches;
use super::rims::Rims;
use super::sight::Sight;
use super::table::{Table, insert};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{push, reserve};
use crate::overlay::Overlay;

/// Both ends of a run.
type Ends = [[f64; 2]; 2];

/// A segment with hidden parts.
struct Hidden {
    sight: Sight,
    /// A face whose edge it is, which does not count; `u32::MAX` if it is none.
    own: u32,
}

/// From a place of a segment on, so many polygons are in front of it.
#[derive(Clone, Copy, Debug)]
struct Step {
    from: f64,
    layers: u32,
}

/// The steps of several segments, and where those of each begin: before its first, nothing is in front.
#[derive(Default)]
struct Steps {
    steps: Vec<Step>,
    begins: Vec<usize>,
}

impl Steps {
    fn of(&self, segment: usize) -> &[Step] {
        &self.steps[self.begins[segment]..self.begins[segment + 1]]
    }
}

impl VisibilityMap<'_> {
    /// The runs of [`edges`](Self::edges), each with [`EdgeRun::layers`]: hidden ones are cut where the
    /// number of polygons in front of them changes.
    ///
    /// All polygons count that show a side to the camera, once each, be they hidden themselves; but not
    /// those that the edge lies on. One counts at least, as where the edge of a shelf lies on the wall that
    /// hides the shelf. Time goes with how many lie in front of hidden edges.
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn edges_in_layers(&self) -> Result<Vec<EdgeRun>, Error> {
        let runs = self.edges()?;
        let faces = self.stock.frame.faces;
        let mut of_edge: Table<(u32, u32), (u32, u32)> = Table::default();
        for face in 0..faces.len() as u32 {
            for k in 0..faces.corners(face).len() as u32 {
                if let Some(edge) = faces.outline_edge(face, k) {
                    insert(&mut of_edge, (faces.polygon(face) as u32, edge), (face, k))?;
                }
            }
        }
        let edges = || runs.chunk_by(|a, b| (a.polygon, a.edge) == (b.polygon, b.edge));
        let (mut all, mut numbers) = (Vec::new(), Vec::new());
        for runs in edges() {
            let edge = (runs[0].polygon as u32, runs[0].edge.unwrap_or_default());
            let is_hidden = runs.iter().any(|run| !run.is_visible);
            let found = of_edge.get(&edge).filter(|_| is_hidden);
            let hidden = found.and_then(|&(own, k)| {
                let sight = Sight::new(&self.rims.lines, ends_of(faces, own, k))?;
                Some(Hidden { sight, own })
            });
            push(&mut numbers, hidden.is_some().then_some(all.len()))?;
            reserve(&mut all, 1)?;
            all.extend(hidden);
        }
        let steps = self.steps(&all)?;
        let mut layered = Vec::new();
        for (runs, number) in edges().zip(numbers) {
            for run in runs {
                let steps = number.map(|number| (&all[number].sight, steps.of(number)));
                for (ends, layers) in in_layers(run.ends, run.is_visible, steps)? {
                    push(&mut layered, EdgeRun { ends, layers: Some(layers), ..*run })?;
                }
            }
        }
        Ok(layered)
    }

    /// The runs of [`lines`](Self::lines), each with [`LineRun::layers`], as
    /// [`edges_in_layers`](Self::edges_in_layers) has those of edges.
    ///
    /// # Errors
    ///
    /// As for `lines`.
    pub fn lines_in_layers(&self, overlay: &Overlay) -> Result<Vec<LineRun>, Error> {
        let runs = self.lines(overlay)?;
        let (segments, sights) = sights(&self.rims.lines, overlay)?;
        let all: Vec<Hidden> =
            sights.into_iter().map(|sight| Hidden { sight, own: u32::MAX }).collect();
        let steps = self.steps(&all)?;
        let mut layered = Vec::new();
        let mut runs = runs.iter().peekable();
        for (number, segment) in segments.iter().enumerate() {
            let name = (segment.line, segment.number);
            while let Some(run) = runs.next_if(|run| (run.line, run.segment) == name) {
                let steps = Some((&all[number].sight, steps.of(number)));
                for (ends, layers) in in_layers(run.ends, run.is_visible, steps)? {
                    push(&mut layered, LineRun { ends, layers: Some(layers), ..*run })?;
                }
            }
        }
        Ok(layered)
    }

    fn steps(&self, all: &[Hidden]) -> Result<Steps, Error> {
        let (stock, faces) = (&self.stock, self.stock.frame.faces);
        let mut reaches = Reaches::default();
        // Polygons that do not show hide edges too.
        let mut rims = Rims::new(stock);
        for face in (0..faces.len() as u32).filter(|&face| stock.sees(face)) {
            reaches.push(face, rims.outline(stock, face)?)?;
        }
        let around = |face: u32| stock.views[face as usize].region;
        let pieces = Pieces { lines: &rims.lines, reaches, face: &|face| face, around: &around };
        let sights: Vec<Sight> = all.iter().map(|hidden| hidden.sight).collect();
        let passing = Passing { sights: &sights, spots: &[] };
        let found = passes(pieces, passing, |is_behind| is_behind, &Watch::default())?;
        let mut passes = found.sights;
        passes.retain(|pass| pass.piece != all[pass.sight as usize].own);
        let polygon = |face: u32| faces.polygon(face);
        passes.sort_unstable_by(|a, b| {
            let keys = [a, b].map(|pass| (pass.sight, polygon(pass.piece)));
            keys[0].cmp(&keys[1]).then(a.places[0].total_cmp(&b.places[0]))
        });
        let (mut steps, mut changes) = (Steps::default(), Vec::new());
        let mut rest = &passes[..];
        for number in 0..all.len() as u32 {
            let (own, others) = rest.split_at(rest.partition_point(|pass| pass.sight == number));
            rest = others;
            changes.clear();
            for same in own.chunk_by(|a, b| polygon(a.piece) == polygon(b.piece)) {
                // Each polygon counts once, however many parts of it there are.
                let mut parts = same.iter().map(|pass| pass.places).peekable();
                while let Some([from, mut to]) = parts.next() {
                    while let Some(next) = parts.next_if(|next| next[0] <= to + SHORTEST) {
                        to = to.max(next[1]);
                    }
                    push(&mut changes, (from, 1))?;
                    push(&mut changes, (to, -1))?;
                }
            }
            changes.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            push(&mut steps.begins, steps.steps.len())?;
            let mut layers = 0i64;
            for &(from, change) in &changes {
                layers += change;
                push(&mut steps.steps, Step { from, layers: layers as u32 })?;
            }
        }
        push(&mut steps.begins, steps.steps.len())?;
        Ok(steps)
    }
}

/// The parts of a run, and how many layers are in front of each: one at least if it is hidden. Parts that
/// rounding has left are not told from those before them.
fn in_layers(
    ends: Ends,
    is_visible: bool,
    steps: Option<(&Sight, &[Step])>,
) -> Result<Vec<(Ends, u32)>, Error> {
    let Some((sight, steps)) = steps.filter(|_| !is_visible) else {
        return Ok(vec![(ends, u32::from(!is_visible))]);
    };
    let [a, b] = ends.map(|end| sight.place(end));
    let (low, high) = (a.min(b), a.max(b));
    // Where each part begins, as a share of the run.
    let mut parts: Vec<(f64, u32)> = Vec::new();
    let first = steps.partition_point(|step| step.from <= low);
    let before = first.checked_sub(1).map_or(0, |before| steps[before].layers);
    let inside = steps[first..].iter().take_while(|step| step.from < high);
    let begins = inside.map(|step| (step.from, step.layers));
    let mut begins = [(low, before)].into_iter().chain(begins).peekable();
    while let Some((from, layers)) = begins.next() {
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
