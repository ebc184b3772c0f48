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
use super::lines::{HalfPlane, LineTable};
use super::primitives::{FEW_CORNERS, Primitives};
use super::tile::{CUT, Growth, Tile};
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
    /// Computes the visible parts of items in a tile. The items are sorted front to back.
    pub(super) fn new(
        tile: Tile,
        items: &[u32],
        primitives: &Primitives<'_>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let lines = &primitives.lines;
        let (whole, sides) = (Cell::rectangle(lines, tile.low, tile.high), tile.sides());
        if items.len() <= SHORT {
            let mut area = OpenArea::new(whole);
            for &item in items {
                watch.work(area.open.len() * CUT)?;
                let around = &primitives.items[item as usize].around;
                if area.is_apart(around) {
                    continue;
                }
                let Some(halves) = primitives.crossing(item, &sides) else { continue };
                area.subtract(item, around, &halves, primitives, watch)?;
            }
            return Ok(Self { tile, cells: area.cells });
        }
        let mut region = SubTile { cell: whole, pieces: vec![], growth: Growth::NONE };
        for &item in items {
            watch.work(CUT)?;
            let Some(halves) = primitives.crossing(item, &sides) else { continue };
            if let Some(cell) = region.cell.within(lines, &halves, None, watch)?
                && region.push(Visible { item, cell }, primitives)
            {
                break;
            }
        }
        let mut cells = Vec::new();
        let mut regions = vec![region];
        while let Some(region) = regions.pop() {
            match region.divider(&primitives.lines, watch)? {
                Some(half) => regions.extend(region.halves(half, primitives, watch)?),
                None => cells.extend(region.visible(primitives, watch)?),
            }
        }
        Ok(Self { tile, cells })
    }
}

/// A convex part of a tile, and the pieces in it, front to back and clipped to it.
struct SubTile {
    cell: Cell,
    pieces: Vec<Visible>,
    growth: Growth,
}

/// How many edges, each of another piece, are tried to divide a region. Too small: regions are divided unevenly, or
/// not at all. Too large: choosing takes longer than it saves.
const TRIED: usize = 12;
/// How many pieces each of these edges is compared with. Too small: the choice is poor. Too large: it takes long.
const SAMPLE: usize = 48;

impl SubTile {
    /// Adds a piece behind all others, and returns whether it is opaque and covers the region.
    fn push(&mut self, piece: Visible, primitives: &Primitives<'_>) -> bool {
        let (own, all) = (&piece.cell.sides, &self.cell.sides);
        let is_side = |half: HalfPlane| all.iter().any(|side| side.half == half);
        let covers = primitives.is_opaque(piece.item)
            && own.len() == all.len()
            && own.iter().all(|side| is_side(side.half));
        self.pieces.push(piece);
        covers
    }

    /// Divides the region along a line.
    fn halves(
        self,
        half: HalfPlane,
        primitives: &Primitives<'_>,
        watch: &Watch<'_>,
    ) -> Result<[Self; 2], Error> {
        let lines = &primitives.lines;
        let signs = self.cell.signs(lines, half);
        let mut parts = [false, true].map(|is_back| {
            let cell = self.cell.part(lines, half.flipped(is_back), &signs, sign(is_back));
            Self { cell, pieces: vec![], growth: self.growth }
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
                is_full[i] = parts[i].push(Visible { item, cell }, primitives);
            }
        }
        let growth = self.growth.after(count, parts.each_ref().map(|part| part.pieces.len()));
        parts.iter_mut().for_each(|part| part.growth = growth);
        Ok(parts)
    }

    /// Chooses the edge that divides the pieces best. `None` for short lists, and if no edge leaves clearly fewer
    /// pieces on both sides.
    fn divider(
        &self,
        lines: &LineTable<'_>,
        watch: &Watch<'_>,
    ) -> Result<Option<HalfPlane>, Error> {
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
    fn visible(
        self,
        primitives: &Primitives<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Visible>, Error> {
        let mut area = OpenArea::new(self.cell);
        for Visible { item, cell } in self.pieces {
            watch.work(area.open.len() * CUT)?;
            let around = cell.around();
            if !area.is_apart(&around) {
                let halves: SmallVec<[HalfPlane; 8]> =
                    cell.sides.iter().map(|side| side.half).collect();
                area.subtract(item, &around, &halves, primitives, watch)?;
            }
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

    /// Whether a box overlaps no open cell.
    fn is_apart(&self, around: &Rect) -> bool {
        self.boxes.iter().all(|open| are_apart(open, around))
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
