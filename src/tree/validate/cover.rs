//! Checks that the fragments of each face cover the face once, by undoing the cuts from the leaves up.
//!
//! Each set of the builder has at most one piece of a face: at the root the face, and on each side of a plane
//! one part of every piece that the plane cuts. So the parts of a face on the two sides of a node must belong
//! to one piece. The outlines of both parts share the cut. Both outlines traverse the cut, in opposite
//! directions between the same two vertices, and the lines of these edges name the plane and the side. The
//! piece's outline then consists of the two outlines without the cut, and without the vertices that the plane
//! made on a line that continues on the other side of the plane. At the root, the result must be each face as
//! given.
//!
//! This check is complete. Suppose that a convex piece is right, and that gluing two outlines, one with
//! vertices in front of a plane and one with vertices behind the plane, gives this piece. Then the two
//! outlines are the two parts of the piece. Every vertex is a vertex of the piece or the point where a side
//! of the piece crosses the plane. A vertex of both parts lies on the plane, because it is neither in front
//! of the plane nor behind it. By induction from the root, the fragments are exactly the pieces that the
//! planes make of the faces: convex, in the face's orientation, each once.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use super::fault;
use crate::exact::Clipper;
use crate::exact::{EdgeLine, PlaneId, PreparedPlane, Vertex, VertexId};
use crate::tree::BspTree;
use crate::tree::node::Visit;

/// The pieces of a node's set: for each face, the outline of the piece, empty for a whole face.
type Set = BTreeMap<u32, Vec<Vertex>>;

impl BspTree {
    /// Glues the fragments together, and compares the result with the faces, and the number of undone cuts
    /// with the builder's count.
    pub(super) fn check_cover(&self, visits: &[Visit]) -> Result<(), String> {
        // A stack of the sets of subtrees whose parents have not been visited yet, front above back.
        let mut sets: Vec<Set> = Vec::new();
        let mut splits = 0;
        for visit in visits.iter().rev() {
            let fault = |what| fault(visit.node, what);
            let leaf = |fragment| (self.records[fragment as usize].face, self.restored(fragment));
            let node = &self.nodes[visit.node];
            let mut front = visit.front.clone().map(leaf).collect();
            let mut back = visit.back.clone().map(leaf).collect();
            if node.front_nodes > 0 {
                front = sets.pop().unwrap_or_default();
            }
            if node.back_is_node() {
                back = sets.pop().unwrap_or_default();
            }
            let mut set = self.glue_sets(node.plane, front, back, &mut splits).map_err(fault)?;
            for (face, piece) in visit.own.clone().map(leaf) {
                if set.insert(face, piece).is_some() {
                    let what = "occurs twice, or another piece overlaps it";
                    return Err(fault(format!("a piece of {} {what}", self.culprit(face))));
                }
            }
            sets.push(set);
        }
        self.check_faces(&sets.pop().unwrap_or_default()).map_err(|what| fault(0, what))?;
        let counted = self.cuts;
        if counted == splits {
            return Ok(());
        }
        let what = format_args!("the builder counted {counted} cuts, but the pieces have {splits}");
        Err(fault(0, what))
    }

    /// Glues the pieces on the two sides of a plane to the pieces of a set. The smaller set is added to the
    /// larger, so no piece is moved more than log n times.
    fn glue_sets(
        &self,
        plane: PlaneId,
        front: Set,
        back: Set,
        splits: &mut usize,
    ) -> Result<Set, String> {
        let front_is_large = front.len() > back.len();
        let (mut large, small) = if front_is_large { (front, back) } else { (back, front) };
        let prepared = PreparedPlane::new(&self.faces, plane);
        for (face, piece) in small {
            let Some(other) = large.get_mut(&face) else {
                large.insert(face, piece);
                continue;
            };
            let parts =
                if front_is_large { [&other[..], &piece[..]] } else { [&piece[..], &other[..]] };
            let side = |vertex: &_| prepared.side(&self.faces, face, vertex);
            *other = glue(plane, parts, side).ok_or_else(|| {
                let culprit = self.culprit(face);
                format!("the pieces of {culprit} on its two sides do not fit along the cut")
            })?;
            *splits += 1;
        }
        Ok(large)
    }

    /// Compares the set of the root with the faces, or with the parts of the faces in the tree's cell.
    fn check_faces(&self, set: &Set) -> Result<(), String> {
        let incomplete =
            |face| Err(format!("the pieces of {} do not add up to it", self.culprit(face)));
        let mut clipper = Clipper::new(&self.faces);
        for face in 0..self.faces.len() as u32 {
            let part = clipper.clip(face);
            if let Some(part) = part.filter(|part| !part.is_empty()) {
                if !set.get(&face).is_some_and(|outline| is_same(outline, part)) {
                    return incomplete(face);
                }
                continue;
            }
            let corners = self.faces.corners(face).len();
            let is_face = |outline: &Vec<Vertex>| {
                let first = outline.iter().position(|v| v.vertex_id() == VertexId::corner(0));
                let is_corner = |k: usize| {
                    let vertex = outline[(first.unwrap_or(0) + k) % corners];
                    let k = k as u32;
                    vertex.vertex_id() == VertexId::corner(k) && vertex.line() == EdgeLine::edge(k)
                };
                outline.is_empty() || outline.len() == corners && (0..corners).all(is_corner)
            };
            if part.is_none() || !set.get(&face).is_some_and(is_face) {
                return incomplete(face);
            }
        }
        Ok(())
    }

