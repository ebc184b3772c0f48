//! A quadtree of the picture: all threads halve tiles until each tile has few pieces (J. E. Warnock, "A
//! hidden surface algorithm for computer generated halftone pictures", 1969; with exact leaves in place of
//! pixels).
//!
//! Halving a tile does not separate triangles around one vertex, or strips side by side. But an edge of such
//! a triangle or strip leaves about half of the other triangles or strips on each side. So tiles where long
//! lists remain are divided along edges of the tile's pieces: a binary space partition of the tile (H. Fuchs,
//! Z. M. Kedem, B. F. Naylor, "On visible surface generation by a priori tree structures", 1980).

use std::cmp::Ordering;
use std::ops::Range;

use smallvec::SmallVec;

use super::cell::{Cell, Rect, are_apart, is_within};
use super::lines::{HalfPlane, LineTable, STEPS};
use super::map::finish_item;
use super::passes::Passing;
use super::primitives::{FEW_CORNERS, Primitives};
use crate::memory::place;
use crate::progress::Watch;
use crate::{Error, parallel_map};

/// A rectangle of the picture, with borders in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) low: [i64; 2],
    pub(super) high: [i64; 2],
}

/// The position of a box relative to a half-plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Across {
    Inside,
    Outside,
    Maybe,
}

/// If the caller divides long lists itself, tiles of this size or smaller, in steps, are not halved: 2⁻⁴ of a
/// pixel. Too small: tiles around a vertex of many faces are halved many times. Too large: many small pieces
/// are in one tile.
pub(super) const TINY: i64 = 1 << 20;
/// If the caller does not divide long lists itself, tiles of this size or smaller, in steps, are not halved:
/// 2⁻¹⁸ of a pixel. Too small: tiles around common points are halved many times. Too large: long lists
/// remain.
pub(super) const TINIEST: i64 = 1 << 6;

/// The growth of the number of pieces by halving. When a tile is halved, its two parts together have more
/// pieces than the tile, because pieces that reach into both parts are counted twice. The growth of a part is
/// the product of the ratios of these two numbers, over all halvings that led to the part.
///
/// The total number of pieces in all parts of a picture is at most the picture's number of pieces times the
/// largest growth of a part. Proof: add up, over all parts, the part's number of pieces divided by the part's
/// growth. Halving a part does not increase this sum.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth(f64);

/// Parts of at least this growth are not halved again. Many pieces may meet in a point, as at the tip of a
/// cone, or along a line, like the columns of a terrain seen along its rows. Around such a point or line,
/// halving would not end. Too small: long lists remain. Too large: many parts with the same pieces.
const MOST: f64 = 4.0;

impl Growth {
    pub(super) const NONE: Self = Self(1.0);

    /// The growth of parts with these numbers of pieces, from a part that had `all` pieces.
    pub(super) fn after(self, all: usize, parts: [usize; 2]) -> Self {
        let growth = (parts[0] + parts[1]) as f64 / all.max(1) as f64;
        Self((self.0 * growth).max(1.0))
    }

    pub(super) fn is_too_much(self) -> bool {
        self.0 >= MOST
    }
}

impl Tile {
    /// The tile of a whole picture.
    pub(super) fn picture(size: [u32; 2]) -> Self {
        Self { low: [0; 2], high: size.map(|side| STEPS as i64 * i64::from(side)) }
    }

    /// The halves of the tile, divided across its longer side, a little beside the middle, at an odd number
    /// of steps. The target of a camera is often exactly in the middle of the picture, and points that lie on
    /// a border by chance are compared in integers.
    pub(super) fn halves(&self) -> [Self; 2] {
        let size = [0, 1].map(|axis: usize| self.high[axis] - self.low[axis]);
        let axis = usize::from(size[1] > size[0]);
        let middle = (self.low[axis] + size[axis] / 32 * 17) | 1;
        let mut parts = [*self; 2];
        parts[0].high[axis] = middle;
        parts[1].low[axis] = middle;
        parts
    }

    /// Whether a half's line is a border of the tile.
    pub(super) fn has_border(&self, half: HalfPlane) -> bool {
        half.number().is_none() && {
            let (axis, steps) = half.border();
            steps == self.low[axis] || steps == self.high[axis]
        }
    }

