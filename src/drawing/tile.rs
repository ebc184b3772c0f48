//! What is visible in a picture, found tile by tile.
//!
//! A tile has a list of the pieces that may show in it, front to back. It ends with the first that
//! covers the tile. Where it is short, the tile is a leaf, and what is visible of each piece is
//! subtracted from what is left open; else the tile is halved (J. E. Warnock, "A hidden surface
//! algorithm for computer generated halftone pictures", 1969; with exact leaves in place of pixels).

use smallvec::SmallVec;

use super::cell::{Cell, are_apart};
use super::lines::{Half, Lines, STEPS};
use super::stock::Stock;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{place, push, reserve};
use crate::parallel_map;

/// A rectangle of the picture, between borders in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) low: [i64; 2],
    pub(super) high: [i64; 2],
}

/// A part of what is visible: all of it in the picture, and none of it shown by another item.
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

/// Tiles with longer lists are halved. Smaller: more tiles, and more cells cut by their borders (16:
/// half as much again for all of a drawing of a scan); larger: more cells compared with more items,
/// though 128 would win another 2 to 4 %.
const SHORT: usize = 64;
/// Tiles that were halved in vain so often are leaves. Many items may meet along a line of the picture,
/// as the columns of a terrain do that is seen along its rows: halving would go on and on along it.
pub(super) const IN_VAIN: u32 = 3;
/// Tiles of this size, in steps, are not halved: 2⁻¹⁸ of a pixel.
const TINY: i64 = 64;
/// Of so many faces at most, the front ones, it is asked whether all their pieces cover a tile.
const FACES: usize = 8;
/// Tiles are shared out to threads after so many halvings.
const SHARED: usize = 6;

/// To compare an item with a tile takes as long as a build takes to examine so many pieces.
pub(super) const NARROWED: usize = 8;
/// So does cutting a cell with an item.
pub(super) const CUT: usize = 64;

/// A tile with the pieces that may show in it.
#[derive(Debug)]
struct Entry {
    tile: Tile,
    list: List,
    /// Items behind this one are missing from the list: they are hidden.
    limit: u32,
    /// How often it was halved in vain: both parts had nearly all items.
    in_vain: u32,
}

/// Items, front to back, each with those of its lines that may cross a tile.
#[derive(Debug, Default)]
struct List {
    items: Vec<Listed>,
    halves: Vec<Half>,
}

#[derive(Clone, Copy, Debug)]
struct Listed {
    item: u32,
    /// Where the halves that bound the whole face begin, then those of its cuts, and where they end.
    halves: [u32; 3],
}

impl Tile {
    /// All of a picture.
    pub(super) fn picture(size: [u32; 2]) -> Self {
        let half = (STEPS / 2.0) as i64;
        let high = size.map(|side| 2 * half * i64::from(side) - half);
        Self { low: [-half; 2], high }
    }

    /// Its halves, across its longer side.
    pub(super) fn halves(&self) -> [Self; 2] {
        let size = [0, 1].map(|axis: usize| self.high[axis] - self.low[axis]);
        let axis = usize::from(size[1] > size[0]);
        let middle = self.low[axis] + size[axis] / 2;
        let mut parts = [*self; 2];
        parts[0].high[axis] = middle;
        parts[1].low[axis] = middle;
        parts
    }

    /// Whether it is too small to be halved.
    pub(super) fn is_tiny(&self) -> bool {
        (0..2).all(|axis| self.high[axis] - self.low[axis] <= TINY)
    }

    /// Its sides in pixels: exact.
    pub(super) fn sides(&self) -> [[f64; 2]; 2] {
        [self.low, self.high].map(|end| end.map(|steps| steps as f64 / STEPS))
    }
}

/// How often both parts of a tile were halved in vain, of so many items: both have nearly all of them.
/// A part that has many more than half of them keeps the count.
pub(super) fn in_vain(before: u32, all: usize, parts: [usize; 2]) -> [u32; 2] {
    let is_in_vain = parts.iter().all(|part| part * 8 >= all * 7);
    parts.map(|part| match is_in_vain {
        true => before + 1,
        false if part * 8 >= all * 6 => before,
        false => 0,
    })
}

