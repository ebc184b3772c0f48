//! Regions of the picture in which the same polygons are visible, one behind the other.

use std::sync::atomic::{AtomicUsize, Ordering};

use smallvec::SmallVec;

use super::cell::{Cell, Rect, are_apart};
use super::lines::{HalfPlane, LineTable, Table};
use super::map::{VisibilityMap, each, finish_item, sort_by};
use super::paths::Area;
use super::primitives::Primitives;
use super::quadtree::{CUT, Leaf, VISITED, Visible};
use crate::error::{Error, Kind};
use crate::parallel_map;
use crate::progress::Watch;

/// A part of the picture in which the same polygons are visible, one behind the other; see
/// [`VisibilityMap::regions`].
#[derive(Clone, Debug)]
pub struct Region {
    polygons: Vec<usize>,
    outlines: Vec<Vec<[f64; 2]>>,
}

/// The number of tiles that all threads together divide before the results are collected. Too small: threads
/// wait for one another. Too large: more memory for the parts.
const TILES_AT_ONCE: usize = 64;

/// The largest number of polygons that are visible behind other polygons, added up over the convex parts of
/// all regions. Too small: pictures of many translucent polygons have no regions. Too large: memory, and time.
const MOST_BEHIND: usize = 1 << 23;

impl VisibilityMap<'_> {
    /// Divides the picture into regions. Inside a region, the same polygons are visible everywhere. Parts of
    /// the picture without a visible polygon are in no region.
    ///
    /// If all polygons are opaque, each visible polygon has one region. Translucent polygons divide the
    /// polygons behind them: n overlapping polygons have up to O(n²) regions, with up to n polygons each. To
    /// avoid seams, fill each region with one blended colour, in a group whose areas are [added
    /// up](super::VectorPicture::added_up). To blend pixels, blend the [cells](Self::cells), which come front to
    /// back where they overlap.
    ///
    /// # Errors
    ///
    /// If the operation was [cancelled](Self#progress), or if there would be too many regions: if in the
    /// convex parts of all regions together, more than 2²³ (about 8 million) polygons would be visible behind
    /// other polygons.
    pub fn regions(&self) -> Result<Vec<Region>, Error> {
        self.reporter.watch(2, |watch| {
            let mut regions = self.stacks(watch)?.regions(&self.primitives.lines, watch)?;
            let is_small = |region: &Region| region.area() < self.least_area;
            regions.retain(|region| !is_small(region));
            Ok(regions)
        })
    }

    /// The visible parts of polygons that lie one behind the other. Counts as one phase of the progress.
    fn stacks(&self, watch: &Watch<'_>) -> Result<Stacks, Error> {
        let mut stacks = Stacks::default();
        stacks.layers.push(PolygonLayer { polygon: usize::MAX, before: 0 });
        // In the parts of all tiles.
        let sum = AtomicUsize::new(0);
        let numbered: Vec<(usize, &Leaf)> = self.leaves.iter().enumerate().collect();
        let divided = |(i, leaf)| {
            let divided = Divided::new(leaf, &self.primitives, Some(&sum), watch)?;
            finish_item(watch, i, numbered.len());
            Ok(divided)
        };
        for leaves in numbered.chunks(TILES_AT_ONCE) {
            for divided in parallel_map::map(leaves.to_vec(), divided)? {
                watch.work(divided.cells.len() * CUT)?;
                stacks.add(&divided, |item| self.primitives.polygon(item))?;
            }
        }
        Ok(stacks)
    }
}

/// A visible polygon, and the layer in front of the polygon. The first layer stands for no polygon.
struct PolygonLayer {
    polygon: usize,
    before: u32,
}

/// All regions, each given by its rearmost layer.
#[derive(Default)]
struct Stacks {
    layers: Vec<PolygonLayer>,
    /// The number of each layer. The key is the layer in front and the polygon.
    numbers: Table<(u32, usize), u32>,
    /// The parts of regions, and the region of each part.
    parts: Area,
    of_parts: Vec<u32>,
}

