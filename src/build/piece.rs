//! Pieces of faces while the tree is built, and the cutting of a piece in two.

use glam::DVec3;
use smallvec::SmallVec;

use crate::Error;
use crate::exact::{Faces, Outline, PreparedPlane, Side, Vertex, VertexKind, split};
use crate::memory::{push, reserve};

/// Moves the vertices of pieces together, without those between them, from `base` on in an arena. Their order stays.
/// `lens` are lengths of the arena, in ascending order, that become the lengths with the same pieces.
pub(super) fn compact<'p>(
    arena: &mut Vec<Vertex>,
    base: usize,
    pieces: impl Iterator<Item = &'p mut Piece>,
    lens: impl Iterator<Item = &'p mut usize>,
) -> Result<(), Error> {
    let mut moved = Vec::new();
    let (least, _) = pieces.size_hint();
    reserve(&mut moved, least)?;
    for piece in pieces.filter(|piece| piece.len > 0 && piece.start as usize >= base) {
        push(&mut moved, piece)?;
    }
    moved.sort_unstable_by_key(|piece| piece.start);
    let (mut end, mut lens) = (base, lens.skip_while(|len| **len <= base).peekable());
    for piece in moved {
        let start = piece.start as usize;
        while let Some(len) = lens.next_if(|len| **len <= start) {
            *len = end;
        }
        arena.copy_within(start..start + piece.cut_len(), end);
        piece.start = end as u32;
        end += piece.cut_len();
    }
    lens.for_each(|len| *len = end);
    arena.truncate(end);
    Ok(())
}

/// A piece of a face, before it is stored in a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// The bounding box in lattice units, from rounded vertices.
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
    pub(crate) face: u32,
    /// The index of the piece's first vertex in the arena, and the number of the piece's vertices. Both
    /// numbers are 0 for a whole face.
    start: u32,
    len: u32,
    /// The number of times the piece was cut, at most 255.
    pub(crate) cuts: u8,
    /// The sides of the box that contain a corner of the face: bits 0–2 for the minima along x, y and z, bits
    /// 3–5 for the maxima.
    on_corner: u8,
}

impl Piece {
    /// A whole face.
    pub(crate) fn whole(faces: &Faces, face: u32) -> Self {
        let mut piece = Self::empty(face, 0, 0);
        for &corner in faces.corners(face) {
            piece.include(corner);
        }
        piece.on_corner = 0b11_1111;
        piece
    }

    /// A part of a piece that was cut. `vertices` are the part's vertices, and `start` is the index of the
    /// first vertex in the arena.
    pub(crate) fn part(whole: &Self, vertices: &[Vertex], start: usize) -> Self {
        let mut piece = Self::empty(whole.face, start as u32, vertices.len() as u32);
        piece.cuts = whole.cuts.saturating_add(1);
        for vertex in vertices {
            piece.include(vertex.position());
        }
        for vertex in vertices {
            if let VertexKind::Corner(_) = vertex.vertex_id().kind() {
                let p = vertex.position();
                for (axis, &c) in p.iter().enumerate() {
                    piece.on_corner |= u8::from(c == piece.min[axis]) << axis;
                    piece.on_corner |= u8::from(c == piece.max[axis]) << (axis + 3);
                }
            }
        }
        piece
    }

    /// The painting order of pieces on one plane: the order of their faces. (Pieces of one face do not
    /// overlap, so their order does not matter. Such pieces are sorted by the index of their first vertex, so
    /// that an unstable sort, which needs no memory, has only one result.)
    #[inline]
    pub(crate) fn rank(&self) -> (u32, u32) {
        (self.face, self.start)
    }

    /// A segment or a point. `vertices` are the vertices, and `start` is the index of the first vertex in the
    /// arena.
    pub(crate) fn thin(face: u32, vertices: &[Vertex], start: usize) -> Self {
        let mut piece = Self::empty(face, start as u32, vertices.len() as u32);
        vertices.iter().for_each(|vertex| piece.include(vertex.position()));
        piece
    }

