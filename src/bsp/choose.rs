//! Choosing the splitter of a set of pieces.

use super::Heuristic;
use super::axis::{FreePlane, Sweep};
use super::convex::{Taken, take_apart};
use super::gather::{Gathered, reach};
use super::live::{Live, bounds};
use super::peel::Peeler;
use super::progress::Watch;
use crate::geom::{Faces, Kernel, PlaneId, Vertex};

/// Below this many pieces `auto` tries own planes beside the free ones. Larger: few fragments
/// less, and quadratic work; smaller: scans, whose surfaces no free plane follows, are cut more.
const OWN_PLANES_BELOW: usize = 1000;
/// How many own planes `auto` tries at a node. More: fewer fragments, for time in proportion.
const OWN_PLANES: usize = 64;
/// A free plane that cuts more than one in so many pieces is a poor one, and some own planes are
/// tried beside it in sets of any size. Larger: time; smaller: stacks of tilted layers are cut
/// rather than parted.
const POOR: usize = 8;
/// How many times fewer pieces an own plane must cut to be taken instead of a poor free one.
/// Smaller: cells of odd shapes, in which more is cut; larger: as for `POOR`.
const FEWER: usize = 4;
/// How many own planes are tried then.
const FEW_OWN_PLANES: usize = 16;
/// How many own planes the heuristics that would look at all of them try at most, so that no
/// node takes quadratic time. They are spread evenly over the set.
const MOST_CANDIDATES: usize = 256;
/// The price of each cut in the cost of `auto`, in polygons still to be sorted. Larger: trees
/// become unbalanced, and unbalanced ones cut more further down; smaller: cuts for balance.
const SPLIT_PRICE: f64 = 1.0;
/// What a cut by a free plane costs beside that: an own plane also takes its polygon off the set.
/// Larger: triangles in a heap are cut less, scans and rooms more.
const FREE_SPLIT_PRICE: f64 = 4.0;
/// The price of cutting at all: more than any amount of work. A plane that cuts nothing costs no
/// fragment, now or later: whatever tree there is of all pieces, its parts on either side are trees
/// of those. So where there is one, it is taken, however unbalanced.
const FIRST_SPLIT_PRICE: f64 = 1e12;
/// What is taken off the cost of the plane of a polygon that fills the set's bounding box, per
/// polygon in the set; less for one that fills less of it. A floor that is not taken early is cut
/// again by every wall on it. Larger: depth spent on polygons that nothing would have cut.
const LARGE_REWARD: f64 = 2.0;
/// The depth from which on no polygon is rewarded for its size: taking one polygon after another
/// off a large set is quadratic work. Smaller: rooms full of walls are cut; larger: more such work.
const REWARD_ABOVE: usize = 128;
/// So many times the pieces of a set must have been looked at before it is tried to take it apart
/// at once, if all planes tried leave the rest on one side. Larger: convex sets are taken apart one
/// piece at a time; smaller: time for sets that only look convex.
const CREDIT: usize = 4;
/// How many of the largest polygons are tried beside free planes at every node.
const LARGEST: usize = 2;
/// The share of the box below which a polygon is not tried as one of the largest.
const LARGE: f64 = 0.2;
/// How many of the set's pieces, spread evenly, all own planes are held against first. Larger: time;
/// smaller: good planes not recognized.
const LOOKS: usize = 32;
/// How many own planes, those that promise most, are then held against the whole set. As above.
const RANKED: usize = 12;
/// How often a candidate is asked whether it can still win, in pieces.
const CHECK_EVERY: usize = 64;

/// How many pieces lie in front of a plane, behind it, and across.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) front: usize,
    pub(super) back: usize,
    pub(super) splits: usize,
}

impl Counts {
    #[inline]
    fn add(&mut self, (front, back): (bool, bool)) {
        self.splits += usize::from(front & back);
        self.front += usize::from(front & !back);
        self.back += usize::from(back & !front);
    }

    /// The work left on both sides, and the cuts: only grows with each count.
    #[inline]
    pub(super) fn cost(&self) -> f64 {
        work(self.front + self.splits) + work(self.back + self.splits) + price(self.splits)
    }

    /// Whether all pieces are on one side.
    fn is_peel(&self) -> bool {
        self.splits == 0 && self.front.min(self.back) == 0
    }

    fn imbalance(&self) -> f64 {
        self.front.abs_diff(self.back) as f64
    }
}

/// What cuts cost.
#[inline]
pub(super) fn price(splits: usize) -> f64 {
    if splits == 0 { 0.0 } else { FIRST_SPLIT_PRICE + SPLIT_PRICE * splits as f64 }
}

/// The work of sorting `n` pieces.
#[inline]
pub(super) fn work(n: usize) -> f64 {
    let n = n as f64;
    if n > 1.0 { n * n.log2() } else { 0.0 }
}

/// What is to be done with a set.
#[derive(Debug)]
pub(super) enum Choice {
    /// It is divided by this plane.
    Split(PlaneId),
    /// It is taken apart piece by piece.
    TakeApart(Vec<Taken>),
}

