//! What a plane does to a set of pieces, what that costs, and the numbers of choosing.

use std::cmp::Ordering;
use std::ops::AddAssign;

use super::set::Set;
use crate::exact::PlaneId;

/// How many pieces lie in front of a plane, behind it, and across.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) front: u32,
    pub(super) back: u32,
    pub(super) splits: u32,
}

impl Counts {
    pub(super) fn imbalance(&self) -> u32 {
        self.front.abs_diff(self.back)
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.front += other.front;
        self.back += other.back;
        self.splits += other.splits;
    }
}

/// What it costs to divide a set by a plane. The lower cost is the better.
///
/// A plane that cuts nothing costs less than any that cuts: it adds no fragment, now or later.
/// (Any tree of a set, restricted to one side of a plane, is a tree of that side.) In large sets
/// whether a plane cuts is left out (see `CostModel::large`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cost {
    pub(super) cuts: bool,
    pub(super) amount: f64,
}

impl Cost {
    /// Of a plane by what it does to the pieces: the work left on both sides.
    #[inline]
    pub(super) fn of(counts: &Counts) -> Self {
        let Counts { front, back, splits } = *counts;
        let amount = work((front + splits) as usize) + work((back + splits) as usize);
        Self { cuts: splits > 0, amount }
    }

    /// More than that of any plane.
    pub(super) const MOST: Self = Self { cuts: true, amount: f64::INFINITY };

    /// Whether it is that of a plane that cuts nothing, and leaves at least one in so many pieces on
    /// either side.
    pub(super) fn divides_evenly(&self, pieces: usize, uneven: usize) -> bool {
        !self.cuts && self.amount <= work(pieces / uneven) + work(pieces - pieces / uneven)
    }

    /// Whether the plane is better than another.
    #[inline]
    pub(super) fn is_less(&self, other: &Self) -> bool {
        (self.cuts, other.cuts) == (false, true)
            || self.cuts == other.cuts && self.amount < other.amount
    }

    /// The order by [`is_less`](Self::is_less); no amount is NaN.
    pub(super) fn cmp(&self, other: &Self) -> Ordering {
        match (self.is_less(other), other.is_less(self)) {
            (true, _) => Ordering::Less,
            (_, true) => Ordering::Greater,
            _ => Ordering::Equal,
        }
    }
}

/// What decides between candidates.
#[derive(Clone, Copy, Debug)]
pub(super) struct CostModel {
    /// What a polygon that fills the box is worth.
    reward: f64,
    /// Whether a plane that cuts nothing is preferred to all that cut.
    prefers_uncut: bool,
}

impl CostModel {
    /// Of a small set: what cuts nothing is preferred.
    pub(super) fn small(set: &Set<'_>, tuning: &Tuning) -> Self {
        Self::of(set.len(), set.pieces.iter().map(|piece| usize::from(piece.cuts)).sum(), tuning)
    }

    /// Of so many pieces, cut so many times together.
    pub(super) fn of(pieces: usize, cuts: usize, tuning: &Tuning) -> Self {
        let pieces = pieces as f64;
        let mean = cuts as f64 / pieces;
        Self { reward: tuning.reward * (1.0 + mean) * pieces, prefers_uncut: true }
    }

    /// Of a large set: whether a plane cuts is left out. The first rounds see a sample, in which many planes
    /// cut nothing that cut much of the set; and the planes at the rim of a set, which cut nothing either,
    /// would make a list of it.
    pub(super) fn large(set: &Set<'_>, tuning: &Tuning) -> Self {
        Self { prefers_uncut: false, ..Self::small(set, tuning) }
    }

    /// The same terms for counts over a sample of `looked` of `all` pieces. (Work is a power: the
    /// work of a share of the pieces is a fixed share of the work, so costs of samples compare.)
    pub(super) fn of_sample(&self, looked: usize, all: usize) -> Self {
        Self { reward: self.reward * work(looked) / work(all), ..*self }
    }

    #[inline]
    pub(super) fn cost(&self, counts: &Counts, share: f64) -> Cost {
        let cost = self.compared(Cost::of(counts));
        Cost { amount: cost.amount - self.reward * share, ..cost }
    }

    /// A cost as it is compared with others by these terms.
    #[inline]
    pub(super) fn compared(&self, cost: Cost) -> Cost {
        Cost { cuts: cost.cuts && self.prefers_uncut, ..cost }
    }
}

