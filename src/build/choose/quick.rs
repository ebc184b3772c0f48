//! How frames choose planes for small sets: quickly, as each tree is ordered once or twice.

use super::cost::{Cost, Counts, Terms};
use super::own::Shares;
use super::set::Set;
use super::tuning::{Quick, Tuning};
use crate::build::piece::Piece;
use crate::exact::{Faces, LATTICE_LIMIT, PlaneId, Side};

/// The share of its set's box that a piece has to fill for its plane to be trusted at once.
///
/// Corners in `f32` are rounded. So small polygons that were meant to lie in one plane have planes of
/// their own, and far from such a polygon its plane is off by more than the tolerance: it would separate
/// others that belong together.
fn trusted_share(faces: &Faces, quick: &Quick) -> f64 {
    if quick.is_coarse(faces) { quick.trusted_share } else { 0.0 }
}

impl Quick {
    /// Whether planes of small pieces cannot be trusted.
    pub(in crate::build) fn is_coarse(&self, faces: &Faces) -> bool {
        faces.tolerance() > self.coarse * LATTICE_LIMIT
    }
}

/// The best own plane of a small set, by exact counts of all its pieces.
#[derive(Debug)]
pub(in crate::build) struct Best {
    terms: Terms,
    pieces: usize,
    shares: Shares,
    trusted_share: f64,
    cost: Cost,
    slot: usize,
    is_trusted: bool,
    is_even: bool,
    uneven: usize,
}

impl Best {
    pub(in crate::build) fn new<'a>(
        pieces: impl Iterator<Item = &'a Piece>,
        faces: &Faces,
        tuning: &Tuning,
        quick: &Quick,
    ) -> Self {
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut count, mut cuts) = (0, 0);
        for piece in pieces {
            count += 1;
            cuts += usize::from(piece.cuts);
            for axis in 0..3 {
                let (low, high) = (piece.min[axis], piece.max[axis]);
                min[axis] = if low < min[axis] { low } else { min[axis] };
                max[axis] = if high > max[axis] { high } else { max[axis] };
            }
        }
        let size = std::array::from_fn(|axis| max[axis] - min[axis]);
        let terms = Terms::of(count, cuts, tuning);
        let shares = Shares::of(size);
        Self {
            terms,
            pieces: count,
            shares,
            trusted_share: trusted_share(faces, quick),
            cost: Cost::MOST,
            slot: 0,
            is_trusted: false,
            is_even: false,
            uneven: tuning.uneven,
        }
    }

    /// Compares the plane of a piece, by which pieces reach in front of it, and which behind.
    pub(in crate::build) fn see(&mut self, slot: usize, piece: &Piece, [front, back]: [u64; 2]) {
        let cut = front & back;
        // Counting bits takes a while on processors without an instruction for it.
        let splits = if cut == 0 { 0 } else { cut.count_ones() };
        let [front, back] = [front, back].map(u64::count_ones);
        let counts = Counts { front: front - splits, back: back - splits, splits };
        let share = self.shares.get(piece);
        let cost = self.terms.cost(&counts, share);
        if cost.is_less(&self.cost) {
            (self.cost, self.slot) = (cost, slot);
            self.is_trusted = share >= self.trusted_share;
            self.is_even =
                self.is_trusted && Cost::of(&counts).divides_evenly(self.pieces, self.uneven);
        }
    }

    /// Whether the plane of a piece can be trusted.
    pub(in crate::build) fn is_trusted(&self, piece: &Piece) -> bool {
        self.shares.get(piece) >= self.trusted_share
    }

    /// Whether the best plane can be trusted, cuts nothing, and leaves enough on both sides.
    pub(in crate::build) fn is_even(&self) -> bool {
        self.is_even
    }

    /// Whether the best plane can be trusted, and cuts nothing.
    pub(in crate::build) fn is_sure(&self) -> bool {
        self.is_trusted && !self.cost.cuts
    }

    /// The slot of the piece with the best plane.
    pub(in crate::build) fn slot(&self) -> usize {
        self.slot
    }
}

/// An own plane that cuts nothing and divides the set evenly, among those of a few pieces. Layers of a
/// stack have such planes; in other sets a few pieces are enough to see that one is cut.
pub(super) fn even_plane(set: &Set<'_>, tuning: &Tuning, quick: &Quick) -> Option<PlaneId> {
    let least = set.len() / tuning.uneven;
    let shares = Shares::of(set.size());
    let least_trusted = trusted_share(set.faces, quick);
    let is_trusted = |&piece: &usize| shares.get(&set.pieces[piece]) >= least_trusted;
    let mut planes = set.sample(quick.probes).filter(is_trusted).map(|piece| set.own_plane(piece));
    planes.find(|&plane| {
        let prepared = set.prepare(plane);
        let (mut front, mut back) = (0, 0);
        let is_whole = (0..set.len()).all(|piece| {
            let side = set.classify(&prepared, piece);
            front += usize::from(side == Side::Front);
            back += usize::from(side == Side::Back);
            // If all of a first sample is on one side, so is nearly all of the set.
            side != Side::Spanning && (piece < tuning.first_sample || front.min(back) > 0)
        });
        is_whole && front.min(back) >= least
    })
}

/// What is in the middle of a set along the longest side of its box. If nothing is, as between two sides
/// of a ring, a free plane there divides the set.
pub(super) enum Middle {
    Gap,
    /// A piece whose plane cuts others, but only such as cross the piece: any tree has to cut them, or
    /// it.
    Crossing(PlaneId),
    /// Pieces with planes that cut nothing, or more than they have to.
    Taken,
}

impl Middle {
    pub(super) fn of(set: &Set<'_>, quick: &Quick) -> Self {
        let (axis, middle) = set.middle();
        let is_there = |&own: &usize| {
            let piece = &set.pieces[own];
            piece.min[axis] < middle && middle < piece.max[axis]
        };
        let (shares, least_trusted) = (Shares::of(set.size()), trusted_share(set.faces, quick));
        let cuts_what_crosses = |&own: &usize| {
            let prepared = set.prepare(set.own_plane(own));
            let mut cuts = 0;
            let is_needed = (0..set.len()).all(|piece| {
                let spans = set.classify(&prepared, piece) == Side::Spanning;
                cuts += usize::from(spans);
                !spans || set.crosses(piece, own)
            });
            is_needed && cuts > 0
        };
        let mut there = (0..set.len()).filter(is_there).take(quick.probes).peekable();
        if there.peek().is_none() {
            return Self::Gap;
        }
        let is_trusted = |&own: &usize| shares.get(&set.pieces[own]) >= least_trusted;
        let own = there.find(|own| is_trusted(own) && cuts_what_crosses(own));
        own.map_or(Self::Taken, |own| Self::Crossing(set.own_plane(own)))
    }
}