    /// Whether the tile is at most `size` steps wide and high.
    pub(super) fn is_within(&self, size: i64) -> bool {
        (0..2).all(|axis| self.high[axis] - self.low[axis] <= size)
    }

    /// The tile as a cell.
    pub(super) fn cell(&self, lines: &LineTable<'_>) -> Cell {
        Cell::rectangle(lines, self.low, self.high)
    }

    /// The sides of the tile in pixels, exactly.
    pub(super) fn sides(&self) -> Rect {
        [self.low, self.high].map(|end| end.map(|steps| steps as f64 / STEPS))
    }
}

impl LineTable<'_> {
    /// The position of a box relative to a half-plane.
    pub(super) fn across(&self, half: HalfPlane, [low, high]: &Rect) -> Across {
        let line = self.rounded(half);
        let [x, y] = [0, 1].map(|axis: usize| 0.5 * (low[axis] + high[axis]));
        let [w, h] = [0, 1].map(|axis: usize| 0.5 * (high[axis] - low[axis]));
        let reach = line.k[1].abs() * w + line.k[2].abs() * h + 2.0 * line.error;
        let value = line.at([x, y]);
        if value.abs() <= reach {
            Across::Maybe
        } else if (value > 0.0) != half.is_negative() {
            Across::Inside
        } else {
            Across::Outside
        }
    }
}

/// The number of levels on which both halves of a part are offered to all threads; deeper, one thread
/// continues alone.
const SHARED: usize = 6;
/// The cost of comparing an item with a tile, in pieces that a build examines.
pub(super) const NARROWED: usize = 8;
/// The cost of cutting a cell with an item.
pub(super) const CUT: usize = 64;
/// The cost of making the lines of a piece.
pub(super) const LINES: usize = 64;
/// The cost of visiting a node of a graph.
pub(super) const VISITED: usize = 4;

/// Halves a part repeatedly, until `halves` returns `None`. Calls `leaf` with each part that is not halved,
/// to add the part's results. Returns one collection for each part that threads share. The result and its
/// order do not depend on the number of threads. Counts as one phase of the progress.
pub(super) fn found_in<P: Send, F: Send + Default>(
    all: P,
    halves: impl Fn(&P) -> Result<Option<[P; 2]>, Error> + Sync,
    leaf: impl Fn(&P, &mut F) -> Result<(), Error> + Sync,
    watch: &Watch<'_>,
) -> Result<Vec<F>, Error> {
    shared(all, 0..1 << SHARED, &halves, &leaf, watch)
}

/// Searches a part. `shares` is the range of the phase's items that the part stands for. Any free thread
/// continues with each half, so no thread waits until all parts of a size are halved.
fn shared<P: Send, F: Send + Default>(
    part: P,
    shares: Range<usize>,
    halves: &(impl Fn(&P) -> Result<Option<[P; 2]>, Error> + Sync),
    leaf: &(impl Fn(&P, &mut F) -> Result<(), Error> + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<F>, Error> {
    let parts = if shares.len() == 1 { None } else { halves(&part)? };
    let Some([first, second]) = parts else {
        let (mut found, mut stack) = (F::default(), vec![part]);
        while let Some(part) = stack.pop() {
            match halves(&part)? {
                Some([first, second]) => stack.extend([second, first]),
                None => leaf(&part, &mut found)?,
            }
        }
        shares.for_each(|i| finish_item(watch, i, 1 << SHARED));
        return Ok(vec![found]);
    };
    drop(part);
    let middle = shares.start + shares.len() / 2;
    let parts = vec![(first, shares.start..middle), (second, middle..shares.end)];
    let found = |(part, shares)| shared(part, shares, halves, leaf, watch);
    Ok(parallel_map::map(parts, found)?.into_iter().flatten().collect())
}

/// The largest number of opaque faces, nearest first, that are tested. The test is whether all items of a
/// face together cover a tile. Too small: more hidden items stay in the lists. Too large: more tests without
/// success.
const FACES: usize = 8;

/// The kind of a list's candidates: numbers of items, front to back, or of whole faces.
#[derive(Clone, Copy, Debug)]
enum Of {
    Items,
    Faces,
}

/// An item or a face, with its half-planes whose lines may cross a part of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) number: u32,
    halves: [u32; 2],
}

impl Candidate {
    /// Whether the candidate covers the whole part.
    pub(super) const fn covers(&self) -> bool {
        self.halves[0] == self.halves[1]
    }
}

/// The items or the faces that may reach into a part of the picture. Items are sorted front to back.
#[derive(Debug)]
pub(super) struct Candidates<'p> {
    pub(super) primitives: &'p Primitives<'p>,
    of: Of,
    pub(super) list: Vec<Candidate>,
    halves: Vec<HalfPlane>,
    /// Whether the list ends where an opaque candidate covers the part.
    ends_at_cover: bool,
    /// Hidden items behind this item are missing from the list.
    limit: u32,
}

