//! Builds a tree from polygons, step by step: preparation, division, the finished tree. The same steps extend
//! trees and build cells of a scene.

use std::mem::take;
use std::ops::ControlFlow;

use glam::DVec3;

use super::choose::Tuning;
use super::jobs::{self, Job};
use super::options::BuildOptions;
use super::piece::Piece;
use super::subtree::{Builder, Shared};
use crate::error::Error;
use crate::exact::{Clipper, Faces};
use crate::faces::{Preparation, Preparer};
use crate::input::{Point, Polygon};
use crate::memory::{push, reserve};
use crate::partition::{Extent, Partition};
use crate::progress::{PIECES_AT_ONCE, Progress, Watch, one_at_a_time};
use crate::tree::BspTree;
use crate::tree::parts::Parts;

impl BspTree {
    /// Builds a tree with the default options.
    ///
    /// # Errors
    ///
    /// If a coordinate is infinite or NaN, if one polygon has more than 2²² corners, if all polygons together
    /// have 2²⁸ corners or more, if the tree would have more than 2²⁵ fragments, or if memory runs out. If a
    /// polygon caused the error, the error names this polygon.
    pub fn build<P: Polygon>(polygons: impl IntoIterator<Item = P>) -> Result<Self, Error> {
        BuildOptions::DEFAULT.build(polygons)
    }
}

