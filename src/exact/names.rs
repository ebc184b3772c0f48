//! Names for planes, edges and vertices that stay exact however often a polygon is cut.

use std::fmt;

const TAG_SHIFT: u32 = 28;
const PAYLOAD: u32 = (1 << TAG_SHIFT) - 1;
const EDGE: u32 = 0;
const FACE: u32 = 1;
const AXIS: u32 = 2;
const BEHIND: u32 = 1 << 31;

/// The number of faces, and of corners of all faces together, that labels can name.
pub(crate) const MAX_NAMES: usize = 1 << TAG_SHIFT;

/// A partition plane, defined by input geometry alone.
///
/// In memory and in files, bits 28 to 30 are 1 for the plane of a face, or 2, 3, 4 for a plane perpendicular
/// to x, y, z through a corner. The lower bits are the number of the face or corner.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PlaneId(pub(crate) u32);

/// The plane that a [`PlaneId`] names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneKind {
    /// The plane of a face; its front is the side from which the face's corners are counter-clockwise.
    Face(u32),
    /// The plane perpendicular to an axis (0, 1, 2 for x, y, z) through a corner, counted over all
    /// faces; its front is the side of larger coordinates.
    Axis(usize, u32),
}

impl PlaneId {
    /// Returns the name of the plane of a face.
    pub const fn face(face: u32) -> Self {
        Self(FACE << TAG_SHIFT | face)
    }

    /// Returns the name of the plane perpendicular to `axis` (0, 1, 2) through a corner.
    pub const fn axis(axis: usize, corner: u32) -> Self {
        Self((AXIS + axis as u32) << TAG_SHIFT | corner)
    }

    /// Returns the kind of the plane: the plane of a face, or perpendicular to an axis.
    #[inline]
    pub const fn kind(self) -> PlaneKind {
        let payload = self.0 & PAYLOAD;
        match self.0 >> TAG_SHIFT {
            FACE => PlaneKind::Face(payload),
            tag => PlaneKind::Axis(tag.wrapping_sub(AXIS) as usize, payload),
        }
    }
}

impl fmt::Debug for PlaneId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.kind().fmt(f)
    }
}

/// The line that bounds a piece of a face along one of its edges: an edge of the face, or the cut
/// by a plane, together with the side of that plane on which the piece lies.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct EdgeLine(u32);

impl EdgeLine {
    /// Returns the line through the face's corner `k` and the next corner.
    pub const fn edge(k: u32) -> Self {
        Self(EDGE << TAG_SHIFT | k)
    }

    /// Returns the line in which `plane` cuts the face, for a piece in front of that plane or behind it.
    pub const fn cut(plane: PlaneId, behind: bool) -> Self {
        Self(plane.0 | if behind { BEHIND } else { 0 })
    }

    /// Returns the number of the face's edge, or `None` for a cut.
    #[inline]
    pub const fn as_edge(self) -> Option<u32> {
        if self.0 >> TAG_SHIFT == EDGE { Some(self.0) } else { None }
    }

    /// Returns the plane that cut the face here, or `None` for an edge.
    #[inline]
    pub const fn as_cut(self) -> Option<PlaneId> {
        if self.0 >> TAG_SHIFT == EDGE { None } else { Some(PlaneId(self.0 & !BEHIND)) }
    }

    /// Returns whether the piece lies behind the plane that cut it along this line.
    #[inline]
    pub const fn is_behind(self) -> bool {
        self.0 & BEHIND != 0
    }
}

impl fmt::Debug for EdgeLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.as_cut() {
            Some(plane) if self.is_behind() => write!(f, "Behind({plane:?})"),
            Some(plane) => write!(f, "InFrontOf({plane:?})"),
            None => write!(f, "Edge({})", self.0),
        }
    }
}

/// A vertex of a piece of a face: the intersection of two lines of that face.
///
/// The definition uses only input points, so a vertex is as exact after a thousand cuts as after one cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VertexId {
    a: EdgeLine,
    b: EdgeLine,
}

/// The three kinds of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexKind {
    /// A corner of the face.
    Corner(u32),
    /// The intersection of a plane and an edge of the face.
    OnEdge(u32, PlaneId),
    /// The intersection of two planes and the face's plane.
    Inside(PlaneId, PlaneId),
}

impl VertexId {
    /// Returns the name of corner `k` of the face.
    pub const fn corner(k: u32) -> Self {
        Self { a: EdgeLine::edge(k), b: EdgeLine::edge(k) }
    }

    /// Returns the vertex where `plane` crosses `line`. If the line is a cut by another plane, exchanging the
    /// two planes returns the same value.
    #[inline]
    pub fn crossing(line: EdgeLine, plane: PlaneId) -> Self {
        let cut = EdgeLine::cut(plane, false);
        let line = EdgeLine(line.0 & !BEHIND);
        // Stored in one order, edges before cuts, so that equal vertices are equal values.
        if line.0 <= cut.0 { Self { a: line, b: cut } } else { Self { a: cut, b: line } }
    }

    /// Returns whether a plane is one of the planes that define the vertex; if so, the vertex lies on that
    /// plane.
    #[inline]
    pub fn is_on(self, plane: PlaneId) -> bool {
        self.a.as_cut() == Some(plane) || self.b.as_cut() == Some(plane)
    }

    /// Returns the kind of vertex.
    #[inline]
    pub const fn kind(self) -> VertexKind {
        match (self.a.as_edge(), self.b.as_cut()) {
            (Some(edge), Some(plane)) => VertexKind::OnEdge(edge, plane),
            (Some(edge), None) => VertexKind::Corner(edge),
            (None, _) => VertexKind::Inside(PlaneId(self.a.0), PlaneId(self.b.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_decoded_as_they_were_encoded() {
        let plane = PlaneId::axis(2, MAX_NAMES as u32 - 1);
        assert_eq!(plane.kind(), PlaneKind::Axis(2, MAX_NAMES as u32 - 1));
        assert_eq!(PlaneId::face(7).kind(), PlaneKind::Face(7));
        assert_eq!(EdgeLine::cut(plane, true).as_cut(), Some(plane));
        assert_eq!(EdgeLine::edge(3).as_edge(), Some(3));
        assert_eq!(EdgeLine::edge(3).as_cut(), None);
        let (g, h) = (PlaneId::face(1), PlaneId::axis(0, 2));
        assert_eq!(VertexId::corner(4).kind(), VertexKind::Corner(4));
        assert_eq!(VertexId::crossing(EdgeLine::edge(4), g).kind(), VertexKind::OnEdge(4, g));
        assert_eq!(
            VertexId::crossing(EdgeLine::cut(g, true), h),
            VertexId::crossing(EdgeLine::cut(h, false), g)
        );
        assert_eq!(VertexId::crossing(EdgeLine::cut(h, false), g).kind(), VertexKind::Inside(g, h));
    }
    #[cfg(feature = "save")]
    #[test]
    fn names_are_known_up_to_the_last() {
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let faces = crate::exact::Faces::new([triangle; 3], None).unwrap().0;
        for plane in [PlaneId::face(2), PlaneId::axis(0, 8), PlaneId::axis(2, 8)] {
            assert!(faces.has_plane(plane));
        }
        for plane in [PlaneId::face(3), PlaneId::axis(1, 9)] {
            assert!(!faces.has_plane(plane));
        }
        for bits in
            [0, 5 << TAG_SHIFT, 6 << TAG_SHIFT, 7 << TAG_SHIFT, BEHIND, BEHIND | 1 << TAG_SHIFT]
        {
            assert!(!faces.has_plane(PlaneId(bits)), "{bits:x}");
        }
    }
}
