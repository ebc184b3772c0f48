//! Drawings: filled outlines in an order to paint them.

use std::ops::Range;

use super::cell::Cell;
use super::half::Half;
use super::lines::Lines;
use super::outline::{Edge, outlines};
use super::overlaid::Overlaid;
use super::tile::Tile;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{place, push, reserve};

/// A view as filled outlines, in the order to paint them.
#[derive(Clone, Debug)]
pub struct Drawing {
    size: [u32; 2],
    pub(super) paths: Vec<Record>,
    /// Where each outline begins, and all corners.
    outlines: Vec<u32>,
    corners: Vec<[f64; 2]>,
    /// Lines and points, each with how many paths come before it: in the order to paint them.
    pub(super) overlaid: Vec<(u32, Overlaid)>,
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

impl Drawing {
    /// Nothing is painted.
    pub(super) fn empty(size: [u32; 2]) -> Self {
        Self { size, paths: vec![], outlines: vec![], corners: vec![], overlaid: vec![] }
    }

    /// Adds a path that fills what edges go around.
    pub(super) fn push(
        &mut self,
        polygon: usize,
        is_clipped: bool,
        edges: &[Edge],
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let start = self.outlines.len() as u32;
        for outline in joined(edges, watch)? {
            push(&mut self.outlines, self.corners.len() as u32)?;
            reserve(&mut self.corners, outline.len())?;
            self.corners.extend(outline);
        }
        let outlines = start..self.outlines.len() as u32;
        push(&mut self.paths, Record { polygon, is_clipped, outlines })
    }

    /// Adds the paths of another after its own.
    pub(super) fn append(&mut self, mut other: Self) -> Result<(), Error> {
        let [outlines, corners] = [place(self.outlines.len())?, place(self.corners.len())?];
        reserve(&mut self.paths, other.paths.len())?;
        reserve(&mut self.outlines, other.outlines.len())?;
        reserve(&mut self.corners, other.corners.len())?;
        self.paths.extend(other.paths.into_iter().map(|record| {
            let Range { start, end } = record.outlines;
            Record { outlines: start + outlines..end + outlines, ..record }
        }));
        self.outlines.extend(other.outlines.iter().map(|start| start + corners));
        self.corners.append(&mut other.corners);
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

/// The outlines of what edges go around. A single part is its outline. Those of a folded polygon lie on one
/// another, and specks are smaller than outlines can be: there each is one of its own.
pub(super) fn joined(edges: &[Edge], watch: &Watch<'_>) -> Result<Vec<Vec<[f64; 2]>>, Error> {
    let is_one =
        edges.iter().position(|edge| edge.to == edges[0].from) == edges.len().checked_sub(1);
    let joined = if is_one { None } else { outlines(edges, watch)? };
    Ok(joined.unwrap_or_else(|| apart(edges)))
}

/// The outlines of convex parts, one after another.
fn apart(edges: &[Edge]) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut is_closed = true;
    for edge in edges {
        if is_closed {
            parts.push(vec![]);
        }
        let Some(part) = parts.last_mut() else { continue };
        part.push(edge.from);
        is_closed = edge.to == part[0];
    }
    parts
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
    lines: &Lines<'_>,
    halves: &[Half],
    edges: &mut Vec<Edge>,
    watch: &Watch<'_>,
) -> Result<(), Error> {
    watch.work(halves.len())?;
    let Tile { low, high } = Tile::picture(lines.frame.rays.size());
    let picture = Cell::rectangle(lines, low, high);
    if let Some(cell) = picture.within(lines, halves, None, watch)? {
        add_sides(&cell, edges)?;
    }
    Ok(())
}
