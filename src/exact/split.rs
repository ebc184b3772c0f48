//! The vertices of a piece, cutting a piece by a plane, and cutting faces to a cell.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::Faces;
use super::classify::{PreparedPlane, Side};
use super::names::{EdgeLine, VertexId};

/// A vertex of a piece of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    pub(crate) position: [f64; 3],
    pub(crate) vertex_id: VertexId,
    pub(crate) line: EdgeLine,
}

impl Vertex {
    /// Returns corner `k` of a face.
    #[inline]
    pub fn corner(faces: &Faces, face: u32, k: u32) -> Self {
        let position = faces.corners(face)[k as usize];
        Self { position, vertex_id: VertexId::corner(k), line: EdgeLine::edge(k) }
    }

    /// Returns the corners of a face, in order around it; for a segment its ends, which lie on the first edge of its
    /// face.
    pub fn corners(faces: &Faces, face: u32) -> impl Iterator<Item = Self> {
        let has_area = faces.has_area(face);
        (0..faces.reach(face) as u32).map(move |k| {
            let corner = Self::corner(faces, face, k);
            if has_area { corner } else { corner.with_line(EdgeLine::edge(0)) }
        })
    }

    /// Returns the position of the vertex in lattice units, rounded.
    #[inline]
    pub fn position(&self) -> [f64; 3] {
        self.position
    }

    /// Returns the definition of the vertex.
    #[inline]
    pub fn vertex_id(&self) -> VertexId {
        self.vertex_id
    }

    /// Returns the line that bounds the piece from this vertex to the next.
    #[inline]
    pub fn line(&self) -> EdgeLine {
        self.line
    }

    /// Returns the vertex where a plane cuts the edge that begins here.
    pub fn cut(&self, faces: &Faces, face: u32, plane: &PreparedPlane) -> Self {
        let vertex_id = VertexId::crossing(self.line, plane.plane);
        Self { position: faces.position(face, vertex_id), vertex_id, line: self.line }
    }

    /// The same vertex with another line to the next vertex.
    #[inline]
    pub(crate) fn with_line(self, line: EdgeLine) -> Self {
        Self { line, ..self }
    }

    /// Returns the vertex in the form of a finished tree.
    #[inline]
    pub fn stored(&self) -> StoredVertex {
        StoredVertex { vertex_id: self.vertex_id, line: self.line }
    }
}

/// A vertex, given only by its definition. The position is computed when it is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredVertex {
    pub(super) vertex_id: VertexId,
    pub(super) line: EdgeLine,
}

impl StoredVertex {
    /// Returns the definition of the vertex.
    pub(crate) fn vertex_id(&self) -> VertexId {
        self.vertex_id
    }

    /// The line that bounds the piece from this vertex to the next.
    pub(crate) fn line(&self) -> EdgeLine {
        self.line
    }

    /// Returns the vertex with its position.
    pub fn restored(&self, faces: &Faces, face: u32) -> Vertex {
        let &Self { vertex_id, line } = self;
        Vertex { position: faces.position(face, vertex_id), vertex_id, line }
    }
}

/// Cuts a piece that has vertices in front of a plane and behind the plane. Appends the vertices of the two
/// parts to `front` and `back`, in the piece's orientation.
///
/// Vertices on the plane are added to both parts. A new vertex is made only on an edge whose ends lie
/// strictly on opposite sides. The two parts define the new vertex by the same line and plane, so the vertex
/// is bit for bit the same in each part. At most two vertices of a convex piece are new. O(n) for a piece of
/// `n` vertices.
///
/// A piece with two vertices is part of a segment; the plane must separate the piece's ends.
pub fn split(
    faces: &Faces,
    plane: &PreparedPlane,
    face: u32,
    vertices: &[Vertex],
    front: &mut Vec<Vertex>,
    back: &mut Vec<Vertex>,
) {
    let cut = |side: Ordering| EdgeLine::cut(plane.plane, side.is_lt());
    let sides: SmallVec<[Ordering; 8]> =
        vertices.iter().map(|vertex| plane.side(faces, face, vertex)).collect();
    // A segment is cut once. As an outline it would be cut in both directions.
    if let [a, b] = vertices {
        let middle = a.cut(faces, face, plane);
        let parts = if sides[0].is_gt() { [front, back] } else { [back, front] };
        parts[0].extend([*a, middle]);
        parts[1].extend([middle, *b]);
        return;
    }
    for (i, vertex) in vertices.iter().enumerate() {
        let j = if i + 1 == vertices.len() { 0 } else { i + 1 };
        let (here, next) = (sides[i], sides[j]);
        // At a vertex on the plane, the part that does not contain `next` leaves the piece's outline and
        // follows the cut from here on.
        let along = |side: Ordering| {
            let leaves = here.is_eq() && next == side.reverse();
            if leaves { vertex.with_line(cut(side)) } else { *vertex }
        };
        if here.is_ge() {
            front.push(along(Ordering::Greater));
        }
        if here.is_le() {
            back.push(along(Ordering::Less));
        }
        if here.is_ne() && next == here.reverse() {
            let crossing = vertex.cut(faces, face, plane);
            let (leaving, entering) =
                (crossing.with_line(cut(here)), crossing.with_line(vertex.line()));
            // The outline passes from one part to the other here. The part that it leaves follows the cut
            // next; the part that it enters continues along this edge.
            let forward = here.is_gt();
            front.push(if forward { leaving } else { entering });
            back.push(if forward { entering } else { leaving });
        }
    }
}

/// Cuts faces to their cell.
///
/// Each plane of the cell decides like a partition plane of a tree, by the rules of
/// [`classify`](super::classify). Parts that are coplanar with the plane belong to the cell in front. All
/// cells of a scene follow this rule, so each point of each face is in one cell. Both cells beside a plane
/// define the vertices on the plane by the same points.
pub(crate) struct Clipper<'f> {
    faces: &'f Faces,
    planes: SmallVec<[(PreparedPlane, Side); 6]>,
    outline: Vec<Vertex>,
    front: Vec<Vertex>,
    back: Vec<Vertex>,
}

impl<'f> Clipper<'f> {
    pub(crate) fn new(faces: &'f Faces) -> Self {
        let planes = faces.planes_of_cell();
        let planes = planes.map(|(plane, side)| (PreparedPlane::new(faces, plane), side)).collect();
        Self { faces, planes, outline: vec![], front: vec![], back: vec![] }
    }

    /// Returns the vertices of the part of a face in the cell: an empty list if the whole face is in the
    /// cell, and `None` if no part is.
    pub(crate) fn clip(&mut self, face: u32) -> Option<&[Vertex]> {
        let Self { faces, planes, outline, front, back } = self;
        outline.clear();
        for (prepared, own) in planes {
            let cut = (!outline.is_empty()).then_some(&outline[..]);
            match prepared.classify(faces, face, cut) {
                Side::Spanning => {
                    if outline.is_empty() {
                        outline.extend(Vertex::corners(faces, face));
                    }
                    front.clear();
                    back.clear();
                    split(faces, prepared, face, outline, front, back);
                    std::mem::swap(outline, if *own == Side::Front { front } else { back });
                }
                Side::Coplanar if *own == Side::Front => {}
                side if side == *own => {}
                _ => return None,
            }
        }
        Some(&self.outline)
    }
}
