//! Choosing the splitter of a set of pieces.

use super::Heuristic;
use super::axis::Sweep;
use super::cost::Counts;
use super::gather::Gathered;
use super::live::Live;
use super::peel::Peeler;
use super::progress::Watch;
use super::taken::TakenApart;
use crate::geom::{Faces, Kernel, PlaneId};
use crate::random::mix;

/// How many own planes the heuristics that would look at all of them try at most, so that no
/// node takes quadratic time. They are spread evenly over the set.
const MOST_CANDIDATES: usize = 256;
/// How often a candidate is asked whether it can still win, in pieces.
pub(super) const CHECK_EVERY: usize = 32;

/// So many pieces of a set are gathered at a time, to be held against several planes. Larger:
/// memory; smaller: planes are fetched more often.
const GATHERED: usize = 512;

/// What is to be done with a set.
#[derive(Debug)]
pub(super) enum Choice {
    /// It is divided by this plane.
    Split(PlaneId),
    /// It is taken apart as the chooser has found.
    TakeApart,
}

/// Chooses the splitters of one tree.
#[derive(Debug)]
pub(super) struct Chooser<'a, K: Kernel> {
    pub(super) kernel: K,
    pub(super) faces: &'a Faces,
    heuristic: Heuristic,
    /// Once a build is cancelled, any plane is chosen, quickly.
    pub(super) watch: &'a Watch<'a>,
    pub(super) sweep: Sweep,
    /// How many pieces were looked at since a set was last tried to be taken apart.
    pub(super) credit: usize,
    /// How often no free plane was found that cuts nothing, in a small scene.
    pub(super) misses: usize,
    pub(super) peeler: Peeler,
    /// How a set is taken apart.
    pub(super) taken: TakenApart,
    /// The set at hand, if it is small.
    pub(super) set: Gathered<K>,
    /// The planes that are tried, and how they divide the set.
    tried: Vec<(K::Splitter, Counts)>,
    /// Pieces of the set whose planes are to be tried, with what they promise.
    pub(super) ranked: Vec<(f64, u32)>,
}

impl<'a, K: Kernel> Chooser<'a, K> {
    pub(super) fn new(
        kernel: K,
        faces: &'a Faces,
        heuristic: Heuristic,
        watch: &'a Watch<'a>,
    ) -> Self {
        Self {
            kernel,
            faces,
            heuristic,
            watch,
            sweep: Sweep::default(),
            credit: usize::MAX,
            misses: 0,
            peeler: Peeler::default(),
            taken: TakenApart::default(),
            set: Gathered::default(),
            tried: vec![],
            ranked: vec![],
        }
    }

    /// What to do with a set of at least one piece, that has `depth` nodes above it. A splitter is
    /// either the plane of a piece, or both its sides have fewer pieces than the set.
    pub(super) fn choose(&mut self, pieces: &[Live], arena: &[K::Vertex], depth: usize) -> Choice {
        let own = |piece: &Live| PlaneId::face(piece.face);
        let lowest = || pieces.iter().min_by_key(|piece| piece.face).unwrap_or(&pieces[0]);
        Choice::Split(match self.heuristic {
            Heuristic::First => own(lowest()),
            Heuristic::Random { seed } => {
                let set = u64::from(lowest().face) << 32 | pieces.len() as u64;
                own(&pieces[(mix(seed ^ mix(set)) % pieces.len() as u64) as usize])
            }
            Heuristic::FewestSplits => self.scored(pieces, arena, MOST_CANDIDATES, |c, _| {
                c.splits as f64 * 1e9 + c.imbalance()
            }),
            Heuristic::Balanced => self.scored(pieces, arena, MOST_CANDIDATES, |c, _| {
                c.imbalance() * 1e9 + c.splits as f64
            }),
            Heuristic::Weighted { splits, balance, axial } => {
                let bonus = axial * pieces.len() as f64;
                self.scored(pieces, arena, MOST_CANDIDATES, |c, is_axial| {
                    let reward = if is_axial { bonus } else { 0.0 };
                    splits * c.splits as f64 + balance * c.imbalance() - reward
                })
            }
            Heuristic::Sampled { candidates } => self.sampled(pieces, arena, candidates as usize),
            Heuristic::FreePlanes => self.free(pieces),
            Heuristic::Auto => return self.auto(pieces, arena, depth),
        })
    }

    /// The best of a sample of own planes by a score, lower being better; the earliest of equals.
    fn scored(
        &mut self,
        pieces: &[Live],
        arena: &[K::Vertex],
        candidates: usize,
        score: impl Fn(&Counts, bool) -> f64,
    ) -> PlaneId {
        let ready = |piece: &Live| {
            let splitter = self.kernel.splitter(self.faces, PlaneId::face(piece.face));
            (splitter, Counts::default())
        };
        self.tried.clear();
        self.tried.extend(sample(pieces, candidates).map(ready));
        for part in pieces.chunks(GATHERED) {
            if self.watch.work(part.len() * self.tried.len()).is_err() {
                break;
            }
            self.set.gather(self.faces, part, arena);
            for (splitter, counts) in &mut self.tried {
                let reaches = self.set.reaches(splitter, 0..part.len());
                *counts = reaches.fold(*counts, Counts::with);
            }
        }
        let mut best = (f64::INFINITY, PlaneId::face(pieces[0].face));
        for (piece, (_, counts)) in sample(pieces, candidates).zip(&self.tried) {
            let is_axial = (0..3).any(|axis| piece.min[axis] == piece.max[axis]);
            let score = score(counts, is_axial);
            if score < best.0 {
                best = (score, PlaneId::face(piece.face));
            }
        }
        best.1
    }

    /// The best of so many own planes, by what they cut and how evenly they divide.
    pub(super) fn sampled(
        &mut self,
        pieces: &[Live],
        arena: &[K::Vertex],
        candidates: usize,
    ) -> PlaneId {
        self.scored(pieces, arena, candidates, |c, _| 8.0 * c.splits as f64 + c.imbalance())
    }

    /// The free plane of least cost; where none separates anything, a piece's own.
    fn free(&mut self, pieces: &[Live]) -> PlaneId {
        let best = self.sweep.best(pieces, self.faces.tolerance(), self.watch);
        let named = best.and_then(|plane| plane.id(self.faces, pieces));
        named.unwrap_or(PlaneId::face(pieces[0].face))
    }

    /// How a plane divides the pieces, by rounded distances: what is decided here is only which
    /// plane is taken. Breaks off where the cost reaches a limit; tells whether it did not.
    pub(super) fn count(
        &self,
        plane: PlaneId,
        pieces: &[Live],
        arena: &[K::Vertex],
        limit: f64,
    ) -> (Counts, bool) {
        let splitter = self.kernel.splitter(self.faces, plane);
        let mut counts = Counts::default();
        if self.watch.work(pieces.len()).is_err() {
            return (counts, false);
        }
        for chunk in pieces.chunks(CHECK_EVERY) {
            for live in chunk {
                counts = counts.with(self.reach(&splitter, live, arena));
            }
            if limit < f64::INFINITY && counts.cost() >= limit {
                return (counts, false);
            }
        }
        (counts, true)
    }
}

/// At most `count` of the pieces, spread evenly.
pub(super) fn sample(pieces: &[Live], count: usize) -> impl Iterator<Item = &Live> {
    let count = count.min(pieces.len());
    (0..count).map(move |i| &pieces[i * pieces.len() / count])
}
