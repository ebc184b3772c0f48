//! Cutting one piece of a face in two.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::kernel::{Kernel, Vertex};
use super::{Faces, Line};

/// Cuts a piece by a plane that has some of its vertices in front and some behind, and appends
/// the vertices of the two parts to `front` and `back`, in the piece's orientation.
///
/// Vertices on the plane go to both parts. A new vertex is made only on an edge whose ends lie
/// strictly on opposite sides. Both parts define it by the same line and plane, so they share it
/// bit for bit. A convex piece gets at most two new vertices. O(n) for a piece of `n` vertices.
///
/// A piece of two vertices is one of a segment, whose ends are on different sides.
pub fn split<K: Kernel>(
    kernel: &K,
    faces: &Faces,
    splitter: &K::Splitter,
    face: u32,
    vertices: &[K::Vertex],
    front: &mut Vec<K::Vertex>,
    back: &mut Vec<K::Vertex>,
) {
    let cut = |side: Ordering| Line::cut(K::plane(splitter), side.is_lt());
    let sides: SmallVec<[Ordering; 8]> =
        vertices.iter().map(|vertex| kernel.side(faces, splitter, face, vertex)).collect();
    // A segment: an outline would come back along it.
    if let [a, b] = vertices {
        let middle = kernel.cut(faces, splitter, face, [a, b]);
        let parts = if sides[0].is_gt() { [front, back] } else { [back, front] };
        parts[0].extend([*a, middle]);
        parts[1].extend([middle, *b]);
        return;
    }
    for (i, vertex) in vertices.iter().enumerate() {
        let j = if i + 1 == vertices.len() { 0 } else { i + 1 };
        let (here, next) = (sides[i], sides[j]);
        // At a vertex on the plane, the part that does not contain `next` leaves the piece's
        // outline and follows the cut from here on.
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
            let crossing = kernel.cut(faces, splitter, face, [vertex, &vertices[j]]);
            let (leaving, entering) =
                (crossing.with_line(cut(here)), crossing.with_line(vertex.line()));
            // The outline goes from one part to the other here. The part it leaves follows the cut
            // next; the part it enters goes on along this edge.
            let forward = here.is_gt();
            front.push(if forward { leaving } else { entering });
            back.push(if forward { entering } else { leaving });
        }
    }
}