impl Stacks {
    /// Adds the parts of a tile.
    fn add(&mut self, divided: &Divided, polygon: impl Fn(u32) -> usize) -> Result<(), Error> {
        // For each layer of this tile, its number among the layers of all tiles.
        let mut own: Vec<u32> = Vec::with_capacity(divided.layers.len());
        own.push(0);
        for layer in &divided.layers[1..] {
            let (before, polygon) = (own[layer.before as usize], polygon(layer.item));
            let number = match self.numbers.get(&(before, polygon)) {
                Some(&number) => number,
                None => {
                    let number = self.layers.len() as u32;
                    self.numbers.insert((before, polygon), number);
                    self.layers.push(PolygonLayer { polygon, before });
                    number
                }
            };
            own.push(number);
        }
        for part in &divided.cells {
            self.parts.push(&part.cell.sides)?;
            self.of_parts.push(own[part.layer as usize]);
        }
        Ok(())
    }

    /// The regions, sorted by their lists of polygons. Counts as one phase of the progress.
    fn regions(self, lines: &LineTable<'_>, watch: &Watch<'_>) -> Result<Vec<Region>, Error> {
        let Self { layers, parts, of_parts, .. } = self;
        let layer = |part: u32| of_parts[part as usize];
        let mut by_layer: Vec<u32> = (0..of_parts.len() as u32).collect();
        sort_by(&mut by_layer, watch, |&a, &b| layer(a).cmp(&layer(b)))?;
        let mut all: Vec<(Vec<usize>, &[u32])> = Vec::new();
        for own in by_layer.chunk_by(|&a, &b| layer(a) == layer(b)) {
            watch.work(own.len())?;
            all.push((stack(&layers, layer(own[0])), own));
        }
        sort_by(&mut all, watch, |(a, _), (b, _)| a.cmp(b))?;
        let count = all.len();
        let region = |(i, (polygons, own)): (usize, (Vec<usize>, &[u32]))| {
            let mut area = Area::default();
            for &part in own {
                area.push(parts.part(part as usize))?;
            }
            let outlines = area.outlines(lines, watch)?.into_iter();
            let outlines = outlines.map(|o| o.iter().map(|side| side.start.at).collect()).collect();
            finish_item(watch, i, count);
            Ok(Region { polygons, outlines })
        };
        parallel_map::map(all.into_iter().enumerate().collect(), region)
    }
}

/// The polygons of a layer and of the layers in front of it, front to back.
fn stack(layers: &[PolygonLayer], last: u32) -> Vec<usize> {
    let at = |layer: u32| (layer != 0).then(|| &layers[layer as usize]);
    let all = std::iter::successors(at(last), |layer| at(layer.before));
    let mut polygons: Vec<usize> = all.map(|layer| layer.polygon).collect();
    polygons.reverse();
    polygons
}

impl Region {
    /// Returns the indices of the visible polygons, front to back: the translucent polygons, then the opaque
    /// polygon behind them, if any. A polygon that is folded over itself is listed more than once.
    pub fn polygons(&self) -> &[usize] {
        &self.polygons
    }

    /// Returns the area of the region in square pixels.
    pub fn area(&self) -> f64 {
        self.outlines.iter().map(|outline| area(outline)).sum::<f64>().max(0.0)
    }

    /// Returns the outlines of the region. Fill them together, like the outlines of a
    /// [`Path`](super::Path::outlines). Two regions have no area in common.
    pub fn outlines(&self) -> impl Iterator<Item = &[[f64; 2]]> + Clone {
        self.outlines.iter().map(Vec::as_slice)
    }
}

/// The area inside a clockwise outline.
fn area(outline: &[[f64; 2]]) -> f64 {
    let origin = outline.first().copied().unwrap_or_default();
    let arm = |at: &[f64; 2]| [at[0] - origin[0], at[1] - origin[1]];
    let halves = outline.windows(2).map(|ends| {
        let ([ax, ay], [bx, by]) = (arm(&ends[0]), arm(&ends[1]));
        0.5 * (ax * by - ay * bx)
    });
    halves.sum()
}

/// A tile that is divided into convex parts.
struct Divided {
    cells: Vec<LayeredCell>,
    /// Each layer follows the layer in front of it. The first layer has no item.
    layers: Vec<ItemLayer>,
}

/// A convex part in which the same items are visible everywhere.
struct LayeredCell {
    cell: Cell,
    around: Rect,
    /// The rearmost of the cell's layers; the first layer, which has no item, if nothing is visible.
    layer: u32,
}

/// A visible item, and the layer in front of the item. Cells share layers, to save memory where many items
/// lie over one another.
struct ItemLayer {
    item: u32,
    before: u32,
    /// The number of items in front.
    depth: u32,
    /// The newest of the layers directly behind this layer.
    newest: u32,
}

