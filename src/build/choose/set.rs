//! The pieces of a set, with what they are pieces of.

use glam::{DVec3, Vec3};

use crate::build::live::Live;
use crate::exact::{Faces, Kernel, PlaneId, Side, Vertex};
use crate::parallel_map;

/// Normals that one thread computes at a time. More: threads idle; fewer: time to hand them out.
const PART: usize = 4096;

/// The unit normals of all faces, rounded: enough to choose planes by.
#[derive(Debug, Default)]
pub(crate) struct Normals(Vec<Vec3>);

impl Normals {
    pub(crate) fn of(faces: &Faces) -> Self {
        let mut normals = Self::default();
        normals.fill(faces);
        normals
    }

    /// Replaces the normals by those of other faces.
    pub(crate) fn fill(&mut self, faces: &Faces) {
        self.fill_from(faces, 0);
    }

    /// Replaces the normals of the faces from number `first` on.
    pub(crate) fn fill_from(&mut self, faces: &Faces, first: usize) {
        let normal = |face| faces.plane(PlaneId::face(face)).normal_f64().normalize().as_vec3();
        let n = faces.len();
        self.0.truncate(first);
        if n - first <= PART {
            self.0.extend((first as u32..n as u32).map(normal));
            return;
        }
        let parts = (first..n).step_by(PART).map(|start| start as u32..n.min(start + PART) as u32);
        let parts = parallel_map::map(parts.collect(), |part| part.map(normal).collect::<Vec<_>>());
        if first == 0 {
            self.0 = parts.concat();
        } else {
            parts.iter().for_each(|part| self.0.extend_from_slice(part));
        }
    }
}

/// A set of pieces that is to be divided: at least one.
#[derive(Debug)]
pub(crate) struct Set<'a, K: Kernel> {
    kernel: &'a K,
    pub(super) faces: &'a Faces,
    normals: &'a Normals,
    pub(super) pieces: &'a [Live],
    /// Holds the vertices of those pieces that are not whole faces.
    arena: &'a [K::Vertex],
    /// The bounding box of the pieces.
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
    /// Along each axis, where the first piece ends, and where the last one begins.
    first_end: [f64; 3],
    last_begin: [f64; 3],
}

impl<'a, K: Kernel> Set<'a, K> {
    pub(crate) fn new(
        kernel: &'a K,
        faces: &'a Faces,
        normals: &'a Normals,
        pieces: &'a [Live],
        arena: &'a [K::Vertex],
    ) -> Self {
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
        Self { kernel, faces, normals, pieces, arena, min, max, first_end, last_begin }
    }

    pub(super) fn len(&self) -> usize {
        self.pieces.len()
    }

    /// The size of the bounding box.
    pub(super) fn size(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.max[axis] - self.min[axis])
    }

    /// Whether a plane perpendicular to an axis may cut nothing and yet leave pieces on both sides.
    pub(super) fn may_part(&self, axis: usize) -> bool {
        self.first_end[axis] <= self.last_begin[axis] + self.faces.tolerance()
    }

    /// The plane of a piece's face: its unit normal, rounded, and a point on it. That is a vertex of
    /// the piece: of one far away, the rounding of the normal would count. (Of a whole face, only
    /// three corners are certain to lie on it, others within the tolerance.)
    #[inline]
    pub(super) fn rounded_plane(&self, piece: usize) -> (Vec3, DVec3) {
        let live = &self.pieces[piece];
        let point = match live.piece(self.arena).cut {
            None => self.faces.corner(self.faces.reference_triangle(live.face)[0]),
            Some(cut) => cut[0].position(),
        };
        (self.normals.0[live.face as usize], DVec3::from_array(point))
    }

    /// The plane of a piece's face.
    pub(super) fn own_plane(&self, piece: usize) -> PlaneId {
        PlaneId::face(self.pieces[piece].face)
    }

    pub(super) fn splitter(&self, plane: PlaneId) -> K::Splitter {
        self.kernel.splitter(self.faces, plane)
    }

    /// Where a piece lies against a plane, by the kernel.
    pub(super) fn classify(&self, splitter: &K::Splitter, piece: usize) -> Side {
        self.kernel.classify(self.faces, splitter, self.pieces[piece].piece(self.arena))
    }

    /// Calls a function with each vertex of a piece, in lattice units, rounded.
    #[inline]
    pub(super) fn for_each_vertex(&self, piece: usize, mut see: impl FnMut([f64; 3])) {
        let live = &self.pieces[piece];
        match live.piece(self.arena).cut {
            None => self.faces.corners(live.face).iter().for_each(|&corner| see(corner)),
            Some(cut) => cut.iter().for_each(|vertex| see(vertex.position())),
        }
    }

    pub(super) fn vertices(&self, piece: usize) -> usize {
        let live = &self.pieces[piece];
        match live.piece(self.arena).cut {
            None => self.faces.corners(live.face).len(),
            Some(cut) => cut.len(),
        }
    }

    /// `count` of the pieces, spread evenly; all of them if there are not more.
    pub(super) fn sample(&self, count: usize) -> impl Iterator<Item = usize> + use<K> {
        let n = self.len();
        let count = count.min(n);
        (0..count).map(move |i| i * n / count)
    }
}
