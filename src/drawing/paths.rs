//! Drawings: filled outlines in an order to paint them.

use std::ops::Range;

use super::cell::Cell;
use super::half::Half;
use super::lines::Lines;
use super::outline::Area;
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

    /// Adds a path that fills an area.
    pub(super) fn push(
        &mut self,
        polygon: usize,
        is_clipped: bool,
        area: &Area,
        lines: &Lines<'_>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let start = self.outlines.len() as u32;
        for outline in area.outlines(lines, watch)? {
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

    /// The outlines of the part in the picture; fill them together by the nonzero rule. There is at least one.
    ///
    /// Each is a list of at least three corners in pixels: x to the right, y down, and the centre of the first
    /// pixel at (0, 0). Outer outlines run clockwise, and holes counter-clockwise. The outlines of a folded polygon
    /// overlap. Only the corners are rounded, by less than a millionth of a pixel; corners of needles may
    /// coincide.
    pub fn outlines(&self) -> impl Iterator<Item = &'d [[f64; 2]]> + Clone + use<'d> {
        let Drawing { outlines, corners, .. } = self.drawing;
        self.record.outlines.clone().map(move |outline| {
            let start = outlines[outline as usize] as usize;
            let end = outlines.get(outline as usize + 1).map_or(corners.len(), |&end| end as usize);
            &corners[start..end]
        })
    }
}

/// Adds a convex piece to an area, as far as it is in the picture.
pub(super) fn add_piece(
    lines: &Lines<'_>,
    halves: &[Half],
    area: &mut Area,
    watch: &Watch<'_>,
) -> Result<(), Error> {
    watch.work(halves.len())?;
    let Tile { low, high } = Tile::picture(lines.frame.rays.size());
    let picture = Cell::rectangle(lines, low, high);
    match picture.within(lines, halves, None, watch)? {
        Some(cell) => area.push(&cell.sides),
        None => Ok(()),
    }
}
