//! Sides of polygons, found by place.

use super::strip::{NEAR, WIDTH};

/// The most cells. Larger: more memory; smaller: more sides in each cell of drawings of millions.
const MOST_CELLS: usize = 1 << 20;

/// A side of an outline, the number of its path, and that of the convex part that it bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Side {
    pub(super) path: usize,
    pub(super) part: usize,
    pub(super) ends: [[f64; 2]; 2],
}

/// Square cells of a picture, each with the sides that pass through it.
#[derive(Debug)]
pub(super) struct Grid {
    cell: f64,
    columns: usize,
    rows: usize,
    sides: Vec<Side>,
    cells: Vec<Vec<u32>>,
}

impl Grid {
    /// An empty grid with about as many cells as there will be sides.
    pub(super) fn new(size: [u32; 2], sides: usize) -> Self {
        let [width, height] = size.map(f64::from);
        let cells = sides.clamp(1, MOST_CELLS) as f64;
        let cell = (width * height / cells).sqrt().max(1.0);
        let [columns, rows] = [width, height].map(|side| (side / cell) as usize + 1);
        Self { cell, columns, rows, sides: vec![], cells: vec![vec![]; columns * rows] }
    }

    pub(super) fn add(&mut self, side: Side) {
        let number = self.sides.len() as u32;
        self.sides.push(side);
        for cell in self.passed(side.ends, NEAR) {
            self.cells[cell].push(number);
        }
    }

    /// Finds sides of paths later than one that are near a side, part by part.
    pub(super) fn near(&self, ends: [[f64; 2]; 2], path: usize, found: &mut Vec<Side>) {
        found.clear();
        let mut numbers: Vec<u32> = Vec::new();
        for cell in self.passed(ends, WIDTH) {
            let later = |&&number: &&u32| self.sides[number as usize].path > path;
            numbers.extend(self.cells[cell].iter().filter(later));
        }
        numbers.sort_unstable();
        numbers.dedup();
        found.extend(numbers.iter().map(|&number| self.sides[number as usize]));
    }

    /// The cells that a side passes through, or passes within reach.
    fn passed(&self, [a, b]: [[f64; 2]; 2], reach: f64) -> Vec<usize> {
        let place = |c: f64, most: usize| ((c.max(0.0) / self.cell) as usize).min(most - 1);
        let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
        // Steps to the side for each downwards; along rows all of them at once.
        let slope = (high[0] - low[0]) / (high[1] - low[1]).max(f64::MIN_POSITIVE);
        let mut passed = Vec::new();
        for row in place(low[1] - reach, self.rows)..=place(high[1] + reach, self.rows) {
            let at = |y: f64| {
                let x = low[0] + (y.clamp(low[1], high[1]) - low[1]) * slope;
                x.clamp(a[0].min(b[0]), a[0].max(b[0]))
            };
            let is_flat = high[1] - low[1] < reach;
            let [x0, x1] = if is_flat {
                [a[0], b[0]]
            } else {
                // The first and the last row reach beyond the picture.
                let edge = |row: usize| row as f64 * self.cell;
                let top = if row == 0 { low[1] } else { edge(row) - reach };
                let is_last = row + 1 == self.rows;
                let bottom = if is_last { high[1] } else { edge(row + 1) + reach };
                [at(top), at(bottom)]
            };
            let [from, to] =
                [x0.min(x1) - reach, x0.max(x1) + reach].map(|x| place(x, self.columns));
            passed.extend((from..=to).map(|column| row * self.columns + column));
        }
        passed
    }
}
