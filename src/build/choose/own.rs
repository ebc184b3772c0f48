//! The best plane among the pieces' own planes: by counting all pieces, or by successive halving of the
//! candidates over growing samples.

use super::cost::{CostModel, Counts, work};
use super::set::{LANES, PackedPieces, PackedPlane, Set};
use super::tuning::Tuning;
use crate::build::piece::Piece;
use crate::exact::{PlaneId, gcd};
use crate::progress::{PIECES_AT_ONCE, Watch};

/// A piece whose plane is tried.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// The piece, by its number in the set.
    piece: usize,
    /// The cost of the piece's plane, estimated from `counts`.
    cost: f64,
    /// The share of the set's bounding box that the piece fills, 0 to 1.
    share: f64,
    plane: PackedPlane,
    /// The numbers of compared pieces in front of the candidate's plane, behind that plane, and across it.
    counts: Counts,
}

/// The share of a set's bounding box that a piece fills along the two axes of its largest share, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    /// 1 divided by the size of the box; `None` along axes where the box has no extent.
    per_unit: [Option<f64>; 3],
}

impl Shares {
    pub(super) fn of(size: [f64; 3]) -> Self {
        Self { per_unit: size.map(|size| (size > 0.0).then(|| 1.0 / size)) }
    }

    #[inline]
    pub(super) fn get(&self, piece: &Piece) -> f64 {
        let [x, y, z] = std::array::from_fn(|axis| {
            let size = piece.max[axis] - piece.min[axis];
            self.per_unit[axis].map_or(1.0, |per_unit| size * per_unit)
        });
        // The largest product of two of the three.
        (x * y).max(y * z).max(z * x)
    }
}

/// No more pieces than this are compared with candidates. Too small: worse planes. Too large: time.
const LARGEST_SAMPLE: usize = 1024;
/// The least sample after which the search may end early. Too small: good planes are dropped by chance.
const ENOUGH: usize = 64;
/// The search ends early if all costs over the sample are more than this many times the cost of another plane.
/// Too small: good planes are dropped. Too large: time.
const HOPELESS: f64 = 1.15;

/// Compares candidates with more and more pieces, and keeps the best candidates (successive halving: Karnin,
/// Koren and Somekh, “Almost optimal exploration in multi-armed bandits”, 2013).
#[derive(Debug, Default)]
pub(super) struct Candidates {
    field: Vec<Candidate>,
    /// The number of groups of packed pieces that the candidates were compared with.
    seen: usize,
    /// The cost of each candidate, with the candidate's place in the field.
    ranks: Vec<(f64, u32)>,
    /// The places of the candidates whose planes had all pieces of the first sample on one side. A candidate
    /// had the same place in the initial field and in the packed pieces.
    one_sided: Vec<usize>,
}

impl Candidates {
    /// Replaces the field by the first `count` pieces of the sample, and compares their planes with the first
    /// pieces of the sample.
    pub(super) fn begin(
        &mut self,
        set: &Set<'_>,
        sample: &mut Sample,
        count: usize,
        terms: &CostModel,
        tuning: &Tuning,
    ) {
        let shares = Shares::of(set.size());
        let sketch = &sample.sketch;
        self.seen = 0;
        let pieces = (0..count.min(sketch.len())).map(|place| sketch.number(place));
        self.field.clear();
        self.field.extend(pieces.map(|piece| Candidate {
            piece,
            share: shares.get(&set.pieces[piece]),
            plane: sketch.plane(set, piece),
            counts: Counts::default(),
            cost: f64::INFINITY,
        }));
        self.look(set, sample, tuning.first_sample, terms);
        let is_one_sided =
            |c: &Candidate| c.counts.splits == 0 && c.counts.front.min(c.counts.back) == 0;
        let found = self.field.iter().enumerate().filter(|(_, candidate)| is_one_sided(candidate));
        self.one_sided.clear();
        self.one_sided.extend(found.map(|(place, _)| place));
    }

    /// Returns the places, in the list of packed pieces, of the candidates whose planes had all pieces of the
    /// first sample on one side.
    pub(super) fn one_sided(&self) -> &[usize] {
        &self.one_sided
    }

    /// Returns the best plane of the field and its cost, after comparing the planes with larger and larger parts
    /// of the set. Of equal planes, returns the earliest. Ends early, with no plane, if all planes cost far more
    /// than `other`, another plane's cost.
    pub(super) fn best(
        &mut self,
        set: &Set<'_>,
        sample: &mut Sample,
        terms: &CostModel,
        tuning: &Tuning,
        other: f64,
    ) -> Option<(PlaneId, f64)> {
        let mut looked = tuning.first_sample;
        while looked < set.len().min(LARGEST_SAMPLE) {
            let most = HOPELESS * other * work(looked) / work(set.len());
            if looked >= ENOUGH && self.field.iter().all(|candidate| candidate.cost > most) {
                return None;
            }
            self.halve(tuning.rate);
            looked *= tuning.rate;
            self.look(set, sample, looked, terms);
        }
        let best = self.field.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))?;
        let cost = best.cost * work(set.len()) / work(looked.min(set.len()));
        Some((set.own_plane(best.piece), cost))
    }

    /// Keeps the best 1/`rate` of the candidates, in unchanged order.
    fn halve(&mut self, rate: usize) {
        let left = self.field.len().div_ceil(rate);
        if left == self.field.len() {
            return;
        }
        self.ranks.clear();
        self.ranks.extend(self.field.iter().zip(0..).map(|(candidate, i)| (candidate.cost, i)));
        let by_cost = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        self.ranks.select_nth_unstable_by(left, by_cost);
        self.ranks.truncate(left);
        self.ranks.sort_unstable_by_key(|&(_, i)| i);
        for (next, &(_, i)) in self.ranks.iter().enumerate() {
            self.field[next] = self.field[i as usize];
        }
        self.field.truncate(left);
    }

    /// Compares all candidates with the first `pieces` pieces.
    fn look(&mut self, set: &Set<'_>, sample: &mut Sample, pieces: usize, terms: &CostModel) {
        sample.grow(set, pieces);
        let sketch = &sample.sketch;
        let groups = self.seen..pieces.min(set.len()).div_ceil(LANES);
        self.seen = groups.end;
        let looked = sketch.len().min(groups.end * LANES);
        let terms = if looked == set.len() { *terms } else { terms.of_sample(looked, set.len()) };
        for candidate in &mut self.field {
            candidate.counts += sketch.count(&candidate.plane, groups.clone());
            candidate.cost = terms.cost(&candidate.counts, candidate.share);
        }
    }
}

