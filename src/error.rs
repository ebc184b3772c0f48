//! The library's error.

mod kind;

use std::fmt;

pub(crate) use kind::{InputFault, InputKind, Kind, Limit};

/// Why something could not be built, written or finished, and the polygon to blame if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    kind: Kind,
}

impl InputFault {
    /// The error of a polygon, given its index.
    pub(crate) fn of_polygon(self, number: usize) -> Error {
        Kind::Input { shape: InputKind::Polygon, number, fault: self }.error()
    }
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
        self.kind.fmt(f)
    }
}

impl std::error::Error for Error {}
