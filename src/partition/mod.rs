//! A scene divided into cells by planes.

mod choose;
#[cfg(feature = "save")]
mod saved;

use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use crate::exact::faces::{CellBox, EVERYWHERE};
use crate::exact::{Eye, Faces, LATTICE_LIMIT, Lattice, Plane};
use crate::input::{MAX_CORNERS, Point, Polygon};
use crate::viewpoint::Viewpoint;

/// A scene divided into cells: a k-d tree of planes perpendicular to the axes, whose leaves are the cells.
///
/// Use a partition for scenes too large for one tree, or for one machine. Each cell has a separate tree,
/// which contains the parts of polygons inside the cell. The trees can be built on different machines and at
/// different times.
///
/// To order the whole scene for a viewpoint, read the cells in their [order](Self::back_to_front), and for
/// each cell the order of its tree. This order is as exact as the order of one tree.
///
/// ```
/// use binspace::partition::Extent;
/// use binspace::{BuildOptions, Viewpoint, scene};
///
/// let (scene, options) = (scene::terrain(2000, 1), BuildOptions::DEFAULT);
/// // All processes must use the same extent and the same samples of corners.
/// let mut extent = Extent::default();
/// scene.polygons().for_each(|polygon| extent.include(&polygon));
/// let samples = scene.polygons().map(|polygon| polygon.points()[0]);
/// let partition = options.partition(&extent, samples, 6)?;
///
/// // The polygons that reach into each cell.
/// let mut given = vec![vec![]; partition.cells()];
/// let mut reached = Vec::new();
/// for number in 0..scene.len() {
///     partition.reached_by(scene.polygon(number), &mut reached);
///     reached.iter().for_each(|&cell| given[cell].push(number));
/// }
/// // Here or elsewhere: a tree of each cell.
/// let eye = Viewpoint::eye([100.0, 30.0, 60.0]);
/// for cell in partition.back_to_front(eye) {
///     let polygons = given[cell].iter().map(|&number| scene.polygon(number));
///     let tree = options.build_cell(&partition, cell, polygons)?;
///     for fragment in tree.back_to_front(eye) {
///         // The fragment's polygon is its place in the list given to the cell.
///         let number = given[cell][fragment.polygon()];
///         # assert!(number < scene.len());
///     }
/// }
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # Cells
///
/// Each point of each polygon is in one cell. Points in a plane between two cells, or within the tolerance of
/// that plane, belong to the cell on the side of larger coordinates.
///
/// The planes between cells cut polygons exactly, like the planes of a tree. If such a plane cuts a polygon,
/// the parts of the polygon on both sides have bit for bit the same vertices on the plane. If the plane cuts
/// two polygons through a common edge, both polygons have the same vertex there, unless the tolerance moved a
/// corner of one of the two polygons. As in one tree, the cuts inside cells can end in
/// [T-junctions](crate::BspTree#t-junctions).
///
/// All cells have the same [grid](crate::BspTree::grid) and tolerance. So a polygon that is triangulated or
/// flattened (made planar within the tolerance) in one cell is triangulated or flattened in all cells.
///
/// # Tolerance
///
/// All cells have one tolerance, a length: the tolerance of the [options](crate::BuildOptions::partition)
/// with which the partition was made. By default the tolerance depends on the [extent](Extent) and the
/// precision of all polygons, as in one tree of the scene. The options with which a cell is built do not
/// affect the tolerance.
///
/// The order is right up to the tolerance, as in [one tree](crate::BspTree#exactness). Two polygons that are
/// closer to each other than the tolerance, and not coplanar, can have another order than in one tree of the
/// scene.
///
/// # Trees of cells
///
/// The tree of a cell returns orders, [fragments](crate::Fragment), meshes, boxes and hits of the polygons'
/// parts in the cell. The tree of a cell differs from other trees in these respects:
///
/// - Winding numbers, drawings, and the depth buffers of `raster` and `verify` need whole polygons. So these
///   features do not work with the tree of a cell.
/// - The [`dropped`](crate::BspTree::dropped) polygons include the polygons outside the cell.
/// - The other counts of the tree's [preparation](crate::BspTree::preparation) include all polygons passed to
///   the build of the cell. To count each polygon of the scene once, use [`preparation`](Self::preparation).
/// - [`BspTree::extend`](crate::BspTree::extend) cuts added polygons to the cell.
/// - An [`Overlay`](crate::overlay::Overlay) does not cut its polygons to the cell. If you add a polygon to
///   the overlays of several cells, the whole polygon is in each of these overlays.
///
/// With the feature `save`, `Partition::write` and `Partition::read` store a partition, for instance to
/// send it to other machines.
#[derive(Clone, Debug, PartialEq)]
pub struct Partition {
    lattice: Lattice,
    /// The tolerance in lattice units.
    tolerance: f64,
    /// The planes, depth first, the subtree behind a plane before the subtree in front. A plane that divides
    /// n cells has n / 2 cells behind it, rounded down, so the numbers alone locate every subtree.
    planes: Vec<SplitPlane>,
}

