//! The best free plane of a set of pieces: perpendicular to an axis, through a corner.

use super::choose::{price, work};
use super::live::Live;
use super::progress::Watch;
use crate::geom::{Faces, PlaneId};

/// Values a bin is to hold in the mean. Larger: more to sort in the bins that are looked at;
/// smaller: more bins to bound.
const PER_BIN: usize = 8;
/// The most bins. Larger: their counters leave the cache.
const MOST_BINS: usize = 1024;
/// To search along an axis is as much work as to look at each piece so often.
const PASSES: usize = 10;

/// A free plane with its cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreePlane {
    pub(super) cost: f64,
    /// How many pieces it cuts.
    pub(super) splits: usize,
    axis: usize,
    coordinate: f64,
}

/// Searches for free planes; its lists are kept to be used again.
///
/// A plane at c leaves a piece in front of it *ended* if the piece does not reach in front of the
/// plane by more than the tolerance, and *begun* if it reaches behind it by more than that. The
/// work in front is that of all pieces not ended, the work behind that of all begun. A piece
/// thinner than twice the tolerance is *flat*, and can be ended without being begun: it lies on
/// the plane; others are begun before they are ended, and cut while they are begun and not ended.
///
/// Where pieces begin and end is put into bins, not sorted. The counts at a bin's borders bound
/// the cost of every plane inside it, so that only the bins that may hold the best plane are
/// looked into: O(n) where coordinates spread, O(n log n) at worst.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    begun: Binned,
    ended: Binned,
    begun_flat: Binned,
    ended_flat: Binned,
    candidates: Binned,
    /// Lower bounds of the cost in each bin.
    bounds: Vec<(f64, usize)>,
}

impl Sweep {
    /// The free plane of least cost, if one has fewer pieces on each side than there are.
    pub(super) fn best(
        &mut self,
        pieces: &[Live],
        tolerance: f64,
        watch: &Watch<'_>,
    ) -> Option<FreePlane> {
        let mut best: Option<FreePlane> = None;
        for axis in 0..3 {
            if watch.work(pieces.len() * PASSES).is_err() {
                break;
            }
            let Some(bins) = Bins::of(pieces, axis) else { continue };
            self.fill(pieces, axis, tolerance, &bins);
            self.bound(pieces.len(), bins.count);
            for i in 0..self.bounds.len() {
                let (bound, bin) = self.bounds[i];
                if best.is_some_and(|best| bound >= best.cost) {
                    break;
                }
                self.scan(pieces.len(), axis, bin, &mut best);
            }
        }
        best
    }

    fn fill(&mut self, pieces: &[Live], axis: usize, tolerance: f64, bins: &Bins) {
        let is_flat = |p: &Live| p.max[axis] - p.min[axis] <= 2.0 * tolerance;
        // Begun is “beyond”, ended is “at or beyond”: the next number above makes it one rule.
        let begin = |p: &Live| (p.min[axis] + tolerance).next_up();
        let end = |p: &Live| p.max[axis] - tolerance;
        let (flat, thick) =
            (|| pieces.iter().filter(|p| is_flat(p)), || pieces.iter().filter(|p| !is_flat(p)));
        self.begun.fill(bins, || thick().map(begin));
        self.ended.fill(bins, || thick().map(end));
        self.begun_flat.fill(bins, || flat().map(begin));
        self.ended_flat.fill(bins, || flat().map(end));
        self.candidates.fill(bins, || {
            pieces.iter().flat_map(|piece| {
                let min = piece.min_is_corner(axis).then_some(piece.min[axis]);
                let max = piece.max_is_corner(axis).then_some(piece.max[axis]);
                min.into_iter().chain(max)
            })
        });
    }