/// A plane with what it costs to divide a set by it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PricedPlane {
    pub(super) plane: PlaneId,
    pub(super) cost: Cost,
}

/// The work of putting `n` pieces in order: n^1.25.
///
/// It grows faster than n·log n, the work of sorting, because a larger set is also cut more. A
/// larger exponent balances trees better, and cuts scans more for that; a smaller one prefers planes
/// at the rim of sets in which every plane cuts much.
#[inline]
pub(super) fn work(n: usize) -> f64 {
    WORK.get(n).copied().unwrap_or_else(|| {
        let n = n as f64;
        n * n.sqrt().sqrt()
    })
}

/// The work of small sets, which is asked for most often: to take two roots each time instead, builds
/// take 2 to 4 % longer.
static WORK: [f64; 1024] = {
    let (mut table, mut n) = ([0.0; 1024], 1);
    while n < table.len() {
        table[n] = n as f64 * sqrt(sqrt(n as f64));
        n += 1;
    }
    table
};

/// The square root of a number from 1 on, by Newton's method.
const fn sqrt(x: f64) -> f64 {
    let (mut root, mut steps) = (x, 0);
    while steps < 16 {
        root = 0.5 * (root + x / root);
        steps += 1;
    }
    root
}

/// What decides how planes are chosen, in numbers, but for the exponent in `cost.rs`.
/// `benches/ABLATION.md` says what each is worth.
#[derive(Clone, Copy, Debug)]
pub struct Tuning {
    /// Sets of fewer pieces try only free planes that cut nothing, found by sorting. Larger: fewer
    /// free planes to choose from; smaller: time, as counting by bins costs more than sorting.
    pub clean_below: usize,
    /// Sets of fewer pieces try more own planes, and pieces that need no cut are peeled off them.
    /// Larger: slightly fewer fragments, but more time and deeper trees; smaller: more fragments on
    /// scans, whose surfaces no free plane follows.
    pub small: usize,
    /// Own planes tried in a small set, and at most by the heuristics that score own planes alone.
    /// More: time; fewer: more fragments.
    pub own_planes: usize,
    /// Own planes tried in a large set. More: time; fewer: more fragments.
    pub few_own_planes: usize,
    /// A large set is searched for peelable pieces if at least this many of its tried own planes have
    /// the whole first sample on one side. More: large convex sets are cut; fewer: searches that find
    /// nothing.
    pub one_sided_needed: usize,
    /// A plane that cuts nothing is taken at once if each side keeps at least 1/`uneven` of the
    /// pieces. Larger: unbalanced trees; smaller: a longer search for little gain.
    pub uneven: usize,
    /// Pieces in the first sample that own planes are compared with, and of which the largest tells
    /// whether all lie on one plane. More: time; fewer: good planes are dropped by chance, and the
    /// pieces tried for all may be too small to tell.
    pub first_sample: usize,
    /// Each round keeps 1/`rate` of the own planes and compares them with `rate` times as many
    /// pieces. Larger: the best are dropped by chance; smaller: time.
    pub rate: usize,
    /// Subtracted from the cost of a polygon's plane, per piece of the set, scaled by the share of the
    /// bounding box that the polygon fills and by 1 + the mean number of cuts per piece. (A wall that
    /// is not taken early is cut again by every plane through it.) Larger: depth wasted on polygons
    /// that nothing would cut; smaller: large polygons are cut.
    pub reward: f64,
    /// The most groups of four pieces per box of the peeling search. More: groups are tested one by
    /// one; fewer: more boxes to build, which tell nothing in small sets (of fewer than `small`
    /// pieces): their groups are not near one another.
    pub groups_per_box: usize,
    /// How small sets are divided quickly; `None` in trees that stay. With it, orders take a fifth longer.
    pub quick: Option<FrameTuning>,
}

impl Tuning {
    /// What trees are built with that stay.
    pub const DEFAULT: Self = Self {
        clean_below: 64,
        small: 256,
        own_planes: 96,
        few_own_planes: 16,
        one_sided_needed: 12,
        uneven: 4,
        first_sample: 16,
        rate: 4,
        reward: 0.35,
        groups_per_box: 64,
        quick: None,
    };

    /// What frames are built with, of which each is ordered once or twice.
    pub const FRAMES: Self = Self { quick: Some(FrameTuning::FRAMES), ..Self::DEFAULT };
}