/// A plane between cells. Its front is the side of larger coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SplitPlane {
    axis: usize,
    /// The position of the plane on the axis, a lattice coordinate.
    at: f64,
}

/// A subtree: the number of its first plane, and its cells.
#[derive(Clone, Debug)]
struct CellRange {
    plane: usize,
    cells: Range<usize>,
}

impl CellRange {
    /// The parts behind and in front of the subtree's plane. A subtree of two cells or more has a plane.
    fn sides(&self) -> [Self; 2] {
        let Self { plane, cells } = self;
        let behind = cells.start + cells.len() / 2;
        let back = Self { plane: plane + 1, cells: cells.start..behind };
        // A subtree has one plane less than cells.
        [back.clone(), Self { plane: plane + back.cells.len(), cells: behind..cells.end }]
    }
}

impl Partition {
    /// The largest number of cells of a partition, about 17 million.
    // Too small: scenes cannot be divided. Too large: a forged file takes much memory.
    pub const MAX_CELLS: usize = 1 << 24;

    /// Returns the number of cells, at least one.
    pub fn cells(&self) -> usize {
        self.planes.len() + 1
    }

    /// Returns the tolerance of all cells, a length.
    pub fn tolerance(&self) -> f64 {
        self.lattice.length_to_world(self.tolerance)
    }

    /// Returns the lower and the upper corner of a cell, in the polygons' unit and rounded outwards. If
    /// no plane bounds the cell on a side, the coordinate of that side is infinite.
    ///
    /// # Panics
    ///
    /// If `cell` is not less than [`cells`](Self::cells).
    pub fn bounds(&self, cell: usize) -> [DVec3; 2] {
        let [low, high] = self.cell(cell);
        let [mut outer_low, mut outer_high] = self.lattice.enclose(low, high);
        for axis in 0..3 {
            if low[axis] == EVERYWHERE[0][axis] {
                outer_low[axis] = f64::NEG_INFINITY;
            }
            if high[axis] == EVERYWHERE[1][axis] {
                outer_high[axis] = f64::INFINITY;
            }
        }
        [outer_low, outer_high]
    }

    fn root(&self) -> CellRange {
        CellRange { plane: 0, cells: 0..self.cells() }
    }

    /// An empty set of faces for a cell.
    pub(crate) fn faces(&self, cell: usize) -> Faces {
        Faces::of_cell(self.lattice, self.tolerance, self.cell(cell))
    }

    /// The box of a cell, in lattice units.
    fn cell(&self, cell: usize) -> CellBox {
        assert!(cell < self.cells(), "cell {cell} of {}", self.cells());
        let (mut found, mut subtree) = (EVERYWHERE, self.root());
        while subtree.cells.len() > 1 {
            let SplitPlane { axis, at } = self.planes[subtree.plane];
            let [back, front] = subtree.sides();
            let is_behind = back.cells.contains(&cell);
            found[usize::from(is_behind)][axis] = at;
            subtree = if is_behind { back } else { front };
        }
        found
    }

