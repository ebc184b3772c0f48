//! The library's error.

use std::sync::Arc;
use std::{fmt, io};

/// The reason why a call failed, such as building or reading a tree: the [kind](Self::kind) of the error, and
/// the polygon that caused the error, if any. The message says what to do.
#[derive(Clone, PartialEq)]
pub struct Error {
    kind: Kind,
    /// The input that caused the error: its kind and its index.
    blamed: Option<(Shape, usize)>,
}

/// The kinds of input that an error may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Polygon,
    Line,
    Point,
    Layer,
}

impl Kind {
    // No `From`: with it, `?` in closures would need the type of their error.
    pub(crate) const fn error(self) -> Error {
        Error { kind: self, blamed: None }
    }

    /// The error of a polygon, given its index.
    pub(crate) fn of_polygon(self, number: usize) -> Error {
        Error { kind: self, blamed: Some((Shape::Polygon, number)) }
    }
}

impl Error {
    pub(crate) const fn out_of_memory() -> Self {
        Kind::OutOfMemory.error()
    }

    pub(crate) const fn cancelled() -> Self {
        Kind::Cancelled.error()
    }

    /// Replaces the kind of the input that caused the error.
    pub(crate) fn of(mut self, shape: Shape) -> Self {
        self.blamed = self.blamed.map(|(_, number)| (shape, number));
        self
    }

    /// Returns the index of the polygon (or layer) that caused the error, in input order.
    pub const fn polygon(&self) -> Option<usize> {
        match self.number_of(Shape::Layer) {
            Some(layer) => Some(layer),
            None => self.number_of(Shape::Polygon),
        }
    }

    /// Renumbers the polygon that caused the error, if any. Use this method if you built from only some of
    /// your polygons, such as the polygons of a [cell](crate::partition).
    ///
    /// ```
    /// let error = binspace::BspTree::build([[[f64::NAN; 3]; 3]]).unwrap_err();
    /// assert_eq!((error.polygon(), error.with_polygon(7).polygon()), (Some(0), Some(7)));
    /// ```
    pub const fn with_polygon(mut self, polygon: usize) -> Self {
        if self.polygon().is_some()
            && let Some((_, number)) = &mut self.blamed
        {
            *number = polygon;
        }
        self
    }

    /// Returns the index, in input order, of the [overlay](crate::overlay::Overlay)'s line that caused the
    /// error.
    pub const fn line(&self) -> Option<usize> {
        self.number_of(Shape::Line)
    }

    /// Returns the index, in input order, of the [overlay](crate::overlay::Overlay)'s point that caused the
    /// error.
    pub const fn point(&self) -> Option<usize> {
        self.number_of(Shape::Point)
    }

    const fn number_of(&self, kind: Shape) -> Option<usize> {
        match self.blamed {
            // `const` functions cannot use `==` on enums.
            Some((shape, number)) if shape as u8 == kind as u8 => Some(number),
            _ => None,
        }
    }

    /// Returns the kind of the error, to decide how to handle it.
    pub const fn kind(&self) -> ErrorKind {
        match self.kind {
            Kind::OffGrid => ErrorKind::OutOfBounds,
            Kind::OpenEdge(_) => ErrorKind::OpenBody,
            Kind::NonFinite
            | Kind::Corners(_)
            | Kind::Opacity(_)
            | Kind::Opacities { .. }
            | Kind::Argument(_)
            | Kind::Layer
            | Kind::Tolerance(_)
            | Kind::Bounds
            | Kind::Viewport
            | Kind::Places { .. } => ErrorKind::InvalidInput,
            Kind::Polygons(_) | Kind::CornersInAll(_) | Kind::Indices | Kind::Regions(_) => {
                ErrorKind::TooLarge
            }
            Kind::PolygonsOfBudget(_) | Kind::Fragments(_) | Kind::Budgets { .. } => {
                ErrorKind::OverBudget
            }
            Kind::OutOfMemory => ErrorKind::OutOfMemory,
            Kind::Cancelled => ErrorKind::Cancelled,
            Kind::OverlaidTree | Kind::MeshOfOtherTree => ErrorKind::OtherTree,
            Kind::InOverlay | Kind::OfCell => ErrorKind::Unsupported,
            Kind::File(FileFault { problem: Problem::Text(_), .. }) => ErrorKind::InvalidFile,
            Kind::File(FileFault { problem: Problem::Io(_), .. }) => ErrorKind::Io,
        }
    }

    /// Returns the line of the text file that caused the error, counted from 1.
    pub const fn line_of_file(&self) -> Option<usize> {
        match &self.kind {
            Kind::File(fault) => fault.line,
            _ => None,
        }
    }
}

