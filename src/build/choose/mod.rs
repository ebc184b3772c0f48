//! Choosing the splitter of a set of pieces.

mod auto;
mod cost;
mod free;
mod own;
mod peel;
mod set;
mod sketch;
#[cfg(test)]
mod tests;
mod tuning;

use super::Heuristic;
use super::progress::Watch;
use crate::exact::{Kernel, PlaneId};
use crate::random::mix;
use cost::Counts;
use free::Sweep;
use own::Contest;
pub(super) use peel::Peeled;
use peel::Peeler;
pub(super) use set::{Normals, Set};
use sketch::{LANES, Sketch, SketchPlane};
pub use tuning::Tuning;

/// The most own planes that heuristics try which would try all, spread evenly over the set. More: time
/// that grows with the square of the set; fewer: planes that cut more.
const MOST_CANDIDATES: usize = 256;
/// Pieces sketched at a time, to be compared with all candidates. Larger: memory; smaller: planes
/// are fetched more often.
const SKETCHED: usize = 512;

/// What is to be done with a set.
#[derive(Debug)]
pub(super) enum Choice {
    /// It is divided by this plane.
    Split(PlaneId),
    /// These pieces are taken off it.
    Peel(Peeled),
}

/// Chooses the splitters of one tree; its lists are kept to be used again.
#[derive(Debug)]
pub(super) struct Chooser<'a> {
    heuristic: Heuristic,
    /// Once a build is cancelled, any plane is chosen, quickly.
    watch: &'a Watch<'a>,
    tuning: &'a Tuning,
    sweep: Sweep,
    sketch: Sketch,
    contest: Contest,
    peeler: Peeler,
    /// The planes that are tried, and how they divide the set.
    tried: Vec<(usize, SketchPlane, Counts)>,
}

impl<'a> Chooser<'a> {
    pub(super) fn new(heuristic: Heuristic, tuning: &'a Tuning, watch: &'a Watch<'a>) -> Self {
        Self {
            heuristic,
            watch,
            tuning,
            sweep: Sweep::default(),
            sketch: Sketch::default(),
            contest: Contest::default(),
            peeler: Peeler::default(),
            tried: vec![],
        }
    }

    /// Chooses what to do with a set of at least one piece. `is_peeled`: peeling has just been tried
    /// on it. Not every plane chosen makes progress; the builder checks.
    pub(super) fn choose<K: Kernel>(&mut self, set: &Set<'_, K>, is_peeled: bool) -> Choice {
        let lowest = || (0..set.len()).min_by_key(|&piece| set.pieces[piece].face).unwrap_or(0);
        Choice::Split(match self.heuristic {
            Heuristic::First => set.own_plane(lowest()),
            Heuristic::Random { seed } => {
                let lowest = u64::from(set.pieces[lowest()].face);
                let random = mix(seed ^ mix(lowest << 32 | set.len() as u64));
                set.own_plane((random % set.len() as u64) as usize)
            }
            Heuristic::FewestSplits => self.scored(set, MOST_CANDIDATES, |c, _| {
                (f64::from(c.splits), f64::from(c.imbalance()))
            }),
            Heuristic::Balanced => self.scored(set, MOST_CANDIDATES, |c, _| {
                (f64::from(c.imbalance()), f64::from(c.splits))
            }),
            Heuristic::Weighted { splits, balance, axial } => {
                let bonus = axial * set.len() as f64;
                self.scored(set, MOST_CANDIDATES, |c, is_axial| {
                    let reward = if is_axial { bonus } else { 0.0 };
                    (
                        splits * f64::from(c.splits) + balance * f64::from(c.imbalance()) - reward,
                        0.0,
                    )
                })
            }
            Heuristic::Sampled { candidates } => self.scored(set, candidates as usize, |c, _| {
                (8.0 * f64::from(c.splits) + f64::from(c.imbalance()), 0.0)
            }),
            Heuristic::FreePlanes => self.free(set),
            Heuristic::Auto => return self.auto(set, is_peeled),
        })
    }

    /// The best of a sample of own planes by a score, lower being better; the earliest of equals.
    fn scored<K: Kernel>(
        &mut self,
        set: &Set<'_, K>,
        candidates: usize,
        score: impl Fn(&Counts, bool) -> (f64, f64),
    ) -> PlaneId {
        self.sketch.reset(set);
        let sketch = &mut self.sketch;
        self.tried.clear();
        self.tried.extend(
            set.sample(candidates)
                .map(|piece| (piece, sketch.plane(set, piece), Counts::default())),
        );
        for start in (0..set.len()).step_by(SKETCHED) {
            let part = start..set.len().min(start + SKETCHED);
            if self.watch.work(part.len() * self.tried.len()).is_err() {
                break;
            }
            sketch.clear();
            sketch.extend(set, part.clone());
            for (_, plane, counts) in &mut self.tried {
                *counts += sketch.count(plane, 0..part.len().div_ceil(LANES));
            }
        }
        let score = |&(piece, _, counts): &(usize, SketchPlane, Counts)| {
            let piece = &set.pieces[piece];
            score(&counts, (0..3).any(|axis| piece.min[axis] == piece.max[axis]))
        };
        let scores = self.tried.iter().map(|tried| (score(tried), tried.0));
        let best = scores.min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        set.own_plane(best.map_or(0, |(_, piece)| piece))
    }

    /// The free plane of least cost; where none separates anything, a piece's own.
    fn free<K: Kernel>(&mut self, set: &Set<'_, K>) -> PlaneId {
        let best = self.sweep.best(set, self.tuning, self.watch);
        best.and_then(|plane| plane.id(set)).unwrap_or(set.own_plane(0))
    }
}