    /// Returns the numbers of all cells, furthest first: no cell hides a later cell. An eye on a plane
    /// between two cells may be treated as lying on either side of that plane, as in a tree. Takes O(cells)
    /// time.
    pub fn back_to_front(&self, viewpoint: Viewpoint) -> Vec<usize> {
        let eye = Eye::new(viewpoint, &self.lattice);
        let mut order = Vec::with_capacity(self.cells());
        let mut rest = vec![self.root()];
        while let Some(subtree) = rest.pop() {
            if subtree.cells.len() == 1 {
                order.push(subtree.cells.start);
                continue;
            }
            let SplitPlane { axis, at } = self.planes[subtree.plane];
            let [back, front] = subtree.sides();
            let is_in_front = Plane::axis(axis, [at; 3]).at_eye(&eye).is_gt();
            // The nearer side is pushed first, so that it is popped later.
            rest.extend(if is_in_front { [front, back] } else { [back, front] });
        }
        order
    }

    /// Returns the numbers of all cells, nearest first: the reverse of
    /// [`back_to_front`](Self::back_to_front).
    pub fn front_to_back(&self, viewpoint: Viewpoint) -> Vec<usize> {
        let mut order = self.back_to_front(viewpoint);
        order.reverse();
        order
    }

    /// Replaces `cells` by the cells that a polygon may reach, in ascending order.
    /// [`build_cell`](crate::BuildOptions::build_cell) needs only the polygons that reach the cell to build.
    ///
    /// The test is conservative: a cell is listed if the cell's box meets the polygon's box, enlarged by the
    /// tolerance, and also meets a thin layer around the polygon's plane. So a few listed cells may contain
    /// no part of the polygon, which does no harm. If a corner of the polygon is NaN or outside the
    /// partition's grid, or if the polygon has more than 2²² corners, all cells are listed, and building any
    /// of these cells with the polygon returns an error.
    ///
    /// Takes O(corners + cells reached · log cells) time.
    pub fn reached_by(&self, polygon: &(impl Polygon + ?Sized), cells: &mut Vec<usize>) {
        cells.clear();
        let corners = polygon.corners().take(MAX_CORNERS + 1);
        let corners: SmallVec<[[f64; 3]; 8]> =
            corners.map(|corner| self.lattice.snap(corner.to_dvec3())).collect();
        let Some(&first) = corners.first() else { return };
        let is_on_lattice = |corner: &[f64; 3]| corner.iter().all(|c| c.abs() <= LATTICE_LIMIT);
        if corners.len() > MAX_CORNERS || !corners.iter().all(is_on_lattice) {
            cells.extend(0..self.cells());
            return;
        }
        let margin = MARGIN[0] * self.tolerance + MARGIN[1];
        let [mut low, mut high] = [first; 2];
        for corner in &corners {
            for axis in 0..3 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let reach = [low.map(|c| c - margin), high.map(|c| c + margin)];
        let mut slot = None;
        let mut rest: SmallVec<[(CellRange, CellBox); 16]> = SmallVec::new();
        rest.push((self.root(), reach));
        while let Some((subtree, part)) = rest.pop() {
            if subtree.cells.len() == 1 {
                // A polygon whose widened box lies in one cell needs no closer look.
                let layer = || Layer::new(&corners, margin);
                if part == reach || slot.get_or_insert_with(layer).meets(&part) {
                    cells.push(subtree.cells.start);
                }
                continue;
            }
            let SplitPlane { axis, at } = self.planes[subtree.plane];
            let [back, front] = subtree.sides();
            let [mut back_part, mut front_part] = [part; 2];
            back_part[1][axis] = at.min(part[1][axis]);
            front_part[0][axis] = at.max(part[0][axis]);
            // The back is pushed last and popped first, so that cells are listed in ascending order.
            if part[1][axis] >= at {
                rest.push((front, front_part));
            }
            if part[0][axis] < at {
                rest.push((back, back_part));
            }
        }
    }
}

/// The bounding box and the precision of a scene. All processes that build cells of a [`Partition`] must use
/// the same extent.
///
/// Each process may compute the extent of a part of the polygons. [`merge`](Self::merge) combines the
/// results, in any order.
///
/// ```
/// use binspace::partition::Extent;
///
/// let mut extent = Extent::default();
/// extent.include(&[[0.0, 1.0, 2.0], [3.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
/// assert_eq!(extent.high.to_array(), [3.0, 1.0, 2.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The least coordinates of corners; ∞ if there is no corner, NaN if a coordinate is infinite or NaN.
    pub low: DVec3,
    /// The largest coordinates of corners; −∞ if there is no corner.
    pub high: DVec3,
    /// The largest [`precision`](Polygon::precision) of the polygons.
    pub precision: f64,
}