/// Chooses the splitters of one tree.
#[derive(Debug)]
pub(super) struct Chooser<'a, K: Kernel> {
    kernel: K,
    faces: &'a Faces,
    heuristic: Heuristic,
    /// Once a build is cancelled, any plane is chosen, quickly.
    watch: &'a Watch<'a>,
    sweep: Sweep,
    /// How many pieces were looked at since a set was last tried to be taken apart.
    credit: usize,
    peeler: Peeler,
    /// The set at hand, if it is small.
    set: Gathered<K>,
    /// Pieces of the set whose planes are to be tried, with what they promise.
    ranked: Vec<(f64, u32)>,
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
            peeler: Peeler::default(),
            set: Gathered::default(),
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
            Heuristic::Sampled { candidates } => {
                self.scored(pieces, arena, candidates as usize, |c, _| {
                    8.0 * c.splits as f64 + c.imbalance()
                })
            }
            Heuristic::FreePlanes => self.free(pieces),
            Heuristic::Auto => return self.auto(pieces, arena, depth),
        })
    }

    /// The best of a sample of own planes by a score, lower being better; the earliest of equals.
    fn scored(
        &self,
        pieces: &[Live],
        arena: &[K::Vertex],
        candidates: usize,
        score: impl Fn(&Counts, bool) -> f64,
    ) -> PlaneId {
        let mut best = (f64::INFINITY, PlaneId::face(pieces[0].face));
        for piece in sample(pieces, candidates) {
            let plane = PlaneId::face(piece.face);
            let (counts, _) = self.count(plane, pieces, arena, f64::INFINITY);
            let is_axial = (0..3).any(|axis| piece.min[axis] == piece.max[axis]);
            let score = score(&counts, is_axial);
            if score < best.0 {
                best = (score, plane);
            }
        }
        best.1
    }

    /// The free plane of least cost; where none separates anything, a piece's own.
    fn free(&mut self, pieces: &[Live]) -> PlaneId {
        let best = self.sweep.best(pieces, self.faces.tolerance(), self.watch);
        let named = best.and_then(|plane| plane.id(self.faces, pieces));
        named.unwrap_or(PlaneId::face(pieces[0].face))
    }

    /// A plane that cuts nothing, if one is found, else the best of free planes and own ones.
    fn auto(&mut self, pieces: &[Live], arena: &[K::Vertex], depth: usize) -> Choice {
        let small = pieces.len() < OWN_PLANES_BELOW;
        if small && let Some(plane) = self.peeler.next(pieces.len()) {
            return Choice::Split(plane);
        }
        let free = self.sweep.best(pieces, self.faces.tolerance(), self.watch);
        let named = free.and_then(|plane| Some((plane, plane.id(self.faces, pieces)?)));
        if let Some((FreePlane { splits: 0, .. }, plane)) = named {
            return Choice::Split(plane);
        }
        let splits = named.map_or(pieces.len(), |(plane, _)| plane.splits);
        let price = FREE_SPLIT_PRICE * splits as f64;
        let none = (f64::INFINITY, PlaneId::face(pieces[0].face));
        let best = named.map_or(none, |(free, plane)| (free.cost + price, plane));
        if small {
            self.set.take(&self.kernel, self.faces, pieces, arena);
            self.peeler.search(pieces, &self.set);
            let peeled = self.peeler.next(pieces.len());
            let plane = peeled.unwrap_or_else(|| self.best_of_small(pieces, depth, best));
            return Choice::Split(plane);
        }
        self.credit = self.credit.saturating_add(pieces.len());
        self.best_of_large(pieces, arena, depth, splits, best)
    }

    /// The best of few own planes, if it is better than the best free plane, which has so many
    /// splits. A large set in convex position is taken apart.
    fn best_of_large(
        &mut self,
        pieces: &[Live],
        arena: &[K::Vertex],
        depth: usize,
        splits: usize,
        mut best: (f64, PlaneId),
    ) -> Choice {
        let cell = Cell::around(pieces);
        let reward = if depth < REWARD_ABOVE { LARGE_REWARD } else { 0.0 };
        for piece in cell.largest(pieces).take(if reward > 0.0 { LARGEST } else { 0 }) {
            self.try_own(piece, (reward * cell.share(piece), usize::MAX), pieces, arena, &mut best);
        }
        if splits * POOR <= pieces.len() {
            return Choice::Split(best.1);
        }
        let mut all_peel = true;
        for piece in sample(pieces, FEW_OWN_PLANES) {
            let reward = (reward * cell.share(piece), splits / FEWER);
            all_peel &= self.try_own(piece, reward, pieces, arena, &mut best);
        }
        if all_peel && self.credit / CREDIT >= pieces.len() {
            self.credit = 0;
            if let Some(list) = take_apart(&self.kernel, self.faces, pieces, arena, self.watch) {
                return Choice::TakeApart(list);
            }
        }
        Choice::Split(best.1)
    }

    /// The best of the planes of the gathered set's pieces, if it is better than what there is.
    fn best_of_small(
        &mut self,
        pieces: &[Live],
        depth: usize,
        mut best: (f64, PlaneId),
    ) -> PlaneId {
        let cell = Cell::around(pieces);
        let reward = if depth < REWARD_ABOVE { LARGE_REWARD } else { 0.0 };
        let n = pieces.len();
        let set = &self.set;
        let count = |candidate: usize, step: usize, limit: f64| {
            let splitter = set.splitter(candidate);
            let mut counts = Counts::default();
            for chunk in (0..n).step_by(CHECK_EVERY * step) {
                let end = n.min(chunk + CHECK_EVERY * step);
                (chunk..end).step_by(step).for_each(|q| counts.add(set.reach(splitter, q)));
                if counts.cost() >= limit {
                    return None;
                }
            }
            Some(counts.cost())
        };
        self.ranked.clear();
        let tries = n.min(OWN_PLANES);
        let reward_of = |candidate: usize| reward * cell.share(&pieces[candidate]);
        let step = n.div_ceil(LOOKS);
        if step == 1 || n <= OWN_PLANES {
            self.ranked.extend((0..tries).map(|i| (0.0, (i * n / tries) as u32)));
        } else {
            let looks = n.div_ceil(step) as f64;
            for i in 0..tries {
                let candidate = i * n / tries;
                let cost = count(candidate, step, f64::INFINITY).unwrap_or(f64::INFINITY);
                self.ranked.push((cost - reward_of(candidate) * looks, candidate as u32));
            }
            self.ranked.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            self.ranked.truncate(RANKED);
        }
        for &(_, candidate) in &self.ranked {
            let reward = reward_of(candidate as usize) * n as f64;
            if let Some(cost) = count(candidate as usize, 1, best.0 + reward)
                && cost - reward < best.0
            {
                best = (cost - reward, PlaneId::face(pieces[candidate as usize].face));
            }
        }
        best.1
    }

    /// Takes the plane of a piece if, with a reward for each piece of the set, it is the best so
    /// far and cuts no more than allowed. Tells whether all pieces, as far as they were looked at,
    /// are on one side of it.
    fn try_own(
        &self,
        piece: &Live,
        (reward, most_splits): (f64, usize),
        pieces: &[Live],
        arena: &[K::Vertex],
        best: &mut (f64, PlaneId),
    ) -> bool {
        let plane = PlaneId::face(piece.face);
        let reward = reward * pieces.len() as f64;
        let (counts, complete) = self.count(plane, pieces, arena, best.0 + reward);
        let cost = counts.cost() - reward;
        if complete && cost < best.0 && counts.splits <= most_splits {
            *best = (cost, plane);
        }
        counts.is_peel()
    }

    /// How a plane divides the pieces, by rounded distances: what is decided here is only which
    /// plane is taken. Breaks off where the cost reaches a limit; tells whether it did not.
    fn count(
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
                counts.add(match live.piece(arena).cut {
                    None => reach::<K>(&splitter, self.faces.corners(live.face).iter().copied()),
                    Some(cut) => reach::<K>(&splitter, cut.iter().map(Vertex::position)),
                });
            }
            if counts.cost() >= limit {
                return (counts, false);
            }
        }
        (counts, true)
    }
}

