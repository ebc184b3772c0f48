//! The library's error.

use std::fmt;

/// Why something could not be built, written or finished, and the polygon to blame if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    NonFinite {
        shape: InputKind,
        number: usize,
    },
    Corners {
        shape: InputKind,
        number: usize,
        limit: usize,
    },
    TooManyCorners {
        limit: usize,
    },
    TooManyPolygons {
        limit: usize,
    },
    OutOfMemory,
    Tolerance {
        value: f64,
    },
    Polygons {
        limit: usize,
    },
    Fragments {
        limit: usize,
    },
    Depth {
        limit: usize,
    },
    Cancelled,
    Bounds,
    OffGrid {
        shape: InputKind,
        number: usize,
    },
    OverlaidTree,
    #[cfg(feature = "drawing")]
    OverlayPolygon {
        number: usize,
    },
    #[cfg(feature = "drawing")]
    OfCell,
    #[cfg(feature = "layers")]
    Layer {
        layer: usize,
    },
    #[cfg(feature = "layers")]
    Viewport,
    TooManyIndices,
    #[cfg(feature = "drawing")]
    Opacity {
        polygon: usize,
        value: f64,
    },
    Places {
        needed: usize,
        given: usize,
    },
    OtherTree {
        fragments: usize,
        expected: usize,
    },
}

/// What an error may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InputKind {
    Polygon,
    Line,
    Point,
}

impl fmt::Display for InputKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Polygon => "polygon",
            Self::Line => "line",
            Self::Point => "point",
        })
    }
}

impl Error {
    pub(crate) const fn non_finite(number: usize) -> Self {
        Self { kind: Kind::NonFinite { shape: InputKind::Polygon, number } }
    }

    pub(crate) const fn polygon_corners(number: usize, limit: usize) -> Self {
        Self { kind: Kind::Corners { shape: InputKind::Polygon, number, limit } }
    }

    /// The same, where the polygon to blame is a shape of another kind.
    pub(crate) const fn of(mut self, kind: InputKind) -> Self {
        match &mut self.kind {
            Kind::NonFinite { shape, .. }
            | Kind::Corners { shape, .. }
            | Kind::OffGrid { shape, .. } => *shape = kind,
            _ => {}
        }
        self
    }

    pub(crate) const fn too_many_corners(limit: usize) -> Self {
        Self { kind: Kind::TooManyCorners { limit } }
    }

    pub(crate) const fn too_many_polygons(limit: usize) -> Self {
        Self { kind: Kind::TooManyPolygons { limit } }
    }

