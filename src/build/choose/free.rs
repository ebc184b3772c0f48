//! The best free plane of a set of pieces: perpendicular to an axis, through a corner.

mod binned;
mod plane;
#[cfg(test)]
mod tests;

use super::cost::{Candidate, Cost, Counts};
use super::set::Set;
use super::tuning::Tuning;
use crate::Error;
use crate::build::piece::Piece;
use crate::build::progress::{SWEEP, Watch};
use crate::exact::Faces;
use crate::memory::reserve;
use binned::{Binned, compare};
use plane::{FreePlane, Through};

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
    ) -> Result<Option<Candidate>, Error> {
        let mut best: Option<FreePlane> = None;
        let n = set.len();
        for (axis, ends) in axes(set) {
            if best.is_some_and(|best| best.cost.divides_evenly(n, tuning.uneven))
                || watch.work(n * SWEEP).is_err()
            {
                break;
            }
            self.binned.best_along(axis, ends, set, tuning, &mut best)?;
        }
        Ok(best.and_then(|best| best.with_corner(set)))
    }

    /// The free plane of least cost among those that cut nothing. It sorts the set, which for a small one
    /// takes less time than counting by bins.
    pub(super) fn clean(
        &mut self,
        set: &Set<'_>,
        tuning: &Tuning,
    ) -> Result<Option<Candidate>, Error> {
        let mut best: Option<FreePlane> = None;
        let (n, pieces, tolerance) = (set.len(), set.pieces, set.faces.tolerance());
        for (axis, _) in axes(set).filter(|&(axis, _)| set.may_part(axis) && set.may_have_gap(axis))
        {
            if best.is_some_and(|best| best.cost.divides_evenly(n, tuning.uneven)) {
                break;
            }
            let spans = pieces.iter().zip(0..).map(|(p, i)| (p.min[axis], p.max[axis], i));
            self.spans.clear();
            reserve(&mut self.spans, n)?;
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
        Ok(best.and_then(|best| best.with_corner(set)))
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