    /// Bounds the cost in every bin that has candidates, least first.
    fn bound(&mut self, pieces: usize, bins: usize) {
        self.bounds.clear();
        for bin in (0..bins).filter(|&bin| !self.candidates.range(bin).is_empty()) {
            let begun = self.begun.before(bin) + self.begun_flat.before(bin);
            let ended = self.ended.before(bin + 1) + self.ended_flat.before(bin + 1);
            let splits = self.begun.before(bin).saturating_sub(self.ended.before(bin + 1));
            let bound = work(pieces - ended) + work(begun) + price(splits);
            self.bounds.push((bound, bin));
        }
        self.bounds.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    /// Walks the candidates of a bin upwards, with a finger in each list.
    fn scan(&mut self, pieces: usize, axis: usize, bin: usize, best: &mut Option<FreePlane>) {
        let mut last = f64::NAN;
        let mut fingers =
            [&mut self.begun, &mut self.ended, &mut self.begun_flat, &mut self.ended_flat]
                .map(|list| Finger { count: list.before(bin), left: list.sorted(bin) });
        for &coordinate in self.candidates.sorted(bin) {
            if coordinate == last {
                continue;
            }
            last = coordinate;
            let [begun, ended, begun_flat, ended_flat] =
                fingers.each_mut().map(|finger| finger.advance(coordinate));
            let (behind, in_front) = (begun + begun_flat, pieces - ended - ended_flat);
            // Where rounding makes a piece end before it begins, it counts as uncut.
            let splits = begun.saturating_sub(ended);
            if in_front < pieces && behind < pieces {
                let cost = work(in_front) + work(behind) + price(splits);
                if best.is_none_or(|best| cost < best.cost) {
                    *best = Some(FreePlane { cost, splits, axis, coordinate });
                }
            }
        }
    }
}

impl FreePlane {
    /// The plane by the name of a corner on it.
    pub(super) fn id(&self, faces: &Faces, pieces: &[Live]) -> Option<PlaneId> {
        let (axis, c) = (self.axis, self.coordinate);
        let touches = |piece: &&Live| {
            piece.min[axis] == c && piece.min_is_corner(axis)
                || piece.max[axis] == c && piece.max_is_corner(axis)
        };
        let corner = pieces.iter().find(touches)?.corner_at(faces, axis, c)?;
        Some(PlaneId::axis(axis, corner))
    }
}

/// Equal bins over the extent of a set along an axis.
#[derive(Debug)]
struct Bins {
    start: f64,
    per_unit: f64,
    count: usize,
}

impl Bins {
    /// `None` if the set has no extent along the axis.
    fn of(pieces: &[Live], axis: usize) -> Option<Self> {
        let start = pieces.iter().fold(f64::INFINITY, |min, p| min.min(p.min[axis]));
        let end = pieces.iter().fold(f64::NEG_INFINITY, |max, p| max.max(p.max[axis]));
        let count = (pieces.len() / PER_BIN).clamp(1, MOST_BINS);
        (end > start).then(|| Self { start, per_unit: count as f64 / (end - start), count })
    }

    /// The bin of a value; a larger value is never in an earlier bin.
    #[inline]
    fn of_value(&self, value: f64) -> usize {
        (((value - self.start) * self.per_unit) as usize).min(self.count - 1)
    }
}

/// Values grouped by bin.
#[derive(Debug, Default)]
struct Binned {
    values: Vec<f64>,
    /// Where each bin ends; before that, while it is filled, where its next value goes.
    ends: Vec<u32>,
}

impl Binned {
    fn fill<I: Iterator<Item = f64>>(&mut self, bins: &Bins, values: impl Fn() -> I) {
        self.ends.clear();
        self.ends.resize(bins.count + 1, 0);
        values().for_each(|value| self.ends[bins.of_value(value) + 1] += 1);
        let mut total = 0;
        for end in &mut self.ends {
            total += *end;
            *end = total;
        }
        // Now `ends[bin]` is where the bin starts; filling it moves that to its end.
        self.values.clear();
        self.values.resize(total as usize, 0.0);
        for value in values() {
            let next = &mut self.ends[bins.of_value(value)];
            self.values[*next as usize] = value;
            *next += 1;
        }
    }

    /// How many values are in earlier bins.
    fn before(&self, bin: usize) -> usize {
        if bin == 0 { 0 } else { self.ends[bin - 1] as usize }
    }

    fn range(&self, bin: usize) -> std::ops::Range<usize> {
        self.before(bin)..self.ends[bin] as usize
    }

    /// The values of a bin, in order.
    fn sorted(&mut self, bin: usize) -> &[f64] {
        let range = self.range(bin);
        self.values[range.clone()].sort_unstable_by(f64::total_cmp);
        &self.values[range]
    }
}

/// How many values of a list a plane has passed.
struct Finger<'a> {
    count: usize,
    left: &'a [f64],
}

impl Finger<'_> {
    #[inline]
    fn advance(&mut self, coordinate: f64) -> usize {
        while let [first, rest @ ..] = self.left
            && *first <= coordinate
        {
            self.count += 1;
            self.left = rest;
        }
        self.count
    }
}
