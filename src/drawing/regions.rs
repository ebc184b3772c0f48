//! Regions of the picture in which the same polygons show, one behind the other.

use super::divided::Divided;
use super::halving::VISITED;
use super::lines::Lines;
use super::map::VisibilityMap;
use super::outline::Area;
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
        self.reporter.watch(2, |watch| self.stacks(watch)?.regions(&self.rims.lines, watch))
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
    /// The parts of regions, and whose they are.
    parts: Area,
    of_parts: Vec<u32>,
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
        for part in each(watch, VISITED, &divided.cells) {
            let part = part?;
            self.parts.push(&part.cell.sides)?;
            push(&mut self.of_parts, own[part.layer as usize])?;
        }
        Ok(())
    }

    /// The regions, in the order of their polygons: a phase.
    fn regions(self, lines: &Lines<'_>, watch: &Watch<'_>) -> Result<Vec<Region>, Error> {
        let Self { layers, parts, of_parts, .. } = self;
        let layer = |part: u32| of_parts[part as usize];
        let mut by_layer: Vec<u32> = collect(0..of_parts.len() as u32)?;
        sort_by(&mut by_layer, watch, |&a, &b| layer(a).cmp(&layer(b)))?;
        let mut all: Vec<(Vec<usize>, &[u32])> = Vec::new();
        for own in by_layer.chunk_by(|&a, &b| layer(a) == layer(b)) {
            let polygons = stack(&layers, layer(own[0]), watch)?;
            push(&mut all, (polygons, own))?;
        }
        sort_by(&mut all, watch, |(a, _), (b, _)| a.cmp(b))?;
        let count = all.len();
        let region = |(i, (polygons, own)): (usize, (Vec<usize>, &[u32]))| {
            let mut area = Area::default();
            for part in each(watch, VISITED, own) {
                area.push(parts.part(*part? as usize))?;
            }
            let outlines = area.outlines(lines, watch)?;
            finish_item(watch, i, count);
            Ok(Region { polygons, outlines })
        };
        parallel_map::map(all.into_iter().enumerate().collect(), region)
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