impl BuildOptions {
    /// Builds a tree of polygons; see [`BspTree::build`].
    ///
    /// # Errors
    ///
    /// If a polygon cannot be read or a budget runs out; see [`Error`].
    pub fn build<P: Polygon>(
        &self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<BspTree, Error> {
        tree(self, polygons, &Watch::default())
    }

    /// Builds the same tree as [`build`](Self::build), and reports the progress of the build to a callback.
    ///
    /// The callback is called at the start, about once per millisecond of work, and at the end. Any thread
    /// may call the callback, but never two threads at once: while one thread calls the callback, the other
    /// threads continue to build. So the callback may be slow, and may use the same thread pool.
    ///
    /// If the callback returns [`ControlFlow::Break`], the build is cancelled: the build then ends within
    /// milliseconds, or within tenths of a second for scenes of some 100 000 polygons. At the end of a build,
    /// the finished tree is laid out in memory. This step takes about as long as a cancellation, and cannot
    /// be cancelled.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    ///
    /// use binspace::{BuildOptions, scene};
    ///
    /// let (scene, mut percent) = (scene::random_triangles(2000, 1), 0);
    /// let tree = BuildOptions::DEFAULT.build_with_progress(scene.polygons(), |progress| {
    ///     percent = 100 * progress.done / progress.total.max(1);
    ///     ControlFlow::Continue(())
    /// })?;
    /// assert_eq!(percent, 100);
    ///
    /// let never = BuildOptions::DEFAULT
    ///     .build_with_progress(scene.polygons(), |_| ControlFlow::Break(()));
    /// assert!(never.is_err_and(|error| error.kind() == binspace::ErrorKind::Cancelled));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As for [`build`](Self::build), and if the build is cancelled.
    pub fn build_with_progress<P: Polygon>(
        &self,
        polygons: impl IntoIterator<Item = P>,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<BspTree, Error> {
        let progress = one_at_a_time(progress);
        tree(self, polygons, &Watch::new(&progress))
    }
}

fn tree<P: Polygon>(
    options: &BuildOptions,
    polygons: impl IntoIterator<Item = P>,
    watch: &Watch<'_>,
) -> Result<BspTree, Error> {
    let (faces, preparation) = prepared(options, polygons, watch)?;
    tree_of_faces(options, faces, preparation, watch)
}

/// Builds a tree of prepared faces. Faces of a partition's cell are first clipped to the cell.
pub(super) fn tree_of_faces(
    options: &BuildOptions,
    mut faces: Faces,
    mut preparation: Preparation,
    watch: &Watch<'_>,
) -> Result<BspTree, Error> {
    watch.expect(faces.len())?;
    let parts = if faces.corners_of_cell() == 0 {
        parts(options, &Tuning::DEFAULT, &faces, watch)?
    } else {
        let job = pieces_in_cell(&mut faces, watch)?;
        preparation.dropped = faces.dropped(preparation.polygons).count();
        watch.expect(faces.len())?;
        let shared = Shared::new(&faces, options, &Tuning::DEFAULT, watch)?;
        jobs::run(&shared, job, &mut Builder::default())?
    };
    watch.end()?;
    BspTree::new(faces, preparation, parts)
}

/// Clips faces to their cell, and removes faces outside it.
fn pieces_in_cell(faces: &mut Faces, watch: &Watch<'_>) -> Result<Job, Error> {
    let (mut pieces, mut arena, mut kept) = (Vec::new(), Vec::new(), Vec::new());
    let mut clipper = Clipper::new(faces);
    for face in 0..faces.len() as u32 {
        watch.work(1)?;
        let Some(outline) = clipper.clip(face) else { continue };
        let mut piece = Piece::whole(faces, face);
        if !outline.is_empty() {
            piece = Piece::part(&piece, outline, arena.len());
            reserve(&mut arena, outline.len())?;
            arena.extend_from_slice(outline);
        }
        piece.face = kept.len() as u32;
        push(&mut pieces, piece)?;
        push(&mut kept, face)?;
    }
    faces.keep(&kept)?;
    faces.shrink_to_fit();
    Ok(Job { pieces, arena, depth: 0 })
}

/// Prepares polygons. The working memory is freed before the faces are divided.
fn prepared<P: Polygon>(
    options: &BuildOptions,
    polygons: impl IntoIterator<Item = P>,
    watch: &Watch<'_>,
) -> Result<(Faces, Preparation), Error> {
    let (mut faces, mut preparer) = (Faces::default(), Preparer::default());
    preparer.hold(options.bounds)?;
    let preparation =
        preparer.prepare(&mut faces, polygons, options.tolerance, options.max_fragments, watch)?;
    faces.shrink_to_fit();
    Ok((faces, preparation))
}

/// Builds a tree of prepared faces, with the faces' tolerance instead of the options' tolerance.
///
/// # Errors
///
/// If a budget or memory runs out.
pub fn tree_of(
    options: &BuildOptions,
    tuning: &Tuning,
    faces: Faces,
    preparation: Preparation,
) -> Result<BspTree, Error> {
    let parts = parts(options, tuning, &faces, &Watch::default())?;
    BspTree::new(faces, preparation, parts)
}

/// Builds the parts of a tree of prepared faces.
fn parts(
    options: &BuildOptions,
    tuning: &Tuning,
    faces: &Faces,
    watch: &Watch<'_>,
) -> Result<Parts, Error> {
    let shared = Shared::new(faces, options, tuning, watch)?;
    divide_all(&shared, faces, &mut Builder::default(), watch)
}

/// Divides the set of all faces, down to the leaves.
pub(super) fn divide_all(
    shared: &Shared<'_>,
    faces: &Faces,
    builder: &mut Builder,
    watch: &Watch<'_>,
) -> Result<Parts, Error> {
    let (mut pieces, mut arena) = (take(&mut builder.pieces), take(&mut builder.arena));
    pieces.clear();
    arena.clear();
    reserve(&mut pieces, faces.len())?;
    for first in (0..faces.len()).step_by(PIECES_AT_ONCE) {
        let some = first..faces.len().min(first + PIECES_AT_ONCE);
        watch.work(some.len())?;
        pieces.extend(some.map(|face| Piece::whole(faces, face as u32)));
    }
    jobs::run(shared, Job { pieces, arena, depth: 0 }, builder)
}

impl BspTree {
    /// Adds polygons permanently, with the default options. If the tree has `n` polygons, the new polygons
    /// get the numbers `n`, `n` + 1 and so on.
    ///
    /// The tree is built again from the old and the new polygons, with the same grid and tolerance. This
    /// takes as long as a build. The numbers of the fragments change, so [overlays](crate::overlay::Overlay)
    /// and [meshes](crate::mesh::Mesh) of the old tree must be made again. For moving polygons, use an
    /// overlay instead.
    ///
    /// ```
    /// use binspace::{BspTree, BuildOptions, glam::DVec3};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let room = BuildOptions::DEFAULT.with_bounds(DVec3::ZERO, DVec3::ONE);
    /// let mut tree = room.build([square(0.0), square(0.5)])?;
    /// tree.extend([square(0.25)])?;
    /// assert_eq!(tree.fragments().map(|f| f.polygon()).max(), Some(2));
    /// # assert_eq!(tree.len(), 3);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As for [`build`](Self::build), and if a new polygon reaches beyond the tree's
    /// [grid](crate::BspTree::grid). For a larger grid, build the tree with [`BuildOptions::with_bounds`].
    /// The error names the polygon by its index among the new polygons, and the tree is not changed.
    pub fn extend<P: Polygon>(
        &mut self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<(), Error> {
        BuildOptions::DEFAULT.extend(self, polygons)
    }
}

impl BuildOptions {
    /// Adds polygons to a tree with these options; see [`BspTree::extend`]. The tree keeps its tolerance and
    /// grid.
    ///
    /// # Errors
    ///
    /// As for [`BspTree::extend`], and if a budget runs out.
    pub fn extend<P: Polygon>(
        &self,
        tree: &mut BspTree,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<(), Error> {
        extend(self, tree, polygons, &Watch::default())
    }

    /// Extends a tree like [`extend`](Self::extend), and reports progress to a callback that can cancel, as
    /// in [`build_with_progress`](Self::build_with_progress).
    ///
    /// # Errors
    ///
    /// As for [`extend`](Self::extend), and if the callback cancels.
    pub fn extend_with_progress<P: Polygon>(
        &self,
        tree: &mut BspTree,
        polygons: impl IntoIterator<Item = P>,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<(), Error> {
        let progress = one_at_a_time(progress);
        extend(self, tree, polygons, &Watch::new(&progress))
    }
}

fn extend<P: Polygon>(
    options: &BuildOptions,
    tree: &mut BspTree,
    polygons: impl IntoIterator<Item = P>,
    watch: &Watch<'_>,
) -> Result<(), Error> {
    let (mut faces, mut preparation) = (tree.faces.try_clone()?, tree.preparation);
    let mut preparer = Preparer::default();
    let added = preparer.append(&mut faces, polygons, preparation.polygons, usize::MAX, watch)?;
    preparation.add(&added);
    faces.shrink_to_fit();
    *tree = tree_of_faces(options, faces, preparation, watch)?;
    Ok(())
}

impl BuildOptions {
    /// Divides a scene into cells, each with about the same number of samples. Samples are points, such as
    /// one corner of every polygon, or of some polygons. Takes O(n log cells) time for n samples.
    ///
    /// The cells are the leaves of a k-d tree. Each plane goes through one of the samples in the box that the
    /// plane divides, and is perpendicular to the axis along which these samples extend furthest. If a box
    /// has no two different samples, the plane halves the longest side of the box. The cells do not depend on
    /// the order of the samples. Samples outside the extent and the bounds count as on their border. Some cells may
    /// be empty. 0 `cells` count as 1. At most [`Partition::MAX_CELLS`] cells and 2²⁸ samples are allowed.
    ///
    /// The extent must contain all polygons: like the [bounds](Self::bounds) of these options, the extent
    /// defines the [grid](BspTree::grid) to which the corners of polygons are rounded. The tolerance of these
    /// options applies to all cells; the default depends on the extent.
    ///
    /// # Errors
    ///
    /// If a coordinate of the extent or the bounds is NaN or infinite, the tolerance is negative or NaN, there
    /// are too many cells or samples, or memory runs out.
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

    /// Builds the tree of a cell. `polygons` must include all polygons that [reach](Partition::reached_by)
    /// the cell. Coplanar polygons keep their order, so pass the polygons in the same order for all cells.
    /// The tree's polygon numbers are indices among these polygons.
    ///
    /// The partition's tolerance and bounds replace the options' tolerance and bounds.
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

    /// Builds the tree of a cell like [`build_cell`](Self::build_cell), and reports progress to a callback
    /// that can cancel, as in [`build_with_progress`](Self::build_with_progress).
    ///
    /// # Errors
    ///
    /// As for [`build_cell`](Self::build_cell), and if the callback cancels.
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
    /// Counts the polygons that are dropped, triangulated or flattened when the trees of cells are built, like
    /// [`BspTree::preparation`].
    /// Each polygon is counted once, however many cells it reaches. [`dropped`](crate::Preparation::dropped)
    /// counts only polygons without area, not polygons outside a cell. If a scene does not fit into memory,
    /// call this method for one list of polygons at a time, and add up the counts. Takes as long as the
    /// preparation in [`build_cell`](BuildOptions::build_cell), and cannot be cancelled.
    ///
    /// # Errors
    ///
    /// As for [`build_cell`](BuildOptions::build_cell), but no budget applies.
    pub fn preparation<P: Polygon>(
        &self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<Preparation, Error> {
        let mut faces = self.faces(0);
        prepared_in_cell(&mut faces, polygons, usize::MAX, &Watch::default())
    }

    /// Returns whether a tree can be the tree of this cell: the tree has the partition's grid and tolerance,
    /// and the tree's polygons are clipped to the cell. The polygons themselves are not compared.
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
    let preparation = prepared_in_cell(&mut faces, polygons, options.max_fragments, watch)?;
    tree_of_faces(options, faces, preparation, watch)
}

/// Prepares the polygons of a cell. The working memory is freed before the faces are divided.
fn prepared_in_cell<P: Polygon>(
    faces: &mut Faces,
    polygons: impl IntoIterator<Item = P>,
    limit: usize,
    watch: &Watch<'_>,
) -> Result<Preparation, Error> {
    Preparer::default().append(faces, polygons, 0, limit, watch)
}
