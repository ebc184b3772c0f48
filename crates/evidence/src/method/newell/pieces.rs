//! Pieces of faces as a camera sees them.

use glam::DVec3;

use super::super::clip::{Clipper, Range};
use super::super::space::{CameraSpace, Vertex};
use binspace::internals::Faces;

/// A plane in the camera's coordinates, with a unit normal that points to the eye's side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EyePlane {
    normal: DVec3,
    offset: f64,
}

impl EyePlane {
    /// The plane of a face. If the plane contains the eye, the normal may point to either side.
    fn of(space: &CameraSpace, faces: &Faces, face: u32) -> Self {
        let [p, q, r] = faces.reference_triangle(face).map(|c| DVec3::from(faces.corner(c)));
        // Differences of lattice points are exact.
        let cross = space.turn((q - p).cross(r - p));
        let normal = cross.normalize_or_zero();
        let offset = normal.dot(space.place(p.to_array()));
        let eye = if space.perspective { -offset } else { -normal.z };
        if eye < 0.0 { Self { normal: -normal, offset: -offset } } else { Self { normal, offset } }
    }

    /// The distance of a place from the plane: positive on the eye's side, negative behind the plane.
    #[inline]
    pub(super) fn distance(&self, at: DVec3) -> f64 {
        self.normal.dot(at) - self.offset
    }
}

/// The extents of a piece, and the place of its vertices in the lists.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) face: u32,
    start: u32,
    len: u32,
    /// Whether the piece is the whole visible part of its face.
    whole: bool,
    pub(super) near: f64,
    pub(super) far: f64,
    /// On the picture, in pixels.
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

/// All pieces, including pieces that were cut up.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    pieces: Vec<Piece>,
    vertices: Vec<Vertex>,
    /// The positions of the vertices on the picture, in pixels.
    flat: Vec<[f64; 2]>,
    /// By face.
    planes: Vec<EyePlane>,
}

impl Pieces {
    /// Replaces all pieces by the parts of the given faces that a camera sees.
    pub(super) fn take(
        &mut self,
        space: &CameraSpace,
        faces: &Faces,
        is_shown: impl Fn(u32) -> bool,
    ) {
        self.clear();
        let Some(range) = Range::ahead(space, faces) else { return };
        let mut clipper = Clipper::new(space, range);
        for face in 0..faces.len() as u32 {
            let outline = if is_shown(face) { clipper.clip_face(space, faces, face) } else { &[] };
            self.add_face(space, faces, face, outline);
        }
    }

    fn clear(&mut self) {
        self.pieces.clear();
        self.vertices.clear();
        self.flat.clear();
        self.planes.clear();
    }

    /// Adds the visible part of the next face, if there is any.
    fn add_face(&mut self, space: &CameraSpace, faces: &Faces, face: u32, outline: &[Vertex]) {
        if outline.is_empty() {
            self.planes.push(EyePlane::default());
        } else {
            self.planes.push(EyePlane::of(space, faces, face));
            self.add(space, face, outline, true);
        }
    }

    /// Adds a piece of a face, and returns its number.
    pub(super) fn add(
        &mut self,
        space: &CameraSpace,
        face: u32,
        outline: &[Vertex],
        whole: bool,
    ) -> u32 {
        let (start, len) = (self.vertices.len() as u32, outline.len() as u32);
        let (mut near, mut far) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for vertex in outline {
            let position = space.project(vertex.at);
            near = near.min(vertex.at.z);
            far = far.max(vertex.at.z);
            for axis in 0..2 {
                low[axis] = low[axis].min(position[axis]);
                high[axis] = high[axis].max(position[axis]);
            }
            self.vertices.push(*vertex);
            self.flat.push(position);
        }
        self.pieces.push(Piece { face, start, len, whole, near, far, low, high });
        self.pieces.len() as u32 - 1
    }

    pub(super) fn len(&self) -> usize {
        self.pieces.len()
    }

    #[inline]
    pub(super) fn get(&self, piece: u32) -> &Piece {
        &self.pieces[piece as usize]
    }

    #[inline]
    pub(super) fn vertices(&self, piece: u32) -> &[Vertex] {
        let Piece { start, len, .. } = self.pieces[piece as usize];
        &self.vertices[start as usize..][..len as usize]
    }

    #[inline]
    pub(super) fn flat(&self, piece: u32) -> &[[f64; 2]] {
        let Piece { start, len, .. } = self.pieces[piece as usize];
        &self.flat[start as usize..][..len as usize]
    }

    /// The plane of a piece's face.
    #[inline]
    pub(super) fn plane(&self, piece: u32) -> &EyePlane {
        &self.planes[self.pieces[piece as usize].face as usize]
    }

    /// The face of a piece, and whether the piece is the whole visible part of this face.
    pub(super) fn source(&self, piece: u32) -> (u32, bool) {
        let piece = self.get(piece);
        (piece.face, piece.whole)
    }

    pub(super) fn bytes(&self) -> usize {
        self.pieces.capacity() * size_of::<Piece>()
            + self.vertices.capacity() * size_of::<Vertex>()
            + self.flat.capacity() * size_of::<[f64; 2]>()
            + self.planes.capacity() * size_of::<EyePlane>()
    }
}
