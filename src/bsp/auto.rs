//! The choice of `auto`: planes that cut nothing, else the best of free planes and own ones.

use super::axis::FreePlane;
use super::cell::{Cell, LARGEST};
use super::choose::{CHECK_EVERY, Choice, Chooser, sample};
use super::convex::take_apart;
use super::cost::{Counts, is_loss, work};
use super::gather::reach;
use super::live::Live;
use crate::geom::{Kernel, PlaneId, Vertex};

/// Scenes of at most so many faces are taken for layers that are put in order anew for every frame:
/// their trees are to be had in the time that a few cuts more take. Larger: more cuts in scenes that
/// are built once; smaller: layers that are late.
const HASTY: usize = 200;
/// How many own planes are tried at a node in such a scene. As above.
const HASTY_TRIES: usize = 8;
/// After so many searches for a free plane that cuts nothing and divides well, and found none, such a
/// scene is not searched again. Larger: time; smaller: one knot costs a field of houses its free planes.
const HASTY_MISSES: usize = 4;
/// Below this many pieces `auto` tries own planes beside the free ones. Larger: few fragments
/// less, and quadratic work; smaller: scans, whose surfaces no free plane follows, are cut more.
const OWN_PLANES_BELOW: usize = 400;
/// How many own planes `auto` tries at a node. More: fewer fragments, for time in proportion.
const OWN_PLANES: usize = 96;
/// A free plane that cuts more than one in so many pieces is a poor one, and some own planes are
/// tried beside it in sets of any size. Larger: time; smaller: stacks of tilted layers are cut
/// rather than parted.
const POOR: usize = 8;
/// How many times fewer pieces an own plane must cut to be taken instead of a poor free one.
/// Smaller: cells of odd shapes, in which more is cut; larger: as for `POOR`.
const FEWER: usize = 4;
/// How many own planes are tried then.
const FEW_OWN_PLANES: usize = 16;
/// What a cut by a free plane costs beside that: an own plane also takes its polygon off the set.
/// Larger: triangles in a heap are cut less, scans and rooms more.
const FREE_SPLIT_PRICE: f64 = 4.0;
/// What is taken off the cost of the plane of a polygon that fills the set's bounding box, per
/// polygon in the set; less for one that fills less of it. A floor that is not taken early is cut
/// again by every wall on it. Larger: depth spent on polygons that nothing would have cut.
const LARGE_REWARD: f64 = 0.7;
/// The same in a heap, where what is not taken is cut again by nearly every plane.
const HEAP_REWARD: f64 = 4.0;
/// A heap is a set whose pieces were cut more often than that in the mean. Larger: heaps are cut
/// more; smaller: other sets are.
const HEAP: usize = 4;
/// The depth from which on no polygon is rewarded for its size: taking one polygon after another
/// off a large set is quadratic work. Smaller: rooms full of walls are cut; larger: more such work.
const REWARD_ABOVE: usize = 128;
/// So many times the pieces of a set must have been looked at before it is tried to take it apart
/// at once, if most own planes of a sample leave the rest on one side. Larger: convex sets are taken
/// apart one piece at a time; smaller: time for sets that only look convex.
const CREDIT: usize = 4;
/// How many of the sample must do so. Larger: a few pieces within a convex set keep it whole;
/// smaller: time for sets that only look convex.
const RIM: usize = FEW_OWN_PLANES * 3 / 4;
/// A free plane that cuts more than one in so many pieces is reason to try that. Smaller: convex
/// sets off the axes are cut; larger: long lists in place of balanced trees.
const NOTABLE: usize = 64;
/// In sets of at most so many pieces, own planes that cut nothing are preferred to free ones: they
/// take a piece off the set, so that there are fewer nodes. Larger: time.
const TINY: usize = 16;
/// How many own planes are tried for a clean division in about equal parts, before pieces are taken
/// off one by one. Larger: time; smaller: lists where there could be trees.
const HALVES: usize = 4;
/// How many of the set's pieces, spread evenly, all own planes are held against first. Larger: time;
/// smaller: good planes not recognized.
const LOOKS: usize = 32;
/// How many own planes, those that promise most, are then held against the whole set. As above.
const RANKED: usize = 12;

/// What is taken off the cost of a large polygon's plane, per polygon in a set at some depth.
fn large_reward(pieces: &[Live], depth: usize) -> f64 {
    let cuts: usize = pieces.iter().map(|piece| usize::from(piece.cuts)).sum();
    match depth {
        REWARD_ABOVE.. => 0.0,
        _ if cuts > HEAP * pieces.len() => HEAP_REWARD,
        _ => LARGE_REWARD,
    }
}

