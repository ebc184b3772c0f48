//! How frames choose planes for small sets: own planes first, as each tree is ordered once or twice.

use super::cost::{Cost, CostModel, Counts};
use super::own::Shares;
use super::set::Set;
use super::tuning::{FrameTuning, Tuning};
use crate::build::piece::{Division, Piece};
use crate::exact::{Faces, LATTICE_LIMIT, PlaneId, Side};

impl FrameTuning {
    /// The share of its set's box that a piece has to fill for its plane to be trusted at once.
    ///
    /// Corners in `f32` are rounded. So small polygons that were meant to lie in one plane have planes of
    /// their own, and far from such a polygon its plane is off by more than the tolerance: it would separate
    /// others that belong together.
    fn least_share(&self, faces: &Faces) -> f64 {
        if self.is_coarse(faces) { self.trusted_share } else { 0.0 }
    }

    /// Whether planes of small pieces cannot be trusted.
    pub(in crate::build) fn is_coarse(&self, faces: &Faces) -> bool {
        faces.tolerance() > self.coarse * LATTICE_LIMIT
    }
}

/// Tries own planes of small sets; its list is kept to be used again.
#[derive(Debug, Default)]
pub(super) struct OwnFirst {
    division: Division,
}

impl OwnFirst {
    /// The first plane of a few pieces that cuts nothing and divides the set evenly, or that cuts few
    /// pieces, whose planes cut its own piece in turn. Of a set of few pieces, the best plane otherwise.
    ///
    /// Says as well whether the plane is good enough to be taken without a search for axis planes: it cuts no
    /// more than it has to, and can be trusted. Writes where the pieces lie against it.
    pub(super) fn find(
        &mut self,
        set: &Set<'_>,
        tuning: &Tuning,
        frames: &FrameTuning,
        division: &mut Division,
    ) -> Option<(PlaneId, bool)> {
        let tries_all = set.len() <= frames.table;
        let (tried, most) =
            if tries_all { (set.len(), usize::MAX) } else { (frames.probes, frames.crossings) };
        let (terms, shares) = (CostModel::small(set, tuning), Shares::of(set.size()));
        let least_share = frames.least_share(set.faces);
        let mut best: Option<(Cost, PlaneId, bool)> = None;
        for own in set.sample(tried) {
            let plane = set.own_plane(own);
            if !set.divide(plane, most, &mut self.division) {
                continue;
            }
            let counts = Counts::of(&self.division);
            let share = shares.get(&set.pieces[own]);
            let is_trusted = share >= least_share;
            let is_even = || Cost::of(&counts).divides_evenly(set.len(), tuning.uneven);
            if is_trusted && (is_even() || self.cuts_what_crosses(set, own, frames)) {
                std::mem::swap(&mut self.division, division);
                return Some((plane, true));
            }
            let cost = terms.cost(&counts, share);
            if tries_all && best.is_none_or(|(least, ..)| cost.is_less(&least)) {
                best = Some((cost, plane, is_trusted && !cost.cuts));
                std::mem::swap(&mut self.division, division);
            }
        }
        best.map(|(_, plane, is_good)| (plane, is_good))
    }

    /// Whether the plane of a piece cuts few pieces, and all of them have to be cut, or the piece: their
    /// planes cut it, and their boxes overlap.
    fn cuts_what_crosses(&self, set: &Set<'_>, own: usize, frames: &FrameTuning) -> bool {
        let (cuts, sides) = (self.division.count(Side::Spanning), &self.division.sides);
        let mut cut = (0..set.len()).filter(|&other| sides[other] == Side::Spanning);
        0 < cuts
            && cuts <= frames.crossings
            && cut.all(|other| {
                overlap(&set.pieces[own], &set.pieces[other])
                    && set.classify(&set.prepare(set.own_plane(other)), own) == Side::Spanning
            })
    }
}

/// Whether the boxes of two pieces overlap.
fn overlap(a: &Piece, b: &Piece) -> bool {
    (0..3).all(|axis| a.min[axis] < b.max[axis] && b.min[axis] < a.max[axis])
}