/// The bounding box of a set.
#[derive(Debug)]
struct Cell {
    size: [f64; 3],
}

impl Cell {
    fn around(pieces: &[Live]) -> Self {
        let (min, max) = bounds(pieces);
        Self { size: std::array::from_fn(|axis| max[axis] - min[axis]) }
    }

    /// How much of the box a piece fills along its two longer sides, 0 to 1.
    fn share(&self, piece: &Live) -> f64 {
        let [x, y, z] = std::array::from_fn(|axis| {
            let size = piece.max[axis] - piece.min[axis];
            if self.size[axis] > 0.0 { size / self.size[axis] } else { 1.0 }
        });
        // The largest product of two of the three.
        (x * y).max(y * z).max(z * x)
    }

    /// The pieces that fill most of the box, if they fill enough of it.
    fn largest<'p>(&self, pieces: &'p [Live]) -> impl Iterator<Item = &'p Live> {
        let mut top: [(f64, Option<&Live>); LARGEST] = [(LARGE, None); LARGEST];
        for piece in pieces {
            let share = self.share(piece);
            if share > top[LARGEST - 1].0 {
                top[LARGEST - 1] = (share, Some(piece));
                top.sort_by(|a, b| b.0.total_cmp(&a.0));
            }
        }
        top.into_iter().filter_map(|(_, piece)| piece)
    }
}

/// At most `count` of the pieces, spread evenly.
fn sample(pieces: &[Live], count: usize) -> impl Iterator<Item = &Live> {
    let count = count.min(pieces.len());
    (0..count).map(move |i| &pieces[i * pieces.len() / count])
}

/// A well-mixed function of a number (SplitMix64's finalizer: Steele, Lea and Flood, “Fast
/// splittable pseudorandom number generators”, 2014).
fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
