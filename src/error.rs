//! What can go wrong.

use std::fmt;

/// Why a tree could not be built, with the polygon that is to blame where one is.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    NonFinite { polygon: usize },
    NotConvex { polygon: usize },
    TooManyCorners,
    Tolerance { value: f64 },
    Polygons { limit: usize },
    Fragments { limit: usize },
    Depth { limit: usize },
    Cancelled,
}

impl Error {
    pub(crate) const fn non_finite(polygon: usize) -> Self {
        Self { kind: Kind::NonFinite { polygon } }
    }

    pub(crate) const fn not_convex(polygon: usize) -> Self {
        Self { kind: Kind::NotConvex { polygon } }
    }

    pub(crate) const fn too_many_corners() -> Self {
        Self { kind: Kind::TooManyCorners }
    }

    pub(crate) const fn tolerance(value: f64) -> Self {
        Self { kind: Kind::Tolerance { value } }
    }

    pub(crate) const fn polygons(limit: usize) -> Self {
        Self { kind: Kind::Polygons { limit } }
    }

    pub(crate) const fn fragments(limit: usize) -> Self {
        Self { kind: Kind::Fragments { limit } }
    }

    pub(crate) const fn depth(limit: usize) -> Self {
        Self { kind: Kind::Depth { limit } }
    }

    pub(crate) const fn cancelled() -> Self {
        Self { kind: Kind::Cancelled }
    }

    /// The index of the polygon to blame, in the order in which the polygons were given.
    pub const fn polygon(&self) -> Option<usize> {
        match self.kind {
            Kind::NonFinite { polygon } | Kind::NotConvex { polygon } => Some(polygon),
            _ => None,
        }
    }

    /// Whether a budget of [`BuildOptions`](crate::BuildOptions) ran out; a larger one, or another
    /// heuristic, may succeed.
    pub const fn is_over_budget(&self) -> bool {
        let kind = &self.kind;
        matches!(kind, Kind::Polygons { .. } | Kind::Fragments { .. } | Kind::Depth { .. })
    }

    /// Whether the caller cancelled the build; see
    /// [`build_with_progress`](crate::BuildOptions::build_with_progress).
    pub const fn is_cancelled(&self) -> bool {
        matches!(self.kind, Kind::Cancelled)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            Kind::NonFinite { polygon } => {
                write!(f, "polygon {polygon} has a coordinate that is infinite or not a number")
            }
            Kind::NotConvex { polygon } => write!(
                f,
                "polygon {polygon} is not convex: triangulate it, or enable the feature \
                 `triangulate`"
            ),
            Kind::TooManyCorners => write!(
                f,
                "the polygons have more than {} corners together",
                crate::geom::MAX_LABELS
            ),
            Kind::Tolerance { value } => {
                write!(f, "the coplanar tolerance must be a length of 0 or more, not {value}")
            }
            Kind::Polygons { limit } => write!(
                f,
                "there are more than {limit} polygons, which is the most fragments that the tree \
                 may have (`max_fragments`): raise the budget"
            ),
            Kind::Fragments { limit } => write!(
                f,
                "the tree would have more than {limit} fragments (`max_fragments`): raise the \
                 budget or choose another heuristic"
            ),
            Kind::Depth { limit } => write!(
                f,
                "the tree would be more than {limit} nodes deep (`max_depth`): raise the budget \
                 or choose another heuristic"
            ),
            Kind::Cancelled => f.write_str("the build was cancelled"),
        }
    }
}

impl std::error::Error for Error {}
