//! Tiles of the picture: rectangles that are halved until their contents are simple, on all threads.

use std::ops::Range;

use smallvec::SmallVec;

use super::cell::{Rect, are_apart, is_within, reaches_across};
use super::lines::{HalfPlane, LineTable, STEPS};
use super::map::{each, finish_item};
use super::primitives::{Item, Primitives};
use crate::memory::place;
use crate::progress::Watch;
use crate::{Error, parallel_map};

/// A rectangle of the picture, between borders in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) low: [i64; 2],
    pub(super) high: [i64; 2],
}

/// Where a box lies against a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Across {
    Inside,
    Outside,
    Maybe,
}

/// Tiles of this size, in steps, are not halved where long lists are divided afterwards: 2⁻⁴ of a pixel. Too small:
/// tiles around a vertex of many faces are halved again and again; too large: many small pieces are in one tile.
pub(super) const TINY: i64 = 1 << 20;
/// Nor are others of this size: 2⁻¹⁸ of a pixel.
pub(super) const TINIEST: i64 = 1 << 6;

/// How many times as many pieces the parts of a tile have together as the tile had before it was halved,
/// the same for the parts of a part, and so on: the product. Pieces that reach into both parts are in both.
///
/// All parts of a picture together have at most as many pieces as the picture, times the largest product among
/// them: dividing the pieces of each part by its product, the sum does not increase where a part is halved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth(f64);

/// Parts are not halved any more from this growth on. Many pieces may meet in a point, as at the tip of a cone, or
/// along a line, as the columns of a terrain do that is seen along its rows: halving would go on and on around it.
/// Too small: long lists remain; too large: many parts with the same pieces.
const MOST: f64 = 4.0;

impl Growth {
    pub(super) const NONE: Self = Self(1.0);

    /// That of parts with so many pieces of a part that had `all`.
    pub(super) fn after(self, all: usize, parts: [usize; 2]) -> Self {
        let growth = (parts[0] + parts[1]) as f64 / all.max(1) as f64;
        Self((self.0 * growth).max(1.0))
    }

    pub(super) fn is_too_much(self) -> bool {
        self.0 >= MOST
    }
}

impl Tile {
    /// All of a picture.
    pub(super) fn picture(size: [u32; 2]) -> Self {
        Self { low: [0; 2], high: size.map(|side| STEPS as i64 * i64::from(side)) }
    }

    /// Its halves, across its longer side: a little beside the middle, at an odd number of steps. What a camera looks
    /// at is often right in the middle of the picture, and what lies on a border by chance is told by integers.
    pub(super) fn halves(&self) -> [Self; 2] {
        let size = [0, 1].map(|axis: usize| self.high[axis] - self.low[axis]);
        let axis = usize::from(size[1] > size[0]);
        let middle = (self.low[axis] + size[axis] / 32 * 17) | 1;
        let mut parts = [*self; 2];
        parts[0].high[axis] = middle;
        parts[1].low[axis] = middle;
        parts
    }

    /// Whether a half's line is one of its borders.
    pub(super) fn has_border(&self, half: HalfPlane) -> bool {
        half.number().is_none() && {
            let (axis, steps) = half.border();
            steps == self.low[axis] || steps == self.high[axis]
        }
    }

    /// Whether it is at most so many steps wide and high.
    pub(super) fn is_within(&self, size: i64) -> bool {
        (0..2).all(|axis| self.high[axis] - self.low[axis] <= size)
    }

    /// Its sides in pixels: exact.
    pub(super) fn sides(&self) -> Rect {
        [self.low, self.high].map(|end| end.map(|steps| steps as f64 / STEPS))
    }
}

impl LineTable<'_> {
    /// Where a box lies against a half.
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

/// So often both halves of a part are offered to all threads; deeper, one goes on alone.
const SHARED: usize = 6;
/// To compare an item with a tile takes as long as a build takes to examine so many pieces.
pub(super) const NARROWED: usize = 8;
/// So does cutting a cell with an item.
pub(super) const CUT: usize = 64;
/// And making the lines of a piece.
pub(super) const LINES: usize = 64;
/// And visiting a node of a graph.
pub(super) const VISITED: usize = 4;

