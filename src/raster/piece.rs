//! What is drawn: a face, or a part of it.

use crate::exact::Line;

/// A piece of a face, to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// The face.
    pub face: u32,
    /// Which part of it.
    pub outline: Outline<'a>,
}

/// Which part of a face a piece is.
#[derive(Clone, Copy, Debug)]
pub enum Outline<'a> {
    /// All of it.
    Whole,
    /// What lies on the right side of each of these lines: exact, however small the piece.
    Lines {
        /// The lines that bound the piece: edges of the face, and cuts.
        lines: &'a [Line],
        /// The piece's vertices in lattice units, each coordinate within 2 of the exact one. They
        /// only say which pixels to look at.
        vertices: &'a [[f64; 3]],
    },
    /// What lies between these vertices, in lattice units, in the face's orientation, rounded to
    /// the lattice: for algorithms that do not keep the lines.
    Vertices(&'a [[f64; 3]]),
}
