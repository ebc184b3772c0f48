//! Drawings of opaque polygons.

use super::above::pairs;
use super::cell::Cell;
use super::halving::{CUT, VISITED};
use super::map::VisibilityMap;
use super::order::{Ordered, order};
use super::outline::Area;
use super::paths::{Drawing, add_piece};
use super::reporter::{each, finish_item};
use super::stock::Stock;
use super::translucent::mixed;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, push};
use crate::parallel_map;

/// So many paths are made by one thread.
const SHARE: usize = 256;

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
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn drawing(&self) -> Result<Drawing, Error> {
        self.reporter.watch(2, |watch| self.drawn(watch))
    }

    fn drawn(&self, watch: &Watch<'_>) -> Result<Drawing, Error> {
        let Self { stock, rims, leaves, .. } = self;
        if stock.has_translucent() {
            return mixed(stock, rims, leaves, watch);
        }
        let size = self.size();
        let shown = Nodes::of(stock, leaves, watch)?;
        let place = |face: u32| shown.places[face as usize];
        let pairs = pairs(stock, rims, leaves, &place, watch)?;
        let Ordered { order, is_clipped } =
            order(shown.polygons.len(), &pairs, &shown.ranks, &|_| true, watch)?;
        let cells = shown.cells(stock, leaves, &is_clipped, watch)?;
        let shares: Vec<_> = order.chunks(SHARE).enumerate().collect();
        let count = shares.len();
        let part = |(i, nodes): (usize, &[u32])| {
            let (mut part, mut area) = (Drawing::empty(size), Area::default());
            for &node in nodes {
                watch.work(CUT)?;
                let index = node as usize;
                area.clear();
                if is_clipped[index] {
                    for cell in each(watch, VISITED, &cells[index]) {
                        area.push(&cell?.sides)?;
                    }
                } else {
                    for face in each(watch, CUT, &shown.faces[index]) {
                        let face = *face?;
                        add_piece(&rims.lines, rims.known_outline(face), &mut area, watch)?;
                    }
                }
                let polygon = shown.polygons[index];
                part.push(polygon, is_clipped[index], &area, &rims.lines, watch)?;
            }
            finish_item(watch, i, count);
            Ok(part)
        };
        let mut drawing = Drawing::empty(size);
        for part in parallel_map::map(shares, part)? {
            watch.work(SHARE)?;
            drawing.append(part)?;
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
    fn of(stock: &Stock<'_>, leaves: &[Leaf], watch: &Watch<'_>) -> Result<Self, Error> {
        let faces = stock.frame.faces;
        let most = stock.polygons_end(watch)?;
        let mut last: Vec<Option<u32>> = collect((0..most).map(|_| None))?;
        for visible in each(watch, 1, leaves.iter().flat_map(|leaf| &leaf.cells)) {
            let item = visible?.item;
            let last = &mut last[stock.polygon(item)];
            *last = (*last).max(Some(item));
        }
        let mut shown = Self { polygons: vec![], places: vec![], faces: vec![], ranks: vec![] };
        let mut numbers: Vec<u32> = collect((0..most).map(|_| u32::MAX))?;
        for named in each(watch, 1, last.iter().enumerate()) {
            let (polygon, last) = named?;
            let Some(last) = last else { continue };
            numbers[polygon] = shown.polygons.len() as u32;
            push(&mut shown.polygons, polygon)?;
            push(&mut shown.faces, vec![])?;
            push(&mut shown.ranks, stock.items.len() as u32 - last)?;
        }
        for face in each(watch, 1, 0..faces.len() as u32) {
            let face = face?;
            let number = match stock.sees(face) {
                true => numbers[faces.polygon(face)],
                false => u32::MAX,
            };
            push(&mut shown.places, number)?;
            if number != u32::MAX {
                push(&mut shown.faces[number as usize], face)?;
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
        watch: &Watch<'_>,
    ) -> Result<Vec<Vec<&'l Cell>>, Error> {
        let mut cells: Vec<Vec<&Cell>> = collect(self.polygons.iter().map(|_| vec![]))?;
        for visible in each(watch, 1, leaves.iter().flat_map(|leaf| &leaf.cells)) {
            let Visible { item, cell } = visible?;
            let place = self.places[stock.face(*item) as usize] as usize;
            if is_clipped[place] {
                push(&mut cells[place], cell)?;
            }
        }
        Ok(cells)
    }
}
