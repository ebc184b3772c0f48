//! What can go wrong, and the words for it.

use std::fmt;

/// All that can go wrong, each with the numbers that its message needs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    /// One of the things that were given.
    Input {
        shape: InputKind,
        number: usize,
        fault: InputFault,
    },
    /// More than the options or the library's numbers allow.
    Over(Limit),
    OutOfMemory,
    Cancelled,
    Tolerance {
        value: f64,
    },
    Bounds,
    #[cfg(feature = "layers")]
    Viewport,
    #[cfg(feature = "drawing")]
    OfCell,
    OverlaidTree,
    MeshOfOtherTree,
    #[cfg(feature = "drawing")]
    OtherRays,
    Places {
        needed: usize,
        given: usize,
    },
}

/// What an error may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InputKind {
    Polygon,
    Line,
    Point,
    #[cfg(feature = "layers")]
    Layer,
}

/// What is wrong with the input that an error names.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum InputFault {
    NonFinite,
    Corners {
        limit: usize,
    },
    OffGrid,
    /// A polygon where only lines and points can be.
    #[cfg(feature = "drawing")]
    InOverlay,
    #[cfg(feature = "drawing")]
    Opacity {
        value: f64,
    },
    #[cfg(feature = "layers")]
    Layer,
}

/// What is limited.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Limit {
    Polygons(usize),
    /// Of all polygons together.
    Corners(usize),
    /// Of a mesh.
    Indices,
    /// By the budget for fragments, before the build.
    PolygonsOfBudget(usize),
    Fragments(usize),
    Depth(usize),
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Input { shape, number, fault } => fault.fmt(*shape, *number, f),
            Kind::Over(limit) => limit.fmt(f),
            Kind::OutOfMemory => {
                f.write_str("out of memory: divide the scene, or limit the tree by `max_fragments`")
            }
            Kind::Cancelled => f.write_str("cancelled by the progress callback"),
            Kind::Tolerance { value } => {
                write!(f, "the coplanar tolerance is {value}, but must be 0 or more")
            }
            Kind::Bounds => f.write_str(
                "a corner of the bounds (`with_bounds`), or of a partition's extent, has a coordinate that \
                 is NaN or infinite",
            ),
            #[cfg(feature = "layers")]
            Kind::Viewport => {
                f.write_str("the viewport has a number that is NaN, infinite or too large")
            }
            #[cfg(feature = "drawing")]
            Kind::OfCell => f.write_str(
                "the tree is of one cell of a partition, but drawings need whole polygons: build one tree of \
                 the scene",
            ),
            Kind::OverlaidTree => f.write_str(
                "the tree is not the one that the overlay was made for: make an overlay for it",
            ),
            Kind::MeshOfOtherTree => {
                f.write_str("the mesh was made of another tree: make the mesh of this tree")
            }
            #[cfg(feature = "drawing")]
            Kind::OtherRays => f.write_str(
                "the rays were made for a scene with another grid: make them for this tree's faces by \
                 `Rays::new`",
            ),
            Kind::Places { needed, given } => write!(
                f,
                "the buffer has room for {given} indices, but {needed} are to be written: make it \
                 as long as `Triangles::indices`"
            ),
        }
    }
}

impl InputFault {
    fn fmt(&self, shape: InputKind, number: usize, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite => {
                write!(f, "{shape} {number} has a coordinate that is NaN or infinite")
            }
            Self::Corners { limit } => write!(
                f,
                "{shape} {number} has more than {limit} corners: divide it into smaller {shape}s"
            ),
            Self::OffGrid => write!(
                f,
                "{shape} {number} reaches beyond the tree's grid: build the tree with bounds \
                 (`with_bounds`), or a cell with an extent, that hold everything that will be added or moved"
            ),
            #[cfg(feature = "drawing")]
            Self::InOverlay => write!(
                f,
                "{shape} {number} of the overlay cannot be drawn: drawings take its lines and points \
                 alone, so give the polygons to the tree"
            ),
            #[cfg(feature = "drawing")]
            Self::Opacity { value } => write!(
                f,
                "the opacity of {shape} {number} is {value}: expected a number from 0 to 1"
            ),
            #[cfg(feature = "layers")]
            Self::Layer => write!(
                f,
                "the rectangle or matrix of {shape} {number} has a number that is NaN, infinite or \
                 too large"
            ),
        }
    }
}

impl fmt::Display for InputKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Polygon => "polygon",
            Self::Line => "line",
            Self::Point => "point",
            #[cfg(feature = "layers")]
            Self::Layer => "layer",
        })
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Polygons(limit) => {
                write!(f, "there are more than {limit} polygons: divide the scene")
            }
            Self::Corners(limit) => {
                write!(f, "the polygons together have {limit} corners or more: divide the scene")
            }
            Self::Indices => {
                f.write_str("the mesh would have more than 2^32 indices: divide the scene")
            }
            Self::PolygonsOfBudget(limit) => write!(
                f,
                "there are more than {limit} polygons, but the tree may have at most {limit} \
                 fragments (`max_fragments`): raise the budget"
            ),
            Self::Fragments(limit) => write!(
                f,
                "the tree would have more than {limit} fragments (`max_fragments`): raise the \
                 budget or choose another heuristic"
            ),
            Self::Depth(limit) => write!(
                f,
                "the tree would be more than {limit} nodes deep (`max_depth`): raise the budget \
                 or choose another heuristic"
            ),
        }
    }
}
