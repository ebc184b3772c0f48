//! The pieces of a set, with what they are pieces of.

use glam::{DVec3, Vec3};

use super::crossing::crosses;
use crate::build::piece::Piece;
use crate::exact::{Faces, PlaneId, PreparedPlane, Side, Vertex};

/// A set of pieces that is to be divided: at least one.
#[derive(Debug)]
pub(crate) struct Set<'a> {
    pub(super) faces: &'a Faces,
    pub(super) pieces: &'a [Piece],
    arena: &'a [Vertex],
    /// The bounding box of the pieces.
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
    /// Along each axis, where the first piece ends, and where the last one begins.
    first_end: [f64; 3],
    last_begin: [f64; 3],
}

impl<'a> Set<'a> {
    pub(crate) fn new(faces: &'a Faces, pieces: &'a [Piece], arena: &'a [Vertex]) -> Self {
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut first_end, mut last_begin) = (min, max);
        // None is NaN: to compare takes fewer instructions than `f64::min`.
        let lower = |a: &mut f64, b: f64| *a = if b < *a { b } else { *a };
        let raise = |a: &mut f64, b: f64| *a = if b > *a { b } else { *a };
        for piece in pieces {
            for axis in 0..3 {
                lower(&mut min[axis], piece.min[axis]);
                raise(&mut max[axis], piece.max[axis]);
                lower(&mut first_end[axis], piece.max[axis]);
                raise(&mut last_begin[axis], piece.min[axis]);
            }
        }
        Self { faces, pieces, arena, min, max, first_end, last_begin }
    }

    pub(super) fn len(&self) -> usize {
        self.pieces.len()
    }

    /// The size of the bounding box.
    pub(super) fn size(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.max[axis] - self.min[axis])
    }

    /// The middle of the longest side of the bounding box, and the axis along which that is.
    pub(super) fn middle(&self) -> (usize, f64) {
        let size = self.size();
        let axis = (1..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
        (axis, 0.5 * self.min[axis] + 0.5 * self.max[axis])
    }

    /// Whether a plane perpendicular to an axis may cut nothing and yet leave pieces on both sides.
    pub(super) fn may_part(&self, axis: usize) -> bool {
        self.first_end[axis] <= self.last_begin[axis] + self.faces.tolerance()
    }

    /// The same as [`may_part`](Self::may_part), by a closer look: there is no such plane if every place for
    /// it is inside of a piece. Places are counted by bins, one a bit, which a piece covers if it reaches
    /// across. As long as the set is small, that takes less time than to sort it in vain.
    pub(super) fn may_have_gap(&self, axis: usize) -> bool {
        let tolerance = self.faces.tolerance();
        let (start, end) = (self.first_end[axis], self.last_begin[axis] + tolerance);
        if start >= end {
            return true;
        }
        let per_unit = f64::from(u64::BITS - 1) / (end - start);
        // Larger values are never in earlier bins, so a gap's bin stays free.
        let bin = |value: f64| ((value - start) * per_unit) as u32;
        let below = |bin| 1u64.checked_shl(bin).map_or(u64::MAX, |bit| bit - 1);
        let covered = self.pieces.iter().fold(0, |covered, piece| {
            let begin = piece.min[axis] + tolerance;
            let first = if begin < start { 0 } else { bin(begin).saturating_add(1) };
            covered | below(bin(piece.max[axis])) & !below(first)
        });
        covered != u64::MAX
    }

    /// The plane of a piece's face, rounded: its unit normal, and a point on it.
    #[inline]
    pub(super) fn rounded_plane(&self, piece: usize) -> (Vec3, DVec3) {
        let live = &self.pieces[piece];
        let normal = self.faces.normal(live.face).normalize().as_vec3();
        (normal, live.point(self.faces, self.arena))
    }

    /// Whether the plane of a piece cuts another, and the two certainly cross.
    pub(super) fn crosses(&self, piece: usize, other: usize) -> bool {
        self.classify(&self.prepare(self.own_plane(piece)), other) == Side::Spanning
            && crosses(self.faces, self.arena, &self.pieces[piece], &self.pieces[other])
    }

    /// The plane of a piece's face.
    pub(super) fn own_plane(&self, piece: usize) -> PlaneId {
        PlaneId::face(self.pieces[piece].face)
    }

    pub(super) fn prepare(&self, plane: PlaneId) -> PreparedPlane {
        PreparedPlane::new(self.faces, plane)
    }

    /// Where a piece lies against a plane, exactly.
    pub(super) fn classify(&self, prepared: &PreparedPlane, piece: usize) -> Side {
        self.pieces[piece].side(self.faces, prepared, self.arena)
    }

    /// Calls a function with each vertex of a piece, in lattice units, rounded.
    #[inline]
    pub(super) fn for_each_vertex(&self, piece: usize, see: impl FnMut([f64; 3])) {
        self.pieces[piece].for_each_vertex(self.faces, self.arena, see);
    }

    pub(super) fn vertices(&self, piece: usize) -> usize {
        let cut = self.pieces[piece].cut_vertices(self.arena);
        cut.map_or_else(|| self.faces.corners(self.pieces[piece].face).len(), <[_]>::len)
    }

    /// `count` of the pieces, spread evenly; all of them if there are not more.
    pub(super) fn sample(&self, count: usize) -> impl Iterator<Item = usize> + use<> {
        let n = self.len();
        let count = count.min(n);
        (0..count).map(move |i| i * n / count)
    }
}
