//! The visibility map: the visible parts of polygons in a picture, found tile by tile.
//!
//! A tile has a list of the pieces that may be visible in it, front to back. The list ends with the first
//! piece that covers the tile. If one sheet of connected faces is visible in the tile, the tile is a leaf, and
//! nothing is subtracted. If the list is short, the tile is a leaf, and each piece is subtracted from the
//! uncovered part. Otherwise the tile is halved.

use std::cmp::Ordering;
use std::fmt;
use std::ops::ControlFlow;

use super::cell::Cell;
use super::primitives::Primitives;
use super::quadtree::{Candidates, Leaf, TileList, Visible, found_in};
use super::sheets::MapTile;
use crate::error::{Error, Kind};
use crate::progress::{Progress, Watch, one_at_a_time};
use crate::raster::Rays;
use crate::tree::BspTree;
use crate::view::Camera;

/// The visible parts of polygons in one view, divided into cells. A [cell](MapCell) is a convex part of the
/// picture in which one polygon is visible. [`BspTree::visibility`] computes a map.
///
/// The map is exact and adds no tolerance. An edge of a cell is stored as a plane through the eye, with
/// integer coefficients. A corner is stored as the intersection of two such planes, never as a rounded point.
/// A polygon is in the map if and only if a part of it is visible, however small. Where two coplanar polygons
/// overlap, the visible polygon is the one that the tree's back-to-front order paints last.
///
/// The tree's [tolerance](crate::BspTree#exactness) may move the corners of a polygon onto a plane: see
/// [flattened](crate::Preparation::flattened) and [nearly coplanar](crate::Stats::nearly_coplanar) polygons.
/// This plane decides which polygon is in front. In most cases, the polygon's edges in the picture still go
/// through the given corners, so there is no crack between neighbours that share an edge. The edges go
/// through the moved corners if
///
/// - a corner was moved by more than 2⁻³² of the scene's [extent](crate::BspTree#exactness) (the rounding of
///   `f64` moves corners less);
/// - the given corners do not form a convex polygon in the picture; or
/// - the polygon has more than eight corners.
///
/// The time is O(n log n) for n [fragments](crate::Fragment) in most scenes. The map stores its cells, and
/// the edges of all polygons in the frustum, including hidden polygons. With the feature `parallel`, all
/// threads share the work; the map is the same, bit for bit.
///
/// Positions are in pixels, as for [`Camera::project`]: x points right, and y points down. The upper left
/// corner of the first pixel is (0, 0), and its centre is (½, ½).
///
/// # Progress
///
/// A map keeps the callback [`ViewOptions::progress`]. The making of the map, and each later operation of the
/// map that can fail, reports its [`Progress`] to this callback. Each operation counts separately:
///
/// - `total` is the number of the operation's parts, which do not take equally long. It does not change
///   during the operation.
/// - `done` begins with 0 and never decreases. In the last call, when the result is ready, it equals `total`.
///
/// The callback is called about once per millisecond, by any thread, one call at a time. While a long list is
/// sorted or read, a call may be late, by a tenth of a second for a million items. If several threads use one
/// map at once, their operations take turns to call the callback, and the last call of an operation may be
/// missing.
///
/// If the callback returns `Break`, the operation ends with an error whose [kind](Error::kind) is
/// `Cancelled`. The map is not changed and can still be used. A new call of the operation starts from the
/// beginning.
#[derive(Debug)]
pub struct VisibilityMap<'t> {
    pub(super) tree: &'t BspTree,
    pub(super) primitives: Primitives<'t>,
    pub(super) leaves: Vec<Leaf>,
    /// Drawings leave out polygons with a smaller visible area.
    pub(super) least_area: f64,
    pub(super) reporter: Reporter<'t>,
}

