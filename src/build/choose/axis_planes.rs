//! Finds the best plane that is perpendicular to an axis and goes through a corner, by bins or by sorting.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::ChooseContext;
use super::cost::{Cost, Counts, PricedPlane};
use super::set::Set;
use crate::Error;
use crate::build::piece::Piece;
use crate::exact::{Faces, PlaneId};
use crate::progress::{PIECES_AT_ONCE, SWEEP, Watch};

/// Mean number of pieces per bin in large sets. Too small: comparing bins takes longer than counting pieces.
/// Too large: narrow gaps are not found.
const PER_BIN: usize = 4;
/// The fewest bins. Too small: small sets are cut more often. Too large: comparing bins takes longer than
/// counting pieces.
const FEWEST_BINS: usize = 32;
/// The most bins. Too small: large sets are cut more often. Too large: bins no longer fit the processor's
/// first cache.
const MOST_BINS: usize = 256;

/// Searches for free planes, with reused lists.
#[derive(Debug, Default)]
pub(super) struct FreePlanes {
    bins: Vec<Bin>,
    /// The beginning, the end and the number of each piece of a small set.
    spans: Vec<(f64, f64, u32)>,
}

impl FreePlanes {
    /// Searches for an axis plane of low cost; in sets of fewer than `clean_below` pieces, only for one that cuts
    /// nothing.
    pub(super) fn find(
        &mut self,
        set: &Set<'_>,
        rules: &ChooseContext<'_>,
    ) -> Result<Option<PricedPlane>, Error> {
        if set.len() < rules.tuning.clean_below {
            Ok(self.clean(set))
        } else {
            self.best(set, rules.watch)
        }
    }

    /// Searches for an axis plane of low cost that has fewer pieces on each side than the set.
    ///
    /// Counts the bins in which pieces begin and end (binned sweep: Wald, “On fast construction of SAH-based
    /// bounding volume hierarchies”, 2007). The candidates are the borders of bins, and one place inside each
    /// bin in which all ends of pieces precede all beginnings. Such places are rows of vertices, and gaps.
    /// The corner nearest the best candidate names the plane. Takes O(n) time.
    pub(super) fn best(
        &mut self,
        set: &Set<'_>,
        watch: &Watch<'_>,
    ) -> Result<Option<PricedPlane>, Error> {
        let n = set.len();
        let count = (n / PER_BIN).clamp(FEWEST_BINS, MOST_BINS);
        let (bins, tolerance) = (Bins::new(set, count), set.faces.tolerance());
        self.bins.clear();
        self.bins.resize(count, Bin::EMPTY);
        for pieces in set.pieces.chunks(PIECES_AT_ONCE) {
            watch.work(pieces.len() * SWEEP)?;
            self.count(pieces, &bins, tolerance);
        }
        let mut places: SmallVec<[(Cost, usize, f64); 3]> = SmallVec::new();
        for axis in axes(set) {
            let (mut begun, mut ended) = (0, 0);
            let mut best = (Cost::MOST, axis, 0.0);
            let mut see = |begun, ended, on, at| {
                let cost = cost(n, begun, ended, on);
                if cost.is_less(&best.0) {
                    best = (cost, axis, at);
                }
            };
            for (next, bin) in (1..).zip(&self.bins) {
                ended += bin.ended[axis];
                if bin.end[axis] <= bin.begin[axis] {
                    see(begun, ended, bin.flat[axis], bin.end[axis]);
                }
                begun += bin.begun[axis];
                see(begun, ended, 0, bins.border(axis, next));
            }
            if best.0.is_less(&Cost::MOST) {
                places.push(best);
            }
        }
        // If many pieces end at cuts, the nearest corner may be so far away that its plane separates nothing.
        places.sort_by(|a, b| a.0.cmp(&b.0));
        let mut planes = places.into_iter().filter_map(|(_, axis, at)| through(set, axis, at));
        Ok(planes.next())
    }