    fn empty(face: u32, start: u32, len: u32) -> Self {
        let (min, max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        Self { min, max, face, start, len, cuts: 0, on_corner: 0 }
    }

    fn include(&mut self, p: [f64; 3]) {
        for (axis, &c) in p.iter().enumerate() {
            // Not `min` and `max`, which take more instructions because of NaN.
            self.min[axis] = if c < self.min[axis] { c } else { self.min[axis] };
            self.max[axis] = if c > self.max[axis] { c } else { self.max[axis] };
        }
    }

    /// Whether the piece's box comes within a distance of another piece's box.
    pub(crate) fn touches(&self, other: &Self, distance: f64) -> bool {
        (0..3).all(|axis| {
            other.min[axis] <= self.max[axis] + distance
                && self.min[axis] <= other.max[axis] + distance
        })
    }

    /// The number of the piece's vertices in the arena.
    pub(crate) fn cut_len(&self) -> usize {
        self.len as usize
    }

    /// The piece's vertices in the arena; `None` if it was never cut.
    #[inline]
    pub(crate) fn cut_vertices<'a>(&self, arena: &'a [Vertex]) -> Option<&'a [Vertex]> {
        let start = self.start as usize;
        (self.len > 0).then(|| &arena[start..start + self.len as usize])
    }

    /// The side of a plane on which the piece lies.
    #[inline]
    pub(crate) fn side(&self, faces: &Faces, plane: &PreparedPlane, arena: &[Vertex]) -> Side {
        plane.classify(faces, self.face, self.cut_vertices(arena))
    }

    /// The same side, and whether the piece may come within twice the tolerance of the plane. Looks at the box first.
    #[inline]
    pub(crate) fn side_and_reach(
        &self,
        faces: &Faces,
        plane: &PreparedPlane,
        arena: &[Vertex],
    ) -> (Side, bool) {
        match plane.side_of_box([self.min, self.max]) {
            Some(side) => (side, false),
            None => plane.classify_and_reach(faces, self.face, self.cut_vertices(arena)),
        }
    }

    /// The side of a plane on which the piece lies, as if the tolerance were 0.
    pub(crate) fn exact_side(
        &self,
        faces: &Faces,
        plane: &PreparedPlane,
        arena: &[Vertex],
    ) -> Side {
        match self.cut_vertices(arena) {
            Some(cut) => plane.exact_side(faces, self.face, cut),
            None => {
                let corners: SmallVec<[Vertex; 4]> = Vertex::corners(faces, self.face).collect();
                plane.exact_side(faces, self.face, &corners)
            }
        }
    }

    /// The rounded vertices.
    pub(crate) fn outline(&self, faces: &Faces, arena: &[Vertex]) -> Outline {
        let mut outline = Outline::new();
        self.for_each_vertex(faces, arena, |p| outline.push(p));
        outline
    }

    /// Calls a function with the rounded position of each vertex, in lattice units.
    #[inline]
    pub(crate) fn for_each_vertex(
        &self,
        faces: &Faces,
        arena: &[Vertex],
        mut see: impl FnMut([f64; 3]),
    ) {
        match self.cut_vertices(arena) {
            None => faces.corners(self.face).iter().for_each(|&corner| see(corner)),
            Some(cut) => cut.iter().for_each(|vertex| see(vertex.position())),
        }
    }

    /// A point on the plane of the piece's face: a vertex of the piece, because at a distant point the
    /// rounding of the normal would matter.
    pub(crate) fn point(&self, faces: &Faces, arena: &[Vertex]) -> DVec3 {
        DVec3::from_array(match self.cut_vertices(arena) {
            // On the plane, or within half a step of it.
            None => faces.corners(self.face)[0],
            Some(cut) => cut[0].position(),
        })
    }

    /// The same piece, with its vertices copied from one arena to the end of another.
    pub(crate) fn copied(self, from: &[Vertex], to: &mut Vec<Vertex>) -> Self {
        let start = to.len() as u32;
        let vertices = self.cut_vertices(from).unwrap_or_default();
        to.extend_from_slice(vertices);
        Self { start, ..self }
    }

    /// Whether a corner of the face lies on the box's lower side along an axis.
    #[inline]
    pub(crate) fn min_is_corner(&self, axis: usize) -> bool {
        self.on_corner >> axis & 1 != 0
    }

    /// Whether a corner of the face lies on the box's upper side along an axis.
    #[inline]
    pub(crate) fn max_is_corner(&self, axis: usize) -> bool {
        self.on_corner >> (axis + 3) & 1 != 0
    }

    /// The number, over all faces, of a corner of the face that has a coordinate from `low` to `high` along
    /// an axis.
    pub(crate) fn corner_within(
        &self,
        faces: &Faces,
        axis: usize,
        [low, high]: [f64; 2],
    ) -> Option<u32> {
        let within = |corner: &usize| (low..=high).contains(&faces.corner(*corner as u32)[axis]);
        faces.corner_range(self.face).find(within).map(|corner| corner as u32)
    }

    /// The number, over all faces, of a corner of the face that has the given coordinate along an axis.
    pub(crate) fn corner_at(&self, faces: &Faces, axis: usize, coordinate: f64) -> Option<u32> {
        let mut range = faces.corner_range(self.face);
        range.find(|&corner| faces.corner(corner as u32)[axis] == coordinate).map(|c| c as u32)
    }
}

/// A plane, and the side of the plane on which each piece of a set lies.
#[derive(Debug, Default)]
pub(crate) struct Division {
    /// The plane; `None` if the pieces are not classified yet.
    pub(crate) plane: Option<PreparedPlane>,
    /// The side of each piece.
    pub(crate) sides: Vec<Side>,
    /// The pieces that may come within twice the tolerance of the plane, except those on it.
    pub(crate) near: Vec<u32>,
    /// The number of pieces on each side, indexed by [`Side`].
    counts: [usize; 4],
}

