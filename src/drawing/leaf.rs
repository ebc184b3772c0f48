//! The visible parts of the pieces in one tile. Pieces come front to back, and each opaque piece is subtracted from
//! the area that is still open.
//!
//! Long lists are divided first, along edges of their own pieces. Halving a tile does not separate triangles around
//! one vertex, or strips side by side, but one of their edges leaves about half of them on either side: a binary
//! space partition of the tile (H. Fuchs, Z. M. Kedem, B. F. Naylor, "On visible surface generation by a priori
//! tree structures", 1980).

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::cell::{Cell, Rect, are_apart};
use super::lines::HalfPlane;
use super::primitives::{FEW_CORNERS, Primitives};
use super::sight::Passing;
use super::tile::{CUT, Candidates, Growth, Tile, TileList};
use crate::Error;
use crate::progress::Watch;

/// A visible convex part of an item: inside the picture, and with no opaque item in front of it. If all items are
/// opaque, these parts do not overlap.
#[derive(Clone, Debug)]
pub(super) struct Visible {
    pub(super) item: u32,
    pub(super) cell: Cell,
}

/// A tile that was not halved, and the visible parts of items in it.
#[derive(Debug)]
pub(super) struct Leaf {
    pub(super) tile: Tile,
    pub(super) cells: Vec<Visible>,
}

/// Longer lists are divided. Too small: more tiles, and more cells cut by their borders (16: half as
/// much again for all of a drawing of a scan); too large: more cells compared with more items, though 128
/// would win another 2 to 4 %.
pub(super) const SHORT: usize = 64;

impl Leaf {
    /// Computes the visible parts of items in a tile.
    pub(super) fn new(list: &TileList<'_>, watch: &Watch<'_>) -> Result<Self, Error> {
        let TileList { tile, candidates, .. } = list;
        let primitives = candidates.primitives;
        let mut cells = Vec::new();
        if candidates.list.len() <= SHORT {
            let mut area = OpenArea::new(tile.cell(&primitives.lines));
            for candidate in &candidates.list {
                watch.work(area.open.len() * CUT)?;
                let (item, halves) = (candidate.number, candidates.halves_of(candidate));
                area.subtract(item, candidates.around(item), halves, primitives, watch)?;
            }
            cells = area.cells;
        } else {
            let whole = SubTile::new(list, Passing::NOTHING, watch)?;
            whole.for_each_part(|part| Ok(cells.extend(part.visible(watch)?)), watch)?;
        }
        Ok(Self { tile: *tile, cells })
    }
}

/// A convex part of a tile, with what is in it.
pub(super) struct SubTile<'l, 'p> {
    pub(super) candidates: &'l Candidates<'p>,
    pub(super) cell: Cell,
    /// The candidates, front to back and clipped to the part.
    pub(super) pieces: Vec<Visible>,
    pub(super) passing: Passing<'l>,
    growth: Growth,
}

/// How many edges, each of another piece, are tried to divide a part. Too small: parts are divided unevenly, or
/// not at all. Too large: choosing takes longer than it saves.
const TRIED: usize = 12;
/// How many pieces each of these edges is compared with. Too small: the choice is poor. Too large: it takes long.
const SAMPLE: usize = 48;

impl<'l, 'p> SubTile<'l, 'p> {
    /// All of a tile, and what passes it.
    pub(super) fn new(
        list: &'l TileList<'p>,
        passing: Passing<'l>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let candidates = &list.candidates;
        let lines = &candidates.primitives.lines;
        let cell = list.tile.cell(lines);
        let mut whole = Self { candidates, cell, pieces: vec![], passing, growth: Growth::NONE };
        for candidate in &candidates.list {
            watch.work(CUT)?;
            let cell = whole.cell.within(lines, candidates.halves_of(candidate), None, watch)?;
            if let Some(cell) = cell
                && whole.push(Visible { item: candidate.number, cell })
            {
                break;
            }
        }
        Ok(whole)
    }

    /// Adds a piece behind all others, and returns whether it hides what is behind it.
    fn push(&mut self, piece: Visible) -> bool {
        let is_hiding = self.candidates.hides(piece.item) && self.is_covered_by(&piece);
        self.pieces.push(piece);
        is_hiding
    }

    /// Whether a piece covers all of the part.
    pub(super) fn is_covered_by(&self, piece: &Visible) -> bool {
        let (own, all) = (&piece.cell.sides, &self.cell.sides);
        let is_side = |half: HalfPlane| all.iter().any(|side| side.half == half);
        own.len() == all.len() && own.iter().all(|side| is_side(side.half))
    }

    /// Divides the part until lists are short, and calls a function with each part of it.
    pub(super) fn for_each_part(
        self,
        mut see: impl FnMut(Self) -> Result<(), Error>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let mut parts = vec![self];
        while let Some(part) = parts.pop() {
            match part.divider(watch)? {
                Some(half) => parts.extend(part.halves(half, watch)?),
                None => see(part)?,
            }
        }
        Ok(())
    }