/// What is visible of all items, in the order of the tiles: the same for any number of threads.
pub(super) fn visible(
    stock: &Stock<'_>,
    picture: Tile,
    watch: &Watch<'_>,
) -> Result<Vec<Leaf>, Error> {
    let all = Entry::of_picture(stock, picture)?;
    let mut shares = vec![all];
    for _ in 0..SHARED {
        let mut next = Vec::with_capacity(2 * shares.len());
        for entry in shares {
            if entry.is_leaf() {
                next.push(entry);
                continue;
            }
            watch.work(entry.list.items.len() * NARROWED)?;
            next.extend(entry.halves(stock)?);
        }
        shares = next;
    }
    watch.expect(shares.len())?;
    let parts = parallel_map::map(shares, |entry| {
        let leaves = leaves(stock, entry, watch);
        watch.finish(0);
        leaves
    });
    let mut all = Vec::new();
    for part in parts {
        let mut part = part?;
        reserve(&mut all, part.len())?;
        all.append(&mut part);
    }
    watch.end()?;
    Ok(all)
}

/// The leaves of a tile.
fn leaves(stock: &Stock<'_>, entry: Entry, watch: &Watch<'_>) -> Result<Vec<Leaf>, Error> {
    let (mut stack, mut leaves) = (vec![entry], Vec::new());
    while let Some(entry) = stack.pop() {
        if entry.list.items.is_empty() {
            continue;
        }
        if entry.is_leaf() {
            reserve(&mut leaves, 1)?;
            leaves.push(entry.leaf(stock, watch)?);
            continue;
        }
        watch.work(entry.list.items.len() * NARROWED)?;
        let [first, second] = entry.halves(stock)?;
        stack.push(second);
        stack.push(first);
    }
    Ok(leaves)
}

impl Entry {
    /// The whole picture with all items.
    fn of_picture(stock: &Stock<'_>, tile: Tile) -> Result<Self, Error> {
        let mut builder = Narrow::new(stock, tile, u32::MAX, &List::default())?;
        for (number, item) in (0..).zip(&stock.items) {
            let rim = stock.outline(item.seen);
            if !builder.add(number, rim, stock.cuts(number))? {
                break;
            }
        }
        Ok(builder.finish())
    }

    /// Both halves of the tile, each with what may show in it.
    fn halves(&self, stock: &Stock<'_>) -> Result<[Self; 2], Error> {
        let [first, second] = self.tile.halves();
        let mut parts = [self.narrowed(stock, first)?, self.narrowed(stock, second)?];
        let [all, first, second] = [self, &parts[0], &parts[1]].map(|entry| entry.list.items.len());
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, all, [first, second]);
        Ok(parts)
    }

    /// What of the list may show in a part of the tile.
    fn narrowed(&self, stock: &Stock<'_>, tile: Tile) -> Result<Self, Error> {
        let mut builder = Narrow::new(stock, tile, self.limit, &self.list)?;
        for listed in &self.list.items {
            let [start, cuts, end] = listed.halves.map(|place| place as usize);
            let (rim, cuts) = (&self.list.halves[start..cuts], &self.list.halves[cuts..end]);
            if !builder.add(listed.item, rim, cuts)? {
                break;
            }
        }
        Ok(builder.finish())
    }

    /// Whether the tile need not be halved.
    fn is_leaf(&self) -> bool {
        let items = &self.list.items;
        items.len() <= SHORT || self.in_vain == IN_VAIN || self.tile.is_tiny()
    }

    /// Takes what each piece shows from what is left open of the tile.
    fn leaf(&self, stock: &Stock<'_>, watch: &Watch<'_>) -> Result<Leaf, Error> {
        let Self { tile, list, .. } = self;
        let lines = &stock.lines;
        let mut open = vec![Open::new(Cell::rectangle(lines, tile.low, tile.high))];
        let (mut left, mut outside) = (Vec::new(), Vec::new());
        let mut cells = Vec::new();
        for listed in &list.items {
            if open.is_empty() {
                break;
            }
            watch.work(open.len() * CUT)?;
            let region = &stock.seen[stock.seen_of(listed.item) as usize].region;
            let halves = list.halves_of(listed);
            let mut i = 0;
            while let Some(Open { cell, around }) = open.get(i) {
                // Where nothing of the piece is, there is no need to cut the cell.
                let shown = match are_apart(around, region) {
                    true => None,
                    false => cell.within(lines, halves, Some(&mut outside))?,
                };
                match shown {
                    Some(cell) => {
                        push(&mut cells, Visible { item: listed.item, cell })?;
                        open.swap_remove(i);
                        reserve(&mut left, outside.len())?;
                        left.append(&mut outside);
                    }
                    None => {
                        outside.clear();
                        i += 1;
                    }
                }
            }
            reserve(&mut open, left.len())?;
            open.extend(left.drain(..).map(Open::new));
        }
        Ok(Leaf { tile: *tile, cells })
    }
}

