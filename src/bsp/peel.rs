//! Pieces that can be taken off a set without a cut.

use super::gather::Gathered;
use super::live::Live;
use crate::geom::{Kernel, PlaneId};

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
    gone: Vec<bool>,
    /// For each piece, what keeps it from being taken: a piece in front of its plane and one
    /// behind, or twice one across.
    witnesses: Vec<[u32; 2]>,
    /// The pieces in the order in which others are held against their planes: those that were
    /// witnesses last come first, as they lie at the rim of the set.
    order: Vec<u32>,
    /// The planes found, with the number of pieces that each leaves, the last to be used first.
    found: Vec<(PlaneId, usize)>,
}

const NOBODY: u32 = u32::MAX;

impl Peeler {
    /// The next plane found, if the set is what the one before it left.
    pub(super) fn next(&mut self, pieces: usize) -> Option<PlaneId> {
        match self.found.pop() {
            Some((plane, expected)) if expected == pieces => Some(plane),
            _ => {
                self.found.clear();
                None
            }
        }
    }

    /// Searches a set; [`next`](Self::next) gives the planes.
    pub(super) fn search<K: Kernel>(&mut self, pieces: &[Live], set: &Gathered<K>) {
        self.reset(pieces.len());
        let (n, mut left) = (pieces.len(), pieces.len());
        let mut patience = PATIENCE * n;
        let mut progress = true;
        while progress && patience > 0 && left > 1 {
            progress = false;
            for p in 0..n as u32 {
                if left <= 1 || self.gone[p as usize] || self.is_held(p) {
                    continue;
                }
                match self.look(p, set) {
                    Ok(coplanar) => {
                        self.found.push((PlaneId::face(pieces[p as usize].face), left));
                        left -= self.take(p, coplanar, set);
                        progress = true;
                    }
                    Err(looks) => patience = patience.saturating_sub(looks),
                }
            }
        }
        self.found.reverse();
    }

    fn reset(&mut self, pieces: usize) {
        self.gone.clear();
        self.gone.resize(pieces, false);
        self.witnesses.clear();
        self.witnesses.resize(pieces, [NOBODY; 2]);
        self.order.clear();
        self.order.extend(0..pieces as u32);
        self.found.clear();
    }

    /// Whether what kept a piece from being taken is still there.
    fn is_held(&self, p: u32) -> bool {
        self.witnesses[p as usize].iter().all(|&w| w != NOBODY && !self.gone[w as usize])
    }

    /// Holds the others against a piece's plane: whether it has some of them on it, if it has
    /// none on one side, or how many were looked at until there were some on both.
    fn look<K: Kernel>(&mut self, p: u32, set: &Gathered<K>) -> Result<bool, usize> {
        let splitter = set.splitter(p as usize);
        let mut seen = [NOBODY; 2];
        let mut coplanar = false;
        for i in 0..self.order.len() {
            let q = self.order[i];
            if q == p || self.gone[q as usize] {
                continue;
            }
            let (front, back) = set.reach(splitter, q as usize);
            coplanar |= !front && !back;
            if front {
                seen[0] = q;
            }
            if back {
                seen[1] = q;
            }
            if seen[0] != NOBODY && seen[1] != NOBODY {
                self.witnesses[p as usize] = seen;
                self.order.swap(i, i / 2);
                return Err(i + 1);
            }
        }
        Ok(coplanar)
    }

    /// Takes a piece, and those on its plane; gives how many.
    fn take<K: Kernel>(&mut self, p: u32, coplanar: bool, set: &Gathered<K>) -> usize {
        self.gone[p as usize] = true;
        let mut taken = 1;
        if coplanar {
            let splitter = set.splitter(p as usize);
            for q in 0..self.gone.len() as u32 {
                if !self.gone[q as usize] && set.reach(splitter, q as usize) == (false, false) {
                    self.gone[q as usize] = true;
                    taken += 1;
                }
            }
        }
        self.order.retain(|&q| !self.gone[q as usize]);
        taken
    }
}
