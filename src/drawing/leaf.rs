//! What is visible of a list of pieces in one tile: each piece takes what the pieces before it left open.
//!
//! Long lists are divided first, along edges of their own pieces: halving a tile does not separate triangles
//! around one vertex or strips side by side, but one of their edges leaves about half of them on either side (a
//! binary space partition of the tile: H. Fuchs, Z. M. Kedem, B. F. Naylor, "On visible surface generation by
//! a priori tree structures", 1980).

use smallvec::SmallVec;

use super::cell::{Cell, Rect, are_apart};
use super::lines::{HalfPlane, LineTable};
use super::stock::{FEW_CORNERS, OutlineCache, Primitives};
use super::tile::{CUT, Growth, Tile};
use crate::Error;
use crate::progress::Watch;

/// A part of what is visible: all of it in the picture, with nothing opaque before it. Where all items
/// are opaque, none of it is shown by another.
#[derive(Clone, Debug)]
pub(super) struct Visible {
    pub(super) item: u32,
    pub(super) cell: Cell,
}

/// A tile that was not halved, and what is visible in it.
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
    /// What is visible in a tile of some items, front to back.
    pub(super) fn new<'t>(
        tile: Tile,
        items: &[u32],
        stock: &Primitives<'t>,
        rims: &mut OutlineCache<'t>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let (whole, sides) = (Cell::rectangle(&rims.lines, tile.low, tile.high), tile.sides());
        if items.len() <= SHORT {
            let mut area = OpenArea::new(whole);
            for &item in items {
                watch.work(area.open.len() * CUT)?;
                let around = &stock.items[item as usize].around;
                // Where nothing of the piece is, there is no need for its lines.
                if area.is_apart(around) {
                    continue;
                }
                let Some(halves) = rims.crossing(stock, item, &sides)? else { continue };
                area.subtract(item, around, &halves, stock, &rims.lines, watch)?;
            }
            return Ok(Self { tile, cells: area.cells });
        }
        let mut region = Region { cell: whole, pieces: vec![], growth: Growth::NONE };
        for &item in items {
            watch.work(CUT)?;
            let Some(halves) = rims.crossing(stock, item, &sides)? else { continue };
            if let Some(cell) = region.cell.within(&rims.lines, &halves, None, watch)?
                && region.push(Visible { item, cell }, stock)
            {
                break;
            }
        }
        let mut cells = Vec::new();
        let mut regions = vec![region];
        while let Some(region) = regions.pop() {
            match region.divided(stock, &rims.lines, watch)? {
                Ok(parts) => regions.extend(parts),
                Err(region) => cells.append(&mut region.visible(stock, &rims.lines, watch)?),
            }
        }
        Ok(Self { tile, cells })
    }
}

/// A convex part of a tile with the pieces that may show in it, front to back, each as far as it is there.
struct Region {
    cell: Cell,
    pieces: Vec<Visible>,
    growth: Growth,
}

/// The edges of so many pieces are tried to divide a region. Too small: regions are divided unevenly, or not; too
/// large: time.
const TRIED: usize = 12;
/// Each is compared with so many pieces.
const SAMPLE: usize = 48;

impl Region {
    /// Adds a piece behind all others. Whether it hides what is behind it all over the region.
    fn push(&mut self, piece: Visible, stock: &Primitives<'_>) -> bool {
        let (own, all) = (&piece.cell.sides, &self.cell.sides);
        let is_side = |half: HalfPlane| all.iter().any(|side| side.half == half);
        let covers = stock.is_opaque(piece.item)
            && own.len() == all.len()
            && own.iter().all(|side| is_side(side.half));
        self.pieces.push(piece);
        covers
    }