impl Division {
    /// Classifies the pieces against a plane. Stops early and returns false if the plane cuts more than
    /// `most` pieces.
    pub(crate) fn classify(
        &mut self,
        faces: &Faces,
        (pieces, arena): (&[Piece], &[Vertex]),
        plane: PreparedPlane,
        most: usize,
    ) -> bool {
        (self.plane, self.counts) = (Some(plane), [0; 4]);
        self.sides.clear();
        self.sides.reserve_exact(pieces.len());
        self.near.clear();
        for (piece, number) in pieces.iter().zip(0..) {
            let (side, is_near) = piece.side_and_reach(faces, &plane, arena);
            self.counts[side as usize] += 1;
            self.sides.push(side);
            if is_near && side != Side::Coplanar {
                self.near.push(number);
            }
            if side == Side::Spanning && self.count(side) > most {
                return false;
            }
        }
        true
    }

    /// The number of pieces on a side.
    pub(crate) fn count(&self, side: Side) -> usize {
        self.counts[side as usize]
    }

    /// Whether both sides of the plane have fewer pieces than the set.
    pub(crate) fn makes_progress(&self) -> bool {
        let [front, back, own, _] = self.counts;
        back + own > 0 && front + own > 0
    }
}

/// Lists that are reused for every cut.
#[derive(Debug, Default)]
pub(crate) struct Splitter {
    outline: Vec<Vertex>,
    front: Vec<Vertex>,
    back: Vec<Vertex>,
}

impl Splitter {
    /// Cuts a piece that spans a plane. Appends the vertices of the two parts to the arena, and returns the
    /// part in front and the part behind.
    pub(crate) fn cut(
        &mut self,
        faces: &Faces,
        plane: &PreparedPlane,
        piece: &Piece,
        arena: &mut Vec<Vertex>,
    ) -> Result<[Piece; 2], Error> {
        let Self { outline, front, back } = self;
        let vertices = piece.cut_vertices(arena).unwrap_or_else(|| {
            outline.clear();
            outline.extend(Vertex::corners(faces, piece.face));
            outline
        });
        front.clear();
        back.clear();
        split(faces, plane, piece.face, vertices, front, back);
        // The piece's own vertices stay behind as garbage until the arena is compacted or truncated.
        let start = arena.len();
        reserve(arena, front.len() + back.len())?;
        arena.extend_from_slice(front);
        arena.extend_from_slice(back);
        let front_part = Piece::part(piece, front, start);
        Ok([front_part, Piece::part(piece, back, start + front.len())])
    }
}

#[cfg(test)]
mod tests {
    use super::{Piece, compact};
    use crate::exact::{Faces, Vertex};
    use crate::random::SplitMix64;

    /// Random pieces of an arena keep their vertices, and each length of the arena still ends after the same pieces.
    #[test]
    fn compacting_keeps_the_vertices_and_the_order_of_pieces() {
        let triangles: Vec<_> = (0..300)
            .map(|i| [[f64::from(i), 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
            .collect();
        let faces = Faces::new(&triangles, None).unwrap().0;
        let mut random = SplitMix64::new(3);
        let mut removed = 0;
        for base in [0, 60, 300] {
            let mut arena: Vec<Vertex> =
                (0..300).flat_map(|face| Vertex::corners(&faces, face)).collect();
            let all: Vec<Piece> = (0..300)
                .map(|face| Piece::thin(face, &arena[3 * face as usize..][..3], 3 * face as usize))
                .collect();
            let is_kept = all.iter().map(|_| random.next() >> 62 > 0);
            let (mut pieces, ends): (Vec<Piece>, Vec<usize>) = all
                .iter()
                .zip(is_kept)
                .filter(|&(piece, is_kept)| is_kept || (piece.start as usize) < base)
                .map(|(piece, _)| (*piece, piece.start as usize + 3))
                .unzip();
            // Lengths between which are no pieces, some, and many.
            let mut lens: Vec<usize> = [0, base, base + 3, 450, 453, 900].into();
            lens.sort_unstable();
            let within: Vec<_> =
                lens.iter().map(|len| ends.iter().filter(|end| *end <= len).count()).collect();
            let before = arena.len();
            pieces.reverse();
            compact(&mut arena, base, pieces.iter_mut(), lens.iter_mut()).unwrap();
            pieces.reverse();
            removed += before - arena.len();
            for piece in &pieces {
                let expected: Vec<_> =
                    Vertex::corners(&faces, piece.face).map(|v| v.position()).collect();
                let found = piece.cut_vertices(&arena).unwrap().iter().map(|v| v.position());
                assert!(found.eq(expected), "{}", piece.face);
            }
            assert!(pieces.is_sorted_by_key(|piece| piece.start));
            let ends: Vec<_> = pieces.iter().map(|piece| piece.start as usize + 3).collect();
            let after: Vec<_> =
                lens.iter().map(|len| ends.iter().filter(|end| *end <= len).count()).collect();
            assert_eq!(within, after, "{lens:?}");
            assert_eq!(arena.len(), *ends.iter().max().unwrap());
        }
        assert!(removed > 300, "{removed}");
    }
}
