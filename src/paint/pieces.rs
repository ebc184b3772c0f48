//! Fragments as pieces to paint.

use crate::exact::Line;
use crate::raster::{Outline, Piece};
use crate::tree::Fragment;

/// A fragment's outline, in memory that the next one uses again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Buffers {
    lines: Vec<Line>,
    vertices: Vec<[f64; 3]>,
}

impl Buffers {
    pub(crate) fn piece(&mut self, fragment: &Fragment<'_>) -> Piece<'_> {
        let face = fragment.face();
        if fragment.is_whole() {
            return Piece { face, outline: Outline::Whole };
        }
        self.vertices.clear();
        self.vertices.extend(fragment.lattice_vertices());
        let vertices = &self.vertices[..];
        self.lines.clear();
        self.lines.extend(fragment.lines());
        Piece { face, outline: Outline::Lines { lines: &self.lines, vertices } }
    }
}