impl<'p> Candidates<'p> {
    /// The candidates for the items that `keep` accepts.
    pub(super) fn items(
        primitives: &'p Primitives<'p>,
        keep: impl Fn(u32) -> bool,
    ) -> Result<Self, Error> {
        let mut all = Self::none(primitives, Of::Items);
        for item in (0..primitives.items.len() as u32).filter(|&item| keep(item)) {
            all.push(item, primitives.halves(item))?;
        }
        Ok(all)
    }

    /// The candidates for the faces that may be visible in the picture and that `keep` accepts.
    pub(super) fn faces(
        primitives: &'p Primitives<'p>,
        keep: impl Fn(u32) -> bool,
    ) -> Result<Self, Error> {
        let mut all = Self::none(primitives, Of::Faces);
        let faces = 0..primitives.views.len() as u32;
        for face in faces.filter(|&face| primitives.sees(face) && keep(face)) {
            all.push(face, primitives.outline(face))?;
        }
        Ok(all)
    }

    fn none(primitives: &'p Primitives<'p>, of: Of) -> Self {
        let (list, halves) = (vec![], vec![]);
        Self { primitives, of, list, halves, ends_at_cover: false, limit: u32::MAX }
    }

    /// Makes the list end at an opaque item that covers the part of the picture, because items behind that
    /// item are hidden.
    pub(super) fn ending_at_covers(self) -> Self {
        Self { ends_at_cover: true, ..self }
    }

    fn push(&mut self, number: u32, halves: &[HalfPlane]) -> Result<(), Error> {
        let start = place(self.halves.len())?;
        self.halves.extend_from_slice(halves);
        self.list.push(Candidate { number, halves: [start, place(self.halves.len())?] });
        Ok(())
    }

    pub(super) fn halves_of(&self, candidate: &Candidate) -> &[HalfPlane] {
        let [start, end] = candidate.halves;
        &self.halves[start as usize..end as usize]
    }

    /// The face of a candidate.
    pub(super) fn face(&self, number: u32) -> u32 {
        match self.of {
            Of::Items => self.primitives.face(number),
            Of::Faces => number,
        }
    }

    /// The bounding box of a candidate's part in the picture.
    pub(super) fn around(&self, number: u32) -> &Rect {
        match self.of {
            Of::Items => &self.primitives.items[number as usize].around,
            Of::Faces => &self.primitives.views[number as usize].around,
        }
    }

    /// Whether a candidate hides items behind it and the list leaves these items out.
    pub(super) fn hides(&self, number: u32) -> bool {
        self.ends_at_cover && self.primitives.views[self.face(number) as usize].is_opaque
    }

