//! The best free plane of a set of pieces: perpendicular to an axis, through a corner.

#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use super::cost::{price, work};
use super::live::Live;
use super::progress::Watch;
use crate::geom::{Faces, PlaneId};

/// Values a bin is to hold in the mean. Larger: more to sort in the bins that are looked at;
/// smaller: more bins to bound.
const PER_BIN: usize = 2;
/// A plane that cuts nothing and leaves at least one in so many pieces on either side is good
/// enough. Smaller: other axes are searched for what is hardly better; larger: unbalanced trees.
const UNEVEN: usize = 4;
/// The most bins. Larger: their counters leave the cache.
const MOST_BINS: usize = 1024;
/// Bins that are to be looked into are divided first, if they hold more values than that. Larger:
/// more to sort; smaller: looks at all pieces once more.
const CROWD: usize = 4096;
/// Values such a finer bin is to hold in the mean, if they need not be too many.
const PER_FINE_BIN: usize = 16;
/// The most of them, roughly. Larger: as for `MOST_BINS`; and all numbers of bins must fit 16 bits.
const MOST_FINE_BINS: usize = 1 << 14;
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
/// Where pieces begin and end is counted by bins, not sorted. The counts at a bin's borders bound
/// the cost of every plane inside it, so that only the bins that may hold the best plane are
/// looked into; where these hold much, they are divided once more. O(n) where coordinates spread,
/// O(n log n) at worst.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    /// For each piece, the bins in which it begins and ends, and those of its two candidates.
    bins: Vec<[u16; 4]>,
    /// Where the pieces of a small set begin and end, and which they are.
    spans: Vec<(f64, f64, u32)>,
    /// For each bin, how many of the four kinds there are, and how many candidates; behind the
    /// last bin, and once summed, how many there are before each.
    counts: Vec<[u32; 4]>,
    candidates: Vec<u32>,
    bounds: Vec<f64>,
    chosen: Vec<bool>,
    /// The values of the four kinds, and the candidates, in the bins looked into.
    values: [Vec<f64>; 4],
    coordinates: Vec<f64>,
}

const BEGUN: usize = 0;
const ENDED: usize = 1;
/// What is added for flat pieces.
const FLAT: usize = 2;

/// Where a piece begins and ends along an axis: it is begun beyond its beginning, and ended at its
/// end.
struct Span {
    begin: f64,
    end: f64,
    /// Zero, or [`FLAT`].
    kind: usize,
}

impl Span {
    #[inline]
    fn of(piece: &Live, axis: usize, tolerance: f64) -> Self {
        let (min, max) = (piece.min[axis], piece.max[axis]);
        let kind = if max - min <= 2.0 * tolerance { FLAT } else { 0 };
        Self { begin: min + tolerance, end: max - tolerance, kind }
    }
}

/// Lists so many times as large as needed are given back. More: memory that other threads could
/// use; fewer: allocations.
const MUCH: usize = 8;

impl Sweep {
    /// The free plane of least cost, if one has fewer pieces on each side than there are.
    pub(super) fn best(
        &mut self,
        pieces: &[Live],
        tolerance: f64,
        watch: &Watch<'_>,
    ) -> Option<FreePlane> {
        let mut best: Option<FreePlane> = None;
        let n = pieces.len();
        for (axis, [low, high]) in axes(pieces) {
            if best.is_some_and(|best| best.is_enough(n)) || watch.work(n * PASSES).is_err() {
                break;
            }
            let mut bins = Bins::new(low, high, n);
            loop {
                if bins.fine.is_empty() {
                    self.fill(pieces, axis, tolerance, (bins.count, |value| bins.coarse(value).1));
                } else {
                    self.fill(pieces, axis, tolerance, (bins.count, |value| bins.of_value(value)));
                }
                let limit = best.map_or(f64::INFINITY, |best| best.cost);
                if !self.bound(n, limit) {
                    break;
                }
                let Some(finer) = self.finer(&bins) else {
                    self.gather(pieces, axis, tolerance);
                    self.walk(n, axis, &mut best);
                    break;
                };
                bins = finer;
            }
        }
        best
    }

    /// The free plane of least cost among those that cut nothing, for sets so small that they are
    /// sorted in less time than to count takes.
    pub(super) fn clean(&mut self, pieces: &[Live], tolerance: f64) -> Option<FreePlane> {
        let mut best: Option<FreePlane> = None;
        let n = pieces.len();
        for (axis, _) in axes(pieces) {
            if best.is_some_and(|best| best.is_enough(n)) {
                break;
            }
            let spans = pieces.iter().zip(0..).map(|(p, i)| (p.min[axis], p.max[axis], i));
            self.spans.clear();
            self.spans.extend(spans);
            self.spans.sort_unstable_by(|a, b| compare(&a.0, &b.0).then(compare(&a.1, &b.1)));
            // Of the pieces so far, the one that reaches furthest, and how far.
            let mut furthest = (f64::NEG_INFINITY, 0);
            for (behind, &(min, max, i)) in self.spans.iter().enumerate() {
                if behind > 0 && min + tolerance >= furthest.0 {
                    let cost = work(n - behind) + work(behind);
                    let coordinate = if pieces[i as usize].min_is_corner(axis) {
                        Some(min)
                    } else {
                        pieces[furthest.1 as usize].max_is_corner(axis).then_some(furthest.0)
                    };
                    if let Some(coordinate) = coordinate
                        && best.is_none_or(|best| cost < best.cost)
                    {
                        best = Some(FreePlane { cost, splits: 0, axis, coordinate });
                    }
                }
                if max > furthest.0 {
                    furthest = (max, i);
                }
            }
        }
        best
    }