    /// Both parts of the region on either side of an edge, or the region if it need not be divided.
    fn divided(
        self,
        stock: &Primitives<'_>,
        lines: &LineTable<'_>,
        watch: &Watch<'_>,
    ) -> Result<Result<[Self; 2], Self>, Error> {
        if self.pieces.len() <= SHORT || self.growth.is_too_much() {
            return Ok(Err(self));
        }
        watch.work(TRIED * SAMPLE * 2)?;
        let Some(half) = self.divider(lines) else { return Ok(Err(self)) };
        let signs = self.cell.signs(lines, half);
        let mut parts = [false, true].map(|is_back| {
            let cell = self.cell.part(lines, half.flipped(is_back), &signs, keep(is_back));
            Self { cell, pieces: vec![], growth: self.growth }
        });
        let (count, mut is_full) = (self.pieces.len(), [false; 2]);
        for Visible { item, cell } in self.pieces {
            watch.work(CUT / 4)?;
            let signs = cell.signs(lines, half);
            let reaches = [false, true].map(|is_back| signs.contains(&keep(is_back)));
            for (i, is_back) in [false, true].into_iter().enumerate() {
                if !reaches[i] || is_full[i] {
                    continue;
                }
                let cell = match reaches[1 - i] {
                    true => cell.part(lines, half.flipped(is_back), &signs, keep(is_back)),
                    false => cell.clone(),
                };
                is_full[i] = parts[i].push(Visible { item, cell }, stock);
            }
        }
        let growth = self.growth.after(count, parts.each_ref().map(|part| part.pieces.len()));
        parts.iter_mut().for_each(|part| part.growth = growth);
        Ok(Ok(parts))
    }

    /// The edge of a piece that divides the pieces best, if one leaves clearly fewer on either side.
    fn divider(&self, lines: &LineTable<'_>) -> Option<HalfPlane> {
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
                counts[0] += usize::from(signs.contains(&keep(false)));
                counts[1] += usize::from(signs.contains(&keep(true)));
            }
            // Subtracting takes up to the square of the number of pieces.
            let cost = counts[0] * counts[0] + counts[1] * counts[1];
            if cost * 10 < all * all * 9 && best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, half));
            }
        }
        best.map(|(_, half)| half)
    }

    fn visible(
        self,
        stock: &Primitives<'_>,
        lines: &LineTable<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Visible>, Error> {
        let mut area = OpenArea::new(self.cell);
        for Visible { item, cell } in self.pieces {
            watch.work(area.open.len() * CUT)?;
            let around = cell.around();
            if !area.is_apart(&around) {
                let halves: SmallVec<[HalfPlane; 8]> =
                    cell.sides.iter().map(|side| side.half).collect();
                area.subtract(item, &around, &halves, stock, lines, watch)?;
            }
        }
        Ok(area.cells)
    }
}

/// On which side of a half's line something lies that is in front of it, or behind.
const fn keep(is_back: bool) -> std::cmp::Ordering {
    if is_back { std::cmp::Ordering::Less } else { std::cmp::Ordering::Greater }
}

/// A convex part of the picture: where nothing opaque shows so far, and what shows elsewhere.
struct OpenArea {
    open: Vec<Cell>,
    /// A box around each of these.
    boxes: Vec<Rect>,
    cells: Vec<Visible>,
    /// Room for what is left of an open cell, and of all that one piece takes from.
    outside: Vec<Cell>,
    left: Vec<Cell>,
}

impl OpenArea {
    fn new(cell: Cell) -> Self {
        let boxes = vec![cell.around()];
        Self { open: vec![cell], boxes, cells: vec![], outside: vec![], left: vec![] }
    }

    /// Whether a box is apart from all that is open.
    fn is_apart(&self, around: &Rect) -> bool {
        self.boxes.iter().all(|open| are_apart(open, around))
    }

    /// Takes what an item shows, of which this box is around.
    fn subtract(
        &mut self,
        item: u32,
        around: &Rect,
        halves: &[HalfPlane],
        stock: &Primitives<'_>,
        lines: &LineTable<'_>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        // Of others it is counted by the caller.
        if halves.len() > FEW_CORNERS {
            watch.work(self.open.len() * halves.len())?;
        }
        let Self { open, boxes, cells, outside, left } = self;
        let is_opaque = stock.is_opaque(item);
        let mut i = 0;
        while let Some(cell) = open.get(i) {
            let shown = match are_apart(&boxes[i], around) {
                true => None,
                false => cell.within(lines, halves, is_opaque.then_some(&mut *outside), watch)?,
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