/// The kinds of errors: [`Error::kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A number of a polygon, option or argument is NaN, infinite or out of range.
    InvalidInput,
    /// A polygon, line or point of an [overlay](crate::overlay::Overlay) or a [cell](crate::partition) lies
    /// outside the tree's [grid](crate::BspTree::grid).
    OutOfBounds,
    /// A body has an [open edge](crate::BspTree::open_edges), so the body has no inside.
    OpenBody,
    /// The number of polygons or corners, or of indices of a mesh or of arrays, is too large for the
    /// library's integers; or a picture has too many regions.
    TooLarge,
    /// A build or a call reached a limit set in [`BuildOptions`](crate::BuildOptions). A larger limit or
    /// another heuristic may succeed.
    OverBudget,
    /// The polygons, the tree, the tree's layout in memory or a mesh does not fit into memory.
    ///
    /// Other allocations, such as the lists of drawings, overlays and boxes, do not return this error: if
    /// such an allocation fails, the program aborts, like other Rust programs. An operating system that
    /// overcommits memory may end the program before an allocation fails. To limit the memory of a build, set
    /// a budget ([`BuildOptions::max_fragments`](crate::BuildOptions::max_fragments)).
    OutOfMemory,
    /// The caller's callback cancelled the call, as in
    /// [`build_with_progress`](crate::BuildOptions::build_with_progress).
    Cancelled,
    /// An [overlay](crate::overlay::Overlay) or a [mesh](crate::mesh::Mesh) was made for another tree.
    OtherTree,
    /// Two features do not work together, such as a drawing and the tree of one cell.
    Unsupported,
    /// A file is damaged, truncated, or not of the expected format.
    InvalidFile,
    /// Reading failed; [`source`](std::error::Error::source) is the reason.
    Io,
}

/// Shows the message, because programs print `Debug` if `main` returns the error.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Error").field(&self.to_string()).finish()
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            Kind::File(FileFault { problem: Problem::Io(error), .. }) => Some(&**error),
            _ => None,
        }
    }
}

/// The reason why a file could not be read. A polygon's number in the error is the number of a face of the
/// file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FileFault {
    /// The name of the file; empty if the caller knows the name.
    pub(crate) name: String,
    /// The line of the file, counted from 1.
    pub(crate) line: Option<usize>,
    pub(crate) problem: Problem,
}

#[derive(Clone, Debug)]
pub(crate) enum Problem {
    Text(String),
    Io(Arc<io::Error>),
}

impl PartialEq for Problem {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Text(a), Self::Text(b)) => a == b,
            (Self::Io(a), Self::Io(b)) => a.kind() == b.kind(),
            _ => false,
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => f.write_str(text),
            Self::Io(error) => write!(f, "cannot be read: {error}"),
        }
    }
}