    /// Divides the part along a line.
    fn halves(self, half: HalfPlane, watch: &Watch<'_>) -> Result<[Self; 2], Error> {
        let candidates = self.candidates;
        let lines = &candidates.primitives.lines;
        let signs = self.cell.signs(lines, half);
        let mut parts = [false, true].map(|is_back| {
            let cell = self.cell.part(lines, half.flipped(is_back), &signs, sign(is_back));
            let passing = self.passing.over(lines, &cell);
            Self { candidates, cell, pieces: vec![], passing, growth: self.growth }
        });
        let (count, mut is_full) = (self.pieces.len(), [false; 2]);
        for Visible { item, cell } in self.pieces {
            watch.work(CUT / 4)?;
            let signs = cell.signs(lines, half);
            let reaches = [false, true].map(|is_back| signs.contains(&sign(is_back)));
            for (i, is_back) in [false, true].into_iter().enumerate() {
                if !reaches[i] || is_full[i] {
                    continue;
                }
                let cell = match reaches[1 - i] {
                    true => cell.part(lines, half.flipped(is_back), &signs, sign(is_back)),
                    false => cell.clone(),
                };
                is_full[i] = parts[i].push(Visible { item, cell });
            }
        }
        let growth = self.growth.after(count, parts.each_ref().map(|part| part.pieces.len()));
        parts.iter_mut().for_each(|part| part.growth = growth);
        Ok(parts)
    }

    /// Chooses the edge that divides the pieces best. `None` for short lists, and if no edge leaves clearly fewer
    /// pieces on both sides.
    fn divider(&self, watch: &Watch<'_>) -> Result<Option<HalfPlane>, Error> {
        let lines = &self.candidates.primitives.lines;
        if self.pieces.len() <= SHORT || self.growth.is_too_much() {
            return Ok(None);
        }
        watch.work(TRIED * SAMPLE * 2)?;
        let some = |most: usize| self.pieces.iter().step_by(self.pieces.len().div_ceil(most));
        let is_inside =
            |half: HalfPlane| self.cell.sides.iter().all(|side| side.half.line() != half.line());
        let mut best: Option<(usize, HalfPlane)> = None;
        for (i, Visible { cell, .. }) in some(TRIED).enumerate() {
            let n = cell.sides.len();
            let mut halves = (0..n).map(|k| cell.sides[(i + k) % n].half);
            let Some(half) = halves.find(|&half| is_inside(half)) else { continue };
            let (mut counts, mut all) = ([0, 0], 0);
            for piece in some(SAMPLE) {
                let signs = piece.cell.signs(lines, half);
                all += 1;
                counts[0] += usize::from(signs.contains(&sign(false)));
                counts[1] += usize::from(signs.contains(&sign(true)));
            }
            // Subtracting takes up to the square of the number of pieces.
            let cost = counts[0] * counts[0] + counts[1] * counts[1];
            if cost * 10 < all * all * 9 && best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, half));
            }
        }
        Ok(best.map(|(_, half)| half))
    }

    /// Computes the visible parts of the pieces.
    fn visible(self, watch: &Watch<'_>) -> Result<Vec<Visible>, Error> {
        let primitives = self.candidates.primitives;
        let mut area = OpenArea::new(self.cell);
        for Visible { item, cell } in self.pieces {
            watch.work(area.open.len() * CUT)?;
            let halves: SmallVec<[HalfPlane; 8]> =
                cell.sides.iter().map(|side| side.half).collect();
            area.subtract(item, &cell.around(), &halves, primitives, watch)?;
        }
        Ok(area.cells)
    }
}

/// The sign of corners behind a line, or in front of it.
const fn sign(is_back: bool) -> Ordering {
    if is_back { Ordering::Less } else { Ordering::Greater }
}

/// A convex part of the picture while pieces are subtracted from it.
struct OpenArea {
    /// The cells that no opaque piece covers so far.
    open: Vec<Cell>,
    /// A box around each open cell.
    boxes: Vec<Rect>,
    /// The visible parts so far.
    cells: Vec<Visible>,
    // Working space: the rest of one open cell, and of all open cells that one piece was subtracted from.
    outside: Vec<Cell>,
    left: Vec<Cell>,
}

impl OpenArea {
    fn new(cell: Cell) -> Self {
        let boxes = vec![cell.around()];
        Self { open: vec![cell], boxes, cells: vec![], outside: vec![], left: vec![] }
    }

    /// Adds the visible parts of an item with this bounding box. An opaque item is subtracted from the open cells.
    fn subtract(
        &mut self,
        item: u32,
        around: &Rect,
        halves: &[HalfPlane],
        primitives: &Primitives<'_>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        // The caller counts the work for fewer corners.
        if halves.len() > FEW_CORNERS {
            watch.work(self.open.len() * halves.len())?;
        }
        let Self { open, boxes, cells, outside, left } = self;
        let is_opaque = primitives.is_opaque(item);
        let mut i = 0;
        while let Some(cell) = open.get(i) {
            let shown = match are_apart(&boxes[i], around) {
                true => None,
                false => cell.within(
                    &primitives.lines,
                    halves,
                    is_opaque.then_some(&mut *outside),
                    watch,
                )?,
            };
            let is_taken = is_opaque && shown.is_some();
            cells.extend(shown.map(|cell| Visible { item, cell }));
            if is_taken {
                open.swap_remove(i);
                boxes.swap_remove(i);
                left.append(outside);
            } else {
                outside.clear();
                i += 1;
            }
        }
        boxes.extend(left.iter().map(Cell::around));
        open.append(left);
        Ok(())
    }
}