/// Halves a part again and again, until `halves` gives none, and lets `leaf` add what it finds there: to one
/// `new` thing for each of the parts that are shared out to threads. What is found, and in which order, does
/// not depend on how many threads there are. It is one phase of the operation that is watched.
pub(super) fn found_in<P: Send, F: Send>(
    all: P,
    new: impl Fn() -> F + Sync,
    halves: impl Fn(&P, &mut F) -> Result<Option<[P; 2]>, Error> + Sync,
    leaf: impl Fn(&P, &mut F) -> Result<(), Error> + Sync,
    watch: &Watch<'_>,
) -> Result<Vec<F>, Error> {
    shared(all, 0..1 << SHARED, &new, &halves, &leaf, watch)
}

/// What is found in a part that stands for these of the shares. Both halves of it are for whichever threads are
/// free: none waits until all parts of a size are halved.
fn shared<P: Send, F: Send>(
    part: P,
    shares: Range<usize>,
    new: &(impl Fn() -> F + Sync),
    halves: &(impl Fn(&P, &mut F) -> Result<Option<[P; 2]>, Error> + Sync),
    leaf: &(impl Fn(&P, &mut F) -> Result<(), Error> + Sync),
    watch: &Watch<'_>,
) -> Result<Vec<F>, Error> {
    let parts = if shares.len() == 1 { None } else { halves(&part, &mut new())? };
    let Some([first, second]) = parts else {
        let found = alone(part, new(), halves, leaf)?;
        shares.for_each(|i| finish_item(watch, i, 1 << SHARED));
        return Ok(vec![found]);
    };
    drop(part);
    let middle = shares.start + shares.len() / 2;
    let parts = vec![(first, shares.start..middle), (second, middle..shares.end)];
    let found = |(part, shares)| shared(part, shares, new, halves, leaf, watch);
    let mut all = Vec::new();
    for mut part in parallel_map::map(parts, found)? {
        all.reserve(part.len());
        all.append(&mut part);
    }
    Ok(all)
}

/// What one thread finds in a part.
fn alone<P, F>(
    part: P,
    mut found: F,
    halves: &impl Fn(&P, &mut F) -> Result<Option<[P; 2]>, Error>,
    leaf: &impl Fn(&P, &mut F) -> Result<(), Error>,
) -> Result<F, Error> {
    let mut stack = vec![part];
    while let Some(part) = stack.pop() {
        match halves(&part, &mut found)? {
            Some([first, second]) => {
                stack.push(second);
                stack.push(first);
            }
            None => leaf(&part, &mut found)?,
        }
    }
    Ok(found)
}

/// Of so many faces at most, the front ones, it is asked whether all their pieces cover a tile.
const FACES: usize = 8;

/// Items that may show in a tile, front to back.
#[derive(Debug)]
pub(super) struct List {
    pub(super) items: Vec<u32>,
    /// Items behind this one are missing from the list: they are hidden.
    limit: u32,
}

impl List {
    /// What of all items may show in a tile.
    pub(super) fn of_all(
        primitives: &Primitives<'_>,
        tile: Tile,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut narrow = Narrow::new(primitives, tile, u32::MAX, primitives.items.len());
        for item in each(watch, NARROWED, 0..primitives.items.len() as u32) {
            if !narrow.add(item?) {
                break;
            }
        }
        narrow.finish(watch)
    }

    /// What of the list may show in a part of the tile.
    pub(super) fn narrowed(
        &self,
        primitives: &Primitives<'_>,
        tile: Tile,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut narrow = Narrow::new(primitives, tile, self.limit, self.items.len());
        for item in each(watch, NARROWED, &self.items) {
            if !narrow.add(*item?) {
                break;
            }
        }
        narrow.finish(watch)
    }
}

/// Makes the list of a tile.
struct Narrow<'a, 't> {
    primitives: &'a Primitives<'t>,
    sides: Rect,
    list: List,
}