/// The options of a view, for [`BspTree::visibility`] and
/// [`Drawing::translucent`](super::Drawing::translucent).
///
/// ```
/// use binspace::drawing::ViewOptions;
///
/// let options = ViewOptions::DEFAULT.with_front_faces_only().with_opacities(vec![1.0, 0.5]);
/// assert_eq!(options.least_area, 0.0);
/// ```
#[derive(Clone, Default)]
#[non_exhaustive]
pub struct ViewOptions<'a> {
    /// Whether polygons that are seen from behind are left out. The corners of such polygons run clockwise in
    /// the picture. Default: `false`.
    pub front_faces_only: bool,
    /// The opacity of each polygon, from 0 to 1, in input order. Polygons with an opacity of less than 1 hide
    /// nothing, and polygons with opacity 0 are left out. Default: an empty list, with which all polygons are
    /// opaque.
    pub opacities: Vec<f64>,
    /// The least visible area, in square pixels. [Drawings](VisibilityMap::drawing) leave out polygons whose
    /// visible area is smaller. Lists of [regions](VisibilityMap::regions) leave out smaller regions.
    /// Default: 0, which leaves out nothing. NaN counts as 0.
    pub least_area: f64,
    /// A callback that receives the progress and can cancel the work: see [Progress](VisibilityMap#progress).
    /// Default: `None`.
    pub progress: Option<&'a (dyn Fn(Progress) -> ControlFlow<()> + Sync)>,
}

impl<'a> ViewOptions<'a> {
    /// Shows all polygons, opaque, from both sides.
    pub const DEFAULT: Self =
        Self { front_faces_only: false, opacities: vec![], least_area: 0.0, progress: None };

    /// Sets [`front_faces_only`](Self::front_faces_only).
    #[must_use]
    pub fn with_front_faces_only(self) -> Self {
        Self { front_faces_only: true, ..self }
    }

    /// Sets [`opacities`](Self::opacities).
    #[must_use]
    pub fn with_opacities(self, opacities: Vec<f64>) -> Self {
        Self { opacities, ..self }
    }

    /// Sets [`least_area`](Self::least_area).
    #[must_use]
    pub fn with_least_area(self, least_area: f64) -> Self {
        Self { least_area, ..self }
    }

    /// Sets a callback for [`progress`](Self::progress).
    #[must_use]
    pub fn with_progress(self, progress: &'a (dyn Fn(Progress) -> ControlFlow<()> + Sync)) -> Self {
        Self { progress: Some(progress), ..self }
    }
}

impl fmt::Debug for ViewOptions<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ViewOptions")
            .field("front_faces_only", &self.front_faces_only)
            .field("opacities", &self.opacities)
            .field("least_area", &self.least_area)
            .field("progress", &self.progress.map(|_| "callback"))
            .finish()
    }
}

/// The handling of hidden parts of [edges](VisibilityMap::edges), [crossings](VisibilityMap::crossings) and
/// [lines](VisibilityMap::lines).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Hidden {
    /// Leaves hidden parts out.
    #[default]
    Skip,
    /// Returns hidden parts as [runs](super::EdgeRun) that are not visible.
    Keep,
    /// Returns hidden parts as runs, like `Keep`, and counts the polygons in front of each run:
    /// [`EdgeRun::layers`](super::EdgeRun::layers). Hidden runs are cut where this number changes.
    ///
    /// A polygon counts once, even if it is hidden itself. Polygons that are seen edge-on do not count, and
    /// polygons that have the edge do not count. Exception: if a polygon is not planar, another part of the
    /// polygon may be in front of its own edge. Then the polygon counts.
    ///
    /// The number for a hidden run is at least 1, even if the run only touches the polygon that hides the
    /// run. (Example: the edge of a shelf touches the wall that hides the edge.) Time and memory are
    /// proportional to the number of polygons in front of hidden parts. (A. Appel, "The notion of
    /// quantitative invisibility and the machine rendering of solids", 1967.)
    Count,
}

/// A polygon with a visible part in a [`VisibilityMap`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct VisiblePolygon {
    /// The index of the polygon, in input order.
    pub polygon: usize,
    /// The visible area of the polygon, in square pixels.
    pub area: f64,
    /// A point, in pixels, at which the polygon is visible: near the middle of the largest of the convex
    /// [cells](MapCell) that form the polygon's visible part.
    pub point: [f64; 2],
}

/// A cell of a [`VisibilityMap`]: a convex part of the picture in which one polygon is visible.
#[derive(Clone, Copy, Debug)]
pub struct MapCell<'m> {
    pub(super) polygon: usize,
    pub(super) cell: &'m Cell,
}