impl Divided {
    /// Divides a tile: combines its visible cells, front to back, with the parts found so far. `sum` counts
    /// the items behind others in the parts of all tiles, up to [`MOST_BEHIND`].
    fn new(
        leaf: &Leaf,
        primitives: &Primitives<'_>,
        sum: Option<&AtomicUsize>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let none = ItemLayer { item: u32::MAX, before: 0, depth: 0, newest: 0 };
        let mut divided = Self { cells: vec![], layers: vec![none] };
        if is_opaque(leaf, primitives) {
            watch.work(leaf.cells.len() * CUT)?;
            for Visible { item, cell } in &leaf.cells {
                let layer = divided.behind(0, *item);
                divided.cells.push(LayeredCell::new(cell.clone(), layer));
            }
            return Ok(divided);
        }
        let lines = &primitives.lines;
        let tile = Cell::rectangle(lines, leaf.tile.low, leaf.tile.high);
        let mut open = vec![LayeredCell::new(tile, 0)];
        let (mut left, mut outside) = (Vec::new(), Vec::new());
        for Visible { item, cell } in &leaf.cells {
            watch.work(CUT)?;
            let halves: SmallVec<[HalfPlane; 8]> =
                cell.sides.iter().map(|side| side.half).collect();
            let around = cell.around();
            let mut i = 0;
            while let Some(part) = open.get(i) {
                watch.work(VISITED)?;
                let common = match are_apart(&part.around, &around) {
                    true => None,
                    false => part.cell.within(lines, &halves, Some(&mut outside), watch)?,
                };
                let Some(common) = common else {
                    outside.clear();
                    i += 1;
                    continue;
                };
                watch.work(CUT)?;
                let LayeredCell { layer, .. } = open.swap_remove(i);
                let depth = divided.layers[layer as usize].depth as usize;
                let more = outside.len() * depth + usize::from(layer != 0);
                let is_too_many =
                    |sum: &AtomicUsize| sum.fetch_add(more, Ordering::Relaxed) + more > MOST_BEHIND;
                if sum.is_some_and(is_too_many) {
                    return Err(Kind::Regions(MOST_BEHIND).error());
                }
                left.extend(outside.drain(..).map(|cell| LayeredCell::new(cell, layer)));
                let behind = LayeredCell::new(common, divided.behind(layer, *item));
                if primitives.is_opaque(*item) { &mut divided.cells } else { &mut left }
                    .push(behind);
            }
            open.append(&mut left);
        }
        open.retain(|part| part.layer != 0);
        divided.cells.append(&mut open);
        Ok(divided)
    }

    /// The layer of an item behind another layer.
    fn behind(&mut self, before: u32, item: u32) -> u32 {
        let newest = self.layers[before as usize].newest;
        if newest != 0 && self.layers[newest as usize].item == item {
            return newest;
        }
        let layer = self.layers.len() as u32;
        let depth = if before == 0 { 0 } else { self.layers[before as usize].depth + 1 };
        self.layers.push(ItemLayer { item, before, depth, newest: 0 });
        self.layers[before as usize].newest = layer;
        layer
    }

    /// The items that are visible in a part, back to front.
    fn items(&self, part: &LayeredCell) -> impl Iterator<Item = u32> {
        let at = |layer: u32| (layer != 0).then(|| &self.layers[layer as usize]);
        std::iter::successors(at(part.layer), move |layer| at(layer.before)).map(|layer| layer.item)
    }
}

impl VisibilityMap<'_> {
    /// Calls a function once for each item that is visible in each convex part of the picture. Counts as one
    /// phase of the progress.
    pub(super) fn for_each_part(
        &self,
        mut see: impl FnMut(u32, &Cell) -> Result<(), Error>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let count = self.leaves.len();
        for (i, leaf) in self.leaves.iter().enumerate() {
            if is_opaque(leaf, &self.primitives) {
                watch.work(leaf.cells.len() * CUT)?;
                leaf.cells.iter().try_for_each(|Visible { item, cell }| see(*item, cell))?;
            } else {
                let divided = Divided::new(leaf, &self.primitives, None, watch)?;
                for part in &divided.cells {
                    for item in each(watch, CUT, divided.items(part)) {
                        see(item?, &part.cell)?;
                    }
                }
            }
            finish_item(watch, i, count);
        }
        Ok(())
    }
}

impl LayeredCell {
    fn new(cell: Cell, layer: u32) -> Self {
        Self { around: cell.around(), cell, layer }
    }
}

