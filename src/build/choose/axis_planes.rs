//! The best plane of a set of pieces that is perpendicular to an axis and goes through a corner, by bins
//! and by sorting.

use std::cmp::Ordering;

use super::cost::{Candidate, Cost, Counts, Tuning};
use super::set::Set;
use crate::build::piece::Piece;
use crate::exact::{Faces, PlaneId};
use crate::progress::{SWEEP, Watch};

/// Searches for free planes; its lists are kept to be used again.
#[derive(Debug, Default)]
pub(super) struct FreePlanes {
    binned: Binned,
    /// Where the pieces of a small set begin and end, and which they are.
    spans: Vec<(f64, f64, u32)>,
}

impl FreePlanes {
    /// The free plane of least cost, if one has fewer pieces on each side than there are. (Where the
    /// tolerance is not 0, pieces that begin or end within it of a bin's border may be counted on
    /// the wrong side.)
    pub(super) fn best(
        &mut self,
        set: &Set<'_>,
        tuning: &Tuning,
        watch: &Watch<'_>,
    ) -> Option<Candidate> {
        let mut best: Option<FreePlane> = None;
        let n = set.len();
        for (axis, ends) in axes(set) {
            if best.is_some_and(|best| best.cost.divides_evenly(n, tuning.uneven))
                || watch.work(n * SWEEP).is_err()
            {
                break;
            }
            self.binned.best_along(axis, ends, set, tuning, &mut best);
        }
        best.and_then(|best| best.with_corner(set))
    }

    /// The free plane of least cost among those that cut nothing. It sorts the set, which for a small one
    /// takes less time than counting by bins.
    pub(super) fn clean(&mut self, set: &Set<'_>, tuning: &Tuning) -> Option<Candidate> {
        let mut best: Option<FreePlane> = None;
        let (n, pieces, tolerance) = (set.len(), set.pieces, set.faces.tolerance());
        for (axis, _) in axes(set).filter(|&(axis, _)| set.may_part(axis) && set.may_have_gap(axis))
        {
            if best.is_some_and(|best| best.cost.divides_evenly(n, tuning.uneven)) {
                break;
            }
            let spans = pieces.iter().zip(0..).map(|(p, i)| (p.min[axis], p.max[axis], i));
            self.spans.clear();
            self.spans.reserve(n);
            self.spans.extend(spans);
            self.spans.sort_unstable_by(|a, b| compare(&a.0, &b.0).then(compare(&a.1, &b.1)));
            // Of the pieces so far, the one that reaches furthest, and how far.
            let mut furthest = (f64::NEG_INFINITY, 0);
            for (behind, &(min, max, i)) in self.spans.iter().enumerate() {
                if behind > 0 && min + tolerance >= furthest.0 {
                    let (front, back) = ((n - behind) as u32, behind as u32);
                    let cost = Cost::of(&Counts { front, back, splits: 0 });
                    let ends = [furthest.1, i].map(|piece| &pieces[piece as usize]);
                    if best.is_none_or(|best| cost.is_less(&best.cost))
                        && let Some(through) = between(set.faces, axis, ends)
                    {
                        best = Some(FreePlane { cost, axis, through });
                    }
                }
                if max > furthest.0 {
                    furthest = (max, i);
                }
            }
        }
        best.and_then(|best| best.with_corner(set))
    }
}

/// A plane between two pieces, the first of which ends before the other begins: at the end of one of
/// them, or else through a corner of their faces that was cut off.
fn between(faces: &Faces, axis: usize, [first, next]: [&Piece; 2]) -> Option<Through> {
    let [low, high] = [first.max[axis], next.min[axis]];
    if next.min_is_corner(axis) {
        return Some(Through::Coordinate(high));
    }
    if first.max_is_corner(axis) {
        return Some(Through::Coordinate(low));
    }
    let corner = |piece: &Piece| piece.corner_within(faces, axis, [low, high]);
    corner(next).or_else(|| corner(first)).map(Through::Corner)
}

