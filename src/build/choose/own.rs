//! The best of the pieces' own planes, by successive halving.

#[cfg(test)]
mod tests;

use super::cost::{Cost, Counts, work};
use super::set::Set;
use super::sketch::{LANES, Sketch, SketchPlane};
use super::tuning::Tuning;
use crate::build::live::Live;
use crate::exact::Kernel;

/// How many of the largest pieces are candidates besides the sample. Fewer: a large wall outside the
/// sample is cut again and again; more: time.
const LARGEST: usize = 2;

/// A candidate for the plane that divides a set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// The piece, by its number in the set.
    pub(super) piece: usize,
    /// What its plane costs, as far as is known.
    pub(super) cost: Cost,
    /// How much of the set's bounding box the piece fills, 0 to 1.
    share: f64,
    plane: SketchPlane,
    /// Of the pieces that it was compared with.
    counts: Counts,
}

/// What decides between candidates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms {
    /// What a polygon that fills the box is worth.
    reward: f64,
    /// How many pieces there are.
    pieces: f64,
    /// In a large set, a plane that cuts nothing is passed over unless both sides, or the plane
    /// itself, get at least this many pieces.
    least: Option<f64>,
}

impl Terms {
    /// Of a small set: what cuts nothing is preferred.
    pub(super) fn small<K: Kernel>(set: &Set<'_, K>, tuning: &Tuning) -> Self {
        let cuts: usize = set.pieces.iter().map(|piece| usize::from(piece.cuts)).sum();
        let pieces = set.len() as f64;
        let mean = cuts as f64 / pieces;
        Self { reward: tuning.reward * (1.0 + mean) * pieces, pieces, least: None }
    }

    /// Of a large set. Whether a plane cuts is left out: the first rounds see a sample, in which many
    /// planes cut nothing that cut much of the set.
    pub(super) fn large<K: Kernel>(set: &Set<'_, K>, tuning: &Tuning) -> Self {
        let least = Some((set.len() / tuning.least_share) as f64);
        Self { least, ..Self::small(set, tuning) }
    }

    /// The same terms for counts over a sample of `looked` of `all` pieces. (Work is a power: the
    /// work of a share of the pieces is a fixed share of the work, so costs of samples compare.)
    fn of_sample(&self, looked: usize, all: usize) -> Self {
        let ratio = looked as f64 / all as f64;
        Self {
            reward: self.reward * work(looked) / work(all),
            pieces: looked as f64,
            least: self.least.map(|least| least * ratio),
        }
    }

    #[inline]
    fn cost(&self, counts: &Counts, share: f64) -> Cost {
        let cost = Cost::of(counts);
        let amount = cost.amount - self.reward * share;
        let Some(least) = self.least else { return Cost { amount, ..cost } };
        let [front, back] = [counts.front, counts.back].map(f64::from);
        let on = self.pieces - front - back;
        let is_passed_over = counts.splits == 0 && front.min(back).max(on) < least;
        Cost { cuts: false, amount: if is_passed_over { f64::INFINITY } else { amount } }
    }
}

/// How much of its set's bounding box a piece fills along its two longer sides, 0 to 1.
#[derive(Clone, Copy, Debug)]
struct Shares {
    /// 1 by the size of the box; none where the box has no extent.
    per_unit: [Option<f64>; 3],
}

impl Shares {
    fn of<K: Kernel>(set: &Set<'_, K>) -> Self {
        Self { per_unit: set.size().map(|size| (size > 0.0).then(|| 1.0 / size)) }
    }

    #[inline]
    fn get(&self, piece: &Live) -> f64 {
        let [x, y, z] = std::array::from_fn(|axis| {
            let size = piece.max[axis] - piece.min[axis];
            self.per_unit[axis].map_or(1.0, |per_unit| size * per_unit)
        });
        // The largest product of two of the three.
        (x * y).max(y * z).max(z * x)
    }

    /// The pieces that fill most of the box.
    fn largest(&self, pieces: &[Live]) -> impl Iterator<Item = usize> + use<> {
        let mut top: [(f64, Option<usize>); LARGEST] = [(0.0, None); LARGEST];
        for (i, piece) in pieces.iter().enumerate() {
            let share = self.get(piece);
            if share > top[LARGEST - 1].0 {
                top[LARGEST - 1] = (share, Some(i));
                top.sort_by(|a, b| b.0.total_cmp(&a.0));
            }
        }
        top.into_iter().filter_map(|(_, piece)| piece)
    }
}