/// Whether all visible items in a tile are opaque.
fn is_opaque(leaf: &Leaf, primitives: &Primitives<'_>) -> bool {
    leaf.cells.iter().all(|visible| primitives.is_opaque(visible.item))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::drawing::{ViewOptions, VisibilityMap};
    use crate::random::SplitMix64;
    use crate::view::Camera;
    use crate::{BspTree, ErrorKind};

    type Square = [[f64; 3]; 4];

    fn square([x, y, z]: [f64; 3], r: f64, turn: f64) -> Square {
        let corner = |k: f64| {
            let (sin, cos) = (turn + k * std::f64::consts::FRAC_PI_2).sin_cos();
            [x + r * cos, y + r * sin, z]
        };
        [0.0, 1.0, 2.0, 3.0].map(corner)
    }

    /// Calls a function with the map of squares from above, all translucent except each `opaque`-th.
    fn with_map<R>(
        squares: &[Square],
        opaque: usize,
        see: impl FnOnce(VisibilityMap<'_>) -> R,
    ) -> R {
        let tree = BspTree::build(squares).unwrap();
        let size = [320, 240];
        let camera = Camera::parallel(-DVec3::Z, DVec3::Y, DVec3::ZERO, 6.0, size).unwrap();
        let opacities = (0..squares.len()).map(|k| if (k + 1) % opaque == 0 { 1.0 } else { 0.5 });
        let options = ViewOptions::DEFAULT.with_opacities(opacities.collect());
        see(tree.visibility(&camera, &options).unwrap())
    }

    fn scattered(count: usize) -> Vec<Square> {
        let mut random = SplitMix64::new(3);
        let mut square = |k: usize| {
            let [x, y] = [(); 2].map(|()| random.range(-2.0, 2.0));
            square([x, y, 0.01 * k as f64], random.range(1.0, 3.0), random.range(0.0, 6.0))
        };
        (0..count).map(&mut square).collect()
    }

    /// At each point, the cells that contain it come front to back, and end at an opaque polygon.
    #[test]
    fn cells_over_one_another_are_the_list_of_their_region() {
        let is_inside = |outline: &[[f64; 2]], [x, y]: [f64; 2]| {
            let next = outline.iter().cycle().skip(1);
            let side = |([ax, ay], [bx, by]): (&[f64; 2], &[f64; 2])| {
                (bx - ax) * (y - ay) - (by - ay) * (x - ax)
            };
            outline.iter().zip(next).all(|ends| side(ends) > 0.0)
        };
        let (mut deepest, mut compared) = (0, 0);
        for (count, opaque) in [(1, 2), (12, 5), (40, 1), (40, 7), (70, 1000)] {
            with_map(&scattered(count), opaque, |map| {
                let cells: Vec<(usize, Vec<[f64; 2]>)> =
                    map.cells().map(|cell| (cell.polygon(), cell.corners().collect())).collect();
                for region in map.regions().unwrap().iter().filter(|region| region.area() > 1.0) {
                    // A point in a corner of the region that is convex.
                    let outline = region.outlines().next().unwrap();
                    let corner = |i: usize| outline[i % outline.len()];
                    let Some(at) = (0..outline.len()).find_map(|i| {
                        let [a, b, c] = [i, i + 1, i + 2].map(corner);
                        let at = [0, 1].map(|k| b[k] + 1e-3 * (a[k] - b[k]) + 1e-3 * (c[k] - b[k]));
                        let turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
                        (turn > 0.1).then_some(at)
                    }) else {
                        continue;
                    };
                    let found = cells.iter().filter(|(_, outline)| is_inside(outline, at));
                    let found: Vec<usize> = found.map(|(polygon, _)| *polygon).collect();
                    assert_eq!(found, region.polygons(), "{count} {opaque} {at:?}");
                    deepest = deepest.max(found.len());
                    compared += 1;
                }
            });
        }
        assert!(deepest > 30 && compared > 2000, "{deepest} {compared}");
    }

    #[test]
    fn too_many_regions_are_an_error_that_says_what_to_do() {
        with_map(&scattered(100), 1000, |map| assert!(map.regions().unwrap().len() > 3000));
        with_map(&scattered(400), 1000, |map| {
            let error = map.regions().unwrap_err();
            assert_eq!(error.kind(), ErrorKind::TooLarge);
            assert!(error.to_string().contains("paint whole polygons one over another"), "{error}");
        });
    }
}