/// The axes along which a set has an extent, with its ends: those first along which it may part,
/// and the longest of them.
fn axes(set: &Set<'_>) -> impl Iterator<Item = (usize, [f64; 2])> + use<> {
    let mut axes = [0, 1, 2].map(|axis| (axis, [set.min[axis], set.max[axis]]));
    let extent = |&(_, [low, high]): &(usize, [f64; 2])| high - low;
    axes.sort_by(|a, b| {
        set.may_part(b.0).cmp(&set.may_part(a.0)).then(extent(b).total_cmp(&extent(a)))
    });
    axes.into_iter().filter(move |ends| extent(ends) > 0.0)
}

/// Compares the free planes along an axis; its lists are kept to be used again.
///
/// A plane at c leaves a piece in front of it *ended* if the piece does not reach in front of the
/// plane by more than the tolerance, and *begun* if it reaches behind it by more than that. The
/// work in front is that of all pieces not ended, the work behind that of all begun. A piece
/// thinner than twice the tolerance is *flat*, and can be ended without being begun: it lies on
/// the plane; others are begun before they are ended, and cut while they are begun and not ended.
///
/// Where pieces begin and end is counted by bins, not sorted. The counts at a bin's borders bound
/// the cost of every plane inside it, so that only the bins that may hold the best plane are
/// looked into. O(n) where coordinates spread, O(n log n) at worst.
#[derive(Debug, Default)]
struct Binned {
    /// For each piece, the bins in which it begins and ends.
    bins: Vec<[u16; 2]>,
    /// For each bin, how many pieces begin and end in it; behind the last bin, and once summed, how
    /// many do so before each.
    counts: Vec<Passed>,
    bounds: Vec<Cost>,
    chosen: Vec<bool>,
    /// Where pieces of each kind begin and end in the bins that are looked into.
    begins: [Vec<f64>; 2],
    ends: [Vec<f64>; 2],
    candidates: Vec<(u16, f64)>,
}

/// Where a piece begins and ends along an axis: it is begun beyond its beginning, and ended at its
/// end.
struct Span {
    begin: f64,
    end: f64,
    kind: usize,
}

/// The kinds of pieces.
const THICK: usize = 0;
const FLAT: usize = 1;

impl Span {
    #[inline]
    fn of(piece: &Piece, axis: usize, tolerance: f64) -> Self {
        let (min, max) = (piece.min[axis], piece.max[axis]);
        let kind = if max - min <= 2.0 * tolerance { FLAT } else { THICK };
        Self { begin: min + tolerance, end: max - tolerance, kind }
    }
}

/// How many pieces of each kind are begun and ended at a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Passed {
    begun: [u32; 2],
    ended: [u32; 2],
}

impl Passed {
    /// What the plane costs, if it leaves fewer pieces on each side than there are.
    #[inline]
    fn cost(&self, pieces: usize) -> Option<Cost> {
        let pieces = pieces as u32;
        let [begun, ended] = [self.begun, self.ended].map(|kinds| kinds[THICK] + kinds[FLAT]);
        // Where rounding makes a piece end before it begins, it counts as uncut.
        let splits = self.begun[THICK].saturating_sub(self.ended[THICK]);
        let counts = Counts { front: pieces - ended - splits, back: begun - splits, splits };
        (begun < pieces && ended > 0).then(|| Cost::of(&counts))
    }
}

impl Binned {
    /// Looks for a free plane across an axis that costs less than the best so far; the set reaches from
    /// one of `ends` to the other.
    fn best_along(
        &mut self,
        axis: usize,
        [low, high]: [f64; 2],
        set: &Set<'_>,
        tuning: &Tuning,
        best: &mut Option<FreePlane>,
    ) {
        let (n, pieces, tolerance) = (set.len(), set.pieces, set.faces.tolerance());
        self.fill(pieces, axis, tolerance, &Bins::new(low, high, n, tuning));
        if self.bound(n, best.map_or(Cost::MOST, |best| best.cost)) {
            self.gather(pieces, axis, tolerance);
            self.walk(n, axis, best);
        }
    }

