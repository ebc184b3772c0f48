//! Drawings of opaque polygons.

use std::ops::ControlFlow;

use super::above::pairs;
use super::cell::Cell;
use super::halving::CUT;
use super::map::VisibilityMap;
use super::order::{Ordered, order};
use super::paths::{Drawing, add_edges, add_sides};
use super::stock::Stock;
use super::translucent::mixed;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::Progress;
use crate::build::progress::{Watch, one_at_a_time};
use crate::memory::{collect, push, reserve};

impl VisibilityMap<'_> {
    /// The view as filled outlines, one for each opaque polygon that shows.
    ///
    /// Polygons are drawn whole, each before those that show above it. A few that are in cycles with
    /// others, none in most scenes, are clipped: only what shows of them is drawn.
    ///
    /// Translucent polygons are painted over what is behind them. A few that lie before and behind others
    /// in a circle are in several paths, as in [`Drawing::translucent`]; each point that shows of one is in
    /// one path. Time and memory go up with the square of how many translucent polygons lie over
    /// one another; where all are translucent, `Drawing::translucent` takes less.
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn drawing(&self) -> Result<Drawing, Error> {
        self.drawn(&Watch::default())
    }

    /// As [`drawing`](Self::drawing). Now and then `progress` is called with how far the drawing has come,
    /// by any thread, one at a time; if it returns `Break`, the drawing is cancelled.
    ///
    /// # Errors
    ///
    /// As for `drawing`, and [`Error`] if it was cancelled.
    pub fn drawing_with_progress(
        &self,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<Drawing, Error> {
        let progress = one_at_a_time(progress);
        self.drawn(&Watch::new(&progress))
    }

    fn drawn(&self, watch: &Watch<'_>) -> Result<Drawing, Error> {
        let Self { stock, leaves } = self;
        if stock.has_translucent() {
            return mixed(stock, leaves, watch);
        }
        let size = self.size();
        let shown = Nodes::of(stock, leaves)?;
        let place = |seen: u32| shown.places[seen as usize];
        let pairs = pairs(stock, leaves, &place, watch)?;
        let Ordered { order, is_clipped } =
            order(shown.polygons.len(), &pairs, &shown.ranks, &|_| true, watch)?;
        let mut drawing = Drawing::empty(size);
        let cells = shown.cells(stock, leaves, &is_clipped)?;
        reserve(&mut drawing.paths, order.len())?;
        let mut edges = Vec::new();
        for node in order {
            watch.work(CUT)?;
            let index = node as usize;
            edges.clear();
            if is_clipped[index] {
                for cell in &cells[index] {
                    add_sides(cell, &mut edges)?;
                }
            } else {
                for &seen in &shown.faces[index] {
                    add_edges(stock, stock.outline(seen), &mut edges)?;
                }
            }
            drawing.push(shown.polygons[index], is_clipped[index], &edges)?;
        }
        Ok(drawing)
    }
}

/// The polygons that show.
struct Nodes {
    polygons: Vec<usize>,
    /// The place of each face's polygon in the list; `u32::MAX` for those that do not show.
    places: Vec<u32>,
    /// The faces of each polygon that the camera sees, whether they show or not.
    faces: Vec<Vec<u32>>,
    /// How many items lie behind the polygon.
    ranks: Vec<u32>,
}

impl Nodes {
    fn of(stock: &Stock<'_>, leaves: &[Leaf]) -> Result<Self, Error> {
        let faces = stock.lines.frame.faces;
        let polygon = |seen: u32| faces.polygon(stock.seen[seen as usize].face);
        let most = (0..stock.seen.len() as u32).map(polygon).max().map_or(0, |most| most + 1);
        let mut last: Vec<Option<u32>> = collect((0..most).map(|_| None))?;
        for Visible { item, .. } in leaves.iter().flat_map(|leaf| &leaf.cells) {
            let last = &mut last[stock.polygon(*item)];
            *last = (*last).max(Some(*item));
        }
        let mut shown = Self { polygons: vec![], places: vec![], faces: vec![], ranks: vec![] };
        let mut numbers: Vec<u32> = collect((0..most).map(|_| u32::MAX))?;
        for (polygon, last) in last.iter().enumerate() {
            let Some(last) = last else { continue };
            numbers[polygon] = shown.polygons.len() as u32;
            push(&mut shown.polygons, polygon)?;
            push(&mut shown.faces, vec![])?;
            push(&mut shown.ranks, stock.items.len() as u32 - last)?;
        }
        for seen in 0..stock.seen.len() as u32 {
            let number = numbers[polygon(seen)];
            push(&mut shown.places, number)?;
            if number != u32::MAX {
                push(&mut shown.faces[number as usize], seen)?;
            }
        }
        Ok(shown)
    }

    /// The cells of the polygons that are clipped.
    fn cells<'l>(
        &self,
        stock: &Stock<'_>,
        leaves: &'l [Leaf],
        is_clipped: &[bool],
    ) -> Result<Vec<Vec<&'l Cell>>, Error> {
        let mut cells: Vec<Vec<&Cell>> = collect(self.polygons.iter().map(|_| vec![]))?;
        for Visible { item, cell } in leaves.iter().flat_map(|leaf| &leaf.cells) {
            let place = self.places[stock.items[*item as usize].seen as usize] as usize;
            if is_clipped[place] {
                push(&mut cells[place], cell)?;
            }
        }
        Ok(cells)
    }
}
