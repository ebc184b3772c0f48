//! How vertices are decided against planes: the one trait that the builder is written against.

use std::cmp::Ordering;
use std::fmt::Debug;

use super::{Eye, Faces, Line, PlaneId, Symbol};

/// Where a piece of a face lies against a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Nothing of it is behind the plane.
    Front,
    /// Nothing of it is in front of the plane.
    Back,
    /// All of it is on the plane.
    Coplanar,
    /// It has to be cut.
    Spanning,
}

/// A piece of a face: all of it, or what cuts left of it.
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
    /// What bounds the piece from this vertex to the next.
    fn line(&self) -> Line;
    /// The same vertex, with another line from it to the next.
    fn with_line(self, line: Line) -> Self;
}

/// A way to decide on which side of a plane vertices lie, and to make new ones.
///
/// The library's own is [`Exact`](super::Exact); [`Float`](super::Float) decides by rounded
/// distances and an epsilon, as other libraries do, and is there to be compared with.
pub trait Kernel: Copy + Debug + Default + Send + Sync + 'static {
    /// Whether every decision is the exact one, so that pieces are what the lines around them
    /// bound, not what their rounded vertices do.
    const IS_EXACT: bool = false;

    /// A plane made ready for many decisions.
    type Splitter: Copy + Debug + Send + Sync;
    /// A vertex while the tree is built.
    type Vertex: Vertex;
    /// A vertex in the finished tree.
    type Stored: Copy + Debug + PartialEq + Send + Sync;

    /// Makes a plane ready.
    fn splitter(&self, faces: &Faces, plane: PlaneId) -> Self::Splitter;

    /// The signed distance of a position from a plane in some unit of the plane's, rounded; in
    /// front it is positive.
    fn distance(splitter: &Self::Splitter, position: [f64; 3]) -> f64;

    /// How far off [`distance`](Self::distance) may be and the tolerance, together, in its unit:
    /// what is further than that from the plane certainly lies on one side of it.
    fn slack(splitter: &Self::Splitter) -> f64;

    /// Corner `k` of a face as a vertex.
    fn corner(&self, faces: &Faces, face: u32, k: u32) -> Self::Vertex;

    /// Where a piece lies against a plane.
    fn classify(
        &self,
        faces: &Faces,
        splitter: &Self::Splitter,
        piece: Piece<'_, Self::Vertex>,
    ) -> Side;

    /// On which side of a plane a vertex lies: what decides how a spanning piece is cut.
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

    /// What bounds the piece from a stored vertex to the next.
    fn line(stored: &Self::Stored) -> Line;

    /// On which side of a plane an eye lies.
    fn eye_side(&self, faces: &Faces, plane: PlaneId, eye: &Eye) -> Ordering;
}