    pub(crate) const fn out_of_memory() -> Self {
        Self { kind: Kind::OutOfMemory }
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

    pub(crate) const fn bounds() -> Self {
        Self { kind: Kind::Bounds }
    }

    pub(crate) const fn off_grid(number: usize) -> Self {
        Self { kind: Kind::OffGrid { shape: InputKind::Polygon, number } }
    }

    pub(crate) const fn overlaid_tree() -> Self {
        Self { kind: Kind::OverlaidTree }
    }

    #[cfg(feature = "drawing")]
    pub(crate) const fn overlay_polygon(number: usize) -> Self {
        Self { kind: Kind::OverlayPolygon { number } }
    }

    #[cfg(feature = "drawing")]
    pub(crate) const fn of_cell() -> Self {
        Self { kind: Kind::OfCell }
    }

    #[cfg(feature = "layers")]
    pub(crate) const fn layer(layer: usize) -> Self {
        Self { kind: Kind::Layer { layer } }
    }

    #[cfg(feature = "layers")]
    pub(crate) const fn viewport() -> Self {
        Self { kind: Kind::Viewport }
    }

    pub(crate) const fn too_many_indices() -> Self {
        Self { kind: Kind::TooManyIndices }
    }

    #[cfg(feature = "drawing")]
    pub(crate) const fn opacity(polygon: usize, value: f64) -> Self {
        Self { kind: Kind::Opacity { polygon, value } }
    }

    pub(crate) const fn places(needed: usize, given: usize) -> Self {
        Self { kind: Kind::Places { needed, given } }
    }

    pub(crate) const fn other_tree(fragments: usize, expected: usize) -> Self {
        Self { kind: Kind::OtherTree { fragments, expected } }
    }

    /// The index of the polygon (or layer) to blame, in the order in which the polygons were given.
    pub const fn polygon(&self) -> Option<usize> {
        match self.kind {
            #[cfg(feature = "layers")]
            Kind::Layer { layer } => Some(layer),
            #[cfg(feature = "drawing")]
            Kind::OverlayPolygon { number } => Some(number),
            #[cfg(feature = "drawing")]
            Kind::Opacity { polygon, .. } => Some(polygon),
            _ => self.number_of(InputKind::Polygon),
        }
    }

    /// The same error about a polygon of another number, if it blames a polygon: for those who give the library
    /// a part of their polygons, as of a cell, and know these by other numbers.
    ///
    /// ```
    /// let error = binspace::BspTree::build([[[f64::NAN; 3]; 3]]).unwrap_err();
    /// assert_eq!((error.polygon(), error.with_polygon(7).polygon()), (Some(0), Some(7)));
    /// ```
    pub const fn with_polygon(mut self, polygon: usize) -> Self {
        match &mut self.kind {
            Kind::NonFinite { shape: InputKind::Polygon, number }
            | Kind::Corners { shape: InputKind::Polygon, number, .. }
            | Kind::OffGrid { shape: InputKind::Polygon, number } => *number = polygon,
            #[cfg(feature = "layers")]
            Kind::Layer { layer } => *layer = polygon,
            #[cfg(feature = "drawing")]
            Kind::OverlayPolygon { number } | Kind::Opacity { polygon: number, .. } => {
                *number = polygon;
            }
            _ => {}
        }
        self
    }

    /// The index of the overlay's line to blame, in the order in which the lines were given.
    pub const fn line(&self) -> Option<usize> {
        self.number_of(InputKind::Line)
    }

    /// The index of the overlay's point to blame, in the order in which the points were given.
    pub const fn point(&self) -> Option<usize> {
        self.number_of(InputKind::Point)
    }

    const fn number_of(&self, kind: InputKind) -> Option<usize> {
        match self.kind {
            Kind::NonFinite { shape, number }
            | Kind::Corners { shape, number, .. }
            | Kind::OffGrid { shape, number }
                if shape as u8 == kind as u8 =>
            {
                Some(number)
            }
            _ => None,
        }
    }

    /// Whether a budget of [`BuildOptions`](crate::BuildOptions) ran out. A larger budget or another
    /// heuristic may succeed.
    pub const fn is_over_budget(&self) -> bool {
        let kind = &self.kind;
        matches!(kind, Kind::Polygons { .. } | Kind::Fragments { .. } | Kind::Depth { .. })
    }

    /// Whether memory ran out. Not every lack of memory is reported as an error: a system that
    /// promises more memory than it has may end the program instead.
    pub const fn is_out_of_memory(&self) -> bool {
        matches!(self.kind, Kind::OutOfMemory)
    }

    /// Whether the caller's callback cancelled it, as that of
    /// [`build_with_progress`](crate::BuildOptions::build_with_progress) can.
    pub const fn is_cancelled(&self) -> bool {
        matches!(self.kind, Kind::Cancelled)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            Kind::NonFinite { shape, number } => {
                write!(f, "{shape} {number} has a coordinate that is NaN or infinite")
            }
            Kind::Corners { shape, number, limit } => write!(
                f,
                "{shape} {number} has more than {limit} corners: divide it into smaller {shape}s"
            ),
            Kind::TooManyPolygons { limit } => {
                write!(f, "there are more than {limit} polygons: divide the scene")
            }
            Kind::OutOfMemory => {
                f.write_str("out of memory: divide the scene, or limit the tree by `max_fragments`")
            }
            Kind::TooManyCorners { limit } => {
                write!(f, "the polygons together have {limit} corners or more: divide the scene")
            }
            Kind::Tolerance { value } => {
                write!(f, "the coplanar tolerance is {value}, but must be 0 or more")
            }
            Kind::Polygons { limit } => write!(
                f,
                "there are more than {limit} polygons, but the tree may have at most {limit} \
                 fragments (`max_fragments`): raise the budget"
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
            #[cfg(feature = "drawing")]
            Kind::Opacity { polygon, value } => {
                write!(
                    f,
                    "the opacity of polygon {polygon} is {value}: expected a number from 0 to 1"
                )
            }
            Kind::TooManyIndices => {
                f.write_str("the mesh would have more than 2^32 indices: divide the scene")
            }
            Kind::Places { needed, given } => write!(
                f,
                "the buffer has room for {given} indices, but {needed} are to be written: make it \
                 as long as `Triangles::indices`"
            ),
            Kind::OtherTree { fragments, expected } => write!(
                f,
                "the tree has {fragments} fragments, but the mesh was made of a tree of \
                 {expected}: make the mesh of this tree"
            ),
            Kind::Bounds => f.write_str(
                "a corner of the bounds (`with_bounds`), or of a partition's extent, has a coordinate that \
                 is NaN or infinite",
            ),
            Kind::OffGrid { shape, number } => write!(
                f,
                "{shape} {number} reaches beyond the tree's grid: build the tree with bounds \
                 (`with_bounds`), or a cell with an extent, that hold everything that will be added or moved"
            ),
            Kind::OverlaidTree => f.write_str(
                "the tree is not the one that the overlay was made for: make an overlay for it",
            ),
            #[cfg(feature = "drawing")]
            Kind::OverlayPolygon { number } => write!(
                f,
                "polygon {number} of the overlay cannot be drawn: drawings take its lines and points \
                 alone, so give the polygons to the tree"
            ),
            #[cfg(feature = "drawing")]
            Kind::OfCell => f.write_str(
                "the tree is of one cell of a partition, but drawings need whole polygons: build one tree of \
                 the scene",
            ),
            Kind::Cancelled => f.write_str("cancelled by the progress callback"),
            #[cfg(feature = "layers")]
            Kind::Layer { layer } => write!(
                f,
                "the rectangle or matrix of layer {layer} has a number that is NaN, infinite or \
                 too large"
            ),
            #[cfg(feature = "layers")]
            Kind::Viewport => {
                f.write_str("the viewport has a number that is NaN, infinite or too large")
            }
        }
    }
}

impl std::error::Error for Error {}