impl<'a, 't> Narrow<'a, 't> {
    /// The list will be of so many items at most, none behind `limit`.
    fn new(primitives: &'a Primitives<'t>, tile: Tile, limit: u32, most: usize) -> Narrow<'a, 't> {
        let items = Vec::with_capacity(most);
        Self { primitives, sides: tile.sides(), list: List { items, limit } }
    }

    /// Adds an item unless it is certain that the tile shows nothing of it; false if no item behind it can
    /// show.
    fn add(&mut self, item: u32) -> bool {
        let Self { primitives, sides, list } = self;
        if item > list.limit {
            return false;
        }
        let Item { ref around, .. } = primitives.items[item as usize];
        if are_apart(sides, around) {
            return true;
        }
        // Lines are looked at only where they may tell more than boxes.
        if reaches_across(around, sides) {
            match primitives.across(primitives.halves(item), sides) {
                Across::Inside if primitives.is_opaque(item) => list.limit = item,
                Across::Outside => return true,
                Across::Inside | Across::Maybe => {}
            }
        }
        list.items.push(item);
        item < list.limit
    }

    /// Ends the list with the last piece of a face that covers the tile, in however many pieces.
    fn finish(self, watch: &Watch<'_>) -> Result<List, Error> {
        let Self { primitives, sides, mut list } = self;
        let mut end = list.limit;
        let mut tried: SmallVec<[u32; FACES]> = SmallVec::new();
        for (place, &item) in list.items.iter().enumerate() {
            if item >= end || tried.len() == FACES {
                break;
            }
            let face = primitives.face(item);
            // If pieces of it are missing from the list, the others alone may not cover the tile.
            if tried.contains(&face)
                || !primitives.is_opaque(item)
                || primitives.views[face as usize].last > list.limit
                || !primitives.covers(face, &sides)
            {
                continue;
            }
            tried.push(face);
            watch.work(list.items.len() - place)?;
            let mut siblings =
                list.items[place..].iter().filter(|&&other| primitives.face(other) == face);
            end = siblings.next_back().map_or(end, |&last| end.min(last));
        }
        list.limit = end;
        let len = list.items.partition_point(|&item| item <= end);
        list.items.truncate(len);
        Ok(list)
    }
}

/// A piece, with those of its lines that may cross a part of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// What the caller gave it: the number of an item, or of a face that is taken whole.
    pub(super) number: u32,
    halves: [u32; 2],
}

impl Reach {
    /// Whether it covers the whole part.
    pub(super) const fn covers(&self) -> bool {
        self.halves[0] == self.halves[1]
    }
}

/// The pieces that may reach into a part of the picture.
#[derive(Debug, Default)]
pub(super) struct Reaches {
    pub(super) list: Vec<Reach>,
    halves: Vec<HalfPlane>,
}

impl Reaches {
    /// Adds a piece.
    pub(super) fn push(&mut self, number: u32, halves: &[HalfPlane]) -> Result<(), Error> {
        let start = place(self.halves.len())?;
        self.halves.reserve(halves.len());
        self.halves.extend_from_slice(halves);
        self.list.push(Reach { number, halves: [start, place(self.halves.len())?] });
        Ok(())
    }

    pub(super) fn halves_of(&self, reach: &Reach) -> &[HalfPlane] {
        let [start, end] = reach.halves;
        &self.halves[start as usize..end as usize]
    }

    /// Those that may reach into a box; `around` gives a box around a piece.
    pub(super) fn narrowed(
        &self,
        lines: &LineTable<'_>,
        sides: &Rect,
        around: impl Fn(u32) -> Rect,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut part = Self::default();
        'pieces: for reach in each(watch, NARROWED, &self.list) {
            let reach = reach?;
            let around = around(reach.number);
            if are_apart(sides, &around) {
                continue;
            }
            if is_within(&around, sides) {
                part.push(reach.number, self.halves_of(reach))?;
                continue;
            }
            let mut kept: SmallVec<[HalfPlane; 8]> = SmallVec::new();
            for &half in self.halves_of(reach) {
                match lines.across(half, sides) {
                    Across::Inside => {}
                    Across::Outside => continue 'pieces,
                    Across::Maybe => kept.push(half),
                }
            }
            part.push(reach.number, &kept)?;
        }
        Ok(part)
    }
}