impl BspTree {
    /// Computes the visible parts of the tree's polygons for a camera.
    ///
    /// A polygon is visible where no opaque polygon is in front of it. So the [cells](MapCell) of
    /// translucent polygons, whose [opacities](ViewOptions::opacities) are less than 1, overlap the cells of
    /// the polygons behind them. The number of cells and the time grow with the number of translucent
    /// polygons that lie over one another.
    ///
    /// # Errors
    ///
    /// An error is returned if
    ///
    /// - the camera is too far from the scene or its view is too narrow, as for [`Rays::new`];
    /// - the tree is the tree of one cell of a [partition](crate::partition);
    /// - the list of opacities is not empty, and its length is not the number of polygons;
    /// - an opacity is not a number from 0 to 1 ([`Error::polygon`] is the first such polygon);
    /// - memory runs out; or
    /// - the [callback](ViewOptions::progress) cancels the work.
    pub fn visibility<'t>(
        &'t self,
        camera: &Camera,
        options: &ViewOptions<'t>,
    ) -> Result<VisibilityMap<'t>, Error> {
        let ViewOptions { front_faces_only, ref opacities, least_area, progress } = *options;
        let rays = drawing_rays(self, camera, front_faces_only)?;
        let opacities = checked(self, opacities)?;
        let reporter = Reporter::new(progress);
        let (primitives, leaves) = reporter.watch(2, |watch| {
            let primitives = Primitives::new(self, rays, opacities, watch)?;
            let leaves = visible(&primitives, watch)?;
            Ok((primitives, leaves))
        })?;
        Ok(VisibilityMap { tree: self, primitives, leaves, least_area, reporter })
    }
}

/// The rays of a drawing: pictures begin at the corner of the first pixel.
pub(super) fn drawing_rays(
    tree: &BspTree,
    camera: &Camera,
    front_faces_only: bool,
) -> Result<Rays, Error> {
    let rays = Rays::new(camera, tree.faces())?;
    let rays = if front_faces_only { rays.with_front_faces_only() } else { rays };
    Ok(rays.with_corner_origin())
}

impl VisibilityMap<'_> {
    /// Returns the picture's width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.primitives.lines.frame.rays.size()
    }

    /// Returns all cells. Of two cells that overlap, the nearer comes first. Cells overlap only where
    /// the nearer polygon is translucent.
    pub fn cells(&self) -> impl Iterator<Item = MapCell<'_>> + Clone {
        let cells = self.leaves.iter().flat_map(|leaf| &leaf.cells);
        cells
            .map(|Visible { item, cell }| MapCell { polygon: self.primitives.polygon(*item), cell })
    }

    /// Returns the visible polygons, sorted by index. [`ViewOptions::least_area`] has no effect on this
    /// list. Each call computes the list again, in O(n + c) for n polygons and c cells.
    pub fn polygons(&self) -> impl Iterator<Item = VisiblePolygon> {
        /// The area of a polygon's cells, and the largest cell with its area.
        #[derive(Clone, Copy)]
        struct Shown<'m> {
            area: f64,
            largest: Option<(MapCell<'m>, f64)>,
        }
        let none = Shown { area: 0.0, largest: None };
        let mut all = vec![none; self.primitives.polygon_count()];
        for cell in self.cells() {
            let (shown, area) = (&mut all[cell.polygon()], cell.area());
            shown.area += area;
            if shown.largest.is_none_or(|(_, largest)| area > largest) {
                shown.largest = Some((cell, area));
            }
        }
        all.into_iter().enumerate().filter_map(|(polygon, Shown { area, largest })| {
            largest.map(|(cell, _)| VisiblePolygon { polygon, area, point: cell.middle() })
        })
    }

    /// The sorted numbers of the polygons that drawings leave out because their visible area is too small.
    pub(super) fn left_out(&self) -> Vec<usize> {
        if self.least_area.is_nan() || self.least_area <= 0.0 {
            return vec![];
        }
        let small = self.polygons().filter(|visible| visible.area < self.least_area);
        small.map(|visible| visible.polygon).collect()
    }
}