    fn fill(
        &mut self,
        pieces: &[Live],
        axis: usize,
        tolerance: f64,
        (bins, bin_of): (usize, impl Fn(f64) -> usize),
    ) {
        if self.bins.capacity() / MUCH > pieces.len() {
            *self = Self::default();
        }
        self.counts.clear();
        self.counts.resize(bins + 1, [0; 4]);
        self.candidates.clear();
        // The last is for what is no candidate.
        self.candidates.resize(bins + 1, 0);
        self.bins.clear();
        let (counts, candidates) = (&mut self.counts, &mut self.candidates);
        self.bins.extend(pieces.iter().map(|piece| {
            let span = Span::of(piece, axis, tolerance);
            let (begin, end) = (bin_of(span.begin), bin_of(span.end));
            counts[begin][span.kind + BEGUN] += 1;
            counts[end][span.kind + ENDED] += 1;
            let mut candidate = |is_corner: bool, value| {
                let bin = if is_corner { bin_of(value) } else { bins };
                candidates[bin] += 1;
                bin
            };
            let low = candidate(piece.min_is_corner(axis), piece.min[axis]);
            let high = candidate(piece.max_is_corner(axis), piece.max[axis]);
            [begin, end, low, high].map(|bin| bin as u16)
        }));
        candidates.pop();
        let mut total = [0; 4];
        for count in counts {
            let here = *count;
            *count = total;
            total = std::array::from_fn(|kind| total[kind] + here[kind]);
        }
    }

    /// Chooses the bins that may hold a plane of less cost than the limit, and than is certain of
    /// another bin; tells whether there are any.
    fn bound(&mut self, pieces: usize, mut limit: f64) -> bool {
        let cost = |begun: &[u32; 4], ended: &[u32; 4]| {
            let behind = (begun[BEGUN] + begun[FLAT + BEGUN]) as usize;
            let in_front = pieces - (ended[ENDED] + ended[FLAT + ENDED]) as usize;
            let splits = begun[BEGUN].saturating_sub(ended[ENDED]) as usize;
            let divides = behind < pieces && in_front < pieces;
            (work(in_front) + work(behind) + price(splits), divides)
        };
        self.bounds.clear();
        for (bin, &candidates) in self.candidates.iter().enumerate() {
            let (before, after) = (&self.counts[bin], &self.counts[bin + 1]);
            if candidates == 0 {
                self.bounds.push(f64::INFINITY);
                continue;
            }
            self.bounds.push(cost(before, after).0);
            let (most, divides) = cost(after, before);
            if divides && most < limit {
                limit = most.next_up();
            }
        }
        self.chosen.clear();
        self.chosen.extend(self.bounds.iter().map(|&bound| bound < limit));
        self.chosen.push(false);
        self.chosen.contains(&true)
    }

    /// Finer bins in place of the chosen ones, if those hold much that would have to be sorted.
    fn finer(&self, bins: &Bins) -> Option<Bins> {
        let values = |bin: usize| self.candidates[bin] as usize * usize::from(self.chosen[bin]);
        let total: usize = (0..bins.count).map(values).sum();
        let per_bin = PER_FINE_BIN.max(total / MOST_FINE_BINS);
        let much = bins.fine.is_empty() && total > CROWD;
        much.then(|| bins.divided(|bin| (values(bin) / per_bin).max(1)))
    }

    /// Gathers what is in the chosen bins.
    fn gather(&mut self, pieces: &[Live], axis: usize, tolerance: f64) {
        let chosen = &self.chosen[..];
        self.values.iter_mut().for_each(Vec::clear);
        self.coordinates.clear();
        for (&[begin, end, low, high], piece) in self.bins.iter().zip(pieces) {
            let [begin, end] = [chosen[usize::from(begin)], chosen[usize::from(end)]];
            let [low, high] = [chosen[usize::from(low)], chosen[usize::from(high)]];
            if !(begin | end | low | high) {
                continue;
            }
            let span = Span::of(piece, axis, tolerance);
            if begin {
                self.values[span.kind + BEGUN].push(span.begin);
            }
            if end {
                self.values[span.kind + ENDED].push(span.end);
            }
            if low {
                self.coordinates.push(piece.min[axis]);
            }
            if high {
                self.coordinates.push(piece.max[axis]);
            }
        }
    }

