//! Drawings, and those of opaque polygons.

use std::ops::{ControlFlow, Range};

use super::above::pairs;
use super::cell::Cell;
use super::half::Half;
use super::halving::CUT;
use super::map::VisibilityMap;
use super::order::{Ordered, order};
use super::outline::{Edge, outlines};
use super::stock::Stock;
use super::tile::Tile;
use super::translucent::mixed;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::Progress;
use crate::build::progress::{Watch, one_at_a_time};
use crate::memory::{collect, push, reserve};

/// A view as filled outlines, in the order to paint them.
#[derive(Clone, Debug)]
pub struct Drawing {
    size: [u32; 2],
    pub(super) paths: Vec<Record>,
    /// Where each outline begins, and all corners.
    outlines: Vec<u32>,
    corners: Vec<[f64; 2]>,
}

#[derive(Clone, Debug)]
pub(super) struct Record {
    polygon: usize,
    is_clipped: bool,
    outlines: Range<u32>,
}

/// What is filled for a polygon.
#[derive(Clone, Copy, Debug)]
pub struct Path<'d> {
    drawing: &'d Drawing,
    record: &'d Record,
}

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

impl Drawing {
    /// Nothing is painted.
    pub(super) fn empty(size: [u32; 2]) -> Self {
        Self { size, paths: vec![], outlines: vec![], corners: vec![] }
    }

    /// Adds a path that fills what edges go around.
    pub(super) fn push(
        &mut self,
        polygon: usize,
        is_clipped: bool,
        edges: &[Edge],
    ) -> Result<(), Error> {
        let start = self.outlines.len() as u32;
        for outline in joined(edges) {
            push(&mut self.outlines, self.corners.len() as u32)?;
            reserve(&mut self.corners, outline.len())?;
            self.corners.extend(outline);
        }
        let outlines = start..self.outlines.len() as u32;
        self.paths.push(Record { polygon, is_clipped, outlines });
        Ok(())
    }

    /// The picture's width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// What is filled, in the order to paint it.
    pub fn paths(&self) -> impl DoubleEndedIterator<Item = Path<'_>> + ExactSizeIterator + Clone {
        self.paths.iter().map(|record| Path { drawing: self, record })
    }
}

impl<'d> Path<'d> {
    /// The polygon, by its number in the input.
    pub fn polygon(&self) -> usize {
        self.record.polygon
    }

    /// Whether the path has only a part of its polygon: what shows of one that is in a cycle with others;
    /// or one of several parts of a translucent one.
    pub fn is_clipped(&self) -> bool {
        self.record.is_clipped
    }

    /// Its outlines, to be filled together by the nonzero rule, as far as the polygon is in the picture:
    /// each by its corners, in pixels from the centre of the first one, x to the right and y down,
    /// clockwise around what is filled, counter-clockwise around holes. There is one at least. Those of a
    /// folded polygon overlap. Where parts were joined, corners nearer to one another than 2⁻¹⁶ of a pixel
    /// may be one, so that an outline is off by up to 2⁻¹⁵ there, and of needles that thin there is nothing.
    pub fn outlines(&self) -> impl Iterator<Item = &'d [[f64; 2]]> + Clone + use<'d> {
        let Drawing { outlines, corners, .. } = self.drawing;
        self.record.outlines.clone().map(move |outline| {
            let start = outlines[outline as usize] as usize;
            let end = outlines.get(outline as usize + 1).map_or(corners.len(), |&end| end as usize);
            &corners[start..end]
        })
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

/// The outlines of what edges go around. Parts of a folded polygon lie on one another, and specks are smaller
/// than outlines can be: there each part is an outline of its own.
pub(super) fn joined(edges: &[Edge]) -> Vec<Vec<[f64; 2]>> {
    outlines(edges).unwrap_or_else(|| apart(edges))
}

/// The outlines of convex parts, one after another.
fn apart(edges: &[Edge]) -> Vec<Vec<[f64; 2]>> {
    let parts = edges.chunk_by(|before, edge| before.to == edge.from);
    parts.map(|part| part.iter().map(|edge| edge.from).collect()).collect()
}

pub(super) fn add_sides(cell: &Cell, edges: &mut Vec<Edge>) -> Result<(), Error> {
    let n = cell.sides.len();
    reserve(edges, n)?;
    edges.extend((0..n).map(|i| {
        let side = &cell.sides[i];
        Edge { line: side.half.line(), from: side.start.at, to: cell.sides[(i + 1) % n].start.at }
    }));
    Ok(())
}

/// Adds the edges of a convex piece, as far as it is in the picture.
pub(super) fn add_edges(
    stock: &Stock<'_>,
    halves: &[Half],
    edges: &mut Vec<Edge>,
) -> Result<(), Error> {
    let Tile { low, high } = Tile::picture(stock.lines.frame.rays.size());
    let picture = Cell::rectangle(&stock.lines, low, high);
    if let Some(cell) = picture.within(&stock.lines, halves, None)? {
        add_sides(&cell, edges)?;
    }
    Ok(())
}
