//! A mask of covered pixels, for front-to-back walks that skip hidden subtrees.

use std::ops::Range;

use glam::DVec3;

use crate::paint::Pieces;
use crate::raster::{Rays, Window, for_each_run};
use crate::tree::{BspTree, Fragment};

/// A mask of the pixels that [fragments](crate::Fragment) cover, for occlusion culling in a front-to-back
/// [walk](crate::Order::walk).
///
/// Call [`cover`](Self::cover) with each visited fragment. Skip each subtree whose box the mask
/// [`hides`](Self::hides), because none of the subtree's fragments is visible. The test is conservative:
/// `hides` never hides a visible fragment, but may return false although all fragments of the subtree are
/// hidden.
///
/// The mask may be coarser than the picture: a cell of the mask can be several pixels wide and high. A cell
/// is covered only if one fragment covers all pixels of the cell. A coarse mask is smaller and faster, but
/// hides less: cells on the edge between two walls remain uncovered, because neither wall covers a whole
/// cell.
///
/// ```
/// use binspace::raster::Rays;
/// use binspace::occlusion::CoverageMask;
/// use binspace::view::Camera;
/// use binspace::{BspTree, Flow, Part, scene};
/// use binspace::glam::DVec3;
///
/// // Squares one behind the other: from the front, the first hides all others.
/// let tree = BspTree::build(scene::chain(50).polygons())?;
/// let eye = DVec3::new(0.0, -9.0, 0.0);
/// let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [64, 64])?;
/// let mut mask = CoverageMask::new(&tree, &Rays::new(&camera, tree.faces())?, 1);
/// let mut seen = Vec::new();
/// let _ = tree.order(camera.viewpoint()).front_to_back().walk(|part| match part {
///     Part::Subtree(node) if mask.hides(node.bounds()) => Flow::Skip,
///     Part::Fragment(fragment) if mask.cover(&fragment) => {
///         seen.push(fragment.polygon());
///         Flow::<()>::Descend
///     }
///     _ => Flow::Descend,
/// });
/// assert_eq!(seen, [0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CoverageMask<'t> {
    tree: &'t BspTree,
    rays: Rays,
    pieces: Pieces,
    /// The side of a cell in pixels.
    cell: u32,
    /// Words in a row of cells.
    words: usize,
    /// A bit for each covered cell.
    bits: Vec<u64>,
    /// The number of uncovered cells in each row.
    open: Vec<u32>,
    /// The number of rows that have an uncovered cell.
    open_rows: usize,
    /// Working space: for each cell of a row, the number of pixel rows in which the cell is covered so far.
    rows_covered: Vec<u32>,
}

/// Bits in a word.
const WORD: u32 = u64::BITS;

impl<'t> CoverageMask<'t> {
    /// Creates an empty mask for a tree and the picture that `rays` define. The mask's cells are `cell`
    /// pixels wide and high; 0 counts as 1.
    ///
    /// # Panics
    ///
    /// If the rays were made for a tree with another [grid](BspTree::grid).
    pub fn new(tree: &'t BspTree, rays: &Rays, cell: u32) -> Self {
        rays.expect(tree.faces());
        let cell = cell.max(1);
        let [columns, rows] = rays.size().map(|side| side.div_ceil(cell));
        let words = columns.div_ceil(WORD) as usize;
        Self {
            tree,
            rays: rays.clone(),
            pieces: Pieces::default(),
            cell,
            words,
            bits: vec![0; words * rows as usize],
            open: vec![columns; rows as usize],
            open_rows: if columns > 0 { rows as usize } else { 0 },
            rows_covered: vec![0; columns as usize],
        }
    }

    /// Returns whether a box is hidden: whether all pixels that the box may cover are already covered, or the
    /// box is outside the picture.
    ///
    /// Tests the cells that the box may cover, row by row and 64 cells at a time, up to the first uncovered
    /// cell. A row in which all cells are covered is not tested cell by cell.
    pub fn hides(&self, [low, high]: [DVec3; 2]) -> bool {
        let lattice = self.tree.faces().lattice();
        let corners: [[f64; 3]; 8] = std::array::from_fn(|k| {
            let pick = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
            lattice.to_lattice(DVec3::new(pick(0), pick(1), pick(2)))
        });
        let Some(Window { columns, rows }) = self.rays.window(&corners) else { return true };
        if self.is_full() {
            return true;
        }
        let columns = columns.start / self.cell..columns.end.div_ceil(self.cell);
        let mut rows = rows.start / self.cell..rows.end.div_ceil(self.cell);
        rows.all(|row| self.open[row as usize] == 0 || !self.has_open(row, &columns))
    }

    /// Covers the pixels of a fragment. Returns whether the fragment may be visible: whether the fragment has
    /// a pixel in a cell that was not covered before.
    ///
    /// Takes O(edges) time for each row of pixels that the fragment reaches, plus O(mask's width in cells)
    /// time for each row of cells. If the fragment's box is known, first test the box by
    /// [`hides`](Self::hides), which is faster.
    ///
    /// # Panics
    ///
    /// If the fragment belongs to a tree with another [grid](BspTree::grid).
    pub fn cover(&mut self, fragment: &Fragment<'_>) -> bool {
        // The fragment's own faces, not the faces of the mask's tree: it may be a piece of an overlay.
        let faces = fragment.faces;
        let mut runs: Vec<(u32, Range<u32>)> = Vec::new();
        for_each_run(&self.rays, faces, self.pieces.of(fragment), |y, run| match runs.last_mut() {
            // Adjacent runs of a row of pixels are parts of one run.
            Some((last_y, last)) if *last_y == y && last.end == run.start => last.end = run.end,
            _ => runs.push((y, run)),
        });
        let (mut owns, cell) = (false, self.cell);
        for runs in runs.chunk_by(|(a, _), (b, _)| a / cell == b / cell) {
            let row = runs[0].0 / cell;
            owns |= self.open[row as usize] > 0
                && runs.iter().any(|(_, run)| {
                    self.has_open(row, &(run.start / cell..run.end.div_ceil(cell)))
                });
            self.close(row, runs);
        }
        owns
    }

    /// Returns whether the whole picture is covered.
    pub fn is_full(&self) -> bool {
        self.open_rows == 0
    }

    /// Covers each cell of a row whose pixels are all in the runs.
    fn close(&mut self, row: u32, runs: &[(u32, Range<u32>)]) {
        let [width, height] = self.rays.size();
        let height = (height - row * self.cell).min(self.cell);
        let end_of = |cell: u32| ((cell + 1) * self.cell).min(width);
        for (_, run) in runs {
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

    /// Whether a row has an uncovered cell in these columns.
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