    /// Counts what begins and ends in each bin.
    fn fill(&mut self, pieces: &[Piece], axis: usize, tolerance: f64, bins: &Bins) {
        self.counts.clear();
        self.counts.resize(bins.count + 1, Passed::default());
        self.bins.clear();
        self.bins.reserve(pieces.len());
        let counts = &mut self.counts;
        self.bins.extend(pieces.iter().map(|piece| {
            let span = Span::of(piece, axis, tolerance);
            let [begin, end] = [span.begin, span.end].map(|value| bins.of(value));
            counts[begin].begun[span.kind] += 1;
            counts[end].ended[span.kind] += 1;
            [begin as u16, end as u16]
        }));
        let mut total = Passed::default();
        for count in counts {
            let Passed { begun, ended } = std::mem::replace(count, total);
            for kind in [THICK, FLAT] {
                total.begun[kind] += begun[kind];
                total.ended[kind] += ended[kind];
            }
        }
    }

    /// Chooses the bins that may hold the best plane: those whose least possible cost is below the limit,
    /// and below what some other bin certainly reaches. Tells whether there are any.
    fn bound(&mut self, pieces: usize, mut limit: Cost) -> bool {
        let cost = |begun: &Passed, ended: &Passed| {
            Passed { begun: begun.begun, ended: ended.ended }.cost(pieces)
        };
        self.bounds.clear();
        for ends in self.counts.windows(2) {
            let [before, after] = [&ends[0], &ends[1]];
            if before == after {
                self.bounds.push(Cost::MOST);
                continue;
            }
            self.bounds.push(cost(before, after).unwrap_or(Cost::MOST));
            if let Some(most) = cost(after, before)
                && most.is_less(&limit)
            {
                limit = Cost { amount: most.amount.next_up(), ..most };
            }
        }
        self.chosen.clear();
        self.chosen.extend(self.bounds.iter().map(|bound| bound.is_less(&limit)));
        self.chosen.contains(&true)
    }

    /// Gathers what is in the chosen bins.
    fn gather(&mut self, pieces: &[Piece], axis: usize, tolerance: f64) {
        let chosen = &self.chosen[..];
        self.begins.iter_mut().chain(&mut self.ends).for_each(Vec::clear);
        self.candidates.clear();
        for (&[begin, end], piece) in self.bins.iter().zip(pieces) {
            let is_chosen = |bin: u16| chosen[usize::from(bin)];
            if !is_chosen(begin) && !is_chosen(end) {
                continue;
            }
            let span = Span::of(piece, axis, tolerance);
            if is_chosen(begin) {
                self.begins[span.kind].push(span.begin);
                if piece.min_is_corner(axis) {
                    self.candidates.push((begin, piece.min[axis]));
                }
            }
            if is_chosen(end) {
                self.ends[span.kind].push(span.end);
                if piece.max_is_corner(axis) {
                    self.candidates.push((end, piece.max[axis]));
                }
            }
        }
    }