/// The opacities of all polygons; an empty list if all polygons are opaque.
pub(super) fn checked(tree: &BspTree, opacities: &[f64]) -> Result<Vec<f64>, Error> {
    let expected = tree.preparation().polygons;
    if !opacities.is_empty() && opacities.len() != expected {
        return Err(Kind::Opacities { given: opacities.len(), expected }.error());
    }
    let is_wrong = |opacity: &f64| !(0.0..=1.0).contains(opacity);
    match opacities.iter().position(is_wrong) {
        Some(polygon) => Err(Kind::Opacity(opacities[polygon]).of_polygon(polygon)),
        None if opacities.iter().all(|&opacity| opacity == 1.0) => Ok(vec![]),
        None => Ok(opacities.to_vec()),
    }
}

impl MapCell<'_> {
    /// Returns the index of the visible polygon, in input order.
    pub fn polygon(&self) -> usize {
        self.polygon
    }

    /// Returns the corners, rounded, in pixels: three or more, clockwise in the picture.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [f64; 2]> + Clone {
        self.cell.sides.iter().map(|side| side.start.at)
    }

    /// Returns the area of the cell in square pixels.
    pub fn area(&self) -> f64 {
        (0.5 * self.cell.double_area()).max(0.0)
    }

    fn middle(&self) -> [f64; 2] {
        let n = self.cell.sides.len() as f64;
        self.corners().fold([0.0; 2], |[x, y], [a, b]| [x + a / n, y + b / n])
    }
}

/// The visible parts of all items, in the order of the tiles. Counts as one phase of the progress.
pub(super) fn visible<'p>(
    primitives: &'p Primitives<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<Leaf>, Error> {
    let halves = |tile: &MapTile<'p>| (!tile.is_settled()).then(|| tile.halves(watch)).transpose();
    let leaf = |tile: &MapTile<'p>, found: &mut Vec<Leaf>| {
        if !tile.list.candidates.list.is_empty() {
            found.push(tile.leaf(watch)?);
        }
        Ok(())
    };
    let items = Candidates::items(primitives, |_| true)?.ending_at_covers();
    let all = MapTile::picture(TileList::picture(items, watch)?, watch)?;
    let parts = found_in(all, halves, leaf, watch)?;
    Ok(parts.into_iter().flatten().collect())
}

/// The number of parts that each phase of an operation adds to the progress.
const PARTS: usize = 64;
/// Loops poll for cancellation after this much work, in pieces that a build examines: a tenth of a
/// millisecond. Too small: polling takes time. Too large: cancelling takes longer.
const STRETCH: usize = 1 << 12;
/// The cost of sorting one item of a list, in pieces that a build examines.
const SORTED: usize = 6;
/// The number of items sorted between two polls for cancellation. Too small: merging takes time. Too large:
/// cancelling takes longer.
const SORTED_AT_ONCE: usize = 1 << 16;

type Report<'c> = dyn Fn(&Watch<'_>) -> ControlFlow<()> + Send + Sync + 'c;

/// A reporter of the progress of operations to a callback, if any. The callback can cancel the operations.
#[derive(Default)]
pub(super) struct Reporter<'c>(Option<Box<Report<'c>>>);