/// A part of a tile where nothing shows so far.
struct Open {
    cell: Cell,
    around: [[f64; 2]; 2],
}

impl Open {
    fn new(cell: Cell) -> Self {
        Self { around: cell.region(), cell }
    }
}

impl List {
    fn halves_of(&self, listed: &Listed) -> &[Half] {
        let [start, _, end] = listed.halves;
        &self.halves[start as usize..end as usize]
    }
}

/// Makes the list of a tile.
struct Narrow<'a, 'b> {
    stock: &'a Stock<'b>,
    tile: Tile,
    sides: [[f64; 2]; 2],
    list: List,
    limit: u32,
}

impl<'a, 'b> Narrow<'a, 'b> {
    /// The list will be a part of another.
    fn new(stock: &'a Stock<'b>, tile: Tile, limit: u32, whole: &List) -> Result<Self, Error> {
        let mut list = List::default();
        reserve(&mut list.items, whole.items.len())?;
        reserve(&mut list.halves, whole.halves.len())?;
        Ok(Self { stock, tile, sides: tile.sides(), list, limit })
    }

    /// Adds an item, with the lines of its face and its cuts that may cross the tile, unless it is
    /// certain that the tile shows nothing of it; false if no item behind it can show.
    fn add(&mut self, item: u32, rim: &[Half], cuts: &[Half]) -> Result<bool, Error> {
        if item > self.limit {
            return Ok(false);
        }
        let Self { stock, sides, list, .. } = self;
        if are_apart(sides, &stock.seen[stock.seen_of(item) as usize].region) {
            return Ok(true);
        }
        let start = list.halves.len();
        let mut middle = start;
        for (is_rim, halves) in [(true, rim), (false, cuts)] {
            for &half in halves {
                match stock.lines.across(half, sides) {
                    Across::Inside => continue,
                    Across::Outside => {
                        list.halves.truncate(start);
                        return Ok(true);
                    }
                    Across::Maybe => {}
                }
                reserve(&mut list.halves, 1)?;
                list.halves.push(half);
                middle += usize::from(is_rim);
            }
        }
        let halves = [place(start)?, place(middle)?, place(list.halves.len())?];
        reserve(&mut list.items, 1)?;
        list.items.push(Listed { item, halves });
        if start == list.halves.len() {
            // It covers the tile.
            self.limit = item;
        }
        Ok(item < self.limit)
    }

    fn finish(mut self) -> Entry {
        self.cover_by_faces();
        let Self { tile, list, limit, .. } = self;
        Entry { tile, list, limit, in_vain: 0 }
    }

    /// Ends the list with the last piece of a face that covers the tile, in however many pieces.
    fn cover_by_faces(&mut self) {
        let Self { stock, list, limit, .. } = self;
        let seen = |listed: &Listed| stock.items[listed.item as usize].seen;
        let mut end = *limit;
        let mut tried: SmallVec<[u32; 8]> = SmallVec::new();
        for (place, listed) in list.items.iter().enumerate() {
            if listed.item >= end || tried.len() == FACES {
                break;
            }
            let [start, cuts, _] = listed.halves;
            let face = seen(listed);
            // If pieces of it are missing from the list, the others alone may not cover the tile.
            if start < cuts || tried.contains(&face) || stock.seen[face as usize].last > *limit {
                continue;
            }
            tried.push(face);
            let mut siblings = list.items[place..].iter().filter(|other| seen(other) == face);
            end = siblings.next_back().map_or(end, |last| end.min(last.item));
        }
        *limit = end;
        let len = list.items.partition_point(|listed| listed.item <= end);
        list.items.truncate(len);
    }
}

/// Where a tile lies against a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Across {
    Inside,
    Outside,
    Maybe,
}

impl Lines<'_> {
    /// Where a box lies against a half.
    pub(super) fn across(&self, half: Half, [low, high]: &[[f64; 2]; 2]) -> Across {
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