impl From<String> for Problem {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Problem {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<io::Error> for Problem {
    fn from(error: io::Error) -> Self {
        Self::Io(Arc::new(error))
    }
}

/// All causes of errors, each with the numbers for its message.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    not(all(feature = "drawing", feature = "layers", any(feature = "save", feature = "obj"))),
    expect(dead_code, reason = "some are of drawings, layers and files alone")
)]
pub(crate) enum Kind {
    // Of a polygon, line, point or layer.
    NonFinite,
    Corners(usize),
    OffGrid,
    /// A polygon of an overlay, where only lines and points can be drawn.
    InOverlay,
    Opacity(f64),
    Opacities {
        given: usize,
        expected: usize,
    },
    /// An invalid argument, such as a camera or a text to parse.
    Argument(String),
    File(FileFault),
    Layer,
    // Limits that the input or its tree exceeds.
    Polygons(usize),
    /// Too many corners of all polygons together. The number is the limit.
    CornersInAll(usize),
    /// Too many indices of a mesh or of arrays.
    Indices,
    /// Too many polygons behind others in all regions of a picture. The number is the limit.
    Regions(usize),
    /// More polygons than the budget for fragments, found before the build.
    PolygonsOfBudget(usize),
    Fragments(usize),
    /// Too many fragments or too many levels of nodes.
    Budgets {
        max_fragments: usize,
        max_depth: usize,
    },
    OutOfMemory,
    Cancelled,
    // Of options and arguments.
    Tolerance(f64),
    Bounds,
    Viewport,
    OfCell,
    /// The number of the corner where the edge begins.
    OpenEdge(usize),
    OverlaidTree,
    MeshOfOtherTree,
    Places {
        needed: usize,
        given: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (shape, number) = self.blamed.unwrap_or((Shape::Polygon, 0));
        let shape = match shape {
            Shape::Polygon => "polygon",
            Shape::Line => "line",
            Shape::Point => "point",
            Shape::Layer => "layer",
        };
        match &self.kind {
            Kind::NonFinite => {
                write!(f, "{shape} {number} has a coordinate that is NaN or infinite")
            }
            Kind::Corners(limit) => write!(
                f,
                "{shape} {number} has more than {limit} corners: divide it into smaller {shape}s"
            ),
            Kind::OffGrid => write!(
                f,
                "{shape} {number} reaches outside the tree's grid: build the tree with bounds (`with_bounds`), \
                 or the partition with an extent, that contain everything to be added or moved"
            ),
            Kind::InOverlay => write!(
                f,
                "{shape} {number} of the overlay cannot be drawn: drawings include only its lines and \
                 points, so build the polygons into the tree"
            ),
            Kind::Opacity(value) => write!(
                f,
                "the opacity of {shape} {number} is {value}: expected a number from 0 to 1"
            ),
            Kind::Opacities { given, expected } => write!(
                f,
                "there are {given} opacities, but {expected} polygons: pass one for each polygon"
            ),
            Kind::Argument(problem) => f.write_str(problem),
            Kind::File(FileFault { name, line, problem }) => {
                let line = line.map(|line| format!("line {line}"));
                let face = self.blamed.map(|(_, face)| format!("face {face} (from 0)"));
                let name = Some(name).filter(|name| !name.is_empty()).cloned();
                let place: Vec<String> = [name, line, face].into_iter().flatten().collect();
                if !place.is_empty() {
                    write!(f, "{}: ", place.join(", "))?;
                }
                problem.fmt(f)
            }
            Kind::Layer => write!(
                f,
                "the rectangle or matrix of {shape} {number} has a number that is NaN, infinite or \
                 too large"
            ),
            Kind::Polygons(limit) => {
                write!(f, "there are more than {limit} polygons: divide the scene")
            }
            Kind::CornersInAll(limit) => {
                write!(f, "the polygons together have {limit} corners or more: divide the scene")
            }
            Kind::Indices => {
                f.write_str("the mesh, or an array of fragments, would have more than 2^32 indices: divide the scene")
            }
            Kind::Regions(limit) => write!(
                f,
                "the picture has too many regions, in which more than {limit} polygons are visible \
                 behind others: draw fewer translucent polygons, or paint whole polygons one over \
                 another (`VisibilityMap::drawing`)"
            ),
            Kind::PolygonsOfBudget(limit) => write!(
                f,
                "there are more than {limit} polygons, but the tree may have at most {limit} \
                 fragments (`max_fragments`): raise the budget"
            ),
            Kind::Fragments(limit) => write!(
                f,
                "the tree would have more than {limit} fragments (`max_fragments`): raise the \
                 budget or choose another heuristic"
            ),
            Kind::Budgets { max_fragments, max_depth } => write!(
                f,
                "the tree would have more than {max_fragments} fragments (`max_fragments`), or be \
                 more than {max_depth} nodes deep (`max_depth`): raise the budgets or choose \
                 another heuristic"
            ),
            Kind::OutOfMemory => {
                f.write_str("out of memory: divide the scene, or limit the tree by `max_fragments`")
            }
            Kind::Cancelled => f.write_str("cancelled by the progress callback"),
            Kind::Tolerance(value) => {
                write!(f, "the coplanar tolerance is {value}, but must be 0 or more")
            }
            Kind::Bounds => f.write_str(
                "a corner of the bounds (`with_bounds`), or of a partition's extent, has a coordinate that \
                 is NaN or infinite",
            ),
            Kind::Viewport => {
                f.write_str("the viewport has a number that is NaN, infinite or too large")
            }
            Kind::OfCell => f.write_str(
                "the tree belongs to one cell of a partition, but drawings and winding numbers need whole \
                 polygons: build one tree of the scene",
            ),
            Kind::OpenEdge(corner) => write!(
                f,
                "{shape} {number} has an open edge, from its corner {corner}: no edge in the opposite direction closes \
                 it, so the body has no inside",
            ),
            Kind::OverlaidTree => f.write_str(
                "the overlay was made for another tree: make an overlay for this tree",
            ),
            Kind::MeshOfOtherTree => {
                f.write_str("the mesh was made of another tree: make the mesh of this tree")
            }
            Kind::Places { needed, given } => write!(
                f,
                "the buffer has room for {given} indices, but {needed} are to be written: make it \
                 as long as `Triangles::indices`"
            ),
        }
    }
}