impl<K: Kernel> Chooser<'_, K> {
    /// A plane that cuts nothing, if one is found, else the best of free planes and own ones.
    pub(super) fn auto(&mut self, pieces: &[Live], arena: &[K::Vertex], depth: usize) -> Choice {
        if self.faces.len() <= HASTY {
            let plane = self.clean_free(pieces);
            return Choice::Split(
                plane.unwrap_or_else(|| self.sampled(pieces, arena, HASTY_TRIES)),
            );
        }
        let small = pieces.len() < OWN_PLANES_BELOW;
        let is_peeled = self.peeler.has_searched(pieces.len());
        let tiny = pieces.len() <= TINY;
        if tiny {
            self.set.take(&self.kernel, self.faces, pieces, arena);
            if let Some(plane) = self.clean_middle(pieces) {
                return Choice::Split(plane);
            }
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
            if !tiny {
                self.set.take(&self.kernel, self.faces, pieces, arena);
                if let Some(plane) = self.clean_halves(pieces) {
                    return Choice::Split(plane);
                }
            }
            if !is_peeled {
                let (by, set) = ((&self.kernel, self.faces), (pieces, arena));
                if self.peeler.search(by, set, &self.set, &mut self.taken) {
                    return Choice::TakeApart;
                }
            }
            return Choice::Split(self.best_of_small(pieces, depth, best));
        }
        self.credit = self.credit.saturating_add(pieces.len());
        self.best_of_large(pieces, arena, depth, splits, best)
    }

    /// The best free plane, if it cuts nothing, and unless too many searches were in vain: found none,
    /// or one that hardly divides. (In sets of which all own planes are tried they cost little, and do
    /// not count.)
    fn clean_free(&mut self, pieces: &[Live]) -> Option<PlaneId> {
        if self.misses == HASTY_MISSES {
            return None;
        }
        let n = pieces.len();
        let clean = self.sweep.clean(pieces, self.faces.tolerance());
        let divides = clean.is_some_and(|free| free.cost <= work(n / 8) + work(n - n / 8));
        self.misses += usize::from(!divides && n > HASTY_TRIES);
        clean.and_then(|free| free.id(self.faces, pieces))
    }

    /// The best of few own planes, if it is better than the best free plane, which has so many
    /// splits. A large set in convex position is taken apart. If every plane cuts so many that it
    /// leaves more work than there was, the least of it would be left by planes at the rim: there
    /// balance counts more.
    fn best_of_large(
        &mut self,
        pieces: &[Live],
        arena: &[K::Vertex],
        depth: usize,
        splits: usize,
        mut best: (f64, PlaneId),
    ) -> Choice {
        let cell = Cell::around(pieces);
        let reward = large_reward(pieces, depth);
        for piece in cell.largest(pieces).take(if reward > 0.0 { LARGEST } else { 0 }) {
            self.try_own(piece, (reward * cell.share(piece), usize::MAX), pieces, arena, &mut best);
        }
        if splits * NOTABLE > pieces.len()
            && self.credit / CREDIT >= pieces.len()
            && self.looks_convex(pieces, arena)
        {
            self.credit = 0;
            let (by, taken) = ((&self.kernel, self.faces), &mut self.taken);
            if take_apart(by, (pieces, arena), self.watch, taken) {
                return Choice::TakeApart;
            }
        }
        if is_loss(best.0, pieces.len()) {
            return Choice::Split(self.sampled(pieces, arena, FEW_OWN_PLANES));
        }
        let tries = if splits * POOR > pieces.len() { FEW_OWN_PLANES } else { 0 };
        for piece in sample(pieces, tries) {
            let reward = (reward * cell.share(piece), splits / FEWER);
            self.try_own(piece, reward, pieces, arena, &mut best);
        }
        Choice::Split(best.1)
    }

    /// Whether most pieces of a sample have all others on one side: a few that lie within, as discs
    /// in a pipe, are no reason to take the rest off one at a time.
    fn looks_convex(&self, pieces: &[Live], arena: &[K::Vertex]) -> bool {
        let at_rim = |piece: &&Live| self.is_at_rim(piece, pieces, arena);
        sample(pieces, FEW_OWN_PLANES).filter(at_rim).count() >= RIM
    }

    /// Whether all other pieces are on one side of a piece's plane, or on it.
    fn is_at_rim(&self, piece: &Live, pieces: &[Live], arena: &[K::Vertex]) -> bool {
        let splitter = self.kernel.splitter(self.faces, PlaneId::face(piece.face));
        let mut seen = (false, false);
        pieces.iter().all(|live| {
            let (front, back) = self.reach(&splitter, live, arena);
            seen = (seen.0 | front, seen.1 | back);
            seen != (true, true)
        })
    }

    pub(super) fn reach(
        &self,
        splitter: &K::Splitter,
        live: &Live,
        arena: &[K::Vertex],
    ) -> (bool, bool) {
        match live.piece(arena).cut {
            None => reach::<K>(splitter, self.faces.corners(live.face).iter().copied()),
            Some(cut) => reach::<K>(splitter, cut.iter().map(Vertex::position)),
        }
    }

    /// The own plane that cuts nothing and leaves most on either side, if it leaves enough there.
    fn clean_middle(&self, pieces: &[Live]) -> Option<PlaneId> {
        let n = pieces.len();
        let mut best = ((n - 1) / 3, None);
        for (candidate, piece) in pieces.iter().enumerate() {
            let splitter = self.set.splitter(candidate);
            let mut counts = Counts::default();
            let clean = (0..n).all(|q| {
                counts = counts.with(self.set.reach(splitter, q));
                counts.splits == 0
            });
            let balance = counts.front.min(counts.back);
            if clean && (balance > best.0 || best.1.is_none() && balance == best.0) {
                best = (balance, Some(PlaneId::face(piece.face)));
                if 2 * balance + 2 >= n {
                    break;
                }
            }
        }
        best.1
    }

    /// An own plane that cuts nothing and leaves enough on either side, if one of few is.
    fn clean_halves(&self, pieces: &[Live]) -> Option<PlaneId> {
        let n = pieces.len();
        let divides = |&candidate: &usize| {
            let splitter = self.set.splitter(candidate);
            let mut counts = Counts::default();
            (0..n).all(|q| {
                counts = counts.with(self.set.reach(splitter, q));
                counts.splits == 0
            }) && counts.front.min(counts.back) > n / 4
        };
        let mut tries = (1..=HALVES).map(|i| i * n / (HALVES + 1));
        tries.find(divides).map(|candidate| PlaneId::face(pieces[candidate].face))
    }

    /// The best of the planes of the gathered set's pieces, if it is better than what there is.
    fn best_of_small(
        &mut self,
        pieces: &[Live],
        depth: usize,
        mut best: (f64, PlaneId),
    ) -> PlaneId {
        let cell = Cell::around(pieces);
        let reward = large_reward(pieces, depth);
        let n = pieces.len();
        let set = &self.set;
        let count = |candidate: usize, limit: f64| {
            let splitter = set.splitter(candidate);
            let mut counts = Counts::default();
            for chunk in (0..n).step_by(CHECK_EVERY) {
                let pieces = chunk..n.min(chunk + CHECK_EVERY);
                counts = set.reaches(splitter, pieces).fold(counts, Counts::with);
                if counts.cost() >= limit {
                    return None;
                }
            }
            Some(counts.cost())
        };
        let count_some = |candidate: usize, step: usize| {
            let splitter = set.splitter(candidate);
            let reaches = (0..n).step_by(step).map(|piece| set.reach(splitter, piece));
            reaches.fold(Counts::default(), Counts::with).cost()
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
                let cost = count_some(candidate, step);
                self.ranked.push((cost - reward_of(candidate) * looks, candidate as u32));
            }
            self.ranked.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            self.ranked.truncate(RANKED);
        }
        for &(_, candidate) in &self.ranked {
            let reward = reward_of(candidate as usize) * n as f64;
            if let Some(cost) = count(candidate as usize, best.0 + reward)
                && cost - reward < best.0
            {
                best = (cost - reward, PlaneId::face(pieces[candidate as usize].face));
            }
        }
        best.1
    }

    /// Takes the plane of a piece if, with a reward for each piece of the set, it is the best so
    /// far and cuts no more than allowed.
    fn try_own(
        &self,
        piece: &Live,
        (reward, most_splits): (f64, usize),
        pieces: &[Live],
        arena: &[K::Vertex],
        best: &mut (f64, PlaneId),
    ) {
        let plane = PlaneId::face(piece.face);
        let reward = reward * pieces.len() as f64;
        let (counts, complete) = self.count(plane, pieces, arena, best.0 + reward);
        let cost = counts.cost() - reward;
        if complete && cost < best.0 && counts.splits <= most_splits {
            *best = (cost, plane);
        }
    }
}
