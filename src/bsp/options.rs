//! How a tree is to be built.

use std::ops::ControlFlow;

use super::progress::{Progress, Watch, one_at_a_time};
use super::{BspTree, Heuristic};
use crate::Error;
use crate::geom::{Exact, Faces, Kernel, Polygon, Preparation};

/// How a tree is to be built: [`BspTree::build`] with other than the defaults.
///
/// ```
/// use binspace::{BuildOptions, Heuristic};
///
/// let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let options = BuildOptions::DEFAULT
///     .with_heuristic(Heuristic::FewestSplits)
///     .with_tolerance(1e-6)
///     .with_max_fragments(1000);
/// assert_eq!(options.build([square])?.len(), 1);
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BuildOptions {
    /// How splitters are chosen. Default: [`Heuristic::Auto`].
    pub heuristic: Heuristic,
    /// The coplanar tolerance, a length in the polygons' unit: polygons no further than this from
    /// a plane count as lying on it. 0 is allowed, and then nothing but exactly coplanar polygons
    /// are. Default: `None`, [`DEFAULT_TOLERANCE`](crate::geom::DEFAULT_TOLERANCE) (1e-9) of the
    /// longest side of the scene's bounding box.
    pub tolerance: Option<f64>,
    /// The most fragments that a tree may have, and the most polygons it may be built of; more is
    /// an error, and as to polygons at once. Default: 2²⁵ (33 554 432, about 5 GB). More than
    /// 2²⁹ − 1 counts as that.
    pub max_fragments: usize,
    /// The most nodes on a path from the root; more is an error. Default: unlimited, as nothing
    /// recurses over the tree.
    pub max_depth: usize,
}

impl BuildOptions {
    /// The defaults.
    pub const DEFAULT: Self = Self {
        heuristic: Heuristic::Auto,
        tolerance: None,
        max_fragments: 1 << 25,
        max_depth: usize::MAX,
    };

    /// With another way to choose splitters.
    #[must_use]
    pub const fn with_heuristic(self, heuristic: Heuristic) -> Self {
        Self { heuristic, ..self }
    }

    /// With another coplanar tolerance, a length of 0 or more.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance: Some(tolerance), ..self }
    }

    /// With another limit to the number of fragments.
    #[must_use]
    pub const fn with_max_fragments(self, max_fragments: usize) -> Self {
        Self { max_fragments, ..self }
    }

    /// With another limit to the depth.
    #[must_use]
    pub const fn with_max_depth(self, max_depth: usize) -> Self {
        Self { max_depth, ..self }
    }

    /// Builds a tree of polygons; see [`BspTree::build`].
    ///
    /// # Errors
    ///
    /// If a polygon cannot be read or a budget runs out; see [`Error`].
    pub fn build<P: Polygon>(
        &self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<BspTree, Error> {
        self.build_with(Exact, polygons)
    }

    /// Builds a tree whose decisions another kernel makes.
    ///
    /// # Errors
    ///
    /// As for [`build`](Self::build).
    pub fn build_with<K: Kernel, P: Polygon>(
        &self,
        kernel: K,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<BspTree<K>, Error> {
        super::build::tree(kernel, self, polygons, &Watch::default())
    }

    /// Builds the same tree as [`build`](Self::build), and tells `progress` how far it is.
    ///
    /// That is called at the start, then about once in a millisecond's work, and at the end, by
    /// whichever thread has something to say, but never by two at once. By [`ControlFlow::Break`]
    /// it cancels the build: every thread stops as soon as it has finished its pass over the set
    /// of pieces at hand, which takes milliseconds, or tenths of a second in sets of some 100 000.
    /// Once all is divided, the tree is laid out, which cannot be cancelled: another such time.
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
    /// assert!(never.is_err_and(|error| error.is_cancelled()));
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
        super::build::tree(Exact, self, polygons, &Watch::new(&progress))
    }

    /// Builds a tree of faces that are made already: their tolerance counts, not that of the
    /// options.
    pub(crate) fn build_faces<K: Kernel>(
        &self,
        kernel: K,
        faces: Faces,
        preparation: Preparation,
    ) -> Result<BspTree<K>, Error> {
        super::build::tree_of(kernel, self, faces, preparation, &Watch::default())
    }
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}
