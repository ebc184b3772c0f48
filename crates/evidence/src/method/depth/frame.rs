//! The two buffers: a depth and a face for each pixel.

use std::ops::Range;

use super::rules::Comparison;
use binspace::raster::NONE;

/// A section of the picture: some of its rows, at all their columns.
#[derive(Debug)]
pub(super) struct Frame {
    width: u32,
    /// The rows of the picture that are drawn; data for others are left out.
    rows: Range<u32>,
    comparison: Comparison,
    keys: Vec<u32>,
    faces: Vec<u32>,
    drawn: u64,
}

impl Frame {
    /// Creates an empty section, which reuses the memory of another section's depths.
    pub(super) fn new(
        width: u32,
        rows: Range<u32>,
        comparison: Comparison,
        mut keys: Vec<u32>,
    ) -> Self {
        let pixels = width as usize * rows.len();
        keys.clear();
        keys.resize(pixels, comparison.cleared);
        Self { width, rows, comparison, keys, faces: vec![NONE; pixels], drawn: 0 }
    }

    /// The picture's width, and the rows that are drawn.
    pub(super) fn width(&self) -> u32 {
        self.width
    }

    /// The rows of the picture that are drawn.
    pub(super) fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// The face in each pixel up to now.
    pub(super) fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// The pixels of a run, if they are in this section.
    fn pixels(&self, y: u32, columns: &Range<u32>) -> Option<Range<usize>> {
        let row = self.rows.contains(&y).then(|| y - self.rows.start)?;
        let start = row as usize * self.width as usize;
        Some(start + columns.start as usize..start + columns.end as usize)
    }

    /// Shows a face in each pixel of a run where it passes the test. The key `None` skips a pixel.
    #[inline]
    pub(super) fn put(
        &mut self,
        y: u32,
        columns: Range<u32>,
        face: u32,
        mut key_at: impl FnMut(u32) -> Option<u32>,
    ) {
        let Some(pixels) = self.pixels(y, &columns) else { return };
        let comparison = self.comparison;
        let keys = self.keys[pixels.clone()].iter_mut();
        for ((x, stored), shown) in columns.zip(keys).zip(&mut self.faces[pixels]) {
            let Some(key) = key_at(x) else { continue };
            self.drawn += 1;
            let key = comparison.stored(key);
            if comparison.passes(key, *stored) || comparison.is_open && *shown == NONE {
                *shown = face;
                if comparison.writes {
                    *stored = key;
                }
            }
        }
    }

    /// Calls `visit` with the columns of a run whose depths pass the test; their depths are kept if
    /// `writes`.
    pub(super) fn test(
        &mut self,
        y: u32,
        columns: Range<u32>,
        writes: bool,
        mut key_at: impl FnMut(u32) -> Option<u32>,
        mut visit: impl FnMut(u32),
    ) {
        let Some(pixels) = self.pixels(y, &columns) else { return };
        for (x, i) in columns.zip(pixels) {
            let Some(key) = key_at(x) else { continue };
            let key = self.comparison.stored(key);
            let is_open = self.comparison.is_open && self.faces[i] == NONE;
            if self.comparison.passes(key, self.keys[i]) || is_open {
                visit(x);
                if writes {
                    self.keys[i] = key;
                }
            }
        }
    }

    /// The faces, the number of drawn pixels, and the memory of the depths.
    pub(super) fn finish(self) -> (Vec<u32>, u64, Vec<u32>) {
        (self.faces, self.drawn, self.keys)
    }
}
