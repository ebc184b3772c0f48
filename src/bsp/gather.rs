//! A small set of pieces, gathered to be held against many planes.

use super::live::Live;
use crate::geom::{Faces, Kernel, PlaneId, Vertex};

/// The vertices of a set's pieces side by side, and the planes of the pieces made ready.
#[derive(Debug)]
pub(super) struct Gathered<K: Kernel> {
    outlines: Vec<Outline>,
    /// The vertices beyond the third of pieces that have more.
    more: Vec<[f64; 3]>,
    splitters: Vec<K::Splitter>,
}

/// The vertices of a piece; most have three.
#[derive(Clone, Copy, Debug)]
struct Outline {
    first: [[f64; 3]; 3],
    more: (u32, u32),
}

impl<K: Kernel> Default for Gathered<K> {
    fn default() -> Self {
        Self { outlines: vec![], more: vec![], splitters: vec![] }
    }
}

impl<K: Kernel> Gathered<K> {
    /// Takes a set with the planes of its pieces, in place of what was there.
    pub(super) fn take(&mut self, kernel: &K, faces: &Faces, set: &[Live], arena: &[K::Vertex]) {
        self.gather(faces, set, arena);
        let splitter = |live: &Live| kernel.splitter(faces, PlaneId::face(live.face));
        self.splitters.extend(set.iter().map(splitter));
    }

    /// Takes a set without the planes.
    pub(super) fn gather(&mut self, faces: &Faces, set: &[Live], arena: &[K::Vertex]) {
        self.outlines.clear();
        self.more.clear();
        self.splitters.clear();
        for live in set {
            match live.piece(arena).cut {
                None => self.push(faces.corners(live.face), |&corner| corner),
                Some(vertices) => self.push(vertices, Vertex::position),
            }
        }
    }

    fn push<V>(&mut self, vertices: &[V], position: impl Fn(&V) -> [f64; 3]) {
        let first = [0, 1, 2].map(|k| position(&vertices[k]));
        let start = self.more.len() as u32;
        self.more.extend(vertices[3..].iter().map(position));
        self.outlines.push(Outline { first, more: (start, self.more.len() as u32) });
    }

    /// The plane of a piece.
    #[inline]
    pub(super) fn splitter(&self, piece: usize) -> &K::Splitter {
        &self.splitters[piece]
    }

    /// Whether a piece reaches in front of a plane, and behind it; see [`reach`].
    #[inline]
    pub(super) fn reach(&self, splitter: &K::Splitter, piece: usize) -> (bool, bool) {
        reach_of::<K>(splitter, self.extent(splitter, piece))
    }

    /// The same for the pieces of a range.
    #[inline]
    pub(super) fn reaches(
        &self,
        splitter: &K::Splitter,
        pieces: std::ops::Range<usize>,
    ) -> impl Iterator<Item = (bool, bool)> {
        let outlines = self.outlines[pieces].iter();
        outlines.map(|outline| reach_of::<K>(splitter, self.extent_of(splitter, outline)))
    }

    /// The least and the greatest distance of a piece from a plane, rounded.
    #[inline]
    pub(super) fn extent(&self, splitter: &K::Splitter, piece: usize) -> (f64, f64) {
        self.extent_of(splitter, &self.outlines[piece])
    }

    #[inline]
    fn extent_of(&self, splitter: &K::Splitter, outline: &Outline) -> (f64, f64) {
        let (low, high) = extent::<K>(splitter, NONE, outline.first.iter().copied());
        let (start, end) = outline.more;
        if start == end {
            return (low, high);
        }
        let more = self.more[start as usize..end as usize].iter();
        extent::<K>(splitter, (low, high), more.copied())
    }
}

/// The extent of no points.
const NONE: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

/// Whether points lie in front of a plane, and behind it, by rounded distances: what is decided so
/// is only which plane is taken.
#[inline]
pub(super) fn reach<K: Kernel>(
    splitter: &K::Splitter,
    points: impl Iterator<Item = [f64; 3]>,
) -> (bool, bool) {
    reach_of::<K>(splitter, extent::<K>(splitter, NONE, points))
}

#[inline]
fn reach_of<K: Kernel>(splitter: &K::Splitter, (low, high): (f64, f64)) -> (bool, bool) {
    let slack = K::slack(splitter);
    (high > slack, low < -slack)
}

/// An extent with some more points.
#[inline]
fn extent<K: Kernel>(
    splitter: &K::Splitter,
    (mut low, mut high): (f64, f64),
    points: impl Iterator<Item = [f64; 3]>,
) -> (f64, f64) {
    for point in points {
        let s = K::distance(splitter, point);
        // Distances are finite: the simple comparisons are one instruction each.
        low = if s < low { s } else { low };
        high = if s > high { s } else { high };
    }
    (low, high)
}