impl<'c> Reporter<'c> {
    pub(super) fn new(progress: Option<&'c (dyn Fn(Progress) -> ControlFlow<()> + Sync)>) -> Self {
        Self(progress.map(|progress| Box::new(one_at_a_time(progress)) as Box<Report<'c>>))
    }

    /// Runs an operation of `phases` phases, each of which counts `PARTS` parts. The last part is reported
    /// only when the operation ends.
    pub(super) fn watch<T>(
        &self,
        phases: usize,
        operation: impl FnOnce(&Watch<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let watch = match &self.0 {
            Some(callback) => Watch::new(&**callback),
            None => Watch::default(),
        };
        watch.expect(phases * PARTS + 1)?;
        let result = operation(&watch)?;
        watch.end()?;
        Ok(result)
    }
}

impl fmt::Debug for Reporter<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = if self.0.is_some() { "Reporter(callback)" } else { "Reporter(nobody)" };
        f.write_str(name)
    }
}

/// Counts item `i` of the `n` items of a phase as done.
pub(super) fn finish_item(watch: &Watch<'_>, i: usize, n: usize) {
    for _ in i * PARTS / n..(i + 1) * PARTS / n {
        watch.finish(0);
    }
}

/// Wraps an iterator so that the loop polls for cancellation. `pieces` is the cost of one item, in pieces
/// that a build examines.
pub(super) fn each<T>(
    watch: &Watch<'_>,
    pieces: usize,
    items: impl IntoIterator<Item = T>,
) -> impl Iterator<Item = Result<T, Error>> {
    let mut items = items.into_iter();
    let mut done = Done { watch, work: 0 };
    std::iter::from_fn(move || {
        let item = items.next();
        done.work += pieces;
        if done.work >= STRETCH || item.is_none() {
            return done.report().err().map(Err).or(item.map(Ok));
        }
        item.map(Ok)
    })
}

/// Work that is done but not yet counted. If a loop ends early, `drop` counts this work.
struct Done<'w, 'c> {
    watch: &'w Watch<'c>,
    work: usize,
}

impl Done<'_, '_> {
    fn report(&mut self) -> Result<(), Error> {
        self.watch.work(std::mem::take(&mut self.work))
    }
}

impl Drop for Done<'_, '_> {
    fn drop(&mut self) {
        // After a cancellation, the next poll returns the error.
        let _ = self.report();
    }
}

/// Sorts a list, stably, unless the operation is cancelled. Parts are sorted first, so that sorting the whole
/// list is fast.
pub(super) fn sort_by<T>(
    list: &mut [T],
    watch: &Watch<'_>,
    compare: impl Fn(&T, &T) -> Ordering,
) -> Result<(), Error> {
    // The sort is long, so it is compiled once for each type of item, not once for each function.
    let compare: &dyn Fn(&T, &T) -> Ordering = &compare;
    for part in list.chunks_mut(SORTED_AT_ONCE) {
        watch.work(part.len() * SORTED)?;
        part.sort_by(compare);
    }
    if list.len() > SORTED_AT_ONCE {
        list.sort_by(compare);
    }
    Ok(())
}

/// Sorts a list and removes duplicates.
pub(super) fn sort_unique<T: Ord>(list: &mut Vec<T>, watch: &Watch<'_>) -> Result<(), Error> {
    sort_by(list, watch, T::cmp)?;
    watch.work(list.len())?;
    list.dedup();
    Ok(())
}

#[cfg(test)]
mod reporter_tests {
    use std::sync::Mutex;
    use std::sync::atomic::AtomicUsize;
    use std::sync::atomic::Ordering::Relaxed;

    use super::*;

    /// If the callback cancels at a step, no more work is done after this step.
    #[test]
    fn loops_and_sorts_end_where_they_are_cancelled() {
        for calls in 1..8 {
            let left = AtomicUsize::new(calls);
            let callback = |_| match left.fetch_sub(1, Relaxed) {
                1 => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            };
            let reporter = Reporter::new(Some(&callback));
            let mut done = 0;
            let result = reporter.watch(1, |watch| {
                let mut list: Vec<u32> = (0..1 << 17).rev().collect();
                for item in each(watch, 1, 0..1 << 18) {
                    item?;
                    done += 1;
                }
                sort_by(&mut list, watch, u32::cmp)
            });
            assert!(result.unwrap_err().kind() == crate::ErrorKind::Cancelled);
            assert_eq!(left.load(Relaxed), 0);
            assert!(done <= (calls - 1) << 16, "{done} by call {calls}");
        }
    }

    #[test]
    fn all_parts_of_a_phase_are_done_in_the_end() {
        for n in [1, 2, 3, 63, 64, 65, 1000] {
            let last = Mutex::new(None);
            let callback = |progress: Progress| {
                *last.lock().unwrap() = Some([progress.done, progress.total]);
                ControlFlow::Continue(())
            };
            let reporter = Reporter::new(Some(&callback));
            let phase = |watch: &Watch<'_>| {
                (0..n).for_each(|i| finish_item(watch, i, n));
                watch.work(1 << 16)?;
                Err::<(), _>(Error::cancelled())
            };
            reporter.watch(2, phase).unwrap_err();
            assert_eq!(*last.lock().unwrap(), Some([PARTS, 2 * PARTS + 1]), "{n}");
        }
    }
}
