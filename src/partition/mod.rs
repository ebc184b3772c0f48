//! A scene divided into cells by planes.

mod choose;
mod extent;
mod order;
mod reach;
#[cfg(feature = "save")]
mod saved;

use std::ops::Range;

use glam::DVec3;

use crate::exact::cell::{CellBox, EVERYWHERE};
use crate::exact::{Faces, Lattice};
pub use extent::Extent;

/// A scene divided into cells: a k-d tree of planes perpendicular to the axes, whose leaves are the cells.
///
/// It is for scenes too large for one tree, or for one machine. Each cell has a tree of its own, of what
/// is in it of the polygons that reach in, and is built anywhere and at any time; in the
/// [order](Self::back_to_front) of the cells for a viewpoint, the orders of their trees are one order of
/// the whole scene, as right as that of one tree.
///
/// ```
/// use binspace::partition::Extent;
/// use binspace::{BuildOptions, Viewpoint, scene};
///
/// let (scene, options) = (scene::terrain(2000, 1), BuildOptions::DEFAULT);
/// // What all have to agree on: the extent, and some of the corners.
/// let mut extent = Extent::default();
/// scene.polygons().for_each(|polygon| extent.include(&polygon));
/// let samples = scene.polygons().map(|polygon| polygon[0]);
/// let partition = options.partition(&extent, samples, 6)?;
///
/// // Which polygons reach into which cells.
/// let mut given = vec![vec![]; partition.cells()];
/// let mut reached = Vec::new();
/// for number in 0..scene.len() {
///     partition.reached_by(scene.polygon(number), &mut reached);
///     reached.iter().for_each(|&cell| given[cell].push(number));
/// }
/// // Here, or elsewhere: a tree of each cell.
/// let eye = Viewpoint::eye([100.0, 30.0, 60.0]);
/// for cell in partition.back_to_front(eye) {
///     let polygons = given[cell].iter().map(|&number| scene.polygon(number));
///     let tree = options.build_cell(&partition, cell, polygons)?;
///     for fragment in tree.back_to_front(eye) {
///         // The fragment's polygon is known by its place among those that the cell was given.
///         let number = given[cell][fragment.polygon()];
///         # assert!(number < scene.len());
///     }
/// }
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # Cells
///
/// Polygons are cut by the planes of a cell first, exactly, as by the planes of a tree. The two cells
/// beside a plane have the vertices that it makes bit for bit in common, and so have faces on one side of
/// it that share an edge, where both are cut and the tolerance moved no corner of one. (As in one tree,
/// further cuts end in T-junctions.) Each point of each polygon is
/// in one cell: what lies in a plane between two, or within the tolerance of it, is in the one on the side
/// of larger coordinates.
///
/// All cells have the same grid and tolerance, and so prepare a polygon in the same way: where it is
/// triangulated or moved onto its plane, it is so in all of them.
///
/// # Tolerance
///
/// It is one length for all cells, that of the [options](crate::BuildOptions::partition) with which the
/// partition was made: by default it follows the extent and the precision of all polygons, as in one tree
/// of them. The options with which a cell is built have no say in it. Across the planes between cells,
/// orders are right up to the tolerance as across those of a tree: polygons that are nearer to one another
/// than that without lying in one plane may be exchanged, as they may in another tree of the scene.
///
/// # Trees of cells
///
/// A tree of a cell gives orders, fragments, meshes, boxes and hits as any other, of what is in the cell.
/// What is made of whole polygons is not for it: `drawing`, where it is an error, and the depth buffer of
/// `raster`, so `verify` as well. Its [`dropped`](crate::BspTree::dropped) polygons are also those of which
/// nothing is in the cell; other counts of its [preparation](crate::BspTree::preparation) are of all that it
/// was given, and [`preparation`](Self::preparation) counts for all cells.
/// [`BspTree::extend`](crate::BspTree::extend) cuts what it adds to the cell. An
/// [`Overlay`](crate::overlay::Overlay) on it is not cut: what moves there is in each cell that is given it.
///
/// With the feature `save`, a partition is written and read, `Partition::write` and `Partition::read`, to
/// send it to others.
#[derive(Clone, Debug, PartialEq)]
pub struct Partition {
    lattice: Lattice,
    /// The tolerance in lattice units.
    tolerance: f64,
    /// The planes, depth first, what is behind a plane before what is in front. A plane over n cells has
    /// half of them behind it, rounded down: so their numbers say which subtree is where.
    planes: Vec<Wall>,
}

/// A plane between cells. Its front is the side of larger coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wall {
    axis: usize,
    /// Where it is on the axis, a lattice coordinate.
    at: f64,
}

/// A subtree: its first plane, and its cells.
#[derive(Clone, Debug)]
struct CellRange {
    plane: usize,
    cells: Range<usize>,
}

impl CellRange {
    /// What is behind its plane, and what is in front. There is a plane if there are two cells or more.
    fn sides(&self) -> [Self; 2] {
        let Self { plane, cells } = self;
        let behind = cells.start + cells.len() / 2;
        let back = Self { plane: plane + 1, cells: cells.start..behind };
        // A subtree has one plane less than cells.
        [back.clone(), Self { plane: plane + back.cells.len(), cells: behind..cells.end }]
    }
}

impl Partition {
    /// How many cells there are; at least one.
    pub fn cells(&self) -> usize {
        self.planes.len() + 1
    }

    /// The tolerance of all cells, a length.
    pub fn tolerance(&self) -> f64 {
        self.lattice.length_to_world(self.tolerance)
    }

    /// The lower and the upper corner of a cell, rounded outwards; infinite on sides where no plane is.
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

    /// No faces so far, for those of a cell.
    pub(crate) fn faces(&self, cell: usize) -> Faces {
        Faces::of_cell(self.lattice, self.tolerance, self.cell(cell))
    }

    /// The box of a cell, in lattice units.
    fn cell(&self, cell: usize) -> CellBox {
        assert!(cell < self.cells(), "cell {cell} of {}", self.cells());
        let (mut found, mut subtree) = (EVERYWHERE, self.root());
        while subtree.cells.len() > 1 {
            let Wall { axis, at } = self.planes[subtree.plane];
            let [back, front] = subtree.sides();
            let is_behind = back.cells.contains(&cell);
            found[usize::from(is_behind)][axis] = at;
            subtree = if is_behind { back } else { front };
        }
        found
    }
}
