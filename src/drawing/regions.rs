//! Regions of the picture in which the same polygons show, one behind the other.

use std::collections::BTreeMap;

use smallvec::SmallVec;

use super::cell::Cell;
use super::half::Half;
use super::lines::Lines;
use super::map::VisibilityMap;
use super::outline::Edge;
use super::paths::{add_sides, joined};
use super::region::{Region as Around, are_apart};
use super::stock::Stock;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::memory::{push, reserve};
use crate::parallel_map;

/// A part of the picture in which the same polygons show, one behind the other.
#[derive(Clone, Debug)]
pub struct Region {
    polygons: Vec<usize>,
    outlines: Vec<Vec<[f64; 2]>>,
}

/// A convex part of a region: all of it shows the same items, front to back.
struct Part {
    cell: Cell,
    around: Around,
    items: SmallVec<[u32; 4]>,
}

impl VisibilityMap<'_> {
    /// The parts of the picture that differ in what shows, side by side; what shows nothing is in none.
    ///
    /// Where all polygons are opaque, there is one for each that shows. Translucent polygons divide what they
    /// lie over: n of them that overlap have up to O(n²) regions. Filled each with one blended colour, and
    /// added up instead of painted over one another, regions have no seams.
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn regions(&self) -> Result<Vec<Region>, Error> {
        let Self { stock, rims, leaves, .. } = self;
        let mut edges: BTreeMap<SmallVec<[usize; 4]>, Vec<Edge>> = BTreeMap::new();
        for parts in
            parallel_map::map(leaves.iter().collect(), |leaf| parts(leaf, stock, &rims.lines))
        {
            for Part { cell, items, .. } in parts? {
                let polygons = items.iter().map(|&item| stock.polygon(item)).collect();
                add_sides(&cell, edges.entry(polygons).or_default())?;
            }
        }
        let all: Vec<_> = edges.into_iter().collect();
        let region = |(polygons, edges): (SmallVec<[usize; 4]>, Vec<Edge>)| Region {
            polygons: polygons.into_vec(),
            outlines: joined(&edges),
        };
        Ok(parallel_map::map(all, region))
    }

    /// Calls a function with each convex part of the picture, once for each item that shows there.
    pub(super) fn for_each_part(
        &self,
        mut see: impl FnMut(u32, &Cell) -> Result<(), Error>,
    ) -> Result<(), Error> {
        for leaf in &self.leaves {
            if is_opaque(leaf, &self.stock) {
                leaf.cells.iter().try_for_each(|visible| see(visible.item, &visible.cell))?;
                continue;
            }
            for Part { cell, items, .. } in parts(leaf, &self.stock, &self.rims.lines)? {
                items.iter().try_for_each(|&item| see(item, &cell))?;
            }
        }
        Ok(())
    }
}

impl Region {
    /// The polygons that show, front to back: translucent ones, and the opaque one behind them if there is
    /// one. One that is folded over itself is among them more than once.
    pub fn polygons(&self) -> &[usize] {
        &self.polygons
    }

    /// Its area in square pixels.
    pub fn area(&self) -> f64 {
        self.outlines.iter().map(|outline| area(outline)).sum::<f64>().max(0.0)
    }

    /// Its outlines, to be filled together, as those of a [`Path`](super::Path): those of two regions have
    /// no area in common.
    pub fn outlines(&self) -> impl Iterator<Item = &[[f64; 2]]> + Clone {
        self.outlines.iter().map(Vec::as_slice)
    }
}

/// The area that an outline goes around clockwise.
fn area(outline: &[[f64; 2]]) -> f64 {
    let origin = outline.first().copied().unwrap_or_default();
    let arm = |at: &[f64; 2]| [at[0] - origin[0], at[1] - origin[1]];
    let halves = outline.windows(2).map(|ends| {
        let ([ax, ay], [bx, by]) = (arm(&ends[0]), arm(&ends[1]));
        0.5 * (ax * by - ay * bx)
    });
    halves.sum()
}

/// Whether nothing shows through anything in a tile.
fn is_opaque(leaf: &Leaf, stock: &Stock<'_>) -> bool {
    leaf.cells.iter().all(|visible| stock.is_opaque(visible.item))
}

/// The parts of a tile. What is visible is laid over what was there, front to back.
fn parts(leaf: &Leaf, stock: &Stock<'_>, lines: &Lines<'_>) -> Result<Vec<Part>, Error> {
    let mut found = Vec::new();
    if is_opaque(leaf, stock) {
        reserve(&mut found, leaf.cells.len())?;
        found.extend(
            leaf.cells.iter().map(|Visible { item, cell }| {
                Part::new(cell.clone(), SmallVec::from_elem(*item, 1))
            }),
        );
        return Ok(found);
    }
    let tile = Cell::rectangle(lines, leaf.tile.low, leaf.tile.high);
    let mut open = vec![Part::new(tile, SmallVec::new())];
    let (mut left, mut outside) = (Vec::new(), Vec::new());
    for Visible { item, cell } in &leaf.cells {
        let halves: SmallVec<[Half; 8]> = cell.sides.iter().map(|side| side.half).collect();
        let around = cell.region();
        let mut i = 0;
        while let Some(part) = open.get(i) {
            let common = match are_apart(&part.around, &around) {
                true => None,
                false => part.cell.within(lines, &halves, Some(&mut outside))?,
            };
            let Some(common) = common else {
                outside.clear();
                i += 1;
                continue;
            };
            let part = open.swap_remove(i);
            reserve(&mut left, outside.len() + 1)?;
            left.extend(outside.drain(..).map(|cell| Part::new(cell, part.items.clone())));
            let mut items = part.items;
            items.push(*item);
            let to = if stock.is_opaque(*item) { &mut found } else { &mut left };
            push(to, Part::new(common, items))?;
        }
        reserve(&mut open, left.len())?;
        open.append(&mut left);
    }
    open.retain(|part| !part.items.is_empty());
    reserve(&mut found, open.len())?;
    found.append(&mut open);
    Ok(found)
}

impl Part {
    fn new(cell: Cell, items: SmallVec<[u32; 4]>) -> Self {
        Self { around: cell.region(), cell, items }
    }
}
