//! The visibility map: what shows of a scene.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use super::cell::Cell;
use super::halving::LINES;
use super::reporter::{Reporter, each, finish_item};
use super::rims::Rims;
use super::stock::Stock;
use super::tile::Tile;
use super::visible::{Leaf, Visible, visible};
use crate::build::Progress;
use crate::build::progress::Watch;
use crate::error::{Error, InputFault};
use crate::memory::{collect, filled};
use crate::raster::Rays;
use crate::tree::BspTree;

/// Which polygon shows where in a picture: convex cells that lie side by side, each of one polygon.
///
/// It is exact, without a tolerance of its own: lines of the picture are planes through the eye in
/// integers, and a corner is where two of them meet, never a rounded point. So a polygon is in the map
/// if and only if some of it shows, however small; and where two polygons of one plane overlap, the one
/// shows that the tree's order paints last.
///
/// Time is O(n log n) for n fragments in most scenes, and what shows adds to it, not what is hidden;
/// memory likewise. With feature `parallel`, tiles of the picture are shared out to all threads; the
/// map is the same, bit for bit.
///
/// Positions are in pixels from the centre of the first one, as those of [`Rays`]: the picture reaches
/// from −½ to its size less ½, x to the right, y down.
///
/// # Progress
///
/// A map that is made [with progress](Self::of_with_progress) keeps the callback: all that is asked of the map
/// afterwards, and can fail, reports to it as well. Each operation, the making of the map among them, counts by
/// itself: `total` is the number of its parts, which is the same from its beginning to its end and tells
/// nothing but how `done` is to be read; `done` begins with 0, never decreases, and is `total` in the last
/// call, when the result is ready. Parts do not take equally long. The callback is called each time about a
/// millisecond of work is done, by any thread, one at a time; only to sort a long list takes longer (a tenth of a
/// second for a million items). If it returns `Break`, the operation ends with an error of which
/// [`Error::is_cancelled`] is true; the map stays as it is, and what is asked of it next begins anew. If several
/// threads ask one map at once, the callback hears of all of them in turn, and of some perhaps not the end.
#[derive(Debug)]
pub struct VisibilityMap<'t> {
    pub(super) tree: &'t BspTree,
    pub(super) stock: Stock<'t>,
    /// Of the faces of polygons that show, and of the items of translucent ones.
    pub(super) rims: Rims<'t>,
    pub(super) leaves: Vec<Leaf>,
    pub(super) reporter: Reporter<'t>,
}

/// A polygon that shows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Shown {
    /// The polygon, by its number in the input.
    pub polygon: usize,
    /// How much of the picture shows it, in square pixels.
    pub area: f64,
    /// A point of the picture that shows it, near the middle of the largest of its cells.
    pub point: [f64; 2],
}

/// A part of the picture that shows one polygon.
#[derive(Clone, Copy, Debug)]
pub struct MapCell<'m> {
    polygon: usize,
    cell: &'m Cell,
}

impl<'t> VisibilityMap<'t> {
    /// What rays meet first of a tree's polygons: of both sides, or of fronts alone, as the rays say. They
    /// have to be made for [`tree.faces()`](BspTree::faces), or for those of a tree with the same
    /// [grid](BspTree::grid).
    ///
    /// # Errors
    ///
    /// If the rays were made for another grid, if the tree is of one cell of a partition, or if there is not
    /// enough memory.
    pub fn of(tree: &'t BspTree, rays: Rays) -> Result<Self, Error> {
        Self::new(tree, rays, |_| 1.0, Reporter::default())
    }

    /// As [`of`](Self::of), of polygons with opacities, by their numbers, from 0 to 1: those of less than 1
    /// hide nothing, and those of 0 are left out. A polygon shows where nothing opaque is before it; so cells
    /// of translucent polygons lie over those of others.
    ///
    /// What is said of a map elsewhere holds for what is seen through translucent polygons as well:
    /// [`edges`](Self::edges) behind one are visible. The number of cells, and the time, grow with how many
    /// translucent polygons lie over one another.
    ///
    /// # Errors
    ///
    /// As for `of`, and if an opacity is not a number from 0 to 1: [`Error::polygon`] tells whose.
    pub fn with_opacities(
        tree: &'t BspTree,
        rays: Rays,
        opacity: impl Fn(usize) -> f64,
    ) -> Result<Self, Error> {
        Self::new(tree, rays, opacity, Reporter::default())
    }

    /// As [`with_opacities`](Self::with_opacities), with `progress` as in
    /// [`of_with_progress`](Self::of_with_progress).
    ///
    /// # Errors
    ///
    /// As for `with_opacities`, and [`Error`] if it was cancelled.
    pub fn with_opacities_and_progress(
        tree: &'t BspTree,
        rays: Rays,
        opacity: impl Fn(usize) -> f64,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send + 't,
    ) -> Result<Self, Error> {
        Self::new(tree, rays, opacity, Reporter::new(progress))
    }

