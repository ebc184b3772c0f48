//! Pieces that can be taken off a small set without a cut.

use super::gather::Gathered;
use super::live::Live;
use super::taken::TakenApart;
use crate::geom::{Faces, Kernel, PlaneId, Side};

/// How many pieces may be looked at in vain, for each piece of the set, before the search for
/// pieces to take off ends. Larger: time; smaller: pieces that are cut for nothing.
const PATIENCE: usize = 32;

/// Finds, in a set of pieces, those whose planes have all the rest on one side, then those for
/// which that holds once the former are gone, and so on.
///
/// To take such a piece first never costs a fragment: a tree of the whole set, with the piece and
/// its plane left out, is one of the rest, with no more fragments. A set in convex position comes
/// apart entirely.
#[derive(Debug, Default)]
pub(super) struct Peeler {
    /// The pieces that are left, in the order in which they are held against the planes of others:
    /// those that were witnesses last come first, as they lie at the rim of the set.
    order: Vec<u32>,
    gone: Vec<bool>,
    /// For each piece, what keeps it from being taken: a piece in front of its plane and one
    /// behind, or twice one across.
    witnesses: Vec<[u32; 2]>,
    /// Pieces that are not certainly on one side of the plane at hand.
    near: Vec<u32>,
    /// The pieces on it.
    own: Vec<u32>,
    /// How many pieces the last search left, if it found any to take.
    left: usize,
}

const NOBODY: u32 = u32::MAX;

impl Peeler {
    /// Whether the set at hand, which comes after the one last searched, is what was left of that:
    /// then another search would be in vain.
    pub(super) fn has_searched(&mut self, pieces: usize) -> bool {
        std::mem::take(&mut self.left) == pieces
    }

    /// Searches a set; tells whether anything was found.
    pub(super) fn search<K: Kernel>(
        &mut self,
        (kernel, faces): (&K, &Faces),
        (pieces, arena): (&[Live], &[K::Vertex]),
        set: &Gathered<K>,
        taken: &mut TakenApart,
    ) -> bool {
        taken.clear();
        self.reset(pieces.len());
        let n = pieces.len();
        let mut patience = PATIENCE * n;
        let mut progress = true;
        while progress && patience > 0 && self.order.len() > 1 {
            progress = false;
            for p in 0..n as u32 {
                if self.order.len() <= 1 || self.gone[p as usize] || self.is_held(p) {
                    continue;
                }
                if let Some(looks) = self.looks_until_held(p, set) {
                    patience = patience.saturating_sub(looks);
                    continue;
                }
                let splitter = set.splitter(p as usize);
                let side =
                    |q: u32| kernel.classify(faces, splitter, pieces[q as usize].piece(arena));
                if let Some(rest) = self.rest(p, side) {
                    taken.push(PlaneId::face(pieces[p as usize].face), rest, &self.own);
                    self.own.iter().for_each(|&q| self.gone[q as usize] = true);
                    self.order.retain(|&q| !self.gone[q as usize]);
                    progress = true;
                } else {
                    patience = patience.saturating_sub(self.order.len());
                }
            }
        }
        let found = taken.len() > 0;
        self.left = if found { self.order.len() } else { 0 };
        found
    }

    fn reset(&mut self, pieces: usize) {
        self.gone.clear();
        self.gone.resize(pieces, false);
        self.witnesses.clear();
        self.witnesses.resize(pieces, [NOBODY; 2]);
        self.order.clear();
        self.order.extend(0..pieces as u32);
    }

    /// Whether what kept a piece from being taken is still there.
    fn is_held(&self, p: u32) -> bool {
        self.witnesses[p as usize].iter().all(|&w| w != NOBODY && !self.gone[w as usize])
    }

    /// Holds the others against a piece's plane until there are some on both sides: how many that
    /// took, if there are.
    fn looks_until_held<K: Kernel>(&mut self, p: u32, set: &Gathered<K>) -> Option<usize> {
        let splitter = set.splitter(p as usize);
        let slack = K::slack(splitter);
        let mut seen = [NOBODY; 2];
        self.near.clear();
        for (i, &q) in self.order.iter().enumerate() {
            if q == p {
                continue;
            }
            let (low, high) = set.extent(splitter, q as usize);
            if high > slack {
                seen[0] = q;
            }
            if low < -slack {
                seen[1] = q;
            }
            if seen[0] != NOBODY && seen[1] != NOBODY {
                self.witnesses[p as usize] = seen;
                self.order.swap(i, i / 2);
                return Some(i + 1);
            }
            if low <= slack && high >= -slack {
                self.near.push(q);
            }
        }
        // For now, what is seen on one side alone; what is near has still to be decided.
        self.witnesses[p as usize] = seen;
        None
    }

    /// On which side of a piece's plane all others are that are left and not on it, if on one; those
    /// on it, and the piece, are then its own.
    fn rest(&mut self, p: u32, side: impl Fn(u32) -> Side) -> Option<Side> {
        let mut seen = self.witnesses[p as usize];
        self.own.clear();
        self.own.push(p);
        for &q in &self.near {
            let side = side(q);
            if side == Side::Coplanar {
                self.own.push(q);
            }
            if matches!(side, Side::Front | Side::Spanning) {
                seen[0] = q;
            }
            if matches!(side, Side::Back | Side::Spanning) {
                seen[1] = q;
            }
        }
        self.witnesses[p as usize] = seen;
        match seen {
            [NOBODY, _] => Some(Side::Back),
            [_, NOBODY] => Some(Side::Front),
            _ => None,
        }
    }
}
