//! A small set of pieces, gathered to be held against many planes.

use super::live::Live;
use crate::geom::{Faces, Kernel, PlaneId, Vertex};

/// The vertices of a set's pieces side by side, and the planes of the pieces made ready.
#[derive(Debug)]
pub(super) struct Gathered<K: Kernel> {
    points: Vec<[f64; 3]>,
    /// Where the points of each piece end.
    ends: Vec<u32>,
    splitters: Vec<K::Splitter>,
}

impl<K: Kernel> Default for Gathered<K> {
    fn default() -> Self {
        Self { points: vec![], ends: vec![], splitters: vec![] }
    }
}

impl<K: Kernel> Gathered<K> {
    /// Takes a set, in place of what was there.
    pub(super) fn take(&mut self, kernel: &K, faces: &Faces, set: &[Live], arena: &[K::Vertex]) {
        self.points.clear();
        self.ends.clear();
        self.splitters.clear();
        for live in set {
            match live.piece(arena).cut {
                None => self.points.extend_from_slice(faces.corners(live.face)),
                Some(vertices) => self.points.extend(vertices.iter().map(Vertex::position)),
            }
            self.ends.push(self.points.len() as u32);
            self.splitters.push(kernel.splitter(faces, PlaneId::face(live.face)));
        }
    }

    /// The plane of a piece.
    #[inline]
    pub(super) fn splitter(&self, piece: usize) -> &K::Splitter {
        &self.splitters[piece]
    }

    /// Whether a piece reaches in front of a plane, and behind it; see [`reach`].
    #[inline]
    pub(super) fn reach(&self, splitter: &K::Splitter, piece: usize) -> (bool, bool) {
        reach::<K>(splitter, self.points(piece))
    }

    /// The least and the greatest distance of a piece from a plane, rounded.
    #[inline]
    pub(super) fn extent(&self, splitter: &K::Splitter, piece: usize) -> (f64, f64) {
        extent::<K>(splitter, self.points(piece))
    }

    #[inline]
    fn points(&self, piece: usize) -> impl Iterator<Item = [f64; 3]> {
        let start = if piece == 0 { 0 } else { self.ends[piece - 1] as usize };
        self.points[start..self.ends[piece] as usize].iter().copied()
    }
}

/// Whether points lie in front of a plane, and behind it, by rounded distances: what is decided so
/// is only which plane is taken.
#[inline]
pub(super) fn reach<K: Kernel>(
    splitter: &K::Splitter,
    points: impl Iterator<Item = [f64; 3]>,
) -> (bool, bool) {
    let (low, high) = extent::<K>(splitter, points);
    let slack = K::slack(splitter);
    (high > slack, low < -slack)
}

#[inline]
fn extent<K: Kernel>(splitter: &K::Splitter, points: impl Iterator<Item = [f64; 3]>) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for point in points {
        let s = K::distance(splitter, point);
        // Distances are finite: the simple comparisons are one instruction each.
        low = if s < low { s } else { low };
        high = if s > high { s } else { high };
    }
    (low, high)
}
