//! Pieces of faces while the tree is built.

use crate::geom::{Faces, Kernel, Piece, SymbolKind, Vertex};

/// A piece of a face on its way down the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Live {
    /// The bounding box in lattice units, from rounded vertices.
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
    pub(super) face: u32,
    /// The vertices in the arena; none for a whole face.
    start: u32,
    len: u32,
    /// How often it was cut, at most 255.
    pub(super) cuts: u8,
    /// Which sides of the box a corner of the face touches: bits 0–2 the minima, 3–5 the maxima.
    on_corner: u8,
}

impl Live {
    /// A whole face.
    pub(super) fn whole(faces: &Faces, face: u32) -> Self {
        let mut live = Self::empty(face, 0, 0);
        for &corner in faces.corners(face) {
            live.include(corner);
        }
        live.on_corner = 0b11_1111;
        live
    }

    /// A part of a piece, whose vertices begin at `start` in the arena and are its last.
    pub(super) fn cut<K: Kernel>(whole: &Self, arena: &[K::Vertex], start: usize) -> Self {
        let vertices = &arena[start..];
        let mut live = Self::empty(whole.face, start as u32, vertices.len() as u32);
        live.cuts = whole.cuts.saturating_add(1);
        for vertex in vertices {
            live.include(vertex.position());
        }
        for vertex in vertices {
            if let SymbolKind::Corner(_) = vertex.symbol().kind() {
                let p = vertex.position();
                for (axis, &c) in p.iter().enumerate() {
                    live.on_corner |= u8::from(c == live.min[axis]) << axis;
                    live.on_corner |= u8::from(c == live.max[axis]) << (axis + 3);
                }
            }
        }
        live
    }

    fn empty(face: u32, start: u32, len: u32) -> Self {
        let (min, max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        Self { min, max, face, start, len, cuts: 0, on_corner: 0 }
    }

    fn include(&mut self, p: [f64; 3]) {
        for (axis, &c) in p.iter().enumerate() {
            self.min[axis] = self.min[axis].min(c);
            self.max[axis] = self.max[axis].max(c);
        }
    }

    /// The piece with its vertices in the arena.
    #[inline]
    pub(super) fn piece<'a, V>(&self, arena: &'a [V]) -> Piece<'a, V> {
        let start = self.start as usize;
        let cut = (self.len > 0).then(|| &arena[start..start + self.len as usize]);
        Piece { face: self.face, cut }
    }

    /// The same piece with its vertices at another place of an arena.
    pub(super) fn moved_to(self, start: usize) -> Self {
        Self { start: start as u32, ..self }
    }

    /// Whether a corner of the face lies on the box's lower side along an axis.
    #[inline]
    pub(super) fn min_is_corner(&self, axis: usize) -> bool {
        self.on_corner >> axis & 1 != 0
    }

    /// Whether a corner of the face lies on the box's upper side along an axis.
    #[inline]
    pub(super) fn max_is_corner(&self, axis: usize) -> bool {
        self.on_corner >> (axis + 3) & 1 != 0
    }

    /// A corner of the face with the given coordinate, counted over all faces.
    pub(super) fn corner_at(&self, faces: &Faces, axis: usize, coordinate: f64) -> Option<u32> {
        let mut range = faces.corner_range(self.face);
        range.find(|&corner| faces.corner(corner as u32)[axis] == coordinate).map(|c| c as u32)
    }
}

/// The bounding box of some pieces.
pub(super) fn bounds(pieces: &[Live]) -> ([f64; 3], [f64; 3]) {
    let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for piece in pieces {
        for axis in 0..3 {
            min[axis] = min[axis].min(piece.min[axis]);
            max[axis] = max[axis].max(piece.max[axis]);
        }
    }
    (min, max)
}