/// What decides how small sets are divided quickly, in numbers.
#[derive(Clone, Copy, Debug)]
pub struct FrameTuning {
    /// Sets of at most so many pieces, 32 at most, are divided down to the leaves from a table of
    /// where each piece lies against each plane. Larger: the table takes longer than it saves;
    /// smaller: planes are chosen anew for every set. Own planes come first in it, which makes trees
    /// quickly; trees by free planes are laid out in fewer parts, which makes orders quick.
    pub table: usize,
    /// The plane of a piece in a table is taken at once if it cuts at most so many pieces, at least one,
    /// and each of them crosses the piece: any tree has to cut them, or it. More: polygons that
    /// cross at random are cut by worse planes; fewer: all planes of rings are compared again and again.
    pub crossings: usize,
    /// Own planes of a small set that are tried first, and taken at once if they cut nothing and
    /// divide the set evenly. More: time where each plane cuts something; fewer: stacks of layers are
    /// searched for the best plane, though any will do.
    pub probes: usize,
    /// The share of its set's box that a piece has to fill for its plane to be trusted at once, where
    /// the tolerance is coarse. Corners in `f32` are rounded, so small polygons that were meant to lie
    /// in one plane have planes of their own, which separate others that belong together. Less: of 400
    /// pages with forty small cards in one plane, 3 lose their order at 1/16, and 10 at 1/50; more:
    /// each set of layers in `f32` is searched for its best plane.
    pub trusted_share: f64,
    /// A tolerance is coarse if it is a larger share of the extent: above that of numbers in `f64`,
    /// and below that of `f32`. Less: planes of layers in `f64` are searched for, which takes stacks
    /// 1.4 times as long; more: small cards in `f32` lose their order.
    pub coarse: f64,
}

impl FrameTuning {
    /// That of frames.
    pub const FRAMES: Self =
        Self { table: 32, crossings: 2, probes: 4, trusted_share: 0.25, coarse: 1e-8 };
}

#[cfg(test)]
mod tests {
    use super::{Cost, CostModel, Counts, work};

    #[test]
    fn work_is_a_power() {
        for n in [0, 1, 2, 3, 100, 1023, 1024, 5000, 1 << 28] {
            let expected = (n as f64).powf(1.25);
            assert!((work(n) - expected).abs() <= expected * 1e-14, "{n}: {}", work(n));
        }
    }

    /// A quarter of 42 pieces, rounded down, is 10.
    #[test]
    fn a_plane_divides_evenly_from_a_share_of_the_pieces_on() {
        let divides_evenly = |front, splits| {
            let counts = Counts { front, back: 42 - front - splits, splits };
            Cost::of(&counts).divides_evenly(42, 4)
        };
        assert!([10, 21, 32].into_iter().all(|front| divides_evenly(front, 0)));
        assert!(!divides_evenly(9, 0) && !divides_evenly(33, 0) && !divides_evenly(20, 1));
    }

    #[test]
    fn terms_of_large_sets_leave_out_whether_a_plane_cuts() {
        let [small, large] =
            [true, false].map(|prefers_uncut| CostModel { reward: 10.0, prefers_uncut });
        let even = Counts { front: 45, back: 45, splits: 10 };
        let rim = Counts { front: 99, back: 0, splits: 0 };
        let is_even_better =
            |terms: &CostModel| terms.cost(&even, 0.5).is_less(&terms.cost(&rim, 0.5));
        assert!(!is_even_better(&small) && is_even_better(&large));
        let counts_cuts = |terms: &CostModel| terms.compared(Cost::of(&even)).cuts;
        assert!(counts_cuts(&small) && !counts_cuts(&large));
    }

    /// Half of a set, and half of each count: all costs are less by the same factor.
    #[test]
    fn costs_of_samples_compare_as_those_of_all() {
        let terms = CostModel { reward: 300.0, prefers_uncut: false };
        let half = terms.of_sample(200, 400);
        for (front, back, splits, share) in
            [(300, 80, 20, 0.9), (200, 200, 0, 0.1), (0, 0, 400, 1.0)]
        {
            let all = terms.cost(&Counts { front, back, splits }, share);
            let [front, back, splits] = [front, back, splits].map(|count| count / 2);
            let sample = half.cost(&Counts { front, back, splits }, share);
            let expected = all.amount * work(200) / work(400);
            assert!((sample.amount - expected).abs() < 1e-9, "{sample:?}, not {expected}");
        }
    }
}