    /// Adds pieces to the bins in which they begin and end.
    fn count(&mut self, pieces: &[Piece], bins: &Bins, tolerance: f64) {
        for piece in pieces {
            for axis in 0..3 {
                let [begin, end] = span(piece, axis, tolerance);
                let bin = &mut self.bins[bins.of(axis, begin)];
                bin.begun[axis] += 1;
                bin.begin[axis] = if begin < bin.begin[axis] { begin } else { bin.begin[axis] };
                let bin = &mut self.bins[bins.of(axis, end)];
                bin.ended[axis] += 1;
                bin.end[axis] = if end > bin.end[axis] { end } else { bin.end[axis] };
                bin.flat[axis] += u32::from(begin == end);
            }
        }
    }

    /// Searches for the free plane with the lowest cost among the planes that cut nothing. Sorts the set; in
    /// small sets, sorting takes less time than counting by bins.
    pub(super) fn clean(&mut self, set: &Set<'_>) -> Option<PricedPlane> {
        let mut best: Option<FreePlane> = None;
        let (n, pieces, tolerance) = (set.len(), set.pieces, set.faces.tolerance());
        for axis in axes(set).filter(|&axis| set.may_part(axis) && set.may_have_gap(axis)) {
            let spans = pieces.iter().zip(0..).map(|(p, i)| (p.min[axis], p.max[axis], i));
            self.spans.clear();
            self.spans.reserve(n);
            self.spans.extend(spans);
            self.spans.sort_unstable_by(|a, b| compare(&a.0, &b.0).then(compare(&a.1, &b.1)));
            // The piece that reaches furthest so far, and its end.
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

/// The plane through the corner nearest a coordinate.
fn through(set: &Set<'_>, axis: usize, at: f64) -> Option<PricedPlane> {
    let mut nearest: Option<(f64, f64, &Piece)> = None;
    for piece in set.pieces {
        let ends = [
            (piece.min[axis], piece.min_is_corner(axis)),
            (piece.max[axis], piece.max_is_corner(axis)),
        ];
        for (coordinate, is_corner) in ends {
            let distance = (coordinate - at).abs();
            if is_corner && nearest.is_none_or(|(least, ..)| distance < least) {
                nearest = Some((distance, coordinate, piece));
            }
        }
    }
    let (_, coordinate, piece) = nearest?;
    let corner = piece.corner_at(set.faces, axis, coordinate)?;
    let (mut begun, mut ended, mut on) = (0, 0, 0);
    for piece in set.pieces {
        let [begin, end] = span(piece, axis, set.faces.tolerance());
        begun += u32::from(begin < coordinate);
        ended += u32::from(end <= coordinate);
        on += u32::from(end <= coordinate && coordinate <= begin);
    }
    let cost = cost(set.len(), begun, ended, on);
    cost.is_less(&Cost::MOST).then(|| PricedPlane { plane: PlaneId::axis(axis, corner), cost })
}

/// Returns a plane between two pieces. The first piece ends before the second begins. The plane goes through
/// an end of a piece, or otherwise through a cut-off corner of a piece's face.
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

/// The axes along which a set has an extent: axes that may have a gap first, and then the longest first.
fn axes(set: &Set<'_>) -> impl Iterator<Item = usize> + use<> {
    let size = set.size();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| set.may_part(b).cmp(&set.may_part(a)).then(size[b].total_cmp(&size[a])));
    axes.into_iter().filter(move |&axis| size[axis] > 0.0)
}

/// Compares numbers that are not NaN, in less time than `total_cmp`.
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

/// Returns two coordinates. A piece reaches behind a plane across the axis by more than the tolerance if the
/// plane's coordinate is above the first. The piece reaches in front of the plane by more than the tolerance
/// if the plane's coordinate is below the second. For a piece thinner than twice the tolerance, the two
/// coordinates are equal.
#[inline]
fn span(piece: &Piece, axis: usize, tolerance: f64) -> [f64; 2] {
    let [begin, end] = [piece.min[axis] + tolerance, piece.max[axis] - tolerance];
    if begin <= end { [begin, end] } else { [0.5 * (begin + end); 2] }
}

/// The cost of a plane that divides `n` pieces: `begun` pieces begin before the plane, `ended` pieces end
/// before it, and `on` pieces lie on it. Returns [`Cost::MOST`] if all pieces are on one side.
#[inline]
fn cost(n: usize, begun: u32, ended: u32, on: u32) -> Cost {
    let n = n as u32;
    if begun == n || ended == 0 {
        return Cost::MOST;
    }
    let splits = (begun + on).saturating_sub(ended);
    Cost::of(&Counts { front: n - ended - splits, back: begun - splits, splits })
}

/// The pieces that begin and end in a bin, along each axis.
#[derive(Clone, Copy, Debug)]
struct Bin {
    begun: [u32; 3],
    ended: [u32; 3],
    /// The number of pieces that begin and end in the same place.
    flat: [u32; 3],
    /// The beginning of the first piece.
    begin: [f64; 3],
    /// The end of the last piece.
    end: [f64; 3],
}

impl Bin {
    const EMPTY: Self = Self {
        begun: [0; 3],
        ended: [0; 3],
        flat: [0; 3],
        begin: [f64::INFINITY; 3],
        end: [f64::NEG_INFINITY; 3],
    };
}

/// Equal bins over the bounding box of a set, along each axis.
struct Bins {
    start: [f64; 3],
    per_unit: [f64; 3],
    /// The number of the last bin.
    last: f64,
}

/// Adding this to a number from 0 to 2³² leaves the nearest integer in the last bits of the sum. The addition
/// is faster than a conversion, which would saturate.
const TO_INTEGER: f64 = (1_u64 << 52) as f64;

impl Bins {
    fn new(set: &Set<'_>, count: usize) -> Self {
        let last = (count - 1) as f64;
        let per_unit = set.size().map(|size| if size > 0.0 { last / size } else { 0.0 });
        Self { start: set.min, per_unit, last }
    }

    /// The bin of a coordinate. A larger coordinate is never in an earlier bin.
    #[inline]
    fn of(&self, axis: usize, coordinate: f64) -> usize {
        let place = (coordinate - self.start[axis]) * self.per_unit[axis];
        let place = if place > 0.0 { place } else { 0.0 };
        let place = if place < self.last { place } else { self.last };
        (place + TO_INTEGER).to_bits() as u32 as usize
    }

    /// The beginning of a bin.
    fn border(&self, axis: usize, bin: usize) -> f64 {
        self.start[axis] + (bin as f64 - 0.5) / self.per_unit[axis]
    }
}

/// A free plane before its [`PlaneId`] is known.
#[derive(Clone, Copy, Debug)]
struct FreePlane {
    cost: Cost,
    axis: usize,
    through: Through,
}

/// The definition of a free plane.
#[derive(Clone, Copy, Debug)]
enum Through {
    /// Through a corner that is not known yet.
    Coordinate(f64),
    /// Through a corner, numbered over all faces.
    Corner(u32),
}

impl FreePlane {
    /// Returns the plane, named by a corner that lies on it.
    fn with_corner(&self, set: &Set<'_>) -> Option<PricedPlane> {
        let Self { cost, axis, through } = *self;
        let coordinate = match through {
            Through::Corner(corner) => {
                return Some(PricedPlane { plane: PlaneId::axis(axis, corner), cost });
            }
            Through::Coordinate(coordinate) => coordinate,
        };
        let touches = |piece: &&Piece| {
            piece.min[axis] == coordinate && piece.min_is_corner(axis)
                || piece.max[axis] == coordinate && piece.max_is_corner(axis)
        };
        let piece = set.pieces.iter().find(touches)?;
        let corner = piece.corner_at(set.faces, axis, coordinate)?;
        Some(PricedPlane { plane: PlaneId::axis(axis, corner), cost })
    }
}

#[cfg(test)]
mod tests;
