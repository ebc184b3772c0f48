//! The exact kernel: a certified floating-point filter, and integers where it cannot tell.

use std::cmp::Ordering;

use super::filter::{ExactSplitter, ExactVertex, compare};
use super::kernel::{Kernel, Piece, Side};
use super::label::{Line, PlaneId, PlaneKind, Symbol};
use super::plane::Plane;
use super::{Eye, Faces, tolerance};

/// Decides exactly, at about the price of an epsilon.
///
/// These rules classify a piece against a plane (file `tolerance`). τ is the coplanar tolerance,
/// and *corners* are those of the uncut face:
///
/// - if no corner is further than τ from the plane, the piece is coplanar;
/// - if corners are further than τ in front, but none behind, the piece is in front, and likewise
///   behind: it is not cut for less than τ;
/// - otherwise the exact signs of the piece's own vertices decide, and it is cut where they differ.
///
/// With τ = 0 every decision is that of real arithmetic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

/// A vertex by its definition alone. It stores no position: each use computes it again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExactStored {
    symbol: Symbol,
    line: Line,
}

#[cfg(feature = "save")]
impl ExactStored {
    /// A vertex as a file names it, which may be any.
    pub(crate) fn new(symbol: Symbol, line: Line) -> Self {
        Self { symbol, line }
    }
}

impl Kernel for Exact {
    type Splitter = ExactSplitter;
    type Vertex = ExactVertex;
    type Stored = ExactStored;

    fn splitter(&self, faces: &Faces, plane: PlaneId) -> ExactSplitter {
        ExactSplitter::new(faces, plane)
    }

    #[inline]
    fn plane(splitter: &ExactSplitter) -> PlaneId {
        splitter.plane
    }

    fn corner(&self, faces: &Faces, face: u32, k: u32) -> ExactVertex {
        let symbol = Symbol::corner(k);
        ExactVertex { position: faces.position(face, symbol), symbol, line: Line::edge(k) }
    }

    #[inline]
    fn classify(
        &self,
        faces: &Faces,
        splitter: &ExactSplitter,
        piece: Piece<'_, ExactVertex>,
    ) -> Side {
        tolerance::classify(faces, splitter, piece)
    }

    #[inline]
    fn side(
        &self,
        faces: &Faces,
        splitter: &ExactSplitter,
        face: u32,
        vertex: &ExactVertex,
    ) -> Ordering {
        compare(faces, splitter, face, vertex.symbol, vertex.position, 0.0)
    }

    fn cut(
        &self,
        faces: &Faces,
        splitter: &ExactSplitter,
        face: u32,
        [from, _]: [&ExactVertex; 2],
    ) -> ExactVertex {
        let symbol = Symbol::crossing(from.line, splitter.plane);
        ExactVertex { position: faces.position(face, symbol), symbol, line: from.line }
    }

    fn store(&self, vertex: &ExactVertex) -> ExactStored {
        ExactStored { symbol: vertex.symbol, line: vertex.line }
    }

    fn restore(&self, faces: &Faces, face: u32, stored: &ExactStored) -> ExactVertex {
        let ExactStored { symbol, line } = *stored;
        ExactVertex { position: faces.position(face, symbol), symbol, line }
    }

    fn symbol(stored: &ExactStored) -> Symbol {
        stored.symbol
    }

    fn line(stored: &ExactStored) -> Line {
        stored.line
    }

    fn eye_side(&self, faces: &Faces, plane: PlaneId, eye: &Eye) -> Ordering {
        match plane.kind() {
            PlaneKind::Axis(axis, corner) => Plane::axis_at_eye(axis, faces.corner(corner), eye),
            PlaneKind::Face(_) => faces.plane(plane).at_eye(eye),
        }
    }
}