/// A chooser among the planes of the set's pieces. Its buffers are reused.
#[derive(Debug, Default)]
pub(super) struct Scored {
    sketch: PackedPieces,
    /// Each tried piece, and how its plane divides the set.
    tried: Vec<(usize, PackedPlane, Counts)>,
}

impl Scored {
    /// Returns the plane with the lowest score among the planes of `candidates` pieces. Of equal planes,
    /// returns the earliest. The score depends on the counts and on whether the plane is perpendicular to an
    /// axis.
    pub(super) fn best(
        &mut self,
        set: &Set<'_>,
        candidates: usize,
        watch: &Watch<'_>,
        score: impl Fn(&Counts, bool) -> (f64, f64),
    ) -> PlaneId {
        let Self { sketch, tried } = self;
        sketch.reset(set);
        tried.clear();
        tried.reserve(candidates.min(set.len()));
        let planes = set.sample(candidates).map(|piece| (piece, sketch.plane(set, piece)));
        tried.extend(planes.map(|(piece, plane)| (piece, plane, Counts::default())));
        for start in (0..set.len()).step_by(PIECES_AT_ONCE) {
            let part = start..set.len().min(start + PIECES_AT_ONCE);
            if watch.work(part.len() * tried.len()).is_err() {
                break;
            }
            sketch.clear();
            sketch.extend(set, part.clone());
            for (_, plane, counts) in &mut *tried {
                *counts += sketch.count(plane, 0..part.len().div_ceil(LANES));
            }
        }
        let scores = tried.iter().map(|&(own, _, counts)| {
            let Piece { min, max, .. } = set.pieces[own];
            (score(&counts, (0..3).any(|axis| min[axis] == max[axis])), own)
        });
        let best = scores.min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        set.own_plane(best.map_or(0, |(_, piece)| piece))
    }
}

/// Some packed pieces of a set, extended in an order in which every prefix is a sample of the set.
#[derive(Debug, Default)]
pub(super) struct Sample {
    pub(super) sketch: PackedPieces,
    rest: Spread,
}

impl Sample {
    /// Replaces the sample by the first `count` pieces, or by all pieces if there are fewer.
    pub(super) fn restart(&mut self, set: &Set<'_>, count: usize) {
        self.sketch.clear();
        self.rest = Spread::new(set.len());
        self.grow(set, count);
    }

    /// Adds pieces until there are `count`, or all.
    pub(super) fn grow(&mut self, set: &Set<'_>, count: usize) {
        let missing = count.min(set.len()).saturating_sub(self.sketch.len());
        if missing > 0 {
            self.sketch.extend(set, self.rest.by_ref().take(missing));
        }
    }
}

/// The numbers below `n` in an order in which every prefix is spread evenly.
#[derive(Debug, Default)]
struct Spread {
    n: usize,
    /// Coprime to `n`.
    step: usize,
    next: usize,
    left: usize,
}

impl Spread {
    fn new(n: usize) -> Self {
        Self { n, step: coprime(n), next: 0, left: n }
    }
}

impl Iterator for Spread {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        self.left = self.left.checked_sub(1)?;
        let here = self.next;
        self.next += self.step;
        self.next -= if self.next < self.n { 0 } else { self.n };
        Some(here)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for Spread {}

/// Returns a number coprime to `n`, near the golden section of `n`. The multiples of this number modulo `n`
/// are spread most evenly.
fn coprime(n: usize) -> usize {
    let section = (n as f64 * 0.618_034) as usize;
    (section.max(1)..n.max(2)).find(|&step| gcd(step as u64, n as u64) == 1).unwrap_or(1)
}

#[cfg(test)]
mod tests;

#[cfg(test)]
mod sample_tests {
    use super::Spread;

    #[test]
    fn every_number_comes_once_and_the_first_are_spread_evenly() {
        for n in (0..100).chain([255, 256, 1000, 4096]) {
            let mut numbers: Vec<usize> = Spread::new(n).collect();
            let first = numbers.len().min(16);
            let mut sample = numbers[..first].to_vec();
            sample.sort_unstable();
            for pair in sample.windows(2) {
                assert!(pair[1] - pair[0] <= 4 * n / first + 2, "{n}: {sample:?}");
            }
            numbers.sort_unstable();
            assert!(numbers.iter().copied().eq(0..n));
        }
    }
}