    /// Tries the candidates in the chosen bins, each upwards, with a finger in the list of each kind.
    fn walk(&mut self, pieces: usize, axis: usize, best: &mut Option<FreePlane>) {
        let sort = |values: &mut Vec<f64>| values.sort_unstable_by(compare);
        self.values.iter_mut().for_each(sort);
        sort(&mut self.coordinates);
        let mut lists = self.values.each_ref().map(|values| &values[..]);
        let mut coordinates = &self.coordinates[..];
        let chosen = self.chosen.iter().enumerate().filter(|&(_, &chosen)| chosen);
        for (bin, _) in chosen {
            let (here, rest) = coordinates.split_at(self.candidates[bin] as usize);
            coordinates = rest;
            let mut passed = self.counts[bin].map(|count| count as usize);
            let mut values: [&[f64]; 4] = std::array::from_fn(|kind| {
                let count = self.counts[bin + 1][kind] - self.counts[bin][kind];
                let (here, rest) = lists[kind].split_at(count as usize);
                lists[kind] = rest;
                here
            });
            let mut last = f64::NAN;
            for &coordinate in here {
                if coordinate == last {
                    continue;
                }
                last = coordinate;
                for kind in [BEGUN, FLAT + BEGUN] {
                    passed[kind] += pass(&mut values[kind], |v| v < coordinate);
                }
                for kind in [ENDED, FLAT + ENDED] {
                    passed[kind] += pass(&mut values[kind], |v| v <= coordinate);
                }
                let behind = passed[BEGUN] + passed[FLAT + BEGUN];
                let in_front = pieces - passed[ENDED] - passed[FLAT + ENDED];
                // Where rounding makes a piece end before it begins, it counts as uncut.
                let splits = passed[BEGUN].saturating_sub(passed[ENDED]);
                if in_front < pieces && behind < pieces {
                    let cost = work(in_front) + work(behind) + price(splits);
                    if best.is_none_or(|best| cost < best.cost) {
                        *best = Some(FreePlane { cost, splits, axis, coordinate });
                    }
                }
            }
        }
    }
}

/// The order of numbers, none of them NaN: less work than a total one.
#[inline]
fn compare(a: &f64, b: &f64) -> Ordering {
    if a < b {
        Ordering::Less
    } else if a > b {
        Ordering::Greater
    } else {
        Ordering::Equal
    }
}

/// Drops the values that pass from the front of a list; gives how many.
#[inline]
fn pass(list: &mut &[f64], passes: impl Fn(f64) -> bool) -> usize {
    let count = list.iter().take_while(|&&value| passes(value)).count();
    *list = &list[count..];
    count
}

/// The axes along which a set has an extent, the longest first, with its ends.
fn axes(pieces: &[Live]) -> impl Iterator<Item = (usize, [f64; 2])> {
    let (min, max) = super::live::bounds(pieces);
    let mut axes = [0, 1, 2].map(|axis| (axis, [min[axis], max[axis]]));
    let extent = |&(_, [low, high]): &(usize, [f64; 2])| high - low;
    axes.sort_by(|a, b| extent(b).total_cmp(&extent(a)));
    axes.into_iter().filter(move |ends| extent(ends) > 0.0)
}

impl FreePlane {
    /// Whether it cuts nothing and divides well: then other axes need not be asked.
    fn is_enough(&self, pieces: usize) -> bool {
        self.cost <= work(pieces / UNEVEN) + work(pieces - pieces / UNEVEN)
    }

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

/// Equal bins over the extent of a set along an axis; some of them may be divided again.
#[derive(Debug)]
struct Bins {
    start: f64,
    per_unit: f64,
    /// The number of the last bin, were none divided.
    last: f64,
    count: usize,
    /// For each bin of the undivided, the first that it is divided into, and how many more there are.
    fine: Vec<(u32, f64)>,
}

/// Added to a number from 0 to 2³², it leaves the nearest integer in the last bits of the sum: faster
/// than a conversion, which would saturate.
const TO_INTEGER: f64 = (1_u64 << 52) as f64;

impl Bins {
    fn new(start: f64, end: f64, pieces: usize) -> Self {
        let count = (pieces / PER_BIN).clamp(1, MOST_BINS);
        let last = (count - 1) as f64;
        Self { start, per_unit: last / (end - start), last, count, fine: vec![] }
    }

    /// The same bins, each divided into so many.
    fn divided(&self, parts: impl Fn(usize) -> usize) -> Self {
        let mut count = 0;
        let fine = (0..self.count).map(|bin| {
            let (first, parts) = (count, parts(bin));
            count += parts;
            (first as u32, (parts - 1) as f64)
        });
        let fine = fine.collect();
        Self { fine, count, ..*self }
    }

    /// The bin of a value were none divided, and its place there.
    #[inline]
    fn coarse(&self, value: f64) -> (f64, usize) {
        let place = (value - self.start) * self.per_unit;
        let place = if place > 0.0 { place } else { 0.0 };
        let place = if place < self.last { place } else { self.last };
        (place, (place + TO_INTEGER).to_bits() as u32 as usize)
    }

    /// The bin of a value; a larger value is never in an earlier bin.
    #[inline]
    fn of_value(&self, value: f64) -> usize {
        let (place, number) = self.coarse(value);
        let (first, more) = self.fine[number];
        let within = place - number as f64 + 0.5;
        first as usize + (within * more + TO_INTEGER).to_bits() as u32 as usize
    }
}