    /// As [`of`](Self::of). Now and then `progress` is called with how far it is, and may cancel it: now, and in
    /// all that is asked of the map afterwards. See [above](Self#progress).
    ///
    /// # Errors
    ///
    /// As for `of`, and [`Error`] if it was cancelled.
    pub fn of_with_progress(
        tree: &'t BspTree,
        rays: Rays,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send + 't,
    ) -> Result<Self, Error> {
        Self::new(tree, rays, |_| 1.0, Reporter::new(progress))
    }

    fn new(
        tree: &'t BspTree,
        rays: Rays,
        opacity: impl Fn(usize) -> f64,
        reporter: Reporter<'t>,
    ) -> Result<Self, Error> {
        let opacities = checked(tree, opacity)?;
        let (stock, rims, leaves) = reporter.watch(3, |watch| {
            let picture = Tile::picture(rays.size());
            let stock = Stock::new(tree, rays, opacities, watch)?;
            let (leaves, mut rims) = visible(&stock, picture, watch)?;
            add_shown(&mut rims, &stock, &leaves, watch)?;
            Ok((stock, rims, leaves))
        })?;
        Ok(Self { tree, stock, rims, leaves, reporter })
    }

    /// The picture's width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.stock.frame.rays.size()
    }

    /// All cells, in no particular order.
    pub fn cells(&self) -> impl Iterator<Item = MapCell<'_>> + Clone {
        let cells = self.leaves.iter().flat_map(|leaf| &leaf.cells);
        cells.map(|Visible { item, cell }| MapCell { polygon: self.stock.polygon(*item), cell })
    }

    /// The polygons that show, by their numbers.
    pub fn polygons(&self) -> impl Iterator<Item = Shown> {
        let mut found: BTreeMap<usize, (Shown, f64)> = BTreeMap::new();
        for cell in self.cells() {
            let (polygon, area) = (cell.polygon(), cell.area());
            let new = (Shown { polygon, area: 0.0, point: cell.middle() }, area);
            let (shown, largest) = found.entry(polygon).or_insert(new);
            shown.area += area;
            if area > *largest {
                (shown.point, *largest) = (cell.middle(), area);
            }
        }
        found.into_values().map(|(shown, _)| shown)
    }
}

/// Adds the outlines of all faces of polygons that show, and of the items of translucent ones: a phase.
fn add_shown<'t>(
    rims: &mut Rims<'t>,
    stock: &Stock<'t>,
    leaves: &[Leaf],
    watch: &Watch<'_>,
) -> Result<(), Error> {
    let faces = stock.frame.faces;
    let mut shows = filled(stock.polygons_end(watch)?, false)?;
    for visible in each(watch, 1, leaves.iter().flat_map(|leaf| &leaf.cells)) {
        shows[stock.polygon(visible?.item)] = true;
    }
    for face in each(watch, 1, 0..faces.len() as u32) {
        let face = face?;
        if stock.sees(face) && shows[faces.polygon(face)] {
            watch.work(LINES + stock.edges_work(face) * LINES / 4)?;
            rims.outline(stock, face)?;
        }
        finish_item(watch, face as usize, faces.len());
    }
    for item in each(watch, 1, 0..stock.items.len() as u32) {
        let item = item?;
        if !stock.is_opaque(item) && shows[stock.polygon(item)] {
            watch.work(LINES)?;
            rims.item(stock, item)?;
        }
    }
    Ok(())
}

/// The opacities of all polygons; none if all are opaque.
fn checked(tree: &BspTree, opacity: impl Fn(usize) -> f64) -> Result<Vec<f64>, Error> {
    let opacities = collect((0..tree.preparation().polygons).map(opacity))?;
    let is_wrong = |opacity: &f64| !(0.0..=1.0).contains(opacity);
    match opacities.iter().position(is_wrong) {
        Some(polygon) => Err(InputFault::Opacity { value: opacities[polygon] }.of_polygon(polygon)),
        None if opacities.iter().all(|&opacity| opacity == 1.0) => Ok(vec![]),
        None => Ok(opacities),
    }
}

impl MapCell<'_> {
    /// The polygon that shows, by its number in the input.
    pub fn polygon(&self) -> usize {
        self.polygon
    }

    /// The corners, rounded, three or more, clockwise in the picture, with x to the right and y down.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [f64; 2]> + Clone {
        self.cell.sides.iter().map(|side| side.start.at)
    }

    /// Its area in square pixels.
    pub fn area(&self) -> f64 {
        (0.5 * self.cell.double_area()).max(0.0)
    }

    fn middle(&self) -> [f64; 2] {
        let n = self.cell.sides.len() as f64;
        self.corners().fold([0.0; 2], |[x, y], [a, b]| [x + a / n, y + b / n])
    }
}