    /// The candidates that may reach into a box, and that `keep` accepts.
    pub(super) fn narrowed(
        &self,
        sides: &Rect,
        keep: impl Fn(u32) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        watch.work(self.list.len() * NARROWED)?;
        let lines = &self.primitives.lines;
        let list = Vec::with_capacity(self.list.len());
        let halves = Vec::with_capacity(self.halves.len());
        let mut part = Self { list, halves, ..*self };
        'candidates: for candidate in &self.list {
            let number = candidate.number;
            if number > part.limit {
                break;
            }
            let around = self.around(number);
            if are_apart(sides, around) || !keep(number) {
                continue;
            }
            let (start, halves) = (part.halves.len(), self.halves_of(candidate));
            if is_within(around, sides) {
                part.push(number, halves)?;
                continue;
            }
            for &half in halves {
                match lines.across(half, sides) {
                    Across::Inside => {}
                    Across::Maybe => part.halves.push(half),
                    Across::Outside => {
                        part.halves.truncate(start);
                        continue 'candidates;
                    }
                }
            }
            let end = part.halves.len();
            if start == end && self.hides(number) {
                part.limit = number;
            }
            part.list.push(Candidate { number, halves: [place(start)?, place(end)?] });
        }
        if self.ends_at_cover {
            part.end_at_face(sides, watch)?;
        }
        Ok(part)
    }

    /// Whether hidden items of a face may be missing from the list of items. Other items that are missing do not
    /// reach into the part of the picture.
    pub(super) fn misses(&self, face: u32) -> bool {
        self.primitives.items_of(face).next().is_some_and(|last| last > self.limit)
    }

    /// Whether a point of the part of the picture is in a candidate; `None` if floats do not tell.
    pub(super) fn is_in(&self, candidate: &Candidate, at: [f64; 2]) -> Option<bool> {
        let mut is_in = Some(true);
        for &half in self.halves_of(candidate) {
            let line = self.primitives.lines.rounded(half);
            let value = line.at(at);
            if value.abs() <= line.error {
                is_in = None;
            } else if (value > 0.0) == half.is_negative() {
                return Some(false);
            }
        }
        is_in
    }

    /// Ends the list of items with the last item of an opaque face that covers the box. One or more items of
    /// the face together cover the box.
    fn end_at_face(&mut self, sides: &Rect, watch: &Watch<'_>) -> Result<(), Error> {
        let primitives = self.primitives;
        let mut end = self.limit;
        let mut tried: SmallVec<[u32; FACES]> = SmallVec::new();
        for candidate in &self.list {
            if candidate.number >= end || tried.len() == FACES {
                break;
            }
            let face = primitives.face(candidate.number);
            let is_opaque = primitives.views[face as usize].is_opaque;
            // If items of the face are missing from the list, the other items may not cover the box.
            if !is_opaque || self.misses(face) || tried.contains(&face) {
                continue;
            }
            tried.push(face);
            watch.work(primitives.edges_work(face))?;
            if primitives.covers(face, sides) {
                let mut numbers = self.list.iter().rev().map(|candidate| candidate.number);
                let last = numbers.find(|&item| primitives.face(item) == face);
                end = last.map_or(end, |last| end.min(last));
            }
        }
        self.limit = end;
        self.list.truncate(self.list.partition_point(|candidate| candidate.number <= end));
        Ok(())
    }
}

/// A tile with the candidates that may reach into the tile.
#[derive(Debug)]
pub(super) struct TileList<'p> {
    pub(super) tile: Tile,
    pub(super) candidates: Candidates<'p>,
    growth: Growth,
}

impl<'p> TileList<'p> {
    /// The whole picture, with the candidates that may reach into the picture.
    pub(super) fn picture(candidates: Candidates<'p>, watch: &Watch<'_>) -> Result<Self, Error> {
        let tile = Tile::picture(candidates.primitives.lines.frame.rays.size());
        let candidates = candidates.narrowed(&tile.sides(), |_| true, watch)?;
        Ok(Self { tile, candidates, growth: Growth::NONE })
    }

    /// The number of candidates that do not cover the tile.
    pub(super) fn open(&self) -> usize {
        self.candidates.list.iter().filter(|candidate| !candidate.covers()).count()
    }

    /// Whether the tile's candidates are few, or the tile cannot be divided into smaller ones with fewer.
    pub(super) fn is_short(&self) -> bool {
        self.candidates.list.len() <= SHORT || self.is_small(TINY)
    }

    /// Whether halving the tile is useless, or the tile is no larger than `least` steps.
    pub(super) fn is_small(&self, least: i64) -> bool {
        self.growth.is_too_much() || self.tile.is_within(least)
    }

    /// The two halves of the tile.
    pub(super) fn halves(&self, watch: &Watch<'_>) -> Result<[Self; 2], Error> {
        let half = |tile: Tile| {
            let candidates = self.candidates.narrowed(&tile.sides(), |_| true, watch)?;
            Ok(Self { tile, candidates, growth: Growth::NONE })
        };
        let [first, second] = self.tile.halves();
        let mut halves = [half(first)?, half(second)?];
        let growth = self.growth.after(self.open(), halves.each_ref().map(Self::open));
        halves.iter_mut().for_each(|half| half.growth = growth);
        Ok(halves)
    }
}

/// A visible convex part of an item: inside the picture, and with no opaque item in front. If all items are
/// opaque, these parts do not overlap.
#[derive(Clone, Debug)]
pub(super) struct Visible {
    pub(super) item: u32,
    pub(super) cell: Cell,
}

