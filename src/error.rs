//! The library's error.

use std::fmt;

/// Why something could not be built, written or finished, and the polygon to blame if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    kind: Kind,
}

impl Limit {
    pub(crate) fn error(self) -> Error {
        Kind::Over(self).error()
    }
}

impl Kind {
    // No `From`: with it, `?` in closures would need their error's type.
    pub(crate) fn error(self) -> Error {
        Error { kind: self }
    }
}

impl Error {
    pub(crate) const fn out_of_memory() -> Self {
        Self { kind: Kind::OutOfMemory }
    }

    pub(crate) const fn cancelled() -> Self {
        Self { kind: Kind::Cancelled }
    }

    /// The same, where the polygon to blame is a shape of another kind.
    pub(crate) fn of(mut self, kind: InputKind) -> Self {
        if let Kind::Input { shape, .. } = &mut self.kind {
            *shape = kind;
        }
        self
    }

    /// The index of the polygon (or layer) to blame, in the order in which the polygons were given.
    pub const fn polygon(&self) -> Option<usize> {
        #[cfg(feature = "layers")]
        if let Some(layer) = self.number_of(InputKind::Layer) {
            return Some(layer);
        }
        self.number_of(InputKind::Polygon)
    }

    /// The same error about a polygon of another number, if it blames a polygon: for those who give the library
    /// a part of their polygons, as of a cell, and know these by other numbers.
    ///
    /// ```
    /// let error = binspace::BspTree::build([[[f64::NAN; 3]; 3]]).unwrap_err();
    /// assert_eq!((error.polygon(), error.with_polygon(7).polygon()), (Some(0), Some(7)));
    /// ```
    pub const fn with_polygon(mut self, polygon: usize) -> Self {
        if self.polygon().is_some()
            && let Kind::Input { number, .. } = &mut self.kind
        {
            *number = polygon;
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
            // `==` of enums is not for `const` functions.
            Kind::Input { shape, number, .. } if shape as u8 == kind as u8 => Some(number),
            _ => None,
        }
    }

    /// Whether a budget of [`BuildOptions`](crate::BuildOptions) ran out. A larger budget or another
    /// heuristic may succeed.
    pub const fn is_over_budget(&self) -> bool {
        matches!(
            self.kind,
            Kind::Over(Limit::PolygonsOfBudget(_) | Limit::Fragments(_) | Limit::Depth(_))
        )
    }

    /// Whether the polygons, the tree, its layout or its mesh do not fit into memory.
    ///
    /// Other lists, such as those of drawings and overlays, are not checked: where they do not fit, the
    /// program ends, as Rust programs do. A system that promises more memory than it has may end it
    /// earlier. Budgets ([`BuildOptions::max_fragments`](crate::BuildOptions::max_fragments)) limit what a
    /// build takes.
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
        self.kind.fmt(f)
    }
}

impl std::error::Error for Error {}

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

/// The fault of a polygon, line or point.
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

/// A limit that the input, or a tree of it, exceeds.
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
    /// The error of a polygon, given its index.
    pub(crate) fn of_polygon(self, number: usize) -> Error {
        Kind::Input { shape: InputKind::Polygon, number, fault: self }.error()
    }

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
