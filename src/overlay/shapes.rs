//! What an overlay is given for a frame.

use glam::DVec3;

/// Polygons, lines and points for [`Overlay::replace_with`](crate::overlay::Overlay::replace_with).
///
/// ```
/// use binspace::overlay::Shapes;
///
/// let axis = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
/// let curve: Vec<_> = (0..9).map(|k| [0.1 * f64::from(k), 0.5, 0.0]).collect();
/// let shapes = Shapes::NONE.with_lines([&axis[..], &curve]).with_points(curve.iter().copied());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Shapes<P, L, Q> {
    pub(super) polygons: P,
    pub(super) lines: L,
    pub(super) points: Q,
}

impl Shapes<[[DVec3; 3]; 0], [[DVec3; 2]; 0], [DVec3; 0]> {
    /// Nothing.
    pub const NONE: Self = Self { polygons: [], lines: [], points: [] };
}

impl<P, L, Q> Shapes<P, L, Q> {
    /// Sets the polygons: an iterator of any type of [`Polygon`](crate::Polygon).
    #[must_use]
    pub fn with_polygons<T>(self, polygons: T) -> Shapes<T, L, Q> {
        let Self { lines, points, .. } = self;
        Shapes { polygons, lines, points }
    }

    /// Sets the lines: an iterator of any type of [`Polygon`](crate::Polygon), whose corners are joined
    /// in order. The last is not joined to the first: to close a line, repeat its first corner. Of one
    /// corner there is no line.
    #[must_use]
    pub fn with_lines<T>(self, lines: T) -> Shapes<P, T, Q> {
        let Self { polygons, points, .. } = self;
        Shapes { polygons, lines, points }
    }

    /// Sets the points: an iterator of any type of [`Point`](crate::Point).
    #[must_use]
    pub fn with_points<T>(self, points: T) -> Shapes<P, L, T> {
        let Self { polygons, lines, .. } = self;
        Shapes { polygons, lines, points }
    }
}
