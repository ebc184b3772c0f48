//! The trait by which the builder decides on which side of a plane a vertex lies.

use std::cmp::Ordering;
use std::fmt::Debug;

use super::{Eye, Faces, Line, PlaneId, Symbol};

/// Where a piece of a face lies against a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// No part of it is behind the plane.
    Front,
    /// No part of it is in front of the plane.
    Back,
    /// All of it is on the plane.
    Coplanar,
    /// It has to be cut.
    Spanning,
}

/// A piece of a face: all of it, or the part that cuts have left.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a, V> {
    /// The face.
    pub face: u32,
    /// The vertices in order around the piece, in the face's orientation; `None` for the whole
    /// face.
    pub cut: Option<&'a [V]>,
}

/// A vertex of a piece.
pub trait Vertex: Copy + Debug + Send + Sync {
    /// Its position in lattice units, rounded.
    fn position(&self) -> [f64; 3];
    /// Its definition.
    fn symbol(&self) -> Symbol;
    /// The line that bounds the piece from this vertex to the next.
    fn line(&self) -> Line;
    /// The same vertex with another line to the next one.
    fn with_line(self, line: Line) -> Self;
}

/// A way to decide on which side of a plane vertices lie, and to make new ones.
///
/// The library's own is [`Exact`](super::Exact). Kernels that decide by rounded distances and an
/// epsilon are in `crates/evidence`, to be compared with it.
pub trait Kernel: Copy + Debug + Send + Sync + 'static {
    /// A plane prepared for many decisions.
    type Splitter: Copy + Debug + Send + Sync;
    /// A vertex while the tree is built.
    type Vertex: Vertex;
    /// A vertex in the finished tree.
    type Stored: Copy + Debug + PartialEq + Send + Sync;

    /// Prepares a plane.
    fn splitter(&self, faces: &Faces, plane: PlaneId) -> Self::Splitter;

    /// The plane of a splitter.
    fn plane(splitter: &Self::Splitter) -> PlaneId;

    /// Corner `k` of a face as a vertex.
    fn corner(&self, faces: &Faces, face: u32, k: u32) -> Self::Vertex;

    /// Where a piece lies against a plane.
    fn classify(
        &self,
        faces: &Faces,
        splitter: &Self::Splitter,
        piece: Piece<'_, Self::Vertex>,
    ) -> Side;

    /// On which side of a plane a vertex lies, to cut a spanning piece.
    fn side(
        &self,
        faces: &Faces,
        splitter: &Self::Splitter,
        face: u32,
        vertex: &Self::Vertex,
    ) -> Ordering;

    /// The vertex where a plane cuts the edge between two vertices on different sides of it.
    fn cut(
        &self,
        faces: &Faces,
        splitter: &Self::Splitter,
        face: u32,
        ends: [&Self::Vertex; 2],
    ) -> Self::Vertex;

    /// A vertex as the finished tree keeps it.
    fn store(&self, vertex: &Self::Vertex) -> Self::Stored;

    /// A stored vertex as it was while the tree was built.
    fn restore(&self, faces: &Faces, face: u32, stored: &Self::Stored) -> Self::Vertex;

    /// A stored vertex's definition.
    fn symbol(stored: &Self::Stored) -> Symbol;

    /// The line that bounds the piece from a stored vertex to the next.
    fn line(stored: &Self::Stored) -> Line;

    /// On which side of a plane an eye lies.
    fn eye_side(&self, faces: &Faces, plane: PlaneId, eye: &Eye) -> Ordering;
}
