//! Fragments as pieces to paint.

use binspace::Fragment;
use binspace::internals::Line;
use binspace::raster::{Outline, Piece};

/// The outline of a fragment, in memory that the next one uses again.
#[derive(Debug, Default)]
pub(crate) struct Pieces {
    lines: Vec<Line>,
    vertices: Vec<[f64; 3]>,
}

impl Pieces {
    /// A fragment as a piece that is bounded by its exact lines.
    pub(crate) fn of(&mut self, fragment: &Fragment<'_>) -> Piece<'_> {
        let face = fragment.face();
        if fragment.is_whole() {
            return Piece { face, outline: Outline::Whole };
        }
        let Self { lines, vertices } = self;
        lines.clear();
        lines.extend(fragment.lines());
        vertices.clear();
        vertices.extend(fragment.lattice_vertices());
        Piece { face, outline: Outline::Lines { lines, vertices } }
    }
}