impl Default for Extent {
    /// Returns the extent of no polygons.
    fn default() -> Self {
        Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, precision: 0.0 }
    }
}

impl Extent {
    /// Includes a polygon. A polygon with more than 2²² corners is left out: no cell can be built with it.
    pub fn include(&mut self, polygon: &(impl Polygon + ?Sized)) {
        let mut own = Self::default();
        for (number, corner) in polygon.corners().map(Point::to_dvec3).enumerate() {
            if number == MAX_CORNERS {
                return;
            }
            let box_of_it = if corner.is_finite() { [corner; 2] } else { [DVec3::NAN; 2] };
            own.include_box(box_of_it);
        }
        own.precision = polygon.precision();
        self.merge(&own);
    }

    /// Includes another extent.
    pub fn merge(&mut self, other: &Self) {
        self.include_box([other.low, other.high]);
        self.precision = self.precision.max(other.precision);
    }

    fn include_box(&mut self, [low, high]: [DVec3; 2]) {
        // `f64::min` and `f64::max` would ignore NaN.
        for axis in 0..3 {
            if low[axis] < self.low[axis] || low[axis].is_nan() {
                self.low[axis] = low[axis];
            }
            if high[axis] > self.high[axis] || high[axis].is_nan() {
                self.high[axis] = high[axis];
            }
        }
    }
}

/// The distance by which a polygon may reach beyond its corners, in tolerances and in steps of the lattice. A
/// corner is moved onto its face's plane by √3 tolerances and half a step; a cell's plane adds one tolerance:
/// together 2.74 tolerances and half a step. Too small: cells miss polygons. Too large: cells receive
/// polygons that do not reach them.
const MARGIN: [f64; 2] = [3.0, 2.0];
/// A bound on the rounding error of a corner's distance from a plane, as a share of the lengths in its
/// computation. The rounding of the normal itself does not matter, because the layer is right for any normal.
/// Let u = 2⁻⁵³: arms of corners are exact, so a scalar product with an arm is off by 3u, for the product and
/// the sums. An end of a box is off by u, and the difference of an end and a corner by u. The box's middle
/// and half size are off by u more. The scalar product of the middle with the normal, and that of the half
/// size, are each off by 3u. Together with the sums and differences in `meets`, and the slack itself, the
/// error is less than 20u. Too small: cells miss polygons. Too large: cells receive polygons that do not
/// reach them.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The space between two parallel planes around some corners.
struct Layer {
    /// The origin of distances.
    from: DVec3,
    normal: DVec3,
    /// The range of scalar products of the normal with all points, widened by the margin.
    least: f64,
    most: f64,
}

impl Layer {
    /// The layer perpendicular to Newell's normal. A layer perpendicular to any direction would be right, but
    /// with this normal the layer of a planar polygon is thin.
    fn new(corners: &[[f64; 3]], margin: f64) -> Self {
        let from = DVec3::from(corners[0]);
        // Differences of lattice coordinates are exact.
        let arms = corners.iter().map(|&corner| DVec3::from(corner) - from);
        let next = arms.clone().cycle().skip(1);
        let normal: DVec3 = arms.clone().zip(next).map(|(arm, next)| arm.cross(next)).sum();
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        let [least, most] = arms.clone().fold(start, |[least, most], arm| {
            let along = normal.dot(arm);
            [least.min(along), most.max(along)]
        });
        let size = arms.map(|arm| arm.abs().max_element()).fold(0.0, f64::max);
        let slack = normal.abs().element_sum() * (margin + ROUNDING * (size + margin));
        Self { from, normal, least: least - slack, most: most + slack }
    }

    /// Whether the layer meets a box. The box must lie in the bounding box of the corners, widened by the
    /// margin: the bounds on rounding assume this.
    fn meets(&self, [low, high]: &CellBox) -> bool {
        let [low, high] = [low, high].map(|&corner| DVec3::from(corner) - self.from);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let (along, reach) = (self.normal.dot(middle), self.normal.abs().dot(half));
        along - reach <= self.most && along + reach >= self.least
    }
}
