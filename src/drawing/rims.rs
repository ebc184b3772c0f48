//! The lines that bound pieces, made when they are asked for.

use smallvec::SmallVec;

use super::half::Half;
use super::lines::Lines;
use super::rect::{Rect, is_within};
use super::stock::{Item, Stock, View};
use super::table::{Table, insert};
use super::tile::Across;
use crate::Error;
use crate::memory::{place, push, reserve};

/// The halves that bound faces and items, of those that someone asked for.
///
/// Most of what is hidden is never asked for. Parts of a picture that several threads look at have rims
/// each, with numbers of their own for lines.
#[derive(Debug)]
pub(super) struct Rims<'t> {
    pub(super) lines: Lines<'t>,
    halves: Vec<Half>,
    of_faces: Table<u32, [u32; 2]>,
    of_items: Table<u32, [u32; 2]>,
}

impl<'t> Rims<'t> {
    /// None so far.
    pub(super) fn new(stock: &Stock<'t>) -> Self {
        let lines = Lines::new(stock.frame.clone());
        Self { lines, halves: vec![], of_faces: Table::default(), of_items: Table::default() }
    }

    /// The halves that bound a whole face: its edges, one after another.
    ///
    /// No ray from an eye is in all of them that meets the face's plane behind the eye: the point where it
    /// does would be outside of every edge of a bounded convex polygon. Nor is one along the plane.
    pub(super) fn outline(&mut self, stock: &Stock<'_>, face: u32) -> Result<&[Half], Error> {
        let ends = self.outline_place(stock, face)?;
        Ok(self.at(ends))
    }

    /// The same, if it was asked for before; else none.
    pub(super) fn known_outline(&self, face: u32) -> &[Half] {
        self.of_faces.get(&face).map_or(&[], |&ends| self.at(ends))
    }

    /// The halves that bound an item.
    pub(super) fn item(&mut self, stock: &Stock<'_>, item: u32) -> Result<&[Half], Error> {
        let ends = self.item_place(stock, item)?;
        Ok(self.at(ends))
    }

    /// The same of an item that was asked for before, or is a whole face whose outline was.
    pub(super) fn known_item(&self, stock: &Stock<'_>, item: u32) -> &[Half] {
        match self.of_items.get(&item) {
            Some(&ends) => self.at(ends),
            None => {
                debug_assert!(stock.fragment(item).is_whole(), "item {item} was not asked for");
                self.known_outline(stock.face(item))
            }
        }
    }

    /// Where a box lies against an item: inside, the item covers it.
    pub(super) fn across_item(
        &mut self,
        stock: &Stock<'_>,
        item: u32,
        sides: &Rect,
    ) -> Result<Across, Error> {
        let ends = self.item_place(stock, item)?;
        Ok(self.across(ends, sides))
    }

    /// The halves of an item whose lines may cross a box; `None` if the item certainly lies beside it.
    pub(super) fn crossing(
        &mut self,
        stock: &Stock<'_>,
        item: u32,
        sides: &Rect,
    ) -> Result<Option<SmallVec<[Half; 8]>>, Error> {
        let ends = self.item_place(stock, item)?;
        if is_within(&stock.items[item as usize].around, sides) {
            return Ok(Some(SmallVec::from_slice(self.at(ends))));
        }
        let mut crossing = SmallVec::new();
        for &half in self.at(ends) {
            match self.lines.across(half, sides) {
                Across::Inside => {}
                Across::Outside => return Ok(None),
                Across::Maybe => crossing.push(half),
            }
        }
        Ok(Some(crossing))
    }

    /// Whether a face certainly covers a box.
    pub(super) fn covers(
        &mut self,
        stock: &Stock<'_>,
        face: u32,
        sides: &Rect,
    ) -> Result<bool, Error> {
        if !is_within(sides, &stock.views[face as usize].around) {
            return Ok(false);
        }
        let ends = self.outline_place(stock, face)?;
        Ok(self.across(ends, sides) == Across::Inside)
    }

    fn across(&self, ends: [u32; 2], sides: &Rect) -> Across {
        let mut all = Across::Inside;
        for &half in self.at(ends) {
            match self.lines.across(half, sides) {
                Across::Inside => {}
                Across::Outside => return Across::Outside,
                Across::Maybe => all = Across::Maybe,
            }
        }
        all
    }

    fn at(&self, [start, end]: [u32; 2]) -> &[Half] {
        &self.halves[start as usize..end as usize]
    }

    fn outline_place(&mut self, stock: &Stock<'_>, face: u32) -> Result<[u32; 2], Error> {
        if let Some(&ends) = self.of_faces.get(&face) {
            return Ok(ends);
        }
        let Self { lines, halves, .. } = self;
        let View { is_positive, .. } = stock.views[face as usize];
        let start = place(halves.len())?;
        for k in 0..stock.frame.faces.corners(face).len() as u32 {
            push(halves, lines.edge(face, k, is_positive)?)?;
        }
        let ends = [start, place(halves.len())?];
        insert(&mut self.of_faces, face, ends)?;
        Ok(ends)
    }

    fn item_place(&mut self, stock: &Stock<'_>, item: u32) -> Result<[u32; 2], Error> {
        if let Some(&ends) = self.of_items.get(&item) {
            return Ok(ends);
        }
        let Item { face, .. } = stock.items[item as usize];
        let rim = self.outline_place(stock, face)?;
        let fragment = stock.fragment(item);
        if fragment.is_whole() {
            return Ok(rim);
        }
        let start = self.halves.len();
        // All edges of the face: one that passes by the piece's box may still be what keeps a piece out that
        // is beside the picture, whose box is not empty.
        reserve(&mut self.halves, (rim[1] - rim[0]) as usize)?;
        self.halves.extend_from_within(rim[0] as usize..rim[1] as usize);
        let View { is_positive, .. } = stock.views[face as usize];
        for line in fragment.lines() {
            let Some(plane) = line.as_cut() else { continue };
            push(&mut self.halves, self.lines.cut(face, plane, line.is_behind(), is_positive)?)?;
        }
        let ends = [place(start)?, place(self.halves.len())?];
        insert(&mut self.of_items, item, ends)?;
        Ok(ends)
    }
}