/// Compares candidates with more and more pieces, and keeps the best of them (successive halving: Karnin, Koren and Somekh, “Almost optimal exploration in multi-armed bandits”, 2013).
#[derive(Debug, Default)]
pub(super) struct Contest {
    field: Vec<Candidate>,
    /// How many of the field were taken from the sketch: they have the same places in both.
    sketched: usize,
    /// How many groups of the sketch they were compared with.
    seen: usize,
    /// The costs of the field, by their places in it.
    ranks: Vec<(Cost, u32)>,
    /// Places in the field of those that had all pieces of the first sample on one side.
    one_sided: Vec<usize>,
}

impl Contest {
    /// Replaces the field by the first `count` pieces of the sketch and the largest pieces of the set.
    pub(super) fn enter<K: Kernel>(&mut self, set: &Set<'_, K>, sketch: &Sketch, count: usize) {
        self.seen = 0;
        self.field.clear();
        self.one_sided.clear();
        let shares = Shares::of(set);
        let largest = (set.len() > count).then(|| shares.largest(set.pieces)).into_iter();
        self.sketched = count.min(sketch.len());
        let first = (0..self.sketched).map(|place| sketch.number(place));
        self.field.extend(first.chain(largest.flatten()).map(|piece| Candidate {
            piece,
            share: shares.get(&set.pieces[piece]),
            plane: sketch.plane(set, piece),
            counts: Counts::default(),
            cost: Cost::MOST,
        }));
    }

    /// Compares all candidates with the first sample.
    pub(super) fn begin<K: Kernel>(
        &mut self,
        set: &Set<'_, K>,
        sketch: &mut Sketch,
        order: &mut impl Iterator<Item = usize>,
        terms: &Terms,
        tuning: &Tuning,
    ) {
        self.look(set, sketch, order, tuning.first_sample, terms);
        let is_one_sided =
            |c: &Candidate| c.counts.splits == 0 && c.counts.front.min(c.counts.back) == 0;
        let found = self.field.iter().enumerate().filter(|(_, candidate)| is_one_sided(candidate));
        self.one_sided.extend(found.map(|(place, _)| place));
    }

    /// How many candidates had all pieces of the first sample on one side of their planes.
    pub(super) fn one_sided(&self) -> usize {
        self.one_sided.len()
    }

    /// The places in the sketch of those among them that were taken from it.
    pub(super) fn one_sided_places(&self) -> impl Iterator<Item = usize> {
        self.one_sided.iter().copied().take_while(|&place| place < self.sketched)
    }

    /// The best candidate after the first sample; the earliest of equals. What the sketch lacks of
    /// the set is added to it in an order of which every beginning is a sample of the set.
    pub(super) fn best<K: Kernel>(
        &mut self,
        set: &Set<'_, K>,
        sketch: &mut Sketch,
        order: &mut impl Iterator<Item = usize>,
        terms: &Terms,
        tuning: &Tuning,
    ) -> Option<Candidate> {
        let mut sample = tuning.first_sample;
        while sample < set.len() {
            self.halve(tuning.rate);
            sample *= tuning.rate;
            self.look(set, sketch, order, sample, terms);
        }
        self.field.iter().min_by(|a, b| a.cost.cmp(&b.cost)).copied()
    }

    /// Keeps the best 1/`rate` of the candidates, in their order.
    fn halve(&mut self, rate: usize) {
        let left = self.field.len().div_ceil(rate);
        if left == self.field.len() {
            return;
        }
        self.ranks.clear();
        self.ranks.extend(self.field.iter().zip(0..).map(|(candidate, i)| (candidate.cost, i)));
        let by_cost = |a: &(Cost, u32), b: &(Cost, u32)| a.0.cmp(&b.0).then(a.1.cmp(&b.1));
        self.ranks.select_nth_unstable_by(left, by_cost);
        self.ranks.truncate(left);
        self.ranks.sort_unstable_by_key(|&(_, i)| i);
        for (next, &(_, i)) in self.ranks.iter().enumerate() {
            self.field[next] = self.field[i as usize];
        }
        self.field.truncate(left);
    }

    /// Compares all candidates with the first `pieces` pieces.
    fn look<K: Kernel>(
        &mut self,
        set: &Set<'_, K>,
        sketch: &mut Sketch,
        order: &mut impl Iterator<Item = usize>,
        pieces: usize,
        terms: &Terms,
    ) {
        let pieces = pieces.min(set.len());
        let missing = pieces.saturating_sub(sketch.len());
        if missing > 0 {
            sketch.extend(set, order.take(missing));
        }
        let groups = self.seen..pieces.div_ceil(LANES);
        self.seen = groups.end;
        let looked = sketch.len().min(groups.end * LANES);
        let terms = if looked == set.len() { *terms } else { terms.of_sample(looked, set.len()) };
        for candidate in &mut self.field {
            candidate.counts += sketch.count(&candidate.plane, groups.clone());
            candidate.cost = terms.cost(&candidate.counts, candidate.share);
        }
    }
}