    /// A message that names the polygon of a face that its pieces do not cover once.
    fn culprit(&self, face: u32) -> String {
        format!("polygon {} (face {face})", self.faces.polygon(face))
    }
}

/// Whether two outlines are the same cycle of vertices; the first vertex may differ.
fn is_same(outline: &[Vertex], other: &[Vertex]) -> bool {
    let name = |vertex: &Vertex| (vertex.vertex_id(), vertex.line());
    let Some(first) = other.first().map(name) else { return outline.is_empty() };
    let start = outline.iter().position(|vertex| name(vertex) == first);
    start.is_some_and(|start| {
        let turned = outline[start..].iter().chain(&outline[..start]);
        turned.map(name).eq(other.iter().map(name))
    })
}

/// The piece that a plane cut into a piece in front and a piece behind. `None` if these two were not one
/// convex piece that the plane crossed, for instance if one of the two is the whole face.
fn glue(
    plane: PlaneId,
    [front, back]: [&[Vertex]; 2],
    side: impl Fn(&Vertex) -> Ordering,
) -> Option<Vec<Vertex>> {
    // Start at the cut's first vertex, so that the cut is the edge from vertex 0 to vertex 1.
    let front = from_cut(front, EdgeLine::cut(plane, false))?;
    let back = from_cut(back, EdgeLine::cut(plane, true))?;
    let mut outline = Vec::with_capacity(front.len() + back.len());
    for (here, there, expected) in
        [(&front, &back, Ordering::Greater), (&back, &front, Ordering::Less)]
    {
        // The start of this side, and the end of the other side.
        let (begin, last) = (here[1], there[there.len() - 1]);
        let end = there[0];
        if begin.vertex_id() != end.vertex_id() || begin.position() != end.position() {
            return None;
        }
        // A line that continues across the plane has a vertex there only because of the cut.
        let is_made = begin.line() == last.line();
        if is_made {
            let is_crossing = begin.vertex_id() == VertexId::crossing(begin.line(), plane);
            let next = here[2];
            if !is_crossing || side(&next) != expected || side(&last) != expected.reverse() {
                return None;
            }
        }
        outline.extend_from_slice(&here[if is_made { 2 } else { 1 }..]);
    }
    Some(outline)
}

/// An outline, rotated to begin with its edge on the line `cut`. A valid outline has one such edge. A second
/// such edge would stay in the glued outline and be found at the root.
fn from_cut(outline: &[Vertex], cut: EdgeLine) -> Option<Vec<Vertex>> {
    // Fragments have three vertices or more, but wrong glueing may leave fewer.
    if outline.len() < 3 {
        return None;
    }
    let first = outline.iter().position(|vertex| vertex.line() == cut)?;
    Some([&outline[first..], &outline[..first]].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLANE: PlaneId = PlaneId::face(7);

    /// The two parts of a square, in front of the plane and behind it: x is the distance from the plane.
    fn parts() -> [Vec<Vertex>; 2] {
        let corner = |k, x, y| Vertex {
            vertex_id: VertexId::corner(k),
            line: EdgeLine::edge(k),
            position: [x, y, 0.0],
        };
        let crossing = |k, line, y| Vertex {
            vertex_id: VertexId::crossing(EdgeLine::edge(k), PLANE),
            line,
            position: [0.0, y, 0.0],
        };
        let front = [
            crossing(0, EdgeLine::edge(0), 0.0),
            corner(1, 1.0, 0.0),
            corner(2, 1.0, 1.0),
            crossing(2, EdgeLine::cut(PLANE, false), 1.0),
        ];
        let back = [
            crossing(2, EdgeLine::edge(2), 1.0),
            corner(3, -1.0, 1.0),
            corner(0, -1.0, 0.0),
            crossing(0, EdgeLine::cut(PLANE, true), 0.0),
        ];
        [front.to_vec(), back.to_vec()]
    }

    fn glued([front, back]: &[Vec<Vertex>; 2]) -> Option<Vec<Vertex>> {
        let side = |vertex: &Vertex| vertex.position[0].total_cmp(&0.0);
        glue(PLANE, [&front[..], &back[..]], side)
    }

    #[test]
    fn parts_of_a_square_are_glued_to_its_corners() {
        let whole = glued(&parts()).expect("two parts of one square");
        let corners: Vec<VertexId> = [1, 2, 3, 0].map(VertexId::corner).into();
        assert_eq!(whole.iter().map(Vertex::vertex_id).collect::<Vec<_>>(), corners);
    }

    /// If a vertex beside the cut lay on the plane, both parts would contain it.
    #[test]
    fn the_vertices_beside_a_cut_are_off_the_plane() {
        for part in 0..2 {
            for beside in 1..3 {
                for wrong in [0.0, -parts()[part][beside].position[0]] {
                    let mut parts = parts();
                    parts[part][beside].position[0] = wrong;
                    assert_eq!(glued(&parts), None, "part {part}, vertex {beside} at {wrong}");
                }
            }
        }
    }

    #[test]
    fn both_parts_have_the_ends_of_a_cut_in_the_same_place() {
        for part in 0..2 {
            for end in [0, 3] {
                let mut parts = parts();
                parts[part][end].position[2] = 1.0;
                assert_eq!(glued(&parts), None, "part {part}, vertex {end}");
            }
        }
    }
}