    /// Tries the candidates in the chosen bins, each upwards, with a finger in the list of each kind.
    fn walk(&mut self, pieces: usize, axis: usize, best: &mut Option<FreePlane>) {
        for values in self.begins.iter_mut().chain(&mut self.ends) {
            values.sort_unstable_by(compare);
        }
        self.candidates.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(compare(&a.1, &b.1)));
        let [mut begins, mut ends] =
            [&self.begins, &self.ends].map(|kinds| kinds.each_ref().map(|values| &values[..]));
        let mut candidates = self.candidates.chunk_by(|a, b| a.0 == b.0).peekable();
        for bin in (0..self.chosen.len()).filter(|&bin| self.chosen[bin]) {
            let (mut passed, after) = (self.counts[bin], self.counts[bin + 1]);
            let mut begins = take(&mut begins, passed.begun, after.begun);
            let mut ends = take(&mut ends, passed.ended, after.ended);
            let here = candidates.next_if(|candidates| usize::from(candidates[0].0) == bin);
            let mut last = f64::NAN;
            for &(_, coordinate) in here.unwrap_or_default() {
                if coordinate == last {
                    continue;
                }
                last = coordinate;
                for kind in [THICK, FLAT] {
                    passed.begun[kind] += pass(&mut begins[kind], |v| v < coordinate);
                    passed.ended[kind] += pass(&mut ends[kind], |v| v <= coordinate);
                }
                if let Some(cost) = passed.cost(pieces)
                    && best.is_none_or(|best| cost.is_less(&best.cost))
                {
                    *best =
                        Some(FreePlane { cost, axis, through: Through::Coordinate(coordinate) });
                }
            }
        }
    }
}

/// Takes the values of one bin from the front of each list, by the counts at the bin's borders.
fn take<'a>(lists: &mut [&'a [f64]; 2], before: [u32; 2], after: [u32; 2]) -> [&'a [f64]; 2] {
    std::array::from_fn(|kind| {
        let (here, rest) = lists[kind].split_at((after[kind] - before[kind]) as usize);
        lists[kind] = rest;
        here
    })
}

/// Drops the values that pass from the front of a list; gives how many.
#[inline]
fn pass(list: &mut &[f64], passes: impl Fn(f64) -> bool) -> u32 {
    let count = list.iter().take_while(|&&value| passes(value)).count();
    *list = &list[count..];
    count as u32
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

/// Equal bins over the extent of a set along an axis.
#[derive(Debug)]
struct Bins {
    start: f64,
    per_unit: f64,
    /// The number of the last bin.
    last: f64,
    count: usize,
}

/// Added to a number from 0 to 2³², it leaves the nearest integer in the last bits of the sum: faster
/// than a conversion, which would saturate.
const TO_INTEGER: f64 = (1_u64 << 52) as f64;

impl Bins {
    fn new(start: f64, end: f64, pieces: usize, tuning: &Tuning) -> Self {
        let count = (pieces / tuning.per_bin).clamp(1, tuning.most_bins);
        let last = (count - 1) as f64;
        Self { start, per_unit: last / (end - start), last, count }
    }

    /// The bin of a value; a larger value is never in an earlier bin.
    #[inline]
    fn of(&self, value: f64) -> usize {
        let place = (value - self.start) * self.per_unit;
        let place = if place > 0.0 { place } else { 0.0 };
        let place = if place < self.last { place } else { self.last };
        (place + TO_INTEGER).to_bits() as u32 as usize
    }
}

/// A free plane, before it has a name.
#[derive(Clone, Copy, Debug)]
struct FreePlane {
    cost: Cost,
    axis: usize,
    through: Through,
}

/// What a free plane goes through.
#[derive(Clone, Copy, Debug)]
enum Through {
    /// A corner that is not known yet.
    Coordinate(f64),
    /// A corner, numbered over all faces.
    Corner(u32),
}

impl FreePlane {
    /// The plane by the name of a corner on it.
    fn with_corner(&self, set: &Set<'_>) -> Option<Candidate> {
        let Self { cost, axis, through } = *self;
        let coordinate = match through {
            Through::Corner(corner) => {
                return Some(Candidate { plane: PlaneId::axis(axis, corner), cost });
            }
            Through::Coordinate(coordinate) => coordinate,
        };
        let touches = |piece: &&Piece| {
            piece.min[axis] == coordinate && piece.min_is_corner(axis)
                || piece.max[axis] == coordinate && piece.max_is_corner(axis)
        };
        let piece = set.pieces.iter().find(touches)?;
        let corner = piece.corner_at(set.faces, axis, coordinate)?;
        Some(Candidate { plane: PlaneId::axis(axis, corner), cost })
    }
}

#[cfg(test)]
mod tests;