/// A tile that was not halved, and the visible parts of items in the tile.
#[derive(Debug)]
pub(super) struct Leaf {
    pub(super) tile: Tile,
    pub(super) cells: Vec<Visible>,
}

/// Lists longer than this are divided. Too small: more tiles, and more cells cut by borders of tiles (16: a
/// drawing of a scan takes 1.5 times as long). Too large: more cells compared with more items, though 128
/// would save another 2 to 4 %.
pub(super) const SHORT: usize = 64;

impl Leaf {
    /// Computes the visible parts of items in a tile.
    pub(super) fn new(list: &TileList<'_>, watch: &Watch<'_>) -> Result<Self, Error> {
        let TileList { tile, candidates, .. } = list;
        let primitives = candidates.primitives;
        let mut cells = Vec::new();
        if candidates.list.len() <= SHORT {
            let count = candidates.list.len();
            let mut area = OpenArea::new(tile.cell(&primitives.lines), count);
            for candidate in &candidates.list {
                watch.work(area.open.len() * CUT)?;
                let (item, halves) = (candidate.number, candidates.halves_of(candidate));
                area.subtract(item, candidates.around(item), halves, primitives, watch)?;
            }
            cells = area.cells;
        } else {
            let whole = SubTile::new(list, Passing::nothing(primitives.lines.frame.faces), watch)?;
            let see = |part: SubTile<'_, '_>| {
                cells.extend(part.visible(watch)?);
                Ok(())
            };
            whole.for_each_part(see, watch)?;
        }
        Ok(Self { tile: *tile, cells })
    }
}

/// A convex part of a tile, with its contents.
pub(super) struct SubTile<'l, 'p> {
    pub(super) candidates: &'l Candidates<'p>,
    pub(super) cell: Cell,
    /// The candidates, front to back and clipped to the part. If the candidates are faces, `item` is the
    /// number of a face.
    pub(super) pieces: Vec<Visible>,
    pub(super) passing: Passing<'l>,
    growth: Growth,
}

/// The number of edges, each from a different piece, that are tried to divide a part. Too small: parts are
/// divided unevenly, or not at all. Too large: choosing takes longer than it saves.
const TRIED: usize = 12;
/// The number of pieces that each tried edge is compared with. Too small: the choice is poor. Too large:
/// choosing takes longer.
const SAMPLE: usize = 48;

impl<'l, 'p> SubTile<'l, 'p> {
    /// The whole tile as one part, with the segments and points in the tile.
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

    /// Adds a piece behind all others. Returns whether the new piece hides pieces behind it.
    fn push(&mut self, piece: Visible) -> bool {
        let is_hiding = self.candidates.hides(piece.item) && self.is_covered_by(&piece);
        self.pieces.push(piece);
        is_hiding
    }

    /// Whether a piece covers the whole part.
    pub(super) fn is_covered_by(&self, piece: &Visible) -> bool {
        let (own, all) = (&piece.cell.sides, &self.cell.sides);
        let is_side = |half: HalfPlane| all.iter().any(|side| side.half == half);
        own.len() == all.len() && own.iter().all(|side| is_side(side.half))
    }

    /// Divides the part until lists are short, and calls a function with each smaller part.
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

    /// Chooses the edge that divides the pieces best. `None` for short lists, and if no edge leaves clearly
    /// fewer pieces on both sides.
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
            // Subtracting takes up to quadratic time.
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
        let mut area = OpenArea::new(self.cell, self.pieces.len());
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
    // Working space: the remaining parts of one open cell, and of all open cells that one piece was
    // subtracted from.
    outside: Vec<Cell>,
    left: Vec<Cell>,
}

impl OpenArea {
    /// An uncovered cell, from which some items will be subtracted.
    fn new(cell: Cell, items: usize) -> Self {
        let (mut open, mut boxes) = (Vec::with_capacity(SHORT), Vec::with_capacity(SHORT));
        boxes.push(cell.around());
        open.push(cell);
        let (outside, left) = (Vec::with_capacity(FEW_CORNERS), Vec::with_capacity(FEW_CORNERS));
        Self { open, boxes, cells: Vec::with_capacity(items), outside, left }
    }

    /// Adds the visible parts of an item with this bounding box. An opaque item is subtracted from the open
    /// cells.
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
