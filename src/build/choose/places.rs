//! Where pieces are, rounded: enough to choose planes by.

use glam::{DVec3, Vec3};

use crate::build::live::Live;
use crate::exact::{Faces, Kernel, Vertex};

/// The vertices and planes of pieces.
#[derive(Debug)]
pub(in crate::build) struct Places<'a, K: Kernel> {
    pub(super) faces: &'a Faces,
    /// Holds the vertices of those pieces that are not whole faces.
    arena: &'a [K::Vertex],
}

impl<'a, K: Kernel> Places<'a, K> {
    pub(in crate::build) fn new(faces: &'a Faces, arena: &'a [K::Vertex]) -> Self {
        Self { faces, arena }
    }

    /// The plane of a piece's face: its unit normal, rounded, and a point on it. That is a vertex of
    /// the piece: of one far away, the rounding of the normal would count. (Of a whole face, only
    /// three corners are certain to lie on it, others within the tolerance.)
    #[inline]
    pub(super) fn plane(&self, live: &Live) -> (Vec3, DVec3) {
        (self.faces.normal(live.face).normalize().as_vec3(), self.point(live))
    }

    fn point(&self, live: &Live) -> DVec3 {
        DVec3::from_array(match live.piece(self.arena).cut {
            None => self.faces.corner(self.faces.reference_triangle(live.face)[0]),
            Some(cut) => cut[0].position(),
        })
    }

    /// Calls a function with each vertex of a piece, in lattice units, rounded.
    #[inline]
    pub(super) fn for_each_vertex(&self, live: &Live, mut see: impl FnMut([f64; 3])) {
        match live.piece(self.arena).cut {
            None => self.faces.corners(live.face).iter().for_each(|&corner| see(corner)),
            Some(cut) => cut.iter().for_each(|vertex| see(vertex.position())),
        }
    }

    pub(super) fn vertices(&self, live: &Live) -> usize {
        match live.piece(self.arena).cut {
            None => self.faces.corners(live.face).len(),
            Some(cut) => cut.len(),
        }
    }

    /// Whether two pieces cross: any tree has to cut one of the two.
    ///
    /// Each is cut by the plane of the other along a segment of the line in which the two planes meet
    /// (Möller, “A fast triangle-triangle intersection test”, 1997).
    pub(in crate::build) fn cross(&self, a: &Live, b: &Live) -> bool {
        let [normal, other] = [a, b].map(|live| self.faces.normal(live.face));
        let line = normal.cross(other);
        let [low, high] = self.segment(a, b, other, line);
        let [other_low, other_high] = self.segment(b, a, normal, line);
        low.max(other_low) < high.min(other_high)
    }

    /// From where to where a piece reaches along a line of the plane of another, where that cuts it.
    fn segment(&self, live: &Live, other: &Live, normal: DVec3, line: DVec3) -> [f64; 2] {
        let point = self.point(other);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut see = |[from, to]: [DVec3; 2], [before, after]: [f64; 2]| {
            let here = line.dot(from + (to - from) * (before / (before - after)));
            (low, high) = (low.min(here), high.max(here));
        };
        let mut first = None;
        let mut last = (DVec3::ZERO, 0.0);
        self.for_each_vertex(live, |vertex| {
            let vertex = DVec3::from_array(vertex);
            let off = normal.dot(vertex - point);
            if first.is_none() {
                first = Some((vertex, off));
            } else if (off > 0.0) != (last.1 > 0.0) {
                see([last.0, vertex], [last.1, off]);
            }
            last = (vertex, off);
        });
        if let Some((vertex, off)) = first
            && (off > 0.0) != (last.1 > 0.0)
        {
            see([last.0, vertex], [last.1, off]);
        }
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3, EulerRot};

    use super::super::tests::Fixture;

    /// A square of side 2 in the plane z = 0, and one in the plane x = 0, moved along y and z.
    #[test]
    fn pieces_cross_where_their_segments_overlap() {
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let level = square.map(|[x, y]| turn * DVec3::new(x, y, 0.0));
        for (y, z, expected) in [
            (0.0, 0.0, true),
            (0.0, 0.9, true),
            (1.9, 0.0, true),
            (-1.9, -0.9, true),
            (0.0, 1.1, false),
            (2.1, 0.0, false),
            (-2.1, 0.9, false),
            (2.1, -1.1, false),
        ] {
            let upright = square.map(|[u, v]| turn * DVec3::new(0.0, u + y, v + z));
            for polygons in [[level, upright], [upright, level]] {
                let fixture = Fixture::new(&polygons, 1e-9);
                assert_eq!(fixture.set().cross(0, 1), expected, "{y} {z}");
            }
        }
    }
}
