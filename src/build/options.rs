//! The options of a build.

use glam::DVec3;

use super::heuristic::Heuristic;
use crate::faces::Tolerance;

/// The options of a build; [`BspTree::build`](crate::BspTree::build) takes the defaults.
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
    /// How partition planes are chosen. Default: [`Heuristic::Auto`].
    pub heuristic: Heuristic,
    /// The coplanar tolerance: polygons that reach no further than this from a plane count as lying
    /// on it. Default: [`Tolerance::Default`], which follows the precision of the polygons.
    pub tolerance: Tolerance,
    /// The most fragments that a tree may have, and the most polygons it may be built from.
    /// Exceeding it is an error; too many input polygons are rejected before the build starts, and
    /// before the rest is read once 2²⁰ have come, if their iterator's size hint tells. Default: 2²⁵ (33 554 432 fragments,
    /// about 5 GB). More than 2²⁹ − 1 counts as 2²⁹ − 1, and there is a fixed limit of 2²⁸ polygons.
    pub max_fragments: usize,
    /// The most nodes on a path from the root. Exceeding it is an error. Default: unlimited; no code
    /// recurses over the tree, so a deep tree cannot overflow the stack.
    pub max_depth: usize,
    /// Two opposite corners of a box that the grid of exact coordinates has to hold besides the
    /// polygons: one that holds all that an [`Overlay`](crate::overlay::Overlay) will have. It counts as part
    /// of the scene where the scene's extent matters, as for the default tolerance. Default: none.
    pub bounds: Option<[DVec3; 2]>,
}

impl BuildOptions {
    /// The defaults.
    pub const DEFAULT: Self = Self {
        heuristic: Heuristic::Auto,
        tolerance: Tolerance::Default,
        max_fragments: 1 << 25,
        max_depth: usize::MAX,
        bounds: None,
    };

    /// Sets how partition planes are chosen.
    #[must_use]
    pub const fn with_heuristic(self, heuristic: Heuristic) -> Self {
        Self { heuristic, ..self }
    }

    /// Sets the coplanar tolerance, a length of 0 or more in the polygons' unit.
    #[must_use]
    pub const fn with_tolerance(self, length: f64) -> Self {
        Self { tolerance: Tolerance::Length(length), ..self }
    }

    /// Sets the coplanar tolerance, a share of the scene's extent of 0 or more.
    #[must_use]
    pub const fn with_relative_tolerance(self, share: f64) -> Self {
        Self { tolerance: Tolerance::Relative(share), ..self }
    }

    /// Sets the most fragments.
    #[must_use]
    pub const fn with_max_fragments(self, max_fragments: usize) -> Self {
        Self { max_fragments, ..self }
    }

    /// Sets the most nodes on a path from the root.
    #[must_use]
    pub const fn with_max_depth(self, max_depth: usize) -> Self {
        Self { max_depth, ..self }
    }

    /// Sets two opposite corners of a box that holds all that will move.
    #[must_use]
    pub const fn with_bounds(self, corner: DVec3, opposite: DVec3) -> Self {
        Self { bounds: Some([corner, opposite]), ..self }
    }
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}
