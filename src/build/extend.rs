//! Polygons added to a finished tree.

use std::ops::ControlFlow;

use super::driver::tree_of_faces;
use super::options::BuildOptions;
use super::progress::{Progress, Watch, one_at_a_time};
use crate::error::Error;
use crate::faces::Preparer;
use crate::input::Polygon;
use crate::tree::BspTree;

impl BspTree {
    /// Adds polygons for good, with the default options. Their numbers follow those of the tree's.
    ///
    /// The tree is built anew, of its own polygons and the others: it is the tree of all of them, on
    /// the grid and with the tolerance that it has. Its fragments have other numbers than before, and
    /// [overlays](crate::overlay::Overlay), [meshes](crate::mesh::Mesh) and [bounds](crate::Bounds) have to be made
    /// anew. It takes as long as a build; what moves belongs into an overlay. Duplicates among the new
    /// polygons, and of old ones, are kept and counted as always. (Of an old polygon that was triangulated,
    /// a corner that no triangle has is not known, as on a straight run or where it crosses itself, in space
    /// or along the axis on which it was triangulated: its duplicates are not found then, and a polygon
    /// without that corner counts as one.)
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
    /// As for [`build`](Self::build), and if a polygon reaches beyond the grid:
    /// [`BuildOptions::with_bounds`] makes it larger. The error names the polygon by its index among
    /// the new ones. The tree is as it was then.
    pub fn extend<P: Polygon>(
        &mut self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<(), Error> {
        BuildOptions::DEFAULT.extend(self, polygons)
    }
}

impl BuildOptions {
    /// Adds polygons to a tree with these options, of which the tolerance and the bounds do not count;
    /// see [`BspTree::extend`].
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

    /// The same, with progress reported to a callback that can cancel, as
    /// [`build_with_progress`](Self::build_with_progress) does.
    ///
    /// # Errors
    ///
    /// As for [`extend`](Self::extend), and if it is cancelled.
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
    let (before, mut preparer) = (faces.len(), Preparer::default());
    let mut added =
        preparer.append(&mut faces, polygons, preparation.polygons, usize::MAX, watch)?;
    added.duplicates = preparer.duplicates_added(&faces, before, watch)?;
    preparation.add(&added);
    faces.shrink_to_fit();
    *tree = tree_of_faces(options, faces, preparation, watch)?;
    Ok(())
}
