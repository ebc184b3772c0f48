//! Regions of the picture in which the same polygons show, one behind the other.

use super::divided::Divided;
use super::halving::VISITED;
use super::map::VisibilityMap;
use super::outline::Edge;
use super::paths::{add_sides, joined};
use super::reporter::{each, finish_item, sort_by};
use super::table::{Table, insert};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, push, reserve};
use crate::parallel_map;

/// A part of the picture in which the same polygons show, one behind the other.
#[derive(Clone, Debug)]
pub struct Region {
    polygons: Vec<usize>,
    outlines: Vec<Vec<[f64; 2]>>,
}

/// So many tiles are divided at once, by all threads. Larger: more memory for their parts; smaller: threads wait
/// for one another.
const TILES_AT_ONCE: usize = 64;

impl VisibilityMap<'_> {
    /// The parts of the picture that differ in what shows, side by side; what shows nothing is in none.
    ///
    /// Where all polygons are opaque, there is one for each that shows. Translucent polygons divide what they
    /// lie over: n of them that overlap have up to O(n²) regions, with up to n polygons each. Filled each with
    /// one blended colour, and added up instead of painted over one another, regions have no seams.
    ///
    /// # Errors
    ///
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn regions(&self) -> Result<Vec<Region>, Error> {
        self.reporter.watch(2, |watch| self.stacks(watch)?.regions(watch))
    }

    /// What shows of polygons that lie one behind the other: a phase.
    fn stacks(&self, watch: &Watch<'_>) -> Result<Stacks, Error> {
        let mut stacks = Stacks::default();
        push(&mut stacks.layers, PolygonLayer { polygon: usize::MAX, before: 0 })?;
        let (mut done, count) = (0, self.leaves.len());
        for leaves in self.leaves.chunks(TILES_AT_ONCE) {
            let divided = |leaf| Divided::new(leaf, &self.stock, &self.rims.lines, watch);
            for divided in parallel_map::map(leaves.iter().collect(), divided)? {
                stacks.add(&divided, |item| self.stock.polygon(item), watch)?;
                finish_item(watch, done, count);
                done += 1;
            }
        }
        Ok(stacks)
    }
}

/// Polygons that show, each behind another layer or, if that is the first of all, in front.
struct PolygonLayer {
    polygon: usize,
    before: u32,
}

/// The regions, each by its last layer.
#[derive(Default)]
struct Stacks {
    layers: Vec<PolygonLayer>,
    /// Layers by what is before them and their polygons.
    numbers: Table<(u32, usize), u32>,
    /// The edges of all parts of regions, and whose they are.
    edges: Vec<(u32, Edge)>,
}

impl Stacks {
    /// Adds the parts of a tile.
    fn add(
        &mut self,
        divided: &Divided,
        polygon: impl Fn(u32) -> usize,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        // The layers of all tiles that those of this one are.
        let mut own: Vec<u32> = Vec::new();
        reserve(&mut own, divided.layers.len())?;
        own.push(0);
        for layer in each(watch, VISITED, &divided.layers[1..]) {
            let layer = layer?;
            let (before, polygon) = (own[layer.before as usize], polygon(layer.item));
            let number = match self.numbers.get(&(before, polygon)) {
                Some(&number) => number,
                None => {
                    let number = self.layers.len() as u32;
                    insert(&mut self.numbers, (before, polygon), number)?;
                    push(&mut self.layers, PolygonLayer { polygon, before })?;
                    number
                }
            };
            own.push(number);
        }
        let mut sides = Vec::new();
        for part in each(watch, VISITED, &divided.cells) {
            let part = part?;
            add_sides(&part.cell, &mut sides)?;
            reserve(&mut self.edges, sides.len())?;
            let layer = own[part.layer as usize];
            self.edges.extend(sides.drain(..).map(|edge| (layer, edge)));
        }
        Ok(())
    }

    /// The regions, in the order of their polygons: a phase.
    fn regions(self, watch: &Watch<'_>) -> Result<Vec<Region>, Error> {
        let Self { layers, edges, numbers } = self;
        drop(numbers);
        // Where the edges of each region begin, and then where they end.
        let mut ends: Vec<usize> = collect(layers.iter().map(|_| 0))?;
        for edge in each(watch, 1, &edges) {
            ends[edge?.0 as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += std::mem::replace(end, sum);
        }
        let none = Edge { line: 0, from: [0.0; 2], to: [0.0; 2] };
        let mut grouped: Vec<Edge> = collect(edges.iter().map(|_| none))?;
        for edge in each(watch, 1, edges) {
            let (layer, edge) = edge?;
            let end = &mut ends[layer as usize];
            grouped[*end] = edge;
            *end += 1;
        }
        let mut begin = 0;
        let mut all: Vec<(Vec<usize>, &[Edge])> = Vec::new();
        for (layer, &end) in (0..).zip(&ends) {
            if begin < end {
                let polygons = stack(&layers, layer, watch)?;
                push(&mut all, (polygons, &grouped[begin..end]))?;
            }
            begin = end;
        }
        let mut order: Vec<usize> = collect(0..all.len())?;
        sort_by(&mut order, watch, |&a, &b| all[a].0.cmp(&all[b].0))?;
        let count = all.len();
        let region = |(i, at): (usize, usize)| {
            let outlines = joined(all[at].1, watch)?;
            finish_item(watch, i, count);
            Ok((at, outlines))
        };
        let joined = parallel_map::map(order.into_iter().enumerate().collect(), region)?;
        let mut regions = Vec::new();
        reserve(&mut regions, count)?;
        for (at, outlines) in joined {
            regions.push(Region { polygons: std::mem::take(&mut all[at].0), outlines });
        }
        Ok(regions)
    }
}

/// The polygons of a layer and of those before it, front to back.
fn stack(layers: &[PolygonLayer], last: u32, watch: &Watch<'_>) -> Result<Vec<usize>, Error> {
    let at = |layer: u32| (layer != 0).then(|| &layers[layer as usize]);
    let all = || std::iter::successors(at(last), |layer| at(layer.before));
    let mut polygons = Vec::new();
    polygons.try_reserve_exact(all().count()).map_err(|_| Error::out_of_memory())?;
    for layer in each(watch, 1, all()) {
        polygons.push(layer?.polygon);
    }
    polygons.reverse();
    Ok(polygons)
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
