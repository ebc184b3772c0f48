//! Trees of the cells of a scene.

use std::ops::ControlFlow;

use glam::DVec3;

use super::driver::tree_of_faces;
use super::options::BuildOptions;
use super::progress::{Progress, Watch, one_at_a_time};
use crate::error::Error;
use crate::exact::Faces;
use crate::faces::{Preparation, Preparer};
use crate::input::{Point, Polygon};
use crate::partition::{Extent, Partition};
use crate::tree::BspTree;

impl BuildOptions {
    /// Divides a scene into cells, each of about as many of some samples of it, such as one corner of every
    /// polygon, or of some of them. Takes O(n log cells) time for n samples.
    ///
    /// Each plane goes through a sample, and divides those on the axis along which they reach furthest. The
    /// same samples, in whatever order, give the same cells. No cell is left out, but there may be nothing
    /// in some: with fewer samples than cells, or most of them in one place, planes lie where there is room
    /// for them. 0 cells count as 1.
    ///
    /// The extent must hold all polygons: it defines the grid that their corners are rounded to, as the
    /// [bounds](Self::bounds) do that these options may have. The tolerance of these options is that of all
    /// cells; the default follows the extent.
    ///
    /// # Errors
    ///
    /// If a coordinate of the extent or the bounds is NaN or infinite, the tolerance is negative or NaN, or
    /// memory runs out.
    pub fn partition<P: Point>(
        &self,
        extent: &Extent,
        samples: impl IntoIterator<Item = P>,
        cells: usize,
    ) -> Result<Partition, Error> {
        let mut room = Extent::default();
        if let Some([corner, opposite]) = self.bounds {
            let is_finite = corner.is_finite() && opposite.is_finite();
            let whole = |c: DVec3| if is_finite { c } else { DVec3::NAN };
            let [low, high] = [corner.min(opposite), corner.max(opposite)].map(whole);
            room = Extent { low, high, ..room };
        }
        Partition::new(extent, &room, self.tolerance, samples, cells)
    }

    /// Builds the tree of a cell, of the polygons that [reach](Partition::reached_by) it, or more. Their
    /// order counts where they are coplanar, so it must be the same for all cells; the tree names them by
    /// their places in this list.
    ///
    /// The tolerance and the bounds of the options do not count: the partition has both.
    ///
    /// # Errors
    ///
    /// As for [`build`](Self::build), and if a polygon reaches beyond the partition's grid.
    ///
    /// # Panics
    ///
    /// If `cell` is not less than [`Partition::cells`].
    pub fn build_cell<P: Polygon>(
        &self,
        partition: &Partition,
        cell: usize,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<BspTree, Error> {
        tree_of_cell(self, partition, cell, polygons, &Watch::default())
    }

    /// The same, with progress reported to a callback that can cancel, as
    /// [`build_with_progress`](Self::build_with_progress) does.
    ///
    /// # Errors
    ///
    /// As for [`build_cell`](Self::build_cell), and if it is cancelled.
    ///
    /// # Panics
    ///
    /// As for [`build_cell`](Self::build_cell).
    pub fn build_cell_with_progress<P: Polygon>(
        &self,
        partition: &Partition,
        cell: usize,
        polygons: impl IntoIterator<Item = P>,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<BspTree, Error> {
        let progress = one_at_a_time(progress);
        tree_of_cell(self, partition, cell, polygons, &Watch::new(&progress))
    }
}

impl Partition {
    /// What becomes of polygons in the trees of cells: what these count in their
    /// [preparations](BspTree::preparation), but each polygon once, however many cells it reaches. For
    /// totals of a scene, whose polygons may be given in lists, as long as those with the same corners are
    /// in one. [`dropped`](crate::Preparation::dropped) are those without area. It takes as long as
    /// [`build_cell`](BuildOptions::build_cell) takes to prepare them, and cannot be cancelled.
    ///
    /// # Errors
    ///
    /// As for [`build_cell`](BuildOptions::build_cell), but for its budgets.
    pub fn preparation<P: Polygon>(
        &self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<Preparation, Error> {
        let mut faces = self.faces(0);
        prepared(&mut faces, polygons, usize::MAX, &Watch::default())
    }

    /// Whether a tree is one of this cell: on the partition's grid, with its tolerance, and cut to the cell.
    /// One that was built of other polygons is, too.
    ///
    /// # Panics
    ///
    /// If `cell` is not less than [`cells`](Self::cells).
    pub fn is_tree_of(&self, cell: usize, tree: &BspTree) -> bool {
        let [own, found] = [&self.faces(cell), tree.faces()];
        let key = |faces: &Faces| (*faces.lattice(), faces.tolerance());
        key(own) == key(found) && own.cell() == found.cell()
    }
}

fn tree_of_cell<P: Polygon>(
    options: &BuildOptions,
    partition: &Partition,
    cell: usize,
    polygons: impl IntoIterator<Item = P>,
    watch: &Watch<'_>,
) -> Result<BspTree, Error> {
    let mut faces = partition.faces(cell);
    let preparation = prepared(&mut faces, polygons, options.max_fragments, watch)?;
    tree_of_faces(options, faces, preparation, watch)
}

/// Prepares the polygons of a cell. What that needs is freed before the faces are divided.
fn prepared<P: Polygon>(
    faces: &mut Faces,
    polygons: impl IntoIterator<Item = P>,
    limit: usize,
    watch: &Watch<'_>,
) -> Result<Preparation, Error> {
    let mut preparer = Preparer::default();
    let mut preparation = preparer.append(faces, polygons, 0, limit, watch)?;
    preparation.duplicates = preparer.duplicates_added(faces, 0, watch)?;
    Ok(preparation)
}
