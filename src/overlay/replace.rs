//! Replaces all that an overlay has.

use std::ops::ControlFlow;

use super::Overlay;
use super::shapes::Shapes;
use crate::build::Progress;
use crate::build::progress::{Watch, one_at_a_time};
use crate::error::Error;
use crate::input::{Point, Polygon};
use crate::tree::BspTree;

impl Overlay {
    /// Replaces all that the overlay has by polygons, and cuts them down to the leaves of the tree.
    ///
    /// # Errors
    ///
    /// As for [`BspTree::build`]; if a polygon reaches beyond the tree's grid; or if the tree is neither
    /// the one that the overlay was made for nor a clone of it. The overlay is empty then. The error names
    /// the polygon where one is to blame, counted from 0.
    pub fn replace<P: Polygon>(
        &mut self,
        tree: &BspTree,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<(), Error> {
        self.replace_with(tree, Shapes::NONE.with_polygons(polygons))
    }

    /// Replaces all that the overlay has by polygons, lines and points, and cuts them down to the
    /// leaves of the tree.
    ///
    /// # Errors
    ///
    /// As for [`replace`](Self::replace). [`Error::line`] or [`Error::point`] is what is to blame, if
    /// it is no polygon.
    pub fn replace_with<P, L, Q>(
        &mut self,
        tree: &BspTree,
        shapes: Shapes<P, L, Q>,
    ) -> Result<(), Error>
    where
        P: IntoIterator<Item: Polygon>,
        L: IntoIterator<Item: Polygon>,
        Q: IntoIterator<Item: Point>,
    {
        self.refill(tree, shapes, &Watch::default())
    }

    /// The same, with progress reported to a callback that can cancel, as
    /// [`BuildOptions::build_with_progress`](crate::BuildOptions::build_with_progress) does.
    ///
    /// # Errors
    ///
    /// As for [`replace_with`](Self::replace_with), and if it is cancelled. The overlay is empty then,
    /// and so it is after a panic of the callback.
    pub fn replace_with_progress<P, L, Q>(
        &mut self,
        tree: &BspTree,
        shapes: Shapes<P, L, Q>,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<(), Error>
    where
        P: IntoIterator<Item: Polygon>,
        L: IntoIterator<Item: Polygon>,
        Q: IntoIterator<Item: Point>,
    {
        let progress = one_at_a_time(progress);
        self.refill(tree, shapes, &Watch::new(&progress))
    }

    fn refill<P, L, Q>(
        &mut self,
        tree: &BspTree,
        shapes: Shapes<P, L, Q>,
        watch: &Watch<'_>,
    ) -> Result<(), Error>
    where
        P: IntoIterator<Item: Polygon>,
        L: IntoIterator<Item: Polygon>,
        Q: IntoIterator<Item: Point>,
    {
        self.clear();
        self.expect(tree)?;
        let mut filling = Filling { overlay: self, is_done: false };
        filling.overlay.fill(tree, shapes, watch)?;
        filling.is_done = true;
        Ok(())
    }

    /// Fills an empty overlay; after an error it may have anything.
    fn fill<P, L, Q>(
        &mut self,
        tree: &BspTree,
        shapes: Shapes<P, L, Q>,
        watch: &Watch<'_>,
    ) -> Result<(), Error>
    where
        P: IntoIterator<Item: Polygon>,
        L: IntoIterator<Item: Polygon>,
        Q: IntoIterator<Item: Point>,
    {
        let Self { faces, base, preparer, placer, pieces, skeleton, preparation, segments } = self;
        let Shapes { polygons, lines, points } = shapes;
        if faces.is_empty() {
            *faces = tree.faces.try_clone()?;
        }
        *preparation = preparer.append(faces, polygons, base.polygons, usize::MAX, watch)?;
        placer.begin_at(base.faces, faces.len());
        preparer.append_lines(faces, lines, segments, watch)?;
        preparer.append_points(faces, points, watch)?;
        watch.expect(faces.len() - base.faces)?;
        placer.place(tree, faces, pieces, skeleton, watch)?;
        watch.end()
    }
}

/// An overlay that is being filled. Unless that is done, it is emptied: after an error, and where the
/// caller's callback or iterators panic.
struct Filling<'a> {
    overlay: &'a mut Overlay,
    is_done: bool,
}

impl Drop for Filling<'_> {
    fn drop(&mut self) {
        if !self.is_done {
            self.overlay.clear();
        }
    }
}
