//! Which cells of a picture are covered.

use std::ops::Range;

use super::bounds::Window;
use super::coverage::{Coverage, Piece};
use super::rays::Rays;
use crate::exact::Faces;

/// Bits in a word.
const WORD: u32 = u64::BITS;

/// A bit for each cell of a picture: a square of pixels.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    size: [u32; 2],
    /// The side of a cell in pixels.
    cell: u32,
    /// Words of a row of cells.
    words: usize,
    bits: Vec<u64>,
    /// How many cells are not covered, in each row.
    open: Vec<u32>,
    /// The rows of which some cell is open.
    open_rows: usize,
    /// Working space: of a row of cells, in how many rows of pixels each was covered so far.
    rows_covered: Vec<u32>,
}

impl Mask {
    pub(crate) fn new(size: [u32; 2], cell: u32) -> Self {
        let [columns, rows] = size.map(|side| side.div_ceil(cell));
        let words = columns.div_ceil(WORD) as usize;
        Self {
            size,
            cell,
            words,
            bits: vec![0; words * rows as usize],
            open: vec![columns; rows as usize],
            open_rows: if columns > 0 { rows as usize } else { 0 },
            rows_covered: vec![0; columns as usize],
        }
    }

    pub(crate) fn is_full(&self) -> bool {
        self.open_rows == 0
    }

    /// Whether all pixels that the convex hull of some points may cover are covered.
    pub(crate) fn hides(&self, rays: &Rays, points: &[[f64; 3]]) -> bool {
        let Some(Window { columns, rows }) = rays.window(points) else { return true };
        if self.is_full() {
            return true;
        }
        let columns = columns.start / self.cell..columns.end.div_ceil(self.cell);
        let mut rows = rows.start / self.cell..rows.end.div_ceil(self.cell);
        rows.all(|row| self.open[row as usize] == 0 || !self.has_open(row, &columns))
    }

    /// Covers the cells of which a piece covers all pixels. Returns whether it covers a pixel of an
    /// open cell.
    pub(crate) fn cover(&mut self, rays: &Rays, faces: &Faces, piece: Piece<'_>) -> bool {
        let Some(coverage) = Coverage::new(rays, faces, piece.face, piece.outline) else {
            return false;
        };
        let mut owns = false;
        let mut runs: Vec<(u32, Range<u32>)> = Vec::new();
        let mut of_row = None;
        coverage.for_each_run(&mut |y, columns| {
            let row = y / self.cell;
            if of_row != Some(row) {
                of_row.inspect(|&row| self.close(row, &mut runs));
                of_row = Some(row);
            }
            let cells = columns.start / self.cell..columns.end.div_ceil(self.cell);
            owns |= self.open[row as usize] > 0 && self.has_open(row, &cells);
            // Runs of a row of pixels may touch: they are parts of one.
            match runs.last_mut() {
                Some((last, run)) if *last == y && run.end == columns.start => {
                    run.end = columns.end
                }
                _ => runs.push((y, columns)),
            }
        });
        of_row.inspect(|&row| self.close(row, &mut runs));
        owns
    }

    /// Covers the cells of a row that the runs of pixels in it cover, all of them.
    fn close(&mut self, row: u32, runs: &mut Vec<(u32, Range<u32>)>) {
        let height = (self.size[1] - row * self.cell).min(self.cell);
        let end_of = |cell: u32| ((cell + 1) * self.cell).min(self.size[0]);
        for (_, run) in runs.drain(..) {
            for cell in run.start.div_ceil(self.cell)..run.end.div_ceil(self.cell) {
                if end_of(cell) > run.end {
                    continue;
                }
                self.rows_covered[cell as usize] += 1;
                let word = row as usize * self.words + (cell / WORD) as usize;
                let bit = 1 << (cell % WORD);
                if self.rows_covered[cell as usize] == height && self.bits[word] & bit == 0 {
                    self.bits[word] |= bit;
                    self.open[row as usize] -= 1;
                    self.open_rows -= usize::from(self.open[row as usize] == 0);
                }
            }
        }
        self.rows_covered.fill(0);
    }

    /// Whether some of a row's cells are open.
    fn has_open(&self, row: u32, columns: &Range<u32>) -> bool {
        let words = &self.bits[row as usize * self.words..][..self.words];
        let (first, last) = (columns.start / WORD, columns.end.saturating_sub(1) / WORD);
        !columns.is_empty()
            && (first..=last).any(|word| {
                let from = columns.start.saturating_sub(word * WORD);
                let to = (columns.end - word * WORD).min(WORD);
                let wanted = (u64::MAX << from) & (u64::MAX >> (WORD - to));
                !words[word as usize] & wanted != 0
            })
    }
}
